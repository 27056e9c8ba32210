//! How much of a pixel a triangle covers, exactly: the measure that every mask grid approximates.
//!
//! The triangle is cut along the four sides of the pixel (Sutherland and Hodgman 1974) in rationals, and the area of
//! what is left is summed by the shoelace formula.

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::super::Vertex;
use super::super::exact::{Fraction, integer, ratio};

/// A point with rational coordinates; the unit is the caller's.
pub type ExactPoint = [BigRational; 2];

/// The covered part of pixel `(i, j)`, `0..=1`.
#[must_use]
pub fn pixel_area(triangle: &[Vertex; 3], i: i32, j: i32) -> BigRational {
    let [left, top] = [i, j].map(|pixel| i128::from(pixel) * 256);
    rectangle_area(triangle, [left, top], [left + 256, top + 256]) / integer(256 * 256)
}

/// The area in u^2 that the triangle shares with the rectangle between two corners, in u.
#[must_use]
pub fn rectangle_area(triangle: &[Vertex; 3], least: [i128; 2], greatest: [i128; 2]) -> BigRational {
    let mut polygon: Vec<ExactPoint> = triangle.iter().map(|v| [integer(v.x), integer(v.y)]).collect();
    for axis in [0, 1] {
        let low = integer(least[axis]);
        let high = integer(greatest[axis]);
        polygon = cut(&polygon, |p| &p[axis] - &low);
        polygon = cut(&polygon, |p| &high - &p[axis]);
    }
    signed_area(&polygon).abs()
}

/// The part of the pixel with its upper left corner at (0, 0) where `a x + b y + c >= 0` (x and y in u), `0..=1`.
///
/// Turned so that a and b are positive, the line cuts a right triangle with legs t/a and t/b off the quadrant, of which
/// the corners beyond the pixel's sides, again right triangles, are taken away: no polygon, only squares.
///
/// # Panics
/// When a and b are both 0.
#[must_use]
pub fn half_plane_area(a: i64, b: i64, c: i64) -> Fraction {
    assert!(a != 0 || b != 0, "a half-plane has a direction");
    let [a, b, c] = [a, b, c].map(i128::from);
    // Along an axis on which the function falls, the pixel is read from the other side.
    let from = c + 256 * (a.min(0) + b.min(0));
    let (a, b) = (256 * a.abs(), 256 * b.abs());
    // The function is `from` in the least corner; what is below 0 is left out: legs of -from.
    let t = -from;
    let square = |value: i128| value.max(0) * value.max(0);
    let (outside, whole) = if a == 0 || b == 0 {
        (t.clamp(0, a + b), a + b)
    } else {
        (square(t) - square(t - a) - square(t - b) + square(t - a - b), 2 * a * b)
    };
    Fraction::new(whole - outside, whole)
}

/// The part of a convex polygon, in any number of dimensions, where the linear function `side` is not negative.
#[must_use]
pub fn cut<const N: usize>(
    polygon: &[[BigRational; N]],
    side: impl Fn(&[BigRational; N]) -> BigRational,
) -> Vec<[BigRational; N]> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, point) in polygon.iter().enumerate() {
        let next = &polygon[(k + 1) % polygon.len()];
        let (here, there) = (side(point), side(next));
        if !here.is_negative() {
            kept.push(point.clone());
        }
        if (here.is_negative() && there.is_positive()) || (here.is_positive() && there.is_negative()) {
            let t = &here / (&here - &there);
            kept.push(std::array::from_fn(|axis| &point[axis] + &t * (&next[axis] - &point[axis])));
        }
    }
    kept
}

/// The area of a polygon; positive when its corners run clockwise on the screen (y down).
#[must_use]
pub fn signed_area(polygon: &[ExactPoint]) -> BigRational {
    let mut twice = BigRational::zero();
    for (k, [x, y]) in polygon.iter().enumerate() {
        let [next_x, next_y] = &polygon[(k + 1) % polygon.len()];
        twice += x * next_y - next_x * y;
    }
    twice * ratio(1, 2)
}

#[cfg(test)]
mod tests {
    use super::super::triangle::{triangle_covers_at, twice_area};
    use super::*;
    use proptest::prelude::*;

    fn triangle(points: [(i32, i32); 3]) -> [Vertex; 3] {
        points.map(|(x, y)| Vertex::at(x, y, 0))
    }

    #[test]
    fn pixel_area_known_shapes_are_exact() {
        let diagonal = triangle([(0, 0), (256, 0), (0, 256)]);
        let wide = triangle([(-1024, -1024), (4096, -1024), (-1024, 4096)]);
        let wedge = triangle([(0, 0), (768, 0), (0, 256)]);

        assert_eq!(pixel_area(&diagonal, 0, 0), ratio(1, 2));
        assert_eq!(pixel_area(&diagonal, 1, 0), BigRational::zero());
        assert_eq!(pixel_area(&wide, 0, 0), integer(1));
        assert_eq!([0, 1, 2].map(|i| pixel_area(&wedge, i, 0)), [ratio(5, 6), ratio(1, 2), ratio(1, 6)]);
    }

    #[test]
    fn half_plane_area_known_lines_are_exact() {
        // x >= 64; y <= 64; x + y <= 256; x - y >= 128; nothing; all.
        let lines = [(1, 0, -64), (0, -1, 64), (-1, -1, 256), (1, -1, -128), (1, 1, -512), (3, -1, 256)];

        let areas = lines.map(|(a, b, c)| half_plane_area(a, b, c).to_rational());

        assert_eq!(areas, [ratio(3, 4), ratio(1, 4), ratio(1, 2), ratio(1, 8), ratio(0, 1), ratio(1, 1)]);
    }

    #[test]
    fn pixel_area_area_zero_is_zero() {
        assert_eq!(pixel_area(&triangle([(0, 0), (100, 100), (200, 200)]), 0, 0), BigRational::zero());
    }

    proptest! {
        #[test]
        fn half_plane_area_any_line_equals_the_cut_square(a in -99i64..99, b in -99i64..99, c in -40_000i64..40_000) {
            prop_assume!(a != 0 || b != 0);
            let corners = [(0, 0), (256, 0), (256, 256), (0, 256)].map(|(x, y)| [integer(x), integer(y)]);

            let kept = cut(&corners, |[x, y]| integer(a) * x + integer(b) * y + integer(c));

            prop_assert_eq!(half_plane_area(a, b, c).to_rational(), signed_area(&kept).abs() / integer(256 * 256));
        }

        #[test]
        fn pixel_area_summed_over_pixels_is_the_triangles_area(xy in prop::array::uniform6(0i32..1024)) {
            let t = triangle([(xy[0], xy[1]), (xy[2], xy[3]), (xy[4], xy[5])]);

            let sum: BigRational = (0..16).map(|k| pixel_area(&t, k % 4, k / 4)).sum();

            prop_assert_eq!(sum * integer(2 * 256 * 256), integer(twice_area(&t).abs()));
        }

        #[test]
        fn pixel_area_is_near_the_share_of_covered_samples(xy in prop::array::uniform6(-256i32..512)) {
            let t = triangle([(xy[0], xy[1]), (xy[2], xy[3]), (xy[4], xy[5])]);

            let covered = (0..1024).filter(|k| triangle_covers_at(&t, k % 32 * 8 + 4, k / 32 * 8 + 4, 1)).count();

            // Three edges, each crossing at most 63 of the 1024 cells.
            let error = (pixel_area(&t, 0, 0) - ratio(covered as i128, 1024)).abs();
            prop_assert!(error <= ratio(3 * 63, 1024), "{}", error);
        }
    }
}
