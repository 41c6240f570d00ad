//! A research test bed for ray casting implicit surfaces.

pub use zeroset_bench as bench;
pub use zeroset_cpu as cpu;
pub use zeroset_expr as expr;
pub use zeroset_ia as ia;
pub use zeroset_raycast as raycast;
pub use zeroset_shade as shade;
