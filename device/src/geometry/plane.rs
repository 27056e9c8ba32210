//! Depth planes: Z(i, j) = Zref + i gx + j gy in fixed point, anchored at a pixel.
//!
//! The anchor is the pixel of the (y, x)-least vertex, so that a plane does not depend on the order
//! of the vertices or on an integer shift of the scene. All arithmetic is modulo 2^64: a covered
//! sample's true value lies in the primitive's range, so a wrap on the way to it does no harm.
//!
//! Internally values carry [`below`] bits below the binary point whatever F is. With 32 of them the
//! stored depth is the upper half of the word and the lower half is what a row of lanes has to
//! carry; depths of 31 bits need head room above and have 24.

use super::ratio::round_ratio;
use super::triangle::doubled_area;
use super::{CENTRE, PIXEL, ScreenVertex};
use zga_abi::format::DepthFormat;

/// Bits below the binary point of a [`DepthPlane`]'s values.
#[must_use]
pub const fn below(format: DepthFormat) -> u32 {
    if format.bits() == 31 { 24 } else { 32 }
}

/// A primitive's depth as an integer function of the pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthPlane {
    /// Value at the anchor, rounding bias included; [`below`] bits below the point, modulo 2^64.
    pub reference: i64,
    /// Change for one pixel to the right.
    pub dx: i64,
    /// Change for one pixel down.
    pub dy: i64,
    /// Anchor, pixels.
    pub anchor: [i32; 2],
    /// Least depth of the primitive's vertices.
    pub minimum: i32,
    /// Greatest depth of the primitive's vertices.
    pub maximum: i32,
}

/// Gradients of at least this share of the depth range a pixel make a plane steep: a smaller one cannot
/// overflow 64 bits anywhere within 64 pixels of a covered one.
const STEEP: f64 = 1.0 / 8.0;

/// Whether a depth that changes by `rise / run` for one u, in depth steps, makes its plane steep.
#[inline(always)]
fn steep(rise: i64, inverse_run: f64, format: DepthFormat) -> bool {
    rise.unsigned_abs() as f64 * inverse_run * f64::from(PIXEL) >= f64::from(format.maximum()) * STEEP
}

/// Which of the pixel's coordinates a line's depth follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Columns.
    X,
    /// Rows.
    Y,
}

impl DepthPlane {
    /// The plane through three vertices, and whether it is steep: its gradients may have wrapped, and only
    /// the values of covered pixels mean something. `area` = twice the signed area, not 0.
    #[must_use]
    #[inline(always)]
    pub fn triangle(v: &[ScreenVertex; 3], area: i64, inverse: f64, format: DepthFormat) -> (DepthPlane, bool) {
        let (mut minimum, mut maximum) = (v[0].z.min(v[1].z), v[0].z.max(v[1].z));
        (minimum, maximum) = (minimum.min(v[2].z), maximum.max(v[2].z));
        let anchor = least(&least(&v[0], &v[1]), &v[2]);
        if minimum == maximum {
            return (DepthPlane::flat(&anchor, format), false);
        }
        let (x1, y1, z1) = difference(&v[1], &v[0]);
        let (x2, y2, z2) = difference(&v[2], &v[0]);
        // area = x1 y2 - x2 y1; A = z1 y2 - z2 y1 and B = x1 z2 - x2 z1 per u.
        let sign = area.signum();
        let a = (z1 * y2 - z2 * y1) * sign;
        let b = (x1 * z2 - x2 * z1) * sign;
        let (area, inverse) = (area * sign, inverse * sign as f64);
        let fraction = format.fraction();
        let [px, py] = to_centre(&anchor);
        let offset = if a.abs().max(b.abs()) < 1 << 54 {
            round_ratio(a * px + b * py, fraction, area, inverse)
        } else {
            let n = i128::from(a) * i128::from(px) + i128::from(b) * i128::from(py);
            ((n << (fraction + 1)) + i128::from(area)).div_euclid(2 * i128::from(area)) as i64
        };
        let plane = DepthPlane::new(
            &anchor,
            (i64::from(anchor.z) << fraction).wrapping_add(offset),
            [round_ratio(a, 8 + fraction, area, inverse), round_ratio(b, 8 + fraction, area, inverse)],
            [minimum, maximum],
            format,
        );
        (plane, steep(a.abs().max(b.abs()), inverse, format))
    }

    /// Depth along a line that runs `length` u along `axis` (not 0) from `v[0]` to `v[1]`, and whether it is
    /// steep.
    #[must_use]
    pub fn line(v: &[ScreenVertex; 2], axis: Axis, length: i64, format: DepthFormat) -> (DepthPlane, bool) {
        let anchor = least(&v[0], &v[1]);
        if v[0].z == v[1].z {
            return (DepthPlane::flat(&anchor, format), false);
        }
        let sign = length.signum();
        let rise = (i64::from(v[1].z) - i64::from(v[0].z)) * sign;
        let (length, fraction) = (length * sign, format.fraction());
        let inverse = 1.0 / length as f64;
        let [px, py] = to_centre(&anchor);
        let along = if axis == Axis::X { px } else { py };
        let gradient = round_ratio(rise, 8 + fraction, length, inverse);
        let plane = DepthPlane::new(
            &anchor,
            (i64::from(anchor.z) << fraction).wrapping_add(round_ratio(rise * along, fraction, length, inverse)),
            if axis == Axis::X { [gradient, 0] } else { [0, gradient] },
            [v[0].z.min(v[1].z), v[0].z.max(v[1].z)],
            format,
        );
        (plane, steep(rise, inverse, format))
    }

    /// The same depth everywhere: that of `vertex`.
    #[must_use]
    pub fn flat(vertex: &ScreenVertex, format: DepthFormat) -> DepthPlane {
        DepthPlane::new(vertex, i64::from(vertex.z) << format.fraction(), [0, 0], [vertex.z; 2], format)
    }

    #[inline(always)]
    fn new(
        anchor: &ScreenVertex,
        reference: i64,
        gradient: [i64; 2],
        range: [u32; 2],
        format: DepthFormat,
    ) -> DepthPlane {
        let fraction = format.fraction();
        let half = if fraction == 0 { 0 } else { 1_i64 << (fraction - 1) };
        let widen = below(format) - fraction;
        DepthPlane {
            reference: reference.wrapping_add(half).wrapping_shl(widen),
            dx: gradient[0].wrapping_shl(widen),
            dy: gradient[1].wrapping_shl(widen),
            anchor: [anchor.x >> 8, anchor.y >> 8],
            minimum: range[0] as i32,
            maximum: range[1] as i32,
        }
    }

    /// Value at pixel (`x`, `y`), before the clamp.
    #[must_use]
    #[inline(always)]
    pub fn value(&self, x: i32, y: i32) -> i64 {
        let across = i64::from(x - self.anchor[0]).wrapping_mul(self.dx);
        let down = i64::from(y - self.anchor[1]).wrapping_mul(self.dy);
        self.reference.wrapping_add(across).wrapping_add(down)
    }

    /// Stored depth of a value.
    #[must_use]
    #[inline(always)]
    pub fn stored(&self, value: i64, below: u32) -> i32 {
        (value >> below).clamp(i64::from(self.minimum), i64::from(self.maximum)) as i32
    }
}

/// A triangle's depth in integers that never wrap: for places that it does not cover, where a steep plane leaves 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WidePlane {
    /// Value at the anchor, rounding bias included; F bits below the point.
    reference: i128,
    /// Change for one pixel to the right and down.
    gradient: [i128; 2],
    anchor: [i32; 2],
    fraction: u32,
    range: [i32; 2],
}

impl WidePlane {
    /// The plane of [`DepthPlane::triangle`].
    #[must_use]
    pub fn triangle(v: &[ScreenVertex; 3], format: DepthFormat) -> WidePlane {
        let area = i128::from(doubled_area(&v[0], &v[1], &v[2]));
        let anchor = least(&least(&v[0], &v[1]), &v[2]);
        let (x1, y1, z1) = difference(&v[1], &v[0]);
        let (x2, y2, z2) = difference(&v[2], &v[0]);
        let sign = area.signum();
        let a = i128::from(z1 * y2 - z2 * y1) * sign;
        let b = i128::from(x1 * z2 - x2 * z1) * sign;
        let fraction = format.fraction();
        let [px, py] = to_centre(&anchor).map(i128::from);
        let ratio = |n: i128, shift: u32| ((n << (shift + 1)) + area.abs()).div_euclid(2 * area.abs());
        let half = if fraction == 0 { 0 } else { 1 << (fraction - 1) };
        let depths = v.map(|v| v.z as i32);
        WidePlane {
            reference: (i128::from(anchor.z) << fraction) + ratio(a * px + b * py, fraction) + half,
            gradient: [ratio(a, 8 + fraction), ratio(b, 8 + fraction)],
            anchor: [anchor.x >> 8, anchor.y >> 8],
            fraction,
            range: [depths[0].min(depths[1]).min(depths[2]), depths[0].max(depths[1]).max(depths[2])],
        }
    }

    /// Signs of the gradients.
    #[must_use]
    pub fn signs(&self) -> [i64; 2] {
        self.gradient.map(|gradient| gradient.signum() as i64)
    }

    /// Stored depth at a place in pixel (`x`, `y`), `offset` 1/16 pixel from its centre.
    #[must_use]
    pub fn stored(&self, x: i32, y: i32, offset: [i32; 2]) -> i32 {
        let along = |c: usize, pixel: i32| 16 * i128::from(pixel - self.anchor[c]) + i128::from(offset[c]);
        let value = 16 * self.reference + along(0, x) * self.gradient[0] + along(1, y) * self.gradient[1];
        (value >> (self.fraction + 4)).clamp(i128::from(self.range[0]), i128::from(self.range[1])) as i32
    }
}

/// The (y, x)-least of two vertices; of equal points the nearer one.
#[inline(always)]
fn least(a: &ScreenVertex, b: &ScreenVertex) -> ScreenVertex {
    if (b.y, b.x, b.z) < (a.y, a.x, a.z) { *b } else { *a }
}

/// From a vertex to its pixel's centre, u.
#[inline(always)]
fn to_centre(v: &ScreenVertex) -> [i64; 2] {
    [i64::from(CENTRE - (v.x & (PIXEL - 1))), i64::from(CENTRE - (v.y & (PIXEL - 1)))]
}

/// b - a in u, u, depth steps.
#[inline(always)]
fn difference(b: &ScreenVertex, a: &ScreenVertex) -> (i64, i64, i64) {
    (i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y), i64::from(b.z) - i64::from(a.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vertex(range: i32, bits: u32) -> impl Strategy<Value = ScreenVertex> {
        (-range..=range, -range..=range, 0_u32..1 << bits).prop_map(|(x, y, z)| ScreenVertex {
            x,
            y,
            z,
            ..ScreenVertex::default()
        })
    }

    proptest! {
        #[test]
        fn wide_plane_equals_the_plane_at_covered_centres(
            v in [vertex(4000, 24), vertex(4000, 24), vertex(4000, 24)],
            fraction in prop::sample::select(vec![0_u32, 8, 24]),
        ) {
            let format = DepthFormat::new(24, fraction).unwrap();
            let area = doubled_area(&v[0], &v[1], &v[2]);
            prop_assume!(area != 0);
            let (plane, _) = DepthPlane::triangle(&v, area, 1.0 / area as f64, format);
            let wide = WidePlane::triangle(&v, format);
            for (x, y) in (-16..16).flat_map(|x| (-16..16).map(move |y| (x, y))) {
                if crate::hidden::z_buffer::specification::covers(&v, x, y) {
                    prop_assert_eq!(wide.stored(x, y, [0, 0]), plane.stored(plane.value(x, y), below(format)));
                }
            }
        }

        #[test]
        fn wide_plane_at_samples_is_the_plane_of_sixteenths(
            v in [vertex(20_000, 20), vertex(20_000, 20), vertex(20_000, 20)], x in -40_i32..40, y in -40_i32..40,
            dx in -7_i32..=7, dy in -7_i32..=7,
        ) {
            let format = DepthFormat::default();
            let area = doubled_area(&v[0], &v[1], &v[2]);
            prop_assume!(area.abs() > 1 << 20);
            let (plane, steep) = DepthPlane::triangle(&v, area, 1.0 / area as f64, format);
            prop_assume!(!steep);
            // As in a pixel that the triangle meets: depths have 56 bits there, and gradients fewer.
            prop_assume!(plane.value(x, y).unsigned_abs() < 1 << 58);
            let value = 16 * plane.value(x, y) + i64::from(dx) * plane.dx + i64::from(dy) * plane.dy;
            let wide = WidePlane::triangle(&v, format);
            prop_assert_eq!(wide.stored(x, y, [dx, dy]), plane.stored(value, below(format) + 4));
            prop_assert_eq!(wide.signs(), [plane.dx.signum(), plane.dy.signum()]);
        }
    }
}
