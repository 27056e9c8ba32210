//! The systolic scan-line array: hidden surfaces without a Z buffer.
//!
//! Source: JP H06-95341 B2 (1985); the earlier design beside it is Gharachorloo and Pottle's Super Buffer.
//!
//! A row of N identical elements, one for each pixel of a scan line. Each has a depth register Zb, a luminance
//! register Ib, one adder and one stage of pipeline registers. Plane segments flow through them as tokens, one
//! every 3 clocks, one element a clock; none of the elements knows its own number. A refresh token ends the
//! line: as it comes by each element drives Ib on the luminance bus, one pixel a clock. Tokens of the next line
//! follow at once. All lines of the target are fed, whether something is on them or not.
//!
//! | file | part |
//! | --- | --- |
//! | [`token`] | tokens, their beats, the CTRL port |
//! | [`element`] | one element on one clock: the specification |
//! | [`tape`] | registers that all move on by one |
//! | [`array`](mod@array) | all elements, 16 at a time |
//! | [`super_buffer`] | the earlier design, both ways |
//! | [`feeder`] | primitives cut by scan lines |
//! | [`scene`] | a scene through either machine, into the frame |
//! | [`closed_form`](mod@closed_form) | clocks without stepping |
//! | [`gates`] | what the variants cost in gates |
//! | [`waves`] | waveforms of the registers (VCD) |
//!
//! Duties: visibility and colours of a scene, line by line. Inputs: a scene that was [held back](super::held), its target.
//! Outputs: frame buffer, Z buffer if there is one, events ([`SystolicCounts`]), waveforms.
//!
//! # Clocks
//! 3 a token, 3 a refresh token, at least N between refresh tokens, N + 2 at the end; see
//! [`closed_form`](mod@closed_form). Interpolated colours are shaded once for each pixel they are seen at, 1 clock
//! each. Depths are loaded and stored along with the refresh tokens where there is a Z buffer, stencil values where the
//! scene asks for any: no clocks. Such a scene is stepped element by element, as the elements are specified.
#![doc = include_str!("worked_example.md")]

pub mod array;
pub mod closed_form;
pub mod element;
pub mod feeder;
pub mod gates;
pub mod scene;
pub mod super_buffer;
pub mod tape;
#[cfg(test)]
mod tests;
pub mod token;
pub mod waves;

pub use closed_form::closed_form;
#[cfg(test)]
pub use scene::draw_scene;
pub use scene::draw_until;
pub use waves::Waves;

use crate::hidden::stencil::StencilCounts;
use crate::probe::account::{Account, Clocks};
use crate::shading::pixel::ShadingCounts;
use token::Pixel;
use zga_abi::Counter;

/// A clocked model: elements in a row that take something from the feeder on each clock.
pub trait Machine {
    /// What stands on the ports of element 0 for a clock; the default is a bubble.
    type Port: Copy + Default;

    /// Names and bits of an element's signals.
    const SIGNALS: &'static [(&'static str, u32)];
    /// Names and bits of the port's signals.
    const PORT_SIGNALS: &'static [(&'static str, u32)];

    /// One clock of every element. `reset` is what Zb becomes where a refresh token comes by; returns the pixel
    /// that comes out.
    fn clock(&mut self, port: Self::Port, reset: i32) -> Option<Pixel>;

    /// Sets Zb of an element before the first clock.
    fn preset(&mut self, element: usize, depth: i32);

    /// Sets the stencil value of an element before the first clock; only machines of scenes that ask for stencil values
    /// keep any.
    fn preset_stencil(&mut self, _element: usize, _value: u8) {}

    /// Gives the stencil value that the element takes where a refresh token comes by in the next clock.
    fn reset_stencil(&mut self, _value: u8) {}

    /// Events of stencil tests.
    fn stencil_counts(&self) -> StencilCounts {
        StencilCounts::default()
    }

    /// Values of an element's signals before a clock in which `port` stands on the ports of element 0.
    fn signals(&self, element: usize, port: &Self::Port) -> Vec<u64>;

    /// Values of the port's signals.
    fn port_signals(port: &Self::Port) -> Vec<u64>;
}

/// Events of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SystolicCounts {
    /// Plane segments that entered, a refresh token not among them.
    pub tokens: u64,
    /// Clocks from the first token to the last pixel on the bus.
    pub clocks: u64,
    /// Segments of triangles.
    pub spans: u64,
    /// Depths loaded from a Z buffer.
    pub reads: u64,
    /// Depths stored to a Z buffer.
    pub writes: u64,
    /// Colours written to the frame buffer.
    pub colours: u64,
    /// Pixels that are shaded: their colour is interpolated, or goes through more.
    pub shaded: u64,
    /// What they cost beyond interpolated colours.
    pub shading: ShadingCounts,
    /// Events of stencil tests.
    pub stencil: StencilCounts,
}

/// Charges the events of a scene.
pub fn charge(counts: &SystolicCounts, account: &mut Account) {
    account.add(Counter::SystolicTokens, counts.tokens);
    account.add(Counter::SystolicClocks, counts.clocks);
    account.charge(Counter::CyclesSystolic, Clocks(counts.clocks));
    account.add(Counter::ZSpans, counts.spans);
    account.add(Counter::ZReads, counts.reads);
    account.add(Counter::ZWrites, counts.writes);
    account.add(Counter::ColourWrites, counts.colours);
    account.add(Counter::ShadingPixels, counts.shaded);
    account.charge(Counter::CyclesShading, Clocks(counts.shaded));
    counts.shading.charge(account);
    counts.stencil.charge(account);
}
