//! A band: some lines of pixels, from items to lists of fragments.
//!
//! Duties: the masks of all pieces on their rows, 16 rows of samples at a time; which fragments are hidden by one that
//! covers the whole pixel; which pixels are active; the list of each. Inputs from: [`super::scene`]. Outputs to:
//! [`super::pixel`]. The clocks are those of a mask.
//!
//! A triangle on rows of samples is walked as on rows of pixels. On each row of pixels it covers, from left to right,
//! some pixels in part, then some wholly (a *span*), then some in part. What the spans hide is found with three depths
//! a pixel: the least of the farthest depths (what lies behind it is hidden), the least and the second least of the
//! nearest ones (if the second is not hidden, two surfaces cross). They are only needed in chunks of 16 pixels in which
//! something is covered in part, or two spans meet: the inside of a surface that nothing hides is never looked at.
//!
//! Everything here must equal [`super::specification`] at every SIMD level.

use super::cover::{Row, Span};
use super::gamma::Space;
use super::lists::Lists;
use super::map::Reason;
use super::parts::Resolver;
use super::piece::{Cover, Piece, extent};
use super::pixel::Fragment;
use super::scene::{Base, Kind, Rule, Scene};
use super::shader::Shader;
use super::{Counts, Setting};
use crate::geometry::plane::below;
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::{Level, Simd, dispatch};

/// Lines of a band.
pub const LINES: usize = 16;

/// Memory of one thread.
#[derive(Debug, Default)]
pub struct Work {
    /// Items of the band, set up.
    pub pieces: Vec<Piece>,
    /// What each of them covers, and where at most: first column and row, first beyond.
    pub covers: Vec<(Cover, [[i32; 2]; 2])>,
    /// Fragments as they are found.
    pub lists: Lists,
    pub(super) spans: Vec<Span>,
    pub(super) rows: Vec<Row>,
    /// For each row the first columns of samples and the first beyond, on all its rows of samples.
    pub(super) edges: Vec<i32>,
    /// A bit a chunk: something in it is covered in part, or translucent.
    pub(super) part: Vec<u64>,
    /// A bit a chunk: a span meets it.
    pub(super) once: Vec<u64>,
    /// A bit a chunk: its depths are needed.
    pub(super) need: Vec<u64>,
    /// A bit a pixel; rows of [`Work::words`] words.
    pub active: Vec<u64>,
    /// The least farthest depth of what covers the whole pixel; rows of whole chunks.
    pub far: Vec<i32>,
    /// The least nearest depth of those.
    pub near: Vec<i32>,
    /// The second least.
    pub second: Vec<i32>,
    /// Whole covers of a pixel, where no rule says which hide which.
    pub(super) stacked: Vec<u8>,
    /// Fragments by pixel, in order of submission.
    fragments: Vec<Fragment>,
    starts: Vec<u32>,
    /// Active pixels before each word.
    ranks: Vec<u32>,
    pub(super) resolver: Resolver,
    pub(super) shader: Shader,
}

/// What a band is given.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// What all pixels share.
    pub setting: &'a Setting,
    /// The scene.
    pub scene: &'a Scene,
    /// Items that can touch the band, in order of submission.
    pub items: &'a [u32],
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

    pub(super) fn chunk_words(&self) -> usize {
        self.chunks().div_ceil(64)
    }

    /// The farthest depth before the first item, where all pixels have one; what is nearer hides it.
    pub(super) fn base_depth(&self) -> Option<i32> {
        match (&self.scene.depth, self.setting.rule) {
            (_, Rule::Last) => Some(1),
            (Base::Uniform(depth), _) => Some(*depth),
            _ => None,
        }
    }

    /// Depth before the first item of a pixel, as spans are compared with it.
    #[must_use]
    pub fn base_at(&self, x: usize, line: usize) -> i32 {
        let width = self.setting.size[0] as usize;
        match self.setting.rule {
            Rule::Last => 1,
            _ if x >= width => i32::MAX,
            _ => self.scene.depth.at((self.top as usize + line) * width + x),
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

impl Work {
    /// Finds the active pixels of a band and their fragments, with lanes.
    pub fn gather(&mut self, level: Level, input: &Input<'_>, counts: &mut Counts) {
        self.begin(input, counts);
        let grid = (input.setting.grid.columns(), input.setting.grid.rows());
        match grid {
            (4, _) => dispatch!(level, simd => self.cover::<_, 4, 4>(simd, input)),
            (_, 4) => dispatch!(level, simd => self.cover::<_, 8, 4>(simd, input)),
            _ => dispatch!(level, simd => self.cover::<_, 8, 8>(simd, input)),
        }
        if input.setting.rule == Rule::InOrder {
            self.count_covers(input);
        } else {
            dispatch!(level, simd => self.compare(simd, input));
        }
        self.find(level, input, counts);
        if self.lists.count(input) {
            // The masks are counted already.
            self.find(level, input, &mut Counts::default());
            self.lists.fit(input);
            self.find(level, input, &mut Counts::default());
        }
    }

    /// Finds the fragments that are not hidden.
    fn find(&mut self, level: Level, input: &Input<'_>, counts: &mut Counts) {
        match (input.setting.grid.columns(), input.setting.grid.rows()) {
            (4, _) => dispatch!(level, simd => self.masks::<_, 4, 4>(simd, input, counts)),
            (_, 4) => dispatch!(level, simd => self.masks::<_, 8, 4>(simd, input, counts)),
            _ => dispatch!(level, simd => self.masks::<_, 8, 8>(simd, input, counts)),
        }
        self.select(input);
    }

    /// Sets the band's items up and empties everything else.
    pub fn begin(&mut self, input: &Input<'_>, counts: &mut Counts) {
        self.pieces.clear();
        self.covers.clear();
        let scene = input.scene;
        for &number in input.items {
            let item = &scene.items[number as usize];
            let draw = &scene.draws[item.draw as usize];
            let (piece, cover) = Piece::new(input.setting, number, item, draw, input.top);
            let [[x, y], [right, bottom]] = extent(item, draw);
            // In the first band that a triangle with masks can touch its edges begin.
            counts.masks += u64::from(item.kind == Kind::Masked && y >= input.top);
            self.pieces.push(piece);
            let beyond = input.top + input.lines as i32;
            self.covers.push((cover, [[x, y.max(input.top)], [right, bottom.min(beyond)]]));
        }
        self.lists.begin(input);
        self.spans.clear();
        self.rows.clear();
        self.edges.clear();
        let chunk_words = input.chunk_words() * input.lines;
        for bits in [&mut self.part, &mut self.once, &mut self.need] {
            bits.clear();
            bits.resize(chunk_words, 0);
        }
        self.active.clear();
        self.active.resize(input.words() * input.lines, 0);
    }

    /// Masks of the pixels that triangles cover in part, unless something hides them there: fragments that make their
    /// pixels active.
    #[inline(always)]
    fn masks<S: Simd, const C: usize, const R: usize>(&mut self, _simd: S, input: &Input<'_>, counts: &mut Counts) {
        let (width, pitch, words) = (input.setting.size[0] as usize, input.pitch(), input.words());
        let below = below(input.setting.format);
        let (rows, edges) = (&self.rows, self.edges.as_chunks::<R>().0);
        for (row, edges) in rows.iter().zip(edges.as_chunks::<2>().0) {
            let piece = &self.pieces[row.piece as usize];
            let [froms, tos] = edges;
            let line = usize::from(row.line);
            let y = input.top + i32::from(row.line);
            let [first, whole, after, beyond] = row.columns.map(usize::from);
            let [centre, centre_end] = row.centres.map(usize::from);
            let (minimum, maximum, step) = (piece.plane.minimum, piece.plane.maximum, piece.row_step());
            for (from, to) in [(first, whole), (after, beyond)] {
                let mut value = piece.row_values(from as i32, y)[0];
                let far = &self.far[line * pitch..][..width];
                for (x, far) in (from..to).zip(&far[from..to.max(from)]) {
                    let nearest = ((value >> below).max(i64::from(minimum)).min(i64::from(maximum))) as i32;
                    value = value.wrapping_add(step);
                    if nearest > *far {
                        continue;
                    }
                    let mask = mask::<C, R>(froms, tos, (x * C) as i32);
                    if mask != 0 || ((centre..centre_end).contains(&x) && !piece.layer) {
                        counts.masks += 1;
                        let at = (line * words * 64 + x) as u32;
                        self.lists.put(Fragment { mask, at, piece: row.piece });
                        self.active[line * words + x / 64] |= 1 << (x % 64);
                    }
                }
            }
        }
    }

    /// Adds the pixels of spans as fragments, if nothing hides them: of layers all, which become active; of the others
    /// those that are active.
    fn select(&mut self, input: &Input<'_>) {
        let (pitch, words) = (input.pitch(), input.words());
        let full = input.setting.grid.full();
        let below = below(input.setting.format);
        let Work { pieces, lists, spans, active, far, .. } = self;
        for layers in [true, false] {
            for span in spans.iter().filter(|span| pieces[span.piece as usize].layer == layers) {
                if span.columns[0] == span.columns[1] {
                    continue;
                }
                let piece = &pieces[span.piece as usize];
                let line = usize::from(span.line);
                let [from, to] = span.columns.map(usize::from);
                let values = piece.row_values(0, input.top + i32::from(span.line));
                let step = piece.row_step();
                let active = &mut active[line * words..(line + 1) * words];
                for (word, active) in active.iter_mut().enumerate().take((to - 1) / 64 + 1).skip(from / 64) {
                    let inside = bits_of(word, from, to);
                    let mut left = if layers { inside } else { *active & inside };
                    while left != 0 {
                        let x = word * 64 + left.trailing_zeros() as usize;
                        left &= left - 1;
                        let value = values[0].wrapping_add(step.wrapping_mul(x as i64));
                        if piece.plane.stored(value, below) <= far[line * pitch + x] {
                            *active |= 1 << (x % 64);
                            let at = (line * words * 64 + x) as u32;
                            lists.put(Fragment { mask: full, at, piece: span.piece });
                        }
                    }
                }
            }
        }
    }

    /// Resolves the active pixels, whose fragments are in `lists`; the rest of the card's work on a band.
    pub fn finish(&mut self, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
        self.sort();
        self.shader.begin(input.setting, self.pieces.len());
        let space = Space::new(input.setting.resolve);
        let width = input.setting.size[0] as usize;
        let mut fragments = std::mem::take(&mut self.fragments);
        let mut number = 0;
        for line in 0..input.lines {
            let mut used = 0;
            let y = input.top as usize + line;
            for word in 0..input.words() {
                let mut left = self.active[line * input.words() + word];
                while left != 0 {
                    let x = word * 64 + left.trailing_zeros() as usize;
                    left &= left - 1;
                    let list = &mut fragments[self.starts[number] as usize..self.starts[number + 1] as usize];
                    number += 1;
                    let rejected = self.lists.is_rejected((line * input.words() * 64 + x) as u32);
                    if list.is_empty() && !rejected {
                        continue;
                    }
                    // Masks come before spans, each in order of submission.
                    if !list.is_sorted_by_key(|fragment| fragment.piece) {
                        list.sort_unstable_by_key(|fragment| fragment.piece);
                    }
                    let mut resolved = Resolved { x: x as u16, y: y as u16, colour: 0, reason: Reason::Degraded };
                    if rejected || used + list.len() > input.setting.pool as usize {
                        counts.degraded += 1;
                        out.push(resolved);
                        continue;
                    }
                    used += list.len();
                    let scene = input.scene;
                    let base = (scene.colour.at(y * width + x), scene.depth.at(y * width + x));
                    let place = [x as i32, y as i32];
                    (resolved.colour, resolved.reason) =
                        self.resolve(input.setting, space, &scene.draws, list, place, base, counts);
                    out.push(resolved);
                }
            }
            counts.fragments += used as u64;
            counts.most = counts.most.max(used as u64);
        }
        self.fragments = fragments;
    }

    /// Fragments by pixel: those of active pixel n, counted line by line, are `starts[n]..starts[n + 1]`.
    fn sort(&mut self) {
        let Work { lists: Lists { stored, .. }, fragments, starts, active, ranks, .. } = self;
        ranks.clear();
        let mut before = 0;
        for word in active.iter() {
            ranks.push(before);
            before += word.count_ones();
        }
        let rank = |fragment: &Fragment| {
            let (word, bit) = (fragment.at as usize / 64, fragment.at % 64);
            (ranks[word] + (active[word] & ((1 << bit) - 1)).count_ones()) as usize
        };
        starts.clear();
        starts.resize(before as usize + 2, 0);
        for fragment in stored.iter() {
            starts[rank(fragment) + 2] += 1;
        }
        for number in 2..starts.len() {
            starts[number] += starts[number - 1];
        }
        fragments.clear();
        fragments.resize(stored.len(), Fragment::default());
        // Each pixel's start moves on to the next one's, and so to its own place.
        for fragment in stored.iter() {
            let place = &mut starts[rank(fragment) + 1];
            fragments[*place as usize] = *fragment;
            *place += 1;
        }
    }
}

/// The bits of word `word` of a bit field that lie in `from..to`; at least one does.
#[inline(always)]
pub(super) fn bits_of(word: usize, from: usize, to: usize) -> u64 {
    let low = from.saturating_sub(word * 64).min(63);
    let high = (to - word * 64).min(64);
    (u64::MAX << low) & (u64::MAX >> (64 - high))
}

/// Samples of the pixel whose first column of samples is `x`.
#[inline(always)]
fn mask<const C: usize, const R: usize>(froms: &[i32; R], tos: &[i32; R], x: i32) -> u64 {
    let full = (1_u32 << C) - 1;
    let mut rows = [0_u32; R];
    for k in 0..R {
        let from = (froms[k] - x).clamp(0, C as i32) as u32;
        let to = (tos[k] - x).clamp(0, C as i32) as u32;
        rows[k] = (full >> from) & !(full >> to);
    }
    if (C, R) == (8, 8) {
        // Rows are bytes, the first one uppermost.
        return u64::from_be_bytes(std::array::from_fn(|k| rows[k % R] as u8));
    }
    rows.iter().fold(0, |mask, row| (mask << C) | u64::from(*row))
}
