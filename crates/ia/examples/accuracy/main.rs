//! Measures the errors of the elementary functions, and proves the bounds of those of `f32`.
//!
//! ```text
//! cargo run --release -p zeroset-ia --example accuracy -- exhaust [FUNCTION..] [--stride N] [--threads N]
//! cargo run --release -p zeroset-ia --example accuracy -- adversarial [FUNCTION..] [--points N] [--threads N]
//! ```
//!
//! `exhaust` goes over all 2^32 floats for each function of one argument (`exhaust.rs` says what that
//! proves); `adversarial` over points chosen to be hard, for each function of `f64` and each function
//! of two arguments. Both print one line a function as soon as it is done, so that a run that was cut off
//! goes on with the functions that are left. The exit status is 1 if a bound is broken, 2 if the
//! arguments make no sense.

mod adversarial;
mod exact;
mod exhaust;
mod points;
mod request;

use std::process::ExitCode;

use request::Request;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mode = arguments.next().unwrap_or_default();
    let all_hold = match (mode.as_str(), Request::read(arguments)) {
        ("exhaust", Ok(request)) => exhaust::run(&request),
        ("adversarial", Ok(request)) => adversarial::run(&request),
        (_, Err(fault)) => Err(fault),
        _ => Err(format!("{mode:?} is no mode: exhaust or adversarial")),
    };
    match all_hold {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(fault) => {
            eprintln!("error: {fault}");
            ExitCode::from(2)
        }
    }
}
