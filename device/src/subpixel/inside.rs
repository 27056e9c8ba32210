//! Pixels inside a surface, which keep what the path drew.
//!
//! What is left of a pixel's fragments lies *inside* a surface if it covers every sample once, and no border of it passes
//! between the samples. That is decided fragment by fragment ([`super::left`]); here is found where it need not be asked:
//! fragments are only looked for in the other pixels.
//!
//! A *tile* is the 16 lines of a band by the 16 columns of a chunk. The triangles that can touch a tile are parted into
//! *sheets*, one for each surface that these are of ([`super::edges`]). A pixel that one sheet covers once, with nothing of
//! another before its depths there or among them, is inside; one that no sheet covers is empty ([`super::sheet`]). In a
//! tile without borders, whose front and back are apart in depth, one pixel stands for all.
//!
//! Everything here may err towards pixels that are looked at.
//!
//! Inputs from: [`super::bands`], [`super::edges`]. Outputs to: [`super::looked`]. Clocks: none of its own.

use super::Setting;
use super::band::Input;
use super::bands::Entry;
use super::edges::{Sides, after};
use super::looked::Looked;
use super::scene::{Item, Rule};
use super::sheet::{Nearest, Sheet};
use super::slant::Slant;
use crate::geometry::PIXEL;
use crate::hidden::z_buffer::kernel::LANES;
use crate::hidden::z_buffer::specification::covers;
use fearless_simd::Simd;
use zga_abi::format::SubpixelEdges;

/// Most sheets of a tile that are looked through.
const SHEETS: usize = 16;
/// Most triangles of a tile that are: a count of 16 bits holds all that their edges change.
const MOST: usize = 4096;
/// Most triangles in all tiles of a band: 5 MiB a thread.
const VISITS: usize = 1 << 18;
/// Pixels from which on the depths of a triangle are bounded tile by tile.
const LARGE: u16 = 2 * LANES as u16;

/// A triangle in a tile.
#[derive(Clone, Copy, Debug)]
struct Visit {
    /// Place in [`Input::items`].
    entry: u32,
    /// The next of the same tile, plus 1; 0 if there is none.
    next: u32,
    /// It covers the centre of the tile's first pixel; it has borders.
    covers: bool,
    borders: bool,
    /// Bounds of its depths in the tile.
    depths: [i32; 2],
}

/// A triangle of the tile that is settled.
#[derive(Clone, Copy, Debug)]
struct Member {
    /// Place in [`Input::items`].
    entry: u32,
    sheet: u32,
    /// It has borders.
    borders: bool,
    /// Bounds of its depths in the tile.
    depths: [i32; 2],
}

/// Of which triangles of a sheet the depths are bounded pixel by pixel, and bounds of those of the others.
#[derive(Clone, Copy, Debug)]
struct Limits {
    asked: [i32; 2],
    bounds: [i32; 2],
}

impl Limits {
    /// Whether a triangle with these depths is one.
    #[inline(always)]
    fn asks(&self, depths: [i32; 2]) -> bool {
        depths[0] <= self.asked[1] && self.asked[0] <= depths[1]
    }
}

/// Bounds of no depths.
const NONE: [i32; 2] = [i32::MAX, i32::MIN];

/// Bounds of the depths of two.
#[inline(always)]
fn both(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// What of a surface is in the tile that is settled.
#[derive(Clone, Copy, Debug)]
struct Extent {
    surface: u32,
    /// How often it covers the centre of the tile's first pixel.
    covers: i16,
    /// Bounds of its depths.
    depths: [i32; 2],
}

/// The triangles of a tile.
#[derive(Clone, Copy, Debug)]
struct Tile {
    /// The first, plus 1.
    first: u32,
    count: usize,
    /// Bounds of the depths of what faces the viewer, and of what faces away.
    depths: [[i32; 2]; 2],
    /// How often the centre of its first pixel is covered by them.
    covers: [u32; 2],
    /// It may have borders.
    borders: bool,
}

impl Tile {
    const EMPTY: Tile = Tile { first: 0, count: 0, depths: [NONE; 2], covers: [0; 2], borders: false };

    /// Whether it is certain that each of its pixels is inside, or empty.
    #[inline(always)]
    fn is_whole(&self) -> bool {
        let [front, back] = self.depths;
        let apart = front[1] < back[0] || back[1] < front[0];
        let nearer = usize::from(back[0] < front[0]);
        let [before, behind] = [self.covers[nearer], self.covers[1 - nearer]];
        !self.borders && (before == 1 || (before == 0 && behind <= 1)) && (apart || before + behind <= 1)
    }
}

/// Where a band is looked at.
#[derive(Debug, Default)]
pub(super) struct Inside {
    /// Where fragments are looked for.
    pub(super) looked: Looked,
    tiles: Vec<Tile>,
    visits: Vec<Visit>,
    members: Vec<Member>,
    sheets: Vec<Extent>,
    sheet: Sheet,
    nearest: Nearest,
}

impl Inside {
    /// Finds where the fragments of a band are to be looked for.
    #[inline(always)]
    pub(super) fn find<S: Simd>(&mut self, simd: S, input: &Input<'_>) {
        let base = input.base_depth().filter(|_| is_worth_it(input));
        self.looked.begin(input, base.is_none());
        let Some(base) = base else {
            return;
        };
        self.visits.clear();
        self.tiles.clear();
        self.tiles.resize(input.chunks(), Tile::EMPTY);
        for (place, entry) in (0..).zip(input.items) {
            let sides = input.edges[entry.number as usize];
            if sides.contains(Sides::NOTHING) {
                continue;
            }
            if !sides.contains(Sides::SMOOTH) || entry.farthest >= base {
                self.looked.add_all(input, entry);
            }
            if sides.contains(Sides::SMOOTH) {
                self.visit(input, place, entry, sides);
            }
        }
        for chunk in 0..input.chunks() {
            if self.tiles[chunk].count > 0 && !self.tiles[chunk].is_whole() {
                self.settle(simd, input, chunk);
            }
        }
    }

    /// Adds a triangle to the tiles that it can touch.
    #[inline(always)]
    fn visit(&mut self, input: &Input<'_>, place: u32, entry: &Entry, sides: Sides) {
        debug_assert!(input.items.len() < u32::MAX as usize);
        let Entry { nearest, farthest, from, to, .. } = *entry;
        let item = &input.scene.items[entry.number as usize];
        // Without depths all is one sheet.
        let last = input.setting.rule == Rule::Last;
        let large = !last && (to[0] - from[0]).max(to[1] - from[1]) > LARGE;
        let slant = large.then(|| Slant::new(input, entry, item));
        let (back, borders) = (sides.contains(Sides::BACK), !sides.contains(Sides::INNER));
        for chunk in usize::from(from[0]) / LANES..(usize::from(to[0]) - 1) / LANES + 1 {
            let depths =
                slant.as_ref().map_or(if last { [0; 2] } else { [nearest, farthest] }, |slant| slant.over(chunk));
            let tile = &mut self.tiles[chunk];
            let column = chunk * LANES;
            let covers = usize::from(from[0]) <= column
                && i32::from(from[1]) <= input.top
                && covers(&item.vertices, column as i32, input.top);
            self.visits.push(Visit { entry: place, next: tile.first, covers, borders, depths });
            tile.first = self.visits.len() as u32;
            tile.count += 1;
            tile.depths[usize::from(back)] = both(tile.depths[usize::from(back)], depths);
            tile.borders |= borders;
            tile.covers[usize::from(back)] += u32::from(covers);
        }
    }

    /// Looks at the pixels of a tile that are not certainly inside, or empty.
    #[inline(always)]
    fn settle<S: Simd>(&mut self, simd: S, input: &Input<'_>, chunk: usize) {
        let Tile { first, count, .. } = self.tiles[chunk];
        if count > MOST || !self.part(input, first) {
            (0..input.lines).for_each(|line| self.looked.add(line, chunk, u16::MAX));
            return;
        }
        self.nearest.begin();
        for place in 0..self.sheets.len() {
            let limits = self.limits(place, input.setting.rule == Rule::Last);
            self.sheet.begin(input, chunk, self.sheets[place].covers, limits.bounds);
            for member in self.members.iter().filter(|member| member.sheet as usize == place) {
                let asked = limits.asks(member.depths);
                if member.borders || asked {
                    let entry = &input.items[member.entry as usize];
                    self.sheet.add(simd, input, entry, [member.borders, asked]);
                }
            }
            self.nearest.add(simd, &self.sheet);
        }
        for line in 0..input.lines {
            self.looked.add(line, chunk, self.nearest.uncertain(simd, line));
        }
    }

    /// Parts the triangles of a tile into sheets; false if there are too many.
    #[inline(always)]
    fn part(&mut self, input: &Input<'_>, first: u32) -> bool {
        self.members.clear();
        self.sheets.clear();
        let mut next = first;
        while next != 0 {
            let visit = &self.visits[next as usize - 1];
            let Visit { entry, covers, borders, depths, .. } = *visit;
            next = visit.next;
            let surface = input.surfaces[input.items[entry as usize].number as usize];
            let sheet = match self.sheets.iter().position(|sheet| sheet.surface == surface) {
                Some(sheet) => sheet,
                None if self.sheets.len() == SHEETS => return false,
                None => {
                    self.sheets.push(Extent { surface, covers: 0, depths });
                    self.sheets.len() - 1
                }
            };
            self.sheets[sheet].depths = both(self.sheets[sheet].depths, depths);
            self.sheets[sheet].covers += i16::from(covers);
            self.members.push(Member { entry, sheet: sheet as u32, borders, depths });
        }
        true
    }

    /// Of which triangles of a sheet depths are bounded pixel by pixel; `last` where there are none.
    #[inline(always)]
    fn limits(&self, place: usize, last: bool) -> Limits {
        let own = self.sheets[place].depths;
        let (first, rest) = (&self.sheets[..place], &self.sheets[place + 1..]);
        let others = first.iter().chain(rest).fold(NONE, |all, other| both(all, other.depths));
        if last || own[1] < others[0] || others[1] < own[0] {
            return Limits { asked: NONE, bounds: own };
        }
        // Of a sheet that begins before all others, what lies before all of them is bounded at once, and else what lies
        // behind all of them: for both there would be nothing between.
        let before = own[0] < others[0];
        let asked = if before { [others[0], i32::MAX] } else { [i32::MIN, others[1]] };
        let mut limits = Limits { asked, bounds: NONE };
        for member in self.members.iter().filter(|member| member.sheet as usize == place) {
            if !limits.asks(member.depths) {
                limits.bounds = both(limits.bounds, member.depths);
            }
        }
        // What is not known of them from below, or from above, is that of the sheet.
        limits.bounds[usize::from(!before)] = own[usize::from(!before)];
        limits
    }
}

/// Whether there may be something inside surfaces, and memory for it: a shared edge for every eight items of a band, which
/// saves more than these cost, and few tiles that they meet.
fn is_worth_it(input: &Input<'_>) -> bool {
    if input.edges.is_empty() {
        return false;
    }
    let (mut shared, mut tiles) = (0, 0);
    for entry in input.items {
        shared += (input.edges[entry.number as usize] & Sides::INNER).bits().count_ones() as usize;
        tiles += usize::from(entry.to[0] - entry.from[0]) / LANES + 2;
    }
    8 * shared > input.items.len() && tiles <= VISITS
}

impl Setting {
    /// Whether pixels inside a surface keep what the path drew.
    #[must_use]
    pub fn looks_inside(&self) -> bool {
        self.edges == SubpixelEdges::Borders && self.rule != Rule::InOrder
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
