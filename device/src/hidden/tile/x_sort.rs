//! X sort: the polygons of one row of tiles, listed under the tile they start in.
//!
//! Duties: puts each polygon of a row under the X index of the tile of its least X *inside that row*;
//! walks a tile, and keeps linked for the next one what reaches beyond the tile's right boundary: where
//! its edges cross the row's boundaries, and its vertices inside the row, the larger X decides.
//! Inputs: a row's polygons, newest first. Outputs: a tile's polygons, oldest first.
//!
//! Clocks: 1 an insertion, 1 a link ([`super::clocks`]).

use super::Grid;
use super::link::{Address, Order, Sort, Walked};
use super::y_sort::Polygon;
use crate::geometry::PIXEL;

/// The lists of one row; empty again after its last tile.
#[derive(Debug)]
pub struct XSort {
    lists: Sort,
    /// Upper and lower boundary of the row, u.
    boundaries: [i32; 2],
    /// Width of a tile, u.
    width: i32,
    /// Polygons linked since the row began.
    linked: u64,
}

impl XSort {
    /// Empty lists.
    #[must_use]
    pub fn new(grid: Grid) -> XSort {
        let width = grid.tile[0] as i32 * PIXEL;
        XSort { lists: Sort::new(Order::Oldest, grid.tiles()[0]), boundaries: [0; 2], width, linked: 0 }
    }

    /// Begins a row between two boundaries, u.
    pub fn begin(&mut self, boundaries: [i32; 2]) {
        self.boundaries = boundaries;
        self.linked = 0;
    }

    /// Takes a polygon of the row, unless the scissor leaves nothing of it here.
    pub fn insert(&mut self, address: Address, polygon: &Polygon<'_>) {
        if let Some([least, _]) = polygon.extent.across(self.boundaries) {
            self.lists.insert(least.interval(self.width) as usize, address);
            self.linked += 1;
        }
    }

    /// Polygons linked since the row began.
    #[must_use]
    pub fn linked(&self) -> u64 {
        self.linked
    }

    /// Bytes of the X index.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.lists.bytes()
    }

    /// X index and `LINK_X`.
    #[cfg(test)]
    #[must_use]
    pub fn lists(&self) -> &Sort {
        &self.lists
    }

    /// Gives the polygons of a tile to `visit`, oldest first, and updates their links.
    pub fn walk<'h>(
        &mut self,
        column: usize,
        polygons: &[Polygon<'h>],
        mut visit: impl FnMut(Address, &Polygon<'h>),
    ) -> Walked {
        let right = (column as i32 + 1) * self.width;
        let boundaries = self.boundaries;
        self.lists.walk(column, |address| {
            let polygon = &polygons[address as usize];
            visit(address, polygon);
            polygon.extent.across(boundaries).is_some_and(|[_, larger]| larger.is_beyond(right))
        })
    }
}
