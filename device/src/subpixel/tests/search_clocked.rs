//! The search's registers and clocks against the functional search.

use crate::probe::account::Clocks;
use crate::subpixel::grid::{Grid, Offset};
use crate::subpixel::search::{self, Corner, Extreme};
use crate::subpixel::search_clocked::{Searcher, State, extreme_of};
use proptest::prelude::*;

const EXTREMES: [Extreme; 2] = [Extreme::Nearest, Extreme::Farthest];

/// A depth that tells samples apart, not a plane: what is evaluated where must be the same, whatever comes of it.
fn depth(Offset { x, y }: Offset) -> i32 {
    (x * 31 + y * 17) % 23
}

/// The clocked search against the functional one: result, samples evaluated, clocks.
fn check(grid: Grid, mask: u64, slopes: [i64; 2], extreme: Extreme) {
    let (mut asked, mut asked_clocked) = (Vec::new(), Vec::new());
    let functional = search::extreme_of(grid, mask, slopes, extreme, |offset| {
        asked.push(offset);
        depth(offset)
    });
    let (clocked, clocks) = extreme_of(grid, mask, slopes, extreme, |offset| {
        asked_clocked.push(offset);
        depth(offset)
    });
    assert_eq!(clocked, functional, "{grid:?} {mask:#x} {slopes:?} {extreme:?}");
    assert_eq!(asked_clocked, asked, "{grid:?} {mask:#x} {slopes:?} {extreme:?}");
    let stated = functional.map_or(Clocks(0), |found| found.clocks());
    assert_eq!(clocks, stated, "{grid:?} {mask:#x} {slopes:?} {extreme:?}");
}

#[test]
fn clocked_every_mask_of_4x4_equals_functional() {
    for slopes in [[1, 1], [-1, 1], [1, -1], [-1, -1]] {
        for mask in 0..=0xFFFF {
            check(Grid::G4X4, mask, slopes, Extreme::Nearest);
            check(Grid::G4X4, mask, slopes, Extreme::Farthest);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn clocked_random_mask_equals_functional(
        dense: u64,
        also: [u64; 3],
        sample in 0..64_u32,
        slopes in [-2..=2_i64, -2..=2],
    ) {
        let sparse = also.iter().fold(dense, |mask, other| mask & other);
        for grid in Grid::ALL {
            for extreme in EXTREMES {
                for mask in [dense, dense & also[0], sparse, 1 << sample] {
                    check(grid, mask, slopes, extreme);
                }
            }
        }
    }
}

#[test]
fn clocked_search_mask_moves_band_by_band_over_the_pixel() {
    for grid in Grid::ALL {
        for slopes in [[1, 1], [-1, 1], [1, -1], [-1, -1]] {
            let corner = Corner::start(slopes, Extreme::Farthest);
            let far = Corner::start(slopes, Extreme::Nearest);
            let column = if far.is_right() { grid.columns() - 1 } else { 0 };
            let row = if far.is_lower() { grid.rows() - 1 } else { 0 };
            // Only the last band has a sample.
            let mut searcher = Searcher::load(grid, grid.bit(column, row), slopes, Extreme::Farthest);
            for band in 0..grid.columns() + grid.rows() - 1 {
                assert_eq!(searcher.state, State::Search);
                assert_eq!(searcher.search_mask, search::search_mask(grid, corner, band), "{grid:?} {corner:?} {band}");
                searcher.step(depth);
            }
            assert_eq!((searcher.search_mask, searcher.state), (0, State::FirstEnd));
        }
    }
}

/// 4x4, start corner upper right, fraction mask 0x0842: five bands, two ends.
#[test]
fn clocked_published_mask_shows_known_registers() {
    let mut searcher = Searcher::load(Grid::G4X4, 0x0842, [1, -1], Extreme::Farthest);
    let x = |offset: Offset| offset.x;
    for search_mask in [0x1000, 0x2100, 0x4210, 0x8421, 0x0842] {
        assert_eq!((searcher.search_mask, searcher.hit), (search_mask, 0));
        searcher.step(x);
    }
    assert_eq!((searcher.state, searcher.steps, searcher.hit), (State::FirstEnd, 5, 0x0842));
    searcher.step(x);
    assert_eq!((searcher.state, searcher.evaluations, searcher.depth), (State::LastEnd, 1, -6));
    assert_eq!(searcher.result(), None);
    searcher.step(x);
    assert_eq!((searcher.state, searcher.evaluations, searcher.depth), (State::Done, 2, 2));
    let done = searcher.clone();
    searcher.step(|_| unreachable!());
    assert_eq!(searcher, done);
    assert_eq!(done.result().map(|found| found.clocks()), Some(Clocks(7)));
}

#[test]
fn clocked_clocks_are_2_to_columns_plus_rows() {
    for (grid, most) in [(Grid::G4X4, 8), (Grid::G8X4, 12), (Grid::G8X8, 16)] {
        let clocks = |mask| extreme_of(grid, mask, [1, 1], Extreme::Nearest, depth).1;
        assert_eq!(clocks(0), Clocks(0));
        assert_eq!(clocks(grid.full()), Clocks(2));
        assert_eq!(clocks(1), Clocks(most));
        // The last band but one, fully covered.
        assert_eq!(clocks(1 << 1 | 1 << grid.columns()), Clocks(most));
    }
}
