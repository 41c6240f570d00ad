//! Taylor expansions with enclosed remainders.

use zeroset_expr::{Evaluator, Tape};

use super::curve::{Expansion, at};
use super::enclosure::{Enclosure, Sign};
use super::fraction::Fraction;

/// Expands a function that need be neither smooth nor defined everywhere.
pub(super) struct Taylor<'a, N: Enclosure> {
    ranges: Evaluator<'a, N>,
    fractions: Evaluator<'a, Fraction<N>>,
}

impl<'a, N: Enclosure> Taylor<'a, N> {
    pub(super) fn new(tape: &'a Tape, context: &N) -> Self {
        Self {
            ranges: tape.evaluator(context),
            fractions: tape.evaluator(&Fraction::new(context.clone())),
        }
    }

    pub(super) fn expand(
        &mut self,
        origin: &[N; 3],
        direction: &[N; 3],
        [a, b]: [f64; 2],
    ) -> Expansion<N> {
        let piece = at(origin, direction, &origin[0].between(a, b));
        let range = self.ranges.evaluate(piece.clone());
        if matches!(range.sign(), Sign::Positive | Sign::Negative | Sign::Undefined) {
            return Expansion::Free;
        }
        if !range.is_bounded() {
            // Perhaps a pole: then the numerator tells.
            let numerator = self.fractions.evaluate(piece.map(Fraction::new)).numerator;
            if !matches!(numerator.sign(), Sign::Zero | Sign::Unknown) {
                return Expansion::Free;
            }
        }
        Expansion::Open
    }
}
