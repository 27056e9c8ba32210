//! Primitives whose texture has holes, in a host tile.
//!
//! A fragment whose texel is a hole does not pass, whatever its depth; the texel is looked up beside the depth test. On
//! a path that takes whole segments (the systolic array) a segment is cut at its holes before it enters.
//!
//! Must equal [`super::specification`] bit for bit, counts too.

use super::DepthTest;
use super::tile::Tile;
use crate::geometry::line::Line;
use crate::geometry::plane::DepthPlane;
use crate::geometry::triangle::Triangle;
use crate::shading::parameters::LANES;
use crate::shading::plane::ColourPlane;
use fearless_simd::Simd;

/// A draw whose texture has holes.
pub struct Punched<'a> {
    /// The primitive's colours, which know its holes.
    pub colours: &'a ColourPlane,
    /// Its identifier.
    pub id: u32,
    /// Depth test; `None` where depth is not called for.
    pub test: Option<DepthTest>,
    /// Bits of a depth plane below its point.
    pub below: u32,
    /// Segments are cut at holes.
    pub cuts: bool,
}

impl Punched<'_> {
    /// Tests pixel (`x`, `y`) of depth `z`, without regard to holes.
    #[inline(always)]
    fn passes(&self, x: i32, y: i32, z: i32, tile: &Tile<'_>) -> bool {
        let stored = || tile.depth[(y - tile.band_y) as usize * tile.depth_pitch + x as usize];
        self.test.is_none_or(|test| test.passes(z, stored()))
    }

    /// A fragment has passed, and is no hole.
    #[inline(always)]
    fn win(&self, x: i32, y: i32, z: i32, tile: &mut Tile<'_>) {
        let row = (y - tile.band_y) as usize;
        if self.test.is_some_and(|test| test.write) {
            tile.depth[row * tile.depth_pitch + x as usize] = z;
        }
        tile.ids[row * super::tile::TILE + (x - tile.x) as usize] = self.id;
        tile.counts.passed += 1;
    }

    /// A triangle.
    #[inline(always)]
    pub fn triangle<S: Simd>(&self, simd: S, t: &Triangle, tile: &mut Tile<'_>) {
        let first = t.rows[0].max(tile.rows[0]);
        let beyond = t.rows[2].min(tile.rows[1]);
        if first >= beyond {
            return;
        }
        tile.counts.rows_touched(first, beyond);
        for y in first..beyond {
            let [start, end] = t.span(y);
            let start = start.max(tile.scissor_x);
            let (from, to) = (start.max(tile.columns[0]), end.min(tile.columns[1]));
            if from >= to {
                continue;
            }
            let begun = start >= tile.x;
            tile.counts.spans += u64::from(begun);
            tile.counts.covered += (to - from) as u64;
            // Whether the pixel before the chunk at hand belongs to a segment that goes on.
            let mut inside = self.cuts && !begun && !self.colours.is_hole(from - 1, y);
            let mut tokens = u32::from(!self.cuts && begun);
            for x in (from..to).step_by(LANES) {
                let count = ((to - x) as usize).min(LANES);
                let covered = (u32::MAX >> (32 - count)) as u16;
                let mut depths = [0; LANES];
                let mut passed = 0;
                for (lane, z) in depths.iter_mut().enumerate().take(count) {
                    *z = depth(&t.plane, x + lane as i32, y, self.below);
                    passed |= u16::from(self.passes(x + lane as i32, y, *z, tile)) << lane;
                }
                let holes = self.colours.hole_lanes(simd, x, y, covered);
                tile.counts.holes += u64::from(holes.count_ones());
                if self.cuts {
                    let solid = covered & !holes;
                    tokens += (solid & !(solid << 1 | u16::from(inside))).count_ones();
                    inside = solid >> (count - 1) & 1 == 1;
                }
                let mut left = passed & !holes;
                while left != 0 {
                    let lane = left.trailing_zeros() as usize;
                    left &= left - 1;
                    self.win(x + lane as i32, y, depths[lane], tile);
                }
            }
            tile.count_tokens(y, tokens);
        }
    }

    /// A line.
    pub fn line(&self, line: &Line, tile: &mut Tile<'_>) {
        if tile.line_steps(line).is_empty() {
            return;
        }
        tile.counts.rows_touched(tile.rows[0], tile.rows[1]);
        for ([x, y], begins) in tile.line_pixels(line) {
            self.pixel([x, y], depth(&line.plane, x, y, self.below), begins, tile);
        }
    }

    /// A point.
    pub fn point(&self, pixel: [i32; 2], z: i32, tile: &mut Tile<'_>) {
        let [x, y] = pixel;
        if (tile.columns[0]..tile.columns[1]).contains(&x) && (tile.rows[0]..tile.rows[1]).contains(&y) {
            tile.counts.rows_touched(y, y + 1);
            self.pixel(pixel, z, true, tile);
        }
    }

    /// One pixel by itself; `begins` if no pixel of its primitive stands left of it.
    fn pixel(&self, [x, y]: [i32; 2], z: i32, begins: bool, tile: &mut Tile<'_>) {
        tile.counts.covered += 1;
        let hole = self.colours.is_hole(x, y);
        tile.counts.holes += u64::from(hole);
        let token = if self.cuts { !hole && (begins || self.colours.is_hole(x - 1, y)) } else { begins };
        tile.count_tokens(y, u32::from(token));
        if !hole && self.passes(x, y, z, tile) {
            self.win(x, y, z, tile);
        }
    }
}

/// Depth of a covered pixel, as stored.
#[inline(always)]
fn depth(plane: &DepthPlane, x: i32, y: i32, below: u32) -> i32 {
    plane.stored(plane.value(x, y), below)
}
