//! Draws of every topology, matrices, and vertices that no mesh would have.

use super::packets::Composer;
use super::surfaces::Picture;
use zga_abi::Reg;
use zga_abi::packet::Opcode;

/// Most vertices of an inline draw.
const MOST_INLINE: u32 = 40;
/// Flags of a draw: vertices carry a colour, a normal, texture coordinates.
const COLOURED: u32 = 1 << 8;
const NORMALS: u32 = 1 << 9;
const COORDINATES: u32 = 1 << 10;

impl Composer<'_, '_> {
    /// Words of a vertex, with what the flags of a draw say.
    fn vertex(&mut self, picture: &Picture, flags: u32) -> Vec<u32> {
        let bytes = &mut *self.bytes;
        let mut words = if bytes.chance(8) {
            vec![bytes.odd_float(), bytes.odd_float(), bytes.odd_float()]
        } else {
            let (wide, high) = match bytes.byte() {
                0..200 => (picture.width, picture.height),
                _ => (40_000, 40_000),
            };
            let z = match bytes.byte() {
                0..8 => bytes.odd_float(),
                8..16 => (bytes.below(5) as f32 - 2.0).to_bits(),
                _ => (bytes.below(0x1_0000) as f32 / 65_536.0).to_bits(),
            };
            vec![bytes.coordinate(wide), bytes.coordinate(high), z]
        };
        if flags & COLOURED != 0 {
            words.push(bytes.raw());
        }
        if flags & NORMALS != 0 {
            words.extend([(); 3].map(|()| match bytes.byte() {
                0..4 => bytes.odd_float(),
                byte => (f32::from(byte as i8) / 64.0).to_bits(),
            }));
        }
        if flags & COORDINATES != 0 {
            words.extend([(); 2].map(|()| match bytes.byte() {
                0..4 => bytes.odd_float(),
                byte => (f32::from(byte as i8) / 16.0).to_bits(),
            }));
        }
        words
    }

    /// The flags word, and whether it says indexed.
    fn flags(&mut self) -> (u32, bool) {
        let topology = self.bytes.pick(&[0, 0, 0, 1, 2, 3]);
        let (indexed, coloured) = (self.bytes.chance(80), self.bytes.chance(180));
        let rest = self.bytes.pick(&[0, 0, NORMALS, COORDINATES, NORMALS | COORDINATES]);
        (topology | (u32::from(indexed) << 4) | (u32::from(coloured) * COLOURED) | rest, indexed)
    }

    pub(super) fn draw_inline(&mut self, picture: &Picture) {
        let (flags, indexed) = self.flags();
        let vertices = self.bytes.below(MOST_INLINE);
        let body: Vec<u32> = (0..vertices).flat_map(|_| self.vertex(picture, flags)).collect();
        let indices = if indexed { self.bytes.below(2 * MOST_INLINE) } else { 0 };
        let mut payload = vec![flags, vertices, indices];
        payload.extend(body);
        payload.extend((0..indices).map(|_| self.bytes.below(vertices.max(1))));
        self.push(Opcode::DrawInline, &payload);
    }

    /// The same few vertices over and over, most of them over the whole picture: clocks for the watchdog.
    fn heavy_vertices(&mut self, picture: &Picture) -> Vec<u32> {
        let (width, height) = (2.0 * picture.width as f32, 2.0 * picture.height as f32);
        let mut words = Vec::new();
        for (x, y) in [(-1.0, -1.0), (width, -1.0), (-1.0, height)] {
            let z = self.bytes.below(256) as f32 / 255.0;
            words.extend([f32::to_bits(x), f32::to_bits(y), z.to_bits(), self.bytes.raw()]);
        }
        words.extend(self.vertex(picture, COLOURED));
        words
    }

    pub(super) fn draw_heavy(&mut self, picture: &Picture) {
        let vertices = self.heavy_vertices(picture);
        let triangles = 8 + self.bytes.below(160);
        let odd = self.bytes.below(triangles);
        let mut payload = vec![0x110, 4, 3 * triangles];
        payload.extend(vertices);
        payload.extend((0..triangles).flat_map(|n| if n == odd { [0, 1, 3] } else { [0, 1, 2] }));
        self.push(Opcode::DrawInline, &payload);
    }

    /// Draws from video memory: vertices uploaded just before, or whatever lies there.
    pub(super) fn draw_buffer(&mut self, picture: &Picture) {
        let (flags, indexed) = self.flags();
        let carried = |flag: u32, words: u32| if flags & flag != 0 { 4 * words } else { 0 };
        let stride = 12 + carried(COLOURED, 1) + carried(NORMALS, 3) + carried(COORDINATES, 2);
        let most = if self.bytes.chance(20) { 4000 } else { 64 };
        let vertices = self.bytes.below(most);
        let address = 4 * self.bytes.below(self.memory.saturating_sub(stride * vertices) / 4);
        if self.bytes.chance(160) {
            let body: Vec<u32> = (0..vertices.min(24)).flat_map(|_| self.vertex(picture, flags)).collect();
            self.upload_words(address, &body);
        }
        let indices = if indexed { self.bytes.below(most) } else { 0 };
        let index_address = if indexed { 4 * self.bytes.below(self.memory.saturating_sub(4 * indices) / 4) } else { 0 };
        if indexed {
            // Indices that name vertices; those behind them are whatever lies there.
            let body: Vec<u32> = (0..indices.min(256)).map(|_| self.bytes.below(vertices.max(1))).collect();
            self.upload_words(index_address, &body);
        }
        self.push(Opcode::DrawBuffer, &[flags, address, vertices, index_address, indices]);
    }

    fn upload_words(&mut self, address: u32, words: &[u32]) {
        let count = words.len() as u32;
        if count > 0 {
            self.push(Opcode::Upload, &[&[address, 4 * count, count, 1][..], words].concat());
        }
    }

    /// Matrices and viewport: the identity, a camera, or numbers without sense.
    pub(super) fn matrices(&mut self, picture: &Picture) {
        const ONE: u32 = 0x3F80_0000;
        let identity: Vec<u32> = (0..16).map(|k| if k % 5 == 0 { ONE } else { 0 }).collect();
        let (width, height) = (picture.width as f32, picture.height as f32);
        match self.bytes.byte() % 4 {
            0 => {
                self.write(Reg::ObjectEye, &[&identity[..], &identity, &identity].concat());
                self.write(Reg::Viewport, &[ONE, ONE, ONE, 0, 0, 0]);
            }
            1 | 2 => {
                // x and y of a vertex are pixels; the camera moves them apart by their z.
                let turn = (self.bytes.below(64) as f32 - 32.0) / 16.0;
                let (x, y) = (-width / 2.0, -height / 2.0);
                let eye = [[1.0, 0.0, turn, 0.0], [0.0, 1.0, 0.0, turn / 2.0], [0.0, 0.0, 4.0, 0.5], [x, y, 1.0, 2.0]];
                let decal = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.99, 0.0], [0.0, 0.0, -0.01, 1.0]];
                let clip = [[2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, -0.5, 0.0]];
                let rows: [[f32; 4]; 12] = std::array::from_fn(|row| [eye, decal, clip][row / 4][row % 4]);
                let words: Vec<u32> = rows.as_flattened().iter().map(|number| number.to_bits()).collect();
                self.write(Reg::ObjectEye, &words);
                let port = [width / 2.0, height / 2.0, 1.0, width / 2.0, height / 2.0, 0.0];
                self.write(Reg::Viewport, &port.map(f32::to_bits));
            }
            _ => {
                let words: Vec<u32> =
                    (0..54).map(|_| if self.bytes.chance(200) { ONE } else { self.bytes.odd_float() }).collect();
                self.write(Reg::ObjectEye, &words);
            }
        }
    }
}
