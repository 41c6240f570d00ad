//! Headers of lines with a key and a value.

use std::str::FromStr;

use glam::DVec3;

use super::Fault;

/// The most bytes of a header; what is longer is none.
const LONGEST: usize = 1 << 16;

/// The fields of a header in their order.
#[derive(Debug, Default)]
pub(super) struct Fields(Vec<(String, String)>);

/// The next line without its end, and what follows.
pub(super) fn line(bytes: &[u8]) -> Result<(String, &[u8]), Fault> {
    let window = &bytes[..bytes.len().min(LONGEST)];
    let (line, rest) = match window.iter().position(|b| *b == b'\n') {
        Some(end) => (&bytes[..end], &bytes[end + 1..]),
        None if window.len() == bytes.len() => (bytes, &[][..]),
        None => return Err(Fault::new("a header line has no end; this is another kind of file")),
    };
    Ok((String::from_utf8_lossy(line).trim_end().to_owned(), rest))
}

impl Fields {
    /// Adds a field. Keys are the same in any case of letters.
    pub(super) fn add(&mut self, key: &str, value: &str) -> Result<(), Fault> {
        let length: usize = self.0.iter().map(|(key, value)| key.len() + value.len() + 2).sum();
        if length > LONGEST {
            return Err(Fault::new("the header has no end; this is another kind of file"));
        }
        self.0.push((key.trim().to_ascii_lowercase(), value.trim().to_owned()));
        Ok(())
    }

    /// The value of the first of these keys that is there.
    pub(super) fn find(&self, keys: &[&str]) -> Option<&str> {
        let value = |key: &&str| {
            let mut fields = self.0.iter();
            fields.find(|(name, _)| name.eq_ignore_ascii_case(key)).map(|(_, value)| value.as_str())
        };
        keys.iter().find_map(value)
    }

    pub(super) fn get(&self, key: &str) -> Result<&str, Fault> {
        self.find(&[key]).ok_or_else(|| {
            Fault::new(format!("the header has no {key}; add it, or fetch the file again"))
        })
    }

    /// The size from one field of three.
    pub(super) fn size(&self, key: &str) -> Result<[usize; 3], Fault> {
        numbers(key, self.get(key)?)
    }

    /// A vector from the first of these fields that is there.
    pub(super) fn vector(&self, keys: &[&str], default: f64) -> Result<DVec3, Fault> {
        match self.find(keys) {
            Some(text) => numbers(keys[0], text).map(DVec3::from),
            None => Ok(DVec3::splat(default)),
        }
    }
}

/// A number, or a fault that names the field.
pub(super) fn number<T: FromStr>(key: &str, text: &str) -> Result<T, Fault> {
    text.trim().parse().map_err(|_| {
        let shown: String = text.chars().take(40).collect();
        Fault::new(format!("{key} is {shown:?}, which is no number that it takes; correct it"))
    })
}

/// Three numbers between spaces.
pub(super) fn numbers<T: FromStr>(key: &str, text: &str) -> Result<[T; 3], Fault> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let [x, y, z] = words[..] else {
        return Err(Fault::new(format!(
            "{key} has {} numbers, not 3; only volumes are read, with one number a sample",
            words.len()
        )));
    };
    Ok([number(key, x)?, number(key, y)?, number(key, z)?])
}
