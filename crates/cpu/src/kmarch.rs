//! Kmarch.

/// Placeholder.
#[derive(Clone, Debug)]
pub struct Kmarch;
