//! Plain Z buffer: each fragment's depth is compared with the one stored for its pixel.
//!
//! Duties: depth test and depth write for every covered pixel, colour write for every one that
//! passes; clears. Inputs: set-up primitives from [`crate::geometry`]. Outputs: frame buffer and
//! Z buffer in video memory.
//!
//! Clocks: 2 a span (edge walk and address), 1 a stencil value read, compared and put back, 1 a depth read and
//! compared, 1 a depth and colour written (one port, 64 bits wide), where there is either; a clear writes 64 bytes of one
//! plane a clock.
//!
//! The host goes another way to the same bits and counts: visibility of all primitives of a draw
//! tile by tile, colours once at the end of a tile, bands of tiles on several threads. [`specification`]
//! is the way the card itself would go.

pub mod band;
pub mod bins;
pub mod kernel;
pub mod punched;
pub mod specification;
pub mod stencilled;
pub mod tile;
pub mod uniform;

use super::stencil::{self, StencilCounts};
use crate::probe::account::{Account, Clocks};
use std::ops::Range;
use zga_abi::Counter;
use zga_abi::format::{DepthFunction, PixelFormat};
use zga_firmware::checked::{Clear, DepthSurface, Rectangle, Surface, Target};

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
    surfaces_of(memory, &target.colour, target.depth.as_ref())
}

/// A frame buffer and the Z buffer that belongs to it as slices of video memory.
#[must_use]
pub fn surfaces_of<'m>(
    memory: &'m mut [u32],
    frame: &Surface,
    depth: Option<&DepthSurface>,
) -> (&'m mut [u32], &'m mut [i32]) {
    let colour = span(frame.base, frame.pitch, frame.height);
    let Some(depth) = depth else {
        return (&mut memory[colour[0]..colour[1]], &mut []);
    };
    let depth = span(depth.base, depth.pitch, frame.height);
    // The firmware has checked that the two lie apart.
    if colour[0] < depth[0] {
        let (low, high) = memory.split_at_mut(depth[0]);
        (&mut low[colour[0]..colour[1]], bytemuck::cast_slice_mut(&mut high[..depth[1] - depth[0]]))
    } else {
        let (low, high) = memory.split_at_mut(colour[0]);
        (&mut high[..colour[1] - colour[0]], bytemuck::cast_slice_mut(&mut low[depth[0]..depth[1]]))
    }
}

/// Frame buffer, Z buffer and stencil plane of a target as slices of video memory; those that are not there are empty.
#[must_use]
pub fn all_surfaces<'m>(memory: &'m mut [u32], target: &Target) -> (&'m mut [u32], &'m mut [i32], &'m mut [u8]) {
    let height = target.colour.height;
    let of = |base: u32, pitch: u32| {
        let [first, beyond] = span(base, pitch, height);
        first..beyond
    };
    let colour = of(target.colour.base, target.colour.pitch);
    let depth = target.depth.map_or(0..0, |depth| of(depth.base, depth.pitch));
    let [colour, depth, stencil] = apart(memory, &[colour, depth, stencil::words(target)]);
    (colour, bytemuck::cast_slice_mut(depth), bytemuck::cast_slice_mut(stencil))
}

/// Ranges of memory as slices. The firmware has checked that they lie apart.
fn apart<'m, const N: usize>(memory: &'m mut [u32], ranges: &[Range<usize>; N]) -> [&'m mut [u32]; N] {
    let mut order: [usize; N] = std::array::from_fn(|k| k);
    order.sort_unstable_by_key(|&k| (ranges[k].start, ranges[k].end));
    let mut parts: [&'m mut [u32]; N] = std::array::from_fn(|_| <&mut [u32]>::default());
    let (mut rest, mut at) = (memory, 0);
    for k in order {
        let (_, after) = rest.split_at_mut(ranges[k].start - at);
        let (mine, after) = after.split_at_mut(ranges[k].len());
        (parts[k], rest, at) = (mine, after, ranges[k].end);
    }
    parts
}

/// First word and first word beyond of a surface.
fn span(base: u32, pitch: u32, height: u32) -> [usize; 2] {
    let (base, pitch) = (base as usize / 4, pitch as usize / 4);
    [base, base + pitch * height as usize]
}

/// Charges the events of a draw.
pub fn charge(counts: &TileCounts, setting: &Setting, account: &mut Account) {
    let StencilCounts { tested, failed } = counts.stencil;
    // What fails the stencil test does not come to the depth test.
    let reads = if setting.test.is_some() { counts.covered - failed } else { 0 };
    let depths = if setting.test.is_some_and(|test| test.write) { counts.passed } else { 0 };
    let colours = if setting.draws_colours() { counts.passed } else { 0 };
    account.add(Counter::ZSpans, counts.spans);
    account.add(Counter::ZReads, reads);
    account.add(Counter::ZWrites, depths);
    account.add(Counter::ColourWrites, colours);
    account.charge(Counter::CyclesZBuffer, Clocks(2 * counts.spans + tested + reads + depths.max(colours)));
    counts.stencil.charge(account);
    charge_shading(colours, setting, account);
    setting.looked_up(counts.covered, counts.holes).charge(account);
}

/// Charges the shading of `pixels` pixels of a draw whose fragments are shaded as soon as they pass.
pub fn charge_shading(pixels: u64, setting: &Setting, account: &mut Account) {
    if setting.is_shaded() {
        account.add(Counter::ShadingPixels, pixels);
        account.charge(Counter::CyclesShading, Clocks(pixels));
    }
    if let Some(shading) = &setting.shading {
        shading.pixel.cost().times(pixels).charge(account);
    }
}

/// Writes a colour (RGBA, R in 7:0) to the pixels of `area` in a frame buffer.
pub fn fill_colour(colours: &mut [u32], surface: &Surface, area: &Rectangle, colour: u32) {
    let pixel = surface.format.encode(colour.to_le_bytes());
    let columns = area.x as usize..area.right as usize;
    let rows = colours.chunks_exact_mut(surface.pitch as usize / 4);
    for row in rows.take(area.bottom as usize).skip(area.y as usize) {
        match surface.format {
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => row[columns.clone()].fill(pixel),
            PixelFormat::Rgb565 => bytemuck::cast_slice_mut::<u32, u16>(row)[columns.clone()].fill(pixel as u16),
        }
    }
}

/// Writes a depth to the pixels of `area` in rows of `pitch` depths; rows for which `held` says that they hold it
/// already are left alone.
pub fn fill_depth(depths: &mut [i32], pitch: usize, area: &Rectangle, depth: i32, held: impl Fn(usize) -> bool) {
    let columns = area.x as usize..area.right as usize;
    for (y, row) in depths.chunks_exact_mut(pitch).enumerate().take(area.bottom as usize).skip(area.y as usize) {
        if !held(y) {
            row[columns.clone()].fill(depth);
        }
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
    if let Some(value) = clear.stencil {
        account.charge(Counter::CyclesZBuffer, stencil::fill(memory, target, &clear.area, value));
    }
    let (colours, depths) = surfaces(memory, target);
    if let Some(colour) = clear.colour {
        fill_colour(colours, &target.colour, &clear.area, colour);
        account.add(Counter::ColourWrites, pixels);
        account.charge(Counter::CyclesZBuffer, Clocks(lines));
    }
    if let (Some(depth), Some(surface)) = (clear.depth, target.depth) {
        let held = |row: usize| uniform.is_some_and(|uniform| uniform.holds(row));
        fill_depth(depths, surface.pitch as usize / 4, &clear.area, depth as i32, held);
        account.add(Counter::ZWrites, pixels);
        account.charge(Counter::CyclesZBuffer, Clocks(lines));
    }
}
