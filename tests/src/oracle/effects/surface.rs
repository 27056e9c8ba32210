//! Attributes of a triangle at a pixel's centre, and how they change from there, in f64.
//!
//! The weights of the snapped vertices on the screen are quotients of integers, rounded once; a weight on the surface is
//! the screen's over w, made to sum to 1 (Blinn 1992, "Hyperbolic interpolation"). With w alike they are the screen's.

use super::super::Vertex;
use super::super::raster::triangle::twice_area;
use super::detail::Gradient;

/// A triangle with the reciprocals of its vertices' w.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    vertices: [Vertex; 3],
    inverse_w: [f64; 3],
    area: i128,
}

/// What part of each vertex is at a place, and how the parts change for a pixel to the right and a pixel down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// They sum to 1.
    pub weights: [f64; 3],
    /// They sum to 0.
    pub gradient: [[f64; 3]; 2],
}

impl Surface {
    /// `None` for area 0. All of `w` are positive.
    #[must_use]
    pub fn new(vertices: [Vertex; 3], w: [f64; 3]) -> Option<Self> {
        let area = twice_area(&vertices);
        (area != 0).then_some(Self { vertices, inverse_w: w.map(|w| 1.0 / w), area })
    }

    /// Twice the area of the part opposite to vertex k at the point (x, y), u.
    fn part(&self, k: usize, [x, y]: [i128; 2]) -> i128 {
        let (p, q) = (&self.vertices[(k + 1) % 3], &self.vertices[(k + 2) % 3]);
        let [ax, ay, bx, by] = [p.x, p.y, q.x, q.y].map(i128::from);
        (ax - x) * (by - y) - (bx - x) * (ay - y)
    }

    /// At the centre of pixel `(i, j)`.
    #[must_use]
    pub fn at(&self, i: i32, j: i32) -> Weights {
        let centre = [i, j].map(|pixel| i128::from(pixel) * 256 + 128);
        let next = [[centre[0] + 256, centre[1]], [centre[0], centre[1] + 256]];
        let over_area = |part: i128| part as f64 / self.area as f64;
        let screen = [0, 1, 2].map(|k| over_area(self.part(k, centre)) * self.inverse_w[k]);
        let sum: f64 = screen.iter().sum();
        let weights = screen.map(|part| part / sum);
        let gradient = next.map(|next| {
            // The screen's weights are linear: a pixel's difference is the derivative.
            let step = [0, 1, 2].map(|k| over_area(self.part(k, next) - self.part(k, centre)) * self.inverse_w[k]);
            let of_sum: f64 = step.iter().sum();
            [0, 1, 2].map(|k| (step[k] - weights[k] * of_sum) / sum)
        });
        Weights { weights, gradient }
    }
}

impl Weights {
    /// Everything of one vertex, no change: a point, or flat shading.
    pub const FIRST: Self = Self { weights: [1.0, 0.0, 0.0], gradient: [[0.0; 3]; 2] };

    /// An attribute of so many numbers.
    #[must_use]
    pub fn mix<const N: usize>(&self, values: [[f64; N]; 3]) -> [f64; N] {
        std::array::from_fn(|n| (0..3).map(|k| self.weights[k] * values[k][n]).sum())
    }

    /// Derivatives of a pair of numbers.
    #[must_use]
    pub fn slope(&self, values: [[f64; 2]; 3]) -> Gradient {
        self.gradient.map(|change| [0, 1].map(|n| (0..3).map(|k| change[k] * values[k][n]).sum()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::colour::{perspective_weights, triangle_weights};
    use super::super::super::exact::from_f64;
    use super::*;
    use num_traits::ToPrimitive;
    use proptest::prelude::*;

    #[test]
    fn at_equal_w_is_affine() {
        let vertices = [(128, 128), (1152, 128), (128, 1152)].map(|(x, y)| Vertex::at(x, y, 0));
        let surface = Surface::new(vertices, [5.0; 3]).unwrap();

        let found = surface.at(1, 2);

        assert_eq!(found.mix([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]), [1.0, 2.0]);
        assert_eq!(found.slope([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]), [[1.0, 0.0], [0.0, 1.0]]);
    }

    #[test]
    fn new_without_an_area_is_none() {
        assert!(Surface::new([Vertex::at(1, 2, 0); 3], [1.0; 3]).is_none());
    }

    proptest! {
        #[test]
        fn at_any_triangle_is_that_of_rationals_and_its_slope_that_of_differences(
            xy in prop::array::uniform6(0_i32..4096), w in prop::array::uniform3(0.2_f64..5.0), u in prop::array::uniform3(-4.0_f64..4.0),
        ) {
            let vertices = [0, 2, 4].map(|k| Vertex::at(xy[k], xy[k + 1], 0));
            let area = twice_area(&vertices).abs();
            // Slivers have slopes that no difference shows.
            prop_assume!(area > 300_000);
            let surface = Surface::new(vertices, w).unwrap();
            let (i, j) = ((xy[0] + xy[2] + xy[4]) / 768, (xy[1] + xy[3] + xy[5]) / 768);
            let found = surface.at(i, j);
            let exact_w = w.map(|w| from_f64(w).unwrap());
            let right = perspective_weights(&triangle_weights(&vertices, i, j).unwrap(), &exact_w);
            for (found, right) in found.weights.iter().zip(right.unwrap()) {
                prop_assert!((found - right.to_f64().unwrap()).abs() < 1.0e-12);
            }

            // Differences over 1/256 pixel, to both sides: the same triangle moved by 1 u. Inside a triangle with w > 0
            // an attribute along a line is a hyperbola's branch, so its slope lies between the two; f64 is good for
            // 2^-44 of values below 2^6, times 256.
            prop_assume!(found.weights.iter().all(|&weight| weight > 0.01));
            let values = u.map(|u| [u, 0.0]);
            let moved = |dx: i32, dy: i32| {
                let vertices = vertices.map(|v| Vertex::at(v.x - dx, v.y - dy, 0));
                Surface::new(vertices, w).unwrap().at(i, j).mix(values)[0]
            };
            let here = moved(0, 0);
            let sides = [[moved(-1, 0), moved(1, 0)], [moved(0, -1), moved(0, 1)]];
            for (slope, [before, behind]) in found.slope(values).iter().zip(sides) {
                let [left, right] = [(here - before) * 256.0, (behind - here) * 256.0];
                let (least, greatest) = (left.min(right) - 1.0e-9, left.max(right) + 1.0e-9);
                prop_assert!((least..=greatest).contains(&slope[0]), "{} not in {}..={}", slope[0], least, greatest);
            }
        }
    }
}
