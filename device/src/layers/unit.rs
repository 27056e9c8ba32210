//! The unit: tiles in bands, bands on threads.
//!
//! Duties: sorts what waits into bands of host tiles, and has each tile composed. Inputs from: [`crate::subpixel::scene`],
//! the pipeline. Outputs to: the frame buffer, counts. Clocks: those of [`super`].
//!
//! Bands share nothing: any number of threads gives the same pixels and counts. No more is kept of a band than where its
//! items lie in it, and no more of a tile than its items set up. So many bands are done between two stop points as hold
//! [`WEIGHT`] pixels of bounding boxes; a band with more than that is done row by row, by one thread.

use super::canvas::{Canvas, Frame};
use super::piece::{Palette, Part, Pixels, common, is_empty};
use super::pixels::Pixels as Mixed;
use super::tile::{Order, Place, paint};
use super::{Counts, Setting, specification};
use crate::hidden::z_buffer::kernel::LANES;
use crate::hidden::z_buffer::tile::TILE;
use crate::pipeline::bands::{Counts as _, Plane, Sight, Surfaces, each_band};
use crate::probe::account::Clocks;
use crate::subpixel::piece::extent;
use crate::subpixel::scene::Scene;
use fearless_simd::{Level, Simd, dispatch};
use rayon::ThreadPool;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use zga_firmware::Stopped;
use zga_firmware::checked::Rectangle;

/// Pixels of bounding boxes between two stop points; few in tests, so that they meet bands with more.
const WEIGHT: u64 = if cfg!(test) { 1 << 13 } else { 1 << 28 };

/// Memory of the unit; empty until a scene calls for it.
#[derive(Debug, Default)]
pub struct Unit {
    /// First band that each item touches in the area, and the first beyond.
    bands: Vec<[u16; 2]>,
    works: Vec<Mutex<Work>>,
}

/// Memory of one thread.
#[derive(Debug, Default)]
struct Work {
    reaches: Vec<Reach>,
    parts: Vec<Part>,
    /// Those of a block.
    few: Vec<Part>,
    order: Order,
    mixed: Mixed,
    palette: Palette,
    canvas: Canvas,
}

/// Where an item lies in a band.
#[derive(Clone, Copy, Debug)]
struct Reach {
    number: u32,
    /// Columns that it can touch, and rows.
    columns: [i32; 2],
    rows: [i32; 2],
}

/// A scene to be composed.
#[derive(Clone, Copy)]
struct Input<'a> {
    setting: &'a Setting,
    scene: &'a Scene,
    bands: &'a [[u16; 2]],
    level: Level,
}

/// Pixels of all bounding boxes.
#[must_use]
pub fn weight(scene: &Scene, setting: &Setting) -> u64 {
    let boxes = scene.items.iter().map(|item| extent(item, &scene.draws[item.draw as usize]));
    let boxes = boxes.map(|[low, high]| common(&setting.area, &[[low[0], high[0]], [low[1], high[1]]]));
    let pixels = |[[left, right], [top, bottom]]: Pixels| (right - left).max(0) as u64 * (bottom - top).max(0) as u64;
    boxes.map(pixels).sum()
}

/// Rows of a band.
fn rows_of(band: usize) -> [i32; 2] {
    [(band * TILE) as i32, ((band + 1) * TILE) as i32]
}

impl Unit {
    /// Notes which bands the items touch in `area`; returns the bands, and the pixels of bounding boxes in each.
    fn sort(&mut self, scene: &Scene, area: &Pixels) -> (Range<usize>, Vec<u64>) {
        let tile = TILE as i32;
        let bands = (area[1][0] / tile) as usize..(area[1][1].max(0) as usize).div_ceil(TILE);
        let mut weights = vec![0; bands.end];
        self.bands.clear();
        self.bands.extend(scene.items.iter().map(|item| {
            let [low, high] = extent(item, &scene.draws[item.draw as usize]);
            let pixels = common(area, &[[low[0], high[0]], [low[1], high[1]]]);
            if is_empty(&pixels) {
                return [0, 0];
            }
            let [[left, right], [top, bottom]] = pixels;
            let touched = [top / tile, (bottom - 1) / tile + 1];
            for band in touched[0]..touched[1] {
                let rows = bottom.min((band + 1) * tile) - top.max(band * tile);
                weights[band as usize] += (right - left) as u64 * rows as u64;
            }
            touched.map(|band| band as u16)
        }));
        (bands, weights)
    }

    /// The parts of tiles that layers can change, for who has to know them beforehand.
    pub fn touched(&mut self, setting: &Setting, scene: &Scene) -> Vec<Rectangle> {
        let (bands, _) = self.sort(scene, &setting.area);
        let mut reaches = Vec::new();
        let mut touched = Vec::new();
        for band in bands {
            find(&mut reaches, setting, scene, &self.bands, band, &setting.area);
            for tile in tiles(&setting.area) {
                let layers = reaches.iter().filter(|reach| scene.is_layer(&scene.items[reach.number as usize]));
                let parts = layers.map(|reach| common(&[reach.columns, reach.rows], &[tile, rows_of(band)]));
                let both = |a: Pixels, b: Pixels| [0, 1].map(|c| [a[c][0].min(b[c][0]), a[c][1].max(b[c][1])]);
                if let Some([columns, rows]) = parts.filter(|part| !is_empty(part)).reduce(both) {
                    let [x, right, y, bottom] = [columns[0], columns[1], rows[0], rows[1]].map(|c| c as u32);
                    touched.push(Rectangle { x, y, right, bottom });
                }
            }
        }
        touched
    }

    /// Composes what waits in `scene`, on the threads of `pool` if there is one, by lanes of `level` or by the
    /// specification. `stop` is asked with the clocks so far.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was written until then stays.
    #[expect(clippy::too_many_arguments, reason = "the unit's inputs; a struct would only be taken apart again")]
    pub fn compose(
        &mut self,
        setting: &Setting,
        scene: &Scene,
        level: Option<Level>,
        pool: Option<&ThreadPool>,
        colours: &mut [u32],
        depths: &mut [i32],
        values: &mut [u8],
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> (Counts, Result<(), Stopped>) {
        let mut total = Counts::default();
        let ends = |total: &Counts| stop(total.clocks()).map_or(Ok(()), Err);
        let Some(level) = level else {
            for y in setting.area[1][0]..setting.area[1][1] {
                let row = Setting { area: [setting.area[0], [y, y + 1]], ..*setting };
                total = total.plus(specification::compose(&row, scene, colours, depths, values));
                if let Err(stopped) = ends(&total) {
                    return (total, Err(stopped));
                }
            }
            return (total, Ok(()));
        };
        let (bands, weights) = self.sort(scene, &setting.area);
        let threads = pool.map_or(1, ThreadPool::current_num_threads);
        self.works.resize_with(threads.max(self.works.len()), Mutex::default);
        let works = &self.works;
        let input = Input { setting, scene, bands: &self.bands, level };
        let mut first = bands.start;
        while first < bands.end {
            let mut beyond = first + 1;
            let mut weight = weights[first];
            while beyond < bands.end && weight + weights[beyond] <= WEIGHT {
                weight += weights[beyond];
                beyond += 1;
            }
            let planes = Surfaces {
                colour: Plane::new(colours, setting.colour_pitch, first),
                depth: if setting.depth_pitch == 0 {
                    Plane::none()
                } else {
                    Plane::new(depths, setting.depth_pitch, first)
                },
                stencil: Plane::new(values, setting.stencil_pitch, first),
                words: Plane::none(),
                sight: Sight::none(),
            };
            if weight > WEIGHT {
                let mut mine = works[0].lock().unwrap_or_else(PoisonError::into_inner);
                let Surfaces { colour, depth, stencil, .. } = planes;
                for tile in tiles(&setting.area) {
                    for y in rows_of(first)[0]..rows_of(first)[1] {
                        let area = common(&setting.area, &[tile, [y, y + 1]]);
                        total = total.plus(input.band(first, &area, colour.rows, depth.rows, stencil.rows, &mut mine));
                        if let Err(stopped) = ends(&total) {
                            return (total, Err(stopped));
                        }
                    }
                }
            } else {
                let draw = |band: usize, planes: Surfaces<'_>| {
                    // Each thread has its own; nobody ever waits here.
                    let mine = &works[rayon::current_thread_index().unwrap_or(0).min(threads - 1)];
                    let mut mine = mine.lock().unwrap_or_else(PoisonError::into_inner);
                    let Surfaces { colour, depth, stencil, .. } = planes;
                    input.band(band, &setting.area, colour.rows, depth.rows, stencil.rows, &mut mine)
                };
                total = total.plus(match pool {
                    Some(pool) => pool.install(|| each_band(true, planes, first..beyond, &draw)),
                    None => each_band(false, planes, first..beyond, &draw),
                });
            }
            if let Err(stopped) = ends(&total) {
                return (total, Err(stopped));
            }
            first = beyond;
        }
        (total, Ok(()))
    }
}

/// Columns of the tiles that an area has pixels in.
fn tiles(area: &Pixels) -> impl Iterator<Item = [i32; 2]> + use<> {
    let tile = TILE as i32;
    let [left, right] = area[0];
    (left / tile..(right - 1) / tile + 1).map(move |column| [column * tile, (column + 1) * tile])
}

/// Finds where items lie in the pixels of `area` in a band.
fn find(reaches: &mut Vec<Reach>, setting: &Setting, scene: &Scene, bands: &[[u16; 2]], band: usize, area: &Pixels) {
    reaches.clear();
    let area = common(area, &[[0, i32::MAX], rows_of(band)]);
    for (number, [first, beyond]) in (0..).zip(bands) {
        if !(usize::from(*first)..usize::from(*beyond)).contains(&band) {
            continue;
        }
        let item = &scene.items[number as usize];
        let draw = &scene.draws[item.draw as usize];
        let (columns, rows) = match Part::new(item, draw, setting.format, &area) {
            Some(Part::Layer(piece) | Part::Cover(piece)) => (piece.reach(piece.area[1]), piece.area[1]),
            Some(Part::Clear([columns, rows])) => (columns, rows),
            None => continue,
        };
        if columns[0] < columns[1] {
            reaches.push(Reach { number, columns, rows });
        }
    }
}

impl Input<'_> {
    /// Composes the pixels of `area` in a band; the surfaces begin with its first row.
    fn band(
        &self,
        band: usize,
        area: &Pixels,
        colours: &mut [u32],
        depths: &[i32],
        values: &[u8],
        work: &mut Work,
    ) -> Counts {
        let Input { setting, scene, bands, level } = *self;
        let mut counts = Counts::default();
        find(&mut work.reaches, setting, scene, bands, band, area);
        if work.reaches.is_empty() {
            return counts;
        }
        let rows = rows_of(band);
        for tile in tiles(area) {
            let area = common(area, &[tile, rows]);
            work.parts.clear();
            for &Reach { number, columns, .. } in &work.reaches {
                if columns[0] >= tile[1] || columns[1] <= tile[0] {
                    continue;
                }
                let item = &scene.items[number as usize];
                let draw = &scene.draws[item.draw as usize];
                match Part::new(item, draw, setting.format, &area) {
                    Some(Part::Clear(pixels)) if pixels == area => work.parts.clear(),
                    // One that takes nothing back is none.
                    Some(Part::Clear(_) | Part::Cover(_)) if work.parts.is_empty() => {}
                    Some(mut part) => {
                        part.set_number(work.parts.len());
                        work.parts.push(part);
                    }
                    None => {}
                }
            }
            if work.parts.is_empty() {
                continue;
            }
            let corner = [tile[0], rows[0]];
            let (depth, depth_pitch, format) = (depths, setting.depth_pitch, setting.format);
            let (stencil, stencil_pitch) = (values, setting.stencil_pitch);
            let place = Place { corner, area, depth, depth_pitch, format, draws: &scene.draws, stencil, stencil_pitch };
            let (words, pitch) = (&mut *colours, setting.colour_pitch);
            let mut frame = Frame { words, pitch, format: setting.pixel_format, x: tile[0] as usize };
            counts = counts.plus(dispatch!(level, simd => work.tile(simd, &place, &mut frame)));
        }
        counts
    }
}

impl Work {
    /// Composes the parts over a tile.
    #[inline(always)]
    fn tile<S: Simd>(&mut self, simd: S, place: &Place<'_>, frame: &mut Frame<'_>) -> Counts {
        let mut counts = Counts::default();
        let areas = self.parts.iter().map(|part| part.area()[1]);
        let [top, bottom] = areas.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or(place.area[1]);
        let rows = [top, bottom].map(|y| (y - place.corner[1]) as usize);
        let place = &Place { area: [place.area[0], [top, bottom]], ..*place };
        self.palette.reset(self.parts.len());
        let Work { parts, few, order, mixed, palette, canvas, .. } = self;
        if order.find(parts, place.format, place.draws) {
            canvas.load(simd, frame, rows, order.is_of_submission());
            paint_counted(simd, parts, order, place, palette, canvas, &mut counts);
        } else {
            canvas.load(simd, frame, rows, false);
            for area in blocks(&place.area) {
                few.clear();
                for part in parts.iter() {
                    match part.within(&area) {
                        Some(Part::Clear(pixels)) if pixels == area => few.clear(),
                        // One that takes nothing back is none.
                        Some(Part::Clear(_) | Part::Cover(_)) if few.is_empty() => {}
                        Some(part) => few.push(part),
                        None => {}
                    }
                }
                if few.is_empty() {
                    continue;
                }
                let block = Place { area, ..*place };
                if order.find(few, place.format, place.draws) {
                    paint_counted(simd, few, order, &block, palette, canvas, &mut counts);
                } else {
                    mixed.compose(simd, few, &block, palette, canvas, &mut counts);
                }
            }
        }
        canvas.store(simd, frame, rows);
        counts
    }
}

/// Side of a block of a tile that is looked at by itself: a chunk of lanes.
const BLOCK: i32 = LANES as i32;

/// The blocks of a tile that an area has pixels in, cut to it.
fn blocks(area: &Pixels) -> impl Iterator<Item = Pixels> + use<> {
    let [[left, right], [top, bottom]] = *area;
    let start = |c: i32| c / BLOCK * BLOCK;
    let rows = (start(top)..bottom).step_by(BLOCK as usize);
    rows.flat_map(move |y| {
        let columns = (start(left)..right).step_by(BLOCK as usize);
        columns.map(move |x| common(&[[left, right], [top, bottom]], &[[x, x + BLOCK], [y, y + BLOCK]]))
    })
}

/// Paints the layers of an area in the order that was found, and counts what that takes.
#[inline(always)]
fn paint_counted<S: Simd>(
    simd: S,
    parts: &[Part],
    order: &Order,
    place: &Place<'_>,
    palette: &mut Palette,
    canvas: &mut Canvas,
    total: &mut Counts,
) {
    let mut counts = Counts::default();
    paint(simd, parts, order, place, palette, canvas, &mut counts);
    let [columns, rows] = [0, 1].map(|axis| place.area[axis].map(|c| (c - place.corner[axis]) as u32));
    let mask = (u64::MAX >> (64 - (columns[1] - columns[0]))) << columns[0];
    canvas.count(rows.map(|row| row as usize), mask, order.is_of_submission(), &mut counts);
    counts.comparisons += counts.blended - counts.pixels;
    *total = total.plus(counts);
}
