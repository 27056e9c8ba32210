//! Bitmap unit: fills, moves, combines, converts and stretches rectangles in video memory.
//!
//! Duties: fill, copy with any overlap, raster operations with a plane mask, conversion between formats, stretch, upload
//! from packets, download to a dense run; lists of rectangles, segments and bitmaps, each through clip boxes.
//! Inputs: checked rectangles from the firmware. Outputs: words in video memory.
//! Clocks (`cycles.bitmap`): video memory moves one line of 64 bytes a clock, so each row costs
//! 1 clock for each line it writes and, where it reads, 1 for each line it reads; what is there counts as read where it
//! has to be combined with what comes. What the words pass through in between costs nothing: it works while memory
//! does. Only a stretch costs more, 1 clock a pixel ([`stretch`]). An upload's words come from the front end, which has
//! charged them. A copy that overlaps itself costs what any other does.
//!
//! | file | stage |
//! | --- | --- |
//! | [`fill`] | one value to a rectangle |
//! | [`copy`] | rectangle to rectangle |
//! | [`combine`] | value or rectangle through a raster operation and a plane mask |
//! | [`convert`] | rectangle into another format |
//! | [`stretch`] | rectangle to another size |
//! | [`transfer`] | packet to rows, rows to a dense run |
//! | [`fill_list`], [`copy_list`] | rectangles of a list |
//! | [`segments`] | lines of single pixels |
//! | [`expand`] | bitmaps of 1 bit a pixel |
//! | [`compose`] | pictures put together with alpha |
//! | [`canvas`] | what lists are drawn onto: clip boxes, rows |
//! | [`specification`], [`list_specification`] | what is not a plain move, pixel by pixel |

mod canvas;
pub(crate) mod combine;
mod compose;
pub(crate) mod convert;
pub(crate) mod copy;
mod copy_list;
mod expand;
pub(crate) mod fill;
mod fill_list;
mod list_specification;
mod segments;
mod specification;
pub(crate) mod stretch;
pub(crate) mod transfer;

use crate::Kernel;
use crate::memory::lines;
use crate::probe::account::{Account, Clocks};
use fearless_simd::Level;
use stretch::LineBuffers;
use zga_abi::Counter;
use zga_firmware::checked::{ClipBox, Image};

/// The unit, with room that it uses again and again; empty until something needs it.
#[derive(Debug)]
pub(crate) struct Bitmap {
    /// Pixel by pixel, in place of the fast ways.
    specification: bool,
    /// Host instructions; none for the specification.
    level: Option<Level>,
    /// Rows of a source that overlaps its destination: at most what lies in video memory.
    scratch: Vec<u32>,
    /// One row.
    line: Vec<u32>,
    buffers: LineBuffers,
    /// Clip boxes of a list.
    clips: Vec<ClipBox>,
}

impl Bitmap {
    /// A unit that works as the kernel says: by the specification, or fast.
    pub(crate) fn new(kernel: Kernel) -> Bitmap {
        Bitmap {
            specification: kernel == Kernel::Specification,
            level: match kernel {
                Kernel::Specification => None,
                kernel => kernel.level().or_else(|| Kernel::Best.level()),
            },
            scratch: Vec::new(),
            line: Vec::new(),
            buffers: LineBuffers::default(),
            clips: Vec::new(),
        }
    }

    /// Gives its memory back.
    pub(crate) fn power_off(&mut self) {
        (self.scratch, self.line, self.buffers) = (Vec::new(), Vec::new(), LineBuffers::default());
        self.clips = Vec::new();
    }
}

/// Rows of bytes in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    base: u64,
    pitch: u64,
    row_bytes: u64,
    rows: u64,
}

impl Span {
    /// The rows of an image.
    fn of(image: &Image) -> Span {
        Span {
            base: u64::from(image.base),
            pitch: u64::from(image.pitch),
            row_bytes: u64::from(image.width) * u64::from(image.format.bytes()),
            rows: u64::from(image.height),
        }
    }

    /// Index of the first pixel of row `row` in memory as pixels.
    fn at<P>(&self, row: u64) -> usize {
        ((self.base + row * self.pitch) / size_of::<P>() as u64) as usize
    }

    /// Pixels of a row.
    fn pixels<P>(&self) -> usize {
        (self.row_bytes / size_of::<P>() as u64) as usize
    }

    /// First byte beyond the last row.
    fn end(&self) -> u64 {
        self.base + (self.rows - 1) * self.pitch + self.row_bytes
    }

    /// Lie the two apart, gaps between rows counted in?
    fn apart(&self, other: &Span) -> bool {
        self.end() <= other.base || other.end() <= self.base
    }

    /// Lines that the rows lie in, each row by itself.
    fn lines(&self) -> u64 {
        (0..self.rows).map(|row| lines(self.base + row * self.pitch, self.row_bytes)).sum()
    }

    /// The same rows as one, if nothing lies between them.
    fn joined(self) -> Span {
        if self.pitch == self.row_bytes {
            Span { row_bytes: self.row_bytes * self.rows, rows: 1, ..self }
        } else {
            self
        }
    }
}

/// Charges `lines` lines and counts `pixels` pixels or words.
fn charge(account: &mut Account, pixels: u64, lines: u64) {
    account.add(Counter::BitmapPixels, pixels);
    account.charge(Counter::CyclesBitmap, Clocks(lines));
}
