//! Builds a SLIM surface from a file of points:
//! `cargo run --release -p zeroset-model --example slim -- FILE [--error 1e-4] [--out F]`.

use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;
use std::str::FromStr;
use std::time::Instant;

use zeroset_model::points::Cloud;
use zeroset_model::slim::{Edges, Options, build};
use zeroset_raycast::Progress;

const USAGE: &str = "usage: slim FILE [--error 1e-4] [--seed 0] [--cover 0.82] [--edges ignore|clip] [--out FILE.slim]";

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::FAILURE
        }
    }
}

fn run(mut words: impl Iterator<Item = String>) -> Result<(), Box<dyn std::error::Error>> {
    let file = words.next().ok_or(USAGE)?;
    let mut options = Options::default();
    let mut out = None;
    while let Some(word) = words.next() {
        let value = words.next().ok_or(USAGE)?;
        match (word.as_str(), value.as_str()) {
            ("--error", _) => options.error = number(&word, &value)?,
            ("--seed", _) => options.seed = number(&word, &value)?,
            ("--cover", _) => options.cover = number(&word, &value)?,
            ("--edges", "ignore") => options.edges = Edges::Ignore,
            ("--edges", "clip") => options.edges = Edges::Clip,
            ("--out", _) => out = Some(value),
            _ => return Err(USAGE.into()),
        }
    }
    let start = Instant::now();
    let (cloud, dropped) = Cloud::read(Path::new(&file))?;
    println!("{file}: {dropped}; read in {:.2} s", start.elapsed().as_secs_f64());
    let (slim, summary) = build(&cloud, &options, &Progress::new())?;
    println!("{summary}");
    if let Some(out) = out {
        slim.write(Path::new(&out))?;
    }
    Ok(())
}

fn number<T: FromStr<Err: Display>>(word: &str, value: &str) -> Result<T, String> {
    value.parse().map_err(|e| format!("{word} cannot be {value:?}: {e}"))
}
