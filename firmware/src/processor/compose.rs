//! COMPOSE: pictures put together by the bitmap unit. Valid in and outside a scene.
//!
//! As for the lists surfaces are checked as a whole and entries are cut to them where they are drawn, and what can change
//! nothing is a legal nothing that calls no unit.

use super::claim::Claim;
use super::lists::{FARTHEST, SurfaceClaim, fixed, split_clips};
use super::memory::VideoMemory;
use super::{Processor, bad_length};
use crate::checked::{Compose, Mask, Paint, Picture, Sampled, are_entries};
use crate::hardware::Hardware;
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_abi::packet::compose::{self, Transform};
use zga_abi::packet::list;
use zga_abi::{Fault, FaultCode, Units};

/// Words of a paint, and its first word's place in the packet.
#[derive(Clone, Copy)]
struct PaintWords<'a> {
    words: &'a [u32],
    first: u32,
}

/// A paint of any kind.
enum Kind {
    None,
    Paint(Paint),
    Inline(PictureFormat),
}

impl PaintWords<'_> {
    /// Word `place` of the paint; 0 beyond its end, where there is none.
    fn word(self, place: u32) -> Claim {
        let value = self.words.get(place as usize).copied().unwrap_or(0);
        Claim::word(self.first + place, value)
    }

    fn check(self, memory: VideoMemory, onto: &Picture) -> Result<Kind, Fault> {
        let kind = self.word(0);
        let format = self.word(1);
        Ok(match kind.value {
            compose::NONE => Kind::None,
            compose::COLOUR => Kind::Paint(Paint::Colour(self.word(3).value)),
            compose::IMAGE => Kind::Paint(Paint::Picture(self.sampled(memory, onto, None)?)),
            compose::TRANSFORMED => {
                let [xx, xy, x0, yx, yy, y0] = [8, 9, 10, 11, 12, 13].map(|place| self.word(place).value as i32);
                let transform = Transform { xx, xy, x0, yx, yy, y0 };
                Kind::Paint(Paint::Picture(self.sampled(memory, onto, Some(transform))?))
            }
            compose::INLINE => {
                let masks = PictureFormat::from_code(format.value)
                    .filter(|format| matches!(format, PictureFormat::Alpha8 | PictureFormat::Argb8888));
                Kind::Inline(format.mean(masks)?)
            }
            _ => return Err(kind.refuse(FaultCode::BadValue)),
        })
    }

    fn sampled(self, memory: VideoMemory, onto: &Picture, transform: Option<Transform>) -> Result<Sampled, Fault> {
        let format = self.word(1).mean(PictureFormat::from_code(self.word(1).value))?;
        let repeat = self.word(2).mean(Repeat::from_code(self.word(2).value))?;
        let base = self.word(3);
        let surface = SurfaceClaim { base, pitch: self.word(4), size: self.word(5) };
        let image = surface.image(memory, format.layout())?;
        for place in [6, 7] {
            self.word(place).require((self.word(place).value as i32).unsigned_abs() <= FARTHEST)?;
        }
        let (mine, others) = (image.bytes(), onto.image.bytes());
        base.require(mine.end <= others.start || others.end <= mine.start)?;
        let offset = [6, 7].map(|place| self.word(place).value as i32);
        Ok(Sampled { picture: Picture { image, format }, offset, repeat, transform })
    }
}

impl Processor {
    /// COMPOSE: base, pitch, format, size, operator, flags, origin, clips, source paint, mask paint, clip boxes, entries.
    pub(super) fn compose<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let ([base, pitch, format, size, operator, flags, origin, clips], words) = fixed(packet, list::COMPOSE_WORDS)?;
        let memory = VideoMemory::of(hardware);
        let [clips, entries] = split_clips(packet, words, clips)?;
        let format = Claim::word(3, format).mean(PictureFormat::from_code(format))?;
        let surface =
            SurfaceClaim { base: Claim::word(1, base), pitch: Claim::word(2, pitch), size: Claim::word(4, size) };
        let onto = Picture { image: surface.image(memory, format.layout())?, format };
        let operator = Claim::word(5, operator).mean(ComposeOperator::from_code(operator))?;
        let flags = Claim::word(6, flags);
        flags.require(flags.value & !compose::COMPONENTS == 0)?;
        let components = flags.value == compose::COMPONENTS;
        let paint = |first: u32| {
            let words = packet.get(first as usize..(first + compose::PAINT_WORDS) as usize).unwrap_or_default();
            PaintWords { words, first }
        };
        let (from, through) = (paint(9), paint(9 + compose::PAINT_WORDS));
        let kind = from.word(0);
        kind.require((compose::COLOUR..=compose::TRANSFORMED).contains(&kind.value))?;
        let source = match from.check(memory, &onto)? {
            Kind::Paint(paint) => paint,
            Kind::None | Kind::Inline(_) => return Err(kind.refuse(FaultCode::BadValue)),
        };
        let mask = match through.check(memory, &onto)? {
            Kind::Paint(paint) => Mask::Paint(paint),
            Kind::Inline(format) => Mask::Inline(format),
            Kind::None => {
                flags.require(!components)?;
                Mask::None
            }
        };
        let origin = [origin as u16, (origin >> 16) as u16].map(|number| i32::from(number as i16));
        let compose = Compose { onto, operator, components, source, mask, origin, clips, entries };
        if !are_entries(entries, compose.inline_bytes()) {
            return Err(bad_length(packet));
        }
        if operator != ComposeOperator::Destination && !clips.is_empty() && !entries.is_empty() {
            self.power.need(hardware, Units::BITMAP);
            hardware.compose(&compose);
        }
        Ok(())
    }
}
