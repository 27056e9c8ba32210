//! Where to cut a curve so that its chords stay near it on the screen.
//!
//! On the screen a Bézier curve in space is a rational one: its control points P carry weights w. It is
//! halved until, within a piece, the rational curve R and the plain curve Q over the same P differ by at
//! most a quarter of the tolerance: |R - Q| <= (w_max / w_min - 1) * max |P - C| for any point C, since
//! both are convex combinations of the P. Q is then flattened by Wang's formula to half of the tolerance.
//! Chords between points of R are a quarter away from chords between points of Q, so the whole lies within
//! 1/4 + 1/2 + 1/4 of the tolerance. Parallel projections have equal weights: no halving takes place.
//!
//! A piece whose control points all lie outside one side of the picture, or before the near plane, cannot
//! be seen and becomes one chord, which cannot be seen either.

use glam::{DMat4, DVec4};
use lyon_geom::{CubicBezierSegment, Point, QuadraticBezierSegment};

use crate::view::{ViewError, finite};

/// Deepest halving; pieces that still are not simple there become one chord. Only coordinates millions of
/// pictures away or a curve that touches the plane of the eye get there.
const DEEPEST: u32 = 24;
/// Pieces larger than this in pixels are halved first: most of them cannot be seen.
const LARGEST: f64 = 65_536.0;
/// Smallest tolerance in pixels: half a step of the sub-pixel grid.
const FINEST: f64 = 1.0 / 512.0;

/// A curve's control points in clip space, and the viewport.
pub(super) struct Projected {
    points: Vec<DVec4>,
    scale: [f64; 2],
    offset: [f64; 2],
    size: [f64; 2],
}

impl Projected {
    /// Takes control points to clip space.
    pub fn new(positions: &[[f32; 3]], matrix: DMat4, viewport: [f64; 6], size: [f64; 2]) -> Result<Self, ViewError> {
        let mut points = Vec::with_capacity(positions.len());
        for position in positions {
            let [x, y, z] = position.map(f64::from);
            for part in [x, y, z] {
                finite("curve control point", part)?;
            }
            points.push(matrix * DVec4::new(x, y, z, 1.0));
        }
        let [sx, sy, _, ox, oy, _] = viewport;
        Ok(Projected { points, scale: [sx, sy], offset: [ox, oy], size })
    }

    fn screen(&self, p: DVec4) -> Point<f64> {
        Point::new(p.x / p.w * self.scale[0] + self.offset[0], p.y / p.w * self.scale[1] + self.offset[1])
    }

    /// Whether all points are outside the same side of the view volume.
    fn is_outside(&self, piece: &[DVec4]) -> bool {
        // Screen x times w, compared with 0 and the width times w: no division, so it holds for any w.
        let x = |p: &DVec4| p.x * self.scale[0] + p.w * self.offset[0];
        let y = |p: &DVec4| p.y * self.scale[1] + p.w * self.offset[1];
        let [width, height] = self.size;
        piece.iter().all(|p| p.w <= 0.0)
            || piece.iter().all(|p| p.z < 0.0)
            || piece.iter().all(|p| p.z > p.w)
            || piece.iter().all(|p| x(p) < 0.0)
            || piece.iter().all(|p| x(p) > width * p.w)
            || piece.iter().all(|p| y(p) < 0.0)
            || piece.iter().all(|p| y(p) > height * p.w)
    }
}

/// Parameters of the corners, rising, from 0 to 1.
pub(super) fn parameters(curve: &Projected, tolerance_px: f64) -> Result<Vec<f64>, ViewError> {
    if finite("curve tolerance", tolerance_px)? <= 0.0 {
        let (field, expected) = ("curve tolerance", "pixels, above 0");
        return Err(ViewError::BadNumber { field, found: tolerance_px, expected });
    }
    let mut corners = vec![0.0];
    cut(curve, &curve.points, [0.0, 1.0], tolerance_px.max(FINEST), DEEPEST, &mut corners);
    Ok(corners)
}

/// Adds the corners of a piece, its first excluded and its last included.
fn cut(curve: &Projected, piece: &[DVec4], [from, to]: [f64; 2], tolerance: f64, deeper: u32, corners: &mut Vec<f64>) {
    if deeper == 0 || curve.is_outside(piece) {
        corners.push(to);
        return;
    }
    if is_simple(curve, piece, tolerance) {
        flatten(curve, piece, tolerance / 2.0, |t| corners.push(if t < 1.0 { from + t * (to - from) } else { to }));
        return;
    }
    let [first, second] = halves(piece);
    let middle = f64::midpoint(from, to);
    cut(curve, &first, [from, middle], tolerance, deeper - 1, corners);
    cut(curve, &second, [middle, to], tolerance, deeper - 1, corners);
}

/// Whether a piece is on the screen nearly the plain curve of its projected control points.
fn is_simple(curve: &Projected, piece: &[DVec4], tolerance: f64) -> bool {
    let nearest = piece.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
    let farthest = piece.iter().map(|p| p.w).fold(f64::NEG_INFINITY, f64::max);
    // The volume ends at the near plane; a piece that goes through it is halved until it lies on one side.
    if nearest <= 0.0 || (nearest < farthest && piece.iter().any(|p| p.z < 0.0)) {
        return false;
    }
    let centre = curve.screen(piece[0]);
    let radius = piece.iter().map(|&p| (curve.screen(p) - centre).length()).fold(0.0, f64::max);
    radius <= LARGEST && (farthest / nearest - 1.0) * radius <= tolerance / 4.0
}

/// Cuts a piece at its middle (de Casteljau).
fn halves(piece: &[DVec4]) -> [Vec<DVec4>; 2] {
    let mut row = piece.to_vec();
    let mut first = vec![row[0]];
    let mut second = vec![row[row.len() - 1]];
    while row.len() > 1 {
        row = row.windows(2).map(|pair| (pair[0] + pair[1]) * 0.5).collect();
        first.push(row[0]);
        second.push(row[row.len() - 1]);
    }
    second.reverse();
    [first, second]
}

/// Tells the parameters of the corners after the first.
fn flatten(curve: &Projected, piece: &[DVec4], tolerance: f64, mut corner: impl FnMut(f64)) {
    let points: Vec<Point<f64>> = piece.iter().map(|&p| curve.screen(p)).collect();
    match points[..] {
        [from, ctrl, to] => QuadraticBezierSegment { from, ctrl, to }
            .for_each_flattened_with_t(tolerance, &mut |_, range| corner(range.end)),
        [from, ctrl1, ctrl2, to] => CubicBezierSegment { from, ctrl1, ctrl2, to }
            .for_each_flattened_with_t(tolerance, &mut |_, range| corner(range.end)),
        _ => corner(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Camera;

    const SIZE: [u32; 2] = [640, 480];

    fn projected(camera: &Camera, positions: &[[f32; 3]]) -> Projected {
        let matrix = camera.projection(640.0 / 480.0) * camera.view().expect("good camera");
        let viewport = camera.matrices(SIZE[0], SIZE[1]).expect("good camera").viewport.map(f64::from);
        Projected::new(positions, matrix, viewport, SIZE.map(f64::from)).expect("finite points")
    }

    fn at(curve: &Projected, t: f64) -> Point<f64> {
        let mut row = curve.points.clone();
        while row.len() > 1 {
            row = row.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
        }
        curve.screen(row[0])
    }

    /// Largest distance of the visible curve from its chords, found by dense sampling; and visible samples.
    fn largest_error(curve: &Projected, corners: &[f64]) -> (f64, usize) {
        let is_seen = |p: &Point<f64>| (0.0..=640.0).contains(&p.x) && (0.0..=480.0).contains(&p.y);
        let chord_errors = |pair: &[f64]| -> Vec<f64> {
            let chord = lyon_geom::LineSegment { from: at(curve, pair[0]), to: at(curve, pair[1]) };
            let samples = (0..=50).map(|i| at(curve, pair[0] + (pair[1] - pair[0]) * f64::from(i) / 50.0));
            samples.filter(is_seen).map(|point| chord.distance_to_point(point)).collect()
        };
        let errors: Vec<f64> = corners.windows(2).flat_map(chord_errors).collect();
        (errors.iter().copied().fold(0.0, f64::max), errors.len())
    }

    const FRONT: Camera = Camera::Perspective {
        eye: [0.0, 0.0, 4.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 60.0,
        near: 0.5,
        far: 50.0,
    };

    #[test]
    fn parameters_screen_camera_stays_within_tolerance() {
        let curve = projected(&Camera::Screen, &[[10.0, 10.0, 0.1], [600.0, 20.0, 0.5], [300.0, 470.0, 0.9]]);
        for tolerance in [0.01, 0.25, 4.0] {
            let corners = parameters(&curve, tolerance).expect("good tolerance");
            let (error, seen) = largest_error(&curve, &corners);
            assert!(error <= tolerance && seen > 100, "{error} > {tolerance}, {seen} samples");
        }
    }

    #[test]
    fn parameters_perspective_toward_the_viewer_stays_within_tolerance() {
        let points = [[-1.0, -1.0, 3.0], [2.0, 0.0, -8.0], [-3.0, 1.0, -20.0], [1.0, 1.0, 2.5]];
        let curve = projected(&FRONT, &points);
        for tolerance in [0.05, 0.25, 2.0] {
            let corners = parameters(&curve, tolerance).expect("good tolerance");
            let (error, seen) = largest_error(&curve, &corners);
            assert!(error <= tolerance && seen > 100, "{error} > {tolerance}, {seen} samples");
            assert!(corners.len() < 2000 && corners.is_sorted(), "{}", corners.len());
        }
    }

    #[test]
    fn parameters_through_the_eye_or_out_of_range_are_few() {
        for points in [
            [[0.0, 0.0, 0.0], [0.0, 0.0, 4.0], [0.1, 0.0, 9.0]],
            [[-3e38, 0.0, 0.0], [0.0, 3e38, 0.0], [3e38, 0.0, 0.0]],
            [[0.0; 3]; 3],
        ] {
            let corners = parameters(&projected(&FRONT, &points), 0.25).expect("good tolerance");
            assert!(corners.len() < 20_000 && corners.first() == Some(&0.0) && corners.last() == Some(&1.0));
        }
    }

    #[test]
    fn parameters_bad_numbers_are_refused() {
        let curve = projected(&Camera::Screen, &[[0.0; 3]; 3]);
        assert!(parameters(&curve, 0.0).is_err());
        assert!(parameters(&curve, f64::NAN).is_err());
        assert!(Projected::new(&[[f32::NAN; 3]; 3], DMat4::IDENTITY, [1.0; 6], [1.0; 2]).is_err());
    }
}
