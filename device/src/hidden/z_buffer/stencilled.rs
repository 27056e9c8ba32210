//! Primitives with a stencil test, in a host tile.
//!
//! Fragment by fragment, in order of submission: hole, stencil test, depth test, what becomes of the stencil value. Draws
//! without a stencil test never come here, and the row kernel knows nothing of one.
//!
//! Must equal [`super::specification`] bit for bit, counts too.

use super::DepthTest;
use super::tile::{TILE, Tile};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::hidden::stencil::{StencilRows, Stencilled};
use crate::shading::plane::ColourPlane;

/// A primitive that is tested.
pub struct StencilledPrimitive<'a> {
    /// The test, and the side that is seen.
    pub stencil: Stencilled,
    /// What knows the holes of its texture, where that has any.
    pub holes: Option<&'a ColourPlane>,
    /// Its identifier.
    pub id: u32,
    /// Depth test; `None` where depth is not called for.
    pub test: Option<DepthTest>,
    /// Bits of a depth plane below its point.
    pub below: u32,
    /// Segments are cut at holes.
    pub cuts: bool,
}

impl StencilledPrimitive<'_> {
    /// Whether a covered pixel is a hole.
    fn is_hole(&self, x: i32, y: i32) -> bool {
        self.holes.is_some_and(|holes| holes.is_hole(x, y))
    }

    /// Tests a covered pixel of depth `z`; returns whether it is a hole. `values` begin with the band's first row.
    #[inline(always)]
    fn fragment(&self, [x, y]: [i32; 2], z: i32, tile: &mut Tile<'_>, values: &mut StencilRows<'_>) -> bool {
        tile.counts.covered += 1;
        if self.is_hole(x, y) {
            tile.counts.holes += 1;
            return true;
        }
        let (row, column) = ((y - tile.band_y) as usize, x as usize);
        let depth = row * tile.depth_pitch + column;
        let passes = || self.test.is_none_or(|test| test.passes(z, tile.depth[depth]));
        let value = &mut values.rows[row * values.pitch + column];
        if !self.stencil.decide(value, &mut tile.counts.stencil, passes) {
            return false;
        }
        if self.test.is_some_and(|test| test.write) {
            tile.depth[depth] = z;
        }
        if !self.stencil.rule.colour_off {
            tile.ids[row * TILE + (x - tile.x) as usize] = self.id;
        }
        tile.counts.passed += 1;
        false
    }

    /// Rows of the tile that may hold identifiers now.
    fn touch(&self, first: i32, beyond: i32, tile: &mut Tile<'_>) {
        if !self.stencil.rule.colour_off {
            tile.counts.rows_touched(first, beyond);
        }
    }

    /// A triangle.
    pub fn triangle(&self, t: &Triangle, tile: &mut Tile<'_>, values: &mut StencilRows<'_>) {
        let first = t.rows[0].max(tile.rows[0]);
        let beyond = t.rows[2].min(tile.rows[1]);
        if first >= beyond {
            return;
        }
        self.touch(first, beyond, tile);
        for y in first..beyond {
            let [start, end] = t.span(y);
            let start = start.max(tile.scissor_x);
            let (from, to) = (start.max(tile.columns[0]), end.min(tile.columns[1]));
            if from >= to {
                continue;
            }
            let begun = start >= tile.x;
            tile.counts.spans += u64::from(begun);
            // Whether the pixel before belongs to a segment that goes on.
            let mut inside = self.cuts && !begun && !self.is_hole(from - 1, y);
            let mut tokens = u32::from(!self.cuts && begun);
            let mut value = t.plane.value(from, y);
            for x in from..to {
                let solid = !self.fragment([x, y], t.plane.stored(value, self.below), tile, values);
                tokens += u32::from(self.cuts && solid && !inside);
                inside = solid;
                value = value.wrapping_add(t.plane.dx);
            }
            tile.count_tokens(y, tokens);
        }
    }

    /// A line.
    pub fn line(&self, line: &Line, tile: &mut Tile<'_>, values: &mut StencilRows<'_>) {
        if tile.line_steps(line).is_empty() {
            return;
        }
        self.touch(tile.rows[0], tile.rows[1], tile);
        for ([x, y], begins) in tile.line_pixels(line) {
            let z = line.plane.stored(line.plane.value(x, y), self.below);
            self.pixel([x, y], z, begins, tile, values);
        }
    }

    /// A point.
    pub fn point(&self, pixel: [i32; 2], z: i32, tile: &mut Tile<'_>, values: &mut StencilRows<'_>) {
        let [x, y] = pixel;
        if (tile.columns[0]..tile.columns[1]).contains(&x) && (tile.rows[0]..tile.rows[1]).contains(&y) {
            self.touch(y, y + 1, tile);
            self.pixel(pixel, z, true, tile, values);
        }
    }

    /// One pixel by itself; `begins` if no pixel of its primitive stands left of it.
    fn pixel(&self, [x, y]: [i32; 2], z: i32, begins: bool, tile: &mut Tile<'_>, values: &mut StencilRows<'_>) {
        let solid = !self.fragment([x, y], z, tile, values);
        let token = if self.cuts { solid && (begins || self.is_hole(x - 1, y)) } else { begins };
        tile.count_tokens(y, u32::from(token));
    }
}
