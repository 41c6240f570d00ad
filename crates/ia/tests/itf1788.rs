//! Every operation that has test vectors of the IEEE 1788 community passes them: one test a file.

#[path = "../examples/conformance/vectors.rs"]
mod vectors;

use std::path::Path;

use vectors::{Arithmetic, Tally};
use zeroset_ia::{Isa, Rounding};

/// The largest slack of an operation in units in the last place.
fn slack(op: &str, arithmetic: Arithmetic) -> f64 {
    let is_embedded = arithmetic == Arithmetic::Lanes(Isa::Avx512, Rounding::Outward);
    match op {
        "abs" | "ceil" | "convexHull" | "floor" | "intersection" | "max" | "min" | "neg"
        | "sign" => 0.0,
        "add" | "sub" | "mul" | "div" | "recip" | "sqr" | "sqrt" if is_embedded => 0.0,
        "add" | "sub" | "mul" | "div" | "recip" | "sqr" | "sqrt" => 1.0,
        _ if arithmetic == Arithmetic::Double => 2.0,
        _ => 1.0,
    }
}

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
        assert_eq!(tally.unbounded, 0, "{arithmetic}");
        assert!(tally.worst() <= slack(op, arithmetic), "{arithmetic}: {}", tally.worst());
        assert_eq!(tally.rows - tally.run, skipped, "{:?}", tally.skipped);
    }
}

macro_rules! files {
    ($($op:ident $skipped:literal,)*) => { $(
        #[test]
        #[allow(non_snake_case)]
        fn $op() {
            check(stringify!($op), $skipped);
        }
    )* };
}

files! {
    abs 0, acos 0, acosh 0, add 1, asin 0, asinh 0, atan 0, atan2 0, atanh 0, ceil 0, convexHull 0,
    cos 0, cosh 0, div 1, exp 0, exp10 0, exp2 0, floor 0, intersection 0, log 0, log10 0, log2 0, max 0, min 0, mul 1, neg 1, pow 0,
    pown 0, recip 0, sign 0, sin 0, sinh 0, sqr 0, sqrt 0, sub 1, tan 0, tanh 0,
}

/// The tally of the rows of a file in single precision, and the place of the file.
fn judged(name: &str, text: &str) -> Tally {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&file, text).unwrap();
    Tally::of(&vectors::read(&file).unwrap(), Arithmetic::Single)
}

#[test]
fn the_form_with_results_in_single_precision_is_read() {
    let tally = judged(
        "rounded.csv",
        "op,a0,b0,a1,b1,n,lo32,hi32\n\
         add,1,2,0x1p-1,0.5,,1.5,2.5\n\
         pown,-2,3,,,2,0,9\n\
         sqrt,empty,empty,,,,empty,empty\n\
         log,-inf,0,,,,empty,empty\n\
         fma,1,1,1,1,,2,2\n",
    );
    assert_eq!((tally.rows, tally.run, tally.violations.len()), (5, 4, 0), "{tally:?}");
    assert_eq!(tally.skipped.into_iter().collect::<Vec<_>>(), [("no operation fma".into(), 1)]);
}

#[test]
fn what_is_wrong_is_told() {
    let header = "op,k0,a0,b0,d0,k1,a1,b1,d1,ok0,oa0,ob0,od0\n";
    for (row, is_wrong) in [
        ("add,iv,1,1,com,iv,2,2,com,iv,3,3,com", false),
        ("add,iv,1,1,com,iv,2,2,com,iv,3,3.5,com", true),
        ("add,iv,1,1,com,iv,2,2,com,iv,-inf,3,com", true),
        ("sqrt,iv,-1,1,com,,,,,iv,0,1,trv", false),
        // Too weak a decoration is sound, too strong a one is not.
        ("sqrt,iv,-1,1,com,,,,,iv,0,1,com", false),
        ("sqrt,iv,1,4,com,,,,,iv,1,2,def", true),
        ("sqrt,iv,-2,-1,com,,,,,iv,0,0,trv", true),
    ] {
        let tally = judged("wrong.csv", &format!("{header}{row}\n"));
        assert_eq!((tally.run, tally.violations.len()), (1, usize::from(is_wrong)), "{row}");
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for (text, says) in [("x,y\n1,2\n", "columns op and a0"), ("op,a0\nadd,one\n", "no number")] {
        let file = folder.join("unreadable.csv");
        std::fs::write(&file, text).unwrap();
        let error = vectors::read(&file).unwrap_err();
        assert!(error.contains("unreadable.csv") && error.contains(says), "{error}");
    }
}
