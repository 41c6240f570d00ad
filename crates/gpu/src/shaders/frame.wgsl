// A frame that stays on the device: rays of the camera, the march, shadow rays, Lambert's law, a sky that
// is mirrored, the image. What is seen is as zeroset_shade has it.

struct Settings {
    march: March,
    // w: 1 in perspective, 0 for parallel rays.
    eye: vec4f,
    forward: vec4f,
    // Half the image's height in space, at distance 1 in perspective. w: a pixel's width there.
    right: vec4f,
    up: vec4f,
    // The domain's box; w: the radius of the ball around its centre, or 0; the longest side.
    low: vec4f,
    high: vec4f,
    // Linear colours of the side that the gradient points out of, and of the other.
    front: vec4f,
    back: vec4f,
    width: u32,
    height: u32,
    first_row: u32,
    last_row: u32,
    lights: u32,
    // 1 for on.
    shadows: u32,
    // No line is longer within the domain.
    longest: f32,
    unused3: u32,
    // The sky: its zenith's direction, w: 1 if there is one; the tiles' edges; linear colours.
    sky_up: vec4f,
    edges: array<vec4f, 2>,
    zenith: vec4f,
    horizon: vec4f,
    tiles: array<vec4f, 2>,
    sun: vec4f,
    // Side of a tile, clear distance, blur, share that is mirrored where the surface faces the eye.
    sky_numbers: vec4f,
    // Unit vectors towards lights; w: strength.
    light: array<vec4f, 8>,
}

@group(0) @binding(1) var<uniform> settings: Settings;
// The background's colour by row, as bytes.
@group(0) @binding(2) var<storage, read> background: array<u32>;
@group(0) @binding(3) var<storage, read_write> image: array<u32>;

// Where a line is in the domain: empty if y < x.
fn clip(origin: vec3f, direction: vec3f) -> vec2f {
    var range = vec2f(0.0, 3.0e38);
    for (var axis = 0u; axis < 3u; axis++) {
        let o = origin[axis];
        let d = direction[axis];
        if d == 0.0 {
            if o < settings.low[axis] || o > settings.high[axis] {
                return vec2f(1.0, 0.0);
            }
        } else {
            let a = (settings.low[axis] - o) / d;
            let b = (settings.high[axis] - o) / d;
            range = vec2f(max(range.x, min(a, b)), min(range.y, max(a, b)));
        }
    }
    let radius = settings.low.w;
    if radius > 0.0 {
        // From the point of the line that is nearest to the centre.
        let centre = 0.5 * (settings.low.xyz + settings.high.xyz);
        let middle = dot(centre - origin, direction);
        let off = origin + middle * direction - centre;
        let square = radius * radius - dot(off, off);
        if square < 0.0 {
            return vec2f(1.0, 0.0);
        }
        let half = sqrt(square);
        range = vec2f(max(range.x, middle - half), min(range.y, middle + half));
    }
    return range;
}

// The part of a line in the domain; no length if there is none.
fn segment_of(origin: vec3f, direction: vec3f) -> Segment {
    let range = clip(origin, direction);
    var segment: Segment;
    segment.start = origin + range.x * direction;
    segment.direction = direction;
    segment.length = range.y - range.x;
    // From very far away, single precision does not tell where a line enters the domain.
    if segment.length > 1.5 * settings.longest {
        segment.length = 0.0;
    }
    return segment;
}

// By central differences where it is not finite: the CPU has narrower ones, in double precision.
fn gradient(p: vec3f) -> vec3f {
    let g = vec3f(
        slope(p.x, p.y, p.z, 1.0, 0.0, 0.0),
        slope(p.x, p.y, p.z, 0.0, 1.0, 0.0),
        slope(p.x, p.y, p.z, 0.0, 0.0, 1.0),
    );
    if is_finite(g.x) && is_finite(g.y) && is_finite(g.z) {
        return g;
    }
    var differences: vec3f;
    for (var axis = 0u; axis < 3u; axis++) {
        var half: vec3f;
        half[axis] = settings.high.w / 8192.0;
        let a = p - half;
        let b = p + half;
        differences[axis] = value(b.x, b.y, b.z) - value(a.x, a.y, a.z);
    }
    return differences;
}

// A linear colour as sRGB bytes.
fn bytes(colour: vec3f) -> u32 {
    let c = clamp(colour, vec3f(0.0), vec3f(1.0));
    let curve = 1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055;
    let encoded = select(curve, 12.92 * c, c <= vec3f(0.0031308));
    let b = vec3u(floor(255.0 * encoded + 0.5));
    return b.x | (b.y << 8u) | (b.z << 16u) | 0xff000000u;
}

// By the longest component first, so that squares neither overflow nor vanish.
fn unit(v: vec3f) -> vec3f {
    let size = max(abs(v.x), max(abs(v.y), abs(v.z)));
    return normalize(v / size);
}

// The mean over a width of the wave that is 1 on (0, 1), -1 on (1, 2), and so on.
fn stripes(x: f32, width: f32) -> f32 {
    let w = max(width, 1e-3);
    let ends = vec2f(x + 0.5 * w, x - 0.5 * w);
    let integral = 1.0 - abs(ends - 2.0 * floor(0.5 * ends) - 1.0);
    return (integral.x - integral.y) / w;
}

// The floor, one unit below, where a direction reaches it.
fn ground(direction: vec3f, depth: f32) -> vec3f {
    let distance = 1.0 / max(depth, 1e-4);
    let tile = settings.sky_numbers.x;
    let width = settings.sky_numbers.z * distance * distance / tile;
    let a = stripes(dot(direction, settings.edges[0].xyz) * distance / tile, width);
    let b = stripes(dot(direction, settings.edges[1].xyz) * distance / tile, width);
    let tiles = mix(settings.tiles[1].xyz, settings.tiles[0].xyz, 0.5 + 0.5 * a * b);
    return mix(tiles, settings.horizon.xyz, 1.0 - exp2(-distance / settings.sky_numbers.y));
}

// A sun's disc and the glow around it, by the cosine of the angle from its centre.
fn glow(cosine: f32) -> f32 {
    let angle = degrees(acos(clamp(cosine, -1.0, 1.0)));
    let disc = clamp(2.5 - angle, 0.0, 1.0);
    let near = angle / 6.0;
    let far = angle / 20.0;
    return 6.0 * disc + 0.7 * exp(-near * near) + 0.25 * exp(-far * far);
}

// The light from a direction, without suns whose bit says that they are blocked.
fn sky(direction: vec3f, blocked: u32) -> vec3f {
    let height = dot(direction, settings.sky_up.xyz);
    var light = ground(direction, -height);
    if height > 0.0 {
        light = mix(settings.horizon.xyz, settings.zenith.xyz, sqrt(height));
    }
    for (var i = 0u; i < settings.lights; i++) {
        let source = settings.light[i];
        if ((blocked >> i) & 1u) == 0u {
            light += source.w * glow(dot(direction, source.xyz)) * settings.sun.xyz;
        }
    }
    return light;
}

fn shade(direction: vec3f, p: vec3f, width: f32, distance: f32) -> u32 {
    let slope = gradient(p);
    let size = max(abs(slope.x), max(abs(slope.y), abs(slope.z)));
    if !(is_finite(size) && size > 0.0) {
        return bytes(vec3f(0.166375));
    }
    var normal = unit(slope);
    var colour = settings.front.xyz;
    if dot(normal, direction) > 0.0 {
        normal = -normal;
        colour = settings.back.xyz;
    }
    let side = settings.high.w;
    let footprint = settings.right.w * mix(1.0, distance, settings.eye.w);
    let offset = min(max(8.0 * width, min(2.0 * footprint, side / 256.0)), side / 8.0);
    var blocked = 0u;
    var light = 0.08 + 0.05 * dot(normal, normalize(settings.up.xyz));
    for (var i = 0u; i < settings.lights; i++) {
        let source = settings.light[i];
        let facing = dot(normal, source.xyz);
        if facing > 0.0 {
            var reaches = true;
            if settings.shadows == 1u {
                // Whether there is a root is enough: no bisections (Section 4.2), but those that refute.
                let segment = segment_of(p + offset * normal, source.xyz);
                let bisections = select(0u, settings.march.bisections, TAYLOR);
                reaches = !(segment.length > 0.0 && march(segment, bisections).found == 1u);
            }
            light += select(0.0, source.w * facing, reaches);
            blocked |= select(1u << i, 0u, reaches);
        }
    }
    let own = light * colour;
    if settings.sky_up.w == 0.0 {
        return bytes(own);
    }
    let cosine = -dot(direction, normal);
    let mirrored = sky(direction + 2.0 * cosine * normal, blocked);
    let past = 1.0 - clamp(cosine, 0.0, 1.0);
    let square = past * past;
    let facing = settings.sky_numbers.w;
    return bytes(mix(own, mirrored, facing + (1.0 - facing) * square * square * past));
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    // Eight by eight pixels a workgroup, so that rays side by side march together.
    let block = group.y * groups.x + group.x;
    let columns = (settings.width + 7u) / 8u;
    let x = block % columns * 8u + local % 8u;
    let y = settings.first_row + block / columns * 8u + local / 8u;
    if x >= settings.width || y >= settings.last_row {
        return;
    }
    let half = 0.5 * f32(settings.height);
    let u = (f32(x) + 0.5 - 0.5 * f32(settings.width)) / half;
    let v = (half - f32(y) - 0.5) / half;
    let offset = u * settings.right.xyz + v * settings.up.xyz;
    let perspective = settings.eye.w;
    let origin = settings.eye.xyz + (1.0 - perspective) * offset;
    let direction = normalize(settings.forward.xyz + perspective * offset);

    var colour = background[y];
    var is_hit = false;
    let segment = segment_of(origin, direction);
    if segment.length > 0.0 {
        let answer = march(segment, settings.march.bisections);
        is_hit = answer.found == 1u;
        if is_hit {
            let s = 0.5 * (answer.bracket.x + answer.bracket.y);
            let p = segment.start + s * direction;
            let width = answer.bracket.y - answer.bracket.x;
            colour = shade(direction, p, width, length(p - origin));
        }
    }
    if !is_hit && settings.sky_up.w == 1.0 {
        colour = bytes(sky(direction, 0u));
    }
    image[y * settings.width + x] = colour;
}
