//! Section 3.1 and the Chebyshev forms: what is counted, not timed.

use std::collections::BTreeMap;

use zeroset::expr::{Function, Op, Parameters, Tape};
use zeroset::ia::{BigInterval, Plain, Scalar};
use zeroset::raycast::{Camera, Domain, Geometry, Scene, View};

use crate::{Failure, surface};

/// The function of a scene.
pub(crate) fn tape(scene: &Scene) -> Result<Tape, Failure> {
    let Geometry::Implicit(function) = &scene.geometry else {
        return Err("the scene has no function".into());
    };
    Ok(function.tape(&scene.parameters, 128)?)
}

/// Floating point operations of one evaluation, and calls of elementary functions.
pub(crate) fn operations(tape: &Tape) -> [u32; 2] {
    let (mut flops, mut calls) = (0, 0);
    for instruction in tape.instructions() {
        match instruction.op {
            Op::Load(_) => {}
            Op::Powi(_, n) => {
                let n = n.unsigned_abs();
                flops += n.ilog2() + n.count_ones() - 1;
            }
            Op::Powc(..) | Op::Unary(..) | Op::Binary(..) => calls += 1,
            _ => flops += 1,
        }
    }
    [flops, calls]
}

/// Coefficients by the powers of x, y and z.
type Polynomial = BTreeMap<[u32; 3], f64>;

/// The expanded polynomial of a tape, if it is one.
fn expanded(tape: &Tape) -> Option<Polynomial> {
    let constant = |c: u32| tape.constants()[c as usize].nearest_f64;
    let variable = |axis: usize| {
        let mut powers = [0; 3];
        powers[axis] = 1;
        Polynomial::from([(powers, 1.0)])
    };
    let sum = |a: &Polynomial, b: &Polynomial, factor: f64| {
        let mut sum = a.clone();
        b.iter().for_each(|(powers, c)| *sum.entry(*powers).or_default() += factor * c);
        sum
    };
    let product = |a: &Polynomial, b: &Polynomial| {
        let mut product = Polynomial::new();
        for (p, c) in a {
            for (q, d) in b {
                *product.entry([p[0] + q[0], p[1] + q[1], p[2] + q[2]]).or_default() += c * d;
            }
        }
        product
    };
    let scaled = |a: &Polynomial, c: f64| a.iter().map(|(p, x)| (*p, c * x)).collect();
    let mut registers = vec![Polynomial::new(); tape.registers()];
    (0..3).for_each(|axis| registers[axis] = variable(axis));
    for instruction in tape.instructions() {
        let at = |r: u32| &registers[r as usize];
        let value = match instruction.op {
            Op::Load(c) => Polynomial::from([([0; 3], constant(c))]),
            Op::Add(a, b) => sum(at(a), at(b), 1.0),
            Op::Sub(a, b) => sum(at(a), at(b), -1.0),
            Op::Mul(a, b) => product(at(a), at(b)),
            Op::Neg(a) => scaled(at(a), -1.0),
            Op::Scale(a, c) => scaled(at(a), constant(c)),
            Op::Offset(a, c) => sum(at(a), &Polynomial::from([([0; 3], 1.0)]), constant(c)),
            Op::Sqr(a) => product(at(a), at(a)),
            Op::Powi(a, n) => {
                let one = Polynomial::from([([0; 3], 1.0)]);
                (0..u32::try_from(n).ok()?).fold(one, |power, _| product(&power, at(a)))
            }
            Op::Div(..) | Op::Powc(..) | Op::Unary(..) | Op::Binary(..) => return None,
        };
        registers[instruction.out as usize] = value;
    }
    let mut polynomial = registers.swap_remove(tape.output() as usize);
    let largest = polynomial.values().fold(0.0_f64, |m, c| m.max(c.abs()));
    // What cancels in exact arithmetic leaves rounding errors.
    polynomial.retain(|_, c| c.abs() > 1e-12 * largest);
    Some(polynomial)
}

/// Section 3.1: the operations of S(p(t)) and the terms of the coefficients of F(t).
pub(crate) fn section_3_1() -> Result<(), Failure> {
    println!("\n## Section 3.1\n");
    println!(
        "Operations of one value S(p(t)) besides the 6 that make the point, the monomials of the \
         expanded polynomial, and the terms of the coefficients of F(t): x^i y^j z^k gives \
         (i+1)(j+1)(k+1) of them. The paper has about 30 against 1373 for the decic.\n"
    );
    println!("| surface | operations of S | monomials | terms of F |");
    println!("|---|---|---|---|");
    for id in ["barth-sextic", "chmutov-8", "barth-decic", "sarti-dodecic", "chmutov-14"] {
        let tape = tape(&surface(id)?)?;
        let Some(polynomial) = expanded(&tape) else { continue };
        let terms: u32 = polynomial.keys().map(|p| p.iter().map(|e| e + 1).product::<u32>()).sum();
        println!("| {id} | {} | {} | {terms} |", operations(&tape)[0], polynomial.len());
    }
    Ok(())
}

/// Signs of a function at points, in single and double precision.
fn signs<S: Scalar>(tape: &Tape, points: &[[f64; 3]]) -> Vec<i8> {
    let mut evaluator = tape.evaluator(&Plain(S::from_f64(0.0)));
    let mut sign = |p: &[f64; 3]| {
        let value = evaluator.evaluate(p.map(|x| Plain(S::from_f64(x)))).0.to_f64();
        i8::from(value > 0.0) - i8::from(value < 0.0)
    };
    points.iter().map(&mut sign).collect()
}

/// False roots of the Chebyshev surfaces by form, order and precision (Section 4.7).
pub(crate) fn chebyshev(side: usize) -> Result<(), Failure> {
    const ORDERS: [u32; 6] = [8, 14, 18, 22, 30, 50];
    const FORMS: [(&str, &str); 3] = [("Tpow", "powers"), ("T", "recurrence"), ("Tcos", "cosines")];
    let half = 1.0625;
    let domain = Domain::new(glam::DVec3::splat(-half), glam::DVec3::splat(half))?;
    let view = View::new(Camera::facing(&domain), side, side);
    println!("\n## Chebyshev surfaces (Section 4.7)\n");
    println!(
        "Steps of 0.01 along the rays of a {side}x{side} view, in the cube of half side {half}: false \
         roots are steps over which the computed sign changes and the exact one does not; lost roots \
         the reverse. Points are the same single precision numbers for all.\n"
    );
    println!(
        "| order | steps | exact roots | form | false, single | lost | false, double | lost |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for n in ORDERS {
        let tapes: Vec<Tape> = FORMS
            .iter()
            .map(|(name, _)| {
                let text = format!("{name}({n},x)+{name}({n},y)+{name}({n},z)");
                Ok(Function::parse(&text)?.tape(&Parameters::default(), 256)?)
            })
            .collect::<Result<_, Failure>>()?;
        let mut counts = [[0_u64; 4]; 3];
        let (mut steps, mut roots) = (0_u64, 0_u64);
        for pixel in 0..side * side {
            let ray = view.ray(pixel % side, pixel / side);
            let Some(clip) = domain.clip(ray, [0.0, f64::INFINITY]) else { continue };
            let [from, to] = clip.outer;
            let count = ((to - from) / 0.01) as usize;
            let points: Vec<[f64; 3]> = (0..=count)
                .map(|i| ray.at(from + 0.01 * i as f64).as_vec3().to_array().map(f64::from))
                .collect();
            let computed: Vec<[Vec<i8>; 2]> = tapes
                .iter()
                .map(|tape| [signs::<f32>(tape, &points), signs::<f64>(tape, &points)])
                .collect();
            let exact: Vec<i8> = points
                .iter()
                .enumerate()
                .map(|(i, p)| {
                    let first = computed[0][0][i];
                    let agree = computed.iter().flatten().all(|signs| signs[i] == first);
                    // Where all agree there is no doubt; else many digits decide.
                    if agree { first } else { exact_sign(&tapes[1], *p) }
                })
                .collect();
            let changes = |signs: &[i8], i: usize| signs[i] * signs[i + 1] < 0;
            for i in 0..count {
                steps += 1;
                let is_root = changes(&exact, i);
                roots += u64::from(is_root);
                for (form, computed) in counts.iter_mut().zip(&computed) {
                    for (k, signs) in computed.iter().enumerate() {
                        let found = changes(signs, i);
                        form[2 * k] += u64::from(found && !is_root);
                        form[2 * k + 1] += u64::from(is_root && !found);
                    }
                }
            }
        }
        for ((_, form), [single, single_lost, double, double_lost]) in FORMS.iter().zip(counts) {
            println!(
                "| {n} | {steps} | {roots} | {form} | {single} | {single_lost} | {double} | \
                 {double_lost} |"
            );
        }
    }
    Ok(())
}

fn exact_sign(tape: &Tape, p: [f64; 3]) -> i8 {
    let zero = BigInterval::from_f64(0.0, 256);
    let value = tape.evaluator(&zero).evaluate(p.map(|x| BigInterval::from_f64(x, 256)));
    let [lo, hi] = value.to_f64();
    i8::from(lo > 0.0) - i8::from(hi < 0.0)
}
