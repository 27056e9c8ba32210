//! Clocks of the tile unit.
//!
//! | clocks | for | because |
//! | --- | --- | --- |
//! | 1 a polygon | Y sort | head read and written, record written, each in a memory of its own |
//! | 1 a row | `Y_INDEX` read | |
//! | 1 a link of the row | X sort, walk | link read; the crossings and the row's link update go beside it |
//! | 1 a polygon linked in X | X sort, insertion | as in Y |
//! | 1 a tile | X index read, comparators reset | |
//! | 1 a link of the tile | walk | link read; the tile's link update goes beside it |
//! | 3 a link of the tile | comparator set-up | the port of the comparators takes a vertex a clock |
//! | 0 | comparisons | all pixels at once, in the shadow of the next polygon's set-up |
//! | 1 a pixel on the screen | load of depths, if they are loaded | one port to memory, 64 bits wide |
//! | 1 a pixel written | write-out of a bank | the same port: colour and depth of a pixel together |
//!
//! A tile's depths are loaded; then it is drawn while the bank of the tile before is written out, so both
//! take as long as the longer one. The first tile of a row waits for the row's X sort. The write-out of
//! the last tile has nothing to hide behind.
//!
//! Pixels written are all on the screen where depths are stored or the background's colour is known, else
//! those something was drawn to. Nothing depends on what the polygons of a list do to each other.

use super::Traffic;

/// Set-up of the comparators for one polygon: its three vertices.
const SET_UP: u64 = 3;

/// Adds up the clocks of a scene; also the loads and stores, which follow from the same numbers.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    traffic: Traffic,
    clocks: u64,
    /// What the next tile has to wait for before it can be drawn: the X sort of its row.
    sorting: u64,
    /// Write-out of the tile before.
    write_out: u64,
    /// Depths loaded.
    pub reads: u64,
    /// Depths stored.
    pub writes: u64,
    /// Colours written.
    pub colours: u64,
}

impl Schedule {
    /// The Y sort of `polygons` polygons.
    #[must_use]
    pub fn new(traffic: Traffic, polygons: u64) -> Schedule {
        Schedule { traffic, clocks: polygons, sorting: 0, write_out: 0, reads: 0, writes: 0, colours: 0 }
    }

    /// The X sort of a row: `live` polygons walked, `linked` inserted.
    pub fn row(&mut self, live: u64, linked: u64) {
        self.sorting += 1 + live + linked;
    }

    /// A tile with `links` polygons and `pixels` pixels on the screen, of which something was drawn to `won`.
    pub fn tile(&mut self, links: u64, pixels: u64, won: u64) {
        let load = if self.traffic.load { pixels } else { 0 };
        let store = if self.traffic.store { pixels } else { 0 };
        let colours = if self.traffic.fill { pixels } else { won };
        let draw = std::mem::take(&mut self.sorting) + 1 + (1 + SET_UP) * links;
        self.clocks += load + draw.max(self.write_out);
        self.write_out = store.max(colours);
        self.reads += load;
        self.writes += store;
        self.colours += colours;
    }

    /// Clocks of the scene, once the last bank is written out.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.clocks + self.write_out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: Traffic = Traffic { load: false, store: false, fill: false };

    #[test]
    fn tile_short_list_waits_for_the_write_out_before() {
        let mut schedule = Schedule::new(NONE, 1);
        schedule.row(1, 1);
        schedule.tile(1, 64, 40);
        schedule.tile(1, 64, 2);
        // Y sort 1; (1 + 1 + 1) + 1 + 4; then max(1 + 4, 40); then 2.
        assert_eq!(schedule.clocks(), 1 + 8 + 40 + 2);
        assert_eq!([schedule.reads, schedule.writes, schedule.colours], [0, 0, 42]);
    }

    #[test]
    fn tile_long_list_hides_the_write_out_before() {
        let mut schedule = Schedule::new(NONE, 0);
        schedule.tile(1, 64, 40);
        schedule.tile(20, 64, 0);
        assert_eq!(schedule.clocks(), 5 + 81);
    }

    #[test]
    fn tile_with_z_buffer_loads_before_and_stores_after() {
        let mut schedule = Schedule::new(Traffic { load: true, store: true, fill: false }, 0);
        schedule.tile(1, 64, 3);
        assert_eq!(schedule.clocks(), 64 + 5 + 64);
        assert_eq!([schedule.reads, schedule.writes, schedule.colours], [64, 64, 3]);
    }

    #[test]
    fn tile_known_background_writes_every_pixel() {
        let mut schedule = Schedule::new(Traffic { fill: true, ..NONE }, 0);
        schedule.tile(0, 64, 0);
        assert_eq!(schedule.clocks(), 1 + 64);
        assert_eq!(schedule.colours, 64);
    }
}
