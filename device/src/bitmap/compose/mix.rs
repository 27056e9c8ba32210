//! Mix: what the words of source, mask and destination come to, 16 pixels at a time.
//!
//! Every operator is one expression, min(255, s F + d G), with factors `(alpha & and) ^ xor`: (0, 0) is 0, (0, 255) is 1,
//! (255, 0) the alpha and (255, 255) 1 less the alpha. A product is [`product`], which leaves a level times 255 as it is.
//! Inputs from: [`super`]. Outputs to: the same. Clocks: none of its own.

use fearless_simd::prelude::*;
use fearless_simd::{u16x32, u32x16};
use zga_abi::format::ComposeFactor;
use zga_firmware::checked::{Compose, Mask};

/// How a mask is used.
#[derive(Clone, Copy)]
enum Through {
    Nothing,
    Unified,
    Components,
}

/// A factor: `(alpha & and) ^ xor`.
#[derive(Clone, Copy)]
struct Factor {
    and: u16,
    xor: u16,
}

impl Factor {
    const fn new(factor: ComposeFactor) -> Factor {
        let (and, xor) = match factor {
            ComposeFactor::Zero => (0, 0),
            ComposeFactor::One => (0, 255),
            ComposeFactor::Alpha => (255, 0),
            ComposeFactor::Inverse => (255, 255),
        };
        Factor { and, xor }
    }

    #[inline(always)]
    fn of<S: Simd>(self, simd: S, alpha: u16x32<S>) -> u16x32<S> {
        (alpha & u16x32::splat(simd, self.and)) ^ u16x32::splat(simd, self.xor)
    }
}

/// The arithmetic of a composition.
#[derive(Clone, Copy)]
pub(super) struct Mix {
    source: Factor,
    there: Factor,
    through: Through,
}

/// Two channels of 16 pixels in the halves of their words: blue and red, or green and alpha.
type Pairs<S> = [u16x32<S>; 2];

// Functions, not closures: a closure is not sure to become part of code for the level that it runs at.

/// The channels of words.
#[inline(always)]
fn pairs<S: Simd>(words: u32x16<S>) -> Pairs<S> {
    let lanes: u16x32<S> = words.bitcast();
    [lanes & 0xFF, lanes >> 8_u32]
}

/// The alpha of words in both halves.
#[inline(always)]
fn alphas<S: Simd>(words: u32x16<S>) -> u16x32<S> {
    let alpha = words >> 24_u32;
    (alpha | (alpha << 16_u32)).bitcast()
}

/// a b / 255, rounded to the nearest.
#[inline(always)]
fn product<S: Simd>(simd: S, a: u16x32<S>, b: u16x32<S>) -> u16x32<S> {
    let t = a * b + u16x32::splat(simd, 128);
    (t + (t >> 8_u32)) >> 8_u32
}

impl Mix {
    pub(super) const fn new(compose: &Compose<'_>) -> Mix {
        let [source, there] = compose.operator.factors();
        let through = match compose.mask {
            Mask::None => Through::Nothing,
            _ if compose.components => Through::Components,
            _ => Through::Unified,
        };
        Mix { source: Factor::new(source), there: Factor::new(there), through }
    }

    /// Puts the result in the place of what is there. All are as long, a multiple of 16.
    #[inline(always)]
    pub(super) fn mix<S: Simd>(&self, simd: S, source: &[u32], mask: &[u32], there: &mut [u32]) {
        let (sources, masks) = (source.as_chunks::<16>().0, mask.as_chunks::<16>().0);
        for ((source, mask), there) in sources.iter().zip(masks).zip(there.as_chunks_mut::<16>().0) {
            let words = u32x16::from_slice(simd, source);
            let (channels, alpha) = (pairs(words), alphas(words));
            let (channels, alpha) = match self.through {
                Through::Nothing => (channels, [alpha, alpha]),
                Through::Unified => {
                    let mask = alphas(u32x16::from_slice(simd, mask));
                    let alpha = product(simd, alpha, mask);
                    ([product(simd, channels[0], mask), product(simd, channels[1], mask)], [alpha, alpha])
                }
                Through::Components => {
                    let mask = pairs(u32x16::from_slice(simd, mask));
                    (
                        [product(simd, channels[0], mask[0]), product(simd, channels[1], mask[1])],
                        [product(simd, mask[0], alpha), product(simd, mask[1], alpha)],
                    )
                }
            };
            let words = u32x16::from_slice(simd, there);
            let (behind, factor) = (pairs(words), self.source.of(simd, alphas(words)));
            let low = self.channel(simd, [channels[0], factor], [behind[0], alpha[0]]);
            let high = self.channel(simd, [channels[1], factor], [behind[1], alpha[1]]);
            let mixed: u32x16<S> = (low | (high << 8_u32)).bitcast();
            there.copy_from_slice(mixed.as_slice());
        }
    }

    #[inline(always)]
    fn channel<S: Simd>(&self, simd: S, source: [u16x32<S>; 2], there: [u16x32<S>; 2]) -> u16x32<S> {
        let sum = product(simd, source[0], source[1]) + product(simd, there[0], self.there.of(simd, there[1]));
        sum.min(u16x32::splat(simd, 255))
    }
}
