//! Tile unit: two sorts find which polygons matter in each tile; its pixels are compared all at once.
//!
//! Source: CN 1275225 A / WO 98/53425 (1997). The screen is cut into tiles of w x h pixels (the source
//! has 8 x 8, and calls them fragments). No polygon is ever cut: it is stored once, and linked.
//!
//! | module | part of the unit |
//! | --- | --- |
//! | [`link`] | linked lists: an index of heads, insertion at the head, the walk that merges and unlinks |
//! | [`y_sort`] | sort buffer: polygons in order of arrival, `Y_INDEX` and `LINK_Y` |
//! | [`x_sort`] | X sort of one row of tiles: X index and `LINK_X` |
//! | [`extent`] | where a polygon's edges cross the boundaries of a row; exact |
//! | [`comparator`] | Z comparator array: one comparator a pixel of the tile |
//! | [`interpolator`] | vertex parameter buffer and pixel parameters |
//! | [`colour_buffer`] | two banks: one tile is written out while the next is drawn |
//! | [`scene`] | the structural model: all of it wired, a scene at a time |
//! | [`closed_form`] | the functional model: the same counts from each primitive alone, without lists |
//! | [`crossing`] | its crossings of rows' boundaries |
//! | [`clocks`] | what the unit charges and why |
//! | [`storage`] | register bits and buffer bytes |
//!
//! Duties: visibility and colours of a scene, tile by tile; both sorts. Inputs: a scene that was
//! [held back](super::held), its target. Outputs: frame buffer, Z buffer if there is one, events.
//!
//! # Order
//! Lists are last in, first out, but pixels must see polygons in order of arrival: not every depth
//! function forgives a swap, and of equal depths the earlier command stays. Two insertions put it right.
//! Addresses in the sort buffer grow in order of arrival, so each list under `Y_INDEX` runs from high to
//! low addresses. A row is walked in that order, the newest polygon first, and each goes in at the head of
//! an X list: those run from low to high, the oldest first. What stays linked keeps its order, and where
//! it meets the list that starts in the next row or tile the walk *merges* the two: it holds two heads,
//! follows the higher address in Y and the lower in X, and reads one link a step as a plain walk does. So
//! order costs one comparator of addresses and no clock, and no pixel needs a sequence number.
//!
//! # Boundaries
//! A polygon is linked in the rows and tiles that its outline, cut by the draw's scissor, reaches into;
//! touching a boundary from the left or from above is not reaching beyond it. Lines and points are linked
//! by the pixels they draw, clears inside a scene are rectangles. A polygon whose bounding box misses its
//! scissor is not stored; one that only misses it inside a row is walked there and not linked in X.
//!
//! # Clocks
//! 1 for each polygon, row, link and tile of the sorts, 3 more for each link of a tile to set up the comparators, 1 for
//! each pixel loaded or written; a tile is drawn while the one before is written out. [`clocks`] has the table and why.
//!
//! # A worked example
//! Tiles of 8 x 8, a target of 24 x 16: two rows of three tiles. Triangle 0 has corners (2, 1), (22, 2),
//! (4, 7), triangle 1 has (9, 1), (12, 2), (10, 6).
//!
//! | step | state afterwards | links walked | removed |
//! | --- | --- | --- | --- |
//! | at first | `Y_INDEX` = EMPTY, EMPTY | | |
//! | 0 arrives | `Y_INDEX[0]` = 0, `LINK_Y[0]` = END | | |
//! | 1 arrives | `Y_INDEX[0]` = 1, `LINK_Y[1]` = 0 | | |
//! | row 0, X sort: 1, then 0 | X index = 0, 1, EMPTY; both end above y = 8: nothing stays | 2 | 2 |
//! | tile 0: 0 | reaches x = 22 > 8: stays | 1 | 0 |
//! | tile 1: 0, merged with 1 | 0 stays; 1 ends at x = 12 < 16: unlinked | 2 | 1 |
//! | tile 2: 0 | 22 < 24: unlinked | 1 | 1 |
//! | row 1: EMPTY | three empty tiles | 0 | 0 |
//!
//! In all: 6 tiles visited, 3 of them empty, 6 links walked, 4 removed; cutting would have stored 4
//! records, so 2 were not stored. Sort memory: 2 and 3 heads of 4 bytes, 2 records of 72: 164 bytes.
//!
//! Where a clear came before, so that all pixels are written: 2 clocks for the Y sort; row 0 has 1 + 2 + 2 for its X
//! sort and 1 + 4 for tile 0; each of the 5 others waits for the 64 pixels of the one before; 64 for the last:
//! 2 + 5 + 5 + 5 x 64 + 64 = 396. The tests follow all of it.

pub mod clocks;
pub mod closed_form;
pub mod colour_buffer;
pub mod comparator;
pub mod crossing;
pub mod extent;
pub mod interpolator;
pub mod link;
pub mod scene;
pub mod storage;
pub mod x_sort;
pub mod y_sort;

#[cfg(test)]
mod tests;

use super::held::Background;
use super::stencil::StencilCounts;
use crate::probe::account::{Account, Clocks};
use crate::shading::pixel::ShadingCounts;
use zga_abi::Counter;
use zga_firmware::checked::{Rectangle, Target};

/// Bytes of a head in an index.
const HEAD_BYTES: u64 = 4;
/// Bytes of a polygon in the sort buffer: 3 vertices of 5 words (x, y, z, colour, 1 / w), a word for its
/// kind and draw, LINK_Y and LINK_X. Lines, points and rectangles fill the record in part.
pub const RECORD_BYTES: u64 = 4 * (3 * 5 + 1 + 2);

/// Events of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SortCounts {
    /// Tiles visited.
    pub visited: u64,
    /// Tiles among them whose list was empty.
    pub empty: u64,
    /// Links followed, in rows for the X sort and in tiles for their pixels.
    pub links_walked: u64,
    /// Polygons unlinked, from rows and from tiles.
    pub links_removed: u64,
    /// Bytes of Y_INDEX, X index and sort buffer.
    pub sort_memory_bytes: u64,
    /// Records that cutting each polygon into tiles would have stored beyond one a polygon.
    pub fragments_not_stored: u64,
    /// Runs of pixels of one triangle on one row.
    pub spans: u64,
    /// Depths loaded from the Z buffer.
    pub reads: u64,
    /// Depths stored in the Z buffer.
    pub writes: u64,
    /// Colours written to the frame buffer.
    pub colours: u64,
    /// Pixels that are shaded: their colour is interpolated, or goes through more.
    pub shaded: u64,
    /// What they cost beyond interpolated colours.
    pub shading: ShadingCounts,
    /// Events of stencil tests.
    pub stencil: StencilCounts,
    /// Clocks of the unit, the interpolators' left out.
    pub clocks: u64,
}

/// Charges the events of a scene. The interpolators' clocks, 1 a pixel, stand in the account that all
/// paths share.
pub fn charge(counts: &SortCounts, account: &mut Account) {
    for (counter, events) in [
        (Counter::TileVisited, counts.visited),
        (Counter::TileEmpty, counts.empty),
        (Counter::TileLinksWalked, counts.links_walked),
        (Counter::TileLinksRemoved, counts.links_removed),
        (Counter::TileSortMemoryBytes, counts.sort_memory_bytes),
        (Counter::TileFragmentsNotStored, counts.fragments_not_stored),
        (Counter::ZSpans, counts.spans),
        (Counter::ZReads, counts.reads),
        (Counter::ZWrites, counts.writes),
        (Counter::ColourWrites, counts.colours),
        (Counter::ShadingPixels, counts.shaded),
    ] {
        account.add(counter, events);
    }
    account.charge(Counter::CyclesTile, Clocks(counts.clocks));
    account.charge(Counter::CyclesShading, Clocks(counts.shaded));
    counts.shading.charge(account);
    counts.stencil.charge(account);
}

/// How a target is cut into tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Width and height of a tile, pixels; powers of two.
    pub tile: [u32; 2],
    /// Width and height of the target, pixels.
    pub size: [u32; 2],
}

impl Grid {
    /// The grid of a target.
    #[must_use]
    pub fn new(target: &Target) -> Grid {
        Grid { tile: target.tile, size: [target.colour.width, target.colour.height] }
    }

    /// Tiles in a row, rows of tiles.
    #[must_use]
    pub fn tiles(&self) -> [usize; 2] {
        [self.size[0].div_ceil(self.tile[0]) as usize, self.size[1].div_ceil(self.tile[1]) as usize]
    }

    /// Pixels of a tile that are on the screen.
    #[must_use]
    pub fn pixels(&self, column: usize, row: usize) -> Rectangle {
        let [w, h] = self.tile;
        let (x, y) = (column as u32 * w, row as u32 * h);
        Rectangle { x, y, right: (x + w).min(self.size[0]), bottom: (y + h).min(self.size[1]) }
    }

    /// Bytes of both indices and of a sort buffer of `polygons`.
    #[must_use]
    pub fn sort_memory_bytes(&self, polygons: u64) -> u64 {
        let [columns, rows] = self.tiles();
        HEAD_BYTES * (columns + rows) as u64 + RECORD_BYTES * polygons
    }
}

/// What a tile exchanges with memory, by the rules that all paths which keep depths on the chip share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// Depths are loaded: there is a Z buffer, and no clear says what they are.
    pub load: bool,
    /// Depths are stored: there is a Z buffer.
    pub store: bool,
    /// All colours are written: a clear says what they are where nothing is drawn.
    pub fill: bool,
}

impl Traffic {
    /// The rules for a scene on a target.
    #[must_use]
    pub fn new(target: &Target, background: &Background) -> Traffic {
        Traffic {
            load: target.depth.is_some() && background.depth.is_none(),
            store: target.depth.is_some(),
            fill: background.colour.is_some(),
        }
    }
}

/// Number of pixels of a rectangle.
fn area(pixels: &Rectangle) -> u64 {
    u64::from(pixels.right - pixels.x) * u64::from(pixels.bottom - pixels.y)
}
