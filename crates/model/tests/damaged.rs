//! No bytes make a reader panic, hang, or take memory for what is not there.

mod files;

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use zeroset_model::volume::{MOST_SAMPLES, Volume};

/// What happens to a file.
#[derive(Clone, Debug)]
enum Damage {
    Byte(prop::sample::Index, u8),
    /// The digits from here on become these.
    Digits(prop::sample::Index, String),
    Cut(prop::sample::Index),
    Insert(prop::sample::Index, Vec<u8>),
    Swap(prop::sample::Index, prop::sample::Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        4 => (at(), any::<u8>()).prop_map(|(at, byte)| Damage::Byte(at, byte)),
        4 => (at(), "-?[0-9]{1,22}|nan|1e999|-|0x10").prop_map(|(at, new)| Damage::Digits(at, new)),
        2 => at().prop_map(Damage::Cut),
        1 => (at(), prop::collection::vec(any::<u8>(), 1..40)).prop_map(|(at, new)| Damage::Insert(at, new)),
        1 => (at(), at()).prop_map(|(a, b)| Damage::Swap(a, b)),
    ]
}

impl Damage {
    fn apply(&self, bytes: &mut Vec<u8>) {
        let length = bytes.len() + 1;
        match self {
            Self::Byte(at, byte) => {
                if let Some(old) = bytes.get_mut(at.index(length)) {
                    *old = *byte;
                }
            }
            Self::Digits(at, new) => {
                let start = at.index(length);
                let found = bytes[start..].iter().position(u8::is_ascii_digit);
                if let Some(found) = found {
                    let from = start + found;
                    let rest = bytes[from..].iter().position(|b| !b.is_ascii_digit());
                    let to = rest.map_or(bytes.len(), |rest| from + rest);
                    bytes.splice(from..to, new.bytes());
                }
            }
            Self::Cut(at) => bytes.truncate(at.index(length)),
            Self::Insert(at, new) => {
                let at = at.index(length);
                bytes.splice(at..at, new.iter().copied());
            }
            Self::Swap(a, b) => {
                let [a, b] = [a.index(length), b.index(length)];
                bytes[a.min(b)..a.max(b)].reverse();
            }
        }
    }
}

fn read(file: &Path) {
    match Volume::read(file) {
        Ok(volume) => {
            let count: usize = volume.size().into_iter().product();
            assert!(count == volume.values().len() && count <= MOST_SAMPLES);
            assert!(volume.spacing().is_finite() && volume.origin().is_finite());
        }
        Err(error) => {
            let said = error.to_string();
            assert!(said.starts_with(&file.display().to_string()) && said.len() < 1000, "{said}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damaged_files_are_errors(damages in prop::collection::vec(damage(), 1..4)) {
        let folder = tempfile::tempdir().unwrap();
        for (name, mut bytes) in files::all() {
            for damage in &damages {
                damage.apply(&mut bytes);
            }
            fs::write(folder.path().join(name), bytes).unwrap();
        }
        for (name, _) in files::all() {
            read(&folder.path().join(name));
        }
    }

    #[test]
    fn any_bytes_are_errors(bytes in prop::collection::vec(any::<u8>(), 0..500)) {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.mha", "a.nrrd", "a.nii", "a.nii.gz", "a.den", "a.inr", "a_4x4x4_u8.raw.gz"] {
            let file = folder.path().join(name);
            fs::write(&file, &bytes).unwrap();
            read(&file);
        }
    }
}
