//! Sixteen pixels at once against one at a time, at every SIMD level of this host.

use super::{Texture, all_levels, noise, plain};
use crate::shading::levels::{mix8, mul8};
use crate::texture::function::{combine, combine_lanes};
use fearless_simd::{Level, dispatch};
use proptest::prelude::*;
use zga_abi::format::{TextureFilter, TextureFunction};
use zga_firmware::checked;

/// SIMD levels of this host.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let others = [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let others = [None];
    others.into_iter().flatten().chain([best]).collect()
}

/// A coordinate: near the window, on or beside places where texels meet, far away, or no number.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -3.0..3.0_f64,
        2 => (-200_i32..200, 1_u32..50, -2_i32..=2).prop_map(|(step, size, ulps)| {
            let meeting = f64::from(step) / f64::from(2 * size);
            f64::from_bits(meeting.to_bits().saturating_add_signed(i64::from(ulps)))
        }),
        1 => -1e7..1e7_f64,
        1 => any::<u64>().prop_map(f64::from_bits),
        1 => prop::sample::select(vec![
            f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0, -0.0, -1e-20, 1e-20,
            f64::MIN_POSITIVE, -5e-324, 4_503_599_627_370_497.0, -4_503_599_627_370_495.5, 1e300,
        ]),
    ]
}

fn any_texture() -> impl Strategy<Value = (checked::Texture, u64)> {
    let window = any::<[prop::sample::Index; 4]>();
    let filter = prop::sample::select(vec![TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear]);
    let sides = [1_u32..40, 1_u32..40];
    (sides, window, filter, any::<[bool; 4]>(), (any::<bool>(), any::<prop::sample::Index>()), any::<u64>()).prop_map(
        |(size, window, filter, wraps, (mip_map, levels), seed)| {
            let offset = [0, 1].map(|axis| window[axis].index(size[axis] as usize) as u32);
            let extent = [0, 1].map(|axis| 1 + window[2 + axis].index((size[axis] - offset[axis]) as usize) as u32);
            let texture = checked::Texture {
                levels: 1 + levels.index(all_levels(size) as usize) as u32,
                offset,
                window: extent,
                repeat: [wraps[0], wraps[1]],
                mirror: [wraps[2], wraps[3]],
                filter,
                mip_map,
                ..plain(size)
            };
            (texture, seed)
        },
    )
}

fn lambdas() -> impl Strategy<Value = [i32; 16]> {
    let same = (0_i32..1800, 0_i32..3).prop_map(|(first, step)| std::array::from_fn(|lane| first + step * lane as i32));
    prop_oneof![same, prop::array::uniform16(-300_i32..2200), prop::array::uniform16(any::<i32>())]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]
    #[test]
    fn texels_of_any_texture_are_texel_by_texel(
        (texture, seed) in any_texture(),
        u in prop::array::uniform16(coordinate()),
        v in prop::array::uniform16(coordinate()),
        lambda in lambdas(),
        wanted in prop_oneof![Just(0xFFFF), any::<u16>()],
    ) {
        let unit = Texture::decode(&noise(4096, seed), &texture);
        let one = |lane: usize| if wanted >> lane & 1 == 1 { unit.texel(u[lane], v[lane], lambda[lane]) } else { 0 };
        let expected: [u32; 16] = std::array::from_fn(one);
        for level in levels() {
            let found = dispatch!(level, _simd => unit.texels(&u, &v, &lambda, wanted));
            prop_assert_eq!(found, expected, "{:?} {:?}", level, texture);
        }
    }

    #[test]
    fn levels_of_detail_of_any_gradients_are_level_by_level(
        (texture, bias) in (any_texture(), -0x8000_i32..0x8000),
        gradients in prop::array::uniform4(prop::array::uniform16(coordinate())),
    ) {
        let unit = Texture::decode(&noise(4096, 0), &checked::Texture { bias, ..texture.0 });
        let [a, b, c, d] = &gradients;
        let expected: [i32; 16] = std::array::from_fn(|i| unit.level_of_detail([a[i], b[i], c[i], d[i]]));
        for level in levels() {
            let found = dispatch!(level, _simd => unit.level_of_detail_lanes([a, b, c, d]));
            prop_assert_eq!(found, expected, "{:?}", level);
        }
    }

    #[test]
    fn combine_lanes_are_combined_one_by_one(
        colour in any::<[u32; 16]>(),
        texel in any::<[u32; 16]>(),
        constant in any::<u32>(),
    ) {
        for function in [TextureFunction::Replace, TextureFunction::Modulate, TextureFunction::Decal, TextureFunction::Blend] {
            let expected: [u32; 16] = std::array::from_fn(|i| combine(function, colour[i], texel[i], constant));
            for level in levels() {
                let found = dispatch!(level, _simd => combine_lanes(function, &colour, &texel, constant));
                prop_assert_eq!(found, expected, "{:?} {:?}", level, function);
            }
        }
    }
}

#[test]
fn combine_of_known_colours_is_the_manuals() {
    let (colour, texel, constant) = (0x80_40_FF_10, 0x40_FF_80_20, 0x11_10_20_F0);
    // Worked out by hand: (a b + 127) / 255 and (a (255 - t) + b t + 127) / 255, rounded down.
    assert_eq!(combine(TextureFunction::Replace, colour, texel, constant), texel);
    assert_eq!(combine(TextureFunction::Modulate, colour, texel, constant), 0x20_40_80_02);
    assert_eq!(combine(TextureFunction::Decal, colour, texel, constant), 0x80_70_DF_14);
    assert_eq!(combine(TextureFunction::Blend, colour, texel, constant), 0x20_10_8F_2C);
}

#[test]
fn mul8_and_mix8_are_rounded_quotients() {
    let levels = || (0..=255_u8).flat_map(|a| (0..=255_u8).map(move |b| (a, b)));
    let product = |a: u8, b: u8| (u32::from(a) * u32::from(b) + 127) / 255;
    assert!(levels().all(|(a, b)| u32::from(mul8(a, b)) == product(a, b)));
    let mixed = |a: u8, b: u8, t: u8| (u32::from(a) * u32::from(255 - t) + u32::from(b) * u32::from(t) + 127) / 255;
    assert!((0..=255_u8).all(|t| levels().all(|(a, b)| u32::from(mix8(a, b, t)) == mixed(a, b, t))));
    assert!(levels().all(|(a, b)| mix8(a, b, 0) == a && mix8(a, b, 255) == b));
}
