//! Tokens: plane segments on their way through the array, and how they lie on its ports.
//!
//! A plane segment is the cut of one primitive by the current scan line. Through the array it travels as
//! three beats, one a clock, on ports A and B with CTRL beside them (JP H06-95341 B2):
//!
//! | beat | port A | port B | port C | CTRL |
//! | --- | --- | --- | --- | --- |
//! | T1 | X | dX | | IN |
//! | T2 | Z | dZ | | |
//! | T3 | Z | I | least and greatest depth | kind, comparison, what is written |
//!
//! With [`TokenPorts::Merged`] X and dX share port A: X in bits 31:0, dX in 63:32. With [`EndTest::Zero`] both
//! enter one larger. A refresh token has an X that no element counts down to.
//!
//! # What is ours
//! The published token compares with `<` and nothing else. For one picture on every path ours also carries
//! the range that depths are clamped to (port C), the outcomes that pass (less, equal, greater) and whether
//! depth and colour are written. The two bits that name the beat travel too, so that a token can enter on
//! any clock; the published array takes them from a clock with three phases. [`super::gates`] shows what
//! each costs. A token of a draw with a stencil test has that test on a port D at T3, and a stencil value comes out beside
//! the depth: only scenes that ask for one have elements with a register for it.

use crate::hidden::stencil::StencilRule;
use crate::hidden::z_buffer::DepthTest;
use zga_abi::format::{EndTest, TokenPorts};
use zga_firmware::checked::SystolicSetting;

/// Bits of the CTRL port.
pub mod control {
    /// Which beat this is: 0 is a bubble.
    pub const PHASE: u32 = 3;
    /// X or dX.
    pub const T1: u32 = 1;
    /// Z and dZ.
    pub const T2: u32 = 2;
    /// Z and I.
    pub const T3: u32 = 3;
    /// T1: the element before was inside the segment.
    pub const INSIDE: u32 = 1 << 2;
    /// T3: a refresh token.
    pub const REFRESH: u32 = 1 << 3;
    /// T3: nearer passes.
    pub const LESS: u32 = 1 << 4;
    /// T3: equal passes.
    pub const EQUAL: u32 = 1 << 5;
    /// T3: farther passes.
    pub const GREATER: u32 = 1 << 6;
    /// T3: a passing depth is stored in Zb.
    pub const WRITE: u32 = 1 << 7;
    /// T3: where the depth passes, Ib is written.
    pub const COLOUR: u32 = 1 << 8;
    /// T3: what I is: 0 background, 1 tag, 2 colour.
    pub const KIND: u32 = 3 << KIND_SHIFT;
    /// Place of [`KIND`].
    pub const KIND_SHIFT: u32 = 9;
    /// Bits of the port.
    pub const WIDTH: u32 = 11;
}

/// What is seen at a pixel, as port B brings it and Ib keeps it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Luminance {
    /// Nothing of this scene.
    #[default]
    Background,
    /// The segment of this tag: an item of the scene, counted from 1. Shaded after the line.
    Tag(u32),
    /// A colour; RGBA, R in 7:0.
    Value(u32),
}

impl Luminance {
    /// Kind and bits, as the registers hold them.
    #[must_use]
    pub const fn encode(self) -> (u32, u32) {
        match self {
            Luminance::Background => (0, 0),
            Luminance::Tag(tag) => (1, tag),
            Luminance::Value(colour) => (2, colour),
        }
    }

    /// What registers with this kind and these bits hold.
    #[must_use]
    pub const fn decode(kind: u32, bits: u32) -> Luminance {
        match kind {
            1 => Luminance::Tag(bits),
            2 => Luminance::Value(bits),
            _ => Luminance::Background,
        }
    }
}

/// A pixel on the buses: what an element holds when the refresh token comes by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    /// On the luminance bus.
    pub luminance: Luminance,
    /// On the depth bus, which a card without a Z buffer does not have.
    pub depth: i32,
    /// Beside it, in a scene that asks for stencil values.
    pub stencil: u8,
}

/// A plane segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// X: first pixel covered, which is the number of its element.
    pub first: u32,
    /// dX: covered pixels beyond the first.
    pub more: u32,
    /// Z at the first pixel; [`crate::geometry::plane::below`] bits below the point, modulo 2^64.
    pub z: i64,
    /// dZ: change for one pixel to the right.
    pub dz: i64,
    /// Least and greatest depth of the primitive.
    pub range: [i32; 2],
    /// What passes, and whether its depth is stored.
    pub test: DepthTest,
    /// I; `None` leaves Ib alone.
    pub luminance: Option<Luminance>,
    /// What becomes of stencil values.
    pub stencil: StencilRule,
}

/// What stands on the ports between two elements for one clock. The default is a bubble.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Beat {
    /// Port A.
    pub a: u64,
    /// Port B.
    pub b: u64,
    /// Port C: least and greatest depth.
    pub c: [i32; 2],
    /// CTRL.
    pub control: u32,
    /// Port D: what becomes of stencil values.
    pub d: StencilRule,
}

impl Beat {
    /// A refresh token: no element counts its X down to 0, each answers at T3.
    pub const REFRESH: [Beat; 3] = [
        Beat { a: u64::MAX, b: 0, c: [0, 0], control: control::T1, d: StencilRule::Keep },
        Beat { a: 0, b: 0, c: [0, 0], control: control::T2, d: StencilRule::Keep },
        Beat { a: 0, b: 0, c: [0, 0], control: control::T3 | control::REFRESH, d: StencilRule::Keep },
    ];
}

impl Token {
    /// CTRL at T3.
    #[must_use]
    pub fn control(&self) -> u32 {
        let bit = |set: bool, bit: u32| if set { bit } else { 0 };
        let (kind, _) = self.luminance.unwrap_or_default().encode();
        control::T3
            | bit(self.test.less, control::LESS)
            | bit(self.test.equal, control::EQUAL)
            | bit(self.test.greater, control::GREATER)
            | bit(self.test.write, control::WRITE)
            | bit(self.luminance.is_some(), control::COLOUR)
            | (kind << control::KIND_SHIFT)
    }

    /// The token's three beats.
    #[must_use]
    pub fn beats(&self, setting: &SystolicSetting) -> [Beat; 3] {
        let larger = u64::from(setting.end_test == EndTest::Zero);
        let (x, dx) = (u64::from(self.first) + larger, u64::from(self.more) + larger);
        let (a, b) = match setting.ports {
            TokenPorts::Swapped => (x, dx),
            TokenPorts::Merged => (x | (dx << 32), 0),
        };
        let (_, luminance) = self.luminance.unwrap_or_default().encode();
        let (z, control) = (self.z as u64, self.control());
        [
            Beat { a, b, control: control::T1, ..Beat::default() },
            Beat { a: z, b: self.dz as u64, control: control::T2, ..Beat::default() },
            Beat { a: z, b: u64::from(luminance), c: self.range, control, d: self.stencil },
        ]
    }
}
