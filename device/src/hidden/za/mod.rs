//! Za unit: a Z buffer with one status word for each block of pixels.
//!
//! After JP H07-120435 B2 / US 5,870,095 (1990). A word stands for a block of the picture, as published
//! 32 pixels of a row, here of any width and height. Negative, it says that the block is logically cleared:
//! nothing was drawn there since the clear, and what memory holds of it means nothing. Else it is the exact
//! maximum of the block's depths. So a clear writes one word for each block and touches no pixel; a block
//! whose farthest pixel is nearer than the nearest that a primitive can have there is passed by after one
//! comparison; and scan-out shows the background where nothing was ever drawn.
//!
//! Duties: decides visibility and writes pixels, depths and words, primitive by primitive, block by block.
//! Inputs: primitives from set-up, a draw's state ([`ZaDraw`]), the background registers. Outputs: frame
//! buffer, Z buffer, Za words ([`Surfaces`]), events ([`ZaCounts`]).
//!
//! | file | part |
//! | --- | --- |
//! | [`grid`] | the blocks of a picture |
//! | [`prediction`] | the nearest that a primitive can be in a block: three ways |
//! | [`specification`] | what must come out, pixel by pixel |
//! | [`clocked`], `walk` | the unit register by register, a state a clock |
//! | [`band`], [`tile`], [`blocks`], [`kernel`], [`steps`], [`holes`] | the fast path: host tiles, sixteen pixels at a time |
//! | [`memory`] | clears; cleared blocks brought to memory; words taken from a Z buffer |
//!
//! # Visits
//! The *run* of a primitive in a block is what it covers there inside the scissor. Primitives come in order,
//! each visits every block in which it has a run:
//! * *Cleared*: all pixels of the block are written: where the run passes the depth test against the
//!   background's depth (a register; nothing is read) its colour, and its depth if depth is written; else the
//!   background. The word becomes the maximum of what was written. (As published the run is not tested, because
//!   nothing is farther than its clear depth; here the clear depth is any and so is the test.)
//! * *Initialised, no depth test*: the run is painted; the word stays.
//! * *Initialised, farther than the word*: if the prediction is greater than the word, and the test lets
//!   nothing farther pass, the block is bypassed. Equality never bypasses.
//! * *Initialised otherwise*: if depth is written the word is set to 0 and every pixel of the block read: those
//!   of the run are compared and written if they win, all feed the running maximum, which becomes the word.
//!   If depth is not written only the run is read and compared; the word stays.
//!
//! With a stencil test a fragment that is no hole is tested before its depth is; its verdict takes the place of the depth
//! test's above, and no block is bypassed whose fragments would change stencil values by failing. Where colours are off a
//! fragment that passes leaves the pixel its colour, and in a cleared block the background. Stencil values lie in memory
//! always: no Za word stands for them.
//!
//! Pixels of edge blocks that lie off the screen never count. Without a Z buffer an initialised block's
//! word is the greatest depth there is.
//!
//! # Clocks
//!
//! | clocks | for | why |
//! | --- | --- | --- |
//! | 2 | a span of a triangle | step the edges; load the interpolators, as on the plain Z buffer |
//! | 1 | a visit | the word is read |
//! | 1 | prediction block-length | an addition and the comparison; only where the block can be bypassed |
//! | 2 | prediction covered-run | a multiplication before |
//! | 1 + rows | prediction plane | the near end of each row before |
//! | 1 | a pixel initialised | colour and depth are written side by side |
//! | 1 | a depth read and compared, a pixel painted | one port |
//! | 1 | a stencil value read, compared and put back | one port |
//! | 1 | a pixel that wins, if anything of it is written | colour and depth are written side by side |
//! | 1 | a word written | |
//! | 1 | 16 words of a logical clear | a line of 64 bytes |
//!
//! # A worked example
//! 96 pixels in a row, three blocks of 32, 16 bits of depth, prediction block-length. Surface A covers columns
//! 0..=79, its depth is 100 + column. Surface B covers 8..=95, its depth is 227 - column: one nearer from each
//! pixel to the next, so a prediction takes 32 from the first covered depth of a block.
//!
//! | event | word 0 | word 1 | word 2 | clocks |
//! | --- | --- | --- | --- | --- |
//! | clear: 3 words | cleared | cleared | cleared | 1 |
//! | A: span | | | | 2 |
//! | A, block 0: initialised, 32 pixels of A: depths 100..=131 | 131 | | | 1 + 32 + 1 |
//! | A, block 1: initialised, 32 pixels of A: depths 132..=163 | | 163 | | 1 + 32 + 1 |
//! | A, block 2: initialised, 16 pixels of A, 16 of the background | | | 65535 | 1 + 32 + 1 |
//! | B: span | | | | 2 |
//! | B, block 0 from column 8: 219 - 32 = 187 > 131, 24 pixels bypassed | 131 | | | 1 + 1 |
//! | B, block 1: 195 - 32 = 163, not > 163: 32 compared, none wins | | 163 | | 1 + 1 + 32 + 0 + 1 |
//! | B, block 2: 163 - 32 = 131, not > 65535: 32 compared, all win | | | 163 | 1 + 1 + 32 + 32 + 1 |
//! | sum | | | | 211 |
//!
//! Prediction covered-run says 195 - 31 = 164 for block 1, which is the truth, and bypasses it as well: 3
//! clocks in place of 35, at one clock more for each other block of B. The tests follow this table.

pub mod band;
pub mod blocks;
pub mod clocked;
pub mod grid;
pub mod holes;
pub mod kernel;
pub mod memory;
pub mod prediction;
pub mod specification;
pub mod steps;
#[cfg(test)]
mod tests;
pub mod tile;
mod walk;

pub use grid::Grid;

use super::stencil::StencilCounts;
use super::z_buffer::band::Setting;
use super::z_buffer::{DepthTest, charge_shading};
use crate::pipeline::bands::Counts;
use crate::probe::account::{Account, Clocks};
use zga_abi::Counter;
use zga_abi::format::ZaPrediction;

/// The word of a block that is logically cleared, as this unit writes it. Any negative word counts as one.
pub const CLEARED: i32 = i32::MIN;

/// What the pixels of cleared blocks are taken to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Background {
    /// Pixel, as it is stored in the frame buffer.
    pub pixel: u32,
    /// Depth, 0 ..= 2^bits - 1.
    pub depth: i32,
}

/// What the Za unit knows of a draw.
#[derive(Clone, Debug)]
pub struct ZaDraw {
    /// What its pixels share.
    pub pixels: Setting,
    /// Blocks of the target.
    pub grid: Grid,
    /// The background registers.
    pub background: Background,
    /// How depths are predicted.
    pub prediction: ZaPrediction,
    /// Blocks behind the prediction are bypassed.
    pub bypass: bool,
    /// There is a Z buffer.
    pub depth_buffer: bool,
}

impl ZaDraw {
    /// The depth test; `None` where depth is not called for or there is no Z buffer.
    #[must_use]
    #[inline(always)]
    pub fn test(&self) -> Option<DepthTest> {
        self.pixels.test.filter(|_| self.depth_buffer)
    }

    /// Whether blocks can be bypassed: not where a farther pixel could win, as it may behind everything, nor where one that
    /// loses would leave its mark on the stencil plane.
    #[must_use]
    #[inline(always)]
    pub fn may_bypass(&self) -> bool {
        self.bypass
            && self.test().is_some_and(|test| !test.greater)
            && self.pixels.stencil.is_none_or(|stencil| !stencil.rule.marks_failures())
    }

    /// The word of an initialised block of which no depth is known to be nearer than the background's:
    /// that depth, or the format's maximum where there is no Z buffer.
    #[must_use]
    pub fn background_word(&self) -> i32 {
        if self.depth_buffer { self.background.depth.max(0) } else { self.pixels.format.maximum() as i32 }
    }
}

/// The memories of the Za path.
#[derive(Debug)]
pub struct Surfaces<'m> {
    /// Frame buffer.
    pub colour: &'m mut [u32],
    /// Z buffer; empty where there is none.
    pub depth: &'m mut [i32],
    /// Za words of the frame, one a block.
    pub words: &'m mut [i32],
    /// Stencil values; empty where no stencil test is called for.
    pub stencil: &'m mut [u8],
}

/// Events of a draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ZaCounts {
    /// Runs of pixels of one triangle on one row.
    pub spans: u64,
    /// Where the texture has holes: fragments that came to the test, those in blocks that were not bypassed.
    pub fragments: u64,
    /// Fragments among them that were holes.
    pub holes: u64,
    /// Events of the stencil test.
    pub stencil: StencilCounts,
    /// Fragments that passed stencil and depth test.
    pub passed: u64,
    /// Visits of cleared blocks.
    pub initialised: u64,
    /// Visits that the prediction ended.
    pub bypassed: u64,
    /// Fragments in bypassed blocks.
    pub pixels_bypassed: u64,
    /// Visits of initialised blocks whose pixels were looked at.
    pub compared: u64,
    /// Depths read.
    pub reads: u64,
    /// Depths written.
    pub depth_writes: u64,
    /// Pixels written.
    pub colour_writes: u64,
    /// Za words written.
    pub words_written: u64,
    /// Clocks of the unit.
    pub clocks: u64,
}

impl ZaCounts {
    /// The sum of two counts.
    #[must_use]
    pub fn plus(self, other: ZaCounts) -> ZaCounts {
        ZaCounts {
            spans: self.spans + other.spans,
            fragments: self.fragments + other.fragments,
            holes: self.holes + other.holes,
            stencil: self.stencil.plus(other.stencil),
            passed: self.passed + other.passed,
            initialised: self.initialised + other.initialised,
            bypassed: self.bypassed + other.bypassed,
            pixels_bypassed: self.pixels_bypassed + other.pixels_bypassed,
            compared: self.compared + other.compared,
            reads: self.reads + other.reads,
            depth_writes: self.depth_writes + other.depth_writes,
            colour_writes: self.colour_writes + other.colour_writes,
            words_written: self.words_written + other.words_written,
            clocks: self.clocks + other.clocks,
        }
    }

    /// Counts spans of triangles.
    #[inline(always)]
    pub fn count_spans(&mut self, spans: u64) {
        self.spans += spans;
        self.clocks += 2 * spans;
    }

    /// Counts the visit of a cleared block with `pixels` pixels on the screen, of which the primitive got `passed`.
    #[inline(always)]
    pub fn count_initialised(&mut self, pixels: u64, passed: u64, depth_buffer: bool) {
        self.initialised += 1;
        self.passed += passed;
        self.colour_writes += pixels;
        self.depth_writes += if depth_buffer { pixels } else { 0 };
        self.words_written += 1;
        self.clocks += 1 + pixels + 1;
    }

    /// Counts the visit of a block that is bypassed with `run` covered pixels after `prediction` clocks.
    #[inline(always)]
    pub fn count_bypassed(&mut self, run: u64, prediction: u64) {
        self.bypassed += 1;
        self.pixels_bypassed += run;
        self.clocks += 1 + prediction;
    }

    /// Counts the visit of an initialised block without a depth test: `run` covered pixels, of which `painted` are no
    /// holes and passed; these are written if there are `colours`.
    #[inline(always)]
    pub fn count_painted(&mut self, run: u64, painted: u64, colours: bool) {
        self.compared += 1;
        self.passed += painted;
        self.colour_writes += if colours { painted } else { 0 };
        self.clocks += 1 + run;
    }

    /// Counts the visit of an initialised block that was not bypassed: `run` covered pixels, of which
    /// `passed` won, or all `pixels` of the block where depth is written. `prediction` clocks were spent
    /// in vain.
    #[inline(always)]
    pub fn count_compared(&mut self, write: bool, pixels: u64, run: u64, passed: u64, prediction: u64, colours: bool) {
        let reads = if write { pixels } else { run };
        self.compared += 1;
        self.passed += passed;
        self.reads += reads;
        self.depth_writes += if write { passed } else { 0 };
        self.colour_writes += if colours { passed } else { 0 };
        self.words_written += u64::from(write);
        let written = if colours || write { passed } else { 0 };
        self.clocks += 1 + prediction + reads + written + u64::from(write);
    }
}

impl Counts for ZaCounts {
    fn plus(self, other: ZaCounts) -> ZaCounts {
        ZaCounts::plus(self, other)
    }
}

/// Charges the events of a draw.
pub fn charge(counts: &ZaCounts, draw: &ZaDraw, account: &mut Account) {
    account.add(Counter::ZSpans, counts.spans);
    account.add(Counter::ZReads, counts.reads);
    account.add(Counter::ZWrites, counts.depth_writes);
    account.add(Counter::ColourWrites, counts.colour_writes);
    account.add(Counter::ZaWordsWritten, counts.words_written);
    account.add(Counter::ZaBlocksInitialised, counts.initialised);
    account.add(Counter::ZaBlocksBypassed, counts.bypassed);
    account.add(Counter::ZaPixelsBypassed, counts.pixels_bypassed);
    account.add(Counter::ZaBlocksCompared, counts.compared);
    account.charge(Counter::CyclesZa, Clocks(counts.clocks));
    counts.stencil.charge(account);
    charge_shading(if draw.pixels.draws_colours() { counts.passed } else { 0 }, &draw.pixels, account);
    draw.pixels.looked_up(counts.fragments, counts.holes).charge(account);
}
