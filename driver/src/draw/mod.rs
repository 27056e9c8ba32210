//! Drawing: vertices from the host in packets, or from video memory.

mod curve;
mod flatten;
mod mesh;
mod vertices;

use zga_abi::bus::Bus;
use zga_abi::format::Topology;
use zga_abi::packet::{DrawFlags, Opcode};

use crate::{Driver, DriverError};
pub use curve::Curve;
pub use mesh::MeshBuffer;
pub use vertices::Vertices;

/// A vertex: a position in object space (or pixels and depth with the screen camera) and a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// x, y, z.
    pub position: [f32; 3],
    /// Red, green, blue, alpha (255 opaque).
    pub colour: [u8; 4],
}

impl Vertex {
    /// A vertex.
    #[must_use]
    pub const fn new(position: [f32; 3], colour: [u8; 4]) -> Vertex {
        Vertex { position, colour }
    }
}

/// Vertices of one primitive where primitives do not share any.
pub(crate) const fn vertices_each(topology: Topology) -> usize {
    match topology {
        Topology::Triangles => 3,
        Topology::Lines => 2,
        Topology::Points | Topology::LineStrip => 1,
    }
}

/// Checks that so many vertices (or indices) make whole primitives.
pub(crate) fn check_whole(topology: Topology, vertices: usize) -> Result<(), DriverError> {
    let multiple = vertices_each(topology);
    if vertices.is_multiple_of(multiple) {
        return Ok(());
    }
    Err(DriverError::VertexCount { vertices, topology: topology.name(), multiple })
}

/// Whether a primitive has vertices of different colours, so that colours must be interpolated.
pub(crate) fn needs_gouraud(topology: Topology, mut colour: impl FnMut(usize) -> [u8; 4], vertices: usize) -> bool {
    match topology {
        Topology::Points => false,
        Topology::LineStrip => (1..vertices).any(|at| colour(at) != colour(at - 1)),
        Topology::Triangles | Topology::Lines => {
            let each = vertices_each(topology);
            (0..vertices).any(|at| colour(at) != colour(at / each * each))
        }
    }
}

impl<B: Bus> Driver<B> {
    /// Draws a triangle; both windings are drawn.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_triangle(&mut self, vertices: [Vertex; 3]) -> Result<(), DriverError> {
        self.draw(Topology::Triangles, &vertices)
    }

    /// Draws a line one pixel wide, without its last pixel; with anti-aliasing as wide as
    /// [`Driver::set_line_width`] says, with both ends cut square.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_line(&mut self, vertices: [Vertex; 2]) -> Result<(), DriverError> {
        self.draw(Topology::Lines, &vertices)
    }

    /// Draws the pixel that a point lies in; with anti-aliasing a square round it, see [`Driver::set_point_size`].
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_point(&mut self, vertex: Vertex) -> Result<(), DriverError> {
        self.draw(Topology::Points, &[vertex])
    }

    /// Draws a triangle for every three vertices.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_triangles(&mut self, vertices: &[Vertex]) -> Result<(), DriverError> {
        self.draw(Topology::Triangles, vertices)
    }

    /// Draws a line for every two vertices.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_lines(&mut self, vertices: &[Vertex]) -> Result<(), DriverError> {
        self.draw(Topology::Lines, vertices)
    }

    /// Draws a point for every vertex.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_points(&mut self, vertices: &[Vertex]) -> Result<(), DriverError> {
        self.draw(Topology::Points, vertices)
    }

    /// Draws lines from each vertex to the next; shared end points are drawn once.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_line_strip(&mut self, vertices: &[Vertex]) -> Result<(), DriverError> {
        self.draw(Topology::LineStrip, vertices)
    }

    /// Draws vertices from the host. What is too long for a packet is split between primitives.
    ///
    /// # Errors
    /// [`DriverError::OutsideScene`], [`DriverError::VertexCount`] if they do not make whole primitives,
    /// [`DriverError::View`] for a decal slope that the camera does not allow, [`DriverError::Memory`] if there is no
    /// room for lights, or as [`Driver::flush`].
    pub fn draw(&mut self, topology: Topology, vertices: &[Vertex]) -> Result<(), DriverError> {
        self.draw_vertices(topology, &Vertices::coloured(vertices), None)
    }

    /// Draws positions from the host in the material colour.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_positions(&mut self, topology: Topology, positions: &[[f32; 3]]) -> Result<(), DriverError> {
        self.draw_vertices(topology, &Vertices::new(positions), None)
    }

    /// Draws vertices that indices name, from the host. If it is too long for one packet the vertices are
    /// sent in the order of the indices; a mesh buffer avoids that.
    ///
    /// # Errors
    /// [`DriverError::BadIndex`], or as [`Driver::draw`].
    pub fn draw_indexed(
        &mut self,
        topology: Topology,
        vertices: &[Vertex],
        indices: &[u32],
    ) -> Result<(), DriverError> {
        self.draw_vertices(topology, &Vertices::coloured(vertices), Some(indices))
    }

    /// Draws vertices of any format from the host, in their order or in that of indices. What is too long for a packet
    /// is split between primitives; with indices the vertices are sent in their order then.
    ///
    /// # Errors
    /// [`DriverError::ListLength`] if there is not a colour, normal or texture coordinate for each vertex,
    /// [`DriverError::BadIndex`], or as [`Driver::draw`].
    pub fn draw_vertices(
        &mut self,
        topology: Topology,
        vertices: &Vertices<'_>,
        indices: Option<&[u32]>,
    ) -> Result<(), DriverError> {
        vertices.check()?;
        let count = indices.map_or(vertices.len(), <[u32]>::len);
        check_whole(topology, count)?;
        mesh::check_indices(indices.unwrap_or_default(), vertices.len())?;
        self.open_scene("draw")?;
        if count == 0 {
            return Ok(());
        }
        let gouraud = vertices.gouraud(topology, indices);
        let words = vertices.words();
        let flags = vertices.flags(topology, false);
        match indices {
            None => self.draw_inline(flags, gouraud, &words),
            Some(indices) if 4 + words.len() + indices.len() > self.queue.max_packet() => {
                let each = flags.vertex_words() as usize;
                let vertex = |&index: &u32| words[index as usize * each..][..each].iter().copied();
                let ordered: Vec<u32> = indices.iter().flat_map(vertex).collect();
                self.draw_inline(flags, gouraud, &ordered)
            }
            Some(indices) => {
                let flags = DrawFlags { indexed: true, ..flags };
                let counts = [flags.code(), vertices.len() as u32, indices.len() as u32];
                let sent = self.prepare_draw("draw", flags, gouraud)?;
                self.encode_in_scene("draw", sent, Opcode::DrawInline, &[&counts, &words, indices])
            }
        }
    }

    /// Draws vertices of any number, at least one.
    fn draw_inline(&mut self, flags: DrawFlags, gouraud: bool, words: &[u32]) -> Result<(), DriverError> {
        let mut result = self.prepare_draw("draw", flags, gouraud)?;
        let each = flags.vertex_words() as usize;
        let count = words.len() / each;
        let most = (self.queue.max_packet() - 4) / each / 6 * 6;
        let mut first = 0;
        while first < count {
            let last = count.min(first + most);
            let counts = [flags.code(), (last - first) as u32, 0];
            let part = &words[first * each..last * each];
            result = self.encode_in_scene("draw", result, Opcode::DrawInline, &[&counts, part]);
            // A strip goes on from its last vertex.
            first = if flags.topology == Topology::LineStrip && last < count { last - 1 } else { last };
        }
        result
    }
}
