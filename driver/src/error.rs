//! What can go wrong, with the values in the text.

use std::time::Duration;

use crate::bitmap::ImageError;
use crate::memory::MemoryError;
use crate::submit::CardFault;
use crate::view::ViewError;

/// Why the driver could not do what it was asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DriverError {
    /// Nothing answers on the bus.
    #[error("no card answers: IDENTIFICATION (offset 0x0000) reads {found:#010x}, a floating bus")]
    NoCard {
        /// What the register read as.
        found: u32,
    },
    /// Something else answers on the bus.
    #[error("not a ZGA card: IDENTIFICATION (offset 0x0000) reads {found:#010x}, expected {expected:#010x}")]
    NotThisCard {
        /// What the register read as.
        found: u32,
        /// What a ZGA card reads as.
        expected: u32,
    },
    /// The card's registers and packets are of a major version that this driver does not know.
    #[error("REVISION (offset 0x0004) says interface {major}.{minor}, this driver speaks {expected}.x")]
    UnknownRevision {
        /// Major version found.
        major: u32,
        /// Minor version found.
        minor: u32,
        /// Major version expected.
        expected: u32,
    },
    /// Writes do not arrive.
    #[error("SCRATCH (offset 0x004c) reads {found:#010x} after {expected:#010x} was written")]
    ScratchTest {
        /// What was read back.
        found: u32,
        /// What was written.
        expected: u32,
    },
    /// An option has no meaning.
    #[error("{name} is {found}, expected {expected}")]
    BadOption {
        /// Name of the option.
        name: &'static str,
        /// Its value.
        found: String,
        /// What it can be.
        expected: &'static str,
    },
    /// Video memory cannot give what was asked for, or the handle is not valid.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The bitmap unit cannot do that: a rectangle, a format or an overlap.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The camera, the object transform or the decal slope has no meaning.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A fence was not executed in time. Nothing is lost: the work is still under way.
    #[error(
        "fence {sequence} was not reached in {waited:?}: the last one executed is {reached}, {pending} words wait, \
         RING_GET {ring_get:#x}, RING_PUT {ring_put:#x}, STATUS {status:#x}"
    )]
    Timeout {
        /// Time waited.
        waited: Duration,
        /// Sequence number waited for.
        sequence: u32,
        /// Last sequence number executed.
        reached: u32,
        /// Words that were submitted and not seen to be executed.
        pending: usize,
        /// The register RING_GET.
        ring_get: u32,
        /// The register RING_PUT.
        ring_put: u32,
        /// The register STATUS.
        status: u32,
    },
    /// The card refused a packet. The driver has already recovered; see [`CardFault`] for what is lost.
    #[error(transparent)]
    CardFault(#[from] CardFault),
    /// A packet is longer than the ring can take.
    #[error("{packet} of {words} words is too long: at most {most} words")]
    PacketTooLong {
        /// Name of the packet.
        packet: &'static str,
        /// Its length.
        words: usize,
        /// The longest.
        most: usize,
    },
    /// The call needs a scene.
    #[error("{call} outside a scene: call begin_scene first")]
    OutsideScene {
        /// The method called.
        call: &'static str,
    },
    /// The call is not possible in a scene.
    #[error("{call} inside a scene: call end_scene first")]
    InsideScene {
        /// The method called.
        call: &'static str,
    },
    /// The target was made by another driver, or is gone.
    #[error("target {id} is not known to this driver")]
    UnknownTarget {
        /// Number of the target.
        id: u32,
    },
    /// The texture was made by another driver, or is gone.
    #[error("texture {id} is not known to this driver")]
    UnknownTexture {
        /// Number of the texture.
        id: u32,
    },
    /// A picture has not the size of its texture.
    #[error("{texels} texels for a texture of {width} x {height}")]
    TexelCount {
        /// Texels given.
        texels: usize,
        /// Width of the texture, texels.
        width: u32,
        /// Height of the texture, texels.
        height: u32,
    },
    /// A picture has more colours than the palette of its texture.
    #[error("the picture has more than {most} colours: a {format} texture needs upload_texture_with_palette")]
    TooManyColours {
        /// Format of the texture.
        format: &'static str,
        /// Colours of its palette.
        most: usize,
    },
    /// A light has a number without meaning.
    #[error("light {light}: {field} is {found}, expected {expected}")]
    BadLight {
        /// Number of the light, from 0.
        light: usize,
        /// Which number.
        field: &'static str,
        /// Its value.
        found: String,
        /// What it can be.
        expected: &'static str,
    },
    /// The lists of vertices have different lengths.
    #[error("{found} {list} for {expected} vertices")]
    ListLength {
        /// Which list.
        list: &'static str,
        /// Its length.
        found: usize,
        /// Number of vertices.
        expected: usize,
    },
    /// The target has no Z buffer.
    #[error("target {id} has no Z buffer")]
    NoDepthBuffer {
        /// Number of the target.
        id: u32,
    },
    /// The target has no stencil plane.
    #[error("target {id} has no stencil plane")]
    NoStencilPlane {
        /// Number of the target.
        id: u32,
    },
    /// A stencil test was set beside something that excludes it.
    #[error("a stencil test does not go with {with}")]
    StencilRefused {
        /// What.
        with: &'static str,
    },
    /// The last scene on the target left no depths behind.
    #[error("target {id} has no depths of its last scene: the {path} path kept none, see set_keep_depth")]
    DepthNotKept {
        /// Number of the target.
        id: u32,
        /// The path that it was drawn on.
        path: &'static str,
    },
    /// Za RAM cannot hold the words of a frame.
    #[error(
        "Za blocks of {} x {} pixels are too small: a frame of {width} x {height} pixels needs {needed} bytes of Za \
         RAM, this card has {has}",
        block[0],
        block[1]
    )]
    ZaRamTooSmall {
        /// Width of the target, pixels.
        width: u32,
        /// Height of the target, pixels.
        height: u32,
        /// Width and height of a block, pixels.
        block: [u32; 2],
        /// Bytes that the words of a frame take.
        needed: u64,
        /// Bytes of Za RAM.
        has: u32,
    },
    /// No frame is shown yet.
    #[error("no frame is shown: call present before capture")]
    NothingShown,
    /// The vertices do not make whole primitives.
    #[error("{vertices} vertices do not make whole {topology}: a multiple of {multiple} is needed")]
    VertexCount {
        /// Vertices (or indices) given.
        vertices: usize,
        /// What they should make.
        topology: &'static str,
        /// Vertices of one primitive.
        multiple: usize,
    },
    /// An index names a vertex that is not there.
    #[error("index {place} is {index}, but there are {vertices} vertices")]
    BadIndex {
        /// Which index.
        place: usize,
        /// Its value.
        index: u32,
        /// Vertices there are.
        vertices: usize,
    },
    /// The card has no unit for it.
    #[error("this card has no {what}: {register} reads {found:#x}")]
    Unsupported {
        /// What was asked for.
        what: &'static str,
        /// The register that says so.
        register: &'static str,
        /// Its value.
        found: u32,
    },
    /// A range does not lie inside an allocation.
    #[error("words {offset}..{end} do not lie in an allocation of {words} words")]
    OutOfAllocation {
        /// First word.
        offset: u64,
        /// First word beyond.
        end: u64,
        /// Words of the allocation.
        words: u64,
    },
}
