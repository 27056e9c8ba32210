//! Random numbers for fixed constructions: always the same, from a seed that stands in the test.

/// Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators".
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The sequence of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number of `low..=high`.
    pub fn range(&mut self, low: i64, high: i64) -> i64 {
        let span = u128::from((high - low) as u64) + 1;
        low + ((u128::from(self.bits()) * span) >> 64) as i64
    }

    /// As [`Random::range`], for coordinates.
    pub fn int(&mut self, low: i32, high: i32) -> i32 {
        self.range(low.into(), high.into()) as i32
    }

    /// A depth of `0..=greatest`.
    pub fn depth(&mut self, greatest: u32) -> u32 {
        self.range(0, greatest.into()) as u32
    }

    /// A number of `0..1`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of `low..high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}
