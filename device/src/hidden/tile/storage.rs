//! Storage: what the unit keeps on the chip, in register bits and buffer bytes.
//!
//! | register | bits | |
//! | --- | --- | --- |
//! | comparator: polygon id | log2(w h) + 1 | place in the parameter buffer, or none |
//! | comparator: depth (1 / z) | depth bits | stored depth |
//! | comparator: t0, t1, t2 | 3 x 49 | numerators: edge functions reach 2^48 and have a sign |
//! | comparator: window | 4 | fog and depth cueing of one of 16 windows; not driven yet |
//! | comparator: stencil | 8 | stencil value; driven in scenes that ask for it |
//! | comparator: shadow | 1 | whether that says shadow when the scene ends |
//! | parameter buffer, a polygon | 3 x 160 + 49 + 32 | vertices (x, y, z, colour, 1 / w), doubled area, draw and kind |
//! | colour buffer, a pixel | 32 + 1 | colour, written or not |
//! | the same where depths are stored | + 32 | depth |
//!
//! The parameter buffer has a place for each pixel, the colour buffer two banks.

use zga_firmware::checked::Target;

/// Bits of the numerator of a division ratio.
const RATIO_BITS: u64 = 49;
/// Bits that name a window.
const WINDOW_BITS: u64 = 4;
/// Bits of a stencil value.
const STENCIL_BITS: u64 = 8;
/// Bits that say whether a pixel is in shadow.
const SHADOW_BITS: u64 = 1;
/// Bits of a vertex: x, y, z, colour, 1 / w.
const VERTEX_BITS: u64 = 5 * 32;
/// Bits of a polygon's draw and kind.
const DRAW_BITS: u64 = 32;
/// Bits of a word.
const WORD_BITS: u64 = 32;
/// Banks of the colour buffer.
const BANKS: u64 = 2;

/// On-chip storage of a tile unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Storage {
    /// Comparators: one a pixel of a tile.
    pub comparators: u64,
    /// Register bits of one comparator.
    pub comparator_bits: u64,
    /// Bytes of the vertex parameter buffer.
    pub parameter_bytes: u64,
    /// Bytes of both banks of the colour buffer.
    pub colour_bytes: u64,
}

impl Storage {
    /// Storage of the unit for the tile size, depth format and Z buffer of a target.
    #[must_use]
    pub fn new(target: &Target) -> Storage {
        Storage::of(target.tile, target.depth_format.bits(), target.depth.is_some())
    }

    /// Storage for tiles of width and height `tile` (pixels, each at least 1), depths of `depth_bits` bits, with or
    /// without a Z buffer.
    #[must_use]
    pub fn of(tile: [u32; 2], depth_bits: u32, z_buffer: bool) -> Storage {
        let pixels = (u64::from(tile[0]) * u64::from(tile[1])).max(1);
        let id = u64::from(pixels.ilog2()) + 1;
        let depth = u64::from(depth_bits);
        let stored = if z_buffer { WORD_BITS } else { 0 };
        Storage {
            comparators: pixels,
            comparator_bits: id + depth + 3 * RATIO_BITS + WINDOW_BITS + STENCIL_BITS + SHADOW_BITS,
            parameter_bytes: (pixels * (3 * VERTEX_BITS + RATIO_BITS + DRAW_BITS)).div_ceil(8),
            colour_bytes: (BANKS * pixels * (WORD_BITS + 1 + stored)).div_ceil(8),
        }
    }

    /// Register bits of all comparators.
    #[must_use]
    pub fn register_bits(&self) -> u64 {
        self.comparators * self.comparator_bits
    }
}
