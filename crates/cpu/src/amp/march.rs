//! The march: Algorithm 1 of [singh2010] on packets of rays.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::plain::Plain;
use zeroset_ia::{Dual, Kernel, Packet, Pair, Scalar};
use zeroset_raycast::{Certificate, Hit, Ray, Work};

use super::Adaptation;
use super::rule::Settings;

/// The part of a ray in the domain. The march counts s, the length from where the ray enters, so
/// that steps are lengths in space and positions stay exact far from the eye.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Where s = 0.
    pub start: [f32; 3],
    /// The unit vector along the ray.
    pub direction: [f32; 3],
    /// The largest s.
    pub length: f32,
    /// `t_s` and `t_e`.
    range: [f64; 2],
    /// Length in space for 1 in t.
    speed: f64,
}

impl Segment {
    /// The part of a ray with t in `range`.
    pub fn new(ray: Ray, range: [f64; 2]) -> Self {
        let direction = ray.direction.as_dvec3();
        let speed = direction.length();
        Self {
            start: ray.at(range[0]).as_vec3().to_array(),
            direction: (direction / speed).as_vec3().to_array(),
            length: ((range[1] - range[0]) * speed) as f32,
            range,
            speed,
        }
    }

    /// Is its place known? For a ray from very far away, double precision does not tell where it
    /// enters the domain.
    pub fn is_resolved(&self, settings: &Settings) -> bool {
        f64::from(self.length) <= 1.5 * settings.longest
    }

    /// The ray parameter at s.
    pub fn t(&self, s: f64) -> f64 {
        (self.range[0] + s / self.speed).min(self.range[1])
    }
}

/// The function along the rays, at one s for each.
#[derive(Clone, Copy)]
pub(super) struct Sample<R> {
    s: R,
    value: R,
    /// F'(s), if the root test looks at slopes.
    slope: R,
    /// Where the value is finite.
    finite: u64,
}

impl<R: Packet> Sample<R> {
    /// This one in the lanes of the mask, else the other.
    #[inline(always)]
    fn select(self, mask: u64, other: Self) -> Self {
        Self {
            s: self.s.select(mask, self.s, other.s),
            value: self.value.select(mask, self.value, other.value),
            slope: self.slope.select(mask, self.slope, other.slope),
            finite: self.finite & mask | other.finite & !mask,
        }
    }
}

/// A [`RootTest`](super::RootTest) known when code is compiled, so that the march has no branch for it.
pub(super) trait Test: Copy {
    /// Does it look at slopes? Then every sample has one.
    const SLOPES: bool;
    /// In which lanes do the steps between two samples hold a root?
    fn isolates<R: Packet>(self, from: &Sample<R>, to: &Sample<R>, zero: R) -> u64;
}

/// [`RootTest::Sign`](super::RootTest::Sign).
#[derive(Clone, Copy)]
pub(super) struct Sign;

/// [`RootTest::Taylor`](super::RootTest::Taylor).
#[derive(Clone, Copy)]
pub(super) struct Taylor;

impl Test for Sign {
    const SLOPES: bool = false;
    /// The signs themselves, since the product of two tiny values would vanish.
    #[inline(always)]
    fn isolates<R: Packet>(self, from: &Sample<R>, to: &Sample<R>, zero: R) -> u64 {
        let (a, b) = (from.value, to.value);
        let opposite = a.lt(zero) & zero.lt(b) | b.lt(zero) & zero.lt(a);
        opposite & from.finite & to.finite
    }
}

impl Test for Taylor {
    const SLOPES: bool = true;
    /// Eq. 3: 0 is in [min, max] if one of p, q, r, s is at most 0 and one at least. What is NaN is
    /// neither.
    #[inline(always)]
    fn isolates<R: Packet>(self, from: &Sample<R>, to: &Sample<R>, zero: R) -> u64 {
        let half = splat(zero, 0.5) * (to.s - from.s);
        let p = from.value;
        let q = from.value + from.slope * half;
        let r = to.value - to.slope * half;
        let s = to.value;
        let least = p.le(zero) | q.le(zero) | r.le(zero) | s.le(zero);
        let greatest = zero.le(p) | zero.le(q) | zero.le(r) | zero.le(s);
        least & greatest & from.finite & to.finite
    }
}

/// By the Taylor test, it may be that neither half of a bracket holds a root. Within so many bisections,
/// the paper's number, that refutes the bracket, and the march goes on behind it. Further ones look at
/// rounding errors: a double root is known to half of the digits.
const REFUTING: f64 = 10.0;

/// The march of some rays, given with their indices; gives the answers with them.
pub(super) struct March<'a, T> {
    pub test: T,
    pub tape: &'a Tape,
    pub settings: &'a Settings,
    pub segments: &'a [(usize, Segment)],
}

impl<T: Test> Kernel for March<'_, T> {
    type Output = Vec<(usize, Hit)>;

    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        let zero = Pair(zero, zero);
        let mut function = Function {
            values: self.tape.evaluator(&Plain(zero)),
            slopes: self.tape.evaluator(&Dual::constant_value(Plain(zero))),
        };
        let mut hits = Vec::with_capacity(self.segments.len());
        for packet in self.segments.chunks(Pair::<R>::LANES) {
            march(&mut function, zero, self.test, self.settings, packet, &mut hits);
        }
        hits
    }
}

/// S, and its derivative along the rays.
struct Function<'a, R> {
    values: Evaluator<'a, Plain<R>>,
    slopes: Evaluator<'a, Dual<Plain<R>, 1>>,
}

/// The lines along which a packet marches.
struct Lines<R> {
    start: [R; 3],
    direction: [R; 3],
}

impl<R: Packet> Lines<R> {
    #[inline(always)]
    fn at(&self, s: R) -> [R; 3] {
        let [x, y, z] = self.start;
        let [u, v, w] = self.direction;
        [x + s * u, y + s * v, z + s * w]
    }
}

impl<R: Packet> Function<'_, R> {
    #[inline(always)]
    fn value(&mut self, lines: &Lines<R>, s: R) -> R {
        let [x, y, z] = lines.at(s);
        self.values.evaluate([Plain(x), Plain(y), Plain(z)]).0
    }

    /// F(s), and F'(s) = grad S . D.
    #[inline(always)]
    fn expansion(&mut self, lines: &Lines<R>, s: R) -> [R; 2] {
        let [x, y, z] = lines.at(s);
        let [u, v, w] = lines.direction;
        let along = [(x, u), (y, v), (z, w)];
        let [x, y, z] = along.map(
            #[inline(always)]
            |(x, u)| Dual { value: Plain(x), tangent: [Plain(u)] },
        );
        let Dual { value, tangent: [slope] } = self.slopes.evaluate([x, y, z]);
        [value.0, slope.0]
    }
}

#[inline(always)]
fn splat<R: Packet>(zero: R, x: f64) -> R {
    zero.splat(R::Scalar::from_f64(x))
}

/// Marches one packet, every lane by its own steps.
#[inline(always)]
fn march<R: Packet, T: Test>(
    function: &mut Function<'_, R>,
    zero: R,
    test: T,
    settings: &Settings,
    packet: &[(usize, Segment)],
    hits: &mut Vec<(usize, Hit)>,
) {
    let lines = Lines {
        start: columns(zero, packet, |s| s.start),
        direction: columns(zero, packet, |s| s.direction),
    };
    let [length] = columns(zero, packet, |s| [s.length]);
    let infinity = zero.splat(R::Scalar::INFINITY);
    let one = splat(zero, 1.0);
    let half = splat(zero, 0.5);
    let epsilon = splat(zero, settings.epsilon);
    let tau1 = splat(zero, settings.tau1);
    let tau2 = splat(zero, settings.tau2);
    let tau3 = splat(zero, settings.tau3);
    let base = splat(zero, settings.step);

    // The last sample of each ray, none at first, and the end of the step or bracket after it.
    let none = Sample { s: zero, value: zero, slope: zero, finite: 0 };
    let [mut from, mut to] = [none; 2];
    let mut active = (1_u64 << packet.len()) - 1;
    let mut bisecting = 0_u64;
    let mut found = 0_u64;
    let all = splat(zero, f64::from(settings.bisections));
    let last_refuting = splat(zero, f64::from(settings.bisections) - REFUTING);
    let samples = splat(zero, settings.samples);
    let mut bisections = all;
    let [mut points, mut gradients, mut nonfinite] = [zero; 3];
    while active != 0 {
        let s = to.s.select(bisecting, half * (from.s + to.s), to.s);
        let [value, slope] = if T::SLOPES {
            gradients = gradients + zero.select(active, one, zero);
            function.expansion(&lines, s)
        } else {
            points = points + zero.select(active, one, zero);
            [function.value(&lines, s), zero]
        };
        let value = value - epsilon;
        let finite = value.abs().lt(infinity);
        let sample = Sample { s, value, slope, finite };
        nonfinite = nonfinite + zero.select(active & !finite, one, zero);

        // A sample that is zero is a root, which the strict test would miss.
        let root = active & value.le(zero) & zero.le(value);
        let isolated = active & test.isolates(&from, &sample, zero);
        let halved = active & bisecting & !root;
        let rest = halved & !isolated & finite;
        let rest = if T::SLOPES { rest & test.isolates(&sample, &to, zero) } else { rest };
        let neither = halved & !isolated & !rest;
        bisections = bisections - zero.select(halved, one, zero);
        let refuted = if T::SLOPES {
            neither & finite & last_refuting.le(bisections) & gradients.le(samples)
        } else {
            0
        };
        // Half of the bracket without a finite value, or a refutation that comes too late: the bracket
        // stays.
        let mut done = root | neither;
        done |= (halved | isolated) & bisections.le(zero);
        done &= !refuted;
        let marching = active & !bisecting & !root & !isolated | refuted;
        bisections = all.select(refuted, all, bisections);
        found = (found | root | isolated) & !refuted;
        bisecting = (bisecting | isolated) & !refuted;

        // Up to here there is no root.
        from = sample.select(root | marching | rest, from);
        // A refuted bracket is passed as a whole.
        from = to.select(refuted, from);
        to = sample.select(root | isolated, to);
        done |= marching & length.le(from.s);
        active &= !done;

        let marching = marching & active;
        if marching == 0 {
            continue;
        }
        let size = from.value.abs();
        let near = marching & size.le(tau1);
        let mut step = base;
        if settings.distance_adaptation == Adaptation::On {
            let far = tau2.lt(size);
            step = step.select(near, half * base, step.select(far, base + base, base));
        }
        if settings.silhouette_adaptation == Adaptation::On && near != 0 {
            let slope = if T::SLOPES {
                from.slope
            } else {
                gradients = gradients + zero.select(near, one, zero);
                let [_, slope] = function.expansion(&lines, from.s);
                slope
            };
            step = step.select(near & slope.abs().le(tau3), half * step, step);
        }
        to.s = to.s.select(marching, (from.s + step).min(length), to.s);
    }
    for (lane, (ray, segment)) in packet.iter().enumerate() {
        let number = |x: R| x.lane(lane).to_f64();
        let work = Work {
            points: number(points) as u64,
            gradients: number(gradients) as u64,
            nonfinite: number(nonfinite) as u64,
            ..Work::default()
        };
        let hit = if found >> lane & 1 == 1 {
            let bracket = [from.s, to.s].map(|s| segment.t(number(s)));
            Hit { bracket, certificate: Certificate::HIT, work }
        } else {
            Hit::miss(Certificate::MISS, work)
        };
        hits.push((*ray, hit));
    }
}

/// Numbers of the segments, one a lane; lanes without a segment repeat the last one.
#[inline(always)]
fn columns<R: Packet, const N: usize>(
    zero: R,
    packet: &[(usize, Segment)],
    numbers: impl Fn(&Segment) -> [f32; N],
) -> [R; N] {
    std::array::from_fn(
        #[inline(always)]
        |n| {
            zero.from_fn(
                #[inline(always)]
                |lane| {
                    let (_, segment) = &packet[lane.min(packet.len() - 1)];
                    R::Scalar::from_f64(f64::from(numbers(segment)[n]))
                },
            )
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(s: f32, value: f32, slope: f32) -> Sample<f32> {
        Sample { s, value, slope, finite: u64::from(value.is_finite()) }
    }

    /// Is there a root by the test, and by the same test with the function's sign changed?
    fn isolates(test: impl Test, from: [f32; 3], to: [f32; 3]) -> bool {
        let [from, to] = [from, to].map(|[s, value, slope]| sample(s, value, slope));
        let negative = |x: Sample<f32>| sample(x.s, -x.value, -x.slope);
        let answers = [[from, to], [negative(from), negative(to)]]
            .map(|[from, to]| test.isolates(&from, &to, 0.0_f32) == 1);
        assert_eq!(answers[0], answers[1]);
        answers[0]
    }

    #[test]
    fn the_sign_test_looks_at_signs() {
        assert!(isolates(Sign, [0.0, 1e-30, 0.0], [1.0, -1e-30, 0.0]));
        assert!(!isolates(Sign, [0.0, 1.0, -9.0], [1.0, 1.0, 9.0]));
        assert!(!isolates(Sign, [0.0, f32::INFINITY, 0.0], [1.0, -1.0, 0.0]));
        assert!(!isolates(Sign, [0.0, f32::NAN, 0.0], [1.0, -1.0, 0.0]));
    }

    #[test]
    fn the_taylor_test_is_equation_3() {
        // q = 1 - 2 * 0.5 = 0 is enough, a little more is not; the same for r.
        assert!(isolates(Taylor, [3.0, 1.0, -2.0], [4.0, 1.0, 0.0]));
        assert!(!isolates(Taylor, [3.0, 1.0, -1.99], [4.0, 1.0, 0.0]));
        assert!(isolates(Taylor, [3.0, 1.0, 0.0], [4.0, 1.0, 2.0]));
        assert!(!isolates(Taylor, [3.0, 1.0, 0.0], [4.0, 1.0, 1.99]));
        // Slopes away from the middle do not count, nor those of a shorter step.
        assert!(!isolates(Taylor, [3.0, 1.0, 9.0], [4.0, 1.0, -9.0]));
        assert!(!isolates(Taylor, [3.0, 1.0, -2.0], [3.5, 1.0, 2.0]));
        // Opposite signs do, whatever the slopes.
        for slope in [0.0, -3.0, f32::NAN, f32::INFINITY] {
            assert!(isolates(Taylor, [3.0, 1.0, slope], [4.0, -1.0, slope]));
        }
        // Slopes that are no numbers tell nothing; values that are not finite are no ends.
        assert!(!isolates(Taylor, [3.0, 1.0, f32::NAN], [4.0, 1.0, f32::NAN]));
        assert!(!isolates(Taylor, [3.0, f32::INFINITY, 0.0], [4.0, -1.0, 0.0]));
        assert!(!isolates(Taylor, [3.0, 1.0, 0.0], [4.0, f32::NAN, 0.0]));
    }
}
