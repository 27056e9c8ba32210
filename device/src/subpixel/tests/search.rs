//! The search: as published, on every grid, from every corner.

use crate::subpixel::grid::{Grid, Offset};
use crate::subpixel::search::*;
use proptest::prelude::*;

/// What a search has to find, from the definition: `[first, last, steps]` by looking at every sample.
fn defined(grid: Grid, mask: u64, corner: Corner) -> Option<[u32; 3]> {
    let (columns, rows) = (grid.columns() as i32, grid.rows() as i32);
    let [x, y] = match corner {
        Corner::UpperLeft => [0, 0],
        Corner::UpperRight => [columns - 1, 0],
        Corner::LowerLeft => [0, rows - 1],
        Corner::LowerRight => [columns - 1, rows - 1],
    };
    let covered = (0..columns * rows).filter(|sample| mask >> (columns * rows - 1 - sample) & 1 == 1);
    let distances = covered.map(|sample| ((sample % columns - x).abs() + (sample / columns - y).abs(), sample));
    let band = distances.clone().map(|(distance, _)| distance).min()?;
    let band_samples: Vec<i32> =
        distances.filter(|&(distance, _)| distance == band).map(|(_, sample)| sample).collect();
    Some([band_samples[0] as u32, *band_samples.last()? as u32, band as u32 + 1])
}

fn check(grid: Grid, mask: u64, corner: Corner) {
    let found = search(grid, mask, corner);
    let numbers = found.map(|found| [found.first, found.last, found.steps]);
    assert_eq!(numbers, defined(grid, mask, corner), "{grid:?} {mask:#x} {corner:?}");
    assert_eq!(found, search_by_bands(grid, mask, corner), "{grid:?} {mask:#x} {corner:?}");
}

/// A plane through 0 at the centre, in slope steps.
fn plane([dx, dy]: [i64; 2]) -> impl Fn(Offset) -> i32 {
    move |Offset { x, y }| (dx * i64::from(x) + dy * i64::from(y)) as i32
}

/// Every covered sample's depth, the nearest or the farthest of them.
fn exhaustive(grid: Grid, mask: u64, extreme: Extreme, depth: impl Fn(Offset) -> i32) -> Option<i32> {
    let covered = (0..grid.samples()).filter(|&sample| mask & grid.sample_bit(sample) != 0);
    let depths = covered.map(|sample| depth(grid.offset(sample)));
    if extreme == Extreme::Nearest { depths.min() } else { depths.max() }
}

/// The samples with `a * x + b * y <= c`, x and y in 1/16 pixel from the centre.
fn half_plane(grid: Grid, [a, b, c]: [i32; 3]) -> u64 {
    let inside = |&sample: &u32| a * grid.offset(sample).x + b * grid.offset(sample).y <= c;
    (0..grid.samples()).filter(inside).map(|sample| grid.sample_bit(sample)).sum()
}

/// `(x, y)` of the ends from the centre, y up, in pixels; and the band.
fn published(grid: Grid, mask: u64) -> Option<([[f64; 2]; 2], u32)> {
    let found = search(grid, mask, Corner::UpperRight)?;
    let place = |sample| {
        let Offset { x, y } = offset_of(grid, sample);
        [f64::from(x) / 16.0, f64::from(-y) / 16.0]
    };
    Some(([place(found.first), place(found.last)], found.steps - 1))
}

#[test]
fn search_published_masks_give_the_published_offsets() {
    assert_eq!(published(Grid::G4X4, 0x0100), Some(([[0.375, 0.125], [0.375, 0.125]], 1)));
    assert_eq!(published(Grid::G4X4, 0x0842), Some(([[-0.375, 0.125], [0.125, -0.375]], 4)));
    // Columns 4 and 5 of rows 1 and 2.
    assert_eq!(published(Grid::G8X4, 0x0008_0400), Some(([[0.0625, 0.125], [0.1875, -0.125]], 4)));
    let found = search(Grid::G8X4, 0x0008_0400, Corner::UpperRight);
    assert_eq!(found, Some(Found { first: 8 + 4, last: 16 + 5, steps: 5 }));
}

#[test]
fn search_mask_holds_the_samples_of_its_distance() {
    for grid in Grid::ALL {
        for corner in Corner::ALL {
            for sample in 0..grid.samples() {
                let band = corner.band_of(grid, sample);
                let bands = (0..40).filter(|&band| search_mask(grid, corner, band) & grid.sample_bit(sample) != 0);
                assert_eq!(bands.collect::<Vec<_>>(), [band], "{grid:?} {corner:?} {sample}");
                let [_, _, steps] = defined(grid, grid.sample_bit(sample), corner).expect("one sample");
                assert_eq!(band + 1, steps, "{grid:?} {corner:?} {sample}");
                assert_eq!(offset_of(grid, sample), grid.offset(sample));
            }
        }
    }
    // From the lower left corner, 4x4.
    let bands: Vec<u64> = (0..8).map(|band| search_mask(Grid::G4X4, Corner::LowerLeft, band)).collect();
    assert_eq!(bands, [0x0008, 0x0084, 0x0842, 0x8421, 0x4210, 0x2100, 0x1000, 0]);
}

#[test]
fn search_every_mask_of_4x4_finds_what_the_definition_says() {
    for corner in Corner::ALL {
        for mask in 0..=0xFFFF {
            check(Grid::G4X4, mask, corner);
        }
    }
}

#[test]
fn search_nothing_covered_finds_nothing() {
    for grid in Grid::ALL {
        for corner in Corner::ALL {
            check(grid, 0, corner);
            assert_eq!(search(grid, !grid.full(), corner), None);
            assert_eq!(search_by_bands(grid, !grid.full(), corner), None);
        }
        assert_eq!(extreme_of(grid, 0, [1, 1], Extreme::Nearest, |_| unreachable!()), None);
        assert_eq!(range_of(grid, 0, [1, 1], |_| unreachable!()), None);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn search_random_mask_finds_what_the_definition_says(dense: u64, also: [u64; 3], shift in 0..64_u32) {
        let sparse = also.iter().fold(dense, |mask, other| mask & other);
        for grid in Grid::ALL {
            for corner in Corner::ALL {
                for mask in [dense, dense & also[0], sparse, u64::MAX >> shift, u64::MAX << shift, 1 << shift] {
                    check(grid, mask & grid.full(), corner);
                }
            }
        }
    }
}

/// Case 39: the corner where the plane is nearest, for all octants and the ties between them.
#[test]
fn start_corner_every_octant_and_tie_is_the_published_one() {
    use Corner::*;
    let slopes = [
        ([2, 1], UpperLeft, LowerRight),
        ([1, 1], UpperLeft, LowerRight),
        ([1, 2], UpperLeft, LowerRight),
        // 0 counts as positive.
        ([0, 1], UpperLeft, LowerRight),
        ([-1, 2], UpperRight, LowerLeft),
        ([-1, 1], UpperRight, LowerLeft),
        ([-2, 1], UpperRight, LowerLeft),
        ([-1, 0], UpperRight, LowerLeft),
        ([-2, -1], LowerRight, UpperLeft),
        ([-1, -1], LowerRight, UpperLeft),
        ([-1, -2], LowerRight, UpperLeft),
        ([0, -1], LowerLeft, UpperRight),
        ([1, -2], LowerLeft, UpperRight),
        ([1, -1], LowerLeft, UpperRight),
        ([2, -1], LowerLeft, UpperRight),
        ([1, 0], UpperLeft, LowerRight),
        ([0, 0], UpperLeft, LowerRight),
        ([i64::MIN, i64::MAX], UpperRight, LowerLeft),
    ];
    for (slopes, nearest, farthest) in slopes {
        assert_eq!(Corner::start(slopes, Extreme::Nearest), nearest, "{slopes:?}");
        assert_eq!(Corner::start(slopes, Extreme::Farthest), farthest, "{slopes:?}");
    }
}

/// Case 39: where the start corner is covered, one depth is evaluated, and it is the extreme for any slopes.
#[test]
fn extreme_start_corner_covered_is_exact_for_any_slopes() {
    for grid in Grid::ALL {
        for (dx, dy) in (-3..=3).flat_map(|dx| (-3..=3).map(move |dy| (dx, dy))) {
            for extreme in [Extreme::Nearest, Extreme::Farthest] {
                let slopes = [dx, dy];
                let found = extreme_of(grid, grid.full(), slopes, extreme, plane(slopes)).expect("covered");
                let exact = exhaustive(grid, grid.full(), extreme, plane(slopes)).expect("covered");
                assert_eq!(found, Evaluated { depth: exact, steps: 1, evaluations: 1 }, "{grid:?} {slopes:?}");
            }
        }
    }
}

#[test]
fn extreme_calls_for_the_ends_only() {
    let mut asked = Vec::new();
    let depth = |offset: Offset| {
        asked.push((offset.x, offset.y));
        offset.x
    };
    // Band 3 from the lower left corner is covered fully: columns 0 to 3 of rows 0 to 3.
    let found = extreme_of(Grid::G4X4, 0x8421 | 0x1000, [1, -1], Extreme::Nearest, depth);
    assert_eq!(asked, [(-6, -6), (6, 6)]);
    assert_eq!(found, Some(Evaluated { depth: -6, steps: 4, evaluations: 2 }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A step of a column changes the depth by as much as a step of a row: the search is exact.
    #[test]
    fn extreme_of_convex_mask_with_equal_steps_is_exact(
        edges in prop::collection::vec([-20..=20_i32, -20..=20, -100..=100], 0..4),
        slope in 0..1000_i64,
        negative: [bool; 2],
    ) {
        for (grid, steps) in [(Grid::G4X4, [1, 1]), (Grid::G8X4, [2, 1]), (Grid::G8X8, [1, 1])] {
            let mask = edges.iter().fold(grid.full(), |mask, &edge| mask & half_plane(grid, edge));
            let slopes = [0, 1].map(|axis| if negative[axis] { -slope } else { slope } * steps[axis]);
            for extreme in [Extreme::Nearest, Extreme::Farthest] {
                let found = extreme_of(grid, mask, slopes, extreme, plane(slopes)).map(|found| found.depth);
                prop_assert_eq!(found, exhaustive(grid, mask, extreme, plane(slopes)), "{:?} {:#x}", grid, mask);
            }
        }
    }

    /// For any slopes: never beyond the true extremes, in order, and with as many evaluations as called for.
    #[test]
    fn range_of_any_mask_lies_inside_the_exhaustive_one(mask: u64, also: u64, slopes in [-99..=99_i64, -99..=99]) {
        for grid in Grid::ALL {
            for mask in [mask & grid.full(), mask & also & grid.full()] {
                let mut calls = 0;
                let range = range_of(grid, mask, slopes, |offset| {
                    calls += 1;
                    plane(slopes)(offset)
                });
                let exact = [Extreme::Nearest, Extreme::Farthest].map(|extreme| exhaustive(grid, mask, extreme, plane(slopes)));
                prop_assert_eq!(calls, range.map_or(0, |range| range.evaluations));
                prop_assert!(range.map(|range| range.nearest) >= exact[0]);
                prop_assert!(range.map(|range| range.farthest) <= exact[1]);
                prop_assert!(range.is_none_or(|range| range.nearest <= range.farthest));
            }
        }
    }
}

/// The mask is that of one edge, x + 3 y >= 3 in columns and rows; depth grows 8 times as fast downwards.
///
/// ```text
///      .  .  .  x <- band 3: -6 - 48 + 12 = -42, the nearest
///      f  x  x  x    f: band 1, what the search finds: -6 - 16 = -22
///      x  x  x  x
///      x  x  x  x
/// ```
#[test]
fn extreme_unequal_steps_finds_the_first_band_though_a_farther_one_is_nearer() {
    let (grid, slopes) = (Grid::G4X4, [1, 8]);
    let mask = half_plane(grid, [-1, -3, 12]);
    assert_eq!(mask, 0x1FFF);
    let found = extreme_of(grid, mask, slopes, Extreme::Nearest, plane(slopes));
    assert_eq!(found, Some(Evaluated { depth: -22, steps: 2, evaluations: 1 }));
    assert_eq!(exhaustive(grid, mask, Extreme::Nearest, plane(slopes)), Some(-42));
}

/// Equal slopes are no equal steps on 8x4: a row is twice as high as a column is wide.
#[test]
fn extreme_equal_slopes_on_8x4_is_not_always_exact() {
    let (grid, slopes) = (Grid::G8X4, [1, 1]);
    let mask = grid.bit(3, 0) | grid.bit(0, 2);
    let found = extreme_of(grid, mask, slopes, Extreme::Nearest, plane(slopes)).map(|found| found.depth);
    assert_eq!((found, exhaustive(grid, mask, Extreme::Nearest, plane(slopes))), (Some(-5), Some(-7)));
}

/// A sliver that covers two samples only: band 2 is met first from one corner, band 3 from the other, and the depth
/// of the first is farther.
#[test]
fn range_of_sliver_whose_searches_disagree_is_put_in_order() {
    let (grid, slopes) = (Grid::G4X4, [1, 0]);
    let mask = grid.bit(2, 0) | grid.bit(0, 3);
    let near = extreme_of(grid, mask, slopes, Extreme::Nearest, plane(slopes)).expect("covered");
    let far = extreme_of(grid, mask, slopes, Extreme::Farthest, plane(slopes)).expect("covered");
    assert_eq!((near.depth, far.depth), (2, -6));
    let range = range_of(grid, mask, slopes, plane(slopes));
    assert_eq!(range, Some(DepthRange { nearest: -6, farthest: 2, steps: 3 + 4, evaluations: 2 }));
}
