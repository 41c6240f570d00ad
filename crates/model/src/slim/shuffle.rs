//! A random order that is the same everywhere and always.

/// The numbers below `count` in an order that depends on `seed` alone: Fisher and Yates' shuffle by SplitMix64.
pub(super) fn shuffled(count: usize, seed: u64) -> Vec<u32> {
    let mut state = seed;
    let mut order: Vec<u32> = (0..count as u32).collect();
    for i in (1..count).rev() {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        let j = (u128::from(z) * (i as u128 + 1)) >> 64;
        order.swap(i, j as usize);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_has_all_numbers_and_follows_the_seed() {
        let order = shuffled(1000, 7);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..1000).collect::<Vec<u32>>());
        assert_eq!(order, shuffled(1000, 7));
        assert_ne!(order, shuffled(1000, 8));
        let still = (0..1000).filter(|&i| order[i as usize] == i).count();
        assert!(still < 10, "{still}");
        // Written down, since files built from a seed should be the same tomorrow.
        assert_eq!(shuffled(8, 0), [1, 2, 6, 5, 4, 0, 3, 7]);
    }
}
