//! Fences and the display: FENCE, PRESENT, WRITE_BACK. Valid in and outside a scene.

use super::claim::Claim;
use super::memory::{Span, VideoMemory};
use super::{Processor, bad_length, registers};
use crate::hardware::Hardware;
use zga_abi::{Fault, FaultCode, Reg, Units};

/// Bytes of an XRGB8888 pixel.
const XRGB_BYTES: u64 = 4;

/// A frame as the SCANOUT registers describe it.
struct Shown {
    /// Pixels.
    width: u32,
    /// Pixels.
    height: u32,
    /// Where it lies.
    span: Span,
}

/// The frame that scan-out shows when it begins at `base`; `None` is a dark screen.
fn shown<H: Hardware>(hardware: &H, base: Claim) -> Result<Option<Shown>, Fault> {
    let size = registers::sample(hardware, Reg::ScanoutSize);
    let (width, height) = registers::pair(size.value);
    if width == 0 || height == 0 {
        return Ok(None);
    }
    registers::size(size)?;
    let format = registers::pixel_format(registers::sample(hardware, Reg::ScanoutFormat))?;
    let pitch = registers::sample(hardware, Reg::ScanoutPitch);
    let memory = VideoMemory::of(hardware);
    let span = memory.frame(base, pitch, width * format.bytes(), height)?;
    Ok(Some(Shown { width, height, span }))
}

impl Processor {
    /// FENCE: sequence.
    pub(super) fn fence<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, sequence] = packet else {
            return Err(bad_length(packet));
        };
        hardware.fence(sequence);
        Ok(())
    }

    /// PRESENT: base. On a dark screen any aligned base will do: it is not shown.
    pub(super) fn present<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, base] = packet else {
            return Err(bad_length(packet));
        };
        let claim = Claim::word(1, base);
        claim.multiple_of(super::memory::CHUNK)?;
        shown(hardware, claim)?;
        self.power.need(hardware, Units::SCANOUT);
        hardware.present(base);
        Ok(())
    }

    /// WRITE_BACK: destination. A dark screen has no pixels to write.
    pub(super) fn write_back<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, destination] = packet else {
            return Err(bad_length(packet));
        };
        let claim = Claim::word(1, destination);
        claim.multiple_of(4)?;
        let base = registers::sample(hardware, Reg::ScanoutBase);
        let Some(frame) = shown(hardware, base)? else {
            return Ok(());
        };
        let bytes = u64::from(frame.width) * u64::from(frame.height) * XRGB_BYTES;
        let span = VideoMemory::of(hardware).span(claim, bytes)?;
        if span.overlaps(frame.span) {
            return Err(claim.refuse(FaultCode::Overlap));
        }
        self.power.need(hardware, Units::SCANOUT);
        hardware.write_back(destination);
        Ok(())
    }
}
