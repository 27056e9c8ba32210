//! The bitmap unit's packets with lists: FILL_LIST, COPY_LIST, SEGMENTS, EXPAND. Valid in and outside a scene.
//!
//! Surfaces are checked as a whole, and entries are cut to them where they are drawn, so an entry can be nowhere near.
//! A list that can change nothing is a legal nothing and calls no unit: one without a clip box or an entry, or with an
//! operation that changes no bit.

use super::claim::Claim;
use super::memory::{LARGEST_SIDE, VideoMemory};
use super::{Processor, bad_length};
use crate::checked::{Canvas, CopyList, ExpandList, FillList, Image, SegmentList, are_bitmaps};
use crate::hardware::Hardware;
use zga_abi::format::{BitmapFormat, RasterOperation};
use zga_abi::packet::{SegmentFlags, list};
use zga_abi::{Fault, Units};

/// Farthest offset of a source, pixels each way: places and their sources stay far from where 32 bits end.
pub(super) const FARTHEST: u32 = 65535;

/// A whole surface whose base, pitch and size stand in words of the packet.
pub(super) struct SurfaceClaim {
    pub base: Claim,
    pub pitch: Claim,
    pub size: Claim,
}

impl SurfaceClaim {
    /// The surface as an image.
    pub fn image(&self, memory: VideoMemory, format: BitmapFormat) -> Result<Image, Fault> {
        let (width, height) = (self.size.value & 0xFFFF, self.size.value >> 16);
        let sides = 1..=LARGEST_SIDE;
        self.base.multiple_of(format.bytes())?;
        self.pitch.multiple_of(format.bytes())?;
        self.size.require(sides.contains(&width) && sides.contains(&height))?;
        let row_bytes = width * format.bytes();
        self.pitch.require(self.pitch.value >= row_bytes)?;
        let before = u64::from(height - 1) * u64::from(self.pitch.value);
        memory.span(self.base, before + u64::from(row_bytes))?;
        Ok(Image { base: self.base.value, pitch: self.pitch.value, width, height, format })
    }
}

/// Words of clip boxes, and of what stands behind them.
pub(super) fn split_clips<'a>(packet: &[u32], words: &'a [u32], clips: u32) -> Result<[&'a [u32]; 2], Fault> {
    let boxes = (clips as usize).saturating_mul(2);
    let (clips, entries) = words.split_at_checked(boxes).ok_or(bad_length(packet))?;
    Ok([clips, entries])
}

/// The canvas that words 1 to 8 describe, and the words of the entries; `words` are those from the clip boxes on.
/// No canvas where nothing could change.
fn canvas<'a>(
    memory: VideoMemory,
    packet: &[u32],
    [base, pitch, format, size, operation, planes, origin, clips]: [u32; 8],
    words: &'a [u32],
) -> Result<(BitmapFormat, Option<Canvas<'a>>, &'a [u32]), Fault> {
    let [clips, entries] = split_clips(packet, words, clips)?;
    let format = Claim::word(3, format).mean(BitmapFormat::from_code(format))?;
    let surface = SurfaceClaim { base: Claim::word(1, base), pitch: Claim::word(2, pitch), size: Claim::word(4, size) };
    let surface = surface.image(memory, format)?;
    let operation = Claim::word(5, operation).mean(RasterOperation::from_code(operation))?;
    let planes = planes & format.bits();
    let origin = [origin as u16, (origin >> 16) as u16].map(|number| i32::from(number as i16));
    let changes = operation != RasterOperation::NoOperation && planes != 0 && !clips.is_empty() && !entries.is_empty();
    let canvas = Canvas { surface, operation, planes, origin, clips };
    Ok((format, changes.then_some(canvas), entries))
}

/// The words, if they are whole entries of `entry` words each; else a BAD_LENGTH.
pub(super) fn whole<'a>(packet: &[u32], entries: &'a [u32], entry: usize) -> Result<&'a [u32], Fault> {
    if entries.len().is_multiple_of(entry) { Ok(entries) } else { Err(bad_length(packet)) }
}

impl Processor {
    /// FILL_LIST: base, pitch, format, size, operation, planes, origin, clips, value, clip boxes, rectangles.
    pub(super) fn fill_list<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let Some((&[_, value], _)) = packet.get(8..).and_then(|rest| rest.split_first_chunk::<2>()) else {
            return Err(bad_length(packet));
        };
        let (fixed, words) = fixed(packet, list::FILL_WORDS)?;
        let (_, canvas, entries) = canvas(VideoMemory::of(hardware), packet, fixed, words)?;
        let entries = whole(packet, entries, 2)?;
        if let Some(canvas) = canvas {
            self.power.need(hardware, Units::BITMAP);
            hardware.fill_list(&FillList { canvas, value, entries });
        }
        Ok(())
    }

    /// COPY_LIST: base, pitch, format, size, operation, planes, origin, clips, source base, source pitch, source size,
    /// offset x, offset y, clip boxes, rectangles.
    pub(super) fn copy_list<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let Some((&[base, pitch, size, x, y], _)) = packet.get(9..).and_then(|rest| rest.split_first_chunk::<5>())
        else {
            return Err(bad_length(packet));
        };
        let (fixed, words) = fixed(packet, list::COPY_WORDS)?;
        let memory = VideoMemory::of(hardware);
        let (format, canvas, entries) = canvas(memory, packet, fixed, words)?;
        let entries = whole(packet, entries, 2)?;
        let source =
            SurfaceClaim { base: Claim::word(9, base), pitch: Claim::word(10, pitch), size: Claim::word(11, size) };
        let source = source.image(memory, format)?;
        for (word, offset) in [(12, x), (13, y)] {
            Claim::word(word, offset).require((offset as i32).unsigned_abs() <= FARTHEST)?;
        }
        if let Some(canvas) = canvas {
            self.power.need(hardware, Units::BITMAP);
            hardware.copy_list(&CopyList { canvas, source, offset: [x as i32, y as i32], entries });
        }
        Ok(())
    }

    /// SEGMENTS: base, pitch, format, size, operation, planes, origin, clips, value, flags, clip boxes, segments.
    pub(super) fn segments<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let Some((&[value, flags], _)) = packet.get(9..).and_then(|rest| rest.split_first_chunk::<2>()) else {
            return Err(bad_length(packet));
        };
        let (fixed, words) = fixed(packet, list::SEGMENTS_WORDS)?;
        let (_, canvas, entries) = canvas(VideoMemory::of(hardware), packet, fixed, words)?;
        let flags = Claim::word(10, flags).mean(SegmentFlags::from_code(flags))?;
        let entries = whole(packet, entries, if flags.strip { 1 } else { 2 })?;
        if let Some(canvas) = canvas {
            self.power.need(hardware, Units::BITMAP);
            hardware.segments(&SegmentList { canvas, value, flags, entries });
        }
        Ok(())
    }

    /// EXPAND: base, pitch, format, size, operation, planes, origin, clips, foreground, background, flags, clip boxes,
    /// bitmaps.
    pub(super) fn expand<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let Some((&[foreground, background, flags], _)) =
            packet.get(9..).and_then(|rest| rest.split_first_chunk::<3>())
        else {
            return Err(bad_length(packet));
        };
        let (fixed, words) = fixed(packet, list::EXPAND_WORDS)?;
        let (_, canvas, entries) = canvas(VideoMemory::of(hardware), packet, fixed, words)?;
        let flags = Claim::word(11, flags).require(flags & !list::EXPAND_OPAQUE == 0)?;
        if !are_bitmaps(entries) {
            return Err(bad_length(packet));
        }
        if let Some(canvas) = canvas {
            let background = (flags == list::EXPAND_OPAQUE).then_some(background);
            self.power.need(hardware, Units::BITMAP);
            hardware.expand(&ExpandList { canvas, foreground, background, entries });
        }
        Ok(())
    }
}

/// Words 1 to 8, which all lists begin with, and the words behind the first `words` payload words.
pub(super) fn fixed(packet: &[u32], words: u32) -> Result<([u32; 8], &[u32]), Fault> {
    let fixed = packet.get(1..).and_then(|payload| payload.first_chunk::<8>());
    match (fixed, packet.get(1 + words as usize..)) {
        (Some(&fixed), Some(rest)) => Ok((fixed, rest)),
        _ => Err(bad_length(packet)),
    }
}
