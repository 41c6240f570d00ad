//! What an expression needs of a number.

use std::fmt::{self, Debug, Display};
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Constant;

/// A number over which a function can be evaluated.
///
/// Squares, integer powers, scaling by and adding a constant are operations of their own: an
/// interval is tighter, and a dual cheaper, than the general product would be.
pub trait Number:
    Clone
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The constant `c`, in the context of `self`.
    fn constant(&self, c: &Constant) -> Self;
    /// `c * self`.
    fn scale(self, c: &Constant) -> Self;
    /// `self + c`.
    fn offset(self, c: &Constant) -> Self;
    /// `self^2`.
    fn sqr(self) -> Self;
    /// `self^n`; for `n < 0` the reciprocal power, undefined at 0.
    fn powi(self, n: i32) -> Self;
    /// `self^c` for a real exponent: defined for `self > 0`, and at 0 for `c > 0`.
    fn powc(self, c: &Constant) -> Self;
    /// A function of one argument.
    fn unary(self, f: Unary) -> Self;
    /// A function of two arguments.
    fn binary(self, f: Binary, other: Self) -> Self;
}

macro_rules! functions {
    ($(#[$doc:meta])* $enum:ident { $($(#[$vdoc:meta])* $variant:ident = $name:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $enum { $($(#[$vdoc])* $variant,)* }

        impl $enum {
            /// Every function, in the order of declaration.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name in an equation.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }
            /// The function of that name.
            pub fn from_name(name: &str) -> Option<Self> {
                match name { $($name => Some(Self::$variant),)* _ => None }
            }
        }

        impl Display for $enum {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

functions! {
    /// A function of one argument, on its natural domain.
    Unary {
        /// Square root, on `[0, inf]`.
        Sqrt = "sqrt",
        /// Real cube root.
        Cbrt = "cbrt",
        /// Absolute value.
        Abs = "abs",
        /// -1, 0 or 1; jumps at 0.
        Sign = "sign",
        /// Largest integer at most x; jumps at integers.
        Floor = "floor",
        /// Smallest integer at least x; jumps at integers.
        Ceil = "ceil",
        /// e^x.
        Exp = "exp",
        /// 2^x.
        Exp2 = "exp2",
        /// 10^x.
        Exp10 = "exp10",
        /// e^x - 1.
        Expm1 = "expm1",
        /// Natural logarithm, on `(0, inf]`.
        Log = "log",
        /// Logarithm to base 2.
        Log2 = "log2",
        /// Logarithm to base 10.
        Log10 = "log10",
        /// log(1 + x), on `(-1, inf]`.
        Logp1 = "logp1",
        /// Sine of radians.
        Sin = "sin",
        /// Cosine of radians.
        Cos = "cos",
        /// Tangent; poles at pi/2 + k pi.
        Tan = "tan",
        /// Inverse sine, on `[-1, 1]`.
        Asin = "asin",
        /// Inverse cosine, on `[-1, 1]`.
        Acos = "acos",
        /// Inverse tangent.
        Atan = "atan",
        /// Hyperbolic sine.
        Sinh = "sinh",
        /// Hyperbolic cosine.
        Cosh = "cosh",
        /// Hyperbolic tangent.
        Tanh = "tanh",
        /// Inverse hyperbolic sine.
        Asinh = "asinh",
        /// Inverse hyperbolic cosine, on `[1, inf]`.
        Acosh = "acosh",
        /// Inverse hyperbolic tangent, on `(-1, 1)`.
        Atanh = "atanh",
    }
}

functions! {
    /// A function of two arguments, on its natural domain.
    Binary {
        /// The smaller.
        Min = "min",
        /// The larger.
        Max = "max",
        /// `x - y floor(x/y)`: takes the divisor's sign; undefined for y = 0.
        Mod = "mod",
        /// Angle of the point (y, x), in `(-pi, pi]`; arguments in this order.
        Atan2 = "atan2",
        /// `sqrt(x^2 + y^2)`.
        Hypot = "hypot",
        /// `x^y` for `x > 0`, and for `x = 0` where `y > 0`.
        Pow = "pow",
    }
}
