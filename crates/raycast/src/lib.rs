//! The contract: what is cast at what, and what the answer means.
//!
//! - A [`Scene`] holds the geometry, a function or [`Patches`] of quadrics, and the [`Domain`] in which
//!   roots count.
//! - [`Rays`] are a [`View`] (a camera and its pixels) or a [`RayBatch`].
//! - A [`Method`] is an algorithm with its knobs; prepared for a scene it is an [`Intersector`].
//! - [`Hits`] are the answers: a bracket on the ray, and a [`Certificate`] of what was proved.
//! - A [`Certifier`] proves roots in brackets that were found without proof.
//! - The [`catalogue`] holds the surfaces of the papers.

pub mod catalogue;
pub mod certifier;
pub mod domain;
pub mod error;
pub mod hit;
pub mod knob;
pub mod method;
pub mod patches;
pub mod progress;
pub mod quadric;
pub mod ray;
pub mod scene;
pub mod view;

pub use certifier::{Certification, Certifier};
pub use domain::{Clip, Domain};
pub use error::{Error, KnobError, Unsupported};
pub use hit::{Certificate, Hit, Hits, Request, Work};
pub use knob::Knob;
pub use method::{Intersector, Method, Report, Sampling};
pub use patches::{Blending, Bound, HalfSpace, Patch, Patches, Sides};
pub use progress::Progress;
pub use quadric::Quadric;
pub use ray::{Ray, RayBatch, Rays};
pub use scene::{Geometry, GeometryKind, Scene};
pub use view::{Camera, Projection, View};
