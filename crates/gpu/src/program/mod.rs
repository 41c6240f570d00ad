//! Functions as shader code.
//!
//! A [`Module`] collects tapes as functions of the shading language, each over one kind of number, and
//! the constants that they read, which live in a buffer: new values for an equation's parameters need
//! no new code. Plain numbers are the language's own. Interval operations are recorded from
//! `zeroset_ia`'s, so that there is one definition of them.

mod interval;
mod plain;
mod trace;

use zeroset_expr::{Instruction, Op, Tape};
use zeroset_ia::{Rounding, portable};
use zeroset_raycast::Unsupported;

/// What a function computes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// `f32`, as the device has it.
    Plain,
    /// Intervals `vec2f(lo, hi)` of [`portable`] reals.
    Interval,
}

/// Shader functions and their constants.
#[derive(Clone, Debug)]
pub struct Module {
    rounding: Rounding,
    source: String,
    /// The interval operations that are needed, each once, with their code.
    operations: Vec<(String, String)>,
    constants: Vec<[f32; 4]>,
    statements: usize,
}

/// The most statements of a shader's functions, an interval operation counted as eight: compilers take
/// a second for this many, and far longer than in proportion for more.
const MOST_STATEMENTS: usize = 8192;

/// The most constants that fit in a uniform buffer on every device.
const MOST_UNIFORM: usize = 4096;

impl Module {
    /// No functions; intervals will round outward, or to nearest.
    pub fn new(rounding: Rounding) -> Self {
        Self {
            rounding,
            source: String::new(),
            operations: Vec::new(),
            constants: Vec::new(),
            statements: 0,
        }
    }

    /// Adds a tape as the function `name(x, y, z)`, or for a slope `name(x, y, z, dx, dy, dz)`.
    ///
    /// # Errors
    /// If an operation has no form on devices, or there are too many.
    pub fn function(
        &mut self,
        name: &str,
        tape: &Tape,
        numbers: Numbers,
    ) -> Result<(), Unsupported> {
        let (ty, weight) = match numbers {
            Numbers::Plain => ("f32", 1),
            Numbers::Interval => ("vec2f", 8),
        };
        self.statements += weight * tape.instructions().len();
        if self.statements > MOST_STATEMENTS {
            return Err(Unsupported(format!(
                "the function is too long for a shader: {} statements, of at most {MOST_STATEMENTS}; \
                 use a CPU method",
                self.statements
            )));
        }
        let inputs = ["x", "y", "z", "dx", "dy", "dz"];
        let parameters: Vec<_> =
            inputs[..tape.inputs()].iter().map(|name| format!("{name}: {ty}")).collect();
        let mut body = format!("fn {name}({}) -> {ty} {{\n", parameters.join(", "));
        // Where each register's value is: registers are written more than once, names are not.
        let mut places: Vec<String> = vec![String::new(); tape.registers()];
        for (place, input) in places.iter_mut().zip(&inputs[..tape.inputs()]) {
            *place = (*input).into();
        }
        let first = self.constants.len() as u32;
        for (line, Instruction { op, out }) in tape.instructions().iter().enumerate() {
            let operands = op.operands().map(|r| r.map_or("", |r| &places[r as usize]));
            let constant = op.constant().map(|c| format!("constants[{}]", first + c));
            let constant = constant.as_deref().unwrap_or_default();
            let value = match numbers {
                Numbers::Plain => plain::expression(*op, operands, constant),
                Numbers::Interval => self.interval(*op, operands, constant)?,
            };
            let place = format!("v{line}");
            body += &format!("    let {place} = {value};\n");
            places[*out as usize] = place;
        }
        body += &format!("    return {};\n}}\n", places[tape.output() as usize]);
        self.source += &body;
        self.constants.extend(values(tape));
        Ok(())
    }

    /// An operation over intervals; its function is added if it is not there yet.
    fn interval(
        &mut self,
        op: Op,
        [a, b]: [&str; 2],
        constant: &str,
    ) -> Result<String, Unsupported> {
        if let Op::Load(_) = op {
            return Ok(format!("{constant}.yz"));
        }
        let operation = interval::Operation::of(op)?;
        let name = operation.name();
        if !self.operations.iter().any(|(known, _)| *known == name) {
            let code = operation.code();
            self.operations.push((name.clone(), code));
        }
        let second = if constant.is_empty() { b.to_owned() } else { format!("{constant}.yz") };
        Ok(if second.is_empty() {
            format!("{name}({a})")
        } else {
            format!("{name}({a}, {second})")
        })
    }

    /// The whole shader: the functions, and the kernel that calls them. The constants are binding 0.
    pub fn shader(&self, kernel: &str) -> String {
        let count = self.constants.len().max(1);
        let space = if count <= MOST_UNIFORM { "uniform" } else { "storage, read" };
        let mut text = format!(
            "// Nearest value, and enclosure.\n\
             @group(0) @binding(0) var<{space}> constants: array<vec4f, {count}>;\n\n"
        );
        text += interval::marks(self.rounding);
        for (_, code) in &self.operations {
            text += code;
        }
        text += &self.source;
        text += kernel;
        text
    }

    /// How the kernel's buffer of constants is bound.
    pub fn binding(&self) -> crate::device::Binding {
        if self.constants.len() <= MOST_UNIFORM {
            crate::device::Binding::Uniform
        } else {
            crate::device::Binding::Read
        }
    }

    /// The constants, in the order in which functions were added; never empty.
    pub fn constants(&self) -> Vec<[f32; 4]> {
        if self.constants.is_empty() { vec![[0.0; 4]] } else { self.constants.clone() }
    }
}

/// A tape's constants: nearest value, enclosure, nothing.
pub(crate) fn values(tape: &Tape) -> impl Iterator<Item = [f32; 4]> {
    tape.constants().iter().map(|c| {
        let [lo, hi] = portable::enclosure(c);
        [c.nearest_f32, lo, hi, 0.0]
    })
}
