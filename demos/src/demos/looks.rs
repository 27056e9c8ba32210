//! Lights, materials and textured surfaces that the demonstrations of effects share.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec3;

use super::shapes;
use crate::mesh::Mesh;
use crate::scene::{
    Colour, Colours, Draw, Light, LightType, Lighting, Material, MeshDraw, Primitives, Scene, Texture, TextureFilter,
    narrow, wide,
};
use crate::texture::Picture;

/// No colour.
pub(super) const BLACK: Colour = [0, 0, 0, 255];

/// Parallel rays along `direction`.
pub(super) fn sun(direction: [f32; 3], colour: Colour) -> Light {
    Light {
        kind: LightType::Directional,
        position: [0.0; 3],
        direction,
        attenuation_cut_off: None,
        spot_exponent: 0.0,
        colour,
        ambient: BLACK,
    }
}

/// A light all round from `position` that ends at a distance.
pub(super) fn lamp(position: [f32; 3], colour: Colour, end: f32) -> Light {
    Light { kind: LightType::Point, position, attenuation_cut_off: Some(end), ..sun([0.0, -1.0, 0.0], colour) }
}

/// A cone of light from `position` along `direction`.
pub(super) fn spot(position: [f32; 3], direction: [f32; 3], colour: Colour, exponent: f32, end: f32) -> Light {
    Light { kind: LightType::Spot, direction, spot_exponent: exponent, ..lamp(position, colour, end) }
}

/// A material that no light falls on.
pub(super) fn unlit() -> Material {
    Material { light: Some(Lighting::None), ..Material::default() }
}

/// A dull material that is lit.
pub(super) fn dull(light: Lighting) -> Material {
    Material { light: Some(light), ..Material::default() }
}

/// A glazed material that is lit.
pub(super) fn glazed(light: Lighting, specular: u8, shininess: f32) -> Material {
    Material { light: Some(light), specular: [specular, specular, specular, 255], shininess, ..Material::default() }
}

/// A picture that is repeated in both directions.
pub(super) fn repeated(picture: &Arc<Picture>, filter: TextureFilter) -> Texture {
    let mip_map = filter == TextureFilter::Trilinear;
    Texture { filter, mip_map, repeat: [true; 2], ..Texture::of(Arc::clone(picture)) }
}

/// Names a material for the draws that follow.
pub(super) fn add(scene: &mut Scene, name: &str, material: Material) {
    scene.materials.insert(name.to_owned(), material);
}

/// A draw with a material of the scene.
pub(super) fn of(draw: Draw, name: &str) -> Draw {
    let material = Some(name.to_owned());
    match draw {
        Draw::Triangles(draw) => Draw::Triangles(Primitives { material, ..draw }),
        Draw::Lines(draw) => Draw::Lines(Primitives { material, ..draw }),
        Draw::Points(draw) => Draw::Points(Primitives { material, ..draw }),
        Draw::Curve(draw) => Draw::Curve(crate::scene::Curve { material, ..draw }),
        Draw::Mesh(draw) => Draw::Mesh(MeshDraw { material, ..draw }),
        Draw::Decal(mut decal) => {
            decal.draw = decal.draw.into_iter().map(|draw| of(draw, name)).collect();
            Draw::Decal(decal)
        }
    }
}

/// A flat piece with corners `a b c d` round it; the texture's first row runs from `a` to `b`, `times` pictures.
pub(super) fn quad(corners: [DVec3; 4], times: [f32; 2], colour: Colour, material: &str) -> Draw {
    let normal = (corners[3] - corners[0]).cross(corners[1] - corners[0]).normalize_or(DVec3::Y);
    let [u, v] = times;
    Draw::Triangles(Primitives {
        vertices: corners.map(narrow).to_vec(),
        indices: Some(vec![0, 3, 1, 1, 3, 2]),
        colours: Colours::One(colour),
        normals: Some(vec![narrow(normal); 4]),
        texture_coordinates: Some(vec![[0.0, 0.0], [u, 0.0], [u, v], [0.0, v]]),
        material: Some(material.to_owned()),
        ..Default::default()
    })
}

/// A level floor from `least` to `greatest` (x and z) at height `y`, in cells with a vertex at each corner, with one
/// texture a world unit `per_unit` times.
pub(super) fn level(y: f64, [least, greatest]: [[f64; 2]; 2], cells: [u32; 2], per_unit: f64, colour: Colour) -> Mesh {
    let at = |u: f64, v: f64| {
        DVec3::new(least[0] + (greatest[0] - least[0]) * u, y, least[1] + (greatest[1] - least[1]) * v)
    };
    let mut mesh = shapes::open_grid(cells, colour, at);
    let coordinates = |p: &[f32; 3]| [(f64::from(p[0]) * per_unit) as f32, (f64::from(p[2]) * per_unit) as f32];
    mesh.texture_coordinates = Some(mesh.positions.iter().map(coordinates).collect());
    mesh
}

/// A ball of `cells` cells round and from pole to pole, with a texture round it.
pub(super) fn globe(radius: f64, cells: [u32; 2], times: [f64; 2], colour: Colour) -> Mesh {
    let at = |u: f64, v: f64| {
        let ((sine, cosine), (ring, height)) = ((u * TAU).sin_cos(), (v * PI).sin_cos());
        radius * DVec3::new(ring * sine, height, ring * cosine)
    };
    let mut mesh = shapes::open_grid(cells, colour, at);
    mesh.normals = Some(mesh.positions.iter().map(|point| narrow(wide(*point) / radius)).collect());
    let place = |index: u32| {
        let [column, row] = [index / (cells[1] + 1), index % (cells[1] + 1)];
        let part = |at: u32, of: u32, times: f64| (f64::from(at) / f64::from(of) * times) as f32;
        [part(column, cells[0], times[0]), part(row, cells[1], times[1])]
    };
    mesh.texture_coordinates = Some((0..mesh.positions.len() as u32).map(place).collect());
    mesh
}

/// A box from `-half` to `half` whose sides have normals and one whole picture each.
pub(super) fn block(half: DVec3, colour: Colour) -> Mesh {
    let (mut positions, mut normals, mut coordinates, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let sides = [
        (DVec3::Z, DVec3::X),
        (DVec3::X, DVec3::NEG_Z),
        (DVec3::NEG_Z, DVec3::NEG_X),
        (DVec3::NEG_X, DVec3::Z),
        (DVec3::Y, DVec3::X),
        (DVec3::NEG_Y, DVec3::NEG_X),
    ];
    for (normal, right) in sides {
        let up = normal.cross(right);
        let first = positions.len() as u32;
        for (x, y) in [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            positions.push(narrow(half * (normal + right * x + up * y)));
            normals.push(narrow(normal));
            coordinates.push([(x + 1.0) as f32 / 2.0, (1.0 - y) as f32 / 2.0]);
        }
        indices.extend([0, 3, 1, 1, 3, 2].map(|corner| first + corner));
    }
    let mut mesh = Mesh::new("block", positions, indices, colour);
    mesh.normals = Some(normals);
    mesh.texture_coordinates = Some(coordinates);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_outwards(mesh: &Mesh) {
        assert_eq!(mesh.check(), Ok(()));
        let normals = mesh.normals.as_ref().expect("normals");
        for corners in mesh.triangles() {
            let face = mesh.face_vector(corners);
            // The cells at the poles of a globe are triangles and half of each has no extent.
            let cosine = corners.map(|corner| face.dot(wide(normals[corner as usize])));
            assert!(cosine.iter().all(|cosine| *cosine > 0.0) || face.length() < 1e-6, "{corners:?}: {cosine:?}");
        }
    }

    #[test]
    fn globe_and_block_face_outwards_and_hold_their_volume() {
        let (ball, cuboid) = (globe(2.0, [48, 24], [1.0; 2], [255; 4]), block(DVec3::new(1.0, 2.0, 3.0), [255; 4]));
        let volume = |mesh: &Mesh| -> f64 {
            mesh.triangles().map(|corners| mesh.face_vector(corners).dot(mesh.corner(corners[0]))).sum::<f64>() / 6.0
        };
        assert_outwards(&ball);
        assert_outwards(&cuboid);
        assert!((volume(&cuboid) - 48.0).abs() < 1e-6);
        // Chords lie inside the ball: 24 cells from pole to pole miss 1 - (sin a)/a of about 1 % each way.
        let whole = 4.0 / 3.0 * PI * 8.0;
        assert!((0.97..1.0).contains(&(volume(&ball) / whole)), "{}", volume(&ball) / whole);
    }

    #[test]
    fn block_texture_is_upright_from_outside() {
        let mesh = block(DVec3::ONE, [255; 4]);
        let coordinates = mesh.texture_coordinates.as_ref().expect("coordinates");
        for (side, points) in mesh.positions.as_chunks::<4>().0.iter().enumerate() {
            let [a, b, _, d] = points.map(wide);
            let outwards = (d - a).cross(b - a);
            assert!(outwards.dot(a) > 0.0, "side {side}");
            assert_eq!(coordinates[4 * side..4 * side + 4], [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        }
    }

    #[test]
    fn level_faces_upwards_and_counts_pictures_from_the_origin() {
        let mesh = level(0.5, [[-2.0, -4.0], [2.0, 0.0]], [4, 2], 0.5, [255; 4]);
        assert_outwards(&mesh);
        let normals = mesh.normals.as_ref().expect("normals");
        assert!(normals.iter().all(|normal| normal[1] > 0.999));
        let coordinates = mesh.texture_coordinates.as_ref().expect("coordinates");
        assert_eq!((coordinates[0], coordinates[14]), ([-1.0, -2.0], [1.0, 0.0]));
    }

    #[test]
    fn quad_normal_is_that_of_its_triangles() {
        let corners = [DVec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::X, DVec3::ZERO];
        let Draw::Triangles(found) = quad(corners, [2.0, 3.0], [255; 4], "glass") else { panic!("triangles") };
        assert_eq!(found.normals, Some(vec![[0.0, 0.0, 1.0]; 4]));
        let indices = found.indices.expect("indices");
        for corner in indices.as_chunks::<3>().0 {
            let [a, b, c] = corner.map(|index| wide(found.vertices[index as usize]));
            assert!((b - a).cross(c - a).z > 0.0);
        }
    }
}
