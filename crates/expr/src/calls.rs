//! Calls, sums and tables.

use std::ops::Range;

use zeroset_ia::Binary;

use crate::ParseError;
use crate::chebyshev::{Form, MAX_DEGREE};
use crate::graph::Id;
use crate::names::{self, Callable};
use crate::parser::{Parser, Place};
use crate::rational::integer;

/// An argument and where it is.
type Argument = (Id, Range<usize>);

impl Parser<'_> {
    /// Reads the arguments of a function whose name stood at `name`.
    pub(crate) fn call(&mut self, f: Callable, name: Range<usize>) -> Result<Id, ParseError> {
        let open = self.here();
        self.skip();
        if let Callable::Sum = f {
            return self.written_sum(&name, open);
        }
        let arguments = self.arguments(open, ')')?;
        let span = name.start..self.previous().end;
        let graph = &mut self.context.graph;
        match (f, &arguments[..]) {
            (Callable::Square, [(a, _)]) => {
                let two = graph.constant(integer(2));
                Ok(graph.power(*a, two))
            }
            (Callable::Unary(f), [(a, _)]) => Ok(graph.unary(f, *a)),
            (Callable::Binary(Binary::Pow), [(a, _), (b, b_span)]) => {
                self.power(*a, *b, b_span.clone())
            }
            (Callable::Binary(Binary::Mod), [_, (b, b_span)]) if graph.is_integer(*b, 0) => {
                Err(self.error(b_span.clone(), "division by zero"))
            }
            (Callable::Binary(f @ (Binary::Min | Binary::Max)), [(a, _), rest @ ..])
                if !rest.is_empty() =>
            {
                Ok(rest.iter().fold(*a, |a, (b, _)| graph.binary(f, a, *b)))
            }
            (Callable::Binary(f), [(a, _), (b, _)]) => Ok(graph.binary(f, *a, *b)),
            (Callable::Chebyshev(form), [(n, n_span), (a, _)]) => {
                let n = self.degree(form, *n, n_span.clone())?;
                Ok(self.context.graph.chebyshev(form, n, *a))
            }
            (_, arguments) => {
                let name = self.shown(name);
                let (count, plural) = match f {
                    Callable::Square | Callable::Unary(_) => ("1", ""),
                    Callable::Binary(Binary::Min | Binary::Max) => ("2 or more", "s"),
                    _ => ("2", "s"),
                };
                let given = arguments.len();
                let message = format!("`{name}` takes {count} argument{plural}, not {given}");
                Err(self.error(span, message).help(format!("write `{}`", f.example())))
            }
        }
    }

    /// Reads arguments or entries up to the closing bracket.
    fn arguments(&mut self, open: Range<usize>, close: char) -> Result<Vec<Argument>, ParseError> {
        let mut arguments = Vec::new();
        if self.accept(close) {
            return Ok(arguments);
        }
        loop {
            let start = self.here().start;
            let value = self.sum()?;
            arguments.push((value, start..self.previous().end));
            if !self.accept(',') {
                self.close(open, close)?;
                return Ok(arguments);
            }
        }
    }

    /// The degree of a Chebyshev polynomial, which is so many operands when written out.
    fn degree(&mut self, form: Form, n: Id, span: Range<usize>) -> Result<u32, ParseError> {
        let degree = self.integer(n).and_then(|n| u32::try_from(n).ok());
        let Some(degree) = degree.filter(|n| *n <= MAX_DEGREE) else {
            let found = self.shown(span.clone());
            let message = format!(
                "`{form}(n, x)` wants a literal integer n from 0 to {MAX_DEGREE}, not `{found}`"
            );
            return Err(self.error(span, message));
        };
        self.count_operands(degree, span)?;
        Ok(degree)
    }

    /// Reads `i, a, b, term)` and adds the terms up.
    fn written_sum(&mut self, sum: &Range<usize>, open: Range<usize>) -> Result<Id, ParseError> {
        let span = self.here();
        let Some(index) = self.peek_name().map(String::from) else {
            let found = self.found();
            let message = format!("expected the name of an index, but found {found}");
            return Err(self.error(span, message).help("write `sum(i, 1, 3, i*x^i)`"));
        };
        let taken = names::is_reserved(&index)
            || index == "w"
            || self.context.is_defined(&index)
            || self.context.indices.iter().any(|(name, _)| *name == index);
        if taken {
            let message = format!("`{index}` has a meaning already: choose another index");
            return Err(self.error(span, message));
        }
        self.skip();
        let first = self.bound(sum)?;
        let last = self.bound(sum)?;
        self.comma(sum)?;
        if first > last {
            let message = format!("this sum from {first} to {last} has no terms");
            return Err(self.error(sum.start..self.previous().end, message));
        }
        let start = self.mark();
        let mut total = None;
        for i in first..=last {
            self.go_back(start);
            self.context.indices.push((index.clone(), i));
            let term = self.sum()?;
            self.context.indices.pop();
            total = Some(match total {
                None => term,
                Some(total) => self.context.graph.add(total, term),
            });
        }
        self.close(open, ')')?;
        Ok(total.expect("there is a first term"))
    }

    /// Reads a comma and a bound of a sum.
    fn bound(&mut self, sum: &Range<usize>) -> Result<i64, ParseError> {
        self.comma(sum)?;
        let start = self.here().start;
        let value = self.in_constant(Self::sum)?;
        let span = start..self.previous().end;
        self.integer(value).ok_or_else(|| {
            let found = self.shown(span.clone());
            self.error(span, format!("a bound of a sum is an integer, not `{found}`"))
        })
    }

    /// Reads a comma between the arguments of a sum.
    fn comma(&mut self, sum: &Range<usize>) -> Result<(), ParseError> {
        if self.accept(',') {
            return Ok(());
        }
        let found = self.found();
        let span = sum.start..self.here().end;
        let message = format!("`sum` takes an index, two bounds and a term, but found {found}");
        Err(self.error(span, message).help("write `sum(i, 1, 3, i*x^i)`"))
    }

    /// Reads where only constants make sense.
    fn in_constant<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, ParseError>,
    ) -> Result<T, ParseError> {
        let place = std::mem::replace(&mut self.place, Place::Constant);
        let value = read(self)?;
        self.place = place;
        Ok(value)
    }

    /// Reads `[1, 2, 3][i]`.
    pub(crate) fn literal_table(&mut self) -> Result<Id, ParseError> {
        let open = self.here();
        self.skip();
        let entries = self.in_constant(|parser| parser.arguments(open.clone(), ']'))?;
        let table = open.start..self.previous().end;
        if entries.is_empty() {
            return Err(self.error(table, "this table has no entries"));
        }
        let i = self.index("this table", table, entries.len())?;
        Ok(entries[i].0)
    }

    /// Reads the `[i]` of a named table.
    pub(crate) fn table_entry(&mut self, name: &str, span: Range<usize>) -> Result<Id, ParseError> {
        let length = self.context.table_length(name).expect("it is a table");
        let i = self.index(&format!("`{name}`"), span.clone(), length)?;
        let error = self.error(span, "");
        self.context.entry(name, i, |message| ParseError { message, ..error })
    }

    /// Reads `[i]`, and gives the index counted from 0.
    fn index(
        &mut self,
        table: &str,
        span: Range<usize>,
        length: usize,
    ) -> Result<usize, ParseError> {
        let open = self.here();
        if !self.accept('[') {
            return Err(self
                .error(span, format!("{table} is a table of {length} constants"))
                .help("choose one by its index, as in `t[1]`"));
        }
        let start = self.here().start;
        let value = self.in_constant(Self::sum)?;
        let index = start..self.previous().end;
        self.close(open, ']')?;
        let found = self.shown(index.clone());
        let Some(i) = self.integer(value) else {
            let message = format!("an index is a constant integer, not `{found}`");
            return Err(self.error(index, message));
        };
        match usize::try_from(i) {
            Ok(i) if (1..=length).contains(&i) => Ok(i - 1),
            _ => {
                let message = format!("index {i} is outside of {table}, which has 1 to {length}");
                Err(self.error(index, message))
            }
        }
    }
}
