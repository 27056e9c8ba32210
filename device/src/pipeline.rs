//! The drawing pipeline: geometry, hidden surfaces, shading, for one draw after another.
//!
//! Duties: cuts a draw into batches, has each assembled and binned (in shares, one a host thread),
//! drawn band by band, and its events charged. Inputs: checked draws and the geometry registers.
//! Outputs: frame buffer and Z buffer in video memory, counters.
//!
//! Clocks: 4 a vertex, 8 / 6 / 1 a triangle / line / point, 4 a clip plane that cuts (see
//! [`crate::geometry`]); the rest is charged by the hidden-surface path.

use crate::geometry::GeometryRegisters;
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Assembler, GeometryCounts, List};
use crate::geometry::fetch::Fetch;
use crate::geometry::transform::Transform;
use crate::hidden::z_buffer::band::{Scratch, Setting};
use crate::hidden::z_buffer::bins::Bins;
use crate::hidden::z_buffer::tile::{TILE, TileCounts};
use crate::hidden::z_buffer::uniform::Uniform;
use crate::hidden::z_buffer::{self, DepthTest, specification, surfaces};
use crate::probe::account::{Account, Clocks};
use crate::probe::pixel::PixelProbe;
use crate::shading::plane::Interpolation;
use fearless_simd::Level;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use zga_abi::format::Topology;
use zga_abi::{Counter, Effects};
use zga_firmware::Stopped;
use zga_firmware::checked::{Clear, Draw, DrawState, Rectangle, Target};

/// Primitives that are assembled before they are drawn, at most; bins that fill up end a batch sooner.
const BATCH: u32 = 1 << 18;
/// Fewer primitives than this are assembled by one thread: handing them out would take longer.
const SHARE: u32 = 1 << 10;
/// A draw of less weight than this ([`Bins::weight`]) is drawn by one thread.
const WEIGHT: u64 = 1 << 18;
/// Most host threads.
const MAX_THREADS: usize = 256;

/// Which code draws the pixels. All give the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// The widest SIMD level of this host.
    #[default]
    Best,
    /// The specification: pixel by pixel, one thread.
    Specification,
    /// 4 lanes, SSE2; on other hosts the least level there is.
    Sse2,
    /// 4 lanes, SSE4.2.
    Sse42,
    /// 8 lanes, AVX2.
    Avx2,
    /// 16 lanes, AVX-512.
    Avx512,
}

impl Kernel {
    /// The kernels that this host can run.
    #[must_use]
    pub fn available() -> Vec<Kernel> {
        let all = [Kernel::Specification, Kernel::Sse2, Kernel::Sse42, Kernel::Avx2, Kernel::Avx512];
        all.into_iter().filter(|k| *k == Kernel::Specification || k.level().is_some()).chain([Kernel::Best]).collect()
    }

    #[cfg(target_arch = "x86_64")]
    fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            Kernel::Best => Some(best),
            Kernel::Specification => None,
            Kernel::Sse2 => best.as_sse2().map(Level::Sse2),
            Kernel::Sse42 => best.as_sse4_2().map(Level::Sse4_2),
            Kernel::Avx2 => best.as_avx2().map(Level::Avx2),
            Kernel::Avx512 => best.as_avx512().map(Level::Avx512),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn level(self) -> Option<Level> {
        (self == Kernel::Best).then(Level::new)
    }
}

/// How the host runs the pipeline; the picture and the counts do not depend on it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PipelineOptions {
    /// Host threads; 0 is one for each processor.
    pub threads: usize,
    /// Which code draws the pixels; one the host cannot run counts as [`Kernel::Best`].
    pub kernel: Kernel,
}

/// Geometry, hidden surfaces and shading of a card.
#[derive(Debug)]
pub struct Pipeline {
    level: Option<Level>,
    threads: usize,
    target: Option<Target>,
    workers: Workers,
    shared: Vec<Option<ScreenVertex>>,
    list: List,
    /// What the Z buffer is known to hold since its last clear.
    uniform: Option<Uniform>,
}

/// Host threads and what each of them works with; empty until the first draw.
#[derive(Debug, Default)]
struct Workers {
    pool: Option<ThreadPool>,
    shares: Vec<Bins>,
    scratch: Vec<Mutex<Scratch>>,
}

impl Pipeline {
    /// A pipeline without power: it owns no scratch memory and no threads until it draws.
    #[must_use]
    pub fn new(options: &PipelineOptions) -> Pipeline {
        let processors = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if options.threads == 0 { processors() } else { options.threads };
        let level = match options.kernel {
            Kernel::Specification => None,
            kernel => kernel.level().or_else(|| Kernel::Best.level()),
        };
        Pipeline {
            level,
            threads: threads.clamp(1, MAX_THREADS),
            target: None,
            workers: Workers::default(),
            shared: Vec::new(),
            list: List::default(),
            uniform: None,
        }
    }

    /// Begins a scene on `target`.
    pub fn begin_scene(&mut self, target: &Target) {
        self.target = Some(*target);
        // Another frame buffer could lie over the Z buffer that is remembered.
        self.uniform = self.uniform.take().filter(|uniform| uniform.is_of(target));
    }

    /// Ends the scene. Everything is in memory already: this path keeps nothing back.
    ///
    /// # Errors
    /// None on this path; other paths draw here and can be stopped.
    pub fn end_scene(&mut self, _memory: &mut [u32], _account: &mut Account) -> Result<(), Stopped> {
        self.target = None;
        Ok(())
    }

    /// Gives scratch memory and threads back.
    pub fn power_off(&mut self) {
        self.workers = Workers::default();
        self.shared = Vec::new();
        self.list = List::default();
        self.uniform = None;
    }

    /// Words of video memory whose contents are remembered from clear to clear.
    #[must_use]
    pub fn remembered(&self) -> Range<usize> {
        self.uniform.as_ref().map_or(0..0, Uniform::words)
    }

    /// Clears planes of the target. `foreign` counts the changes that others may have made to the
    /// remembered words.
    pub fn clear(&mut self, memory: &mut [u32], foreign: u64, clear: &Clear, account: &mut Account) {
        let Some(target) = &self.target else {
            return;
        };
        let all = Rectangle { x: 0, y: 0, right: target.colour.width, bottom: target.colour.height };
        let known = self.uniform.take();
        match (clear.depth, target.depth) {
            (None, _) | (_, None) => {
                z_buffer::clear(memory, target, clear, None, account);
                self.uniform = known;
            }
            (Some(value), Some(surface)) if clear.area == all && self.level.is_some() => {
                let mut uniform = Uniform::before_clear(known, target, surface, value, foreign);
                z_buffer::clear(memory, target, clear, Some(&uniform), account);
                uniform.cleared(foreign);
                self.uniform = Some(uniform);
            }
            _ => z_buffer::clear(memory, target, clear, None, account),
        }
    }

    /// Draws. Between batches `stop` is asked with the clocks this draw has taken so far.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was drawn until then stays.
    #[expect(clippy::too_many_arguments, reason = "the unit's inputs; a struct would only be taken apart again")]
    pub fn draw(
        &mut self,
        memory: &mut [u32],
        geometry: &GeometryRegisters,
        state: &DrawState,
        draw: &Draw<'_>,
        mut probe: Option<&mut PixelProbe>,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        let Some(target) = self.target else {
            return Ok(());
        };
        let size = [target.colour.width, target.colour.height];
        let transform = Transform::new(geometry, state.effects, size, target.depth_format, target.subpixel_bits);
        let setting = setting(&target, state);
        let begun = account.total();
        let fetch = Fetch::new(memory, draw, state.material_colour);
        let primitives = draw.topology.primitives(fetch.elements() as u32);
        if fetch.indexed() {
            self.transform_shared(&fetch, &transform, account);
        }
        let mut first = 0;
        while first < primitives {
            let assembler = Assembler {
                fetch: Fetch::new(memory, draw, state.material_colour),
                transform: &transform,
                format: target.depth_format,
                topology: draw.topology,
                shared: draw.indices.is_some().then_some(&self.shared[..]),
            };
            let before = first;
            let (counts, tiles);
            if self.level.is_some() && probe.is_none() {
                (first, counts) = self.workers.assemble(self.threads, &assembler, &setting, size, first..primitives);
                tiles = self.draw_bins(memory, &target, &setting);
            } else {
                (first, counts) = list(&mut self.list, &assembler, setting.scissor, first..primitives);
                if let Some(probe) = probe.as_deref_mut() {
                    let (_, depth) = surfaces(memory, &target);
                    let at = probe.y as usize * setting.depth_pitch + probe.x as usize;
                    let stored = depth.get(at).copied().unwrap_or(0);
                    probe.follow(&setting, state.depth_function, state.tag, &self.list.shapes, stored);
                }
                tiles = self.draw_list(memory, &target, &setting);
            }
            charge_geometry(&counts, draw, account);
            z_buffer::charge(&tiles, &setting, account);
            debug_assert!(first > before);
            if let Some(stopped) = stop(Clocks(account.total().0 - begun.0)) {
                return Err(stopped);
            }
        }
        if let Some(probe) = probe {
            probe.draw = probe.draw.wrapping_add(1);
        }
        Ok(())
    }

    /// Transforms each vertex of an indexed draw once.
    fn transform_shared(&mut self, fetch: &Fetch<'_>, transform: &Transform, account: &mut Account) {
        let count = fetch.vertices();
        let vertex = |v: usize| transform.inside(&fetch.vertex(v));
        self.shared.clear();
        match self.workers.pool_for(self.threads, count >= 2 * SHARE as usize) {
            Some(pool) => pool.install(|| (0..count).into_par_iter().map(vertex).collect_into_vec(&mut self.shared)),
            None => self.shared.extend((0..count).map(vertex)),
        }
        account.add(Counter::GeometryVertices, count as u64);
        account.charge(Counter::CyclesGeometry, Clocks(4 * count as u64));
    }

    fn draw_bins(&mut self, memory: &mut [u32], target: &Target, setting: &Setting) -> TileCounts {
        if let (Some(uniform), Some([first, beyond])) = (&mut self.uniform, self.workers.rows()) {
            uniform.drawn(first..beyond);
        }
        let (colour, depth) = surfaces(memory, target);
        self.level
            .map_or_else(TileCounts::default, |level| self.workers.draw(self.threads, level, setting, colour, depth))
    }

    fn draw_list(&mut self, memory: &mut [u32], target: &Target, setting: &Setting) -> TileCounts {
        self.uniform = None;
        let (colour, depth) = surfaces(memory, target);
        specification::draw(setting, self.list.shapes.iter().map(|(shape, _)| shape), colour, depth)
    }
}

/// What the pixels of a draw share.
fn setting(target: &Target, state: &DrawState) -> Setting {
    let effects = state.effects;
    Setting {
        test: effects.contains(Effects::DEPTH).then(|| DepthTest::new(state.depth_function, state.depth_write)),
        format: target.depth_format,
        interpolation: if !effects.contains(Effects::GOURAUD) {
            Interpolation::Flat
        } else if effects.contains(Effects::PERSPECTIVE) {
            Interpolation::Perspective
        } else {
            Interpolation::Affine
        },
        scissor: state.scissor,
        width: target.colour.width,
        pixel_format: target.colour.format,
        colour_pitch: target.colour.pitch as usize / 4,
        depth_pitch: target.depth.map_or(0, |d| d.pitch as usize / 4),
    }
}

/// Assembles primitives into a plain list.
fn list(list: &mut List, assembler: &Assembler<'_>, scissor: Rectangle, range: Range<u32>) -> (u32, GeometryCounts) {
    let mut counts = GeometryCounts::default();
    list.reset(scissor);
    let first = assembler.run(range, list, &mut counts);
    (first, counts)
}

impl Workers {
    /// The pool if the work is worth handing out, made when it is first needed.
    fn pool_for(&mut self, threads: usize, worth: bool) -> Option<&ThreadPool> {
        if threads == 1 || !worth {
            return None;
        }
        if self.pool.is_none() {
            let name = |n| format!("zga-{n}");
            self.pool = rayon::ThreadPoolBuilder::new().num_threads(threads).thread_name(name).build().ok();
        }
        self.pool.as_ref()
    }

    /// Assembles primitives from `range.start` on into the shares' bins; returns the first not assembled.
    fn assemble(
        &mut self,
        threads: usize,
        assembler: &Assembler<'_>,
        setting: &Setting,
        size: [u32; 2],
        range: Range<u32>,
    ) -> (u32, GeometryCounts) {
        let count = (range.end - range.start).min(BATCH);
        let used = if self.pool_for(threads, count >= 2 * SHARE).is_some() { threads } else { 1 };
        self.shares.resize_with(used.max(self.shares.len()), Bins::default);
        self.shares[used..].iter_mut().for_each(|share| share.reset(size[0], size[1], setting.scissor));
        let each = count.div_ceil(used as u32);
        let fill = |(number, share): (usize, &mut Bins)| {
            let from = range.start + (each * number as u32).min(count);
            let to = range.start + (each * (number as u32 + 1)).min(count);
            let mut counts = GeometryCounts::default();
            share.reset(size[0], size[1], setting.scissor);
            let first = assembler.run(from..to, share, &mut counts);
            (first, to, counts)
        };
        let shares = &mut self.shares[..used];
        let done: Vec<_> = match &self.pool {
            Some(pool) if used > 1 => pool.install(|| shares.par_iter_mut().enumerate().map(fill).collect()),
            _ => shares.iter_mut().enumerate().map(fill).collect(),
        };
        // A share that filled up ends the batch: what later shares hold comes after a gap and waits.
        let mut sum = GeometryCounts::default();
        for (number, (first, to, counts)) in done.into_iter().enumerate() {
            sum = sum.plus(counts);
            if first < to {
                self.shares[number + 1..].iter_mut().for_each(|share| share.reset(size[0], size[1], setting.scissor));
                return (first, sum);
            }
        }
        (range.start + count, sum)
    }

    /// Bands that the shares' bins hold something for: first, first beyond.
    fn rows(&self) -> Option<[usize; 2]> {
        self.shares.iter().filter_map(Bins::rows).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Draws what the shares' bins hold, band by band.
    fn draw(
        &mut self,
        threads: usize,
        level: Level,
        setting: &Setting,
        colour: &mut [u32],
        depth: &mut [i32],
    ) -> TileCounts {
        let Some([first, beyond]) = self.rows() else {
            return TileCounts::default();
        };
        let worth = self.shares.iter().map(Bins::weight).sum::<u64>() >= WEIGHT;
        self.pool_for(threads, worth);
        let shares = &self.shares;
        let pool = self.pool.as_ref().filter(|_| worth && beyond - first > 1);
        let threads = pool.map_or(1, ThreadPool::current_num_threads);
        self.scratch.resize_with(threads.max(self.scratch.len()), Mutex::default);
        let with_depth = setting.test.is_some();
        let rows = |pitch: usize| first * TILE * pitch..;
        let colour = &mut colour[rows(setting.colour_pitch)];
        let depth = if with_depth { &mut depth[rows(setting.depth_pitch)] } else { &mut [] };
        let (colour_band, depth_band) = (setting.colour_pitch * TILE, setting.depth_pitch.max(1) * TILE);
        let bands = beyond - first;
        let scratch = &self.scratch;
        let draw = |(band, (colour, depth)): (usize, (&mut [u32], &mut [i32]))| {
            // Each thread has its own; nobody ever waits here.
            let mine = &scratch[rayon::current_thread_index().unwrap_or(0).min(threads - 1)];
            let mut mine = mine.lock().unwrap_or_else(PoisonError::into_inner);
            setting.draw_band(level, shares, first + band, colour, depth, &mut mine)
        };
        match pool {
            Some(pool) if with_depth => pool.install(|| {
                let bands = colour.par_chunks_mut(colour_band).zip(depth.par_chunks_mut(depth_band)).take(bands);
                bands.enumerate().map(draw).reduce(TileCounts::default, TileCounts::plus)
            }),
            Some(pool) => pool.install(|| {
                let bands = colour.par_chunks_mut(colour_band).take(bands).enumerate();
                let bands = bands.map(|(band, colour)| draw((band, (colour, &mut []))));
                bands.reduce(TileCounts::default, TileCounts::plus)
            }),
            None => {
                let mut depths = depth.chunks_mut(depth_band);
                let bands = colour.chunks_mut(colour_band).take(bands);
                let bands = bands.map(|colour| (colour, depths.next().unwrap_or(&mut [])));
                bands.enumerate().map(draw).fold(TileCounts::default(), TileCounts::plus)
            }
        }
    }
}

/// Charges the geometry unit's events of one batch.
fn charge_geometry(counts: &GeometryCounts, draw: &Draw<'_>, account: &mut Account) {
    let (vertices, set_up) = match draw.topology {
        Topology::Triangles => (3, 8),
        Topology::Lines => (2, 6),
        Topology::LineStrip => (1, 6),
        Topology::Points => (1, 1),
    };
    let vertices = if draw.indices.is_some() { 0 } else { counts.primitives * vertices };
    account.add(Counter::GeometryVertices, vertices);
    account.add(Counter::GeometryPrimitives, counts.primitives);
    account.add(Counter::GeometryClipped, counts.clipped);
    account.add(Counter::GeometryDiscarded, counts.discarded);
    let clocks = 4 * vertices + set_up * counts.primitives + 4 * counts.cuts;
    account.charge(Counter::CyclesGeometry, Clocks(clocks));
}
