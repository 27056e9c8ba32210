//! What is drawn to: rectangles, surfaces, a scene's target.

use super::{SubpixelSetting, SystolicSetting, ZaSetting};
use core::ops::Range;
use zga_abi::format::{DepthFormat, Fidelity, HiddenSurface, PixelFormat};

/// A rectangle of pixels: `x`, `y` inclusive, `right`, `bottom` exclusive.
///
/// # Invariants
/// `x <= right` and `y <= bottom`; it is empty where they are equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// First column beyond.
    pub right: u32,
    /// First row beyond.
    pub bottom: u32,
}

/// Pixels in video memory.
///
/// # Invariants
/// `base + (height - 1) * pitch + width * format.bytes()` lies in video memory; for render and
/// scan-out targets `base` and `pitch` are multiples of 64, so a row holds whole chunks of 16 words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// First byte.
    pub base: u32,
    /// Bytes from a row to the next.
    pub pitch: u32,
    /// Pixels, 1..=16384.
    pub width: u32,
    /// Pixels, 1..=16384.
    pub height: u32,
    /// Format of a pixel.
    pub format: PixelFormat,
}

impl Surface {
    /// From its first byte to the first beyond its last row.
    #[must_use]
    pub const fn bytes(&self) -> Range<u64> {
        let rows = (self.height as u64 - 1) * self.pitch as u64 + self.width as u64 * self.format.bytes() as u64;
        self.base as u64..self.base as u64 + rows
    }
}

/// Depths in video memory, one 32-bit word a pixel; the size is that of the target.
///
/// # Invariants
/// `base` and `pitch` are multiples of 64; all `height` rows of `pitch` bytes lie in video memory
/// and apart from the frame buffer's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthSurface {
    /// First byte.
    pub base: u32,
    /// Bytes from a row to the next, at least 4 times the width.
    pub pitch: u32,
}

/// Stencil values in video memory, one byte a pixel; the size is that of the target.
///
/// # Invariants
/// `base` and `pitch` are multiples of 64; all `height` rows of `pitch` bytes lie in video memory
/// and apart from those of frame buffer and Z buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilSurface {
    /// First byte.
    pub base: u32,
    /// Bytes from a row to the next, at least the width.
    pub pitch: u32,
}

/// What a scene draws to, and how; fixed from begin scene to end scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Frame buffer. All `height` rows of `pitch` bytes lie in video memory.
    pub colour: Surface,
    /// Z buffer, if there is one (DEPTH_PITCH is not 0).
    pub depth: Option<DepthSurface>,
    /// Number format of depth.
    pub depth_format: DepthFormat,
    /// Bits of a pixel that coordinates are snapped to: 4 or 8.
    pub subpixel_bits: u32,
    /// Who decides visibility.
    pub hidden_surface: HiddenSurface,
    /// How units with a clocked model are simulated.
    pub fidelity: Fidelity,
    /// Za unit; on the Za path the frame's words lie in Za RAM.
    pub za: ZaSetting,
    /// Systolic array.
    pub systolic: SystolicSetting,
    /// Width and height of a tile of the tile unit, pixels: 4, 8, 16, 32 or 64.
    pub tile: [u32; 2],
    /// Sub-pixel mask unit; none where SUBPIXEL_GRID is off. Only with one do draws call for ANTI_ALIAS.
    pub subpixel: Option<SubpixelSetting>,
    /// Stencil plane, if there is one (STENCIL_PITCH is not 0). Only with one, and without a grid, do draws call for
    /// STENCIL.
    pub stencil: Option<StencilSurface>,
}

impl Target {
    /// Depth can be tested and cleared: there is a Z buffer, or the path keeps depths in its own registers.
    #[must_use]
    pub const fn has_depth(&self) -> bool {
        self.depth.is_some() || self.is_sorted()
    }

    /// The path sorts a scene before it decides what is seen: it keeps depths in registers of its own.
    #[must_use]
    pub const fn is_sorted(&self) -> bool {
        matches!(self.hidden_surface, HiddenSurface::Systolic | HiddenSurface::Tile)
    }
}
