//! Lists of the bitmap unit: rectangles, copies, lines of single pixels, bitmaps of 1 bit a pixel, rows of bytes.
//!
//! Entries and clip boxes lie in memory as in the card's packets, which is as window systems have them, so lists travel as
//! they are. A list of any length is cut into packets. Nothing is sent for each call: see [`Driver::flush`].

use bytemuck::{Pod, Zeroable};
use zga_abi::bus::Bus;
use zga_abi::packet::{Opcode, SegmentFlags, list};

use crate::bitmap::Surface;
use crate::{Drawable, Driver, DriverError, ImageError, Raster, Rectangle};

/// Most words of entries in one packet: the card lets the host to its memory between packets, and many packets fit the ring.
const MOST_ENTRY_WORDS: usize = 1 << 13;

/// A rectangle of a list; it can be empty, and lie anywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ListRectangle {
    /// First column.
    pub x: i16,
    /// First row.
    pub y: i16,
    /// Pixels.
    pub width: u16,
    /// Pixels.
    pub height: u16,
}

/// A line of single pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Segment {
    /// Column of its first pixel.
    pub x1: i16,
    /// Row of its first pixel.
    pub y1: i16,
    /// Column of its last pixel.
    pub x2: i16,
    /// Row of its last pixel.
    pub y2: i16,
}

/// A place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Point {
    /// Column.
    pub x: i16,
    /// Row.
    pub y: i16,
}

/// A box that entries are cut to, in pixels of the drawable: `x1`, `y1` inclusive, `x2`, `y2` exclusive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ClipBox {
    /// First column.
    pub x1: i16,
    /// First row.
    pub y1: i16,
    /// First column beyond.
    pub x2: i16,
    /// First row beyond.
    pub y2: i16,
}

impl ClipBox {
    /// A box that holds every drawable.
    pub const ALL: ClipBox = ClipBox { x1: 0, y1: 0, x2: i16::MAX, y2: i16::MAX };

    /// No pixel lies in it.
    pub(crate) const fn is_empty(self) -> bool {
        self.x1 >= self.x2 || self.y1 >= self.y2
    }
}

/// What a list is drawn onto, and how.
#[derive(Clone, Copy, Debug)]
pub struct Canvas<'a> {
    /// Image or target.
    pub drawable: Drawable<'a>,
    /// Added to the places of entries; sums do not wrap round.
    pub origin: [i16; 2],
    /// Each entry is drawn through each box in turn. Boxes are cut to the drawable; without one nothing is drawn.
    pub clips: &'a [ClipBox],
    /// What becomes of stored bits.
    pub raster: Raster,
}

impl<'a> Canvas<'a> {
    /// All of a drawable.
    pub fn whole(drawable: impl Into<Drawable<'a>>, raster: Raster) -> Canvas<'a> {
        Canvas { drawable: drawable.into(), origin: [0, 0], clips: &[ClipBox::ALL], raster }
    }
}

/// A bitmap of 1 bit a pixel with its place.
#[derive(Clone, Copy, Debug)]
pub struct BitmapGlyph<'b> {
    /// Column of its first pixel.
    pub x: i16,
    /// Row of its first pixel.
    pub y: i16,
    /// Pixels.
    pub width: u16,
    /// Pixels.
    pub height: u16,
    /// Rows, each padded to 32 bits; bit 0 of a row's first byte is its leftmost pixel. There can be more bytes.
    pub bits: &'b [u8],
}

/// Appends values as words; they have whole ones.
pub(crate) fn append<T: Pod>(words: &mut Vec<u32>, values: &[T]) {
    let bytes: &[u8] = bytemuck::cast_slice(values);
    let first = words.len();
    words.resize(first + bytes.len() / 4, 0);
    bytemuck::cast_slice_mut(&mut words[first..]).copy_from_slice(bytes);
}

/// A surface as it stands in packets with lists.
pub(crate) fn surface_words(surface: &Surface) -> [u32; 4] {
    [surface.base, surface.pitch, surface.format.code(), list::pair(surface.width as u16, surface.height as u16)]
}

impl<B: Bus> Driver<B> {
    /// Words 1 to 8 of a packet with a list; `None` where nothing is to be drawn.
    fn canvas(&self, call: &'static str, canvas: &Canvas<'_>) -> Result<Option<[u32; 8]>, DriverError> {
        let surface = self.surface(call, canvas.drawable)?;
        if canvas.clips.iter().all(|clip| clip.is_empty()) {
            return Ok(None);
        }
        let [base, pitch, format, size] = surface_words(&surface);
        let [x, y] = canvas.origin;
        let Raster { operation, planes } = canvas.raster;
        let origin = list::pair(x as u16, y as u16);
        Ok(Some([base, pitch, format, size, operation.code(), planes, origin, canvas.clips.len() as u32]))
    }

    /// Most words of entries that go behind `before` words and the clip boxes.
    pub(crate) fn entry_room(&self, packet: Opcode, before: usize, clips: &[ClipBox]) -> Result<usize, DriverError> {
        let fixed = 1 + before + 2 * clips.len();
        let most = self.queue.max_packet();
        match most.checked_sub(fixed) {
            Some(room) if room >= 16 => Ok(room.min(MOST_ENTRY_WORDS)),
            _ => Err(DriverError::PacketTooLong { packet: packet.name(), words: fixed + 16, most }),
        }
    }

    /// Encodes a list of entries of whole words: each packet begins with `parts` and the clip boxes.
    pub(crate) fn encode_list<T: Pod>(
        &mut self,
        opcode: Opcode,
        parts: [&[u32]; 2],
        clips: &[ClipBox],
        entries: &[T],
    ) -> Result<(), DriverError> {
        let before = parts.iter().map(|part| part.len()).sum();
        let room = self.entry_room(opcode, before, clips)? * 4 / size_of::<T>();
        let mut result = Ok(());
        for entries in entries.chunks(room) {
            // All of the list is encoded even if sending a part of it met an error.
            let sent = self.encode_with(opcode, |words| {
                parts.iter().for_each(|part| words.extend_from_slice(part));
                append(words, clips);
                append(words, entries);
            });
            result = result.and(sent);
        }
        result
    }

    /// Fills rectangles with a stored pixel value through the canvas's operation, in order.
    ///
    /// # Errors
    /// [`DriverError::InsideScene`] for the target of the open scene; [`DriverError::UnknownTarget`];
    /// [`DriverError::PacketTooLong`] for more clip boxes than a packet takes; or as [`Driver::flush`].
    pub fn fill_list(
        &mut self,
        canvas: &Canvas<'_>,
        value: u32,
        rectangles: &[ListRectangle],
    ) -> Result<(), DriverError> {
        let Some(words) = self.canvas("fill_list", canvas)? else { return Ok(()) };
        self.encode_list(Opcode::FillList, [&words, &[value]], canvas.clips, rectangles)
    }

    /// Copies to rectangles what lies `offset` from them in the source, through the canvas's operation.
    ///
    /// A rectangle in one clip box is read before it is written; from one to the next, what was written is read. Pixels
    /// whose source lies outside stay.
    ///
    /// # Errors
    /// [`ImageError::FormatsDiffer`]; [`DriverError::BadOption`] for an offset beyond 65535 pixels; or as
    /// [`Driver::fill_list`].
    pub fn copy_list<'s>(
        &mut self,
        source: impl Into<Drawable<'s>>,
        offset: [i32; 2],
        canvas: &Canvas<'_>,
        rectangles: &[ListRectangle],
    ) -> Result<(), DriverError> {
        const CALL: &str = "copy_list";
        let (source, to) = (self.surface(CALL, source.into())?, self.surface(CALL, canvas.drawable)?);
        if source.format != to.format {
            let [from, to] = [source.format.name(), to.format.name()];
            return Err(ImageError::FormatsDiffer { call: CALL, from, to }.into());
        }
        if let Some(far) = offset.iter().find(|pixels| pixels.unsigned_abs() > 65535) {
            let expected = "-65535 to 65535 pixels";
            return Err(DriverError::BadOption { name: "copy_list offset", found: far.to_string(), expected });
        }
        let Some(words) = self.canvas(CALL, canvas)? else { return Ok(()) };
        let [base, pitch, _, size] = surface_words(&source);
        let from = [base, pitch, size, offset[0] as u32, offset[1] as u32];
        self.encode_list(Opcode::CopyList, [&words, &from], canvas.clips, rectangles)
    }

    /// Draws lines of single pixels, those of the X Window System's lines of width zero; `last` says whether their last
    /// pixels are drawn. The pixels are defined at [`SegmentFlags`]; clip boxes move none.
    ///
    /// # Errors
    /// As [`Driver::fill_list`].
    pub fn segments(
        &mut self,
        canvas: &Canvas<'_>,
        value: u32,
        segments: &[Segment],
        last: bool,
    ) -> Result<(), DriverError> {
        let Some(words) = self.canvas("segments", canvas)? else { return Ok(()) };
        let flags = SegmentFlags { last, strip: false }.code();
        self.encode_list(Opcode::Segments, [&words, &[value, flags]], canvas.clips, segments)
    }

    /// Draws lines from each point to the next, each without its last pixel; `last` says whether the very last is drawn.
    /// A single point is that pixel, if `last`.
    ///
    /// # Errors
    /// As [`Driver::fill_list`].
    pub fn polyline(
        &mut self,
        canvas: &Canvas<'_>,
        value: u32,
        points: &[Point],
        last: bool,
    ) -> Result<(), DriverError> {
        let Some(words) = self.canvas("polyline", canvas)? else { return Ok(()) };
        let room = self.entry_room(Opcode::Segments, list::SEGMENTS_WORDS as usize, canvas.clips)?;
        let mut result = Ok(());
        let mut rest = points;
        while !rest.is_empty() {
            // The next packet goes on from this one's last point, whose pixel it draws.
            let (now, ends) = (&rest[..rest.len().min(room)], rest.len() <= room);
            let flags = SegmentFlags { last: last && ends, strip: true }.code();
            let sent = self.encode_list(Opcode::Segments, [&words, &[value, flags]], canvas.clips, now);
            result = result.and(sent);
            rest = if ends { &[] } else { &rest[room - 1..] };
        }
        result
    }

    /// Draws bitmaps of 1 bit a pixel: ones as `foreground`, zeros as `background` or, if there is none, not at all; both
    /// stored pixel values, through the canvas's operation.
    ///
    /// # Errors
    /// [`ImageError::Bits`] for a bitmap with too few bytes: nothing of it and of those behind it is drawn; or as
    /// [`Driver::fill_list`].
    pub fn expand<'b>(
        &mut self,
        canvas: &Canvas<'_>,
        foreground: u32,
        background: Option<u32>,
        bitmaps: impl IntoIterator<Item = BitmapGlyph<'b>>,
    ) -> Result<(), DriverError> {
        let Some(words) = self.canvas("expand", canvas)? else { return Ok(()) };
        let flags = if background.is_some() { list::EXPAND_OPAQUE } else { 0 };
        let values = [foreground, background.unwrap_or(0), flags];
        let room = self.entry_room(Opcode::Expand, list::EXPAND_WORDS as usize, canvas.clips)?;
        let mut entries = std::mem::take(&mut self.payload);
        entries.clear();
        let mut result = Ok(());
        let send = |driver: &mut Driver<B>, entries: &mut Vec<u32>| {
            let sent = driver.encode_with(Opcode::Expand, |packet| {
                packet.extend_from_slice(&words);
                packet.extend_from_slice(&values);
                append(packet, canvas.clips);
                packet.extend_from_slice(entries);
            });
            entries.clear();
            sent
        };
        'bitmaps: for bitmap in bitmaps {
            let BitmapGlyph { x, y, width, height, bits } = bitmap;
            let row_bytes = 4 * list::bitmap_row_words(u32::from(width)) as usize;
            let needed = row_bytes * usize::from(height);
            let Some(bits) = bits.get(..needed) else {
                result = result.and(Err(ImageError::Bits { width, height, needed, found: bits.len() }.into()));
                break;
            };
            if needed == 0 {
                continue;
            }
            // A bitmap that is longer than a packet goes in bands of rows.
            let most_rows = ((room - 2) * 4 / row_bytes).max(1);
            let mut top = i32::from(y);
            for band in bits.chunks(most_rows * row_bytes) {
                let rows = band.len() / row_bytes;
                let Ok(place) = i16::try_from(top) else { continue 'bitmaps };
                if entries.len() + 2 + band.len() / 4 > room {
                    result = result.and(send(self, &mut entries));
                }
                entries.extend([list::pair(x as u16, place as u16), list::pair(width, rows as u16)]);
                let row_words = band.as_chunks::<4>().0;
                entries.extend(row_words.iter().map(|&word| u32::from_le_bytes(word)));
                top += rows as i32;
            }
        }
        if !entries.is_empty() {
            result = result.and(send(self, &mut entries));
        }
        self.payload = entries;
        result
    }

    /// Writes rows of bytes to a rectangle, in order with what else is encoded; `stride` bytes lie from a row to the next.
    ///
    /// # Errors
    /// [`ImageError::Outside`]; [`ImageError::Unaligned`] where the rectangle does not begin and end at whole words of 4
    /// bytes; [`ImageError::Rows`] for too few bytes or rows that run into each other; or as [`Driver::fill_list`].
    pub fn upload<'a>(
        &mut self,
        destination: impl Into<Drawable<'a>>,
        rectangle: Rectangle,
        bytes: &[u8],
        stride: usize,
    ) -> Result<(), DriverError> {
        const CALL: &str = "upload";
        let to = self.surface(CALL, destination.into())?;
        to.hold(CALL, "destination", rectangle)?;
        let Some([width, height]) = crate::bitmap::size(rectangle) else { return Ok(()) };
        let pixel = to.format.bytes();
        if !(rectangle.x * pixel).is_multiple_of(4) || !(width * pixel).is_multiple_of(4) {
            return Err(ImageError::Unaligned { x: rectangle.x, width, pixel }.into());
        }
        let row_bytes = (width * pixel) as usize;
        let needed = (height as usize - 1).saturating_mul(stride).saturating_add(row_bytes);
        if bytes.len() < needed || (height > 1 && stride < row_bytes) {
            return Err(ImageError::Rows { row_bytes, stride, rows: height, found: bytes.len() }.into());
        }
        let row_words = row_bytes / 4;
        // A row of 16384 pixels is 2^14 words; short rings take it in parts.
        let room = (self.queue.max_packet() - 5).min(1 << 14);
        let rows = (room / row_words).max(1);
        let mut result = Ok(());
        for (top, band) in (0..height as usize).step_by(rows).map(|top| (top, rows.min(height as usize - top))) {
            for first in (0..row_words).step_by(room) {
                let words = room.min(row_words - first);
                let place = u64::from(to.base)
                    + (u64::from(rectangle.y) + top as u64) * u64::from(to.pitch)
                    + u64::from(rectangle.x * pixel)
                    + 4 * first as u64;
                let sent = self.encode_with(Opcode::Upload, |packet| {
                    packet.extend([place as u32, to.pitch, words as u32, band as u32]);
                    for row in top..top + band {
                        append(packet, &bytes[row * stride + 4 * first..][..4 * words]);
                    }
                });
                result = result.and(sent);
            }
        }
        result
    }
}
