//! Every row of the tables of \[singh2010\] is one surface of the catalogue.

use zeroset_raycast::catalogue::{Catalogue, Surface};

/// Table 1: what a row is called, with its order if it is algebraic; its step; and the surface, the
/// corrected one where an equation is misprinted.
const TABLE_1: [(&str, f64, &str); 45] = [
    ("Chmutov [50]", 0.01, "chmutov-50"),
    ("Chmutov [22]", 0.01, "chmutov-22"),
    ("Chmutov [18]", 0.01, "chmutov-18"),
    ("Chmutov [14]", 0.01, "chmutov-14"),
    ("Chmutov [12]", 0.01, "chmutov-12"),
    ("Sarti [12]", 0.015, "sarti-dodecic"),
    ("Barth [10]", 0.015, "barth-decic"),
    ("Chmutov [9]", 0.015, "chmutov-9"),
    ("Endrass [8]", 0.01, "endrass-octic-minus"),
    ("Nonisol [8]", 0.01, "nonisol"),
    ("Chmutov [8]", 0.02, "chmutov-8"),
    ("Chmutov [7]", 0.02, "chmutov-7"),
    ("Labs [7]", 0.015, "labs-septic"),
    ("Chmutov [6]", 0.02, "chmutov-6"),
    ("Hunt [6]", 0.01, "hunt"),
    ("Barth [6]", 0.02, "barth-sextic"),
    ("Heart [6]", 0.02, "heart-singh"),
    ("Kleine [6]", 0.02, "klein"),
    ("High Silhouette [6]", 0.02, "high-silhouette"),
    ("Dervish [5]", 0.02, "dervish"),
    ("Kiss [5]", 0.02, "kiss"),
    ("Peninsula [5]", 0.03, "peninsula"),
    ("Steiner [4]", 0.02, "steiner"),
    ("Cassini [4]", 0.02, "cassini"),
    ("Tooth [4]", 0.03, "tooth"),
    ("Piriform [4]", 0.02, "piriform"),
    ("Cross-Cap [4]", 0.02, "cross-cap"),
    ("Miter [4]", 0.02, "miter"),
    ("Kummer [4]", 0.02, "kummer"),
    ("Goursat [4]", 0.04, "goursat"),
    ("Cushion [4]", 0.02, "cushion"),
    ("Nordstrands [4]", 0.03, "nordstrand"),
    ("Cayley [3]", 0.03, "cayley"),
    ("Clebsch [3]", 0.03, "clebsch"),
    ("Ding-Dong [3]", 0.03, "ding-dong"),
    ("Chmutov 50", 0.01, "chmutov-50-cosine"),
    ("Chmutov 22", 0.01, "chmutov-22-cosine"),
    ("Chmutov 18", 0.01, "chmutov-18-cosine"),
    ("Chmutov 14", 0.01, "chmutov-14-cosine"),
    ("Torus", 0.04, "torus-sqrt"),
    ("Superquadric", 0.02, "superquadric-2p5"),
    ("Blobby", 0.05, "blobby"),
    ("Blinn's Blobby", 0.05, "blinn-blobby-75"),
    ("Scherk", 0.03, "scherk"),
    ("Diamond", 0.04, "diamond"),
];

/// Table 2: surfaces in common with an interval method.
const TABLE_2: [&str; 8] = [
    "steiner-knoll",
    "teardrop",
    "tangle",
    "barth-sextic",
    "klein",
    "mitchell",
    "barth-decic",
    "superquadric-2p5",
];

/// Table 3: surfaces on the CPU.
const TABLE_3: [&str; 11] = [
    "ding-dong",
    "nordstrand",
    "torus",
    "dervish",
    "kiss",
    "chmutov-6",
    "heart-singh",
    "chmutov-8",
    "barth-decic",
    "chmutov-18",
    "chmutov-50-cosine",
];

/// The surfaces that say that they are in a table, with their rows, in the order of rows.
fn rows(table: u32) -> Vec<(usize, &'static Surface)> {
    let prefix = format!("singh2010 Table {table}");
    let mut rows = Vec::new();
    for surface in Catalogue::builtin().iter() {
        for rest in surface.papers.iter().filter_map(|paper| paper.strip_prefix(&prefix)) {
            let row = rest.strip_prefix(" row ").and_then(|row| row.parse().ok());
            rows.push((row.unwrap_or_else(|| panic!("{}: no row", surface.id)), surface));
        }
    }
    rows.sort_by_key(|(row, _)| *row);
    rows
}

fn check<'a>(table: u32, expected: impl IntoIterator<Item = &'a str>) {
    let found: Vec<(usize, &str)> =
        rows(table).into_iter().map(|(row, surface)| (row, surface.id.as_str())).collect();
    let expected: Vec<(usize, &str)> = (1..).zip(expected).collect();
    assert_eq!(found, expected, "Table {table}");
}

#[test]
fn every_row_is_one_surface() {
    check(1, TABLE_1.map(|(_, _, id)| id));
    check(2, TABLE_2);
    check(3, TABLE_3);
}

#[test]
fn rows_have_the_order_and_the_step_that_are_printed() {
    for ((row, surface), (printed, step, _)) in rows(1).into_iter().zip(TABLE_1) {
        let order = printed.split_once('[').map(|(_, n)| n.trim_end_matches(']').parse().unwrap());
        assert_eq!(surface.degree, order, "row {row}, {printed}: {}", surface.id);
        assert_eq!(surface.published_step, Some(step), "row {row}, {printed}: {}", surface.id);
    }
    let algebraic = rows(1).into_iter().filter(|(_, surface)| surface.degree.is_some());
    assert_eq!(algebraic.count(), 35);
}

/// A step that stands beside no row is that of a variant or another form.
#[test]
fn steps_come_from_rows() {
    let rows = rows(1);
    let is_row = |surface: &Surface| rows.iter().any(|(_, row)| row.id == surface.id);
    for surface in Catalogue::builtin().iter() {
        let relatives = |other: &&Surface| {
            let names = |a: &Surface, b: &Surface| {
                [&a.variant_of, &a.form_of].into_iter().flatten().any(|id| *id == b.id)
            };
            is_row(other) && (names(surface, other) || names(other, surface))
        };
        if is_row(surface) || surface.published_step.is_none() {
            continue;
        }
        let steps = Catalogue::builtin().iter().filter(relatives).map(|s| s.published_step);
        let steps: Vec<_> = steps.collect();
        assert!(steps.contains(&surface.published_step), "{}: {steps:?}", surface.id);
    }
}
