//! Tables of records: CSV files, and JSON.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::Record;

/// A file of records that cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct RecordError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub message: String,
}

/// Writes records as CSV, replacing the file at once.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, records: &[Record]) -> Result<(), RecordError> {
    replace(path, &[header(), rows(records)].concat())
}

/// Adds records to a CSV file, which is replaced at once; it need not exist.
///
/// # Errors
/// If the file is not one of records, or cannot be written.
pub fn append(path: &Path, records: &[Record]) -> Result<(), RecordError> {
    let old = match fs::read(path) {
        Ok(old) if !old.is_empty() => old,
        Ok(_) => return write(path, records),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return write(path, records),
        Err(error) => return Err(failure(path, error)),
    };
    // The old rows are kept as they are, but only if they are rows of the same columns.
    parse(path, &old)?;
    let mut all = old;
    if !all.ends_with(b"\n") {
        all.push(b'\n');
    }
    all.extend(rows(records));
    replace(path, &all)
}

/// Reads records from CSV.
///
/// # Errors
/// If the file cannot be read, or is not one of records.
pub fn read(path: &Path) -> Result<Vec<Record>, RecordError> {
    let text = fs::read(path).map_err(|error| failure(path, error))?;
    parse(path, &text)
}

/// Records as a JSON array. Numbers beyond all bounds are null there.
pub fn json(records: &[Record]) -> String {
    serde_json::to_string_pretty(records).expect("records are plain fields")
}

fn parse(path: &Path, text: &[u8]) -> Result<Vec<Record>, RecordError> {
    let header = header();
    let mut expected = csv::Reader::from_reader(&header[..]);
    let mut reader = csv::Reader::from_reader(text);
    let found = reader.headers().map_err(|error| failure(path, error))?;
    if expected.headers().ok() != Some(found) {
        let message = "its columns are not those of this version's records; \
                       move it away or give another file";
        return Err(failure(path, message));
    }
    reader.deserialize().map(|row| row.map_err(|error| failure(path, error))).collect()
}

/// The row of the columns' names.
fn header() -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.serialize(Record::default()).expect("a record is flat");
    let mut text = writer.into_inner().expect("memory takes what is left");
    let end = text.iter().position(|byte| *byte == b'\n').map_or(0, |i| i + 1);
    text.truncate(end);
    text
}

fn rows(records: &[Record]) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    for record in records {
        writer.serialize(record).expect("records are flat");
    }
    writer.into_inner().expect("memory takes what is left")
}

/// Writes beside the file, then renames: a reader never sees half of it.
fn replace(path: &Path, text: &[u8]) -> Result<(), RecordError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.new", std::process::id()));
    let beside = path.with_file_name(name);
    let written = fs::write(&beside, text).and_then(|()| fs::rename(&beside, path));
    written.map_err(|error| {
        // What is left of it helps nobody; the first error is the one to tell.
        let _ = fs::remove_file(&beside);
        failure(path, error)
    })
}

fn failure(path: &Path, message: impl ToString) -> RecordError {
    RecordError { path: path.into(), message: message.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::now;

    fn awkward() -> Record {
        Record {
            date: now(),
            equation: "x^2 + y^2 = r^2; r = 1, \"quoted\",\nand on two lines".into(),
            outcome: "ok".into(),
            parameters: "r=(1 + sqrt(5))/2; w=0.5".into(),
            precision: Some(f64::MIN_POSITIVE),
            median_ms: Some(0.1 + 0.2),
            min_ms: Some(1.0 / 3.0),
            median_dt: Some(5e-324),
            worst_dt: Some(f64::INFINITY),
            clear_misses: Some(0),
            points: u64::MAX,
            ..Record::default()
        }
    }

    #[test]
    fn records_read_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.csv");
        let records = [awkward(), Record::default()];
        write(&path, &records).unwrap();
        assert_eq!(read(&path).unwrap(), records);
        append(&path, &records[..1]).unwrap();
        assert_eq!(read(&path).unwrap(), [awkward(), Record::default(), awkward()]);
        write(&path, &[]).unwrap();
        assert!(read(&path).unwrap().is_empty());
        append(&path, &records).unwrap();
        assert_eq!(read(&path).unwrap(), records);
        // Nothing is left beside the file.
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn appending_starts_a_file_and_finishes_a_cut_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("runs.csv");
        append(&path, &[awkward()]).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.trim_end()).unwrap();
        append(&path, &[awkward()]).unwrap();
        assert_eq!(read(&path).unwrap(), [awkward(), awkward()]);
    }

    #[test]
    fn other_files_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("notes.csv");
        fs::write(&path, "name,age\nAda,36\n").unwrap();
        let error = append(&path, &[awkward()]).unwrap_err();
        assert!(error.to_string().contains("notes.csv: its columns"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "name,age\nAda,36\n");
        let missing = folder.path().join("none").join("runs.csv");
        assert!(write(&missing, &[]).unwrap_err().to_string().contains("none"));
        assert!(read(&missing).is_err());
    }

    #[test]
    fn json_holds_every_column() {
        let value: serde_json::Value = serde_json::from_str(&json(&[awkward()])).unwrap();
        let row = value[0].as_object().unwrap();
        let names = csv::Reader::from_reader(&header()[..]).headers().unwrap().len();
        assert_eq!(row.len(), names);
        assert_eq!(row["points"], u64::MAX);
        assert_eq!(row["worst_dt"], serde_json::Value::Null);
    }
}
