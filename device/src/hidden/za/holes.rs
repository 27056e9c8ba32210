//! Holes of a texture on the Za path: fragments that come to the test of a block and do not pass it, whatever their depth.
//!
//! A primitive visits blocks as one without holes does: what it covers there, the prediction and the word do not know of
//! them. In blocks that are not bypassed the texel of each fragment is looked up, 16 of a row at a time; what is left of
//! the row goes to the test run by run. Must equal [`super::specification`] bit for bit, counts too.
//!
//! Duties: which fragments are holes. Inputs from: colour planes. Outputs to: [`super::kernel`], [`super::steps`]. Clocks:
//! the texture unit's, charged with the draw.

use super::blocks::ones;
use crate::hidden::z_buffer::kernel::LANES;
use crate::hidden::z_buffer::tile::TILE;
use crate::shading::plane::ColourPlane;
use fearless_simd::Simd;

/// Where a primitive has holes.
pub trait Holes {
    /// It can have any; else there is no code for them.
    const ANY: bool;

    /// Those of the fragments of row `y` that `covered` has a bit for, the lowest for column `x`, which are holes.
    fn on_row<S: Simd>(&self, simd: S, x: i32, y: i32, covered: u64) -> u64;

    /// Whether pixel (`x`, `y`) is one.
    fn at(&self, x: i32, y: i32) -> bool;
}

/// A primitive without holes.
#[derive(Clone, Copy, Debug)]
pub struct Solid;

/// A primitive whose colours know its holes.
#[derive(Clone, Copy, Debug)]
pub struct Punched<'a>(pub &'a ColourPlane);

impl Holes for Solid {
    const ANY: bool = false;

    #[inline(always)]
    fn on_row<S: Simd>(&self, _simd: S, _x: i32, _y: i32, _covered: u64) -> u64 {
        0
    }

    #[inline(always)]
    fn at(&self, _x: i32, _y: i32) -> bool {
        false
    }
}

impl Holes for Punched<'_> {
    const ANY: bool = true;

    #[inline(always)]
    fn on_row<S: Simd>(&self, simd: S, x: i32, y: i32, covered: u64) -> u64 {
        let mut found = 0;
        for first in (0..TILE).step_by(LANES) {
            let wanted = (covered >> first & ones(LANES as u32)) as u16;
            if wanted != 0 {
                found |= u64::from(self.0.hole_lanes(simd, x + first as i32, y, wanted)) << first;
            }
        }
        found
    }

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> bool {
        self.0.is_hole(x, y)
    }
}
