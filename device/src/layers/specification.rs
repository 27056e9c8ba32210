//! The specification of the layer unit: pixel by pixel, everything by definition.
//!
//! At each pixel all that waits is looked at in order of submission: a clear takes back what came before it, a layer that
//! covers the pixel's centre is tested against the opaque depth; those that pass are put in order and blended. The edges
//! are edge functions, and nothing is known beforehand. Every fast way must give the same pixels and counts.

use super::blend;
use super::piece::NEAREST;
use super::pixels::{Fragment, sort};
use super::{Counts, Setting};
use crate::geometry::assembly::{Point, Shape};
use crate::geometry::line::Line;
use crate::geometry::plane::below;
use crate::geometry::triangle::Triangle;
use crate::hidden::stencil::StencilCounts;
use crate::hidden::z_buffer::specification::{colour_plane, meets};
use crate::subpixel::scene::{Item, Kind, Scene};
use zga_abi::format::{DepthFormat, PixelFormat};

/// What an item covers; `None` for a clear, and for what covers nothing.
fn shape(item: &Item, format: DepthFormat) -> Option<Shape> {
    let v = item.vertices;
    match item.kind {
        Kind::Clear => None,
        Kind::Line => Line::new(&[v[0], v[1]], format).map(|line| Shape::Line(line, [v[0], v[1]])),
        Kind::Point => Some(Shape::Point(Point { pixel: [v[0].x >> 8, v[0].y >> 8], z: v[0].z as i32 }, v[0])),
        Kind::Triangle | Kind::Masked => Triangle::new(&v, format).map(|(triangle, _)| Shape::Triangle(triangle, v)),
    }
}

/// Composes what waits in the pixels of the setting's area, on whole surfaces.
pub fn compose(setting: &Setting, scene: &Scene, colours: &mut [u32], depths: &[i32], values: &[u8]) -> Counts {
    let mut counts = Counts::default();
    let below = below(setting.format);
    let shapes: Vec<Option<Shape>> = scene.items.iter().map(|item| shape(item, setting.format)).collect();
    let mut fragments = Vec::new();
    let [columns, rows] = setting.area;
    for (x, y) in (rows[0]..rows[1]).flat_map(|y| (columns[0]..columns[1]).map(move |x| (x, y))) {
        let stored = depths.get(y as usize * setting.depth_pitch + x as usize).copied().unwrap_or(0);
        let value = values.get(y as usize * setting.stencil_pitch + x as usize).copied().unwrap_or(0);
        let (mut came, mut tests) = (0, StencilCounts::default());
        fragments.clear();
        for ((item, shape), number) in scene.items.iter().zip(&shapes).zip(0..) {
            let draw = &scene.draws[item.draw as usize];
            let area = &draw.scissor;
            if !(area.x..area.right).contains(&(x as u32)) || !(area.y..area.bottom).contains(&(y as u32)) {
                continue;
            }
            if item.kind == Kind::Clear {
                fragments.clear();
                (came, tests) = (0, StencilCounts::default());
            }
            let Some(shape) = shape.as_ref().filter(|shape| meets(shape, x, y)) else {
                continue;
            };
            if draw.is_opaque(&item.vertices) {
                if !(draw.has_holes() && colour_plane(shape, &draw.shade(item.number)).is_hole(x, y)) {
                    fragments.clear();
                    (came, tests) = (0, StencilCounts::default());
                }
                continue;
            }
            came += 1;
            if let Some(test) = draw.stencil {
                let failed = u64::from(!test.passes(value));
                tests = tests.plus(StencilCounts { tested: 1, failed });
                if failed == 1 {
                    continue;
                }
            }
            let plane = shape.plane(setting.format);
            let depth = plane.stored(plane.value(x, y), below);
            match draw.test {
                None => fragments.push(Fragment { depth: NEAREST, number }),
                Some(test) if test.passes(depth, stored) => fragments.push(Fragment { depth, number }),
                Some(_) => {}
            }
        }
        counts.fragments += came;
        counts.stencil = counts.stencil.plus(tests);
        sort(&mut fragments, &mut counts);
        let mut pixel = Pixel { words: colours, setting, x: x as usize, y: y as usize };
        let mut colour = pixel.get();
        for &Fragment { number, .. } in &fragments {
            let item = &scene.items[number as usize];
            let draw = &scene.draws[item.draw as usize];
            let Some(shape) = &shapes[number as usize] else {
                continue;
            };
            let source = colour_plane(shape, &draw.shade(item.number));
            counts.count_shaded(draw, 1);
            let source = if source.is_hole(x, y) { 0 } else { source.colour(x, y) };
            colour = blend::over(draw.mode, colour, source);
        }
        if !fragments.is_empty() {
            pixel.put(colour);
        }
    }
    counts
}

/// A pixel of the frame buffer.
struct Pixel<'a> {
    words: &'a mut [u32],
    setting: &'a Setting,
    x: usize,
    y: usize,
}

impl Pixel<'_> {
    fn row(&mut self) -> &mut [u32] {
        &mut self.words[self.y * self.setting.colour_pitch..][..self.setting.colour_pitch]
    }

    /// Its colour; RGBA, R in 7:0.
    fn get(&mut self) -> u32 {
        let (x, format) = (self.x, self.setting.pixel_format);
        let stored = match format {
            PixelFormat::Rgb565 => u32::from(bytemuck::cast_slice_mut::<u32, u16>(self.row())[x]),
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => self.row()[x],
        };
        u32::from_le_bytes(format.decode(stored))
    }

    fn put(&mut self, colour: u32) {
        let (x, format) = (self.x, self.setting.pixel_format);
        let stored = format.encode(colour.to_le_bytes());
        match format {
            PixelFormat::Rgb565 => bytemuck::cast_slice_mut::<u32, u16>(self.row())[x] = stored as u16,
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => self.row()[x] = stored,
        }
    }
}
