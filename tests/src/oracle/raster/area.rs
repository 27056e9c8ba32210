//! How much of a pixel a triangle covers, exactly: the measure that every mask grid approximates.
//!
//! The triangle is cut along the four sides of the pixel (Sutherland and Hodgman 1974) in rationals, and the area of
//! what is left is summed by the shoelace formula.

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::super::Vertex;
use super::super::exact::{integer, ratio};

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
    fn pixel_area_area_zero_is_zero() {
        assert_eq!(pixel_area(&triangle([(0, 0), (100, 100), (200, 200)]), 0, 0), BigRational::zero());
    }

    proptest! {
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
