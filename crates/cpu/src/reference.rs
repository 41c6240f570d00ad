//! Reference.

/// Placeholder.
#[derive(Clone, Debug)]
pub struct Reference;
/// Placeholder.
#[derive(Clone, Copy, Debug)]
pub enum Class {}
