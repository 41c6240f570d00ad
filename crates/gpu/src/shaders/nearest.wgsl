// Rounding to nearest: marks do nothing.
fn step_down(x: f32, steps: u32) -> f32 {
    return x;
}

fn step_up(x: f32, steps: u32) -> f32 {
    return x;
}

