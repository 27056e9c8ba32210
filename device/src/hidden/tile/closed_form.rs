//! Closed form: the events of both sorts from each primitive alone, without lists.
//!
//! How long a list is follows from the first and last place of each polygon, so a difference array for
//! each row of tiles takes the place of the lists: 1 is added where a polygon starts and taken away
//! beyond where it ends. Sums over primitives do not care who adds them; the parts of several threads are
//! [merged](Sorts::merge).
//!
//! Duties: the same counts and clocks as the structural model ([`super::scene`]), exactly. Inputs: what
//! geometry sets up, clears inside the scene. Outputs: events of a scene.
//!
//! Crossings are exact, and quick: see [`super::crossing`].
//!
//! Memory: 4 bytes a tile. Lengths are modulo 2^32.

use super::clocks::Schedule;
use super::crossing::{Across, Edges, NOTHING, steps_on_rows, union};
use super::{Grid, SortCounts, Traffic, area};
use crate::geometry::assembly::{Point, Sink};
use crate::geometry::line::Line;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::Triangle;
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::held::Background;
use crate::hidden::stencil::StencilCounts;
use crate::shading::pixel::ShadingCounts;
use zga_firmware::checked::{Rectangle, Target};

/// What the pixels of a scene say that its primitives do not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelCounts {
    /// Runs of pixels of one triangle on one row.
    pub spans: u64,
    /// Pixels whose colour, as it is seen in the end, is interpolated or goes through more.
    pub shaded: u64,
    /// What they cost beyond interpolated colours.
    pub shading: ShadingCounts,
    /// Events of stencil tests.
    pub stencil: StencilCounts,
}

/// Sums of a scene's primitives.
#[derive(Clone, Debug)]
pub struct Sorts {
    grid: Grid,
    /// log2 of a tile's width and height in u.
    shift: [u32; 2],
    /// Scissor of the primitives that come: left, top, right, bottom; u.
    area: [i32; 4],
    /// Differences of the list lengths, rows of `pitch`: one element more than there are tiles.
    lists: Vec<u32>,
    /// Elements of a row of `lists`.
    pitch: usize,
    /// Differences of the numbers of live polygons, one element more than rows.
    live: Vec<u32>,
    /// Polygons live in a row and not linked in X.
    missed: Vec<u32>,
    /// Polygons stored.
    stored: u64,
    /// Tiles that polygons are linked in beyond one each.
    not_stored: u64,
}

impl Sorts {
    /// No primitives yet; the scissor is the whole target.
    #[must_use]
    pub fn new(target: &Target) -> Sorts {
        let grid = Grid::new(target);
        let [columns, rows] = grid.tiles();
        let mut sorts = Sorts {
            grid,
            shift: grid.tile.map(|pixels| (pixels * PIXEL as u32).trailing_zeros()),
            area: [0; 4],
            lists: vec![0; (columns + 1) * rows],
            pitch: columns + 1,
            live: vec![0; rows + 1],
            missed: vec![0; rows],
            stored: 0,
            not_stored: 0,
        };
        sorts.scissor(Rectangle { x: 0, y: 0, right: grid.size[0], bottom: grid.size[1] });
        sorts
    }

    /// Sets the pixels that primitives from now on may change; inside the target.
    pub fn scissor(&mut self, area: Rectangle) {
        self.area = [area.x, area.y, area.right, area.bottom].map(|c| c as i32 * PIXEL);
    }

    /// Forgets all primitives.
    pub fn reset(&mut self) {
        self.lists.fill(0);
        self.live.fill(0);
        self.missed.fill(0);
        (self.stored, self.not_stored) = (0, 0);
    }

    /// Adds the sums of another part of the same scene.
    pub fn merge(&mut self, other: &Sorts) {
        let add = |to: &mut [u32], from: &[u32]| {
            for (to, from) in to.iter_mut().zip(from) {
                *to = to.wrapping_add(*from);
            }
        };
        add(&mut self.lists, &other.lists);
        add(&mut self.live, &other.live);
        add(&mut self.missed, &other.missed);
        self.stored += other.stored;
        self.not_stored += other.not_stored;
    }

    /// Adds a clear inside the scene; the scissor of primitives is not its own.
    pub fn clear(&mut self, area: Rectangle) {
        self.rectangle([area.x, area.y, area.right, area.bottom].map(|c| c as i32 * PIXEL));
    }

    /// The events of the scene, once all its parts are merged. `won` gives the number of pixels of a tile
    /// (column, row) that a colour was drawn to; it is asked only where a clear does not say the
    /// background's colour.
    #[must_use]
    pub fn finish(
        &self,
        target: &Target,
        background: &Background,
        pixels: PixelCounts,
        mut won: impl FnMut(usize, usize) -> u64,
    ) -> SortCounts {
        if self.stored == 0 && *background == Background::default() {
            return SortCounts::default();
        }
        let traffic = Traffic::new(target, background);
        let mut schedule = Schedule::new(traffic, self.stored);
        let mut counts = SortCounts {
            sort_memory_bytes: self.grid.sort_memory_bytes(self.stored),
            fragments_not_stored: self.not_stored,
            links_removed: self.stored,
            spans: pixels.spans,
            shaded: pixels.shaded,
            shading: pixels.shading,
            stencil: pixels.stencil,
            ..SortCounts::default()
        };
        let mut live = 0_u32;
        for (row, lists) in self.lists.chunks_exact(self.pitch).enumerate() {
            live = live.wrapping_add(self.live[row]);
            let linked = u64::from(live).saturating_sub(u64::from(self.missed[row]));
            counts.links_walked += u64::from(live);
            // Each is unlinked in the last tile it reaches.
            counts.links_removed += linked;
            schedule.row(u64::from(live), linked);
            let mut links = 0_u32;
            for (column, change) in lists[..self.pitch - 1].iter().enumerate() {
                links = links.wrapping_add(*change);
                let won = if traffic.fill { 0 } else { won(column, row) };
                schedule.tile(u64::from(links), area(&self.grid.pixels(column, row)), won);
                counts.visited += 1;
                counts.empty += u64::from(links == 0);
                counts.links_walked += u64::from(links);
            }
        }
        let Schedule { reads, writes, colours, .. } = schedule;
        SortCounts { reads, writes, colours, clocks: schedule.clocks(), ..counts }
    }

    /// Stores a polygon that is live in rows `first..=last`.
    #[inline(always)]
    fn store(&mut self, first: i32, last: i32) {
        self.stored += 1;
        let (first, beyond) = (first as usize, last as usize + 1);
        self.live[first] = self.live[first].wrapping_add(1);
        self.live[beyond] = self.live[beyond].wrapping_sub(1);
    }

    /// Links it in tiles `first..=last` of a row; returns their number.
    #[inline(always)]
    fn link(&mut self, row: i32, first: i32, last: i32) -> u64 {
        let lists = &mut self.lists[row as usize * self.pitch..][..self.pitch];
        let (first, beyond) = (first as usize, last as usize + 1);
        lists[first] = lists[first].wrapping_add(1);
        lists[beyond] = lists[beyond].wrapping_sub(1);
        (beyond - first) as u64
    }

    /// Links it in the tiles of a row that it reaches into, if the scissor leaves any; returns their number.
    #[inline(always)]
    fn link_across(&mut self, row: i32, across: Across) -> u64 {
        let [first, beyond] = [across[0].max(self.area[0]), across[1].min(self.area[2])];
        if first < beyond {
            self.link(row, first >> self.shift[0], (beyond - 1) >> self.shift[0])
        } else {
            self.missed[row as usize] = self.missed[row as usize].wrapping_add(1);
            0
        }
    }

    /// Adds a rectangle that lies inside its scissor; u.
    fn rectangle(&mut self, [left, top, right, bottom]: [i32; 4]) {
        if left >= right || top >= bottom {
            return;
        }
        let [x, y] = self.shift;
        let rows = [top >> y, (bottom - 1) >> y];
        self.store(rows[0], rows[1]);
        let mut tiles = 0;
        for row in rows[0]..=rows[1] {
            tiles += self.link(row, left >> x, (right - 1) >> x);
        }
        self.not_stored += tiles - 1;
    }

    /// Adds a triangle that its bounding box is not enough for.
    fn triangle_by_rows(&mut self, v: &[ScreenVertex; 3], x: [i32; 2], y: [i32; 2]) {
        let [left, top, right, bottom] = self.area;
        let [from, to] = [y[0].max(top), y[1].min(bottom)];
        if from >= to || x[0].max(left) >= x[1].min(right) {
            return;
        }
        let height = self.shift[1];
        let rows = [from >> height, (to - 1) >> height];
        self.store(rows[0], rows[1]);
        let edges = Edges::new(v);
        let crossings = |at: i32| if y[0] < at && at < y[1] { edges.crossings(at) } else { NOTHING };
        let mut tiles = 0;
        let (mut upper, mut above) = (from, crossings(from));
        for row in rows[0]..=rows[1] {
            let lower = ((row + 1) << height).min(to);
            let below = crossings(lower);
            let mut across = union(above, below);
            for v in v {
                // A selection, not a branch: no predictor knows where vertices lie.
                let inside = (upper <= v.y) & (v.y <= lower);
                across = union(across, if inside { [v.x; 2] } else { NOTHING });
            }
            tiles += self.link_across(row, across);
            (upper, above) = (lower, below);
        }
        self.not_stored += tiles.saturating_sub(1);
    }

    /// Adds a line by the pixels it draws.
    fn line_by_rows(&mut self, line: &Line) {
        let [left, top, right, bottom] = self.area.map(|c| c / PIXEL);
        let x_major = line.axis == Axis::X;
        let [low, high] = if x_major { [left, right] } else { [top, bottom] };
        let [first, beyond] = [line.steps[0].max(low), line.steps[1].min(high)];
        if first >= beyond {
            return;
        }
        let minor = |step: i32| line.minor_at(step);
        let ends = [minor(first).min(minor(beyond - 1)), minor(first).max(minor(beyond - 1)) + 1];
        let across = if x_major { [top, bottom] } else { [left, right] };
        if ends[0].max(across[0]) >= ends[1].min(across[1]) {
            return;
        }
        let y = if x_major { [ends[0].max(top), ends[1].min(bottom)] } else { [first, beyond] };
        let height = self.shift[1] - PIXEL.trailing_zeros();
        let rows = [y[0] >> height, (y[1] - 1) >> height];
        self.store(rows[0], rows[1]);
        let mut tiles = 0;
        for row in rows[0]..=rows[1] {
            let [upper, lower] = [(row << height).max(y[0]), ((row + 1) << height).min(y[1])];
            let columns = if x_major {
                steps_on_rows(line, [first, beyond], [upper, lower])
            } else {
                let [a, b] = [minor(upper), minor(lower - 1)];
                [a.min(b), a.max(b) + 1]
            };
            tiles += self.link_across(row, columns.map(|x| x * PIXEL));
        }
        self.not_stored += tiles.saturating_sub(1);
    }
}

impl Sink for Sorts {
    fn masked(&mut self, _vertices: &[ScreenVertex; 3], _number: u32) {}

    #[inline(always)]
    fn triangle(&mut self, _triangle: &Triangle, _columns: [i32; 2], v: &[ScreenVertex; 3], _number: u32) {
        let x = [v[0].x.min(v[1].x).min(v[2].x), v[0].x.max(v[1].x).max(v[2].x)];
        let y = [v[0].y.min(v[1].y).min(v[2].y), v[0].y.max(v[1].y).max(v[2].y)];
        let [left, top, right, bottom] = self.area;
        // Inside the scissor, and in one row or one column of tiles: the bounding box says it all.
        if left <= x[0] && x[1] <= right && top <= y[0] && y[1] <= bottom {
            let columns = x.map(|x| x >> self.shift[0]);
            let [c0, c1] = [columns[0], (x[1] - 1) >> self.shift[0]];
            let [r0, r1] = [y[0] >> self.shift[1], (y[1] - 1) >> self.shift[1]];
            if c0 == c1 || r0 == r1 {
                self.store(r0, r1);
                let mut tiles = 0;
                for row in r0..=r1 {
                    tiles += self.link(row, c0, c1);
                }
                self.not_stored += tiles - 1;
                return;
            }
        }
        self.triangle_by_rows(v, x, y);
    }

    fn line(&mut self, line: &Line, _vertices: &[ScreenVertex; 2], _number: u32) {
        self.line_by_rows(line);
    }

    fn point(&mut self, point: &Point, _vertex: &ScreenVertex, _number: u32) {
        let [x, y] = point.pixel.map(|c| c * PIXEL);
        let [left, top, right, bottom] = self.area;
        if (left..right).contains(&x) && (top..bottom).contains(&y) {
            self.rectangle([x, y, x + PIXEL, y + PIXEL]);
        }
    }

    fn full(&self) -> bool {
        false
    }
}

/// Pixels of a tile that are set in a plane of one bit a pixel: rows of `pitch` chunks of 16, lowest bit
/// leftmost. For [`Sorts::finish`].
#[must_use]
pub fn pixels_of_tile(plane: &[u16], pitch: usize, area: &Rectangle) -> u64 {
    let [x, right] = [area.x as usize, area.right as usize];
    let mut count = 0;
    for row in plane.chunks_exact(pitch.max(1)).take(area.bottom as usize).skip(area.y as usize) {
        for (chunk, bits) in row.iter().enumerate().take(right.div_ceil(16)).skip(x / 16) {
            let first = x.saturating_sub(16 * chunk);
            let beyond = (right - 16 * chunk).min(16);
            let mask = (u32::from(u16::MAX) >> (16 - beyond)) & (u32::MAX << first);
            count += u64::from((u32::from(*bits) & mask).count_ones());
        }
    }
    count
}
