//! Hits to pictures.
