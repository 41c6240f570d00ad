//! What the paper prints.

/// A surface of Figs. 2 to 4: its name there, its id, and its rows of Table I (512x512) and Table II
/// (1024x1024): frames a second on a GTX 470, uniform and adaptive, with 1 sample a pixel and with 4.
pub(crate) struct Surface {
    pub(crate) name: &'static str,
    pub(crate) id: &'static str,
    pub(crate) table_1: [f64; 4],
    pub(crate) table_2: [f64; 4],
}

const fn row(
    name: &'static str,
    id: &'static str,
    table_1: [f64; 4],
    table_2: [f64; 4],
) -> Surface {
    Surface { name, id, table_1, table_2 }
}

pub(crate) const SURFACES: [Surface; 12] = [
    row("Sphere", "sphere", [860.0, 1120.0, 280.0, 464.0], [300.0, 447.0, 79.0, 140.0]),
    row("Dingdong", "ding-dong-printed", [815.0, 947.0, 284.0, 425.0], [300.0, 412.0, 83.0, 142.0]),
    row("Klein", "klein", [274.0, 362.0, 76.0, 133.0], [88.0, 131.0, 21.0, 41.0]),
    row("Mitchell", "mitchell-ganacim", [189.0, 240.0, 45.0, 72.0], [54.0, 70.0, 13.0, 23.0]),
    row("Octdong", "octdong", [544.0, 660.0, 173.0, 267.0], [190.0, 263.0, 52.0, 87.0]),
    row("Steiner", "steiner-knoll", [532.0, 840.0, 168.0, 389.0], [180.0, 377.0, 48.0, 137.0]),
    row("Tangle", "tangle", [185.0, 244.0, 49.0, 86.0], [56.0, 85.0, 14.0, 27.0]),
    row("Teardrop", "teardrop", [842.0, 1287.0, 283.0, 580.0], [288.0, 555.0, 80.0, 196.0]),
    row("Barth", "barth-sextic", [235.0, 287.0, 67.0, 105.0], [77.0, 104.0, 20.0, 35.0]),
    row("Heart", "heart-taubin", [574.0, 806.0, 180.0, 339.0], [193.0, 332.0, 51.0, 110.0]),
    row("Chmutov", "chmutov-7", [212.0, 333.0, 50.0, 95.0], [60.0, 94.0, 13.0, 20.0]),
    row("Blob", "blinn-blob-ganacim", [781.0, 1322.0, 257.0, 570.0], [262.0, 545.0, 70.0, 182.0]),
];
