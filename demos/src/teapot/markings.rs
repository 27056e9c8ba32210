//! Lines on the teapot's surface.
//!
//! Rings and meridians run along the edges of the triangles: their points are vertices of the mesh, bit for bit. Free
//! markings are given in the surface's parameters and cross triangles; they are cut at every edge, and each piece lies
//! in the plane of its triangle, as far as single precision goes.

use glam::DVec3;

use super::{Grid, Part, Teapot};
use crate::scene::{narrow, wide};

/// A line on a surface: points joined in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Marking {
    /// The points.
    pub points: Vec<[f32; 3]>,
    /// Whether the last point is joined with the first.
    pub closed: bool,
}

impl Teapot {
    /// The line of constant u round a part, at the grid line next to `u`.
    #[must_use]
    pub fn ring(&self, part: Part, u: f64) -> Marking {
        let grid = self.grid(part);
        let i = self.nearest_line(u, grid.cells[0]);
        let points = (0..grid.cells[1]).map(|j| self.mesh.positions[grid.vertex(i, j) as usize]).collect();
        Marking { points, closed: true }
    }

    /// The line of constant v along a part from `from` to `to`, all at the grid lines next to them.
    #[must_use]
    pub fn meridian(&self, part: Part, v: f64, from: f64, to: f64) -> Marking {
        let grid = self.grid(part);
        let j = self.nearest_line(v.rem_euclid(grid.sheet.columns as f64), grid.cells[1]);
        let ends = [from, to].map(|u| self.nearest_line(u, grid.cells[0]));
        let rows = ends[0].min(ends[1])..=ends[0].max(ends[1]);
        let points = rows.map(|i| self.mesh.positions[grid.vertex(i, j) as usize]).collect();
        Marking { points, closed: false }
    }

    /// A free marking on a part through points (u, v), straight in the parameters from each to the next. v may go
    /// round any number of times; u is held to the part.
    #[must_use]
    pub fn marking(&self, part: Part, through: &[[f64; 2]]) -> Marking {
        let grid = self.grid(part);
        let level = self.level as f64;
        let in_cells = |[u, v]: [f64; 2]| [(u * level).clamp(0.0, grid.cells[0] as f64), v * level];
        let mut points: Vec<[f32; 3]> = Vec::new();
        let mut push = |point: [f32; 3]| {
            if points.last() != Some(&point) {
                points.push(point);
            }
        };
        for pair in through.windows(2) {
            let [from, to] = [in_cells(pair[0]), in_cells(pair[1])];
            for t in cuts(from, to) {
                let at = [from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t];
                push(self.on_facet(grid, at));
            }
        }
        Marking { points, closed: false }
    }

    fn grid(&self, part: Part) -> &Grid {
        // Every part has a grid; the first stands in for none.
        self.grids.iter().find(|grid| grid.sheet.part == part).unwrap_or(&self.grids[0])
    }

    fn nearest_line(&self, parameter: f64, cells: usize) -> usize {
        ((parameter * self.level as f64).round().max(0.0) as usize).min(cells)
    }

    /// The point of the triangle at (s, t), in cells.
    fn on_facet(&self, grid: &Grid, [s, t]: [f64; 2]) -> [f32; 3] {
        let snap = |value: f64| if (value - value.round()).abs() < 1e-9 { value.round() } else { value };
        let (s, t) = (snap(s), snap(t).rem_euclid(grid.cells[1] as f64));
        let i = (s.floor().max(0.0) as usize).min(grid.cells[0] - 1);
        let j = t.floor() as usize;
        let (s, t) = (s - i as f64, t - j as f64);
        let corner = |i, j| wide(self.mesh.positions[grid.vertex(i, j) as usize]);
        let [b, c] = [corner(i, j + 1), corner(i + 1, j)];
        let point: DVec3 = if s + t <= 1.0 {
            let a = corner(i, j);
            a + (c - a) * s + (b - a) * t
        } else {
            let d = corner(i + 1, j + 1);
            d + (b - d) * (1.0 - s) + (c - d) * (1.0 - t)
        };
        narrow(point)
    }
}

/// Where a straight piece from one point to another crosses edges of the grid, as parts of its length, ends included:
/// the edges are at whole s, whole t and whole s + t.
fn cuts(from: [f64; 2], to: [f64; 2]) -> Vec<f64> {
    let mut all = vec![0.0, 1.0];
    for (a, b) in [(from[0], to[0]), (from[1], to[1]), (from[0] + from[1], to[0] + to[1])] {
        let mut whole = a.min(b).ceil();
        while whole <= a.max(b) && a != b {
            all.push((whole - a) / (b - a));
            whole += 1.0;
        }
    }
    all.retain(|t| (0.0..=1.0).contains(t));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
    all
}
