//! Exact constants, as every number takes them.

use std::borrow::Cow;
use std::sync::LazyLock;

use crate::{BigInterval, Number, Scalar, Unary};

/// A real constant, known as tightly as any number type can use it.
///
/// A constant that a type holds exactly is a point of that type: 2 is a point, 0.1 an interval one
/// unit in the last place wide.
#[derive(Clone, Debug)]
pub struct Constant {
    /// The tightest enclosure in double precision.
    pub f64: [f64; 2],
    /// The tightest enclosure in single precision.
    pub f32: [f32; 2],
    /// The nearest double.
    pub nearest_f64: f64,
    /// The nearest float.
    pub nearest_f32: f32,
    /// An enclosure at the precision it was made with.
    pub big: BigInterval,
}

impl Constant {
    /// The constant that `big` encloses.
    pub fn new(big: BigInterval) -> Self {
        let f64 = big.to_f64();
        let f32 = f32::enclose_range(f64[0], f64[1]);
        let nearest_f64 = if f64[0] == f64[1] { f64[0] } else { big.nearest() };
        // Rounding the nearest double again would break ties the wrong way.
        let halfway = (f64::from(f32[0]) + f64::from(f32[1])) / 2.0;
        let nearest_f32 = if f64[0] == f64[1] || !halfway.is_finite() {
            nearest_f64 as f32
        } else {
            f32[usize::from(halfway <= f64[0])]
        };
        Self { f64, f32, nearest_f64, nearest_f32, big }
    }

    /// The exact value of a double.
    pub fn from_f64(x: f64) -> Self {
        Self::new(BigInterval::from_f64(x, 128))
    }
}

impl Constant {
    /// An integer.
    pub fn integer(n: i32) -> Self {
        Self::shared_integer(n).into_owned()
    }

    /// An integer, without a copy if it is small: for exponents in inner loops.
    pub fn shared_integer(n: i32) -> Cow<'static, Self> {
        static SMALL: LazyLock<Vec<Constant>> = LazyLock::new(|| {
            (-LARGEST_SHARED..=LARGEST_SHARED).map(|n| Constant::from_f64(f64::from(n))).collect()
        });
        match SMALL.get((i64::from(n) + i64::from(LARGEST_SHARED)) as usize) {
            Some(c) => Cow::Borrowed(c),
            None => Cow::Owned(Self::from_f64(f64::from(n))),
        }
    }

    /// The constant less 1, at the same precision.
    pub fn minus_one(&self) -> Self {
        let one = BigInterval::from_f64(1.0, self.big.precision());
        Self::new(self.big.clone() - one)
    }
}

macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub static $name: LazyLock<Constant> = LazyLock::new(|| $value);)*
    };
}

/// The largest integer that is made only once.
const LARGEST_SHARED: i32 = 64;

/// The precision of the constants below, in bits.
const PRECISION: usize = 1088;

constants! {
    /// 0.
    ZERO = Constant::from_f64(0.0);
    /// 1/2.
    HALF = Constant::from_f64(0.5);
    /// 1.
    ONE = Constant::from_f64(1.0);
    /// 2.
    TWO = Constant::from_f64(2.0);
    /// 3.
    THREE = Constant::from_f64(3.0);
    /// -1.
    MINUS_ONE = Constant::from_f64(-1.0);
    /// log(2).
    LN_2 = Constant::new(BigInterval::from_f64(2.0, PRECISION).unary(Unary::Log));
    /// log(10).
    LN_10 = Constant::new(BigInterval::from_f64(10.0, PRECISION).unary(Unary::Log));
}
