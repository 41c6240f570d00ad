//! A method's shader on a device.

use std::sync::Arc;

use zeroset_raycast::Error;

use crate::device::{Binding, Buffer, Choice, Device, Kernel};
use crate::program::Module;

/// A shader, compiled for a device that it also keeps open.
pub(crate) struct Compiled {
    choice: Choice,
    pub device: Arc<Device>,
    pub kernel: Kernel,
    pub constants: Buffer<[f32; 4]>,
    /// What calls the functions.
    caller: String,
    source: String,
}

impl Compiled {
    /// Compiles the functions and the kernel that calls them.
    pub(crate) fn new(choice: &Choice, module: &Module, caller: String) -> Result<Self, Error> {
        let source = module.shader(&caller);
        let device = Device::open(choice)?;
        let bindings = [module.binding(), Binding::Uniform, Binding::Read, Binding::Write];
        let kernel = device.kernel("rays", &source, &bindings)?;
        let constants = module.buffer(&device)?;
        Ok(Self { choice: choice.clone(), device, kernel, constants, caller, source })
    }

    /// The same for other constants, if the functions are the same; else all anew.
    pub(crate) fn update(&mut self, module: &Module) -> Result<(), Error> {
        if self.device.is_lost() || module.shader(&self.caller) != self.source {
            *self = Self::new(&self.choice, module, self.caller.clone())?;
        } else {
            let written = self.device.write(&self.constants, &module.constants());
            if written.is_err() {
                // Whose constants are there now is not known.
                self.source.clear();
            }
            written?;
        }
        Ok(())
    }

    /// Must it be [updated](Self::update) before it is used? The device was lost, or an update failed.
    pub(crate) fn is_stale(&self) -> bool {
        self.device.is_lost() || self.source.is_empty()
    }
}
