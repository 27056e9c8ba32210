//! What NAME|FILE stands for: a demonstration, a scene file or a mesh.

use std::path::Path;

use super::note;
use crate::demos::{self, Demo};
use crate::error::{Error, Result};
use crate::mesh;
use crate::scene::{self, Scene, SubpixelGrid};

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
    /// A demonstration of this name, or else the file; `size` and `antialias` go before the scene's own.
    ///
    /// # Errors
    /// [`Error::Use`] for what is neither; what is wrong with the file.
    pub(super) fn open(text: &str, size: Option<[u32; 2]>, antialias: Option<SubpixelGrid>) -> Result<Self> {
        let (name, file) = (text.to_owned(), Path::new(text));
        if let Some(demo) = demos::find(text) {
            tell_unsupported(text, &demo.build(0), antialias);
            return Ok(Self { name, stem: text.to_owned(), size, kind: Kind::Demo(demo) });
        }
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let scene = match ending.as_deref() {
            Some("json") => scene::load(file)?,
            Some("obj" | "gltf" | "glb") => Scene::showing(mesh::load(file)?, size.unwrap_or(MESH_SIZE)),
            _ => {
                let hint = "neither a demo (see zga list) nor a file that ends in .json, .obj, .gltf or .glb";
                return Err(Error::Use(format!("{text}: {hint}")));
            }
        };
        for line in scene.warnings() {
            note(&format!("warning: {line}"));
        }
        tell_unsupported(text, &scene, antialias);
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

/// Warns of effects that no unit of the card has; `antialias` goes before the scene's own.
fn tell_unsupported(name: &str, scene: &Scene, antialias: Option<SubpixelGrid>) {
    let grid = antialias.or(scene.card.antialias).unwrap_or(SubpixelGrid::Off);
    let beyond = scene.unsupported_effects(grid);
    if !beyond.is_empty() {
        let beyond = beyond.join(", ");
        note(&format!("warning: {name}: this card has no unit yet for {beyond}; drawn without"));
    }
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
