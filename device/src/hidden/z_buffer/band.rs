//! A band: one row of host tiles, drawn by one thread from visibility to colour.
//!
//! In each tile all primitives of the draw pass the depth test in order of submission; then what
//! each pixel shows is shaded, once. Bands share no pixel, so any number of threads gives the same
//! picture.

use super::bins::{Bin, Bins};
use super::punched::Punched;
use super::stencilled::StencilledPrimitive;
use super::tile::{TILE, Tile, TileCounts};
use super::{DepthTest, kernel};
use crate::built::{Called, Key, PunchThroughKey, ShadingKey, StencilKey};
use crate::geometry::plane::below;
use crate::geometry::triangle::runs_counter_clockwise;
use crate::hidden::stencil::{StencilRows, Stencilled};
use crate::hidden::za::band::TileBlocks;
use crate::pipeline::bands::{Plane, Sight, Surfaces};
use crate::shading::parameters::Parameters;
use crate::shading::pixel::{PixelShading, ShadingCounts};
use crate::shading::plane::{ColourPlane, ColourSource, Interpolated, Interpolation, Shade};
use crate::shading::resolve::{Planes, Row16, Row32, Sixteen, resolve_row};
use fearless_simd::{Level, Simd, dispatch};
use std::sync::Arc;
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::{Rectangle, Stencil};

/// What all bands of a draw share.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Depth test; `None` where depth is not called for.
    pub test: Option<DepthTest>,
    /// Number format of depth.
    pub format: DepthFormat,
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// What interpolated colours go through.
    pub shading: Option<Arc<DrawShading>>,
    /// Stencil test; `None` where it is not called for.
    pub stencil: Option<Called<StencilKey, StencilSetting>>,
    /// The path takes whole segments: holes of a texture cut them.
    pub cuts_segments: bool,
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

/// A draw's stencil test, and where the values are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilSetting {
    /// The test.
    pub rule: Stencil,
    /// Bytes from a row of stencil values to the next.
    pub pitch: usize,
}

/// What the colours of a batch of primitives go through.
#[derive(Debug, PartialEq)]
pub struct DrawShading {
    /// The same for all.
    pub pixel: Arc<PixelShading>,
    /// Number of the first primitive in the draw.
    pub first: u32,
    /// What the vertices of each carry.
    pub vertices: Vec<Parameters>,
}

impl DrawShading {
    /// What the colours of primitive `number` of the draw go through.
    #[must_use]
    #[inline(always)]
    pub fn of(&self, number: u32) -> (&Arc<PixelShading>, &Parameters) {
        (&self.pixel, &self.vertices[(number - self.first) as usize])
    }
}

/// Memory of one thread that draws bands.
#[derive(Debug)]
pub struct Scratch {
    /// Which primitive of the tile is seen at each pixel, counted from 1 through the shares' bins.
    pub(in crate::hidden) ids: Box<[u32; TILE * TILE]>,
    /// Place of each primitive's colour plane in `planes` plus 1; 0 is none yet.
    place: Vec<u32>,
    /// Colour planes of the primitives that are seen, where colours are interpolated alone.
    planes: Vec<Interpolated>,
    /// The same where they go through more.
    shaded: Vec<ColourPlane>,
    /// Blocks of a tile, once a path that has them has drawn.
    pub(in crate::hidden) blocks: Option<Box<TileBlocks>>,
}

impl Default for Scratch {
    fn default() -> Self {
        let ids = Box::new([0; TILE * TILE]);
        Scratch { ids, place: Vec::new(), planes: Vec::new(), shaded: Vec::new(), blocks: None }
    }
}

impl Setting {
    /// How the pixels of primitive `number` of the draw get their colours.
    #[must_use]
    pub fn shade(&self, number: u32) -> Shade<'_> {
        Shade { interpolation: self.interpolation, pixel: self.shading.as_ref().map(|draw| draw.of(number)) }
    }

    /// Whether the texture has holes.
    #[must_use]
    pub fn has_holes(&self) -> bool {
        let called = || self.shading.as_ref().is_some_and(|draw| draw.pixel.punch_through().is_some());
        PunchThroughKey::built().is_some() && called()
    }

    /// What looking for holes among so many fragments costs, where so many are holes; nothing without a texture that
    /// has any.
    #[must_use]
    pub fn looked_up(&self, fragments: u64, holes: u64) -> ShadingCounts {
        self.shading.as_ref().map_or(ShadingCounts::default(), |draw| draw.pixel.looked_up(fragments, holes))
    }

    /// Whether pixels that pass get a colour.
    #[must_use]
    #[inline(always)]
    pub fn draws_colours(&self) -> bool {
        self.stencil.is_none_or(|stencil| !stencil.rule.colour_off)
    }

    /// Whether shading does anything for its pixels.
    #[must_use]
    pub fn is_shaded(&self) -> bool {
        self.interpolation != Interpolation::Flat || self.shading.is_some()
    }

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
        let Surfaces { colour, depth, stencil, mut sight, .. } = surfaces;
        let (Plane { rows: colour, .. }, Plane { rows: depth, .. }) = (colour, depth);
        let mut values = StencilRows { rows: stencil.rows, pitch: self.stencil.map_or(0, |stencil| stencil.pitch) };
        let top = (band * TILE) as i32;
        let rows = [top.max(self.scissor.y as i32), (top + TILE as i32).min(self.scissor.bottom as i32)];
        let mut total = TileCounts::default();
        let holes = self.has_holes();
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
                // Apart, so that the one has no code of the other.
                match &self.stencil {
                    Some(stencil) => self.draw_stencilled(&stencil.rule, bin, first, &mut tile, &mut values),
                    None if holes => dispatch!(level, simd => self.draw_punched(simd, bin, first, &mut tile)),
                    None => dispatch!(level, simd => self.draw_bin(simd, bin, first, &mut tile)),
                }
                first += bin.len() as u32;
            }
            let counts = tile.counts;
            if sight.is_kept() {
                self.note(&scratch.ids, x as usize, top, counts.touched, &mut sight);
            }
            self.resolve(level, bins, x as usize, top, counts.touched, colour, scratch);
            total = total.plus(counts);
        }
        total
    }

    /// Notes which pixels of a tile something was drawn to, and whether its colour is interpolated.
    fn note(&self, ids: &[u32; TILE * TILE], x: usize, top: i32, touched: [i32; 2], sight: &mut Sight<'_>) {
        // Rows of whole chunks, as long as the target is wide.
        let pitch = (self.width as usize).div_ceil(16);
        let late = if self.is_shaded() { u16::MAX } else { 0 };
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
            if !sight.costs.rows.is_empty() {
                let costs = sight.costs.rows[16 * first..16 * beyond].iter_mut();
                for (id, cost) in ids.as_flattened().iter().zip(costs) {
                    *cost = if *id == 0 { *cost } else { sight.cost };
                }
            }
        }
    }

    /// Visibility of one share's primitives in one tile, where the texture has no holes.
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

    /// What knows the holes of a primitive of a bin; they do not depend on its vertices' colours.
    #[must_use]
    pub(in crate::hidden) fn hole_plane(&self, bin: &Bin, index: usize) -> Option<ColourPlane> {
        let (source, number) = (bin.colours(index)?, bin.number(index)?);
        Some(Interpolated::Flat(0).shaded(source.first_place(), &self.shade(number)))
    }

    /// The same where the texture has holes.
    #[inline(always)]
    fn draw_punched<S: Simd>(&self, simd: S, bin: &Bin, first: u32, tile: &mut Tile<'_>) {
        let (below, cuts) = (below(self.format), self.cuts_segments);
        for index in 0..bin.len() {
            let Some(colours) = self.hole_plane(bin, index) else {
                continue;
            };
            let punched = Punched { colours: &colours, id: first + index as u32, test: self.test, below, cuts };
            if let Some((triangle, _)) = bin.triangles.get(index) {
                punched.triangle(simd, triangle, tile);
            } else if let Some((line, _)) = bin.lines.get(index) {
                punched.line(line, tile);
            } else if let Some((point, _)) = bin.points.get(index) {
                punched.point(point.pixel, point.z, tile);
            }
        }
    }

    /// The same with a stencil test.
    fn draw_stencilled(
        &self,
        rule: &Stencil,
        bin: &Bin,
        first: u32,
        tile: &mut Tile<'_>,
        values: &mut StencilRows<'_>,
    ) {
        let (below, has_holes) = (below(self.format), self.has_holes());
        for index in 0..bin.len() {
            let Some(source) = bin.colours(index) else {
                continue;
            };
            let holes = has_holes.then(|| self.hole_plane(bin, index)).flatten();
            let front = bin.triangles.is_empty() || runs_counter_clockwise(source.places());
            let primitive = StencilledPrimitive {
                stencil: Stencilled { rule: *rule, front },
                holes: holes.as_ref(),
                id: first + index as u32,
                test: self.test,
                below,
                cuts: self.cuts_segments && has_holes,
            };
            if let Some((triangle, _)) = bin.triangles.get(index) {
                primitive.triangle(triangle, tile, values);
            } else if let Some((line, _)) = bin.lines.get(index) {
                primitive.line(line, tile, values);
            } else if let Some((point, _)) = bin.points.get(index) {
                primitive.point(point.pixel, point.z, tile, values);
            }
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

    /// Colours of one tile; leaves the identifiers empty. One of two kernels: draws that call for interpolated colours
    /// alone have one without code for more.
    #[expect(clippy::too_many_arguments, reason = "a tile's memories; a struct would only be taken apart again")]
    pub(in crate::hidden) fn resolve<'b, B: Iterator<Item = &'b Bin>>(
        &self,
        level: Level,
        bins: impl Fn() -> B,
        x: usize,
        top: i32,
        touched: [i32; 2],
        colour: &mut [u32],
        scratch: &mut Scratch,
    ) {
        let Scratch { ids, place, planes, shaded, .. } = scratch;
        place.clear();
        place.resize(bins().map(Bin::len).sum(), 0);
        if let (Some(_), Some(_)) = (&self.shading, ShadingKey::built()) {
            shaded.clear();
            let seen = SeenPlanes { bins, setting: self, place, planes: shaded };
            dispatch!(level, simd => self.resolve_with(simd, seen, x, top, touched, colour, ids));
        } else {
            planes.clear();
            let seen = SeenPlanes { bins, setting: self, place, planes };
            dispatch!(level, simd => self.resolve_with(simd, seen, x, top, touched, colour, ids));
        }
    }

    #[expect(clippy::too_many_arguments, reason = "inlined into its one caller at every SIMD level")]
    #[inline(always)]
    fn resolve_with<S: Simd>(
        &self,
        simd: S,
        mut planes: impl Planes,
        x: usize,
        top: i32,
        touched: [i32; 2],
        colour: &mut [u32],
        ids: &mut [u32; TILE * TILE],
    ) {
        // Pixels of a row up to its pitch: whole chunks, of which those beyond the target are never seen.
        let pixels = self.colour_pitch * 4 / self.pixel_format.bytes() as usize;
        let opaque = if self.pixel_format == PixelFormat::Xrgb8888 { 0xFF00_0000 } else { 0 };
        for y in touched[0]..touched[1] {
            let row = (y - top) as usize;
            let ids = &mut ids[row * TILE..][..TILE.min(pixels - x)];
            let words = &mut colour[row * self.colour_pitch..][..self.colour_pitch];
            let (y, planes) = (y as usize, &mut planes);
            match self.pixel_format {
                PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => {
                    resolve_row(simd, &mut Row32 { words, opaque }, ids, x, y, planes);
                }
                PixelFormat::Rgb565 => {
                    let pixels = bytemuck::cast_slice_mut(words);
                    resolve_row(simd, &mut Row16 { pixels }, ids, x, y, planes);
                }
            }
            ids.fill(0);
        }
    }
}

/// Colour planes of a tile's primitives, each made when it is first seen.
struct SeenPlanes<'a, F, P> {
    bins: F,
    setting: &'a Setting,
    place: &'a mut Vec<u32>,
    planes: &'a mut Vec<P>,
}

/// A plane that is made from a primitive of a bin.
trait Made: Sixteen {
    /// That of primitive `index` of a bin, whose colours come from `source`.
    fn make(setting: &Setting, bin: &Bin, index: usize, source: &ColourSource) -> Self;
}

impl Made for Interpolated {
    #[inline(always)]
    fn make(setting: &Setting, bin: &Bin, _index: usize, source: &ColourSource) -> Interpolated {
        if bin.triangles.is_empty() {
            Interpolated::line(source, setting.interpolation)
        } else {
            Interpolated::triangle(source, setting.interpolation)
        }
    }
}

impl Made for ColourPlane {
    #[inline(always)]
    fn make(setting: &Setting, bin: &Bin, index: usize, source: &ColourSource) -> ColourPlane {
        let plane = Interpolated::make(setting, bin, index, source);
        // Draws that are shaded have their numbers in the bins.
        plane.shaded(source.first_place(), &setting.shade(bin.number(index).unwrap_or(0)))
    }
}

impl<'b, B: Iterator<Item = &'b Bin>, F: Fn() -> B, P: Made> SeenPlanes<'_, F, P> {
    /// Makes the plane of the primitive that identifier `id` names: counted from 1 through the bins of the tile, of
    /// which there is one for each share.
    #[inline(always)]
    fn make(&self, id: u32) -> P {
        let mut index = id as usize - 1;
        for bin in (self.bins)() {
            match bin.colours(index) {
                Some(source) => return P::make(self.setting, bin, index, source),
                None => index -= bin.len(),
            }
        }
        // PANIC: identifiers are handed out by counting through these very bins.
        unreachable!("identifier {id} is beyond the tile's bins")
    }
}

impl<'b, B: Iterator<Item = &'b Bin>, F: Fn() -> B, P: Made> Planes for SeenPlanes<'_, F, P> {
    type Plane = P;

    #[inline(always)]
    fn plane(&mut self, id: u32) -> &P {
        let slot = id as usize - 1;
        if self.place[slot] == 0 {
            let plane = self.make(id);
            self.planes.push(plane);
            self.place[slot] = self.planes.len() as u32;
        }
        &self.planes[self.place[slot] as usize - 1]
    }
}
