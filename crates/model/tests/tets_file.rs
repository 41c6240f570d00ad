//! A file of tetrahedra gives them back, or says what is wrong with it.

use std::fs;

use glam::DVec3;
use proptest::prelude::*;
use zeroset_model::spline::{Filter, Outside, Spline, Tets};
use zeroset_model::volume::Volume;
use zeroset_raycast::{Progress, Sides};

fn tets() -> Tets {
    let mut values = Volume::sphere(8).unwrap().values().to_vec();
    values[0] = f32::NAN;
    let volume = Volume::new([8; 3], DVec3::new(0.1, 0.3, 1.0 / 3.0), DVec3::X, values).unwrap();
    let spline = Spline::new(&volume, Filter::None).unwrap();
    spline.isosurface(0.8, Outside::Above, &Progress::new()).unwrap()
}

/// The bytes with their checksum made right.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.len() - 4;
    let mut crc = flate2::Crc::new();
    crc.update(&bytes[..end]);
    bytes[end..].copy_from_slice(&crc.sum().to_le_bytes());
    bytes
}

fn with(bytes: &[u8], at: usize, new: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at..at + new.len()].copy_from_slice(new);
    bytes
}

#[test]
fn what_was_written_is_read() {
    let tets = tets();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sphere.tets");
    fs::write(&file, tets.to_bytes()).unwrap();
    let read = Tets::read(&file).unwrap();
    assert_eq!(read, tets);
    assert_eq!((read.dropped(), read.outside(), read.isovalue()), (1, Outside::Above, 0.8));
    assert_eq!(read.patches(Sides::Both).unwrap(), tets.patches(Sides::Both).unwrap());
    let absent = Tets::read(&folder.path().join("absent.tets")).unwrap_err().to_string();
    assert!(absent.contains("absent.tets"), "{absent}");
    fs::write(&file, &tets.to_bytes()[..1000]).unwrap();
    let cut = Tets::read(&file).unwrap_err().to_string();
    assert!(cut.contains("sphere.tets: 1000 bytes, but"), "{cut}");
    let folder = Tets::read(folder.path()).unwrap_err().to_string();
    assert!(folder.contains("no ordinary file"), "{folder}");
}

#[test]
fn the_file_is_as_documented() {
    let tets = tets();
    let bytes = tets.to_bytes();
    assert_eq!(bytes.len(), 108 + 116 * tets.cubes());
    assert_eq!(&bytes[..8], b"\x89TETS\r\n\x1a");
    let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let u64_at = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    let f64_at = |at: usize| f64::from_bits(u64_at(at));
    assert_eq!([8, 12, 16, 20, 24].map(u32_at), [1, 1, 8, 8, 8]);
    assert_eq!(u32_at(28) as usize, tets.cubes());
    assert_eq!([32, 40, 48, 56, 64, 72, 80].map(f64_at), [0.1, 0.3, 1.0 / 3.0, 1.0, 0.0, 0.0, 0.8]);
    assert_eq!([88, 96].map(u64_at), [1, tets.len() as u64]);
    let first = tets.all().next().unwrap();
    let [i, j, k] = first.cell;
    assert_eq!(u32_at(104) as usize, i + 8 * (j + 8 * k));
    assert_eq!(u32_at(108).trailing_zeros(), u32::from(first.sector.number()));
    assert_eq!(sealed(bytes.clone()), bytes);
}

#[test]
fn what_is_wrong_is_said() {
    let bytes = tets().to_bytes();
    let nan = f64::NAN.to_le_bytes();
    let huge = u32::MAX.to_le_bytes();
    for (bytes, why) in [
        (Vec::new(), "does not start like"),
        (bytes[..50].to_vec(), "cut off"),
        (with(&bytes, 8, &[2]), "version 2"),
        (with(&bytes, 28, &huge), "4294967295 cubes take"),
        (with(&bytes, 200, &[0, 1, 2, 3]), "checksum"),
        (sealed(with(&bytes, 12, &[2])), "outside"),
        (sealed(with(&bytes, 16, &huge)), "spacing"),
        (sealed(with(&bytes, 16, &[0; 4])), "no samples"),
        (sealed(with(&bytes, 32, &nan)), "spacing"),
        (sealed(with(&bytes, 56, &nan)), "origin"),
        (sealed(with(&bytes, 80, &nan)), "isovalue"),
        (sealed(with(&bytes, 96, &[0])), "are told"),
        (sealed(with(&bytes, 104, &[0; 4])), "no place"),
        (sealed(with(&bytes, 104, &huge)), "no place"),
        (sealed(with(&bytes, 108, &[0; 4])), "tetrahedra that there are not"),
        (sealed(with(&bytes, 108, &huge)), "tetrahedra that there are not"),
        (sealed(with(&bytes, 112, &f32::NAN.to_le_bytes())), "not finite"),
        (sealed(with(&bytes, 104, &bytes[220..224])), "no place"),
    ] {
        let said = Tets::from_bytes(&bytes).unwrap_err().to_string();
        let why = if why == "spacing" && bytes[16..20] == huge { "most allowed" } else { why };
        assert!(said.contains(why), "{said:?} for {why:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_bytes_are_a_panic(
        changes in prop::collection::vec((0_usize..400, any::<u8>()), 0..6),
        cut in prop::option::of(0_usize..2000),
    ) {
        let mut bytes = tets().to_bytes();
        for (at, byte) in changes {
            bytes[at] = byte;
        }
        bytes.truncate(cut.unwrap_or(usize::MAX).max(4));
        let whole = Tets::from_bytes(&sealed(bytes));
        if let Ok(tets) = whole {
            prop_assert_eq!(tets.all().count(), tets.len());
            // Ordinates may be huge, but nothing panics.
            let _ = tets.patches(Sides::Both);
        }
    }
}
