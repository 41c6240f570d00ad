//! Judges interval operations by a folder of test vectors.
//!
//! `cargo run --release -p zeroset-ia --example conformance -- DIR` reads every CSV file of the folder
//! (the forms are in `vectors.rs`) and prints, for each operation and arithmetic: rows, rows run,
//! violations, results that are unbounded without need, mean and worst slack in units in the last place;
//! then why rows were skipped. The exit status is 1 if there is a violation, 2 if nothing could be read.

mod vectors;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use vectors::{Arithmetic, Row, Tally};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder] = &arguments[..] else {
        eprintln!("usage: conformance DIR, a folder of CSV files of test vectors");
        return ExitCode::from(2);
    };
    match rows(Path::new(folder)) {
        Ok(rows) => report(&rows),
        Err(fault) => {
            eprintln!("error: {fault}");
            ExitCode::from(2)
        }
    }
}

/// The rows of all files of a folder, by operation.
fn rows(folder: &Path) -> Result<BTreeMap<String, Vec<Row>>, String> {
    let fault = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .map_err(fault)?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()
        .map_err(fault)?;
    files.retain(|file| file.extension().is_some_and(|e| e == "csv"));
    files.sort();
    if files.is_empty() {
        return Err(format!("{}: there is no CSV file", folder.display()));
    }
    let mut rows: BTreeMap<String, Vec<Row>> = BTreeMap::new();
    for row in files.iter().map(|file| vectors::read(file)).collect::<Result<Vec<_>, _>>()?.concat()
    {
        rows.entry(row.op.clone()).or_default().push(row);
    }
    Ok(rows)
}

fn report(rows: &BTreeMap<String, Vec<Row>>) -> ExitCode {
    println!(
        "{:12} {:16} {:>6} {:>6} {:>10} {:>9} {:>10} {:>10}",
        "operation",
        "arithmetic",
        "rows",
        "run",
        "violations",
        "unbounded",
        "mean ulp",
        "worst ulp"
    );
    let mut skipped = Vec::new();
    let mut violations = Vec::new();
    for (op, rows) in rows {
        for arithmetic in Arithmetic::all() {
            let tally = Tally::of(rows, arithmetic);
            println!(
                "{op:12} {arithmetic:16} {:6} {:6} {:10} {:9} {:10.3} {:10}",
                tally.rows,
                tally.run,
                tally.violations.len(),
                tally.unbounded,
                tally.mean(),
                tally.worst()
            );
            for (why, count) in &tally.skipped {
                skipped.push(format!("{op}, {arithmetic}: {count} ({why})"));
            }
            violations
                .extend(tally.violations.into_iter().map(|how| format!("{arithmetic}: {how}")));
        }
    }
    for (title, list) in [("Skipped", &skipped), ("Violations", &violations)] {
        if !list.is_empty() {
            println!("\n{title}:");
            list.iter().for_each(|line| println!("  {line}"));
        }
    }
    if violations.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
