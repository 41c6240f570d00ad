// Adaptive marching points [singh2010], Algorithm 1 and Eq. 2: the same march as that of zeroset_cpu::Amp,
// which is its twin. Who includes this has a uniform `settings` with a member `march`, and says what the
// compiler had better know: the constants TAYLOR (else the sign test), DISTANCE_ADAPTATION and
// SILHOUETTE_ADAPTATION.

struct March {
    step: f32,
    tau1: f32,
    tau2: f32,
    tau3: f32,
    epsilon: f32,
    bisections: u32,
    // A march that has taken more samples refutes no bracket.
    samples: u32,
    unused: u32,
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

fn sample_at(segment: Segment, s: f32, answer: ptr<function, Answer>) -> Sample {
    let p = segment.start + s * segment.direction;
    var sample: Sample;
    sample.s = s;
    sample.value = value(p.x, p.y, p.z) - settings.march.epsilon;
    sample.finite = is_finite(sample.value);
    if TAYLOR {
        sample.slope = slope_at(segment, s);
        (*answer).gradients += 1u;
    } else {
        (*answer).points += 1u;
    }
    (*answer).nonfinite += select(1u, 0u, sample.finite);
    return sample;
}

// Does the step between two samples hold a root?
fn isolates(a: Sample, b: Sample) -> bool {
    if !(a.finite && b.finite) {
        return false;
    }
    if !TAYLOR {
        return (a.value < 0.0 && b.value > 0.0) || (a.value > 0.0 && b.value < 0.0);
    }
    // Eq. 3. What is no number is on neither side of 0.
    let half = 0.5 * (b.s - a.s);
    let q = a.value + a.slope * half;
    let r = b.value - b.slope * half;
    let least = a.value <= 0.0 || q <= 0.0 || r <= 0.0 || b.value <= 0.0;
    let greatest = a.value >= 0.0 || q >= 0.0 || r >= 0.0 || b.value >= 0.0;
    return least && greatest;
}

// Where the next sample is: at the one before if there is none.
fn next(segment: Segment, before: Sample, answer: ptr<function, Answer>) -> f32 {
    if before.s >= segment.length {
        return before.s;
    }
    let size = abs(before.value);
    let near = size <= settings.march.tau1;
    var step = settings.march.step;
    if DISTANCE_ADAPTATION {
        if near {
            step *= 0.5;
        } else if size > settings.march.tau2 {
            step *= 2.0;
        }
    }
    if SILHOUETTE_ADAPTATION && near {
        var along = before.slope;
        if !TAYLOR {
            along = slope_at(segment, before.s);
            (*answer).gradients += 1u;
        }
        if abs(along) <= settings.march.tau3 {
            step *= 0.5;
        }
    }
    return min(before.s + step, segment.length);
}

// Marches along a segment, and narrows the first step that holds a root so often.
fn march(segment: Segment, bisections: u32) -> Answer {
    var answer: Answer;
    var before: Sample;
    before.finite = false;
    var s = 0.0;
    loop {
        // To a step that may hold a root. It is narrowed only then, so that rays side by side do so
        // together: else all would wait for each.
        var sample: Sample;
        var isolated = false;
        loop {
            sample = sample_at(segment, s, &answer);
            if sample.finite && sample.value == 0.0 {
                answer.found = 1u;
                answer.bracket = vec2f(s, s);
                break;
            }
            isolated = isolates(before, sample);
            if isolated {
                break;
            }
            before = sample;
            s = next(segment, before, &answer);
            // A step that is none would never end.
            if s <= before.s {
                break;
            }
        }
        if !isolated {
            break;
        }
        var from_ = before;
        var to_ = sample;
        if narrow(segment, &from_, &to_, bisections, &answer) {
            answer.found = 1u;
            answer.bracket = vec2f(from_.s, to_.s);
            break;
        }
        // A bracket that is refuted is passed.
        before = to_;
        s = next(segment, before, &answer);
        if s <= before.s {
            break;
        }
    }
    return answer;
}

// By the Taylor test, it may be that neither half of a bracket holds a root: within so many bisections
// that refutes the bracket.
const REFUTING = 10u;

// Halves the isolated step, keeping the half with the root. False if there is none.
fn narrow(
    segment: Segment,
    from_: ptr<function, Sample>,
    to_: ptr<function, Sample>,
    bisections: u32,
    answer: ptr<function, Answer>,
) -> bool {
    for (var i = 1u; i <= bisections; i++) {
        let middle = sample_at(segment, 0.5 * ((*from_).s + (*to_).s), answer);
        if middle.finite && middle.value == 0.0 {
            *from_ = middle;
            *to_ = middle;
            return true;
        }
        if isolates(*from_, middle) {
            *to_ = middle;
        } else if middle.finite && (!TAYLOR || isolates(middle, *to_)) {
            *from_ = middle;
        } else {
            // Without a finite value, and where a refutation comes too late, the bracket stays.
            return !middle.finite || i > REFUTING || (*answer).gradients > settings.march.samples;
        }
    }
    return true;
}
