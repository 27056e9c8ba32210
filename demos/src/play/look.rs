//! Ways to look at a scene: its markings without the decal transform, its triangles as lines, other filters and light,
//! an effect more or less.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::Arc;

use zga_abi::Effects;

use super::Change;
use crate::scene::{Batch, Colour, DEFAULT_SLOPE, FogFunction, Lighting, Material, Scene, TextureFilter, Topology};

/// What is switched when a scene is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Surface markings are drawn with the decal transform.
    pub decals: bool,
    /// Triangles are drawn as their edges; hidden ones are removed by surfaces in the colour of the background.
    pub wireframe: bool,
    /// How textures are read between texels, in place of what their materials say.
    pub filter: Option<TextureFilter>,
    /// Where light is worked out on what is lit, in place of what its materials say.
    pub lighting: Option<Lighting>,
    /// Fog where there is none, and none where there is.
    pub other_fog: bool,
    /// An effect more or less.
    pub change: Option<Change>,
}

impl Default for Look {
    /// The scene as it is.
    fn default() -> Self {
        Self { decals: true, wireframe: false, filter: None, lighting: None, other_fog: false, change: None }
    }
}

impl Look {
    /// The scene with the materials and lights that it is looked at with.
    #[must_use]
    pub fn scene(self, scene: &Scene) -> Cow<'_, Scene> {
        let mut changes: Vec<Change> = self.change.into_iter().collect();
        if self.other_fog {
            let fogged = |batch: &Batch| batch.material.fog_function != FogFunction::None;
            let any = scene.batches().iter().any(fogged);
            changes.push(if any { Change::Without(Effects::FOG) } else { Change::Fog });
        }
        let mut seen = Cow::Borrowed(scene);
        changes.into_iter().for_each(|change| change.scene(seen.to_mut()));
        seen
    }

    /// Depths are compared and stored.
    #[must_use]
    pub fn tests_depth(self) -> bool {
        self.change != Some(Change::Without(Effects::DEPTH))
    }

    /// The batches of a scene that [`Look::scene`] gave, looked at so.
    #[must_use]
    pub fn batches(self, scene: &Scene) -> Vec<Batch> {
        let mut batches = scene.batches();
        if let Some(filter) = self.filter {
            batches.iter_mut().for_each(|batch| filtered(batch, filter));
        }
        if let Some(lighting) = self.lighting {
            let lit = batches.iter_mut().filter(|batch| batch.light != Lighting::None);
            lit.for_each(|batch| batch.light = lighting);
        }
        if self.wireframe {
            batches = batches.into_iter().flat_map(|batch| wires(batch, scene.background)).collect();
        }
        if !self.decals {
            batches.iter_mut().for_each(|batch| batch.slope = None);
        }
        if let Some(change) = self.change {
            change.batches(&mut batches);
        }
        batches
    }
}

/// Gives a textured batch another filter.
fn filtered(batch: &mut Batch, filter: TextureFilter) {
    if batch.material.texture.as_ref().is_none_or(|texture| texture.filter == filter) {
        return;
    }
    let material = Arc::make_mut(&mut batch.material);
    if let Some(texture) = &mut material.texture {
        texture.filter = filter;
    }
}

/// A batch of triangles as a surface that cannot be seen and its edges, as decals on it; others as they are.
fn wires(mut batch: Batch, background: Colour) -> Vec<Batch> {
    if batch.topology != Topology::Triangles || batch.material.stencil.is_some_and(|stencil| !stencil.colours) {
        return vec![batch];
    }
    // Corners of different triangles at one place are one end of an edge.
    let key = |index: u32| batch.positions[index as usize].map(|coordinate| (coordinate + 0.0).to_bits());
    let mut known = HashSet::new();
    let mut indices = Vec::new();
    for corners in batch.indices.as_chunks::<3>().0 {
        for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|corner: usize| corners[corner])) {
            let (a, b) = (key(from), key(to));
            if known.insert(if a < b { (a, b) } else { (b, a) }) {
                indices.extend([from, to]);
            }
        }
    }
    // Edges keep fog, as a cue of depth, and blending.
    let material = Material { texture: None, punch_through: None, ..(*batch.material).clone() };
    let edges = Batch {
        path: format!("{} (edges)", batch.path),
        topology: Topology::Lines,
        material: Arc::new(material),
        light: Lighting::None,
        slope: Some(batch.slope.unwrap_or(DEFAULT_SLOPE)),
        indices,
        ..batch.clone()
    };
    batch.colours.fill(background);
    batch.make_plain();
    vec![batch, edges]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Primitives};

    fn square() -> Scene {
        let mut scene = Scene::new([8, 8], [1, 2, 3, 255]);
        scene.draw.push(Draw::Triangles(Primitives {
            vertices: vec![[0.0; 3], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0; 3], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]],
            ..Primitives::default()
        }));
        scene
    }

    #[test]
    fn batches_wireframe_draws_each_edge_once_over_a_hidden_surface() {
        let batches = Look { wireframe: true, ..Look::default() }.batches(&square());
        assert_eq!(batches.len(), 2);
        assert!(batches[0].colours.iter().all(|colour| *colour == [1, 2, 3, 255]));
        assert_eq!((batches[1].topology, batches[1].indices.len()), (Topology::Lines, 2 * 5));
        assert_eq!(batches[1].slope, Some(DEFAULT_SLOPE));
    }

    #[test]
    fn batches_without_decals_have_no_slope() {
        let batches = Look { wireframe: true, decals: false, ..Look::default() }.batches(&square());
        assert!(batches.iter().all(|batch| batch.slope.is_none()));
    }
}
