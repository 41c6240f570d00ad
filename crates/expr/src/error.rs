//! What can be wrong with an equation or a parameter.

use std::fmt::Write;
use std::ops::Range;

/// An equation that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ParseError {
    /// What is wrong, and what was expected.
    pub message: String,
    /// Where: bytes of `text`.
    pub span: Range<usize>,
    /// What to write instead, if that can be guessed.
    pub help: Option<String>,
    /// The text that was read.
    pub text: String,
}

/// The most characters of a line that are shown on either side of the fault.
const CONTEXT: usize = 40;

impl ParseError {
    /// An error at a place of a text.
    pub(crate) fn new(text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        Self { message: message.into(), span, help: None, text: text.into() }
    }

    /// Adds what to write instead.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// The message with the line it is about, carets under the fault, and the help.
    ///
    /// ```text
    /// error: there is no operator between `2` and `x`
    ///   |
    /// 1 | 2x + 1
    ///   | ^^
    ///   = help: write `2*x`
    /// ```
    pub fn render(&self) -> String {
        let start = self.text.floor_char_boundary(self.span.start);
        let end = self.text.floor_char_boundary(self.span.end).max(start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = self.text[start..].find('\n').map_or(self.text.len(), |i| start + i);
        let number = self.text[..start].matches('\n').count() + 1;
        let margin = " ".repeat(number.to_string().len());

        let before: Vec<char> = self.text[line_start..start].chars().collect();
        let fault: Vec<char> = self.text[start..end.min(line_end)].chars().collect();
        let after: Vec<char> = self.text[end.min(line_end)..line_end].chars().collect();
        let skipped = before.len().saturating_sub(CONTEXT);
        let left = if skipped > 0 { "..." } else { "" };
        // A long fault is cut, too; one past the end of the line still gets a caret.
        let shown = &fault[..fault.len().min(CONTEXT)];
        let rest = fault[shown.len()..].iter().chain(&after);
        let right = if rest.clone().count() > CONTEXT { "..." } else { "" };

        let plain = |c: &char| if c.is_control() { ' ' } else { *c };
        let line: String =
            (before[skipped..].iter().chain(shown).chain(rest.take(CONTEXT))).map(plain).collect();
        let indent = " ".repeat(left.len() + before.len() - skipped);
        let carets = "^".repeat(shown.len().max(1));
        let mut out = format!(
            "error: {}\n{margin} |\n{number} | {left}{line}{right}\n{margin} | {indent}{carets}\n",
            self.message
        );
        if let Some(help) = &self.help {
            let _ = writeln!(out, "{margin} = help: {help}");
        }
        out
    }
}

/// A parameter that cannot be given.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ParameterError {
    /// What is wrong, with the value and the names that exist.
    pub message: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fault_is_marked() {
        let error = ParseError::new("x +\n\t2y", 5..7, "no operator").help("write `2*y`");
        let expected = "error: no operator\n  |\n2 |  2y\n  |  ^^\n  = help: write `2*y`\n";
        assert_eq!(error.render(), expected);
    }

    #[test]
    fn the_end_of_the_text_is_marked() {
        let error = ParseError::new("é +", 4..4, "an operand is missing");
        assert!(error.render().ends_with("1 | é +\n  |    ^\n"));
        assert!(ParseError::new("", 0..0, "empty").render().ends_with("1 | \n  | ^\n"));
    }

    #[test]
    fn long_lines_are_cut() {
        let text = format!("{}?{}", "x+".repeat(500), "+x".repeat(500));
        let shown = ParseError::new(&text, 1000..1001, "stray").render();
        let lines: Vec<&str> = shown.lines().collect();
        assert!(lines[2].len() < 100);
        assert_eq!(lines[2].find('?'), lines[3].find('^'));
        let all = ParseError::new(&text, 0..text.len(), "all").render();
        assert!(all.lines().all(|l| l.len() < 120));
    }
}
