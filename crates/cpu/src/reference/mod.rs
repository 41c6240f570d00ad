//! The reference: slow, and trusted because it proves what it says.
//!
//! | module | holds |
//! |---|---|
//! | `prepared` | the reference for one scene: a ladder of searches for each ray |
//! | `ladder` | what searches have in common; one that is too coarse asks those above |
//! | `bisection` | the search in intervals of one precision |
//! | `curve` | F along a ray: values, slopes, expansions |
//! | `bernstein`, `taylor` | expansions of polynomials, of other functions |
//! | `fraction` | quotients that know a pole from a root |
//! | `isolation`, `exact`, `sturm` | the search in exact arithmetic |
//! | `outward` | what all this needs of an interval |

mod bernstein;
mod bisection;
mod curve;
mod exact;
mod fraction;
mod isolation;
mod ladder;
mod outward;
mod prepared;
mod sturm;
mod taylor;

use zeroset_raycast::{
    Certificate, Error, Intersector, Knob, KnobError, Method, Scene, Unsupported, Work, knob,
};

use crate::implicit::Implicit;

pub use prepared::PreparedReference;

/// Encloses the first root of F(t) = f(o + t d) in outward arithmetic, or proves that there is none.
///
/// A range of t is bisected, the part with small t first, until F or F' is proven to have one sign
/// on each piece T. A sign change of a continuous, monotone F is a root, narrowed by interval Newton:
/// `T := T and m - F(m) / F'(T)`, m the midpoint.
///
/// - A polynomial F is expanded exactly in Bernstein form, any other F in Taylor form with an
///   enclosed remainder.
/// - What double precision cannot decide is repeated with 128 bits, then, for polynomials whose
///   constants are binary fractions, by exact arithmetic and Sturm's theorem, then with ever more
///   bits.
/// - What is still open is said to be undecidable.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Width in t of the bracket of a root, or four units in the last place of t if that is wider.
    pub width: f64,
    /// The most bits of the significand; below 128 there is double precision and exact arithmetic only.
    pub bits: u32,
    /// The most pieces of a ray looked at in double precision (an expansion of degree n counts
    /// n^2/32 more); an eighth of it in each higher precision.
    pub budget: u32,
}

impl Default for Reference {
    fn default() -> Self {
        Self { width: 1e-12, bits: 512, budget: 2048 }
    }
}

/// What is known of the first root on a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// A simple root, alone in its bracket, where F' does not vanish; nothing before it is a root.
    Transversal,
    /// A root in the bracket, and none before it; it may be multiple, or one of several there.
    Tangential,
    /// No root in the whole range.
    None,
    /// No root before the bracket; in it and behind it nothing is known.
    Undecidable,
}

impl Class {
    /// All classes, in the order of their declaration.
    pub const ALL: [Self; 4] = [Self::Transversal, Self::Tangential, Self::None, Self::Undecidable];

    /// The name, as printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transversal => "transversal",
            Self::Tangential => "tangential",
            Self::None => "none",
            Self::Undecidable => "undecidable",
        }
    }
}

/// The truth about one ray, or about a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// What is known.
    pub class: Class,
    /// The range of t that it is known of; `[inf, inf]` if there is no root, or no ray.
    pub bracket: [f64; 2],
    /// No root lies before it: the start of the bracket. For a pixel: on one of its rays at least, `inf` if
    /// one has none.
    pub latest: f64,
    /// What it cost.
    pub work: Work,
}

impl Truth {
    /// The truth about one ray.
    pub const fn new(class: Class, bracket: [f64; 2], work: Work) -> Self {
        Self { class, bracket, latest: bracket[0], work }
    }

    /// What the class proves.
    pub fn certificate(&self) -> Certificate {
        match self.class {
            Class::Transversal | Class::Tangential => Certificate::PROVEN_HIT,
            Class::None => Certificate::PROVEN_MISS,
            Class::Undecidable => Certificate::POSSIBLE_HIT,
        }
    }
}

impl Reference {
    /// Prepares for a scene; also [`PreparedReference::classify`] is then at hand.
    ///
    /// # Errors
    /// If the scene is unsupported, or its parameters are invalid.
    pub fn prepare_reference(&self, scene: &Scene) -> Result<PreparedReference, Error> {
        PreparedReference::new(self.clone(), scene)
    }
}

impl Method for Reference {
    fn id(&self) -> &'static str {
        "reference"
    }

    fn summary(&self) -> &'static str {
        "proven first roots: derivative tests and interval Newton, with more bits where needed"
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        Implicit::function(self.id(), scene).map(drop)
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        Ok(Box::new(self.prepare_reference(scene)?))
    }

    fn knobs(&self) -> Vec<Knob> {
        vec![
            Knob {
                name: "width",
                value: knob::text(self.width),
                doc: "width of the bracket of a root, in t (default 1e-12)",
            },
            Knob {
                name: "bits",
                value: self.bits.to_string(),
                doc: "the most bits of precision, from 53 to 4096 (default 512)",
            },
            Knob {
                name: "budget",
                value: self.budget.to_string(),
                doc: "the most pieces of a ray looked at in double precision (default 2048)",
            },
        ]
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        match name {
            "width" => self.width = knob::number(name, value, [0.0, 1e30])?,
            "bits" => self.bits = knob::whole(name, value, [53, 4096])?,
            "budget" => self.budget = knob::whole(name, value, [1, 1_000_000_000])?,
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }

    fn for_precision(&mut self, width: f64, _: &Scene) {
        self.width = width;
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}
