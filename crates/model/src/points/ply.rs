//! PLY, ascii and binary: the vertices' x, y, z, nx, ny, nz, and the faces' lists.

use glam::DVec3;

use super::{Fault, Raw, number};

/// The encoding of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

impl Kind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::Signed(1),
            "uchar" | "uint8" => Self::Unsigned(1),
            "short" | "int16" => Self::Signed(2),
            "ushort" | "uint16" => Self::Unsigned(2),
            "int" | "int32" => Self::Signed(4),
            "uint" | "uint32" => Self::Unsigned(4),
            "float" | "float32" => Self::Float(4),
            "double" | "float64" => Self::Float(8),
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) | Self::Float(size) => size,
        }
    }

    fn value(self, little: [u8; 8]) -> f64 {
        let raw = u64::from_le_bytes(little);
        match self {
            Self::Signed(size) => {
                let shift = 64 - 8 * size as u32;
                ((raw << shift) as i64 >> shift) as f64
            }
            Self::Unsigned(_) => raw as f64,
            Self::Float(4) => f64::from(f32::from_bits(raw as u32)),
            Self::Float(_) => f64::from_bits(raw),
        }
    }
}

struct Property {
    name: String,
    kind: Kind,
    /// The type of a list's length.
    length: Option<Kind>,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Numbers, one after another.
struct Numbers<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
}

impl Numbers<'_> {
    fn next(&mut self, kind: Kind) -> Result<f64, Fault> {
        if self.encoding == Encoding::Ascii {
            let rest = &self.bytes[self.at..];
            let start = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
            let word = &rest[start..];
            let end = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
            let text = String::from_utf8_lossy(&word[..end]);
            let value = number(&text).ok_or_else(|| {
                let what = if text.is_empty() { "the end of the file" } else { text.as_ref() };
                self.fault(format!("a number was expected, not {what:?}"))
            })?;
            self.at += start + end;
            return Ok(value);
        }
        let size = kind.size();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else {
            return Err(self.fault("the file ends within the data: it is cut off".into()));
        };
        let mut little = [0; 8];
        little[..size].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            little[..size].reverse();
        }
        self.at += size;
        Ok(kind.value(little))
    }

    fn fault(&self, why: String) -> Fault {
        (format!("byte {}", self.at), why)
    }

    /// The least bytes that are left for each of so many rows.
    fn has_room(&self, rows: usize) -> bool {
        rows <= self.bytes.len() - self.at.min(self.bytes.len())
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Raw, Fault> {
    let (encoding, elements, at) = header(bytes)?;
    let mut numbers = Numbers { bytes, at, encoding };
    let mut raw = Raw::default();
    for element in elements {
        if element.properties.is_empty() {
            continue;
        }
        if !numbers.has_room(element.count) {
            let (count, name) = (element.count, &element.name);
            return Err(numbers.fault(format!("{count} rows of {name} do not fit in the file")));
        }
        let place = |name: &str| element.properties.iter().position(|p| p.name == name);
        let points = ["x", "y", "z"].map(place);
        let normals = ["nx", "ny", "nz"].map(place);
        if element.name == "vertex" && points.contains(&None) {
            return Err(("header".into(), "a vertex has no x, y and z".into()));
        }
        let mut row = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            for (property, value) in element.properties.iter().zip(&mut row) {
                let Some(length) = property.length else {
                    *value = numbers.next(property.kind)?;
                    continue;
                };
                let count = numbers.next(length)?;
                if !(count >= 0.0 && numbers.has_room(count as usize)) {
                    return Err(numbers.fault(format!("a list of {count} numbers does not fit")));
                }
                let mut corners = Vec::new();
                for _ in 0..count as usize {
                    let index = numbers.next(property.kind)?;
                    if element.name == "face" && property.name.starts_with("vert") {
                        if !(index >= 0.0 && (index as usize) < raw.points.len()) {
                            return Err(numbers.fault(format!("there is no vertex {index}")));
                        }
                        corners.push(index as usize);
                    }
                }
                for i in 2..corners.len() {
                    raw.faces.push([corners[0], corners[i - 1], corners[i]]);
                }
            }
            if element.name == "vertex" {
                let vector = |places: [Option<usize>; 3]| {
                    let [x, y, z] = places.map(|i| i.map(|i| row[i]));
                    x.zip(y).zip(z).map(|((x, y), z)| DVec3::new(x, y, z))
                };
                raw.points.extend(vector(points));
                raw.normals.extend(vector(normals));
            }
        }
    }
    Ok(raw)
}

fn header(bytes: &[u8]) -> Result<(Encoding, Vec<Element>, usize), Fault> {
    let (mut at, mut encoding) = (0, None);
    let mut elements: Vec<Element> = Vec::new();
    for number in 1.. {
        let fault = |why: String| (format!("line {number}"), why);
        let end = bytes[at..].iter().position(|b| *b == b'\n');
        let Some(end) = end else {
            return Err(fault("the file ends before end_header".into()));
        };
        let line = String::from_utf8_lossy(&bytes[at..at + end]).into_owned();
        at += end + 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["ply"] | ["comment" | "obj_info", ..] | [] => {}
            ["format", name, _] => {
                encoding = match name {
                    "ascii" => Some(Encoding::Ascii),
                    "binary_little_endian" => Some(Encoding::Little),
                    "binary_big_endian" => Some(Encoding::Big),
                    _ => return Err(fault(format!("no format is {name:?}"))),
                };
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| fault(format!("{count:?} is no count")))?;
                elements.push(Element { name: name.into(), count, properties: Vec::new() });
            }
            ["property", .., name] => {
                let kinds: Option<Vec<Kind>> = words[1..words.len() - 1]
                    .iter()
                    .filter(|word| **word != "list")
                    .map(|word| Kind::named(word))
                    .collect();
                let is_list = words[1] == "list";
                let (length, kind) = match kinds.as_deref() {
                    Some([kind]) if !is_list => (None, *kind),
                    Some([length, kind]) if is_list => (Some(*length), *kind),
                    _ => return Err(fault(format!("no property is {line:?}"))),
                };
                let Some(element) = elements.last_mut() else {
                    return Err(fault("a property before any element".into()));
                };
                element.properties.push(Property { name: name.into(), kind, length });
            }
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| fault("there is no format".into()))?;
                return Ok((encoding, elements, at));
            }
            _ => return Err(fault(format!("{line:?} is nothing of a header"))),
        }
    }
    unreachable!("a file ends")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn header(format: &str) -> String {
        format!(
            "ply\nformat {format} 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\n\
             property double y\nproperty short z\nproperty uchar grey\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n"
        )
    }

    fn binary(is_big: bool) -> Vec<u8> {
        let format = if is_big { "binary_big_endian" } else { "binary_little_endian" };
        let mut bytes = header(format).into_bytes();
        let mut push = |mut value: Vec<u8>| {
            if is_big {
                value.reverse();
            }
            bytes.extend(value);
        };
        for [x, y, z] in [[0.0, 0.0, 1.0], [1.0, 0.0, -2.0], [0.5, 2.0, 3.0]] {
            push((x as f32).to_le_bytes().into());
            push(f64::to_le_bytes(y).into());
            push((z as i16).to_le_bytes().into());
            push(vec![200]);
        }
        push(vec![3]);
        for i in [0_i32, 1, 2] {
            push(i.to_le_bytes().into());
        }
        bytes
    }

    #[test]
    fn every_encoding_is_read() {
        let ascii = header("ascii") + "0 0 1 200\n1 0 -2 200 0.5 2 3 200\n3 0 1 2\n";
        let raw = read(ascii.as_bytes()).unwrap();
        assert_eq!(raw.points[1..], [DVec3::new(1.0, 0.0, -2.0), DVec3::new(0.5, 2.0, 3.0)]);
        assert_eq!(raw.faces, [[0, 1, 2]]);
        assert_eq!(read(&binary(false)).unwrap(), raw);
        assert_eq!(read(&binary(true)).unwrap(), raw);
    }

    #[test]
    fn counts_are_not_believed() {
        let huge = header("ascii").replace("vertex 3", "vertex 99999999999999");
        assert!(read(huge.as_bytes()).unwrap_err().1.contains("do not fit"));
        let list = header("ascii") + "0 0 1 2 0 0 1 2 0 0 1 2 99999999 1";
        assert!(read(list.as_bytes()).unwrap_err().1.contains("does not fit"));
        let cut = binary(false);
        assert!(read(&cut[..cut.len() - 1]).unwrap_err().1.contains("cut off"));
        let far = header("ascii") + "0 0 1 2 0 0 1 2 0 0 1 2 3 0 1 7";
        assert!(read(far.as_bytes()).unwrap_err().1.contains("no vertex 7"));
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_fail_badly(
            place in 0..400_usize,
            byte: u8,
            end in 0..400_usize,
            kind in 0..3,
        ) {
            let mut bytes = match kind {
                0 => binary(false),
                1 => binary(true),
                _ => (header("ascii") + "0 0 1 2 0 0 1 2 0 0 1 2 3 0 1 2").into_bytes(),
            };
            if let Some(b) = bytes.get_mut(place) {
                *b = byte;
            }
            bytes.truncate(end);
            let _ = read(&bytes);
        }
    }
}
