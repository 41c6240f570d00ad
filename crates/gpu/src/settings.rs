//! What all methods on devices have: the knob `device`.

use zeroset_cpu::Implicit;
use zeroset_expr::Tape;
use zeroset_raycast::{Error, Knob, KnobError, Scene, Unsupported};

use crate::device::{self, Choice, Device};

/// The knobs of a method's twin on the CPU that have a meaning on a device, and `device`.
pub(crate) fn knobs(twin: Vec<Knob>, choice: &Choice) -> Vec<Knob> {
    let mut knobs = twin;
    knobs.retain(|knob| !matches!(knob.name, "isa" | "packet" | "arithmetic" | "poles" | "delta"));
    knobs.push(Knob {
        name: "device",
        value: choice.to_string(),
        doc: "where it runs: a number or a part of a name in the list of `zeroset devices`, or auto: what the variable ZEROSET_DEVICE says, else the first (default auto)",
    });
    knobs
}

/// Reads the knob `device`: a device that there is.
pub(crate) fn read_device(value: &str) -> Result<Choice, KnobError> {
    let choice = Choice::read(value);
    if choice == Choice::Auto {
        return Ok(choice);
    }
    device::find(&choice).map(|_| choice).map_err(|why| KnobError::Value {
        knob: "device".into(),
        value: value.into(),
        expected: format!("auto, or a device by its number or a part of its name; {why}"),
    })
}

/// Is there a shader for the scene's function?
pub(crate) fn shader(
    method: &str,
    scene: &Scene,
    check: impl FnOnce(&Tape) -> Result<(), Unsupported>,
) -> Result<(), Unsupported> {
    match Implicit::new(method, scene) {
        Ok(implicit) => check(&implicit.tape),
        Err(Error::Unsupported(unsupported)) => Err(unsupported),
        // Wrong parameters and domains are for preparing to tell.
        Err(_) => Ok(()),
    }
}

/// Can the device be opened?
pub(crate) fn available(choice: &Choice) -> Result<(), Unsupported> {
    Device::open(choice).map(|_| ()).map_err(|e| Unsupported(e.to_string()))
}
