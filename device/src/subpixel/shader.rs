//! Colours of fragments.
//!
//! One colour a fragment and pixel: at the pixel's centre, as the path has it, or where the polygon does not cover the
//! centre at the sample nearest to it that it covers. So no colour is taken from beyond a polygon.
//!
//! Clocks: 1 an interpolated colour, of the shading unit.

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
        let piece = pixel.piece(fragment);
        let interpolation = pixel.draws[piece.draw as usize].interpolation;
        if interpolation == Interpolation::Flat {
            return piece.source.flat();
        }
        counts.shaded += 1;
        let Fragment { mask, piece: number, .. } = pixel.fragments[fragment];
        let [x, y] = pixel.place;
        // What covers the four samples about the centre covers the centre.
        let inner = self.rings[0];
        if mask & inner == inner {
            let place = &mut self.place[number as usize];
            if *place == 0 {
                self.planes.push(piece.colours(interpolation));
                *place = self.planes.len() as u32;
            }
            return self.planes[*place as usize - 1].colour(x, y);
        }
        let nearest = self.rings.iter().map(|ring| ring & mask).find(|&hit| hit != 0).unwrap_or(mask);
        let grid = pixel.setting.grid;
        let [u, v] = grid.position(grid.samples() - 1 - nearest.ilog2());
        piece.source.colour_at([x * 256 + u, y * 256 + v], interpolation)
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
