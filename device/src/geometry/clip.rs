//! Homogeneous clipping (Sutherland-Hodgman) against near, far and the guard band.
//!
//! A crossing is always computed from the inside vertex toward the outside one, so that the two
//! triangles at an edge get the same point, whichever way round they name it. w = 0 needs no plane
//! of its own: |x| <= g w and |y| <= g w leave nothing of it but a point.

use super::transform::{ClipVertex, Transform};

/// Planes: near, far, four sides of the guard band.
const PLANES: usize = 6;
/// Most vertices a clipped triangle can have: each plane adds one.
pub const MAX_VERTICES: usize = 3 + PLANES;

/// A convex polygon in clip space.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    vertices: [ClipVertex; MAX_VERTICES],
    count: usize,
    /// Clip planes that cut something off.
    pub cuts: u32,
}

const ORIGIN: ClipVertex = ClipVertex { position: [0.0; 4], depth: [0.0; 2], colour: [0.0; 4] };

impl Polygon {
    /// What is left of a triangle.
    #[must_use]
    pub fn triangle(transform: &Transform, triangle: &[ClipVertex; 3]) -> Polygon {
        let mut polygon = Polygon { vertices: [ORIGIN; MAX_VERTICES], count: 3, cuts: 0 };
        polygon.vertices[..3].copy_from_slice(triangle);
        for plane in 0..PLANES {
            polygon.cut(|v| transform.distances(v)[plane]);
        }
        polygon
    }

    /// The vertices left, in order; empty or at least 3.
    #[must_use]
    pub fn vertices(&self) -> &[ClipVertex] {
        if self.count < 3 { &[] } else { &self.vertices[..self.count] }
    }

    fn cut(&mut self, distance: impl Fn(&ClipVertex) -> f64) {
        let before = *self;
        let (input, distances) = (&before.vertices[..before.count], before.vertices.map(|v| distance(&v)));
        if distances[..before.count].iter().all(|&d| d >= 0.0) {
            return;
        }
        self.cuts += 1;
        self.count = 0;
        for k in 0..input.len() {
            let next = (k + 1) % input.len();
            let (da, db) = (distances[k], distances[next]);
            if da >= 0.0 {
                self.push(input[k]);
            }
            if (da >= 0.0) != (db >= 0.0) {
                self.push(if da >= 0.0 {
                    crossing(&input[k], &input[next], da, db)
                } else {
                    crossing(&input[next], &input[k], db, da)
                });
            }
        }
    }

    fn push(&mut self, vertex: ClipVertex) {
        // A convex polygon gains at most one vertex a plane; rounding cannot make it concave enough
        // for more than the array holds, and if it did the vertex would be dropped.
        if let Some(slot) = self.vertices.get_mut(self.count) {
            *slot = vertex;
            self.count += 1;
        }
    }
}

/// What is left of a line, and how many planes cut it.
#[must_use]
pub fn clip_line(transform: &Transform, line: &[ClipVertex; 2]) -> (Option<[ClipVertex; 2]>, u32) {
    let (mut ends, mut cuts) = (*line, 0);
    for plane in 0..PLANES {
        let [da, db] = [0, 1].map(|k| transform.distances(&ends[k])[plane]);
        match (da >= 0.0, db >= 0.0) {
            (true, true) => continue,
            (false, false) => return (None, cuts + 1),
            (true, false) => ends[1] = crossing(&ends[0], &ends[1], da, db),
            (false, true) => ends[0] = crossing(&ends[1], &ends[0], db, da),
        }
        cuts += 1;
    }
    (Some(ends), cuts)
}

/// Where the way from `inside` (distance `di` >= 0) to `outside` (`d_o` < 0) meets the plane.
fn crossing(inside: &ClipVertex, outside: &ClipVertex, di: f64, d_o: f64) -> ClipVertex {
    let t = di / (di - d_o);
    let mix = |a: f64, b: f64| a + (b - a) * t;
    ClipVertex {
        position: [0, 1, 2, 3].map(|k| mix(inside.position[k], outside.position[k])),
        depth: [0, 1].map(|k| mix(inside.depth[k], outside.depth[k])),
        colour: [0, 1, 2, 3].map(|k| mix(inside.colour[k], outside.colour[k])),
    }
}
