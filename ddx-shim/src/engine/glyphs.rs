//! Text of RENDER: the pixels of glyphs are masks that travel in packets.
//!
//! A request with a mask format has its glyphs added up in a mask first, and that composed in the box around all of them. Where
//! that changes nothing the glyphs go one by one; else the mask is made here.

use zga_abi::format::{ComposeOperator, PictureFormat};
use zga_driver::MaskGlyph;

use super::Engine;
use super::compose::{Area, Request};
use super::lists::ENTRY;
use super::pixmaps::{Pixmaps, Place};

/// Most pixels of a mask that is made here. A line of text across a wide screen has as many.
const MOST_GATHERED: u64 = 1 << 17;
/// Most bytes of a row: with the most clip boxes, even the ring of 2 MiB of memory takes a packet of that.
const MOST_ROW: u32 = 4 * 1900;

/// A glyph with its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glyph {
    /// Number of its pixmap, which is in host memory for good.
    pub pixmap: usize,
    /// Column of its first pixel, in the destination's pixmap.
    pub x: i32,
    /// Row of its first pixel.
    pub y: i32,
    /// Pixels.
    pub width: u16,
    /// Pixels.
    pub height: u16,
    /// Alpha8, whose glyphs are unified masks, or Argb8888, whose glyphs are masks by components.
    pub format: PictureFormat,
}

impl Glyph {
    fn area(&self) -> Area {
        Area { x1: self.x, y1: self.y, x2: self.x + i32::from(self.width), y2: self.y + i32::from(self.height) }
    }

    fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Its rows and the bytes from one to the next; `None` where they are not as they have to be.
    fn rows<'p>(&self, pixmaps: &'p Pixmaps) -> Option<(&'p [u8], usize)> {
        let pixmap = pixmaps.get(self.pixmap)?;
        let Place::Host(words) = &pixmap.place else { return None };
        let fits = pixmap.bits_per_pixel == 8 * self.format.bytes()
            && u32::from(self.width) * self.format.bytes() <= MOST_ROW
            && pixmap.width >= self.width.into()
            && pixmap.height >= self.height.into();
        fits.then(|| (bytemuck::cast_slice(words), pixmap.pitch as usize))
    }

    /// As the driver has it.
    fn mask<'p>(&self, pixmaps: &'p Pixmaps) -> Option<MaskGlyph<'p>> {
        let (rows, stride) = self.rows(pixmaps)?;
        let (x, y) = (i16::try_from(self.x).ok()?, i16::try_from(self.y).ok()?);
        Some(MaskGlyph { x, y, width: self.width, height: self.height, rows, stride })
    }
}

/// The box around glyphs; `None` without any.
fn around(glyphs: &[Glyph]) -> Option<Area> {
    glyphs.iter().map(Glyph::area).reduce(|one, other| Area {
        x1: one.x1.min(other.x1),
        y1: one.y1.min(other.y1),
        x2: one.x2.max(other.x2),
        y2: one.y2.max(other.y2),
    })
}

/// Glyphs in lines, each right of the one before or below all before: none overlaps another. Others may, or may not.
fn are_apart(glyphs: &[Glyph]) -> bool {
    let (mut top, mut right, mut bottom) = (i32::MIN, i32::MIN, i32::MIN);
    glyphs.iter().map(Glyph::area).all(|area| {
        let goes_on = area.x1 >= right && area.y1 >= top;
        let begins = area.y1 >= bottom;
        if !goes_on && begins {
            (top, right) = (bottom, i32::MIN);
        }
        (right, bottom) = (right.max(area.x2), bottom.max(area.y2));
        goes_on || begins
    })
}

/// Where the mask is 0 the destination stays.
const fn leaves_the_rest(operator: ComposeOperator) -> bool {
    use ComposeOperator::{Add, Atop, Destination, OutReverse, Over, OverReverse, Xor};
    matches!(operator, Destination | Over | OverReverse | OutReverse | Atop | Xor | Add)
}

/// Adds glyphs up in a mask of `format` over `area`, each channel up to 255; rows of whole words. `None` where a glyph's pixels are
/// not to be had.
fn gather(pixmaps: &Pixmaps, format: PictureFormat, area: Area, glyphs: &[Glyph], mask: &mut Vec<u8>) -> Option<usize> {
    let bytes = format.bytes() as usize;
    let side = |from: i32, to: i32| (to - from).unsigned_abs() as usize;
    let stride = (side(area.x1, area.x2) * bytes).next_multiple_of(4);
    mask.clear();
    mask.resize(stride * side(area.y1, area.y2), 0);
    for glyph in glyphs {
        let (rows, pitch) = glyph.rows(pixmaps)?;
        let (width, size) = (usize::from(glyph.width), glyph.format.bytes() as usize);
        let first = side(area.y1, glyph.y) * stride + side(area.x1, glyph.x) * bytes;
        for row in 0..usize::from(glyph.height) {
            let from = rows.get(row * pitch..)?.get(..width * size)?;
            let onto = mask.get_mut(first + row * stride..)?.get_mut(..width * bytes)?;
            match (size, bytes) {
                // White through a unified mask has it in every channel; through components its alpha is theirs.
                (1, 4) => onto.iter_mut().enumerate().for_each(|(at, to)| *to = to.saturating_add(from[at / 4])),
                (4, 1) => onto.iter_mut().enumerate().for_each(|(at, to)| *to = to.saturating_add(from[4 * at + 3])),
                _ => onto.iter_mut().zip(from).for_each(|(to, from)| *to = to.saturating_add(*from)),
            }
        }
    }
    Some(stride)
}

/// Work of so many letters with so many pixels together.
const fn text_work(letters: u64, pixels: u64) -> u64 {
    ENTRY * letters + pixels
}

impl Engine {
    /// So little text, and nothing to do for the card, that it is the renderer's: to be asked before its glyphs are looked at.
    pub fn is_small_text(&mut self, letters: u64, pixels: u64) -> bool {
        self.is_small(text_work(letters, pixels))
    }

    /// Composes through glyphs. `mask`: the format in which they are added up first; none: each is composed by itself. The
    /// request's own mask is not looked at.
    pub fn compose_glyphs(&mut self, request: &Request<'_>, glyphs: &[Glyph], mask: Option<PictureFormat>) -> bool {
        let Some(around) = around(glyphs) else { return true };
        let Some(area) = around.common(Area::of(request.onto)) else { return true };
        let known = |format: PictureFormat| matches!(format, PictureFormat::Alpha8 | PictureFormat::Argb8888);
        let all_known = glyphs.iter().all(|glyph| known(glyph.format)) && mask.is_none_or(known);
        if !all_known || !request.reaches(area) {
            return false;
        }
        let request = request.simple();
        if let Some(format) = mask {
            let alone = glyphs.len() == 1 || leaves_the_rest(request.operator) && are_apart(glyphs);
            if !alone || glyphs.iter().any(|glyph| glyph.format != format) {
                return self.gathered(&request, around, area, glyphs, format);
            }
        }
        let placed = |glyph: &Glyph| glyph.mask(&self.pixmaps).is_some();
        if !glyphs.iter().all(placed) {
            return false;
        }
        let work = text_work(glyphs.len() as u64, glyphs.iter().map(Glyph::pixels).sum());
        self.composed(&request, area, Some(work), &|driver, pixmaps, composition| {
            // One call takes glyphs of one format.
            glyphs.chunk_by(|one, other| one.format == other.format).try_for_each(|glyphs| {
                let format = glyphs[0].format;
                let masks = glyphs.iter().filter_map(|glyph| glyph.mask(pixmaps));
                driver.compose_glyphs(composition, format, format != PictureFormat::Alpha8, masks)
            })
        })
    }

    /// Composes through the sum of glyphs.
    fn gathered(
        &mut self,
        request: &Request<'_>,
        around: Area,
        area: Area,
        glyphs: &[Glyph],
        format: PictureFormat,
    ) -> bool {
        let half = |number: i32| i16::try_from(number).ok();
        let side = |from: i32, to: i32| u16::try_from(to - from).ok();
        let place = half(around.x1).zip(half(around.y1));
        let size = side(around.x1, around.x2).zip(side(around.y1, around.y2));
        let (Some((x, y)), Some((width, height))) = (place, size) else { return false };
        if around.pixels() > MOST_GATHERED || u32::from(width) * format.bytes() > MOST_ROW {
            return false;
        }
        let mut rows = std::mem::take(&mut self.scratch.mask);
        let drawn = gather(&self.pixmaps, format, around, glyphs, &mut rows).is_some_and(|stride| {
            self.composed(request, area, Some(ENTRY + around.pixels()), &|driver, _, composition| {
                let mask = MaskGlyph { x, y, width, height, rows: &rows, stride };
                driver.compose_glyphs(composition, format, format != PictureFormat::Alpha8, [mask])
            })
        });
        self.scratch.mask = rows;
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::super::pixmaps::Pixmap;
    use super::*;

    fn glyph(pixmap: usize, x: i32, y: i32, format: PictureFormat) -> Glyph {
        Glyph { pixmap, x, y, width: 2, height: 2, format }
    }

    /// A pixmap of 2 x 2 pixels in host memory.
    fn pixmap(bits_per_pixel: u32, words: Vec<u32>) -> Pixmap {
        let (place, pitch) = (Place::Host(words), bits_per_pixel / 4);
        let pitch = pitch.next_multiple_of(4);
        Pixmap { width: 2, height: 2, bits_per_pixel, pitch, place, batch: 0, used: 0, credit: 0, asks_at: 0 }
    }

    #[test]
    fn are_apart_lines_of_glyphs_side_by_side() {
        let at = |x, y| glyph(0, x, y, PictureFormat::Alpha8);
        assert!(are_apart(&[at(0, 0), at(2, 1), at(4, -1)]));
        assert!(are_apart(&[at(0, 0), at(2, 0), at(0, 2), at(2, 2)]), "two lines");
        assert!(!are_apart(&[at(0, 0), at(1, 0)]), "they touch the same column");
        assert!(!are_apart(&[at(0, 0), at(2, 0), at(0, 2), at(2, 1)]), "the second line reaches into the first");
    }

    #[test]
    fn gather_same_format_adds_up_to_255() {
        let mut pixmaps = Pixmaps::default();
        let number = pixmaps.insert(pixmap(8, vec![0x0000_C820, 0x0000_0907]));
        let glyphs = [glyph(number, 5, 5, PictureFormat::Alpha8), glyph(number, 6, 5, PictureFormat::Alpha8)];
        let area = around(&glyphs).expect("a box");
        let mut mask = Vec::new();
        let stride = gather(&pixmaps, PictureFormat::Alpha8, area, &glyphs, &mut mask);
        assert_eq!((stride, area), (Some(4), Area { x1: 5, y1: 5, x2: 8, y2: 7 }));
        assert_eq!(mask, [0x20, 0xE8, 0xC8, 0, 0x07, 0x10, 0x09, 0]);
        let twice = [glyphs[0]; 2];
        let area = around(&twice).expect("a box");
        gather(&pixmaps, PictureFormat::Alpha8, area, &twice, &mut mask);
        assert_eq!(mask, [0x40, 0xFF, 0, 0, 0x0E, 0x12, 0, 0]);
    }

    #[test]
    fn gather_other_format_takes_alpha() {
        let mut pixmaps = Pixmaps::default();
        let alone = pixmaps.insert(pixmap(8, vec![0x0000_0201, 0x0000_0403]));
        let all = pixmaps.insert(pixmap(32, vec![0x1111_0000, 0x2200_2200, 0x3300_0033, 0x4444_4444]));
        let area = Area { x1: 0, y1: 0, x2: 2, y2: 2 };
        let mut mask = Vec::new();
        let glyphs = [glyph(alone, 0, 0, PictureFormat::Alpha8)];
        assert_eq!(gather(&pixmaps, PictureFormat::Argb8888, area, &glyphs, &mut mask), Some(8));
        assert_eq!(mask, [1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4]);
        let glyphs = [glyph(all, 0, 0, PictureFormat::Argb8888)];
        assert_eq!(gather(&pixmaps, PictureFormat::Alpha8, area, &glyphs, &mut mask), Some(4));
        assert_eq!(mask, [0x11, 0x22, 0, 0, 0x33, 0x44, 0, 0]);
    }

    #[test]
    fn gather_pixels_that_are_not_in_host_memory_are_not_to_be_had() {
        let mut pixmaps = Pixmaps::default();
        let number = pixmaps.insert(Pixmap { place: Place::Nothing, ..pixmap(8, Vec::new()) });
        let glyphs = [glyph(number, 0, 0, PictureFormat::Alpha8)];
        let area = around(&glyphs).expect("a box");
        assert_eq!(gather(&pixmaps, PictureFormat::Alpha8, area, &glyphs, &mut Vec::new()), None);
    }
}
