//! Feature edges: where a surface ends or turns sharply.
//!
//! Vertices at the same position count as one, so a seam of normals or texture coordinates is no boundary.

use std::collections::HashMap;

use super::Mesh;

/// The triangles at an edge: unit normals of the first two, and how many there are.
struct Sides {
    ends: [u32; 2],
    normals: [glam::DVec3; 2],
    count: u32,
}

impl Mesh {
    /// For each vertex, the first vertex at the same position.
    #[must_use]
    pub fn welded(&self) -> Vec<u32> {
        let mut first = HashMap::with_capacity(self.positions.len());
        // Adding zero makes -0 and 0 the same bits.
        let key = |position: &[f32; 3]| position.map(|coordinate| (coordinate + 0.0).to_bits());
        (0_u32..).zip(&self.positions).map(|(index, position)| *first.entry(key(position)).or_insert(index)).collect()
    }

    /// The edges of the triangles, each once, as indices of vertices, in the order in which they first appear:
    /// those with one triangle (boundaries), with more than two, or between faces that turn by more than
    /// `angle_degrees`. With a negative angle: all edges. Triangles without area do not count.
    #[must_use]
    pub fn feature_edges(&self, angle_degrees: f32) -> Vec<[u32; 2]> {
        let limit = f64::from(angle_degrees).to_radians().cos();
        let is_feature =
            |edge: &&Sides| edge.count != 2 || angle_degrees < 0.0 || edge.normals[0].dot(edge.normals[1]) < limit;
        self.edges().iter().filter(is_feature).map(|edge| edge.ends).collect()
    }

    fn edges(&self) -> Vec<Sides> {
        let welded = self.welded();
        let mut edges: Vec<Sides> = Vec::new();
        let mut known: HashMap<[u32; 2], usize> = HashMap::with_capacity(self.indices.len() / 2);
        for corners in self.triangles() {
            let corners = corners.map(|index| welded[index as usize]);
            let Some(normal) = self.face_vector(corners).try_normalize() else { continue };
            for side in 0..3 {
                let (a, b) = (corners[side], corners[(side + 1) % 3]);
                let slot = *known.entry([a.min(b), a.max(b)]).or_insert(edges.len());
                match edges.get_mut(slot) {
                    Some(edge) => {
                        // Faces wound against each other are seen from the same side.
                        let turned = if edge.ends == [a, b] { -normal } else { normal };
                        edge.normals[1] = turned;
                        edge.count += 1;
                    }
                    None => edges.push(Sides { ends: [a, b], normals: [normal; 2], count: 1 }),
                }
            }
        }
        edges
    }
}
