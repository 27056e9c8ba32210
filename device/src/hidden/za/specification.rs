//! The specification of the Za path: primitive by primitive, block by block, pixel by pixel.
//!
//! Simple and slow on purpose. What a primitive covers is found by its edge functions; the words are
//! maxima taken anew from the Z buffer; nothing is stepped and nothing is remembered from one block to
//! the next. Every faster or finer model must give the same frame buffer, Z buffer, words and counts.

use super::memory::{maximum, put};
use super::prediction::{Predictor, RowRun, clocks};
use super::{Surfaces, ZaCounts, ZaDraw, grid};
use crate::geometry::assembly::Shape;
use crate::hidden::stencil::{Stencilled, is_front};
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::band::StencilSetting;
use crate::hidden::z_buffer::specification::{colour_plane, extent, meets};
use crate::shading::plane::ColourPlane;
use zga_firmware::checked::Rectangle;

/// Draws primitives, each with its number in the draw, on whole surfaces, one after another.
#[must_use]
pub fn draw<'s>(
    draw: &ZaDraw,
    shapes: impl Iterator<Item = (&'s Shape, u32)>,
    surfaces: &mut Surfaces<'_>,
) -> ZaCounts {
    let mut counts = ZaCounts::default();
    for (shape, number) in shapes {
        primitive(draw, shape, number, surfaces, &mut counts);
    }
    counts
}

/// Draws one primitive.
fn primitive(draw: &ZaDraw, shape: &Shape, number: u32, surfaces: &mut Surfaces<'_>, counts: &mut ZaCounts) {
    let primitive = Primitive {
        colours: colour_plane(shape, &draw.pixels.shade(number)),
        depths: Predictor::new(shape, draw.pixels.format),
        front: is_front(shape),
    };
    let ((top, bottom), (left, right)) = extent(shape, &draw.pixels);
    if top >= bottom || left >= right {
        return;
    }
    let bounds = Rectangle { x: left as u32, y: top as u32, right: right as u32, bottom: bottom as u32 };
    let [columns, rows] = draw.grid.meeting(&bounds);
    let mut drawn_rows = vec![false; (bottom - top) as usize];
    let mut run = Vec::new();
    for row in rows {
        for column in columns.clone() {
            let area = draw.grid.area_at(column, row);
            let part = grid::common(&area, &bounds);
            run.clear();
            for y in part.y as i32..part.bottom as i32 {
                run.extend((part.x as i32..part.right as i32).filter(|&x| meets(shape, x, y)).map(|x| [x, y]));
            }
            if !run.is_empty() {
                run.iter().for_each(|[_, y]| drawn_rows[(y - top) as usize] = true);
                visit(draw, &primitive, &run, row * draw.grid.across() + column, &area, surfaces, counts);
            }
        }
    }
    if matches!(shape, Shape::Triangle(..)) {
        counts.count_spans(drawn_rows.iter().map(|&drawn| u64::from(drawn)).sum());
    }
}

/// A primitive's colours and depths, and whether its front is seen.
struct Primitive {
    colours: ColourPlane,
    depths: Predictor,
    front: bool,
}

impl Primitive {
    /// Depth of a covered pixel, as stored.
    fn depth(&self, [x, y]: [i32; 2]) -> i32 {
        self.depths.plane.stored(self.depths.plane.value(x, y), self.depths.below)
    }
}

/// Visits one block for one primitive, which covers the pixels `run` of it (not none).
fn visit(
    draw: &ZaDraw,
    primitive: &Primitive,
    run: &[[i32; 2]],
    index: usize,
    area: &Rectangle,
    surfaces: &mut Surfaces<'_>,
    counts: &mut ZaCounts,
) {
    let (pixels, covered) = (grid::pixels(area), run.len() as u64);
    if surfaces.words[index] < 0 {
        count_looked_up(draw, primitive, run, counts);
        fill_with_background(draw, area, surfaces);
        let passed = compare(draw, primitive, draw.test(), run, surfaces, counts);
        surfaces.words[index] = word(draw, area, surfaces);
        counts.count_initialised(pixels, passed, draw.depth_buffer);
        return;
    }
    let colours = draw.pixels.draws_colours();
    let Some(test) = draw.test() else {
        count_looked_up(draw, primitive, run, counts);
        let painted = compare(draw, primitive, None, run, surfaces, counts);
        counts.count_painted(covered, painted, colours);
        return;
    };
    let mut spent = 0;
    if draw.may_bypass() {
        let rows = row_runs(run);
        spent = clocks(draw.prediction, rows.len() as u64);
        if primitive.depths.predict(draw.prediction, draw.grid.block, &rows) > surfaces.words[index] {
            counts.count_bypassed(covered, spent);
            return;
        }
    }
    count_looked_up(draw, primitive, run, counts);
    let passed = compare(draw, primitive, Some(test), run, surfaces, counts);
    if test.write {
        surfaces.words[index] = word(draw, area, surfaces);
    }
    counts.count_compared(test.write, pixels, covered, passed, spent, colours);
}

/// Counts the texels that are looked up for holes.
fn count_looked_up(draw: &ZaDraw, primitive: &Primitive, run: &[[i32; 2]], counts: &mut ZaCounts) {
    if draw.pixels.has_holes() {
        counts.fragments += run.len() as u64;
        counts.holes += run.iter().filter(|[x, y]| primitive.colours.is_hole(*x, *y)).count() as u64;
    }
}

/// What the block holds that nobody has drawn to.
fn fill_with_background(draw: &ZaDraw, area: &Rectangle, surfaces: &mut Surfaces<'_>) {
    for y in area.y as usize..area.bottom as usize {
        for x in area.x as usize..area.right as usize {
            put(surfaces.colour, draw.pixels.pixel_format, draw.pixels.colour_pitch, x, y, draw.background.pixel);
            if draw.depth_buffer {
                surfaces.depth[y * draw.pixels.depth_pitch + x] = draw.background.depth;
            }
        }
    }
}

/// The pixels that pass the tests get the primitive's colours and depths; returns how many do.
fn compare(
    draw: &ZaDraw,
    primitive: &Primitive,
    test: Option<DepthTest>,
    run: &[[i32; 2]],
    surfaces: &mut Surfaces<'_>,
    counts: &mut ZaCounts,
) -> u64 {
    let mut passed = 0;
    for &[x, y] in run.iter().filter(|[x, y]| !primitive.colours.is_hole(*x, *y)) {
        let (column, row) = (x as usize, y as usize);
        let (z, place) = (primitive.depth([x, y]), row * draw.pixels.depth_pitch + column);
        let passes = || test.is_none_or(|test| test.passes(z, surfaces.depth[place]));
        let drawn = match draw.pixels.stencil.as_deref() {
            None => passes(),
            Some(&StencilSetting { rule, pitch }) => {
                let stored = &mut surfaces.stencil[row * pitch + column];
                let stencilled = Stencilled { rule, front: primitive.front };
                let drawn = stencilled.decide(stored, &mut counts.stencil, passes);
                counts.clocks += 1;
                drawn
            }
        };
        if !drawn {
            continue;
        }
        passed += 1;
        if test.is_some_and(|test| test.write) {
            surfaces.depth[place] = z;
        }
        if draw.pixels.draws_colours() {
            let pixel = draw.pixels.pixel_format.encode(primitive.colours.colour(x, y).to_le_bytes());
            put(surfaces.colour, draw.pixels.pixel_format, draw.pixels.colour_pitch, column, row, pixel);
        }
    }
    passed
}

/// The word of an initialised block.
fn word(draw: &ZaDraw, area: &Rectangle, surfaces: &Surfaces<'_>) -> i32 {
    if draw.depth_buffer {
        maximum(surfaces.depth, draw.pixels.depth_pitch, area)
    } else {
        draw.pixels.format.maximum() as i32
    }
}

/// The rows of a run: its pixels come row by row, and those of a row lie side by side.
fn row_runs(run: &[[i32; 2]]) -> Vec<RowRun> {
    let mut rows: Vec<RowRun> = Vec::new();
    for &[x, y] in run {
        match rows.last_mut() {
            Some(row) if row.y == y => row.last = x,
            _ => rows.push(RowRun { y, first: x, last: x }),
        }
    }
    rows
}
