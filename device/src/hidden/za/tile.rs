//! A host tile of the Za path: its pixels and its blocks.

use super::blocks::{Blocks, ones};
use super::{ZaCounts, ZaDraw};
use crate::hidden::stencil::StencilCounts;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::tile::{TILE, Tile};
use zga_abi::format::PixelFormat;

/// A tile being drawn.
pub struct ZaTile<'a> {
    /// The draw.
    pub draw: &'a ZaDraw,
    /// The depth test; one that everything passes where there is none.
    pub test: DepthTest,
    /// Blocks can be bypassed.
    pub may_bypass: bool,
    /// Depth is written.
    pub writes: bool,
    /// Bits below the binary point of planes' values.
    pub below: u32,
    /// Pixels.
    pub pixels: Tile<'a>,
    /// The band's rows of the frame buffer.
    pub colour: &'a mut [u32],
    /// Blocks.
    pub blocks: &'a mut Blocks,
    /// What the primitive at hand covers.
    pub runs: &'a mut Runs,
    /// Events of triangles.
    pub visits: Visits,
    /// Other events.
    pub counts: ZaCounts,
}

/// Events of triangles in a tile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Visits {
    /// Blocks initialised.
    pub initialised: u64,
    /// Their pixels on the screen.
    pub initialised_pixels: u64,
    /// Fragments in them that passed.
    pub initialised_passed: u64,
    /// Blocks bypassed.
    pub bypassed: u64,
    /// Fragments in them.
    pub bypassed_fragments: u64,
    /// Blocks compared, or painted.
    pub compared: u64,
    /// Their pixels on the screen; counted only where they are read: with a test, where depth is written.
    pub compared_pixels: u64,
    /// Fragments in them; counted only in other cases.
    pub compared_fragments: u64,
    /// Fragments in them that passed a test.
    pub compared_passed: u64,
    /// Fragments in them that were holes, where there is no test.
    pub unpainted: u64,
    /// Clocks of predictions.
    pub prediction: u64,
}

/// Rows that the row kernel may write beyond the last.
const SPARE: usize = 16;

/// What a triangle covers of a tile, and what of it is drawn.
#[derive(Debug)]
pub struct Runs {
    /// First column on each row.
    pub from: [i32; TILE + SPARE],
    /// Number of columns on each row, 0 on rows that are not covered.
    pub count: [i32; TILE + SPARE],
    /// For each column of blocks the rows covered in it.
    pub touched: [u64; TILE],
    /// For each column of blocks the rows in it that are drawn.
    pub needed: [u64; TILE],
    /// For each row the pixels of blocks that are being initialised.
    pub fresh: [u64; TILE],
}

impl Default for Runs {
    fn default() -> Self {
        Runs {
            from: [0; TILE + SPARE],
            count: [0; TILE + SPARE],
            touched: [0; TILE],
            needed: [0; TILE],
            fresh: [0; TILE],
        }
    }
}

impl ZaTile<'_> {
    /// All events of the tile. Sums of what one visit after another would count: see [`ZaCounts`].
    pub fn events(&self) -> ZaCounts {
        let (visits, tested) = (&self.visits, self.draw.test().is_some());
        // Without a test a clock goes to every fragment of the run, holes too.
        let (passed, painting) = if tested {
            (visits.compared_passed, visits.compared_passed)
        } else {
            (visits.compared_fragments - visits.unpainted, visits.compared_fragments)
        };
        let reads = match (tested, self.writes) {
            (false, _) => 0,
            (true, true) => visits.compared_pixels,
            (true, false) => visits.compared_fragments,
        };
        let words = if self.writes { visits.compared } else { 0 };
        let initial_depths = if self.draw.depth_buffer { visits.initialised_pixels } else { 0 };
        self.counts.plus(ZaCounts {
            // Holes are counted where they are looked for; stencil tests take another way.
            fragments: 0,
            holes: 0,
            stencil: StencilCounts::default(),
            spans: 0,
            passed: visits.initialised_passed + passed,
            initialised: visits.initialised,
            bypassed: visits.bypassed,
            pixels_bypassed: visits.bypassed_fragments,
            compared: visits.compared,
            reads,
            depth_writes: initial_depths + if self.writes { passed } else { 0 },
            colour_writes: visits.initialised_pixels + passed,
            words_written: visits.initialised + words,
            clocks: 2 * visits.initialised
                + visits.initialised_pixels
                + visits.bypassed
                + visits.compared
                + visits.prediction
                + reads
                + painting
                + words,
        })
    }

    /// Gives every pixel of blocks of a column what a cleared block is taken to hold, and the blocks their words.
    #[inline(always)]
    pub fn initialise(&mut self, column: usize, blocks: u64) {
        let left = column << self.blocks.width_shift();
        let right = (left + (1 << self.blocks.width_shift())).min(self.blocks.size[0]);
        let rows = self.blocks.rows(blocks) & ones(self.blocks.size[1] as u32);
        self.fill_depths(left, right, rows);
        self.fill_colours(left, right, rows);
        self.now_initialised(column, blocks);
    }

    /// Background depth from column `left` to `right` on `rows`.
    #[inline(always)]
    pub fn fill_depths(&mut self, left: usize, right: usize, mut rows: u64) {
        if !self.draw.depth_buffer {
            return;
        }
        let x = self.pixels.x as usize;
        while rows != 0 {
            let row = rows.trailing_zeros() as usize;
            rows &= rows - 1;
            let depths = &mut self.pixels.depth[row * self.pixels.depth_pitch + x..];
            depths[left..right].fill(self.draw.background.depth);
        }
    }

    /// Background colour from column `left` to `right` on `rows`.
    #[inline(always)]
    fn fill_colours(&mut self, left: usize, right: usize, mut rows: u64) {
        let (x, pixel) = (self.pixels.x as usize, self.draw.background.pixel);
        let pitch = self.draw.pixels.colour_pitch;
        while rows != 0 {
            let row = rows.trailing_zeros() as usize;
            rows &= rows - 1;
            let words = &mut self.colour[row * pitch..][..pitch];
            match self.draw.pixels.pixel_format {
                PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => words[x + left..x + right].fill(pixel),
                PixelFormat::Rgb565 => {
                    bytemuck::cast_slice_mut::<u32, u16>(words)[x + left..x + right].fill(pixel as u16);
                }
            }
        }
    }

    /// Blocks of a column are not cleared any more; their words are the background's.
    #[inline(always)]
    pub fn now_initialised(&mut self, column: usize, blocks: u64) {
        let word = self.draw.background_word();
        self.blocks.cleared[column] &= !blocks;
        self.blocks.cleared_count -= blocks.count_ones();
        let mut left = blocks;
        while left != 0 {
            self.blocks.words[column * TILE + left.trailing_zeros() as usize] = word;
            left &= left - 1;
        }
        if self.may_bypass {
            self.blocks.derived[column] |= blocks;
            self.blocks.hold(column, self.blocks.rows(blocks));
        } else if self.writes {
            self.now_written(column, blocks);
        }
    }

    /// Blocks of a column are visited and depth may be written: words that never came from depths do now.
    #[inline(always)]
    pub fn now_written(&mut self, column: usize, blocks: u64) {
        let blocks = blocks & !self.blocks.derived[column];
        self.blocks.derived[column] |= blocks;
        self.blocks.stale[column] |= blocks;
        self.blocks.loose = true;
    }
}
