//! What NAME|FILE stands for: a demonstration, a scene file or a mesh.

use std::path::Path;

use super::note;
use crate::demos::{self, Demo};
use crate::error::{Error, Result};
use crate::mesh;
use crate::play::Environment;
use crate::scene::{self, Scene};

/// Size of the picture of a mesh, in pixels, where nothing is asked for.
const MESH_SIZE: [u32; 2] = [800, 600];
/// Frames of a turn round a scene that does not move by itself.
const TURN: u32 = 180;

/// Where scenes come from, frame by frame.
#[derive(Debug)]
pub(super) struct Source {
    /// What the user called it, for messages.
    pub name: String,
    /// The same as the stem of a file's name.
    pub stem: String,
    size: Option<[u32; 2]>,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Demo(&'static Demo),
    Scene(Box<Scene>),
}

impl Source {
    /// A demonstration of this name, or else the file; `size` goes before the scene's own,
    /// and a mesh stands in this light.
    ///
    /// # Errors
    /// [`Error::Use`] for what is neither, and for light on what is no mesh; what is wrong with the file.
    pub(super) fn open(text: &str, size: Option<[u32; 2]>, environment: Option<Environment>) -> Result<Self> {
        let (name, file) = (text.to_owned(), Path::new(text));
        let is_mesh = ["obj", "gltf", "glb"].iter().any(|ending| Some(*ending) == lower_ending(file).as_deref());
        if environment.is_some() && !is_mesh {
            return Err(Error::Use(format!(
                "--environment: {text} is no mesh: demos and scene files have light of their own"
            )));
        }
        if let Some(demo) = demos::find(text) {
            return Ok(Self { name, stem: text.to_owned(), size, kind: Kind::Demo(demo) });
        }
        let scene = match lower_ending(file).as_deref() {
            Some("json") => scene::load(file)?,
            Some("obj" | "gltf" | "glb") => {
                let mesh = mesh::load(file)?;
                let light = environment.unwrap_or_else(|| Environment::usual(&mesh));
                let bounds = mesh.bounds();
                let mut scene = Scene::showing(mesh, size.unwrap_or(MESH_SIZE));
                light.light(&mut scene, bounds);
                scene
            }
            _ => {
                let hint = "neither a demo (see zga list) nor a file that ends in .json, .obj, .gltf or .glb";
                return Err(Error::Use(format!("{text}: {hint}")));
            }
        };
        for line in scene.warnings() {
            note(&format!("warning: {line}"));
        }
        let stem = file.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy()).into_owned();
        Ok(Self { name, stem, size, kind: Kind::Scene(Box::new(scene)) })
    }

    /// The scene at a frame. What does not move by itself is seen from all round.
    pub(super) fn scene(&self, frame: u32) -> Scene {
        let mut scene = match &self.kind {
            Kind::Demo(demo) => demo.build(frame),
            Kind::Scene(scene) if frame == 0 => (**scene).clone(),
            Kind::Scene(scene) => {
                let angle = std::f64::consts::TAU * f64::from(frame % TURN) / f64::from(TURN);
                Scene { camera: scene.camera.orbited(angle, 0.0, 1.0), ..(**scene).clone() }
            }
        };
        scene.size = self.size.unwrap_or(scene.size);
        scene
    }

    /// Name of the file of a frame: the stem, and the frame's number if there are several.
    pub(super) fn file_name(&self, frame: u32, frames: u32, ending: &str) -> String {
        let stem = &self.stem;
        if frames == 1 { format!("{stem}.{ending}") } else { format!("{stem}-{frame:04}.{ending}") }
    }
}

/// The ending of a file's name in small letters.
fn lower_ending(file: &Path) -> Option<String> {
    file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_unknown_name_says_what_there_is() {
        let fault = Source::open("no-such-demo", None, None).expect_err("unknown").to_string();
        assert!(fault.starts_with("no-such-demo: neither a demo (see zga list)"), "{fault}");
        assert!(
            Source::open("missing.json", None, None).expect_err("no file").to_string().starts_with("missing.json: ")
        );
    }

    #[test]
    fn scene_size_of_the_command_line_goes_first() {
        let source = Source::open("teapot", Some([320, 200]), None).expect("known");
        assert_eq!(source.scene(3).size, [320, 200]);
        assert_eq!(
            (source.file_name(0, 1, "png"), source.file_name(7, 9, "png")),
            ("teapot.png".into(), "teapot-0007.png".into())
        );
    }
}
