//! Wavefront .obj files. Their material libraries are in [`super::mtl`].
//!
//! `tobj` does the reading; before it sees a line, the line is checked here. That gives messages with line numbers, and
//! keeps from it what it cannot take: texture and normal indices out of range, short colours in material libraries,
//! and `l` and `p` elements (which it would turn into triangles).

use std::fmt::Write as _;
use std::path::Path;

use super::mtl::{self, Surfaces};
use super::{Mesh, PLAIN_COLOUR, Part};
use crate::error::{Error, Result};
use crate::limits;
use crate::scene::{Colour, Material};

/// Reads a file whose bytes are in memory; faces with more than three corners are cut into fans.
pub(super) fn read(bytes: &[u8], file: &Path) -> Result<Mesh> {
    let mut warnings = Vec::new();
    let text = String::from_utf8_lossy(bytes);
    let checked = check(&text, &mut warnings).map_err(|reason| Error::mesh(file, reason))?;
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    let folder = file.parent().unwrap_or(Path::new(""));
    let left_out = std::cell::RefCell::new(Vec::new());
    let library = |name: &Path| match limits::read_file(&folder.join(name)) {
        Ok(bytes) => {
            let text = mtl::plain_library(&String::from_utf8_lossy(&bytes), &mut left_out.borrow_mut());
            tobj::load_mtl_buf(&mut text.as_bytes())
        }
        Err(fault) => {
            left_out.borrow_mut().push(format!("material library left out: {fault}"));
            Err(tobj::LoadError::OpenFileFailed)
        }
    };
    let (models, materials) = tobj::load_obj_buf(&mut checked.as_bytes(), &options, library)
        .map_err(|fault| Error::mesh(file, fault.to_string()))?;
    warnings.extend(left_out.into_inner());
    let materials = materials.unwrap_or_default();
    let mut surfaces = Surfaces::new(&materials, folder);
    let mut mesh = join(&models, &mut surfaces, &mut warnings).map_err(|reason| Error::mesh(file, reason))?;
    warnings.extend(surfaces.into_warnings());
    mesh.warnings = warnings;
    Ok(mesh)
}

/// Checks every line that matters and gives the text that `tobj` is to read.
fn check(text: &str, warnings: &mut Vec<String>) -> std::result::Result<String, String> {
    let mut kept = String::with_capacity(text.len());
    let (mut positions, mut coordinates, mut normals) = (0_usize, 0_usize, 0_usize);
    let (mut faces, mut corners, mut loose, mut empty) = (0_usize, 0_usize, 0_usize, 0_usize);
    // A backslash at the end of a line joins it with the next.
    let joined = text.replace("\\\r\n", " ").replace("\\\n", " ");
    for (number, line) in (1..).zip(joined.lines()) {
        let line = line.split('#').next().unwrap_or("").trim();
        let mut words = line.split_whitespace();
        let at = |reason: String| format!("line {number}: {reason}");
        match words.next() {
            Some("v") => {
                let values = finite(words).map_err(at)?;
                if ![3, 4, 6].contains(&values.len()) {
                    return Err(at(format!("a position has {} numbers, expected 3, 4 or 6", values.len())));
                }
                // The fourth number is a weight that only curves use.
                let values = if values.len() == 4 { &values[..3] } else { &values[..] };
                write_numbers(&mut kept, "v", values);
                positions += 1;
            }
            Some("vn") => {
                let values = finite(words).map_err(at)?;
                let [x, y, z] = values[..] else {
                    return Err(at(format!("a normal has {} numbers, expected 3", values.len())));
                };
                write_numbers(&mut kept, "vn", &[x, y, z]);
                normals += 1;
            }
            Some("vt") => {
                let values = finite(words).map_err(at)?;
                let u = *values.first().ok_or_else(|| at("a texture coordinate has no number".to_owned()))?;
                write_numbers(&mut kept, "vt", &[u, values.get(1).copied().unwrap_or(0.0)]);
                coordinates += 1;
            }
            Some("f") => {
                let mut count = 0;
                for word in words {
                    corner(word, [positions, coordinates, normals]).map_err(at)?;
                    count += 1;
                }
                if count < 3 {
                    empty += 1;
                    continue;
                }
                faces += 1;
                corners += 3 * (count - 2);
                if corners > limits::MAX_MESH_INDICES {
                    return Err(at(format!("more than {} corners", limits::MAX_MESH_INDICES)));
                }
                kept.push_str(line);
                kept.push('\n');
            }
            Some("l" | "p") => loose += 1,
            Some("o" | "g" | "mtllib") | Some("usemtl") if line.contains(char::is_whitespace) => {
                // tobj splits names at a space, not at a tab.
                let (word, name) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
                let _ = writeln!(kept, "{word} {}", name.trim());
            }
            _ => {}
        }
    }
    if faces == 0 {
        return Err("holds no face".to_owned());
    }
    for (count, what) in [(loose, "lines and points"), (empty, "faces with fewer than 3 corners")] {
        if count > 0 {
            warnings.push(format!("{what} left out: {count}"));
        }
    }
    Ok(kept)
}

pub(super) fn finite<'a>(words: impl Iterator<Item = &'a str>) -> std::result::Result<Vec<f32>, String> {
    let number = |word: &str| {
        let value = word.parse::<f32>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("expected a finite number, found {word:?}"))
    };
    words.map(number).collect()
}

pub(super) fn write_numbers(into: &mut String, word: &str, values: &[f32]) {
    into.push_str(word);
    for value in values {
        let _ = write!(into, " {value}");
    }
    into.push('\n');
}

/// Checks `v`, `v/vt`, `v//vn` or `v/vt/vn` against the numbers of positions, coordinates and normals so far.
fn corner(word: &str, counts: [usize; 3]) -> std::result::Result<(), String> {
    const WHAT: [&str; 3] = ["position", "texture coordinate", "normal"];
    let parts: Vec<&str> = word.split('/').collect();
    if parts.len() > 3 || parts[0].is_empty() {
        return Err(format!("expected a corner like 1, 1/1, 1//1 or 1/1/1, found {word:?}"));
    }
    for (part, (what, count)) in parts.iter().zip(WHAT.iter().zip(counts)) {
        if part.is_empty() {
            continue;
        }
        let index = part.parse::<i64>().map_err(|_| format!("expected the index of a {what}, found {part:?}"))?;
        let magnitude = index.unsigned_abs();
        if magnitude == 0 || magnitude > count as u64 {
            return Err(format!("{what} {index} does not exist, there are {count}"));
        }
    }
    Ok(())
}

/// One mesh from the parts of a file.
fn join(
    models: &[tobj::Model],
    surfaces: &mut Surfaces<'_>,
    warnings: &mut Vec<String>,
) -> std::result::Result<Mesh, String> {
    let mut mesh = Mesh::new("", Vec::new(), Vec::new(), PLAIN_COLOUR);
    let mut normals = Vec::new();
    let mut coordinates: Vec<[f32; 2]> = Vec::new();
    let mut vertex_colours: Vec<Colour> = Vec::new();
    let whole = |part: &tobj::Mesh| !part.normals.is_empty() && part.normals.len() == part.positions.len();
    let smooth = models.iter().all(|model| model.mesh.positions.is_empty() || whole(&model.mesh));
    if !smooth && models.iter().any(|model| !model.mesh.normals.is_empty()) {
        warnings.push("normals left out, because some corners have none".to_owned());
    }
    for model in models {
        let part = &model.mesh;
        let base = u32::try_from(mesh.positions.len()).map_err(|_| "has too many vertices".to_owned())?;
        let added = part.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
        mesh.positions.extend(added);
        if smooth {
            let unit = |n: &[f32]| {
                let normal = crate::scene::wide([n[0], n[1], n[2]]);
                crate::scene::narrow(normal.normalize_or(glam::DVec3::Y))
            };
            normals.extend(part.normals.chunks_exact(3).map(unit));
        }
        let vertices = part.positions.len() / 3;
        let has_coordinates = !part.texcoords.is_empty() && part.texcoords.len() == 2 * vertices;
        if has_coordinates {
            coordinates.resize(base as usize, [0.0; 2]);
            // From the last row of the picture upward to from the first row downward.
            coordinates.extend(part.texcoords.as_chunks::<2>().0.iter().map(|[u, v]| [*u, 1.0 - *v]));
        }
        let surface = surfaces.of(part.material_id, has_coordinates);
        let [r, g, b, alpha] = surface.colour;
        if part.vertex_color.len() == part.positions.len() {
            vertex_colours.extend(
                part.vertex_color
                    .chunks_exact(3)
                    .map(|c| [mtl::channel(c[0]), mtl::channel(c[1]), mtl::channel(c[2]), alpha]),
            );
        } else {
            vertex_colours.resize(mesh.positions.len(), [r, g, b, alpha]);
        }
        // In range: u32 indices of vertices of this part, which were counted.
        let first = mesh.triangle_count();
        mesh.indices.extend(part.indices.iter().map(|index| base.saturating_add(*index)));
        let end = mesh.triangle_count();
        match mesh.parts.last_mut() {
            Some(last) if last.material == surface.material => last.triangles.end = end,
            _ => mesh.parts.push(Part { triangles: first..end, material: surface.material }),
        }
    }
    if !coordinates.is_empty() {
        coordinates.resize(mesh.positions.len(), [0.0; 2]);
    }
    mesh.texture_coordinates = (!coordinates.is_empty()).then_some(coordinates);
    if let [only] = &mesh.parts[..]
        && *only.material == Material::default()
    {
        mesh.parts.clear();
    }
    mesh.normals = smooth.then_some(normals);
    mesh.colours = super::simplest(vertex_colours);
    Ok(mesh)
}
