//! Lists of the bitmap unit: a canvas with clip boxes, and entries that are cut to it.
//!
//! Places need no check: whatever they are, only what lies in a clip box and in the surface is drawn. So entries stay the
//! words of the packet, and are taken apart where they are drawn.

use super::Image;
use zga_abi::format::RasterOperation;
use zga_abi::packet::{SegmentFlags, list};

/// The two signed 16-bit numbers of a word.
const fn signed(word: u32) -> [i32; 2] {
    [word as u16 as i16 as i32, (word >> 16) as u16 as i16 as i32]
}

/// The two unsigned 16-bit numbers of a word.
const fn unsigned(word: u32) -> [i32; 2] {
    [(word & 0xFFFF) as i32, (word >> 16) as i32]
}

/// A clip box: `x1`, `y1` inclusive, `x2`, `y2` exclusive; pixels of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClipBox {
    /// First column.
    pub x1: i32,
    /// First row.
    pub y1: i32,
    /// First column beyond.
    pub x2: i32,
    /// First row beyond.
    pub y2: i32,
}

impl ClipBox {
    /// What of the box lies in another; it can be empty.
    #[must_use]
    pub const fn cut(self, other: ClipBox) -> ClipBox {
        ClipBox {
            x1: if self.x1 > other.x1 { self.x1 } else { other.x1 },
            y1: if self.y1 > other.y1 { self.y1 } else { other.y1 },
            x2: if self.x2 < other.x2 { self.x2 } else { other.x2 },
            y2: if self.y2 < other.y2 { self.y2 } else { other.y2 },
        }
    }

    /// No pixel lies in it.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.x1 >= self.x2 || self.y1 >= self.y2
    }
}

/// A rectangle of a list, its place with the origin added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ListRectangle {
    /// First column.
    pub x: i32,
    /// First row.
    pub y: i32,
    /// Pixels, 0..=65535.
    pub width: i32,
    /// Pixels, 0..=65535.
    pub height: i32,
}

impl ListRectangle {
    /// The rectangle as a box.
    #[must_use]
    pub const fn as_box(self) -> ClipBox {
        ClipBox { x1: self.x, y1: self.y, x2: self.x + self.width, y2: self.y + self.height }
    }
}

/// A place, with the origin added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// Column, -65536..=65534.
    pub x: i32,
    /// Row, -65536..=65534.
    pub y: i32,
}

/// A line of single pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Its first pixel.
    pub from: Point,
    /// Its last pixel.
    pub to: Point,
    /// The last pixel is drawn.
    pub last: bool,
}

/// What a list is drawn onto, and how.
///
/// # Invariants
/// The operation is not no-operation; `planes` has a bit of the format and none beyond. `clips` holds whole boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canvas<'a> {
    /// All of the surface.
    pub surface: Image,
    /// What becomes of a bit.
    pub operation: RasterOperation,
    /// Bits of the stored pixel that may change.
    pub planes: u32,
    /// Added to the places of entries.
    pub origin: [i32; 2],
    /// Words of the clip boxes, two each.
    pub clips: &'a [u32],
}

impl<'a> Canvas<'a> {
    /// The clip boxes cut to the surface, without those that are empty then.
    pub fn clip_boxes(&self) -> impl Iterator<Item = ClipBox> + use<'a> {
        clip_boxes(&self.surface, self.clips)
    }

    /// What is there has to be read: the operation depends on it, or some of its bits stay.
    #[must_use]
    pub const fn reads_destination(&self) -> bool {
        self.operation.reads_destination() || self.planes != self.surface.format.bits()
    }

    const fn point(&self, word: u32) -> Point {
        let [x, y] = signed(word);
        Point { x: x + self.origin[0], y: y + self.origin[1] }
    }

    const fn rectangle(&self, place: u32, size: u32) -> ListRectangle {
        place_of(place, size, self.origin)
    }

    /// The rectangles of entries of two words.
    fn rectangles(&self, entries: &'a [u32]) -> impl ExactSizeIterator<Item = ListRectangle> + use<'a> {
        let canvas = *self;
        entries.as_chunks::<2>().0.iter().map(move |&[place, size]| canvas.rectangle(place, size))
    }
}

/// The boxes in words of two each, cut to a surface, without those that are empty then.
pub(super) fn clip_boxes<'a>(surface: &Image, clips: &'a [u32]) -> impl Iterator<Item = ClipBox> + use<'a> {
    let whole = ClipBox { x1: 0, y1: 0, x2: surface.width as i32, y2: surface.height as i32 };
    let boxes = clips.as_chunks::<2>().0.iter().map(move |&[first, beyond]| {
        let ([x1, y1], [x2, y2]) = (signed(first), signed(beyond));
        ClipBox { x1, y1, x2, y2 }.cut(whole)
    });
    boxes.filter(|clip| !clip.is_empty())
}

/// The rectangle in two words, with an origin added.
pub(super) const fn place_of(place: u32, size: u32, origin: [i32; 2]) -> ListRectangle {
    let ([x, y], [width, height]) = (signed(place), unsigned(size));
    ListRectangle { x: x + origin[0], y: y + origin[1], width, height }
}

/// Words of the rows of an entry, and the words behind them; `None` where there are not as many.
pub(super) fn take_rows(words: &[u32], size: u32, row_words: impl Fn(u32) -> u32) -> Option<(&[u32], &[u32])> {
    let count = u64::from(row_words(size & 0xFFFF)) * u64::from(size >> 16);
    words.split_at_checked(usize::try_from(count).ok()?)
}

/// Rectangles of one value.
///
/// # Invariants
/// `entries` holds whole entries of two words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FillList<'a> {
    /// Onto what, and how.
    pub canvas: Canvas<'a>,
    /// Stored pixel; bits beyond the format do not count.
    pub value: u32,
    /// Words of the entries.
    pub entries: &'a [u32],
}

impl<'a> FillList<'a> {
    /// The rectangles, in order.
    pub fn rectangles(&self) -> impl ExactSizeIterator<Item = ListRectangle> + use<'a> {
        self.canvas.rectangles(self.entries)
    }
}

/// Rectangles that come from elsewhere, all with the same displacement.
///
/// # Invariants
/// `entries` holds whole entries of two words. The source has the canvas's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CopyList<'a> {
    /// Onto what, and how.
    pub canvas: Canvas<'a>,
    /// All of the surface that is read.
    pub source: Image,
    /// From a pixel's place to that of its source, -65535..=65535.
    pub offset: [i32; 2],
    /// Words of the entries.
    pub entries: &'a [u32],
}

impl<'a> CopyList<'a> {
    /// The rectangles, in order.
    pub fn rectangles(&self) -> impl ExactSizeIterator<Item = ListRectangle> + use<'a> {
        self.canvas.rectangles(self.entries)
    }

    /// Where pixels have a source.
    #[must_use]
    pub const fn reach(&self) -> ClipBox {
        let [x, y] = self.offset;
        ClipBox { x1: -x, y1: -y, x2: self.source.width as i32 - x, y2: self.source.height as i32 - y }
    }
}

/// Lines of single pixels.
///
/// # Invariants
/// `entries` holds whole entries: of two words, or of a strip one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SegmentList<'a> {
    /// Onto what, and how.
    pub canvas: Canvas<'a>,
    /// Stored pixel; bits beyond the format do not count.
    pub value: u32,
    /// What entries are, and whether last pixels are drawn.
    pub flags: SegmentFlags,
    /// Words of the entries.
    pub entries: &'a [u32],
}

impl<'a> SegmentList<'a> {
    /// The segments, in order. A strip of a single point is the segment from that to itself.
    pub fn segments(&self) -> impl ExactSizeIterator<Item = Segment> + use<'a> {
        let list = *self;
        let (entries, SegmentFlags { last, strip }) = (list.entries, list.flags);
        let count = match (strip, entries.len()) {
            (false, words) => words / 2,
            (true, 1) => 1,
            (true, points) => points.saturating_sub(1),
        };
        (0..count).map(move |place| {
            let first = if strip { place } else { 2 * place };
            let second = (first + 1).min(entries.len() - 1);
            let [from, to] = [first, second].map(|word| list.canvas.point(entries[word]));
            Segment { from, to, last: last && (!strip || place + 1 == count) }
        })
    }
}

/// A bitmap of 1 bit a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bitmap<'a> {
    /// Where it goes.
    pub place: ListRectangle,
    /// Rows of whole words; bit 0 is the leftmost pixel.
    pub rows: &'a [u32],
}

impl Bitmap<'_> {
    /// Words of a row.
    #[must_use]
    pub const fn row_words(&self) -> usize {
        list::bitmap_row_words(self.place.width as u32) as usize
    }
}

/// Bitmaps in two values.
///
/// # Invariants
/// `entries` holds whole entries: two words, then the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExpandList<'a> {
    /// Onto what, and how.
    pub canvas: Canvas<'a>,
    /// Stored pixel of ones; bits beyond the format do not count.
    pub foreground: u32,
    /// Stored pixel of zeros; `None`: they stay.
    pub background: Option<u32>,
    /// Words of the entries.
    pub entries: &'a [u32],
}

impl<'a> ExpandList<'a> {
    /// The bitmaps, in order.
    pub fn bitmaps(&self) -> impl Iterator<Item = Bitmap<'a>> + use<'a> {
        let (canvas, mut rest) = (self.canvas, self.entries);
        core::iter::from_fn(move || {
            let (bitmap, behind) = take_bitmap(rest, |place, size| canvas.rectangle(place, size))?;
            rest = behind;
            Some(bitmap)
        })
    }
}

/// The bitmap that words begin with, and the words behind it; `None` where there is no whole one.
pub(crate) fn take_bitmap(
    words: &[u32],
    rectangle: impl Fn(u32, u32) -> ListRectangle,
) -> Option<(Bitmap<'_>, &[u32])> {
    let (&[place, size], rest) = words.split_first_chunk::<2>()?;
    let place = rectangle(place, size);
    let (rows, rest) = take_rows(rest, size, list::bitmap_row_words)?;
    Some((Bitmap { place, rows }, rest))
}

/// Whether words are whole entries of EXPAND.
pub(crate) fn are_bitmaps(mut words: &[u32]) -> bool {
    let nowhere = ListRectangle { x: 0, y: 0, width: 0, height: 0 };
    while !words.is_empty() {
        match take_bitmap(words, |_, _| nowhere) {
            Some((_, rest)) => words = rest,
            None => return false,
        }
    }
    true
}
