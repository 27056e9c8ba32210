//! The search as registers and clocks.
//!
//! Source: JP 2569952 B2 (1990). [`super::search`] says what it is for; this is how the unit does it, and must find
//! the same.
//!
//! Duties: hold the fraction mask; move the search mask away from the start corner, one band a clock, until the AND
//! of the two is not 0; put the ends on the offset table and the plane equation, one a clock; keep the extreme.
//!
//! | state | in one clock | next |
//! | --- | --- | --- |
//! | search | step + 1; hit := search mask AND fraction mask; search mask moves on by a band | first end where hit is not 0, else search |
//! | first end | depth := plane at the first sample of hit | done where it is the only one, else last end |
//! | last end | depth := the extreme of depth and the plane at the last sample of hit | done |
//!
//! The search mask has no table: moved on by a band it is itself moved by a column, OR itself moved by a row, both
//! away from the start corner. What would leave the pixel is dropped.
//!
//! Inputs from: the mask generator (fraction mask), set-up (slopes). Outputs to: the merge and pack stages.
//!
//! Clocks: steps + evaluations, see [`Evaluated::clocks`]. At least 2 (the start corner is covered); at most
//! columns + rows - 1 bands, of which the last has one sample: columns + rows. A fraction mask of 0 is seen when
//! it is loaded and takes no clock.

use super::grid::{Grid, Offset};
use super::search::{Corner, Evaluated, Extreme, ends, offset_of};
use crate::probe::account::Clocks;

/// What the unit does on the next clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Looks at a band.
    Search,
    /// Evaluates the depth at the first end.
    FirstEnd,
    /// Evaluates the depth at the last end.
    LastEnd,
    /// Nothing: the result stands.
    Done,
}

/// The registers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Searcher {
    grid: Grid,
    corner: Corner,
    extreme: Extreme,
    /// What happens next.
    pub state: State,
    /// The samples that the fragment covers.
    pub fraction: u64,
    /// The band that is looked at next; after the last one 0.
    pub search_mask: u64,
    /// What the last band has of the fraction mask.
    pub hit: u64,
    /// Bands looked at.
    pub steps: u32,
    /// Depths evaluated.
    pub evaluations: u32,
    /// The extreme so far; holds nothing until the first end is evaluated.
    pub depth: i32,
}

impl Searcher {
    /// Loads a fraction mask and the slopes `[dz/dx, dz/dy]`, which are as in [`Corner::start`].
    #[must_use]
    pub fn load(grid: Grid, mask: u64, slopes: [i64; 2], extreme: Extreme) -> Searcher {
        let corner = Corner::start(slopes, extreme);
        let fraction = mask & grid.full();
        let column = if corner.is_right() { grid.columns() - 1 } else { 0 };
        let row = if corner.is_lower() { grid.rows() - 1 } else { 0 };
        Searcher {
            grid,
            corner,
            extreme,
            state: if fraction == 0 { State::Done } else { State::Search },
            fraction,
            search_mask: grid.bit(column, row),
            hit: 0,
            steps: 0,
            evaluations: 0,
            depth: 0,
        }
    }

    /// One clock. `plane` is the plane equation: the depth at a sample.
    pub fn step(&mut self, plane: impl FnOnce(Offset) -> i32) {
        match self.state {
            State::Search => {
                self.steps += 1;
                self.hit = self.search_mask & self.fraction;
                self.search_mask = self.next_band();
                if self.hit != 0 {
                    self.state = State::FirstEnd;
                }
            }
            State::FirstEnd => {
                let [first, last] = ends(self.grid, self.hit);
                self.depth = plane(offset_of(self.grid, first));
                self.evaluations += 1;
                self.state = if first == last { State::Done } else { State::LastEnd };
            }
            State::LastEnd => {
                let [_, last] = ends(self.grid, self.hit);
                self.depth = self.extreme.of(self.depth, plane(offset_of(self.grid, last)));
                self.evaluations += 1;
                self.state = State::Done;
            }
            State::Done => {}
        }
    }

    /// The wires from the search mask to its next value.
    fn next_band(&self) -> u64 {
        let (band, grid) = (self.search_mask, self.grid);
        let by_column = if self.corner.is_right() {
            (band & !grid.column_mask(0)) << 1
        } else {
            (band & !grid.column_mask(grid.columns() - 1)) >> 1
        };
        let by_row =
            if self.corner.is_lower() { (band & !grid.row_mask(0)) << grid.columns() } else { band >> grid.columns() };
        by_column | by_row
    }

    /// The result, once the unit is done. `None` before that, and where the mask covers nothing.
    #[must_use]
    pub fn result(&self) -> Option<Evaluated> {
        (self.state == State::Done && self.fraction != 0).then_some(Evaluated {
            depth: self.depth,
            steps: self.steps,
            evaluations: self.evaluations,
        })
    }
}

/// Steps a search to its end: the result and the clocks taken. Finds what [`super::search::extreme_of`] finds.
pub fn extreme_of(
    grid: Grid,
    mask: u64,
    slopes: [i64; 2],
    extreme: Extreme,
    mut depth: impl FnMut(Offset) -> i32,
) -> (Option<Evaluated>, Clocks) {
    let mut searcher = Searcher::load(grid, mask, slopes, extreme);
    let mut clocks = Clocks(0);
    while searcher.state != State::Done {
        searcher.step(&mut depth);
        clocks.0 += 1;
    }
    (searcher.result(), clocks)
}
