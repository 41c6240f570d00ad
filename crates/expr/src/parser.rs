//! Tokens to expressions.
//!
//! ```text
//! equation := sum [ "=" sum ]
//! sum      := product (("+" | "-") product)*
//! product  := signed (("*" | "/") signed)*
//! signed   := "-" signed | power
//! power    := operand [ "^" signed ]               so -x^2 = -(x^2), x^y^z = x^(y^z)
//! operand  := number | name | name "[" sum "]" | call | table "[" sum "]" | "(" sum ")"
//! ```

use std::ops::Range;

use num_traits::Signed;

use crate::ParseError;
use crate::definitions::{Chunk, Context};
use crate::graph::{Id, Node};
use crate::lexer::{Kind, Token};
use crate::names::{self, Callable};
use crate::rational::{self, MAX_EXPONENT, integer};

/// The longest text, in bytes.
pub(crate) const MAX_TEXT: usize = 1 << 20;
/// The most parentheses, signs, powers and definitions around an operand.
const MAX_DEPTH: usize = 200;
/// The most operands, those of sums counted once a term; `T_n` counts as n.
const MAX_OPERANDS: usize = 100_000;

/// Where an expression stands, which decides what its names can mean.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Place {
    /// In the equation: x, y, z.
    Equation,
    /// Where only constants make sense.
    Constant,
    /// In a polynomial in one unknown, which has a name once it was met.
    Polynomial(Option<String>),
}

/// How tightly an operator binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Binding {
    Sum,
    Product,
    Sign,
    Power,
}

/// A reader of one chunk.
pub(crate) struct Parser<'a> {
    pub(crate) context: &'a mut Context,
    chunk: Chunk,
    /// The next token.
    at: usize,
    pub(crate) place: Place,
}

impl<'a> Parser<'a> {
    pub(crate) fn new(context: &'a mut Context, chunk: Chunk, place: Place) -> Self {
        let at = chunk.range.start;
        Self { context, chunk, at, place }
    }

    /// Reads an equation: one side, or the left side less the right side.
    pub(crate) fn equation(&mut self) -> Result<Id, ParseError> {
        let mut value = self.sum()?;
        if self.accept('=') {
            if self.peek_symbol() == Some('=') {
                let span = self.previous().start..self.here().end;
                return Err(self.error(span, "unexpected `==`").help("write one `=`"));
            }
            let right = self.sum()?;
            value = self.context.graph.sub(value, right);
        }
        self.end()?;
        Ok(value)
    }

    /// Reads a constant and nothing after it.
    pub(crate) fn constant(&mut self) -> Result<Id, ParseError> {
        let value = self.sum()?;
        self.end()?;
        Ok(value)
    }

    /// Reads a parameter's value: a constant, or `root:` and a polynomial.
    pub(crate) fn value(&mut self) -> Result<Id, ParseError> {
        let is_root = self.peek_name() == Some("root")
            && self.chunk.tokens.get(self.at + 1).map(|t| &t.kind) == Some(&Kind::Symbol(':'));
        if !is_root {
            return self.constant();
        }
        self.at += 2;
        self.place = Place::Polynomial(None);
        let polynomial = self.constant()?;
        if self.place == Place::Polynomial(None) {
            return Err(self
                .error(self.chunk.span(), "this polynomial has no unknown")
                .help("write for example `root:7*u^3 + 7*u + 1`"));
        }
        let root = self.context.graph.intern(Node::Root(polynomial));
        let chunk = self.chunk.clone();
        self.context.written.entry(root).or_insert((chunk.clone(), chunk.span()));
        Ok(root)
    }

    /// Reads sums and whatever binds tighter.
    pub(crate) fn sum(&mut self) -> Result<Id, ParseError> {
        self.expression(Binding::Sum)
    }

    /// Reads operators that bind at least as tightly as `loosest`.
    fn expression(&mut self, loosest: Binding) -> Result<Id, ParseError> {
        if self.context.depth == MAX_DEPTH {
            let message =
                format!("nested too deeply: at most {MAX_DEPTH} parentheses, signs and powers");
            return Err(self.error(self.here(), message));
        }
        self.context.depth += 1;
        let start = self.here().start;
        let mut left = self.signed()?;
        while let Some(symbol) = self.operator()? {
            let binding = match symbol {
                '+' | '-' => Binding::Sum,
                '*' | '/' => Binding::Product,
                _ => Binding::Power,
            };
            if binding < loosest {
                break;
            }
            let operator = self.here();
            self.at += 1;
            if symbol == '*' && self.peek_symbol() == Some('*') {
                let span = operator.start..self.here().end;
                return Err(self.error(span, "unexpected `**`").help("write `^` for a power"));
            }
            let tighter = match binding {
                Binding::Sum => Binding::Product,
                Binding::Product => Binding::Sign,
                Binding::Sign | Binding::Power => Binding::Power,
            };
            let right_start = self.here().start;
            let right = self.expression(tighter)?;
            let right_span = right_start..self.previous().end;
            left = match symbol {
                '+' => self.context.graph.add(left, right),
                '-' => self.context.graph.sub(left, right),
                '*' => self.context.graph.mul(left, right),
                '/' => self.quotient(left, right, right_span)?,
                _ => self.power(left, right, right_span)?,
            };
            self.note(left, start);
        }
        self.context.depth -= 1;
        Ok(left)
    }

    /// Remembers where a constant was written.
    pub(crate) fn note(&mut self, id: Id, start: usize) {
        let graph = &self.context.graph;
        if graph.is_constant(id) && graph.number(id).is_none() {
            let span = start..self.previous().end;
            let chunk = &self.chunk;
            self.context.written.entry(id).or_insert_with(|| (chunk.clone(), span));
        }
    }

    fn quotient(&mut self, a: Id, b: Id, span: Range<usize>) -> Result<Id, ParseError> {
        if self.context.graph.is_integer(b, 0) {
            return Err(self.error(span, "division by zero"));
        }
        Ok(self.context.graph.div(a, b))
    }

    pub(crate) fn power(&mut self, a: Id, b: Id, span: Range<usize>) -> Result<Id, ParseError> {
        let limit = integer(MAX_EXPONENT);
        match self.context.graph.number(b) {
            Some(n) if n.is_integer() && n.abs() > limit => {
                let message = format!(
                    "the exponent {} is too large: integers are limited to {MAX_EXPONENT}",
                    self.shown(span.clone())
                );
                Err(self.error(span, message))
            }
            _ => Ok(self.context.graph.power(a, b)),
        }
    }

    /// The next token if it is a binary operator; none at the end of an expression.
    fn operator(&self) -> Result<Option<char>, ParseError> {
        let Some(token) = self.peek() else { return Ok(None) };
        match token.kind {
            Kind::Symbol(c @ ('+' | '-' | '*' | '/' | '^')) => Ok(Some(c)),
            Kind::Number(_) | Kind::Name | Kind::Symbol('(' | '[') => Err(self.missing_operator()),
            Kind::Symbol(_) => Ok(None),
        }
    }

    /// The error for two operands in a row.
    fn missing_operator(&self) -> ParseError {
        let (left, right) = (self.previous(), self.here());
        let [a, b] = [left.clone(), right.clone()].map(|span| &self.chunk.text[span]);
        let message = format!("there is no operator between `{a}` and `{b}`");
        let error = self.error(left.start..right.end, message);
        if b == "[" {
            return error.help("only tables have entries: `t = [1, 2, 3]` and `t[2]`");
        }
        let a = if a == ")" { "(...)" } else { a };
        let b = if b == "(" { "(...)" } else { b };
        error.help(format!("write `{a}*{b}`"))
    }

    fn signed(&mut self) -> Result<Id, ParseError> {
        let start = self.here().start;
        if self.accept('-') {
            let value = self.expression(Binding::Sign)?;
            let value = self.context.graph.neg(value);
            self.note(value, start);
            return Ok(value);
        }
        let value = self.operand()?;
        self.note(value, start);
        Ok(value)
    }

    fn operand(&mut self) -> Result<Id, ParseError> {
        let span = self.here();
        self.count_operands(1, span.clone())?;
        let Some(token) = self.peek() else { return Err(self.missing_operand()) };
        match &token.kind {
            Kind::Number(value) => {
                let value = value.clone();
                self.at += 1;
                Ok(self.context.graph.constant(value))
            }
            Kind::Name => self.name(span),
            Kind::Symbol('(') => {
                self.at += 1;
                let value = self.sum()?;
                self.close(span, ')')?;
                Ok(value)
            }
            Kind::Symbol('[') => self.literal_table(),
            Kind::Symbol(_) => Err(self.missing_operand()),
        }
    }

    /// Counts operands that the expression has when it is written out.
    pub(crate) fn count_operands(&mut self, n: u32, span: Range<usize>) -> Result<(), ParseError> {
        self.context.operands += n as usize;
        if self.context.operands > MAX_OPERANDS {
            let message = format!(
                "the equation is too large: at most {MAX_OPERANDS} operands, sums and `T` written out"
            );
            return Err(self.error(span, message));
        }
        Ok(())
    }

    fn missing_operand(&self) -> ParseError {
        let place = self.here();
        if self.chunk.range.is_empty() {
            return self.error(place, "there is nothing to read: expected an expression");
        }
        let error = self.error(
            place.clone(),
            format!("expected a number, a name or `(`, but found {}", self.found()),
        );
        match self.peek_symbol() {
            Some('+') => error.help("leave this `+` out"),
            Some('*' | '/' | '^') if self.at == self.chunk.range.start => error,
            Some('*') if self.shown(self.previous()) == "*" => error.help("write `^` for a power"),
            _ => error,
        }
    }

    /// Reads a name and what belongs to it.
    fn name(&mut self, span: Range<usize>) -> Result<Id, ParseError> {
        let name = self.chunk.text[span.clone()].to_string();
        self.at += 1;
        if let Some(callable) = Callable::from_name(&name) {
            if self.peek_symbol() == Some('(') {
                return self.call(callable, span);
            }
            let argument = match self.peek().map(|t| (&t.kind, t.span.clone())) {
                Some((Kind::Number(_) | Kind::Name, argument)) => Some(self.shown(argument)),
                _ => None,
            };
            let example = match argument {
                Some(argument) if callable.example().ends_with("(x)") => {
                    format!("{name}({argument})")
                }
                _ => callable.example(),
            };
            return Err(self
                .error(span, format!("expected `(` after the function `{name}`"))
                .help(format!("write `{example}`")));
        }
        if let Some(&(_, i)) = self.context.indices.iter().find(|(n, _)| *n == name) {
            return Ok(self.context.graph.constant(integer(i)));
        }
        if self.context.table_length(&name).is_some() {
            return self.table_entry(&name, span);
        }
        if self.context.is_defined(&name) {
            let chunk = &self.chunk;
            let is_polynomial = matches!(self.place, Place::Polynomial(_));
            return self.context.parameter(&name, |message| {
                let error = chunk.error(span, message);
                if is_polynomial {
                    return error.help("give the polynomial's unknown a name of its own");
                }
                error
            });
        }
        match &mut self.place {
            Place::Polynomial(unknown) if name != "pi" => match unknown {
                Some(u) if *u != name => {
                    let message = format!(
                        "`{name}` is a second unknown beside `{u}`: a polynomial has one here"
                    );
                    return Err(self.error(span, message));
                }
                _ => {
                    *unknown = Some(name);
                    return Ok(self.context.graph.intern(Node::Variable(0)));
                }
            },
            _ => {}
        }
        match (name.as_str(), &self.place) {
            ("pi", _) => Ok(self.context.graph.intern(Node::Pi)),
            ("x" | "y" | "z", Place::Equation) => {
                let axis = name.as_bytes()[0] - b'x';
                Ok(self.context.graph.intern(Node::Variable(axis)))
            }
            ("w", Place::Equation) => {
                let chunk = &self.chunk;
                self.context.parameter("w", |message| chunk.error(span, message))
            }
            ("x" | "y" | "z" | "w", _) => {
                Err(self.error(span, format!("`{name}` varies, but a constant is expected here")))
            }
            _ => Err(self.unknown_name(&name, span)),
        }
    }

    fn unknown_name(&self, name: &str, span: Range<usize>) -> ParseError {
        let lower = name.to_lowercase();
        if matches!(lower.as_str(), "inf" | "infinity" | "nan") {
            let message = format!("`{name}` is no number: infinite and undefined values are not");
            return self.error(span, message);
        }
        if name == "root" {
            let message = "a root can only be the whole value of a parameter";
            return self.error(span, message).help("write `...; a = root:7*u^3 + 7*u + 1`");
        }
        let called = self.peek_symbol() == Some('(');
        let kind = if called { "function" } else { "name" };
        let error = self.error(span, format!("unknown {kind} `{name}`"));
        if let Some(known) = names::synonym(name) {
            return error.help(format!("write `{known}`"));
        }
        match names::nearest(name, names::known().chain(self.context.names())) {
            Some(near) => error.help(format!("did you mean {near}?")),
            None if called => error,
            None if self.place == Place::Equation => error.help(format!(
                "the variables are `x`, `y` and `z`; a parameter is defined at the end, as in \
                 `...; {name} = 1`"
            )),
            None => error,
        }
    }

    // Tokens.

    fn peek(&self) -> Option<&Token> {
        self.chunk.tokens[..self.chunk.range.end].get(self.at)
    }

    pub(crate) fn peek_symbol(&self) -> Option<char> {
        match self.peek()?.kind {
            Kind::Symbol(c) => Some(c),
            _ => None,
        }
    }

    pub(crate) fn peek_name(&self) -> Option<&str> {
        let token = self.peek()?;
        (token.kind == Kind::Name).then(|| &self.chunk.text[token.span.clone()])
    }

    /// Takes the next token if it is this symbol.
    pub(crate) fn accept(&mut self, c: char) -> bool {
        let is = self.peek_symbol() == Some(c);
        self.at += usize::from(is);
        is
    }

    /// Takes the next token, whatever it is.
    pub(crate) fn skip(&mut self) {
        self.at += 1;
    }

    /// Where the next token is; where the chunk ends, if there is none.
    pub(crate) fn here(&self) -> Range<usize> {
        match self.peek() {
            Some(token) => token.span.clone(),
            None => {
                let end = self.chunk.span().end;
                end..end
            }
        }
    }

    /// Where the last token was.
    pub(crate) fn previous(&self) -> Range<usize> {
        self.chunk.tokens[..self.at].last().map_or(0..0, |t| t.span.clone())
    }

    /// The place of the next token, to come back to.
    pub(crate) fn mark(&self) -> usize {
        self.at
    }

    pub(crate) fn go_back(&mut self, mark: usize) {
        self.at = mark;
    }

    /// The next token in words.
    pub(crate) fn found(&self) -> String {
        match self.peek() {
            Some(token) => format!("`{}`", self.shown(token.span.clone())),
            None => "the end".into(),
        }
    }

    /// A piece of the text, for a message.
    pub(crate) fn shown(&self, span: Range<usize>) -> String {
        let text = &self.chunk.text[span];
        match text.char_indices().nth(40) {
            Some((end, _)) => format!("{}...", &text[..end]),
            None => text.into(),
        }
    }

    pub(crate) fn error(&self, span: Range<usize>, message: impl Into<String>) -> ParseError {
        self.chunk.error(span, message)
    }

    /// Takes the bracket that closes the one at `open`.
    pub(crate) fn close(&mut self, open: Range<usize>, c: char) -> Result<(), ParseError> {
        if self.accept(c) {
            return Ok(());
        }
        let bracket = self.shown(open.clone());
        Err(match self.peek_symbol() {
            None => self.error(open, format!("this `{bracket}` is not closed")),
            Some(',') => self
                .error(self.here(), format!("unexpected `,` in `{bracket}...{c}`"))
                .help("decimals are written with a point, as in 0.5"),
            Some(_) => {
                let found = self.found();
                self.error(open, format!("this `{bracket}` is not closed: found {found} first"))
            }
        })
    }

    /// Expects the end of the chunk.
    fn end(&self) -> Result<(), ParseError> {
        let Some(symbol) = self.peek_symbol() else { return Ok(()) };
        let error = |message: &str| self.error(self.here(), message);
        Err(match symbol {
            ')' => error("this `)` has no `(` before it"),
            ']' => error("this `]` has no `[` before it"),
            '=' if self.place == Place::Equation => error("an equation has only one `=`"),
            '=' => error("unexpected `=` in a constant")
                .help("definitions are separated by `;`, as in `a = 1; b = 2`"),
            ',' => error("unexpected `,`").help("decimals are written with a point, as in 0.5"),
            _ => error(&format!("unexpected `{symbol}`")),
        })
    }

    /// The value of a constant expression that must be an integer.
    pub(crate) fn integer(&self, id: Id) -> Option<i64> {
        self.context.graph.number(id).and_then(rational::to_integer)
    }
}
