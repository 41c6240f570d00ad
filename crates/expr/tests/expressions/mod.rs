//! Random expression trees, with evaluators and derivatives that know nothing of the crate.
#![allow(dead_code, reason = "each test uses its part")]

pub(crate) mod big;
pub(crate) mod rounded;

use proptest::prelude::*;

/// An expression as a tree.
#[derive(Clone, Debug)]
pub(crate) enum Expr {
    /// x, y or z.
    Variable(usize),
    /// An integer or a decimal.
    Number(String),
    Pi,
    /// A name that the text defines elsewhere; only trees for printing have it.
    Name(&'static str),
    Neg(Box<Expr>),
    Add(Box<Expr>, Box<Expr>),
    Sub(Box<Expr>, Box<Expr>),
    Mul(Box<Expr>, Box<Expr>),
    Div(Box<Expr>, Box<Expr>),
    Power(Box<Expr>, i32),
    Call1(&'static str, Box<Expr>),
    Call2(&'static str, Box<Expr>, Box<Expr>),
}

use Expr::{Add, Call1, Call2, Div, Mul, Name, Neg, Number, Pi, Power, Sub, Variable};

/// What a tree is evaluated over.
pub(crate) trait Arithmetic: Clone {
    fn number(&self, decimal: &str) -> Self;
    fn pi(&self) -> Self;
    fn neg(self) -> Self;
    fn add(self, o: Self) -> Self;
    fn sub(self, o: Self) -> Self;
    fn mul(self, o: Self) -> Self;
    fn div(self, o: Self) -> Self;
    fn power(self, n: i32) -> Self;
    fn call1(self, f: &str) -> Self;
    fn call2(self, f: &str, o: Self) -> Self;
}

impl Expr {
    /// The value at a point.
    pub(crate) fn evaluate<A: Arithmetic>(&self, point: &[A; 3]) -> A {
        let at = |e: &Self| e.evaluate(point);
        match self {
            Variable(axis) => point[*axis].clone(),
            Number(decimal) => point[0].number(decimal),
            Pi => point[0].pi(),
            Name(name) => panic!("`{name}` has no value here"),
            Neg(a) => at(a).neg(),
            Add(a, b) => at(a).add(at(b)),
            Sub(a, b) => at(a).sub(at(b)),
            Mul(a, b) => at(a).mul(at(b)),
            Div(a, b) => at(a).div(at(b)),
            Power(a, n) => at(a).power(*n),
            Call1(f, a) => at(a).call1(f),
            Call2(f, a, b) => at(a).call2(f, at(b)),
        }
    }

    /// Text with no more parentheses than the grammar needs.
    pub(crate) fn text(&self) -> String {
        self.text_within(0)
    }

    /// Text for a place where only operators of at least this level need no parentheses.
    fn text_within(&self, least: u8) -> String {
        let (level, text) = match self {
            Variable(axis) => (4, ["x", "y", "z"][*axis].into()),
            Number(decimal) => (4, decimal.clone()),
            Pi => (4, "pi".into()),
            Name(name) => (4, (*name).into()),
            Add(a, b) => (0, format!("{} + {}", a.text_within(0), b.text_within(1))),
            Sub(a, b) => (0, format!("{}-{}", a.text_within(0), b.text_within(1))),
            Mul(a, b) => (1, format!("{}*{}", a.text_within(1), b.text_within(2))),
            Div(a, b) => (1, format!("{}/{}", a.text_within(1), b.text_within(2))),
            Neg(a) => (2, format!("-{}", a.text_within(2))),
            Power(a, n) => (3, format!("{}^{n}", a.text_within(4))),
            Call1(f, a) => (4, format!("{f}({})", a.text())),
            Call2(f, a, b) => (4, format!("{f}({}, {})", a.text(), b.text())),
        };
        if level < least { format!("({text})") } else { text }
    }

    /// The partial derivative, by the rules of the school book.
    pub(crate) fn derivative(&self, axis: usize) -> Self {
        let d = |e: &Self| e.derivative(axis);
        match self {
            Variable(a) => number(i32::from(*a == axis)),
            Number(_) | Pi | Name(_) => number(0),
            Neg(a) => Neg(d(a).into()),
            Add(a, b) => Add(d(a).into(), d(b).into()),
            Sub(a, b) => Sub(d(a).into(), d(b).into()),
            Mul(a, b) => Add(mul(d(a), a_of(b)).into(), mul(a_of(a), d(b)).into()),
            Div(a, b) => {
                let top = Sub(mul(d(a), a_of(b)).into(), mul(a_of(a), d(b)).into());
                Div(top.into(), Power(b.clone(), 2).into())
            }
            Power(_, 0) => number(0),
            Power(a, n) => mul(mul(number(*n), Power(a.clone(), n - 1)), d(a)),
            Call1(f, a) => mul(slope(f, a), d(a)),
            Call2(f, ..) => panic!("`{f}` is not among the smooth functions"),
        }
    }
}

fn a_of(e: &Expr) -> Expr {
    e.clone()
}

fn mul(a: Expr, b: Expr) -> Expr {
    Mul(a.into(), b.into())
}

fn number(n: i32) -> Expr {
    let magnitude = Number(n.unsigned_abs().to_string());
    if n < 0 { Neg(magnitude.into()) } else { magnitude }
}

/// f'(a).
fn slope(f: &str, a: &Expr) -> Expr {
    let call = |f| Call1(f, a.clone().into());
    let square = |e: Expr| Power(e.into(), 2);
    let reciprocal = |e: Expr| Div(number(1).into(), e.into());
    match f {
        "sin" => call("cos"),
        "cos" => Neg(call("sin").into()),
        "exp" => call("exp"),
        "sinh" => call("cosh"),
        "cosh" => call("sinh"),
        "tanh" => reciprocal(square(call("cosh"))),
        "tan" => reciprocal(square(call("cos"))),
        "sqr" => mul(number(2), a.clone()),
        "sqrt" => reciprocal(mul(number(2), call("sqrt"))),
        "log" => reciprocal(a.clone()),
        "log2" => reciprocal(mul(a.clone(), Call1("log", number(2).into()))),
        "cbrt" => reciprocal(mul(number(3), square(call("cbrt")))),
        "atan" => reciprocal(Add(square(a.clone()).into(), number(1).into())),
        "asinh" => {
            reciprocal(Call1("sqrt", Add(square(a.clone()).into(), number(1).into()).into()))
        }
        _ => panic!("`{f}` is not among the smooth functions"),
    }
}

/// Functions with one argument that have derivatives wherever they are defined, but for cbrt and sqrt
/// at 0.
pub(crate) const SMOOTH: &[&str] = &[
    "sin", "cos", "exp", "sinh", "cosh", "tanh", "tan", "sqr", "sqrt", "log", "log2", "cbrt",
    "atan", "asinh",
];

/// The other functions with one argument.
pub(crate) const OTHERS: &[&str] = &[
    "abs", "sign", "floor", "ceil", "exp2", "exp10", "expm1", "log10", "logp1", "asin", "acos",
    "acosh", "atanh",
];

/// Functions with two arguments.
pub(crate) const BINARY: &[&str] = &["min", "max", "mod", "atan2", "hypot", "pow"];

/// Numbers as they are written: small integers, and decimals of which few are doubles.
fn written_number() -> impl Strategy<Value = Expr> {
    prop_oneof![
        3 => (0..4_u32).prop_map(|n| Number(n.to_string())),
        1 => (0..1000_u32).prop_map(|n| Number(n.to_string())),
        2 => (0..300_u32).prop_map(|n| Number(format!("{}.{:02}", n / 100, n % 100))),
        1 => prop::sample::select(&["0.1", "1e-3", "2.5e2", ".75", "0.333333333333333333333"][..])
            .prop_map(|text| Number(text.into())),
    ]
}

/// What the inner nodes of a tree may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Functions {
    Smooth,
    All,
}

/// Trees with the given leaves beside variables and numbers.
fn trees(functions: Functions, leaf: BoxedStrategy<Expr>) -> BoxedStrategy<Expr> {
    leaf.prop_recursive(6, 40, 2, move |inner| {
        let pair = || (inner.clone().prop_map(Box::new), inner.clone().prop_map(Box::new));
        let operations = prop_oneof![
            3 => pair().prop_map(|(a, b)| Add(a, b)),
            3 => pair().prop_map(|(a, b)| Sub(a, b)),
            4 => pair().prop_map(|(a, b)| Mul(a, b)),
            2 => pair().prop_map(|(a, b)| Div(a, b)),
            2 => inner.clone().prop_map(|a| Neg(a.into())),
            2 => (inner.clone(), -3..6).prop_map(|(a, n)| Power(a.into(), n)),
            2 => (prop::sample::select(SMOOTH), inner.clone())
                .prop_map(|(f, a)| Call1(f, a.into())),
        ];
        if functions == Functions::Smooth {
            return operations.boxed();
        }
        let others = prop_oneof![
            (prop::sample::select(OTHERS), inner.clone()).prop_map(|(f, a)| Call1(f, a.into())),
            (prop::sample::select(BINARY), pair()).prop_map(|(f, (a, b))| Call2(f, a, b)),
        ];
        prop_oneof![4 => operations, 1 => others].boxed()
    })
    .boxed()
}

fn leaf() -> BoxedStrategy<Expr> {
    prop_oneof![5 => (0..3_usize).prop_map(Variable), 3 => written_number(), 1 => Just(Pi)].boxed()
}

/// Random trees.
pub(crate) fn expression(functions: Functions) -> BoxedStrategy<Expr> {
    trees(functions, leaf())
}

/// Random trees that may use the given names.
pub(crate) fn expression_with(names: &'static [&'static str]) -> BoxedStrategy<Expr> {
    let name = prop::sample::select(names).prop_map(Name);
    trees(Functions::All, prop_oneof![3 => leaf(), 1 => name].boxed())
}

/// A coordinate: often a small integer or half, else anywhere near.
pub(crate) fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => (-6..7_i32).prop_map(|n| f64::from(n) / 2.0),
        3 => -3.0..3.0,
        1 => (-1.0..1.0_f64, -20..5_i32).prop_map(|(m, e)| m * 2_f64.powi(e)),
    ]
}
