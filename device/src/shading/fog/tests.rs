//! Fog against exact arithmetic, lanes against the specification.

use super::{FogMixer, mix};
use fearless_simd::{Level, dispatch};
use proptest::prelude::*;
use zga_abi::format::FogFunction;
use zga_firmware::checked::Fog;

const FUNCTIONS: [FogFunction; 4] =
    [FogFunction::Linear, FogFunction::Exponential, FogFunction::ExponentialSquared, FogFunction::DepthCue];

fn fog(function: FogFunction) -> Fog {
    Fog { function, density: 0.25, end: 10.0, cue_scale: 0.125, cue_offset: 1.5, colour: 0 }
}

/// The rounded share of the surface: white comes out as the share, where the fog is black.
fn share(fog: &Fog, distance: f32) -> u32 {
    FogMixer::new(fog).mixed(0xFFFF_FFFF, distance) & 0xFF
}

/// The share in f64, before it is rounded, times 255.
fn exact(fog: &Fog, distance: f32) -> f64 {
    let (d, density) = (f64::from(distance), f64::from(fog.density));
    let share = match fog.function {
        FogFunction::None => 1.0,
        FogFunction::Linear => 1.0 - d / f64::from(fog.end),
        FogFunction::Exponential => (-density * d).exp(),
        FogFunction::ExponentialSquared => (-(density * d).powi(2)).exp(),
        FogFunction::DepthCue => f64::from(fog.cue_offset) - f64::from(fog.cue_scale) * d,
    };
    255.0 * share.clamp(0.0, 1.0)
}

/// The levels of SIMD that this host has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ]
    .into_iter()
    .flatten()
    .chain([best])
    .collect()
}

fn any_float() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => 0.0_f32..60.0,
        1 => any::<u32>().prop_map(f32::from_bits),
        1 => prop::sample::select(vec![0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e-45, -1.0, 10.0]),
    ]
}

/// What the firmware lets through.
fn any_fog() -> impl Strategy<Value = Fog> {
    let size = prop_oneof![4 => 0.0_f32..2.0, 1 => (0_u32..0x7F80_0000).prop_map(f32::from_bits)];
    let signed = prop_oneof![4 => -2.0_f32..2.0, 1 => any::<u32>().prop_map(f32::from_bits)]
        .prop_filter("finite", |c| c.is_finite());
    (prop::sample::select(FUNCTIONS.to_vec()), size.clone(), size, signed.clone(), signed, any::<u32>()).prop_map(
        |(function, density, end, cue_scale, cue_offset, colour)| {
            let end = if end > 0.0 { end } else { 1.0 };
            Fog { function, density, end, cue_scale, cue_offset, colour }
        },
    )
}

#[test]
fn mix_of_any_levels_is_the_formula() {
    let formula = |fog: u32, c: u32, share: u32| (fog * (255 - share) + c * share + 127) / 255;
    for share in 0..256 {
        for fog in 0..256 {
            for c in 0..256 {
                // Unlike neighbours, so that what one channel carried into another would show.
                let (d, e) = (255 - c, (c * 7 + 13) % 256);
                let expected = formula(fog, c, share)
                    | formula(255 - fog, d, share) << 8
                    | formula(fog ^ 85, e, share) << 16
                    | 0xA500_0000;
                let fog = fog | (255 - fog) << 8 | (fog ^ 85) << 16 | 0x7700_0000;
                assert_eq!(mix(fog, c | d << 8 | e << 16 | 0xA500_0000, share), expected);
            }
        }
    }
}

#[test]
fn fog_at_the_eye_leaves_the_colour() {
    for function in FUNCTIONS {
        for distance in [0.0, -0.0, -5.0, f32::NEG_INFINITY, f32::NAN] {
            assert_eq!(share(&fog(function), distance), 255, "{function:?} at {distance}");
        }
    }
}

#[test]
fn fog_at_its_end_hides_the_colour() {
    for end in [1e-40, 0.3, 10.0, 1e30, f32::MAX] {
        assert_eq!(share(&Fog { end, ..fog(FogFunction::Linear) }, end), 0, "end {end}");
    }
    for function in FUNCTIONS {
        for distance in [1e4, f32::MAX, f32::INFINITY] {
            assert_eq!(share(&fog(function), distance), 0, "{function:?} at {distance}");
        }
    }
}

#[test]
fn fog_of_no_density_leaves_the_colour() {
    for function in [FogFunction::Exponential, FogFunction::ExponentialSquared] {
        for distance in [0.0, 1.0, f32::MAX, f32::INFINITY] {
            assert_eq!(share(&Fog { density: 0.0, ..fog(function) }, distance), 255, "{function:?} at {distance}");
        }
    }
}

#[test]
fn fog_hidden_takes_its_colour_and_keeps_alpha() {
    let mixer = FogMixer::new(&Fog { colour: 0x1144_5566, ..fog(FogFunction::Linear) });
    assert_eq!(mixer.mixed(0x80FF_0000, 10.0), 0x8044_5566);
    assert_eq!(mixer.mixed(0x80FF_0000, 0.0), 0x80FF_0000);
}

#[test]
fn depth_cue_follows_its_line() {
    // 1.5 - d / 8: full to 4, a half at 8, nothing from 12 on.
    let cue = fog(FogFunction::DepthCue);
    assert_eq!([0.0, 4.0, 8.0, 12.0, 20.0].map(|d| share(&cue, d)), [255, 255, 128, 0, 0]);
    let rising = Fog { cue_scale: -0.5, cue_offset: -1.0, ..cue };
    assert_eq!([0.0, 2.0, 3.0, 4.0, f32::MAX].map(|d| share(&rising, d)), [0, 0, 128, 255, 255]);
}

#[test]
fn fog_share_is_the_rounded_one_of_exact_arithmetic() {
    for function in FUNCTIONS {
        for n in 0..200_000 {
            let distance = n as f32 * 1e-4;
            let (found, exact) = (share(&fog(function), distance), exact(&fog(function), distance));
            // Half a level is the rounding. 2^-12 levels: 255 times 16 * 2^-24, of which exp2 has 8, the three or four
            // roundings of its argument y up to 3 (ln 2 |y| 2^y < 0.54), those of 255 f + 0.5 two.
            assert!((f64::from(found) - exact).abs() <= 0.5 + 1.0 / 4096.0, "{function:?} at {distance}: {exact}");
        }
    }
}

#[test]
fn fog_never_falls_back_with_distance() {
    for function in FUNCTIONS {
        let fog = fog(function);
        // Where the share goes from one level to the next there are the only places at which it could go back.
        for level in 0..255 {
            let (mut low, mut high) = (0_u32, 1e4_f32.to_bits());
            while high - low > 1 {
                let middle = low.midpoint(high);
                if share(&fog, f32::from_bits(middle)) > level { low = middle } else { high = middle }
            }
            let near = high.saturating_sub(2000)..high + 2000;
            let shares: Vec<u32> = near.map(|bits| share(&fog, f32::from_bits(bits))).collect();
            assert!(shares.is_sorted_by(|a, b| a >= b), "{function:?} near {}", f32::from_bits(high));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn fog_in_lanes_is_the_specification(
        fog in any_fog(),
        colours in prop::array::uniform16(any::<u32>()),
        distance in prop::array::uniform16(any_float()),
    ) {
        let mixer = FogMixer::new(&fog);
        let expected: [u32; 16] = std::array::from_fn(|lane| mixer.mixed(colours[lane], distance[lane]));
        for level in levels() {
            prop_assert_eq!(dispatch!(level, _simd => mixer.mixed_lanes(&colours, &distance)), expected);
        }
    }

    #[test]
    fn fog_of_any_two_distances_hides_more_at_the_farther(mut fog in any_fog(), a in any_float(), b in any_float()) {
        fog.colour = 0;
        fog.cue_scale = fog.cue_scale.abs();
        let of = |d: f32| if d > 0.0 { d } else { 0.0 };
        prop_assert!(share(&fog, of(a).min(of(b))) >= share(&fog, of(a).max(of(b))));
    }
}
