//! The mesh as the studies draw it: in eye space, turned and scaled to fit, all of it in front of the near plane.

use zga_tests::oracle::effects::Corner;
use zga_tests::study::scene::{FAR, Facet, REACH, Scene, UNITS};

use crate::mesh::Mesh;

/// Radius of the mesh in eye space, and how far before the eye its middle is: nothing is nearer than 1.2.
const RADIUS: f64 = 2.0;
const DISTANCE: f64 = 3.2;
/// Near and far plane of the studies' camera.
const PLANES: [f64; 2] = [1.0, 1024.0];

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Three corners for each triangle, in eye space: x to the right, y up, looking down -z. The view is 90 degrees wide and
/// high; x is narrowed so that pixels of a picture of `size` are square. `turn` is about the vertical, in degrees.
#[must_use]
pub fn corners(mesh: &Mesh, size: [u32; 2], turn: f64) -> Vec<Corner> {
    let bounds = mesh.bounds();
    let centre = bounds.centre.map(f64::from);
    let scale = RADIUS / f64::from(bounds.radius).max(1e-30);
    let narrow = (f64::from(size[1]) / f64::from(size[0].max(1))).min(1.0);
    let (sin, cos) = turn.to_radians().sin_cos();
    let (tilt_sin, tilt_cos) = 24_f64.to_radians().sin_cos();
    let turned = |[x, y, z]: [f64; 3]| {
        let (x, z) = (cos * x + sin * z, cos * z - sin * x);
        [x, tilt_cos * y - tilt_sin * z, tilt_sin * y + tilt_cos * z]
    };
    let place = |index: u32| {
        let position = mesh.positions[index as usize].map(f64::from);
        let [x, y, z] = turned([0, 1, 2].map(|k| (position[k] - centre[k]) * scale));
        [x * narrow, y, z - DISTANCE]
    };
    let mut all = Vec::with_capacity(mesh.indices.len());
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let places = triangle.map(place);
        let side = |k: usize| [0, 1, 2].map(|axis| places[k][axis] - places[0][axis]);
        let face = cross(side(1), side(2));
        for (index, at) in triangle.iter().zip(places) {
            let normal = match &mesh.normals {
                Some(normals) => turned(normals[*index as usize].map(f64::from)),
                None => face,
            };
            all.push(Corner {
                position: at.map(|c| c as f32),
                colour: 0xFFC8_B8A0,
                normal: normal.map(|c| c as f32),
                coordinates: [0.0; 2],
            });
        }
    }
    all
}

/// The colour of the mesh alone in full light.
const BASE: [u8; 3] = [236, 226, 205];

/// How often a texture goes round a mesh without coordinates of its own.
const ROUND: f64 = 6.0;

/// [`corners`] with texture coordinates: the mesh's own, or the angle about its vertical and the height.
#[must_use]
pub fn textured(mesh: &Mesh, size: [u32; 2], turn: f64) -> Vec<Corner> {
    let mut all = corners(mesh, size, turn);
    let bounds = mesh.bounds();
    let wrapped = |index: u32| {
        let position = mesh.positions[index as usize];
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(position[axis]) - f64::from(bounds.centre[axis]));
        [x.atan2(z) / std::f64::consts::TAU * ROUND, -y / f64::from(bounds.radius).max(1e-30) * ROUND / 3.0]
    };
    for (corners, triangle) in all.as_chunks_mut::<3>().0.iter_mut().zip(mesh.indices.as_chunks::<3>().0) {
        let mut coordinates = match &mesh.texture_coordinates {
            Some(own) => triangle.map(|index| own[index as usize].map(f64::from)),
            None => triangle.map(wrapped),
        };
        if mesh.texture_coordinates.is_none() {
            // The other two corners as near to the first as whole turns allow: no triangle goes round the back.
            let first = coordinates[0][0];
            coordinates.iter_mut().for_each(|[u, _]| *u -= ((*u - first) / ROUND).round() * ROUND);
        }
        for (corner, place) in corners.iter_mut().zip(coordinates) {
            (corner.colour, corner.coordinates) = (u32::MAX, place.map(|part| part as f32));
        }
    }
    all
}

/// How much of the full light a surface gets that faces `normal`, of any length.
fn light(normal: [f64; 3]) -> f64 {
    let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt().max(1e-30);
    let light = ((0.4 * normal[0] + 0.6 * normal[1] + 0.7 * normal[2]) / length).abs();
    0.25 + 0.75 * light.min(1.0)
}

/// A colour in so much of the full light.
fn lit(base: [u8; 3], light: f64) -> [u8; 3] {
    base.map(|level| (f64::from(level) * light).round() as u8)
}

/// The same on the screen, each triangle in one colour by how it faces a light; `base` is the colour in full light.
/// Triangles that would not fit the exact numbers are left out.
#[must_use]
pub fn facets(corners: &[Corner], size: [u32; 2], base: [u8; 3]) -> Vec<Facet> {
    let colours = |three: &[Corner; 3]| {
        let side = |k: usize| [0, 1, 2].map(|axis| f64::from(three[k].position[axis] - three[0].position[axis]));
        [lit(base, light(cross(side(1), side(2)))); 3]
    };
    projected(corners, size, colours)
}

/// Triangles on the screen, in the colours that `colours` says.
fn projected(corners: &[Corner], size: [u32; 2], colours: impl Fn(&[Corner; 3]) -> [[u8; 3]; 3]) -> Vec<Facet> {
    let [near, far] = PLANES;
    let project = |corner: &Corner| {
        let [x, y, z] = corner.position.map(f64::from);
        let half = size.map(|side| f64::from(side) / 2.0);
        let pixels = [half[0] * (1.0 + x / -z), half[1] * (1.0 - y / -z)];
        let depth = far / (far - near) * (1.0 - near / -z);
        (pixels.map(|c| (c * f64::from(UNITS)).round() as i32), (depth * f64::from(FAR)).round() as i32)
    };
    let facet = |three: &[Corner; 3]| {
        let at = three.each_ref().map(project);
        let fits = at.iter().all(|(place, depth)| place.iter().all(|c| c.abs() <= REACH) && (0..=FAR).contains(depth));
        fits.then(|| Facet {
            corners: at.map(|corner| corner.0),
            depths: at.map(|corner| corner.1),
            colours: colours(three),
        })
    };
    corners.as_chunks::<3>().0.iter().filter_map(facet).collect()
}

/// The mesh alone, with flat faces.
#[must_use]
pub fn scene(mesh: &Mesh, size: [u32; 2]) -> Scene {
    Scene { size, facets: facets(&corners(mesh, size, 25.0), size, BASE) }
}

/// The mesh alone, lit at its vertices, with colours between them; with flat faces if it has no normals.
#[must_use]
pub fn smooth(mesh: &Mesh, size: [u32; 2]) -> Scene {
    let colours = |three: &[Corner; 3]| three.map(|corner| lit(BASE, light(corner.normal.map(f64::from))));
    Scene { size, facets: projected(&corners(mesh, size, 25.0), size, colours) }
}

/// The mesh twice, turned against each other, so that the two cut each other everywhere.
#[must_use]
pub fn crossing(mesh: &Mesh, size: [u32; 2]) -> Scene {
    let mut facets_of_both = facets(&corners(mesh, size, 25.0), size, [236, 190, 120]);
    facets_of_both.extend(facets(&corners(mesh, size, 70.0), size, [110, 170, 240]));
    Scene { size, facets: facets_of_both }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teapot::Teapot;

    #[test]
    fn textured_without_coordinates_wraps_and_with_coordinates_takes_them() {
        let mut mesh = Teapot::new(4, [255; 4]).mesh().clone();
        let wrapped = textured(&mesh, [80, 60], 25.0);
        for triangle in wrapped.as_chunks::<3>().0 {
            let first = triangle[0].coordinates[0];
            // ROUND is once round; half of that is the farthest that the nearest turn can be.
            assert!(triangle.iter().all(|corner| (corner.coordinates[0] - first).abs() <= 3.0001), "{triangle:?}");
        }
        assert!(wrapped.iter().any(|corner| corner.coordinates[0] > 1.0));

        mesh.texture_coordinates = Some(mesh.positions.iter().map(|[x, _, z]| [*x, *z]).collect());
        let own = textured(&mesh, [80, 60], 25.0);
        let expected = mesh.indices.iter().map(|index| mesh.positions[*index as usize]).map(|[x, _, z]| [x, z]);
        assert!(own.iter().map(|corner| corner.coordinates).eq(expected));
    }
}
