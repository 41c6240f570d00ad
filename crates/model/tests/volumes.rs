//! Volumes are read from every format, and what is wrong with a file is said.

mod files;

use std::fs;
use std::path::{Path, PathBuf};

use files::{gzip, nifti, samples};
use glam::DVec3;
use zeroset_model::spline::{Filter, Sector, Spline, Tet, isosurface};
use zeroset_model::volume::{ByteOrder, Layout, ReadError, Sample, Volume};
use zeroset_raycast::Progress;

/// The size of the volume.
const SIZE: [usize; 3] = [4, 3, 5];

/// Writes all of them into a folder; the files to read.
fn write(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for (name, bytes) in files::all() {
        let file = folder.join(name);
        fs::write(&file, bytes).unwrap();
        if !name.ends_with("bin") && name != "beside.gz" {
            files.push(file);
        }
    }
    files
}

#[test]
fn every_format_gives_the_same_samples() {
    let folder = tempfile::tempdir().unwrap();
    for file in write(folder.path()) {
        let volume = Volume::read(&file).unwrap_or_else(|error| panic!("{error}"));
        let name = file.file_name().unwrap().to_str().unwrap();
        assert_eq!(volume.size(), SIZE, "{name}");
        let is_scaled = name.contains(".nii");
        let expected = samples().into_iter().map(|n| match is_scaled {
            true => 0.5 * f32::from(n) - 1.0,
            false => f32::from(n),
        });
        assert_eq!(volume.values(), expected.collect::<Vec<f32>>(), "{name}");
        let has_steps = !name.contains(".raw") && !name.ends_with(".den");
        let steps = if has_steps { DVec3::new(0.5, 1.0, 2.0) } else { DVec3::ONE };
        assert_eq!(volume.spacing(), steps, "{name}");
        let has_origin = ["mha", "mhd", "nrrd", "nhdr"].iter().any(|ending| name.ends_with(ending));
        let has_origin = has_origin && name != "steps.nrrd";
        let origin = if has_origin { DVec3::new(1.0, 2.0, 3.0) } else { DVec3::ZERO };
        assert_eq!(volume.origin(), origin, "{name}");
    }
}

#[test]
fn layouts_can_be_given() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("samples.dat");
    fs::write(&file, [&[9; 5], &samples()[..]].concat()).unwrap();
    let steps = DVec3::new(1.0, 2.0, 3.0);
    let layout = Layout { skip: 5, spacing: steps, origin: steps, ..Layout::new(SIZE, Sample::U8) };
    let volume = Volume::read_raw(&file, &layout).unwrap();
    assert_eq!((volume.spacing(), volume.origin()), (steps, steps));
    assert_eq!(volume.values()[59], 236.0);
    let big = Layout { order: ByteOrder::Big, ..Layout::new([2, 3, 5], Sample::U16) };
    let said = Volume::read_raw(&file, &big).unwrap_err().to_string();
    assert!(said.contains("samples.dat: more bytes"), "{said}");
    assert!(said.contains("asks for 60 (2 for each sample, U16)"), "{said}");
}

/// What is said of a file of this name with these bytes.
fn said(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    fs::write(&file, bytes).unwrap();
    let error = Volume::read(&file).unwrap_err();
    assert!(matches!(error, ReadError::Data { .. } | ReadError::Io { .. }));
    let said = error.to_string();
    let shown = folder.path().display().to_string();
    assert!(said.starts_with(&shown), "{said}");
    said[shown.len() + 1..].to_owned()
}

/// A file of [`files::all`] with one text in it replaced.
fn changed(name: &str, from: &str, to: &str) -> Vec<u8> {
    let (_, bytes) = files::all().into_iter().find(|(other, _)| *other == name).unwrap();
    let at = bytes.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
    [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
}

#[test]
fn what_is_wrong_is_said() {
    for (name, from, to, why) in [
        ("local.mha", "NDims = 3", "NDims = 2", "NDims is \"2\""),
        (
            "local.mha",
            "DimSize = 4 3 5",
            "DimSize = 4 3 6",
            "120 bytes of samples, but the size of 4 x 3 x 6",
        ),
        ("local.mha", "DimSize = 4 3 5", "DimSize = 4 3", "DimSize has 2 numbers"),
        ("local.mha", "DimSize = 4 3 5", "DimSize = 4 3 -5", "DimSize is \"-5\""),
        ("local.mha", "DimSize = 4 3 5", "DimSize = 99999 99999 99999", "most allowed"),
        (
            "local.mha",
            "DimSize = 4 3 5",
            "DimSize = 9999999999 9999999999 9999999999",
            "most allowed",
        ),
        ("local.mha", "DimSize = 4 3 5", "DimSize = 0 3 5", "at least 1"),
        ("local.mha", "DimSize = 4 3 5", "DimSize = 1024 1024 1024", "the file is cut off"),
        ("local.mha", "MET_SHORT", "MET_STRING", "ElementType is \"MET_STRING\""),
        ("local.mha", "MET_SHORT", "MET_UCHAR", "more bytes of samples"),
        ("local.mha", "0.5 1 2", "0 1 2", "spacing 0 along x"),
        ("local.mha", "0.5 1 2", "nan 1 2", "spacing NaN along x"),
        ("local.mha", "Offset = 1 2 3", "Offset = 1 2 1e300", "origin"),
        ("local.mha", "LOCAL", "LIST", "several files"),
        ("local.mha", "LOCAL", "absent.bin", "absent.bin"),
        ("local.mha", "ObjectType = Image", "hello", "not key = value"),
        ("packed.mha", "DimSize = 4 3 5", "DimSize = 4 3 4", "more bytes"),
        ("packed.mha", "DimSize = 4 3 5", "DimSize = 4 3 6", "60 bytes of samples"),
        ("packed.mha", "DimSize = 4 3 5", "DimSize = 1024 1024 1024", "cannot hold"),
        ("text.mha", "236", "x", "sample 59 is \"x\""),
        ("raw.nrrd", "NRRD", "NERD", "first line"),
        ("raw.nrrd", "endian: big", "endian: huge", "endian"),
        ("raw.nrrd", "dimension: 3", "dimension: 4", "dimension is \"4\""),
        ("raw.nrrd", "type: short", "type: block", "type is \"block\""),
        ("raw.nrrd", "encoding: raw", "encoding: bzip2", "encoding is \"bzip2\""),
        ("raw.nrrd", "key:=value", "byte skip: 3", "byte skip"),
        ("raw.nrrd", "(0,0,2)", "", "2 vectors"),
        ("raw.nrrd", "(0,0,2)", "(0,0)", "(x,y,z)"),
        ("ascii.nrrd", "236", "", "59 numbers where"),
        ("float.inr", "##}", "###", "no end"),
        ("float.inr", "#INR", "#ink", "does not start"),
        ("float.inr", "TYPE=float", "TYPE=waves", "samples of \"waves\""),
        ("float.inr", "CPU=decm", "CPU=cray", "cray"),
        ("float.inr", "VDIM=1", "VDIM=3", "VDIM"),
        ("little.nii", "n+1", "n-1", "no NIfTI-1"),
        ("little.nii", "n+1", "ni1", "another file"),
    ] {
        let said = said(name, &changed(name, from, to));
        assert!(said.contains(why), "{said:?} for {why:?}");
    }
    let mut header = nifti(128, i16::to_le_bytes, f32::to_le_bytes);
    assert!(said("colours.nii", &header).contains("datatype is 128"));
    header[44] = 0xff;
    header[45] = 0xff;
    header[70] = 2;
    assert!(said("negative.nii", &header).contains("no samples"));
    header[48] = 2;
    assert!(said("series.nii", &header).contains("only volumes"));
    assert!(said("short.nii.gz", &gzip(&header[..100])).contains("header alone has 348"));
    assert!(said("short.den", &[1; 61]).contains("header alone has 62"));
    assert!(said("other.den", &[2; 100]).contains("version"));
    assert!(said("volume.vti", b"").contains("must end in .mhd"));
    assert!(said("volume.raw", b"").contains("fuel_64x64x64_u8.raw"));
    assert!(said("a_4x3x5_u8.raw.gz", &samples()).contains("unpacking failed"));
    let folder = tempfile::tempdir().unwrap();
    let absent = Volume::read(&folder.path().join("absent.nrrd")).unwrap_err();
    assert!(matches!(absent, ReadError::Io { .. }), "{absent}");
}

#[test]
fn a_head_is_read() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/brainsmall.den");
    let volume = Volume::read(&file).unwrap();
    assert_eq!(volume.size(), [128, 128, 84]);
    // As a script says that knows nothing of this reader.
    assert_eq!(volume.range(), Some([0.0, 202.0]));
    let sum: f64 = volume.values().iter().copied().map(f64::from).sum();
    assert_eq!(sum, 19_284_185.0);
    let tets = isosurface(&volume, 84.5, &Progress::new()).unwrap();
    // A part of it, without the search.
    let spline = Spline::new(&volume, Filter::None).unwrap();
    let mut expected = Vec::new();
    for j in 1..127 {
        for i in 1..127 {
            for sector in Sector::all() {
                let cell = [i, j, 41];
                let ordinates = spline.ordinates(cell, sector);
                let is_below = ordinates.iter().any(|b| *b < 84.5);
                if is_below && ordinates.iter().any(|b| *b > 84.5) {
                    expected.push(Tet { cell, sector, ordinates });
                }
            }
        }
    }
    assert!(expected.len() > 1000);
    assert_eq!(tets.all().filter(|tet| tet.cell[2] == 41).collect::<Vec<_>>(), expected);
}
