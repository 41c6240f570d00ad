// At least `steps` floats below x, whatever a subnormal x was flushed from; never subnormal.
fn step_down(x: f32, steps: u32) -> f32 {
    let bits = bitcast<u32>(x);
    let negative = bits >> 31u;
    let least = 0x00800000u;
    let stepped = select(bits - steps, bits + steps, negative == 1u);
    let around_zero = (bits & 0x7fffffffu) < least + select(steps, 0u, negative == 1u);
    return bitcast<f32>(select(stepped, 0x80000000u + least + steps, around_zero));
}

fn step_up(x: f32, steps: u32) -> f32 {
    return -step_down(-x, steps);
}

