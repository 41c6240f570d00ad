//! The errors of the functions of one `f32`, over all of them.
//!
//! For each float x the value y of [`Scalar::elementary`] is compared with two double-precision
//! libraries that share no code, `metallic` and the standard library (that of the system), and each
//! must find y within the bound less a margin of 2^-44 of the value, 512 of its units in the last place in
//! double precision. Where one does not, [`BigInterval`] decides. So the proof rests on this: at no float
//! do both libraries err by more than 2^-44, to the same side; or, where they were not trusted, on
//! `astro-float`. A bound below 1 proves that the neighbours of y enclose the exact value.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use zeroset_ia::{BigInterval, Number, Scalar, Unary};

use crate::exact::{Settled, Side, neighbour, settle};
use crate::request::Request;

/// The bound claimed for a function, in units in the last place.
fn bound(f: Unary) -> f64 {
    match f {
        // Computed in double precision.
        Unary::Exp | Unary::Log | Unary::Sin | Unary::Cos => 0.51,
        // Correctly rounded.
        _ => 0.5,
    }
}

/// The factor c, if `f(-x) = c f(x)`: then -x needs no proof of its own.
fn symmetry(f: Unary) -> Option<f32> {
    match f {
        Unary::Cos | Unary::Cosh => Some(1.0),
        Unary::Cbrt | Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan => Some(-1.0),
        Unary::Sinh | Unary::Tanh | Unary::Asinh | Unary::Atanh => Some(-1.0),
        _ => None,
    }
}

/// The functions that need a proof; the others are exact.
fn functions() -> impl Iterator<Item = Unary> {
    let exact = [Unary::Abs, Unary::Sign, Unary::Floor, Unary::Ceil];
    Unary::ALL.iter().copied().filter(move |f| !exact.contains(f))
}

/// The function by the system's library; where that has none, or one that loses digits, by formulas that
/// lose a few units.
fn system(f: Unary, x: f64) -> f64 {
    match f {
        Unary::Sqrt => x.sqrt(),
        Unary::Cbrt => x.cbrt(),
        Unary::Exp => x.exp(),
        Unary::Exp2 => x.exp2(),
        Unary::Exp10 => 10.0_f64.powf(x),
        Unary::Expm1 => x.exp_m1(),
        Unary::Log => x.ln(),
        Unary::Log2 => x.log2(),
        Unary::Log10 => x.log10(),
        Unary::Logp1 => x.ln_1p(),
        Unary::Sin => x.sin(),
        Unary::Cos => x.cos(),
        Unary::Tan => x.tan(),
        Unary::Asin => x.asin(),
        Unary::Acos => x.acos(),
        Unary::Atan => x.atan(),
        Unary::Sinh => x.sinh(),
        Unary::Cosh => x.cosh(),
        Unary::Tanh => x.tanh(),
        Unary::Asinh => {
            let a = x.abs();
            // Squares of floats neither overflow nor lose their digits.
            let sum = if a < f64::INFINITY { a + a * a / (1.0 + (a * a + 1.0).sqrt()) } else { a };
            sum.ln_1p().copysign(x)
        }
        Unary::Acosh if x < 1.0 => f64::NAN,
        Unary::Acosh => ((x - 1.0) + ((x - 1.0) * (x + 1.0)).sqrt()).ln_1p(),
        Unary::Atanh => 0.5 * (2.0 * x / (1.0 - x)).ln_1p(),
        Unary::Abs | Unary::Sign | Unary::Floor | Unary::Ceil => x.elementary(f),
    }
}

/// What was found over a range of floats.
#[derive(Clone, Debug, Default)]
struct Finding {
    inputs: u64,
    /// In units in the last place, and where.
    worst: (f64, f32),
    settled: u64,
    broken: Vec<f32>,
}

impl Finding {
    fn add(&mut self, other: Self) {
        self.inputs += other.inputs;
        self.settled += other.settled;
        self.broken.extend(other.broken);
        if other.worst.0 > self.worst.0 {
            self.worst = other.worst;
        }
    }

    fn see(&mut self, error: f64, x: f32) {
        if error > self.worst.0 {
            self.worst = (error, x);
        }
    }
}

/// The distance of y from the value in units in the last place, and the margin in the same; an infinite
/// y stands for 2^128.
#[inline(always)]
fn distance(y: f32, value: f64) -> [f64; 2] {
    const MARGIN: f64 = 1.0 / (1_u64 << 44) as f64;
    const OVERFLOW: f64 = 2.0 * (1_u128 << 127) as f64;
    let wide = |y: f32| f64::from(y).clamp(-OVERFLOW, OVERFLOW);
    let value = value.clamp(-OVERFLOW, OVERFLOW);
    let difference = value - wide(y);
    if difference == 0.0 {
        return [0.0, 0.0];
    }
    let side = if difference < 0.0 { Side::Below } else { Side::Above };
    let gap = (wide(neighbour(y, side)) - wide(y)).abs();
    [difference.abs() / gap, value.abs() * MARGIN / gap]
}

/// Do both libraries put y within the bound beyond doubt? And the larger error that they see.
#[inline(always)]
fn agree(y: f32, values: [f64; 2], bound: f64) -> (bool, f64) {
    let [[a, margin_a], [b, margin_b]] = values.map(|value| distance(y, value));
    (a + margin_a <= bound && b + margin_b <= bound, a.max(b))
}

/// Goes over the floats with bits from `first` up to `end`.
fn range(f: Unary, first: u64, end: u64, stride: u32) -> Finding {
    let (bound, symmetry) = (bound(f), symmetry(f));
    let mut finding = Finding::default();
    for bits in (first..end).step_by(stride as usize) {
        let x = f32::from_bits(bits as u32);
        finding.inputs += 1;
        let y = x.elementary(f);
        if symmetry.is_some_and(|c| x < 0.0 && y == c * (-x).elementary(f)) {
            // As far from the value as its mirror image.
            continue;
        }
        let wide = f64::from(x);
        let values = [wide.elementary(f), system(f, wide)];
        if y.is_nan() && values[0].is_nan() && values[1].is_nan() {
            continue;
        }
        let (holds, error) = agree(y, values, bound);
        if holds {
            finding.see(error, x);
            continue;
        }
        finding.settled += 1;
        let exact = |precision| BigInterval::from_f64(wide, precision).unary(f);
        match settle(y, bound, exact) {
            Settled::Within(error) => finding.see(error, x),
            Settled::Beyond(_) | Settled::Open => finding.broken.push(x),
        }
    }
    finding
}

/// Goes over all floats of a function, in blocks that the threads take in turn.
fn exhaust(f: Unary, request: &Request) -> Finding {
    const BLOCK: u64 = 1 << 24;
    const END: u64 = 1 << 32;
    let next = AtomicU64::new(0);
    let work = || {
        let mut finding = Finding::default();
        loop {
            let block = next.fetch_add(1, Ordering::Relaxed);
            // The stride goes on across blocks.
            let stride = u64::from(request.stride);
            let first = (block * BLOCK).next_multiple_of(stride);
            if block * BLOCK >= END {
                return finding;
            }
            finding.add(range(f, first, (block + 1) * BLOCK, request.stride));
            if std::io::stderr().is_terminal() {
                eprint!("\r{f}: {:3} of 256 ", block + 1);
            }
        }
    };
    let mut all = Finding::default();
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..request.threads).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            all.add(worker.join().expect("a worker does not panic"));
        }
    });
    all
}

/// Runs the functions that were named, or all; true if each bound holds.
pub(crate) fn run(request: &Request) -> Result<bool, String> {
    let names = &request.functions;
    for name in names {
        if !functions().any(|f| f.name() == name) {
            let all: Vec<_> = functions().map(Unary::name).collect();
            return Err(format!("{name} is none of the functions: {}", all.join(" ")));
        }
    }
    println!(
        "| function | inputs | bound (ulp) | worst (ulp) | at | settled by big arithmetic | seconds |"
    );
    println!("|---|---:|---:|---:|---|---:|---:|");
    let mut all_hold = true;
    for f in functions().filter(|f| names.is_empty() || names.iter().any(|n| n == f.name())) {
        let start = Instant::now();
        let finding = exhaust(f, request);
        println!("{}", line(f, &finding, start.elapsed().as_secs_f64()));
        for x in finding.broken.iter().take(20) {
            println!("{f}({x:e}) = {:e} breaks the bound", x.elementary(f));
        }
        all_hold &= finding.broken.is_empty();
    }
    Ok(all_hold)
}

fn line(f: Unary, finding: &Finding, seconds: f64) -> String {
    let Finding { inputs, worst: (worst, x), settled, .. } = finding;
    format!("| {f} | {inputs} | {} | {worst:.7} | {x:e} | {settled} | {seconds:.1} |", bound(f))
}
