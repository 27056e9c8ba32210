//! The bitmap unit's packets: FILL, COPY, UPLOAD, DOWNLOAD, FILL_ROP, COPY_ROP, CONVERT, STRETCH. Valid in and
//! outside a scene.
//!
//! A rectangle or block without pixels or words is a legal nothing: formats, alignments and sizes
//! are checked, where it lies is not, and no unit is called. So is a raster operation that changes no bit, but where
//! that lies is checked.

use super::claim::Claim;
use super::memory::{LARGEST_SIDE, VideoMemory};
use super::{Processor, bad_length, registers};
use crate::checked::{Combine, CombineSource, Convert, Copy, Fill, Image, Rows, Stretch, Surface};
use crate::hardware::Hardware;
use zga_abi::format::{BitmapFormat, PixelFormat, RasterOperation, StretchFilter};
use zga_abi::{Fault, FaultCode, Units};

/// A rectangle of a surface, not checked yet.
#[derive(Clone, Copy)]
struct RectangleClaim {
    base: Claim,
    pitch: Claim,
    x: Claim,
    y: Claim,
    width: Claim,
    height: Claim,
}

impl RectangleClaim {
    /// The rectangle whose base, pitch, x, y, width and height are the payload words from word `first` on.
    const fn of(first: u32, [base, pitch, x, y, width, height]: [u32; 6]) -> RectangleClaim {
        RectangleClaim {
            base: Claim::word(first, base),
            pitch: Claim::word(first + 1, pitch),
            x: Claim::word(first + 2, x),
            y: Claim::word(first + 3, y),
            width: Claim::word(first + 4, width),
            height: Claim::word(first + 5, height),
        }
    }

    /// The rectangle as a surface of its own; `None` if it is empty.
    fn surface(&self, memory: VideoMemory, format: PixelFormat) -> Result<Option<Surface>, Fault> {
        let (pitch, width, height) = (self.pitch.value, self.width.value, self.height.value);
        Ok(self.check(memory, format.bytes())?.map(|base| Surface { base, pitch, width, height, format }))
    }

    /// The rectangle as an image of its own; `None` if it is empty.
    fn image(&self, memory: VideoMemory, format: BitmapFormat) -> Result<Option<Image>, Fault> {
        let (pitch, width, height) = (self.pitch.value, self.width.value, self.height.value);
        Ok(self.check(memory, format.bytes())?.map(|base| Image { base, pitch, width, height, format }))
    }

    /// First byte of the rectangle, for pixels of `bytes` bytes; `None` if it is empty.
    ///
    /// A row of the surface is `pitch` bytes, so the rectangle's right edge lies inside it.
    fn check(&self, memory: VideoMemory, bytes: u32) -> Result<Option<u32>, Fault> {
        let [x, y, width, height, pitch] =
            [self.x, self.y, self.width, self.height, self.pitch].map(|c| u64::from(c.value));
        let pixel = u64::from(bytes);
        self.base.multiple_of(bytes)?;
        self.pitch.multiple_of(bytes)?;
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
        u32::try_from(base).map(Some).map_err(|_| self.base.refuse(FaultCode::OutOfMemory))
    }
}

/// The rectangle of a fill, whose format stands between pitch and x.
const fn filled([base, pitch, x, y, width, height]: [u32; 6]) -> RectangleClaim {
    let place = RectangleClaim::of(2, [0, 0, x, y, width, height]);
    RectangleClaim { base: Claim::word(1, base), pitch: Claim::word(2, pitch), ..place }
}

/// Source and destination of a copy: base, pitch, x, y of each stand from the words named on; width and height, which
/// both share, behind the destination's.
const fn pair(from: u32, [base, pitch, x, y]: [u32; 4], to: u32, destination: [u32; 6]) -> [RectangleClaim; 2] {
    let destination = RectangleClaim::of(to, destination);
    let source = RectangleClaim::of(from, [base, pitch, x, y, 0, 0]);
    [RectangleClaim { width: destination.width, height: destination.height, ..source }, destination]
}

/// A format of the bitmap unit.
fn bitmap_format(claim: Claim) -> Result<BitmapFormat, Fault> {
    claim.mean(BitmapFormat::from_code(claim.value))
}

/// A raster operation.
fn raster_operation(claim: Claim) -> Result<RasterOperation, Fault> {
    claim.mean(RasterOperation::from_code(claim.value))
}

/// What an operation does to a rectangle on these planes; `None` if that is nothing.
fn combine(source: CombineSource, destination: Image, operation: RasterOperation, planes: u32) -> Option<Combine> {
    let planes = planes & destination.format.bits();
    // A source that decides nothing is not read.
    let source = if operation.reads_source() { source } else { CombineSource::Value(0) };
    let changes = operation != RasterOperation::NoOperation && planes != 0;
    changes.then_some(Combine { source, destination, operation, planes })
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
        let rectangle = filled([base, pitch, x, y, width, height]);
        if let Some(surface) = rectangle.surface(memory, format)? {
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
        let destination = [destination_base, destination_pitch, destination_x, destination_y, width, height];
        let [source, destination] = pair(2, [source_base, source_pitch, source_x, source_y], 6, destination);
        let source = source.surface(memory, format)?;
        let destination = destination.surface(memory, format)?;
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

    /// FILL_ROP: base, pitch, format, x, y, width, height, value, operation, planes.
    pub(super) fn fill_rop<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, base, pitch, format, x, y, width, height, value, operation, planes] = packet else {
            return Err(bad_length(packet));
        };
        let format = bitmap_format(Claim::word(3, format))?;
        let operation = raster_operation(Claim::word(9, operation))?;
        let destination = filled([base, pitch, x, y, width, height]).image(VideoMemory::of(hardware), format)?;
        let combined = destination.and_then(|image| combine(CombineSource::Value(value), image, operation, planes));
        if let Some(combine) = combined {
            self.power.need(hardware, Units::BITMAP);
            hardware.combine(&combine);
        }
        Ok(())
    }

    /// COPY_ROP: format, source base, source pitch, x, y, destination base, destination pitch, x, y, width, height,
    /// operation, planes.
    pub(super) fn copy_rop<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, format, from_base, from_pitch, from_x, from_y, base, pitch, x, y, width, height, operation, planes] =
            packet
        else {
            return Err(bad_length(packet));
        };
        let memory = VideoMemory::of(hardware);
        let format = bitmap_format(Claim::word(1, format))?;
        let operation = raster_operation(Claim::word(12, operation))?;
        let [source, destination] =
            pair(2, [from_base, from_pitch, from_x, from_y], 6, [base, pitch, x, y, width, height]);
        let source = source.image(memory, format)?;
        let destination = destination.image(memory, format)?;
        let combined = source
            .zip(destination)
            .and_then(|(source, image)| combine(CombineSource::Image(source), image, operation, planes));
        if let Some(combine) = combined {
            self.power.need(hardware, Units::BITMAP);
            hardware.combine(&combine);
        }
        Ok(())
    }

    /// CONVERT: source format, source base, source pitch, x, y, destination format, destination base, destination
    /// pitch, x, y, width, height.
    pub(super) fn convert<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, from_format, from_base, from_pitch, from_x, from_y, format, base, pitch, x, y, width, height] = packet
        else {
            return Err(bad_length(packet));
        };
        let memory = VideoMemory::of(hardware);
        let from_format = bitmap_format(Claim::word(1, from_format))?;
        let format = bitmap_format(Claim::word(6, format))?;
        let [source, destination] =
            pair(2, [from_base, from_pitch, from_x, from_y], 7, [base, pitch, x, y, width, height]);
        let source = source.image(memory, from_format)?;
        let destination = destination.image(memory, format)?;
        if let (Some(source), Some(destination)) = (source, destination) {
            self.power.need(hardware, Units::BITMAP);
            hardware.convert(&Convert { source, destination });
        }
        Ok(())
    }

    /// STRETCH: filter, source format, source base, source pitch, x, y, width, height, destination format, destination
    /// base, destination pitch, x, y, width, height, whole width, whole height, part x, part y.
    pub(super) fn stretch<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, filter, from_format, ref rest @ ..] = packet else {
            return Err(bad_length(packet));
        };
        let Some((&from, &[format, ref rest @ ..])) = rest.split_first_chunk::<6>() else {
            return Err(bad_length(packet));
        };
        let Some((&to, &[whole_width, whole_height, part_x, part_y])) = rest.split_first_chunk::<6>() else {
            return Err(bad_length(packet));
        };
        let memory = VideoMemory::of(hardware);
        let filter = Claim::word(1, filter).mean(StretchFilter::from_code(filter))?;
        let from_format = bitmap_format(Claim::word(2, from_format))?;
        let format = bitmap_format(Claim::word(9, format))?;
        let source = RectangleClaim::of(3, from).image(memory, from_format)?;
        let to = RectangleClaim::of(10, to);
        let destination = to.image(memory, format)?;
        let whole = [Claim::word(16, whole_width), Claim::word(17, whole_height)];
        for side in whole {
            side.require(side.value <= LARGEST_SIDE)?;
        }
        let (Some(source), Some(destination)) = (source, destination) else {
            return Ok(());
        };
        let part = [Claim::word(18, part_x), Claim::word(19, part_y)];
        for ((start, length), whole) in part.into_iter().zip([destination.width, destination.height]).zip(whole) {
            let end = u64::from(start.value) + u64::from(length);
            start.require(end <= u64::from(whole.value))?;
        }
        if source.shares_bytes(&destination) {
            return Err(to.base.refuse(FaultCode::Overlap));
        }
        let [whole, part] = [whole, part].map(|pair| pair.map(|claim| claim.value));
        self.power.need(hardware, Units::BITMAP);
        hardware.stretch(&Stretch { source, destination, whole, part, filter });
        Ok(())
    }
}
