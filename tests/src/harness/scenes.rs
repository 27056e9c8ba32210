//! Random scenes for differential tests: every kind of primitive that a rasteriser gets wrong.

use super::{Random, depth};
use crate::oracle::{Primitive, Vertex};
use proptest::prelude::*;

/// What a piece of a scene is made of; expands into one or many primitives.
#[derive(Clone, Debug)]
pub enum Piece {
    /// Three free corners.
    Triangle([Vertex; 3]),
    /// Triangles round a hub.
    Fan(Vertex, Vec<Vertex>),
    /// Each vertex after the second makes a triangle with the two before it.
    Strip(Vec<Vertex>),
    /// One plane twice: a triangle, and the same with its vertices in another order, then a part of it.
    Coincident([Vertex; 3]),
    /// A line.
    Line([Vertex; 2]),
    /// Lines from each vertex to the next.
    Polyline(Vec<Vertex>),
    /// A point.
    Point(Vertex),
}

impl Piece {
    /// The primitives, in order.
    #[must_use]
    pub fn primitives(&self) -> Vec<Primitive> {
        match self {
            Self::Triangle(v) => vec![Primitive::Triangle(*v)],
            Self::Fan(hub, rim) => {
                let next = rim.iter().cycle().skip(1);
                rim.iter().zip(next).map(|(a, b)| Primitive::Triangle([*hub, *a, *b])).collect()
            }
            Self::Strip(v) => v.windows(3).map(|w| Primitive::Triangle([w[0], w[1], w[2]])).collect(),
            Self::Coincident([a, b, c]) => {
                vec![
                    Primitive::Triangle([*a, *b, *c]),
                    Primitive::Triangle([*c, *b, *a]),
                    Primitive::Triangle([*b, *c, *a]),
                ]
            }
            Self::Line(v) => vec![Primitive::Line(*v)],
            Self::Polyline(v) => v.windows(2).map(|w| Primitive::Line([w[0], w[1]])).collect(),
            Self::Point(v) => vec![Primitive::Point(*v)],
        }
    }
}

/// The primitives of pieces.
#[must_use]
pub fn primitives(pieces: &[Piece]) -> Vec<Primitive> {
    pieces.iter().flat_map(Piece::primitives).collect()
}

/// Depths of `bits` bits that survive an f32: anything, the ends, and a few values close together so that ties occur.
pub fn any_depth(bits: u32) -> impl Strategy<Value = u32> + Clone {
    let greatest = ((1_u64 << bits) - 1) as u32;
    let values = prop_oneof![
        4 => 0..=greatest,
        1 => Just(0),
        1 => Just(greatest),
        3 => (0_u32..6).prop_map(move |k| greatest / 2 + k),
    ];
    values.prop_map(move |z| depth::survivor(z, bits)).boxed()
}

/// A vertex within `reach` u of `centre`, often on the lattice of quarter pixels where the ties are.
fn vertex(centre: [i32; 2], reach: i32, bits: u32) -> impl Strategy<Value = Vertex> + Clone {
    let free = (-reach..=reach, -reach..=reach);
    let tied = (-reach..=reach, -reach..=reach).prop_map(|(x, y)| (x & !63, y & !63));
    let offset = prop_oneof![2 => free, 1 => tied];
    (offset, any_depth(bits)).prop_map(move |((x, y), z)| Vertex::at(centre[0] + x, centre[1] + y, z)).boxed()
}

/// One piece of a scene on a target of `size` pixels.
pub fn piece(size: [u32; 2], bits: u32) -> impl Strategy<Value = Piece> {
    let [width, height] = size.map(|side| side as i32 * 256);
    let place = (-512..width + 512, -512..height + 512).prop_map(|(x, y)| [x & !63, y & !63]);
    // Reaches from a fraction of a pixel to the guard band (which lies around the target's centre).
    let reach = prop_oneof![3 => 1_i32..700, 3 => 700_i32..8_000, 1 => 8_000_i32..60_000, 1 => Just(8_300_000)];
    (place, reach).prop_flat_map(move |(place, reach)| {
        let huge = reach > 1_000_000;
        let centre = if huge { [width / 2, height / 2] } else { place };
        let vertex = vertex(centre, reach, bits);
        let triangle = [vertex.clone(), vertex.clone(), vertex.clone()];
        let sliver = ([vertex.clone(), vertex.clone()], 0.0_f64..1.0, -3..=3_i32, any_depth(bits));
        let sliver = sliver.prop_map(|([a, b], t, off, z)| {
            let mix = |a: i32, b: i32| (f64::from(a) + t * (f64::from(b) - f64::from(a))) as i32;
            Piece::Triangle([a, b, Vertex::at(mix(a.x, b.x) + off, mix(a.y, b.y), z)])
        });
        prop_oneof![
            6 => triangle.clone().prop_map(Piece::Triangle),
            2 => sliver,
            1 => (vertex.clone(), prop::collection::vec(vertex.clone(), 3..10)).prop_map(|(hub, rim)| Piece::Fan(hub, rim)),
            1 => prop::collection::vec(vertex.clone(), 3..12).prop_map(Piece::Strip),
            1 => triangle.prop_map(Piece::Coincident),
            2 => [vertex.clone(), vertex.clone()].prop_map(Piece::Line),
            1 => prop::collection::vec(vertex.clone(), 2..8).prop_map(Piece::Polyline),
            1 => vertex.prop_map(Piece::Point),
        ]
    })
}

/// A scene of up to `most` pieces on a target of `size` pixels.
pub fn scene(size: [u32; 2], bits: u32, most: usize) -> impl Strategy<Value = Vec<Piece>> {
    prop::collection::vec(piece(size, bits), 1..most)
}

/// A fixed scene of `count` triangles of up to `reach` pixels, all with one colour for their vertices, then some lines
/// and points. Depths have 24 bits.
#[must_use]
pub fn fixed(seed: u64, size: [u32; 2], count: usize, reach: i32) -> Vec<Primitive> {
    let mut random = Random::new(seed);
    let vertex = |random: &mut Random, place: [i32; 2], colour: [u8; 4]| {
        let [x, y] = place.map(|c| c + random.int(-128 * reach, 128 * reach));
        Vertex::at(x, y, random.depth((1 << 24) - 1)).coloured(colour)
    };
    let mut scene = Vec::with_capacity(count + 64);
    for number in 0..count + 64 {
        let place = size.map(|side| random.int(0, side as i32 * 256));
        let colour = (random.bits() as u32).to_le_bytes();
        let v = [0; 3].map(|_| vertex(&mut random, place, colour));
        scene.push(match number.saturating_sub(count) {
            0 => Primitive::Triangle(v),
            k if k < 48 => Primitive::Line([v[0], v[1]]),
            _ => Primitive::Point(v[0]),
        });
    }
    scene
}
