//! Text to tokens.

use std::ops::Range;

use crate::ParseError;
use crate::rational::{self, Rational};

/// What a token is; its text is in its span.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    /// A decimal number.
    Number(Rational),
    /// A name of letters, digits and underscores.
    Name,
    /// One of `+-*/^()[],=;:`.
    Symbol(char),
}

/// A piece of the text.
#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub(crate) kind: Kind,
    /// Where it is, in bytes.
    pub(crate) span: Range<usize>,
}

/// Splits a text into tokens.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token>, ParseError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = match c {
            _ if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            'a'..='z' | 'A'..='Z' => (Kind::Name, run(rest, is_name)),
            '0'..='9' => number(text, at)?,
            '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => number(text, at)?,
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | '[' | ']' | ',' | '=' | ';' | ':' => {
                (Kind::Symbol(c), 1)
            }
            _ => return Err(stray(text, at, c)),
        };
        tokens.push(Token { kind, span: at..at + length });
        at += length;
    }
    Ok(tokens)
}

fn is_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The length of the longest start of the text that consists of such characters.
fn run(text: &str, accept: impl Fn(char) -> bool) -> usize {
    text.find(|c| !accept(c)).unwrap_or(text.len())
}

/// Reads a number, which starts at the given place.
fn number(text: &str, start: usize) -> Result<(Kind, usize), ParseError> {
    let rest = &text[start..];
    let digits = |at: usize| at + run(&rest[at..], |c| c.is_ascii_digit());
    let mut end = digits(0);
    if rest[end..].starts_with('.') {
        end = digits(end + 1);
        if rest[end..].starts_with('.') {
            let all = run(rest, |c| c.is_ascii_digit() || c == '.');
            let message = format!("`{}` is no number: it has two decimal points", &rest[..all]);
            return Err(ParseError::new(text, start..start + all, message));
        }
    }
    let mantissa = end;
    if rest[end..].starts_with(['e', 'E']) {
        let sign = usize::from(rest[end + 1..].starts_with(['+', '-']));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        } else if !rest[end + 1..].starts_with(is_name) {
            let span = start..start + end + 1;
            let message = format!("the exponent of `{}` has no digits", &text[span.clone()]);
            let mantissa = &rest[..mantissa];
            return Err(ParseError::new(text, span, message)
                .help(format!("write `{mantissa}e1`, or `{mantissa}*e` for a product")));
        }
    }
    let hexadecimal = |c: char| c.is_ascii_hexdigit();
    if &rest[..end] == "0"
        && rest[1..].starts_with(['x', 'X'])
        && rest[2..].starts_with(hexadecimal)
    {
        let end = start + 2 + run(&rest[2..], is_name);
        let message = format!("`{}` is no decimal number", &text[start..end]);
        return Err(ParseError::new(text, start..end, message)
            .help("write numbers in decimal, as 16 or 0.5 or 1.5e-3"));
    }
    match rational::decimal(&rest[..end]) {
        Some(value) => Ok((Kind::Number(value), end)),
        None => Err(ParseError::new(
            text,
            start..start + end,
            "this number is too long: at most about 600 digits can be kept exactly",
        )),
    }
}

/// The error for a character that no equation contains.
fn stray(text: &str, at: usize, c: char) -> ParseError {
    let help = match c {
        '−' | '–' | '—' | '‐' | '‑' => "write `-` for minus",
        '×' | '·' | '⋅' | '∗' | '•' => "write `*` for a product",
        '÷' | '∕' | '⁄' => "write `/` for a quotient",
        '²' => "write `^2` for a square",
        '³' => "write `^3` for a cube",
        '⁰'..='⁹' | '¹' => "write `^` before an exponent",
        'π' => "write `pi`",
        '√' => "write `sqrt(...)`",
        '|' => "write `abs(...)` for an absolute value",
        '%' => "write `mod(a, b)` for a remainder",
        '{' | '}' => "write parentheses, `(` and `)`",
        '<' | '>' | '≤' | '≥' => "a surface is where two sides are equal: write `=`",
        '.' => "a number has digits beside its point, as in 0.5",
        '_' => "names start with a letter",
        _ if c.is_alphabetic() => "names consist of the letters a to z, digits and `_`",
        _ => "an equation has numbers, names, `+ - * / ^ ( ) [ ] , = ;`",
    };
    let span = at..at + c.len_utf8();
    let shown = c.escape_debug();
    ParseError::new(text, span, format!("unexpected character `{shown}`")).help(help)
}
