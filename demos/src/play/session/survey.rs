//! Looking into the units: Za words, and the work of a part of the picture.
//!
//! Duties: reads the Za words of the frame over the bus; draws the frame once more with its draws cut to an area and
//! reads what that cost. The unit's own counters so tell where in the picture the work is, without a model of it on
//! this side. Inputs from: the session's last frame. Outputs to: [`crate::paths`].

use zga_abi::Bus;
use zga_abi::Reg;
use zga_abi::bus::ZA_BASE;
use zga_abi::format::HiddenSurface;
use zga_device::Card;
use zga_driver::{Counters, Rectangle};

use super::Session;
use crate::error::{Error, Result};

/// Za words of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ZaWords {
    /// Width and height of a block, pixels.
    pub block: [u32; 2],
    /// Blocks in a row, rows of blocks.
    pub blocks: [u32; 2],
    /// A word a block, row by row from the top: negative is logically cleared, else the farthest depth in the block.
    pub words: Vec<i32>,
}

impl ZaWords {
    /// The word of the block that pixel (`x`, `y`) lies in; `None` outside.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Option<i32> {
        let [column, row] = [x / self.block[0], y / self.block[1]];
        let inside = column < self.blocks[0] && row < self.blocks[1];
        inside.then(|| self.words.get((row * self.blocks[0] + column) as usize).copied()).flatten()
    }

    /// Pixels of a picture of this size that lie in cleared blocks.
    #[must_use]
    pub fn cleared_pixels(&self, [width, height]: [u32; 2]) -> u64 {
        let side = |at: u32, block: u32, size: u32| u64::from(size.saturating_sub(at * block).min(block));
        let cleared = (0_u32..).zip(&self.words).filter(|(_, word)| **word < 0);
        cleared
            .map(|(index, _)| {
                let [column, row] = [index % self.blocks[0], index / self.blocks[0]];
                side(column, self.block[0], width) * side(row, self.block[1], height)
            })
            .sum()
    }
}

impl<B: Bus> Session<B> {
    /// The card.
    #[must_use]
    pub const fn card(&self) -> &Card {
        &self.card
    }

    /// Za words of the frame that was drawn last; `None` on the other paths, and before the first frame.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn za_words(&mut self) -> Result<Option<ZaWords>> {
        if self.settings.hidden_surface != HiddenSurface::Za || self.view.is_none() {
            return Ok(None);
        }
        self.driver.finish().map_err(Error::driver(&self.name))?;
        let block = self.settings.za.block;
        let blocks = [0, 1].map(|axis| self.size[axis].div_ceil(block[axis]));
        let bus = self.driver.bus_mut();
        let base = bus.read32(Reg::ZaBase.offset());
        let mut words = vec![0; blocks[0] as usize * blocks[1] as usize];
        bus.read_burst(ZA_BASE + base, &mut words);
        let words = words.into_iter().map(u32::cast_signed).collect();
        Ok(Some(ZaWords { block, blocks, words }))
    }

    /// Draws the last frame once more, with all its draws cut to `area`, and returns what that cost; nothing before the
    /// first frame. The clear is not cut. The picture on the screen stays; the frame buffer behind it does not.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn cost_of(&mut self, area: Rectangle) -> Result<Option<Counters>> {
        let Some(view) = self.view else {
            return Ok(None);
        };
        self.driver.clear_counters();
        self.encode(view, Some(area))?;
        self.driver.finish().map_err(Error::driver(&self.name))?;
        Ok(Some(self.driver.counters()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: [i32; 6] = [-1, 5, i32::MIN, 0, -7, 9];

    #[test]
    fn cleared_pixels_of_blocks_at_the_edges_are_those_on_the_screen() {
        let words = ZaWords { block: [4, 2], blocks: [3, 2], words: WORDS.to_vec() };
        // 10 x 3 pixels: block 0 has 4 x 2, block 2 has 2 x 2, block 4 has 4 x 1.
        assert_eq!(words.cleared_pixels([10, 3]), 8 + 4 + 4);
    }

    #[test]
    fn at_outside_is_none() {
        let words = ZaWords { block: [4, 2], blocks: [3, 2], words: WORDS.to_vec() };
        assert_eq!([(3, 1), (4, 1), (8, 0), (4, 2)].map(|(x, y)| words.at(x, y)), [-1, 5, i32::MIN, -7].map(Some));
        assert_eq!([(12, 0), (0, 4)].map(|(x, y)| words.at(x, y)), [None, None]);
    }
}
