//! What an equation defines after its `;`, and what is defined for it.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;

use num_traits::One;

use crate::function::{Definitions, Parameter};
use crate::graph::{Graph, Id, Node};
use crate::lexer::{self, Kind, Token};
use crate::names;
use crate::parser::{Parser, Place};
use crate::rational::Rational;
use crate::{ParseError, parser};

/// A run of tokens of some text.
#[derive(Clone, Debug)]
pub(crate) struct Chunk {
    pub(crate) text: Rc<str>,
    pub(crate) tokens: Rc<[Token]>,
    pub(crate) range: Range<usize>,
    /// What a text is that is not the equation's own, for messages.
    role: Option<Rc<str>>,
}

impl Chunk {
    /// All of a text.
    pub(crate) fn new(text: &str, role: Option<&str>) -> Result<Self, ParseError> {
        let role: Option<Rc<str>> = role.map(Into::into);
        let name = |error: ParseError| match &role {
            Some(role) => ParseError { message: format!("{role}: {}", error.message), ..error },
            None => error,
        };
        if text.len() > parser::MAX_TEXT {
            let message =
                format!("the text has {} bytes: at most {} are read", text.len(), parser::MAX_TEXT);
            return Err(name(ParseError::new("", 0..0, message)));
        }
        let tokens: Rc<[Token]> = lexer::tokens(text).map_err(name)?.into();
        Ok(Self { text: text.into(), range: 0..tokens.len(), tokens, role })
    }

    /// Some of these tokens.
    fn part(&self, range: Range<usize>) -> Self {
        Self { range, ..self.clone() }
    }

    /// Where it is in its text; the place after the token before it, if it is empty.
    pub(crate) fn span(&self) -> Range<usize> {
        if self.range.is_empty() {
            let end = self.tokens[..self.range.start].last().map_or(0, |t| t.span.end);
            return end..end;
        }
        self.tokens[self.range.start].span.start..self.tokens[self.range.end - 1].span.end
    }

    /// Its text.
    pub(crate) fn source(&self) -> &str {
        &self.text[self.span()]
    }

    fn is_symbol(&self, i: usize, c: char) -> bool {
        self.range.contains(&i) && self.tokens[i].kind == Kind::Symbol(c)
    }

    /// An error at a place of its text.
    pub(crate) fn error(&self, span: Range<usize>, message: impl Into<String>) -> ParseError {
        let message = message.into();
        let message = match &self.role {
            Some(role) => format!("{role}: {message}"),
            None => message,
        };
        ParseError::new(&self.text, span, message)
    }

    /// Splits at a separator that is in no bracket.
    fn split(&self, separator: char) -> Vec<Self> {
        let mut depth = 0_usize;
        let mut start = self.range.start;
        let mut parts = Vec::new();
        for i in self.range.clone() {
            match self.tokens[i].kind {
                Kind::Symbol('(' | '[') => depth += 1,
                Kind::Symbol(')' | ']') => depth = depth.saturating_sub(1),
                Kind::Symbol(c) if c == separator && (depth == 0 || c == ';') => {
                    parts.push(self.part(start..i));
                    start = i + 1;
                }
                _ => {}
            }
        }
        parts.push(self.part(start..self.range.end));
        parts
    }
}

/// A constant that is read when it is first used.
#[derive(Clone, Debug)]
struct Entry {
    chunk: Chunk,
    state: State,
}

#[derive(Clone, Copy, Debug)]
enum State {
    Unread,
    Reading,
    Read(Id),
}

impl Entry {
    fn new(chunk: Chunk) -> Self {
        Self { chunk, state: State::Unread }
    }
}

#[derive(Clone, Debug)]
enum Definition {
    Parameter(Entry),
    Table(Vec<Entry>),
}

/// What all parts of an equation share while they are read.
#[derive(Debug)]
pub(crate) struct Context {
    pub(crate) graph: Graph,
    pub(crate) parameters: Vec<Parameter>,
    /// The indices of the sums around.
    pub(crate) indices: Vec<(String, i64)>,
    /// Open parentheses, signs, powers and definitions.
    pub(crate) depth: usize,
    /// Operands read so far, as if sums and Chebyshev polynomials were written out.
    pub(crate) operands: usize,
    /// Where each constant was first written.
    pub(crate) written: HashMap<Id, (Chunk, Range<usize>)>,
    definitions: BTreeMap<String, Definition>,
}

impl Context {
    /// A context with no definitions.
    pub(crate) fn new() -> Self {
        Self {
            graph: Graph::new(),
            parameters: Vec::new(),
            indices: Vec::new(),
            depth: 0,
            operands: 0,
            written: HashMap::new(),
            definitions: BTreeMap::new(),
        }
    }

    /// Adds what is defined for an equation.
    pub(crate) fn define(&mut self, definitions: &Definitions) -> Result<(), ParseError> {
        for Parameter { name, default } in &definitions.parameters {
            let chunk = Chunk::new(default, Some(&format!("the default of `{name}`")))?;
            self.insert(name, Definition::Parameter(Entry::new(chunk)), |m| {
                ParseError::new(name, 0..name.len(), m)
            })?;
        }
        for (name, entries) in &definitions.tables {
            let entry = |(i, text): (usize, &String)| {
                Chunk::new(text, Some(&format!("entry {} of `{name}`", i + 1))).map(Entry::new)
            };
            let entries = entries.iter().enumerate().map(entry).collect::<Result<_, _>>()?;
            self.insert(name, Definition::Table(entries), |m| {
                ParseError::new(name, 0..name.len(), m)
            })?;
        }
        Ok(())
    }

    fn insert(
        &mut self,
        name: &str,
        definition: Definition,
        error: impl Fn(String) -> ParseError,
    ) -> Result<(), ParseError> {
        let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic())
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_name {
            return Err(error(format!(
                "`{name}` is no name: names are letters, digits and `_`, a letter first"
            )));
        }
        if names::is_reserved(name) {
            return Err(error(format!("`{name}` has a meaning already: choose another name")));
        }
        if self.definitions.insert(name.into(), definition).is_some() {
            return Err(error(format!("`{name}` is defined twice")));
        }
        Ok(())
    }

    /// Splits an equation from its definitions, which replace those of the same name, and keeps them.
    pub(crate) fn split(&mut self, all: &Chunk) -> Result<Chunk, ParseError> {
        let mut parts = all.split(';').into_iter();
        let equation = parts.next().expect("there is a first part");
        let mut named = HashSet::new();
        for part in parts.filter(|p| !p.range.is_empty()) {
            let start = part.range.start;
            let name = &part.tokens[start];
            if name.kind != Kind::Name || !part.is_symbol(start + 1, '=') {
                return Err(part
                    .error(part.span(), "expected a definition after `;`")
                    .help("definitions are written as `r = 1` or `t = [1, 2, 3]`"));
            }
            let span = name.span.clone();
            let name = &part.text[span.clone()];
            let value = part.part(start + 2..part.range.end);
            let definition = if value.is_symbol(start + 2, '[') {
                Definition::Table(entries(&value)?)
            } else {
                Definition::Parameter(Entry::new(value))
            };
            if named.insert(name.to_string()) {
                self.definitions.remove(name);
            }
            self.insert(name, definition, |m| part.error(span.clone(), m))?;
        }
        Ok(equation)
    }

    /// Names that can be used, reserved ones aside.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        let indices = self.indices.iter().map(|(name, _)| name.as_str());
        self.definitions.keys().map(String::as_str).chain(indices)
    }

    /// Is there a parameter or a table of this name?
    pub(crate) fn is_defined(&self, name: &str) -> bool {
        self.definitions.contains_key(name)
    }

    /// The number of entries of a table.
    pub(crate) fn table_length(&self, name: &str) -> Option<usize> {
        match self.definitions.get(name)? {
            Definition::Table(entries) => Some(entries.len()),
            Definition::Parameter(_) => None,
        }
    }

    /// The node of a parameter, which is read at its first use; `error` is one at that use.
    pub(crate) fn parameter(
        &mut self,
        name: &str,
        error: impl FnOnce(String) -> ParseError,
    ) -> Result<Id, ParseError> {
        if name == "w" && !self.is_defined(name) {
            let half = Rational::new(One::one(), 2.into());
            let default = self.graph.constant(half);
            let known = self.parameters.iter().position(|p| p.name == name);
            let index = known.unwrap_or_else(|| self.new_parameter("w", "0.5"));
            return Ok(self.graph.intern(Node::Parameter(index as u32, default)));
        }
        let Some(Definition::Parameter(Entry { chunk, state })) = self.definitions.get(name) else {
            panic!("`{name}` is a parameter");
        };
        match *state {
            State::Read(id) => Ok(id),
            State::Reading => Err(error(format!("`{name}` is defined by itself"))),
            State::Unread => {
                let chunk = chunk.clone();
                self.set_state(name, 0, State::Reading);
                let index = self.new_parameter(name, chunk.source());
                let default = self.isolated(chunk, |parser| parser.value())?;
                let id = self.graph.intern(Node::Parameter(index as u32, default));
                self.set_state(name, 0, State::Read(id));
                Ok(id)
            }
        }
    }

    fn new_parameter(&mut self, name: &str, default: &str) -> usize {
        self.parameters.push(Parameter { name: name.into(), default: default.into() });
        self.parameters.len() - 1
    }

    /// An entry of a table, counted from 0, which is read at its first use.
    pub(crate) fn entry(
        &mut self,
        name: &str,
        i: usize,
        error: impl FnOnce(String) -> ParseError,
    ) -> Result<Id, ParseError> {
        let Some(Definition::Table(entries)) = self.definitions.get(name) else {
            panic!("`{name}` is a table");
        };
        match entries[i].state {
            State::Read(id) => Ok(id),
            State::Reading => {
                Err(error(format!("entry {} of `{name}` is defined by itself", i + 1)))
            }
            State::Unread => {
                let chunk = entries[i].chunk.clone();
                self.set_state(name, i, State::Reading);
                let id = self.isolated(chunk, |parser| parser.constant())?;
                self.set_state(name, i, State::Read(id));
                Ok(id)
            }
        }
    }

    fn set_state(&mut self, name: &str, i: usize, state: State) {
        match self.definitions.get_mut(name) {
            Some(Definition::Parameter(entry)) => entry.state = state,
            Some(Definition::Table(entries)) => entries[i].state = state,
            None => panic!("`{name}` is defined"),
        }
    }

    /// Reads a chunk outside of all sums.
    fn isolated(
        &mut self,
        chunk: Chunk,
        read: impl FnOnce(&mut Parser<'_>) -> Result<Id, ParseError>,
    ) -> Result<Id, ParseError> {
        let indices = std::mem::take(&mut self.indices);
        let id = read(&mut Parser::new(self, chunk, Place::Constant))?;
        self.indices = indices;
        Ok(id)
    }

    /// Reads definitions that were not used, for the sake of their errors alone.
    pub(crate) fn check_unused(&mut self) -> Result<(), ParseError> {
        let used = self.parameters.len();
        let cycle = |message| ParseError::new("", 0..0, message);
        for name in self.definitions.keys().cloned().collect::<Vec<_>>() {
            match self.table_length(&name) {
                Some(n) => {
                    for i in 0..n {
                        self.entry(&name, i, cycle)?;
                    }
                }
                None => {
                    self.parameter(&name, cycle)?;
                }
            }
        }
        self.parameters.truncate(used);
        Ok(())
    }
}

/// The entries of a table that is written as `[1, 2, 3]`.
fn entries(table: &Chunk) -> Result<Vec<Entry>, ParseError> {
    let Range { start, end } = table.range;
    if end < start + 2 || !table.is_symbol(end - 1, ']') {
        return Err(table
            .error(table.tokens[start].span.clone(), "this table is not closed")
            .help("a table is written as `[1, 2, 3]`"));
    }
    let entries = table.part(start + 1..end - 1).split(',');
    match entries.iter().find(|e| e.range.is_empty()) {
        Some(_) if entries.len() == 1 => {
            Err(table.error(table.span(), "this table has no entries"))
        }
        Some(e) => Err(table.error(e.span(), "an entry of the table is missing here")),
        None => Ok(entries.into_iter().map(Entry::new).collect()),
    }
}
