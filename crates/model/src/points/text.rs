//! Lines of numbers.

use std::borrow::Cow;

use glam::DVec3;

use super::{Error, Place};

/// A line that says something.
#[derive(Debug)]
pub(super) struct Line<'a> {
    file: &'a str,
    number: usize,
    text: Cow<'a, str>,
}

/// The lines of a file without comments (`#` to the end), those that are empty left out. Bytes that are no
/// UTF-8 are replaced: in a comment they do not matter, and in a number they are reported.
pub(super) fn lines<'a>(file: &'a str, bytes: &'a [u8]) -> impl Iterator<Item = Line<'a>> {
    let all = bytes.split(|&b| b == b'\n').enumerate();
    all.filter_map(move |(i, line)| {
        let said = line.split(|&b| b == b'#').next().unwrap_or_default().trim_ascii();
        let text = String::from_utf8_lossy(said);
        (!said.is_empty()).then_some(Line { file, number: i + 1, text })
    })
}

impl Line<'_> {
    /// The words between spaces.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        self.text.split_ascii_whitespace()
    }

    pub(super) fn number(&self) -> usize {
        self.number
    }

    pub(super) fn error(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::new(self.file, Place::Line(self.number), what, remedy)
    }

    pub(super) fn float(&self, word: &str) -> Result<f64, Error> {
        let no_number = |_| self.error(format!("{} is not a number", quoted(word)), "correct it");
        word.parse().map_err(no_number)
    }

    /// The next three words as numbers.
    pub(super) fn vector<'w>(
        &self,
        words: &mut impl Iterator<Item = &'w str>,
    ) -> Result<DVec3, Error> {
        let mut out = [0.0; 3];
        for number in &mut out {
            let missing = || self.error("fewer than three numbers", "complete the line");
            *number = self.float(words.next().ok_or_else(missing)?)?;
        }
        Ok(out.into())
    }
}

/// A word as messages show it: short, whatever it holds.
pub(super) fn quoted(word: &str) -> String {
    let mut short: String = word.chars().take(40).collect();
    if short.len() < word.len() {
        short.push_str("...");
    }
    format!("{short:?}")
}
