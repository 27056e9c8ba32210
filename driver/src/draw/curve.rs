//! Bézier curves in space, drawn as line strips.

use lyon_geom::{CubicBezierSegment, Point, QuadraticBezierSegment};
use zga_abi::bus::Bus;

use super::Vertex;
use super::flatten::{Projected, parameters};
use crate::{Driver, DriverError};

/// A Bézier curve in object space. Colours follow the control points as positions do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// From the first to the third point, toward the second.
    Quadratic([Vertex; 3]),
    /// From the first to the fourth point, toward the second and the third.
    Cubic([Vertex; 4]),
}

impl Curve {
    /// The control points.
    #[must_use]
    pub const fn points(&self) -> &[Vertex] {
        match self {
            Curve::Quadratic(points) => points,
            Curve::Cubic(points) => points,
        }
    }

    /// The point at parameter `t`, 0..=1.
    #[must_use]
    pub fn at(&self, t: f64) -> Vertex {
        let part = |pick: &dyn Fn(&Vertex) -> f64| match self {
            Curve::Quadratic(p) => {
                let [from, ctrl, to] = [0, 1, 2].map(|i| Point::new(pick(&p[i]), 0.0));
                QuadraticBezierSegment { from, ctrl, to }.x(t)
            }
            Curve::Cubic(p) => {
                let [from, ctrl1, ctrl2, to] = [0, 1, 2, 3].map(|i| Point::new(pick(&p[i]), 0.0));
                CubicBezierSegment { from, ctrl1, ctrl2, to }.x(t)
            }
        };
        Vertex {
            position: std::array::from_fn(|i| part(&|v| v.position[i].into()) as f32),
            colour: std::array::from_fn(|i| part(&|v| v.colour[i].into()).round() as u8),
        }
    }
}

impl<B: Bus> Driver<B> {
    /// Draws a curve as a line strip that lies within `tolerance_px` pixels of it on the screen.
    ///
    /// The curve is cut where it bends on the screen, but every corner is computed in space: depth and decal
    /// are those of the curve, and the strip is the same with and without a decal. The tolerance holds for
    /// the visible part; coordinates are then snapped as all are.
    ///
    /// # Errors
    /// [`DriverError::View`] if a coordinate is not finite or the tolerance is not above 0, or as
    /// [`Driver::draw`].
    pub fn draw_curve(&mut self, curve: &Curve, tolerance_px: f64) -> Result<(), DriverError> {
        let scene = self.open_scene("draw_curve")?;
        let state = &self.state;
        let (width, height) = (f64::from(scene.width), f64::from(scene.height));
        let matrix = state.camera.projection(width / height) * state.camera.view()? * state.object;
        let viewport = state.camera.matrices(scene.width, scene.height)?.viewport.map(f64::from);
        let positions: Vec<[f32; 3]> = curve.points().iter().map(|point| point.position).collect();
        let projected = Projected::new(&positions, matrix, viewport, [width, height])?;
        let strip: Vec<Vertex> = parameters(&projected, tolerance_px)?.into_iter().map(|t| curve.at(t)).collect();
        self.draw_line_strip(&strip)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_ends_are_the_end_points_and_middle_blends() {
        let black = Vertex::new([0.0; 3], [0, 0, 0, 255]);
        let white = Vertex::new([4.0, 0.0, 2.0], [200, 100, 0, 255]);
        let curve = Curve::Quadratic([black, Vertex::new([2.0, 4.0, 1.0], [100, 50, 0, 255]), white]);
        assert_eq!((curve.at(0.0), curve.at(1.0)), (black, white));
        assert_eq!(curve.at(0.5), Vertex::new([2.0, 2.0, 1.0], [100, 50, 0, 255]));
    }
}
