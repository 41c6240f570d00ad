//! Whatever the bytes of a file, there is a sound cloud or a message, soon and in little memory.

mod octahedron;

use octahedron::{Coding, Normals, gzipped, obj, ply};
use proptest::prelude::*;
use zeroset_model::points::Cloud;

/// A file of each format and how it can be broken: bytes changed, words swapped for others, cut, repeated.
fn broken() -> impl Strategy<Value = (&'static str, Vec<u8>)> {
    let seeds = vec![
        ("a.ply", ply(Coding::Ascii, Normals::Absent)),
        ("a.ply", ply(Coding::Ascii, Normals::Given)),
        ("a.ply", ply(Coding::Little, Normals::Absent)),
        ("a.ply", ply(Coding::Big, Normals::Given)),
        ("a.obj", obj(Normals::Given, |i| format!("{0}/1/{0}", i + 1)).into_bytes()),
        ("a.obj", obj(Normals::Absent, |i| format!("{}", i as i32 - 6)).into_bytes()),
        ("a.xyz", b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n".to_vec()),
        ("a.xyz", b"0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n".to_vec()),
        ("a.obj.gz", gzipped(obj(Normals::Absent, |i| format!("{}", i + 1)).as_bytes())),
        ("a.ply.gz", gzipped(&ply(Coding::Little, Normals::Absent))),
    ];
    let words = prop::sample::select(vec![
        "-1",
        "0",
        "nan",
        "inf",
        "1e308",
        "1e-308",
        "4294967295",
        "99999999999999999999",
        "-2147483648",
        "\n",
        "\r",
        "/",
        "//",
        "#",
        "list",
        "uchar",
        "double",
        "element",
        "vertex",
        "property",
        "\u{e4}",
        "end_header\n",
        "element a 9999999999\n",
        "f",
        "v",
        "vn",
    ]);
    let change = prop_oneof![
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Change::Byte(at, byte)),
        (any::<usize>(), words).prop_map(|(at, word)| Change::Word(at, word)),
        any::<usize>().prop_map(Change::Cut),
        (any::<usize>(), any::<usize>()).prop_map(|(a, b)| Change::Repeat(a, b)),
    ];
    (prop::sample::select(seeds), prop::collection::vec(change, 1..4)).prop_map(
        |(seed, changes)| {
            let (name, mut bytes) = seed;
            changes.iter().for_each(|change| change.apply(&mut bytes));
            (name, bytes)
        },
    )
}

#[derive(Clone, Debug)]
enum Change {
    Byte(usize, u8),
    Word(usize, &'static str),
    Cut(usize),
    Repeat(usize, usize),
}

impl Change {
    fn apply(&self, bytes: &mut Vec<u8>) {
        let length = bytes.len().max(1);
        match *self {
            Self::Byte(at, byte) => {
                bytes.iter_mut().skip(at % length).take(1).for_each(|b| *b = byte);
            }
            Self::Word(at, word) => {
                // The word at the place is replaced.
                let start = (at % length).min(bytes.len());
                let end = bytes[start..].iter().position(u8::is_ascii_whitespace);
                let end = end.map_or(bytes.len(), |n| start + n);
                bytes.splice(start..end, word.bytes());
            }
            Self::Cut(at) => bytes.truncate(at % length),
            Self::Repeat(a, b) => {
                let (a, b) = (a % length, b % length);
                let part = bytes[a.min(b)..a.max(b)].to_vec();
                bytes.splice(a.min(b)..a.min(b), part);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20000))]

    /// Whatever the bytes, there is a sound cloud or a message, soon.
    #[test]
    fn broken_files_do_no_harm((name, bytes) in broken()) {
        match Cloud::parse(name, bytes) {
            Ok((cloud, _)) => {
                prop_assert!(cloud.points.len() >= 2);
                prop_assert_eq!(cloud.points.len(), cloud.normals.len());
                prop_assert!(cloud.points.iter().all(|p| p.is_finite()));
                prop_assert!(cloud.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-9));
            }
            Err(error) => {
                let said = error.to_string();
                prop_assert!(said.starts_with(name) && said.len() < 400, "{}", said);
                prop_assert!(!said.contains('\n'), "{}", said);
            }
        }
    }
}
