// BeamCast ([ganacim2011] Section III-B) for the cells of a level of the quadtree, one an invocation. The
// stack is two integers: piece `index` of 2^depth equal pieces of the beam.
//
// Form is what encloses values over a piece; functions whose names start with form_ are recorded from the
// CPU's.

struct Settings {
    // The domain's box.
    low: vec4f,
    high: vec4f,
    // The enclosed centre of its ball; the square of its radius, or -1 where there is no ball.
    centre_low: vec3f,
    squared: f32,
    centre_high: vec3f,
    // Rays are rounded by at most this.
    slack: f32,
    // The eye, or the direction.
    fixed: vec3f,
    far: f32,
    // Pixels of the whole image.
    image: vec2f,
    unused: vec2f,
}

// What a pixel sees, or the cell of which it is the first pixel.
struct Answer {
    piece: vec2f,
    // Exponent of the cell that was excluded; FOUND, PROVEN.
    state: u32,
    intervals: u32,
}

const FOUND = 0x100u;
const PROVEN = 0x200u;

@group(0) @binding(1) var<uniform> settings: Settings;
@group(0) @binding(2) var<uniform> level: Level;
// For each level: workgroups along x, y and z, and how many cells.
@group(0) @binding(3) var<storage, read> counts: array<vec4u>;
@group(0) @binding(4) var<storage, read> cells: array<Cell>;
// Where quarters start, if the cell has any: their number, and t.
@group(0) @binding(5) var<storage, read_write> quarters: array<vec2u>;
// Quarters of the cells of a workgroup.
@group(0) @binding(6) var<storage, read_write> sums: array<u32>;
@group(0) @binding(7) var<storage, read_write> answers: array<Answer>;

var<workgroup> sum: atomic<u32>;

struct Points {
    x: Form,
    y: Form,
    z: Form,
}

struct Boxes {
    low: vec3f,
    high: vec3f,
}

struct Beam {
    origin: Points,
    direction: Points,
}

fn beam_of(column: u32, row: u32) -> Beam {
    let size = f32(level.size);
    let u = form_u(vec2f(f32(column) * size, min(f32(column + 1u) * size, settings.image.x)));
    let v = form_v(vec2f(f32(row) * size, min(f32(row + 1u) * size, settings.image.y)));
    let none = form_point(0.0);
    let moving = Points(
        form_widened(lens_x(u, v, none), settings.slack),
        form_widened(lens_y(u, v, none), settings.slack),
        form_widened(lens_z(u, v, none), settings.slack),
    );
    let fixed = Points(
        form_point(settings.fixed.x),
        form_point(settings.fixed.y),
        form_point(settings.fixed.z),
    );
    if PERSPECTIVE {
        return Beam(fixed, moving);
    }
    return Beam(moving, fixed);
}

// Over a range of t, which is not negative.
fn points_of(beam: Beam, range: vec2f) -> Points {
    let t = form_t(range);
    return Points(
        form_along(beam.origin.x, beam.direction.x, t),
        form_along(beam.origin.y, beam.direction.y, t),
        form_along(beam.origin.z, beam.direction.z, t),
    );
}

fn boxes_of(points: Points) -> Boxes {
    let x = form_range(points.x);
    let y = form_range(points.y);
    let z = form_range(points.z);
    return Boxes(vec3f(x.x, y.x, z.x), vec3f(x.y, y.y, z.y));
}

fn is_inside(boxes: Boxes) -> bool {
    // Bounds are rounded outward: the next number inward is in the domain.
    let inside = all(settings.low.xyz < boxes.low) && all(boxes.high < settings.high.xyz);
    return inside && settings.squared < 0.0;
}

fn gap(low: f32, high: f32, centre_low: f32, centre_high: f32) -> f32 {
    return max(max(step_down(low - centre_high, 1u), step_down(centre_low - high, 1u)), 0.0);
}

// May the box have a point in the domain?
fn meets(boxes: Boxes) -> bool {
    if !all(boxes.low <= boxes.high) {
        return false;
    }
    if settings.squared < 0.0 {
        return true;
    }
    let low = settings.centre_low;
    let high = settings.centre_high;
    let x = gap(boxes.low.x, boxes.high.x, low.x, high.x);
    let y = gap(boxes.low.y, boxes.high.y, low.y, high.y);
    let z = gap(boxes.low.z, boxes.high.z, low.z, high.z);
    var total = step_down(0.0 + step_down(x * x, 1u), 1u);
    total = step_down(total + step_down(y * y, 1u), 1u);
    total = step_down(total + step_down(z * z, 1u), 1u);
    return total <= settings.squared;
}

// F over points, which are cut with a box.
fn value_of(points: Points, boxes: Boxes) -> vec2f {
    return form_range(value(
        form_cut(points.x, vec2f(boxes.low.x, boxes.high.x)),
        form_cut(points.y, vec2f(boxes.low.y, boxes.high.y)),
        form_cut(points.z, vec2f(boxes.low.z, boxes.high.z)),
    ));
}

fn cut(boxes: Boxes) -> Boxes {
    return Boxes(max(boxes.low, settings.low.xyz), min(boxes.high, settings.high.xyz));
}

fn beam_cast(beam: Beam, start: f32) -> Answer {
    var answer = Answer(vec2f(0.0, 0.0), level.exponent, 0u);
    let length = step_up(settings.far - start, 1u);
    var index = 0u;
    var depth = 0u;
    // Of F at the start of the piece, on all rays.
    var sign = 0i;
    loop {
        // Exact: an index has at most 24 bits.
        let part = length * bitcast<f32>((127u - depth) << 23u);
        let last = step_down(f32(index + 1u) * part, 1u);
        let t = vec2f(
            step_down(start + step_down(f32(index) * part, 1u), 1u),
            step_up(start + step_up(f32(index + 1u) * part, 1u), 1u),
        );
        let points = points_of(beam, t);
        let whole = boxes_of(points);
        let boxes = cut(whole);
        var excluded = true;
        var next_sign = 0i;
        if meets(boxes) {
            let f = value_of(points, boxes);
            answer.intervals += 1u;
            // What is no number excludes nothing; a range that ends before it begins has no sign.
            next_sign = i32(f.x > 0.0) - i32(f.y < 0.0);
            excluded = f.x > 0.0 || f.y < 0.0;
        }
        if excluded {
            sign = next_sign;
            index += 1u;
            let up = min(countTrailingZeros(index), depth);
            index >>= up;
            depth -= up;
            if depth == 0u {
                break;
            }
            continue;
        }
        var proven = false;
        if SEES && sign != 0i && is_inside(whole) {
            // The face in which the piece ends.
            let ends = points_of(beam, vec2f(step_down(start + last, 1u), t.y));
            let face = boxes_of(ends);
            let f = value_of(ends, cut(face));
            answer.intervals += 1u;
            let change = (sign > 0i && f.y < 0.0) || (sign < 0i && f.x > 0.0);
            proven = change && is_inside(face);
        }
        if part <= level.tolerance || proven || depth == DEEPEST {
            answer.piece = t;
            answer.state = FOUND | select(0u, PROVEN, proven);
            break;
        }
        index *= 2u;
        depth += 1u;
    }
    return answer;
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let count = counts[level.number];
    let workgroup = group.y * count.x + group.x;
    let i = workgroup * 64u + lane;
    if i < count.w {
        let cell = cells[i];
        let column = cell.place & 0xffffu;
        let row = cell.place >> 16u;
        var answer = beam_cast(beam_of(column, row), cell.start);
        let pixel = vec2u(column, row) * level.size;
        let place = (pixel.y - level.row) * level.width + pixel.x;
        // The work of a cell counts at its first pixel, which it shares with its first quarter.
        if level.number > 0u && ((column | row) & 1u) == 0u {
            answer.intervals += answers[place].intervals;
        }
        answers[place] = answer;
        var parts = 0u;
        if (answer.state & FOUND) != 0u && level.size > 1u {
            let first = vec2u(column, row) * 2u;
            let both = select(vec2u(1u), vec2u(2u), first + 1u < level.extent);
            parts = both.x * both.y;
        }
        quarters[i] = vec2u(parts, bitcast<u32>(answer.piece.x));
        if parts > 0u {
            atomicAdd(&sum, parts);
        }
    }
    workgroupBarrier();
    if lane == 0u && workgroup * 64u < count.w {
        sums[workgroup] = atomicLoad(&sum);
    }
}
