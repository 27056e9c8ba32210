//! Colours of fragments.
//!
//! One colour a fragment and pixel: at the pixel's centre, as the path has it, or where the polygon does not cover the
//! centre at the sample nearest to it that it covers. So no colour is taken from beyond a polygon.
//!
//! Colours are asked for first, and found piece by piece, 16 at a time: the fragments of a piece share its planes, wherever
//! they lie.
//!
//! Inputs from: [`super::queue`]. Outputs to: the same. Clocks: 1 an interpolated colour, of the shading unit,
//! and what it goes through beyond that ([`crate::shading::pixel`]).

use super::grid::Grid;
use super::piece::Piece;
use super::scene::ItemDraw;
use super::search;
use crate::hidden::z_buffer::kernel::LANES;
use crate::shading::plane::ColourPlane;
use crate::shading::scattered::{self, Places, centre_of};
use fearless_simd::{Level, Simd, dispatch};

/// What colours are found in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    pub(super) pieces: &'a [Piece],
    pub(super) draws: &'a [ItemDraw],
}

/// Most rings that a grid has.
const RINGS: usize = 9;

/// Samples of a grid by their distance from the centre.
#[derive(Debug, Default)]
pub struct Rings {
    grid: Option<Grid>,
    /// The nearest first; 0 beyond the last.
    masks: [u64; RINGS],
}

/// Colours of pieces, whose planes are made when they are first seen.
#[derive(Debug, Default)]
pub struct Shader {
    /// Place of each piece's plane in `planes` plus 1; 0 is none yet.
    place: Vec<u32>,
    planes: Vec<ColourPlane>,
}

impl Rings {
    /// Makes ready for a grid.
    pub(super) fn begin(&mut self, grid: Grid) {
        if self.grid == Some(grid) {
            return;
        }
        let distance = |sample: u32| {
            let offset = grid.offset(sample);
            offset.x * offset.x + offset.y * offset.y
        };
        let mut distances: Vec<i32> = (0..grid.samples()).map(distance).collect();
        distances.sort_unstable();
        distances.dedup();
        *self = Rings { grid: Some(grid), masks: [0; RINGS] };
        for (mask, of) in self.masks.iter_mut().zip(distances) {
            *mask = (0..grid.samples()).filter(|&s| distance(s) == of).map(|s| grid.sample_bit(s)).sum();
        }
    }

    /// Where a fragment of pixel (`x`, `y`) has its colour, in u; `None` is the pixel's centre. It covers a sample.
    #[inline(always)]
    pub(super) fn place_of(&self, mask: u64, [x, y]: [i32; 2]) -> Option<[i32; 2]> {
        // What covers the four samples about the centre covers the centre.
        let inner = self.masks[0];
        if mask & inner == inner {
            return None;
        }
        let mut nearest = mask;
        for ring in self.masks.iter().rev() {
            let hit = ring & mask;
            nearest = if hit == 0 { nearest } else { hit };
        }
        let grid = self.grid?;
        let offset = search::offset_of(grid, grid.samples() - 1 - nearest.ilog2());
        let [cx, cy] = centre_of(x, y);
        Some([cx + 16 * offset.x, cy + 16 * offset.y])
    }
}

impl Source<'_> {
    pub(super) fn draw(&self, piece: u32) -> &ItemDraw {
        &self.draws[self.pieces[piece as usize].draw as usize]
    }
}

impl Shader {
    /// Makes ready for a band of so many pieces.
    pub(super) fn begin(&mut self, pieces: usize) {
        self.planes.clear();
        self.place.clear();
        self.place.resize(pieces, 0);
    }

    /// The plane of a piece, made when it is first asked for.
    #[inline(always)]
    fn plane(&mut self, source: Source<'_>, piece: u32) -> &ColourPlane {
        let place = &mut self.place[piece as usize];
        if *place == 0 {
            let set_up = &source.pieces[piece as usize];
            self.planes.push(set_up.colours(&source.draw(piece).shade(set_up.number)));
            *place = self.planes.len() as u32;
        }
        &self.planes[*place as usize - 1]
    }

    /// Colour of a piece at a place, a pixel's centre or another.
    fn colour_at(&mut self, source: Source<'_>, piece: u32, at_centre: bool, place: [i32; 2]) -> u32 {
        if at_centre {
            return self.plane(source, piece).colour(place[0] >> 8, place[1] >> 8);
        }
        let draw = source.draw(piece);
        let colour = source.pieces[piece as usize].source.colour_at(place, draw.interpolation);
        if draw.shading.is_none() {
            return colour;
        }
        match self.plane(source, piece) {
            ColourPlane::Shaded(both) => both.1.colour(colour, place),
            ColourPlane::Interpolated(_) => colour,
        }
    }

    /// Colours of a piece at 16 places, all of them centres or none; those not wanted mean nothing.
    pub(super) fn colours(
        &mut self,
        level: Option<Level>,
        source: Source<'_>,
        piece: u32,
        at_centre: bool,
        at: &Places,
        wanted: u16,
    ) -> [u32; LANES] {
        match level {
            Some(level) => dispatch!(level, simd => self.lanes(simd, source, piece, at_centre, at, wanted)),
            None => std::array::from_fn(|lane| match wanted >> lane & 1 {
                0 => 0,
                _ => self.colour_at(source, piece, at_centre, [at[0][lane], at[1][lane]]),
            }),
        }
    }

    #[inline(always)]
    fn lanes<S: Simd>(
        &mut self,
        simd: S,
        source: Source<'_>,
        piece: u32,
        at_centre: bool,
        at: &Places,
        wanted: u16,
    ) -> [u32; LANES] {
        let draw = source.draw(piece);
        let of_places = || scattered::at_places(simd, &source.pieces[piece as usize].source, at, draw.interpolation);
        if !at_centre && draw.shading.is_none() {
            return of_places();
        }
        match self.plane(source, piece) {
            ColourPlane::Interpolated(_) if !at_centre => of_places(),
            ColourPlane::Interpolated(plane) => scattered::at_centres(simd, plane, at),
            ColourPlane::Shaded(both) => {
                let colours = if at_centre { scattered::at_centres(simd, &both.0, at) } else { of_places() };
                both.1.scattered(simd, &colours, at, wanted)
            }
        }
    }

    /// Which of 16 places are holes of a piece's texture: 1, else 0.
    pub(super) fn holes(
        &mut self,
        level: Option<Level>,
        source: Source<'_>,
        piece: u32,
        at: &Places,
        wanted: u16,
    ) -> [u32; LANES] {
        let ColourPlane::Shaded(both) = self.plane(source, piece) else {
            return [0; LANES];
        };
        let holes = match level {
            Some(level) => dispatch!(level, simd => both.1.scattered_holes(simd, at, wanted)),
            None => {
                let hole = |lane: usize| u16::from(both.1.is_hole([at[0][lane], at[1][lane]])) << lane;
                (0..LANES).map(hole).sum()
            }
        };
        std::array::from_fn(|lane| u32::from(holes >> lane & 1))
    }
}
