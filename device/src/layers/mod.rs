//! The layer unit: translucent primitives where a pixel has one sample.
//!
//! A primitive that may be translucent cannot be drawn when it comes: what lies behind it may come later. So it waits,
//! whatever path decides what is hidden, until the opaque picture is done: when the scene ends, or before depths alone
//! are cleared. Then each of its fragments is tested by its own depth function against the opaque depth of its pixel; no
//! depth is stored; and those that pass are composed over the pixel's colour from the farthest to the nearest, equal depths in
//! order of submission, layers without a depth test as the nearest of all. The picture depends on no path and no tile
//! size. With a SUBPIXEL_GRID layers are the business of [`crate::subpixel`].
//!
//! An opaque primitive without a depth test lies over what came before it, layers too: where it covers a pixel, the layers
//! that wait there are taken back. A clear that writes colours takes back the layers that wait in its pixels: nobody will see them. One of depths alone
//! lets them be seen first: what waits in its pixels is composed before it.
//!
//! A layer with a stencil test is tested against the plane as the opaque picture left it, before its depth is; no layer
//! changes a stencil value. What is opaque and has a stencil test takes no layer back, since the plane has gone on by then.
//!
//! | file | part |
//! | --- | --- |
//! | [`blend`] | one layer over one colour |
//! | [`piece`] | an item set up: edges, depths, colours |
//! | [`canvas`] | the pixels of a host tile, decoded |
//! | [`tile`] | a tile whose layers have one order |
//! | [`pixels`] | any other tile, pixel by pixel |
//! | [`specification`] | all of it by definition |
//! | [`mod@unit`] | tiles in bands on threads |
//!
//! Inputs from: [`crate::subpixel::scene`], frame buffer and depths of the opaque picture. Outputs to: frame buffer.
//!
//! # Clocks
//! 1 a fragment tested, 1 more one with a stencil test, 1 a fragment blended, 1 a comparison. Each fragment that passed is compared with the one that
//! passed before it at its pixel: with n of them that is n - 1. Where they did not come in the order in which they are
//! composed, each is compared with each other, n (n - 1) / 2 in all, which gives it its rank. An interpolated colour is 1
//! clock of the shading unit. Levels are of 8 bits from layer to layer; a pixel is read and written once, in the clocks of
//! its fragments.

pub mod blend;
pub mod canvas;
pub mod piece;
pub mod pixels;
pub mod specification;
#[cfg(test)]
mod tests;
pub mod tile;
pub mod unit;

use crate::hidden::stencil::StencilCounts;
use crate::probe::account::{Account, Clocks};
use crate::shading::pixel::ShadingCounts;
use crate::subpixel::scene::ItemDraw;
use piece::Pixels;
use zga_abi::Counter;
use zga_abi::format::{DepthFormat, PixelFormat};

/// What all tiles of a scene share.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Number format of depth.
    pub format: DepthFormat,
    /// Format of the frame buffer.
    pub pixel_format: PixelFormat,
    /// Words from a row of the frame buffer to the next.
    pub colour_pitch: usize,
    /// Words from a row of depths to the next: a multiple of 16. 0 where there are none.
    pub depth_pitch: usize,
    /// Pixels that may change, inside the target.
    pub area: Pixels,
    /// Bytes from a row of stencil values to the next; 0 where there are none.
    pub stencil_pitch: usize,
}

/// Events of the unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Fragments that came to the depth test, or to the stencil test before it.
    pub fragments: u64,
    /// Events of the stencil test.
    pub stencil: StencilCounts,
    /// Fragments that passed and were blended.
    pub blended: u64,
    /// Pixels whose fragments did not come in order.
    pub sorted_pixels: u64,
    /// Comparisons of depths of fragments.
    pub comparisons: u64,
    /// Pixels written.
    pub pixels: u64,
    /// Pixels shaded: colours interpolated, or taken through more.
    pub shaded: u64,
    /// What they cost beyond interpolated colours.
    pub shading: ShadingCounts,
}

impl crate::pipeline::bands::Counts for Counts {
    fn plus(self, other: Counts) -> Counts {
        Counts {
            fragments: self.fragments + other.fragments,
            stencil: self.stencil.plus(other.stencil),
            blended: self.blended + other.blended,
            sorted_pixels: self.sorted_pixels + other.sorted_pixels,
            comparisons: self.comparisons + other.comparisons,
            pixels: self.pixels + other.pixels,
            shaded: self.shaded + other.shaded,
            shading: self.shading.plus(other.shading),
        }
    }
}

impl Counts {
    /// Counts that the colours of `pixels` pixels of a draw were made.
    fn count_shaded(&mut self, draw: &ItemDraw, pixels: u64) {
        if draw.is_shaded() {
            self.shaded += pixels;
        }
        if let Some(shading) = &draw.shading {
            self.shading = self.shading.plus(shading.pixel.cost().times(pixels));
        }
    }

    /// Clocks of the unit, without shading.
    #[must_use]
    pub fn clocks(&self) -> Clocks {
        Clocks(self.fragments + self.stencil.tested + self.blended + self.comparisons)
    }
}

/// Charges the events of a composition.
pub fn charge(counts: &Counts, account: &mut Account) {
    account.add(Counter::LayersFragments, counts.fragments);
    account.add(Counter::LayersBlended, counts.blended);
    account.add(Counter::LayersSortedPixels, counts.sorted_pixels);
    account.charge(Counter::CyclesLayers, counts.clocks());
    account.add(Counter::ColourWrites, counts.pixels);
    account.add(Counter::ShadingPixels, counts.shaded);
    account.charge(Counter::CyclesShading, Clocks(counts.shaded));
    counts.shading.charge(account);
    counts.stencil.charge(account);
}
