//! glTF 2.0 files, as text (.gltf) or binary (.glb).
//!
//! Duties: walks the nodes of the default scene, places their meshes in the world, and cuts strips, fans and loops into
//! triangles and lines. Read are positions, normals, texture coordinates and the first set of vertex colours, also of
//! primitives that are compressed ([`super::draco`]); materials ([`super::gltf_material`]) and lights
//! ([`super::gltf_light`]). What the file has beyond that is named in the warnings.

use std::path::Path;

use glam::{DMat4, DVec3};
use gltf::mesh::Mode;

use super::accessor::Buffers;
use super::draco::{self, Vertices};
use super::gltf_light::{self, Lamps};
use super::gltf_material::{self, Materials, Placement};
use super::{Mesh, PLAIN_COLOUR, Part, shortened, simplest};
use crate::error::{Error, Result};
use crate::limits::{MAX_MESH_INDICES, MAX_MESH_VERTICES};
use crate::scene::{Colour, Material, narrow, wide};

type Read<T> = std::result::Result<T, String>;

/// Extensions that are read.
const EXTENSIONS: [&str; 4] = [gltf_material::UNLIT, gltf_material::TRANSFORM, gltf_light::EXTENSION, draco::EXTENSION];

/// Deepest nesting of nodes.
const MAX_DEPTH: usize = 64;
/// Most nodes that are visited; a graph that names nodes again and again ends here.
const MAX_VISITS: usize = 1 << 20;

/// Reads a file whose bytes are in memory.
pub(super) fn read(bytes: &[u8], file: &Path) -> Result<Mesh> {
    let folder = file.parent().unwrap_or(Path::new(""));
    document(bytes, folder).map_err(|reason| Error::mesh(file, reason))
}

fn document(bytes: &[u8], folder: &Path) -> Read<Mesh> {
    if bytes.starts_with(b"glTF") {
        check_header(bytes)?;
    }
    let invalid = |fault: gltf::Error| format!("is not valid glTF: {fault}");
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(bytes).map_err(invalid)?;
    let mut json = document.into_json();
    check_extensions(&json)?;
    // The validation that follows knows the extensions of its crate only.
    json.extensions_required.retain(|name| name != draco::EXTENSION);
    check_attributes(&json)?;
    let document = validated(json).map_err(invalid)?;
    let buffers = Buffers::load(&document, blob, folder)?;
    let mut builder = Builder { warnings: beyond(&document), ..Builder::default() };
    let mut materials = Materials::new(&document, &buffers, folder);
    let mut lamps = Lamps::default();
    let mut visits = 0;
    // Without a scene every root is shown; a node that some other names is no root.
    let roots: Vec<gltf::Node<'_>> = match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().collect(),
        None => {
            let inner: std::collections::HashSet<usize> =
                document.nodes().flat_map(|node| node.children().map(|child| child.index())).collect();
            document.nodes().filter(|node| !inner.contains(&node.index())).collect()
        }
    };
    let mut waiting: Vec<(gltf::Node<'_>, DMat4, usize)> =
        roots.into_iter().rev().map(|node| (node, DMat4::IDENTITY, 0)).collect();
    while let Some((node, outer, depth)) = waiting.pop() {
        visits += 1;
        if depth > MAX_DEPTH || visits > MAX_VISITS {
            return Err(format!("node {}: nodes are nested too deep or in a circle", node.index()));
        }
        let local = node.transform().matrix().map(|column| column.map(f64::from));
        let matrix = outer * DMat4::from_cols_array_2d(&local);
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                let place = format!("mesh {} primitive {}", mesh.index(), primitive.index());
                let vertices = Vertices::of(&primitive, &document, &buffers);
                vertices
                    .and_then(|vertices| builder.primitive(&primitive, &vertices, matrix, &mut materials))
                    .map_err(|reason| format!("{place}: {reason}"))?;
            }
        }
        if let Some(light) = node.light() {
            lamps.add(&light, matrix);
        }
        let first = waiting.len();
        waiting.extend(node.children().map(|child| (child, matrix, depth + 1)));
        waiting[first..].reverse();
    }
    let mut mesh = builder.finish();
    mesh.warnings.extend(materials.into_warnings());
    mesh.lights = lamps.finish(&mesh.bounds(), &mut mesh.warnings);
    Ok(mesh)
}

/// What the file has and is not read, a line each.
fn beyond(document: &gltf::Document) -> Vec<String> {
    let unread = document.extensions_used().filter(|name| !EXTENSIONS.contains(name));
    let mut lines: Vec<String> =
        unread.take(16).map(|name| format!("extension {} left out", shortened(name))).collect();
    let primitives = document.meshes().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
    let morphs = primitives.filter(|primitive| primitive.morph_targets().len() > 0).count();
    let counts = [
        ("animations", document.animations().len()),
        ("skins", document.skins().len()),
        ("cameras", document.cameras().len()),
        ("primitives with morph targets, drawn without them", morphs),
    ];
    let there = counts.iter().filter(|(_, count)| *count > 0);
    lines.extend(there.map(|(what, count)| format!("{what} left out: {count}")));
    lines
}

/// Refuses files that cannot be understood without an extension that is not read here.
fn check_extensions(json: &gltf::json::Root) -> Read<()> {
    match json.extensions_required.iter().find(|name| !EXTENSIONS.contains(&name.as_str())) {
        Some(name) => Err(format!("needs the glTF extension {name}, which is not supported; export it without")),
        None => Ok(()),
    }
}

/// The document, if its structure is sound. In a file with compressed primitives accessors may lack a view: those of
/// what is compressed do.
fn validated(json: gltf::json::Root) -> std::result::Result<gltf::Document, gltf::Error> {
    use gltf::json::validation::{Error, Validate};
    let mut faults = Vec::new();
    json.validate(&json, gltf::json::Path::new, &mut |path, fault| faults.push((path(), fault)));
    if json.extensions_used.iter().any(|name| name == draco::EXTENSION) {
        let is_view = |path: &str| path.starts_with("accessors[") && path.ends_with("].bufferView");
        faults.retain(|(path, fault)| !(*fault == Error::Missing && is_view(path.as_str())));
    }
    match faults.is_empty() {
        true => Ok(gltf::Document::from_json_without_validation(json)),
        false => Err(gltf::Error::Validation(faults)),
    }
}

/// Refuses attributes without an accessor. The validation that follows would, but looks into that accessor first.
fn check_attributes(json: &gltf::json::Root) -> Read<()> {
    for (number, mesh) in json.meshes.iter().enumerate() {
        for index in mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values()) {
            if index.value() >= json.accessors.len() {
                let count = json.accessors.len();
                return Err(format!("mesh {number} names accessor {} of {count}", index.value()));
            }
        }
    }
    Ok(())
}

/// Refuses binary headers whose length makes no sense.
fn check_header(bytes: &[u8]) -> Read<()> {
    const HEADER: usize = 12;
    let Some(stated) = bytes.get(8..HEADER) else {
        return Err(format!("ends inside the binary header: {} bytes", bytes.len()));
    };
    let stated = stated.iter().rev().fold(0_usize, |value, byte| value << 8 | usize::from(*byte));
    if stated < HEADER || stated > bytes.len() {
        return Err(format!("the header says {stated} bytes, the file has {}", bytes.len()));
    }
    Ok(())
}

#[derive(Default)]
struct Builder {
    positions: Vec<[f32; 3]>,
    /// Zero where a vertex has none.
    normals: Vec<DVec3>,
    colours: Vec<Colour>,
    /// Zero where a vertex has none, and shorter than the positions where the last ones have none.
    coordinates: Vec<[f32; 2]>,
    triangles: Vec<u32>,
    parts: Vec<Part>,
    lines: Vec<u32>,
    points: Vec<u32>,
    warnings: Vec<String>,
}

impl Builder {
    fn primitive(
        &mut self,
        primitive: &gltf::Primitive<'_>,
        vertices: &Vertices<'_>,
        matrix: DMat4,
        materials: &mut Materials<'_>,
    ) -> Read<()> {
        let rows = vertices.rows(&gltf::Semantic::Positions, 3, "positions")?;
        let count = rows.len() / 3;
        let base = self.positions.len();
        if base + count > MAX_MESH_VERTICES {
            return Err(format!("more than {MAX_MESH_VERTICES} vertices"));
        }
        for row in rows.chunks_exact(3) {
            let placed = narrow(matrix.transform_point3(DVec3::new(row[0], row[1], row[2])));
            if placed.iter().any(|coordinate| !coordinate.is_finite()) {
                return Err(format!("position {} is not finite", self.positions.len() - base));
            }
            self.positions.push(placed);
        }
        self.add_normals(vertices, matrix, count)?;
        self.add_colours(primitive, vertices, count)?;
        let placement = materials.placement(&primitive.material());
        let has_coordinates = self.add_coordinates(vertices, placement, base, count)?;

        let order = match vertices.indices() {
            None => (0..count as u32).collect(),
            Some(rows) => indices(&rows?, count)?,
        };
        let base = base as u32;
        let order: Vec<u32> = order.into_iter().map(|index| base + index).collect();
        let mode = if vertices.are_compressed() { Mode::Triangles } else { primitive.mode() };
        match mode {
            Mode::Points => self.points.extend(&order),
            Mode::Lines => self.lines.extend(order.as_chunks::<2>().0.as_flattened()),
            Mode::LineStrip | Mode::LineLoop => {
                self.lines.extend(order.windows(2).flatten());
                if let (Mode::LineLoop, [first, _, .., last]) = (mode, &order[..]) {
                    self.lines.extend([*last, *first]);
                }
            }
            mode => {
                // A mirrored node turns every triangle over.
                let mirrored = matrix.determinant() < 0.0;
                let turn = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
                let first = self.triangles.len() / 3;
                self.triangles.extend(triangles(&order, mode).flat_map(turn));
                let end = self.triangles.len() / 3;
                let material = materials.of(&primitive.material(), has_coordinates);
                match self.parts.last_mut() {
                    Some(last) if last.material == material => last.triangles.end = end,
                    _ => self.parts.push(Part { triangles: first..end, material }),
                }
            }
        }
        match [&self.triangles, &self.lines, &self.points].iter().any(|list| list.len() > MAX_MESH_INDICES) {
            true => Err(format!("more than {MAX_MESH_INDICES} indices")),
            false => Ok(()),
        }
    }

    fn add_normals(&mut self, vertices: &Vertices<'_>, matrix: DMat4, count: usize) -> Read<()> {
        if vertices.accessor(&gltf::Semantic::Normals).is_some() {
            let rows = vertices.rows(&gltf::Semantic::Normals, 3, "normals")?;
            same_count(rows.len() / 3, count, "normals")?;
            // Normals go with the cofactors, which exist even where the inverse does not.
            let (x, y, z) = (matrix.x_axis.truncate(), matrix.y_axis.truncate(), matrix.z_axis.truncate());
            let side = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
            let (cx, cy, cz) = (y.cross(z), z.cross(x), x.cross(y));
            let place = |n: &[f64]| ((cx * n[0] + cy * n[1] + cz * n[2]) * side).normalize_or_zero();
            self.normals.extend(rows.chunks_exact(3).map(place));
        }
        self.normals.resize(self.positions.len(), DVec3::ZERO);
        Ok(())
    }

    fn add_colours(&mut self, primitive: &gltf::Primitive<'_>, vertices: &Vertices<'_>, count: usize) -> Read<()> {
        let material = primitive.material();
        let factor = match material.index() {
            Some(_) => material.pbr_metallic_roughness().base_color_factor(),
            None => PLAIN_COLOUR.map(|value| (f32::from(value) / 255.0).powf(2.2)),
        };
        let Some(accessor) = vertices.accessor(&gltf::Semantic::Colors(0)) else {
            self.colours.resize(self.positions.len(), shown(factor));
            return Ok(());
        };
        let components = accessor.dimensions().multiplicity();
        if components != 4 && components != 3 {
            return Err(format!("colours have {components} components, expected 3 or 4"));
        }
        let rows = vertices.rows(&gltf::Semantic::Colors(0), components, "colours")?;
        same_count(rows.len() / components, count, "colours")?;
        let factor = if material.index().is_some() { factor } else { [1.0; 4] };
        let mixed = |row: &[f64]| {
            let vertex: [f32; 4] = std::array::from_fn(|channel| row.get(channel).map_or(1.0, |value| *value as f32));
            shown(std::array::from_fn(|channel| factor[channel] * f32::min(vertex[channel], 1.0)))
        };
        self.colours.extend(rows.chunks_exact(components).map(mixed));
        Ok(())
    }

    /// Adds texture coordinates of a set, if the primitive has it.
    fn add_coordinates(&mut self, vertices: &Vertices<'_>, from: Placement, base: usize, count: usize) -> Read<bool> {
        let set = gltf::Semantic::TexCoords(from.set);
        if vertices.accessor(&set).is_none() {
            return Ok(false);
        }
        let rows = vertices.rows(&set, 2, "texture coordinates")?;
        same_count(rows.len() / 2, count, "texture coordinates")?;
        self.coordinates.resize(base, [0.0; 2]);
        let place =
            |row: &[f64; 2]| std::array::from_fn(|axis| (row[axis] * from.scale[axis] + from.offset[axis]) as f32);
        self.coordinates.extend(rows.as_chunks::<2>().0.iter().map(place));
        Ok(true)
    }

    fn finish(mut self) -> Mesh {
        let with = self.normals.iter().filter(|normal| **normal != DVec3::ZERO).count();
        let normals = (with > 0 && !self.triangles.is_empty()).then(|| {
            if with < self.normals.len() {
                self.warnings.push("missing normals worked out from the faces".to_owned());
                self.fill_normals();
            }
            self.normals.iter().map(|normal| narrow(*normal)).collect()
        });
        let mut mesh = Mesh::new("", self.positions, self.triangles, PLAIN_COLOUR);
        mesh.normals = normals;
        if !self.coordinates.is_empty() {
            self.coordinates.resize(mesh.positions.len(), [0.0; 2]);
            mesh.texture_coordinates = Some(self.coordinates);
        }
        if self.parts.iter().any(|part| *part.material != Material::default()) {
            mesh.parts = self.parts;
        }
        mesh.colours = simplest(self.colours);
        mesh.lines = self.lines;
        mesh.points = self.points;
        mesh.warnings = self.warnings;
        mesh
    }

    /// Gives the vertices without a normal the mean of their faces', weighted by area.
    fn fill_normals(&mut self) {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for corners in self.triangles.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| wide(self.positions[corners[corner] as usize]));
            let face = (b - a).cross(c - a);
            for corner in corners {
                sums[*corner as usize] += face;
            }
        }
        for (normal, sum) in self.normals.iter_mut().zip(sums) {
            if *normal == DVec3::ZERO {
                *normal = sum.normalize_or(DVec3::Y);
            }
        }
    }
}

fn same_count(found: usize, expected: usize, what: &str) -> Read<()> {
    if found == expected { Ok(()) } else { Err(format!("has {found} {what} for {expected} positions")) }
}

fn indices(rows: &[f64], count: usize) -> Read<Vec<u32>> {
    let check = |row: &f64| {
        let in_range = *row >= 0.0 && *row < count as f64 && row.fract() == 0.0;
        if in_range { Ok(*row as u32) } else { Err(format!("index {row} of {count} vertices")) }
    };
    rows.iter().map(check).collect()
}

/// The triangles of a list, strip or fan, all wound the same way.
fn triangles(order: &[u32], mode: Mode) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
    match mode {
        Mode::TriangleStrip => Box::new(order.windows(3).enumerate().map(|(index, corners)| {
            if index % 2 == 0 { [corners[0], corners[1], corners[2]] } else { [corners[1], corners[0], corners[2]] }
        })),
        Mode::TriangleFan => {
            let hub = order.first().copied().unwrap_or(0);
            Box::new(order.windows(2).skip(1).map(move |rim| [hub, rim[0], rim[1]]))
        }
        _ => Box::new(order.as_chunks::<3>().0.iter().copied()),
    }
}

/// A linear colour as it is shown.
pub(super) fn shown(linear: [f32; 4]) -> Colour {
    let encode = |value: f32| {
        let value = value.clamp(0.0, 1.0);
        if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
    };
    let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
    [byte(encode(linear[0])), byte(encode(linear[1])), byte(encode(linear[2])), byte(linear[3])]
}
