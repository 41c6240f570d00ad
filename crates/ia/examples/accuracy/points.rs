//! Arguments at which functions are hard.

use std::f64::consts::FRAC_PI_2;

use zeroset_ia::Scalar;

/// A sequence of pseudo-random numbers (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 up to, and without, `end`.
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }

    /// From 0 up to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn pick(&mut self, from: &[f64]) -> f64 {
        from[self.below(from.len() as u64) as usize]
    }
}

/// Zeros, ends of domains, fixed points, overflow and underflow of exponentials, and where a function
/// turns into its asymptote or a library changes its method.
const SPECIAL: [f64; 34] = [
    0.0, 0.03125, 0.125, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 10.0, 0.1, 16.6, 18.37, 19.06, 22.18, 28.0,
    36.04, 37.42, 38.53, 44.85, 87.34, 88.72, 103.97, 126.0, 128.0, 149.0, 307.65, 308.25, 323.3,
    708.4, 709.78, 745.13, 1022.0, 1024.0,
];

/// Nearer to a multiple of pi/2 than any other double of their size.
const HARD_ANGLES: [f64; 4] =
    [5.319372648326541e255, 2.0197660453083944e6, 1.1597110740910382e6, 2.8943728736971784e6];

/// A hard argument: one of many kinds, then moved by a few floats.
pub(crate) fn argument<S: Scalar>(random: &mut Random) -> S {
    let is_single = size_of::<S>() == 4;
    let (digits, least, most) = if is_single { (24, -149, 127) } else { (53, -1074, 1023) };
    let exponent =
        |random: &mut Random, lo: i32, hi: i32| lo + random.below((hi - lo) as u64) as i32;
    let x = match random.below(10) {
        // Any float at all; those that are no numbers become special ones.
        0 if is_single => f64::from(f32::from_bits(random.bits() as u32)),
        0 => f64::from_bits(random.bits()),
        1 if random.below(8) == 0 => random.pick(&HARD_ANGLES),
        1 => random.pick(&SPECIAL) * (1.0 + power_of_two(exponent(random, -60, 0)) * random.unit()),
        // Near multiples of pi/2, small ones and large ones.
        2 => {
            let largest = 1 << (1 + random.below(digits as u64 - 1));
            random.below(largest) as f64 * FRAC_PI_2
        }
        // Powers of two, down to the least subnormal.
        3 => power_of_two(exponent(random, least, most)),
        // Subnormal numbers.
        4 => power_of_two(least) * random.below(1 << (digits - 1)) as f64,
        // Near 1, at any distance.
        5 => 1.0 - power_of_two(exponent(random, -60, 0)) * (random.unit() - 0.5),
        // So small that the second term of the series decides the rounding.
        6 => power_of_two(exponent(random, -digits, 0)) * (1.0 + random.unit()),
        // Few digits: sums and products of them are exact or ties.
        7 => (random.below(1 << (digits / 2 + 1)) as f64) * power_of_two(exponent(random, -40, 10)),
        8 => 100.0 * random.unit(),
        _ => 1000.0 * random.unit(),
    };
    let x = if x.is_finite() { x } else { 1.0 };
    let mut x = S::from_f64(if random.below(2) == 0 { x } else { -x });
    for _ in 0..random.below(4) {
        x = if random.below(2) == 0 { x.up() } else { x.down() };
    }
    if x.to_f64().is_finite() { x } else { S::from_f64(1.0) }
}

fn power_of_two(exponent: i32) -> f64 {
    // In two steps, since the least subnormal has no reciprocal.
    2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent - exponent / 2)
}
