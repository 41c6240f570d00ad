//! Test vectors for interval operations: reading them, and judging the crate by them.
//!
//! Two forms are read, by the names in the header:
//! - `op, k0, a0, b0, d0, .., ok0, oa0, ob0, od0`: intervals (`iv`), integers (`int`) and decorations,
//!   with the tightest result in double precision;
//! - `op, a0, b0, .., n, lo32, hi32`: the tightest result in single precision; n is an exponent.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use zeroset_ia::{
    Binary, Decorated, Decoration, Interval, Isa, Kernel, Number, Packet, Real, Rounding, Scalar,
    Set, Unary, dispatch,
};

/// An interval in double precision; `None` is empty.
type Bounds = Option<[f64; 2]>;

/// One expectation.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// File and line.
    place: String,
    /// The operation's name.
    pub(crate) op: String,
    inputs: Vec<(Bounds, Decoration)>,
    exponent: Option<i32>,
    expected: Bounds,
    /// The strongest decoration that is true.
    decoration: Decoration,
    /// Is every input exactly a single-precision number?
    is_single: bool,
    /// Is `expected` rounded to single precision?
    is_rounded: bool,
    /// Why the row cannot be run.
    unusable: Option<String>,
}

/// Reads all rows of a file.
///
/// # Errors
/// If the file cannot be read, or a line is not in one of the two forms.
pub(crate) fn read(file: &Path) -> Result<Vec<Row>, String> {
    let fault = |e: csv::Error| format!("{}: {e}", file.display());
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(file).map_err(fault)?;
    let header = reader.headers().map_err(fault)?.clone();
    let columns: HashMap<&str, usize> = header.iter().enumerate().map(|(i, n)| (n, i)).collect();
    if !columns.contains_key("op") || !columns.contains_key("a0") {
        return Err(format!("{}: the header has no columns op and a0", file.display()));
    }
    let mut rows = Vec::new();
    for (number, record) in reader.records().enumerate() {
        let record = record.map_err(fault)?;
        let get = |name: &str| {
            columns.get(name).and_then(|i| record.get(*i)).map(str::trim).filter(|x| !x.is_empty())
        };
        let place = format!("{}:{}", file.display(), number + 2);
        rows.push(row(&place, get).map_err(|e| format!("{place}: {e}"))?);
    }
    Ok(rows)
}

fn row<'a>(place: &str, get: impl Fn(&str) -> Option<&'a str>) -> Result<Row, String> {
    let op = get("op").ok_or("no operation")?.to_string();
    let is_rounded = get("lo32").is_some();
    let mut unusable = None;
    let mut inputs = Vec::new();
    let mut exponent = get("n").map(|n| n.parse().map_err(|_| format!("n = {n}"))).transpose()?;
    for i in 0..3 {
        let Some(a) = get(&format!("a{i}")) else { break };
        match get(&format!("k{i}")).unwrap_or("iv") {
            "int" => match a.parse() {
                Ok(n) => exponent = Some(n),
                Err(_) => unusable = Some(format!("exponent {a}")),
            },
            "iv" if a == "nai" => unusable = Some("NaI".into()),
            "iv" => {
                let bounds = interval(a, get(&format!("b{i}")).unwrap_or(a))?;
                match decoration(get(&format!("d{i}")).unwrap_or("com")) {
                    Some(decoration) => inputs.push((bounds, decoration)),
                    None => unusable = Some("NaI".into()),
                }
            }
            kind => unusable = Some(format!("input of kind {kind}")),
        }
    }
    let [lo, hi] = if is_rounded { ["lo32", "hi32"] } else { ["oa0", "ob0"] };
    let (mut expected, mut strongest) = (None, Decoration::Continuous);
    match get("ok0").unwrap_or("iv") {
        "iv" if get(lo) == Some("nai") => unusable = Some("NaI".into()),
        "iv" => {
            let lo = get(lo).ok_or("no result")?;
            expected = interval(lo, get(hi).unwrap_or(lo))?;
            match decoration(get("od0").unwrap_or("com")) {
                Some(decoration) => strongest = decoration,
                None => unusable = Some("NaI".into()),
            }
        }
        kind => unusable = Some(format!("result of kind {kind}")),
    }
    let fits = |x: f64| f64::from(x as f32).to_bits() == x.to_bits();
    let is_single =
        inputs.iter().filter_map(|(bounds, _)| *bounds).flatten().all(fits) || is_rounded;
    Ok(Row {
        place: place.into(),
        op,
        inputs,
        exponent,
        expected,
        decoration: strongest,
        is_single,
        is_rounded,
        unusable,
    })
}

/// `None` for "ill", the decoration of what is no interval.
fn decoration(text: &str) -> Option<Decoration> {
    match text {
        "com" | "dac" => Some(Decoration::Continuous),
        "def" => Some(Decoration::Defined),
        "trv" => Some(Decoration::Trivial),
        _ => None,
    }
}

fn interval(lo: &str, hi: &str) -> Result<Bounds, String> {
    if lo == "empty" {
        return Ok(None);
    }
    Ok(Some([number(lo)?, number(hi)?]))
}

/// A decimal number or a hexadecimal one, `-0x1.8p-3`.
fn number(text: &str) -> Result<f64, String> {
    let fault = || format!("{text:?} is no number");
    let (sign, rest) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text),
    };
    let Some(rest) = rest.strip_prefix("0x") else { return text.parse().map_err(|_| fault()) };
    let (mantissa, exponent) = rest.split_once('p').ok_or_else(fault)?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).map_err(|_| fault())?;
    let exponent: i32 = exponent.parse().map_err(|_| fault())?;
    // In two steps, so that subnormal numbers do not vanish on the way.
    let shift = exponent - 4 * fraction.len() as i32;
    Ok(sign * digits as f64 * 2.0_f64.powi(shift / 2) * 2.0_f64.powi(shift - shift / 2))
}

/// A number that is a set.
trait Sets: Number {
    fn intersection(self, other: Self) -> Self;
    fn hull(self, other: Self) -> Self;
}

impl<R: Real> Sets for Interval<R, Set> {
    #[inline(always)]
    fn intersection(self, other: Self) -> Self {
        Interval::intersection(self, other)
    }
    #[inline(always)]
    fn hull(self, other: Self) -> Self {
        Interval::hull(self, other)
    }
}

/// As the standard has it: no function is known to have the result as its range.
impl<S: Scalar> Sets for Decorated<S> {
    fn intersection(self, other: Self) -> Self {
        let interval = self.interval.intersection(other.interval);
        Self { interval, decoration: Decoration::Trivial }
    }
    fn hull(self, other: Self) -> Self {
        let interval = self.interval.hull(other.interval);
        Self { interval, decoration: Decoration::Trivial }
    }
}

/// The operation on any number; `None` if there is no such operation.
#[inline(always)]
fn apply<N: Sets>(op: &str, x: &[N], exponent: Option<i32>, one: N) -> Option<N> {
    let result = match (op, x) {
        ("intersection", [x, y]) => x.clone().intersection(y.clone()),
        ("convexHull", [x, y]) => x.clone().hull(y.clone()),
        ("neg", [x]) => -x.clone(),
        ("recip", [x]) => one / x.clone(),
        ("sqr", [x]) => x.clone().sqr(),
        ("pown", [x]) => x.clone().powi(exponent?),
        ("add", [x, y]) => x.clone() + y.clone(),
        ("sub", [x, y]) => x.clone() - y.clone(),
        ("mul", [x, y]) => x.clone() * y.clone(),
        ("div", [x, y]) => x.clone() / y.clone(),
        (name, [x]) => x.clone().unary(Unary::from_name(name)?),
        (name, [x, y]) => x.clone().binary(Binary::from_name(name)?, y.clone()),
        _ => return None,
    };
    Some(result)
}

/// What a row is run on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arithmetic {
    /// Double precision, with decorations.
    Double,
    /// Single precision, with decorations.
    Single,
    /// Lanes of single precision.
    Lanes(Isa, Rounding),
}

impl Arithmetic {
    /// All of this machine.
    pub(crate) fn all() -> Vec<Self> {
        let lanes = Isa::available()
            .into_iter()
            .flat_map(|isa| [Rounding::Outward, Rounding::Nudged].map(|r| Self::Lanes(isa, r)));
        [Self::Double, Self::Single].into_iter().chain(lanes).collect()
    }
}

impl fmt::Display for Arithmetic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Double => f.pad("f64"),
            Self::Single => f.pad("f32"),
            Self::Lanes(isa, rounding) => {
                f.pad(&format!("{} {rounding:?}", isa.name()).to_lowercase())
            }
        }
    }
}

/// What came of a row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outcome {
    /// It cannot be run; why.
    Skipped(String),
    /// The result does not hold the expectation, or a decoration claims too much; how.
    Violation(String),
    /// Sound. The greater distance of an end from the tightest one in units in the last place, where the
    /// tightest one is known; infinite if the end is.
    Sound(Option<f64>),
}

impl Row {
    /// Runs the row.
    pub(crate) fn run(&self, arithmetic: Arithmetic) -> Outcome {
        if let Some(why) = &self.unusable {
            return Outcome::Skipped(why.clone());
        }
        let results = match arithmetic {
            Arithmetic::Double if self.is_rounded => {
                return Outcome::Skipped("rounded to f32".into());
            }
            Arithmetic::Double => self.scalar::<f64>(),
            Arithmetic::Single => self.scalar::<f32>(),
            Arithmetic::Lanes(isa, rounding) => dispatch(isa, rounding, InLanes(self))
                .map(|bounds| vec![(bounds, Decoration::Trivial)]),
        };
        let Some(results) = results else {
            return Outcome::Skipped(format!("no operation {}", self.op));
        };
        let mut outcome = Outcome::Skipped("no result".into());
        for (bounds, decoration) in results {
            outcome = self.judge(bounds, decoration, arithmetic == Arithmetic::Double);
            if matches!(outcome, Outcome::Violation(_)) {
                break;
            }
        }
        outcome
    }

    fn judge(&self, bounds: Bounds, decoration: Decoration, is_double: bool) -> Outcome {
        let holds = match (bounds, self.expected) {
            (_, None) => true,
            (None, Some(_)) => false,
            (Some([lo, hi]), Some([a, b])) => lo <= a && b <= hi,
        };
        if !holds || decoration > self.decoration {
            return Outcome::Violation(format!(
                "{}: {} of {:?} {:?} is {:?} {:?}; got {bounds:?} {decoration:?}",
                self.place, self.op, self.inputs, self.exponent, self.expected, self.decoration
            ));
        }
        let (Some([lo, hi]), Some([a, b])) = (bounds, self.expected) else {
            // Empty, and so both; or not empty where it could be: as loose as can be, unless it was made
            // so when the input was rounded.
            let slack = if bounds.is_some() { f64::INFINITY } else { 0.0 };
            return Outcome::Sound((is_double || self.is_single).then_some(slack));
        };
        let slack = if is_double {
            Some(steps::<f64>(lo, a).max(steps::<f64>(b, hi)))
        } else if self.is_single {
            let [a, b] = f32::enclose_range(a, b).map(f64::from);
            Some(steps::<f32>(lo, a).max(steps::<f32>(b, hi)))
        } else {
            None
        };
        Outcome::Sound(slack)
    }

    /// The result in decorated intervals, and the one in plain intervals, of which the slack is reported.
    fn scalar<S: Scalar>(&self) -> Option<Vec<(Bounds, Decoration)>> {
        let x: Vec<_> = self.inputs.iter().map(|(bounds, _)| enclosed::<S>(*bounds)).collect();
        let decorated: Vec<_> = (x.iter().zip(&self.inputs))
            .map(|(&interval, (_, decoration))| {
                let decoration = Decorated::new(interval).decoration.min(*decoration);
                Decorated { interval, decoration }
            })
            .collect();
        let one = Interval::point(S::from_f64(1.0));
        let plain = apply(&self.op, &x, self.exponent, one)?;
        let Decorated { interval, decoration } =
            apply(&self.op, &decorated, self.exponent, Decorated::new(one))?;
        Some(vec![(bounds(interval), decoration), (bounds(plain), Decoration::Trivial)])
    }
}

/// A row in every lane, without decorations.
struct InLanes<'a>(&'a Row);

impl Kernel for InLanes<'_> {
    type Output = Option<Bounds>;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        let in_lanes = |[lo, hi]: [f64; 2]| {
            let [lo, hi] = [lo, hi].map(|x| zero.splat(R::Scalar::from_f64(x)));
            Interval::<R, Set>::new(lo, hi)
        };
        let x: Vec<_> = self
            .0
            .inputs
            .iter()
            .map(|(bounds, _)| in_lanes(enclosed::<f32>(*bounds).bounds().map(f64::from)))
            .collect();
        let result = apply(&self.0.op, &x, self.0.exponent, in_lanes([1.0, 1.0]))?;
        let lane = |i| Interval::new(result.lo.lane(i), result.hi.lane(i));
        let first = bounds::<R::Scalar>(lane(0));
        assert!((1..R::LANES).all(|i| bounds(lane(i)) == first), "lanes differ");
        Some(first)
    }
}

/// Rounded outward to the scalar type.
fn enclosed<S: Scalar>(bounds: Bounds) -> Interval<S, Set> {
    let [lo, hi] = match bounds {
        Some([lo, hi]) => S::enclose_range(lo, hi),
        None => [S::NAN, S::NAN],
    };
    Interval::new(lo, hi)
}

fn bounds<S: Scalar>(x: Interval<S, Set>) -> Bounds {
    (!x.is_empty()).then(|| x.bounds().map(S::to_f64))
}

/// How many numbers of the scalar type lie from `a` up to `b`; infinite where only one of them is.
fn steps<S: Scalar>(a: f64, b: f64) -> f64 {
    let order = |x: f64| {
        let (bits, sign) = if size_of::<S>() == 4 {
            (i128::from((x as f32).to_bits() & 0x7fff_ffff), x.is_sign_negative())
        } else {
            (i128::from(x.to_bits() & (u64::MAX >> 1)), x.is_sign_negative())
        };
        if sign { -bits } else { bits }
    };
    let steps = (order(b) - order(a)) as f64;
    // The largest number and infinity are neighbours.
    if a.is_infinite() != b.is_infinite() && steps > 1.0 { f64::INFINITY } else { steps }
}

/// The rows of an operation on one arithmetic.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    /// All rows.
    pub(crate) rows: usize,
    /// Rows that were run.
    pub(crate) run: usize,
    /// Why the others were not, and how many.
    pub(crate) skipped: std::collections::BTreeMap<String, usize>,
    /// What was wrong.
    pub(crate) violations: Vec<String>,
    /// Results of which an end is infinite, or which are not empty, without need.
    pub(crate) unbounded: usize,
    slacks: Vec<f64>,
}

impl Tally {
    /// Runs rows.
    pub(crate) fn of<'a>(rows: impl IntoIterator<Item = &'a Row>, arithmetic: Arithmetic) -> Self {
        let mut tally = Self::default();
        for row in rows {
            tally.rows += 1;
            match row.run(arithmetic) {
                Outcome::Skipped(why) => *tally.skipped.entry(why).or_default() += 1,
                Outcome::Violation(how) => {
                    tally.run += 1;
                    tally.violations.push(how);
                }
                Outcome::Sound(slack) => {
                    tally.run += 1;
                    match slack {
                        Some(f64::INFINITY) => tally.unbounded += 1,
                        Some(steps) => tally.slacks.push(steps),
                        None => {}
                    }
                }
            }
        }
        tally
    }

    /// Mean slack in units in the last place.
    pub(crate) fn mean(&self) -> f64 {
        self.slacks.iter().sum::<f64>() / self.slacks.len().max(1) as f64
    }

    /// Worst slack in units in the last place.
    pub(crate) fn worst(&self) -> f64 {
        self.slacks.iter().copied().fold(0.0, f64::max)
    }
}
