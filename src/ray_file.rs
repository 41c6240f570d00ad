//! Rays from CSV.

use std::io::Read;

use glam::Vec3;
use zeroset::raycast::Ray;

const COLUMNS: [&str; 6] = ["ox", "oy", "oz", "dx", "dy", "dz"];

/// Reads rays; an error names the line, the value and the limit.
pub(crate) fn read(mut file: impl Read) -> Result<Vec<Ray>, String> {
    let mut text = Vec::new();
    file.read_to_end(&mut text).map_err(|error| format!("cannot read: {error}"))?;
    rays(text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&text))
}

fn rays(text: &[u8]) -> Result<Vec<Ray>, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text);
    let columns = find_columns(reader.headers().map_err(|e| message(text, &e))?)?;
    let mut rays = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(|e| message(text, &e))? {
        rays.push(ray(&record, columns).map_err(|why| at(text, record.position(), &why))?);
    }
    Ok(rays)
}

/// The ray of a row.
fn ray(record: &csv::StringRecord, columns: [usize; 6]) -> Result<Ray, String> {
    let mut values = [0.0_f32; 6];
    for ((value, name), column) in values.iter_mut().zip(COLUMNS).zip(columns) {
        *value = number(name, &record[column])?;
    }
    let [ox, oy, oz, dx, dy, dz] = values;
    let ray = Ray::new(Vec3::new(ox, oy, oz), Vec3::new(dx, dy, dz));
    if ray.is_valid() {
        Ok(ray)
    } else {
        Err("the direction is zero in single precision; dx, dy or dz must not be".into())
    }
}

/// Where the six columns are.
fn find_columns(header: &csv::StringRecord) -> Result<[usize; 6], String> {
    let mut columns = [0; 6];
    for (place, name) in columns.iter_mut().zip(COLUMNS) {
        let mut places = (0..header.len()).filter(|&i| &header[i] == name);
        *place = places.next().ok_or_else(|| {
            let found = header.iter().collect::<Vec<_>>().join(",");
            format!("line 1: no column {name} in the header {found:?}; give {}", COLUMNS.join(","))
        })?;
        if places.next().is_some() {
            return Err(format!("line 1: the header has two columns {name}"));
        }
    }
    Ok(columns)
}

/// A finite number, rounded to single precision once.
fn number(name: &str, text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(x) if x.is_infinite() && text.parse().is_ok_and(f64::is_finite) => {
            Err(format!("{name} is {text}, beyond single precision (3.4e38)"))
        }
        Ok(_) => Err(format!("{name} is {text}; rays must be finite")),
        Err(_) => Err(format!("{name} is {text:?}, not a number")),
    }
}

/// What the CSV reader found wrong.
fn message(text: &[u8], error: &csv::Error) -> String {
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} fields where the header has {expected_len}")
        }
        csv::ErrorKind::Utf8 { .. } => "not UTF-8 text".into(),
        _ => error.to_string(),
    };
    at(text, error.position(), &what)
}

/// What is wrong, with its line. The reader's own count of lines omits blank ones before a row.
fn at(text: &[u8], position: Option<&csv::Position>, what: &str) -> String {
    let Some(position) = position else { return what.into() };
    let start = text.len().min(position.byte() as usize);
    let blank = text[start..].iter().take_while(|b| matches!(b, b'\r' | b'\n')).count();
    let line = 1 + text[..start + blank].iter().filter(|b| **b == b'\n').count();
    format!("line {line}: {what}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_and_rounded_once() {
        // 1 + 2^-24 + 2^-60 is above the middle of two floats, but a double would lose the last bit.
        let text =
            "dz,note,ox,oy,oz,dx,dy\r\n 0.1 ,hello, 1.00000005960464477625783128, 2,3,0,-0\r\n";
        let rays = read(text.as_bytes()).unwrap();
        let x = 1.0_f32.next_up();
        assert_eq!(rays, [Ray::new(Vec3::new(x, 2.0, 3.0), Vec3::new(0.0, 0.0, 0.1))]);
    }

    #[test]
    fn a_byte_order_mark_is_no_part_of_the_header() {
        assert_eq!(read("\u{feff}ox,oy,oz,dx,dy,dz\n0,0,0,1,0,0\n".as_bytes()).unwrap().len(), 1);
    }

    #[test]
    fn no_rays_are_no_error() {
        assert_eq!(read("ox,oy,oz,dx,dy,dz\n".as_bytes()), Ok(vec![]));
    }

    #[test]
    fn faults_are_named_with_their_line() {
        let header = "ox,oy,oz,dx,dy,dz";
        for (text, says) in [
            ("".to_owned(), "line 1: no column ox"),
            ("0,0,0,1,0,0\n".into(), "line 1: no column ox"),
            ("ox;oy;oz;dx;dy;dz\n".into(), "line 1: no column ox"),
            ("ox,oy,oz,dx,dy\n".into(), "line 1: no column dz"),
            (format!("ox,{header}\n"), "line 1: the header has two columns ox"),
            (format!("{header}\n0,0,0,1,0,0\n0,0,zero,1,0,0\n"), "line 3: oz is \"zero\""),
            (format!("{header}\n0,0,,1,0,0\n"), "line 2: oz is \"\""),
            (format!("{header}\n0,0,0,1,0\n"), "line 2: 5 fields where the header has 6"),
            (format!("{header}\n0,0,0,nan,0,0\n"), "line 2: dx is nan"),
            (format!("{header}\n0,0,0,1,0,-inf\n"), "line 2: dz is -inf"),
            (format!("{header}\n1e39,0,0,1,0,0\n"), "line 2: ox is 1e39, beyond"),
            (format!("{header}\n\n0,0,0,1e-60,0,-0\n"), "line 3: the direction is zero"),
            (format!("{header}\r\n\r\n0,0,0,0,0,0"), "line 3: the direction is zero"),
            (format!("{header},note\n0,0,0,1,0,0,\"a\nb\"\n0,0,0,0,0,0,\n"), "line 4: the dir"),
        ] {
            let error = read(text.as_bytes()).unwrap_err();
            assert!(error.starts_with(says), "{text:?}: {error}");
        }
        let error = read(&b"ox,oy,oz,dx,dy,dz\n0,0,0,\xff,0,0\n"[..]).unwrap_err();
        assert!(error.starts_with("line 2: not UTF-8"), "{error}");
    }
}
