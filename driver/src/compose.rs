//! Composition: pictures put together with alpha, as the RENDER extension of the X Window System has it.
//!
//! What a pixel comes to is defined at [`zga_abi::packet::compose`]. Rectangles and glyphs travel as lists do, see
//! [`Canvas`](crate::Canvas): nothing is sent for each call.

use zga_abi::bus::Bus;
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_abi::packet::compose::Transform;
use zga_abi::packet::{Opcode, compose, list};

use crate::bitmap::Surface;
use crate::lists::{append, surface_words};
use crate::{ClipBox, Drawable, Driver, DriverError, ImageError, ListRectangle, Rectangle};

/// Words of a paint.
type PaintWords = [u32; compose::PAINT_WORDS as usize];

/// Pixels of an image or target, and what they mean.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Where they are.
    pub drawable: Drawable<'a>,
    /// The picture is this part of it; all of it without.
    pub part: Option<Rectangle>,
    /// What they mean: a format with the drawable's bytes a pixel.
    pub format: PictureFormat,
}

/// A colour for each pixel.
#[derive(Clone, Copy, Debug)]
pub enum Paint<'a> {
    /// An ARGB word everywhere, alpha in 31:24; colours are multiplied by alpha already.
    Colour(u32),
    /// A picture's.
    Image {
        /// The picture. It shares no memory with what is drawn onto.
        picture: Picture<'a>,
        /// From a pixel of what is drawn onto to the picture's, before it is transformed; up to 65535 pixels.
        offset: [i32; 2],
        /// What lies outside.
        repeat: Repeat,
        /// Transformed, with the nearest pixel; or pixel by pixel.
        transform: Option<Transform>,
    },
}

/// What a source goes through.
#[derive(Clone, Copy, Debug)]
pub enum Mask<'a> {
    /// Nothing.
    None,
    /// The alpha of a paint.
    Unified(Paint<'a>),
    /// Each channel of a paint for that channel of the source.
    Components(Paint<'a>),
}

/// A composition but for the places where.
#[derive(Clone, Copy, Debug)]
pub struct Composition<'a> {
    /// How source and destination are put together.
    pub operator: ComposeOperator,
    /// What is drawn.
    pub source: Paint<'a>,
    /// What it goes through.
    pub mask: Mask<'a>,
    /// What it is drawn onto.
    pub onto: Picture<'a>,
    /// Added to the places of entries.
    pub origin: [i16; 2],
    /// Each entry is drawn through each box in turn, in pixels of `onto`; without one nothing is drawn.
    pub clips: &'a [ClipBox],
}

/// Pixels of a mask with their place.
#[derive(Clone, Copy, Debug)]
pub struct MaskGlyph<'b> {
    /// Column of its first pixel.
    pub x: i16,
    /// Row of its first pixel.
    pub y: i16,
    /// Pixels.
    pub width: u16,
    /// Pixels.
    pub height: u16,
    /// Rows of stored pixels, the last one whole; there can be more bytes.
    pub rows: &'b [u8],
    /// Bytes from a row to the next.
    pub stride: usize,
}

const CALL: &str = "compose";

impl<B: Bus> Driver<B> {
    /// A picture as a surface of its own.
    fn picture(&self, picture: &Picture<'_>, side: &'static str) -> Result<Surface, DriverError> {
        let whole = self.surface(CALL, picture.drawable)?;
        if whole.format.bytes() != picture.format.bytes() {
            let [from, to] = [whole.format.name(), picture.format.name()];
            return Err(ImageError::FormatsDiffer { call: CALL, from, to }.into());
        }
        let Some(part) = picture.part else { return Ok(whole) };
        whole.hold(CALL, side, part)?;
        let Some([width, height]) = crate::bitmap::size(part) else {
            let (Surface { width, height, .. }, rectangle) = (whole, part);
            return Err(ImageError::Outside { call: CALL, side, rectangle, width, height }.into());
        };
        let base = whole.base + part.y * whole.pitch + part.x * whole.format.bytes();
        Ok(Surface { base, width, height, ..whole })
    }

    /// A paint as it stands in the packet.
    fn paint(&self, paint: &Paint<'_>, side: &'static str, onto: &Surface) -> Result<PaintWords, DriverError> {
        let (picture, offset, repeat, transform) = match *paint {
            Paint::Colour(argb) => return Ok([compose::COLOUR, 0, 0, argb, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]),
            Paint::Image { ref picture, offset, repeat, transform } => (picture, offset, repeat, transform),
        };
        let surface = self.picture(picture, side)?;
        if let Some(far) = offset.iter().find(|pixels| pixels.unsigned_abs() > 65535) {
            let expected = "-65535 to 65535 pixels";
            return Err(DriverError::BadOption { name: "compose offset", found: far.to_string(), expected });
        }
        if meet(&surface, onto) {
            return Err(ImageError::Overlap.into());
        }
        let kind = if transform.is_some() { compose::TRANSFORMED } else { compose::IMAGE };
        let [base, pitch, _, size] = surface_words(&surface);
        let Transform { xx, xy, x0, yx, yy, y0 } =
            transform.unwrap_or(Transform { xx: 0, xy: 0, x0: 0, yx: 0, yy: 0, y0: 0 });
        let [x, y] = offset;
        let numbers = [x, y, xx, xy, x0, yx, yy, y0].map(i32::cast_unsigned);
        let mut words = [kind, picture.format.code(), repeat.code(), base, pitch, size, 0, 0, 0, 0, 0, 0, 0, 0];
        words[6..].copy_from_slice(&numbers);
        Ok(words)
    }

    /// The words before the clip boxes; `None` where nothing is to be drawn.
    fn composition(
        &self,
        composition: &Composition<'_>,
        inline: Option<(PictureFormat, bool)>,
    ) -> Result<Option<[u32; list::COMPOSE_WORDS as usize]>, DriverError> {
        let onto = self.picture(&composition.onto, "destination")?;
        let source = self.paint(&composition.source, "source", &onto)?;
        let mut none: PaintWords = [0; compose::PAINT_WORDS as usize];
        let (mask, components) = match (inline, &composition.mask) {
            (Some((format, components)), _) => {
                (none[0], none[1]) = (compose::INLINE, format.code());
                (none, components)
            }
            (None, Mask::None) => (none, false),
            (None, Mask::Unified(mask)) => (self.paint(mask, "mask", &onto)?, false),
            (None, Mask::Components(mask)) => (self.paint(mask, "mask", &onto)?, true),
        };
        if composition.clips.iter().all(|clip| clip.is_empty()) {
            return Ok(None);
        }
        let [base, pitch, _, size] = surface_words(&onto);
        let ([x, y], clips) = (composition.origin, composition.clips.len() as u32);
        let format = composition.onto.format.code();
        let flags = if components { compose::COMPONENTS } else { 0 };
        let head = [
            base,
            pitch,
            format,
            size,
            composition.operator.code(),
            flags,
            list::pair(x.cast_unsigned(), y.cast_unsigned()),
            clips,
        ];
        let mut words = [0; list::COMPOSE_WORDS as usize];
        words[..8].copy_from_slice(&head);
        words[8..22].copy_from_slice(&source);
        words[22..].copy_from_slice(&mask);
        Ok(Some(words))
    }

    /// Composes rectangles, in order.
    ///
    /// # Errors
    /// [`ImageError::FormatsDiffer`] for a picture whose format has not its drawable's bytes a pixel;
    /// [`ImageError::Outside`] for a part that reaches beyond its drawable or is empty; [`ImageError::Overlap`] for a source or
    /// mask that shares memory with the destination; [`DriverError::BadOption`] for an offset beyond 65535 pixels; or as
    /// [`Driver::fill_list`].
    pub fn compose(&mut self, composition: &Composition<'_>, rectangles: &[ListRectangle]) -> Result<(), DriverError> {
        let Some(words) = self.composition(composition, None)? else { return Ok(()) };
        self.encode_list(Opcode::Compose, [&words, &[]], composition.clips, rectangles)
    }

    /// Composes through masks that come with the call, each at its own place, in order. The composition's mask is not looked
    /// at; `format` is alpha8 or argb8888, and with `components` each channel is for itself.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for another format; [`ImageError::Bits`] for a glyph with too few bytes, or one of whose rows
    /// there is no room for in a packet: nothing of it and of those behind it is drawn; or as [`Driver::compose`].
    pub fn compose_glyphs<'b>(
        &mut self,
        composition: &Composition<'_>,
        format: PictureFormat,
        components: bool,
        glyphs: impl IntoIterator<Item = MaskGlyph<'b>>,
    ) -> Result<(), DriverError> {
        if !matches!(format, PictureFormat::Alpha8 | PictureFormat::Argb8888) {
            let (found, expected) = (format.name().to_owned(), "alpha8 or argb8888");
            return Err(DriverError::BadOption { name: "format of glyphs", found, expected });
        }
        let Some(words) = self.composition(composition, Some((format, components)))? else { return Ok(()) };
        let room = self.entry_room(Opcode::Compose, words.len(), composition.clips)?;
        let mut entries = std::mem::take(&mut self.payload);
        entries.clear();
        let mut result = Ok(());
        for glyph in glyphs {
            if let Err(refused) = self.append_glyph(&words, composition.clips, room, &mut entries, format, &glyph) {
                result = result.and(Err(refused));
                break;
            }
        }
        if !entries.is_empty() {
            result = result.and(self.send_glyphs(&words, composition.clips, &mut entries));
        }
        self.payload = entries;
        result
    }

    /// Appends the rows of a glyph; sends what there is where they do not fit.
    fn append_glyph(
        &mut self,
        words: &[u32],
        clips: &[ClipBox],
        room: usize,
        entries: &mut Vec<u32>,
        format: PictureFormat,
        glyph: &MaskGlyph<'_>,
    ) -> Result<(), DriverError> {
        let &MaskGlyph { x, y, width, height, rows, stride } = glyph;
        if width == 0 || height == 0 {
            return Ok(());
        }
        let row_bytes = usize::from(width) * format.bytes() as usize;
        let row_words = compose::row_words(u32::from(width), format.bytes()) as usize;
        let needed = (usize::from(height) - 1).saturating_mul(stride).saturating_add(row_bytes);
        if rows.len() < needed || (height > 1 && stride < row_bytes) || row_words + 2 > room {
            return Err(ImageError::Bits { width, height, needed, found: rows.len() }.into());
        }
        let most_rows = (room - 2) / row_words;
        let mut top = 0;
        while top < usize::from(height) {
            let count = (usize::from(height) - top).min(most_rows);
            let Ok(place) = i16::try_from(i32::from(y) + top as i32) else { break };
            if entries.len() + 2 + count * row_words > room {
                self.send_glyphs(words, clips, entries)?;
            }
            let size = list::pair(width, count as u16);
            entries.extend([list::pair(x.cast_unsigned(), place.cast_unsigned()), size]);
            for row in top..top + count {
                let bytes = &rows[row * stride..][..row_bytes];
                let (whole, rest) = bytes.as_chunks::<4>();
                entries.extend(whole.iter().map(|&word| u32::from_le_bytes(word)));
                if !rest.is_empty() {
                    let mut last = [0; 4];
                    last[..rest.len()].copy_from_slice(rest);
                    entries.push(u32::from_le_bytes(last));
                }
            }
            top += count;
        }
        Ok(())
    }

    /// Encodes a packet with the entries, and empties them.
    fn send_glyphs(&mut self, words: &[u32], clips: &[ClipBox], entries: &mut Vec<u32>) -> Result<(), DriverError> {
        let sent = self.encode_with(Opcode::Compose, |packet| {
            packet.extend_from_slice(words);
            append(packet, clips);
            packet.extend_from_slice(entries);
        });
        entries.clear();
        sent
    }
}

/// The two share a byte, gaps between rows counted in.
const fn meet(a: &Surface, b: &Surface) -> bool {
    let ends = [end(a), end(b)];
    (a.base as u64) < ends[1] && (b.base as u64) < ends[0]
}

/// First byte beyond the last row.
const fn end(surface: &Surface) -> u64 {
    let row = surface.width as u64 * surface.format.bytes() as u64;
    surface.base as u64 + (surface.height as u64 - 1) * surface.pitch as u64 + row
}
