//! Y sort: the polygons of a scene in order of arrival, listed under the row of tiles they start in.
//!
//! Duties: keeps the sort buffer; puts each polygon that arrives under `Y_INDEX` of the row of its least
//! Y; walks a row, and keeps linked for the next one what reaches below the row's lower boundary.
//! Inputs: items of a scene. Outputs: a row's polygons, the newest first.
//!
//! Clocks: 1 an insertion, 1 a link ([`super::clocks`]).

use super::extent::Extent;
use super::link::{Address, Order, Sort, Walked};
use super::{Grid, RECORD_BYTES};
use crate::geometry::PIXEL;
use crate::hidden::held::Item;

/// A polygon (or line, point, rectangle) of the sort buffer. Its links stand in [`Sort`], by address.
#[derive(Clone, Copy, Debug)]
pub struct Polygon<'h> {
    /// What arrived.
    pub item: &'h Item,
    /// Where it lies.
    pub extent: Extent<'h>,
    /// Greatest Y, u, inside the scissor.
    bottom: i32,
}

/// The Y-sort buffer and its lists.
#[derive(Debug)]
pub struct YSort<'h> {
    polygons: Vec<Polygon<'h>>,
    lists: Sort,
    grid: Grid,
}

impl<'h> YSort<'h> {
    /// An empty sort buffer.
    #[must_use]
    pub fn new(grid: Grid) -> YSort<'h> {
        YSort { polygons: Vec::new(), lists: Sort::new(Order::Newest, grid.tiles()[1]), grid }
    }

    /// Takes what arrives, if its scissor leaves anything.
    pub fn insert(&mut self, item: &'h Item, extent: Extent<'h>) {
        if let Some([top, bottom]) = extent.down() {
            let row = top / (self.grid.tile[1] as i32 * PIXEL);
            self.lists.insert(row as usize, self.polygons.len() as Address);
            self.polygons.push(Polygon { item, extent, bottom });
        }
    }

    /// Polygons stored.
    #[must_use]
    pub fn polygons(&self) -> &[Polygon<'h>] {
        &self.polygons
    }

    /// `Y_INDEX` and `LINK_Y`.
    #[cfg(test)]
    #[must_use]
    pub fn lists(&self) -> &Sort {
        &self.lists
    }

    /// Bytes of `Y_INDEX` and of the sort buffer, links included.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.lists.bytes() + RECORD_BYTES * self.polygons.len() as u64
    }

    /// Upper and lower boundary of a row of tiles, u.
    #[must_use]
    pub fn boundaries(&self, row: usize) -> [i32; 2] {
        let height = self.grid.tile[1] as i32 * PIXEL;
        [row as i32 * height, (row as i32 + 1) * height]
    }

    /// Whether a row has no polygon.
    #[cfg(test)]
    #[must_use]
    pub fn is_empty_row(&self, row: usize) -> bool {
        self.lists.is_empty_at(row)
    }

    /// Gives the polygons of a row to `visit`, newest first, and updates their links.
    pub fn walk(&mut self, row: usize, mut visit: impl FnMut(Address, &Polygon<'h>)) -> Walked {
        let [_, lower] = self.boundaries(row);
        let polygons = &self.polygons;
        self.lists.walk(row, |address| {
            let polygon = &polygons[address as usize];
            visit(address, polygon);
            polygon.bottom > lower
        })
    }
}
