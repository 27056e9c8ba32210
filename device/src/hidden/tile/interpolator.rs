//! Interpolator: vertex parameter buffer, and pixel parameters from division ratios.
//!
//! Duties: keeps the vertices of the polygons that are seen somewhere in the tile, at most one for each
//! pixel; turns a comparator's ratios into the colour of its pixel. Inputs: polygons as they win pixels,
//! the comparators. Outputs: colours for the [colour buffer](super::colour_buffer).
//!
//! The source forms t0 p0 + t1 p1 + t2 p2 for each parameter p. Here the ratios give the place of the
//! pixel between the vertices, exactly, and the colour planes of [`crate::shading`] are evaluated there:
//! their rounding is what every path shares.
//!
//! A place is free again as soon as no comparator sees its polygon. One that wins takes its place after
//! the losers have let go of theirs, so there are never more polygons than pixels.
//!
//! Clocks: the vertices come in with the comparators' set-up; a colour is a clock of the card's colour
//! interpolators ([`super::charge`]).

use super::comparator::{Ratios, Slot};
use crate::geometry::assembly::Shape;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::doubled_area;
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::held::{Held, Item};
use crate::hidden::z_buffer::specification::colour_plane;
use crate::shading::pixel::ShadingCounts;
use crate::shading::plane::ColourPlane;

/// A polygon of the parameter buffer.
#[derive(Debug)]
struct Parameters<'h> {
    item: &'h Item,
    /// Comparators that see it.
    seen_by: usize,
    /// Its colours, once a pixel asks for them.
    plane: Option<ColourPlane>,
}

/// The vertex parameter buffer and what reads it.
#[derive(Debug)]
pub struct Interpolator<'h> {
    held: &'h Held,
    slots: Vec<Option<Parameters<'h>>>,
    free: Vec<Slot>,
}

/// A colour, and whether the interpolators made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shaded {
    /// RGBA, R in 7:0.
    pub colour: u32,
    /// The draw calls for shading: interpolated colours, or more.
    pub is_shaded: bool,
    /// What it cost beyond an interpolated colour.
    pub cost: ShadingCounts,
}

impl<'h> Interpolator<'h> {
    /// An empty buffer with a place for each pixel of a tile.
    #[must_use]
    pub fn new(held: &'h Held, tile: [u32; 2]) -> Interpolator<'h> {
        let places = (tile[0] * tile[1]) as Slot;
        Interpolator { held, slots: (0..places).map(|_| None).collect(), free: (0..places).rev().collect() }
    }

    /// A comparator does not see the polygon of `slot` any more.
    pub fn release(&mut self, slot: Slot) {
        let place = &mut self.slots[slot as usize];
        if let Some(parameters) = place {
            parameters.seen_by -= 1;
            if parameters.seen_by == 0 {
                *place = None;
                self.free.push(slot);
            }
        }
    }

    /// Takes the vertices of a polygon that `seen_by` comparators see from now on; `None` if there are no
    /// such comparators, or they have not been released.
    pub fn take(&mut self, item: &'h Item, seen_by: usize) -> Option<Slot> {
        if seen_by == 0 {
            return None;
        }
        let slot = self.free.pop()?;
        self.slots[slot as usize] = Some(Parameters { item, seen_by, plane: None });
        Some(slot)
    }

    /// The tile is done: nothing is seen any more.
    pub fn clear(&mut self) {
        for (slot, place) in self.slots.iter_mut().enumerate() {
            if place.take().is_some() {
                self.free.push(slot as Slot);
            }
        }
    }

    /// Colour where the polygon of `slot` has these ratios; `None` if the place is empty.
    #[must_use]
    pub fn colour(&mut self, slot: Slot, ratios: &Ratios) -> Option<Shaded> {
        let Parameters { item, plane, .. } = self.slots.get_mut(slot as usize)?.as_mut()?;
        Some(match item {
            Item::Primitive(shape, draw) => {
                let draw = &self.held.draws[*draw as usize];
                let [x, y] = pixel(shape, ratios);
                Shaded {
                    colour: plane.get_or_insert_with(|| colour_plane(shape, &draw.shade())).colour(x, y),
                    is_shaded: draw.is_shaded(),
                    cost: draw.cost(),
                }
            }
            Item::Clear { colour, .. } => {
                Shaded { colour: (*colour)?, is_shaded: false, cost: ShadingCounts::default() }
            }
        })
    }
}

/// The pixel at which a primitive has these ratios.
#[must_use]
pub fn pixel(shape: &Shape, ratios: &Ratios) -> [i32; 2] {
    match shape {
        Shape::Triangle(_, v) => {
            let divisor = doubled_area(&v[0], &v[1], &v[2]).abs();
            [divided(v.map(|v| v.x), ratios, divisor), divided(v.map(|v| v.y), ratios, divisor)]
        }
        Shape::Line(line, v) => {
            let major = |v: &ScreenVertex| if line.axis == Axis::X { v.x } else { v.y };
            let [a, b] = [major(&v[0]), major(&v[1])];
            let step = divided([a, b, 0], ratios, (i64::from(b) - i64::from(a)).abs());
            let minor = line.minor_at(step);
            if line.axis == Axis::X { [step, minor] } else { [minor, step] }
        }
        Shape::Point(point, _) => point.pixel,
    }
}

/// The pixel whose centre is at (t0 c0 + t1 c1 + t2 c2) / divisor u.
fn divided(c: [i32; 3], t: &Ratios, divisor: i64) -> i32 {
    let sum: i128 = c.iter().zip(t).map(|(c, t)| i128::from(*c) * i128::from(*t)).sum();
    sum.div_euclid(i128::from(divisor) * i128::from(PIXEL)) as i32
}
