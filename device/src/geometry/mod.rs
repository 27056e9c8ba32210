//! Geometry: from vertex words to snapped screen primitives and their set-up records.
//!
//! | file | stage |
//! | --- | --- |
//! | [`fetch`] | vertex and index words, in the packet or in video memory |
//! | [`transform`] | [object -> eye] [decal] [eye -> clip], viewport, snap to the sub-pixel grid |
//! | [`clip`] | homogeneous clipping against near, far and the guard band |
//! | [`assembly`] | vertices become primitives, clipped and set up |
//! | [`ratio`] | exactly rounded quotients, the one division of set-up |
//! | [`triangle`] | triangle set-up: edges walked row by row |
//! | [`line`] | line set-up: diamond-exit, half-open |
//! | [`plane`] | depth planes in fixed point |
//!
//! Floating point ends at the snap; everything behind it is integer arithmetic.
//!
//! Clocks: 4 a vertex (one row of the matrix product a clock in a four-wide multiplier), 8 a
//! triangle, 6 a line, 1 a point (edges and planes through one divider), 4 for each clip plane that cuts.

pub mod assembly;
pub mod clip;
pub mod fetch;
pub mod line;
pub mod plane;
pub mod ratio;
pub mod transform;
pub mod triangle;

/// Units of u in a pixel; the pixel's centre is at half of it.
pub const PIXEL: i32 = 256;
/// Offset of a pixel's centre from its corner, in u.
pub const CENTRE: i32 = 128;
/// Half the width of the guard band in pixels, around the centre of the target.
pub const GUARD_BAND: f64 = 32768.0;

/// The matrices of the geometry unit, as its registers hold them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeometryRegisters {
    /// Object to eye, row-major for row vectors.
    pub object_eye: [f32; 16],
    /// Decal transform in eye space.
    pub decal: [f32; 16],
    /// Eye to clip space.
    pub eye_clip: [f32; 16],
    /// Scale x, y, z, offset x, y, z from clip / w to pixels.
    pub viewport: [f32; 6],
}

#[cfg(test)]
const ONE: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

#[cfg(test)]
impl GeometryRegisters {
    /// Registers that change nothing.
    pub(crate) const IDENTITY: GeometryRegisters =
        GeometryRegisters { object_eye: ONE, decal: ONE, eye_clip: ONE, viewport: [1., 1., 1., 0., 0., 0.] };
}

/// A vertex on the sub-pixel grid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScreenVertex {
    /// s16.8, pixels.
    pub x: i32,
    /// s16.8, pixels, down.
    pub y: i32,
    /// Depth, 0 ..= 2^bits - 1.
    pub z: u32,
    /// RGBA, R in 7:0.
    pub colour: u32,
    /// 1 / w in clip space.
    pub reciprocal_w: f32,
}
