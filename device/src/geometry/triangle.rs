//! Triangle set-up: edges that are walked row by row.
//!
//! On a row whose centre lies between a triangle's top and bottom exactly one left and one right
//! edge are met; the covered pixels are x_left <= x < x_right, both rounded up to a pixel centre.
//! That is the top-left rule: a centre on a left or top edge is in, on a right or bottom edge out.
//!
//! An edge's crossing is a fraction with denominator dy <= 2^24. It is walked in fixed point with
//! [`WALK`] fraction bits, rounded up: start and step are too large by 1/2 to 4 units of 2^-43, so
//! that after 2^16 rows the error is below 2^-24 <= 1/dy and the integer part is still exact. One addition and one shift a row replace the edge functions, bit for bit.

use super::plane::DepthPlane;
use super::{CENTRE, PIXEL, ScreenVertex};
use zga_abi::format::DepthFormat;

/// Fraction bits of a walked edge.
pub const WALK: u32 = 43;

/// An edge on its way down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// First column right of the edge on its first row; s20.43, pixels, the integer part is exact.
    pub x: i64,
    /// Change a row.
    pub step: i64,
}

/// A triangle ready to be walked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    /// First row, first row of the lower part, first row beyond; pixels.
    pub rows: [i32; 3],
    /// The edge from top to bottom vertex, starting on `rows[0]`.
    pub long: Edge,
    /// The two edges on the other side, starting on `rows[0]` and `rows[1]`.
    pub short: [Edge; 2],
    /// Depth.
    pub plane: DepthPlane,
    /// The gradients of `plane` mean nothing but at covered pixels: they are large, or have wrapped.
    pub steep: bool,
}

impl Triangle {
    /// Sets a triangle up, and tells its first column and the first beyond; `None` if it lies between
    /// pixel centres or has no area.
    #[must_use]
    #[inline(always)]
    pub fn new(v: &[ScreenVertex; 3], format: DepthFormat) -> Option<(Triangle, [i32; 2])> {
        // Sorted by places, which compile to selections: no predictor knows the order.
        let [a, b, c] = [v[0].y, v[1].y, v[2].y];
        let (low, high) = if b < a { (1, 0) } else { (0, 1) };
        let top = if c < v[low].y { 2 } else { low };
        let bottom = if c < v[high].y { high } else { 2 };
        let (top, middle, bottom) = (&v[top], &v[3 - top - bottom], &v[bottom]);
        let rows = [first_centre(top.y), first_centre(middle.y), first_centre(bottom.y)];
        let columns = [first_centre(v[0].x.min(v[1].x).min(v[2].x)), first_centre(v[0].x.max(v[1].x).max(v[2].x))];
        if rows[0] == rows[2] || columns[0] == columns[1] {
            return None;
        }
        let area = doubled_area(&v[0], &v[1], &v[2]);
        if area == 0 {
            return None;
        }
        let (plane, steep) = DepthPlane::triangle(v, area, 1.0 / area as f64, format);
        let triangle = Triangle {
            rows,
            long: Edge::new(top, bottom, rows[0]),
            short: [Edge::new(top, middle, rows[0]), Edge::new(middle, bottom, rows[1])],
            plane,
            steep,
        };
        Some((triangle, columns))
    }

    /// The edges alone, on grids whose columns and rows are 2^pitch u apart, walked from row `top` on where the
    /// triangle begins above: so no walk is longer than the rows that are asked for. The planes are left empty. `None`
    /// if no row of a grid from its `top` on, or no column, is met. A grid is its pitches in x and y, and `top`.
    #[must_use]
    #[inline(always)]
    pub fn outlines<const N: usize>(v: &[ScreenVertex; 3], grids: [([u32; 2], i32); N]) -> [Option<Triangle>; N] {
        let sides = Sides::new(v);
        let mut outlines = [None; N];
        for (outline, (pitch, top)) in outlines.iter_mut().zip(grids) {
            *outline = sides.outline(pitch, top);
        }
        outlines
    }

    /// Columns covered on row `y`, `[first, beyond)`; `y` in `rows[0]..rows[2]`.
    #[must_use]
    #[inline(always)]
    pub fn span(&self, y: i32) -> [i32; 2] {
        let lower = usize::from(y >= self.rows[1]);
        let long = self.long.at(y - self.rows[0]);
        let short = self.short[lower].at(y - self.rows[lower]);
        // Rounding keeps the order of the crossings, so the smaller one is the left one.
        [long.min(short), long.max(short)]
    }
}

/// A triangle's vertices from top to bottom, and what its edges have on any grid.
struct Sides<'a> {
    vertices: [&'a ScreenVertex; 3],
    /// Least and greatest x.
    extent: [i32; 2],
    /// 1 / dy of the edges from top to bottom, to the middle, and from the middle to the bottom.
    inverse: [f64; 3],
    /// It has an area.
    open: bool,
}

impl<'a> Sides<'a> {
    #[inline(always)]
    fn new(v: &'a [ScreenVertex; 3]) -> Self {
        let [a, b, c] = [v[0].y, v[1].y, v[2].y];
        let (low, high) = if b < a { (1, 0) } else { (0, 1) };
        let above = if c < v[low].y { 2 } else { low };
        let below = if c < v[high].y { high } else { 2 };
        let vertices = [&v[above], &v[3 - above - below], &v[below]];
        let [above, middle, below] = vertices;
        Sides {
            vertices,
            extent: [v[0].x.min(v[1].x).min(v[2].x), v[0].x.max(v[1].x).max(v[2].x)],
            inverse: [inverse_of(above, below), inverse_of(above, middle), inverse_of(middle, below)],
            open: doubled_area(&v[0], &v[1], &v[2]) != 0,
        }
    }

    #[inline(always)]
    fn outline(&self, pitch: [u32; 2], top: i32) -> Option<Triangle> {
        let [above, middle, below] = self.vertices;
        let row = |y: i32| first_sample(y, pitch[1]).max(top);
        let rows = [row(above.y), row(middle.y), row(below.y)];
        let columns = [first_sample(self.extent[0], pitch[0]), first_sample(self.extent[1], pitch[0])];
        if rows[0] == rows[2] || columns[0] == columns[1] || !self.open {
            return None;
        }
        let [long, upper, lower] = self.inverse;
        Some(Triangle {
            rows,
            long: Edge::between(above, below, long, rows[0], pitch),
            short: [
                Edge::between(above, middle, upper, rows[0], pitch),
                Edge::between(middle, below, lower, rows[1], pitch),
            ],
            plane: DepthPlane::default(),
            steep: false,
        })
    }
}

/// 1 / dy of an edge from `a` down to `b`; of one that meets no row it means nothing.
#[inline(always)]
fn inverse_of(a: &ScreenVertex, b: &ScreenVertex) -> f64 {
    1.0 / (i64::from(b.y) - i64::from(a.y)).max(1) as f64
}

/// Twice the signed area in u^2: (b - a) x (c - a), y down.
#[must_use]
#[inline(always)]
pub fn doubled_area(a: &ScreenVertex, b: &ScreenVertex, c: &ScreenVertex) -> i64 {
    doubled_area_of([[a.x, a.y], [b.x, b.y], [c.x, c.y]])
}

/// The same of places in u.
#[inline(always)]
fn doubled_area_of([a, b, c]: [[i32; 2]; 3]) -> i64 {
    let [bx, by] = [0, 1].map(|axis| i64::from(b[axis]) - i64::from(a[axis]));
    let [cx, cy] = [0, 1].map(|axis| i64::from(c[axis]) - i64::from(a[axis]));
    bx * cy - by * cx
}

/// Whether vertices at these places, u, run counter-clockwise on the screen, where y goes down.
#[must_use]
#[inline(always)]
pub fn runs_counter_clockwise(places: [[i32; 2]; 3]) -> bool {
    doubled_area_of(places) < 0
}

/// First pixel whose centre is at or beyond `c` u.
#[must_use]
#[inline(always)]
pub fn first_centre(c: i32) -> i32 {
    (c + (PIXEL - 1 - CENTRE)) >> 8
}

/// First row or column of a grid with a pitch of 2^`pitch` u that is at or beyond `c` u.
#[must_use]
#[inline(always)]
pub fn first_sample(c: i32, pitch: u32) -> i32 {
    (c + (1 << (pitch - 1)) - 1) >> pitch
}

impl Edge {
    /// The edge from `a` down to `b`, starting on row `row`, the first whose centre is not above `a`.
    /// An edge that meets no row is never walked; what it holds then means nothing.
    #[inline(always)]
    fn new(a: &ScreenVertex, b: &ScreenVertex, row: i32) -> Edge {
        Edge::between(a, b, inverse_of(a, b), row, [PIXEL.ilog2(); 2])
    }

    /// The same on a grid whose columns and rows are 2^`pitch` u apart, rows as far as columns or farther, from any row
    /// that the edge meets on; `inverse` as [`inverse_of`] has it.
    #[inline(always)]
    fn between(a: &ScreenVertex, b: &ScreenVertex, inverse: f64, row: i32, pitch: [u32; 2]) -> Edge {
        let [across, down] = pitch.map(|log| 1_i64 << log);
        let (dx, dy) = (i64::from(b.x) - i64::from(a.x), (i64::from(b.y) - i64::from(a.y)).max(1));
        let below = i64::from(row) * down + down / 2 - i64::from(a.y);
        // ceil((x_crossing - across / 2) / across) = floor(n / dy) with n below; both floors nest.
        let n = (((i64::from(a.x) - across / 2) * dy + below * dx) + (across * dy - 1)) >> pitch[0];
        // From row to row n grows by a whole number, since rows are as far apart as columns or farther.
        let step = walked(dx << (pitch[1] - pitch[0]), dy, inverse);
        Edge { x: walked(n, dy, inverse), step }
    }

    /// Integer part after `rows` rows.
    #[must_use]
    #[inline(always)]
    pub fn at(self, rows: i32) -> i32 {
        (self.walk(rows) >> WALK) as i32
    }

    /// Value after `rows` rows.
    #[must_use]
    #[inline(always)]
    pub fn walk(self, rows: i32) -> i64 {
        self.x.wrapping_add(i64::from(rows).wrapping_mul(self.step))
    }
}

/// n / d in fixed point with [`WALK`] fraction bits, too large by 1/2 to 4 units: `inverse` = 1.0 / d
/// and its product err by less than 2^-8 units, the truncation by less than 1, 2 are added.
///
/// Quotients beyond 2^20 wrap; they belong to edges that are met by one row only, whose step is never
/// taken.
#[must_use]
#[inline(always)]
pub fn walked(n: i64, d: i64, inverse: f64) -> i64 {
    let whole = (n as f64 * inverse) as i64;
    let rest = n - whole * d;
    let fraction = (rest as f64 * inverse * (1_u64 << WALK) as f64) as i64 + 2;
    whole.wrapping_shl(WALK).wrapping_add(fraction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Coverage by edge functions and the top-left rule, as the rule is written.
    fn covers(v: &[ScreenVertex; 3], x: i32, y: i32) -> bool {
        covers_place(v, i128::from(x) * 256 + 128, i128::from(y) * 256 + 128)
    }

    /// The same for any place, in u.
    fn covers_place(v: &[ScreenVertex; 3], px: i128, py: i128) -> bool {
        let mut v = v.map(|v| (i128::from(v.x), i128::from(v.y)));
        let area = (v[1].0 - v[0].0) * (v[2].1 - v[0].1) - (v[1].1 - v[0].1) * (v[2].0 - v[0].0);
        if area == 0 {
            return false;
        }
        if area < 0 {
            v.swap(1, 2);
        }
        (0..3).all(|k| {
            let (a, b) = (v[k], v[(k + 1) % 3]);
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let e = dx * (py - a.1) - dy * (px - a.0);
            let top_left = dy < 0 || (dy == 0 && dx > 0);
            e > 0 || (e == 0 && top_left)
        })
    }

    fn vertex(range: i32) -> impl Strategy<Value = ScreenVertex> {
        (-range..=range, -range..=range, 0_u32..1 << 24).prop_map(|(x, y, z)| ScreenVertex {
            x,
            y,
            z,
            ..ScreenVertex::default()
        })
    }

    fn check(v: &[ScreenVertex; 3], rows: impl Iterator<Item = i32>) -> Result<(), TestCaseError> {
        let set = Triangle::new(v, DepthFormat::default()).map(|(t, _)| t);
        for y in rows {
            let span = set.filter(|t| (t.rows[0]..t.rows[2]).contains(&y)).map_or([0, 0], |t| t.span(y));
            // Both ends of the span, and both ends of the row's extent.
            let extent = v.map(|v| v.x >> 8);
            for x in [span[0] - 1, span[0], span[1] - 1, span[1], extent[0], extent[1], extent[2]] {
                prop_assert_eq!(
                    (span[0]..span[1]).contains(&x),
                    covers(v, x, y),
                    "pixel {} {} of {:?}, span {:?}",
                    x,
                    y,
                    v,
                    span
                );
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn triangle_small_equals_edge_functions(v in [vertex(2000), vertex(2000), vertex(2000)]) {
            check(&v, -9..9)?;
        }

        #[test]
        fn triangle_guard_band_equals_edge_functions(v in [vertex(1 << 23), vertex(1 << 23), vertex(1 << 23)], rows in proptest::collection::vec(-32_768_i32..32_768, 40)) {
            check(&v, rows.into_iter())?;
        }

        #[test]
        fn triangle_sliver_equals_edge_functions(a in vertex(1 << 23), b in vertex(1 << 23), t in 0.0_f64..1.0, d in -3..=3, rows in proptest::collection::vec(0.0_f64..1.0, 40)) {
            let mix = |a: i32, b: i32| (f64::from(a) + t * (f64::from(b) - f64::from(a))) as i32;
            let c = ScreenVertex { x: mix(a.x, b.x) + d, y: mix(a.y, b.y), ..a };
            let rows = rows.into_iter().map(|s| (f64::from(a.y) + s * (f64::from(b.y) - f64::from(a.y))) as i32 >> 8);
            check(&[a, b, c], rows)?;
        }

        #[test]
        fn outline_any_grid_and_top_equals_edge_functions(
            v in [vertex(1 << 12), vertex(1 << 12), vertex(1 << 12)],
            pitch in prop::sample::select(vec![[6, 6], [5, 6], [5, 5], [8, 8]]), top in -130_i32..130,
        ) {
            let [set, twice] = Triangle::outlines(&v, [(pitch, top); 2]);
            prop_assert_eq!(set, twice);
            let place = |c: i32, log: u32| i128::from(c) * (1 << log) + (1 << (log - 1));
            for y in top..top + 40 {
                let span = set.filter(|t| (t.rows[0]..t.rows[2]).contains(&y)).map_or([0, 0], |t| t.span(y));
                for x in [span[0] - 1, span[0], span[1] - 1, span[1], v[0].x >> pitch[0], v[1].x >> pitch[0]] {
                    let inside = covers_place(&v, place(x, pitch[0]), place(y, pitch[1]));
                    prop_assert_eq!((span[0]..span[1]).contains(&x), inside, "sample {} {}, span {:?}", x, y, span);
                }
            }
        }

        #[test]
        fn outline_guard_band_equals_edge_functions(v in [vertex(1 << 23), vertex(1 << 23), vertex(1 << 23)], top in -262_144_i32..262_144) {
            let [_, set] = Triangle::outlines(&v, [([8, 8], top >> 3), ([5, 5], top)]);
            for y in (top..top + 128).step_by(9) {
                let span = set.filter(|t| (t.rows[0]..t.rows[2]).contains(&y)).map_or([0, 0], |t| t.span(y));
                for x in [span[0] - 1, span[0], span[1] - 1, span[1]] {
                    let inside = covers_place(&v, i128::from(x) * 32 + 16, i128::from(y) * 32 + 16);
                    prop_assert_eq!((span[0]..span[1]).contains(&x), inside, "sample {} {}, span {:?}", x, y, span);
                }
            }
        }
    }
}
