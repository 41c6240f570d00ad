//! Hits to pictures.
//!
//! A [`Picture`] is made from a view and its hits, by [`picture()`] and the name of a [`ViewKind`]:
//!
//! | kind | shows | module |
//! |---|---|---|
//! | `normal` | unit normals that face the eye, as colours | [`normals`] |
//! | `shaded` | Lambert's law under a light above and to the left of the eye | [`shaded`] |
//! | `depth` | t, near bright and far dark | [`depth`] |
//! | `steps` | evaluations a ray, on a logarithmic scale | [`steps`] |
//! | `certificate` | what was proved | [`certificate`] |
//! | `error` | agreement with the reference | [`agreement`] |
//!
//! A shaded picture has shadows where [`ShadowRays`] were cast and found blocked, and lies in an
//! [`Environment`], which it may mirror.
//!
//! Several answers to one view are painted by [`pictures`], with the same scale for all. Pictures
//! are saved as PNG ([`Picture::save_png`]), joined to a contact [`sheet`](sheet::sheet), or shown
//! one after the other by an [`Animation`]; hits are kept as numbers in an EXR with named channels
//! ([`exr::save`]). Files are whole or absent: everything goes through [`write_atomically`].
//!
//! NaN and infinity have colours like any number, and never panic.

pub mod agreement;
pub mod animation;
pub mod certificate;
pub mod colour;
pub mod depth;
pub mod environment;
pub mod error;
pub mod exr;
pub mod file;
mod font;
pub mod kind;
pub mod legend;
pub mod normals;
pub mod palette;
mod picture;
mod png;
pub mod shaded;
pub mod shadows;
pub mod sheet;
pub mod steps;
mod text;

pub use agreement::Agreement;
pub use animation::Animation;
pub use colour::Colour;
pub use environment::Environment;
pub use error::ShadeError;
pub use file::write_atomically;
pub use kind::{ViewKind, picture, pictures};
pub use legend::Legend;
pub use picture::Picture;
pub use shaded::Light;
pub use shadows::ShadowRays;
pub use sheet::Tile;
