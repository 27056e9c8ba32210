//! Registers of the effects: textures anywhere in video memory, fog, lights, blend modes; most of them valid.
//!
//! What lies at their addresses is texels, palettes and lights, whatever it is: frames, vertices, packets, the draw's own
//! target.

use super::packets::Composer;
use crate::oracle::effects::texel::{Format, extent, level_offset, level_words};
use zga_abi::Reg;
use zga_abi::packet::Opcode;

const TEXTURE: u32 = 1 << 4;
const MIP_MAP: u32 = 1 << 5;
const LIGHT: u32 = 1 << 6;
const FOG: u32 = 1 << 7;
const BLEND: u32 = 1 << 8;
const PUNCH_THROUGH: u32 = 1 << 9;

impl Composer<'_, '_> {
    /// Sets registers, and says which effects to call for: bits of EFFECTS.
    pub(super) fn looks(&mut self) -> u32 {
        let mut effects = 0;
        if self.bytes.chance(128) {
            self.texture();
            effects |= TEXTURE | self.bytes.pick(&[0, MIP_MAP, PUNCH_THROUGH, MIP_MAP | PUNCH_THROUGH]);
        } else if self.bytes.chance(16) {
            // Without a texture they come to nothing.
            effects |= MIP_MAP | PUNCH_THROUGH;
        }
        if self.bytes.chance(80) {
            self.fog();
            effects |= FOG;
        }
        if self.bytes.chance(80) {
            self.lights();
            effects |= LIGHT;
        }
        if self.bytes.chance(110) {
            let mode = self.bytes.below(4);
            self.write(Reg::BlendControl, &[mode]);
            effects |= BLEND;
        }
        effects
    }

    fn texture(&mut self) {
        let bytes = &mut *self.bytes;
        let format = Format::ALL[bytes.below(6) as usize];
        let size = match bytes.byte() % 16 {
            0 => [16384, 1],
            1 => [1, 4096 - bytes.below(3)],
            2 | 3 => [128, 128],
            _ => [1 + bytes.below(33), 1 + bytes.below(33)],
        };
        let levels = 1 + bytes.below(1 + size[0].max(size[1]).ilog2());
        let length = level_offset(format, size, levels - 1) + 4 * level_words(format, extent(size, levels - 1));
        let room = self.memory.saturating_sub(length) / 64;
        // A third of them at the end of memory, where an error would show.
        let base = 64 * if bytes.chance(85) { room } else { bytes.below(room + 1) };
        let pair = |[x, y]: [u32; 2]| y << 16 | x;
        let whole = bytes.chance(128);
        let offset = size.map(|side| if whole { 0 } else { bytes.below(side) });
        let window = [0, 1].map(|axis| if whole { 0 } else { bytes.below(size[axis] - offset[axis] + 1) });
        let (filter, function, wraps) = (bytes.below(3), bytes.below(4), bytes.below(16));
        let control = format as u32 | filter << 4 | function << 8 | wraps << 12 | levels << 16;
        let bias = bytes.pick(&[0, 0, 0x100, 0xFF00, 0x7FFF, 0x8000]);
        let palette = 64 * bytes.below(self.memory.saturating_sub(1024) / 64);
        let (colour, reference) = (bytes.raw(), u32::from(bytes.byte()));
        let words = [base, pair(size), control, pair(offset), pair(window), colour, bias, palette, reference];
        self.write(Reg::TextureBase, &words);
    }

    fn fog(&mut self) {
        let bytes = &mut *self.bytes;
        let function = bytes.below(5);
        let [density, end] = [bytes.below(1000) as f32 / 100.0, (1 + bytes.below(10_000)) as f32 / 16.0];
        let [scale, offset] = [bytes.below(512) as f32 / 64.0 - 4.0, bytes.below(256) as f32 / 64.0];
        // Now and then one that is no number, or has no meaning there.
        let odd = bytes.chance(16).then(|| (1 + bytes.below(4) as usize, bytes.odd_float()));
        let mut words = [function, density.to_bits(), end.to_bits(), scale.to_bits(), offset.to_bits(), bytes.raw()];
        if let Some((place, value)) = odd {
            words[place] = value;
        }
        self.write(Reg::FogControl, &words);
    }

    fn lights(&mut self) {
        let control = self.bytes.below(8);
        let count = if self.bytes.chance(4) { 256 } else { self.bytes.pick(&[0, 1, 1, 3, 8]) };
        let base = 64 * self.bytes.below(self.memory.saturating_sub(64 * count) / 64 + 1);
        if self.bytes.chance(160) && count > 0 {
            let records: Vec<u32> = (0..count.min(3)).flat_map(|_| self.record()).collect();
            let words = records.len() as u32;
            self.push(Opcode::Upload, &[&[base, 4 * words, words, 1][..], &records].concat());
        }
        let [ambient, specular, emission] = [(); 3].map(|()| self.bytes.raw());
        let shininess = match self.bytes.byte() {
            0..8 => self.bytes.odd_float(),
            byte => (f32::from(byte) / 2.0).to_bits(),
        };
        self.write(Reg::LightControl, &[control, base, count, ambient, specular, emission, shininess]);
    }

    /// A light; some of its numbers are none.
    fn record(&mut self) -> [u32; 16] {
        let bytes = &mut *self.bytes;
        let mut record = [0; 16];
        record[0] = bytes.below(4);
        for word in &mut record[1..9] {
            *word = if bytes.chance(8) { bytes.odd_float() } else { bytes.coordinate(64) };
        }
        record[9] = bytes.raw();
        record[10] = bytes.raw();
        record
    }
}
