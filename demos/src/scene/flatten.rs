//! From the draw list to flat batches of triangles, lines and points, the form in which a driver takes them.
//!
//! Duties: joins decals with what they hold, meshes with their feature edges, cuts curves into chords, gives every
//! vertex its colour and every draw an object tag. Positions stay in world units (pixels with the screen camera);
//! the card does the transform.

use super::camera::{wide, wide_matrix};
use super::{Blend, Camera, Colour, Colours, Curve, CurveKind, Draw, IDENTITY, Matrix, MeshDraw, Primitives, Scene};
use crate::mesh::Mesh;

/// Angle between two faces from which their common edge is a feature, in degrees.
const FEATURE_ANGLE_DEGREES: f32 = 30.0;

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
    /// Texture coordinates for each position, where the draw has them.
    pub texture_coordinates: Option<Vec<[f32; 2]>>,
    /// Corners, as indices of positions; every one in range.
    pub indices: Vec<u32>,
    /// From the positions' space to the world.
    pub transform: Matrix,
    /// Slope of the decal transform, where the batch is a surface marking.
    pub slope: Option<f32>,
    /// Name of a material of the scene.
    pub material: Option<String>,
    /// Alpha is translucency: the material's blend is `alpha`.
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
        let mut flattener = Flattener { scene: self, batches: Vec::new(), next_tag: free_tag(&self.draw) };
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

struct Flattener<'a> {
    scene: &'a Scene,
    batches: Vec<Batch>,
    next_tag: u32,
}

impl Flattener<'_> {
    fn draw(&mut self, draw: &Draw, path: String, slope: Option<f32>) {
        match draw {
            Draw::Triangles(primitives) => self.primitives(primitives, Topology::Triangles, path, slope),
            Draw::Lines(primitives) => self.primitives(primitives, Topology::Lines, path, slope),
            Draw::Points(primitives) => self.primitives(primitives, Topology::Points, path, slope),
            Draw::Curve(curve) => self.curve(curve, path, slope),
            Draw::Decal(decal) => {
                for (index, draw) in decal.draw.iter().enumerate() {
                    self.draw(draw, format!("{path}.decal.draw[{index}]"), Some(decal.slope));
                }
            }
            Draw::Mesh(named) => {
                if let Some(mesh) = &named.mesh {
                    self.mesh(named, mesh, path, slope);
                }
            }
        }
    }

    fn tag(&mut self, asked: Option<u32>) -> u32 {
        asked.unwrap_or_else(|| {
            let tag = self.next_tag;
            self.next_tag = tag.wrapping_add(1);
            tag
        })
    }

    fn translucent(&self, material: Option<&str>) -> bool {
        let material = material.and_then(|name| self.scene.materials.get(name));
        material.is_some_and(|material| material.blend == Blend::Alpha)
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
            material: draw.material.clone(),
            translucent: self.translucent(draw.material.as_deref()),
            extent: draw.extent.unwrap_or(1.0),
            tag: self.tag(draw.tag),
        };
        batch.paint(&draw.colours);
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
        self.batches.push(Batch {
            path,
            topology: Topology::Lines,
            positions,
            colours,
            normals: None,
            texture_coordinates: None,
            indices,
            transform: IDENTITY,
            slope,
            material: curve.material.clone(),
            translucent: self.translucent(curve.material.as_deref()),
            extent: curve.width.unwrap_or(1.0),
            tag,
        });
    }

    fn mesh(&mut self, named: &MeshDraw, mesh: &Mesh, path: String, slope: Option<f32>) {
        let tag = self.tag(named.tag);
        let base = Batch {
            path,
            topology: Topology::Triangles,
            positions: mesh.positions.clone(),
            colours: Vec::new(),
            normals: mesh.normals.clone(),
            texture_coordinates: None,
            indices: Vec::new(),
            transform: named.transform,
            slope,
            material: named.material.clone(),
            translucent: self.translucent(named.material.as_deref()),
            extent: 1.0,
            tag,
        };
        let plain = named.colour.map_or_else(|| mesh.colours.clone(), Colours::One);
        // The viewer in the mesh's own space, since that is where its normals are.
        let viewer = match self.scene.camera.placement() {
            Some([eye, ..]) => wide_matrix(&named.transform).inverse().transform_point3(wide(eye)),
            None => wide(mesh.bounds().centre) - glam::DVec3::Z * 1e6,
        };
        if !mesh.indices.is_empty() {
            let mut faces = Batch { indices: mesh.indices.clone(), ..base.clone() };
            let lit = self.scene.lights.is_empty() && viewer.is_finite();
            faces.paint(&if lit { mesh.baked(&plain, viewer) } else { plain.clone() });
            self.batches.push(faces);
        }
        for (topology, indices) in [(Topology::Lines, &mesh.lines), (Topology::Points, &mesh.points)] {
            if !indices.is_empty() {
                let mut loose = Batch { topology, indices: indices.clone(), ..base.clone() };
                loose.paint(&plain);
                self.batches.push(loose);
            }
        }
        if named.edges {
            let indices = mesh.feature_edges(FEATURE_ANGLE_DEGREES).into_flattened();
            let tag = self.tag(None);
            let path = format!("{}.mesh.edges", base.path);
            let slope = Some(named.slope);
            let mut edges = Batch { path, topology: Topology::Lines, indices, slope, tag, ..base };
            edges.paint(&Colours::One(named.edge_colour));
            self.batches.push(edges);
        }
    }
}

impl Batch {
    /// Gives each position its colour. Colours by face take the corners of different faces apart.
    fn paint(&mut self, colours: &Colours) {
        let indices = &self.indices;
        match colours {
            Colours::One(colour) => self.colours = vec![*colour; self.positions.len()],
            Colours::PerVertex(list) => self.colours.clone_from(list),
            Colours::PerFace(list) => {
                self.colours = list.iter().flat_map(|colour| [*colour; 3]).collect();
                self.positions = indices.iter().map(|i| self.positions[*i as usize]).collect();
                let normals = self.normals.take();
                self.normals = normals.map(|all| indices.iter().map(|i| all[*i as usize]).collect());
                let coordinates = self.texture_coordinates.take();
                self.texture_coordinates = coordinates.map(|all| indices.iter().map(|i| all[*i as usize]).collect());
                self.indices = (0..self.positions.len() as u32).collect();
            }
        }
        // A value built by hand may have fewer colours than corners; a missing one is white.
        self.colours.resize(self.positions.len(), [255; 4]);
    }
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
