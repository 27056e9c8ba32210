//! Meshes as batches: one for each run of triangles that look the same, then lines, points and feature edges.
//!
//! Duties: says which material a part has, takes a part's vertices out of the mesh, and works light into colours where
//! the scene has no lights. Inputs from: [`Mesh`]. Outputs to: the list of batches.

use std::ops::Range;
use std::sync::Arc;

use super::camera::{wide, wide_matrix};
use super::flatten::{Flattener, each};
use super::{Batch, Colour, Colours, Lighting, Material, MeshDraw, Topology};
use crate::mesh::Mesh;

/// Angle between two faces from which their common edge is a feature, in degrees.
const FEATURE_ANGLE_DEGREES: f32 = 30.0;

/// Triangles that look the same.
struct Run {
    triangles: Range<usize>,
    material: Arc<Material>,
}

impl Flattener<'_> {
    pub(super) fn mesh(&mut self, named: &MeshDraw, mesh: &Mesh, path: String, slope: Option<f32>) {
        let tag = self.tag(named.tag);
        let base = Batch {
            path,
            topology: Topology::Triangles,
            positions: Vec::new(),
            colours: Vec::new(),
            normals: None,
            texture_coordinates: None,
            indices: Vec::new(),
            transform: named.transform,
            slope,
            // A mesh has no part in a fitted decal.
            surfaces: Arc::default(),
            material: self.material(named.material.as_deref()),
            light: Lighting::None,
            translucent: false,
            extent: 1.0,
            tag,
        };
        let plain = named.colour.map_or_else(|| mesh.colours.clone(), Colours::One);
        // The viewer in the mesh's own space, since that is where its normals are.
        let viewer = match self.scene.camera.placement() {
            Some([eye, ..]) => wide_matrix(&named.transform).inverse().transform_point3(wide(eye)),
            None => wide(mesh.bounds().centre) - glam::DVec3::Z * 1e6,
        };
        let runs = runs(named, mesh, &base.material);
        let bakes = |material: &Material| {
            self.scene.lights.is_empty() && material.light.is_none() && viewer.is_finite() && !mesh.indices.is_empty()
        };
        let baked = runs.iter().any(|run| bakes(&run.material)).then(|| mesh.baked(&plain, viewer));
        let mut taken = Taken { mesh, renumbered: Vec::new() };
        for (number, run) in runs.iter().enumerate() {
            let light = baked.as_ref().filter(|_| bakes(&run.material));
            let colours = light.unwrap_or(&plain);
            let path = match runs.len() {
                1 => base.path.clone(),
                _ => format!("{}.mesh.parts[{number}]", base.path),
            };
            let mut faces = Batch { path, material: Arc::clone(&run.material), ..base.clone() };
            let textured = run.material.texture.is_some();
            let colours = if runs.len() == 1 {
                taken.everything(&mut faces, textured);
                colours.clone()
            } else {
                taken.run(&mut faces, run.triangles.clone(), textured, colours)
            };
            faces.paint(&colours);
            faces.settle(self.scene);
            if light.is_some() {
                give_off(&mut faces.colours, run.material.emission);
            }
            self.batches.push(faces);
        }
        for (topology, indices) in [(Topology::Lines, &mesh.lines), (Topology::Points, &mesh.points)] {
            if !indices.is_empty() {
                let mut loose = Batch { topology, ..base.clone() };
                taken.everything(&mut loose, false);
                loose.indices.clone_from(indices);
                loose.paint(&plain);
                loose.settle(self.scene);
                loose.light = Lighting::None;
                self.batches.push(loose);
            }
        }
        if named.edges {
            let tag = self.tag(None);
            let path = format!("{}.mesh.edges", base.path);
            let slope = Some(named.slope);
            let mut edges = Batch { path, topology: Topology::Lines, slope, tag, ..base };
            taken.everything(&mut edges, false);
            edges.indices = mesh.feature_edges(FEATURE_ANGLE_DEGREES).into_flattened();
            edges.paint(&Colours::One(named.edge_colour));
            edges.settle(self.scene);
            edges.light = Lighting::None;
            self.batches.push(edges);
        }
    }
}

/// The triangles of a mesh by material: one run where the scene gives the material. Parts beside each other that look
/// the same are one.
fn runs(named: &MeshDraw, mesh: &Mesh, given: &Arc<Material>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    if mesh.indices.is_empty() {
        return runs;
    }
    if named.material.is_none() {
        for part in mesh.parts.iter().filter(|part| !part.triangles.is_empty()) {
            match runs.last_mut() {
                Some(last) if last.material == part.material && last.triangles.end == part.triangles.start => {
                    last.triangles.end = part.triangles.end;
                }
                _ => runs.push(Run { triangles: part.triangles.clone(), material: Arc::clone(&part.material) }),
            }
        }
    }
    if runs.is_empty() {
        runs.push(Run { triangles: 0..mesh.triangle_count(), material: Arc::clone(given) });
    }
    runs
}

/// Adds the colour that a surface gives off to its vertices, for those whose light is in their colours.
fn give_off(colours: &mut [Colour], emission: Colour) {
    if emission[..3] == [0; 3] {
        return;
    }
    for colour in colours {
        for channel in 0..3 {
            colour[channel] = colour[channel].saturating_add(emission[channel]);
        }
    }
}

/// Takes vertices out of a mesh.
struct Taken<'a> {
    mesh: &'a Mesh,
    /// The number of each vertex in the run; `u32::MAX` where it has none.
    renumbered: Vec<u32>,
}

impl Taken<'_> {
    /// All vertices and triangles, as they are.
    fn everything(&self, batch: &mut Batch, textured: bool) {
        batch.positions.clone_from(&self.mesh.positions);
        batch.normals.clone_from(&self.mesh.normals);
        batch.indices.clone_from(&self.mesh.indices);
        if textured {
            batch.texture_coordinates.clone_from(&self.mesh.texture_coordinates);
        }
    }

    /// A run of triangles with the vertices that it uses and no others, however many runs there are. Gives the run's
    /// colours, of those of the whole mesh.
    fn run(&mut self, batch: &mut Batch, triangles: Range<usize>, textured: bool, colours: &Colours) -> Colours {
        let mesh = self.mesh;
        self.renumbered.resize(mesh.positions.len(), u32::MAX);
        let mut used: Vec<u32> = Vec::new();
        let corners = mesh.indices.get(triangles.start * 3..triangles.end * 3).unwrap_or_default();
        for index in corners {
            let number = &mut self.renumbered[*index as usize];
            if *number == u32::MAX {
                *number = used.len() as u32;
                used.push(*index);
            }
            batch.indices.push(*number);
        }
        for index in &used {
            self.renumbered[*index as usize] = u32::MAX;
        }
        batch.positions = each(&used, &mesh.positions);
        batch.normals = mesh.normals.as_ref().map(|all| each(&used, all));
        batch.texture_coordinates = mesh.texture_coordinates.as_ref().filter(|_| textured).map(|all| each(&used, all));
        match colours {
            Colours::One(colour) => Colours::One(*colour),
            Colours::PerVertex(list) if list.len() == mesh.positions.len() => Colours::PerVertex(each(&used, list)),
            Colours::PerVertex(_) => Colours::default(),
            Colours::PerFace(list) => Colours::PerFace(list.get(triangles).unwrap_or_default().to_vec()),
        }
    }
}
