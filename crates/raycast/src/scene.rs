//! Scenes: what rays are cast at.

use std::sync::Arc;

use zeroset_expr::{Function, Parameters};

use crate::{Domain, Patches};

/// The shape in a scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Geometry {
    /// The zero set of a function.
    Implicit(Function),
    /// Quadrics in bounds.
    Patches(Arc<Patches>),
}

/// A kind of geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GeometryKind {
    /// [`Geometry::Implicit`].
    Function,
    /// [`Geometry::Patches`].
    Patches,
}

impl Geometry {
    /// Its kind.
    pub fn kind(&self) -> GeometryKind {
        match self {
            Self::Implicit(_) => GeometryKind::Function,
            Self::Patches(_) => GeometryKind::Patches,
        }
    }
}

/// What rays are cast at: a geometry, the values of its parameters, and the domain.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The name in records and file names.
    pub id: String,
    /// The shape.
    pub geometry: Geometry,
    /// Values for the equation's parameters that differ from their defaults.
    pub parameters: Parameters,
    /// Where roots count.
    pub domain: Domain,
    /// The base step that \[singh2010\] publishes for this surface, in units of space.
    pub published_step: Option<f64>,
}

impl Scene {
    /// The zero set of a function in a domain.
    pub fn new(id: impl Into<String>, function: Function, domain: Domain) -> Self {
        Self {
            id: id.into(),
            geometry: Geometry::Implicit(function),
            parameters: Parameters::default(),
            domain,
            published_step: None,
        }
    }

    /// Patches of quadrics; their bounds are the domain.
    pub fn of_patches(id: impl Into<String>, patches: Patches) -> Self {
        Self {
            id: id.into(),
            domain: patches.domain(),
            geometry: Geometry::Patches(Arc::new(patches)),
            parameters: Parameters::default(),
            published_step: None,
        }
    }
}
