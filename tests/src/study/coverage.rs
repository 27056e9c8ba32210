//! How far the share of covered samples is from the covered area.
//!
//! Half-planes with an angle uniform in a turn, and an offset uniform over all those at which the edge crosses the pixel:
//! each is one large triangle drawn to one pixel of the card; the level of white that the pixel gets says how many
//! samples it covers. The area is that of the snapped edge, exactly.

use crate::harness::{Grid, Options, Random, Screen, State, Subpixel};
use crate::oracle::raster::half_plane_area;
use crate::oracle::{Primitive, Vertex};

/// Pixels a side of a frame.
const SIDE: u32 = 128;
/// How far the triangle's other two edges are, u.
const REACH: f64 = 32_768.0;
/// Edges within this of an axis are *near* it, degrees.
const NEAR: f64 = 5.0;

/// A half-plane about pixel (0, 0).
#[derive(Clone, Copy, Debug)]
pub struct HalfPlane {
    /// The edge is that between the first two corners; the others stay out of the pixel.
    corners: [(i32, i32); 3],
    /// Covered part of the pixel.
    pub area: f64,
    /// The edge is near an axis.
    pub near: bool,
}

impl HalfPlane {
    /// One at random.
    #[must_use]
    pub fn any(random: &mut Random) -> Self {
        let angle = random.between(0.0, std::f64::consts::TAU);
        let (sin, cos) = angle.sin_cos();
        let reach = (sin.abs() + cos.abs()) / 2.0;
        let offset = 256.0 * random.between(-reach, reach);
        let at = |along: f64, across: f64| {
            let x = 128.0 + cos * (offset + across) - sin * along;
            let y = 128.0 + sin * (offset + across) + cos * along;
            (x.round() as i32, y.round() as i32)
        };
        let corners = [at(-REACH, 0.0), at(REACH, 0.0), at(0.0, -REACH)];
        let [(x0, y0), (x1, y1), (x2, y2)] = corners.map(|(x, y)| (i64::from(x), i64::from(y)));
        let (a, b) = (y0 - y1, x1 - x0);
        let c = -a * x0 - b * y0;
        let sign = (a * x2 + b * y2 + c).signum();
        let area = half_plane_area(sign * a, sign * b, sign * c);
        let from_axis = angle.to_degrees().rem_euclid(90.0);
        Self {
            corners,
            area: area.numerator() as f64 / area.denominator() as f64,
            near: from_axis.min(90.0 - from_axis) <= NEAR,
        }
    }

    /// White, about pixel `(i, j)`.
    #[must_use]
    pub fn triangle(&self, i: u32, j: u32) -> [Vertex; 3] {
        let [x, y] = [i, j].map(|pixel| pixel as i32 * 256);
        self.corners.map(|corner| Vertex::at(x + corner.0, y + corner.1, 5).coloured([255; 4]))
    }
}

/// Errors of a grid, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Half-planes.
    pub samples: u32,
    /// Root of the mean square error.
    pub rmse: f64,
    /// The same of edges near an axis.
    pub near_axis: f64,
    /// Largest error.
    pub largest: f64,
    /// One standard error of the root mean square error.
    pub standard_error: f64,
}

/// Sums up what was covered against what should have been.
#[must_use]
pub fn errors(pairs: impl IntoIterator<Item = (HalfPlane, f64)>) -> Errors {
    let (mut all, mut near, mut largest, mut fourth) = ((0, 0.0), (0, 0.0), 0.0_f64, 0.0);
    for (half_plane, covered) in pairs {
        let error = covered - half_plane.area;
        all = (all.0 + 1, all.1 + error * error);
        fourth += error.powi(4);
        near = if half_plane.near { (near.0 + 1, near.1 + error * error) } else { near };
        largest = largest.max(error.abs());
    }
    let root = |(count, sum): (u32, f64)| (sum / f64::from(count.max(1))).sqrt();
    let (count, rmse) = (f64::from(all.0.max(1)), root(all));
    // Of the mean square, by its own variance; of its root half of that, relatively.
    let of_square = ((fourth / count - rmse.powi(4)).max(0.0) / count).sqrt();
    let standard_error = if rmse > 0.0 { of_square / (2.0 * rmse) } else { 0.0 };
    Errors { samples: all.0, rmse, near_axis: root(near), largest, standard_error }
}

/// The card's errors over at least `samples` half-planes.
#[must_use]
pub fn of_card(grid: Grid, samples: usize, seed: u64) -> Errors {
    let mut random = Random::new(seed);
    let options = Options { subpixel: Subpixel::on(grid), ..Options::default() };
    let mut screen = Screen::new(SIDE, SIDE, &options);
    let [columns, rows] = grid.size();
    let count = f64::from(columns * rows);
    let mut pairs = Vec::with_capacity(samples);
    while pairs.len() < samples {
        let frame: Vec<HalfPlane> = (0..SIDE * SIDE).map(|_| HalfPlane::any(&mut random)).collect();
        screen.clear();
        for (pixel, half_plane) in (0..).zip(&frame) {
            let (i, j) = (pixel % SIDE, pixel / SIDE);
            let state = State {
                depth_test: false,
                anti_alias: grid != Grid::Off,
                scissor: Some([i, j, i + 1, j + 1]),
                ..State::default()
            };
            screen.draw(&[Primitive::Triangle(half_plane.triangle(i, j))], &state);
        }
        let picture = screen.read();
        // 255 levels tell 64 samples apart.
        let covered = picture.colour.iter().map(|pixel| (f64::from(pixel & 255) * count / 255.0).round() / count);
        pairs.extend(frame.into_iter().zip(covered));
    }
    errors(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::raster::Outline;

    #[test]
    fn errors_of_counted_samples_are_the_published_ones() {
        // The distribution and the exact areas, without a card: root mean square errors of the manual, chapter "Numbers".
        let published =
            [([1, 1], 0.249, 0.282), ([4, 4], 0.0315, 0.060), ([8, 4], 0.0213, 0.045), ([8, 8], 0.0112, 0.0246)];
        for ([columns, rows], rmse, near_axis) in published {
            let mut random = Random::new(38);
            let pairs = (0..40_000).map(|_| {
                let half_plane = HalfPlane::any(&mut random);
                let outline = Outline::new(&half_plane.triangle(0, 0)).expect("an area");
                let middle = |place: i64, of: i64| 256 * (2 * place + 1) / (2 * of);
                let samples = (0..columns * rows).map(|k| (middle(k % columns, columns), middle(k / columns, rows)));
                let covered = samples.filter(|&(x, y)| outline.covers(x, y)).count();
                (half_plane, covered as f64 / (columns * rows) as f64)
            });

            let found = errors(pairs);

            println!("{columns}x{rows}: {found:?}");
            assert!((found.rmse / rmse - 1.0).abs() < 0.05, "{columns}x{rows}: {found:?}");
            assert!((found.near_axis / near_axis - 1.0).abs() < 0.1, "{columns}x{rows}: {found:?}");
        }
    }
}
