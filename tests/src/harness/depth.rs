//! Depths between steps and the f32 that a vertex carries.
//!
//! The card stores `z = floor(d (2^n - 1) + 1/2)`. Of 16 and 24 bits every z has an f32 d that leads to it; of 31 bits
//! only some have, because an f32 carries 24.

/// The depth that the card stores for vertex depth `d` in `0..=1`, computed in integers.
#[must_use]
pub fn stored(d: f32, bits: u32) -> u32 {
    let word = d.to_bits();
    let (exponent, fraction) = (word >> 23 & 0xFF, word & 0x007F_FFFF);
    // d = mantissa / 2^shift, denormals read as 0
    let (mantissa, shift) = if exponent == 0 { (0, 1) } else { (i128::from(fraction | 1 << 23), 150 - exponent) };
    // Anything below 2^-40 of the range is 0; the shift is kept within i128.
    let shift = shift.min(90);
    let greatest = (1_i128 << bits) - 1;
    let doubled = 2 * mantissa * greatest + (1_i128 << shift);
    (doubled >> (shift + 1)).clamp(0, greatest) as u32
}

/// The f32 nearest to z that the card stores as z; `None` if there is none (31 bits only).
#[must_use]
pub fn encode(z: u32, bits: u32) -> Option<f32> {
    let near = nearest(z, bits);
    let candidates = [near, near.next_down().max(0.0), near.next_up().min(1.0)];
    candidates.into_iter().find(|&d| stored(d, bits) == z)
}

/// A depth near `z` that survives the way through an f32.
#[must_use]
pub fn survivor(z: u32, bits: u32) -> u32 {
    encode(z, bits).map_or_else(|| stored(nearest(z, bits), bits), |_| z)
}

fn nearest(z: u32, bits: u32) -> f32 {
    (f64::from(z) / ((1_u64 << bits) - 1) as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn stored_ends_and_middle_are_as_the_rule_says() {
        assert_eq!([0.0, 1.0, 0.5].map(|d| stored(d, 16)), [0, 65535, 32768]);
        assert_eq!([0.0, 1.0, 0.5].map(|d| stored(d, 31)), [0, 0x7FFF_FFFF, 1 << 30]);
        assert_eq!(stored(1.0e-40, 31), 0);
    }

    proptest! {
        #[test]
        fn encode_16_and_24_bits_every_depth_survives(z in 0_u32..1 << 24) {
            prop_assert_eq!(encode(z, 24).map(|d| stored(d, 24)), Some(z));
            prop_assert_eq!(encode(z >> 8, 16).map(|d| stored(d, 16)), Some(z >> 8));
        }

        #[test]
        fn survivor_31_bits_is_near_and_survives(z in 0_u32..1 << 31) {
            let near = survivor(z, 31);

            prop_assert!(encode(near, 31).is_some());
            prop_assert!(near.abs_diff(z) <= 64);
        }
    }
}
