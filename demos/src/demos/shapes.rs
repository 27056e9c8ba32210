//! Solids and surfaces that the demonstrations are made of.

use std::f64::consts::{PI, TAU};

use glam::{DMat4, DVec3};

use super::palette::mix;
use crate::mesh::Mesh;
use crate::scene::{Colour, Colours, Decal, Draw, MeshDraw, Primitives, narrow};

/// Lines of one colour from pairs of positions.
pub(super) fn lines(pairs: Vec<[f32; 3]>, colour: Colour) -> Draw {
    Draw::Lines(Primitives { vertices: pairs, colours: Colours::One(colour), ..Default::default() })
}

/// The same, so many pixels wide where they are anti-aliased.
pub(super) fn wide_lines(pairs: Vec<[f32; 3]>, colour: Colour, width: f32) -> Draw {
    let colours = Colours::One(colour);
    Draw::Lines(Primitives { vertices: pairs, colours, extent: Some(width), ..Default::default() })
}

/// The ends of the pieces of a polyline.
pub(super) fn pieces(points: &[[f32; 3]], closed: bool) -> Vec<[f32; 3]> {
    let mut pairs: Vec<[f32; 3]> = points.windows(2).flatten().copied().collect();
    if let ([first, .., last], true) = (points, closed) {
        pairs.extend([*last, *first]);
    }
    pairs
}

/// A decal of the usual slope.
pub(super) fn decal(draw: Vec<Draw>) -> Draw {
    Draw::Decal(Decal { slope: crate::scene::DEFAULT_SLOPE, surfaces: Vec::new(), draw })
}

/// A mesh where it stands.
pub(super) fn solid(mesh: Mesh) -> Draw {
    Draw::Mesh(MeshDraw::of(mesh))
}

/// A round floor that fades from `middle` to `rim`, at height `y`.
pub(super) fn floor(y: f64, radius: f64, middle: Colour, rim: Colour) -> Draw {
    const SPOKES: u32 = 48;
    const RINGS: u32 = 12;
    let mut vertices = vec![narrow(DVec3::new(0.0, y, 0.0))];
    let mut colours = vec![middle];
    let mut indices = Vec::new();
    let vertex = |ring: u32, spoke: u32| 1 + (ring - 1) * SPOKES + spoke % SPOKES;
    for ring in 1..=RINGS {
        let t = f64::from(ring) / f64::from(RINGS);
        for spoke in 0..SPOKES {
            let angle = TAU * f64::from(spoke) / f64::from(SPOKES);
            vertices.push(narrow(DVec3::new(radius * t * angle.cos(), y, radius * t * angle.sin())));
            // Level at both ends, so that neither the middle nor the rim shows.
            colours.push(mix(middle, rim, t * t * (3.0 - 2.0 * t)));
            let (a, b) = (vertex(ring, spoke), vertex(ring, spoke + 1));
            if ring == 1 {
                indices.extend([0, b, a]);
            } else {
                let (c, d) = (vertex(ring - 1, spoke), vertex(ring - 1, spoke + 1));
                indices.extend([c, d, a, d, b, a]);
            }
        }
    }
    let colours = Colours::PerVertex(colours);
    Draw::Triangles(Primitives { vertices, indices: Some(indices), colours, ..Default::default() })
}

/// A box from `-half` to `half`, without normals.
pub(super) fn cuboid(half: DVec3, colour: Colour) -> Mesh {
    let corner = |index: u32| {
        let sign = |bit: u32| if index >> bit & 1 == 1 { 1.0 } else { -1.0 };
        narrow(half * DVec3::new(sign(0), sign(1), sign(2)))
    };
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    Mesh::new("box", (0..8).map(corner).collect(), indices, colour)
}

/// A surface over a grid of parameters in 0..1 that closes in both, with normals: `point(u, v)`; v runs round a tube
/// that goes along u.
pub(super) fn closed_grid(cells: [u32; 2], colour: Colour, point: impl Fn(f64, f64) -> DVec3) -> Mesh {
    const STEP: f64 = 1e-4;
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    let mut indices = Vec::new();
    let vertex = |i: u32, j: u32| (i % cells[0]) * cells[1] + j % cells[1];
    for i in 0..cells[0] {
        for j in 0..cells[1] {
            let (u, v) = (f64::from(i) / f64::from(cells[0]), f64::from(j) / f64::from(cells[1]));
            positions.push(narrow(point(u, v)));
            let along = point(u + STEP, v) - point(u - STEP, v);
            let round = point(u, v + STEP) - point(u, v - STEP);
            normals.push(narrow(round.cross(along).normalize_or(DVec3::Y)));
            let [a, b] = [vertex(i, j), vertex(i, j + 1)];
            let [c, d] = [vertex(i + 1, j), vertex(i + 1, j + 1)];
            indices.extend([a, b, c, b, d, c]);
        }
    }
    let mut mesh = Mesh::new("grid", positions, indices, colour);
    mesh.normals = Some(normals);
    mesh
}

/// A surface over a grid of parameters in 0..=1, open in both, with normals: `point(u, v)`; its front is the side
/// that the cross product of the way of v and the way of u points to.
pub(super) fn open_grid(cells: [u32; 2], colour: Colour, point: impl Fn(f64, f64) -> DVec3) -> Mesh {
    const STEP: f64 = 1e-4;
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    let mut indices = Vec::new();
    for i in 0..=cells[0] {
        for j in 0..=cells[1] {
            let (u, v) = (f64::from(i) / f64::from(cells[0]), f64::from(j) / f64::from(cells[1]));
            positions.push(narrow(point(u, v)));
            let along = point(u + STEP, v) - point(u - STEP, v);
            let across = point(u, v + STEP) - point(u, v - STEP);
            normals.push(narrow(across.cross(along).normalize_or(DVec3::Y)));
            if i < cells[0] && j < cells[1] {
                let a = i * (cells[1] + 1) + j;
                let c = a + cells[1] + 1;
                indices.extend([a, a + 1, c, a + 1, c + 1, c]);
            }
        }
    }
    let mut mesh = Mesh::new("sheet", positions, indices, colour);
    mesh.normals = Some(normals);
    mesh
}

/// A mesh somewhere else.
pub(super) fn placed(mesh: Mesh, transform: DMat4) -> Draw {
    // A matrix for column vectors, column by column, is the same numbers as one for row vectors, row by row.
    let transform = transform.to_cols_array().map(|entry| entry as f32);
    Draw::Mesh(MeshDraw { transform, ..MeshDraw::of(mesh) })
}

/// A point of a torus about the y axis.
pub(super) fn torus_point(large: f64, small: f64, u: f64, v: f64) -> DVec3 {
    let (along, round) = (u * TAU, v * TAU);
    let radius = large + small * round.cos();
    DVec3::new(radius * along.cos(), small * round.sin(), radius * along.sin())
}

/// A sphere of triangles of much the same size: an icosahedron cut `times` times.
pub(super) fn sphere(radius: f64, times: u32, colour: Colour) -> Mesh {
    let long = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points: Vec<DVec3> = Vec::new();
    for (a, b) in [(-1.0, long), (1.0, long), (-1.0, -long), (1.0, -long)] {
        points.push(DVec3::new(a, b, 0.0));
    }
    for (a, b) in [(-1.0, long), (1.0, long), (-1.0, -long), (1.0, -long)] {
        points.push(DVec3::new(0.0, a, b));
    }
    for (a, b) in [(-1.0, long), (1.0, long), (-1.0, -long), (1.0, -long)] {
        points.push(DVec3::new(b, 0.0, a));
    }
    let mut points: Vec<DVec3> = points.into_iter().map(DVec3::normalize).collect();
    let mut faces: Vec<[usize; 3]> = Vec::new();
    // Faces are the triples of corners that are one edge apart.
    let edge = points[0].distance(points[1]) + 1e-9;
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            for c in b + 1..points.len() {
                let near = |x: usize, y: usize| points[x].distance(points[y]) < edge;
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = (points[b] - points[a]).cross(points[c] - points[a]).dot(points[a]) > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..times {
        let mut known = std::collections::HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                points.push((points[a] + points[b]).normalize());
                points.len() - 1
            })
        };
        let mut finer = Vec::with_capacity(faces.len() * 4);
        for [a, b, c] in faces {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    let indices = faces.into_iter().flatten().map(|index| index as u32).collect();
    let mut mesh = Mesh::new("sphere", points.iter().map(|p| narrow(*p * radius)).collect(), indices, colour);
    mesh.normals = Some(points.into_iter().map(narrow).collect());
    mesh
}

/// A point of the tube of radius `small` round a (2, 3) torus knot.
pub(super) fn knot_point(large: f64, small: f64, u: f64, v: f64) -> DVec3 {
    let middle = |u: f64| {
        let angle = u * TAU;
        let radius = large * (1.0 + 0.42 * (3.0 * angle).cos());
        DVec3::new(radius * (2.0 * angle).cos(), radius * (2.0 * angle).sin(), large * 0.55 * (3.0 * angle).sin())
    };
    let forward = (middle(u + 1e-4) - middle(u - 1e-4)).normalize();
    // The axis of the torus is never along the knot, so this frame turns smoothly and closes.
    let side = forward.cross(DVec3::Z).normalize();
    let up = side.cross(forward);
    let (sine, cosine) = (v * TAU + PI / 8.0).sin_cos();
    middle(u) + (side * sine + up * cosine) * small
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::wide;

    fn assert_closed_and_outwards(mesh: &Mesh) {
        assert_eq!(mesh.check(), Ok(()));
        assert_eq!(mesh.feature_edges(179.9), Vec::<[u32; 2]>::new());
        let volume: f64 = mesh.triangles().map(|corners| mesh.face_vector(corners).dot(mesh.corner(corners[0]))).sum();
        assert!(volume > 0.0, "{volume}");
        let normals = mesh.normals.as_ref().expect("normals");
        for corners in mesh.triangles() {
            assert!(mesh.face_vector(corners).dot(wide(normals[corners[0] as usize])) > 0.0);
        }
    }

    #[test]
    fn shapes_are_closed_and_face_outwards() {
        assert_closed_and_outwards(&sphere(2.0, 2, [255; 4]));
        assert_closed_and_outwards(&closed_grid([24, 12], [255; 4], |u, v| torus_point(2.0, 0.7, u, v)));
        assert_closed_and_outwards(&closed_grid([96, 8], [255; 4], |u, v| knot_point(1.0, 0.2, u, v)));
    }

    #[test]
    fn open_grid_has_a_border_and_normals_of_its_front() {
        let mesh = open_grid([6, 4], [255; 4], |u, v| DVec3::new(u, u * v, v));
        assert_eq!((mesh.check(), mesh.triangles().count()), (Ok(()), 2 * 6 * 4));
        let normals = mesh.normals.as_ref().expect("normals");
        for corners in mesh.triangles() {
            assert!(mesh.face_vector(corners).dot(wide(normals[corners[0] as usize])) > 0.0);
        }
        // Edges of one face alone are features at every angle.
        assert_eq!(mesh.feature_edges(179.9).len(), 2 * (6 + 4));
    }

    #[test]
    fn torus_normals_point_away_from_the_ring() {
        let mesh = closed_grid([24, 12], [255; 4], |u, v| torus_point(2.0, 0.5, u, v));
        let outermost = mesh.positions.iter().position(|p| p[0] > 2.499).expect("on the rim");
        let normal = mesh.normals.as_ref().expect("normals")[outermost];
        assert!(normal[0] > 0.99, "{normal:?}");
    }

    #[test]
    fn cuboid_feature_edges_are_twelve() {
        assert_eq!(cuboid(DVec3::ONE, [255; 4]).feature_edges(30.0).len(), 12);
    }
}
