// Quadrics in bounds, drawn: [stoll2006] Section 5. Stage `shape` covers a bound on the screen and works out
// what is linear over it; stage `paint` solves the equation of a pixel's ray.
//
// Constants before this text: TETRAHEDRA, LOCAL, RECIPROCAL, BRUTE, BOTH, CULLED, PERSPECTIVE, BYTES, OFFSET.
//
// All points are given about the scene's centre, or about a patch's origin ("local").

struct Frame {
    // The eye; where rays start in an orthographic view.
    eye: vec3f,
    // Half the image's height in space, at distance 1 in perspective.
    extent: f32,
    right: vec3f,
    // Pixels.
    width: f32,
    up: vec3f,
    height: f32,
    forward: vec3f,
    // The radius of the scene.
    radius: f32,
}

struct Patch {
    origin: vec3f,
    c: f32,
    // A: xx, yy, zz, and xy, yz, zx.
    diagonal: vec3f,
    // The radius of the ball.
    radius: f32,
    mixed: vec3f,
    // n'x <= offset, all of it local; n = 0 where nothing is cut.
    cut_offset: f32,
    b: vec3f,
    unused: f32,
    cut: vec3f,
    unused_too: f32,
    // The middle of the bound.
    centre: vec3f,
    unused_again: f32,
}

// Barycentric coordinates of a local point x: linear x + constant, a row for each corner.
struct Corners {
    corner: array<vec4f, 4>,
    linear: array<vec4f, 4>,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> patches: array<Patch>;
@group(0) @binding(2) var<storage, read> corners: array<Corners>;

// What varies linearly over a bound's shape on the screen.
struct Varying {
    @builtin(position) place: vec4f,
    // The ray: local point, direction.
    @location(0) point: vec3f,
    @location(1) direction: vec3f,
    // A times them.
    @location(2) a_point: vec3f,
    @location(3) a_direction: vec3f,
    // Barycentric coordinates of the point, and how they change along the ray.
    @location(4) inside: vec4f,
    @location(5) change: vec4f,
    @location(6) @interpolate(flat) index: u32,
}

// Outside of what is seen.
fn nowhere() -> Varying {
    var out: Varying;
    out.place = vec4f(2.0, 2.0, 2.0, 1.0);
    return out;
}

fn times(p: Patch, x: vec3f) -> vec3f {
    return vec3f(
        p.diagonal.x * x.x + p.mixed.x * x.y + p.mixed.z * x.z,
        p.mixed.x * x.x + p.diagonal.y * x.y + p.mixed.y * x.z,
        p.mixed.z * x.x + p.mixed.y * x.y + p.diagonal.z * x.z,
    );
}

// The same with all terms positive.
fn abs_times(p: Patch, x: vec3f) -> vec3f {
    let diagonal = abs(p.diagonal);
    let mixed = abs(p.mixed);
    return vec3f(
        diagonal.x * x.x + mixed.x * x.y + mixed.z * x.z,
        mixed.x * x.x + diagonal.y * x.y + mixed.y * x.z,
        mixed.z * x.x + mixed.y * x.y + diagonal.z * x.z,
    );
}

// Along right, up and forward.
fn seen(x: vec3f) -> vec3f {
    return vec3f(dot(x, frame.right), dot(x, frame.up), dot(x, frame.forward));
}

// From pixels to slopes; to lengths in an orthographic view.
fn slope(pixel: vec2f) -> vec2f {
    let half = 0.5 * vec2f(frame.width, frame.height);
    return vec2f(pixel.x - half.x, half.y - pixel.y) * (frame.extent / half.y);
}

fn pixel(slope: vec2f) -> vec2f {
    let half = 0.5 * vec2f(frame.width, frame.height);
    return half + vec2f(slope.x, -slope.y) * (half.y / frame.extent);
}

fn place_of(pixel: vec2f) -> vec4f {
    let half = 0.5 * vec2f(frame.width, frame.height);
    return vec4f(pixel.x / half.x - 1.0, 1.0 - pixel.y / half.y, 0.5, 1.0);
}

// Does a patch surely show its inside alone? Eq. 18 and 19, with a margin for what was rounded.
fn is_hidden(p: Patch, k: u32, eye: vec3f) -> bool {
    let ae = times(p, eye);
    let b = p.b + ae;
    let c = p.c + dot(eye, ae + 2.0 * p.b);
    var most: f32;
    if TETRAHEDRA {
        most = dot(corners[k].corner[0].xyz - eye, b);
        for (var i = 1u; i < 4u; i += 1u) {
            most = max(most, dot(corners[k].corner[i].xyz - eye, b));
        }
    } else {
        most = dot(p.centre - eye, b) + p.radius * length(b);
    }
    // Each term of c and b has a few roundings.
    let largest = abs_times(p, abs(eye));
    let size = dot(abs(eye), largest + 2.0 * abs(p.b)) + abs(p.c);
    let reach = abs(eye) + abs(p.centre) + p.radius;
    return c + most < -4e-6 * (size + dot(largest + abs(p.b), reach));
}

// Fills in what is linear, for a ray of local point and direction.
fn linear(p: Patch, point: vec3f, direction: vec3f) -> Varying {
    var out: Varying;
    out.point = point;
    out.direction = direction;
    if !BRUTE {
        out.a_point = times(p, point);
        out.a_direction = times(p, direction);
    }
    return out;
}

fn ball(k: u32, vertex: u32) -> Varying {
    let p = patches[k];
    let eye = frame.eye - p.origin;
    if CULLED && is_hidden(p, k, eye) {
        return nowhere();
    }
    let c = seen(p.centre - eye);
    let r = p.radius;
    var low = vec2f(0.0);
    var high = vec2f(frame.width, frame.height);
    if PERSPECTIVE {
        if c.z <= -r {
            return nowhere();
        }
        // Nearer, rounding moves the tangents.
        if c.z > 1.01 * r {
            // Tangents to the circles in which planes along an axis of the image cut the ball.
            let square = c.z * c.z - r * r;
            let root = r * sqrt(max(c.xy * c.xy + square, vec2f(0.0)));
            let a = pixel((c.xy * c.z - root) / square);
            let b = pixel((c.xy * c.z + root) / square);
            low = min(a, b);
            high = max(a, b);
        }
    } else {
        let a = pixel(c.xy - r);
        let b = pixel(c.xy + r);
        low = min(a, b);
        high = max(a, b);
    }
    // Whole pixels: there rasterisation interpolates without error.
    low = clamp(floor(low - 0.01), vec2f(0.0), vec2f(frame.width, frame.height));
    high = clamp(ceil(high + 0.01), vec2f(0.0), vec2f(frame.width, frame.height));
    if any(low >= high) {
        return nowhere();
    }
    let corner = select(low, high, vec2<bool>((vertex & 1u) == 1u, (vertex & 2u) == 2u));
    let s = slope(corner);
    var point: vec3f;
    var direction = frame.forward;
    if PERSPECTIVE {
        // On the plane through the ball's centre.
        point = p.centre + (s.x * c.z - c.x) * frame.right + (s.y * c.z - c.y) * frame.up;
        direction += s.x * frame.right + s.y * frame.up;
    } else {
        point = p.centre + (s.x - c.x) * frame.right + (s.y - c.y) * frame.up;
    }
    if !LOCAL {
        point = eye;
    }
    var out = linear(p, point, direction);
    out.place = place_of(corner);
    out.index = k;
    return out;
}

fn tetrahedron(instance: u32, vertex: u32) -> Varying {
    let k = instance / 4u;
    let face = instance % 4u;
    let p = patches[k];
    let eye = frame.eye - p.origin;
    if CULLED && is_hidden(p, k, eye) {
        return nowhere();
    }
    var all = corners[k].corner;
    var before = true;
    var behind = true;
    for (var i = 0u; i < 4u; i += 1u) {
        let z = dot(all[i].xyz - eye, frame.forward);
        before &= z > 1e-4 * p.radius;
        behind &= z <= 0.0;
    }
    if PERSPECTIVE && behind {
        return nowhere();
    }
    let a = all[(face + 1u) % 4u].xyz;
    let b = all[(face + 2u) % 4u].xyz;
    let c = all[(face + 3u) % 4u].xyz;
    let normal = cross(b - a, c - a);
    let outward = select(normal, -normal, dot(normal, all[face].xyz - a) > 0.0);
    let sight = select(frame.forward, a - eye, PERSPECTIVE);
    // Faces towards the eye; away from it where the eye may be among them, or beside.
    let is_front = dot(outward, sight) < 0.0;
    if is_front != (before || !PERSPECTIVE) {
        return nowhere();
    }
    let at = (face + 1u + vertex) % 4u;
    let corner = all[at].xyz;
    let direction = select(frame.forward, corner - eye, PERSPECTIVE);
    let c_seen = seen(corner - eye);
    var point = corner;
    var inside = vec4f(0.0);
    inside[at] = 1.0;
    if !LOCAL {
        point = eye;
        inside = barycentric(k, eye, 1.0);
    }
    var out = linear(p, point, direction);
    out.inside = inside;
    out.change = barycentric(k, direction, 0.0);
    let half = 0.5 * vec2f(frame.width, frame.height);
    let on_screen = c_seen.xy / frame.extent * vec2f(half.y / half.x, 1.0);
    let w = select(1.0, c_seen.z, PERSPECTIVE);
    out.place = vec4f(on_screen, 0.5 * w, w);
    out.index = k;
    return out;
}

fn barycentric(k: u32, x: vec3f, w: f32) -> vec4f {
    let rows = corners[k].linear;
    let point = vec4f(x, w);
    return vec4f(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point), dot(rows[3], point));
}

@vertex
fn shape(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Varying {
    if TETRAHEDRA {
        return tetrahedron(instance, vertex);
    }
    return ball(instance, vertex);
}

// A pixel's ray and the surface: the roots where it enters the inside and where it leaves it; which count.
struct Roots {
    enters: f32,
    leaves: f32,
    are: bool,
}

fn solve(alpha: f32, beta: f32, gamma: f32) -> Roots {
    if RECIPROCAL {
        // Eq. 15, with the sign of its root mended.
        let b = beta / gamma;
        let square = b * b - alpha / gamma;
        let s = sqrt(square);
        let near = 1.0 / (s - b);
        let far = 1.0 / (-b - s);
        return Roots(select(far, near, gamma > 0.0), select(near, far, gamma > 0.0), square >= 0.0);
    }
    let square = beta * beta - alpha * gamma;
    if square < 0.0 {
        return Roots(0.0, 0.0, false);
    }
    let s = sqrt(square);
    if !LOCAL {
        // Eq. 7.
        if abs(alpha) < 1e-6 {
            let t = -gamma / (2.0 * beta);
            // One root; the other is nowhere.
            return Roots(select(3e38, t, beta < 0.0), select(t, 3e38, beta < 0.0), true);
        }
        return Roots((-beta - s) / alpha, (s - beta) / alpha, true);
    }
    // The sum of numbers of one sign, and the other root from the product of both.
    if beta < 0.0 {
        return Roots(gamma / (s - beta), (s - beta) / alpha, true);
    }
    return Roots(-(beta + s) / alpha, -gamma / (beta + s), true);
}

// How far beyond a face a root still counts, in parts of the height over it: rasterisation places corners to
// 1/256 of a pixel, and what it leaves to a neighbour must not be left by both.
fn slack(k: u32, size: f32) -> vec4f {
    let rows = corners[k].linear;
    let steepness =
        vec4f(length(rows[0].xyz), length(rows[1].xyz), length(rows[2].xyz), length(rows[3].xyz));
    return steepness * size;
}

struct Found {
    // About the scene's centre; the distance from the ball's centre in radii.
    position: vec3f,
    distance: f32,
    normal: vec3f,
    depth: f32,
}

// Is the root in the bound and before the eye? Then its distance from the ball's centre in radii, else -1.
fn place_in_bound(in: Varying, p: Patch, x: vec3f, t: f32) -> f32 {
    let z = dot(x + p.origin - frame.eye, frame.forward);
    // Also where it is not a number.
    if !(z > 0.0) || dot(p.cut, x) > p.cut_offset {
        return -1.0;
    }
    if TETRAHEDRA {
        let footprint = 2.0 * frame.extent / frame.height * select(1.0, z, PERSPECTIVE);
        let size = 1e-6 * p.radius + footprint / 128.0;
        let coordinates = in.inside + t * in.change + slack(in.index, size);
        return select(-1.0, 0.0, all(coordinates >= vec4f(0.0)));
    }
    let away = x - p.centre;
    let distance = length(away) / p.radius;
    return select(-1.0, distance, distance <= 1.0);
}

fn find(fragment: Varying) -> Found {
    var in = fragment;
    let p = patches[in.index];
    if BRUTE {
        in.a_point = times(p, in.point);
        in.a_direction = times(p, in.direction);
    }
    let d = in.direction;
    if LOCAL && !TETRAHEDRA {
        // The circle of the ball on the screen.
        let away = in.point - p.centre;
        let along = dot(away, d);
        if along * along < dot(d, d) * (dot(away, away) - p.radius * p.radius) {
            discard;
        }
    }
    let alpha = dot(d, in.a_direction);
    let beta = dot(d, in.a_point + p.b);
    let gamma = dot(in.point, in.a_point + 2.0 * p.b) + p.c;
    let roots = solve(alpha, beta, gamma);
    if !roots.are {
        discard;
    }
    var t = roots.enters;
    var x = in.point + t * d;
    var distance = place_in_bound(in, p, x, t);
    if BOTH {
        let other = in.point + roots.leaves * d;
        let there = place_in_bound(in, p, other, roots.leaves);
        if there >= 0.0 && (distance < 0.0 || roots.leaves < t) {
            t = roots.leaves;
            x = other;
            distance = there;
        }
    }
    if distance < 0.0 {
        discard;
    }
    let gradient = in.a_point + p.b + t * in.a_direction;
    let position = x + p.origin;
    // Along the ray, about the foot of the scene's centre: from -1 to 1.
    let along = dot(position, d) / (length(d) * frame.radius);
    let reach = OFFSET * p.radius / frame.radius;
    let depth = clamp(0.5 + 0.25 * (along + reach), 0.0, 1.0);
    return Found(position, distance, normalize(gradient), depth);
}
