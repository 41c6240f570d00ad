//! Operations of plain numbers, as the shading language writes them.

use zeroset_expr::Op;
use zeroset_ia::{Binary, Unary};

/// The expression of an operation on the operands that are given by name.
pub(super) fn expression(op: Op, [a, b]: [&str; 2], constant: &str) -> String {
    match op {
        Op::Load(_) => format!("{constant}.x"),
        Op::Add(..) => format!("{a} + {b}"),
        Op::Sub(..) => format!("{a} - {b}"),
        Op::Mul(..) => format!("{a} * {b}"),
        Op::Div(..) => format!("{a} / {b}"),
        Op::Neg(_) => format!("-{a}"),
        Op::Scale(..) => format!("{constant}.x * {a}"),
        Op::Offset(..) => format!("{a} + {constant}.x"),
        Op::Sqr(_) => format!("{a} * {a}"),
        Op::Powi(_, n) => power(a, n),
        Op::Powc(..) => format!("pow({a}, {constant}.x)"),
        Op::Unary(f, _) => unary(f, a),
        Op::Binary(f, ..) => binary(f, a, b),
    }
}

/// a^n by squares, in the order of `zeroset_ia::Plain`. The language has no blocks in expressions: every
/// square is written out, and the compiler computes it once.
fn power(a: &str, n: i32) -> String {
    fn of(a: &str, n: u32) -> String {
        let mut square = a.to_owned();
        let mut power: Option<String> = None;
        let mut rest = n;
        while rest > 0 {
            if rest & 1 == 1 {
                power = Some(power.map_or_else(|| square.clone(), |p| format!("({p} * {square})")));
            }
            square = format!("({square} * {square})");
            rest >>= 1;
        }
        power.unwrap_or_default()
    }
    // Longer texts than this are a pow: its base may be negative.
    const LONGEST: u32 = 64;
    let size = n.unsigned_abs();
    let power = match size {
        0 => "1.0".into(),
        1..=LONGEST => of(a, size),
        _ if size.is_multiple_of(2) => format!("pow(abs({a}), {size}.0)"),
        _ => format!("(sign({a}) * pow(abs({a}), {size}.0))"),
    };
    if n < 0 { format!("1.0 / {power}") } else { power }
}

fn unary(f: Unary, a: &str) -> String {
    match f {
        Unary::Cbrt => format!("sign({a}) * pow(abs({a}), 0.3333333433)"),
        Unary::Exp10 => format!("exp2({a} * 3.321928095)"),
        Unary::Expm1 => format!("exp({a}) - 1.0"),
        Unary::Log10 => format!("log2({a}) * 0.3010299957"),
        Unary::Logp1 => format!("log(1.0 + {a})"),
        // The others have the names of the language.
        _ => format!("{}({a})", f.name()),
    }
}

fn binary(f: Binary, a: &str, b: &str) -> String {
    match f {
        Binary::Min => format!("min({a}, {b})"),
        Binary::Max => format!("max({a}, {b})"),
        Binary::Mod => format!("{a} - {b} * floor({a} / {b})"),
        Binary::Atan2 => format!("atan2({a}, {b})"),
        Binary::Hypot => format!("length(vec2f({a}, {b}))"),
        Binary::Pow => format!("pow({a}, {b})"),
    }
}
