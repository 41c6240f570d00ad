//! Every operation that has test vectors of the IEEE 1788 community passes them: one test a file.

#[path = "../examples/conformance/vectors.rs"]
mod vectors;

use std::path::Path;

use vectors::{Arithmetic, Tally};

/// Runs all rows of a file on all arithmetics; each must run, but for `skipped` rows, which are about what
/// is no interval (NaI).
fn check(op: &str, skipped: usize) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/itf1788");
    let rows = vectors::read(&folder.join(format!("{op}.csv"))).unwrap();
    assert!(rows.len() > 5, "{} rows", rows.len());
    for arithmetic in Arithmetic::all() {
        let tally = Tally::of(&rows, arithmetic);
        println!(
            "{op} {arithmetic}: {} rows, {} run, skipped {:?}, {} unbounded, slack mean {:.3}, worst {}",
            tally.rows,
            tally.run,
            tally.skipped,
            tally.unbounded,
            tally.mean(),
            tally.worst()
        );
        assert_eq!(tally.violations, [""; 0], "{arithmetic}");
        assert_eq!(tally.rows - tally.run, skipped, "{:?}", tally.skipped);
    }
}

macro_rules! files {
    ($($op:ident $skipped:literal,)*) => { $(
        #[test]
        fn $op() {
            check(stringify!($op), $skipped);
        }
    )* };
}

files! {
    abs 0, acos 0, acosh 0, add 1, asin 0, asinh 0, atan 0, atan2 0, atanh 0, ceil 0, cos 0, cosh 0,
    div 1, exp 0, exp10 0, exp2 0, floor 0, log 0, log10 0, log2 0, max 0, min 0, mul 1, neg 1, pow 0,
    pown 0, recip 0, sign 0, sin 0, sinh 0, sqr 0, sqrt 0, sub 1, tan 0, tanh 0,
}
