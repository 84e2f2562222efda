//! Random numbers that a scene can give again.

/// Numbers from 0 to below 1 that follow from a seed (Steele, Lea and Flood, OOPSLA 2014).
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// Numbers of a seed.
    pub fn new(seed: i64) -> SplitMix64 {
        SplitMix64(seed as u64)
    }

    /// The next number.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 53) as f64
    }
}
