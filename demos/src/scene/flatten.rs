//! From the draw list to flat batches of triangles, lines and points, the form in which a driver takes them.
//!
//! Duties: joins decals with what they hold, meshes with their feature edges, cuts curves into chords, gives every
//! vertex its colour and every draw an object tag, and settles which effects a batch calls for. Meshes are in
//! [`super::parts`]. Positions stay in world units (pixels with the screen camera); the card does the transform.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{
    Blend, Camera, Colour, Colours, Curve, CurveKind, Draw, IDENTITY, Lighting, Material, Matrix, Primitives, Scene,
    narrow, wide,
};

/// Most chords of one curve segment, and of all segments of a curve.
const MAX_CHORDS: usize = 1024;
const MAX_CHORDS_OF_CURVE: usize = 4 << 20;

/// What the corners of a batch make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Three corners each.
    Triangles,
    /// Two corners each.
    Lines,
    /// One corner each.
    Points,
}

/// Primitives of one kind that belong to one draw of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// The draw, for example `draw[2].decal.draw[0]`.
    pub path: String,
    /// What the corners make.
    pub topology: Topology,
    /// Positions.
    pub positions: Vec<[f32; 3]>,
    /// A colour for each position.
    pub colours: Vec<Colour>,
    /// Normals for each position, where the draw has them.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates for each position, where the draw has them (and, of a mesh, its material a texture).
    pub texture_coordinates: Option<Vec<[f32; 2]>>,
    /// Corners, as indices of positions; every one in range.
    pub indices: Vec<u32>,
    /// From the positions' space to the world.
    pub transform: Matrix,
    /// Slope of the decal transform, where the batch is a surface marking.
    pub slope: Option<f32>,
    /// Of a fitted decal the surfaces, in world units; empty for others.
    pub surfaces: Arc<Vec<[[f32; 3]; 3]>>,
    /// How the surface looks: the draw's material or that of a mesh's part. It has a texture only together with its
    /// picture and with texture coordinates, and holes only with a texture.
    pub material: Arc<Material>,
    /// Where light is worked out; not `none` only together with normals. What the material asks for is settled here.
    pub light: Lighting,
    /// What lies behind shows through: the material's blend is not `opaque`.
    pub translucent: bool,
    /// Width of lines or side of points, in pixels, where they are anti-aliased.
    pub extent: f32,
    /// Object tag.
    pub tag: u32,
}

impl Scene {
    /// The scene as flat batches, in drawing order. A mesh that is not loaded gives none.
    #[must_use]
    pub fn batches(&self) -> Vec<Batch> {
        let shared = |(name, material): (&String, &Material)| (name.clone(), Arc::new(material.clone()));
        let mut flattener = Flattener {
            scene: self,
            materials: self.materials.iter().map(shared).collect(),
            plain: Arc::default(),
            batches: Vec::new(),
            next_tag: free_tag(&self.draw),
            surfaces: Arc::default(),
        };
        for (index, draw) in self.draw.iter().enumerate() {
            flattener.draw(draw, format!("draw[{index}]"), None);
        }
        flattener.batches
    }
}

/// The first of the tags that no draw asks for.
fn free_tag(draws: &[Draw]) -> u32 {
    let of = |draw: &Draw| match draw {
        Draw::Triangles(draw) | Draw::Lines(draw) | Draw::Points(draw) => draw.tag.map_or(0, |tag| tag.wrapping_add(1)),
        Draw::Curve(draw) => draw.tag.map_or(0, |tag| tag.wrapping_add(1)),
        Draw::Mesh(draw) => draw.tag.map_or(0, |tag| tag.wrapping_add(1)),
        Draw::Decal(decal) => free_tag(&decal.draw),
    };
    draws.iter().map(of).max().unwrap_or(0)
}

/// Batches while they are made.
pub(super) struct Flattener<'a> {
    pub(super) scene: &'a Scene,
    materials: BTreeMap<String, Arc<Material>>,
    plain: Arc<Material>,
    pub(super) batches: Vec<Batch>,
    next_tag: u32,
    /// Of the decal that is being flattened.
    pub(super) surfaces: Arc<Vec<[[f32; 3]; 3]>>,
}

impl Flattener<'_> {
    fn draw(&mut self, draw: &Draw, path: String, slope: Option<f32>) {
        match draw {
            Draw::Triangles(primitives) => self.primitives(primitives, Topology::Triangles, path, slope),
            Draw::Lines(primitives) => self.primitives(primitives, Topology::Lines, path, slope),
            Draw::Points(primitives) => self.primitives(primitives, Topology::Points, path, slope),
            Draw::Curve(curve) => self.curve(curve, path, slope),
            Draw::Decal(decal) => {
                self.surfaces = Arc::new(decal.surfaces.clone());
                for (index, draw) in decal.draw.iter().enumerate() {
                    self.draw(draw, format!("{path}.decal.draw[{index}]"), Some(decal.slope));
                }
                self.surfaces = Arc::default();
            }
            Draw::Mesh(named) => {
                if let Some(mesh) = &named.mesh {
                    self.mesh(named, mesh, path, slope);
                }
            }
        }
    }

    pub(super) fn tag(&mut self, asked: Option<u32>) -> u32 {
        asked.unwrap_or_else(|| {
            let tag = self.next_tag;
            self.next_tag = tag.wrapping_add(1);
            tag
        })
    }

    /// The material of this name; the default one without a name.
    pub(super) fn material(&self, name: Option<&str>) -> Arc<Material> {
        Arc::clone(name.and_then(|name| self.materials.get(name)).unwrap_or(&self.plain))
    }

    fn primitives(&mut self, draw: &Primitives, topology: Topology, path: String, slope: Option<f32>) {
        let in_order = || (0..draw.vertices.len() as u32).collect();
        let mut batch = Batch {
            path,
            topology,
            positions: draw.vertices.clone(),
            colours: Vec::new(),
            normals: draw.normals.clone(),
            texture_coordinates: draw.texture_coordinates.clone(),
            indices: draw.indices.clone().unwrap_or_else(in_order),
            transform: IDENTITY,
            slope,
            surfaces: Arc::clone(&self.surfaces),
            material: self.material(draw.material.as_deref()),
            light: Lighting::None,
            translucent: false,
            extent: draw.extent.unwrap_or(1.0),
            tag: self.tag(draw.tag),
        };
        batch.paint(&draw.colours);
        batch.settle(self.scene);
        self.batches.push(batch);
    }

    fn curve(&mut self, curve: &Curve, path: String, slope: Option<f32>) {
        let (positions, colours) = chords(curve, &self.scene.camera, self.scene.size);
        let last = positions.len().saturating_sub(1) as u32;
        let chained = |end: u32| [end - 1, end];
        // Bézier segments are separate: no chord joins the end of one with the start of the next.
        let per_segment = (positions.len() / segments_of(curve).max(1)) as u32;
        let joins = |end: &u32| curve.kind == CurveKind::Polyline || !end.is_multiple_of(per_segment);
        let indices = (1..=last).filter(joins).flat_map(chained).collect();
        let tag = self.tag(curve.tag);
        let mut batch = Batch {
            path,
            topology: Topology::Lines,
            positions,
            colours,
            normals: None,
            texture_coordinates: None,
            indices,
            transform: IDENTITY,
            slope,
            surfaces: Arc::clone(&self.surfaces),
            material: self.material(curve.material.as_deref()),
            light: Lighting::None,
            translucent: false,
            extent: curve.width.unwrap_or(1.0),
            tag,
        };
        batch.settle(self.scene);
        self.batches.push(batch);
    }
}

impl Batch {
    /// The batch without any effect of its material: no light, no texture, no blending.
    pub fn make_plain(&mut self) {
        self.material = Arc::default();
        self.light = Lighting::None;
        self.translucent = false;
        self.texture_coordinates = None;
    }

    /// Leaves of the material what the batch has the means for, and settles where light is worked out.
    pub(super) fn settle(&mut self, scene: &Scene) {
        let textured = self.texture_coordinates.is_some()
            && self.material.texture.as_ref().is_some_and(|texture| texture.image.is_some());
        if !textured && (self.material.texture.is_some() || self.material.punch_through.is_some()) {
            let plain = Material { texture: None, punch_through: None, ..(*self.material).clone() };
            self.material = Arc::new(plain);
        }
        self.translucent = self.material.blend != Blend::Opaque;
        let usual = if scene.lights.is_empty() { Lighting::None } else { Lighting::Vertex };
        self.light = self.material.light.unwrap_or(usual);
        if self.light == Lighting::None || self.normals.is_some() {
            return;
        }
        // On the screen a triangle faces the viewer, so it is lit only where that is asked for.
        let on_screen = scene.camera == Camera::Screen && self.material.light.is_none();
        if self.topology == Topology::Triangles && !on_screen {
            self.add_flat_normals();
        } else {
            self.light = Lighting::None;
        }
    }

    /// Gives each triangle the normal of its plane. Which side is the outer one is a guess from the order of its
    /// corners, so it is lit on the side that is seen.
    fn add_flat_normals(&mut self) {
        self.take_corners_apart();
        let mut normals = Vec::with_capacity(self.positions.len());
        for corners in self.positions.as_chunks::<3>().0 {
            let [a, b, c] = corners.map(wide);
            normals.extend([narrow((b - a).cross(c - a).normalize_or_zero()); 3]);
        }
        // What is no whole triangle draws nothing.
        normals.resize(self.positions.len(), [0.0; 3]);
        self.normals = Some(normals);
        if !self.material.two_sided {
            self.material = Arc::new(Material { two_sided: true, ..(*self.material).clone() });
        }
    }

    /// Gives each corner a vertex of its own.
    fn take_corners_apart(&mut self) {
        let indices = std::mem::take(&mut self.indices);
        self.positions = each(&indices, &self.positions);
        self.colours = each(&indices, &self.colours);
        self.normals = self.normals.take().map(|all| each(&indices, &all));
        self.texture_coordinates = self.texture_coordinates.take().map(|all| each(&indices, &all));
        self.indices = (0..indices.len() as u32).collect();
    }

    /// Gives each position its colour. Colours by face take the corners of different faces apart.
    pub(super) fn paint(&mut self, colours: &Colours) {
        match colours {
            Colours::One(colour) => self.colours = vec![*colour; self.positions.len()],
            Colours::PerVertex(list) => self.colours.clone_from(list),
            Colours::PerFace(list) => {
                self.colours = vec![[255; 4]; self.positions.len()];
                self.take_corners_apart();
                self.colours = list.iter().flat_map(|colour| [*colour; 3]).collect();
            }
        }
        // A value built by hand may have fewer colours than corners; a missing one is white.
        self.colours.resize(self.positions.len(), [255; 4]);
    }
}

/// What a list holds at these places.
pub(super) fn each<T: Copy>(places: &[u32], list: &[T]) -> Vec<T> {
    places.iter().map(|place| list[*place as usize]).collect()
}

fn segments_of(curve: &Curve) -> usize {
    match curve.kind {
        CurveKind::Polyline => 1,
        kind => curve.points.len() / kind.points_per_segment(),
    }
}

/// The ends of the chords of a curve, with colours: the same number for each Bézier segment, so many that no chord
/// is farther from the curve than the tolerance.
fn chords(curve: &Curve, camera: &Camera, size: [u32; 2]) -> (Vec<[f32; 3]>, Vec<Colour>) {
    let all_colours = match &curve.colours {
        Colours::One(colour) => vec![*colour; curve.points.len()],
        Colours::PerVertex(list) | Colours::PerFace(list) => list.clone(),
    };
    if curve.kind == CurveKind::Polyline {
        return (curve.points.clone(), all_colours);
    }
    let order = curve.kind.points_per_segment();
    let segments = || curve.points.chunks_exact(order).zip(all_colours.chunks_exact(order));
    let bend = segments().map(|(points, _)| bend_in_pixels(points, camera, size)).fold(0.0, f64::max);
    // A chord over 1/n of a segment whose control points have the second difference b stays within b / (4 n^2)
    // of a quadratic and 3 b / (4 n^2) of a cubic.
    let most = (MAX_CHORDS_OF_CURVE / segments_of(curve).max(1)).clamp(1, MAX_CHORDS);
    let count = (bend / f64::from(curve.tolerance)).sqrt().ceil().clamp(1.0, most as f64) as usize;
    let mut positions = Vec::new();
    let mut colours = Vec::new();
    for (points, ends) in segments() {
        for step in 0..=count {
            let weights = bernstein(order, step as f64 / count as f64);
            let mix = |read: &dyn Fn(usize) -> f64| -> f64 {
                weights[..order].iter().enumerate().map(|(i, w)| w * read(i)).sum()
            };
            positions.push(std::array::from_fn(|axis| mix(&|i| f64::from(points[i][axis])) as f32));
            colours.push(std::array::from_fn(|channel| mix(&|i| f64::from(ends[i][channel])).round() as u8));
        }
    }
    (positions, colours)
}

/// Weights of the control points of a Bézier segment of 3 or 4 points at `t`.
fn bernstein(order: usize, t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    match order {
        3 => [s * s, 2.0 * s * t, t * t, 0.0],
        _ => [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
    }
}

/// The largest second difference of the control points on the screen, in pixels.
fn bend_in_pixels(points: &[[f32; 3]], camera: &Camera, size: [u32; 2]) -> f64 {
    let on_screen: Option<Vec<[f64; 3]>> = points.iter().map(|point| camera.project(*point, size)).collect();
    // Partly behind the viewer: as fine as it gets.
    let Some(on_screen) = on_screen else { return f64::MAX };
    let second = |w: &[[f64; 3]]| (w[0][0] - 2.0 * w[1][0] + w[2][0]).hypot(w[0][1] - 2.0 * w[1][1] + w[2][1]);
    on_screen.windows(3).map(second).fold(0.0, f64::max)
}
