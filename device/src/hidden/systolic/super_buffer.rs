//! The earlier design that the systolic array improves on: Gharachorloo and Pottle's Super Buffer.
//!
//! One element a pixel too, but a segment travels as one token in one clock, and each element has two range
//! comparators (against its own pixel number), a depth comparator and an adder side by side:
//!
//! * inside XL ..= XR: Z against Zb, and Z + dZ goes on to the right; outside: the token passes unchanged.
//! * A refresh token puts Ib into a second pipeline that flows back to the left, one element a clock. So
//!   pixel i comes out 2 i + 1 clocks after the refresh token went in: one pixel every 2 clocks.
//! * The feeder waits for the last pixel before it lets the next line in. Clocks: K + 2 N a line.
//!
//! What tokens carry beside that (range of depths, outcomes that pass, write bits) is as in [`super::token`],
//! so that the picture is the same. [`Specification`] goes element by element, [`SuperBuffer`] 16 at a time.

use super::Machine;
use super::array::{Halves, has, load, refresh, relation};
use super::element::{StencilPart, compare};
use super::tape::{Fixed, LANES, Tape};
use super::token::{Beat, Luminance, Pixel, Token, control};
use crate::hidden::stencil::{StencilCounts, StencilRule};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, i32x16, u32x16};

/// What stands between two elements for one clock. The default is a bubble.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Slot {
    /// XL: first pixel covered.
    pub first: u32,
    /// XR: last pixel covered.
    pub last: u32,
    /// Z at the element it comes to next, once inside.
    pub z: i64,
    /// dZ.
    pub dz: i64,
    /// I, its 32 bits.
    pub luminance: u32,
    /// Least and greatest depth of the primitive.
    pub range: [i32; 2],
    /// CTRL, as the array has it at T3.
    pub control: u32,
    /// What becomes of stencil values.
    pub d: StencilRule,
}

impl Slot {
    /// A refresh token: inside nowhere.
    pub const REFRESH: Slot = Slot {
        first: 1,
        last: 0,
        z: 0,
        dz: 0,
        luminance: 0,
        range: [0, 0],
        control: control::T3 | control::REFRESH,
        d: StencilRule::Keep,
    };
}

impl From<&Token> for Slot {
    fn from(token: &Token) -> Slot {
        Slot {
            first: token.first,
            last: token.first + token.more,
            z: token.z,
            dz: token.dz,
            luminance: token.luminance.unwrap_or_default().encode().1,
            range: token.range,
            control: token.control(),
            d: token.stencil,
        }
    }
}

/// The registers of one element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Element {
    /// The token that goes on to the right.
    pub slot: Slot,
    /// The pixel that goes on to the left.
    pub back: Option<Pixel>,
    /// Zb.
    pub depth: i32,
    /// Ib.
    pub luminance: Luminance,
    /// Stencil value, in a scene that asks for any.
    pub stencil: u8,
}

/// A Super Buffer, element by element.
#[derive(Clone, Debug)]
pub struct Specification {
    /// The elements, leftmost first.
    pub elements: Vec<Element>,
    below: u32,
    stencil: StencilPart,
}

impl Specification {
    /// `count` elements that hold nothing; depths have `below` bits below the point.
    #[must_use]
    pub fn new(count: u32, below: u32) -> Specification {
        Specification { elements: vec![Element::default(); count as usize], below, stencil: StencilPart::default() }
    }
}

impl Machine for Specification {
    type Port = Slot;

    fn clock(&mut self, port: Slot, reset: i32) -> Option<Pixel> {
        let before = self.elements.clone();
        for (number, element) in self.elements.iter_mut().enumerate() {
            let input = if number == 0 { port } else { before[number - 1].slot };
            element.slot = input;
            element.back = before.get(number + 1).and_then(|right| right.back);
            if input.control & control::REFRESH != 0 {
                let Element { luminance, depth, stencil, .. } = *element;
                element.back = Some(Pixel { luminance, depth, stencil });
                element.luminance = Luminance::Background;
                element.depth = reset;
                element.stencil = self.stencil.reset;
            } else if input.control != 0 && (input.first..=input.last).contains(&(number as u32)) {
                let (b, c, control) = (u64::from(input.luminance), input.range, input.control);
                let beat = Beat { a: 0, b, c, control, d: input.d };
                let mine = (&mut element.depth, &mut element.luminance, &mut element.stencil);
                compare(&beat, input.z, self.below, mine, &mut self.stencil.counts);
                element.slot.z = input.z.wrapping_add(input.dz);
            }
        }
        before[0].back
    }

    fn preset(&mut self, element: usize, depth: i32) {
        self.elements[element].depth = depth;
    }

    fn preset_stencil(&mut self, element: usize, value: u8) {
        self.elements[element].stencil = value;
    }

    fn reset_stencil(&mut self, value: u8) {
        self.stencil.reset = value;
    }

    fn stencil_counts(&self) -> StencilCounts {
        self.stencil.counts
    }

    fn signals(&self, element: usize, _port: &Slot) -> Vec<u64> {
        signals(&self.elements[element])
    }

    fn port_signals(port: &Slot) -> Vec<u64> {
        port_signals(port)
    }

    const SIGNALS: &'static [(&'static str, u32)] = SIGNALS;
    const PORT_SIGNALS: &'static [(&'static str, u32)] = PORT_SIGNALS;
}

/// Registers on the tape.
mod moving {
    pub const FIRST: usize = 0;
    pub const LAST: usize = 1;
    pub const Z_LOW: usize = 2;
    pub const Z_HIGH: usize = 3;
    pub const DZ_LOW: usize = 4;
    pub const DZ_HIGH: usize = 5;
    pub const LUMINANCE: usize = 6;
    pub const MINIMUM: usize = 7;
    pub const MAXIMUM: usize = 8;
    pub const CONTROL: usize = 9;
    pub const COUNT: usize = 10;
}

/// Registers that stay.
mod staying {
    pub const DEPTH: usize = 0;
    pub const LUMINANCE: usize = 1;
    /// The kind of Ib, at its place in CTRL.
    pub const STATE: usize = 2;
    pub const COUNT: usize = 3;
}

/// A Super Buffer, [`LANES`] elements at a time.
#[derive(Clone, Debug)]
pub struct SuperBuffer {
    level: Level,
    below: u32,
    elements: usize,
    tape: Tape<{ moving::COUNT }>,
    kept: Fixed<{ staying::COUNT }>,
    /// The pipeline that flows back. It moves as a tape does, the other way; element i is at `head + i`.
    back: Vec<Option<Pixel>>,
    back_head: usize,
}

impl SuperBuffer {
    /// `count` elements that hold nothing; depths have `below` bits below the point.
    #[must_use]
    pub fn new(count: u32, below: u32, level: Level) -> SuperBuffer {
        let elements = count as usize;
        SuperBuffer {
            level,
            below,
            elements,
            tape: Tape::new(elements),
            kept: Fixed::new(elements),
            back: vec![None; 2 * elements + 1024],
            back_head: 0,
        }
    }

    /// The registers of one element.
    #[must_use]
    pub fn element(&self, element: usize) -> Element {
        let word = |register: usize| self.tape.word(register, element);
        let long = |low: usize, high: usize| (u64::from(word(low)) | (u64::from(word(high)) << 32)) as i64;
        let kind = (self.kept.word(staying::STATE, element) & control::KIND) >> control::KIND_SHIFT;
        Element {
            slot: Slot {
                first: word(moving::FIRST),
                last: word(moving::LAST),
                z: long(moving::Z_LOW, moving::Z_HIGH),
                dz: long(moving::DZ_LOW, moving::DZ_HIGH),
                luminance: word(moving::LUMINANCE),
                range: [word(moving::MINIMUM) as i32, word(moving::MAXIMUM) as i32],
                control: word(moving::CONTROL),
                d: StencilRule::Keep,
            },
            back: self.back[self.back_head + element],
            depth: self.kept.word(staying::DEPTH, element) as i32,
            luminance: Luminance::decode(kind, self.kept.word(staying::LUMINANCE, element)),
            stencil: 0,
        }
    }

    /// The pixel that leaves on the left; all others go on by one.
    fn shift_back(&mut self) -> Option<Pixel> {
        if self.back_head + self.elements + 1 > self.back.len() {
            self.back.copy_within(self.back_head.., 0);
            self.back[self.elements..].fill(None);
            self.back_head = 0;
        }
        let out = self.back[self.back_head].take();
        self.back_head += 1;
        out
    }

    /// One clock of all elements, whose inputs lie on the tapes already.
    #[inline(always)]
    fn step<S: Simd>(&mut self, simd: S, reset: i32) {
        let (start, count) = self.tape.chunks();
        let [first, last, z_low, z_high, dz_low, dz_high, luminance, minimum, maximum, ctrl] =
            self.tape.registers.each_mut().map(|words| &mut words.get_mut()[start..][..count * LANES]);
        let [depths, luminances, states] = self.kept.chunks(self.tape.head - start).map(|chunks| &mut chunks[..count]);
        let lane = u32x16::from_slice(simd, &NUMBERS);
        for (k, at) in (0..count).zip((0..).step_by(LANES)) {
            let controls = u32x16::from_slice(simd, &ctrl[at..at + LANES]);
            if controls.simd_eq(0).all_true() {
                continue;
            }
            // Lanes before element 0 have numbers no segment reaches, and no CTRL.
            let number = lane + ((start + at).wrapping_sub(self.tape.head) as u32);
            let outside =
                number.simd_lt(chunk(simd, first, at)) | chunk(simd, last, at).simd_lt(number) | controls.simd_eq(0);
            let z = Halves::load(simd, &z_low[at..], &z_high[at..]);
            let dz = Halves::load(simd, &dz_low[at..], &dz_high[at..]);
            let (sum, _) = z.plus(dz);
            Halves::select(outside, z, sum).store(&mut z_low[at..], &mut z_high[at..]);

            let [least, greatest]: [i32x16<S>; 2] =
                [chunk(simd, minimum, at).bitcast(), chunk(simd, maximum, at).bitcast()];
            let z = z.stored(simd, self.below).max(least).min(greatest);
            let held: i32x16<S> = load(simd, &depths[k]).bitcast();
            let passes = !outside & relation(simd, z, held, controls);
            let writes = passes & has(controls, control::WRITE);
            let colours = passes & has(controls, control::COLOUR);
            let depth: u32x16<S> = writes.select(z, held).bitcast();
            depth.store_slice(&mut depths[k]);
            colours.select(chunk(simd, luminance, at), load(simd, &luminances[k])).store_slice(&mut luminances[k]);
            (colours.select(controls, load(simd, &states[k])) & control::KIND).store_slice(&mut states[k]);
            let refreshed = has(controls, control::REFRESH);
            if refreshed.any_true() {
                let lane = refreshed.to_bitmask().trailing_zeros() as usize % LANES;
                let element = start + at + lane - self.tape.head;
                self.back[self.back_head + element] =
                    refresh(&mut depths[k][lane], &mut luminances[k][lane], &mut states[k][lane], reset);
            }
        }
    }
}

/// The chunk of `words` that begins at `at`.
#[inline(always)]
fn chunk<S: Simd>(simd: S, words: &[u32], at: usize) -> u32x16<S> {
    u32x16::from_slice(simd, &words[at..at + LANES])
}

/// Numbers of the lanes.
const NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

impl Machine for SuperBuffer {
    type Port = Slot;

    fn clock(&mut self, port: Slot, reset: i32) -> Option<Pixel> {
        let (z, dz) = (port.z as u64, port.dz as u64);
        let [minimum, maximum] = port.range.map(|depth| depth as u32);
        self.tape.shift([
            port.first,
            port.last,
            z as u32,
            (z >> 32) as u32,
            dz as u32,
            (dz >> 32) as u32,
            port.luminance,
            minimum,
            maximum,
            port.control,
        ]);
        let out = self.shift_back();
        dispatch!(self.level, simd => self.step(simd, reset));
        out
    }

    fn preset(&mut self, element: usize, depth: i32) {
        self.kept.set(staying::DEPTH, element, depth as u32);
    }

    fn signals(&self, element: usize, _port: &Slot) -> Vec<u64> {
        signals(&self.element(element))
    }

    fn port_signals(port: &Slot) -> Vec<u64> {
        port_signals(port)
    }

    const SIGNALS: &'static [(&'static str, u32)] = SIGNALS;
    const PORT_SIGNALS: &'static [(&'static str, u32)] = PORT_SIGNALS;
}

/// Names and bits of an element's signals.
const SIGNALS: &[(&str, u32)] = &[
    ("XL", 32),
    ("XR", 32),
    ("Z", 64),
    ("dZ", 64),
    ("I", 32),
    ("minimum", 32),
    ("maximum", 32),
    ("CTRL", control::WIDTH),
    ("Zb", 32),
    ("Ib", 32),
    ("Ib_kind", 2),
    ("back", 32),
    ("back_valid", 1),
];

fn signals(element: &Element) -> Vec<u64> {
    let (kind, luminance) = element.luminance.encode();
    let back = element.back.unwrap_or_default().luminance.encode().1;
    let kept = [element.depth as u32, luminance, kind, back, u32::from(element.back.is_some())].map(u64::from);
    [port_signals(&element.slot).as_slice(), &kept].concat()
}

/// Names and bits of what the feeder puts on the ports of element 0.
const PORT_SIGNALS: &[(&str, u32)] = SIGNALS.split_at(8).0;

fn port_signals(slot: &Slot) -> Vec<u64> {
    let [minimum, maximum] = slot.range.map(|depth| u64::from(depth as u32));
    let [first, last, luminance, control] = [slot.first, slot.last, slot.luminance, slot.control].map(u64::from);
    vec![first, last, slot.z as u64, slot.dz as u64, luminance, minimum, maximum, control]
}
