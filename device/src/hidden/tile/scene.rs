//! The structural model: a whole scene through both sorts, the comparators and the colour buffer.
//!
//! Duties: everything of the unit, each part doing what it does on the card; events are counted where
//! they happen. Inputs: a scene that was held back, its target, what memory holds. Outputs: frame buffer
//! and Z buffer. The functional model ([`super::closed_form`]) must give the same counts, the plain Z
//! buffer the same pixels.
//!
//! Clocks: [`super::clocks`].

use super::clocks::Schedule;
use super::colour_buffer::{BankPixel, ColourBuffer, Memory};
use super::comparator::{Array, Coverage, DepthRule, NONE, SetUp, TriangleRatios};
use super::extent::Extent;
use super::interpolator::{Interpolator, Shaded};
use super::link::Walked;
use super::x_sort::XSort;
use super::y_sort::{Polygon, YSort};
use super::{Grid, SortCounts, Traffic, area};
use crate::geometry::assembly::Shape;
use crate::geometry::plane::below;
use crate::geometry::triangle::Triangle;
use crate::hidden::held::{Background, Depths, Held, Item};
use crate::hidden::stencil::{StencilRows, StencilRule};
use crate::hidden::z_buffer::specification::colour_plane;
use crate::probe::account::Clocks;
use zga_abi::format::DepthFormat;
use zga_firmware::Stopped;
use zga_firmware::checked::{Rectangle, Target};

/// Draws a scene. `colour` and `depth` are the target's surfaces. A scene that neither draws nor clears anything does nothing. Before each row of tiles `stop` is asked with
/// the clocks so far; what it says ends the scene there, and comes back beside the counts.
pub fn draw_until(
    held: &Held,
    target: &Target,
    colour: &mut [u32],
    depth: Depths<'_>,
    stop: &dyn Fn(Clocks) -> Option<Stopped>,
) -> (SortCounts, Option<Stopped>) {
    let (Depths { rows: depth, pitch: depth_pitch, stencil }, grid) = (depth, Grid::new(target));
    let mut y_sort = YSort::new(grid);
    for item in &held.items {
        y_sort.insert(item, Extent::new(held, item));
    }
    let stored = y_sort.polygons().len();
    if stored == 0 && held.background == Background::default() {
        return (SortCounts::default(), None);
    }
    let mut x_sort = XSort::new(grid);
    let mut unit = Unit {
        held,
        format: target.depth_format,
        memory: Memory { colour, surface: target.colour, depth, depth_pitch },
        stencil,
        array: Array::new(target.tile),
        interpolator: Interpolator::new(held, target.tile),
        colour_buffer: ColourBuffer::default(),
        won: Vec::new(),
        tiles: vec![0; stored],
        schedule: Schedule::new(Traffic::new(target, &held.background), stored as u64),
        counts: SortCounts { sort_memory_bytes: y_sort.bytes() + x_sort.bytes(), ..SortCounts::default() },
    };
    let [columns, rows] = grid.tiles();
    let mut stopped = None;
    for row in 0..rows {
        stopped = stop(Clocks(unit.schedule.clocks()));
        if stopped.is_some() {
            break;
        }
        x_sort.begin(y_sort.boundaries(row));
        let walked = y_sort.walk(row, |address, polygon| x_sort.insert(address, polygon));
        unit.schedule.row(walked.links, x_sort.linked());
        unit.count(walked);
        for column in 0..columns {
            unit.tile(column, grid.pixels(column, row), &mut x_sort, y_sort.polygons());
        }
    }
    (unit.finish(), stopped)
}

/// Draws a whole scene.
#[cfg(test)]
pub fn draw_scene(held: &Held, target: &Target, colour: &mut [u32], depth: &mut [i32]) -> SortCounts {
    draw_until(held, target, colour, Depths::of(target, depth), &|_| None).0
}

/// The unit at work, sorts apart.
struct Unit<'h, 'm> {
    held: &'h Held,
    format: DepthFormat,
    memory: Memory<'m>,
    /// The stencil plane, if the scene asks for it.
    stencil: StencilRows<'m>,
    array: Array,
    interpolator: Interpolator<'h>,
    colour_buffer: ColourBuffer,
    /// Comparators that a polygon just won.
    won: Vec<usize>,
    /// Tiles that each polygon was linked in.
    tiles: Vec<u64>,
    schedule: Schedule,
    counts: SortCounts,
}

impl<'h> Unit<'h, '_> {
    fn count(&mut self, walked: Walked) {
        self.counts.links_walked += walked.links;
        self.counts.links_removed += walked.removed;
    }

    /// Draws a tile into one bank while the other is written out.
    fn tile(&mut self, column: usize, pixels: Rectangle, x_sort: &mut XSort, polygons: &[Polygon<'h>]) {
        let (memory, background, format) = (&self.memory, &self.held.background, self.format);
        let stencil = &self.stencil;
        self.array.reset(pixels, |x, y| {
            let depth = match background.depth {
                Some(depth) => depth,
                None if memory.depth_pitch != 0 => memory.depth_at(x, y),
                None => format.maximum() as i32,
            };
            (depth, background.stencil.unwrap_or_else(|| stencil.at(x, y)))
        });
        let walked = x_sort.walk(column, polygons, |address, polygon| {
            self.tiles[address as usize] += 1;
            self.polygon(polygon.item, &pixels);
        });
        if self.stencil.is_kept() {
            for (x, y) in (pixels.y..pixels.bottom).flat_map(|y| (pixels.x..pixels.right).map(move |x| (x, y))) {
                self.stencil.put(x, y, self.array.at(x, y).stencil);
            }
        }
        let won = self.colours(pixels);
        self.colour_buffer.write_out(&mut self.memory);
        self.colour_buffer.swap();
        self.schedule.tile(walked.links, area(&pixels), won);
        self.counts.visited += 1;
        self.counts.empty += u64::from(walked.links == 0);
        self.count(walked);
    }

    /// Compares a polygon at all pixels of the tile; its vertices come into the parameter buffer if any
    /// of them sees it.
    fn polygon(&mut self, item: &'h Item, pixels: &Rectangle) {
        let set_up = self.set_up(item);
        if let Item::Primitive(Shape::Triangle(triangle, _), _) = item {
            self.counts.spans += spans_begun(triangle, &set_up.area, pixels);
        }
        self.won.clear();
        let [covered, holes] = self.array.compare(&set_up, &mut self.won);
        if let Item::Primitive(_, draw) = item {
            let looked_up = self.held.draws[*draw as usize].looked_up(covered, holes);
            self.counts.shading = self.counts.shading.plus(looked_up);
        }
        for &place in &self.won {
            let before = self.array.identify(place, NONE);
            if before != NONE {
                self.interpolator.release(before);
            }
        }
        if let Some(slot) = self.interpolator.take(item, self.won.len()) {
            for &place in &self.won {
                self.array.identify(place, slot);
            }
        }
    }

    /// What the comparators are told of an item.
    fn set_up(&self, item: &'h Item) -> SetUp<'h> {
        match item {
            Item::Primitive(shape, draw) => {
                let draw = &self.held.draws[*draw as usize];
                SetUp {
                    coverage: match shape {
                        Shape::Triangle(_, v) => Coverage::Triangle(TriangleRatios::new(v)),
                        Shape::Line(line, ends) => Coverage::Line(line, ends),
                        Shape::Point(point, _) => Coverage::Point(point.pixel),
                    },
                    area: draw.scissor,
                    depth: draw.test.map_or(DepthRule::Keep, |test| {
                        DepthRule::Test(test, shape.plane(self.format), below(self.format))
                    }),
                    stencil: draw.stencil_rule(shape),
                    seen: draw.draws_colours(),
                    holes: draw.has_holes().then(|| colour_plane(shape, &draw.shade())),
                }
            }
            Item::Clear { area, colour, depth, stencil } => SetUp {
                coverage: Coverage::Everywhere,
                area: *area,
                depth: depth.map_or(DepthRule::Keep, DepthRule::Store),
                stencil: stencil.map_or(StencilRule::Keep, StencilRule::Store),
                seen: colour.is_some(),
                holes: None,
            },
        }
    }

    /// Colours of what is seen go into the bank that is drawn to; returns at how many pixels something is.
    fn colours(&mut self, pixels: Rectangle) -> u64 {
        let background = self.held.background.colour;
        let mut won = 0;
        let (array, interpolator, counts) = (&self.array, &mut self.interpolator, &mut self.counts);
        let places = (pixels.y..pixels.bottom).flat_map(|y| (pixels.x..pixels.right).map(move |x| (x, y)));
        let shaded = places.map(|(x, y)| {
            let mine = array.at(x, y);
            let seen = interpolator.colour(mine.id, &mine.ratios);
            if let Some(Shaded { is_shaded, cost, .. }) = seen {
                won += 1;
                counts.shaded += u64::from(is_shaded);
                counts.shading = counts.shading.plus(cost);
            }
            BankPixel { colour: seen.map(|seen| seen.colour).or(background), depth: mine.depth }
        });
        self.colour_buffer.draw(pixels, shaded);
        self.interpolator.clear();
        won
    }

    /// Writes out the last tile.
    fn finish(mut self) -> SortCounts {
        self.colour_buffer.write_out(&mut self.memory);
        self.counts.fragments_not_stored = self.tiles.iter().map(|tiles| tiles.saturating_sub(1)).sum();
        let Schedule { reads, writes, colours, .. } = self.schedule;
        let stencil = self.array.tests;
        SortCounts { reads, writes, colours, stencil, clocks: self.schedule.clocks(), ..self.counts }
    }
}

/// Rows of the tile on which the triangle's run of pixels begins in it.
fn spans_begun(triangle: &Triangle, scissor: &Rectangle, tile: &Rectangle) -> u64 {
    let [left, top, right, bottom] = [scissor.x, scissor.y, scissor.right, scissor.bottom].map(|c| c as i32);
    let [first, beyond] = [tile.x as i32, tile.right as i32];
    let rows = triangle.rows[0].max(top).max(tile.y as i32)..triangle.rows[2].min(bottom).min(tile.bottom as i32);
    rows.filter(|&y| {
        let [start, end] = triangle.span(y);
        let start = start.max(left);
        start < end.min(right) && (first..beyond).contains(&start)
    })
    .count() as u64
}
