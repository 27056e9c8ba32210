//! Look-ups against a reference in f64, whose coordinates and weights are not rounded.

use super::{Texture, all_levels, noise, plain};
use zga_abi::format::TextureFilter;
use zga_firmware::checked;

/// Wraps of an axis: repeat, mirror.
const WRAPS: [[bool; 2]; 3] = [[false, false], [true, false], [false, true]];

/// A texture of 13 x 9 texels, all levels, and its memory.
fn texture(filter: TextureFilter, wrap: [[bool; 2]; 2]) -> (checked::Texture, Vec<u32>) {
    let size = [13, 9];
    let texture = checked::Texture {
        levels: all_levels(size),
        mip_map: true,
        repeat: [wrap[0][0], wrap[1][0]],
        mirror: [wrap[0][1], wrap[1][1]],
        filter,
        ..plain(size)
    };
    let memory = noise(texture.bytes() as usize / 4, 11);
    (texture, memory)
}

/// Texel `index`, counted from the window's first, of a row of `size`, by walking there.
fn walk(index: i64, size: i64, [repeat, mirror]: [bool; 2]) -> i64 {
    let (mut at, mut forward) = (0, true);
    for _ in 0..index.unsigned_abs() {
        let step = if (index > 0) == forward { 1 } else { -1 };
        let next = at + step;
        match (next < 0 || next == size, repeat, mirror) {
            (false, ..) => at = next,
            (true, _, true) => forward = !forward,
            (true, true, false) => at = size - 1 - at,
            (true, false, false) => break,
        }
    }
    at
}

/// Channel values of the bilinear mean at `u`, `v` in level `level`.
fn bilinear(memory: &[u32], texture: &checked::Texture, level: u32, at: [f64; 2]) -> [f64; 4] {
    let size = texture.level_size(level).map(i64::from);
    let first = texture.level_offset(level) as usize / 4;
    let place = [0, 1].map(|axis| at[axis] * size[axis] as f64 - 0.5);
    let mut mean = [0.0; 4];
    for (right, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let index = |axis: usize, further: i64| {
            let index = place[axis].floor() as i64 + further;
            walk(index, size[axis], [texture.repeat[axis], texture.mirror[axis]])
        };
        let share = |axis: usize, further: i64| {
            let fraction = place[axis] - place[axis].floor();
            if further == 1 { fraction } else { 1.0 - fraction }
        };
        let texel = memory[first + (index(1, down) * size[0] + index(0, right)) as usize];
        for (mean, channel) in mean.iter_mut().zip(texel.to_le_bytes()) {
            *mean += f64::from(channel) * share(0, right) * share(1, down);
        }
    }
    mean
}

/// Places of a lattice that falls on no lattice of texels, on all sides of the window.
fn places() -> impl Iterator<Item = [f64; 2]> {
    (-60..120).flat_map(|x| (-10..25).map(move |y| [f64::from(x) * 0.021_37 + 0.001, f64::from(y) * 0.0911 + 0.0003]))
}

/// Greatest and mean error, levels, over all places, wraps and levels of detail (in levels, `lambdas`).
fn errors(
    filter: TextureFilter,
    lambdas: &[f64],
    mean: impl Fn(&[u32], &checked::Texture, f64, [f64; 2]) -> [f64; 4],
) -> [f64; 2] {
    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for wrap in WRAPS.into_iter().flat_map(|x| WRAPS.map(|y| [x, y])) {
        let (texture, memory) = texture(filter, wrap);
        let unit = Texture::decode(&memory, &texture);
        for (at, &lambda) in places().flat_map(|at| lambdas.iter().map(move |lambda| (at, lambda))) {
            let found = unit.texel(at[0], at[1], (256.0 * lambda + 0.5).floor() as i32).to_le_bytes();
            for (found, exact) in found.into_iter().zip(mean(&memory, &texture, lambda, at)) {
                let error = (f64::from(found) - exact).abs();
                (worst, sum, count) = (worst.max(error), sum + error, count + 1.0);
            }
        }
    }
    [worst, sum / count]
}

/// Over 1.1 million channels of noise, the worst texture there is: greatest error 1.13 levels, mean 0.14.
#[test]
fn bilinear_texels_are_the_references() {
    let lambdas = [0.0, 1.1, 2.8, 3.0, 2.2];
    let [worst, mean] = errors(TextureFilter::Bilinear, &lambdas, |memory, texture, lambda, at| {
        bilinear(memory, texture, lambda.round() as u32, at)
    });
    // A place is wrong by up to 1/512 texel in x and in y, over which the mean changes by up to 255/512 levels each;
    // the texel is rounded by up to 1/2.
    assert!(worst <= 0.5 + 2.0 * 255.0 / 512.0, "{worst}");
    // On average half of each, and neighbours in noise differ by 255/3.
    assert!(mean <= 0.25 + 2.0 * 85.0 / 1024.0, "{mean}");
}

/// Over 1.1 million channels of noise: greatest error 1.13 levels, mean 0.26.
#[test]
fn trilinear_texels_are_the_references() {
    let lambdas = [0.0, 0.2513, 1.1234, 1.999, 2.7771];
    let [worst, mean] = errors(TextureFilter::Trilinear, &lambdas, |memory, texture, lambda, at| {
        let [near, far] = [0, 1].map(|more| bilinear(memory, texture, lambda.floor() as u32 + more, at));
        std::array::from_fn(|k| near[k] + (far[k] - near[k]) * lambda.fract())
    });
    // As above, and the weight of the second level is wrong by up to 1/512, over which the mean changes by up to
    // 255/512 levels.
    assert!(worst <= 0.5 + 3.0 * 255.0 / 512.0, "{worst}");
    assert!(mean <= 0.25 + 3.0 * 85.0 / 1024.0, "{mean}");
}

/// The place may be rounded across the border of two texels, by 1/512 texel; anywhere else the error is 0.
#[test]
fn nearest_texels_are_the_references() {
    let mut beside = 0;
    for wrap in WRAPS.into_iter().flat_map(|x| WRAPS.map(|y| [x, y])) {
        let (texture, memory) = texture(TextureFilter::Nearest, wrap);
        let unit = Texture::decode(&memory, &texture);
        for (at, level) in places().flat_map(|at| [0, 1, 2, 3].map(|level| (at, level))) {
            let size = texture.level_size(level).map(i64::from);
            let read = |shift: [f64; 2]| {
                let [x, y] = [0, 1].map(|axis| {
                    let index = (at[axis] * size[axis] as f64 + shift[axis]).floor() as i64;
                    walk(index, size[axis], [texture.repeat[axis], texture.mirror[axis]])
                });
                memory[texture.level_offset(level) as usize / 4 + (y * size[0] + x) as usize]
            };
            let found = unit.texel(at[0], at[1], 256 * level as i32);
            let step = 1.0 / 512.0 + 1e-9;
            let near = [[-step, -step], [step, -step], [-step, step], [step, step]].map(read);
            assert!(near.contains(&found), "{at:?} level {level}");
            beside += usize::from(found != read([0.0; 2]));
        }
    }
    // Twice 1/512 of each side of a texel is open to rounding, half of it goes wrong: 1/256 of all, and a margin.
    assert!(beside * 128 < 9 * 4 * places().count(), "{beside}");
}

#[test]
fn repeated_texels_a_million_windows_away_are_the_same() {
    for filter in [TextureFilter::Nearest, TextureFilter::Bilinear] {
        for wrap in [WRAPS[1], WRAPS[2]] {
            let (texture, memory) = texture(filter, [wrap; 2]);
            let unit = Texture::decode(&memory, &texture);
            // Places in the middle of a step of 1/256 texel: f64 there is good for 2^-33 windows, a step is 2^-12.
            for step in (0..13 * 256).step_by(7) {
                let [u, v] = [f64::from(step) / (13.0 * 256.0), (f64::from(step % (9 * 256))) / (9.0 * 256.0)];
                let here = unit.texel(u, v, 0);
                for far in [1e6, -1e6] {
                    assert_eq!(unit.texel(u + far, v - far, 0), here, "{step} {filter:?} {wrap:?}");
                }
            }
        }
    }
}

#[test]
fn coordinates_that_are_no_numbers_count_as_0() {
    for wrap in WRAPS.into_iter().flat_map(|x| WRAPS.map(|y| [x, y])) {
        let (texture, memory) = texture(TextureFilter::Bilinear, wrap);
        let unit = Texture::decode(&memory, &texture);
        assert_eq!(unit.texel(f64::NAN, -f64::NAN, 0), unit.texel(0.0, 0.0, 0));
        let infinite = |[repeat, mirror]: [bool; 2], end: f64| if repeat || mirror { 0.0 } else { end };
        let expected = unit.texel(infinite(wrap[0], 2.0), infinite(wrap[1], -1.0), 0);
        assert_eq!(unit.texel(f64::INFINITY, f64::NEG_INFINITY, 0), expected);
    }
}
