//! Colour interpolators.
//!
//! Affine colours are integer planes with 22 fraction bits in 32-bit arithmetic modulo 2^32, anchored
//! as depth is: a covered pixel's true value is in 0..=255, so a wrap on the way does no harm, and any
//! order of evaluation gives the same bits. The gradients are rounded exactly; the error of a pixel
//! (i, j) from the anchor is at most (|i| + |j| + 1) * 2^-23 levels.
//!
//! Perspective-correct colours divide a plane of c / w by a plane of 1 / w, in f32, one division a
//! pixel. Both kinds end in a clamp to the range of the primitive's own vertices.

use crate::geometry::ratio::round_ratio;
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};

/// How a primitive's colour follows the pixel.
#[derive(Clone, Copy, Debug)]
pub enum ColourPlane {
    /// One colour; RGBA, R in 7:0.
    Flat(u32),
    /// Affine in the pixel.
    Affine(AffinePlane),
    /// Perspective-correct.
    Perspective(PerspectivePlane),
}

/// Four integer planes: R, G, B, A.
#[derive(Clone, Copy, Debug)]
pub struct AffinePlane {
    /// Values at the anchor, rounding bias included; [`AffinePlane::FRACTION`] fraction bits, modulo 2^32.
    reference: [i32; 4],
    /// Change for one pixel to the right.
    pub(super) dx: [i32; 4],
    /// Change for one pixel down.
    dy: [i32; 4],
    /// Column and row of the anchor.
    anchor: [i32; 2],
    /// Least level of the vertices.
    pub(super) minimum: [i32; 4],
    /// Greatest level of the vertices.
    pub(super) maximum: [i32; 4],
}

/// Four f32 planes of c / w, and one of 1 / w.
#[derive(Clone, Copy, Debug)]
pub struct PerspectivePlane {
    /// Values at the anchor.
    pub(super) reference: [f32; 5],
    /// Change for one pixel to the right.
    pub(super) dx: [f32; 5],
    /// Change for one pixel down.
    pub(super) dy: [f32; 5],
    /// Column and row of the anchor.
    pub(super) anchor: [i32; 2],
    /// Least level of the vertices.
    pub(super) minimum: [f32; 4],
    /// Greatest level of the vertices.
    pub(super) maximum: [f32; 4],
}

/// What a primitive's colours are made from, once it turns out to be seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct ColourSource {
    /// x, y of the vertices; s16.8, pixels. A line repeats its second vertex, a point its only one.
    position: [[i32; 2]; 3],
    /// RGBA of the vertices, R in 7:0.
    colour: [u32; 3],
    /// 1 / w of the vertices.
    reciprocal_w: [f32; 3],
}

impl ColourSource {
    /// The source of a primitive with these vertices.
    #[must_use]
    #[inline(always)]
    pub fn new(v: &[ScreenVertex; 3]) -> ColourSource {
        let [a, b, c] = v;
        ColourSource {
            position: [[a.x, a.y], [b.x, b.y], [c.x, c.y]],
            colour: [a.colour, b.colour, c.colour],
            reciprocal_w: [a.reciprocal_w, b.reciprocal_w, c.reciprocal_w],
        }
    }

    /// The colour of a flat primitive: its first vertex's.
    #[must_use]
    pub fn flat(&self) -> u32 {
        self.colour[0]
    }

    fn channel(&self, vertex: usize, k: usize) -> u8 {
        self.colour[vertex].to_le_bytes()[k]
    }

    /// From vertex 0 to vertex `k`, u.
    #[inline(always)]
    fn edge(&self, k: usize) -> [i64; 2] {
        let along = |c: usize| i64::from(self.position[k][c]) - i64::from(self.position[0][c]);
        [along(0), along(1)]
    }

    /// From vertex 0 to the centre of its pixel, u.
    fn offset_to_centre(&self) -> [i32; 2] {
        self.position[0].map(|c| CENTRE - (c & (PIXEL - 1)))
    }

    /// The pixel of vertex 0.
    fn anchor(&self) -> [i32; 2] {
        self.position[0].map(|c| c >> 8)
    }
}

/// Which interpolators a draw calls for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The first vertex's colour.
    Flat,
    /// Affine in screen space.
    Affine,
    /// Perspective-correct where the vertices' w differ.
    Perspective,
}

impl ColourPlane {
    /// The plane of a triangle that covers at least one pixel.
    #[must_use]
    pub fn triangle(v: &ColourSource, interpolation: Interpolation) -> ColourPlane {
        if interpolation == Interpolation::Flat || (v.colour[0] == v.colour[1] && v.colour[0] == v.colour[2]) {
            return ColourPlane::Flat(v.flat());
        }
        let ([x1, y1], [x2, y2]) = (v.edge(1), v.edge(2));
        let area = x1 * y2 - y1 * x2;
        let sign = area.signum();
        let inverse = 1.0 / area.abs() as f64;
        let w = v.reciprocal_w;
        if interpolation == Interpolation::Perspective && (w[0] != w[1] || w[0] != w[2]) {
            let slopes = |c: [f64; 3]| {
                let (c1, c2) = (c[1] - c[0], c[2] - c[0]);
                let per_u = inverse * sign as f64;
                [(c1 * y2 as f64 - c2 * y1 as f64) * per_u, (x1 as f64 * c2 - x2 as f64 * c1) * per_u]
            };
            return ColourPlane::Perspective(PerspectivePlane::new(v, slopes));
        }
        let slopes = |c: [i64; 3]| {
            let (c1, c2) = (c[1] - c[0], c[2] - c[0]);
            [(c1 * y2 - c2 * y1) * sign, (x1 * c2 - x2 * c1) * sign]
        };
        ColourPlane::Affine(AffinePlane::new(v, area.abs(), inverse, slopes))
    }

    /// The plane along a line that draws at least one pixel; of a point, whose colours are equal.
    #[must_use]
    pub fn line(v: &ColourSource, interpolation: Interpolation) -> ColourPlane {
        if interpolation == Interpolation::Flat || v.colour[0] == v.colour[1] {
            return ColourPlane::Flat(v.flat());
        }
        let [dx, dy] = v.edge(1);
        let x_major = dx.abs() >= dy.abs();
        let length = if x_major { dx } else { dy };
        let (sign, inverse) = (length.signum(), 1.0 / length.abs() as f64);
        if interpolation == Interpolation::Perspective && v.reciprocal_w[0] != v.reciprocal_w[1] {
            let slopes = |c: [f64; 3]| {
                let slope = (c[1] - c[0]) * (inverse * sign as f64);
                if x_major { [slope, 0.0] } else { [0.0, slope] }
            };
            return ColourPlane::Perspective(PerspectivePlane::new(v, slopes));
        }
        let slopes = |c: [i64; 3]| {
            let rise = (c[1] - c[0]) * sign;
            if x_major { [rise, 0] } else { [0, rise] }
        };
        ColourPlane::Affine(AffinePlane::new(v, length.abs(), inverse, slopes))
    }

    /// Colour of pixel (`x`, `y`); RGBA, R in 7:0.
    #[must_use]
    pub fn colour(&self, x: i32, y: i32) -> u32 {
        match self {
            ColourPlane::Flat(colour) => *colour,
            ColourPlane::Affine(plane) => plane.colour(plane.value(x, y)),
            ColourPlane::Perspective(plane) => plane.colour(x, y),
        }
    }
}

impl AffinePlane {
    /// Fraction bits of a value.
    pub const FRACTION: u32 = 22;

    /// `slopes` gives a channel's change for one u right and down, times `area`.
    fn new(v: &ColourSource, area: i64, inverse: f64, slopes: impl Fn([i64; 3]) -> [i64; 2]) -> AffinePlane {
        let mut plane = AffinePlane {
            reference: [0; 4],
            dx: [0; 4],
            dy: [0; 4],
            anchor: v.anchor(),
            minimum: [0; 4],
            maximum: [0; 4],
        };
        let to_centre = v.offset_to_centre().map(i64::from);
        for k in 0..4 {
            let c = [i64::from(v.channel(0, k)), i64::from(v.channel(1, k)), i64::from(v.channel(2, k))];
            plane.minimum[k] = c[0].min(c[1]).min(c[2]) as i32;
            plane.maximum[k] = c[0].max(c[1]).max(c[2]) as i32;
            let half = 1_i64 << (Self::FRACTION - 1);
            let mut reference = (c[0] << Self::FRACTION) + half;
            if plane.minimum[k] != plane.maximum[k] {
                let [a, b] = slopes(c);
                reference = reference.wrapping_add(round_ratio(
                    a * to_centre[0] + b * to_centre[1],
                    Self::FRACTION,
                    area,
                    inverse,
                ));
                plane.dx[k] = round_ratio(a, 8 + Self::FRACTION, area, inverse) as i32;
                plane.dy[k] = round_ratio(b, 8 + Self::FRACTION, area, inverse) as i32;
            }
            plane.reference[k] = reference as i32;
        }
        plane
    }

    /// Values at pixel (`x`, `y`).
    #[must_use]
    #[inline(always)]
    pub fn value(&self, x: i32, y: i32) -> [i32; 4] {
        let (i, j) = (x - self.anchor[0], y - self.anchor[1]);
        let mut value = self.reference;
        for (value, (dx, dy)) in value.iter_mut().zip(self.dx.iter().zip(self.dy)) {
            *value = value.wrapping_add(i.wrapping_mul(*dx)).wrapping_add(j.wrapping_mul(dy));
        }
        value
    }

    /// The colour of values.
    #[must_use]
    #[inline(always)]
    pub fn colour(&self, value: [i32; 4]) -> u32 {
        let channel = |k: usize| (value[k] >> Self::FRACTION).max(self.minimum[k]).min(self.maximum[k]) as u32;
        channel(0) | (channel(1) << 8) | (channel(2) << 16) | (channel(3) << 24)
    }
}

impl PerspectivePlane {
    /// `slopes` gives a quantity's change for one u right and down.
    fn new(v: &ColourSource, slopes: impl Fn([f64; 3]) -> [f64; 2]) -> PerspectivePlane {
        let to_centre = v.offset_to_centre().map(f64::from);
        let mut plane = PerspectivePlane {
            reference: [0.0; 5],
            dx: [0.0; 5],
            dy: [0.0; 5],
            anchor: v.anchor(),
            minimum: [0.0; 4],
            maximum: [0.0; 4],
        };
        // 1 / w relative to the first vertex keeps the planes in range for any w.
        let scale = 1.0 / f64::from(v.reciprocal_w[0]);
        let w = [0, 1, 2].map(|n| f64::from(v.reciprocal_w[n]) * scale);
        for k in 0..5 {
            let quantity = if k == 4 { w } else { [0, 1, 2].map(|n| f64::from(v.channel(n, k)) * w[n]) };
            let [a, b] = slopes(quantity);
            plane.reference[k] = (quantity[0] + a * to_centre[0] + b * to_centre[1]) as f32;
            plane.dx[k] = (a * f64::from(PIXEL)) as f32;
            plane.dy[k] = (b * f64::from(PIXEL)) as f32;
            if k < 4 {
                let c = [0, 1, 2].map(|n| f32::from(v.channel(n, k)));
                plane.minimum[k] = c[0].min(c[1]).min(c[2]);
                plane.maximum[k] = c[0].max(c[1]).max(c[2]);
            }
        }
        plane
    }

    /// Colour of pixel (`x`, `y`).
    #[must_use]
    #[inline(always)]
    pub fn colour(&self, x: i32, y: i32) -> u32 {
        let (i, j) = ((x - self.anchor[0]) as f32, (y - self.anchor[1]) as f32);
        let value = |k: usize| self.reference[k] + i * self.dx[k] + j * self.dy[k];
        let divisor = value(4);
        // max and min put the range's ends where a division by 0 gives a NaN.
        let channel = |k: usize| ((value(k) / divisor).max(self.minimum[k]).min(self.maximum[k]) + 0.5) as u32;
        channel(0) | (channel(1) << 8) | (channel(2) << 16) | (channel(3) << 24)
    }
}
