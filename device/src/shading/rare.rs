//! Colours of the rare cases, pixel by pixel: from end to end of a line, and perspective on slivers.
//!
//! A triangle that is thin and long has planes so steep that reference + i dx + j dy cancels: in f32 a
//! sliver of 1 pixel by 30000 was 20 levels off. Such planes are kept in f64. Where f32 is good for a
//! quarter of a level it is used, so this is seldom met and need not be fast.

use super::plane::{ColourSource, PerspectivePlane};
use crate::geometry::PIXEL;

/// Four quotients c / w over 1 / w that change from end to end of a line.
#[derive(Clone, Copy, Debug)]
pub struct LineColours {
    /// Columns count along the line, else rows.
    x_major: bool,
    /// Column or row of the first end.
    anchor: i32,
    /// From the first end to its pixel's centre, u.
    to_centre: i32,
    /// From the first end to the second, u, not 0.
    length: f32,
    /// c / w and 1 / w at the first end, relative to its w.
    start: [f32; 5],
    /// Their change to the second end.
    change: [f32; 5],
}

/// Four f64 planes of c / w, and one of 1 / w.
#[derive(Clone, Copy, Debug)]
pub struct PrecisePlane {
    /// Values at the anchor.
    reference: [f64; 5],
    /// Change for one pixel to the right.
    dx: [f64; 5],
    /// Change for one pixel down.
    dy: [f64; 5],
    /// Column and row of the anchor.
    anchor: [i32; 2],
    /// Least values of the vertices: levels, then 1 / w.
    minimum: [f64; 5],
    /// Greatest values of the vertices.
    maximum: [f64; 5],
}

impl LineColours {
    /// `w` is 1 / w of the second end relative to the first.
    pub(super) fn new(v: &ColourSource, x_major: bool, length: i64, w: f32) -> LineColours {
        let major = usize::from(!x_major);
        let mut line = LineColours {
            x_major,
            anchor: v.anchor()[major],
            to_centre: v.offset_to_centre()[major],
            length: length as f32,
            start: [1.0; 5],
            change: [w - 1.0; 5],
        };
        for k in 0..4 {
            line.start[k] = f32::from(v.channel(0, k));
            line.change[k] = f32::from(v.channel(1, k)) * w - line.start[k];
        }
        line
    }

    /// Colour of pixel (`x`, `y`).
    #[must_use]
    pub fn colour(&self, x: i32, y: i32) -> u32 {
        let pixel = if self.x_major { x } else { y };
        // Below 2^24 u, so the conversion is exact.
        let along = ((pixel - self.anchor) * PIXEL + self.to_centre) as f32;
        let t = (along / self.length).clamp(0.0, 1.0);
        let value = |k: usize| self.start[k] + t * self.change[k];
        let channel = |k: usize| (value(k) / value(4) + 0.5).min(255.0) as u32;
        channel(0) | (channel(1) << 8) | (channel(2) << 16) | (channel(3) << 24)
    }
}

impl PrecisePlane {
    /// `slopes` gives a quantity's change for one u right and down.
    pub(super) fn new(v: &ColourSource, slopes: impl Fn([f64; 3]) -> [f64; 2]) -> PrecisePlane {
        let to_centre = v.offset_to_centre().map(f64::from);
        let mut plane = PrecisePlane {
            reference: [0.0; 5],
            dx: [0.0; 5],
            dy: [0.0; 5],
            anchor: v.anchor(),
            minimum: [0.0; 5],
            maximum: [0.0; 5],
        };
        let w = [0, 1, 2].map(|n| v.relative_w(n));
        for k in 0..5 {
            let level = if k == 4 { w } else { [0, 1, 2].map(|n| f64::from(v.channel(n, k))) };
            let quantity = if k == 4 { w } else { [0, 1, 2].map(|n| level[n] * w[n]) };
            let [a, b] = slopes(quantity);
            plane.reference[k] = quantity[0] + a * to_centre[0] + b * to_centre[1];
            plane.dx[k] = a * f64::from(PIXEL);
            plane.dy[k] = b * f64::from(PIXEL);
            plane.minimum[k] = level[0].min(level[1]).min(level[2]);
            plane.maximum[k] = level[0].max(level[1]).max(level[2]);
        }
        plane
    }

    /// Whether f32 planes could be off by more than a quarter of a level within `extent` pixels of the
    /// anchor: each of the three terms is rounded twice, at 2^-24, and so is the divisor's, which counts
    /// 255 levels, all relative to the least 1 / w.
    pub(super) fn cancels(&self, extent: [f64; 2]) -> bool {
        let terms = |k: usize| self.reference[k].abs() + extent[0] * self.dx[k].abs() + extent[1] * self.dy[k].abs();
        let levels = terms(0).max(terms(1)).max(terms(2)).max(terms(3));
        let error = 2.0 * (levels + 255.0 * terms(4)) / f64::from(1 << 24);
        let allowed = 0.25 * self.minimum[4];
        error > allowed || error.is_nan() || allowed.is_nan()
    }

    /// The same in f32.
    pub(super) fn rounded(&self) -> PerspectivePlane {
        let levels = |all: &[f64; 5]| [0, 1, 2, 3].map(|k| all[k] as f32);
        PerspectivePlane {
            reference: self.reference.map(|c| c as f32),
            dx: self.dx.map(|c| c as f32),
            dy: self.dy.map(|c| c as f32),
            anchor: self.anchor,
            minimum: levels(&self.minimum),
            maximum: levels(&self.maximum),
        }
    }

    /// Colour of pixel (`x`, `y`).
    #[must_use]
    pub fn colour(&self, x: i32, y: i32) -> u32 {
        let (i, j) = (f64::from(x - self.anchor[0]), f64::from(y - self.anchor[1]));
        let value = |k: usize| self.reference[k] + i * self.dx[k] + j * self.dy[k];
        let divisor = value(4);
        // max and min put the range's ends where a division by 0 gives a NaN.
        let channel = |k: usize| ((value(k) / divisor).max(self.minimum[k]).min(self.maximum[k]) + 0.5) as u32;
        channel(0) | (channel(1) << 8) | (channel(2) << 16) | (channel(3) << 24)
    }
}
