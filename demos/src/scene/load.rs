//! Scene files with what they name: meshes, and pictures for textures.
//!
//! Duties: reads each file once however often it is named, compares what a texture uses with its picture, and says
//! which field names what cannot be read. Inputs from: [`Scene::from_json`], files. Outputs to: the scene itself.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::json::{Fault, Read};
use super::{Draw, Material, Scene, Texture};
use crate::error::{Error, Result};
use crate::limits;
use crate::mesh::Mesh;
use crate::texture::{Picture, Room};

/// Reads a scene file and the meshes and pictures that it names.
///
/// # Errors
/// Names the file, and the field or the line, that is at fault.
pub fn load(file: &Path) -> Result<Scene> {
    let bytes = limits::read_file(file)?;
    let mut scene = Scene::from_json(&bytes, file)?;
    scene.load_meshes(file.parent().unwrap_or(Path::new("")), file)?;
    Ok(scene)
}

impl Scene {
    /// Reads every mesh and every picture of a texture that the scene names and does not hold yet, from `folder`;
    /// `scene_file` is for messages. A file that is named twice is read once.
    ///
    /// # Errors
    /// The first file that cannot be read, with the field that names it; the first texture that uses more than its
    /// picture has.
    pub fn load_meshes(&mut self, folder: &Path, scene_file: &Path) -> Result<()> {
        let mut known: BTreeMap<PathBuf, Arc<Mesh>> = BTreeMap::new();
        load_meshes_of(&mut self.draw, "draw", folder, scene_file, &mut known)?;
        let mut pictures = Pictures::default();
        for (name, material) in &mut self.materials {
            let Some(texture) = &mut material.texture else { continue };
            pictures
                .load(texture, folder)
                .map_err(|fault| fault.in_field("texture").in_field(name).in_field("materials").in_file(scene_file))?;
        }
        Ok(())
    }

    /// What was left out or guessed while the meshes were read, and what of their materials draws have no use for, a
    /// line each.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut lines = Vec::new();
        self.warnings_of(&self.draw, "draw", &mut lines);
        lines.sort();
        lines.dedup();
        lines
    }

    fn warnings_of(&self, draws: &[Draw], path: &str, into: &mut Vec<String>) {
        for (index, draw) in draws.iter().enumerate() {
            let path = format!("{path}[{index}]");
            let (material, has_coordinates) = match draw {
                Draw::Decal(decal) => {
                    self.warnings_of(&decal.draw, &format!("{path}.decal.draw"), into);
                    continue;
                }
                Draw::Triangles(draw) | Draw::Lines(draw) | Draw::Points(draw) => {
                    (&draw.material, draw.texture_coordinates.is_some())
                }
                Draw::Curve(curve) => (&curve.material, false),
                Draw::Mesh(named) => {
                    if let Some(mesh) = &named.mesh {
                        into.extend(mesh.warnings.iter().map(|line| format!("{}: {line}", mesh.name)));
                        if !mesh.lights.is_empty() && mesh.lights != self.lights {
                            let count = mesh.lights.len();
                            into.push(format!("{}: lights left out, a scene has its own: {count}", mesh.name));
                        }
                    }
                    (&named.material, named.mesh.as_ref().is_none_or(|mesh| mesh.texture_coordinates.is_some()))
                }
            };
            let material = material.as_ref().and_then(|name| self.materials.get_key_value(name));
            if let Some((name, Material { texture: Some(_), .. })) = material
                && !has_coordinates
            {
                into.push(format!("{path}: drawn without the texture of {name:?}, for want of texture coordinates"));
            }
        }
    }
}

/// The pictures of a scene file.
#[derive(Default)]
struct Pictures {
    known: BTreeMap<PathBuf, Arc<Picture>>,
    room: Room,
}

impl Pictures {
    /// Gives a texture its picture. The fault begins in the texture.
    fn load(&mut self, texture: &mut Texture, folder: &Path) -> Read<()> {
        if texture.image.is_none() {
            let file = folder.join(&texture.file);
            let image = match self.known.get(&file) {
                Some(image) => Arc::clone(image),
                None => Arc::new(
                    Picture::load_within(&file, &mut self.room)
                        .map_err(|reason| Fault::new("a readable PNG or JPEG picture", reason).in_field("file"))?,
                ),
            };
            texture.image = Some(Arc::clone(&image));
            self.known.insert(file, image);
        }
        let size = texture.image.as_ref().map_or([0; 2], |image| image.size());
        for axis in 0..2 {
            let (offset, side) = (texture.offset[axis], size[axis]);
            if offset >= side {
                let expected = format!("a texel of the picture, 0..={}", side.saturating_sub(1));
                return Err(Fault::new(expected, offset.to_string()).in_item(axis).in_field("offset"));
            }
            let (used, most) = (texture.size.map_or(1, |used| used[axis]), side - offset);
            if used > most {
                let expected = format!("at most the {most} texels from the offset to the picture's end");
                return Err(Fault::new(expected, used.to_string()).in_item(axis).in_field("size"));
            }
        }
        Ok(())
    }
}

/// Loads the meshes of one draw list; `path` is the list's own path in the scene file.
fn load_meshes_of(
    draws: &mut [Draw],
    path: &str,
    folder: &Path,
    scene_file: &Path,
    known: &mut BTreeMap<PathBuf, Arc<Mesh>>,
) -> Result<()> {
    for (index, draw) in draws.iter_mut().enumerate() {
        match draw {
            Draw::Decal(decal) => {
                let path = format!("{path}[{index}].decal.draw");
                load_meshes_of(&mut decal.draw, &path, folder, scene_file, known)?;
            }
            Draw::Mesh(named) if named.mesh.is_none() => {
                let file = folder.join(&named.file);
                let mesh = match known.get(&file) {
                    Some(mesh) => Arc::clone(mesh),
                    None => Arc::new(crate::mesh::load(&file).map_err(|fault| Error::Field {
                        file: scene_file.to_path_buf(),
                        path: format!("{path}[{index}].mesh.file"),
                        expected: "a readable .obj, .gltf or .glb file".to_owned(),
                        found: fault.to_string(),
                    })?),
                };
                known.insert(file, Arc::clone(&mesh));
                named.mesh = Some(mesh);
            }
            _ => {}
        }
    }
    Ok(())
}
