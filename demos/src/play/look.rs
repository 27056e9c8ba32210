//! Ways to look at a scene: its markings without the decal transform, its triangles as lines.

use std::collections::HashSet;

use crate::scene::{Batch, Colour, DEFAULT_SLOPE, Scene, Topology};

/// What is switched when a scene is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Surface markings are drawn with the decal transform.
    pub decals: bool,
    /// Triangles are drawn as their edges; hidden ones are removed by surfaces in the colour of the background.
    pub wireframe: bool,
}

impl Default for Look {
    /// The scene as it is.
    fn default() -> Self {
        Self { decals: true, wireframe: false }
    }
}

impl Look {
    /// The scene's batches, looked at so.
    #[must_use]
    pub fn batches(self, scene: &Scene) -> Vec<Batch> {
        let mut batches = scene.batches();
        if self.wireframe {
            batches = batches.into_iter().flat_map(|batch| wires(batch, scene.background)).collect();
        }
        if !self.decals {
            batches.iter_mut().for_each(|batch| batch.slope = None);
        }
        batches
    }
}

/// A batch of triangles as a surface that cannot be seen and its edges, as decals on it; others as they are.
fn wires(mut batch: Batch, background: Colour) -> Vec<Batch> {
    if batch.topology != Topology::Triangles {
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
    let edges = Batch {
        path: format!("{} (edges)", batch.path),
        topology: Topology::Lines,
        slope: Some(batch.slope.unwrap_or(DEFAULT_SLOPE)),
        indices,
        ..batch.clone()
    };
    batch.colours.fill(background);
    batch.translucent = false;
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
        let batches = Look { wireframe: true, decals: false }.batches(&square());
        assert!(batches.iter().all(|batch| batch.slope.is_none()));
    }
}
