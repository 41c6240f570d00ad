//! Files that are whole or absent.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::ShadeError;

/// Writes a file so that no reader ever sees a part of it: into a new file beside it, then renamed.
///
/// Missing folders are created. If anything fails, what was at `path` before is still there.
///
/// # Errors
/// [`ShadeError::Folder`] or [`ShadeError::File`], if the folder cannot be made or written.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), ShadeError> {
    let failed = |source| ShadeError::File { path: path.to_path_buf(), source };
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder)
            .map_err(|source| ShadeError::Folder { path: folder.to_path_buf(), source })?;
    }
    if path.file_name().is_none() {
        return Err(failed(io::Error::new(io::ErrorKind::InvalidInput, "the path names no file")));
    }
    let (partial, mut file) = create_beside(path).map_err(failed)?;
    fill(&mut file, bytes).and_then(|()| fs::rename(&partial, path)).map_err(|source| {
        // The first error is the one to report.
        let _ = fs::remove_file(&partial);
        failed(source)
    })
}

fn fill(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    // Else a crash after the rename could leave an empty file.
    file.sync_all()
}

/// A new file in the same folder, of a name that no process or thread uses.
fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let partial = path.with_file_name(format!(".{}-{count}.partial", process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&partial) {
            // Left by a process of the same number that was killed.
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            other => return other.map(|file| (partial, file)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn missing_folders_are_created_and_old_files_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/c.txt");
        write_atomically(&path, b"old").unwrap();
        write_atomically(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(path.parent().unwrap()), ["c.txt"]);
    }

    #[test]
    fn an_unwritable_folder_is_named_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let blocker = folder.path().join("blocker");
        fs::write(&blocker, b"a file, not a folder").unwrap();
        let out = blocker.join("out");
        let error = write_atomically(&out.join("x.png"), b"x").unwrap_err();
        assert!(matches!(&error, ShadeError::Folder { path, .. } if *path == out), "{error:?}");
        let message = error.to_string();
        assert!(message.contains(&format!("{out:?}")), "{message}");
        assert!(message.contains("choose an output folder"), "{message}");
    }

    #[test]
    fn a_failed_write_leaves_no_partial_file_and_keeps_the_old() {
        let folder = tempfile::tempdir().unwrap();
        // The partial file is written, and the rename fails: a file cannot replace a folder.
        let path = folder.path().join("taken");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("kept"), b"kept").unwrap();
        let error = write_atomically(&path, b"x").unwrap_err();
        assert!(matches!(&error, ShadeError::File { path: p, .. } if *p == path), "{error:?}");
        assert_eq!(names(folder.path()), ["taken"]);
        assert_eq!(fs::read(path.join("kept")).unwrap(), b"kept");
    }

    #[test]
    fn a_path_without_a_name_is_an_error() {
        assert!(matches!(write_atomically(Path::new("/"), b""), Err(ShadeError::File { .. })));
        assert!(matches!(write_atomically(Path::new(""), b""), Err(ShadeError::File { .. })));
    }
}
