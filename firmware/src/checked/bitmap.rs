//! Rectangles for the bitmap unit.

use super::Surface;
use core::ops::Range;
use zga_abi::format::{BitmapFormat, RasterOperation, StretchFilter};

/// A rectangle of one stored pixel value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fill {
    /// Pixels to fill: `base` is the first of them, a multiple of the pixel's bytes, as is `pitch`.
    pub surface: Surface,
    /// Stored value; the low 16 bits for 16-bit formats.
    pub value: u32,
}

/// A copy between two surfaces of the same format and size; overlap must come out right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Copy {
    /// From: `base` is the first pixel copied.
    pub source: Surface,
    /// To: `base` is the first pixel written.
    pub destination: Surface,
}

/// Pixels in video memory for the bitmap unit, in any of its formats.
///
/// # Invariants
/// `base` and `pitch` are multiples of the pixel's bytes; `pitch` holds a row, so rows lie apart;
/// `base + (height - 1) * pitch + width * format.bytes()` lies in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// First byte of the first pixel.
    pub base: u32,
    /// Bytes from a row to the next.
    pub pitch: u32,
    /// Pixels, 1..=16384.
    pub width: u32,
    /// Pixels, 1..=16384.
    pub height: u32,
    /// Format of a pixel.
    pub format: BitmapFormat,
}

impl Image {
    /// From its first byte to the first beyond its last row.
    #[must_use]
    pub const fn bytes(&self) -> Range<u64> {
        self.row(0).start..self.row(self.height as u64 - 1).end
    }

    /// Bytes of row `row`.
    #[must_use]
    pub const fn row(&self, row: u64) -> Range<u64> {
        let start = self.base as u64 + row * self.pitch as u64;
        start..start + self.width as u64 * self.format.bytes() as u64
    }

    /// A byte is a pixel's of both; gaps between rows do not count.
    #[must_use]
    pub const fn shares_bytes(&self, other: &Image) -> bool {
        let (mut mine, mut others) = (0, 0);
        // Both sets of rows rise: the one that ends first meets nothing more of the other.
        while mine < self.height as u64 && others < other.height as u64 {
            let (a, b) = (self.row(mine), other.row(others));
            if a.end <= b.start {
                mine += 1;
            } else if b.end <= a.start {
                others += 1;
            } else {
                return true;
            }
        }
        false
    }
}

/// What a raster operation takes for the source bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CombineSource {
    /// The same stored pixel everywhere; bits beyond the format do not count.
    Value(u32),
    /// A rectangle of the destination's size and format; overlap must come out right.
    Image(Image),
}

/// A raster operation on a rectangle.
///
/// # Invariants
/// It changes something: the operation is not no-operation, and `planes` has a bit of the format and none beyond.
/// The source is an image only where the operation reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Combine {
    /// From.
    pub source: CombineSource,
    /// To: `base` is the first pixel written.
    pub destination: Image,
    /// What becomes of a bit.
    pub operation: RasterOperation,
    /// Bits of the stored pixel that may change.
    pub planes: u32,
}

impl Combine {
    /// What is there has to be read: the operation depends on it, or some of its bits stay.
    #[must_use]
    pub const fn reads_destination(&self) -> bool {
        self.operation.reads_destination() || self.planes != self.destination.format.bits()
    }
}

/// A copy between two rectangles of the same size; overlap must come out right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convert {
    /// From: `base` is the first pixel read.
    pub source: Image,
    /// To: `base` is the first pixel written.
    pub destination: Image,
}

/// A stretch of a rectangle over a whole of another size, of which a part is written.
///
/// # Invariants
/// The part lies in the whole, and shares no byte with the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// From: all of it is stretched over the whole.
    pub source: Image,
    /// To: the part.
    pub destination: Image,
    /// Width and height of the whole, pixels, 1..=16384.
    pub whole: [u32; 2],
    /// Column and row of the part's first pixel in the whole.
    pub part: [u32; 2],
    /// How it is read between pixels.
    pub filter: StretchFilter,
}

/// Rows of words in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rows {
    /// First byte, a multiple of 4.
    pub address: u32,
    /// Bytes from a row to the next, a multiple of 4.
    pub pitch: u32,
    /// Words of a row.
    pub words: u32,
    /// Rows.
    pub rows: u32,
}

impl Rows {
    /// From the first byte to the first beyond the last row.
    #[must_use]
    pub const fn bytes(&self) -> Range<u64> {
        let before = (self.rows as u64).saturating_sub(1) * self.pitch as u64;
        self.address as u64..self.address as u64 + before + 4 * self.words as u64
    }

    /// The bytes of all rows' words in one run from byte `address` on.
    #[must_use]
    pub const fn run_at(&self, address: u32) -> Range<u64> {
        address as u64..address as u64 + 4 * self.words as u64 * self.rows as u64
    }
}
