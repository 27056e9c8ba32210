//! How visibility is decided: the registers from HIDDEN_SURFACE to TILE_SIZE.

use std::fmt;

/// Hidden-surface path; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Path {
    /// Plain Z buffer.
    #[default]
    ZBuffer = 0,
    /// Z buffer with a status word for each block.
    Za = 1,
    /// Systolic scan-line array.
    Systolic = 2,
    /// Tiles found by a Y, then X sort.
    Tile = 3,
}

impl Path {
    /// All four.
    pub const ALL: [Self; 4] = [Self::ZBuffer, Self::Za, Self::Systolic, Self::Tile];

    /// Whether depth can be tested without a Z buffer.
    #[must_use]
    pub const fn keeps_depths(self) -> bool {
        matches!(self, Self::Systolic | Self::Tile)
    }
}

/// How the least depth in a block is predicted; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Prediction {
    /// Over the whole length of a block.
    #[default]
    BlockLength = 0,
    /// Over the covered pixels.
    CoveredRun = 1,
    /// The least depth there really is.
    Plane = 2,
}

impl Prediction {
    /// All three.
    pub const ALL: [Self; 3] = [Self::BlockLength, Self::CoveredRun, Self::Plane];
}

/// Bit 0 of SYSTOLIC_VARIANT: a segment begins and ends where A - 1 is zero.
pub const END_AT_ZERO: u32 = 1;
/// Bit 1: X and dX share port A.
pub const PORTS_MERGED: u32 = 2;
/// Bit 2: tokens carry colours.
pub const COLOUR_VALUE: u32 = 4;
/// Bit 3: the earlier design.
pub const SUPER_BUFFER: u32 = 8;

/// The registers; sampled by BEGIN_SCENE.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Hidden {
    /// Who decides.
    pub path: Path,
    /// Register by register instead of functional.
    pub clocked: bool,
    /// Width and height of a Za block, pixels.
    pub block: [u32; 2],
    /// How depths are predicted.
    pub prediction: Prediction,
    /// Blocks are bypassed.
    pub bypass: bool,
    /// First byte in Za RAM, a multiple of 64.
    pub base: u32,
    /// The second frame's words lie behind those of the first, not in their place.
    pub apart: bool,
    /// SYSTOLIC_VARIANT.
    pub variant: u32,
    /// Width and height of a tile, pixels.
    pub tile: [u32; 2],
}

impl Default for Hidden {
    /// The plain Z buffer; the others as the card resets them.
    fn default() -> Self {
        Self {
            path: Path::ZBuffer,
            clocked: false,
            block: [32, 1],
            prediction: Prediction::BlockLength,
            bypass: true,
            base: 0,
            apart: true,
            variant: 0,
            tile: [8, 8],
        }
    }
}

impl fmt::Debug for Hidden {
    /// What matters on the path.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, block, prediction, base, variant, tile, .. } = self;
        write!(f, "{path:?}{}", if self.clocked { " clocked" } else { "" })?;
        let bypass = if self.bypass { "" } else { ", no bypass" };
        match path {
            Path::ZBuffer => Ok(()),
            Path::Za => write!(f, " {}x{} {prediction:?}{bypass} at {base:#x}", block[0], block[1]),
            Path::Systolic => write!(f, " variant {variant}"),
            Path::Tile => write!(f, " {}x{}", tile[0], tile[1]),
        }
    }
}

impl Hidden {
    /// A path with the card's reset values.
    #[must_use]
    pub fn on(path: Path) -> Self {
        Self { path, ..Self::default() }
    }

    /// The Za path with blocks of this width and height.
    #[must_use]
    pub fn za(block: [u32; 2]) -> Self {
        Self { block, ..Self::on(Path::Za) }
    }

    /// The systolic path in a variant.
    #[must_use]
    pub fn systolic(variant: u32) -> Self {
        Self { variant, ..Self::on(Path::Systolic) }
    }

    /// The tile path with tiles of this width and height.
    #[must_use]
    pub fn tile(tile: [u32; 2]) -> Self {
        Self { tile, ..Self::on(Path::Tile) }
    }

    /// The same, stepped register by register.
    #[must_use]
    pub const fn clocked(self) -> Self {
        Self { clocked: true, ..self }
    }

    /// Words of Za RAM for a target of this size.
    #[must_use]
    pub const fn za_words(&self, width: u32, height: u32) -> u32 {
        width.div_ceil(self.block[0]) * height.div_ceil(self.block[1])
    }

    /// The same for the second frame of a target of this size.
    #[must_use]
    pub const fn of_second_frame(self, width: u32, height: u32) -> Self {
        let bytes = if self.apart { (4 * self.za_words(width, height)).next_multiple_of(64) } else { 0 };
        Self { base: self.base + bytes, ..self }
    }

    /// HIDDEN_SURFACE to TILE_SIZE.
    #[must_use]
    pub const fn words(&self, subpixel_bits: u32) -> [u32; 8] {
        [
            self.path as u32,
            subpixel_bits,
            self.clocked as u32,
            self.block[1] << 16 | self.block[0],
            self.prediction as u32 | (!self.bypass as u32) << 8,
            self.base,
            self.variant,
            self.tile[1] << 16 | self.tile[0],
        ]
    }
}
