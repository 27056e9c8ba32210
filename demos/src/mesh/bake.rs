//! Light worked into colours before the mesh reaches the card, for scenes that name no lights of their own.
//!
//! Lambert's law with three lights that move with the viewer: a key light from above on the left, a head light, and
//! light from all around that is a little stronger from above.

use glam::DVec3;

use super::Mesh;
use crate::scene::{Colour, Colours};

const AMBIENT: f64 = 0.30;
/// How much the ambient light differs between above and below.
const SKY: f64 = 0.08;
const KEY: f64 = 0.52;
const HEAD: f64 = 0.16;

impl Mesh {
    /// `plain` (colours of this mesh) in the light seen by a viewer at `viewer`, in the mesh's space.
    /// With normals: one colour for each vertex. Without: one for each triangle, lit on the side that is seen.
    #[must_use]
    pub fn baked(&self, plain: &Colours, viewer: DVec3) -> Colours {
        let lights = Lights::toward(viewer - crate::scene::wide(self.bounds().centre));
        let colour_of = |list: &[Colour], index: usize| list.get(index).copied().unwrap_or([255; 4]);
        let vertex_colour = |vertex: u32| match plain {
            Colours::One(colour) => *colour,
            Colours::PerVertex(list) => colour_of(list, vertex as usize),
            Colours::PerFace(_) => [255; 4],
        };
        match (&self.normals, plain) {
            (Some(normals), Colours::One(_) | Colours::PerVertex(_)) => {
                let lit =
                    |(vertex, normal): (u32, &[f32; 3])| lights.on(crate::scene::wide(*normal), vertex_colour(vertex));
                Colours::PerVertex((0..).zip(normals).map(lit).collect())
            }
            _ => {
                let lit = |(face, corners): (usize, [u32; 3])| {
                    let normal = self.face_vector(corners).normalize_or_zero();
                    let middle = corners.iter().map(|index| self.corner(*index)).sum::<DVec3>() / 3.0;
                    let seen = if normal.dot(viewer - middle) < 0.0 { -normal } else { normal };
                    let colour = match plain {
                        Colours::PerFace(list) => colour_of(list, face),
                        _ => mean(corners.map(vertex_colour)),
                    };
                    lights.on(seen, colour)
                };
                Colours::PerFace(self.triangles().enumerate().map(lit).collect())
            }
        }
    }
}

fn mean(colours: [Colour; 3]) -> Colour {
    std::array::from_fn(|channel| {
        let sum: u32 = colours.iter().map(|colour| u32::from(colour[channel])).sum();
        ((sum + 1) / 3) as u8
    })
}

struct Lights {
    head: DVec3,
    key: DVec3,
}

impl Lights {
    /// Lights for a viewer in the direction `toward`.
    fn toward(toward: DVec3) -> Self {
        let head = toward.try_normalize().unwrap_or(DVec3::Z);
        // Seen from straight above, "up" is away from the viewer's feet.
        let up = if head.y.abs() > 0.999 { DVec3::NEG_Z } else { DVec3::Y };
        let right = up.cross(head).normalize();
        let up = head.cross(right);
        Self { head, key: (head * 0.8 - right * 0.65 + up * 0.9).normalize() }
    }

    fn on(&self, normal: DVec3, colour: Colour) -> Colour {
        let key = normal.dot(self.key).max(0.0);
        let head = normal.dot(self.head).max(0.0);
        let light = AMBIENT + SKY * normal.y + KEY * key + HEAD * head;
        let lit = |channel: u8| (f64::from(channel) * light).round().clamp(0.0, 255.0) as u8;
        [lit(colour[0]), lit(colour[1]), lit(colour[2]), colour[3]]
    }
}
