//! The card's units as the firmware sees them.

use crate::checked::{
    Clear, Combine, Compose, Convert, Copy, CopyList, Draw, DrawState, ExpandList, Fill, FillList, Rows, SegmentList,
    Shadow, Stretch, Target, Words,
};
use zga_abi::{Reg, Units};

/// Why a unit stopped before its work was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// The packet took longer than the WATCHDOG register allows.
    Watchdog,
    /// The host is resetting the card.
    Reset,
    /// The scene has more primitives than a unit can hold back until its end.
    SceneFull,
}

/// The units of a card, as its command processor programs them.
///
/// Every argument has been checked; see [`crate::checked`] for what holds.
pub trait Hardware {
    /// Value of word `word` of a register; side effects of a bus read do not take place.
    fn register(&self, register: Reg, word: u32) -> u32;

    /// Sets word `word` of a register; access and masks have been applied.
    fn set_register(&mut self, register: Reg, word: u32, value: u32);

    /// Powers exactly these units. A unit that loses power gives its memory back.
    fn power(&mut self, units: Units);

    /// Begins a scene.
    fn begin_scene(&mut self, target: &Target);

    /// Ends the scene: everything drawn is in memory when this returns. With a `shadow`, which comes only where the
    /// target has a stencil plane, pixels in shadow are darkened after the opaque picture and before layers.
    ///
    /// # Errors
    /// [`Stopped`] if it took too long or the host resets the card.
    fn end_scene(&mut self, shadow: Option<&Shadow>) -> Result<(), Stopped>;

    /// Clears planes of the target.
    fn clear(&mut self, clear: &Clear);

    /// Draws.
    ///
    /// # Errors
    /// [`Stopped`] if it took too long or the host resets the card; what was drawn stays.
    fn draw(&mut self, state: &DrawState, draw: &Draw<'_>) -> Result<(), Stopped>;

    /// The largest of a run of indices, and its place in the run; `None` for an empty one.
    fn largest_index(&mut self, indices: &Words<'_>) -> Option<(u32, u32)>;

    /// Fills a rectangle.
    fn fill(&mut self, fill: &Fill);

    /// Copies a rectangle.
    fn copy(&mut self, copy: &Copy);

    /// Combines a value or a rectangle with what is there.
    fn combine(&mut self, combine: &Combine);

    /// Copies a rectangle into another format.
    fn convert(&mut self, convert: &Convert);

    /// Stretches a rectangle to another size.
    fn stretch(&mut self, stretch: &Stretch);

    /// Fills rectangles.
    fn fill_list(&mut self, fill: &FillList<'_>);

    /// Copies rectangles.
    fn copy_list(&mut self, copy: &CopyList<'_>);

    /// Draws lines of single pixels.
    fn segments(&mut self, segments: &SegmentList<'_>);

    /// Draws bitmaps of 1 bit a pixel.
    fn expand(&mut self, expand: &ExpandList<'_>);

    /// Composes rectangles.
    fn compose(&mut self, compose: &Compose<'_>);

    /// Writes `words` to rows in video memory; `words` has `rows.words * rows.rows` of them.
    fn upload(&mut self, rows: &Rows, words: &[u32]);

    /// Gathers rows into a dense run at byte `destination`.
    fn download(&mut self, rows: &Rows, destination: u32);

    /// Everything before it is done: stores the sequence number, raises the fence interrupt.
    fn fence(&mut self, sequence: u32);

    /// Shows the frame at byte `base` from the next vertical blank on; returns when it has begun.
    fn present(&mut self, base: u32);

    /// Composes the frame shown into dense XRGB8888 rows at byte `destination`.
    fn write_back(&mut self, destination: u32);

    /// A packet of `words` words was taken from ring or FIFO.
    fn packet_taken(&mut self, words: u32);
}
