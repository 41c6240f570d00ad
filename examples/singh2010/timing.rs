//! How often something is done until its time is known.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
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
/// A GPU with little to do lowers its clock, to a sixth on a card that was tried, and short frames are
/// little. While this lives, the device is given other work whenever it has none.
pub(crate) struct Timing {
    heater: Option<Heater>,
}

impl Timing {
    /// On the processor.
    pub(crate) const HERE: Self = Self { heater: None };

    /// On a device, which may be the processor.
    pub(crate) fn on(device: &Arc<Device>) -> Result<Self, Failure> {
        // Without a clock of its own, what the device waits for would be counted.
        if device.report().kind == "software" || !device.report().timestamps {
            return Ok(Self::HERE);
        }
        let heater = Heater::new(device)?;
        std::thread::sleep(HEATED);
        Ok(Self { heater: Some(heater) })
    }

    /// The least time of what tells the device's time, if it has a clock.
    pub(crate) fn least(
        &self,
        mut once: impl FnMut() -> Result<Option<Duration>, Failure>,
    ) -> Result<Duration, Failure> {
        let busy = if self.heater.is_some() { BUSY } else { Duration::ZERO };
        let begun = Instant::now();
        let (mut least, mut rounds) = (Duration::MAX, 0);
        while rounds < ROUNDS || begun.elapsed() < busy {
            let start = Instant::now();
            let time = once()?;
            least = least.min(time.unwrap_or_else(|| start.elapsed()));
            rounds += 1;
        }
        Ok(least)
    }
}

/// Keeps a device busy. It runs one kernel at a time, so no other is slowed while it runs.
struct Heater {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Heater {
    fn new(device: &Arc<Device>) -> Result<Self, Failure> {
        let chains = peak::chains(peak::CHAINS[0]);
        let load = Load::new(device, &Module::new(Rounding::Nearest), &chains, 1 << 21)?;
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread =
            std::thread::spawn(
                move || {
                    while !stopped.load(Ordering::Relaxed) && load.run().is_ok() {}
                },
            );
        Ok(Self { stop, thread: Some(thread) })
    }
}

impl Drop for Heater {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // It holds nothing that a panic could spoil.
            let _ = thread.join();
        }
    }
}
