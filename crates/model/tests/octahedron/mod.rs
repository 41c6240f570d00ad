//! An octahedron in all formats.

#![allow(dead_code, reason = "not every test needs all of it")]

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;

pub(crate) const OCTAHEDRON: [[i32; 3]; 6] =
    [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
pub(crate) const FACES: [[usize; 3]; 8] =
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

pub(crate) fn gzipped(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Does a file have normals?
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Normals {
    Given,
    Absent,
}

#[derive(Clone, Copy)]
pub(crate) enum Coding {
    Ascii,
    Little,
    Big,
}

/// The octahedron with its faces, or with normals of length 2.
pub(crate) fn ply(coding: Coding, normals: Normals) -> Vec<u8> {
    let format = match coding {
        Coding::Ascii => "ascii",
        Coding::Little => "binary_little_endian",
        Coding::Big => "binary_big_endian",
    };
    let properties = match normals {
        Normals::Given => ["nx", "ny", "nz"].map(|n| format!("property double {n}\n")).concat(),
        Normals::Absent => String::new(),
    };
    let mut out = format!(
        "ply\nformat {format} 1.0\ncomment by hand\nelement vertex 6\nproperty float x\n\
         property uchar colour\nproperty float y\nproperty float z\n{properties}\
         element face 8\nproperty list uchar int vertex_indices\nelement other 1\n\
         property list int float list\nend_header\n"
    )
    .into_bytes();
    let mut put = |numbers: &[(char, f64)]| match coding {
        Coding::Ascii => {
            let words: Vec<_> = numbers.iter().map(|(_, n)| n.to_string()).collect();
            out.extend(words.join(" ").bytes().chain([b'\n']));
        }
        Coding::Little | Coding::Big => {
            for &(kind, n) in numbers {
                let mut bytes = match kind {
                    'd' => n.to_le_bytes().to_vec(),
                    'f' => (n as f32).to_le_bytes().to_vec(),
                    'i' => (n as i32).to_le_bytes().to_vec(),
                    _ => vec![n as u8],
                };
                if matches!(coding, Coding::Big) {
                    bytes.reverse();
                }
                out.extend(bytes);
            }
        }
    };
    for corner in OCTAHEDRON {
        let [x, y, z] = corner.map(f64::from);
        let mut row = vec![('f', x), ('b', 200.0), ('f', y), ('f', z)];
        if normals == Normals::Given {
            row.extend([x, y, z].map(|n| ('d', 2.0 * n)));
        }
        put(&row);
    }
    for face in FACES {
        let [a, b, c] = face.map(|i| ('i', i as f64));
        put(&[('b', 3.0), a, b, c]);
    }
    put(&[('i', 2.0), ('f', 0.5), ('f', 0.25)]);
    out
}

/// The octahedron's lines, with faces whose corners are written by `corner` from an index from 0.
pub(crate) fn obj(normals: Normals, corner: impl Fn(usize) -> String) -> String {
    let mut out = String::from("# by hand\nmtllib none.mtl\no thing\n");
    for [x, y, z] in OCTAHEDRON {
        out += &format!("v {x} {y} {z} 1.0\n");
        if normals == Normals::Given {
            out += &format!("vn {} {} {}\n", 3 * x, 3 * y, 3 * z);
        }
        out += "vt 0.5 0.5\n";
    }
    for face in FACES {
        out += &format!("f {}\n", face.map(&corner).join("\t"));
    }
    out
}
