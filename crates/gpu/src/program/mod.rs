//! Functions as shader code.
//!
//! A [`Module`] collects tapes as functions of the shading language, each over one kind of number, and
//! the constants that they read, which live in a buffer: new values for an equation's parameters need
//! no new code. Plain numbers are the language's own. Operations of intervals and affine forms are recorded
//! from `zeroset_ia`'s, so that there is one definition of them.

mod affine;
mod interval;
mod parts;
mod plain;
mod trace;

pub use parts::Parts;
pub use trace::Trace;

use zeroset_expr::{Instruction, Op, Tape};
use zeroset_ia::{Affine, Interval, Rounding, portable};
use zeroset_raycast::Unsupported;

use crate::device::{Binding, Buffer, Device, DeviceError};

/// What a function computes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// `f32`, as the device has it.
    Plain,
    /// Intervals `vec2f(lo, hi)` of [`portable`] reals.
    Interval,
    /// Affine forms with three symbols, arrays as [`Parts`] has them, of [`portable`] reals.
    Affine,
}

impl Numbers {
    /// The type in the shading language.
    pub fn type_name(self) -> String {
        parts::type_of(match self {
            Self::Plain => 1,
            Self::Interval => Interval::<Trace>::WIDTH,
            Self::Affine => Affine::<Trace, 3>::WIDTH,
        })
    }
}

/// Shader functions and their constants.
#[derive(Clone, Debug)]
pub struct Module {
    rounding: Rounding,
    source: String,
    /// The operations of intervals and affine forms that are needed, each once, with their code.
    operations: Vec<(String, String)>,
    constants: Vec<[f32; 4]>,
    statements: usize,
}

/// The most statements of a shader's functions, an operation of intervals counted as eight, one of affine
/// forms as 64: compilers take
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
        let ty = numbers.type_name();
        let weight = match numbers {
            Numbers::Plain => 1,
            Numbers::Interval => 8,
            Numbers::Affine => 64,
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
                Numbers::Affine => self.affine(*op, operands, constant)?,
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
        self.add(&name, operation.code());
        let second = if constant.is_empty() { b.to_owned() } else { format!("{constant}.yz") };
        Ok(if second.is_empty() {
            format!("{name}({a})")
        } else {
            format!("{name}({a}, {second})")
        })
    }

    /// The same over affine forms.
    fn affine(&mut self, op: Op, [a, b]: [&str; 2], constant: &str) -> Result<String, Unsupported> {
        let (name, code) = affine::operation(op)?;
        self.add(&name, code);
        let constant = if constant.is_empty() { String::new() } else { format!("{constant}.yz") };
        let operands = [a, b, &constant].into_iter().filter(|operand| !operand.is_empty());
        Ok(format!("{name}({})", operands.collect::<Vec<_>>().join(", ")))
    }

    /// Adds a function, recorded from what `f` does with the reals of its operands, which have these widths
    /// (as [`Parts`] has them). A second one of the same name is not added.
    pub fn record<N: Parts>(
        &mut self,
        name: &str,
        widths: &[usize],
        f: impl FnOnce(&[Trace]) -> N,
    ) {
        self.add(name, parts::function(name, widths, f));
    }

    /// Adds an operation if it is not there yet.
    fn add(&mut self, name: &str, code: String) {
        if !self.operations.iter().any(|(known, _)| known == name) {
            self.operations.push((name.to_owned(), code));
        }
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
    pub fn binding(&self) -> Binding {
        if self.constants.len() <= MOST_UNIFORM { Binding::Uniform } else { Binding::Read }
    }

    /// The kernel's buffer of constants, with them.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn buffer(&self, device: &Device) -> Result<Buffer<[f32; 4]>, DeviceError> {
        let values = self.constants();
        let buffer = match self.binding() {
            Binding::Uniform => device.uniform(values.len())?,
            _ => device.storage(values.len())?,
        };
        device.write(&buffer, &values)?;
        Ok(buffer)
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
