//! Lists of the bitmap unit, compositions among them: surfaces that fit into video memory, entries and clip boxes on them and beyond every edge.

use super::packets::Composer;
use super::surfaces::Area;
use zga_abi::packet::{Opcode, compose, list};

impl Composer<'_, '_> {
    /// A surface with an origin, as words 1 to 8 of a packet with a list have it, and clip boxes.
    fn canvas(&mut self) -> ([u32; 8], Area, Vec<u32>) {
        let (format, pixel) = self.bitmap_format();
        let area = self.area(pixel, None);
        let clips: Vec<u32> = (0..self.bytes.below(4)).flat_map(|_| self.span(&area)).collect();
        let [operation, planes] = self.raster();
        let origin = if self.bytes.chance(128) { self.bytes.word() } else { 0 };
        let count = clips.len() as u32 / 2;
        ([area.base, area.pitch, format, size(&area), operation, planes, origin, count], area, clips)
    }

    /// Two places, the second seldom above or left of the first.
    fn span(&mut self, area: &Area) -> [u32; 2] {
        let [x, y] = self.place(area);
        let far = [x + self.bytes.below(area.width + 9) as i16, y + self.bytes.below(area.height + 9) as i16];
        [word([x, y]), word(far)]
    }

    /// A place on the surface or a little outside.
    fn place(&mut self, area: &Area) -> [i16; 2] {
        [area.x + area.width, area.y + area.height].map(|end| self.bytes.below(end + 17) as i16 - 8)
    }

    /// Rectangles: place, then size.
    fn rectangles(&mut self, area: &Area) -> Vec<u32> {
        let one = |composer: &mut Self| {
            let [x, y] = composer.place(area);
            let size =
                list::pair(composer.bytes.below(area.width + 9) as u16, composer.bytes.below(area.height + 9) as u16);
            [word([x, y]), size]
        };
        (0..1 + self.bytes.below(6)).flat_map(|_| one(self)).collect()
    }

    pub(super) fn fill_list(&mut self) {
        let (canvas, area, clips) = self.canvas();
        let value = self.bytes.raw();
        let rectangles = self.rectangles(&area);
        self.push(Opcode::FillList, &[&canvas[..], &[value], &clips, &rectangles].concat());
    }

    pub(super) fn copy_list(&mut self) {
        let (canvas, area, clips) = self.canvas();
        // From another place of the same surface: mostly over itself.
        let offset = [(); 2].map(|()| self.bytes.below(33).wrapping_sub(16));
        let from = [area.base, area.pitch, size(&area), offset[0], offset[1]];
        let rectangles = self.rectangles(&area);
        self.push(Opcode::CopyList, &[&canvas[..], &from, &clips, &rectangles].concat());
    }

    pub(super) fn segments(&mut self) {
        let (canvas, area, clips) = self.canvas();
        let values = [self.bytes.raw(), self.bytes.below(4)];
        // Now and then far outside.
        let end = |composer: &mut Self| {
            if composer.bytes.chance(32) { composer.bytes.word() } else { word(composer.place(&area)) }
        };
        let ends: Vec<u32> = (0..2 + 2 * self.bytes.below(5)).map(|_| end(self)).collect();
        self.push(Opcode::Segments, &[&canvas[..], &values, &clips, &ends].concat());
    }

    pub(super) fn expand(&mut self) {
        let (canvas, area, clips) = self.canvas();
        let values = [self.bytes.raw(), self.bytes.raw(), self.bytes.below(2)];
        let mut bitmaps = Vec::new();
        for _ in 0..1 + self.bytes.below(4) {
            let [width, height] = [self.bytes.below(70), self.bytes.below(12)];
            bitmaps.extend([word(self.place(&area)), list::pair(width as u16, height as u16)]);
            bitmaps.extend((0..list::bitmap_row_words(width) * height).map(|_| self.bytes.word()));
        }
        self.push(Opcode::Expand, &[&canvas[..], &values, &clips, &bitmaps].concat());
    }

    pub(super) fn compose(&mut self) {
        let (format, pixel) = self.picture_format();
        let size_of_part = [1 + self.bytes.below(80), 1 + self.bytes.below(40)];
        let area = self.area(pixel, Some(size_of_part));
        let clips: Vec<u32> = (0..1 + self.bytes.below(3)).flat_map(|_| self.span(&area)).collect();
        let source = 1 + self.bytes.below(3);
        let source = self.paint(source);
        let mask = self.bytes.pick(&[compose::NONE, 1, 2, 3, compose::INLINE, compose::INLINE]);
        let mut mask = self.paint(mask);
        let inline = if mask[0] == compose::INLINE {
            let (format, bytes) = self.bytes.pick(&[(3, 1), (1, 4)]);
            mask[1] = format;
            bytes
        } else {
            0
        };
        let flags = u32::from(mask[0] != compose::NONE && self.bytes.chance(100));
        let operator = self.bytes.below(13);
        let origin = if self.bytes.chance(32) { self.bytes.word() } else { 0 };
        let head = [area.base, area.pitch, format, size(&area), operator, flags, origin, clips.len() as u32 / 2];
        let mut entries = Vec::new();
        for _ in 0..1 + self.bytes.below(4) {
            let [width, height] = [self.bytes.below(70), self.bytes.below(12)];
            entries.extend([word(self.place(&area)), list::pair(width as u16, height as u16)]);
            entries.extend((0..compose::row_words(width, inline) * height).map(|_| self.bytes.word()));
        }
        self.push(Opcode::Compose, &[&head[..], &source, &mask, &clips, &entries].concat());
    }

    /// A paint of a kind; now and then its picture lies where others do.
    fn paint(&mut self, kind: u32) -> [u32; compose::PAINT_WORDS as usize] {
        let (format, pixel) = self.picture_format();
        let size_of_part = [1 + self.bytes.below(40), 1 + self.bytes.below(20)];
        let area = self.area(pixel, Some(size_of_part));
        let base = if kind == compose::COLOUR { self.bytes.raw() } else { area.base };
        let offset = [(); 2].map(|()| self.bytes.below(65).wrapping_sub(32));
        let repeat = self.bytes.below(4);
        let mut words = [kind, format, repeat, base, area.pitch, size(&area), offset[0], offset[1], 0, 0, 0, 0, 0, 0];
        if kind == compose::TRANSFORMED {
            for word in &mut words[8..] {
                *word = match self.bytes.byte() % 4 {
                    0 => 1 << 16,
                    1 => self.bytes.below(1 << 18).wrapping_sub(1 << 17),
                    _ => self.bytes.word(),
                };
            }
        }
        words
    }

    /// A format of pictures that are composed, and its bytes a pixel.
    fn picture_format(&mut self) -> (u32, u32) {
        let format = self.bytes.below(6);
        (format, [4, 4, 2, 1, 4, 4][format as usize])
    }
}

/// A surface that ends with the area.
const fn size(area: &Area) -> u32 {
    list::pair((area.x + area.width) as u16, (area.y + area.height) as u16)
}

/// A place as a word.
const fn word([x, y]: [i16; 2]) -> u32 {
    list::pair(x as u16, y as u16)
}
