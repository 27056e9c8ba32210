//! PNG and JPEG files as pictures.
//!
//! Duties: tells the two apart by their first bytes, compares the stated size with the limits before a texel is
//! decoded, and brings every kind of colour to RGBA of 8 bits. Colour profiles and orientation tags are not applied.
//! JPEG is decoded by `zune-jpeg`, whose inverse transform may round otherwise from host to host by a level: what must
//! be the same everywhere is a PNG.

use std::io::Cursor;
use std::path::Path;

use image::codecs::{jpeg::JpegDecoder, png::PngDecoder};
use image::{DynamicImage, ImageDecoder, Limits};

use super::Picture;
use crate::limits::{self, MAX_PICTURE_SIDE, MAX_PICTURE_TEXELS, MAX_TEXELS};

/// Most bytes that the decoder of a PNG takes for itself.
const MAX_DECODER_BYTES: u64 = 16 * MAX_PICTURE_TEXELS;

type Read<T> = Result<T, String>;

/// How many texels more may be read for one mesh or scene.
#[derive(Debug)]
pub(crate) struct Room(u64);

impl Default for Room {
    fn default() -> Self {
        Self(MAX_TEXELS)
    }
}

impl Room {
    /// Room for so many texels.
    #[cfg(test)]
    pub(super) const fn with(texels: u64) -> Self {
        Self(texels)
    }

    /// A size that fits, else the reason.
    fn check(&self, [width, height]: [u32; 2]) -> Read<()> {
        let texels = u64::from(width) * u64::from(height);
        if width == 0 || height == 0 || width.max(height) > MAX_PICTURE_SIDE || texels > MAX_PICTURE_TEXELS {
            let most = format!("at most {MAX_PICTURE_SIDE} on a side and {MAX_PICTURE_TEXELS} in all");
            return Err(format!("has {width} x {height} texels, expected {most}"));
        }
        if texels > self.0 {
            return Err(format!("has {width} x {height} texels, but all pictures together may have {MAX_TEXELS}"));
        }
        Ok(())
    }

    /// Makes room for a picture of this size.
    pub(crate) fn take(&mut self, size: [u32; 2]) -> Read<()> {
        self.check(size)?;
        self.0 -= u64::from(size[0]) * u64::from(size[1]);
        Ok(())
    }
}

impl Picture {
    /// Reads a PNG or JPEG file.
    ///
    /// # Errors
    /// A sentence with the file's name.
    pub fn load(file: &Path) -> Read<Self> {
        Self::load_within(file, &mut Room::default())
    }

    /// The same, as one of several; `room` becomes less by what was read.
    pub(crate) fn load_within(file: &Path, room: &mut Room) -> Read<Self> {
        let bytes = limits::read_file(file).map_err(|fault| fault.to_string())?;
        Self::decode(&bytes, room).map_err(|reason| format!("{}: {reason}", file.display()))
    }

    /// Decodes a file whose bytes are in memory.
    pub(crate) fn decode(bytes: &[u8], room: &mut Room) -> Read<Self> {
        let unreadable = |fault: image::ImageError| format!("cannot be decoded: {fault}");
        let picture = if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            // The size stands in the first chunk. It is looked at before the decoder sees the file, because the decoder
            // reads more than that, and takes memory for it.
            let stated = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]]));
            let (Some(width), Some(height)) = (stated(16), stated(20)) else {
                return Err("cannot be decoded: ends inside the header".to_owned());
            };
            room.check([width, height])?;
            let mut within = Limits::no_limits();
            within.max_alloc = Some(MAX_DECODER_BYTES);
            let decoder = PngDecoder::with_limits(Cursor::new(bytes), within).map_err(unreadable)?;
            pixels(decoder, room)
        } else if bytes.starts_with(&[0xFF, 0xD8, 0xFF]) {
            pixels(JpegDecoder::new(Cursor::new(bytes)).map_err(unreadable)?, room)
        } else {
            Err("is neither a PNG nor a JPEG picture".to_owned())
        }?;
        room.take(picture.size)?;
        Ok(picture)
    }
}

fn pixels(decoder: impl ImageDecoder, room: &Room) -> Read<Picture> {
    let (width, height) = decoder.dimensions();
    room.check([width, height])?;
    let image = DynamicImage::from_decoder(decoder).map_err(|fault| format!("cannot be decoded: {fault}"))?;
    let pixels = image.into_rgba8().into_raw().as_chunks::<4>().0.to_vec();
    Picture::new([width, height], pixels).ok_or_else(|| "cannot be decoded: ends before the last row".to_owned())
}
