//! The catalogue of surfaces.
