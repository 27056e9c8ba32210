//! Packets that are valid but for what the bytes make wrong: they reach what lies behind the checks.

use super::bytes::Bytes;
use super::surfaces::Picture;
use zga_abi::packet::{Opcode, header};
use zga_abi::{Reg, packet};

/// One opcode and its payload.
#[must_use]
pub fn packet(opcode: Opcode, payload: &[u32]) -> Vec<u32> {
    let mut words = vec![header(opcode, payload.len() as u32)];
    words.extend(payload);
    words
}

/// Packets in their order.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The packets, whole.
    pub packets: Vec<Vec<u32>>,
    /// One of them was changed.
    pub mutated: bool,
}

/// Makes packets from bytes.
#[derive(Debug)]
pub struct Composer<'a, 'b> {
    pub(super) bytes: &'b mut Bytes<'a>,
    /// Bytes of video memory.
    pub(super) memory: u32,
    /// The scene's pixels have samples.
    grid: bool,
    /// The scene has a stencil plane.
    plane: bool,
    packets: Vec<Vec<u32>>,
}

impl<'a, 'b> Composer<'a, 'b> {
    /// Packets for a card with `memory` bytes of video memory.
    pub fn new(bytes: &'b mut Bytes<'a>, memory: u32) -> Composer<'a, 'b> {
        Composer { bytes, memory, grid: false, plane: false, packets: Vec::new() }
    }

    /// A scene: target, begin, work, end. In every third or so a word is not what it was.
    pub fn scene(&mut self) -> Plan {
        let picture = self.picture();
        self.push(Opcode::RegisterWrite, &[&[Reg::TargetSize.offset()][..], &picture.registers()].concat());
        let subpixel = self.bytes.pick(&[8, 8, 8, 4]);
        self.write(Reg::SubpixelBits, &[subpixel]);
        self.samples();
        self.stencil_plane(&picture);
        self.push(Opcode::BeginScene, &[]);
        self.state(&picture);
        for _ in 0..1 + self.bytes.below(8) {
            self.step(&picture);
        }
        if self.plane {
            // SHADOW_CONTROL and SHADOW_INTENSITY: any value has a meaning.
            let shadow = [self.bytes.raw(), self.bytes.raw()];
            self.write(Reg::ShadowControl, &shadow);
        }
        self.push(Opcode::EndScene, &[]);
        if self.bytes.chance(60) {
            self.shown(&picture);
        }
        let mutated = self.bytes.chance(90);
        if mutated {
            self.mutate();
        }
        Plan { packets: std::mem::take(&mut self.packets), mutated }
    }

    /// One packet without a plan around it; half of them are changed.
    pub fn loose(&mut self) -> Vec<u32> {
        let picture = self.picture();
        self.step(&picture);
        if self.bytes.chance(128) {
            self.mutate();
        }
        std::mem::take(&mut self.packets).concat()
    }

    pub(super) fn push(&mut self, opcode: Opcode, payload: &[u32]) {
        self.packets.push(packet(opcode, payload));
    }

    /// REGISTER_WRITE from a register's first word on.
    pub(super) fn write(&mut self, register: Reg, values: &[u32]) {
        self.push(Opcode::RegisterWrite, &[&[register.offset()][..], values].concat());
    }

    /// One thing that can be done in a scene.
    fn step(&mut self, picture: &Picture) {
        match self.bytes.byte() % 41 {
            0..=7 => self.draw_inline(picture),
            8 => self.draw_heavy(picture),
            9..=12 => self.draw_buffer(picture),
            13..=15 => self.clear(picture),
            16..=17 => self.state(picture),
            18..=19 => self.probe(picture),
            20 => self.matrices(picture),
            21..=22 => self.fill(),
            23..=24 => self.copy(),
            25 => self.upload(),
            26 => self.download(),
            27 => {
                let sequence = self.bytes.raw();
                self.push(Opcode::Fence, &[sequence]);
            }
            28 => {
                let words: Vec<u32> = (0..self.bytes.below(6)).map(|_| self.bytes.byte().into()).collect();
                self.push(Opcode::NoOperation, &words);
            }
            29 => self.shown(picture),
            30 => {
                let watchdog = self.bytes.pick(&[1, 1, 2, 4, 0]);
                self.write(Reg::Watchdog, &[watchdog]);
            }
            32 => self.fill_rop(),
            33 => self.copy_rop(),
            34 => self.convert(),
            35 => self.stretch(),
            36 => self.fill_list(),
            37 => self.copy_list(),
            38 => self.segments(),
            39 => self.expand(),
            40 => self.compose(),
            _ => self.register(),
        }
    }

    /// One word of any register that packets can write, any value.
    fn register(&mut self) {
        let offset = 0x0200 + 4 * self.bytes.below(0x140);
        let value = self.bytes.word();
        self.push(Opcode::RegisterWrite, &[offset, value]);
    }

    /// Changes one word of one packet, or how many there are.
    fn mutate(&mut self) {
        let place = self.bytes.below(self.packets.len() as u32) as usize;
        let Some(words) = self.packets.get_mut(place) else { return };
        let at = self.bytes.below(words.len() as u32) as usize;
        match self.bytes.byte() % 8 {
            0 => words.push(self.bytes.word()),
            1 => words.truncate(at.max(1)),
            2 => words[0] = words[0].wrapping_add(self.bytes.below(5)).wrapping_sub(2),
            3 => words[at] ^= 1 << self.bytes.below(32),
            4 => words[at] = words[at].wrapping_add(self.bytes.below(9)).wrapping_sub(4),
            5 => self.packets.swap(0, place),
            _ => words[at] = self.bytes.word(),
        }
    }

    /// A grid for every third scene, with any mode and a pool that is often too small; none for the others.
    fn samples(&mut self) {
        self.grid = self.bytes.chance(85);
        let values = if self.grid {
            let (grid, depth, resolve) = (1 + self.bytes.below(3), self.bytes.below(3), self.bytes.below(2));
            let pool = self.bytes.pick(&[1 << 20, 1 << 12, 64, 1]);
            let [width, size] = [0; 2].map(|_: u32| 1 + 16 * self.bytes.below(128));
            self.write(Reg::LineWidth, &[width, size]);
            vec![grid, depth, resolve, pool]
        } else {
            vec![0]
        };
        self.write(Reg::SubpixelGrid, &values);
    }

    /// A stencil plane for every other scene without a grid, and a few with one, where there is room beside the target's
    /// other surfaces; none for the others.
    fn stencil_plane(&mut self, picture: &Picture) {
        let wanted = self.bytes.chance(if self.grid { 16 } else { 128 });
        let pitch = picture.width.next_multiple_of(64);
        let size = pitch * picture.height;
        let depth = picture.depth.map(|[base, pitch]| [base, base + pitch * picture.height]);
        let colour = [picture.base, picture.base + picture.pitch * picture.height];
        let first = depth.map_or(colour[0], |depth| depth[0].min(colour[0]));
        let beyond = depth.map_or(colour[1], |depth| depth[1].max(colour[1]));
        let place = match (beyond.saturating_add(size) <= self.memory, size <= first) {
            (true, _) => Some(beyond),
            (_, true) => Some(first - size),
            _ => None,
        };
        self.plane = wanted && place.is_some();
        let values = if self.plane { [place.unwrap_or(0), pitch] } else { [0, 0] };
        self.write(Reg::StencilBase, &values);
    }

    /// Sets a stencil test, which changes nothing where something blends, and says whether to call for it.
    fn stencil_test(&mut self, blends: bool) -> bool {
        if !self.plane || !self.bytes.chance(150) {
            return false;
        }
        let function = self.bytes.pick(&[7, 7, 1, 2, 3, 4, 5, 6, 0]);
        let operations = self.bytes.raw() & 0x7777_7710;
        let keeps = blends && !self.bytes.chance(16);
        let control = function | if keeps { 0 } else { operations };
        let value = if self.bytes.chance(128) { 0x00FF_FF00 | self.bytes.below(4) } else { self.bytes.raw() };
        self.write(Reg::StencilControl, &[control, value]);
        true
    }

    /// Effects, depth test, colour, tag, scissor.
    fn state(&mut self, picture: &Picture) {
        let depth = u32::from(picture.depth.is_some());
        let effects = match self.bytes.byte() {
            0..240 => {
                let masks = if self.grid { self.bytes.pick(&[0, 0x400, 0x400, 0x500]) } else { 0 };
                let looks = if self.bytes.chance(110) { self.looks() } else { 0 };
                let stencil = if self.stencil_test(looks & 0x100 != 0) { 0x800 } else { 0 };
                (self.bytes.below(16) & !1) | (depth & !u32::from(self.bytes.chance(32))) | masks | looks | stencil
            }
            _ => self.bytes.word(),
        };
        let function = self.bytes.below(8) | (u32::from(!self.bytes.chance(40)) << 8);
        let colour = self.bytes.raw();
        let mut values = vec![effects, function, colour, u32::from(self.bytes.byte())];
        if self.bytes.chance(60) {
            let corner =
                |bytes: &mut Bytes<'_>| bytes.below(picture.width + 2) | (bytes.below(picture.height + 2) << 16);
            values.extend([corner(self.bytes), corner(self.bytes)]);
        }
        self.write(Reg::Effects, &values);
    }

    /// Pixel history, on or off, with its records anywhere.
    fn probe(&mut self, picture: &Picture) {
        let pixel = self.bytes.below(picture.width) | (self.bytes.below(picture.height) << 16);
        let records = self.bytes.below(300);
        let base = match self.bytes.byte() % 4 {
            0 => picture.base,
            1 => picture.depth.map_or(0, |[base, _]| base),
            _ => 64 * self.bytes.below(self.memory.saturating_sub(32 * records) / 64),
        };
        let on = u32::from(!self.bytes.chance(60));
        self.write(Reg::ProbeControl, &[on, pixel, base, records]);
    }

    fn clear(&mut self, picture: &Picture) {
        let colours = if self.bytes.chance(40) { 0 } else { packet::CLEAR_COLOUR };
        let depths = if picture.depth.is_none() || self.bytes.chance(40) { 0 } else { packet::CLEAR_DEPTH };
        let depth = match self.bytes.byte() {
            0..128 => picture.maximum_depth,
            _ => self.bytes.raw() & picture.maximum_depth,
        };
        let colour = self.bytes.raw();
        let stencil = if self.plane && self.bytes.chance(128) {
            packet::CLEAR_STENCIL | self.bytes.below(4) << packet::CLEAR_STENCIL_SHIFT
        } else {
            0
        };
        self.push(Opcode::Clear, &[colours | depths | stencil, colour, depth]);
    }

    /// Display: the frame, sometimes something else; shown, written back, or both.
    fn shown(&mut self, picture: &Picture) {
        let size = picture.width | (picture.height << 16);
        let [base, pitch, format] = match self.bytes.byte() {
            0..200 => [picture.base, picture.pitch, picture.format],
            _ => [self.bytes.word(), self.bytes.word(), self.bytes.below(3)],
        };
        let size = if self.bytes.chance(16) { self.bytes.word() } else { size };
        self.write(Reg::ScanoutBase, &[base, pitch, format, size]);
        if self.bytes.chance(32) {
            // On the frame, or beyond any edge.
            let place = self.bytes.below(size.max(1)).wrapping_sub(self.bytes.below(64));
            let base = if self.bytes.chance(64) { self.bytes.word() } else { 64 * self.bytes.below(self.memory / 64) };
            self.write(Reg::CursorControl, &[1, base, place]);
        }
        if self.bytes.chance(4) {
            // Continuous, 1 to 3 ms; a reset ends it.
            let period = 1000 + self.bytes.below(2000);
            self.write(Reg::ScanoutControl, &[1, period]);
        }
        if !self.bytes.chance(60) {
            self.push(Opcode::Present, &[base]);
        }
        if self.bytes.chance(160) {
            let destination = 4 * self.bytes.below(self.memory / 4);
            self.push(Opcode::WriteBack, &[destination]);
        }
    }
}
