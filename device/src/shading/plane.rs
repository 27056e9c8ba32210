//! Colour interpolators.
//!
//! Affine colours are integer planes with 22 fraction bits in 32-bit arithmetic modulo 2^32, anchored
//! as depth is: a covered pixel's true value is in 0..=255, so a wrap on the way does no harm, and any
//! order of evaluation gives the same bits. The gradients are rounded exactly; the error of a pixel
//! (i, j) from the anchor is at most (|i| + |j| + 1) * 2^-23 levels.
//!
//! Perspective-correct colours divide a plane of c / w by a plane of 1 / w, in f32, one division a
//! pixel. Both kinds end in a clamp to the range of the primitive's own vertices.
//!
//! A line can draw a pixel whose centre lies up to 1/2 pixel beyond an end; the pixel has the end's
//! colour then. An affine plane sees to that by its clamp, as long as the overshoot fits its 32 bits;
//! short lines and perspective-correct ones (1 / w may change its sign there) limit the place instead.
//! Slivers whose planes are so steep that f32 would lose levels have planes in f64 ([`super::rare`]).
//!
//! All are made from the vertices in (y, x) order, so colours do not depend on the order they came in.

use super::parameters::Parameters;
use super::pixel::{PixelShading, ShadedPlane};
use super::rare::{LineColours, PrecisePlane};
pub use super::source::ColourSource;
use crate::built::{Called, ShadingKey};
use crate::geometry::ratio::round_ratio;
use crate::geometry::{CENTRE, PIXEL};
use fearless_simd::Simd;
use std::sync::Arc;

/// How a primitive's interpolated colour follows the pixel.
#[derive(Clone, Copy, Debug)]
pub enum Interpolated {
    /// One colour; RGBA, R in 7:0.
    Flat(u32),
    /// Affine in the pixel.
    Affine(AffinePlane),
    /// Perspective-correct.
    Perspective(PerspectivePlane),
    /// From end to end of a line, no farther.
    Line(LineColours),
    /// Perspective-correct, where f32 would cancel.
    Precise(PrecisePlane),
}

/// How a primitive's colour follows the pixel.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "most planes are of the large kind, and none of them is to cost an allocation"
)]
pub enum ColourPlane {
    /// By interpolation alone.
    Interpolated(Interpolated),
    /// The interpolated colour goes through more.
    Shaded(Called<ShadingKey, Box<(Interpolated, ShadedPlane)>>),
}

/// How the pixels of a primitive get their colours.
#[derive(Clone, Copy, Debug)]
pub struct Shade<'a> {
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// What colours go through, and what the primitive's vertices carry for it.
    pub pixel: Option<(&'a Arc<PixelShading>, &'a Parameters)>,
}

/// Four integer planes: R, G, B, A.
#[derive(Clone, Copy, Debug)]
pub struct AffinePlane {
    /// Values at the anchor, rounding bias included; [`AffinePlane::FRACTION`] fraction bits, modulo 2^32.
    pub(super) reference: [i32; 4],
    /// Change for one pixel to the right.
    pub(super) dx: [i32; 4],
    /// Change for one pixel down.
    pub(super) dy: [i32; 4],
    /// Column and row of the anchor.
    pub(super) anchor: [i32; 2],
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

/// Affine lines shorter than this, in u, can overshoot an end by more than an affine plane holds.
const SHORT: i64 = 128;

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

impl Interpolated {
    /// The plane of a triangle that covers at least one pixel.
    #[must_use]
    pub fn triangle(v: &ColourSource, interpolation: Interpolation) -> Interpolated {
        if interpolation == Interpolation::Flat || (v.colour[0] == v.colour[1] && v.colour[0] == v.colour[2]) {
            return Interpolated::Flat(v.flat());
        }
        let mut order = [0, 1, 2];
        order.sort_unstable_by_key(|&n| v.place(n));
        let v = &v.ordered(order);
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
            let plane = PrecisePlane::new(v, slopes);
            let extent = [v.extent(0), v.extent(1)];
            return if plane.cancels(extent) {
                Interpolated::Precise(plane)
            } else {
                Interpolated::Perspective(plane.rounded())
            };
        }
        let slopes = |c: [i64; 3]| {
            let (c1, c2) = (c[1] - c[0], c[2] - c[0]);
            [(c1 * y2 - c2 * y1) * sign, (x1 * c2 - x2 * c1) * sign]
        };
        Interpolated::Affine(AffinePlane::new(v, area.abs(), inverse, slopes))
    }

    /// The plane along a line that draws at least one pixel; of a point, whose colours are equal.
    #[must_use]
    pub fn line(v: &ColourSource, interpolation: Interpolation) -> Interpolated {
        if interpolation == Interpolation::Flat || v.colour[0] == v.colour[1] {
            return Interpolated::Flat(v.flat());
        }
        let v = &v.ordered(if v.place(1) < v.place(0) { [1, 0, 0] } else { [0, 1, 1] });
        let [dx, dy] = v.edge(1);
        let x_major = dx.abs() >= dy.abs();
        let length = if x_major { dx } else { dy };
        if interpolation == Interpolation::Perspective && v.reciprocal_w[0] != v.reciprocal_w[1] {
            return Interpolated::Line(LineColours::new(v, x_major, length, v.reciprocal_w[1] / v.reciprocal_w[0]));
        }
        if length.abs() < SHORT {
            return Interpolated::Line(LineColours::new(v, x_major, length, 1.0));
        }
        let (sign, inverse) = (length.signum(), 1.0 / length.abs() as f64);
        let slopes = |c: [i64; 3]| {
            let rise = (c[1] - c[0]) * sign;
            if x_major { [rise, 0] } else { [0, rise] }
        };
        Interpolated::Affine(AffinePlane::new(v, length.abs(), inverse, slopes))
    }

    /// Colour of pixel (`x`, `y`); RGBA, R in 7:0.
    #[must_use]
    pub fn colour(&self, x: i32, y: i32) -> u32 {
        match self {
            Interpolated::Flat(colour) => *colour,
            Interpolated::Affine(plane) => plane.colour(plane.value(x, y)),
            Interpolated::Perspective(plane) => plane.colour(x, y),
            Interpolated::Line(line) => line.colour(x, y),
            Interpolated::Precise(plane) => plane.colour(x, y),
        }
    }

    /// The plane with what its colours go through, for a primitive with a vertex at `vertex`, in u.
    #[must_use]
    pub fn shaded(self, vertex: [i32; 2], shade: &Shade<'_>) -> ColourPlane {
        match shade.pixel {
            None => ColourPlane::Interpolated(self),
            Some((shading, vertices)) => {
                let plane = || ShadedPlane::new(shading, vertex.map(|c| c >> 8), vertices);
                let both = Called::new(|| Box::new((self, plane())));
                both.map_or(ColourPlane::Interpolated(self), ColourPlane::Shaded)
            }
        }
    }
}

impl ColourPlane {
    /// One colour; RGBA, R in 7:0.
    #[must_use]
    pub const fn flat(colour: u32) -> ColourPlane {
        ColourPlane::Interpolated(Interpolated::Flat(colour))
    }

    /// The interpolated plane of a triangle.
    #[must_use]
    pub fn triangle(v: &ColourSource, interpolation: Interpolation) -> Interpolated {
        Interpolated::triangle(v, interpolation)
    }

    /// The interpolated plane of a line or point.
    #[must_use]
    pub fn line(v: &ColourSource, interpolation: Interpolation) -> Interpolated {
        Interpolated::line(v, interpolation)
    }

    /// Colour of pixel (`x`, `y`); RGBA, R in 7:0.
    #[must_use]
    pub fn colour(&self, x: i32, y: i32) -> u32 {
        match self {
            ColourPlane::Interpolated(plane) => plane.colour(x, y),
            ColourPlane::Shaded(both) => both.1.colour(both.0.colour(x, y), [x * PIXEL + CENTRE, y * PIXEL + CENTRE]),
        }
    }

    /// Which of the wanted ones of 16 pixels from (`x`, `y`) on are holes, a bit each.
    #[inline(always)]
    pub fn hole_lanes<S: Simd>(&self, simd: S, x: i32, y: i32, wanted: u16) -> u16 {
        match self {
            ColourPlane::Shaded(both) => both.1.holes_of_sixteen(simd, x, y, wanted),
            ColourPlane::Interpolated(_) => 0,
        }
    }

    /// Whether the pixel (`x`, `y`) is a hole of its texture.
    #[must_use]
    pub fn is_hole(&self, x: i32, y: i32) -> bool {
        match self {
            ColourPlane::Shaded(both) => both.1.is_hole([x * PIXEL + CENTRE, y * PIXEL + CENTRE]),
            ColourPlane::Interpolated(_) => false,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ScreenVertex;
    use crate::hidden::z_buffer::specification::covers;
    use proptest::prelude::*;

    fn vertex() -> impl Strategy<Value = ScreenVertex> {
        (-4000_i32..4000, -4000_i32..4000, any::<u32>(), 0.1_f32..4.0)
            .prop_map(|(x, y, colour, reciprocal_w)| ScreenVertex { x, y, z: 0, colour, reciprocal_w })
    }

    proptest! {
        #[test]
        fn colour_at_centres_is_the_planes_colour(v in [vertex(), vertex(), vertex()], perspective in any::<bool>()) {
            let interpolation = if perspective { Interpolation::Perspective } else { Interpolation::Affine };
            let source = ColourSource::new(&v);
            for (x, y) in (-16..16).flat_map(|x| (-16..16).map(move |y| (x, y))).filter(|&(x, y)| covers(&v, x, y)) {
                let found = source.colour_at([x * 256 + 128, y * 256 + 128], interpolation).to_le_bytes();
                let plane = ColourPlane::triangle(&source, interpolation).colour(x, y).to_le_bytes();
                // Both round half up; the plane is good for a quarter of a level before that, f64 for 2^-40.
                prop_assert!(found.iter().zip(plane).all(|(a, b)| a.abs_diff(b) <= 1), "{:?} {:?} at {} {}", found, plane, x, y);
            }
        }
    }

    #[test]
    fn colour_at_a_vertex_is_the_vertexs() {
        let at = |x, y, colour| ScreenVertex { x, y, z: 0, colour, reciprocal_w: 0.5 };
        let v = [at(0, 0, 0x0102_0304), at(700, 10, 0xFF00_80FE), at(30, 900, 0x7F7F_7F7F)];
        for interpolation in [Interpolation::Affine, Interpolation::Perspective] {
            let colours = v.map(|vertex| ColourSource::new(&v).colour_at([vertex.x, vertex.y], interpolation));
            assert_eq!(colours, v.map(|vertex| vertex.colour));
        }
        assert_eq!(ColourSource::new(&v).colour_at([700, 10], Interpolation::Flat), 0x0102_0304);
    }
}
