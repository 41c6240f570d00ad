//! What a device can do at most: chains of multiplications and additions.

use zeroset::gpu::device::{AsBinding, Binding};
use zeroset::gpu::{Choice, Device};

use crate::Failure;

/// Eight independent chains an invocation.
const KERNEL: &str = "
@group(0) @binding(0) var<storage, read_write> out: array<vec4f>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let i = id.y * groups.x * 64u + id.x;
    if i >= arrayLength(&out) {
        return;
    }
    let a = vec4f(1.0000001, 0.9999999, 1.0000002, 0.9999998);
    let b = vec4f(f32(i & 15u)) * 1e-7;
    var x = vec4f(f32(i));
    var y = x + 1.0;
    for (var k = 0u; k < 2048u; k++) {
        x = fma(x, a, b);
        y = fma(y, a, b);
    }
    out[i] = x + y;
}
";
const STEPS: f64 = 2048.0;
const INVOCATIONS: usize = 1 << 20;

/// Prints the rate of fused multiplications and additions, each counted as two operations.
pub(crate) fn print() -> Result<(), Failure> {
    let device = match Device::open(&Choice::Auto) {
        Ok(device) => device,
        Err(why) => {
            println!("\nThe device's peak: {why}");
            return Ok(());
        }
    };
    let kernel = device.kernel("peak", KERNEL, &[Binding::Write])?;
    let out = device.storage::<[f32; 4]>(INVOCATIONS)?;
    let bound: [&dyn AsBinding; 1] = [&out];
    let mut best = f64::INFINITY;
    for _ in 0..4 {
        if let Some(time) = device.run(&kernel, &bound, INVOCATIONS)? {
            best = best.min(time.as_secs_f64());
        }
    }
    let operations = INVOCATIONS as f64 * STEPS * 16.0;
    println!(
        "\nThe peak of {} by chains of `fma` in single precision: {:.1} GFLOP/s.",
        device.report().name,
        operations / best / 1e9
    );
    Ok(())
}
