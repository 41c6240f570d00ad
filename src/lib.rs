//! A research test bed for ray casting implicit surfaces.
