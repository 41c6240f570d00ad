//! Devices: finding, choosing and opening them, and what can go wrong on them.

mod buffer;
mod choice;
mod kernel;
mod raster;
mod sequence;

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

pub use buffer::{Buffer, Reader};
pub use choice::{Choice, VARIABLE, knob, read_knob};
pub use kernel::{AsBinding, Binding, Kernel};
pub use raster::{BoundPipeline, DepthStart, DepthTest, Format, Mixing, Pass, Pipeline, Texture};
pub use sequence::{Bound, Clock, Groups, Step};
use zeroset_raycast::Error;

/// What is wrong with a device.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DeviceError {
    /// There is no adapter at all.
    #[error(
        "no GPU was found: install a Vulkan driver (on Debian or Ubuntu, in software: \
         apt-get install mesa-vulkan-drivers); `zeroset devices` lists what there is"
    )]
    NoAdapter,
    /// No adapter is of that number or name.
    #[error("no device is {wanted:?}; numbers and names are {known}")]
    Unknown {
        /// What was asked for.
        wanted: String,
        /// Numbers and names of those that exist.
        known: String,
    },
    /// The adapter did not give a device.
    #[error("the device {0} cannot be opened: {1}")]
    Refused(String, String),
    /// The device is gone, and what was computed on it.
    #[error("the device {0} was lost: {1}; the next request opens it anew")]
    Lost(String, String),
    /// Too little memory.
    #[error("the device {0} is out of memory; make the image smaller")]
    OutOfMemory(String),
    /// The driver or the shader compiler refused something.
    #[error("the device {0} reports: {1}")]
    Invalid(String, String),
}

impl From<DeviceError> for Error {
    fn from(error: DeviceError) -> Self {
        Self::Device(error.to_string())
    }
}

/// A device as the system describes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// The name.
    pub name: String,
    /// Discrete, integrated, virtual or in software.
    pub kind: &'static str,
    /// The interface: Vulkan, Metal or Dx12.
    pub backend: String,
    /// The driver and its version.
    pub driver: String,
    /// The largest buffer that a kernel may use, in bytes.
    pub largest_binding: u64,
    /// Can it time its own work?
    pub timestamps: bool,
}

impl AdapterReport {
    fn of(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        Self {
            kind: match info.device_type {
                wgpu::DeviceType::DiscreteGpu => "discrete",
                wgpu::DeviceType::IntegratedGpu => "integrated",
                wgpu::DeviceType::VirtualGpu => "virtual",
                wgpu::DeviceType::Cpu => "software",
                wgpu::DeviceType::Other => "unknown",
            },
            backend: format!("{:?}", info.backend),
            driver: format!("{} {}", info.driver, info.driver_info).trim().into(),
            largest_binding: adapter.limits().max_storage_buffer_binding_size,
            timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
            name: info.name,
        }
    }
}

/// The devices of this machine, in the order of their numbers.
pub fn adapters() -> Vec<AdapterReport> {
    found().iter().map(AdapterReport::of).collect()
}

/// The adapters; real GPUs first.
fn found() -> Vec<wgpu::Adapter> {
    static INSTANCE: LazyLock<wgpu::Instance> = LazyLock::new(|| {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        if !cfg!(debug_assertions) {
            // Kernels write counts of workgroups within every device's limit. Checking them takes another
            // kernel each time.
            descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
        }
        wgpu::Instance::new(descriptor)
    });
    let mut adapters = pollster::block_on(INSTANCE.enumerate_adapters(wgpu::Backends::PRIMARY));
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    adapters
}

/// The device of that choice, without opening it.
///
/// # Errors
/// If there is none.
pub fn find(choice: &Choice) -> Result<AdapterReport, DeviceError> {
    chosen(&choice.resolved()).map(|adapter| AdapterReport::of(&adapter))
}

fn chosen(choice: &Choice) -> Result<wgpu::Adapter, DeviceError> {
    let mut adapters = found();
    if adapters.is_empty() {
        return Err(DeviceError::NoAdapter);
    }
    let Choice::Named(wanted) = choice else {
        return Ok(adapters.swap_remove(0));
    };
    let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
    let by_name =
        |name: &String| !wanted.is_empty() && name.to_lowercase().contains(&wanted.to_lowercase());
    let index = match wanted.parse::<usize>() {
        Ok(number) if number < names.len() => Some(number),
        // A number may be a part of a name, too.
        _ => names.iter().position(by_name),
    };
    let unknown = || DeviceError::Unknown {
        wanted: wanted.clone(),
        known: names
            .iter()
            .enumerate()
            .map(|(i, n)| format!("{i}: {n}"))
            .collect::<Vec<_>>()
            .join(", "),
    };
    Ok(adapters.swap_remove(index.ok_or_else(unknown)?))
}

/// An open device, shared by everything that uses it.
#[derive(Debug)]
pub struct Device {
    report: AdapterReport,
    device: wgpu::Device,
    queue: wgpu::Queue,
    lost: Arc<Mutex<Option<String>>>,
    /// One user at a time: errors and times belong to who caused them.
    turn: Mutex<()>,
    /// What was made on it so far, and what was read.
    made: AtomicUsize,
    read: AtomicUsize,
}

impl Device {
    /// The device of that choice, opened once for the whole process; anew if it was lost.
    ///
    /// # Errors
    /// If there is none, or it cannot be opened.
    pub fn open(choice: &Choice) -> Result<Arc<Self>, DeviceError> {
        static OPEN: LazyLock<Mutex<HashMap<Choice, Arc<Device>>>> = LazyLock::new(Mutex::default);
        let choice = choice.resolved();
        let mut open = OPEN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(device) = open.get(&choice).filter(|device| device.loss().is_none()) {
            return Ok(device.clone());
        }
        let device = Arc::new(Self::new(&chosen(&choice)?)?);
        open.insert(choice, device.clone());
        Ok(device)
    }

    fn new(adapter: &wgpu::Adapter) -> Result<Self, DeviceError> {
        let report = AdapterReport::of(adapter);
        let limits = wgpu::Limits::default().using_resolution(adapter.limits());
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("zeroset"),
            required_features: adapter.features()
                & (wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::FLOAT32_BLENDABLE),
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| DeviceError::Refused(report.name.clone(), e.to_string()))?;
        let lost = Arc::new(Mutex::new(None));
        let note = lost.clone();
        device.set_device_lost_callback(move |reason, message| {
            // Dropping a device is no loss.
            if reason != wgpu::DeviceLostReason::Destroyed {
                *note.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
            }
        });
        let (made, read) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Ok(Self { report, device, queue, lost, turn: Mutex::new(()), made, read })
    }

    /// What it is.
    pub fn report(&self) -> &AdapterReport {
        &self.report
    }

    /// The largest buffer that a kernel may use, in bytes.
    pub fn largest_binding(&self) -> u64 {
        self.device.limits().max_storage_buffer_binding_size
    }

    /// How many buffers, bindings, kernels and clocks were made on it so far, and how many buffers were read:
    /// for tests of what a frame does.
    pub fn counts(&self) -> [usize; 2] {
        [&self.made, &self.read].map(|count| count.load(Ordering::Relaxed))
    }

    /// Was it lost? Then it is of no use any more.
    pub fn is_lost(&self) -> bool {
        self.loss().is_some()
    }

    /// Why it was lost, if it was.
    fn loss(&self) -> Option<String> {
        self.lost.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Does something on the device; every error of the driver comes back from here.
    fn guarded<T>(&self, work: impl FnOnce() -> Result<T, DeviceError>) -> Result<T, DeviceError> {
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        let filters = [
            wgpu::ErrorFilter::OutOfMemory,
            wgpu::ErrorFilter::Validation,
            wgpu::ErrorFilter::Internal,
        ];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let result = work();
        let mut errors = Vec::new();
        for scope in scopes.into_iter().rev() {
            errors.extend(pollster::block_on(scope.pop()));
        }
        let name = || self.report.name.clone();
        if let Some(reason) = self.loss() {
            return Err(DeviceError::Lost(name(), reason));
        }
        match errors.into_iter().next() {
            None => result,
            Some(wgpu::Error::OutOfMemory { .. }) => Err(DeviceError::OutOfMemory(name())),
            Some(error) => Err(DeviceError::Invalid(name(), error.to_string())),
        }
    }

    /// Waits until the device has done all that was submitted.
    fn wait(&self) -> Result<(), DeviceError> {
        let done = self.device.poll(wgpu::PollType::wait_indefinitely());
        done.map(|_| ()).map_err(|e| DeviceError::Invalid(self.report.name.clone(), e.to_string()))
    }

    /// Destroys the device, as a driver's reset would: for tests of what follows.
    #[doc(hidden)]
    pub fn lose(&self) {
        *self.lost.lock().unwrap_or_else(PoisonError::into_inner) = Some("it was destroyed".into());
        self.device.destroy();
    }
}
