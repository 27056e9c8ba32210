//! Line set-up: one pixel for each step along the major axis, diamond-exit and half-open.
//!
//! A line draws the pixels whose open diamond |x - xc| + |y - yc| < 1/2 it leaves, so that the
//! pieces of a polyline draw each shared end point once (OpenGL 4.6, section 14.5.1). Ties are
//! decided as if both end points were moved by (-e, -e^2), e infinitesimal, as that rule proposes.
//!
//! Along the major axis the line meets each diamond it crosses on the centre line; there the minor
//! coordinate is walked in fixed point as an edge is (see [`super::triangle`]). Only at the two ends
//! does the diamond itself decide.

use super::plane::{Axis, DepthPlane};
use super::triangle::{WALK, first_centre, walked};
use super::{CENTRE, PIXEL, ScreenVertex};
use zga_abi::format::DepthFormat;

/// A line ready to be walked along its major axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Major axis: [`Axis::X`] where |dx| >= |dy|.
    pub axis: Axis,
    /// First major pixel on the walk, and the first beyond.
    pub steps: [i32; 2],
    /// Minor pixel at `steps[0]`; s20.43, the integer part is exact.
    pub minor: i64,
    /// Change a step.
    pub slope: i64,
    /// Depth.
    pub plane: DepthPlane,
    /// The gradient of `plane` means nothing but at drawn pixels: it is large, or has wrapped.
    pub steep: bool,
}

impl Line {
    /// Sets a line up; `None` if it draws no pixel.
    #[must_use]
    pub fn new(v: &[ScreenVertex; 2], format: DepthFormat) -> Option<Line> {
        let (dx, dy) = (i64::from(v[1].x) - i64::from(v[0].x), i64::from(v[1].y) - i64::from(v[0].y));
        let axis = if dx.abs() >= dy.abs() { Axis::X } else { Axis::Y };
        let ends = v.map(|v| if axis == Axis::X { [v.x, v.y] } else { [v.y, v.x] });
        let (length, rise) = if axis == Axis::X { (dx, dy) } else { (dy, dx) };
        if length == 0 {
            return None;
        }
        let inside = [0, 1].map(|k| diamond(v[k].x, v[k].y));
        if inside[0].is_some() && inside[0] == inside[1] {
            return None;
        }
        // Centres passed: x-major x0 - e < centre < x1 - e; y-major y0 - e^2 < centre < y1 - e^2.
        let centres = ends.map(|e| first_centre(e[0]));
        let major = |pixel: [i32; 2]| if axis == Axis::X { pixel[0] } else { pixel[1] };
        let forward = length > 0;
        let [mut first, mut beyond] = if forward { centres } else { [centres[1], centres[0]] };
        // The start's diamond is left even if its centre line is not crossed; the end's diamond is not.
        if let Some(pixel) = inside[0].map(major) {
            if forward { first = first.min(pixel) } else { beyond = beyond.max(pixel + 1) }
        }
        if let Some(pixel) = inside[1].map(major) {
            if forward { beyond = beyond.min(pixel) } else { first = first.max(pixel + 1) }
        }
        if first >= beyond {
            return None;
        }
        let (minor, slope) = walk(ends[0], length, rise, axis, first);
        let (plane, steep) = DepthPlane::line(v, axis, length, format);
        Some(Line { axis, steps: [first, beyond], minor, slope, plane, steep })
    }

    /// Minor pixel at step `step`.
    #[must_use]
    #[inline(always)]
    pub fn minor_at(&self, step: i32) -> i32 {
        (self.minor.wrapping_add(i64::from(step - self.steps[0]).wrapping_mul(self.slope)) >> WALK) as i32
    }

    /// Whether the line draws pixel (`x`, `y`).
    #[must_use]
    pub fn draws(&self, x: i32, y: i32) -> bool {
        let (step, minor) = if self.axis == Axis::X { (x, y) } else { (y, x) };
        (self.steps[0]..self.steps[1]).contains(&step) && self.minor_at(step) == minor
    }

    /// Steps of an x-major line inside `columns`, `[first, beyond)`.
    #[must_use]
    pub fn steps_inside(&self, columns: [i32; 2]) -> [i32; 2] {
        [self.steps[0].max(columns[0]), self.steps[1].min(columns[1])]
    }

    /// Columns drawn on row `y`, `[first, beyond)`: of an x-major line those inside `columns`, of a y-major one the
    /// pixel of the row, which must be one of its steps.
    #[must_use]
    pub fn columns_on_row(&self, y: i32, columns: [i32; 2]) -> [i32; 2] {
        if self.axis == Axis::Y {
            let x = self.minor_at(y);
            return [x, x + 1];
        }
        // Rows follow one another along the line, down or up.
        let steps = self.steps_inside(columns);
        if self.slope >= 0 {
            [first_step(steps, |x| self.minor_at(x) >= y), first_step(steps, |x| self.minor_at(x) > y)]
        } else {
            [first_step(steps, |x| self.minor_at(x) <= y), first_step(steps, |x| self.minor_at(x) < y)]
        }
    }
}

/// The first step in `[first, beyond)` from which on `reached` holds, or the first beyond.
fn first_step([mut first, mut beyond]: [i32; 2], reached: impl Fn(i32) -> bool) -> i32 {
    while first < beyond {
        let middle = first + (beyond - first) / 2;
        if reached(middle) { beyond = middle } else { first = middle + 1 }
    }
    first
}

/// The pixel in whose open diamond the moved point lies.
fn diamond(x: i32, y: i32) -> Option<[i32; 2]> {
    // The move takes a point on a border to the pixel before it.
    let pixel = [(x - 1) >> 8, (y - 1) >> 8];
    let [a, b] = [x - (pixel[0] * PIXEL + CENTRE), y - (pixel[1] * PIXEL + CENTRE)];
    // At a distance of just 1/2 the move leads inside where it shortens |a| first.
    let distance = a.abs() + b.abs();
    (distance < CENTRE || (distance == CENTRE && a > 0)).then_some(pixel)
}

/// Minor coordinate at the centre of major pixel `step`, in pixels, and its change a step.
///
/// At a border between two pixels the moved line decides: for x-major lines by the sign of the slope
/// (y + e slope - e^2), for y-major ones always toward smaller x (x - e).
fn walk(start: [i32; 2], length: i64, rise: i64, axis: Axis, step: i32) -> (i64, i64) {
    let sign = length.signum();
    let (d, rise) = (length * sign, rise * sign);
    let along = i64::from(step) * i64::from(PIXEL) + i64::from(CENTRE - start[0]);
    // minor = n / (PIXEL d), in pixels
    let n = i64::from(start[1]) * d + along * rise;
    let up = axis == Axis::X && rise > 0;
    // floor(n / (256 d)), or ceil(n / (256 d)) - 1 = floor((n - 1) / (256 d))
    let n = (if up { n } else { n - 1 }) >> 8;
    let inverse = 1.0 / d as f64;
    (walked(n, d, inverse), walked(rise, d, inverse))
}
