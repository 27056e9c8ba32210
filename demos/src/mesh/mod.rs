//! Triangle meshes: loading, bounds, feature edges, a view that frames them, and light baked into colours.
//!
//! Inputs from: .obj, .gltf and .glb files, [`crate::teapot`], the shapes of the demonstrations.
//! Outputs to: the scene. A `Mesh` from a loader is valid: every index is in range and every number finite.

mod accessor;
mod bake;
mod draco;
#[cfg(test)]
mod draco_tests;
mod edges;
mod gltf_file;
mod gltf_light;
mod gltf_material;
#[cfg(test)]
mod material_tests;
mod mtl;
mod obj;
#[cfg(test)]
mod tests;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;

use crate::error::{Error, Result};
use crate::limits;
use crate::scene::{Colour, Colours, Light, Material, Perspective};

/// Colour of a surface whose file gives none.
pub const PLAIN_COLOUR: Colour = [206, 202, 194, 255];

/// Triangles, with lines and points where the file has them.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Name for messages: the file's name.
    pub name: String,
    /// Positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one for each vertex, or none: then each triangle is flat.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates, one pair for each vertex: v grows downward from the picture's first row.
    pub texture_coordinates: Option<Vec<[f32; 2]>>,
    /// Colours before any light.
    pub colours: Colours,
    /// Triangles, three indices of vertices each.
    pub indices: Vec<u32>,
    /// Separate lines, two indices each.
    pub lines: Vec<u32>,
    /// Points, one index each.
    pub points: Vec<u32>,
    /// Runs of triangles with a material each, in order and together all of them; none where all triangles have the
    /// default one.
    pub parts: Vec<Part>,
    /// Lights of the file, where the mesh stands; for who shows the mesh alone.
    pub lights: Vec<Light>,
    /// What was left out or guessed while the mesh was read.
    pub warnings: Vec<String>,
}

/// A run of triangles with one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The triangles, exclusive end.
    pub triangles: Range<usize>,
    /// How they look. Its colour is in the vertices.
    pub material: Arc<Material>,
}

/// The space that a mesh takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub least: [f32; 3],
    /// Greatest coordinates.
    pub greatest: [f32; 3],
    /// Middle of the box.
    pub centre: [f32; 3],
    /// Distance of the farthest vertex from `centre`.
    pub radius: f32,
}

/// Reads a mesh; the ending of the name says which kind.
///
/// # Errors
/// Names the file and what is wrong in it. Damaged files give errors, never a panic.
pub fn load(file: &Path) -> Result<Mesh> {
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let bytes = match ending.as_deref() {
        Some("obj" | "gltf" | "glb") => limits::read_file(file)?,
        _ => return Err(Error::mesh(file, "has none of the endings .obj, .gltf, .glb")),
    };
    from_bytes(&bytes, file)
}

/// Reads a mesh whose bytes are in memory. `file` gives the kind, the folder of what the mesh refers to, and the name
/// for messages.
///
/// # Errors
/// As [`load`].
pub fn from_bytes(bytes: &[u8], file: &Path) -> Result<Mesh> {
    let is_obj = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
    let mut mesh = if is_obj { obj::read(bytes, file)? } else { gltf_file::read(bytes, file)? };
    mesh.check().map_err(|reason| Error::mesh(file, reason))?;
    mesh.name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    Ok(mesh)
}

impl Mesh {
    /// A mesh of one colour, without normals.
    #[must_use]
    pub fn new(name: &str, positions: Vec<[f32; 3]>, indices: Vec<u32>, colour: Colour) -> Self {
        Self {
            name: name.to_owned(),
            positions,
            normals: None,
            texture_coordinates: None,
            colours: Colours::One(colour),
            indices,
            lines: Vec::new(),
            points: Vec::new(),
            parts: Vec::new(),
            lights: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// What makes the mesh unfit for drawing, if anything does.
    ///
    /// # Errors
    /// A sentence without the file's name.
    pub fn check(&self) -> std::result::Result<(), String> {
        let count = self.positions.len();
        if count == 0 || self.indices.len() + self.lines.len() + self.points.len() == 0 {
            return Err("holds nothing that can be drawn".to_owned());
        }
        if count > limits::MAX_MESH_VERTICES {
            return Err(format!("has {count} vertices, expected at most {}", limits::MAX_MESH_VERTICES));
        }
        let indices = [&self.indices, &self.lines, &self.points];
        if let Some(index) = indices.iter().flat_map(|list| list.iter()).find(|index| **index as usize >= count) {
            return Err(format!("refers to vertex {index} of {count}"));
        }
        if let Some(vertex) = self.positions.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
            return Err(format!("position {vertex} (from 0) is not finite"));
        }
        if self.normals.as_ref().is_some_and(|normals| normals.len() != count) {
            return Err("has not one normal for each vertex".to_owned());
        }
        if let Some(coordinates) = &self.texture_coordinates {
            if coordinates.len() != count {
                return Err("has not one pair of texture coordinates for each vertex".to_owned());
            }
            if let Some(vertex) = coordinates.iter().position(|pair| pair.iter().any(|c| !c.is_finite())) {
                return Err(format!("texture coordinate {vertex} (from 0) is not finite"));
            }
        }
        let mut end = 0;
        for part in &self.parts {
            if part.triangles.start != end || part.triangles.end < end {
                return Err(format!("has parts with a gap or an overlap at triangle {end}"));
            }
            end = part.triangles.end;
        }
        if !self.parts.is_empty() && end != self.triangle_count() {
            return Err(format!("has parts of {end} triangles, but {} triangles", self.triangle_count()));
        }
        match &self.colours {
            Colours::PerVertex(list) if list.len() != count => Err("has not one colour for each vertex".to_owned()),
            Colours::PerFace(list) if list.len() * 3 != self.indices.len() => {
                Err("has not one colour for each triangle".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// The corners of each triangle.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]])
    }

    pub(crate) fn corner(&self, index: u32) -> DVec3 {
        crate::scene::wide(self.positions[index as usize])
    }

    /// Twice the area of a triangle times its unit normal (anticlockwise seen from outside).
    pub(crate) fn face_vector(&self, [a, b, c]: [u32; 3]) -> DVec3 {
        let (a, b, c) = (self.corner(a), self.corner(b), self.corner(c));
        (b - a).cross(c - a)
    }

    /// The space that the vertices take; all zero for no vertices.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let Some(first) = self.positions.first() else {
            return Bounds { least: [0.0; 3], greatest: [0.0; 3], centre: [0.0; 3], radius: 0.0 };
        };
        let (mut least, mut greatest) = (*first, *first);
        for position in &self.positions {
            for axis in 0..3 {
                least[axis] = least[axis].min(position[axis]);
                greatest[axis] = greatest[axis].max(position[axis]);
            }
        }
        let centre = crate::scene::wide(least).midpoint(crate::scene::wide(greatest));
        let square = |position: &[f32; 3]| crate::scene::wide(*position).distance_squared(centre);
        let radius = self.positions.iter().map(square).fold(0.0, f64::max).sqrt() as f32;
        Bounds { least, greatest, centre: crate::scene::narrow(centre), radius: radius.min(f32::MAX) }
    }

    /// A three-quarter view from the front, right and above that shows the whole mesh on a target of `size` pixels.
    #[must_use]
    pub fn default_camera(&self, size: [u32; 2]) -> Perspective {
        const FOV_DEGREES: f64 = 36.0;
        const ROOM: f64 = 1.04;
        let bounds = self.bounds();
        // Coordinates past this would overflow the view; they are framed as if they ended here. And single precision
        // must still tell the eye from the target when a small thing lies far from the origin.
        let centre = crate::scene::wide(bounds.centre).clamp(DVec3::splat(-1e18), DVec3::splat(1e18));
        let radius = f64::from(bounds.radius).clamp(1e-6 + centre.length() * 1e-5, 1e18);
        let half_x = (FOV_DEGREES / 2.0).to_radians();
        let aspect = f64::from(size[0].max(1)) / f64::from(size[1].max(1));
        let half_y = (half_x.tan() / aspect).atan();
        let distance = ROOM * radius / half_x.min(half_y).sin();
        let eye = centre + DVec3::new(0.55, 0.42, 1.0).normalize() * distance;
        Perspective {
            eye: crate::scene::narrow(eye),
            target: crate::scene::narrow(centre),
            up: [0.0, 1.0, 0.0],
            fov_x_degrees: FOV_DEGREES as f32,
            near: (distance - ROOM * radius).max(distance * 1e-3) as f32,
            far: (distance + ROOM * radius) as f32,
        }
    }
}

/// A name of a file for a message, in quotes and cut when it is long.
fn shortened(name: &str) -> String {
    const LONGEST: usize = 60;
    match name.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{:?}...", &name[..end]),
        None => format!("{name:?}"),
    }
}

/// Colour and sharpness of a highlight as the card takes them. One so wide that all of the lit side would shine is
/// none: with an exponent near 0 the card would light up everything to the very edge.
fn highlight([r, g, b]: [u8; 3], exponent: f32) -> (Colour, f32) {
    match exponent >= 1.0 && [r, g, b] != [0; 3] {
        true => ([r, g, b, 255], exponent.min(128.0)),
        false => (crate::scene::DARK, 0.0),
    }
}

/// One colour for all where the vertices have but one.
fn simplest(colours: Vec<Colour>) -> Colours {
    match colours.first() {
        Some(first) if colours.iter().all(|colour| colour == first) => Colours::One(*first),
        Some(_) => Colours::PerVertex(colours),
        None => Colours::One(PLAIN_COLOUR),
    }
}
