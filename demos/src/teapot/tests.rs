//! The teapot's shape, closedness, normals and markings.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::{Part, Teapot};
use crate::scene::wide;

const WHITE: [u8; 4] = [255; 4];

#[test]
fn teapot_edges_belong_to_two_triangles_except_at_the_six_openings() {
    for level in [2, 5, 10] {
        let teapot = Teapot::new(level, WHITE);
        let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
        for [a, b, c] in teapot.mesh().triangles() {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *sides.entry([from.min(to), from.max(to)]).or_default() += 1;
            }
        }
        let open = sides.values().filter(|count| **count == 1).count();
        assert!(sides.values().all(|count| *count <= 2));
        // Rim and lid in four patches each; both ends of handle and spout in two each.
        assert_eq!(open, 16 * level as usize, "level {level}");
    }
}

#[test]
fn teapot_neighbours_wind_the_same_way() {
    let teapot = Teapot::new(6, WHITE);
    let mut directed = HashSet::new();
    for [a, b, c] in teapot.mesh().triangles() {
        for edge in [[a, b], [b, c], [c, a]] {
            assert!(directed.insert(edge), "edge {edge:?} runs twice in the same direction");
        }
    }
}

#[test]
fn teapot_level_10_has_the_published_extent_and_count() {
    let teapot = Teapot::new(10, WHITE);
    let bounds = teapot.mesh().bounds();
    let near = |found: [f32; 3], expected: [f32; 3]| {
        found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-3)
    };
    assert!(near(bounds.least, [-3.0, 0.0, -2.0]), "{:?}", bounds.least);
    assert!(near(bounds.greatest, [3.434, 3.15, 2.0]), "{:?}", bounds.greatest);
    // Two triangles a cell, less one for each of the 4 x 10 cells at both poles.
    assert_eq!(teapot.mesh().triangle_count(), 32 * 200 - 80);
    assert_eq!(teapot.mesh().check(), Ok(()));
}

#[test]
fn teapot_normals_are_unit_and_agree_with_the_triangles() {
    let teapot = Teapot::new(12, WHITE);
    let mesh = teapot.mesh();
    let normals = mesh.normals.as_ref().expect("analytic normals");
    assert!(normals.iter().all(|normal| (wide(*normal).length() - 1.0).abs() < 1e-6));
    for corners in mesh.triangles() {
        let face = mesh.face_vector(corners).normalize();
        for corner in corners {
            let cosine = wide(normals[corner as usize]).dot(face);
            // The lip of the spout turns by half a right angle within a cell.
            assert!(cosine > 0.5, "{corners:?}: {cosine}");
        }
    }
}

#[test]
fn teapot_body_normals_point_outwards() {
    let teapot = Teapot::new(8, WHITE);
    let mesh = teapot.mesh();
    let normals = mesh.normals.as_ref().expect("analytic normals");
    let belly =
        mesh.positions.iter().zip(normals).filter(|(p, _)| {
            (0.3..2.0).contains(&p[1]) && (1.5..=2.001).contains(&p[0].hypot(p[2])) && p[2].abs() > 0.8
        });
    let mut checked = 0;
    for (position, normal) in belly {
        let outwards = DVec3::new(f64::from(position[0]), 0.0, f64::from(position[2]));
        assert!(wide(*normal).dot(outwards) > 0.0, "{position:?} {normal:?}");
        checked += 1;
    }
    assert!(checked > 100);
    let top = mesh.positions.iter().position(|p| p[1] > 3.149).expect("the knob");
    assert_eq!(normals[top], [0.0, 1.0, 0.0]);
}

#[test]
fn ring_and_meridian_run_along_mesh_edges() {
    let teapot = Teapot::new(8, WHITE);
    let mesh = teapot.mesh();
    let bits = |p: [f32; 3]| p.map(|c| (c + 0.0).to_bits());
    let mut edges = HashSet::new();
    for corners in mesh.triangles() {
        let points = corners.map(|index| bits(mesh.positions[index as usize]));
        for side in 0..3 {
            edges.insert([points[side], points[(side + 1) % 3]]);
            edges.insert([points[(side + 1) % 3], points[side]]);
        }
    }
    let ring = teapot.ring(Part::Body, 1.5);
    assert_eq!((ring.points.len(), ring.closed), (32, true));
    let pairs = ring.points.iter().zip(ring.points.iter().cycle().skip(1));
    assert!(pairs.into_iter().all(|(a, b)| edges.contains(&[bits(*a), bits(*b)])));
    let line = teapot.meridian(Part::Spout, 0.5, 0.0, 2.0);
    assert_eq!(line.points.len(), 17);
    assert!(line.points.windows(2).all(|pair| edges.contains(&[bits(pair[0]), bits(pair[1])])));
}

#[test]
fn marking_pieces_lie_in_the_planes_of_single_triangles() {
    let teapot = Teapot::new(6, WHITE);
    let mesh = teapot.mesh();
    let through: Vec<[f64; 2]> =
        (0..=40).map(|k| [2.0 + 0.3 * f64::from(k).sin(), 0.05 + f64::from(k) * 0.1]).collect();
    let marking = teapot.marking(Part::Body, &through);
    assert!(marking.points.len() > through.len());
    for pair in marking.points.windows(2) {
        let [a, b] = [wide(pair[0]), wide(pair[1])];
        let distance = |corners: [u32; 3]| {
            let [p, q, r] = corners.map(|index| mesh.corner(index));
            let normal = (q - p).cross(r - p).normalize();
            // Outside one of the sides, or off the plane, whichever is more.
            let off = |x: DVec3| {
                let outside = [(p, q), (q, r), (r, p)]
                    .map(|(from, to)| (to - from).normalize().cross(normal).dot(x - from).max(0.0));
                outside.into_iter().fold((x - p).dot(normal).abs(), f64::max)
            };
            off(a).max(off(b))
        };
        let nearest = mesh.triangles().map(distance).fold(f64::MAX, f64::min);
        assert!(nearest < 1e-6, "{pair:?}: {nearest}");
    }
}
