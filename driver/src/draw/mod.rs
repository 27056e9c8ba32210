//! Drawing: vertices from the host in packets, or from video memory.

mod curve;
mod flatten;
mod mesh;

use zga_abi::bus::Bus;
use zga_abi::format::Topology;
use zga_abi::packet::{DrawFlags, Opcode};

use crate::{Driver, DriverError};
pub use curve::Curve;
pub use mesh::MeshBuffer;

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
    /// [`DriverError::View`] for a decal slope that the camera does not allow, [`DriverError::NoGrid`] for blend
    /// in a scene without a grid, or as [`Driver::flush`].
    pub fn draw(&mut self, topology: Topology, vertices: &[Vertex]) -> Result<(), DriverError> {
        check_whole(topology, vertices.len())?;
        let gouraud = needs_gouraud(topology, |at| vertices[at].colour, vertices.len());
        self.draw_inline(topology, true, gouraud, vertices.len(), bytemuck::cast_slice(vertices))
    }

    /// Draws positions from the host in the material colour.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_positions(&mut self, topology: Topology, positions: &[[f32; 3]]) -> Result<(), DriverError> {
        check_whole(topology, positions.len())?;
        self.draw_inline(topology, false, false, positions.len(), bytemuck::cast_slice(positions))
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
        check_whole(topology, indices.len())?;
        mesh::check_indices(indices, vertices.len())?;
        let words: &[u32] = bytemuck::cast_slice(vertices);
        if 4 + words.len() + indices.len() > self.queue.max_packet() {
            let ordered: Vec<Vertex> = indices.iter().map(|&index| vertices[index as usize]).collect();
            return self.draw(topology, &ordered);
        }
        if indices.is_empty() {
            return Ok(());
        }
        let gouraud = needs_gouraud(topology, |at| vertices[indices[at] as usize].colour, indices.len());
        let flags = DrawFlags { topology, indexed: true, coloured: true }.code();
        let counts = [flags, vertices.len() as u32, indices.len() as u32];
        let state = self.prepare_draw("draw", gouraud);
        self.encode_in_scene("draw", state, Opcode::DrawInline, &[&counts, words, indices])
    }

    /// Draws `count` vertices of 3 or 4 words each.
    fn draw_inline(
        &mut self,
        topology: Topology,
        coloured: bool,
        gouraud: bool,
        count: usize,
        words: &[u32],
    ) -> Result<(), DriverError> {
        self.open_scene("draw")?;
        if count == 0 {
            return Ok(());
        }
        let mut result = self.prepare_draw("draw", gouraud);
        let flags = DrawFlags { topology, indexed: false, coloured };
        let each = flags.vertex_words() as usize;
        let most = (self.queue.max_packet() - 4) / each / 6 * 6;
        let mut first = 0;
        while first < count {
            let last = count.min(first + most);
            let counts = [flags.code(), (last - first) as u32, 0];
            let part = &words[first * each..last * each];
            result = self.encode_in_scene("draw", result, Opcode::DrawInline, &[&counts, part]);
            // A strip goes on from its last vertex.
            first = if topology == Topology::LineStrip && last < count { last - 1 } else { last };
        }
        result
    }
}
