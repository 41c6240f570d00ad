//! Taylor expansions with enclosed remainders.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Decorated, Decoration, Jet};

use super::bernstein;
use super::curve::{Expansion, Line};
use super::fraction::Fraction;
use super::outward::{Double, Outward, Sign};

/// The highest derivative: the remainder of the expansion, `F^(n)(T) (t - m)^n / n!`.
const ORDER: usize = 5;

/// Expands a function that need be neither smooth nor defined everywhere.
pub(super) struct Taylor<'a, N: Outward> {
    /// Its range, and whether it is continuous: in doubles, whatever the precision.
    ranges: Evaluator<'a, Decorated<f64>>,
    fractions: Evaluator<'a, Fraction<Double>>,
    jets: Evaluator<'a, Jet<N>>,
}

impl<'a, N: Outward> Taylor<'a, N> {
    pub(super) fn new(tape: &'a Tape, context: &N) -> Self {
        let zero = Double::point(0.0);
        Self {
            ranges: tape.evaluator(&Decorated::new(zero)),
            fractions: tape.evaluator(&Fraction::new(zero)),
            jets: tape.evaluator(&Jet::constant_value(context.clone(), 0)),
        }
    }

    /// Is F certainly defined at t?
    pub(super) fn is_defined(&mut self, coarse: &Line<Double>, t: f64) -> bool {
        let point = coarse.at(Double::point(t)).map(Decorated::new);
        self.ranges.evaluate(point).decoration >= Decoration::Defined
    }

    /// What is known of F between two t; `slope` encloses its slopes there, kinks included.
    pub(super) fn expand(
        &mut self,
        coarse: &Line<Double>,
        line: &Line<N>,
        [a, b]: [f64; 2],
        slope: impl FnOnce() -> N,
    ) -> Expansion<N> {
        let piece = coarse.at(Double::new(a, b));
        let range = self.ranges.evaluate(piece.map(Decorated::new));
        if !matches!(range.interval.sign(), Sign::Zero | Sign::Unknown) {
            return Expansion::Free;
        }
        if !range.interval.is_bounded() {
            // Perhaps a pole: then the numerator tells.
            let numerator = self.fractions.evaluate(piece.map(Fraction::new)).numerator;
            if !matches!(numerator.sign(), Sign::Zero | Sign::Unknown) {
                return Expansion::Free;
            }
        }
        if !range.is_continuous() {
            return Expansion::Open;
        }
        let m = 0.5 * a + 0.5 * b;
        let exact = |t: f64| line.exact(t);
        // The half-width that reaches both ends.
        let half = (exact(b) - exact(m)).union(&(exact(m) - exact(a)));
        let terms = self.powers(line, [a, b], m, &half, slope);
        Expansion::Terms(match terms {
            Some(terms) => bernstein::from_powers(terms),
            None => vec![exact(0.0).between(range.interval.lo, range.interval.hi)],
        })
    }

    /// The coefficients of the powers of `(t - m) / half`, with the remainder as the last; of the
    /// orders the one with the least remainder.
    fn powers(
        &mut self,
        line: &Line<N>,
        [a, b]: [f64; 2],
        m: f64,
        half: &N,
        slope: impl FnOnce() -> N,
    ) -> Option<Vec<N>> {
        let remainders = self.jet(line, line.exact(a).between(a, b), ORDER);
        let mut scale = half.clone();
        let mut best: Option<(f64, usize, N)> = None;
        for (order, remainder) in remainders.into_iter().enumerate().skip(1) {
            let remainder = remainder * scale.clone();
            scale = scale * half.clone();
            let size = remainder.bounds().iter().fold(0.0, |s: f64, x| s.max(x.abs()));
            if size.is_finite() && best.as_ref().is_none_or(|(least, ..)| size < *least) {
                best = Some((size, order, remainder));
            }
        }
        // At a kink only slopes are known.
        let (order, remainder) = match best {
            Some((_, order, remainder)) => (order, remainder),
            None => (1, slope() * half.clone()),
        };
        let mut powers = Vec::with_capacity(order + 1);
        let mut scale: Option<N> = None;
        for term in self.jet(line, line.exact(m), order - 1) {
            powers.push(match &scale {
                None => term,
                Some(scale) => term * scale.clone(),
            });
            scale = Some(scale.map_or_else(|| half.clone(), |s| s * half.clone()));
        }
        powers.push(remainder);
        powers.iter().all(N::is_bounded).then_some(powers)
    }

    /// The Taylor coefficients at t.
    fn jet(&mut self, line: &Line<N>, t: N, order: usize) -> Vec<N> {
        let mut directions = line.direction.iter();
        let point = line
            .at(t)
            .map(|x| Jet::variable(x, directions.next().expect("three axes").clone(), order));
        self.jets.evaluate(point).coefficients().to_vec()
    }
}
