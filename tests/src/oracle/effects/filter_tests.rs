//! Lookups that can be worked out by hand, and the distance between exact and ideal ones.

use super::super::texel::{Format, Level, extent};
use super::*;
use crate::harness::Random;
use proptest::prelude::*;

/// A texture of noise, all levels.
fn noise(size: [u32; 2], filter: Filter, wraps: [bool; 4], seed: u64) -> Texture {
    let mut random = Random::new(seed);
    let mut level = |k: u32| {
        let [width, height] = extent(size, k);
        let texels = (0..width * height).map(|_| (random.bits() as u32).to_le_bytes()).collect();
        Level { size: [width, height], texels }
    };
    Texture {
        format: Format::Rgba8888,
        levels: (0..=size[0].max(size[1]).ilog2()).map(&mut level).collect(),
        offset: [0; 2],
        window: size,
        repeat: [wraps[0], wraps[1]],
        mirror: [wraps[2], wraps[3]],
        filter,
        function: 0,
        constant: [0; 4],
        bias: 0,
        mip_map: true,
    }
}

fn flat(levels: &[u8], filter: Filter) -> Texture {
    let size = [1 << (levels.len() - 1), 1];
    let mut texture = noise(size, filter, [false; 4], 0);
    for (level, value) in texture.levels.iter_mut().zip(levels) {
        level.texels.fill([*value; 4]);
    }
    texture
}

#[test]
fn exact_texel_centres_are_texels_with_every_filter() {
    for filter in Filter::ALL {
        let texture = noise([8, 4], filter, [false; 4], 1);
        for (x, y) in (0..32).map(|k| (k % 8, k / 8)) {
            let centre = [(f64::from(x) + 0.5) / 8.0, (f64::from(y) + 0.5) / 4.0];
            assert_eq!(exact(&texture, centre, 0), texture.levels[0].at(x, y), "{filter:?} ({x}, {y})");
            assert_eq!(ideal_lookup(&texture, centre, 0.0), ideal(texture.levels[0].at(x, y)));
        }
    }
}

#[test]
fn exact_middle_of_four_texels_is_their_mean() {
    let mut texture = noise([2, 2], Filter::Bilinear, [false; 4], 2);
    texture.levels[0].texels = vec![[0, 10, 0, 255], [1, 20, 0, 255], [1, 30, 0, 255], [1, 40, 3, 255]];

    // 3/4 is nearest to 1, 25 is exact, 3/4 again.
    assert_eq!(exact(&texture, [0.5, 0.5], 0), [1, 25, 1, 255]);
    assert_eq!(ideal_lookup(&texture, [0.5, 0.5], 0.0), [0.75, 25.0, 0.75, 255.0]);
}

#[test]
fn exact_edges_follow_the_wrap() {
    let mut texture = noise([2, 1], Filter::Bilinear, [false; 4], 3);
    texture.levels[0].texels = vec![[0; 4], [200; 4]];
    let at = |texture: &Texture, u: f64| exact(texture, [u, 0.5], 0)[0];

    // At the left edge: the edge goes on; the other end is next; the mirrored self is next.
    assert_eq!([0.0, -7.0, 1.0, 99.0].map(|u| at(&texture, u)), [0, 0, 200, 200]);
    texture.repeat[0] = true;
    assert_eq!([0.0, 1.0, -3.0, 0.25, 5.75].map(|u| at(&texture, u)), [100, 100, 100, 0, 200]);
    texture.mirror[0] = true;
    assert_eq!([0.0, 1.0, -3.0, 1.25, 1.75].map(|u| at(&texture, u)), [0, 200, 200, 200, 0]);
}

#[test]
fn exact_levels_are_chosen_at_half_and_mixed_between() {
    let nearest = flat(&[10, 90, 200], Filter::Nearest);
    let trilinear = flat(&[10, 90, 200], Filter::Trilinear);
    let at = |texture: &Texture, lambda: i32| exact(texture, [0.3, 0.5], lambda)[0];

    assert_eq!([0, 127, 128, 383, 384, 512].map(|lambda| at(&nearest, lambda)), [10, 10, 90, 90, 200, 200]);
    assert_eq!([0, 128, 256, 320, 512].map(|lambda| at(&trilinear, lambda)), [10, 50, 90, 118, 200]);
    let without = Texture { mip_map: false, ..trilinear };
    assert_eq!(at(&without, 0), 10);
}

#[test]
fn exact_trilinear_weights_rise_with_every_256th() {
    let texture = flat(&[0, 255, 0], Filter::Trilinear);
    let levels: Vec<u8> = (0..=256).map(|lambda| exact(&texture, [0.5, 0.5], lambda)[0]).collect();

    assert!(levels.is_sorted());
    assert_eq!((levels[0], levels[256]), (0, 255));
}

proptest! {
    #[test]
    fn exact_any_lookup_is_near_the_ideal(
        uv in [-3.0_f64..3.0, -3.0..3.0], lambda in 0_i32..=4 * 256, wraps in any::<[bool; 4]>(), filter in 1_usize..3, seed in 0_u64..50,
    ) {
        let texture = noise([16, 8], Filter::ALL[filter], wraps, seed);
        // A level that is chosen has no tie here: the exact one is asked for it.
        let levels = f64::from(lambda) / 256.0;

        let (found, right) = (exact(&texture, uv, lambda), ideal_lookup(&texture, uv, levels));

        // Coordinates are rounded to 1/256 texel, off by 1/512 on each axis; then the level is rounded.
        let most = spread(Filter::Bilinear, 1.0 / 512.0) + 0.5 + 1.0e-9;
        for c in 0..4 {
            prop_assert!((f64::from(found[c]) - right[c]).abs() <= most, "{:?} and {:?}", found, right);
        }
    }

    #[test]
    fn exact_nearest_is_the_ideal_unless_in_doubt(
        uv in [-3.0_f64..3.0, -3.0..3.0], lambda in 0_i32..=4 * 256, wraps in any::<[bool; 4]>(), seed in 0_u64..50,
    ) {
        let texture = noise([16, 8], Filter::Nearest, wraps, seed);
        let levels = f64::from(lambda) / 256.0;
        let right = ideal_lookup(&texture, uv, levels);

        let same = ideal(exact(&texture, uv, lambda)) == right;

        prop_assert!(same || in_doubt(&texture, uv, levels, 1.0 / 256.0, 1.0e-6));
    }

    #[test]
    fn exact_one_colour_stays_that_colour(uv in any::<[f64; 2]>(), lambda in 0_i32..=512, level in any::<u8>(), filter in 0_usize..3) {
        let texture = flat(&[level; 3], Filter::ALL[filter]);

        prop_assert_eq!(exact(&texture, uv, lambda), [level; 4]);
    }
}
