//! Looking into the units: Za words, the pixels of the sub-pixel unit, and the work of a part of the picture.
//!
//! Duties: reads the Za words of the frame over the bus; draws the frame once more while the card notes what the
//! sub-pixel unit takes up, or with its draws cut to an area, and reads what that cost. The unit's own counters so
//! tell where in the picture the work is, without a model of it on this side. Inputs from: the session's last frame.
//! Outputs to: [`crate::paths`].

use zga_abi::Bus;
use zga_abi::Reg;
use zga_abi::bus::ZA_BASE;
use zga_abi::format::HiddenSurface;
use zga_device::{Card, SubpixelMap};
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

    /// Which pixels of the last frame the sub-pixel unit took up, and why: draws the frame once more while the card
    /// notes them. A unit that was not called took up none; `None` without a grid of samples, and before the first
    /// frame. The picture on the screen stays; the frame buffer behind it does not.
    ///
    /// # Errors
    /// [`Error::Driver`]; [`Error::Card`] where the card's thread is gone.
    pub fn subpixels(&mut self) -> Result<Option<SubpixelMap>> {
        let Some(view) = self.view.clone().filter(|_| self.settings.is_antialiased()) else {
            return Ok(None);
        };
        let fault = |name: &str| Error::driver(name.to_owned());
        let gone = |name: &str| {
            let place = name.to_owned();
            move |reason| Error::Card { place, reason }
        };
        // A scene that is at work still would be noted in place of this one.
        self.driver.finish().map_err(fault(&self.name))?;
        self.card.record_subpixels().map_err(gone(&self.name))?;
        self.encode(&view, None)?;
        self.driver.finish().map_err(fault(&self.name))?;
        let map = self.card.take_subpixels().map_err(gone(&self.name))?;
        Ok(Some(map.unwrap_or_else(|| SubpixelMap::new(self.size[0], self.size[1]))))
    }

    /// Draws the last frame once more, with all its draws cut to `area`, and returns what that cost; nothing before the
    /// first frame. The clear is not cut. The picture on the screen stays; the frame buffer behind it does not.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn cost_of(&mut self, area: Rectangle) -> Result<Option<Counters>> {
        let Some(view) = self.view.clone() else {
            return Ok(None);
        };
        self.driver.clear_counters();
        self.encode(&view, Some(area))?;
        self.driver.finish().map_err(Error::driver(&self.name))?;
        Ok(Some(self.driver.counters()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demos;
    use crate::play::{Asked, Look};
    use crate::scene::{CardSettings, SubpixelGrid};
    use zga_device::Reason;

    /// The map of a demo's first frame at a small size, as `card` has it.
    fn mapped(demo: &str, card: CardSettings) -> Option<SubpixelMap> {
        let mut scene = demos::find(demo).expect("a demo").build(0);
        scene.size = [200, 150];
        let mut session = Session::open(demo, &scene, &Asked { card, ..Asked::default() }).expect("a card");
        assert_eq!(session.subpixels().expect("a card"), None, "there is no frame yet");
        let (frame, _) = session.frame(&scene, Look::default()).expect("drawn");
        let map = session.subpixels().expect("drawn");
        let (again, _) = session.frame(&scene, Look::default()).expect("drawn");
        assert_eq!(frame.hash, again.hash, "noting leaves no trace");
        map
    }

    #[test]
    fn subpixels_are_as_many_as_pixels_and_none_without_a_grid() {
        let map = mapped("crossing", CardSettings::default()).expect("the demo has a grid");
        assert_eq!((map.width, map.height, map.reasons.len()), (200, 150, 200 * 150));
        assert_eq!(mapped("crossing", CardSettings { antialias: Some(SubpixelGrid::Off), ..Default::default() }), None);
    }

    #[test]
    fn subpixels_of_the_demos_have_the_reasons_that_they_are_made_for() {
        let count = |demo, card, reason| mapped(demo, card).map_or(0, |map| map.count(reason));
        let plain = CardSettings::default();
        assert!(count("crossing", plain, Reason::Crossing) > 50);
        assert!(count("spokes", plain, Reason::Edge) > 50);
        assert!(count("layers", plain, Reason::Layer) > 500);
        assert_eq!(count("crossing", plain, Reason::Layer) + count("crossing", plain, Reason::Degraded), 0);
        let small = CardSettings { subpixel_pool: Some(500), ..plain };
        assert!(count("layers", small, Reason::Degraded) > 50);
    }

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
