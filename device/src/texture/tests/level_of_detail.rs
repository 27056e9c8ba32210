//! Level of detail: the logarithm, its ends, and the weights on both sides of a level.

use super::{Texture, noise, plain};
use crate::texture::level_of_detail::{lambda, log2};
use zga_abi::format::TextureFilter;
use zga_firmware::checked;

/// A trilinear texture of 64 x 64 texels with all levels.
fn mip_map(bias: i32) -> checked::Texture {
    checked::Texture { levels: 7, mip_map: true, filter: TextureFilter::Trilinear, bias, ..plain([64, 64]) }
}

fn unit(bias: i32) -> Texture {
    Texture::decode(&noise(8192, 3), &mip_map(bias))
}

#[test]
fn log2_of_every_mantissa_is_close_and_climbs() {
    let (mut before, mut worst) = (-1.0, 0.0_f64);
    for mantissa in 0..1_u64 << 20 {
        // The least and the greatest of the numbers that are cut to this mantissa.
        let least = f64::from_bits(1023 << 52 | mantissa << 32);
        let greatest = f64::from_bits(least.to_bits() | 0xFFFF_FFFF);
        let found = log2(least);
        assert!(found > before && log2(greatest) == found, "{least}");
        worst = worst.max((found - least.log2()).abs()).max((found - greatest.log2()).abs());
        before = found;
    }
    assert!(before < 1.0);
    // The polynomial's 1.09e-6 and the cut's 1.38e-6, which partly meet; f64::log2 is good to 2^-52.
    assert!(worst < 2.5e-6, "{worst}");
    // What is asked for: half a logarithm is a level, and a level's 2^-12.
    assert!(worst / 2.0 < 1.0 / 4096.0);
}

#[test]
fn log2_of_powers_of_two_is_exact() {
    let found = (-1022..=1023).map(|exponent: i32| log2(f64::from_bits(((exponent + 1023) as u64) << 52)));
    assert!(found.eq((-1022..=1023).map(f64::from)));
}

#[test]
fn level_of_detail_of_gradients_is_their_logarithm() {
    for step in -2000..2000 {
        let rho = 1.01_f64.powi(step);
        for gradients in [[rho / 64.0, 0.0, 0.0, 0.0], [0.0, 0.6 * rho / 64.0, -0.8 * rho / 64.0, 0.6 * rho / 64.0]] {
            let expected = (256.0 * rho.log2()).clamp(0.0, 1536.0);
            let found = unit(0).level_of_detail(gradients);
            // Half a step of rounding, and 256 * 1.25e-6 of the logarithm.
            assert!((f64::from(found) - expected).abs() <= 0.5004, "{rho} {found} {expected}");
        }
    }
}

#[test]
fn level_of_detail_counts_texels_of_the_window_along_each_axis() {
    let unit = Texture::decode(&noise(8192, 3), &checked::Texture { offset: [8, 40], window: [32, 8], ..mip_map(0) });
    let lambdas = [
        [4.0 / 32.0, 0.0, 0.0, 0.0],
        [0.0, 4.0 / 8.0, 0.0, 0.0],
        [0.0, 0.0, 4.0 / 32.0, 0.0],
        [0.0, 0.0, 0.0, 4.0 / 8.0],
        // The longer of two sides, both in texels: 8 * (0.6, 0.8) and 4.
        [8.0 * 0.6 / 32.0, 8.0 * 0.8 / 8.0, 4.0 / 32.0, 0.0],
    ]
    .map(|gradients| unit.level_of_detail(gradients));
    assert_eq!(lambdas, [512, 512, 512, 512, 768]);
}

#[test]
fn level_of_detail_of_no_gradient_is_level_0_whatever_the_bias() {
    for bias in [-0x8000, 0, 256, 0x7FFF] {
        assert_eq!(unit(bias).level_of_detail([0.0; 4]), 0);
        assert_eq!(unit(bias).level_of_detail([1e-300, -5e-324, 0.0, -0.0]), 0);
    }
}

#[test]
fn level_of_detail_of_what_is_not_finite_is_the_last_level_whatever_the_bias() {
    for bias in [-0x8000, 0, 0x7FFF] {
        for wrong in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
            for place in 0..4 {
                let mut gradients = [0.001, 1.0, 1e-9, 0.0];
                gradients[place] = wrong;
                assert_eq!(unit(bias).level_of_detail(gradients), 1536, "{gradients:?}");
            }
        }
    }
}

#[test]
fn level_of_detail_adds_its_bias_before_it_is_clamped() {
    let gradients = [4.0 / 64.0, 0.0, 0.0, 0.0];
    assert_eq!(
        [-0x8000, -513, -100, 0, 1, 1024, 1025].map(|bias| unit(bias).level_of_detail(gradients)),
        [0, 0, 412, 512, 513, 1536, 1536]
    );
}

#[test]
fn level_of_detail_without_mip_map_is_0() {
    let unit = Texture::decode(&noise(4096, 3), &checked::Texture { mip_map: false, bias: 700, ..mip_map(0) });
    assert_eq!(unit.level_of_detail([0.5, 0.0, f64::NAN, 0.0]), 0);
    assert_eq!(unit.level_of_detail_lanes([&[0.5; 16], &[f64::NAN; 16], &[0.0; 16], &[0.0; 16]]), [0; 16]);
}

/// Numerics case 52: level 0 black, level 1 white, and so on; rho steps through k +- 2^-9 levels.
#[test]
fn weights_around_a_level_never_turn_back() {
    for k in 1..6 {
        let mut memory = vec![0; 8192];
        let texture = mip_map(0);
        for level in k + 1..7 {
            let first = texture.level_offset(level) as usize / 4;
            memory[first..first + (4096 >> (2 * level))].fill(if level == k + 1 { u32::MAX } else { 0 });
        }
        let first = texture.level_offset(k) as usize / 4;
        memory[first..first + (4096 >> (2 * k))].fill(0x8080_8080);
        let unit = Texture::decode(&memory, &texture);
        // A little beyond 2^-9, so that the ends do not depend on how a tie falls.
        let steps = -72..=72;
        let of = |step: i32| {
            let rho = (f64::from(k) + f64::from(step) / 64.0 / 512.0).exp2();
            unit.level_of_detail([rho / 64.0, 0.0, 0.0, 0.0])
        };
        let lambdas: Vec<i32> = steps.map(of).collect();
        assert!(lambdas.is_sorted());
        assert_eq!((lambdas[0], lambdas[72], lambdas[144]), (256 * k as i32 - 1, 256 * k as i32, 256 * k as i32 + 1));
        let greys: Vec<u32> = (-256..=256).map(|d| unit.texel(0.5, 0.5, 256 * k as i32 + d) & 255).collect();
        assert!(greys.is_sorted());
        assert_eq!((greys[0], greys[256], greys[512]), (0, 0x80, 255));
    }
}

#[test]
fn lambda_climbs_with_every_gradient() {
    let mut before = 0;
    for step in 0..200_000 {
        let found = lambda([0.0, 1e-3 + f64::from(step) * 1e-7, 1e-4, 0.0], [64.0, 1000.0], 0, 4096);
        assert!(found >= before);
        before = found;
    }
    assert!(before > 1000);
}
