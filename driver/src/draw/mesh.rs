//! Meshes in video memory: uploaded once, drawn with a packet of six words.

use zga_abi::bus::{Bus, MEMORY_BASE};
use zga_abi::format::Topology;
use zga_abi::packet::{DrawFlags, Opcode};

use super::{Vertex, Vertices, check_whole};
use crate::memory::{Alignment, Allocation};
use crate::{Driver, DriverError};

/// Vertices and indices in video memory. Given back with [`Driver::free_mesh`].
#[derive(Debug, PartialEq, Eq)]
#[must_use = "a mesh that is dropped keeps its video memory until the driver is gone"]
pub struct MeshBuffer {
    vertices: Allocation,
    indices: Option<Allocation>,
    flags: DrawFlags,
    vertex_count: u32,
    index_count: u32,
    /// Colours differ within a primitive.
    gouraud: bool,
}

impl MeshBuffer {
    /// Primitives that it draws.
    #[must_use]
    pub const fn primitives(&self) -> u32 {
        let vertices = if self.indices.is_some() { self.index_count } else { self.vertex_count };
        self.flags.topology.primitives(vertices)
    }

    /// Bytes of video memory that it takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        u64::from(self.vertices.bytes()) + self.indices.as_ref().map_or(0, |indices| u64::from(indices.bytes()))
    }
}

/// Checks that every index names a vertex.
pub(super) fn check_indices(indices: &[u32], vertices: usize) -> Result<(), DriverError> {
    match indices.iter().position(|&index| index as usize >= vertices) {
        Some(place) => Err(DriverError::BadIndex { place, index: indices[place], vertices }),
        None => Ok(()),
    }
}

impl<B: Bus> Driver<B> {
    /// Copies a mesh into video memory: coloured vertices, and indices into them if given.
    ///
    /// # Errors
    /// As [`Driver::create_mesh`].
    pub fn upload_mesh(
        &mut self,
        topology: Topology,
        vertices: &[Vertex],
        indices: Option<&[u32]>,
    ) -> Result<MeshBuffer, DriverError> {
        self.create_mesh(topology, &Vertices::coloured(vertices), indices)
    }

    /// Copies a mesh of positions into video memory; it is drawn in the material colour.
    ///
    /// # Errors
    /// As [`Driver::create_mesh`].
    pub fn upload_positions(
        &mut self,
        topology: Topology,
        positions: &[[f32; 3]],
        indices: Option<&[u32]>,
    ) -> Result<MeshBuffer, DriverError> {
        self.create_mesh(topology, &Vertices::new(positions), indices)
    }

    /// Copies a mesh of vertices of any format into video memory, and indices into them if given.
    ///
    /// ```
    /// # use zga_abi::format::Topology;
    /// # use zga_driver::{Driver, DriverError, Vertices, bus::MockBus};
    /// # let mut driver = Driver::open(MockBus::new(1 << 20))?;
    /// // A square with a normal and texture coordinates at each corner.
    /// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let coordinates = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    /// let vertices = Vertices::new(&corners).normals(&[[0.0, 0.0, 1.0]; 4]).coordinates(&coordinates);
    /// let mesh = driver.create_mesh(Topology::Triangles, &vertices, Some(&[0, 1, 2, 0, 2, 3]))?;
    /// assert_eq!(mesh.primitives(), 2);
    /// # Ok::<(), DriverError>(())
    /// ```
    ///
    /// # Errors
    /// [`DriverError::ListLength`] if there is not a colour, normal or texture coordinate for each vertex,
    /// [`DriverError::VertexCount`], [`DriverError::BadIndex`], or [`DriverError::Memory`] if there is no room.
    pub fn create_mesh(
        &mut self,
        topology: Topology,
        vertices: &Vertices<'_>,
        indices: Option<&[u32]>,
    ) -> Result<MeshBuffer, DriverError> {
        vertices.check()?;
        let count = vertices.len();
        let flags = vertices.flags(topology, indices.is_some());
        check_whole(flags.topology, indices.map_or(count, <[u32]>::len))?;
        check_indices(indices.unwrap_or_default(), count)?;
        let gouraud = vertices.gouraud(topology, indices);
        let words = vertices.words();
        let vertices = self.allocate(4 * words.len() as u64, Alignment::Line)?;
        let index_buffer = match indices.map(|indices| self.allocate(4 * indices.len() as u64, Alignment::Line)) {
            None => None,
            Some(Ok(buffer)) => Some(buffer),
            Some(Err(refused)) => {
                self.free(vertices)?;
                return Err(refused);
            }
        };
        // Fresh memory: no work under way reads it, so it is written at once.
        self.bus.write_burst(MEMORY_BASE + vertices.address(), &words);
        if let (Some(buffer), Some(indices)) = (&index_buffer, indices) {
            self.bus.write_burst(MEMORY_BASE + buffer.address(), indices);
        }
        let (vertex_count, index_count) = (count as u32, indices.map_or(0, <[u32]>::len) as u32);
        Ok(MeshBuffer { vertices, indices: index_buffer, flags, vertex_count, index_count, gouraud })
    }

    /// Draws a mesh.
    ///
    /// # Errors
    /// As [`Driver::draw`].
    pub fn draw_mesh(&mut self, mesh: &MeshBuffer) -> Result<(), DriverError> {
        self.open_scene("draw_mesh")?;
        if mesh.primitives() == 0 {
            return Ok(());
        }
        let sent = self.prepare_draw("draw_mesh", mesh.flags, mesh.gouraud)?;
        let indices = mesh.indices.as_ref().map_or(0, Allocation::address);
        let payload = [mesh.flags.code(), mesh.vertices.address(), mesh.vertex_count, indices, mesh.index_count];
        self.encode_in_scene("draw_mesh", sent, Opcode::DrawBuffer, &[&payload])
    }

    /// Gives a mesh's memory back when the card has drawn what was encoded before.
    ///
    /// # Errors
    /// As [`Driver::free`].
    pub fn free_mesh(&mut self, mesh: MeshBuffer) -> Result<(), DriverError> {
        self.free(mesh.vertices)?;
        mesh.indices.map_or(Ok(()), |indices| self.free(indices))
    }
}
