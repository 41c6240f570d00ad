//! Elementary functions of single floats.

use crate::{BigInterval, Binary, Number, Unary, single};

macro_rules! scalar_functions {
    (
        $(#[$doc:meta])*
        $float:ident: $unary:ident { $($one:ident = $f:ident,)* } $binary:ident { $($two:ident = $g:ident,)* }
    ) => {
        $(#[$doc])*
        pub(crate) fn $unary(f: Unary, x: $float) -> $float {
            match f {
                Unary::Sqrt => x.sqrt(),
                Unary::Abs => x.abs(),
                Unary::Sign if x > 0.0 => 1.0,
                Unary::Sign if x < 0.0 => -1.0,
                Unary::Sign => x,
                Unary::Floor => x.floor(),
                Unary::Ceil => x.ceil(),
                $(Unary::$one => metallic::$f(x),)*
            }
        }

        $(#[$doc])*
        pub(crate) fn $binary(f: Binary, x: $float, y: $float) -> $float {
            match f {
                Binary::Min => if x < y { x } else { y },
                Binary::Max => if x > y { x } else { y },
                Binary::Mod => {
                    // The remainder is exact and has the sign of x.
                    let remainder = x % y;
                    if remainder * y.signum() < 0.0 { remainder + y } else { remainder }
                }
                $(Binary::$two => metallic::$g(x, y),)*
            }
        }
    };
}

/// The function in single precision, within 0.51 units in the last place.
pub(crate) fn unary_f32(f: Unary, x: f32) -> f32 {
    match f {
        Unary::Exp => single::exp(x),
        Unary::Log => single::log(x),
        Unary::Sin if x.abs() <= single::LARGEST_ANGLE => single::sin(x),
        Unary::Cos if x.abs() <= single::LARGEST_ANGLE => single::cos(x),
        _ => rounded_unary_f32(f, x),
    }
}

/// The function in single precision, within 0.51 units in the last place.
pub(crate) fn binary_f32(f: Binary, x: f32, y: f32) -> f32 {
    match f {
        Binary::Pow => single::pow(x, y).unwrap_or_else(|| rounded_binary_f32(f, x, y)),
        _ => rounded_binary_f32(f, x, y),
    }
}

scalar_functions! {
    /// The function in single precision, correctly rounded.
    f32: rounded_unary_f32 {
        Cbrt = cbrtf, Exp = expf, Exp2 = exp2f, Exp10 = exp10f, Expm1 = expm1f, Log = logf,
        Log2 = log2f, Log10 = log10f, Logp1 = log1pf, Sin = sinf, Cos = cosf, Tan = tanf,
        Asin = asinf, Acos = acosf, Atan = atanf, Sinh = sinhf, Cosh = coshf, Tanh = tanhf,
        Asinh = asinhf, Acosh = acoshf, Atanh = atanhf,
    }
    rounded_binary_f32 { Atan2 = atan2f, Hypot = hypotf, Pow = powf, }
}

/// The function in double precision, within one unit in the last place.
pub(crate) fn unary_f64(f: Unary, x: f64) -> f64 {
    // From here on the library's tangent loses digits near its poles (docs/elementary.md).
    const LARGE: f64 = 1_048_576.0;
    let y = library_unary_f64(f, x);
    if f == Unary::Tan && x.abs() >= LARGE && y.abs() >= LARGE {
        BigInterval::from_f64(x, 128).unary(f).nearest()
    } else {
        y
    }
}

scalar_functions! {
    /// The function in double precision, as the library has it.
    f64: library_unary_f64 {
        Cbrt = cbrt, Exp = exp, Exp2 = exp2, Exp10 = exp10, Expm1 = expm1, Log = log,
        Log2 = log2, Log10 = log10, Logp1 = log1p, Sin = sin, Cos = cos, Tan = tan,
        Asin = asin, Acos = acos, Atan = atan, Sinh = sinh, Cosh = cosh, Tanh = tanh,
        Asinh = asinh, Acosh = acosh, Atanh = atanh,
    }
    binary_f64 { Atan2 = atan2, Hypot = hypot, Pow = pow, }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mod_takes_the_sign_of_the_divisor() {
        for (x, y, expected) in [
            (5.5, 2.0, 1.5),
            (-5.5, 2.0, 0.5),
            (5.5, -2.0, -0.5),
            (-5.5, -2.0, -1.5),
            (4.0, 2.0, 0.0),
            (-4.0, 2.0, 0.0),
        ] {
            assert_eq!(binary_f64(Binary::Mod, x, y), expected, "{x} mod {y}");
            assert_eq!(binary_f32(Binary::Mod, x as f32, y as f32), expected as f32);
        }
        assert!(binary_f64(Binary::Mod, 1.0, 0.0).is_nan());
    }

    #[test]
    fn tangents_of_large_arguments_are_right_beside_poles() {
        // Found by the example `accuracy`: the library was wrong by 8.8, 3.4 and 1.3 units.
        for (x, expected) in [
            (-2.0197660453083944e6, 0x425e_200f_77e6_b5ff),
            (1.1597110740910382e6, 0xc263_49d3_fcb4_9b06),
            (2.8943728736971784e6, 0xc24b_5251_89a8_84be),
        ] {
            let y = unary_f64(Unary::Tan, x);
            assert_eq!(y.to_bits(), expected, "{x:e}: {y:e}");
        }
        assert!(unary_f64(Unary::Tan, f64::INFINITY).is_nan());
    }

    #[test]
    fn outside_the_domain_is_nan() {
        for (f, x) in [
            (Unary::Sqrt, -1.0),
            (Unary::Log, -1.0),
            (Unary::Logp1, -2.0),
            (Unary::Asin, 1.5),
            (Unary::Acos, -1.5),
            (Unary::Acosh, 0.5),
            (Unary::Atanh, 1.5),
        ] {
            assert!(unary_f64(f, x).is_nan(), "{f}({x})");
            assert!(unary_f32(f, x as f32).is_nan(), "{f}({x})");
        }
    }

    #[test]
    fn agrees_with_the_standard_library_to_a_few_units() {
        for i in -400..=400 {
            let x = f64::from(i) * 0.043;
            for (f, expected) in [
                (Unary::Sin, x.sin()),
                (Unary::Cos, x.cos()),
                (Unary::Exp, x.exp()),
                (Unary::Exp2, x.exp2()),
                (Unary::Cbrt, x.cbrt()),
                (Unary::Atan, x.atan()),
                (Unary::Tanh, x.tanh()),
                (Unary::Asinh, x.asinh()),
                (Unary::Log2, x.log2()),
                (Unary::Logp1, x.ln_1p()),
            ] {
                let y = unary_f64(f, x);
                let close = (y - expected).abs() <= 1e-14 * expected.abs().max(1e-9);
                assert!(
                    close || y.is_nan() && expected.is_nan() || y == expected,
                    "{f}({x}) = {y}"
                );
            }
        }
    }
}
