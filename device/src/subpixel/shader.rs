//! Colours of fragments.
//!
//! One colour a fragment and pixel: at the pixel's centre, as the path has it, or where the polygon does not cover the
//! centre at the sample nearest to it that it covers. So no colour is taken from beyond a polygon.
//!
//! Clocks: 1 an interpolated colour, of the shading unit, and what it goes through beyond that ([`crate::shading::pixel`]).

use super::grid::Grid;
use super::pixel::{Fragment, Pixel};
use super::{Counts, Setting};
use crate::shading::plane::{ColourPlane, Interpolation};

/// Colours of pieces, whose planes are made when they are first seen.
#[derive(Debug, Default)]
pub struct Shader {
    /// Place of each piece's plane in `planes` plus 1; 0 is none yet.
    place: Vec<u32>,
    planes: Vec<ColourPlane>,
    /// Samples by their distance from the centre, nearest first, of this grid.
    rings: Vec<u64>,
    grid: Option<Grid>,
}

impl Shader {
    /// Makes ready for a band of so many pieces.
    pub fn begin(&mut self, setting: &Setting, pieces: usize) {
        self.planes.clear();
        self.place.clear();
        self.place.resize(pieces, 0);
        if self.grid != Some(setting.grid) {
            (self.grid, self.rings) = (Some(setting.grid), rings(setting.grid));
        }
    }

    /// Colour of a fragment: at the pixel's centre, or, where the piece does not cover that, at the sample nearest to
    /// it that it does.
    #[inline(always)]
    pub(super) fn colour(&mut self, pixel: &Pixel<'_>, fragment: usize, counts: &mut Counts) -> u32 {
        let (piece, draw) = (pixel.piece(fragment), pixel.draw(fragment));
        if draw.interpolation == Interpolation::Flat && draw.shading.is_none() {
            return piece.source.flat();
        }
        counts.shaded += 1;
        let Some(shading) = &draw.shading else {
            return match self.place_of(pixel, fragment) {
                None => self.plane(pixel, fragment).colour(pixel.place[0], pixel.place[1]),
                Some(place) => piece.source.colour_at(place, draw.interpolation),
            };
        };
        counts.shading = counts.shading.plus(shading.pixel.cost());
        match (self.place_of(pixel, fragment), self.plane(pixel, fragment)) {
            (Some(place), ColourPlane::Shaded(both)) => {
                both.1.colour(piece.source.colour_at(place, draw.interpolation), place)
            }
            (_, plane) => plane.colour(pixel.place[0], pixel.place[1]),
        }
    }

    /// Whether a fragment is a hole of its texture, where its colour is taken.
    pub(super) fn is_hole(&mut self, pixel: &Pixel<'_>, fragment: usize, counts: &mut Counts) -> bool {
        let [x, y] = pixel.place;
        let place = self.place_of(pixel, fragment).unwrap_or([x * 256 + 128, y * 256 + 128]);
        let hole = match self.plane(pixel, fragment) {
            ColourPlane::Shaded(both) => both.1.is_hole(place),
            _ => false,
        };
        if let Some(shading) = &pixel.draw(fragment).shading {
            counts.shading = counts.shading.plus(shading.pixel.looked_up(1, u64::from(hole)));
        }
        hole
    }

    /// Where a fragment's colour is taken, in u; `None` is the pixel's centre.
    #[inline(always)]
    fn place_of(&self, pixel: &Pixel<'_>, fragment: usize) -> Option<[i32; 2]> {
        let Fragment { mask, .. } = pixel.fragments[fragment];
        // What covers the four samples about the centre covers the centre.
        let inner = self.rings[0];
        if mask & inner == inner {
            return None;
        }
        let nearest = self.rings.iter().map(|ring| ring & mask).find(|&hit| hit != 0).unwrap_or(mask);
        let grid = pixel.setting.grid;
        let [u, v] = grid.position(grid.samples() - 1 - nearest.ilog2());
        let [x, y] = pixel.place;
        Some([x * 256 + u, y * 256 + v])
    }

    /// The plane of a fragment's piece.
    #[inline(always)]
    fn plane(&mut self, pixel: &Pixel<'_>, fragment: usize) -> &ColourPlane {
        let place = &mut self.place[pixel.fragments[fragment].piece as usize];
        if *place == 0 {
            self.planes.push(pixel.piece(fragment).colours(&pixel.draw(fragment).shade()));
            *place = self.planes.len() as u32;
        }
        &self.planes[*place as usize - 1]
    }
}

/// The samples of a grid by their distance from the centre, nearest first.
fn rings(grid: Grid) -> Vec<u64> {
    let distance = |sample: u32| {
        let offset = grid.offset(sample);
        offset.x * offset.x + offset.y * offset.y
    };
    let mut distances: Vec<i32> = (0..grid.samples()).map(distance).collect();
    distances.sort_unstable();
    distances.dedup();
    let ring = |of: &i32| (0..grid.samples()).filter(|&s| distance(s) == *of).map(|s| grid.sample_bit(s)).sum();
    distances.iter().map(ring).collect()
}
