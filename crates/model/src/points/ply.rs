//! PLY: polygons and points, in text or binary.

use std::io::ErrorKind;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
};

use super::faces::Faces;
use super::raw::Raw;
use super::text::quoted;
use super::{Error, Place};

type Bytes<'a> = Reader<&'a [u8]>;

/// A vertex: its place, then its normal.
#[derive(Debug)]
struct Vertex([f64; 6]);

/// The indices of a face.
#[derive(Debug)]
struct Face(Vec<u32>);

/// An element that is passed over.
#[derive(Debug)]
struct Other;

const NAMES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Reads the elements `vertex` and `face`.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Raw, Error> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<Other>::new().read_header(&mut reader);
    let header = header.map_err(|e| said(file, &e, Place::Line(reader.line().max(1))))?;
    let start = bytes.len() - reader.get_ref().len();
    let complaint = |what: String, remedy: &str| Error::new(file, Place::Byte(start), what, remedy);

    // The parser believes counts; each element takes a byte at least.
    for element in header.elements.values() {
        let (name, count) = (&element.name, element.count);
        if count > 0 && element.properties.is_empty() {
            let what = format!("{count} elements {name} have no properties");
            return Err(complaint(what, "delete the element"));
        }
        if count > bytes.len() - start {
            let what = format!("{count} elements {name} in {} bytes", bytes.len() - start);
            return Err(complaint(what, "the file is cut short, or its header is wrong"));
        }
    }
    let has = |name: &str| {
        let vertex = header.elements.get("vertex");
        let property = vertex.and_then(|v| v.properties.get(name));
        property.is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)))
    };
    if !NAMES[..3].iter().all(|name| has(name)) {
        let what = "there is no element vertex with the numbers x, y and z".into();
        return Err(complaint(what, "correct the header"));
    }
    let normals = NAMES[3..].iter().all(|name| has(name));

    let mut raw = Raw { normals: normals.then(Vec::new), ..Raw::default() };
    let body = Body { file, length: bytes.len(), header: &header };
    for element in header.elements.values() {
        match element.name.as_str() {
            "vertex" => {
                for Vertex([x, y, z, nx, ny, nz]) in body.elements(&mut reader, element)? {
                    raw.points.push([x, y, z].into());
                    raw.normals.iter_mut().for_each(|all| all.push([nx, ny, nz].into()));
                }
            }
            "face" => raw.faces = faces(body.elements(&mut reader, element)?),
            _ => drop(body.elements::<Other>(&mut reader, element)?),
        }
    }
    let rest = reader.get_ref();
    if !rest.iter().all(u8::is_ascii_whitespace) {
        let what = format!("{} bytes follow the last element that the header counts", rest.len());
        let place = body.place(&reader);
        return Err(Error::new(file, place, what, "correct the counts of the header"));
    }
    let count = raw.points.len();
    if let Some(wrong) = raw.faces.corners().iter().find(|&&i| i as usize >= count) {
        let what = format!("a face names vertex {wrong}, and there are {count} from 0");
        return Err(complaint(what, "the file is broken; get it again"));
    }
    Ok(raw)
}

/// What follows the header.
#[derive(Debug)]
struct Body<'a> {
    file: &'a str,
    length: usize,
    header: &'a Header,
}

impl Body<'_> {
    fn elements<E: PropertyAccess>(
        &self,
        reader: &mut Bytes<'_>,
        element: &ElementDef,
    ) -> Result<Vec<E>, Error> {
        let all = Parser::<E>::new().read_payload_for_element(reader, element, self.header);
        all.map_err(|e| said(self.file, &e, self.place(reader)))
    }

    /// How far the reader is.
    fn place(&self, reader: &Bytes<'_>) -> Place {
        match self.header.encoding {
            Encoding::Ascii => Place::Line(reader.line()),
            _ => Place::Byte(self.length - reader.get_ref().len()),
        }
    }
}

/// What the parser said, on one line: its sentence, and the text that it is about.
fn said(file: &str, error: &ParseError, place: Place) -> Error {
    let remedy = match error.kind() {
        ErrorKind::UnexpectedEof => "the file is cut short, or its header is wrong; get it again",
        _ => "correct the file",
    };
    let text = error.to_string();
    // Lines are the place's to name, and in binary there are none.
    let text = text.strip_prefix("Line ").and_then(|t| t.split_once(": ")).map_or(&*text, |t| t.1);
    let (sentence, rest) = text.split_once("\n\tString: '").unwrap_or((text, ""));
    let mut what = sentence.split_whitespace().collect::<Vec<_>>().join(" ");
    if let Some((about, _)) = rest.split_once("'\n").or(rest.rsplit_once('\'')) {
        what = format!("{} {}", what.trim_end_matches('.'), quoted(about.trim()));
    }
    Error::new(file, place, what, remedy)
}

fn faces(all: Vec<Face>) -> Faces {
    let mut faces = Faces::default();
    for Face(corners) in all {
        corners.into_iter().for_each(|corner| faces.add_corner(corner));
        faces.close();
    }
    faces
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self([0.0; 6])
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(i) = NAMES.iter().position(|n| *n == name) else {
            return PropertyAccessResult::Ignored;
        };
        let value = match property {
            Property::Char(v) => v.into(),
            Property::UChar(v) => v.into(),
            Property::Short(v) => v.into(),
            Property::UShort(v) => v.into(),
            Property::Int(v) => v.into(),
            Property::UInt(v) => v.into(),
            Property::Float(v) => v.into(),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        self.0[i] = value;
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        match property.to_u32_list() {
            Some(corners) => {
                self.0 = corners;
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::UnsupportedType,
        }
    }
}

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}
