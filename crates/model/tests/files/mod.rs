//! Files of one small volume in every format.

use std::io::Write;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};

/// The samples of the volume, 4 x 3 x 5 whole numbers from 0 to 236.
pub(crate) fn samples() -> Vec<u8> {
    (0..60).map(|n| n * 4).collect()
}

fn of_16_bits(bytes: fn(i16) -> [u8; 2]) -> Vec<u8> {
    samples().into_iter().flat_map(|n| bytes(i16::from(n))).collect()
}

fn of_floats(bytes: fn(f32) -> [u8; 4]) -> Vec<u8> {
    samples().into_iter().flat_map(|n| bytes(f32::from(n))).collect()
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn text() -> Vec<u8> {
    samples().into_iter().map(|n| format!("{n}\n")).collect::<String>().into_bytes()
}

fn meta(lines: &str, name: &str) -> Vec<u8> {
    format!(
        "ObjectType = Image\nNDims = 3\n{lines}\nOffset = 1 2 3\nElementSpacing = 0.5 1 2\n\
         DimSize = 4 3 5\nElementDataFile = {name}\n"
    )
    .into_bytes()
}

fn nrrd(lines: &str) -> Vec<u8> {
    format!(
        "NRRD0004\n# a comment\ndimension: 3\nsizes: 4 3 5\nspace origin: (1,2,3)\n\
         space directions: (0,0.5,0) (-1,0,0) (0,0,2)\nkey:=value\n{lines}\n\n"
    )
    .into_bytes()
}

/// One that has only two of its steps.
fn nrrd_of_steps() -> Vec<u8> {
    b"NRRD0001\ndimension: 3\nsizes: 4 3 5\nspacings: 0.5 nan 2\ntype: uchar\nencoding: raw\n\n"
        .to_vec()
}

/// A NIfTI-1 header with samples of this type, from 352 on, halved and less 1.
pub(crate) fn nifti(kind: i16, short: fn(i16) -> [u8; 2], float: fn(f32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes = vec![0; 352];
    let mut put = |at: usize, new: &[u8]| bytes[at..at + new.len()].copy_from_slice(new);
    let is_little = short(1) == [1, 0];
    put(0, &if is_little { 348_u32.to_le_bytes() } else { 348_u32.to_be_bytes() });
    for (i, n) in [4, 4, 3, 5, 1].into_iter().enumerate() {
        put(40 + 2 * i, &short(n));
    }
    put(70, &short(kind));
    for (i, step) in [-0.5, 1.0, 2.0].into_iter().enumerate() {
        put(80 + 4 * i, &float(step));
    }
    put(108, &float(352.0));
    put(112, &float(0.5));
    put(116, &float(-1.0));
    put(344, b"n+1\0");
    bytes
}

fn den() -> Vec<u8> {
    let mut shorts = [0_i16; 31];
    (shorts[0], shorts[25], shorts[26], shorts[27]) = (1, 4, 3, 5);
    shorts.into_iter().flat_map(i16::to_le_bytes).collect()
}

fn inr(lines: &str, blocks: usize) -> Vec<u8> {
    let start =
        format!("#INRIMAGE-4#{{\nXDIM=4\nYDIM=3\nZDIM=5\nVDIM=1\nVX=0.5\nVY=1\nVZ=2\n{lines}\n");
    let mut bytes = start.into_bytes();
    bytes.resize(256 * blocks - 4, b'\n');
    bytes.extend(b"##}\n");
    bytes
}

/// All of them: name and bytes.
pub(crate) fn all() -> Vec<(&'static str, Vec<u8>)> {
    let bytes = samples();
    let [little, big] = [of_16_bits(i16::to_le_bytes), of_16_bits(i16::to_be_bytes)];
    let [float, float_big] = [of_floats(f32::to_le_bytes), of_floats(f32::to_be_bytes)];
    let short = "ElementType = MET_SHORT";
    let packed = "CompressedData = True\nElementType = MET_UCHAR";
    let behind = [&[7; 11], &little[..]].concat();
    let nifti_little = [nifti(2, i16::to_le_bytes, f32::to_le_bytes), bytes.clone()].concat();
    let nifti_big = [nifti(16, i16::to_be_bytes, f32::to_be_bytes), float_big.clone()].concat();
    vec![
        ("a_4x3x5_u8.raw", bytes.clone()),
        ("a_4x3x5_i16be.raw", big.clone()),
        ("a_4x3x5_f32le.raw.gz", gzip(&float)),
        ("local.mha", [meta(short, "LOCAL"), little.clone()].concat()),
        ("packed.mha", [meta(packed, "LOCAL"), zlib(&bytes)].concat()),
        ("beside.mhd", meta("ElementByteOrderMSB = True\nElementType = MET_FLOAT", "beside.bin")),
        ("beside.bin", float_big),
        ("behind.mhd", meta(&format!("HeaderSize = -1\n{short}"), "behind.bin")),
        ("behind.bin", behind),
        ("text.mha", [meta(&format!("BinaryData = False\n{short}"), "LOCAL"), text()].concat()),
        ("raw.nrrd", [nrrd("type: short\nencoding: raw\nendian: big"), big].concat()),
        ("gzip.nrrd", [nrrd("type: uint8\nencoding: gzip"), gzip(&bytes)].concat()),
        ("steps.nrrd", [nrrd_of_steps(), bytes.clone()].concat()),
        ("ascii.nrrd", [nrrd("type: double\nencoding: ascii"), text()].concat()),
        ("beside.nhdr", nrrd("type: float\nencoding: gz\nendian: little\ndata file: beside.gz")),
        ("beside.gz", gzip(&float)),
        ("little.nii", nifti_little.clone()),
        ("big.nii", nifti_big),
        ("packed.nii.gz", gzip(&nifti_little)),
        ("bytes.den", [den(), bytes.clone()].concat()),
        ("float.inr", [inr("TYPE=float\nPIXSIZE=32 bits\nCPU=decm", 1), float].concat()),
        ("long.inr", [inr("TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=sun", 2), bytes].concat()),
    ]
}
