//! The grid of sub-pixels: where the samples of a pixel lie and which bit of a mask each one is.
//!
//! Source: JP 2569952 B2 (1990), which has 4x4, 8x4 and 8x8 sub-pixels.
//!
//! A sample lies at the centre of its sub-pixel. Samples count from the upper left one, row by row; the first
//! sample is the most significant of the low n bits of a mask, n the number of samples:
//!
//! ```text
//!   4x4            x from the centre, 1/16 pixel          8x4: 32 samples, x -7 -5 ... 7, y -6 -2 2 6
//!                   -6  -2   2   6                        8x8: 64 samples, x and y -7 -5 ... 7
//!   y from    -6    15  14  13  12
//!   the       -2    11  10   9   8    <- bits
//!   centre,    2     7   6   5   4
//!   1/16       6     3   2   1   0
//! ```
//!
//! Rows and y go down, as they do in the frame; the source's y goes up.

/// From the centre of a pixel to a place in it: 1/16 pixel, x to the right, y down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offset {
    /// To the right, 1/16 pixel.
    pub x: i32,
    /// Down, 1/16 pixel.
    pub y: i32,
}

/// Sub-pixels of a pixel. One of the three of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Grid {
    columns: u32,
    rows: u32,
}

impl Grid {
    /// 16 samples.
    pub const G4X4: Grid = Grid { columns: 4, rows: 4 };
    /// 32 samples, 8 columns of 4.
    pub const G8X4: Grid = Grid { columns: 8, rows: 4 };
    /// 64 samples.
    pub const G8X8: Grid = Grid { columns: 8, rows: 8 };
    /// All grids, in the order of [`Grid::index`].
    pub const ALL: [Grid; 3] = [Grid::G4X4, Grid::G8X4, Grid::G8X8];

    /// Samples of a row.
    #[must_use]
    pub const fn columns(self) -> u32 {
        self.columns
    }

    /// Samples of a column.
    #[must_use]
    pub const fn rows(self) -> u32 {
        self.rows
    }

    /// Samples of a pixel: 16, 32 or 64.
    #[must_use]
    pub const fn samples(self) -> u32 {
        self.columns * self.rows
    }

    /// Place in tables that have an entry for each grid: 0, 1 or 2.
    #[must_use]
    pub const fn index(self) -> usize {
        ((self.columns + self.rows) / 4 - 2) as usize
    }

    /// The mask of a pixel that is covered fully.
    #[must_use]
    pub const fn full(self) -> u64 {
        u64::MAX >> (64 - self.samples())
    }

    /// The sample in a column from the left and a row from the top, both from 0.
    #[must_use]
    pub const fn sample(self, column: u32, row: u32) -> u32 {
        row * self.columns + column
    }

    /// The mask of one sample, by its number.
    #[must_use]
    pub const fn sample_bit(self, sample: u32) -> u64 {
        1 << (self.samples() - 1 - sample)
    }

    /// The mask of the sample in a column from the left and a row from the top, both from 0.
    #[must_use]
    pub const fn bit(self, column: u32, row: u32) -> u64 {
        self.sample_bit(self.sample(column, row))
    }

    /// The mask of a column, from 0 at the left.
    #[must_use]
    pub const fn column_mask(self, column: u32) -> u64 {
        let (mut mask, mut row) = (0, 0);
        while row < self.rows {
            mask |= self.bit(column, row);
            row += 1;
        }
        mask
    }

    /// The mask of a row, from 0 at the top.
    #[must_use]
    pub const fn row_mask(self, row: u32) -> u64 {
        ((1 << self.columns) - 1) << ((self.rows - 1 - row) * self.columns)
    }

    /// `[u, v]` of a sample from the upper left corner of its pixel, 1/256 pixel, y down.
    #[must_use]
    pub const fn position(self, sample: u32) -> [i32; 2] {
        let (column, row) = (sample % self.columns, sample / self.columns);
        [(128 * (2 * column + 1) / self.columns) as i32, (128 * (2 * row + 1) / self.rows) as i32]
    }

    /// A sample from the centre of its pixel.
    #[must_use]
    pub const fn offset(self, sample: u32) -> Offset {
        let [u, v] = self.position(sample);
        Offset { x: (u - 128) / 16, y: (v - 128) / 16 }
    }

    /// The lower right sample from the centre of its pixel. The other corners have the same distances: no sample is
    /// farther out than this in x or in y.
    #[must_use]
    pub const fn corner_offset(self) -> Offset {
        self.offset(self.samples() - 1)
    }
}
