//! Which pixels the unit took up in a scene, and why: an instrument of the host.
//!
//! Duties: holds one [`Reason`] for each pixel of the last scene recorded. Inputs from: the unit. Outputs to: reports
//! and pictures. Clocks: none; an instrument is no unit of the card.

/// Why a pixel was taken up. Where several hold, the first of [`Reason::ALL`] from the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// It was not: the pixel is the hidden-surface path's.
    #[default]
    Untouched,
    /// A fragment covers a part of it.
    Edge,
    /// Two fragments cover all of it, and neither hides the other.
    Crossing,
    /// A translucent fragment is seen there.
    Layer,
    /// It would have been, but the pool had no room: the pixel is the hidden-surface path's.
    Degraded,
}

impl Reason {
    /// All of them.
    pub const ALL: [Reason; 5] = [Reason::Untouched, Reason::Edge, Reason::Crossing, Reason::Layer, Reason::Degraded];
}

/// The reasons of all pixels of a target.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SubpixelMap {
    /// Pixels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// A reason each, row by row from the top.
    pub reasons: Vec<Reason>,
}

impl SubpixelMap {
    /// A map of pixels that nothing took up.
    #[must_use]
    pub fn new(width: u32, height: u32) -> SubpixelMap {
        SubpixelMap { width, height, reasons: vec![Reason::Untouched; width as usize * height as usize] }
    }

    /// Reason of a pixel; [`Reason::Untouched`] outside.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Reason {
        let inside = x < self.width && y < self.height;
        if inside { self.reasons[(y * self.width + x) as usize] } else { Reason::Untouched }
    }

    /// Pixels with a reason.
    #[must_use]
    pub fn count(&self, reason: Reason) -> usize {
        self.reasons.iter().filter(|&&found| found == reason).count()
    }
}
