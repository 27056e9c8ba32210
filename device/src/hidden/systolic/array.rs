//! The systolic array, stepped register by register, [`LANES`] elements at a time.
//!
//! Source: JP H06-95341 B2 (1985). Duties: every register of every element on every clock, as
//! [`super::element`] specifies. Inputs: a beat a clock from the feeder, and what Zb is reset to. Outputs: the
//! luminance bus. A clock is one call of [`Machine::clock`].
//!
//! A, B, C and CTRL lie on a [`Tape`]: on each clock all of them go on by one element, and a chunk computes
//! what its elements make of them, in place. IN, Zb and Ib stay with their element. 64-bit registers are two
//! halves in 32-bit lanes, as in the row kernels of the Z buffer. The one adder of an element adds -1 (T1),
//! dZ (T2) or nothing; a lane whose element is in another timing selects another operand.
//!
//! A chunk in which all elements have a bubble is passed over: a bubble changes no register (A + 0 = A), and
//! what it carries has moved with the tape. With tokens back to back there is none.

use super::Machine;
use super::element::{Element, Rules};
use super::tape::{Fixed, LANES, Tape};
use super::token::{Beat, Luminance, Pixel, control};
use crate::hidden::stencil::StencilRule;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, i32x16, mask32x16, u32x16};
use zga_abi::format::{EndTest, TokenPorts};

/// Registers on the tape.
mod moving {
    pub const A_LOW: usize = 0;
    pub const A_HIGH: usize = 1;
    pub const B_LOW: usize = 2;
    pub const B_HIGH: usize = 3;
    pub const MINIMUM: usize = 4;
    pub const MAXIMUM: usize = 5;
    pub const CONTROL: usize = 6;
    pub const COUNT: usize = 7;
}

/// Registers that stay.
mod staying {
    /// Zb.
    pub const DEPTH: usize = 0;
    /// Ib, its 32 bits.
    pub const LUMINANCE: usize = 1;
    /// IN and the kind of Ib, at the places they have in CTRL.
    pub const STATE: usize = 2;
    pub const COUNT: usize = 3;
}

/// An array of elements.
#[derive(Clone, Debug)]
pub struct Array {
    level: Level,
    rules: Rules,
    tape: Tape<{ moving::COUNT }>,
    kept: Fixed<{ staying::COUNT }>,
}

impl Array {
    /// `count` elements that hold nothing.
    #[must_use]
    pub fn new(count: u32, rules: Rules, level: Level) -> Array {
        let count = count as usize;
        Array { level, rules, tape: Tape::new(count), kept: Fixed::new(count) }
    }

    /// The registers of one element.
    #[must_use]
    pub fn element(&self, element: usize) -> Element {
        let word = |register: usize| self.tape.word(register, element);
        let long = |low: usize, high: usize| u64::from(word(low)) | (u64::from(word(high)) << 32);
        let state = self.kept.word(staying::STATE, element);
        Element {
            a: long(moving::A_LOW, moving::A_HIGH),
            b: long(moving::B_LOW, moving::B_HIGH),
            c: [word(moving::MINIMUM) as i32, word(moving::MAXIMUM) as i32],
            control: word(moving::CONTROL),
            inside: state & control::INSIDE != 0,
            depth: self.kept.word(staying::DEPTH, element) as i32,
            luminance: Luminance::decode(
                (state & control::KIND) >> control::KIND_SHIFT,
                self.kept.word(staying::LUMINANCE, element),
            ),
            d: StencilRule::Keep,
            stencil: 0,
        }
    }

    /// One clock of all elements, whose inputs lie on the tape already.
    #[inline(always)]
    fn step<S: Simd>(&mut self, simd: S, reset: i32) -> Option<Pixel> {
        let (first, count) = self.tape.chunks();
        let [a_low, a_high, b_low, b_high, minimum, maximum, ctrl] = self.tape.registers.each_mut().map(|words| {
            // One chunk more: A of the neighbours.
            &mut words.get_mut()[first..][..(count + 1) * LANES]
        });
        let [b_low, b_high, minimum, maximum] =
            [b_low, b_high, minimum, maximum].map(|words| &words.as_chunks::<LANES>().0[..count]);
        let ctrl = &mut ctrl.as_chunks_mut::<LANES>().0[..count];
        let [depths, luminances, states] = self.kept.chunks(self.tape.head - first).map(|chunks| &mut chunks[..count]);

        let zero = u32x16::splat(simd, 0);
        let ones = u32x16::splat(simd, u32::MAX);
        let zero_test = self.rules.setting.end_test == EndTest::Zero;
        let merged = self.rules.setting.ports == TokenPorts::Merged;
        let mut driven = None;
        for k in 0..count {
            let controls = load(simd, &ctrl[k]);
            if controls.simd_eq(0).all_true() {
                continue;
            }
            let phase = controls & control::PHASE;
            let (t1, t2, t3) = (phase.simd_eq(control::T1), phase.simd_eq(control::T2), phase.simd_eq(control::T3));
            let a = Halves::load(simd, &a_low[k * LANES..], &a_high[k * LANES..]);
            let b = Halves { low: load(simd, &b_low[k]), high: load(simd, &b_high[k]) };
            // What A of these elements has held since the last clock lies one element on.
            let a_before = Halves::load(simd, &a_low[k * LANES + 1..], &a_high[k * LANES + 1..]);
            let state = load(simd, &states[k]);
            let inside = has(state, control::INSIDE);

            // The one adder.
            let advance = t2 & inside;
            let operand = Halves {
                low: t1.select(ones, advance.select(b.low, zero)),
                high: t1.select(ones, advance.select(b.high, zero)),
            };
            let (sum, carry) = a.plus(operand);

            // T1: a segment begins or ends here. A - 1 carries unless it borrows.
            let hit = t1 & if zero_test { sum.low.simd_eq(0) } else { !carry };
            let was_inside = has(controls, control::INSIDE);
            let now_inside = (was_inside ^ hit) | (inside & !t1);
            let dx = if merged { Halves { low: a.high, high: zero } } else { b };
            let ended = hit & was_inside;
            let hit_gives = Halves::select(ended, Halves { low: ones, high: ones }, dx);
            let result = Halves::select(t3, a_before, Halves::select(hit, hit_gives, sum));
            result.store(&mut a_low[k * LANES..], &mut a_high[k * LANES..]);
            hit.select(controls ^ control::INSIDE, controls).store_slice(&mut ctrl[k]);

            // T3: outcomes that pass are set in CTRL at T3 only, and never with a refresh.
            let z = a.stored(simd, self.rules.below);
            let z = z.max(load_signed(simd, &minimum[k])).min(load_signed(simd, &maximum[k]));
            let held = load_signed(simd, &depths[k]);
            let passes = inside & relation(simd, z, held, controls);
            let writes = passes & has(controls, control::WRITE);
            let colours = passes & has(controls, control::COLOUR);
            let depth: u32x16<S> = writes.select(z, held).bitcast();
            let luminance = load(simd, &luminances[k]);
            let kind = colours.select(controls, state) & control::KIND;
            let refreshed = has(controls, control::REFRESH);
            depth.store_slice(&mut depths[k]);
            colours.select(b.low, luminance).store_slice(&mut luminances[k]);
            (kind | now_inside.select(u32x16::splat(simd, control::INSIDE), zero)).store_slice(&mut states[k]);
            if refreshed.any_true() {
                let lanes = refreshed.to_bitmask();
                debug_assert!(driven.is_none() && lanes.is_power_of_two(), "two elements drive the bus");
                let lane = lanes.trailing_zeros() as usize % LANES;
                driven = refresh(&mut depths[k][lane], &mut luminances[k][lane], &mut states[k][lane], reset);
            }
        }
        driven
    }
}

/// A refresh token's beat T3 at one element: what it drives on the buses.
pub fn refresh(depth: &mut u32, luminance: &mut u32, state: &mut u32, reset: i32) -> Option<Pixel> {
    let kind = (*state & control::KIND) >> control::KIND_SHIFT;
    let pixel = Pixel { luminance: Luminance::decode(kind, *luminance), depth: *depth as i32, stencil: 0 };
    *depth = reset as u32;
    *luminance = 0;
    *state &= !control::KIND;
    Some(pixel)
}

/// A chunk's lanes.
#[inline(always)]
pub fn load<S: Simd>(simd: S, chunk: &[u32; LANES]) -> u32x16<S> {
    u32x16::from_slice(simd, chunk)
}

#[inline(always)]
fn load_signed<S: Simd>(simd: S, chunk: &[u32; LANES]) -> i32x16<S> {
    load(simd, chunk).bitcast()
}

/// Lanes that have a bit set.
#[inline(always)]
pub fn has<S: Simd>(word: u32x16<S>, bit: u32) -> mask32x16<S> {
    !(word & bit).simd_eq(0)
}

/// Lanes in which the outcome of `z` against `held` is one that CTRL lets pass.
#[inline(always)]
pub fn relation<S: Simd>(simd: S, z: i32x16<S>, held: i32x16<S>, controls: u32x16<S>) -> mask32x16<S> {
    let (less, greater) = (u32x16::splat(simd, control::LESS), u32x16::splat(simd, control::GREATER));
    let unequal = z.simd_lt(held).select(less, greater);
    let outcome = z.simd_eq(held).select(u32x16::splat(simd, control::EQUAL), unequal);
    !(outcome & controls).simd_eq(0)
}

/// 64-bit lanes in two halves.
#[derive(Clone, Copy)]
pub struct Halves<S: Simd> {
    /// Bits 31:0.
    pub low: u32x16<S>,
    /// Bits 63:32.
    pub high: u32x16<S>,
}

impl<S: Simd> Halves<S> {
    /// The lanes that `low` and `high` begin with.
    #[inline(always)]
    pub fn load(simd: S, low: &[u32], high: &[u32]) -> Self {
        Halves { low: u32x16::from_slice(simd, &low[..LANES]), high: u32x16::from_slice(simd, &high[..LANES]) }
    }

    /// Puts the lanes where `low` and `high` begin.
    #[inline(always)]
    pub fn store(self, low: &mut [u32], high: &mut [u32]) {
        self.low.store_slice(&mut low[..LANES]);
        self.high.store_slice(&mut high[..LANES]);
    }

    /// `yes` in the lanes of `which`, `no` in the others.
    #[inline(always)]
    pub fn select(which: mask32x16<S>, yes: Self, no: Self) -> Self {
        Halves { low: which.select(yes.low, no.low), high: which.select(yes.high, no.high) }
    }

    /// The sum, and the carry out of its lower half.
    #[inline(always)]
    pub fn plus(self, other: Self) -> (Self, mask32x16<S>) {
        let low = self.low + other.low;
        let carry = low.simd_lt(self.low);
        let high = self.high + other.high;
        (Halves { low, high: carry.select(high + 1, high) }, carry)
    }

    /// Shifted right by `below`, 24 or 32; what does not fit is as far away as fits.
    #[inline(always)]
    pub fn stored(self, simd: S, below: u32) -> i32x16<S> {
        let high: i32x16<S> = self.high.bitcast();
        if below == 32 {
            return high;
        }
        let body: i32x16<S> = ((self.high << 8_u32) | (self.low >> 24_u32)).bitcast();
        let near = high.simd_lt(-(1 << 23)).select(i32x16::splat(simd, i32::MIN), body);
        high.simd_gt((1 << 23) - 1).select(i32x16::splat(simd, i32::MAX), near)
    }
}

impl Machine for Array {
    type Port = Beat;

    fn clock(&mut self, port: Beat, reset: i32) -> Option<Pixel> {
        self.tape.shift([
            port.a as u32,
            (port.a >> 32) as u32,
            port.b as u32,
            (port.b >> 32) as u32,
            port.c[0] as u32,
            port.c[1] as u32,
            port.control,
        ]);
        dispatch!(self.level, simd => self.step(simd, reset))
    }

    fn preset(&mut self, element: usize, depth: i32) {
        self.kept.set(staying::DEPTH, element, depth as u32);
    }

    fn signals(&self, element: usize, port: &Beat) -> Vec<u64> {
        let input = if element == 0 { port.control } else { self.tape.word(moving::CONTROL, element - 1) };
        signals(&self.element(element), input)
    }

    fn port_signals(port: &Beat) -> Vec<u64> {
        port_signals(port)
    }

    const SIGNALS: &'static [(&'static str, u32)] = SIGNALS;
    const PORT_SIGNALS: &'static [(&'static str, u32)] = PORT_SIGNALS;
}

/// Names and bits of an element's signals.
pub const SIGNALS: &[(&str, u32)] = &[
    ("A", 64),
    ("B", 64),
    ("C_minimum", 32),
    ("C_maximum", 32),
    ("CTRL", control::WIDTH),
    ("Zb", 32),
    ("Ib", 32),
    ("Ib_kind", 2),
    ("IN", 1),
    ("phase", 2),
];

/// Values of an element's signals; the phase is the timing it is in, from CTRL on its left.
pub fn signals(element: &Element, input_control: u32) -> Vec<u64> {
    let (kind, luminance) = element.luminance.encode();
    let [minimum, maximum] = element.c.map(|depth| u64::from(depth as u32));
    let narrow = [element.control, element.depth as u32, luminance, kind, u32::from(element.inside)].map(u64::from);
    let phase = u64::from(input_control & control::PHASE);
    [[element.a, element.b, minimum, maximum].as_slice(), &narrow, &[phase]].concat()
}

/// Names and bits of what the feeder puts on the ports of element 0.
pub const PORT_SIGNALS: &[(&str, u32)] =
    &[("A", 64), ("B", 64), ("C_minimum", 32), ("C_maximum", 32), ("CTRL", control::WIDTH)];

/// Values of them.
pub fn port_signals(port: &Beat) -> Vec<u64> {
    let [minimum, maximum] = port.c.map(|depth| u64::from(depth as u32));
    vec![port.a, port.b, minimum, maximum, u64::from(port.control)]
}
