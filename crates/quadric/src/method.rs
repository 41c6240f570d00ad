//! The settings of casting rays at quadrics on the CPU.

use std::sync::Arc;

use zeroset_raycast::{
    Error, Geometry, GeometryKind, Intersector, Knob, KnobError, Method, Patches, Scene,
    Unsupported, knob,
};

use crate::piece::Formula;
use crate::prepared::PreparedQuadrics;

/// What is done before the first ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Staging {
    /// What rays of one eye share: patches that turn their back to it are left out.
    Incremental,
    /// Nothing: every ray takes all patches on its way.
    Brute,
}

/// The precision in which roots are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 24 bits, as on a GPU.
    Single,
    /// 53 bits.
    Double,
}

/// Quadrics in bounds, over a hierarchy of their boxes: the methods `quadric` and `quadric-brute`.
///
/// Along each ray the equation of each patch is solved (\[stoll2006\] Section 4.2) and roots outside its
/// bound are dropped; the first root is the answer, or the mean of the first sheet where the scene blends.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrics {
    /// Which of them.
    pub staging: Staging,
    /// Default: local.
    pub formula: Formula,
    /// Default: double.
    pub precision: Precision,
}

impl Quadrics {
    /// The method `quadric`.
    pub fn incremental() -> Self {
        Self {
            staging: Staging::Incremental,
            formula: Formula::Local,
            precision: Precision::Double,
        }
    }

    /// The method `quadric-brute`.
    pub fn brute() -> Self {
        Self { staging: Staging::Brute, ..Self::incremental() }
    }
}

pub(crate) const FORMULAS: [(&str, Formula); 3] = [
    ("local", Formula::Local),
    ("quotient", Formula::Quotient),
    ("reciprocal", Formula::Reciprocal),
];
const PRECISIONS: [(&str, Precision); 2] =
    [("single", Precision::Single), ("double", Precision::Double)];

/// The patches of a scene, for the method of that id.
///
/// # Errors
/// If the scene has none.
pub(crate) fn patches<'a>(method: &str, scene: &'a Scene) -> Result<&'a Arc<Patches>, Unsupported> {
    match &scene.geometry {
        Geometry::Patches(patches) => Ok(patches),
        _ => Err(Unsupported(format!("{method} casts rays at quadrics in bounds only"))),
    }
}

impl Method for Quadrics {
    fn id(&self) -> &'static str {
        match self.staging {
            Staging::Incremental => "quadric",
            Staging::Brute => "quadric-brute",
        }
    }

    fn summary(&self) -> &'static str {
        match self.staging {
            Staging::Incremental => "quadrics in bounds, those turned away culled [stoll2006]",
            Staging::Brute => "quadrics in bounds, all of them for every ray [stoll2006]",
        }
    }

    fn geometry(&self) -> GeometryKind {
        GeometryKind::Patches
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        patches(self.id(), scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let patches = patches(self.id(), scene)?;
        Ok(Box::new(PreparedQuadrics::new(self, Arc::clone(patches))))
    }

    fn knobs(&self) -> Vec<Knob> {
        vec![
            Knob {
                name: "formula",
                value: knob::name(&FORMULAS, &self.formula),
                doc: "local (about the ray's point nearest to the patch, without cancellation), or the paper's about the eye: quotient (Eq. 7) or reciprocal (Eq. 15); default local",
            },
            Knob {
                name: "precision",
                value: knob::name(&PRECISIONS, &self.precision),
                doc: "single (as on a GPU) or double (default double)",
            },
        ]
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        match name {
            "formula" => self.formula = knob::choice(name, value, &FORMULAS)?,
            "precision" => self.precision = knob::choice(name, value, &PRECISIONS)?,
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }

    /// Roots come in closed form.
    fn for_precision(&mut self, _: f64, _: &Scene) {}

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}
