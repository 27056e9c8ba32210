//! From the bytes of a scene file to a checked [`Scene`]: the document, camera and card settings.
//!
//! Every field is checked and an unknown one is refused with its path. Outputs to: nobody re-checks.

use std::path::Path;

use super::json::{ANY, Fault, Json, Object, Read};
use super::parse_draw::{self, Context};
use super::parse_effects;
use super::settings::{
    ANTIALIAS_EDGES, ANTIALIAS_GRIDS, ANTIALIAS_RESOLVES, CardSettings, END_TESTS, FIDELITIES, HIDDEN_SURFACES,
    MOST_SUBPIXEL_POOL, PRESETS, SUBPIXEL_DEPTHS, SystolicSettings, TILE_SIDES, TOKEN_COLOURS, TOKEN_PORTS,
    ZA_PREDICTIONS,
};
use super::{Camera, DARK, Orthographic, Perspective, Scene};
use crate::error::{Error, Result};
use crate::limits::{MAX_FILE_BYTES, MAX_TARGET_PIXELS_PER_SIDE};

/// Largest side of a Za block, in pixels.
const MAX_ZA_BLOCK_SIDE: u32 = 16384;

impl Scene {
    /// Reads a scene from JSON. Meshes and pictures are named but not read; see [`Scene::load_meshes`]. `file` is for messages.
    ///
    /// # Errors
    /// [`Error::Syntax`] with line and column, or [`Error::Field`] with the field's path, what was expected and
    /// what was found.
    pub fn from_json(bytes: &[u8], file: &Path) -> Result<Self> {
        let size = bytes.len() as u64;
        if size > MAX_FILE_BYTES {
            return Err(Error::TooLarge { file: file.to_path_buf(), bytes: size, limit: MAX_FILE_BYTES });
        }
        // A byte order mark is not JSON, but editors write it.
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let tree = Json::parse(bytes).map_err(|fault| syntax_error(file, &fault))?;
        document(&tree).map_err(|fault| fault.in_file(file))
    }
}

fn syntax_error(file: &Path, fault: &serde_json::Error) -> Error {
    let (line, column) = (fault.line(), fault.column());
    let text = fault.to_string();
    let suffix = format!(" at line {line} column {column}");
    let reason = text.strip_suffix(&suffix).unwrap_or(&text).to_owned();
    Error::Syntax { file: file.to_path_buf(), line, column, reason }
}

fn document(tree: &Json) -> Read<Scene> {
    let fields =
        tree.object(&["size", "background", "camera", "card", "ambient", "lights", "shadow", "materials", "draw"])?;
    let size = fields
        .required("size", |value| value.array("whole numbers", |side| side.whole(1..=MAX_TARGET_PIXELS_PER_SIDE)))?;
    let camera = fields.or("camera", Camera::Screen, camera)?;
    let materials = fields.optional("materials", parse_effects::materials)?.unwrap_or_default();
    let context = Context {
        materials: &materials,
        in_pixels: camera == Camera::Screen,
        inside_decal: false,
        inside_fitted: false,
    };
    let draw = fields.required("draw", |value| parse_draw::draws(value, context))?;
    Ok(Scene {
        size,
        background: fields.or("background", [0, 0, 0, 255], Json::colour)?,
        camera,
        card: fields.optional("card", card)?.unwrap_or_default(),
        ambient: fields.or("ambient", DARK, Json::colour)?,
        lights: fields.optional("lights", parse_effects::lights)?.unwrap_or_default(),
        shadow: fields.optional("shadow", parse_effects::shadow)?,
        materials,
        draw,
    })
}

fn camera(value: &Json) -> Read<Camera> {
    let (kind, value) = value.tagged(&["screen", "orthographic", "perspective"])?;
    let read = match kind {
        "screen" => value.object(&[]).map(|_| Camera::Screen),
        "orthographic" => orthographic(value),
        _ => perspective(value),
    };
    read.map_err(|fault| fault.in_field(kind))
}

fn orthographic(value: &Json) -> Read<Camera> {
    let fields = value.object(&["eye", "target", "up", "width", "near", "far"])?;
    let [eye, target, up] = placement(&fields)?;
    let width = fields.required("width", Json::positive)?;
    let near = fields.required("near", |value| value.number(ANY))?;
    let far = fields.required("far", |value| farther_than(value, near))?;
    Ok(Camera::Orthographic(Orthographic { eye, target, up, width, near, far }))
}

fn perspective(value: &Json) -> Read<Camera> {
    let fields = value.object(&["eye", "target", "up", "fov_x_degrees", "near", "far"])?;
    let [eye, target, up] = placement(&fields)?;
    let fov_x_degrees = fields.required("fov_x_degrees", |value| value.number(0.01..=179.0))?;
    let near = fields.required("near", Json::positive)?;
    let far = fields.required("far", |value| farther_than(value, near))?;
    Ok(Camera::Perspective(Perspective { eye, target, up, fov_x_degrees, near, far }))
}

fn farther_than(value: &Json, near: f32) -> Read<f32> {
    let far = value.number(ANY)?;
    if far > near { Ok(far) } else { Err(Fault::new(format!("a distance above near ({near})"), far.to_string())) }
}

/// Eye, target and up, from which a view can be made.
fn placement(fields: &Object<'_>) -> Read<[[f32; 3]; 3]> {
    let eye = fields.required("eye", Json::numbers)?;
    let target = fields.required("target", Json::numbers)?;
    let up = fields.or("up", [0.0, 1.0, 0.0], Json::numbers)?;
    let forward = super::camera::wide(target) - super::camera::wide(eye);
    if forward.length_squared() == 0.0 {
        return Err(Fault::new("a point other than eye", format!("{target:?}")).in_field("target"));
    }
    let sine = super::camera::wide(up).try_normalize().map_or(0.0, |up| forward.normalize().cross(up).length());
    if sine < 1e-6 {
        let expected = "a direction that is not along the line of sight";
        return Err(Fault::new(expected, format!("{up:?}")).in_field("up"));
    }
    Ok([eye, target, up])
}

fn card(value: &Json) -> Read<CardSettings> {
    let fields = value.object(&[
        "preset",
        "hidden_surface",
        "fidelity",
        "antialias",
        "subpixel_depth",
        "antialias_resolve",
        "subpixel_pool",
        "antialias_edges",
        "za_block",
        "za_prediction",
        "za_bypass",
        "systolic_variant",
        "tile_size",
        "depth_bits",
        "depth_fraction_bits",
    ])?;
    Ok(CardSettings {
        preset: fields.optional("preset", |value| value.named(&PRESETS))?,
        hidden_surface: fields.optional("hidden_surface", |value| value.named(&HIDDEN_SURFACES))?,
        fidelity: fields.optional("fidelity", |value| value.named(&FIDELITIES))?,
        antialias: fields.optional("antialias", |value| value.named(&ANTIALIAS_GRIDS))?,
        subpixel_depth: fields.optional("subpixel_depth", |value| value.named(&SUBPIXEL_DEPTHS))?,
        antialias_resolve: fields.optional("antialias_resolve", |value| value.named(&ANTIALIAS_RESOLVES))?,
        antialias_edges: fields.optional("antialias_edges", |value| value.named(&ANTIALIAS_EDGES))?,
        subpixel_pool: fields.optional("subpixel_pool", |value| value.whole(1..=MOST_SUBPIXEL_POOL))?,
        za_block: fields
            .optional("za_block", |value| value.array("whole numbers", |side| side.whole(1..=MAX_ZA_BLOCK_SIDE)))?,
        za_prediction: fields.optional("za_prediction", |value| value.named(&ZA_PREDICTIONS))?,
        za_bypass: fields.optional("za_bypass", Json::flag)?,
        systolic_variant: fields.optional("systolic_variant", systolic_variant)?.unwrap_or_default(),
        tile_size: fields.optional("tile_size", |value| value.array("sides", |side| one_of(side, &TILE_SIDES)))?,
        depth_bits: fields.optional("depth_bits", |value| one_of(value, &[16, 24, 31]))?,
        depth_fraction_bits: fields.optional("depth_fraction_bits", |value| one_of(value, &[0, 8, 16, 24]))?,
    })
}

fn systolic_variant(value: &Json) -> Read<SystolicSettings> {
    let fields = value.object(&["end_test", "ports", "colour", "super_buffer"])?;
    Ok(SystolicSettings {
        end_test: fields.optional("end_test", |value| value.named(&END_TESTS))?,
        ports: fields.optional("ports", |value| value.named(&TOKEN_PORTS))?,
        colour: fields.optional("colour", |value| value.named(&TOKEN_COLOURS))?,
        super_buffer: fields.optional("super_buffer", Json::flag)?,
    })
}

fn one_of(value: &Json, allowed: &[u32]) -> Read<u32> {
    value.whole(0..=u32::MAX).ok().filter(|number| allowed.contains(number)).ok_or_else(|| {
        let names: Vec<String> = allowed.iter().map(ToString::to_string).collect();
        Fault::new(format!("one of {}", names.join(", ")), value.describe())
    })
}
