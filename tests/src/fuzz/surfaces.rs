//! Targets and rectangles that fit into video memory: most of them ordinary, some as odd as can be.

use super::packets::Composer;
use zga_abi::packet::Opcode;

/// A render target as its registers describe it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// First byte of the frame buffer.
    pub base: u32,
    /// Bytes from a row to the next.
    pub pitch: u32,
    /// COLOUR_FORMAT.
    pub format: u32,
    /// DEPTH_BASE and DEPTH_PITCH, if there is a Z buffer.
    pub depth: Option<[u32; 2]>,
    /// DEPTH_FORMAT.
    pub depth_format: u32,
    /// Farthest depth.
    pub maximum_depth: u32,
}

impl Picture {
    /// TARGET_SIZE to DEPTH_FORMAT.
    #[must_use]
    pub fn registers(&self) -> [u32; 7] {
        let [depth_base, depth_pitch] = self.depth.unwrap_or_default();
        let size = self.width | (self.height << 16);
        [size, self.base, self.pitch, self.format, depth_base, depth_pitch, self.depth_format]
    }
}

/// A rectangle of a surface.
#[derive(Clone, Copy)]
pub(super) struct Area {
    pub(super) base: u32,
    pub(super) pitch: u32,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Composer<'_, '_> {
    /// A render target.
    pub(super) fn picture(&mut self) -> Picture {
        let bytes = &mut *self.bytes;
        let [width, height] = match bytes.byte() % 16 {
            0 => [1, 1],
            1..=3 => [1 + bytes.below(8), 1 + bytes.below(8)],
            4 => [16384 - bytes.below(3), 1 + bytes.below(3)],
            5 => [1 + bytes.below(16), 4096 - bytes.below(3)],
            6 | 7 => [256 + bytes.below(128), 200 + bytes.below(100)],
            _ => [1 + bytes.below(128), 1 + bytes.below(128)],
        };
        let format = bytes.below(3);
        let pixel = if format == 2 { 2 } else { 4 };
        let pitch = (width * pixel).next_multiple_of(64) + 64 * bytes.below(256).saturating_sub(250);
        let size = pitch * height;
        let room = self.memory.saturating_sub(size) / 64;
        // Half of them at an end of memory, where an error would show.
        let base = match bytes.byte() % 4 {
            0 => 0,
            1 => 64 * room,
            _ => 64 * bytes.below(room + 1),
        };
        let depth_pitch = (width * 4).next_multiple_of(64);
        let depth_size = depth_pitch * height;
        let after = base.saturating_add(size);
        let depth = match bytes.byte() {
            0..50 => None,
            _ if after + depth_size <= self.memory => Some([after, depth_pitch]),
            _ if depth_size <= base => Some([base - depth_size, depth_pitch]),
            _ => None,
        };
        let depth_bits = bytes.pick(&[24, 16, 31]);
        let fraction = bytes.pick(&[24, 0, 8, 16]);
        let maximum_depth = (1 << depth_bits) - 1;
        Picture { width, height, base, pitch, format, depth, depth_format: depth_bits | (fraction << 8), maximum_depth }
    }

    /// A rectangle for pixels of `pixel` bytes; of `size` if it is given. Seldom outside.
    pub(super) fn area(&mut self, pixel: u32, size: Option<[u32; 2]>) -> Area {
        let bytes = &mut *self.bytes;
        let columns = 1 + bytes.below(1024);
        let pitch = pixel * columns;
        let [width, height] = size.unwrap_or_else(|| [bytes.below(columns + 1), bytes.below(256)]);
        let x = bytes.below(columns.saturating_sub(width) + 1);
        let y = bytes.below(16);
        let end = pitch.saturating_mul((y + height).saturating_sub(1)).saturating_add(pixel * (x + width));
        let room = self.memory.saturating_sub(end) / pixel;
        // A third of them end with the last pixel of memory.
        let base = pixel * if bytes.chance(85) { room } else { bytes.below(room + 1) };
        Area { base, pitch, x, y, width, height }
    }

    pub(super) fn fill(&mut self) {
        let format = self.bytes.below(3);
        let Area { base, pitch, x, y, width, height } = self.area(if format == 2 { 2 } else { 4 }, None);
        let value = self.bytes.raw();
        self.push(Opcode::Fill, &[base, pitch, format, x, y, width, height, value]);
    }

    pub(super) fn copy(&mut self) {
        let format = self.bytes.below(3);
        let pixel = if format == 2 { 2 } else { 4 };
        let (from, to) = self.areas(pixel);
        let source = [format, from.base, from.pitch, from.x, from.y];
        let destination = [to.base, to.pitch, to.x, to.y];
        self.push(Opcode::Copy, &[&source[..], &destination, &[from.width, from.height]].concat());
    }

    /// Two rectangles of one size.
    fn areas(&mut self, pixel: u32) -> (Area, Area) {
        let from = self.area(pixel, None);
        let to = match self.bytes.byte() % 4 {
            // Overlapping, with the same pitch and with another.
            0 | 1 => {
                let near = self.bytes.below(from.x + 3);
                Area { x: near, y: self.bytes.below(from.y + 3), ..from }
            }
            2 => Area { pitch: from.pitch + pixel * self.bytes.below(3), ..from },
            _ => self.area(pixel, Some([from.width, from.height])),
        };
        (from, to)
    }

    /// A format of the bitmap unit, and bytes of its pixels.
    pub(super) fn bitmap_format(&mut self) -> (u32, u32) {
        let format = self.bytes.below(4);
        (format, [4, 4, 2, 1][format as usize])
    }

    /// A raster operation and the planes it works on.
    pub(super) fn raster(&mut self) -> [u32; 2] {
        let operation = self.bytes.below(16);
        let planes = if self.bytes.chance(128) { self.bytes.raw() } else { u32::MAX };
        [operation, planes]
    }

    pub(super) fn fill_rop(&mut self) {
        let (format, pixel) = self.bitmap_format();
        let Area { base, pitch, x, y, width, height } = self.area(pixel, None);
        let value = self.bytes.raw();
        let raster = self.raster();
        self.push(Opcode::FillRop, &[&[base, pitch, format, x, y, width, height, value][..], &raster].concat());
    }

    pub(super) fn copy_rop(&mut self) {
        let (format, pixel) = self.bitmap_format();
        let (from, to) = self.areas(pixel);
        let source = [format, from.base, from.pitch, from.x, from.y];
        let destination = [to.base, to.pitch, to.x, to.y, from.width, from.height];
        let raster = self.raster();
        self.push(Opcode::CopyRop, &[&source[..], &destination, &raster].concat());
    }

    pub(super) fn convert(&mut self) {
        let [(from_format, from_pixel), (format, pixel)] = [(); 2].map(|()| self.bitmap_format());
        let from = self.area(from_pixel, None);
        // Every other one over its source, in rows that hold the larger pixels.
        let (from, to) = if self.bytes.chance(128) {
            let from = Area { base: from.base & !3, pitch: 4 * (from.pitch / from_pixel), ..from };
            let to = Area { x: self.bytes.below(from.x + 3), y: self.bytes.below(from.y + 3), ..from };
            (from, to)
        } else {
            (from, self.area(pixel, Some([from.width, from.height])))
        };
        let source = [from_format, from.base, from.pitch, from.x, from.y];
        let destination = [format, to.base, to.pitch, to.x, to.y, from.width, from.height];
        self.push(Opcode::Convert, &[&source[..], &destination].concat());
    }

    pub(super) fn stretch(&mut self) {
        let filter = self.bytes.below(2);
        let [(from_format, from_pixel), (format, pixel)] = [(); 2].map(|()| self.bitmap_format());
        let [from, to] = [from_pixel, pixel].map(|pixel| self.area(pixel, None));
        let around = |bytes: &mut super::bytes::Bytes<'_>| if bytes.chance(128) { bytes.below(15000) } else { 0 };
        let [before_x, before_y, behind_x, behind_y] = [(); 4].map(|()| around(self.bytes));
        let whole = [before_x + to.width + behind_x, before_y + to.height + behind_y].map(|side| side.min(16384));
        let side = |format, area: Area| [format, area.base, area.pitch, area.x, area.y, area.width, area.height];
        let part = [before_x, before_y];
        self.push(
            Opcode::Stretch,
            &[&[filter][..], &side(from_format, from), &side(format, to), &whole, &part].concat(),
        );
    }

    pub(super) fn upload(&mut self) {
        let (words, rows) = (self.bytes.below(12), self.bytes.below(6));
        let pitch = 4 * (words + self.bytes.below(20));
        let address = 4 * self.bytes.below(self.memory.saturating_sub(pitch * rows) / 4);
        let mut payload = vec![address, pitch, words, rows];
        payload.extend((0..words * rows).map(|_| self.bytes.word()));
        self.push(Opcode::Upload, &payload);
    }

    pub(super) fn download(&mut self) {
        let (words, rows) = (self.bytes.below(300), self.bytes.below(100));
        let pitch = 4 * (words + self.bytes.below(20));
        let address = 4 * self.bytes.below(self.memory.saturating_sub(pitch * rows) / 4);
        let destination = match self.bytes.byte() % 2 {
            0 => 4 * self.bytes.below(self.memory.saturating_sub(4 * words * rows) / 4),
            // Overlapping its source.
            _ => address.saturating_add(4 * self.bytes.below(64)).saturating_sub(128),
        };
        self.push(Opcode::Download, &[address, pitch, words, rows, destination]);
    }
}
