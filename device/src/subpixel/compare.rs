//! Depths of two planes compared at all samples of a pixel, by lanes.
//!
//! Must equal [`Sampled::depth`] sample by sample. Inputs from: [`super::parts`]. Clocks: those of the depths evaluated are
//! counted there.

use super::grid::{Grid, Offset};
use super::piece::Sampled;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, i32x16, mask32x16};

/// Samples of the largest grid.
const SAMPLES: usize = 64;

/// Samples at which `new` passes `test` against `stored`.
pub(super) fn passing(level: Level, grid: Grid, test: DepthTest, new: &Sampled, stored: &Sampled) -> u64 {
    match (grid.columns(), grid.rows()) {
        (4, _) => dispatch!(level, simd => lanes::<_, 4, 4>(simd, grid, test, new, stored)),
        (_, 4) => dispatch!(level, simd => lanes::<_, 8, 4>(simd, grid, test, new, stored)),
        _ => dispatch!(level, simd => lanes::<_, 8, 8>(simd, grid, test, new, stored)),
    }
}

#[inline(never)]
fn lanes<S: Simd, const C: usize, const R: usize>(
    simd: S,
    grid: Grid,
    test: DepthTest,
    new: &Sampled,
    stored: &Sampled,
) -> u64 {
    simd.vectorize(
        #[inline(always)]
        || {
            let (mut news, mut olds) = ([0; SAMPLES], [0; SAMPLES]);
            depths::<C, R>(grid, new, &mut news);
            depths::<C, R>(grid, stored, &mut olds);
            let asked = |asked: bool| mask32x16::splat(simd, asked);
            let mut passes = 0;
            for first in (0..C * R).step_by(LANES) {
                let new = i32x16::from_slice(simd, &news[first..first + LANES]);
                let old = i32x16::from_slice(simd, &olds[first..first + LANES]);
                let less = asked(test.less) & new.simd_lt(old);
                let wins = less | (asked(test.equal) & new.simd_eq(old)) | (asked(test.greater) & new.simd_gt(old));
                passes |= wins.to_bitmask() << first;
            }
            // The first sample is the most significant bit of a mask.
            passes.reverse_bits() >> (SAMPLES - C * R)
        },
    )
}

/// Depths at all samples, row by row.
#[inline(always)]
fn depths<const C: usize, const R: usize>(grid: Grid, sampled: &Sampled, depths: &mut [i32; SAMPLES]) {
    let mut columns = [0; C];
    for (column, along) in columns.iter_mut().enumerate() {
        *along = i64::from(grid.offset(column as u32).x) * sampled.gradient[0];
    }
    let (least, greatest) = (i64::from(sampled.limits[0]), i64::from(sampled.limits[1]));
    for row in 0..R {
        let Offset { y, .. } = grid.offset((row * C) as u32);
        let first = sampled.value + i64::from(y) * sampled.gradient[1];
        for column in 0..C {
            let depth = (first + columns[column]) >> sampled.below;
            depths[row * C + column] = depth.max(least).min(greatest) as i32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::levels;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn passing_at_every_sample_is_what_single_depths_say(
            values in prop::array::uniform2(-(1_i64 << 50)..1 << 50),
            gradients in prop::array::uniform4(-(1_i64 << 46)..1 << 46),
            limits in prop::array::uniform2(0_i32..1 << 18),
            grid in prop::sample::select(Grid::ALL.to_vec()),
            tests in prop::array::uniform3(any::<bool>()),
        ) {
            let [less, equal, greater] = tests;
            let test = DepthTest { less, equal, greater, write: true };
            let plane = |k: usize| Sampled {
                value: values[k],
                gradient: [gradients[2 * k], gradients[2 * k + 1]],
                below: 36,
                limits: [limits[k].min(1 << 12), limits[k].max(1 << 12)],
            };
            let (new, stored) = (plane(0), plane(1));
            let single = (0..grid.samples()).filter(|&sample| {
                let at = grid.offset(sample);
                test.passes(new.depth(at), stored.depth(at))
            });
            let single: u64 = single.map(|sample| grid.sample_bit(sample)).sum();
            for level in levels().into_iter().chain([Level::new()]) {
                prop_assert_eq!(passing(level, grid, test, &new, &stored), single);
            }
        }
    }
}
