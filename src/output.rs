//! Where results go.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use crate::failure::Failure;

/// Prints to standard output. A reader that has seen enough, such as `head`, is no failure.
pub(crate) fn print(text: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::work(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Makes a folder and those above it, and checks that files can be made in it: better known before
/// an hour of work than after.
pub(crate) fn make_folder(folder: &Path) -> Result<(), Failure> {
    let fail = |error: io::Error| {
        Failure::work(format!(
            "cannot write to the folder {}: {error}; choose another with --out",
            folder.display()
        ))
    };
    fs::create_dir_all(folder).map_err(fail)?;
    let probe = folder.join(format!(".zeroset-{}", std::process::id()));
    fs::write(&probe, b"").map_err(fail)?;
    fs::remove_file(&probe).map_err(fail)
}

/// Makes the folder of a file.
pub(crate) fn make_folder_of(file: &Path) -> Result<(), Failure> {
    if file.is_dir() || file.file_name().is_none() {
        return Err(Failure::work(format!(
            "cannot write {}: it is a folder; name a file with --out",
            file.display()
        )));
    }
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => make_folder(folder),
        _ => make_folder(Path::new(".")),
    }
}

/// A name with only letters, digits, dots, dashes and underscores, for files. Names that lose
/// something get a checksum, so that x^2+y^2 does not overwrite x^2-y^2.
pub(crate) fn file_stem(name: &str) -> String {
    /// Longer names would exceed what file systems take.
    const LONGEST: usize = 50;
    let mut stem = String::new();
    for c in name.chars() {
        match c {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' => stem.push(c),
            // Files must not look hidden, nor like options.
            '.' | '-' if !stem.is_empty() => stem.push(c),
            _ if !stem.is_empty() && !stem.ends_with('-') => stem.push('-'),
            _ => {}
        }
    }
    stem.truncate(LONGEST);
    let stem = stem.trim_end_matches(['-', '.']);
    match stem {
        "" => format!("surface-{:08x}", checksum(name)),
        _ if stem == name => stem.into(),
        _ => format!("{stem}-{:08x}", checksum(name)),
    }
}

/// The FNV-1a hash in 32 bits: the same on every machine.
fn checksum(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_made_and_files_in_the_way_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b/c");
        make_folder(&deep).unwrap();
        assert!(deep.is_dir() && fs::read_dir(&deep).unwrap().next().is_none());
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let failure = make_folder(&file.join("d")).unwrap_err();
        assert!(failure.to_string().contains("file/d"), "{failure}");
        assert!(make_folder_of(folder.path()).is_err());
        make_folder_of(&folder.path().join("e/picture.png")).unwrap();
        assert!(folder.path().join("e").is_dir());
    }

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(file_stem("barth-sextic"), "barth-sextic");
        for (name, start) in
            [("x^2 + y^2 = 1/4", "x-2-y-2-1-4-"), ("../../etc", "etc-"), ("^^^", "surface-")]
        {
            let stem = file_stem(name);
            assert!(stem.starts_with(start) && stem.len() == start.len() + 8, "{stem}");
        }
        assert!(file_stem("-x").starts_with("x-") && file_stem(".x").starts_with("x-"));
        assert_eq!(file_stem(&"x+".repeat(500)).len(), 49 + 9);
    }

    #[test]
    fn other_equations_have_other_files() {
        let names = ["x^2+y^2-1", "x^2-y^2+1", "x-2-y-2-1", "x^2+y^2-1 "].map(file_stem);
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name), "{name}");
        }
        // A published test vector.
        assert_eq!(checksum("foobar"), 0xbf9c_f968);
    }
}
