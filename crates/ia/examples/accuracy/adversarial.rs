//! The errors of the functions of `f64`, and of those of two arguments, at points chosen to be hard
//! (`points.rs`); all are compared with `astro-float`.

use std::time::Instant;

use zeroset_ia::{BigInterval, Binary, Number, Scalar, Unary};

use crate::exact::{Settled, settle};
use crate::points::{Random, argument};
use crate::request::Request;

/// A function as it is called here.
#[derive(Clone, Copy)]
enum Function {
    One(Unary),
    Two(Binary),
    Power,
}

impl Function {
    /// Those that are not exact.
    fn all() -> impl Iterator<Item = Self> {
        let exact = [Unary::Abs, Unary::Sign, Unary::Floor, Unary::Ceil];
        let one = Unary::ALL.iter().copied().filter(move |f| !exact.contains(f)).map(Self::One);
        let two = [Binary::Pow, Binary::Atan2, Binary::Hypot].map(Self::Two);
        one.chain(two).chain([Self::Power])
    }

    fn name(self) -> &'static str {
        match self {
            Self::One(f) => f.name(),
            Self::Two(f) => f.name(),
            Self::Power => "pown",
        }
    }

    /// Compares the function with the exact one at a random point; also says where that is.
    fn try_one<S: Scalar>(self, random: &mut Random) -> (Settled, String) {
        let bound = bound::<S>();
        let big = |x: S, precision| BigInterval::from_f64(x.to_f64(), precision);
        let x: S = argument(random);
        match self {
            Self::One(f) => {
                let y = x.elementary(f);
                (settle(y, bound, |p| big(x, p).unary(f)), format!("{:e}", x.to_f64()))
            }
            Self::Two(f) => {
                // Without zeros, of which the signs tell the sides of the cut; powers are of positive
                // numbers.
                let zero = S::from_f64(0.0);
                let x = if x == zero { S::from_f64(1.0) } else { x };
                let x = if f == Binary::Pow { x.abs() } else { x };
                let mut y: S = argument(random);
                if f == Binary::Pow && random.below(2) == 0 {
                    // An exponent for which the power is in range.
                    let log = x.elementary(Unary::Log2).to_f64();
                    let range = if size_of::<S>() == 4 { 150.0 } else { 1080.0 };
                    y = S::from_f64(
                        range * (2.0 * random.unit() - 1.0) / if log == 0.0 { 1.0 } else { log },
                    );
                } else if f == Binary::Pow && random.below(4) == 0 {
                    y = S::from_f64(random.pick(&[2.0, 3.0, 0.5, -1.0, 1.5, 0.25]));
                }
                let y = y + zero;
                let value = x.elementary2(f, y);
                let exact = |p| big(x, p).binary(f, big(y, p));
                (settle(value, bound, exact), format!("{:e}, {:e}", x.to_f64(), y.to_f64()))
            }
            Self::Power => {
                let largest = 1 << (1 + random.below(12));
                let n = random.below(largest) as i32 + 2;
                let n = if random.below(2) == 0 { n } else { -n };
                let y = x.power(n);
                (settle(y, bound, |p| big(x, p).powi(n)), format!("{:e}, {n}", x.to_f64()))
            }
        }
    }
}

/// What is claimed, in units in the last place.
fn bound<S: Scalar>() -> f64 {
    if size_of::<S>() == 4 { 0.51 } else { 1.0 }
}

/// What was found on some points.
#[derive(Default)]
struct Finding {
    points: usize,
    worst: (f64, String),
    broken: Vec<String>,
}

impl Finding {
    fn of<S: Scalar>(f: Function, points: usize, seed: u64) -> Self {
        let mut random = Random(seed);
        let mut finding = Self { points, ..Self::default() };
        for _ in 0..points {
            let (settled, place) = f.try_one::<S>(&mut random);
            match settled {
                Settled::Within(error) if error > finding.worst.0 => finding.worst = (error, place),
                Settled::Within(_) => {}
                Settled::Beyond(error) => finding.broken.push(format!("({place}) by {error}")),
                Settled::Open => finding.broken.push(format!("({place}), perhaps")),
            }
        }
        finding
    }

    /// The same in threads.
    fn on_threads<S: Scalar>(f: Function, request: &Request) -> Self {
        let mut all = Self::default();
        std::thread::scope(|scope| {
            let share = request.points.div_ceil(request.threads);
            let workers: Vec<_> = (0..request.threads)
                .map(|i| scope.spawn(move || Self::of::<S>(f, share, i as u64)))
                .collect();
            for worker in workers {
                let finding = worker.join().expect("a worker does not panic");
                all.points += finding.points;
                all.broken.extend(finding.broken);
                if finding.worst.0 > all.worst.0 {
                    all.worst = finding.worst;
                }
            }
        });
        all
    }
}

/// Runs the functions that were named, or all; true if each bound holds.
pub(crate) fn run(request: &Request) -> Result<bool, String> {
    let names = &request.functions;
    for name in names {
        if !Function::all().any(|f| f.name() == name) {
            let all: Vec<_> = Function::all().map(Function::name).collect();
            return Err(format!("{name} is none of the functions: {}", all.join(" ")));
        }
    }
    println!("| function | type | points | bound (ulp) | worst (ulp) | at | seconds |");
    println!("|---|---|---:|---:|---:|---|---:|");
    let mut all_hold = true;
    for f in Function::all().filter(|f| names.is_empty() || names.iter().any(|n| n == f.name())) {
        all_hold &= report::<f64>(f, "f64", request);
        if !matches!(f, Function::One(_)) {
            all_hold &= report::<f32>(f, "f32", request);
        }
    }
    Ok(all_hold)
}

fn report<S: Scalar>(f: Function, scalar: &str, request: &Request) -> bool {
    let start = Instant::now();
    let Finding { points, worst: (worst, place), broken } = Finding::on_threads::<S>(f, request);
    let (name, bound, seconds) = (f.name(), bound::<S>(), start.elapsed().as_secs_f64());
    println!("| {name} | {scalar} | {points} | {bound} | {worst:.7} | {place} | {seconds:.1} |");
    for place in broken.iter().take(20) {
        println!("{name} of {scalar} breaks the bound at {place}");
    }
    broken.is_empty()
}
