//! The unsnapped truth of a homogeneous triangle: transformed, clipped and divided in rationals.
//!
//! The triangle is cut in homogeneous space (Blinn and Newell 1978, "Clipping using homogeneous coordinates";
//! Sutherland and Hodgman 1974) against `w >= 0`, the near plane `z >= 0`, the far plane `z <= w` when asked for, and
//! the guard band, then divided. The guard band makes the result finite: inside it w = 0 leaves only the eye itself,
//! whose two neighbours already carry its edges to the screen, so that corner is left out.
//!
//! Screen coordinates are in pixels here, y down, pixel `(i, j)` with its centre at `(i + 1/2, j + 1/2)`.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::exact::{from_card_f32, from_f64, integer, ratio, round_ties_even};
use super::raster::area::{ExactPoint, cut, signed_area};

/// x, y, z, w before the divide; depth is z/w, `0` near to `1` far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Homogeneous(pub [BigRational; 4]);

impl Homogeneous {
    /// Exactly these numbers; `None` for a NaN or an infinity.
    #[must_use]
    pub fn from_f64(xyzw: [f64; 4]) -> Option<Self> {
        let [x, y, z, w] = xyzw.map(from_f64);
        Some(Self([x?, y?, z?, w?]))
    }

    /// These numbers as the card reads them: denormals are 0, infinities the largest finite numbers. `None` for a NaN,
    /// which discards the primitive.
    #[must_use]
    pub fn from_f32(xyzw: [f32; 4]) -> Option<Self> {
        let [x, y, z, w] = xyzw.map(from_card_f32);
        Some(Self([x?, y?, z?, w?]))
    }

    /// Row vector times matrix, without rounding. `None` for a NaN in the matrix.
    #[must_use]
    pub fn transformed(&self, matrix: &[[f32; 4]; 4]) -> Option<Self> {
        let mut product: [BigRational; 4] = Default::default();
        for (value, row) in self.0.iter().zip(matrix) {
            for (sum, factor) in product.iter_mut().zip(row) {
                *sum += value * from_card_f32(*factor)?;
            }
        }
        Some(Self(product))
    }
}

/// The way from clip coordinates to pixels: `px = scale x / w + offset`, and what is cut away.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct View {
    /// Pixels for a unit of x/w and of y/w.
    pub scale: [BigRational; 2],
    /// Pixels at x/w = 0 and y/w = 0.
    pub offset: [BigRational; 2],
    /// Least and greatest x and y in pixels that survive.
    pub guard: [[BigRational; 2]; 2],
    /// Whether to cut at the far plane, z <= w, too.
    pub far: bool,
}

impl View {
    /// x/w and y/w from -1 to 1 across a target of `width` x `height` pixels, y down; the guard band reaches 32768 px
    /// from pixel corner (0, 0), the range of the card's coordinates.
    #[must_use]
    pub fn normalised(width: u32, height: u32) -> Self {
        let half = [width, height].map(|size| ratio(size.into(), 2));
        Self { scale: half.clone(), offset: half, ..Self::pixels() }
    }

    /// x/w and y/w are pixels already; the guard band as in [`View::normalised`].
    #[must_use]
    pub fn pixels() -> Self {
        let band = || [integer(-32768), integer(32768)];
        Self { scale: [integer(1), integer(1)], offset: [integer(0), integer(0)], guard: [band(), band()], far: false }
    }

    /// The same with a guard band of `reach` pixels to all sides of a centre, in pixels.
    #[must_use]
    pub fn guarded(self, centre: [BigRational; 2], reach: &BigRational) -> Self {
        Self { guard: centre.map(|middle| [&middle - reach, &middle + reach]), ..self }
    }
}

/// A corner of the clipped polygon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Corner {
    /// x and y in pixels.
    pub position: ExactPoint,
    /// z/w.
    pub depth: BigRational,
    /// 1/w.
    pub inverse_w: BigRational,
    /// What part of each vertex of the triangle is in this corner, before the divide: attributes are these sums.
    pub weights: [BigRational; 3],
}

/// A convex polygon on the screen, the exact image of a triangle. Empty when nothing is left.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExactPolygon {
    /// In the order of the triangle's vertices, so a mirrored triangle runs the other way.
    pub corners: Vec<Corner>,
}

/// Clips a triangle and divides by w.
#[must_use]
pub fn clip(triangle: &[Homogeneous; 3], view: &View) -> ExactPolygon {
    // x, y, z, w and the weights are all linear before the divide, so they are cut together.
    let mut polygon: Vec<[BigRational; 7]> = (0..3)
        .map(|k| {
            let [x, y, z, w] = triangle[k].0.clone();
            let [a, b, c] = [0, 1, 2].map(|of| if of == k { BigRational::one() } else { BigRational::zero() });
            [x, y, z, w, a, b, c]
        })
        .collect();
    polygon = cut(&polygon, |v| v[3].clone());
    polygon = cut(&polygon, |v| v[2].clone());
    if view.far {
        polygon = cut(&polygon, |v| &v[3] - &v[2]);
    }
    for axis in [0, 1] {
        let [least, greatest] = &view.guard[axis];
        let (scale, offset) = (&view.scale[axis], &view.offset[axis]);
        polygon = cut(&polygon, |v| scale * &v[axis] + (offset - least) * &v[3]);
        polygon = cut(&polygon, |v| (greatest - offset) * &v[3] - scale * &v[axis]);
    }
    let corners = polygon.into_iter().filter(|v| v[3].is_positive()).map(|[x, y, z, w, a, b, c]| Corner {
        position: [&view.scale[0] * x / &w + &view.offset[0], &view.scale[1] * y / &w + &view.offset[1]],
        depth: z / &w,
        inverse_w: w.recip(),
        weights: [a, b, c],
    });
    ExactPolygon { corners: corners.collect() }
}

impl ExactPolygon {
    /// The corners' positions, in pixels.
    #[must_use]
    pub fn outline(&self) -> Vec<ExactPoint> {
        self.corners.iter().map(|corner| corner.position.clone()).collect()
    }

    /// Whether the polygon covers the centre of pixel `(i, j)` under the top-left rule, with nothing snapped.
    #[must_use]
    pub fn covers(&self, i: i32, j: i32) -> bool {
        self.covers_at(&[i, j].map(|pixel| integer(pixel) + ratio(1, 2)))
    }

    /// Whether the polygon covers a point, in pixels, under the top-left rule.
    #[must_use]
    pub fn covers_at(&self, point: &ExactPoint) -> bool {
        covers_outline(&self.outline(), point, |e, dx, dy| {
            e.is_positive() || (e.is_zero() && (dy.is_negative() || (dy.is_zero() && dx.is_positive())))
        })
    }

    /// Calls `visit(i, j)` for each pixel of a `width` x `height` target that [`ExactPolygon::covers`], row by row.
    /// The edges are brought to integers first, which is faster than asking for each pixel.
    pub fn for_each_pixel(&self, width: u32, height: u32, mut visit: impl FnMut(u32, u32)) {
        let outline = self.outline();
        let turn = signed_area(&outline).signum();
        if turn.is_zero() {
            return;
        }
        let edges: Vec<IntegerEdge> = sides(&outline)
            .filter(|(from, to)| from != to)
            .map(|(from, to)| IntegerEdge::between(from, to, &turn))
            .collect();
        let (columns, rows) = (touched(&outline, 0, width), touched(&outline, 1, height));
        for (j, i) in rows.flat_map(|j| columns.clone().map(move |i| (j, i))) {
            if edges.iter().all(|edge| edge.admits(i, j)) {
                visit(i, j);
            }
        }
    }

    /// The square of the Hausdorff distance, in u^2, between this polygon and a convex outline of the card's, in u.
    /// No point of either outline is farther than that from the other: edges lie within 1 u when it is at most 1.
    /// `None` when either is empty.
    #[must_use]
    pub fn distance_squared(&self, outline: &[(i32, i32)]) -> Option<BigRational> {
        let exact: Vec<ExactPoint> =
            self.outline().iter().map(|p| [0, 1].map(|axis| &p[axis] * integer(256))).collect();
        let card: Vec<ExactPoint> = outline.iter().map(|&(x, y)| [integer(x), integer(y)]).collect();
        // The distance to a convex set is convex: its maximum over a polygon is at a corner.
        let farthest = |from: &[ExactPoint], to: &[ExactPoint]| from.iter().filter_map(|p| distance_to(to, p)).max();
        Some(farthest(&exact, &card)?.max(farthest(&card, &exact)?))
    }
}

/// `a (2 i + 1) + b (2 j + 1) + c` at the centre of pixel `(i, j)`, positive inside.
struct IntegerEdge {
    a: BigInt,
    b: BigInt,
    c: BigInt,
    /// Left or top.
    closed: bool,
}

impl IntegerEdge {
    fn between(from: &ExactPoint, to: &ExactPoint, turn: &BigRational) -> Self {
        let dx = (&to[0] - &from[0]) * turn;
        let dy = (&to[1] - &from[1]) * turn;
        let c = (&dy * &from[0] - &dx * &from[1]) * integer(2);
        let scale = dx.denom() * dy.denom() * c.denom();
        let whole = |value: &BigRational| value.numer() * (&scale / value.denom());
        Self {
            a: -whole(&dy),
            b: whole(&dx),
            c: whole(&c),
            closed: dy.is_negative() || (dy.is_zero() && dx.is_positive()),
        }
    }

    fn admits(&self, i: u32, j: u32) -> bool {
        let e = &self.a * (2 * u64::from(i) + 1) + &self.b * (2 * u64::from(j) + 1) + &self.c;
        e.is_positive() || (e.is_zero() && self.closed)
    }
}

/// The pixels of one axis, clipped to `0..size`, that the outline can touch.
fn touched(outline: &[ExactPoint], axis: usize, size: u32) -> std::ops::Range<u32> {
    let clip = |pixel: BigRational| pixel.to_integer().clamp(0.into(), size.into()).to_u32().unwrap_or(0);
    let least = outline.iter().map(|p| p[axis].floor()).min();
    let greatest = outline.iter().map(|p| p[axis].ceil()).max();
    least.map_or(0, clip)..greatest.map_or(0, clip)
}

/// The sides of a closed outline, from and to.
fn sides(outline: &[ExactPoint]) -> impl Iterator<Item = (&ExactPoint, &ExactPoint)> {
    (0..outline.len()).map(|k| (&outline[k], &outline[(k + 1) % outline.len()]))
}

/// Whether `admits(e, dx, dy)` holds at every edge of a convex outline with an area, e positive inside and the edge
/// running along (dx, dy) with the inside below a rightward edge.
fn covers_outline(
    outline: &[ExactPoint],
    point: &ExactPoint,
    admits: impl Fn(&BigRational, &BigRational, &BigRational) -> bool,
) -> bool {
    let turn = signed_area(outline).signum();
    !turn.is_zero()
        && sides(outline).filter(|(from, to)| from != to).all(|(from, to)| {
            let dx = (&to[0] - &from[0]) * &turn;
            let dy = (&to[1] - &from[1]) * &turn;
            let e = &dx * (&point[1] - &from[1]) - &dy * (&point[0] - &from[0]);
            admits(&e, &dx, &dy)
        })
}

/// The square of the distance from a point to a filled convex polygon; `None` for no polygon.
fn distance_to(polygon: &[ExactPoint], point: &ExactPoint) -> Option<BigRational> {
    if covers_outline(polygon, point, |e, _, _| !e.is_negative()) {
        return Some(BigRational::zero());
    }
    sides(polygon).map(|(from, to)| distance_to_segment(from, to, point)).min()
}

fn distance_to_segment(from: &ExactPoint, to: &ExactPoint, point: &ExactPoint) -> BigRational {
    let along = [0, 1].map(|axis| &to[axis] - &from[axis]);
    let offset = [0, 1].map(|axis| &point[axis] - &from[axis]);
    let dot = |a: &ExactPoint, b: &ExactPoint| &a[0] * &b[0] + &a[1] * &b[1];
    let length = dot(&along, &along);
    let t = if length.is_zero() {
        BigRational::zero()
    } else {
        (dot(&offset, &along) / length).clamp(BigRational::zero(), BigRational::one())
    };
    let rest = [0, 1].map(|axis| &offset[axis] - &along[axis] * &t);
    dot(&rest, &rest)
}

/// The snap: pixels to u, `subpixel_bits` (4 or 8) of them kept, ties to even. `None` beyond `i32`.
#[must_use]
pub fn snap(pixels: &BigRational, subpixel_bits: u32) -> Option<i32> {
    let units: BigInt = round_ties_even(&(pixels * integer(BigInt::one() << subpixel_bits)));
    (units << (8 - subpixel_bits)).to_i32()
}

/// The stored depth of an exact z/w: `floor(d (2^n - 1) + 1/2)`, limited to `0..=2^n - 1`.
#[must_use]
pub fn stored_depth(depth: &BigRational, bits: u32) -> u32 {
    let greatest: BigInt = (BigInt::one() << bits) - 1;
    let rounded = (depth * integer(greatest.clone()) + ratio(1, 2)).floor().to_integer();
    rounded.clamp(BigInt::zero(), greatest).to_u32().unwrap_or(u32::MAX)
}

#[cfg(test)]
#[path = "clip_tests.rs"]
mod tests;
