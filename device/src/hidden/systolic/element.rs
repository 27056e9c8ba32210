//! One processing element of the array, as the source describes it: the specification.
//!
//! Duties: the T1/T2/T3 table, to the letter. [`super::array`] steps many elements at once and must equal this
//! bit for bit, every register on every clock.
//!
//! | timing | port A | port B | with its one adder |
//! | --- | --- | --- | --- |
//! | T1 | X (IN = 0) or dX (IN = 1) | dX | A - 1. Hit while IN = 0: A := dX, IN := 1. Hit while IN = 1: A := all ones, IN := 0. Else A := A - 1 |
//! | T2 | Z | dZ | A := Z + dZ if IN, else Z |
//! | T3 | Z | I | Z passes against Zb and IN: Zb := Z, Ib := I. A keeps what T2 gave it |
//!
//! "Hit" is a borrow out of A - 1 (end test *negative*) or A - 1 = 0 (end test *zero*). After a segment has
//! ended A counts down from all ones, which takes more elements than there are. A refresh token acts at T3:
//! the element drives Ib on the luminance bus, resets it, and sets Zb to what the next line begins with.
//!
//! The comparison sees the Z that arrived, so the first element inside compares the segment's own Z.

use super::Machine;
use super::token::{Beat, Luminance, Pixel, control};
use crate::hidden::stencil::{StencilCounts, StencilRule};
use zga_abi::format::{EndTest, TokenPorts};
use zga_firmware::checked::SystolicSetting;

/// What all elements of an array share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// The variant.
    pub setting: SystolicSetting,
    /// Bits of Z below the binary point: 24 or 32.
    pub below: u32,
}

/// The registers of one element. A, B, C and CTRL are what the element to its right sees on the next clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Element {
    /// A.
    pub a: u64,
    /// B.
    pub b: u64,
    /// C.
    pub c: [i32; 2],
    /// CTRL.
    pub control: u32,
    /// IN: the pixel is inside the segment that came by last.
    pub inside: bool,
    /// Zb.
    pub depth: i32,
    /// Ib.
    pub luminance: Luminance,
    /// D.
    pub d: StencilRule,
    /// Stencil value, in a scene that asks for any.
    pub stencil: u8,
}

/// What an element does its stencil test with beside its registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StencilPart {
    /// The value that a refresh token leaves.
    pub reset: u8,
    /// Events.
    pub counts: StencilCounts,
}

impl Element {
    /// One clock. `reset` is what Zb takes when a refresh token comes by; returns what is driven on the buses.
    pub fn clock(&mut self, input: &Beat, rules: &Rules, reset: i32, stencil: &mut StencilPart) -> Option<Pixel> {
        let mut driven = None;
        let mut control = input.control;
        match input.control & control::PHASE {
            control::T1 => {
                let was_inside = input.control & control::INSIDE != 0;
                let hit = input.a as u32 == u32::from(rules.setting.end_test == EndTest::Zero);
                self.a = match (hit, was_inside) {
                    (false, _) => input.a.wrapping_sub(1),
                    (true, true) => u64::MAX,
                    (true, false) if rules.setting.ports == TokenPorts::Swapped => input.b,
                    (true, false) => input.a >> 32,
                };
                self.inside = was_inside != hit;
                control = if self.inside { control | control::INSIDE } else { control & !control::INSIDE };
            }
            control::T2 => self.a = if self.inside { input.a.wrapping_add(input.b) } else { input.a },
            control::T3 if input.control & control::REFRESH != 0 => {
                driven = Some(Pixel { luminance: self.luminance, depth: self.depth, stencil: self.stencil });
                self.luminance = Luminance::Background;
                self.depth = reset;
                self.stencil = stencil.reset;
            }
            control::T3 => {
                if self.inside {
                    let mine = (&mut self.depth, &mut self.luminance, &mut self.stencil);
                    compare(input, input.a as i64, rules.below, mine, &mut stencil.counts);
                }
            }
            _ => self.a = input.a,
        }
        (self.b, self.c, self.control, self.d) = (input.b, input.c, control, input.d);
        driven
    }

    /// What the element to the right sees.
    #[must_use]
    pub fn output(&self) -> Beat {
        Beat { a: self.a, b: self.b, c: self.c, control: self.control, d: self.d }
    }
}

/// The comparison at T3: the stencil value by the rule on port D; `z` shifted, clamped to the range on port C, against Zb.
/// The element's depth, luminance and stencil value are changed.
pub fn compare(
    input: &Beat,
    z: i64,
    below: u32,
    (depth, luminance, stencil): (&mut i32, &mut Luminance, &mut u8),
    counts: &mut StencilCounts,
) {
    let z = (z >> below).clamp(i64::from(input.c[0]), i64::from(input.c[1])) as i32;
    let relation = match z.cmp(depth) {
        std::cmp::Ordering::Less => control::LESS,
        std::cmp::Ordering::Equal => control::EQUAL,
        std::cmp::Ordering::Greater => control::GREATER,
    };
    if !input.d.decide(stencil, counts, || input.control & relation != 0) {
        return;
    }
    if input.control & control::WRITE != 0 {
        *depth = z;
    }
    if input.control & control::COLOUR != 0 {
        *luminance = Luminance::decode((input.control & control::KIND) >> control::KIND_SHIFT, input.b as u32);
    }
}

/// An array of elements, stepped one by one.
#[derive(Clone, Debug)]
pub struct Elements {
    /// The elements, leftmost first.
    pub elements: Vec<Element>,
    rules: Rules,
    stencil: StencilPart,
}

impl Elements {
    /// `count` elements that hold nothing.
    #[must_use]
    pub fn new(count: u32, rules: Rules) -> Elements {
        Elements { elements: vec![Element::default(); count as usize], rules, stencil: StencilPart::default() }
    }
}

impl Machine for Elements {
    type Port = Beat;

    fn clock(&mut self, port: Beat, reset: i32) -> Option<Pixel> {
        let mut driven = None;
        // From the far end, so that each element still sees what its neighbour held before the clock.
        for place in (0..self.elements.len()).rev() {
            let input = if place == 0 { port } else { self.elements[place - 1].output() };
            driven = self.elements[place].clock(&input, &self.rules, reset, &mut self.stencil).or(driven);
        }
        driven
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

    fn signals(&self, element: usize, port: &Beat) -> Vec<u64> {
        let input = if element == 0 { port.control } else { self.elements[element - 1].control };
        super::array::signals(&self.elements[element], input)
    }

    fn port_signals(port: &Beat) -> Vec<u64> {
        super::array::port_signals(port)
    }

    const SIGNALS: &'static [(&'static str, u32)] = super::array::SIGNALS;
    const PORT_SIGNALS: &'static [(&'static str, u32)] = super::array::PORT_SIGNALS;
}
