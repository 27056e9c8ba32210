//! Pixel history: every fragment that comes to one pixel, and what became of it.
//!
//! Duties: follows one pixel through clears and draws with the plain rules of the specification,
//! beside whatever fast path draws the frame; the depth it arrives at is the one the path stored.
//! Inputs: set-up primitives, the pixel's depth before the draw. Outputs: [`ProbeRecord`]s, which the
//! card writes to video memory. Clocks: none; a probe is an instrument, not a unit of the card.

use crate::geometry::assembly::Shape;
use crate::geometry::plane::below;
use crate::hidden::stencil::{StencilCounts, Stencilled};
use crate::hidden::z_buffer::band::Setting;
use crate::hidden::z_buffer::specification::{colour_plane, meets};
use zga_abi::format::DepthFunction;
use zga_abi::packet::ProbeRecord;

/// Kind of a record: a clear.
pub const KIND_CLEAR: u32 = 0;
/// Kind of a record: a triangle's fragment.
pub const KIND_TRIANGLE: u32 = 1;
/// Kind of a record: a line's fragment.
pub const KIND_LINE: u32 = 2;
/// Kind of a record: a point's fragment.
pub const KIND_POINT: u32 = 3;

/// The probe at one pixel.
#[derive(Clone, Debug, Default)]
pub struct PixelProbe {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Draws since begin scene.
    pub draw: u32,
    /// Fragments since the records were last taken.
    pub records: Vec<ProbeRecord>,
}

impl PixelProbe {
    /// Notes a clear of planes at the pixel.
    pub fn clear(&mut self, depth_before: u32, depth: u32, colour: u32) {
        self.records.push(ProbeRecord {
            verdict: KIND_CLEAR | 1 << 16 | 1 << 17,
            depth,
            depth_before,
            colour,
            draw: self.draw,
            ..ProbeRecord::default()
        });
    }

    /// Follows primitives of a draw, in order; the pixel's depth and stencil value before them are `held`.
    pub fn follow(
        &mut self,
        setting: &Setting,
        function: DepthFunction,
        tag: u32,
        shapes: &[(Shape, u32)],
        held: (i32, u8),
    ) {
        let (mut stored, mut value) = held;
        let (x, y) = (self.x as i32, self.y as i32);
        let area = setting.scissor;
        if !(area.x..area.right).contains(&self.x) || !(area.y..area.bottom).contains(&self.y) {
            return;
        }
        for (shape, primitive) in shapes.iter().filter(|(shape, _)| meets(shape, x, y)) {
            let kind = match shape {
                Shape::Triangle(..) => KIND_TRIANGLE,
                Shape::Line(..) => KIND_LINE,
                Shape::Point(..) => KIND_POINT,
            };
            let plane = shape.plane(setting.format);
            let depth = plane.stored(plane.value(x, y), below(setting.format));
            let colours = colour_plane(shape, &setting.shade(*primitive));
            let passes = || setting.test.is_none_or(|test| test.passes(depth, stored));
            let passed = !colours.is_hole(x, y)
                && match &setting.stencil {
                    None => passes(),
                    Some(stencil) => {
                        let stencilled = Stencilled::of(stencil.rule, shape);
                        stencilled.decide(&mut value, &mut StencilCounts::default(), passes)
                    }
                };
            let written = passed && setting.test.is_some_and(|test| test.write);
            self.records.push(ProbeRecord {
                primitive: *primitive,
                tag,
                verdict: kind | (function.code() << 8) | (u32::from(passed) << 16) | (u32::from(written) << 17),
                depth: depth as u32,
                depth_before: stored as u32,
                colour: colours.colour(x, y),
                draw: self.draw,
                reserved: 0,
            });
            if written {
                stored = depth;
            }
        }
    }
}
