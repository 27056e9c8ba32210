//! A band of the Za path: one row of host tiles, drawn by one thread from visibility to colour.
//!
//! As for the plain Z buffer ([`crate::hidden::z_buffer::band`]), with the tile's blocks beside its
//! pixels. Only for blocks that divide a host tile; bands then share no block.

use super::blocks::Blocks;
use super::holes::{Punched, Solid};
use super::prediction::fits_64_bits;
use super::tile::{Runs, Visits, ZaTile};
use super::{ZaCounts, ZaDraw, kernel, steps};
use crate::geometry::plane::below;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::band::Scratch;
use crate::hidden::z_buffer::bins::{Bin, Bins};
use crate::hidden::z_buffer::kernel::{GENERAL, LESS, NO_DEPTH, WIDE};
use crate::hidden::z_buffer::tile::{TILE, Tile, TileCounts};
use fearless_simd::{Level, Simd, dispatch};

/// What a thread that draws bands needs beside the memory of the plain Z buffer's.
#[derive(Debug, Default)]
pub struct TileBlocks {
    blocks: Blocks,
    runs: Runs,
}

impl ZaDraw {
    /// Whether [`ZaDraw::draw_band`] can draw it: blocks divide a host tile.
    #[must_use]
    pub fn fast(&self) -> bool {
        fits_64_bits(self.grid.block)
            && self.grid.block.iter().all(|size| size.is_power_of_two() && *size as usize <= TILE)
    }

    /// Draws band `band` of the shares' bins. `colour` and `depth` are its rows of frame buffer and Z buffer
    /// (`depth` is needed without a depth test as well, and empty only where there is no Z buffer), `words` are
    /// its Za words, [`TILE`] / block height rows of [`super::Grid::across`], fewer at the lower edge.
    #[must_use]
    #[expect(clippy::too_many_arguments, reason = "the band's memories; a struct would only be taken apart again")]
    pub fn draw_band(
        &self,
        level: Level,
        shares: &[Bins],
        band: usize,
        colour: &mut [u32],
        depth: &mut [i32],
        words: &mut [i32],
        scratch: &mut Scratch,
    ) -> ZaCounts {
        let pixels = &self.pixels;
        let top = (band * TILE) as i32;
        let height = (self.grid.size[1] as usize - band * TILE).min(TILE);
        let words = &mut words[..height.div_ceil(self.grid.block[1] as usize) * self.grid.across()];
        let rows = [top.max(pixels.scissor.y as i32), (top + TILE as i32).min(pixels.scissor.bottom as i32)];
        let holes = pixels.has_holes();
        let mut total = ZaCounts::default();
        // Its own while it draws: the tile borrows both.
        let mut own = scratch.blocks.take().unwrap_or_default();
        for column in 0..(pixels.width as usize).div_ceil(TILE) {
            let bins = || shares.iter().map(|share| share.tile(column, band));
            if bins().all(Bin::is_empty) {
                continue;
            }
            let left = column * TILE;
            let x = left as i32;
            own.blocks.enter(self, left, height, words);
            let mut tile = ZaTile {
                draw: self,
                test: self.test().unwrap_or(DepthTest::ALWAYS),
                may_bypass: self.may_bypass(),
                writes: self.test().is_some_and(|test| test.write),
                below: below(pixels.format),
                pixels: Tile {
                    x,
                    rows,
                    columns: [x.max(pixels.scissor.x as i32), (x + TILE as i32).min(pixels.scissor.right as i32)],
                    scissor_x: pixels.scissor.x as i32,
                    band_y: top,
                    reach: if self.depth_buffer { TILE.min(pixels.depth_pitch - left) } else { TILE },
                    depth: &mut *depth,
                    depth_pitch: pixels.depth_pitch,
                    ids: &mut scratch.ids,
                    tokens: &mut [],
                    counts: TileCounts { touched: [i32::MAX, i32::MIN], ..TileCounts::default() },
                },
                colour: &mut *colour,
                blocks: &mut own.blocks,
                runs: &mut own.runs,
                visits: Visits::default(),
                counts: ZaCounts::default(),
            };
            let mut first = 1;
            for bin in bins() {
                // Apart, so that the one has no code of the other.
                if holes {
                    dispatch!(level, simd => draw_punched(simd, bin, first, &mut tile));
                } else {
                    dispatch!(level, simd => draw_bin(simd, bin, first, &mut tile));
                }
                first += bin.len() as u32;
            }
            dispatch!(level, simd => tile.finish(simd));
            let (counts, touched) = (tile.events(), tile.pixels.counts.touched);
            own.blocks.leave(self, left, words);
            pixels.resolve(level, bins, left, top, touched, colour, scratch);
            total = total.plus(counts);
        }
        scratch.blocks = Some(own);
        total
    }
}

impl ZaTile<'_> {
    /// Stores what is pending and makes all words exact.
    #[inline(always)]
    fn finish<S: Simd>(&mut self, simd: S) {
        kernel::store(simd, self);
        let depth = self.pixels.depth.get(self.pixels.x as usize..).unwrap_or_default();
        self.blocks.renew_all(simd, depth, self.pixels.depth_pitch);
    }
}

/// Visibility of one share's primitives in one tile, where the texture has no holes.
#[inline(always)]
fn draw_bin<S: Simd>(simd: S, bin: &Bin, first: u32, tile: &mut ZaTile<'_>) {
    match tile.draw.test() {
        None => draw_bin_with::<S, NO_DEPTH>(simd, bin, first, tile),
        Some(_) if tile.below != 32 => draw_bin_with::<S, WIDE>(simd, bin, first, tile),
        Some(DepthTest::LESS) => draw_bin_with::<S, LESS>(simd, bin, first, tile),
        Some(_) => draw_bin_with::<S, GENERAL>(simd, bin, first, tile),
    }
}

#[inline(always)]
fn draw_bin_with<S: Simd, const MODE: u8>(simd: S, bin: &Bin, first: u32, tile: &mut ZaTile<'_>) {
    for ((triangle, _), id) in bin.triangles.iter().zip(first..) {
        kernel::triangle::<S, Solid, MODE>(simd, triangle, id, &Solid, tile);
    }
    for ((line, _), id) in bin.lines.iter().zip(first..) {
        steps::line::<S, Solid, MODE>(simd, line, id, &Solid, tile);
    }
    for ((point, _), id) in bin.points.iter().zip(first..) {
        steps::point::<S, Solid, MODE>(simd, point.pixel, point.z, id, &Solid, tile);
    }
}

/// The same where the texture has holes.
#[inline(always)]
fn draw_punched<S: Simd>(simd: S, bin: &Bin, first: u32, tile: &mut ZaTile<'_>) {
    for (index, id) in (0..bin.len()).zip(first..) {
        let Some(colours) = tile.draw.pixels.hole_plane(bin, index) else {
            continue;
        };
        match tile.draw.test() {
            None => draw_one::<S, NO_DEPTH>(simd, bin, index, id, &Punched(&colours), tile),
            Some(_) if tile.below != 32 => draw_one::<S, WIDE>(simd, bin, index, id, &Punched(&colours), tile),
            Some(_) => draw_one::<S, GENERAL>(simd, bin, index, id, &Punched(&colours), tile),
        }
    }
}

/// One primitive of a bin.
#[inline(always)]
fn draw_one<S: Simd, const MODE: u8>(
    simd: S,
    bin: &Bin,
    index: usize,
    id: u32,
    holes: &Punched<'_>,
    tile: &mut ZaTile<'_>,
) {
    if let Some((triangle, _)) = bin.triangles.get(index) {
        kernel::triangle::<S, _, MODE>(simd, triangle, id, holes, tile);
    } else if let Some((line, _)) = bin.lines.get(index) {
        steps::line::<S, _, MODE>(simd, line, id, holes, tile);
    } else if let Some((point, _)) = bin.points.get(index) {
        steps::point::<S, _, MODE>(simd, point.pixel, point.z, id, holes, tile);
    }
}
