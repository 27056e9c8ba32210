//! The bitmap unit's packets: FILL, COPY, UPLOAD, DOWNLOAD. Valid in and outside a scene.
//!
//! A rectangle or block without pixels or words is a legal nothing: formats, alignments and sizes
//! are checked, where it lies is not, and no unit is called.

use super::claim::Claim;
use super::memory::{LARGEST_SIDE, VideoMemory};
use super::{Processor, bad_length, registers};
use crate::checked::{Copy, Fill, Rows, Surface};
use crate::hardware::Hardware;
use zga_abi::format::PixelFormat;
use zga_abi::{Fault, FaultCode, Units};

/// A rectangle of a surface, not checked yet.
struct RectangleClaim {
    base: Claim,
    pitch: Claim,
    x: Claim,
    y: Claim,
    width: Claim,
    height: Claim,
}

impl RectangleClaim {
    /// The rectangle as a surface of its own, its place folded into the base; `None` if it is empty.
    ///
    /// A row of the surface is `pitch` bytes, so the rectangle's right edge lies inside it.
    fn check(&self, memory: VideoMemory, format: PixelFormat) -> Result<Option<Surface>, Fault> {
        let [x, y, width, height, pitch] =
            [self.x, self.y, self.width, self.height, self.pitch].map(|c| u64::from(c.value));
        let pixel = u64::from(format.bytes());
        self.base.multiple_of(format.bytes())?;
        self.pitch.multiple_of(format.bytes())?;
        self.width.require(self.width.value <= LARGEST_SIDE)?;
        self.height.require(self.height.value <= LARGEST_SIDE)?;
        if width == 0 || height == 0 {
            return Ok(None);
        }
        self.pitch.require((x + width) * pixel <= pitch)?;

        let last_row = (y + height - 1).saturating_mul(pitch);
        memory.span(self.base, last_row.saturating_add((x + width) * pixel))?;
        // The whole rectangle lies in video memory, so the sum is an address.
        let base = u64::from(self.base.value) + y * pitch + x * pixel;
        let base = u32::try_from(base).map_err(|_| self.base.refuse(FaultCode::OutOfMemory))?;
        Ok(Some(Surface { base, pitch: self.pitch.value, width: self.width.value, height: self.height.value, format }))
    }
}

/// Rows of words, not checked yet.
struct RowsClaim {
    address: Claim,
    pitch: Claim,
    words: u32,
    rows: u32,
}

impl RowsClaim {
    /// The rows; `None` if there is not a word in them.
    ///
    /// One row needs no pitch; several must not run into each other.
    fn check(&self, memory: VideoMemory) -> Result<Option<Rows>, Fault> {
        let row_bytes = u64::from(self.words) * 4;
        let pitch = u64::from(self.pitch.value);
        self.address.multiple_of(4)?;
        self.pitch.multiple_of(4)?;
        if self.words == 0 || self.rows == 0 {
            return Ok(None);
        }
        self.pitch.require(self.rows == 1 || pitch >= row_bytes)?;
        let last_row = u64::from(self.rows - 1).saturating_mul(pitch);
        memory.span(self.address, last_row.saturating_add(row_bytes))?;
        Ok(Some(Rows { address: self.address.value, pitch: self.pitch.value, words: self.words, rows: self.rows }))
    }
}

impl Processor {
    /// FILL: base, pitch, format, x, y, width, height, value.
    pub(super) fn fill<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, base, pitch, format, x, y, width, height, value] = packet else {
            return Err(bad_length(packet));
        };
        let memory = VideoMemory::of(hardware);
        let format = registers::pixel_format(Claim::word(3, format))?;
        let rectangle = RectangleClaim {
            base: Claim::word(1, base),
            pitch: Claim::word(2, pitch),
            x: Claim::word(4, x),
            y: Claim::word(5, y),
            width: Claim::word(6, width),
            height: Claim::word(7, height),
        };
        if let Some(surface) = rectangle.check(memory, format)? {
            self.power.need(hardware, Units::BITMAP);
            hardware.fill(&Fill { surface, value });
        }
        Ok(())
    }

    /// COPY: format, source base, source pitch, x, y, destination base, destination pitch, x, y,
    /// width, height.
    pub(super) fn copy<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[
            _,
            format,
            ref source @ ..,
            destination_base,
            destination_pitch,
            destination_x,
            destination_y,
            width,
            height,
        ] = packet
        else {
            return Err(bad_length(packet));
        };
        let &[source_base, source_pitch, source_x, source_y] = source else {
            return Err(bad_length(packet));
        };
        let memory = VideoMemory::of(hardware);
        let format = registers::pixel_format(Claim::word(1, format))?;
        let (width, height) = (Claim::word(10, width), Claim::word(11, height));
        let source = RectangleClaim {
            base: Claim::word(2, source_base),
            pitch: Claim::word(3, source_pitch),
            x: Claim::word(4, source_x),
            y: Claim::word(5, source_y),
            width,
            height,
        };
        let destination = RectangleClaim {
            base: Claim::word(6, destination_base),
            pitch: Claim::word(7, destination_pitch),
            x: Claim::word(8, destination_x),
            y: Claim::word(9, destination_y),
            width,
            height,
        };
        let source = source.check(memory, format)?;
        let destination = destination.check(memory, format)?;
        // Both have the same size, so either both are empty or none is.
        if let (Some(source), Some(destination)) = (source, destination) {
            self.power.need(hardware, Units::BITMAP);
            hardware.copy(&Copy { source, destination });
        }
        Ok(())
    }

    /// UPLOAD: address, pitch, words a row, rows, words ...
    pub(super) fn upload<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, address, pitch, words, rows, ref payload @ ..] = packet else {
            return Err(bad_length(packet));
        };
        if u64::from(words) * u64::from(rows) != payload.len() as u64 {
            return Err(bad_length(packet));
        }
        let claim = RowsClaim { address: Claim::word(1, address), pitch: Claim::word(2, pitch), words, rows };
        if let Some(rows) = claim.check(VideoMemory::of(hardware))? {
            self.power.need(hardware, Units::BITMAP);
            hardware.upload(&rows, payload);
        }
        Ok(())
    }

    /// DOWNLOAD: address, pitch, words a row, rows, destination.
    pub(super) fn download<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, address, pitch, words, rows, destination] = packet else {
            return Err(bad_length(packet));
        };
        let memory = VideoMemory::of(hardware);
        let claim = RowsClaim { address: Claim::word(1, address), pitch: Claim::word(2, pitch), words, rows };
        let source = claim.check(memory)?;
        let dense = (u64::from(words) * u64::from(rows)).saturating_mul(4);
        let destination = Claim::word(5, destination);
        destination.multiple_of(4)?;
        memory.span(destination, dense)?;
        if let Some(rows) = source {
            self.power.need(hardware, Units::BITMAP);
            hardware.download(&rows, destination.value);
        }
        Ok(())
    }
}
