//! Texture function: the colour of the polygon and the texel become one colour.
//!
//! Duties: replaces, modulates, lays over or blends, in 8-bit levels. Inputs from: the filter, shading's base colour.
//! Outputs to: fog and blending. Clocks: none of its own.

use super::coordinates::LANES;
use crate::shading::levels::{mix8, mul8};
use zga_abi::format::TextureFunction;

/// Bits of alpha in an RGBA word.
const ALPHA: u32 = 0xFF00_0000;

/// Base colour `colour` and `texel`, combined; `constant` is the colour of the function `blend`. All RGBA.
#[must_use]
pub fn combine(function: TextureFunction, colour: u32, texel: u32, constant: u32) -> u32 {
    let (c, t, k) = (colour.to_le_bytes(), texel.to_le_bytes(), constant.to_le_bytes());
    let combined = match function {
        TextureFunction::Replace => t,
        TextureFunction::Modulate => [mul8(c[0], t[0]), mul8(c[1], t[1]), mul8(c[2], t[2]), mul8(c[3], t[3])],
        TextureFunction::Decal => [mix8(c[0], t[0], t[3]), mix8(c[1], t[1], t[3]), mix8(c[2], t[2], t[3]), c[3]],
        TextureFunction::Blend => {
            [mix8(c[0], k[0], t[0]), mix8(c[1], k[1], t[1]), mix8(c[2], k[2], t[2]), mul8(c[3], t[3])]
        }
    };
    u32::from_le_bytes(combined)
}

/// [`combine`] of 16 pixels. Channels are lanes of their own here, all treated alike; alpha is put right afterwards.
#[must_use]
#[inline(always)]
pub fn combine_lanes(
    function: TextureFunction,
    colour: &[u32; LANES],
    texel: &[u32; LANES],
    constant: u32,
) -> [u32; LANES] {
    match function {
        TextureFunction::Replace => *texel,
        TextureFunction::Modulate => modulate(colour, texel),
        TextureFunction::Decal => {
            let mut share = [0; LANES];
            for i in 0..LANES {
                share[i] = (texel[i] >> 24).wrapping_mul(0x0101_0101);
            }
            with_alpha(&mix(colour, texel, &share), colour)
        }
        TextureFunction::Blend => with_alpha(&mix(colour, &[constant; LANES], texel), &modulate(colour, texel)),
    }
}

/// Products of all channels.
#[inline(always)]
fn modulate(a: &[u32; LANES], b: &[u32; LANES]) -> [u32; LANES] {
    let (a, b) = (bytes(a), bytes(b));
    let mut product = [0; 4 * LANES];
    for i in 0..4 * LANES {
        product[i] = mul8(a[i], b[i]);
    }
    bytemuck::cast(product)
}

/// All channels from `a` to `b` by `t`.
#[inline(always)]
fn mix(a: &[u32; LANES], b: &[u32; LANES], t: &[u32; LANES]) -> [u32; LANES] {
    let (a, b, t) = (bytes(a), bytes(b), bytes(t));
    let mut mixed = [0; 4 * LANES];
    for i in 0..4 * LANES {
        mixed[i] = mix8(a[i], b[i], t[i]);
    }
    bytemuck::cast(mixed)
}

/// Levels one by one; their order within a pixel is the host's.
#[inline(always)]
fn bytes(words: &[u32; LANES]) -> [u8; 4 * LANES] {
    bytemuck::cast(*words)
}

/// Colours with the alpha of others.
#[inline(always)]
fn with_alpha(colour: &[u32; LANES], alpha: &[u32; LANES]) -> [u32; LANES] {
    let mut joined = [0; LANES];
    for i in 0..LANES {
        joined[i] = colour[i] & !ALPHA | alpha[i] & ALPHA;
    }
    joined
}
