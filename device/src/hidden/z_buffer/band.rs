//! A band: one row of host tiles, drawn by one thread from visibility to colour.
//!
//! In each tile all primitives of the draw pass the depth test in order of submission; then what
//! each pixel shows is shaded, once. Bands share no pixel, so any number of threads gives the same
//! picture.

use super::bins::{Bin, Bins};
use super::tile::{TILE, Tile, TileCounts};
use super::{DepthTest, kernel};
use crate::geometry::plane::below;
use crate::hidden::za::band::TileBlocks;
use crate::pipeline::bands::{Plane, Sight, Surfaces};
use crate::shading::plane::{ColourPlane, ColourSource, Interpolation};
use crate::shading::resolve::{Planes, Row16, Row32, resolve_row};
use fearless_simd::{Level, Simd, dispatch};
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::Rectangle;

/// What all bands of a draw share.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Depth test; `None` where depth is not called for.
    pub test: Option<DepthTest>,
    /// Number format of depth.
    pub format: DepthFormat,
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// Pixels that may change, inside the target.
    pub scissor: Rectangle,
    /// Width of the target, pixels.
    pub width: u32,
    /// Format of the frame buffer.
    pub pixel_format: PixelFormat,
    /// Words from a row of the frame buffer to the next.
    pub colour_pitch: usize,
    /// Words from a row of depths to the next.
    pub depth_pitch: usize,
}

/// Memory of one thread that draws bands.
#[derive(Debug)]
pub struct Scratch {
    /// Which primitive of the tile is seen at each pixel, counted from 1 through the shares' bins.
    pub(in crate::hidden) ids: Box<[u32; TILE * TILE]>,
    /// Place of each primitive's colour plane in `planes` plus 1; 0 is none yet.
    place: Vec<u32>,
    /// Colour planes of the primitives that are seen.
    planes: Vec<ColourPlane>,
    /// Blocks of a tile, once a path that has them has drawn.
    pub(in crate::hidden) blocks: Option<Box<TileBlocks>>,
}

impl Default for Scratch {
    fn default() -> Self {
        Scratch { ids: Box::new([0; TILE * TILE]), place: Vec::new(), planes: Vec::new(), blocks: None }
    }
}

impl Setting {
    /// Draws band `band` of the shares' bins: rows `band * TILE ..` of frame buffer and Z buffer.
    #[must_use]
    pub fn draw_band(
        &self,
        level: Level,
        shares: &[Bins],
        band: usize,
        surfaces: Surfaces<'_>,
        scratch: &mut Scratch,
    ) -> TileCounts {
        let Surfaces { colour: Plane { rows: colour, .. }, depth: Plane { rows: depth, .. }, mut sight, .. } = surfaces;
        let top = (band * TILE) as i32;
        let rows = [top.max(self.scissor.y as i32), (top + TILE as i32).min(self.scissor.bottom as i32)];
        let mut total = TileCounts::default();
        for column in 0..(self.width as usize).div_ceil(TILE) {
            let bins = || shares.iter().map(|share| share.tile(column, band));
            if bins().all(Bin::is_empty) {
                continue;
            }
            let x = (column * TILE) as i32;
            let mut tile = Tile {
                x,
                rows,
                columns: [x.max(self.scissor.x as i32), (x + TILE as i32).min(self.scissor.right as i32)],
                scissor_x: self.scissor.x as i32,
                band_y: top,
                reach: if self.test.is_some() { TILE.min(self.depth_pitch - column * TILE) } else { TILE },
                depth: &mut *depth,
                depth_pitch: self.depth_pitch,
                ids: &mut scratch.ids,
                tokens: &mut *sight.tokens.rows,
                counts: TileCounts { touched: [i32::MAX, i32::MIN], ..TileCounts::default() },
            };
            let mut first = 1;
            for bin in bins() {
                dispatch!(level, simd => self.draw_bin(simd, bin, first, &mut tile));
                first += bin.len() as u32;
            }
            let counts = tile.counts;
            if sight.is_kept() {
                self.note(&scratch.ids, x as usize, top, counts.touched, &mut sight);
            }
            dispatch!(level, simd => self.resolve(simd, bins, x as usize, top, counts.touched, colour, scratch));
            total = total.plus(counts);
        }
        total
    }

    /// Notes which pixels of a tile something was drawn to, and whether its colour is interpolated.
    fn note(&self, ids: &[u32; TILE * TILE], x: usize, top: i32, touched: [i32; 2], sight: &mut Sight<'_>) {
        // Rows of whole chunks, as long as the target is wide.
        let pitch = (self.width as usize).div_ceil(16);
        let late = if self.interpolation == Interpolation::Flat { 0 } else { u16::MAX };
        for row in touched[0]..touched[1] {
            let row = (row - top) as usize;
            let ids = ids[row * TILE..][..TILE].as_chunks::<16>().0;
            let first = row * pitch + x / 16;
            let beyond = (row + 1) * pitch;
            let places = sight.winner.rows[first..beyond].iter_mut().zip(&mut sight.late.rows[first..beyond]);
            for (ids, (winner, lates)) in ids.iter().zip(places) {
                let mut seen = 0_u16;
                for (lane, &id) in ids.iter().enumerate() {
                    seen |= u16::from(id != 0) << lane;
                }
                *winner |= seen;
                *lates = (*lates & !seen) | (seen & late);
            }
        }
    }

    /// Visibility of one share's primitives in one tile.
    #[inline(always)]
    fn draw_bin<S: Simd>(&self, simd: S, bin: &Bin, first: u32, tile: &mut Tile<'_>) {
        match self.test {
            None => self.draw_bin_with::<S, { kernel::NO_DEPTH }>(simd, bin, first, DepthTest::ALWAYS, tile),
            Some(test) if below(self.format) != 32 => {
                self.draw_bin_with::<S, { kernel::WIDE }>(simd, bin, first, test, tile);
            }
            Some(test) if test == DepthTest::LESS => {
                self.draw_bin_with::<S, { kernel::LESS }>(simd, bin, first, test, tile);
            }
            Some(test) => self.draw_bin_with::<S, { kernel::GENERAL }>(simd, bin, first, test, tile),
        }
    }

    #[inline(always)]
    fn draw_bin_with<S: Simd, const MODE: u8>(
        &self,
        simd: S,
        bin: &Bin,
        first: u32,
        test: DepthTest,
        tile: &mut Tile<'_>,
    ) {
        let below = below(self.format);
        for ((triangle, _), id) in bin.triangles.iter().zip(first..) {
            kernel::triangle::<S, MODE>(simd, triangle, id, test, below, tile);
        }
        for ((line, _), id) in bin.lines.iter().zip(first..) {
            tile.line::<MODE>(line, id, test, below);
        }
        for ((point, _), id) in bin.points.iter().zip(first..) {
            tile.point::<MODE>(point.pixel, point.z, id, test);
        }
    }

    /// Colours of one tile; leaves the identifiers empty.
    #[expect(clippy::too_many_arguments, reason = "inlined into its one caller at every SIMD level")]
    #[inline(always)]
    pub(in crate::hidden) fn resolve<'b, S: Simd, B: Iterator<Item = &'b Bin>>(
        &self,
        simd: S,
        bins: impl Fn() -> B,
        x: usize,
        top: i32,
        touched: [i32; 2],
        colour: &mut [u32],
        scratch: &mut Scratch,
    ) {
        let Scratch { ids, place, planes, .. } = scratch;
        planes.clear();
        place.clear();
        place.resize(bins().map(Bin::len).sum(), 0);
        // Pixels of a row up to its pitch: whole chunks, of which those beyond the target are never seen.
        let pixels = self.colour_pitch * 4 / self.pixel_format.bytes() as usize;
        let mut planes = SeenPlanes { bins, interpolation: self.interpolation, place, planes };
        for y in touched[0]..touched[1] {
            let row = (y - top) as usize;
            let ids = &mut ids[row * TILE..][..TILE.min(pixels - x)];
            let words = &mut colour[row * self.colour_pitch..][..self.colour_pitch];
            let y = y as usize;
            match self.pixel_format {
                PixelFormat::Xrgb8888 => {
                    resolve_row(simd, &mut Row32 { words, opaque: 0xFF00_0000 }, ids, x, y, &mut planes);
                }
                PixelFormat::Argb8888 => resolve_row(simd, &mut Row32 { words, opaque: 0 }, ids, x, y, &mut planes),
                PixelFormat::Rgb565 => {
                    resolve_row(simd, &mut Row16 { pixels: bytemuck::cast_slice_mut(words) }, ids, x, y, &mut planes);
                }
            }
            ids.fill(0);
        }
    }
}

/// Colour planes of a tile's primitives, each made when it is first seen.
struct SeenPlanes<'a, F> {
    bins: F,
    interpolation: Interpolation,
    place: &'a mut Vec<u32>,
    planes: &'a mut Vec<ColourPlane>,
}

impl<'b, B: Iterator<Item = &'b Bin>, F: Fn() -> B> SeenPlanes<'_, F> {
    /// The primitive that identifier `id` names: counted from 1 through the bins of the tile, of which
    /// there is one for each share.
    fn source(&self, id: u32) -> (&'b Bin, &'b ColourSource) {
        let mut index = id as usize - 1;
        for bin in (self.bins)() {
            match bin.colours(index) {
                Some(source) => return (bin, source),
                None => index -= bin.len(),
            }
        }
        // PANIC: identifiers are handed out by counting through these very bins.
        unreachable!("identifier {id} is beyond the tile's bins")
    }
}

impl<'b, B: Iterator<Item = &'b Bin>, F: Fn() -> B> Planes for SeenPlanes<'_, F> {
    #[inline(always)]
    fn plane(&mut self, id: u32) -> &ColourPlane {
        let slot = id as usize - 1;
        if self.place[slot] == 0 {
            let (bin, source) = self.source(id);
            self.planes.push(if bin.triangles.is_empty() {
                ColourPlane::line(source, self.interpolation)
            } else {
                ColourPlane::triangle(source, self.interpolation)
            });
            self.place[slot] = self.planes.len() as u32;
        }
        &self.planes[self.place[slot] as usize - 1]
    }
}
