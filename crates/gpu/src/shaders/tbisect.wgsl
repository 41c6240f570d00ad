// Interval bisection along a ray ([knoll2007] Section 6.5), one ray an invocation. The stack is two
// integers: piece `index` of 2^depth equal pieces of the ray.

struct Settings {
    rays: u32,
    // Comes back with each answer.
    ticket: u32,
    unused0: u32,
    unused1: u32,
}

// From its base, which is enclosed in a box, a ray goes `length` directions far.
struct Line {
    base_lo: vec3f,
    length: f32,
    base_hi: vec3f,
    // Where the march starts or goes on.
    index: u32,
    direction: vec3f,
    // Two bytes: where it is, and the depth of pieces that are bisected no further.
    depths: u32,
}

struct Answer {
    // The piece that may hold a root.
    index: u32,
    found: u32,
    intervals: u32,
    ticket: u32,
}

@group(0) @binding(1) var<uniform> settings: Settings;
@group(0) @binding(2) var<storage, read> lines: array<Line>;
@group(0) @binding(3) var<storage, read_write> answers: array<Answer>;

// base + t direction.
fn coordinate(lo: f32, hi: f32, t: vec2f, direction: f32) -> vec2f {
    let a = t.x * direction;
    let b = t.y * direction;
    return vec2f(
        step_down(lo + step_down(min(a, b), 1u), 1u),
        step_up(hi + step_up(max(a, b), 1u), 1u),
    );
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let ray = id.y * groups.x * 64u + id.x;
    if ray >= settings.rays {
        return;
    }
    let line = lines[ray];
    let last = line.depths >> 8u;
    var depth = line.depths & 0xffu;
    var index = line.index;
    var answer: Answer;
    answer.ticket = settings.ticket;
    loop {
        // Exact: an index has at most 24 bits.
        let part = bitcast<f32>((127u - depth) << 23u) * line.length;
        let t = vec2f(step_down(f32(index) * part, 1u), step_up(f32(index + 1u) * part, 1u));
        let f = value(
            coordinate(line.base_lo.x, line.base_hi.x, t, line.direction.x),
            coordinate(line.base_lo.y, line.base_hi.y, t, line.direction.y),
            coordinate(line.base_lo.z, line.base_hi.z, t, line.direction.z),
        );
        answer.intervals += 1u;
        // What is no number excludes nothing.
        let excluded = f.x > 0.0 || f.y < 0.0;
        if !excluded {
            if depth >= last {
                answer.found = 1u;
                answer.index = index;
                break;
            }
            index *= 2u;
            depth += 1u;
            continue;
        }
        index += 1u;
        if index == 1u << depth {
            break;
        }
        let up = countTrailingZeros(index);
        index >>= up;
        depth -= up;
    }
    answers[ray] = answer;
}
