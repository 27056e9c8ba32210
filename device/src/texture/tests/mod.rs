//! Tests of the texture unit.

mod decode;
mod lanes;
mod level_of_detail;
mod reference;

use super::Texture;
use zga_abi::format::{TextureFilter, TextureFormat, TextureFunction};
use zga_firmware::checked;

/// A texture of RGBA words without levels, clamped and read by its nearest texel.
pub(crate) fn plain(size: [u32; 2]) -> checked::Texture {
    checked::Texture {
        base: 0,
        size,
        format: TextureFormat::Rgba8888,
        levels: 1,
        palette: 0,
        offset: [0; 2],
        window: size,
        repeat: [false; 2],
        mirror: [false; 2],
        filter: TextureFilter::Nearest,
        function: TextureFunction::Modulate,
        colour: 0,
        bias: 0,
        mip_map: false,
    }
}

/// Words without a pattern: a full-period generator modulo 2^64, its high half.
pub(crate) fn noise(words: usize, seed: u64) -> Vec<u32> {
    let mut state = seed.wrapping_mul(2) + 1;
    let step = |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 32) as u32
    };
    (0..words).map(step).collect()
}

/// The most levels of a texture.
pub(super) fn all_levels(size: [u32; 2]) -> u32 {
    32 - size[0].max(size[1]).leading_zeros()
}

#[test]
fn filter_without_mip_map_reads_four_texels_in_one_clock() {
    let cost = |filter, mip_map| {
        let texture = checked::Texture { filter, mip_map, levels: 3, ..plain([4, 4]) };
        let texture = Texture::decode(&noise(64, 1), &texture);
        (texture.fetches(), texture.clocks())
    };
    assert_eq!([cost(TextureFilter::Nearest, true), cost(TextureFilter::Nearest, false)], [(1, 1); 2]);
    assert_eq!([cost(TextureFilter::Bilinear, true), cost(TextureFilter::Bilinear, false)], [(4, 1); 2]);
    assert_eq!([cost(TextureFilter::Trilinear, true), cost(TextureFilter::Trilinear, false)], [(8, 2), (4, 1)]);
}

#[test]
fn trilinear_without_mip_map_is_bilinear() {
    let read = |filter| {
        let texture = Texture::decode(&noise(256, 2), &checked::Texture { filter, levels: 4, ..plain([8, 8]) });
        [0, 300, 5000].map(|lambda| texture.texel(0.37, 0.61, lambda))
    };
    assert_eq!(read(TextureFilter::Trilinear), read(TextureFilter::Bilinear));
}

#[test]
fn trilinear_with_one_level_is_bilinear() {
    let read = |filter| {
        let texture = checked::Texture { filter, mip_map: true, ..plain([8, 8]) };
        let texture = Texture::decode(&noise(256, 2), &texture);
        [0, 300, 5000].map(|lambda| texture.texel(0.37, 0.61, lambda))
    };
    assert_eq!(read(TextureFilter::Trilinear), read(TextureFilter::Bilinear));
}
