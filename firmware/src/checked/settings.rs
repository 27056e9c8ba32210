//! Settings of the hidden-surface paths and of the sub-pixel unit.

use zga_abi::format::{
    EndTest, SubpixelDepth, SubpixelEdges, SubpixelGrid, SubpixelResolve, TokenColour, TokenPorts, ZaPrediction,
};

/// The Za unit's registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ZaSetting {
    /// First word in Za RAM, a multiple of 16.
    pub base: u32,
    /// Width and height of a block, pixels, each 1..=16384.
    pub block: [u32; 2],
    /// How the least depth of a primitive in a block is predicted.
    pub prediction: ZaPrediction,
    /// Blocks behind the prediction are bypassed.
    pub bypass: bool,
}

impl Default for ZaSetting {
    /// As published: blocks of 32 pixels of a row, prediction over the length of a block.
    fn default() -> Self {
        ZaSetting { base: 0, block: [32, 1], prediction: ZaPrediction::BlockLength, bypass: true }
    }
}

impl ZaSetting {
    /// Blocks across and down a picture of `width` x `height` pixels; those at the edges are cut by it.
    #[must_use]
    pub const fn blocks(&self, width: u32, height: u32) -> [u32; 2] {
        [width.div_ceil(self.block[0]), height.div_ceil(self.block[1])]
    }
}

/// The variant of the systolic array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SystolicSetting {
    /// When a segment begins or ends.
    pub end_test: EndTest,
    /// How X and dX enter.
    pub ports: TokenPorts,
    /// What a token carries for the picture.
    pub colour: TokenColour,
    /// The earlier design, Super Buffer, in place of the array.
    pub super_buffer: bool,
}

impl Default for SystolicSetting {
    fn default() -> Self {
        SystolicSetting {
            end_test: EndTest::Negative,
            ports: TokenPorts::Swapped,
            colour: TokenColour::Tag,
            super_buffer: false,
        }
    }
}

/// The sub-pixel mask unit's registers, where there is a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SubpixelSetting {
    /// Samples of a pixel; never [`SubpixelGrid::Off`].
    pub grid: SubpixelGrid,
    /// How fragments that share samples are ordered.
    pub depth: SubpixelDepth,
    /// Space in which samples are averaged.
    pub resolve: SubpixelResolve,
    /// Fragments that the lists of one line of pixels have room for, 1..=2^20.
    pub pool: u32,
    /// Which edges are anti-aliased.
    pub edges: SubpixelEdges,
}
