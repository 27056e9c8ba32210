//! Workers: the host threads, and what each of them works with.

use super::bands::{Counts, Surfaces, each_band};
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Assembler, GeometryCounts, Point, Sink};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::hidden::tile::closed_form::Sorts;
use crate::hidden::z_buffer::band::Scratch;
use crate::hidden::z_buffer::bins::{BinSink, Bins};
use crate::subpixel::scene::{Item, Taken, Taking};
use rayon::ThreadPool;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use zga_firmware::checked::Rectangle;

/// Primitives that are assembled before they are drawn, at most; bins that fill up end a batch sooner.
const BATCH: u32 = 1 << 18;
/// Fewer primitives than this are assembled by one thread: handing them out would take longer.
pub(super) const SHARE: u32 = 1 << 10;
/// A draw of less weight than this ([`Bins::weight`]) is drawn by one thread.
const WEIGHT: u64 = 1 << 18;

/// Host threads and what each of them works with; empty until the first draw.
#[derive(Debug, Default)]
pub(super) struct Workers {
    pool: Option<ThreadPool>,
    shares: Vec<Bins>,
    /// What shares beyond the first note for the tile unit.
    noted: Vec<Sorts>,
    /// What shares beyond the first take for the sub-pixel unit.
    taken: Vec<Vec<Item>>,
    scratch: Vec<Mutex<Scratch>>,
}

/// Who takes primitives beside the bins.
#[derive(Debug)]
pub(super) struct Wanted<'a> {
    /// The tile unit's sorts.
    pub(super) sorts: Option<&'a mut Sorts>,
    /// The sub-pixel unit.
    pub(super) taken: Option<Taken<'a>>,
    /// The numbers of primitives are kept.
    pub(super) numbers: bool,
}

/// Where the primitives of a share go.
struct Places<'a> {
    bins: &'a mut Bins,
    sorts: Option<&'a mut Sorts>,
    taken: Option<Taken<'a>>,
}

/// Bins that take primitives, and the tile unit's sorts where they are wanted.
struct Share<'a> {
    bins: BinSink<'a, true>,
    sorts: Option<&'a mut Sorts>,
}

impl Sink for Share<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle, columns: [i32; 2], vertices: &[ScreenVertex; 3], number: u32) {
        self.bins.triangle(triangle, columns, vertices, number);
        if let Some(sorts) = &mut self.sorts {
            sorts.triangle(triangle, columns, vertices, number);
        }
    }

    #[inline(always)]
    fn line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: u32) {
        self.bins.line(line, vertices, number);
        if let Some(sorts) = &mut self.sorts {
            sorts.line(line, vertices, number);
        }
    }

    #[inline(always)]
    fn point(&mut self, point: &Point, vertex: &ScreenVertex, number: u32) {
        self.bins.point(point, vertex, number);
        if let Some(sorts) = &mut self.sorts {
            sorts.point(point, vertex, number);
        }
    }

    fn masked(&mut self, _vertices: &[ScreenVertex; 3], _number: u32) {}

    #[inline(always)]
    fn full(&self) -> bool {
        self.bins.full()
    }
}

impl Workers {
    /// The pool if the work is worth handing out, made when it is first needed.
    pub(super) fn pool_for(&mut self, threads: usize, worth: bool) -> Option<&ThreadPool> {
        if threads == 1 || !worth {
            return None;
        }
        if self.pool.is_none() {
            let name = |n| format!("zga-{n}");
            self.pool = rayon::ThreadPoolBuilder::new().num_threads(threads).thread_name(name).build().ok();
        }
        self.pool.as_ref()
    }

    /// Assembles primitives from `range.start` on into the shares' bins, for a target of `size` pixels of
    /// which `scissor` may change; returns the first not assembled. `wanted` notes those assembled.
    pub(super) fn assemble(
        &mut self,
        threads: usize,
        assembler: &Assembler<'_>,
        scissor: Rectangle,
        size: [u32; 2],
        range: Range<u32>,
        wanted: Wanted<'_>,
    ) -> (u32, GeometryCounts) {
        let Wanted { mut sorts, mut taken, numbers } = wanted;
        let count = (range.end - range.start).min(BATCH);
        let used = if self.pool_for(threads, count >= 2 * SHARE).is_some() { threads } else { 1 };
        self.shares.resize_with(used.max(self.shares.len()), Bins::default);
        let empty = |bins: &mut Bins| bins.reset(size[0], size[1], scissor);
        self.shares[used..].iter_mut().for_each(empty);
        // The first share notes where the draws before have noted: few primitives need no second place.
        self.noted.clear();
        if let Some(sorts) = &mut sorts {
            sorts.scissor(scissor);
            self.noted.resize_with(used - 1, || {
                let mut other = sorts.clone();
                other.reset();
                other
            });
        }
        let mut noted = sorts.as_deref_mut().into_iter().chain(&mut self.noted);
        self.taken.resize_with((used - 1).max(self.taken.len()), Vec::new);
        self.taken.iter_mut().for_each(Vec::clear);
        let mut takers = Vec::new();
        if let Some(Taken { items, draw, masked, translucent, without_grid }) = &mut taken {
            let (draw, masked, translucent, without_grid) = (*draw, *masked, *translucent, *without_grid);
            let all = std::iter::once(&mut **items).chain(&mut self.taken).take(used);
            takers.extend(all.map(|items| Taken { items, draw, masked, translucent, without_grid }));
        }
        let mut takers = takers.into_iter();
        let each = count.div_ceil(used as u32);
        let fill = |(number, Places { bins, sorts, taken }): (usize, Places<'_>)| {
            let from = range.start + (each * number as u32).min(count);
            let to = range.start + (each * (number as u32 + 1)).min(count);
            let mut counts = GeometryCounts::default();
            empty(bins);
            // Two loops over primitives: the one for draws that nobody else takes a part of has no code for them.
            let first = if numbers || sorts.is_some() || taken.is_some() {
                let mut share = Share { bins: BinSink::any(bins, numbers), sorts };
                assembler.run(from..to, &mut Taking { sink: &mut share, taken }, &mut counts)
            } else {
                assembler.run(from..to, &mut BinSink::plain(bins), &mut counts)
            };
            (first, to, counts)
        };
        let shares = self.shares[..used]
            .iter_mut()
            .map(|bins| Places { bins, sorts: noted.next(), taken: takers.next() })
            .enumerate();
        let done: Vec<_> = match &self.pool {
            Some(pool) if used > 1 => {
                let shares: Vec<_> = shares.collect();
                pool.install(|| shares.into_par_iter().map(fill).collect())
            }
            _ => shares.map(fill).collect(),
        };
        // A share that filled up ends the batch: what later shares hold comes after a gap and waits.
        let mut sum = GeometryCounts::default();
        let (mut end, mut whole) = (range.start + count, used);
        for (number, (first, to, counts)) in done.into_iter().enumerate() {
            sum = sum.plus(counts);
            if first < to {
                self.shares[number + 1..].iter_mut().for_each(empty);
                (end, whole) = (first, number + 1);
                break;
            }
        }
        if let Some(sorts) = sorts {
            self.noted.iter().take(whole - 1).for_each(|more| sorts.merge(more));
        }
        if let Some(Taken { items, .. }) = taken {
            self.taken.iter().take(whole - 1).for_each(|more| items.extend_from_slice(more));
        }
        (end, sum)
    }

    /// Bands that the shares' bins hold something for: first, first beyond.
    pub(super) fn rows(&self) -> Option<[usize; 2]> {
        let rows = self.shares.iter().filter_map(Bins::rows);
        rows.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Draws what the shares' bins hold, band by band; `planes` begin with band `bands.start`.
    pub(super) fn draw<C: Counts>(
        &mut self,
        threads: usize,
        planes: Surfaces<'_>,
        bands: Range<usize>,
        draw: impl Fn(&[Bins], usize, Surfaces<'_>, &mut Scratch) -> C + Sync,
    ) -> C {
        let worth = self.shares.iter().map(Bins::weight).sum::<u64>() >= WEIGHT;
        self.pool_for(threads, worth);
        let pool = self.pool.as_ref().filter(|_| worth && bands.len() > 1);
        let threads = pool.map_or(1, ThreadPool::current_num_threads);
        self.scratch.resize_with(threads.max(self.scratch.len()), Mutex::default);
        let (shares, scratch) = (&self.shares, &self.scratch);
        let draw = |band: usize, planes: Surfaces<'_>| {
            // Each thread has its own; nobody ever waits here.
            let mine = &scratch[rayon::current_thread_index().unwrap_or(0).min(threads - 1)];
            let mut mine = mine.lock().unwrap_or_else(PoisonError::into_inner);
            draw(shares, band, planes, &mut mine)
        };
        match pool {
            Some(pool) => pool.install(|| each_band(true, planes, bands, &draw)),
            None => each_band(false, planes, bands, &draw),
        }
    }
}
