//! The unit: resolves a scene band by band, and writes its active pixels.
//!
//! Inputs from: [`super::scene`], the pipeline. Outputs to: the frame buffer, the account, the map.
//!
//! Bands share nothing: any number of threads gives the same pixels and counts. What they resolve is written when all
//! of some bands are done, by one thread.

use super::band::{Input, LINES, Resolved, Work};
use super::bands::Bands;
use super::edges::Edges;
use super::scene::Scene;
use super::{Counts, Setting};
use crate::pipeline::bands::Counts as _;
use crate::probe::account::Clocks;
use fearless_simd::Level;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use zga_firmware::Stopped;

/// Bands of a thread between two stop points.
const GROUP: usize = 24;

/// Memory of the unit; empty until a scene calls for it.
#[derive(Debug, Default)]
pub struct Unit {
    bands: Bands,
    edges: Edges,
    works: Vec<Mutex<Work>>,
    resolved: Vec<Vec<Resolved>>,
}

impl Unit {
    /// Resolves a scene, on the threads of `pool` if there is one, by lanes of `level` or by the specification. `write`
    /// takes the pixels of some bands; `stop` is asked with the clocks so far.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was written until then stays.
    pub fn resolve(
        &mut self,
        setting: &Setting,
        scene: &Scene,
        level: Option<Level>,
        pool: Option<&ThreadPool>,
        mut write: impl FnMut(&[Resolved]),
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> (Counts, Result<(), Stopped>) {
        let height = setting.size[1] as usize;
        self.bands.fill(scene, setting.rule, setting.size[1]);
        let mut total = Counts::default();
        match level {
            Some(_) => self.edges.find(setting, scene, &mut total),
            None => self.edges.specify(setting, scene, &mut total),
        }
        let threads = pool.map_or(1, ThreadPool::current_num_threads);
        self.works.resize_with(threads.max(self.works.len()), Mutex::default);
        let group = GROUP * threads;
        self.resolved.resize_with(group.max(self.resolved.len()), Vec::new);
        // The edges of a triangle with masks begin in one of them.
        total.masks = self.bands.masked();
        for first in (0..self.bands.count()).step_by(group) {
            let (bands, works) = (&self.bands, &self.works);
            let (edges, surfaces) = (self.edges.sides(), self.edges.surfaces());
            let draw = |(band, out): (usize, &mut Vec<Resolved>)| {
                out.clear();
                let mut counts = Counts::default();
                if band >= bands.count() || bands.items(band).is_empty() {
                    return counts;
                }
                // Each thread has its own; nobody ever waits here.
                let mine = &works[rayon::current_thread_index().unwrap_or(0).min(threads - 1)];
                let mut work = mine.lock().unwrap_or_else(PoisonError::into_inner);
                let top = band * LINES;
                let lines = LINES.min(height - top);
                let input = Input { setting, scene, items: bands.items(band), edges, surfaces, top: top as i32, lines };
                work.draw(level, &input, out, &mut counts);
                counts
            };
            let outs = self.resolved[..group].iter_mut().enumerate().map(|(n, out)| (first + n, out));
            let counts = match pool {
                Some(pool) => {
                    let outs: Vec<_> = outs.collect();
                    pool.install(|| outs.into_par_iter().map(draw).reduce(Counts::default, Counts::plus))
                }
                None => outs.map(draw).fold(Counts::default(), Counts::plus),
            };
            total = total.plus(counts);
            self.resolved[..group].iter().for_each(|resolved| write(resolved));
            if let Some(stopped) = stop(total.clocks()) {
                return (total, Err(stopped));
            }
        }
        (total, Ok(()))
    }
}
