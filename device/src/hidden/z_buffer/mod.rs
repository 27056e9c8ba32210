//! Plain Z buffer: each fragment's depth is compared with the one stored for its pixel.
//!
//! Duties: depth test and depth write for every covered pixel, colour write for every one that
//! passes; clears. Inputs: set-up primitives from [`crate::geometry`]. Outputs: frame buffer and
//! Z buffer in video memory.
//!
//! Clocks: 2 a span (edge walk and address), 1 a depth read and compared, 1 a depth and colour
//! written (one port, 64 bits wide); a clear writes 16 words of one plane a clock.
//!
//! The host goes another way to the same bits and counts: visibility of all primitives of a draw
//! tile by tile, colours once at the end of a tile, bands of tiles on several threads. [`specification`]
//! is the way the card itself would go.

pub mod band;
pub mod bins;
pub mod kernel;
pub mod specification;
pub mod tile;
pub mod uniform;

use crate::probe::account::{Account, Clocks};
use zga_abi::Counter;
use zga_abi::format::{DepthFunction, PixelFormat};
use zga_firmware::checked::{Clear, Rectangle, Target};

use crate::shading::plane::Interpolation;
use band::Setting;
use tile::TileCounts;
use uniform::Uniform;

/// A depth function as the three outcomes that pass, and whether passing depths are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthTest {
    /// Nearer passes.
    pub less: bool,
    /// Equal passes.
    pub equal: bool,
    /// Farther passes.
    pub greater: bool,
    /// A passing depth is stored.
    pub write: bool,
}

impl DepthTest {
    /// Strictly nearer passes and is stored.
    pub const LESS: DepthTest = DepthTest { less: true, equal: false, greater: false, write: true };
    /// Everything passes, nothing is stored.
    pub const ALWAYS: DepthTest = DepthTest { less: true, equal: true, greater: true, write: false };

    /// The test of a draw.
    #[must_use]
    pub fn new(function: DepthFunction, write: bool) -> DepthTest {
        use DepthFunction as F;
        DepthTest {
            less: matches!(function, F::Less | F::LessEqual | F::NotEqual | F::Always),
            equal: matches!(function, F::Equal | F::LessEqual | F::GreaterEqual | F::Always),
            greater: matches!(function, F::Greater | F::GreaterEqual | F::NotEqual | F::Always),
            write,
        }
    }
}

/// Frame buffer and Z buffer of a target as slices of video memory; the Z buffer is empty if there is none.
#[must_use]
pub fn surfaces<'m>(memory: &'m mut [u32], target: &Target) -> (&'m mut [u32], &'m mut [i32]) {
    let colour = span(target.colour.base, target.colour.pitch, target.colour.height);
    let Some(depth) = target.depth else {
        return (&mut memory[colour[0]..colour[1]], &mut []);
    };
    let depth = span(depth.base, depth.pitch, target.colour.height);
    // The firmware has checked that the two lie apart.
    if colour[0] < depth[0] {
        let (low, high) = memory.split_at_mut(depth[0]);
        (&mut low[colour[0]..colour[1]], bytemuck::cast_slice_mut(&mut high[..depth[1] - depth[0]]))
    } else {
        let (low, high) = memory.split_at_mut(colour[0]);
        (&mut high[..colour[1] - colour[0]], bytemuck::cast_slice_mut(&mut low[depth[0]..depth[1]]))
    }
}

/// First word and first word beyond of a surface.
fn span(base: u32, pitch: u32, height: u32) -> [usize; 2] {
    let (base, pitch) = (base as usize / 4, pitch as usize / 4);
    [base, base + pitch * height as usize]
}

/// Charges the events of a draw.
pub fn charge(counts: &TileCounts, setting: &Setting, account: &mut Account) {
    let reads = if setting.test.is_some() { counts.covered } else { 0 };
    account.add(Counter::ZSpans, counts.spans);
    account.add(Counter::ZReads, reads);
    account.add(Counter::ZWrites, if setting.test.is_some_and(|test| test.write) { counts.passed } else { 0 });
    account.add(Counter::ColourWrites, counts.passed);
    account.charge(Counter::CyclesZBuffer, Clocks(2 * counts.spans + reads + counts.passed));
    if setting.interpolation != Interpolation::Flat {
        account.add(Counter::ShadingPixels, counts.passed);
        account.charge(Counter::CyclesShading, Clocks(counts.passed));
    }
}

/// Clears planes of a target; rows of depths that `uniform` knows to hold the value already are left alone.
pub fn clear(memory: &mut [u32], target: &Target, clear: &Clear, uniform: Option<&Uniform>, account: &mut Account) {
    let Rectangle { x, y, right, bottom } = clear.area;
    if x >= right || y >= bottom {
        return;
    }
    let (pixels, lines) =
        (u64::from(right - x) * u64::from(bottom - y), u64::from((right - x).div_ceil(16)) * u64::from(bottom - y));
    let (colours, depths) = surfaces(memory, target);
    let (columns, rows) = (x as usize..right as usize, y as usize..bottom as usize);
    if let Some(colour) = clear.colour {
        let pixel = target.colour.format.encode(colour.to_le_bytes());
        for row in colours.chunks_exact_mut(target.colour.pitch as usize / 4).take(rows.end).skip(rows.start) {
            match target.colour.format {
                PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => row[columns.clone()].fill(pixel),
                PixelFormat::Rgb565 => bytemuck::cast_slice_mut::<u32, u16>(row)[columns.clone()].fill(pixel as u16),
            }
        }
        account.add(Counter::ColourWrites, pixels);
        account.charge(Counter::CyclesZBuffer, Clocks(lines));
    }
    if let (Some(depth), Some(surface)) = (clear.depth, target.depth) {
        let all = depths.chunks_exact_mut(surface.pitch as usize / 4).enumerate();
        for (y, row) in all.take(rows.end).skip(rows.start) {
            if !uniform.is_some_and(|uniform| uniform.holds(y)) {
                row[columns.clone()].fill(depth as i32);
            }
        }
        account.add(Counter::ZWrites, pixels);
        account.charge(Counter::CyclesZBuffer, Clocks(lines));
    }
}
