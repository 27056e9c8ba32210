//! Pixels inside a surface, which keep what the path drew.
//!
//! What is left of a pixel's fragments lies *inside* a surface if it covers every sample once, and no border of it passes
//! between the samples. That is decided fragment by fragment ([`super::left`]); here is found where it need not be asked:
//! fragments are only looked for in the other pixels.
//!
//! A *tile* is the 16 lines of a band by the 16 columns of a chunk. The triangles that can touch a tile are parted by
//! their depths there into *sheets*: what is of one sheet is all nearer than what is of the next. Triangles that share an
//! edge in a tile share its depths, so they are of one sheet; how often a sheet covers a place then changes at borders
//! alone. Its triangles say how often it covers the centres of the tile's first column, their borders where on a line
//! that changes; and where no border passes between the samples they all are covered as often as the centre. A pixel
//! that the nearest sheet covers once is inside, whatever lies behind; one that it does not cover is left to the next.
//!
//! Everything here may err towards pixels that are looked at.
//!
//! Inputs from: [`super::bands`], [`super::edges`]. Outputs to: [`super::band`], [`super::hide`], [`super::rows`]. Clocks:
//! none of its own.

use super::Setting;
use super::band::{Input, LINES, Work, bits_of};
use super::bands::Entry;
use super::edges::{Sides, after};
use super::scene::{Item, Rule};
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};
use crate::hidden::z_buffer::kernel::LANES;
use zga_abi::format::SubpixelEdges;

/// What a border is taken for wider, u: more than the rounding of where it crosses a line.
const SPARE: f64 = 1.0;
/// Most sheets of a tile that are looked through.
const SHEETS: usize = 4;
/// Most triangles of a tile that are: a count of 16 bits holds all their edges.
const MOST: usize = 4096;

/// Most triangles in all tiles of a band: 4 MiB a thread.
const VISITS: usize = 1 << 18;

/// A triangle in a tile.
#[derive(Clone, Copy, Debug)]
struct Visit {
    /// Place in [`Input::items`].
    entry: u32,
    /// The next of the same tile, plus 1; 0 if there is none.
    next: u32,
    /// Bounds of its depths in the tile.
    depths: [i32; 2],
}

/// The triangles of a tile.
#[derive(Clone, Copy, Debug)]
struct Tile {
    /// The first, plus 1.
    first: u32,
    count: usize,
    depths: [i32; 2],
}

impl Tile {
    const EMPTY: Tile = Tile { first: 0, count: 0, depths: [i32::MAX, i32::MIN] };
}

/// Where a band is looked at.
#[derive(Debug, Default)]
pub(super) struct Inside {
    /// A bit a pixel in which fragments are looked for; rows of [`Input::words`] words.
    pub(super) looked_at: Vec<u64>,
    tiles: Vec<Tile>,
    visits: Vec<Visit>,
}

/// A sheet of a tile.
struct Sheet {
    /// First column and row of the tile, pixels.
    place: [i32; 2],
    lines: usize,
    /// How often centres are covered.
    counts: [[i16; LANES]; LINES],
    /// A bit a pixel between whose samples a border may pass.
    borders: [u16; LINES],
}

impl Sheet {
    fn new(input: &Input<'_>, chunk: usize) -> Sheet {
        let place = [(chunk * LANES) as i32, input.top];
        Sheet { place, lines: input.lines, counts: [[0; LANES]; LINES], borders: [0; LINES] }
    }

    /// A triangle.
    #[inline(always)]
    fn add(&mut self, input: &Input<'_>, entry: &Entry) {
        let sides = input.edges[entry.number as usize];
        let v = &input.scene.items[entry.number as usize].vertices;
        let back = sides.contains(Sides::BACK);
        let column = self.place[0];
        if i32::from(entry.from[0]) <= column && column < i32::from(entry.to[0]) {
            let rows = [entry.from[1], entry.to[1]].map(|y| (i32::from(y) - self.place[1]).clamp(0, self.lines as i32));
            self.cover(v, back, rows);
        }
        let turn = if back { -1 } else { 1 };
        for k in (0..3).filter(|&k| !sides.shares(k)) {
            self.edge(input.setting, &v[k], &v[after(k)], turn);
        }
    }

    /// What a triangle covers of the first column's centres: the lines, which it does as far as they show.
    #[inline(always)]
    fn cover(&mut self, v: &[ScreenVertex; 3], back: bool, [first, beyond]: [i32; 2]) {
        let order = if back { [0, 2, 1] } else { [0, 1, 2] };
        let px = i64::from(self.place[0] * PIXEL + CENTRE);
        let py = i64::from((self.place[1] + first) * PIXEL + CENTRE);
        let mut at = [0; 3];
        let mut step = [0; 3];
        for k in 0..3 {
            let (a, b) = (&v[order[k]], &v[order[after(k)]]);
            let (dx, dy) = (i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y));
            let owner = dy < 0 || (dy == 0 && dx > 0);
            at[k] = dx * (py - i64::from(a.y)) - dy * (px - i64::from(a.x)) - i64::from(!owner);
            step[k] = dx * i64::from(PIXEL);
        }
        for counts in &mut self.counts[first as usize..beyond as usize] {
            let covered = i16::from((at[0] | at[1] | at[2]) >= 0);
            counts.iter_mut().for_each(|count| *count += covered);
            (0..3).for_each(|k| at[k] += step[k]);
        }
    }

    /// An edge from `a` to `b`; `turn` says by how much more what lies to the right of it is covered where it goes up.
    #[inline(always)]
    fn edge(&mut self, setting: &Setting, a: &ScreenVertex, b: &ScreenVertex, turn: i16) {
        let [left, above] = setting.pitch.map(|bits| f64::from(1_u32 << bits) / 2.0);
        let pixel = f64::from(PIXEL);
        // In u, from the tile's corner.
        let [ax, bx] = [a.x, b.x].map(|x| i64::from(x) - i64::from(self.place[0] * PIXEL));
        let [ay, by] = [a.y, b.y].map(|y| i64::from(y) - i64::from(self.place[1] * PIXEL));
        let width = LANES as i64 * i64::from(PIXEL);
        if ax.max(bx) < 0 || ax.min(bx) > width {
            return;
        }
        let (low, high) = (ay.min(by), ay.max(by));
        let first = (low >> 8).max(0);
        let beyond = ((high >> 8) + 1).min(self.lines as i64);
        let (x0, y0) = (ax as f64, ay as f64);
        let slope = if ay == by { 0.0 } else { (bx - ax) as f64 / (by - ay) as f64 };
        for line in first..beyond {
            let row = line * i64::from(PIXEL);
            let (from, to) = ((low as f64).max(row as f64 + above), (high as f64).min(row as f64 + pixel - above));
            if from <= to {
                let [from, to] = if ay == by { [x0, bx as f64] } else { [from, to].map(|y| x0 + (y - y0) * slope) };
                let (from, to) = (from.min(to) - SPARE, from.max(to) + SPARE);
                // Columns whose samples' rectangle it may meet; casts go towards 0, so none is less than 0.
                let first = ((from + left) / pixel).clamp(0.0, LANES as f64) as u32;
                let last = ((to - left + pixel) / pixel).clamp(0.0, LANES as f64) as u32;
                self.borders[line as usize] |= (((1_u32 << last) - 1) & !((1 << first) - 1)) as u16;
            }
            let centre = row + i64::from(CENTRE);
            if (ay <= centre) != (by <= centre) {
                // Where it crosses the line is right of the first centre.
                let right = (ax - i64::from(CENTRE)) * (by - ay) + (centre - ay) * (bx - ax);
                if right.signum() * (by - ay).signum() > 0 {
                    let x = x0 + (centre as f64 - y0) * slope;
                    let column = (((x - f64::from(CENTRE)) / pixel).clamp(0.0, LANES as f64) as usize + 1) as u16;
                    let turn = if by < ay { turn } else { -turn };
                    for (count, lane) in self.counts[line as usize].iter_mut().zip(0_u16..) {
                        *count += if lane >= column { turn } else { 0 };
                    }
                }
            }
        }
    }

    /// The pixels of a line that are covered once everywhere, and those that are not covered at all.
    #[inline(always)]
    fn covered(&self, line: usize) -> [u16; 2] {
        let free = !self.borders[line];
        let of = |wanted: i16| {
            let bits = self.counts[line].iter().zip(0..).map(|(&count, lane)| u16::from(count == wanted) << lane);
            bits.fold(0, |all, bit| all | bit)
        };
        [of(1) & free, of(0) & free]
    }
}

impl Inside {
    /// Finds where the fragments of a band are to be looked for.
    pub(super) fn find(&mut self, input: &Input<'_>) {
        let words = input.words() * input.lines;
        self.looked_at.clear();
        let base = input.base_depth().filter(|_| is_worth_it(input));
        let Some(base) = base else {
            self.looked_at.resize(words, u64::MAX);
            return;
        };
        self.looked_at.resize(words, 0);
        self.visits.clear();
        self.tiles.clear();
        self.tiles.resize(input.chunks(), Tile::EMPTY);
        for (place, entry) in (0..).zip(input.items) {
            let sides = input.edges[entry.number as usize];
            if sides.contains(Sides::NOTHING) {
                continue;
            }
            let item = &input.scene.items[entry.number as usize];
            let far = farthest(input, entry, item);
            if !sides.contains(Sides::SMOOTH) || far >= base {
                self.look_at(input, entry);
            }
            if sides.contains(Sides::SMOOTH) {
                // Without depths all is one sheet.
                let depths = if input.setting.rule == Rule::Last { [0; 2] } else { [entry.nearest, far] };
                self.visit(input, place, entry, Slant::new(input, entry, item, depths));
            }
        }
        for chunk in 0..input.chunks() {
            if self.tiles[chunk].count > 0 {
                self.settle(input, chunk);
            }
        }
    }

    /// Adds a triangle to the tiles that it can touch.
    #[inline(always)]
    fn visit(&mut self, input: &Input<'_>, entry: u32, Entry { from, to, .. }: &Entry, slant: Slant) {
        debug_assert!(input.items.len() < u32::MAX as usize);
        for chunk in usize::from(from[0]) / LANES..(usize::from(to[0]) - 1) / LANES + 1 {
            let depths = slant.over(chunk);
            let tile = &mut self.tiles[chunk];
            self.visits.push(Visit { entry, next: tile.first, depths });
            *tile = Tile {
                first: self.visits.len() as u32,
                count: tile.count + 1,
                depths: [tile.depths[0].min(depths[0]), tile.depths[1].max(depths[1])],
            };
        }
    }

    /// Looks for fragments wherever an item may be.
    fn look_at(&mut self, input: &Input<'_>, entry: &Entry) {
        let [from, to] = [entry.from, entry.to].map(|place| place.map(usize::from));
        let top = input.top as usize;
        for line in from[1].max(top)..to[1].min(top + input.lines) {
            for word in from[0] / 64..(to[0] - 1) / 64 + 1 {
                self.looked_at[(line - top) * input.words() + word] |= bits_of(word, from[0], to[0]);
            }
        }
    }

    /// Looks at the pixels of a tile that are not certainly inside, or empty.
    fn settle(&mut self, input: &Input<'_>, chunk: usize) {
        let Tile { first, count, depths: [nearest, farthest] } = self.tiles[chunk];
        let range = farthest.wrapping_sub(nearest) as u32;
        let shift = (32 - range.leading_zeros()).saturating_sub(6);
        let slice = |depth: i32| depth.wrapping_sub(nearest) as u32 >> shift;
        let visits = &self.visits;
        let each = || {
            let at = |place: u32| (place != 0).then(|| &visits[place as usize - 1]);
            std::iter::successors(at(first), move |visit| at(visit.next))
        };
        // Depths that there is something at.
        let mut taken = each().fold(0_u64, |taken, &Visit { depths: [near, far], .. }| {
            taken | (u64::MAX << slice(near) & u64::MAX >> (63 - slice(far)))
        });
        // Pixels that the sheets so far do not touch, and those that are inside.
        let (mut left, mut inside) = ([u16::MAX; LINES], [0; LINES]);
        for _ in 0..SHEETS {
            if taken == 0 || count > MOST || left == [0; LINES] {
                break;
            }
            let from = taken.trailing_zeros();
            let slices = (taken >> from).trailing_ones();
            taken &= !(u64::MAX >> (64 - slices) << from);
            let mut sheet = Sheet::new(input, chunk);
            for visit in each().filter(|visit| (from..from + slices).contains(&slice(visit.depths[0]))) {
                sheet.add(input, &input.items[visit.entry as usize]);
            }
            for line in 0..input.lines {
                let [once, never] = sheet.covered(line);
                inside[line] |= left[line] & once;
                left[line] &= never;
            }
        }
        for line in 0..input.lines {
            let empty = if taken == 0 { left[line] } else { 0 };
            let looked_at = u64::from(!(inside[line] | empty));
            self.looked_at[line * input.words() + chunk / 4] |= looked_at << (chunk % 4 * LANES);
        }
    }
}

/// Depths of a triangle on the lines of a band, column by column; near enough.
#[derive(Clone, Copy, Debug)]
struct Slant {
    /// At the left edge of the target, half-way between the lines that it meets; change for one pixel to the right.
    middle: f64,
    along: f64,
    /// To the nearest and the farthest depth there, and what rounding may add.
    spare: f64,
    limits: [i32; 2],
    columns: [f64; 2],
}

/// A change of depths for one pixel beyond which those of the vertices must do.
const STEEP: f64 = (1 << 20) as f64;

impl Slant {
    #[inline(always)]
    fn new(input: &Input<'_>, entry: &Entry, item: &Item, limits: [i32; 2]) -> Slant {
        let [from, to] = [entry.from, entry.to].map(|place| place.map(f64::from));
        let columns = [from[0], to[0]];
        let [a, b, c] = item.vertices.map(|v| [f64::from(v.x), f64::from(v.y), f64::from(v.z)]);
        let [b, c] = [b, c].map(|v| [v[0] - a[0], v[1] - a[1], v[2] - a[2]]);
        let scale = f64::from(PIXEL) / (b[0] * c[1] - c[0] * b[1]);
        let along = (b[2] * c[1] - c[2] * b[1]) * scale;
        let down = (b[0] * c[2] - c[0] * b[2]) * scale;
        let gentle = along.abs() + down.abs() < STEEP;
        if limits[0] == limits[1] || !gentle {
            return Slant { middle: f64::from(limits[0]), along: 0.0, spare: f64::INFINITY, limits, columns };
        }
        let top = from[1].max(f64::from(input.top));
        let bottom = to[1].min(f64::from(input.top + input.lines as i32));
        let pixel = f64::from(PIXEL);
        let middle = a[2] + ((top + bottom) / 2.0 - a[1] / pixel) * down - a[0] / pixel * along;
        // A gradient is rounded to so many bits, and taken along at most so many pixels; depths are rounded once more.
        let rounding =
            (columns[1] - columns[0] + to[1] - from[1]) / f64::from(1_u32 << input.setting.format.fraction());
        Slant { middle, along, spare: (bottom - top) / 2.0 * down.abs() + rounding + 2.0, limits, columns }
    }

    /// Bounds of its depths in a chunk's columns.
    #[inline(always)]
    fn over(&self, chunk: usize) -> [i32; 2] {
        let x = (chunk * LANES) as f64;
        let (left, right) = (x.max(self.columns[0]), (x + LANES as f64).min(self.columns[1]));
        let middle = self.middle + (left + right) / 2.0 * self.along;
        let reach = (right - left) / 2.0 * self.along.abs() + self.spare;
        let [near, far] = self.limits;
        [((middle - reach).floor() as i32).clamp(near, far), ((middle + reach).ceil() as i32).clamp(near, far)]
    }
}

/// Whether there is much inside surfaces, and memory for it: of half of a band's triangles all edges are shared, and they
/// meet few tiles each.
fn is_worth_it(input: &Input<'_>) -> bool {
    let inner = |entry: &&Entry| input.edges[entry.number as usize].contains(Sides::INNER);
    let tiles = |entry: &Entry| usize::from(entry.to[0] - entry.from[0]) / LANES + 2;
    !input.edges.is_empty()
        && 2 * input.items.iter().filter(inner).count() > input.items.len()
        && input.items.iter().map(tiles).sum::<usize>() <= VISITS
}

/// No depth of an item is farther, as [`Entry::nearest`] has it.
#[inline(always)]
fn farthest(input: &Input<'_>, entry: &Entry, item: &Item) -> i32 {
    let [a, b, c] = &item.vertices;
    if input.setting.rule == Rule::Last { entry.nearest } else { a.z.max(b.z).max(c.z) as i32 }
}

impl Setting {
    /// Whether pixels inside a surface keep what the path drew.
    #[must_use]
    pub fn looks_inside(&self) -> bool {
        self.edges == SubpixelEdges::Borders && self.rule != Rule::InOrder
    }
}

impl Work {
    /// The pixels of a chunk in which fragments are looked for.
    #[inline(always)]
    pub(super) fn looks_at(&self, input: &Input<'_>, line: usize, chunk: usize) -> u32 {
        (self.inside.looked_at[line * input.words() + chunk / 4] >> (chunk % 4 * LANES)) as u32 & 0xFFFF
    }
}

/// Whether a border of a triangle passes between the samples of pixel (`x`, `y`): meets the rectangle that they span.
pub(super) fn meets_border(setting: &Setting, item: &Item, sides: Sides, [x, y]: [i32; 2]) -> bool {
    if sides.contains(Sides::INNER) {
        return false;
    }
    // It has edges that are nobody's borders: what it shows goes on nowhere.
    if !sides.contains(Sides::SMOOTH) {
        return true;
    }
    let spare = setting.pitch.map(|bits| (1_i64 << bits) / 2);
    let (x, y) = (i64::from(x) * i64::from(PIXEL), i64::from(y) * i64::from(PIXEL));
    let (left, right) = (x + spare[0], x + i64::from(PIXEL) - spare[0]);
    let (top, bottom) = (y + spare[1], y + i64::from(PIXEL) - spare[1]);
    (0..3).filter(|&k| !sides.shares(k)).any(|k| {
        let [a, b] = [k, after(k)].map(|k| [item.vertices[k].x, item.vertices[k].y].map(i64::from));
        let apart = |c: usize, low: i64, high: i64| a[c].max(b[c]) < low || a[c].min(b[c]) > high;
        if apart(0, left, right) || apart(1, top, bottom) {
            return false;
        }
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let beside = |x: i64, y: i64| (dx * (y - a[1]) - dy * (x - a[0])).signum();
        let corners = [beside(left, top), beside(right, top), beside(left, bottom), beside(right, bottom)];
        // It does unless all corners lie on one side of its line.
        !(corners.iter().all(|&side| side > 0) || corners.iter().all(|&side| side < 0))
    })
}
