//! Operations of affine forms, recorded as functions of the shading language.

use zeroset_expr::Op;
use zeroset_ia::{Affine, Binary, Interval, Number, portable};
use zeroset_raycast::Unsupported;

use super::parts::{Parts, function};
use super::trace::Trace;

type Form = Affine<Trace, 3>;

const FORM: usize = Form::WIDTH;
const INTERVAL: usize = Interval::<Trace>::WIDTH;

/// The function's name and its code; a constant is an interval, its last operand.
pub(super) fn operation(op: Op) -> Result<(String, String), Unsupported> {
    let first = |x: &[Trace]| Form::from_parts(&x[..FORM]);
    let both = |x: &[Trace]| (first(x), Form::from_parts(&x[FORM..]));
    let with_constant = |x: &[Trace]| (first(x), Interval::from_parts(&x[FORM..]));
    let one = |name: String, f: &dyn Fn(Form) -> Form| {
        let code = function(&name, &[FORM], |x| f(first(x)));
        (name, code)
    };
    let two = |name: String, f: &dyn Fn(Form, Form) -> Form| {
        let code = function(&name, &[FORM, FORM], |x| {
            let (a, b) = both(x);
            f(a, b)
        });
        (name, code)
    };
    let constant = |name: &str, f: &dyn Fn(Form, Interval<Trace>) -> Form| {
        let code = function(name, &[FORM, INTERVAL], |x| {
            let (a, c) = with_constant(x);
            f(a, c)
        });
        (name.to_owned(), code)
    };
    let none = |name: &str| {
        Err(Unsupported(format!("{name} has no affine form on devices; use a CPU method")))
    };
    Ok(match op {
        Op::Load(_) => {
            let name = "affine_constant";
            let code = function(name, &[INTERVAL], |x| Form::between(Interval::from_parts(x)));
            (name.into(), code)
        }
        Op::Add(..) => two("affine_add".into(), &|a, b| a + b),
        Op::Sub(..) => two("affine_sub".into(), &|a, b| a - b),
        Op::Mul(..) => two("affine_mul".into(), &|a, b| a * b),
        Op::Div(..) => two("affine_div".into(), &|a, b| a / b),
        Op::Neg(_) => one("affine_neg".into(), &|a| -a),
        Op::Sqr(_) => one("affine_sqr".into(), &|a| a.sqr()),
        Op::Scale(..) => constant("affine_scale", &|a, c| a.scaled(c, a.range * c)),
        Op::Offset(..) => constant("affine_offset", &|a, c| a.shifted(c, a.range + c)),
        Op::Powi(_, n) if n < 0 => {
            one(format!("affine_power_minus_{}", n.unsigned_abs()), &|a| a.powi(n))
        }
        Op::Powi(_, n) => one(format!("affine_power_{n}"), &|a| a.powi(n)),
        Op::Powc(..) => {
            constant("affine_powc", &|a, c| Form::between(a.range.binary(Binary::Pow, c)))
        }
        Op::Unary(f, _) if portable::has_unary(f) => one(format!("affine_{f}"), &|a| a.unary(f)),
        Op::Unary(f, _) => return none(f.name()),
        Op::Binary(f, ..) if portable::has_binary(f) => {
            two(format!("affine_{f}"), &|a, b| a.binary(f, b))
        }
        Op::Binary(f, ..) => return none(f.name()),
    })
}
