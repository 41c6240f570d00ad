//! Amp.

/// Placeholder.
#[derive(Clone, Debug)]
pub struct Amp;
