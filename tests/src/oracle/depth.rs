//! Depth at a pixel, twice: the true depth on the exact plane, and the depth that the card's formats prescribe.
//!
//! The true depth of a triangle is its plane at the pixel's centre; of a line, the linear function of the major
//! coordinate that has the end points' depths, at the pixel's centre, limited to the end points' range (a diamond
//! can be met although its centre lies beyond an end).
//!
//! The prescribed depth follows the manual: gradients and a reference depth with F fraction bits, each rounded half up
//! once, anchored at the pixel of the (y, x)-least vertex, then summed, rounded and limited to the vertices' range. It
//! is computed here in `i128` without any wrap.

use num_bigint::BigInt;
use num_rational::BigRational;
use std::ops::Range;

use super::exact::{Fraction, integer, round_half_up};
use super::raster::line::is_x_major;
use super::{DepthFormat, Primitive, Vertex};

/// `z = z_v + (a (x - x_v) + b (y - y_v)) / d`: the exact plane, x and y in u, z in steps.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// The (y, x)-least vertex.
    anchor: Vertex,
    a: i128,
    b: i128,
    /// Positive.
    d: i128,
    least: u32,
    greatest: u32,
    /// Whether the plane says nothing beyond the vertices' range.
    limited: bool,
}

impl Plane {
    /// `None` for what draws nothing: area 0, length 0.
    fn of(primitive: &Primitive) -> Option<Self> {
        let vertices = primitive.vertices();
        let (a, b, d) = match primitive {
            Primitive::Triangle(vertices) => Self::of_triangle(vertices),
            Primitive::Line(vertices) => Self::of_line(vertices),
            Primitive::Point(_) => (0, 0, 1),
        };
        let depths = || vertices.iter().map(|v| v.z);
        let anchor = vertices.iter().min_by_key(|v| (v.y, v.x, v.z))?;
        (d != 0).then_some(Self {
            anchor: *anchor,
            a: a * d.signum(),
            b: b * d.signum(),
            d: d.abs(),
            least: depths().min()?,
            greatest: depths().max()?,
            limited: !matches!(primitive, Primitive::Triangle(_)),
        })
    }

    fn of_triangle([v0, v1, v2]: &[Vertex; 3]) -> (i128, i128, i128) {
        let [dx1, dy1, dz1] = difference(v0, v1);
        let [dx2, dy2, dz2] = difference(v0, v2);
        (dz1 * dy2 - dz2 * dy1, dx1 * dz2 - dx2 * dz1, dx1 * dy2 - dx2 * dy1)
    }

    fn of_line(line: &[Vertex; 2]) -> (i128, i128, i128) {
        let [dx, dy, dz] = difference(&line[0], &line[1]);
        if is_x_major(line) { (dz, 0, dx) } else { (0, dz, dy) }
    }

    /// z times d at the centre of a pixel.
    fn numerator_at(&self, i: i64, j: i64) -> i128 {
        let from_anchor = |pixel: i64, coordinate: i32| i128::from(pixel) * 256 + 128 - i128::from(coordinate);
        i128::from(self.anchor.z) * self.d
            + self.a * from_anchor(i, self.anchor.x)
            + self.b * from_anchor(j, self.anchor.y)
    }
}

fn difference(from: &Vertex, to: &Vertex) -> [i128; 3] {
    [
        i128::from(to.x) - i128::from(from.x),
        i128::from(to.y) - i128::from(from.y),
        i128::from(to.z) - i128::from(from.z),
    ]
}

/// The unrounded depth of a primitive at every pixel's centre, in steps.
#[derive(Clone, Copy, Debug)]
pub struct TrueDepth {
    plane: Plane,
    /// `d z` at pixel (0, 0) and its increments for a pixel.
    origin: i128,
    step_x: i128,
    step_y: i128,
}

impl TrueDepth {
    /// `None` when the primitive draws nothing: a triangle of area 0, a line of length 0.
    #[must_use]
    pub fn new(primitive: &Primitive) -> Option<Self> {
        let plane = Plane::of(primitive)?;
        Some(Self { plane, origin: plane.numerator_at(0, 0), step_x: plane.a * 256, step_y: plane.b * 256 })
    }

    /// The depth at the centre of pixel `(i, j)`. On a triangle's plane it has no limits, so it may be asked outside
    /// the triangle too; a line's depth is limited to the range of its ends.
    #[must_use]
    pub fn at(&self, i: i32, j: i32) -> Fraction {
        let numerator = self.origin + self.step_x * i128::from(i) + self.step_y * i128::from(j);
        let plane = &self.plane;
        let numerator = if plane.limited {
            numerator.clamp(i128::from(plane.least) * plane.d, i128::from(plane.greatest) * plane.d)
        } else {
            numerator
        };
        Fraction::new(numerator, plane.d)
    }

    /// The change of depth for a pixel to the right; `None` where limits may bend the plane.
    #[must_use]
    pub fn step(&self) -> Option<Fraction> {
        (!self.plane.limited).then(|| Fraction::new(self.step_x, self.plane.d))
    }
}

/// The card's depth of a primitive: everything that its setup computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrescribedDepth {
    /// Column of the anchor pixel, which holds the (y, x)-least vertex.
    pub anchor_x: i64,
    /// Row of the anchor pixel.
    pub anchor_y: i64,
    /// Depth at the anchor pixel's centre, in 2^-F steps.
    pub reference: i128,
    /// Depth gradient for a pixel to the right, in 2^-F steps.
    pub step_x: i128,
    /// Depth gradient for a pixel down, in 2^-F steps.
    pub step_y: i128,
    /// The least depth of the vertices, in steps.
    pub least: u32,
    /// The greatest depth of the vertices, in steps.
    pub greatest: u32,
    /// F.
    pub fraction: u32,
}

impl PrescribedDepth {
    /// `None` when the primitive draws nothing: a triangle of area 0, a line of length 0.
    #[must_use]
    pub fn new(primitive: &Primitive, format: DepthFormat) -> Option<Self> {
        let plane = Plane::of(primitive)?;
        let fraction = format.fraction;
        let anchor_x = i64::from(plane.anchor.x).div_euclid(256);
        let anchor_y = i64::from(plane.anchor.y).div_euclid(256);
        let gradient = |slope: i128| round_half_up(slope * (1 << (8 + fraction)), plane.d);
        Some(Self {
            anchor_x,
            anchor_y,
            reference: round_half_up(plane.numerator_at(anchor_x, anchor_y) * (1 << fraction), plane.d),
            step_x: gradient(plane.a),
            step_y: gradient(plane.b),
            least: plane.least,
            greatest: plane.greatest,
            fraction,
        })
    }

    /// Z at pixel `(i, j)`, in 2^-F steps, before the last rounding and the limits; never wrapped.
    #[must_use]
    pub fn interpolated(&self, i: i32, j: i32) -> i128 {
        self.reference
            + (i128::from(i) - i128::from(self.anchor_x)) * self.step_x
            + (i128::from(j) - i128::from(self.anchor_y)) * self.step_y
    }

    /// The depth that the card stores at pixel `(i, j)`.
    #[must_use]
    pub fn stored(&self, i: i32, j: i32) -> u32 {
        let rounded = round_half_up(self.interpolated(i, j), 1 << self.fraction);
        rounded.clamp(self.least.into(), self.greatest.into()) as u32
    }

    /// The depths that the card stores on a run of row `j`: [`PrescribedDepth::along_at`] the centres.
    #[must_use]
    pub fn along(&self, run: Range<u32>, j: u32) -> Along {
        self.along_at(run, j, [128, 128])
    }

    /// The depths that the card gives to a sample of each pixel of a run of row `j`; the sample lies `at` in 1/256 pixel
    /// from the pixels' upper left corners.
    ///
    /// Along a row the depth is a sum of equal steps. It lies between its values at the run's ends: where those are far
    /// from the limits of 64 bits, so is everything between.
    #[must_use]
    pub fn along_at(&self, run: Range<u32>, j: u32, at: [u32; 2]) -> Along {
        let j = j as i32;
        let sum = |i: u32| i64::try_from(self.interpolated_in(i as i32, j, at)).ok().filter(|z| z.abs() < 1 << 61);
        match (sum(run.start), run.end.checked_sub(1).and_then(sum)) {
            (Some(first), Some(_)) => Along::Narrow(Sums {
                first: first + if self.fraction == 0 { 0 } else { 128 << self.fraction },
                // A step that does not fit is never taken: the run is one pixel.
                step: i64::try_from(256 * self.step_x).unwrap_or_default(),
                count: run.len() as u32,
                shift: self.fraction + 8,
                limits: [self.least.into(), self.greatest.into()],
            }),
            _ => Along::Wide(run.map(|i| self.stored_in(i as i32, j, at)).collect()),
        }
    }

    /// The depth at a sample of pixel `(i, j)` that lies `(u, v)` in 1/256 pixel from the pixel's upper left corner,
    /// before the last rounding and the limits: in 2^-F steps, times 256.
    #[must_use]
    pub fn interpolated_in(&self, i: i32, j: i32, [u, v]: [u32; 2]) -> i128 {
        let from_centre = |offset: u32| i128::from(offset) - 128;
        256 * self.interpolated(i, j) + from_centre(u) * self.step_x + from_centre(v) * self.step_y
    }

    /// The depth that the card gives to that sample: half a step is added, then the fraction dropped. Without fraction
    /// bits (F = 0) there is no half step in the card's words, so nothing is added.
    #[must_use]
    pub fn stored_in(&self, i: i32, j: i32, at: [u32; 2]) -> u32 {
        let half = if self.fraction == 0 { 0 } else { 1 << (self.fraction - 1) };
        let step: i128 = 256 << self.fraction;
        let z = (self.interpolated_in(i, j, at) + 256 * half).div_euclid(step);
        z.clamp(self.least.into(), self.greatest.into()) as u32
    }

    /// Bound on `|interpolated * 2^-F - true depth|` at pixel `(i, j)` of a triangle, in steps:
    /// `(|i - anchor_x| + |j - anchor_y| + 1) 2^-(F+1)`. The stored depth is at most 1/2 farther off.
    #[must_use]
    pub fn error_bound(&self, i: i32, j: i32) -> BigRational {
        let across = (i128::from(i) - i128::from(self.anchor_x)).abs();
        let down = (i128::from(j) - i128::from(self.anchor_y)).abs();
        integer(across + down + 1) / integer(BigInt::from(2u32) << self.fraction)
    }
}

/// The stored depths of a run of pixels, from left to right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Along {
    /// Sums in 64 bits.
    Narrow(Sums),
    /// Depth by depth.
    Wide(Vec<u32>),
}

/// Equal steps in 64 bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sums {
    /// In 2^-(F + 8) steps, with the half that makes dropping the fraction a rounding.
    first: i64,
    step: i64,
    count: u32,
    shift: u32,
    limits: [i64; 2],
}

impl Along {
    /// The depth of the `k`-th pixel of the run.
    #[must_use]
    pub fn at(&self, k: u32) -> u32 {
        match self {
            Self::Narrow(sums) => sums.at(k),
            Self::Wide(depths) => depths[k as usize],
        }
    }
}

impl Sums {
    /// The depth of the `k`-th pixel of the run.
    #[must_use]
    fn at(&self, k: u32) -> u32 {
        let [least, greatest] = self.limits;
        ((self.first + i64::from(k) * self.step) >> self.shift).clamp(least, greatest) as u32
    }

    /// The depths of the run.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        (0..self.count).map(|k| self.at(k))
    }
}

#[cfg(test)]
#[path = "depth_tests.rs"]
mod tests;
