//! Blend arithmetic: a layer's colour over what lies behind it, on levels of 8 bits.
//!
//! [`over`] is the definition, channel by channel. [`Factors`] is the same for 16 pixels at a time: every mode comes to
//!
//! ```text
//! c = min(255, round((d * F + K) / 255) + C)
//! ```
//!
//! of the level `d` behind, with numbers F, K and C that follow from the layer's colour alone, so that a layer of one
//! colour has them made once. d * F + K is at most 255 * 255, which fits a lane of 16 bits, and the quotient is two
//! shifts and two additions.
//!
//! Inputs from: colours of layers and pixels, RGBA, R in 7:0. Outputs to: [`super::tile`], [`super::pixels`],
//! [`super::specification`]. Clocks: 1 a fragment blended.

use crate::shading::levels::{mix8, mul8};
use fearless_simd::prelude::*;
use fearless_simd::{u16x32, u32x16};
use zga_abi::format::BlendMode;

/// A layer of colour `source` over a pixel of colour `behind`.
#[must_use]
pub fn over(mode: BlendMode, behind: u32, source: u32) -> u32 {
    let [behind, source] = [behind, source].map(u32::to_le_bytes);
    let (alpha, last) = (source[3], behind[3]);
    u32::from_le_bytes([0, 1, 2, 3].map(|k| {
        let (d, s) = (behind[k], source[k]);
        match (mode, k) {
            (BlendMode::Alpha, 3) => mix8(last, 255, alpha),
            (BlendMode::Alpha, _) => mix8(d, s, alpha),
            (BlendMode::Add | BlendMode::Multiply, 3) => last,
            (BlendMode::Add, _) => d.saturating_add(mul8(s, alpha)),
            (BlendMode::Multiply, _) => mul8(d, 255 - mul8(alpha, 255 - s)),
            (BlendMode::Premultiplied, 3) => alpha.saturating_add(mul8(last, 255 - alpha)),
            (BlendMode::Premultiplied, _) => s.saturating_add(mul8(d, 255 - alpha)),
        }
    }))
}

/// Two channels of 16 pixels, in the halves of their words: R and B, or G and A.
#[derive(Clone, Copy)]
struct Pair<S: Simd> {
    factor: u16x32<S>,
    /// K, and 128 more for the rounding.
    addend: u16x32<S>,
    constant: u16x32<S>,
}

/// What a layer does to 16 pixels.
#[derive(Clone, Copy)]
pub struct Factors<S: Simd> {
    pairs: [Pair<S>; 2],
}

/// t / 255 to the nearest, where `t` is 128 too large: exact up to 255 * 255.
#[inline(always)]
fn quotient<S: Simd>(t: u16x32<S>) -> u16x32<S> {
    (t + (t >> 8_u32)) >> 8_u32
}

// Functions, not closures: a closure is not sure to become part of code for the level that it runs at.
impl<S: Simd> Pair<S> {
    #[inline(always)]
    fn new(simd: S, mode: BlendMode, source: u16x32<S>, alpha: u16x32<S>) -> Self {
        let full = u16x32::splat(simd, 255);
        let none = u16x32::splat(simd, 0);
        let half = u16x32::splat(simd, 128);
        match mode {
            BlendMode::Alpha => Pair { factor: full - alpha, addend: source * alpha + half, constant: none },
            BlendMode::Add => Pair { factor: full, addend: half, constant: quotient(source * alpha + half) },
            BlendMode::Multiply => {
                let taken = quotient(alpha * (full - source) + half);
                Pair { factor: full - taken, addend: half, constant: none }
            }
            BlendMode::Premultiplied => Pair { factor: full - alpha, addend: half, constant: source },
        }
    }

    #[inline(always)]
    fn over(&self, simd: S, levels: u16x32<S>) -> u16x32<S> {
        (quotient(levels * self.factor + self.addend) + self.constant).min(u16x32::splat(simd, 255))
    }
}

impl<S: Simd> Factors<S> {
    /// Of 16 colours.
    #[inline(always)]
    pub fn new(simd: S, mode: BlendMode, colours: u32x16<S>) -> Self {
        // A level in both halves.
        let alpha = colours >> 24_u32;
        let alpha: u16x32<S> = (alpha | (alpha << 16_u32)).bitcast();
        // In modes that have a rule of their own for alpha the fourth level is one with which the others' rule does it.
        let colours = match mode {
            BlendMode::Alpha | BlendMode::Multiply => colours | 0xFF00_0000,
            BlendMode::Add => colours & 0x00FF_FFFF,
            BlendMode::Premultiplied => colours,
        };
        let lanes: u16x32<S> = colours.bitcast();
        let (low, high) = (lanes & 0xFF, lanes >> 8_u32);
        Factors { pairs: [Pair::new(simd, mode, low, alpha), Pair::new(simd, mode, high, alpha)] }
    }

    /// The layer over 16 pixels.
    #[inline(always)]
    pub fn over(&self, simd: S, behind: u32x16<S>) -> u32x16<S> {
        let behind: u16x32<S> = behind.bitcast();
        let low = self.pairs[0].over(simd, behind & 0xFF);
        let high = self.pairs[1].over(simd, behind >> 8_u32);
        (low | (high << 8_u32)).bitcast()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::Kernel;
    use fearless_simd::{Level, dispatch};

    #[test]
    fn over_each_mode_by_hand() {
        // Half of white over a grey of alpha 100.
        let (behind, source) = (0x6440_4040, 0x80FF_FFFF);
        // 64 * 127 + 255 * 128 = 40768, / 255 = 159.9; 100 * 127 + 255 * 128 = 45340, / 255 = 177.8.
        assert_eq!(over(BlendMode::Alpha, behind, source), 0xB2A0_A0A0);
        assert_eq!(over(BlendMode::Add, behind, source), 0x64C0_C0C0);
        // White lets all through; half of black lets 127 of 255 through.
        assert_eq!(over(BlendMode::Multiply, behind, source), behind);
        assert_eq!(over(BlendMode::Multiply, behind, 0x8000_0000), 0x6420_2020);
        assert_eq!(over(BlendMode::Premultiplied, behind, 0x8010_2030), 0xB230_4050);
        assert_eq!(over(BlendMode::Add, 0xFFFF_FFFF, 0xFFFF_FFFF), 0xFFFF_FFFF);
    }

    #[test]
    fn factors_every_level_alpha_and_level_behind_are_over() {
        let best = Level::new();
        let levels = Kernel::available().len();
        assert!(levels > 1);
        dispatch!(best, simd => {
            for mode in BlendMode::ALL {
                for alpha in 0..=255_u32 {
                    for level in 0..=255_u32 {
                        let source = alpha << 24 | level << 16 | (255 - level) << 8 | level;
                        let factors = Factors::new(simd, *mode, u32x16::splat(simd, source));
                        for first in (0..256_u32).step_by(16) {
                            let behind: [u32; 16] = std::array::from_fn(|lane| {
                                let d = first + lane as u32;
                                d << 24 | (255 - d) << 16 | d << 8 | d
                            });
                            let found = factors.over(simd, u32x16::from_slice(simd, &behind)).to_array();
                            assert_eq!(found, behind.map(|d| over(*mode, d, source)), "{mode:?} {source:08x}");
                        }
                    }
                }
            }
        });
    }
}
