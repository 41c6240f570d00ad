//! The device of the tests.

#![allow(missing_docs, unreachable_pub)]

use std::sync::Arc;

use zeroset_gpu::{Choice, Device};

/// The device; without one the test is skipped, which it says, or fails if `REQUIRE_GPU` is set.
pub fn device() -> Option<Arc<Device>> {
    match Device::open(&Choice::Auto) {
        Ok(device) => Some(device),
        Err(error) if std::env::var_os("REQUIRE_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            eprintln!("skipped: {error}");
            None
        }
    }
}
