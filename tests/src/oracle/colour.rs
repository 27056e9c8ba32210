//! Exact colours at a pixel's centre, before any rounding, on the scale of the vertices (`0..=255`).
//!
//! Affine: barycentric weights of the snapped triangle; along the major axis for a line, limited to its ends as its
//! depth is. Perspective-correct (Blinn 1992, "Hyperbolic interpolation"): c/w and 1/w are affine on the screen.

use num_rational::BigRational;
use num_traits::Zero;

use super::exact::{integer, ratio};
use super::raster::line::is_x_major;
use super::raster::triangle::twice_area;
use super::{Primitive, Vertex};

/// Red, green, blue, alpha.
pub type ExactColour = [BigRational; 4];

/// The affine weights of a triangle's vertices at the centre of pixel `(i, j)`; they sum to 1 and none is negative in
/// the triangle. `None` for area 0.
#[must_use]
pub fn triangle_weights(triangle: &[Vertex; 3], i: i32, j: i32) -> Option<[BigRational; 3]> {
    let whole = twice_area(triangle);
    let [px, py] = [i, j].map(|pixel| i128::from(pixel) * 256 + 128);
    // Twice the area of the part opposite to each vertex.
    let part = |k: usize| {
        let (p, q) = (&triangle[(k + 1) % 3], &triangle[(k + 2) % 3]);
        let [ax, ay, bx, by] = [p.x, p.y, q.x, q.y].map(i128::from);
        (ax - px) * (by - py) - (bx - px) * (ay - py)
    };
    (whole != 0).then(|| [0, 1, 2].map(|k| ratio(part(k), whole)))
}

/// The weights of a line's ends at pixel `(i, j)`. `None` for length 0.
#[must_use]
pub fn line_weights(line: &[Vertex; 2], i: i32, j: i32) -> Option<[BigRational; 2]> {
    let x_major = is_x_major(line);
    let [from, to] = line.map(|v| i128::from(if x_major { v.x } else { v.y }));
    let centre = i128::from(if x_major { i } else { j }) * 256 + 128;
    (from != to).then(|| {
        let second = ratio(centre - from, to - from).clamp(integer(0), integer(1));
        [integer(1) - &second, second]
    })
}

/// The affine colour of a primitive at the centre of pixel `(i, j)`. `None` for area 0 and length 0.
#[must_use]
pub fn affine(primitive: &Primitive, i: i32, j: i32) -> Option<ExactColour> {
    Some(match primitive {
        Primitive::Triangle(vertices) => blend(vertices, &triangle_weights(vertices, i, j)?),
        Primitive::Line(vertices) => blend(vertices, &line_weights(vertices, i, j)?),
        Primitive::Point(vertex) => vertex.colour.map(integer),
    })
}

/// The perspective-correct colour of a triangle at the centre of pixel `(i, j)`, where `w` are the vertices' w,
/// positive. `None` for area 0, or for a pixel outside the triangle where the plane's 1/w is 0.
#[must_use]
pub fn perspective(triangle: &[Vertex; 3], w: &[BigRational; 3], i: i32, j: i32) -> Option<ExactColour> {
    let weights = perspective_weights(&triangle_weights(triangle, i, j)?, w)?;
    Some(blend(triangle, &weights))
}

/// Screen weights turned into weights of the surface: each divided by its w, then made to sum to 1. `None` when 1/w
/// vanishes.
#[must_use]
pub fn perspective_weights(screen: &[BigRational; 3], w: &[BigRational; 3]) -> Option<[BigRational; 3]> {
    let parts = [0, 1, 2].map(|k| &screen[k] / &w[k]);
    let sum: BigRational = parts.iter().sum();
    (!sum.is_zero()).then(|| parts.map(|part| part / &sum))
}

fn blend(vertices: &[Vertex], weights: &[BigRational]) -> ExactColour {
    [0, 1, 2, 3].map(|channel| {
        vertices.iter().zip(weights).map(|(vertex, weight)| weight * integer(vertex.colour[channel])).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::super::exact::from_f64;
    use super::super::raster::triangle_covers;
    use super::*;
    use num_traits::Signed;
    use proptest::prelude::*;

    fn corners() -> [Vertex; 3] {
        [
            Vertex::at(128, 128, 0).coloured([255, 0, 0, 40]),
            Vertex::at(1152, 128, 0).coloured([0, 255, 0, 40]),
            Vertex::at(128, 1152, 0).coloured([0, 0, 255, 40]),
        ]
    }

    #[test]
    fn affine_at_vertices_and_between_is_exact() {
        let primitive = Primitive::Triangle(corners());

        assert_eq!(affine(&primitive, 0, 0), Some([255, 0, 0, 40].map(integer)));
        assert_eq!(affine(&primitive, 1, 1), Some([ratio(255, 2), ratio(255, 4), ratio(255, 4), integer(40)]));
    }

    #[test]
    fn perspective_equal_w_is_affine() {
        let w = [3, 3, 3].map(integer);

        assert_eq!(perspective(&corners(), &w, 1, 2), affine(&Primitive::Triangle(corners()), 1, 2));
    }

    #[test]
    fn perspective_far_vertex_counts_less() {
        let w = [1, 3, 1].map(integer);

        let colour = perspective(&corners(), &w, 2, 0).unwrap();

        // Half way on the screen between w = 1 and w = 3: 3/4 of the near one.
        assert_eq!(colour[..2], [ratio(3 * 255, 4), ratio(255, 4)]);
    }

    #[test]
    fn affine_line_is_linear_and_limited() {
        let line = Primitive::Line([
            Vertex::at(200, 128, 0).coloured([0, 100, 0, 255]),
            Vertex::at(712, 300, 0).coloured([200, 0, 0, 255]),
        ]);
        let red = |i| affine(&line, i, 0).unwrap()[0].clone();

        assert_eq!([red(0), red(1), red(3)], [integer(0), ratio(184 * 200, 512), integer(200)]);
    }

    #[test]
    fn affine_nothing_to_draw_is_none() {
        let [a, b, _] = corners();

        assert_eq!(affine(&Primitive::Triangle([a, b, b]), 0, 0), None);
        assert_eq!(affine(&Primitive::Line([a, a]), 0, 0), None);
        assert_eq!(affine(&Primitive::Point(a), 7, 7), Some(a.colour.map(integer)));
    }

    proptest! {
        #[test]
        fn triangle_weights_covered_pixels_are_means(
            xy in prop::array::uniform6(0i32..2048), w in prop::array::uniform3(0.1f64..4.0),
        ) {
            let triangle = [0, 2, 4].map(|k| Vertex::at(xy[k], xy[k + 1], 0));
            let w = w.map(|w| from_f64(w).unwrap());

            for (i, j) in (0..64).map(|k| (k % 8, k / 8)).filter(|&(i, j)| triangle_covers(&triangle, i, j)) {
                let weights = triangle_weights(&triangle, i, j).unwrap();
                let position: BigRational = (0..3).map(|k| &weights[k] * integer(triangle[k].x)).sum();
                let surface = perspective_weights(&weights, &w).unwrap();
                prop_assert_eq!(position, integer(256 * i + 128));
                prop_assert_eq!(surface.iter().sum::<BigRational>(), integer(1));
                prop_assert!(weights.iter().chain(&surface).all(|weight| !weight.is_negative()));
            }
        }
    }
}
