//! The same small scene twelve times, each with one effect of the card, the last with all of them.
//!
//! A ball and a block on a disc, seen in parallel, so that every cell shows the same thing from the same side. What
//! anti-aliasing adds is the second demonstration's: it is a setting of the whole picture.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use super::palette::{AMBER, CORAL, MIST, NIGHT, PORCELAIN, TEAL, hue, mix};
use super::{SIZE, looks, overlay, pictures, shapes, smooth_scene, turn};
use crate::mesh::Mesh;
use crate::scene::{
    Blend, Camera, Colour, Colours, FogFunction, Lighting, Material, Orthographic, Scene, Texture, TextureFilter,
    narrow,
};

/// Cells in a row, and rows.
const CELLS: [u32; 2] = [4, 3];
/// Pixels from one cell to the next.
const CELL: [f64; 2] = [200.0, 200.0];
/// Pixels for each world unit.
const UNIT: f64 = 72.0;
/// Distance of the viewer, and how far the gaze is lowered for each unit forward.
const DISTANCE: f64 = 20.0;
const LOWERED: f64 = 0.5;

/// What a cell shows.
struct Cell {
    name: &'static str,
    /// Colours belong to the triangles, not to the vertices.
    faceted: bool,
    /// Colours by place, else one for ball and one for block.
    rainbow: bool,
    /// Lines on ball and disc.
    decal: bool,
    material: Material,
}

impl Cell {
    fn of(name: &'static str, material: Material) -> Self {
        Self { name, faceted: false, rainbow: false, decal: false, material }
    }
}

/// The cells from left to right and from the top down.
fn cells() -> [Cell; 12] {
    let lit = || looks::glazed(Lighting::Pixel, 150, 36.0);
    let textured = |filter| {
        let mip_map = filter == TextureFilter::Trilinear;
        Material { texture: Some(Texture { mip_map, ..looks::repeated(&pictures::PATCHES, filter) }), ..lit() }
    };
    let holed = Material {
        texture: Some(looks::repeated(&pictures::LATTICE, TextureFilter::Bilinear)),
        punch_through: Some(128),
        two_sided: true,
        ..lit()
    };
    // Clear at the front of a cell, gone at its back with a scale of 0.6 for each world unit.
    let fog = |scale: f32, material| Material {
        fog_function: FogFunction::DepthCue,
        depth_cue_scale: scale,
        depth_cue_offset: scale * (DISTANCE as f32 - 0.75) + 1.0,
        fog_colour: NIGHT,
        ..material
    };
    let all = fog(0.3, Material { blend: Blend::Alpha, two_sided: true, ..textured(TextureFilter::Trilinear) });
    [
        Cell { faceted: true, rainbow: true, ..Cell::of("plain", looks::unlit()) },
        Cell { rainbow: true, ..Cell::of("gouraud", looks::unlit()) },
        Cell::of("light: vertex", looks::glazed(Lighting::Vertex, 150, 36.0)),
        Cell::of("light: pixel", lit()),
        Cell::of("nearest", textured(TextureFilter::Nearest)),
        Cell::of("bilinear", textured(TextureFilter::Bilinear)),
        Cell::of("trilinear", textured(TextureFilter::Trilinear)),
        Cell::of("fog", fog(0.56, lit())),
        Cell::of("blend", Material { blend: Blend::Alpha, two_sided: true, ..lit() }),
        Cell::of("punch-through", holed),
        Cell { decal: true, ..Cell::of("decal", lit()) },
        Cell { rainbow: true, decal: true, ..Cell::of("all of them", all) },
    ]
}

pub(super) fn scene(frame: u32) -> Scene {
    showing(Scene::new(SIZE, NIGHT), frame)
}

/// The same with 64 samples a pixel.
pub(super) fn smooth(frame: u32) -> Scene {
    showing(smooth_scene(SIZE, NIGHT), frame)
}

fn showing(mut scene: Scene, frame: u32) -> Scene {
    let back = DVec3::new(0.0, LOWERED, 1.0).normalize();
    scene.camera = Camera::Orthographic(Orthographic {
        eye: narrow(back * DISTANCE),
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        width: (f64::from(SIZE[0]) / UNIT) as f32,
        near: 10.0,
        far: 30.0,
    });
    scene.ambient = [70, 74, 92, 255];
    scene.lights = vec![looks::sun([-0.6, -0.75, -0.6], [222, 214, 198, 255])];
    let up = DVec3::new(0.0, 1.0, -LOWERED).normalize();
    looks::add(&mut scene, LINE, looks::unlit());
    for (number, cell) in (0_u32..).zip(cells()) {
        let [column, row] = [number % CELLS[0], number / CELLS[0]].map(f64::from);
        let [x, y] = [(column + 0.5) * CELL[0], row * CELL[1] + 104.0];
        // Moved along the picture's plane, so that every cell has the same depths.
        let place = DVec3::X * ((x - 400.0) / UNIT) + up * ((300.0 - y) / UNIT);
        cell.build(&mut scene, place, turn(frame));
        overlay::caption(&mut scene, [x, row * CELL[1] + 162.0], PORCELAIN, cell.name);
    }
    scene
}

/// Lines on surfaces.
const LINE: &str = "line";
/// Radius of the disc, the ball and half the block.
const DISC: f64 = 1.16;
const BALL: f64 = 0.52;
const BLOCK: DVec3 = DVec3::new(0.3, 0.48, 0.3);

impl Cell {
    fn build(&self, scene: &mut Scene, place: DVec3, angle: f64) {
        looks::add(scene, self.name, self.material.clone());
        let floor = format!("{} disc", self.name);
        // The disc stays opaque and whole, so that there is something to see through ball and block.
        let material = Material { blend: Blend::Opaque, punch_through: None, ..self.material.clone() };
        looks::add(scene, &floor, material);
        let textured = self.material.texture.is_some();
        let alpha = match (self.material.blend, textured) {
            (Blend::Opaque, _) => 255,
            (_, false) => 150,
            (_, true) => 205,
        };
        let tone = |colour: Colour| {
            let [r, g, b, _] = if textured && !self.rainbow { mix(colour, PORCELAIN, 0.7) } else { colour };
            [r, g, b, alpha]
        };
        let turned = DMat4::from_translation(place) * DMat4::from_rotation_y(angle + 0.5);
        let ball = DMat4::from_translation(DVec3::new(-0.34, BALL, 0.34));
        let block = DMat4::from_translation(DVec3::new(0.42, BLOCK.y, -0.4)) * DMat4::from_rotation_y(0.4);
        // Half a picture on each side: texels so large that filters can be told apart.
        let mut coarse = looks::block(BLOCK, tone(TEAL));
        for pair in coarse.texture_coordinates.iter_mut().flatten() {
            *pair = pair.map(|coordinate| coordinate / 2.0);
        }
        // Few cells, so that vertices can be told from pixels.
        let parts = [
            (looks::globe(BALL, [20, 10], [2.0, 1.0], tone(CORAL)), turned * ball, 0.0),
            (coarse, turned * block, 0.45),
        ];
        let dark = mix(MIST, NIGHT, if textured { 0.0 } else { 0.25 });
        let disc = self.painted(disc(dark), 0.6, 255);
        scene.draw.push(looks::of(shapes::placed(disc, turned), &floor));
        for (mesh, transform, tint) in parts {
            let mesh = self.painted(mesh, tint, alpha);
            scene.draw.push(looks::of(shapes::placed(mesh, transform), self.name));
        }
        if self.decal {
            let [ball, block] = [ball, block].map(|part| turned * part);
            for (lines, colour) in [(rings(turned), AMBER), (meridians(ball), PORCELAIN), (cross(block), AMBER)] {
                scene.draw.push(looks::of(shapes::decal(vec![shapes::wide_lines(lines, colour, 2.0)]), LINE));
            }
        }
    }

    /// The mesh in the colours of the cell.
    fn painted(&self, mut mesh: Mesh, tint: f64, alpha: u8) -> Mesh {
        let height = mesh.bounds().greatest[1];
        let shade = |at: DVec3| {
            let [r, g, b, _] = hue(tint + 0.5 * (at.z.atan2(at.x) / TAU).abs() + 0.3 * at.y);
            let colour = mix([r, g, b, 255], NIGHT, if height < 0.1 { 0.45 * at.length() } else { 0.0 });
            [colour[0], colour[1], colour[2], alpha]
        };
        if self.rainbow {
            let middle = |corners: [u32; 3]| corners.map(|corner| mesh.corner(corner)).iter().sum::<DVec3>() / 3.0;
            mesh.colours = if self.faceted {
                Colours::PerFace(mesh.triangles().map(|corners| shade(middle(corners))).collect())
            } else {
                Colours::PerVertex((0..mesh.positions.len() as u32).map(|index| shade(mesh.corner(index))).collect())
            };
        }
        mesh
    }
}

/// A round floor, a fan in two rings, whose texture lies along x and z.
fn disc(colour: Colour) -> Mesh {
    const SIDES: u32 = 36;
    let (mut positions, mut indices) = (vec![[0.0; 3]], Vec::new());
    for side in 0..SIDES {
        let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
        positions.extend([0.5, 1.0].map(|part| narrow(DVec3::new(cosine, 0.0, -sine) * DISC * part)));
        let [a, b] = [1 + 2 * side, 1 + 2 * ((side + 1) % SIDES)];
        indices.extend([0, a, b, a, a + 1, b, b, a + 1, b + 1]);
    }
    let mut mesh = Mesh::new("disc", positions, indices, colour);
    mesh.normals = Some(vec![[0.0, 1.0, 0.0]; mesh.positions.len()]);
    mesh.texture_coordinates = Some(mesh.positions.iter().map(|at| [at[0] * 2.6, at[2] * 2.6]).collect());
    mesh
}

fn placed(points: impl Iterator<Item = DVec3>, transform: DMat4) -> Vec<[f32; 3]> {
    shapes::pieces(&points.map(|point| narrow(transform.transform_point3(point))).collect::<Vec<_>>(), false)
}

/// Circles on the disc.
fn rings(transform: DMat4) -> Vec<[f32; 3]> {
    let ring = |radius: f64| {
        let at = move |step: u32| {
            let (sine, cosine) = (TAU * f64::from(step) / 72.0).sin_cos();
            DVec3::new(radius * cosine, 0.0, radius * sine)
        };
        placed((0..=72).map(at), transform)
    };
    [0.35, 0.7, 1.05].into_iter().flat_map(ring).collect()
}

/// Every other meridian of the ball and three of its parallels, along the edges of its triangles.
fn meridians(transform: DMat4) -> Vec<[f32; 3]> {
    let point = |column: u32, row: u32| {
        let (sine, cosine) = (TAU * f64::from(column) / 20.0).sin_cos();
        let (ring, height) = (TAU * f64::from(row) / 20.0).sin_cos();
        BALL * DVec3::new(ring * sine, height, ring * cosine)
    };
    let mut all: Vec<_> =
        (0..20).step_by(2).flat_map(|column| placed((0..=10).map(|row| point(column, row)), transform)).collect();
    for row in [3, 5, 7] {
        all.extend(placed((0..=20).map(|column| point(column, row)), transform));
    }
    all
}

/// Two diagonals on each side of the block.
fn cross(transform: DMat4) -> Vec<[f32; 3]> {
    let mesh = looks::block(BLOCK, [255; 4]);
    let sides = (0..mesh.positions.len() as u32).step_by(4);
    sides
        .flat_map(|first| [[first, first + 2], [first + 1, first + 3]])
        .flat_map(|ends| placed(ends.map(|end| mesh.corner(end)).into_iter(), transform))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_different_materials_and_each_effect_once_before_the_last() {
        let cells = cells();
        let before = &cells[..11];
        let count = |has: &dyn Fn(&Material) -> bool| before.iter().filter(|cell| has(&cell.material)).count();
        assert_eq!(count(&|m| m.fog_function != FogFunction::None), 1);
        assert_eq!(count(&|m| m.blend != Blend::Opaque), 1);
        assert_eq!(count(&|m| m.punch_through.is_some()), 1);
        assert_eq!(count(&|m| m.light == Some(Lighting::Vertex)), 1);
        for filter in [TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Trilinear] {
            let named = before.iter().filter(|cell| cell.name == filter.name());
            let found: Vec<_> = named.filter_map(|cell| cell.material.texture.as_ref()).collect();
            assert_eq!(found.iter().map(|texture| texture.filter).collect::<Vec<_>>(), [filter]);
        }
    }

    #[test]
    fn scene_cells_keep_to_their_place_in_every_frame_tried() {
        // Those that can be told by their material.
        let all = cells();
        let same = |cell: &Cell| all.iter().filter(|other| other.material == cell.material).count();
        let alone: Vec<&Cell> = all.iter().filter(|cell| same(cell) == 1).collect();
        for frame in [0, 20, 45, 100] {
            let scene = scene(frame);
            let seen = scene.batches().into_iter().filter(|batch| batch.path.starts_with("draw"));
            let mut of_cells: std::collections::BTreeMap<String, [f64; 4]> = std::collections::BTreeMap::new();
            for batch in seen {
                let Some(cell) = alone.iter().find(|cell| cell.material == *batch.material) else { continue };
                let transform = crate::scene::wide;
                let matrix = DMat4::from_cols_array(&batch.transform.map(f64::from));
                for point in &batch.positions {
                    let world = narrow(matrix.transform_point3(transform(*point)));
                    let Some([x, y, _]) = scene.camera.project(world, SIZE) else { continue };
                    let all = of_cells.entry(cell.name.to_owned()).or_insert([x, x, y, y]);
                    *all = [all[0].min(x), all[1].max(x), all[2].min(y), all[3].max(y)];
                }
            }
            assert_eq!(of_cells.len(), 8, "{of_cells:?}");
            assert!(of_cells.values().all(|[left, right, top, bottom]| right - left < 200.0 && bottom - top < 170.0));
        }
    }

    #[test]
    fn disc_faces_upwards() {
        let mesh = disc([255; 4]);
        assert_eq!(mesh.check(), Ok(()));
        assert!(mesh.triangles().all(|corners| mesh.face_vector(corners).y > 0.0));
    }

    #[test]
    fn meridians_run_along_the_edges_of_the_ball() {
        let ball = looks::globe(BALL, [20, 10], [1.0; 2], [255; 4]);
        let near = |point: &[f32; 3]| {
            let off = |other: &[f32; 3]| crate::scene::wide(*point).distance(crate::scene::wide(*other));
            ball.positions.iter().map(off).fold(f64::MAX, f64::min)
        };
        // Single precision of numbers below one.
        assert!(meridians(DMat4::IDENTITY).iter().all(|point| near(point) < 1e-6));
    }
}
