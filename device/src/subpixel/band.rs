//! A band: some lines of pixels, from items to resolved pixels.
//!
//! Duties: what the items cover, from the nearest to the farthest; which fragments are hidden; which pixels are active;
//! the list of each. Inputs from: [`super::scene`]. Outputs to: [`super::pixel`]. The clocks are those of a mask.
//!
//! While items are gone through, everything that is certainly hidden by what came before is left out: an item all of
//! whose pixels are, without being set up. What is hidden by definition follows from what is left
//! ([`super::left`]); so the order in which items come saves time and changes nothing.
//!
//! Everything here must equal [`super::specification`] at every SIMD level.

use super::bands::Entry;
use super::brief::Brief;
use super::edges::Sides;
use super::finish::Pixels;
use super::hide::{Depths, OPEN, Span, UNTOUCHED};
use super::inside::Inside;
use super::left;
use super::lists::{Fragment, Lists};
use super::looked::Looked;
use super::map::Reason;
use super::parts::Resolver;
use super::piece::{Cover, Piece, extent};
use super::rows::Visit;
use super::runs::Runs;
use super::scene::{Base, Item, Rule, Scene};
use super::shader::{Rings, Shader};
use super::{Counts, Setting, specification};
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::{Level, Simd, dispatch};

/// Lines of a band.
pub const LINES: usize = 16;

/// Memory of one thread.
#[derive(Debug, Default)]
pub struct Work {
    /// Items of the band, set up.
    pub pieces: Vec<Piece>,
    /// Of the specification: what each piece covers, and where at most: first column and row, first beyond.
    pub covers: Vec<(Cover, [[i32; 2]; 2])>,
    /// Where fragments are looked for.
    pub(super) inside: Inside,
    /// Fragments as they are found.
    pub(super) lists: Lists,
    pub(super) spans: Vec<Span>,
    /// Chunks that the last piece meets.
    pub(super) visits: Vec<Visit>,
    pub(super) runs: Runs,
    /// For the chunks below one another on all lines the piece that covers them, [`UNTOUCHED`], or [`OPEN`] where each has
    /// its own owner.
    pub(super) columns: Vec<u32>,
    /// For each such chunk the piece that covers it, [`UNTOUCHED`] or [`OPEN`].
    pub(super) owners: Vec<u32>,
    /// A bit a pixel that may be active; rows of [`Input::words`] words.
    pub(super) active: Vec<u64>,
    /// For each such chunk, where it is open, the depths of its pixels.
    pub(super) depths: Vec<Depths>,
    /// Whole covers of a pixel, where no rule says which hide which.
    pub(super) stacked: Vec<u8>,
    /// Items of the band that may be where fragments are looked for.
    found: Vec<Entry>,
    /// The same from the nearest to the farthest, so far as that may save time.
    order: Vec<Entry>,
    /// Fragments of one pixel.
    list: Vec<Fragment>,
    /// Fragments in the lists of each line.
    pub(super) used: [usize; LINES],
    /// Lanes in which colours are found and depths compared; by the specification without.
    pub(super) level: Option<Level>,
    /// The pieces in brief.
    pub(super) briefs: Vec<Brief>,
    pub(super) pixels: Pixels,
    pub(super) resolver: Resolver,
    pub(super) shader: Shader,
    pub(super) rings: Rings,
}

/// What a band is given.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// What all pixels share.
    pub setting: &'a Setting,
    /// The scene.
    pub scene: &'a Scene,
    /// Items that can touch the band, in order of submission.
    pub items: &'a [Entry],
    /// What is known of the edges of each item of the scene; empty if all are anti-aliased.
    pub edges: &'a [Sides],
    /// The first item of the surface that each is part of; the specification has no use for that.
    pub surfaces: &'a [u32],
    /// First line.
    pub top: i32,
    /// Lines.
    pub lines: usize,
}

impl Input<'_> {
    /// Chunks of a line.
    #[must_use]
    pub fn chunks(&self) -> usize {
        (self.setting.size[0] as usize).div_ceil(LANES)
    }

    /// Pixels from a line to the next in arrays of depths.
    #[must_use]
    pub fn pitch(&self) -> usize {
        self.chunks() * LANES
    }

    /// Words from a line to the next in [`Work::active`].
    #[must_use]
    pub fn words(&self) -> usize {
        self.pitch().div_ceil(64)
    }

    /// All of the band: first column and row, first beyond.
    fn all(&self) -> [[i32; 2]; 2] {
        [[0, self.top], [self.setting.size[0] as i32, self.top + self.lines as i32]]
    }

    /// The farthest depth before the first item, where all pixels have one; what is nearer hides it.
    pub(super) fn base_depth(&self) -> Option<i32> {
        match (&self.scene.depth, self.setting.rule) {
            (_, Rule::Last) => Some(1),
            (Base::Uniform(depth), _) => Some(*depth),
            _ => None,
        }
    }

    /// Depth before the first item of a pixel, as fragments are compared with it.
    #[must_use]
    #[inline(always)]
    pub fn base_at(&self, x: usize, line: usize) -> i32 {
        match self.setting.rule {
            Rule::Last => 1,
            _ => self.scene.depth.at((self.top as usize + line) * self.setting.size[0] as usize + x),
        }
    }

    /// Whether a piece that covers a whole pixel may pass at some of its samples only, by what was there before.
    #[must_use]
    pub fn undecided(&self, piece: &Piece) -> bool {
        let tested = self.scene.draws[piece.draw as usize].test.is_some();
        match self.setting.rule {
            Rule::Last => false,
            Rule::Nearest => self.base_depth().is_none_or(|base| piece.plane.maximum >= base),
            Rule::InOrder => {
                let range = [piece.plane.minimum, piece.plane.maximum];
                tested && self.base_depth().is_none_or(|base| range[0] <= base && base <= range[1])
            }
        }
    }

    /// Rows and columns of an area that an item can touch.
    pub(super) fn area(&self, item: &Item, [low, high]: [[i32; 2]; 2]) -> [[i32; 2]; 2] {
        let [from, to] = extent(item, &self.scene.draws[item.draw as usize]);
        [[from[0].max(low[0]), from[1].max(low[1])], [to[0].min(high[0]), to[1].min(high[1])]]
    }
}

/// Pixels of a band that were resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolved {
    /// Column.
    pub x: u16,
    /// Row of the target.
    pub y: u16,
    /// RGBA, R in 7:0; of a degraded pixel it means nothing.
    pub colour: u32,
    /// Why.
    pub reason: Reason,
}

impl Resolved {
    /// The pixel keeps what the path drew.
    #[must_use]
    pub fn is_degraded(&self) -> bool {
        self.reason == Reason::Degraded
    }
}

/// Buckets that items are sorted into by their depth: few, so that neighbours stay together in memory.
const BUCKETS: usize = 128;

/// Puts the items of a band that may be where fragments are looked for in order, from the nearest to the farthest, so well
/// as the buckets have it; of each what lies there.
#[inline(always)]
fn sort<S: Simd>(simd: S, input: &Input<'_>, looked: &Looked, [found, order]: [&mut Vec<Entry>; 2]) {
    order.clear();
    if input.setting.rule == Rule::InOrder {
        order.extend_from_slice(input.items);
        return;
    }
    found.clear();
    for entry in input.items {
        if let Some([from, to]) = looked.within(simd, [entry.from, entry.to]) {
            found.push(Entry { from, to, ..*entry });
        }
    }
    let least = found.iter().map(|entry| entry.nearest).min().unwrap_or(0);
    let greatest = found.iter().map(|entry| entry.nearest).max().unwrap_or(0);
    let range = greatest.wrapping_sub(least) as u32;
    let shift = (32 - range.leading_zeros()).saturating_sub(BUCKETS.ilog2());
    let bucket = |entry: &Entry| (entry.nearest.wrapping_sub(least) as u32 >> shift) as usize;
    let mut starts = [0_u32; BUCKETS + 1];
    for entry in &*found {
        starts[bucket(entry) + 1] += 1;
    }
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    order.resize(found.len(), Entry::default());
    for entry in found {
        let start = &mut starts[bucket(entry)];
        order[*start as usize] = *entry;
        *start += 1;
    }
}

impl Work {
    /// Resolves the active pixels of a band, by lanes of `level` or by the specification.
    pub fn draw(&mut self, level: Option<Level>, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
        self.used = [0; LINES];
        self.level = level;
        match level {
            Some(level) => {
                dispatch!(level, simd => self.find(simd, input));
                self.draw_part(level, input, input.all(), out, counts);
            }
            None => specification::draw(self, input, out, counts),
        }
        for &used in &self.used[..input.lines] {
            counts.fragments += used as u64;
            counts.most = counts.most.max(used as u64);
        }
    }

    /// Finds where fragments are looked for, and the items there.
    #[inline(always)]
    fn find<S: Simd>(&mut self, simd: S, input: &Input<'_>) {
        self.inside.find(simd, input);
        sort(simd, input, &self.inside.looked, [&mut self.found, &mut self.order]);
    }

    /// The same for an area, in halves where there are too many fragments for the memory of a thread.
    fn draw_part(
        &mut self,
        level: Level,
        input: &Input<'_>,
        area: [[i32; 2]; 2],
        out: &mut Vec<Resolved>,
        counts: &mut Counts,
    ) {
        self.begin(input);
        match (input.setting.grid.columns(), input.setting.grid.rows()) {
            (4, _) => dispatch!(level, simd => self.gather::<_, 4, 4>(simd, input, area)),
            (_, 4) => dispatch!(level, simd => self.gather::<_, 8, 4>(simd, input, area)),
            _ => dispatch!(level, simd => self.gather::<_, 8, 8>(simd, input, area)),
        }
        if !self.lists.is_full() {
            return self.finish(input, out, counts);
        }
        self.each_active(input, |work, at, _| work.lists.drop(at));
        let [[left, first], [right, beyond]] = area;
        if beyond - first > 1 {
            // Line by line: a line's lists are served from left to right.
            for y in first..beyond {
                self.draw_part(level, input, [[left, y], [right, y + 1]], out, counts);
            }
        } else {
            let middle = left + (right - left) / 2;
            self.draw_part(level, input, [[left, first], [middle, beyond]], out, counts);
            self.draw_part(level, input, [[middle, first], [right, beyond]], out, counts);
        }
    }

    /// Empties everything.
    fn begin(&mut self, input: &Input<'_>) {
        self.pieces.clear();
        self.spans.clear();
        self.lists.begin(input);
        self.runs.clear();
        self.active.clear();
        self.active.resize(input.words() * input.lines, 0);
        let chunks = input.chunks() * input.lines;
        self.depths.resize(chunks.max(self.depths.len()), Depths::ALL);
        // Without a rule nothing hides anything.
        let ordered = input.setting.rule == Rule::InOrder;
        self.columns.clear();
        self.columns.resize(input.chunks(), if ordered { OPEN } else { UNTOUCHED });
        self.owners.resize(chunks, OPEN);
        if ordered {
            self.owners.fill(OPEN);
            self.depths[..chunks].fill(Depths::ALL);
        }
    }

    /// Finds the fragments in an area, as far as they may be seen, and the pixels that may be active.
    #[inline(always)]
    fn gather<S: Simd, const C: usize, const R: usize>(&mut self, simd: S, input: &Input<'_>, area: [[i32; 2]; 2]) {
        let scene = input.scene;
        let ordered = input.setting.rule == Rule::InOrder;
        let [low, high] = area;
        for k in 0..self.order.len() {
            let Entry { number, nearest, from, to, .. } = self.order[k];
            let from = [i32::from(from[0]).max(low[0]), i32::from(from[1]).max(low[1])];
            let to = [i32::from(to[0]).min(high[0]), i32::from(to[1]).min(high[1])];
            if from[0] >= to[0] || from[1] >= to[1] || (!ordered && self.is_hidden(simd, input, nearest, [from, to])) {
                continue;
            }
            let item = &scene.items[number as usize];
            let draw = &scene.draws[item.draw as usize];
            let piece = Piece::new(input.setting, number, item, draw, input.top);
            self.cover::<S, C, R>(simd, input, piece, [from, to]);
            if self.lists.is_full() {
                return;
            }
        }
        let layers = scene.draws.iter().any(|draw| draw.blend || draw.has_holes());
        if layers {
            self.select(simd, input, true);
        }
        if input.setting.rule == Rule::InOrder {
            self.count_covers(input);
        } else {
            self.cross(simd, input);
        }
        self.select(simd, input, false);
    }

    /// Adds the pixels of spans as fragments, if nothing hides them: of layers all, which become active; of the others
    /// those that may be active.
    #[inline(always)]
    fn select<S: Simd>(&mut self, simd: S, input: &Input<'_>, layers: bool) {
        let (pitch, words) = (input.pitch(), input.words());
        let full = input.setting.grid.full();
        for place in 0..self.spans.len() {
            let span = self.spans[place];
            if self.pieces[span.piece as usize].layer != layers {
                continue;
            }
            let line = usize::from(span.line);
            let [from, to] = span.columns.map(usize::from);
            if layers {
                (from / LANES..(to - 1) / LANES + 1).for_each(|chunk| self.open(simd, input, line, chunk));
            }
            let piece = &self.pieces[span.piece as usize];
            let y = input.top + i32::from(span.line);
            for word in from / 64..(to - 1) / 64 + 1 {
                let inside = bits_of(word, from, to);
                let active = &mut self.active[line * words + word];
                let mut left = if layers { inside } else { *active & inside };
                if left == 0 {
                    continue;
                }
                if !self.lists.has_room(left.count_ones() as usize) {
                    return;
                }
                while left != 0 {
                    let x = word * 64 + left.trailing_zeros() as usize;
                    left &= left - 1;
                    let bounds = piece.bounds(x as i32, y);
                    let at = line * pitch + x;
                    if bounds[0] <= self.depths[at / LANES].far[at % LANES] {
                        *active |= 1 << (x % 64);
                        self.lists.put(at, Fragment::new(full, span.piece, bounds));
                    }
                }
            }
        }
    }

    /// Calls `each` with the place and the column of every pixel that may be active, line by line.
    #[inline(always)]
    fn each_active(&mut self, input: &Input<'_>, mut each: impl FnMut(&mut Work, usize, [usize; 2])) {
        for line in 0..input.lines {
            for word in 0..input.words() {
                let mut left = self.active[line * input.words() + word];
                while left != 0 {
                    let x = word * 64 + left.trailing_zeros() as usize;
                    left &= left - 1;
                    each(self, line * input.pitch() + x, [x, line]);
                }
            }
        }
    }

    /// Resolves the pixels that may be active, and are.
    fn finish(&mut self, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
        self.open_pixels(input);
        let mut list = std::mem::take(&mut self.list);
        self.each_active(input, |work, at, place| {
            work.lists.take(at, &mut list);
            if let Some(apart) = left::keep(work, input, &mut list, place) {
                work.take_up(input, &list, place, apart, out, counts);
            }
        });
        self.list = list;
        self.close_pixels(input, out, counts);
    }
}

/// The bits of word `word` of a bit field that lie in `from..to`; at least one does.
#[inline(always)]
pub(super) fn bits_of(word: usize, from: usize, to: usize) -> u64 {
    let low = from.saturating_sub(word * 64).min(63);
    let high = (to - word * 64).min(64);
    (u64::MAX << low) & (u64::MAX >> (64 - high))
}
