//! The blocks of one host tile while primitives are drawn to it.
//!
//! Sets of blocks are 64-bit masks, one for each column of blocks: bit k stands for the block that
//! begins on row k of the tile. So the 16 rows that the row kernel walks together are 16 blocks of
//! height 1, and counting blocks is counting bits, whatever their shape.
//!
//! A word is exact whenever it decides something, but is not kept exact in between. Where depth falls
//! only, it stays exact until all pixels that were found to hold the maximum are overwritten; from then
//! on it is an upper bound (`stale`), good enough to bypass a block behind it, and taken anew from the
//! depths only when it is not, or when the tile is left. Words that came from the Za RAM are taken as
//! they are until their block is compared.
//!
//! A triangle that replaces the whole tile is only remembered (`pending`): the next one may replace it.

use super::ZaDraw;
use crate::geometry::plane::DepthPlane;
use crate::hidden::z_buffer::kernel::LANES;
use crate::hidden::z_buffer::tile::TILE;
use fearless_simd::i32x16;
use fearless_simd::prelude::*;

/// Numbers of the lanes.
pub const LANE: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Blocks of a tile.
#[derive(Debug)]
pub struct Blocks {
    /// log2 of a block's width and height.
    shift: [u32; 2],
    /// Columns of blocks on the screen.
    pub columns: usize,
    /// Pixels of the tile on the screen: columns, rows.
    pub size: [usize; 2],
    /// Rows on which blocks begin.
    firsts: u64,
    /// Words, or upper bounds of stale ones: [`TILE`] for each column, a block's at its first row; `i32::MIN`
    /// elsewhere. Any 16 from a row on can be loaded.
    pub words: Box<[i32; TILE * TILE + LANES]>,
    /// Blocks that are logically cleared.
    pub cleared: [u64; TILE],
    /// Number of cleared blocks.
    pub cleared_count: u32,
    /// Blocks whose word is no more than an upper bound.
    pub stale: [u64; TILE],
    /// Blocks whose word comes from their depths and not from the Za RAM.
    pub derived: [u64; TILE],
    /// For each row of pixels those that hold the maximum of their block, where a word is neither stale nor from
    /// the Za RAM.
    pub holders: [u64; TILE],
    /// No word is greater, cleared blocks aside.
    pub ceiling: i32,
    /// Words may have fallen since the ceiling was taken.
    pub loose: bool,
    /// No depth of the tile is less, cleared blocks counted with the background's.
    pub floor: i32,
    /// What has replaced everything in the tile and is not stored yet: its depth, and its identifier.
    pub pending: Option<(DepthPlane, u32)>,
}

impl Default for Blocks {
    fn default() -> Self {
        Blocks {
            shift: [0; 2],
            columns: 0,
            size: [0; 2],
            firsts: 0,
            words: Box::new([i32::MIN; TILE * TILE + LANES]),
            cleared: [0; TILE],
            cleared_count: 0,
            stale: [0; TILE],
            derived: [0; TILE],
            holders: [0; TILE],
            ceiling: i32::MAX,
            loose: false,
            floor: i32::MIN,
            pending: None,
        }
    }
}

/// The lowest `count` bits, `count` <= 64.
#[inline(always)]
pub const fn ones(count: u32) -> u64 {
    if count == 0 { 0 } else { u64::MAX >> (64 - count) }
}

impl Blocks {
    /// Takes the words of the tile at column `x` of a band of `rows` pixel rows.
    pub fn enter(&mut self, draw: &ZaDraw, x: usize, rows: usize, words: &[i32]) {
        let [width, height] = draw.grid.block;
        self.shift = [width.trailing_zeros(), height.trailing_zeros()];
        self.size = [(draw.grid.size[0] as usize - x).min(TILE), rows];
        let across = draw.grid.across();
        let first = x >> self.shift[0];
        self.columns = (across - first).min(TILE >> self.shift[0]);
        self.firsts = 0;
        self.cleared_count = 0;
        self.cleared[..self.columns].fill(0);
        self.stale[..self.columns].fill(0);
        self.derived[..self.columns].fill(0);
        self.holders.fill(0);
        self.words[..self.columns * TILE].fill(i32::MIN);
        for (row, words) in words.chunks_exact(across).enumerate() {
            let row = row << self.shift[1];
            self.firsts |= 1 << row;
            for (column, &word) in words[first..first + self.columns].iter().enumerate() {
                self.words[column * TILE + row] = word;
                let cleared = u64::from(word < 0);
                self.cleared[column] |= cleared << row;
                self.cleared_count += cleared as u32;
            }
        }
        (self.ceiling, self.loose) = (i32::MAX, true);
        self.pending = None;
        self.floor = if self.all_cleared() { draw.background.depth } else { i32::MIN };
    }

    /// Gives the words back; none is stale.
    pub fn leave(&self, draw: &ZaDraw, x: usize, words: &mut [i32]) {
        let first = x >> self.shift[0];
        for (row, words) in words.chunks_exact_mut(draw.grid.across()).enumerate() {
            let row = row << self.shift[1];
            for (column, word) in words[first..first + self.columns].iter_mut().enumerate() {
                *word = self.words[column * TILE + row];
            }
        }
    }

    /// Every block is cleared.
    #[inline(always)]
    pub fn all_cleared(&self) -> bool {
        self.cleared_count == self.columns as u32 * self.firsts.count_ones()
    }

    /// log2 of a block's width.
    #[inline(always)]
    pub fn width_shift(&self) -> u32 {
        self.shift[0]
    }

    /// First row of the block that row `row` lies in.
    #[inline(always)]
    pub fn first_row(&self, row: usize) -> usize {
        row >> self.shift[1] << self.shift[1]
    }

    /// Height of a block.
    #[inline(always)]
    pub fn height(&self) -> usize {
        1 << self.shift[1]
    }

    /// All blocks of a column.
    #[inline(always)]
    pub fn all(&self) -> u64 {
        self.firsts
    }

    /// Blocks that have a pixel on one of `rows`.
    #[inline(always)]
    pub fn meeting(&self, rows: u64) -> u64 {
        let mut blocks = rows;
        for shift in 0..self.shift[1] {
            blocks |= blocks >> (1_u32 << shift);
        }
        blocks & self.firsts
    }

    /// Rows of blocks.
    #[inline(always)]
    pub fn rows(&self, blocks: u64) -> u64 {
        // From each first bit a borrow runs up to the bit after the block's last.
        let beyond = if self.shift[1] == 6 { 0 } else { blocks << (1_u32 << self.shift[1]) };
        beyond.wrapping_sub(blocks)
    }

    /// Columns of pixels of a column of blocks.
    #[inline(always)]
    pub fn column(&self, column: usize) -> u64 {
        ones(1 << self.shift[0]) << (column << self.shift[0])
    }

    /// Number of pixels of blocks of a column that are on the screen.
    #[inline(always)]
    pub fn pixels(&self, column: usize, blocks: u64) -> u64 {
        let width = (self.size[0] - (column << self.shift[0])).min(1 << self.shift[0]);
        let rows = if self.shift[1] == 0 { blocks } else { self.rows(blocks) & ones(self.size[1] as u32) };
        width as u64 * u64::from(rows.count_ones())
    }

    /// On `rows` of a column of blocks pixels that held the maximum do not any more: where no other of the block
    /// does, its word is stale.
    #[inline(always)]
    pub fn outdate(&mut self, column: usize, rows: u64) {
        let pixels = self.column(column);
        let mut blocks = self.meeting(rows);
        let mut stale = 0;
        while blocks != 0 {
            let first = blocks.trailing_zeros() as usize % TILE;
            blocks &= blocks - 1;
            let mut held = self.holders[first];
            if self.shift[1] != 0 {
                for row in &self.holders[first..first + self.height()] {
                    held |= row;
                }
            }
            stale |= u64::from(held & pixels == 0) << first;
        }
        self.stale[column] |= stale;
    }

    /// All pixels of `rows` of a column of blocks hold their maxima.
    #[inline(always)]
    pub fn hold(&mut self, column: usize, mut rows: u64) {
        let pixels = self.column(column) & ones(self.size[0] as u32);
        rows &= ones(self.size[1] as u32);
        while rows != 0 {
            self.holders[rows.trailing_zeros() as usize % TILE] |= pixels;
            rows &= rows - 1;
        }
    }

    /// Takes the ceiling anew.
    #[inline(always)]
    pub fn tighten<S: Simd>(&mut self, simd: S) {
        let mut greatest = i32x16::splat(simd, i32::MIN);
        for words in self.words[..self.columns * TILE].as_chunks::<LANES>().0 {
            greatest = greatest.max(i32x16::from_slice(simd, words));
        }
        self.ceiling = greatest.reduce_max();
        self.loose = false;
    }

    /// Columns of pixels of a column of blocks on the screen: first, first beyond.
    #[inline(always)]
    fn sides(&self, column: usize) -> [usize; 2] {
        let left = column << self.shift[0];
        [left, (left + (1 << self.shift[0])).min(self.size[0])]
    }

    /// The greatest depth, at least 0, of the block of column `column` that begins on row `first`. `depth` begins
    /// with the tile's first.
    #[inline(always)]
    fn greatest<S: Simd>(&self, simd: S, column: usize, first: usize, depth: &[i32], pitch: usize) -> i32 {
        let [left, right] = self.sides(column);
        let beyond = (first + self.height()).min(self.size[1]);
        let mut greatest = i32x16::splat(simd, 0);
        let start = left & !(LANES - 1);
        for row in first..beyond {
            let row = &depth[row * pitch + start..row * pitch + right.next_multiple_of(LANES)];
            if left.is_multiple_of(LANES) && right.is_multiple_of(LANES) {
                for chunk in row.as_chunks::<LANES>().0 {
                    greatest = greatest.max(i32x16::from_slice(simd, chunk));
                }
                continue;
            }
            let lane = i32x16::from_slice(simd, &LANE);
            for (chunk, x) in row.as_chunks::<LANES>().0.iter().zip((start..).step_by(LANES)) {
                let inside = lane.simd_ge(left as i32 - x as i32) & lane.simd_lt(right as i32 - x as i32);
                greatest = inside.select(i32x16::from_slice(simd, chunk), greatest).max(greatest);
            }
        }
        greatest.reduce_max()
    }

    /// Makes a stale word exact and finds who holds the maximum. `depth` begins with the tile's first.
    #[inline(always)]
    pub fn renew<S: Simd>(&mut self, simd: S, column: usize, first: usize, depth: &[i32], pitch: usize) -> i32 {
        let word = self.greatest(simd, column, first, depth, pitch);
        let [left, right] = self.sides(column);
        let beyond = (first + self.height()).min(self.size[1]);
        let start = left & !(LANES - 1);
        for (row, holders) in self.holders.iter_mut().enumerate().take(beyond).skip(first) {
            let row = &depth[row * pitch + start..row * pitch + right.next_multiple_of(LANES)];
            let mut held = 0;
            for (chunk, x) in row.as_chunks::<LANES>().0.iter().zip((start..).step_by(LANES)) {
                held |= i32x16::from_slice(simd, chunk).simd_eq(word).to_bitmask() << x;
            }
            *holders |= held & ones(right as u32) & !ones(left as u32);
        }
        self.words[column * TILE + first] = word;
        self.stale[column] &= !(1 << first);
        self.loose = true;
        word
    }

    /// Makes all stale words exact, as the tile is left.
    #[inline(always)]
    pub fn renew_all<S: Simd>(&mut self, simd: S, depth: &[i32], pitch: usize) {
        for column in 0..self.columns {
            let mut stale = self.stale[column];
            while stale != 0 {
                let first = stale.trailing_zeros() as usize % TILE;
                stale &= stale - 1;
                self.words[column * TILE + first] = self.greatest(simd, column, first, depth, pitch);
            }
        }
    }

    /// Every depth of the tile was replaced by those of `plane`. `exact`: words must be good for decisions.
    #[inline(always)]
    pub fn replaced(&mut self, plane: &DepthPlane, exact: bool) {
        let known = exact && plane.minimum == plane.maximum;
        for column in 0..self.columns {
            self.stale[column] = if known { 0 } else { self.firsts };
            self.derived[column] = self.firsts;
            let mut left = self.firsts;
            while left != 0 {
                self.words[column * TILE + left.trailing_zeros() as usize] = plane.maximum;
                left &= left - 1;
            }
        }
        self.holders[..self.size[1]].fill(if known { ones(self.size[0] as u32) } else { 0 });
        (self.ceiling, self.loose) = (plane.maximum, false);
        self.floor = plane.minimum;
    }
}
