//! Ray casting methods on the CPU.
