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

use std::process::ExitCode;

/// What the command line asks for.
struct Request {
    functions: Vec<String>,
    stride: u32,
    points: usize,
    threads: usize,
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mode = arguments.next().unwrap_or_default();
    let all_hold = match (mode.as_str(), request(arguments)) {
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

fn request(mut arguments: impl Iterator<Item = String>) -> Result<Request, String> {
    let mut request = Request { functions: Vec::new(), stride: 1, points: 2000, threads: 1 };
    while let Some(argument) = arguments.next() {
        let mut number = || {
            let text = arguments.next().ok_or(format!("{argument} needs a number"))?;
            match text.parse::<u32>() {
                Ok(n) if n > 0 => Ok(n),
                _ => Err(format!("{argument} {text}: a number from 1 to 4294967295 is needed")),
            }
        };
        match argument.as_str() {
            "--stride" => request.stride = number()?,
            "--points" => request.points = number()? as usize,
            "--threads" => request.threads = number()? as usize,
            option if option.starts_with("--") => return Err(format!("no option {option}")),
            _ => request.functions.push(argument),
        }
    }
    Ok(request)
}
