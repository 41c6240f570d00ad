//! A comparison as tables for people; records hold the exact numbers.

use std::time::Duration;

use comfy_table::{CellAlignment, Table, presets};
use zeroset::bench::{Class, Comparison, Outcome, Run, Truths, Verdict};
use zeroset::raycast::Certificate;

use crate::numbers::{percent, short};

/// What the columns mean, for `--help`.
pub(crate) const LEGEND: &str = "\
The tables:
  prepare          time to compile the method for the surface
  frame, min..max  median time of the timed frames after one warm-up, and their range
  Mrays/s          rays of the median frame a second, in millions
  points, gradients, intervals  evaluations of the function a ray, by kind
  proven-hit       the bracket holds a root and nothing before it is one
  possible-hit     there is no root before the bracket; it may hold none
  root-hit         the bracket holds a root; an earlier one may have been missed
  hit              something was found, nothing proved
  proven-miss      there is no root in the whole range
  miss             nothing was found, nothing proved
  false misses     misses where the reference proves a root (in brackets: where it only touches)
  false hits       hits where there is no root (in brackets: nor in any neighbouring pixel)
  wrong sheets     hits further from the first root than a pixel's width there
  undecided        rays on which the reference does not know
  lies             certificates that the reference refutes: the worst fault
  |dt|             distance from the first root to the middle of the bracket, along the ray";

/// The tables, one below the other.
pub(crate) fn tables(comparison: &Comparison, rays: usize) -> String {
    let outcomes: Vec<_> = comparison
        .runs
        .iter()
        .filter_map(|run| run.outcome.as_ref().ok().map(|outcome| (run, outcome)))
        .collect();
    let mut parts = Vec::new();
    if !outcomes.is_empty() {
        parts.push(cost(&outcomes, rays));
        parts.push(certificates(&outcomes, rays));
    }
    let known = [(&comparison.truths, "rays"), (&comparison.footprints, "pixels")];
    let known: Vec<_> = known
        .iter()
        .filter_map(|(truths, what)| Some(sampling(truths.as_ref()?, what, rays)))
        .collect();
    match &comparison.no_truth {
        Some(why) => parts.push(format!("Not judged: {why}")),
        None if known.is_empty() || outcomes.is_empty() => {}
        None => parts.push(format!("{}\n\n{}", known.join("\n"), judged(&outcomes))),
    }
    for run in &comparison.runs {
        if let Err(error) = &run.outcome {
            parts.push(format!("{}: {error}", run.method));
        }
    }
    parts.join("\n\n")
}

type Rows<'a> = [(&'a Run, &'a Outcome)];

fn cost(outcomes: &Rows<'_>, rays: usize) -> String {
    let mut table = table(&[
        "method",
        "prepare ms",
        "frame ms",
        "min..max ms",
        "Mrays/s",
        "points",
        "gradients",
        "intervals",
    ]);
    for (run, outcome) in outcomes {
        let a_ray = |count: u64| short(count as f64 / rays.max(1) as f64);
        let mut row = vec![run.method.to_owned(), short(milliseconds(outcome.prepare))];
        row.extend(match outcome.times {
            Some(times) => [
                short(milliseconds(times.median)),
                format!("{}..{}", short(milliseconds(times.min)), short(milliseconds(times.max))),
                short(times.mrays_per_second(rays)),
            ],
            None => ["-", "-", "-"].map(String::from),
        });
        let work = outcome.work;
        row.extend([work.points, work.gradients, work.intervals].map(a_ray));
        table.add_row(row);
    }
    table.to_string()
}

fn certificates(outcomes: &Rows<'_>, rays: usize) -> String {
    let mut header = vec!["method", "hits"];
    header.extend(Certificate::ALL.map(Certificate::name));
    let mut table = table(&header);
    for (run, outcome) in outcomes {
        let mut row = vec![run.method.to_owned(), outcome.hit_count().to_string()];
        row.extend(outcome.certificates.map(|count| percent(count, rays)));
        table.add_row(row);
    }
    table.to_string()
}

/// What was judged, in words: rays, or pixels by 16 rays each.
fn sampling(truths: &Truths, what: &str, rays: usize) -> String {
    let [crossed, touched, none, undecidable] = truths.classes();
    let which = if truths.sample.is_all() {
        format!("all {rays} {what}")
    } else {
        format!(
            "every {} of the {what} in both axes, {} of {rays}, for the reference is slow here",
            ordinal(truths.sample.step),
            truths.truths.len()
        )
    };
    let how = if what == "pixels" { ", by 16 rays of each" } else { "" };
    let mut text = format!(
        "Judged against the reference on {which}{how}: {crossed} cross the surface first, \
         {touched} touch it, {none} miss"
    );
    if undecidable > 0 {
        text += &format!(", {undecidable} are undecidable");
    }
    text
}

fn ordinal(n: usize) -> String {
    match (n % 10, n % 100) {
        (1, r) if r != 11 => format!("{n}st"),
        (2, r) if r != 12 => format!("{n}nd"),
        (3, r) if r != 13 => format!("{n}rd"),
        _ => format!("{n}th"),
    }
}

fn judged(outcomes: &Rows<'_>) -> String {
    let mut table = table(&[
        "method",
        "false misses",
        "false hits",
        "wrong sheets",
        "undecided",
        "lies",
        "median |dt|",
        "worst |dt|",
    ]);
    for (run, outcome) in outcomes {
        let Some(judgement) = &outcome.judgement else { continue };
        let tally = &judgement.tally;
        let distance = |dt: Option<f64>| dt.map_or("-".into(), short);
        table.add_row([
            run.method.to_owned(),
            with_part(
                tally.count(Verdict::FalseMiss),
                Some(tally.count_in(Class::Tangential, Verdict::FalseMiss)),
            ),
            with_part(tally.count(Verdict::FalseHit), tally.clear_false_hits),
            tally.count(Verdict::WrongSheet).to_string(),
            tally.count(Verdict::Undecided).to_string(),
            tally.lies.to_string(),
            distance(tally.median_dt),
            distance(tally.worst_dt),
        ]);
    }
    format!(
        "{table}\n\nIn brackets: misses of roots that only touch, hits without a root in any \
         neighbouring pixel"
    )
}

/// A count, and in brackets a part of it.
fn with_part(count: usize, part: Option<usize>) -> String {
    match part {
        Some(part) if count > 0 => format!("{count} ({part})"),
        _ => count.to_string(),
    }
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// An empty table that is also Markdown: the first column to the left, numbers to the right.
fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::ASCII_MARKDOWN).set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
