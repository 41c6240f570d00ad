// Adaptive marching points [singh2010], Algorithm 1 and Eq. 2: one ray an invocation. The same march as
// that of zeroset_cpu::Amp, which is its twin.

struct Settings {
    step: f32,
    tau1: f32,
    tau2: f32,
    tau3: f32,
    epsilon: f32,
    bisections: u32,
    // 1 for on.
    distance_adaptation: u32,
    silhouette_adaptation: u32,
    // 0 for the sign test, 1 for the Taylor test.
    test: u32,
    rays: u32,
    unused0: u32,
    unused1: u32,
}

// The part of a ray in the domain; s counts length from its start.
struct Segment {
    start: vec3f,
    length: f32,
    direction: vec3f,
    unused: f32,
}

struct Answer {
    bracket: vec2f,
    found: u32,
    points: u32,
    gradients: u32,
    nonfinite: u32,
}

@group(0) @binding(1) var<uniform> settings: Settings;
@group(0) @binding(2) var<storage, read> segments: array<Segment>;
@group(0) @binding(3) var<storage, read_write> answers: array<Answer>;

// S, and its derivative along the ray where a test or a measure needs it.
struct Sample {
    s: f32,
    value: f32,
    slope: f32,
    finite: bool,
}

// By bits: a compiler may assume that there is no NaN.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

fn slope_at(segment: Segment, s: f32) -> f32 {
    let p = segment.start + s * segment.direction;
    let d = segment.direction;
    return slope(p.x, p.y, p.z, d.x, d.y, d.z);
}

fn sample_at(segment: Segment, s: f32) -> Sample {
    let p = segment.start + s * segment.direction;
    var sample: Sample;
    sample.s = s;
    sample.value = value(p.x, p.y, p.z) - settings.epsilon;
    sample.finite = is_finite(sample.value);
    if settings.test == 1u {
        sample.slope = slope_at(segment, s);
        sample.finite = sample.finite && is_finite(sample.slope);
    }
    return sample;
}

// Does the step between two samples hold a root?
fn isolates(a: Sample, b: Sample) -> bool {
    if !(a.finite && b.finite) {
        return false;
    }
    if settings.test == 0u {
        return (a.value < 0.0 && b.value > 0.0) || (a.value > 0.0 && b.value < 0.0);
    }
    // Eq. 3.
    let half = 0.5 * (b.s - a.s);
    let q = a.value + a.slope * half;
    let r = b.value - b.slope * half;
    let least = min(min(a.value, q), min(r, b.value));
    let most = max(max(a.value, q), max(r, b.value));
    return least <= 0.0 && most >= 0.0;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let ray = id.y * groups.x * 64u + id.x;
    if ray >= settings.rays {
        return;
    }
    let segment = segments[ray];
    var answer: Answer;
    var before: Sample;
    before.finite = false;
    var s = 0.0;
    var isolated = vec2f(0.0, 0.0);
    loop {
        let sample = sample_at(segment, s);
        answer.points += 1u;
        answer.gradients += settings.test;
        answer.nonfinite += select(1u, 0u, sample.finite);
        if sample.finite && sample.value == 0.0 {
            answer.found = 1u;
            answer.bracket = vec2f(s, s);
            break;
        }
        if isolates(before, sample) {
            answer.found = 1u;
            answer.bracket = narrow(segment, before, sample, &answer);
            break;
        }
        if s >= segment.length {
            break;
        }
        before = sample;
        let size = abs(sample.value);
        let near = size <= settings.tau1;
        var step = settings.step;
        if settings.distance_adaptation == 1u {
            if near {
                step *= 0.5;
            } else if size > settings.tau2 {
                step *= 2.0;
            }
        }
        if settings.silhouette_adaptation == 1u && near {
            var along = sample.slope;
            if settings.test == 0u {
                along = slope_at(segment, s);
                answer.gradients += 1u;
            }
            if abs(along) <= settings.tau3 {
                step *= 0.5;
            }
        }
        s = min(s + step, segment.length);
    }
    answers[ray] = answer;
}

// Halves the isolated step, keeping the half with the root.
fn narrow(segment: Segment, from_: Sample, to_: Sample, answer: ptr<function, Answer>) -> vec2f {
    var a = from_;
    var b = to_;
    for (var i = 0u; i < settings.bisections; i++) {
        let middle = sample_at(segment, 0.5 * (a.s + b.s));
        (*answer).points += 1u;
        (*answer).gradients += settings.test;
        if !middle.finite {
            (*answer).nonfinite += 1u;
            break;
        }
        if middle.value == 0.0 {
            return vec2f(middle.s, middle.s);
        }
        if isolates(a, middle) {
            b = middle;
        } else {
            a = middle;
        }
    }
    return vec2f(a.s, b.s);
}
