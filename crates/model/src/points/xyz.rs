//! XYZ: a point a line, with or without its normal.

use super::text::lines;
use super::{Error, raw::Raw};

/// Reads `x y z` or `x y z nx ny nz` a line, the same on all.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Raw, Error> {
    let mut raw = Raw::default();
    let mut normals = Vec::new();
    let mut first = None;
    for line in lines(file, bytes) {
        let count = line.words().count();
        if count != 3 && count != 6 {
            let what = format!("{count} words where a point has 3 numbers, or 6 with its normal");
            return Err(line.error(what, "delete other columns; comments start with #"));
        }
        if *first.get_or_insert(count) != count {
            let what = format!("{count} numbers where lines before have {}", 9 - count);
            return Err(line.error(what, "give all points a normal, or none"));
        }
        let mut words = line.words();
        raw.points.push(line.vector(&mut words)?);
        if count == 6 {
            normals.push(line.vector(&mut words)?);
        }
    }
    raw.normals = (!normals.is_empty()).then_some(normals);
    Ok(raw)
}
