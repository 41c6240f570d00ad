//! The arithmetic of a march on a scene.

use zeroset_expr::Tape;
use zeroset_raycast::{Domain, Error};

use super::cut::Bounds;
use super::method::{Arithmetic, Bisection};
use crate::numbers::Numbers;

/// The numbers of a march, and the domain's box in them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub bounds: Bounds,
    pub numbers: Numbers,
}

/// 2^800: coordinates are at most as large. Divided by the least component of a direction, 2^-149, they do
/// not overflow on the way to a piece.
const FARTHEST: f64 = f64::from_bits((1023 + 800) << 52);

impl Form {
    /// The numbers for a function and its slope.
    ///
    /// # Errors
    /// If the domain reaches beyond 2^800.
    pub(super) fn of(
        method: &Bisection,
        tape: &Tape,
        slope: Option<&Tape>,
        domain: &Domain,
    ) -> Result<Self, Error> {
        let reach = domain.min.abs().max(domain.max.abs()).max_element();
        if reach > FARTHEST {
            return Err(Error::Domain(format!(
                "the domain reaches to {reach:e}; interval bisection takes domains within 2^800 of \
                 the origin"
            )));
        }
        let numbers = match method.arithmetic {
            Arithmetic::Double => Numbers::Double,
            Arithmetic::Auto => Numbers::of(tape, slope, domain),
        };
        let bounds = match numbers {
            Numbers::Double => Bounds::new::<f64>(domain),
            Numbers::Raw | Numbers::Set => Bounds::new::<f32>(domain),
        };
        Ok(Self { bounds, numbers })
    }
}
