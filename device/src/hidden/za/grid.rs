//! The grid of blocks that a picture is divided into, one Za word each.
//!
//! Blocks are numbered row by row from the top left corner of the picture. Those at its right and
//! bottom edge are cut by it: only their pixels on the screen exist, in any count and in any maximum.

use std::ops::Range;
use zga_firmware::checked::Rectangle;

/// How a picture is divided into blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Width and height of a block, pixels, each 1..=16384.
    pub block: [u32; 2],
    /// Width and height of the picture, pixels, each 1..=16384.
    pub size: [u32; 2],
}

impl Grid {
    /// Blocks in a row.
    #[must_use]
    #[inline(always)]
    pub const fn across(&self) -> usize {
        self.size[0].div_ceil(self.block[0]) as usize
    }

    /// Rows of blocks.
    #[must_use]
    #[inline(always)]
    pub const fn down(&self) -> usize {
        self.size[1].div_ceil(self.block[1]) as usize
    }

    /// Words of the picture.
    #[must_use]
    pub const fn words(&self) -> usize {
        self.across() * self.down()
    }

    /// Pixels of block (`column`, `row`) that are on the screen.
    #[must_use]
    #[inline(always)]
    pub fn area_at(&self, column: usize, row: usize) -> Rectangle {
        let (x, y) = (column as u32 * self.block[0], row as u32 * self.block[1]);
        Rectangle { x, y, right: (x + self.block[0]).min(self.size[0]), bottom: (y + self.block[1]).min(self.size[1]) }
    }

    /// Pixels of block `index` that are on the screen.
    #[must_use]
    pub fn area(&self, index: usize) -> Rectangle {
        self.area_at(index % self.across(), index / self.across())
    }

    /// Number of pixels of block `index` that are on the screen.
    #[must_use]
    #[cfg(test)]
    pub fn pixels(&self, index: usize) -> u64 {
        pixels(&self.area(index))
    }

    /// All pixels of the picture.
    #[must_use]
    pub const fn all(&self) -> Rectangle {
        Rectangle { x: 0, y: 0, right: self.size[0], bottom: self.size[1] }
    }

    /// Columns and rows of blocks that hold pixels of `area`, which is cut to the picture.
    #[must_use]
    pub fn meeting(&self, area: &Rectangle) -> [Range<usize>; 2] {
        let blocks = |first: u32, beyond: u32, axis: usize| {
            let beyond = beyond.min(self.size[axis]);
            if first >= beyond {
                0..0
            } else {
                (first / self.block[axis]) as usize..beyond.div_ceil(self.block[axis]) as usize
            }
        };
        [blocks(area.x, area.right, 0), blocks(area.y, area.bottom, 1)]
    }
}

/// Number of pixels of a rectangle.
#[must_use]
#[inline(always)]
pub fn pixels(area: &Rectangle) -> u64 {
    u64::from(area.right.saturating_sub(area.x)) * u64::from(area.bottom.saturating_sub(area.y))
}

/// What two rectangles have in common; empty ones have no pixels ([`pixels`]).
#[must_use]
pub fn common(a: &Rectangle, b: &Rectangle) -> Rectangle {
    Rectangle { x: a.x.max(b.x), y: a.y.max(b.y), right: a.right.min(b.right), bottom: a.bottom.min(b.bottom) }
}
