//! Levels of 8 bits: products and mixtures, where 255 stands for 1.
//!
//! The scalar arithmetic of texture functions and blending, by which their lanes are judged. Clocks: none of its own.

/// The product of two levels: (a b + 127) / 255, rounded down.
#[must_use]
#[inline(always)]
pub fn mul8(a: u8, b: u8) -> u8 {
    ((u16::from(a) * u16::from(b) + 127) / 255) as u8
}

/// From level `a` to level `b` by `t`: (a (255 - t) + b t + 127) / 255, rounded down.
#[must_use]
#[inline(always)]
pub fn mix8(a: u8, b: u8, t: u8) -> u8 {
    // At most 255 * 255 + 127: it fits 16 bits.
    ((u16::from(a) * u16::from(255 - t) + u16::from(b) * u16::from(t) + 127) / 255) as u8
}

/// The whole part of `x`, which is 0 or more and below 2^22. Plain casts have to look for numbers that do not fit, one lane
/// after another.
#[must_use]
#[inline(always)]
pub fn whole(x: f32) -> u32 {
    const TOP: f32 = (1 << 23) as f32;
    // The nearest integer stands in the low bits of the sum.
    let nearest = x + TOP;
    (nearest.to_bits() & 0x7F_FFFF).wrapping_sub(u32::from(nearest - TOP > x))
}

/// The same in double precision, below 2^31.
#[must_use]
#[inline(always)]
pub fn whole_double(x: f64) -> u32 {
    const TOP: f64 = (1_u64 << 52) as f64;
    let nearest = x + TOP;
    (nearest.to_bits() as u32).wrapping_sub(u32::from(nearest - TOP > x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_of_any_level_and_its_neighbours_is_what_a_cast_gives() {
        for quarter in 0..1100_u32 {
            let single = quarter as f32 / 4.0;
            for bits in [single.to_bits(), single.to_bits() + 1, single.to_bits().saturating_sub(1)] {
                let x = f32::from_bits(bits);
                assert_eq!(whole(x), x as u32, "{x}");
            }
            let double = f64::from(single);
            for bits in [double.to_bits(), double.to_bits() + 1, double.to_bits().saturating_sub(1)] {
                let x = f64::from_bits(bits);
                assert_eq!(whole_double(x), x as u32, "{x}");
            }
        }
    }
}
