//! Accuracy by name: settings that belong together.
//!
//! Duties: says what each preset stands for, and sets a driver and a target up so. Inputs from: the user. Outputs to:
//! [`Driver::set_subpixel_bits`], [`Driver::set_antialias`], [`TargetOptions`]. What each costs, and how far its pictures
//! are from the true ones, is measured: `zga accuracy presets`.

use zga_abi::bus::Bus;
use zga_abi::format::{DepthFormat, SubpixelDepth, SubpixelGrid};

use crate::{Antialias, Driver, DriverError, TargetOptions};

/// Settings of accuracy that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Preset {
    /// The cheapest picture: one sample a pixel. Depths of 24 bits with 24 fraction bits and vertices on 1/256 pixel, since
    /// coarser ones cost the card as many clocks.
    Draft,
    /// For looking at: 4x4 samples at every edge, each with a depth of its own, of 24 bits with 24 fraction bits, 1/256 pixel.
    Standard,
    /// All the card has: 8x8 samples at every edge, each with a depth of its own, of 31 bits with 24 fraction bits, 1/256 pixel.
    Exact,
}

impl Preset {
    /// All three, from the cheapest to the most exact.
    pub const ALL: &'static [Preset] = &[Preset::Draft, Preset::Standard, Preset::Exact];

    /// The preset's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Preset::Draft => "draft",
            Preset::Standard => "standard",
            Preset::Exact => "exact",
        }
    }

    /// Samples of a pixel, and how fragments that share them are ordered.
    #[must_use]
    pub fn antialias(self) -> Antialias {
        let (grid, depth) = match self {
            Preset::Draft => (SubpixelGrid::Off, SubpixelDepth::Centre),
            Preset::Standard => (SubpixelGrid::Grid4x4, SubpixelDepth::Exhaustive),
            Preset::Exact => (SubpixelGrid::Grid8x8, SubpixelDepth::Exhaustive),
        };
        Antialias { grid, depth, ..Antialias::default() }
    }

    /// Number format of depth.
    #[must_use]
    pub fn depth(self) -> DepthFormat {
        let [bits, fraction] = match self {
            Preset::Draft | Preset::Standard => [24, 24],
            Preset::Exact => [31, 24],
        };
        DepthFormat::new(bits, fraction).unwrap_or_default()
    }

    /// Bits of a pixel that coordinates are snapped to.
    #[must_use]
    pub const fn subpixel_bits(self) -> u32 {
        match self {
            Preset::Draft | Preset::Standard | Preset::Exact => 8,
        }
    }
}

impl TargetOptions {
    /// A target of this size with the depth format of a preset.
    #[must_use]
    pub fn with_preset(width: u32, height: u32, preset: Preset) -> TargetOptions {
        TargetOptions { depth: Some(preset.depth()), ..TargetOptions::new(width, height) }
    }
}

impl<B: Bus> Driver<B> {
    /// Opens the card on `bus` set to a preset; targets for it are made with [`TargetOptions::with_preset`].
    ///
    /// # Errors
    /// As [`Driver::open`] and [`Driver::set_preset`].
    pub fn open_with_preset(bus: B, preset: Preset) -> Result<Driver<B>, DriverError> {
        let mut driver = Driver::open(bus)?;
        driver.set_preset(preset)?;
        Ok(driver)
    }

    /// Sets anti-aliasing and the grid of coordinates as a preset has them, from the next begin scene on. The depth format
    /// is the target's: [`TargetOptions::with_preset`].
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] for samples on a card without a sub-pixel unit.
    pub fn set_preset(&mut self, preset: Preset) -> Result<(), DriverError> {
        self.set_subpixel_bits(preset.subpixel_bits())?;
        let antialias = Some(preset.antialias()).filter(|antialias| antialias.grid != SubpixelGrid::Off);
        self.set_antialias(antialias)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zga_abi::format::SubpixelEdges;

    #[test]
    fn presets_have_formats_that_there_are_and_names_of_their_own() {
        let formats: Vec<_> = Preset::ALL.iter().map(|p| (p.name(), p.depth().bits(), p.depth().fraction())).collect();
        assert_eq!(formats, [("draft", 24, 24), ("standard", 24, 24), ("exact", 31, 24)]);
        assert_eq!(TargetOptions::with_preset(8, 8, Preset::Exact).depth, Some(Preset::Exact.depth()));
        let edges: Vec<_> = Preset::ALL.iter().map(|preset| preset.antialias().edges).collect();
        assert_eq!(edges, [SubpixelEdges::All; 3]);
    }
}
