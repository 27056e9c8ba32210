//! Decoding: every texel of every format, level and window against a reading bit by bit.

use super::{Texture, all_levels, noise, plain};
use proptest::prelude::*;
use zga_abi::format::TextureFormat;
use zga_firmware::checked;

/// Bits of a texel, from the manual.
fn bits(format: TextureFormat) -> u64 {
    match format {
        TextureFormat::Rgba8888 => 32,
        TextureFormat::Rgb565 | TextureFormat::Rgba5551 | TextureFormat::Rgba4444 => 16,
        TextureFormat::Palette8 => 8,
        TextureFormat::Palette4 => 4,
    }
}

/// The bits `low..low + count` of memory, bit 0 the lowest of word 0.
fn field(memory: &[u32], low: u64, count: u64) -> u64 {
    (0..count).map(|bit| u64::from(memory[((low + bit) / 32) as usize] >> ((low + bit) % 32) & 1) << bit).sum()
}

/// A level of `bits` bits as one of 8: its bits from the top, again and again.
fn widen(value: u64, bits: u32) -> u64 {
    (0..8).map(|place| (value >> (bits - 1 - place % bits) & 1) << (7 - place)).sum()
}

/// Texel (`x`, `y`) of level `level`, found by walking through memory as the manual describes it.
fn read(memory: &[u32], texture: &checked::Texture, level: u32, x: u64, y: u64) -> u32 {
    let bits = bits(texture.format);
    let mut first = u64::from(texture.base) * 8;
    let size = |k: u32| texture.size.map(|side| u64::from((side >> k).max(1)));
    let row = |k: u32| (size(k)[0] * bits).div_ceil(32) * 32;
    for k in 0..level {
        first = (first + row(k) * size(k)[1]).next_multiple_of(512);
    }
    let low = first + y * row(level) + x * bits;
    let part = |at, count: u32| widen(field(memory, low + at, u64::from(count)), count);
    let index = || field(memory, low, bits);
    let [r, g, b, a] = match texture.format {
        TextureFormat::Rgba8888 => [part(0, 8), part(8, 8), part(16, 8), part(24, 8)],
        TextureFormat::Rgb565 => [part(11, 5), part(5, 6), part(0, 5), 255],
        TextureFormat::Rgba5551 => [part(10, 5), part(5, 5), part(0, 5), part(15, 1)],
        TextureFormat::Rgba4444 => [part(8, 4), part(4, 4), part(0, 4), part(12, 4)],
        TextureFormat::Palette8 | TextureFormat::Palette4 => {
            let colour = memory[(u64::from(texture.palette) / 4 + index()) as usize];
            colour.to_le_bytes().map(u64::from)
        }
    };
    u32::try_from(r | g << 8 | b << 16 | a << 24).unwrap()
}

fn format() -> impl Strategy<Value = TextureFormat> {
    prop::sample::select(vec![
        TextureFormat::Rgba8888,
        TextureFormat::Rgb565,
        TextureFormat::Rgba5551,
        TextureFormat::Rgba4444,
        TextureFormat::Palette8,
        TextureFormat::Palette4,
    ])
}

proptest! {
    #[test]
    fn decode_gives_every_texel_of_every_level(
        (format, size, seed) in (format(), [1_u32..50, 1_u32..50], any::<u64>()),
        (window, wraps) in (any::<[prop::sample::Index; 4]>(), any::<[bool; 4]>()),
    ) {
        let offset = [0, 1].map(|axis| window[axis].index(size[axis] as usize) as u32);
        let extent = [0, 1].map(|axis| 1 + window[2 + axis].index((size[axis] - offset[axis]) as usize) as u32);
        let texture = checked::Texture {
            base: 128,
            palette: 1024,
            format,
            levels: all_levels(size),
            mip_map: true,
            offset,
            window: extent,
            repeat: [wraps[0], wraps[1]],
            mirror: [wraps[2], wraps[3]],
            ..plain(size)
        };
        let memory = noise(8192, seed);
        let unit = Texture::decode(&memory, &texture);
        let (mut bytes, mut opaque) = (0, true);
        for level in 0..texture.levels {
            let side = |axis: usize| (size[axis] >> level).max(1);
            let first = [0, 1].map(|axis| (offset[axis] >> level).min(side(axis) - 1));
            let used = [0, 1].map(|axis| (extent[axis] >> level).max(1).min(side(axis) - first[axis]));
            for (x, y) in (0..used[0]).flat_map(|x| (0..used[1]).map(move |y| (x, y))) {
                let place = |at: u32, axis: usize| (f64::from(at) + 0.5) / f64::from(used[axis]);
                let found = unit.texel(place(x, 0), place(y, 1), 256 * level as i32);
                let stored = read(&memory, &texture, level, u64::from(first[0] + x), u64::from(first[1] + y));
                prop_assert_eq!(found, stored, "level {} texel {} {}", level, x, y);
                opaque &= stored >> 24 == 255;
            }
            bytes += 4 * u64::from(used[0]) * u64::from(used[1]);
        }
        prop_assert_eq!(unit.bytes(), bytes);
        prop_assert_eq!(unit.is_opaque(), opaque);
    }
}

#[test]
fn decode_of_every_16_bit_texel_is_the_manuals() {
    let memory: Vec<u32> = (0..1 << 15).map(|pair| (2 * pair) | ((2 * pair + 1) << 16)).collect();
    for format in [TextureFormat::Rgb565, TextureFormat::Rgba5551, TextureFormat::Rgba4444] {
        let texture = checked::Texture { format, ..plain([256, 256]) };
        let unit = Texture::decode(&memory, &texture);
        let same = |texel: u32| {
            let [x, y] = [texel & 255, texel >> 8].map(|at| (f64::from(at) + 0.5) / 256.0);
            unit.texel(x, y, 0) == read(&memory, &texture, 0, u64::from(texel & 255), u64::from(texel >> 8))
        };
        assert_eq!((0..1 << 16).find(|&texel| !same(texel)), None, "{format:?}");
    }
}

#[test]
fn decode_of_a_window_sees_no_other_texel() {
    let mut memory = vec![0x0000_0000; 64];
    (memory[9], memory[10]) = (0xFF11_2233, 0xFF44_5566);
    let texture = checked::Texture { offset: [1, 1], window: [2, 1], ..plain([8, 8]) };
    let unit = Texture::decode(&memory, &texture);
    assert!(unit.is_opaque());
    assert_eq!(unit.bytes(), 8);
    assert_eq!([-0.7, 0.2, 0.8, 3.0].map(|u| unit.texel(u, 9.0, 0)), [memory[9], memory[9], memory[10], memory[10]]);
}

#[test]
fn decode_without_mip_map_takes_level_0_alone() {
    let texture = checked::Texture { levels: 4, ..plain([8, 8]) };
    let unit = Texture::decode(&[7; 64], &texture);
    assert_eq!(unit.bytes(), 256);
    assert!(!unit.has_levels());
    assert_eq!(unit.texel(0.5, 0.5, 512), 7);
}
