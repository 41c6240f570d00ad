//! Where pictures go.

use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// What `--out` names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    /// A picture; for an animation what the names of its frames are made from.
    File(PathBuf),
    /// A folder for frames.
    Folder(PathBuf),
}

/// Reads the name of a picture, or of a folder.
pub(crate) fn destination(text: &str) -> Result<Destination, String> {
    let path = PathBuf::from(text);
    if text.ends_with(std::path::is_separator) {
        return Ok(Destination::Folder(path));
    }
    if is_png(&path) || is_exr(&path) {
        return Ok(Destination::File(path));
    }
    if path.is_dir() || (path.extension().is_none() && path.file_name().is_some()) {
        return Ok(Destination::Folder(path));
    }
    Err("name a .png or .exr file, or with --animate a folder".into())
}

impl Destination {
    /// The one picture's file.
    pub(crate) fn file(&self) -> Result<PathBuf, Failure> {
        match self {
            Self::File(file) => Ok(file.clone()),
            Self::Folder(folder) => Err(Failure::usage(format!(
                "--out {} is a folder; name a .png or .exr file",
                folder.display()
            ))),
        }
    }
}

/// The numbered files of frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FrameFiles {
    /// The file that the names are made from: `morph.png` for `morph-0007.png`.
    pattern: PathBuf,
    digits: usize,
}

impl FrameFiles {
    /// The files of that many frames.
    pub(crate) fn new(destination: &Destination, frames: usize) -> Self {
        let pattern = match destination {
            Destination::File(file) => file.clone(),
            Destination::Folder(folder) => folder.join("frame.png"),
        };
        let last = frames.saturating_sub(1).to_string();
        Self { pattern, digits: last.len().max(4) }
    }

    /// The file of a frame, counted from 0.
    pub(crate) fn file(&self, frame: usize) -> PathBuf {
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_owned();
        let mut name = part(self.pattern.file_stem());
        name.push(format!("-{frame:0digits$}.", digits = self.digits));
        name.push(part(self.pattern.extension()));
        self.pattern.with_file_name(name)
    }

    /// Do frames hold numbers, not pictures alone?
    pub(crate) fn are_exr(&self) -> bool {
        is_exr(&self.pattern)
    }
}

pub(crate) fn is_png(file: &Path) -> bool {
    has_extension(file, "png")
}

pub(crate) fn is_exr(file: &Path) -> bool {
    has_extension(file, "exr")
}

pub(crate) fn has_extension(file: &Path, extension: &str) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_with_enough_digits() {
        let names = |out: &str, frames| {
            let files = FrameFiles::new(&destination(out).unwrap(), frames);
            [0, frames - 1].map(|i| files.file(i).display().to_string())
        };
        assert_eq!(names("a/", 1), ["a/frame-0000.png"; 2]);
        assert_eq!(names("a.b/", 60), ["a.b/frame-0000.png", "a.b/frame-0059.png"]);
        assert_eq!(names("a/b.exr", 10_000), ["a/b-0000.exr", "a/b-9999.exr"]);
        assert_eq!(names("c.d.PNG", 10_001), ["c.d-00000.PNG", "c.d-10000.PNG"]);
    }

    #[test]
    fn other_kinds_of_files_are_refused() {
        for bad in ["picture.jpg", "a/b.gif", "", ".."] {
            let is_folder = Path::new(bad).is_dir();
            assert_eq!(destination(bad).is_err(), !is_folder, "{bad}");
        }
        assert!(destination("new").unwrap().file().is_err());
        assert!(destination("new.png").unwrap().file().is_ok());
    }
}
