//! What ran it.

use serde::{Deserialize, Serialize};

/// The machine and its settings.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// The instruction set that lanes use.
    pub isa: String,
    /// The operating system and architecture.
    pub os: String,
    /// Worker threads.
    pub threads: usize,
}

impl Machine {
    /// This machine, with the threads of the current pool.
    pub fn this() -> Self {
        todo!()
    }
}
