//! A host tile: the part of the frame whose depths and identifiers stay in the first-level cache.

use super::DepthTest;
use super::kernel::{LESS, NO_DEPTH};
use crate::geometry::line::Line;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::WALK;
use crate::hidden::stencil::StencilCounts;
use crate::pipeline::bands::Counts;
use std::ops::Range;

/// Width and height of a tile in pixels.
pub const TILE: usize = 64;

/// Events of one or more tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileCounts {
    /// Runs of pixels of one triangle on one row, counted where they begin.
    pub spans: u64,
    /// Fragments: pixels covered inside the scissor.
    pub covered: u64,
    /// Fragments that passed the stencil test, if there is one, and the depth test.
    pub passed: u64,
    /// Fragments that were holes of their texture.
    pub holes: u64,
    /// Of draws with a stencil test: its events.
    pub stencil: StencilCounts,
    /// First row and first row beyond where something was covered, pixels.
    pub touched: [i32; 2],
}

impl TileCounts {
    /// Adds another tile's events.
    #[must_use]
    pub fn plus(self, other: TileCounts) -> TileCounts {
        TileCounts {
            spans: self.spans + other.spans,
            covered: self.covered + other.covered,
            passed: self.passed + other.passed,
            holes: self.holes + other.holes,
            stencil: self.stencil.plus(other.stencil),
            touched: self.touched,
        }
    }

    /// Notes that rows `first..beyond` may hold identifiers.
    #[inline(always)]
    pub fn rows_touched(&mut self, first: i32, beyond: i32) {
        self.touched = [self.touched[0].min(first), self.touched[1].max(beyond)];
    }
}

impl Counts for TileCounts {
    fn plus(self, other: TileCounts) -> TileCounts {
        TileCounts::plus(self, other)
    }
}

/// A tile being drawn.
pub struct Tile<'a> {
    /// First column, pixels.
    pub x: i32,
    /// Rows to draw: tile cut to scissor and target; first, first beyond.
    pub rows: [i32; 2],
    /// Columns to draw: tile cut to scissor and target; first, first beyond.
    pub columns: [i32; 2],
    /// First column of the scissor.
    pub scissor_x: i32,
    /// First row of the band the tile lies in.
    pub band_y: i32,
    /// The band's depths, rows of `depth_pitch`; empty without a depth buffer.
    pub depth: &'a mut [i32],
    /// Words from a row of depths to the next.
    pub depth_pitch: usize,
    /// Words of a row of the frame from `x` on that a chunk may load: a multiple of 16, at most [`TILE`].
    pub reach: usize,
    /// Which primitive is seen at each pixel, rows of [`TILE`]; 0 is none.
    pub ids: &'a mut [u32; TILE * TILE],
    /// Plane segments that begin on each row of the band, counted for the paths that ask; else empty.
    pub tokens: &'a mut [u32],
    /// Events.
    pub counts: TileCounts,
}

impl Tile<'_> {
    /// Tests one fragment; no branch on the outcome, which no predictor knows.
    #[inline(always)]
    fn fragment<const MODE: u8>(&mut self, x: i32, y: i32, z: i32, id: u32, test: DepthTest) {
        let (row, column) = ((y - self.band_y) as usize, (x - self.x) as usize);
        let seen = &mut self.ids[row * TILE + column];
        self.counts.covered += 1;
        if MODE == NO_DEPTH {
            self.counts.passed += 1;
            *seen = id;
            return;
        }
        let stored = &mut self.depth[row * self.depth_pitch + x as usize];
        let pass = if MODE == LESS { z < *stored } else { test.passes(z, *stored) };
        *stored = if pass & test.write { z } else { *stored };
        *seen = if pass { id } else { *seen };
        self.counts.passed += u64::from(pass);
    }

    /// Steps of a line along its major axis that the tile may have pixels of.
    #[inline(always)]
    pub fn line_steps(&self, line: &Line) -> Range<i32> {
        let along = if line.axis == Axis::X { self.columns } else { self.rows };
        line.steps[0].max(along[0])..line.steps[1].min(along[1])
    }

    /// The pixels of a line in the tile, and whether its segment on that row begins there: no pixel of the line inside the
    /// scissor stands left of it.
    pub fn line_pixels<'l>(&self, line: &'l Line) -> impl Iterator<Item = ([i32; 2], bool)> + use<'l> {
        let across = if line.axis == Axis::X { self.rows } else { self.columns };
        let scissor_x = self.scissor_x;
        self.line_steps(line).filter_map(move |step| {
            let at = line.minor_at(step);
            let begins =
                || line.axis == Axis::Y || step == line.steps[0] || step == scissor_x || line.minor_at(step - 1) != at;
            let pixel = if line.axis == Axis::X { [step, at] } else { [at, step] };
            (across[0]..across[1]).contains(&at).then(|| (pixel, begins()))
        })
    }

    /// Counts plane segments that begin on row `y`, if the path asks.
    #[inline(always)]
    pub fn count_tokens(&mut self, y: i32, begun: u32) {
        if let Some(row) = self.tokens.get_mut((y - self.band_y) as usize) {
            *row += begun;
        }
    }

    /// Counts the plane segments of a line that begin in the tile.
    #[cold]
    fn line_tokens(&mut self, line: &Line) {
        self.line_pixels(line).for_each(|([_, y], begins)| self.count_tokens(y, u32::from(begins)));
    }

    /// Tests a line's steps that fall into the tile.
    pub fn line<const MODE: u8>(&mut self, line: &Line, id: u32, test: DepthTest, below: u32) {
        let across = if line.axis == Axis::X { self.rows } else { self.columns };
        let Range { start: first, end: beyond } = self.line_steps(line);
        if first >= beyond {
            return;
        }
        self.counts.rows_touched(self.rows[0], self.rows[1]);
        if !self.tokens.is_empty() {
            self.line_tokens(line);
        }
        let mut minor = line.minor.wrapping_add(i64::from(first - line.steps[0]).wrapping_mul(line.slope));
        let plane = &line.plane;
        // Depth follows the major axis alone: the other gradient is 0.
        let (mut value, gradient) = match line.axis {
            Axis::X => (plane.value(first, plane.anchor[1]), plane.dx),
            Axis::Y => (plane.value(plane.anchor[0], first), plane.dy),
        };
        for step in first..beyond {
            let at = (minor >> WALK) as i32;
            if at >= across[0] && at < across[1] {
                let (x, y) = if line.axis == Axis::X { (step, at) } else { (at, step) };
                self.fragment::<MODE>(x, y, plane.stored(value, below), id, test);
            }
            minor = minor.wrapping_add(line.slope);
            value = value.wrapping_add(gradient);
        }
    }

    /// Tests a point.
    pub fn point<const MODE: u8>(&mut self, pixel: [i32; 2], z: i32, id: u32, test: DepthTest) {
        let [x, y] = pixel;
        if (self.columns[0]..self.columns[1]).contains(&x) && (self.rows[0]..self.rows[1]).contains(&y) {
            self.counts.rows_touched(y, y + 1);
            self.count_tokens(y, 1);
            self.fragment::<MODE>(x, y, z, id, test);
        }
    }
}
