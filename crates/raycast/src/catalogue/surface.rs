//! Surfaces of a catalogue.

use serde::Deserialize;
use zeroset_expr::{Definitions, Function, Parameters, ParseError};

use super::{Rotation, Symmetry, extent};
use crate::{Domain, Scene};

/// A surface f(x, y, z) = 0: its equation, and what is known of it.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its name in commands and records.
    pub id: String,
    /// Its title.
    pub name: String,
    /// f as text; constants in it are exact.
    pub equation: String,
    /// The parameters and tables that the equation refers to.
    pub definitions: Definitions,
    /// Where roots count; `None` to find it from f, see [`extent::find`].
    pub domain: Option<Domain>,
    /// The total degree, where f is a polynomial.
    pub degree: Option<u32>,
    /// The degree of a polynomial with the same zero set, where f is none.
    pub zero_set_degree: Option<u32>,
    /// The id of the surface with that polynomial.
    pub algebraic_form: Option<String>,
    /// The id of the surface that this is another form of.
    pub variant_of: Option<String>,
    /// The id of the surface that has the same f, computed in another way.
    pub form_of: Option<String>,
    /// Where it is printed: a paper's key and a place in it, such as `singh2010 Table 1 row 4`.
    pub papers: Vec<String>,
    /// The base step of adaptive marching points, units of space (\[singh2010\], Table 1): that of
    /// the surface's row, or of the row of a surface that it is a variant or a form of.
    pub published_step: Option<f64>,
    /// How sure it is that the equation is the one meant.
    pub status: Status,
    /// What a paper prints, where this differs.
    pub printed_as: Option<String>,
    /// Why it differs, or what else is in doubt.
    pub correction: Option<String>,
    /// Where f is negative or positive.
    pub sign: Option<String>,
    /// False where sheets touch or double lines run, so that sign tests lose parts of the surface.
    pub simple_roots_only: bool,
    /// What its singular points are; `none` for a smooth surface, `None` if that is not known.
    pub singular_kind: Option<String>,
    /// Where its singular points are.
    pub singular_locus: Option<String>,
    /// Signed permutations of the coordinates that leave f as it is, or turn its sign.
    pub symmetries: Vec<Symmetry>,
    /// Turns that leave f as it is.
    pub rotations: Vec<Rotation>,
    /// Points on the surface, as exact constants.
    pub points: Vec<[String; 3]>,
    /// What else is known.
    pub facts: Vec<String>,
}

/// How sure it is that an equation is the one that a paper means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// As printed, or a correction that is certain.
    #[default]
    Sound,
    /// The sources leave it open.
    Ambiguous,
    /// As printed, though probably not meant.
    Printed,
    /// Implied by a paper, not printed.
    Variant,
    /// Values that no paper publishes were chosen.
    Chosen,
}

impl Surface {
    /// A surface of which nothing is known but its equation.
    pub fn new(id: impl Into<String>, equation: impl Into<String>) -> Self {
        let id = id.into();
        Self {
            name: id.clone(),
            id,
            equation: equation.into(),
            definitions: Definitions::default(),
            domain: None,
            degree: None,
            zero_set_degree: None,
            algebraic_form: None,
            variant_of: None,
            form_of: None,
            papers: Vec::new(),
            published_step: None,
            status: Status::default(),
            printed_as: None,
            correction: None,
            sign: None,
            simple_roots_only: true,
            singular_kind: None,
            singular_locus: None,
            symmetries: Vec::new(),
            rotations: Vec::new(),
            points: Vec::new(),
            facts: Vec::new(),
        }
    }

    /// The function f.
    ///
    /// # Errors
    /// If the equation cannot be read.
    pub fn function(&self) -> Result<Function, ParseError> {
        Function::parse_with(&self.equation, &self.definitions)
    }

    /// The surface as a scene, its parameters at their defaults.
    ///
    /// # Errors
    /// If the equation cannot be read.
    pub fn scene(&self) -> Result<Scene, ParseError> {
        self.scene_with(&Parameters::default())
    }

    /// The surface as a scene, with values for some of its parameters. Wrong ones are found when a
    /// method is prepared.
    ///
    /// # Errors
    /// If the equation cannot be read.
    pub fn scene_with(&self, parameters: &Parameters) -> Result<Scene, ParseError> {
        let function = self.function()?;
        let domain = self.domain.unwrap_or_else(|| extent::find(&function, parameters));
        Ok(Scene {
            parameters: parameters.clone(),
            published_step: self.published_step,
            ..Scene::new(self.id.clone(), function, domain)
        })
    }
}
