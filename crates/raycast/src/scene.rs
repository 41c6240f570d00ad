//! Scenes: what rays are cast at.

use zeroset_expr::{Function, Parameters};

use crate::Domain;

/// The shape in a scene. Other kinds of geometry will join.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Geometry {
    /// The zero set of a function.
    Implicit(Function),
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
}
