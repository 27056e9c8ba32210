//! Uniform depths: bands of the Z buffer that still hold what the last clear wrote.
//!
//! Where nothing was drawn since, clearing again to the same depth changes nothing, and the host need
//! not do it. The card's own clear writes every word; its counts and clocks do not change.

use super::span;
use super::tile::TILE;
use std::ops::Range;
use zga_firmware::checked::{DepthSurface, Target};

/// What is known of one Z buffer.
#[derive(Debug)]
pub struct Uniform {
    surface: DepthSurface,
    size: [u32; 2],
    value: u32,
    /// Bands of [`TILE`] rows that hold nothing but `value`.
    bands: Vec<bool>,
    /// Changes by others when this became known.
    foreign: u64,
}

impl Uniform {
    /// Nothing but the target is known: no band is uniform.
    fn unknown(target: &Target, surface: DepthSurface, value: u32) -> Uniform {
        let size = [target.colour.width, target.colour.height];
        Uniform { surface, size, value, bands: vec![false; (size[1] as usize).div_ceil(TILE)], foreign: 0 }
    }

    /// What of `known` still holds before all of the target's depths are cleared to `value`.
    #[must_use]
    pub fn before_clear(
        known: Option<Uniform>,
        target: &Target,
        surface: DepthSurface,
        value: u32,
        foreign: u64,
    ) -> Uniform {
        match known {
            Some(known) if known.is_of(target) && known.value == value && known.foreign == foreign => known,
            _ => Uniform::unknown(target, surface, value),
        }
    }

    /// After such a clear every band is uniform; `foreign` is the count of others' changes.
    pub fn cleared(&mut self, foreign: u64) {
        self.bands.fill(true);
        self.foreign = foreign;
    }

    /// Whether this is the Z buffer of `target`.
    #[must_use]
    pub fn is_of(&self, target: &Target) -> bool {
        target.depth == Some(self.surface) && self.size == [target.colour.width, target.colour.height]
    }

    /// Whether row `y` holds nothing but the value.
    #[must_use]
    pub fn holds(&self, y: usize) -> bool {
        self.bands[y / TILE]
    }

    /// Depths may be written in bands `bands`.
    pub fn drawn(&mut self, bands: Range<usize>) {
        self.bands[bands].fill(false);
    }

    /// Words of the Z buffer.
    #[must_use]
    pub fn words(&self) -> Range<usize> {
        let [first, beyond] = span(self.surface.base, self.surface.pitch, self.size[1]);
        first..beyond
    }
}
