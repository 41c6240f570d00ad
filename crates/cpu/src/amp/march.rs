//! The march: Algorithm 1 of [singh2010] on packets of rays.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::plain::Plain;
use zeroset_ia::{Dual, Kernel, Packet, Pair, Scalar};
use zeroset_raycast::{Certificate, Hit, Ray, Work};

use super::rule::Settings;
use super::{Adaptation, RootTest};

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

/// A value of the function along the rays.
#[derive(Clone, Copy)]
struct Sample<R> {
    s: R,
    value: R,
    /// Where the value is finite.
    finite: u64,
}

impl RootTest {
    /// In which lanes do the steps between two samples hold a root?
    #[inline(always)]
    fn isolates<R: Packet>(self, from: &Sample<R>, to: &Sample<R>, zero: R) -> u64 {
        match self {
            // The signs themselves, since the product of two tiny values would vanish.
            Self::Sign => {
                let (a, b) = (from.value, to.value);
                let opposite = a.lt(zero) & zero.lt(b) | b.lt(zero) & zero.lt(a);
                opposite & from.finite & to.finite
            }
        }
    }
}

/// The march of some rays, given with their indices; gives the answers with them.
pub(super) struct March<'a> {
    pub tape: &'a Tape,
    pub settings: &'a Settings,
    pub segments: &'a [(usize, Segment)],
}

impl Kernel for March<'_> {
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
            march(&mut function, zero, self.settings, packet, &mut hits);
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

    /// F'(s) = grad S . D.
    #[inline(always)]
    fn slope(&mut self, lines: &Lines<R>, s: R) -> R {
        let [x, y, z] = lines.at(s);
        let [u, v, w] = lines.direction;
        let along = [(x, u), (y, v), (z, w)];
        let [x, y, z] = along.map(
            #[inline(always)]
            |(x, u)| Dual { value: Plain(x), tangent: [Plain(u)] },
        );
        self.slopes.evaluate([x, y, z]).tangent[0].0
    }
}

#[inline(always)]
fn splat<R: Packet>(zero: R, x: f64) -> R {
    zero.splat(R::Scalar::from_f64(x))
}

/// Marches one packet, every lane by its own steps.
#[inline(always)]
fn march<R: Packet>(
    function: &mut Function<'_, R>,
    zero: R,
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
    let mut from = Sample { s: zero, value: zero, finite: 0 };
    let mut to = zero;
    let mut active = (1_u64 << packet.len()) - 1;
    let mut bisecting = 0_u64;
    let mut found = 0_u64;
    let mut bisections = splat(zero, f64::from(settings.bisections));
    let [mut points, mut gradients, mut nonfinite] = [zero; 3];
    while active != 0 {
        let s = to.select(bisecting, half * (from.s + to), to);
        let value = function.value(&lines, s) - epsilon;
        let finite = value.abs().lt(infinity);
        let sample = Sample { s, value, finite };
        points = points + zero.select(active, one, zero);
        nonfinite = nonfinite + zero.select(active & !finite, one, zero);

        // A sample that is zero is a root, which the strict test would miss.
        let root = active & value.le(zero) & zero.le(value);
        let isolated = active & settings.test.isolates(&from, &sample, zero);
        let marching = active & !bisecting & !root & !isolated;
        let halved = active & bisecting & !root;
        let mut done = root;
        // Half of the bracket without a finite value: the bracket stays.
        done |= halved & !finite;
        bisections = bisections - zero.select(halved, one, zero);
        done |= (halved | isolated) & bisections.le(zero);
        done |= marching & length.le(s);
        found |= root | isolated;
        bisecting |= isolated;

        // Up to here there is no root.
        let passed = root | marching | halved & finite & !isolated;
        from = Sample {
            s: s.select(passed, s, from.s),
            value: value.select(passed, value, from.value),
            finite: finite & passed | from.finite & !passed,
        };
        to = s.select(root | isolated, s, to);
        active &= !done;

        let marching = marching & active;
        if marching == 0 {
            continue;
        }
        let size = value.abs();
        let near = marching & size.le(tau1);
        let mut step = base;
        if settings.distance_adaptation == Adaptation::On {
            let far = tau2.lt(size);
            step = step.select(near, half * base, step.select(far, base + base, base));
        }
        if settings.silhouette_adaptation == Adaptation::On && near != 0 {
            let slope = function.slope(&lines, s);
            gradients = gradients + zero.select(near, one, zero);
            step = step.select(near & slope.abs().le(tau3), half * step, step);
        }
        to = to.select(marching, (s + step).min(length), to);
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
            let bracket = [from.s, to].map(|s| segment.t(number(s)));
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
