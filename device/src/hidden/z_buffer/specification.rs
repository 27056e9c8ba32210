//! The specification of the Z buffer path: pixel by pixel, everything switched by state.
//!
//! Simple and slow on purpose. A triangle is its edge functions and the top-left rule, a fragment is
//! compared (stencil value, then depth), written and coloured at once, in order of submission. Every fast path must give the
//! same frame buffer, Z buffer and counts, bit for bit.

use super::DepthTest;
use super::band::{Setting, StencilSetting};
use super::tile::TileCounts;
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::Shape;
use crate::geometry::plane::below;
use crate::geometry::triangle::doubled_area;
use crate::hidden::stencil::{Stencilled, is_front};
use crate::pipeline::bands::Sight;
use crate::shading::plane::{ColourPlane, ColourSource, Shade};
use crate::shading::resolve::{PixelRow, Row16, Row32};
use zga_abi::format::PixelFormat;

/// Draws primitives, each with its number in the draw, on whole surfaces, one after another.
#[cfg(test)]
#[must_use]
pub fn draw<'s>(
    setting: &Setting,
    shapes: impl Iterator<Item = (&'s Shape, u32)>,
    colour: &mut [u32],
    depth: &mut [i32],
) -> TileCounts {
    draw_noting(setting, shapes, colour, depth, &mut [], &mut Sight::none())
}

/// Draws primitives as [`draw`] does, and notes what a path that shades late keeps.
#[must_use]
pub fn draw_noting<'s>(
    setting: &Setting,
    shapes: impl Iterator<Item = (&'s Shape, u32)>,
    colour: &mut [u32],
    depth: &mut [i32],
    stencil: &mut [u8],
    sight: &mut Sight<'_>,
) -> TileCounts {
    let mut counts = TileCounts::default();
    for (shape, number) in shapes {
        primitive(setting, shape, number, colour, depth, stencil, sight, &mut counts);
    }
    counts
}

/// The colour plane of a primitive.
#[must_use]
pub fn colour_plane(shape: &Shape, shade: &Shade<'_>) -> ColourPlane {
    let source = match shape {
        Shape::Triangle(_, v) => ColourSource::new(v),
        Shape::Line(_, v) => ColourSource::new(&[v[0], v[1], v[1]]),
        Shape::Point(_, v) => ColourSource::new(&[*v; 3]),
    };
    let plane = match shape {
        Shape::Triangle(..) => ColourPlane::triangle(&source, shade.interpolation),
        Shape::Line(..) | Shape::Point(..) => ColourPlane::line(&source, shade.interpolation),
    };
    plane.shaded(source.first_place(), shade)
}

/// Whether a primitive covers (or draws) pixel (`x`, `y`).
#[must_use]
pub fn meets(shape: &Shape, x: i32, y: i32) -> bool {
    match shape {
        Shape::Triangle(_, v) => covers(v, x, y),
        Shape::Line(..) | Shape::Point(..) => shape.line_or_point_draws(x, y),
    }
}

#[expect(clippy::too_many_arguments, reason = "the path's memories; a struct would only be taken apart again")]
fn primitive(
    setting: &Setting,
    shape: &Shape,
    number: u32,
    colour: &mut [u32],
    depth: &mut [i32],
    stencil: &mut [u8],
    sight: &mut Sight<'_>,
    counts: &mut TileCounts,
) {
    let plane = shape.plane(setting.format);
    let colours = colour_plane(shape, &setting.shade(number));
    let (below, front) = (below(setting.format), is_front(shape));
    let (rows, columns) = extent(shape, setting);
    for y in rows.0..rows.1 {
        let mut any = false;
        // Runs of pixels without a hole, where these cut segments.
        let (mut runs, mut inside) = (0, false);
        for x in columns.0..columns.1 {
            if !meets(shape, x, y) {
                inside = false;
                continue;
            }
            any = true;
            counts.covered += 1;
            let hole = colours.is_hole(x, y);
            runs += u32::from(!hole && !inside);
            inside = !hole;
            if hole {
                counts.holes += 1;
                continue;
            }
            let (column, row) = (x as usize, y as usize);
            let (z, at) = (plane.stored(plane.value(x, y), below), row * setting.depth_pitch + column);
            let passes = || setting.test.is_none_or(|test| test.passes(z, depth[at]));
            let drawn = match setting.stencil.as_deref() {
                None => passes(),
                Some(StencilSetting { rule, pitch }) => {
                    let stored = &mut stencil[row * pitch + column];
                    Stencilled { rule: *rule, front }.decide(stored, &mut counts.stencil, passes)
                }
            };
            if !drawn {
                continue;
            }
            if setting.test.is_some_and(|test| test.write) {
                depth[at] = z;
            }
            counts.passed += 1;
            if !setting.draws_colours() {
                continue;
            }
            sight.note(setting, column, row);
            put(
                setting,
                &mut colour[row * setting.colour_pitch..][..setting.colour_pitch],
                column,
                colours.colour(x, y),
            );
        }
        counts.spans += u64::from(any && matches!(shape, Shape::Triangle(..)));
        if let Some(tokens) = sight.tokens.rows.get_mut(y as usize) {
            *tokens += if setting.cuts_segments { runs } else { u32::from(any) };
        }
    }
}

/// Rows and columns that a primitive can touch inside the scissor, with a pixel to spare.
#[must_use]
pub fn extent(shape: &Shape, setting: &Setting) -> ((i32, i32), (i32, i32)) {
    let vertices: &[ScreenVertex] = match shape {
        Shape::Triangle(_, v) => v,
        Shape::Line(_, v) => v,
        Shape::Point(_, v) => std::slice::from_ref(v),
    };
    let range = |coordinate: fn(&ScreenVertex) -> i32, low: u32, high: u32| {
        let pixels = || vertices.iter().map(|v| coordinate(v) >> 8);
        let (least, greatest) = (pixels().min().unwrap_or(0), pixels().max().unwrap_or(0));
        ((least - 1).max(low as i32), (greatest + 2).min(high as i32))
    };
    let area = setting.scissor;
    (range(|v| v.y, area.y, area.bottom), range(|v| v.x, area.x, area.right))
}

fn put(setting: &Setting, row: &mut [u32], x: usize, colour: u32) {
    match setting.pixel_format {
        PixelFormat::Xrgb8888 => Row32 { words: row, opaque: 0xFF00_0000 }.put(x, colour),
        PixelFormat::Argb8888 => Row32 { words: row, opaque: 0 }.put(x, colour),
        PixelFormat::Rgb565 => Row16 { pixels: bytemuck::cast_slice_mut(row) }.put(x, colour),
    }
}

/// Whether the centre of pixel (`x`, `y`) lies in the triangle, by edge functions and the top-left rule.
#[must_use]
pub fn covers(v: &[ScreenVertex; 3], x: i32, y: i32) -> bool {
    covers_place(v, i64::from(x) * 256 + 128, i64::from(y) * 256 + 128)
}

/// The same for any place, in u.
#[must_use]
pub fn covers_place(v: &[ScreenVertex; 3], px: i64, py: i64) -> bool {
    let area = doubled_area(&v[0], &v[1], &v[2]);
    let order = if area > 0 { [0, 1, 2] } else { [0, 2, 1] };
    area != 0
        && (0..3).all(|k| {
            let (a, b) = (&v[order[k]], &v[order[(k + 1) % 3]]);
            let (dx, dy) = (i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y));
            let e = dx * (py - i64::from(a.y)) - dy * (px - i64::from(a.x));
            // An edge that is neither left (going up) nor top (going right) does not own its points.
            let owner = dy < 0 || (dy == 0 && dx > 0);
            e - i64::from(!owner) >= 0
        })
}

impl DepthTest {
    /// Whether depth `z` passes against `stored`.
    #[must_use]
    #[inline(always)]
    pub fn passes(self, z: i32, stored: i32) -> bool {
        (self.less && z < stored) || (self.equal && z == stored) || (self.greater && z > stored)
    }
}
