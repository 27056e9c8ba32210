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
