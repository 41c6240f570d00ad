//! How much of a device the march of the Chmutov surface of order 14 uses (Section 4.3), and where the
//! rest goes: chains of multiplications and additions, values alone, and the march.

use std::sync::Arc;
use std::time::Duration;

use zeroset::cpu::Amp;
use zeroset::cpu::amp::Adaptation;
use zeroset::expr::Tape;
use zeroset::gpu::device::{AsBinding, Binding, Buffer, Kernel};
use zeroset::gpu::program::{Module, Numbers};
use zeroset::gpu::{AmpGpu, Device, Frames};
use zeroset::ia::Rounding;
use zeroset::raycast::{Camera, Hits, Method, Progress, Rays, Request, View, Work};
use zeroset::shade::shaded;

use crate::tables::look;
use crate::timing::Timing;
use crate::{Failure, counts, row};

/// What every kernel here begins with.
const HEAD: &str = "
@group(0) @binding(1) var<storage, read_write> out: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let i = id.y * groups.x * 64u + id.x;
    if i >= arrayLength(&out) {
        return;
    }
";

/// Eight independent chains an invocation: as `fma`, and as the device likes to combine the two.
pub(crate) const CHAINS: [&str; 2] = ["fma(x, a, b)", "x * a + b"];
const CHAIN_OPERATIONS: f64 = 2048.0 * 16.0;

/// The kernel of one of the [`CHAINS`].
pub(crate) fn chains(link: &str) -> String {
    let links = format!("x = {link};\ny = {};\n", link.replace('x', "y")).repeat(16);
    format!(
        "
    let a = vec4f(1.0000001, 0.9999999, 1.0000002, 0.9999998);
    let b = vec4f(f32(i & 15u)) * 1e-7;
    var x = vec4f(f32(i));
    var y = x + 1.0;
    for (var k = 0u; k < 128u; k++) {{
        {links}
    }}
    let sum = x + y;
    out[i] = sum.x + sum.y + sum.z + sum.w;
}}
"
    )
}

/// Values at points of a line, which differs from one invocation to the next.
const VALUES: &str = "
    let start = vec3f(f32(i & 255u), f32(i >> 8u & 255u), f32(i >> 16u)) / 256.0;
    let direction = vec3f(0.577, 0.577, 0.578) + 0.01 * start;
    var sum = 0.0;
    for (var k = 0u; k < 256u; k++) {
        let p = start + f32(k) * 0.004 * direction;
        sum += value(p.x, p.y, p.z);
    }
    out[i] = sum;
}
";
const VALUES_EACH: f64 = 256.0;

/// Invocations at first, and at most.
const INVOCATIONS: [usize; 2] = [1 << 14, 1 << 22];
/// A run that takes so long is long enough.
const LONG: f64 = 0.02;

/// A kernel that does nothing but compute.
pub(crate) struct Load {
    device: Arc<Device>,
    kernel: Kernel,
    constants: Buffer<[f32; 4]>,
    out: Buffer<f32>,
}

impl Load {
    pub(crate) fn new(
        device: &Arc<Device>,
        module: &Module,
        body: &str,
        invocations: usize,
    ) -> Result<Self, Failure> {
        let source = module.shader(&format!("{HEAD}{body}"));
        let kernel = device.kernel("load", &source, &[Binding::Uniform, Binding::Write])?;
        let constants = device.uniform(module.constants().len())?;
        device.write(&constants, &module.constants())?;
        let out = device.storage::<f32>(invocations)?;
        Ok(Self { device: Arc::clone(device), kernel, constants, out })
    }

    /// Runs it once; the device's time.
    pub(crate) fn run(&self) -> Result<Option<Duration>, Failure> {
        let bound: [&dyn AsBinding; 2] = [&self.constants, &self.out];
        Ok(self.device.run(&self.kernel, &bound, self.out.len())?)
    }
}

/// The rate of a kernel with so many operations an invocation, a second.
fn rate(
    timing: &Timing,
    device: &Arc<Device>,
    module: &Module,
    body: &str,
    operations: f64,
) -> Result<f64, Failure> {
    let [mut invocations, most] = INVOCATIONS;
    loop {
        let load = Load::new(device, module, body, invocations)?;
        let least = timing.least(|| load.run())?.as_secs_f64();
        if least > LONG || invocations == most {
            return Ok(invocations as f64 * operations / least);
        }
        invocations *= 4;
    }
}

/// The part of the lanes of blocks of 8 by 4 pixels that compute a value while others of theirs do: to
/// the step with a root, and then in bisections, which a hit takes so many of.
fn busy(hits: &Hits, [width, height]: [usize; 2], bisections: u64) -> f64 {
    let (mut used, mut held) = (0, 0);
    for top in (0..height).step_by(4) {
        for left in (0..width).step_by(8) {
            let rows = top..(top + 4).min(height);
            let pixels =
                rows.flat_map(|y| (left..(left + 8).min(width)).map(move |x| y * width + x));
            let (mut march, mut narrow) = (0, 0);
            for pixel in pixels {
                let points = hits.work[pixel].points;
                let after =
                    if hits.certificate[pixel].is_hit() { bisections.min(points) } else { 0 };
                used += points;
                march = march.max(points - after);
                narrow = narrow.max(after);
            }
            held += 32 * (march + narrow);
        }
    }
    used as f64 / held.max(1) as f64
}

/// Section 4.3: what a frame of the Chmutov surface of order 14 takes, and the share of the device's peak.
pub(crate) fn section_4_3(
    timing: &Timing,
    device: &Arc<Device>,
    size: usize,
) -> Result<(), Failure> {
    println!("\n## Section 4.3, {size}x{size}, on the device\n");
    let scene = row(1, 4)?;
    let tape: Tape = counts::tape(&scene)?;
    // With the operations that make the point.
    let [value, slope] =
        [&tape, &tape.slope()].map(|tape| f64::from(counts::operations(tape)[0] + 6));
    println!(
        "{}: {value} operations a value with the 6 that make the point (the paper: over 75), {slope} a \
         slope. The paper: 70 values a ray, 1.38e9 operations a frame of 512x512, 65 % of the card's \
         peak. The peak is what chains of multiplications and additions reach.\n",
        scene.id
    );
    let plain = Module::new(Rounding::Nearest);
    let mut values = plain.clone();
    values.function("value", &tape, Numbers::Plain)?;
    let mut peak = 0.0_f64;
    for link in CHAINS {
        peak = peak.max(rate(timing, device, &plain, &chains(link), CHAIN_OPERATIONS)?);
    }
    let alone = rate(timing, device, &values, VALUES, VALUES_EACH * value)?;
    println!(
        "Lanes: the part of those of a block of 8 by 4 pixels that compute a value while any of them does.\n"
    );
    println!("| what | values a ray | operations a frame | ms | GFLOP/s | of the peak | lanes |");
    println!("|{}", "---|".repeat(7));
    let line = |what: &str, cells: &str, rate: f64, lanes: &str| {
        println!(
            "| {what} | {cells} | {:.1} | {:.0} % | {lanes} |",
            rate / 1e9,
            100.0 * rate / peak
        );
    };
    line("multiplications and additions, chained", "| |", peak, "");
    line("values on lines, every invocation 256 of them", "| |", alone, "");
    let view = View::new(Camera::facing(&scene.domain), size, size);
    let mut hits = Hits::new(Request::First, size * size);
    for (name, adaptation) in [("", Adaptation::On), (", no adaptation", Adaptation::Off)] {
        let method = AmpGpu::auto(Amp {
            distance_adaptation: adaptation,
            silhouette_adaptation: adaptation,
            ..Amp::default()
        });
        let intersector = method.prepare(&scene)?;
        let mut work = Work::default();
        let least = timing.least(|| {
            let report = intersector.intersect(Rays::View(&view), &mut hits, &Progress::new())?;
            work = report.work;
            Ok(report.device_time)
        })?;
        let mut frames = Frames::new(&method, &scene)?;
        let background = shaded::background(size);
        let resident = timing
            .least(|| Ok(frames.draw(&view, &look(&[], &background), &Progress::new())?))?;
        let operations = work.points as f64 * value + work.gradients as f64 * slope;
        for (what, time) in
            [("`amp-sign-gpu`", least), ("the same, a frame that stays there", resident)]
        {
            let seconds = time.as_secs_f64();
            let cells = format!(
                "{:.1} | {operations:.3e} | {:.3}",
                work.points as f64 / (size * size) as f64,
                1e3 * seconds
            );
            let lanes = format!(
                "{:.0} %",
                100.0 * busy(&hits, [size, size], method.twin.bisections.into())
            );
            line(&format!("{what}{name}"), &cells, operations / seconds, &lanes);
        }
    }
    Ok(())
}
