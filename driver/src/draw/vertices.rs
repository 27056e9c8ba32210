//! Vertices as lists of what they have: positions, and as wished colours, normals, texture coordinates.

use std::borrow::Cow;

use zga_abi::format::Topology;
use zga_abi::packet::DrawFlags;

use super::{Vertex, needs_gouraud};
use crate::DriverError;

/// Vertices for [`crate::Driver::draw_vertices`] and [`crate::Driver::create_mesh`].
///
/// Positions, and lists of the same length of what else each vertex has. What is left out is not sent: without colours
/// everything has the material colour, without normals it is not lit, without texture coordinates it is not textured.
///
/// ```
/// use zga_driver::Vertices;
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let vertices = Vertices::new(&positions)
///     .normals(&[[0.0, 0.0, 1.0]; 3])
///     .coordinates(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
/// assert_eq!((vertices.len(), vertices.words_each()), (3, 8));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertices<'a> {
    base: Base<'a>,
    colours: Option<&'a [[u8; 4]]>,
    normals: Option<&'a [[f32; 3]]>,
    coordinates: Option<&'a [[f32; 2]]>,
}

/// Where positions come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Base<'a> {
    Positions(&'a [[f32; 3]]),
    /// With colours.
    Vertices(&'a [Vertex]),
}

impl<'a> Vertices<'a> {
    /// Vertices at these positions: x, y, z in object space, or pixels and depth with the screen camera.
    #[must_use]
    pub const fn new(positions: &'a [[f32; 3]]) -> Vertices<'a> {
        Vertices { base: Base::Positions(positions), colours: None, normals: None, coordinates: None }
    }

    /// The positions and colours of these vertices.
    #[must_use]
    pub const fn coloured(vertices: &'a [Vertex]) -> Vertices<'a> {
        Vertices { base: Base::Vertices(vertices), colours: None, normals: None, coordinates: None }
    }

    /// With these colours: red, green, blue, alpha (255 opaque).
    #[must_use]
    pub const fn colours(self, colours: &'a [[u8; 4]]) -> Vertices<'a> {
        Vertices { colours: Some(colours), ..self }
    }

    /// With these normals, in object space, of any length.
    #[must_use]
    pub const fn normals(self, normals: &'a [[f32; 3]]) -> Vertices<'a> {
        Vertices { normals: Some(normals), ..self }
    }

    /// With these texture coordinates: u to the right and v down, 0 to 1 the texture.
    #[must_use]
    pub const fn coordinates(self, coordinates: &'a [[f32; 2]]) -> Vertices<'a> {
        Vertices { coordinates: Some(coordinates), ..self }
    }

    /// Number of vertices.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self.base {
            Base::Positions(positions) => positions.len(),
            Base::Vertices(vertices) => vertices.len(),
        }
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Words of a vertex as it is sent.
    #[must_use]
    pub const fn words_each(&self) -> u32 {
        self.flags(Topology::Points, false).vertex_words()
    }

    /// The flags of a draw.
    pub(crate) const fn flags(&self, topology: Topology, indexed: bool) -> DrawFlags {
        DrawFlags {
            topology,
            indexed,
            coloured: self.colours.is_some() || matches!(self.base, Base::Vertices(_)),
            normals: self.normals.is_some(),
            coordinates: self.coordinates.is_some(),
        }
    }

    /// Checks that every list has an entry for each vertex.
    pub(crate) fn check(&self) -> Result<(), DriverError> {
        let expected = self.len();
        let lists = [
            ("colours", self.colours.map(<[_]>::len)),
            ("normals", self.normals.map(<[_]>::len)),
            ("texture coordinates", self.coordinates.map(<[_]>::len)),
        ];
        for (list, found) in lists {
            if let Some(found) = found.filter(|&found| found != expected) {
                return Err(DriverError::ListLength { list, found, expected });
            }
        }
        Ok(())
    }

    /// The colour of a vertex; white where there is none.
    fn colour(&self, at: usize) -> [u8; 4] {
        match (self.colours, self.base) {
            (Some(colours), _) => colours[at],
            (None, Base::Vertices(vertices)) => vertices[at].colour,
            (None, Base::Positions(_)) => [255; 4],
        }
    }

    /// Whether colours differ within a primitive.
    pub(crate) fn gouraud(&self, topology: Topology, indices: Option<&[u32]>) -> bool {
        match indices {
            _ if !self.flags(topology, false).coloured => false,
            None => needs_gouraud(topology, |at| self.colour(at), self.len()),
            Some(indices) => needs_gouraud(topology, |at| self.colour(indices[at] as usize), indices.len()),
        }
    }

    /// The words of all vertices.
    pub(crate) fn words(&self) -> Cow<'a, [u32]> {
        match *self {
            Vertices { base: Base::Positions(positions), colours: None, normals: None, coordinates: None } => {
                Cow::Borrowed(bytemuck::cast_slice(positions))
            }
            Vertices { base: Base::Vertices(vertices), colours: None, normals: None, coordinates: None } => {
                Cow::Borrowed(bytemuck::cast_slice(vertices))
            }
            _ => {
                let flags = self.flags(Topology::Points, false);
                let mut words = Vec::with_capacity(self.len() * flags.vertex_words() as usize);
                for at in 0..self.len() {
                    let position = match self.base {
                        Base::Positions(positions) => positions[at],
                        Base::Vertices(vertices) => vertices[at].position,
                    };
                    words.extend(position.map(f32::to_bits));
                    if flags.coloured {
                        words.push(u32::from_le_bytes(self.colour(at)));
                    }
                    words.extend(self.normals.iter().flat_map(|normals| normals[at]).map(f32::to_bits));
                    words.extend(self.coordinates.iter().flat_map(|list| list[at]).map(f32::to_bits));
                }
                Cow::Owned(words)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSITIONS: [[f32; 3]; 2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];

    #[test]
    fn words_are_position_colour_normal_coordinates() {
        let ones = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let vertices = Vertices::new(&POSITIONS)
            .coordinates(&[[0.25, 0.5], [0.5, 2.0]])
            .normals(&ones)
            .colours(&[[1, 2, 3, 4], [5, 6, 7, 8]]);
        let f = f32::to_bits;
        let first = [f(1.0), f(2.0), f(3.0), 0x0403_0201, f(1.0), 0, 0, f(0.25), f(0.5)];
        let second = [f(4.0), f(5.0), f(6.0), 0x0807_0605, 0, f(1.0), 0, f(0.5), f(2.0)];
        assert_eq!(*vertices.words(), [first, second].concat());
        assert_eq!(vertices.flags(Topology::Lines, true).code(), 0x711);
    }

    #[test]
    fn words_of_every_format_are_as_many_as_its_flags_say() {
        let coloured = POSITIONS.map(|position| Vertex::new(position, [9; 4]));
        let bases = [Vertices::new(&POSITIONS), Vertices::coloured(&coloured)];
        for base in bases {
            let formats = [
                base,
                base.colours(&[[3; 4]; 2]),
                base.normals(&[[0.0; 3]; 2]),
                base.coordinates(&[[0.0; 2]; 2]),
                base.normals(&[[0.0; 3]; 2]).coordinates(&[[0.0; 2]; 2]),
            ];
            for vertices in formats {
                assert_eq!(vertices.words().len(), 2 * vertices.words_each() as usize, "{vertices:?}");
                assert_eq!(vertices.words()[0], 1.0_f32.to_bits());
            }
        }
        assert_eq!(Vertices::coloured(&coloured).words()[3], 0x0909_0909);
        assert_eq!(Vertices::coloured(&coloured).colours(&[[3; 4]; 2]).words()[3], 0x0303_0303);
    }

    #[test]
    fn check_names_the_list_that_is_too_short() {
        let refused = Vertices::new(&POSITIONS).normals(&[[0.0; 3]; 1]).check().expect_err("one normal");
        assert_eq!(refused.to_string(), "1 normals for 2 vertices");
        assert!(Vertices::new(&POSITIONS).normals(&[[0.0; 3]; 2]).check().is_ok());
    }
}
