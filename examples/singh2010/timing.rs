//! How often something is done until its time is known.

use std::time::{Duration, Instant};

use zeroset::gpu::Device;
use zeroset::gpu::program::Module;
use zeroset::ia::Rounding;

use crate::Failure;
use crate::peak::{self, Load};

/// How often at least.
const ROUNDS: usize = 3;
/// How long at least on a GPU.
const BUSY: Duration = Duration::from_millis(100);
/// For how long a GPU is heated at first.
const HEATED: Duration = Duration::from_secs(2);

/// How something is timed.
///
/// A GPU with little to do lowers its clock, to a fifth on a card that was tried, and short frames are
/// little: between them it is given other work.
pub(crate) struct Timing<'a> {
    heat: Option<Load<'a>>,
}

impl<'a> Timing<'a> {
    /// On the processor.
    pub(crate) const HERE: Timing<'static> = Timing { heat: None };

    /// On a device, which may be the processor.
    pub(crate) fn on(device: &'a Device) -> Result<Self, Failure> {
        if device.report().kind == "software" {
            return Ok(Self { heat: None });
        }
        let chains = peak::chains(peak::CHAINS[0]);
        let load = Load::new(device, &Module::new(Rounding::Nearest), &chains, 1 << 21)?;
        let begun = Instant::now();
        while begun.elapsed() < HEATED {
            load.run()?;
        }
        Ok(Self { heat: Some(load) })
    }

    /// The least time of what tells the device's time, if it has a clock.
    pub(crate) fn least(
        &self,
        mut once: impl FnMut() -> Result<Option<Duration>, Failure>,
    ) -> Result<Duration, Failure> {
        let busy = if self.heat.is_some() { BUSY } else { Duration::ZERO };
        let begun = Instant::now();
        let (mut least, mut rounds) = (Duration::MAX, 0);
        while rounds < ROUNDS || begun.elapsed() < busy {
            if let Some(load) = &self.heat {
                load.run()?;
            }
            let start = Instant::now();
            let time = once()?;
            least = least.min(time.unwrap_or_else(|| start.elapsed()));
            rounds += 1;
        }
        Ok(least)
    }
}
