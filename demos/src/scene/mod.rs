//! A scene as a value: target size, camera, card settings, lights, materials and the list of draws.
//!
//! Duties: the types, loading with the meshes a scene names, and the view of a single mesh.
//! Inputs from: [`parse`](Scene::from_json) for files, [`crate::demos`] for built-in scenes.
//! Outputs to: [`Scene::batches`], which a driver adapter reads.

mod camera;
mod effects;
#[cfg(test)]
mod effects_tests;
mod flatten;
mod json;
mod load;
mod parse;
mod parse_draw;
mod parse_effects;
#[cfg(test)]
mod parse_tests;
mod parts;
#[cfg(test)]
mod parts_tests;
mod settings;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

pub use camera::{Camera, Orthographic, Perspective};
pub(crate) use camera::{narrow, wide};
pub use effects::{
    Blend, DepthFunction, FogFunction, Light, LightType, Lighting, Material, STENCIL_FUNCTIONS, STENCIL_OPERATIONS,
    Shadow, Stencil, StencilOperation, StencilSide, TEXTURE_FORMATS, TEXTURE_FUNCTIONS, Texture, TextureFilter,
    TextureFormat, TextureFunction,
};
pub use flatten::{Batch, Topology};
pub use load::load;
pub use settings::{
    ANTIALIAS_EDGES, ANTIALIAS_GRIDS, ANTIALIAS_RESOLVES, CardSettings, END_TESTS, EndTest, FIDELITIES, Fidelity,
    HIDDEN_SURFACES, HiddenSurface, MOST_SUBPIXEL_POOL, PRESETS, Preset, SUBPIXEL_DEPTHS, SubpixelDepth, SubpixelEdges,
    SubpixelGrid, SubpixelResolve, SystolicSettings, TILE_SIDES, TOKEN_COLOURS, TOKEN_PORTS, TokenColour, TokenPorts,
    ZA_PREDICTIONS, ZaPrediction,
};

use crate::mesh::Mesh;

/// A colour: red, green, blue, alpha, each 0..=255.
pub type Colour = [u8; 4];

/// A 4x4 matrix, row-major, for row vectors: `[x y z 1] * M`.
pub type Matrix = [f32; 16];

/// The matrix that changes nothing.
pub const IDENTITY: Matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

/// No light.
pub(crate) const DARK: Colour = [0, 0, 0, 255];

/// Light everywhere in a scene that shows a mesh with lights of its own: what no light of the file meets is told from
/// the background.
const SHOWN_AMBIENT: Colour = [40, 40, 40, 255];

/// The slope that markings survive when a decal names none.
pub const DEFAULT_SLOPE: f32 = 8.0;

/// Everything that is needed to draw one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Width and height of the target, in pixels, each 1..=16384.
    pub size: [u32; 2],
    /// Colour of every pixel that nothing covers.
    pub background: Colour,
    /// How positions become pixels.
    pub camera: Camera,
    /// What the scene asks of the card; flags of the command line override it.
    pub card: CardSettings,
    /// Light that is everywhere, where surfaces are lit; its alpha is not in use.
    pub ambient: Colour,
    /// Lights, by position in the list.
    pub lights: Vec<Light>,
    /// What is darkened when all is drawn that hides something, if a material has a stencil test.
    pub shadow: Option<Shadow>,
    /// Materials by name.
    pub materials: BTreeMap<String, Material>,
    /// What is drawn, in order.
    pub draw: Vec<Draw>,
}

/// One entry of the draw list.
#[derive(Clone, Debug, PartialEq)]
pub enum Draw {
    /// Triangles, three vertices each.
    Triangles(Primitives),
    /// Separate lines, two vertices each.
    Lines(Primitives),
    /// Points, one vertex each.
    Points(Primitives),
    /// A polyline or a chain of Bézier segments.
    Curve(Curve),
    /// Surface markings: drawn with the decal transform.
    Decal(Decal),
    /// A mesh from a file.
    Mesh(MeshDraw),
}

/// Vertices with what belongs to them; how many make a primitive is said by the [`Draw`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitives {
    /// Positions: pixels and depth 0..=1 with the screen camera, else world units.
    pub vertices: Vec<[f32; 3]>,
    /// Positions in `vertices`, or none when the vertices are used in order.
    pub indices: Option<Vec<u32>>,
    /// Colours of the vertices or triangles.
    pub colours: Colours,
    /// Unit normals, one for each vertex.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates, one pair for each vertex.
    pub texture_coordinates: Option<Vec<[f32; 2]>>,
    /// Name of a material of the scene.
    pub material: Option<String>,
    /// Object tag; without one each draw is its own object.
    pub tag: Option<u32>,
    /// Width of lines or side of points, in pixels; in use where they are anti-aliased. Without it 1.
    pub extent: Option<f32>,
}

/// Colours of the vertices of a draw or a mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    /// The same everywhere.
    One(Colour),
    /// One for each vertex.
    PerVertex(Vec<Colour>),
    /// One for each triangle.
    PerFace(Vec<Colour>),
}

impl Default for Colours {
    fn default() -> Self {
        Self::One([255; 4])
    }
}

/// How the points of a [`Curve`] are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveKind {
    /// Straight lines from point to point; at least two points.
    Polyline,
    /// Quadratic Bézier segments, three points each.
    Quadratic,
    /// Cubic Bézier segments, four points each.
    Cubic,
}

impl CurveKind {
    /// Points that make one segment (2 for a polyline, whose segments share them).
    #[must_use]
    pub fn points_per_segment(self) -> usize {
        match self {
            Self::Polyline => 2,
            Self::Quadratic => 3,
            Self::Cubic => 4,
        }
    }
}

/// A curve in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// How the points are joined.
    pub kind: CurveKind,
    /// Control points, segment after segment.
    pub points: Vec<[f32; 3]>,
    /// One for all or one for each control point.
    pub colours: Colours,
    /// Largest distance of a drawn chord from the curve, in pixels.
    pub tolerance: f32,
    /// Width in pixels; in use where it is anti-aliased. Without it 1.
    pub width: Option<f32>,
    /// Name of a material of the scene.
    pub material: Option<String>,
    /// Object tag.
    pub tag: Option<u32>,
}

/// Markings on a surface, moved toward the viewer so that they are not buried in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Decal {
    /// The slope S that the markings survive; negative moves away from the viewer.
    pub slope: f32,
    /// Triangles, in world units, of the surfaces that the markings lie on: they are moved no farther than these need, and
    /// `slope` is the limit. Without any they are moved by `slope`.
    pub surfaces: Vec<[[f32; 3]; 3]>,
    /// The markings; no decal among them, and with surfaces no mesh, which has a place of its own.
    pub draw: Vec<Draw>,
}

/// A mesh that a scene names.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshDraw {
    /// The file, relative to the scene file.
    pub file: PathBuf,
    /// Where the mesh stands in the world.
    pub transform: Matrix,
    /// Name of a material of the scene.
    pub material: Option<String>,
    /// Colour that replaces those of the file.
    pub colour: Option<Colour>,
    /// Also draw the feature edges, as decal lines.
    pub edges: bool,
    /// Slope of the decal for the edges.
    pub slope: f32,
    /// Colour of the edges.
    pub edge_colour: Colour,
    /// Object tag.
    pub tag: Option<u32>,
    /// The mesh itself, once [`Scene::load_meshes`] has read it; nothing is drawn before.
    pub mesh: Option<Arc<Mesh>>,
}

impl MeshDraw {
    /// A mesh that is already in memory, where it stands, without edges.
    #[must_use]
    pub fn of(mesh: Mesh) -> Self {
        Self {
            file: PathBuf::from(&mesh.name),
            transform: IDENTITY,
            material: None,
            colour: None,
            edges: false,
            slope: DEFAULT_SLOPE,
            edge_colour: [20, 24, 36, 255],
            tag: None,
            mesh: Some(Arc::new(mesh)),
        }
    }
}

impl Scene {
    /// An empty scene with the screen camera and nothing asked of the card.
    #[must_use]
    pub fn new(size: [u32; 2], background: Colour) -> Self {
        Self {
            size,
            background,
            camera: Camera::Screen,
            card: CardSettings::default(),
            ambient: DARK,
            lights: Vec::new(),
            shadow: None,
            materials: BTreeMap::new(),
            draw: Vec::new(),
        }
    }

    /// A scene that shows one mesh from a three-quarter view, in the light of its file if that has any.
    #[must_use]
    pub fn showing(mesh: Mesh, size: [u32; 2]) -> Self {
        let mut scene = Self::new(size, [24, 29, 43, 255]);
        if !mesh.lights.is_empty() {
            scene.lights.clone_from(&mesh.lights);
            scene.ambient = SHOWN_AMBIENT;
        }
        scene.camera = Camera::Perspective(mesh.default_camera(size));
        scene.draw.push(Draw::Mesh(MeshDraw::of(mesh)));
        scene
    }
}
