//! Depths of a triangle in a tile of a band, from its vertices; near enough, and never too narrow.
//!
//! Inputs from: [`super::scene`]. Outputs to: [`super::inside`], [`super::sheet`]. Clocks: none.

use super::Setting;
use super::band::Input;
use super::bands::Entry;
use super::scene::Item;
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};
use crate::hidden::z_buffer::kernel::LANES;

/// More than a few sums of f32 in a tile can lose of what they are made of.
pub(super) const ROUNDING: f32 = 1.0 / (1 << 21) as f32;

/// A change of depths for one pixel beyond which those of the vertices must do.
const STEEP: f64 = (1 << 20) as f64;

/// The plane of a triangle's depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slant {
    /// Depth at the target's corner; change for one pixel to the right and down.
    corner: f64,
    along: f64,
    down: f64,
    /// What rounding may add; infinite where the plane says nothing.
    spare: f64,
    /// First column and row, and first beyond, of the pixels that it can touch in the band.
    from: [f64; 2],
    to: [f64; 2],
    /// The nearest and the farthest depth of its vertices.
    limits: [i32; 2],
}

impl Slant {
    #[inline(always)]
    pub(super) fn new(input: &Input<'_>, entry: &Entry, item: &Item) -> Slant {
        let [a, b, c] = &item.vertices;
        let limits = [entry.nearest, entry.farthest];
        let place = |v: &ScreenVertex| [f64::from(v.x), f64::from(v.y), f64::from(v.z)];
        let (a, b, c) = (place(a), place(b), place(c));
        let (b, c) = ([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
        let scale = f64::from(PIXEL) / (b[0] * c[1] - c[0] * b[1]);
        let along = (b[2] * c[1] - c[2] * b[1]) * scale;
        let down = (b[0] * c[2] - c[0] * b[2]) * scale;
        let corner = |c: [u16; 2]| [f64::from(c[0]), f64::from(c[1])];
        let (from, to) = (corner(entry.from), corner(entry.to));
        // A gradient is rounded to so many bits, and taken along at most so many pixels; depths are rounded once more.
        let rounding = (to[0] - from[0] + to[1] - from[1]) / f64::from(1_u32 << input.setting.format.fraction());
        let gentle = along.abs() + down.abs() < STEEP;
        let (along, down, spare) = if gentle { (along, down, rounding + 2.0) } else { (0.0, 0.0, f64::INFINITY) };
        let corner = a[2] - (a[0] * along + a[1] * down) / f64::from(PIXEL);
        let from = [from[0], from[1].max(f64::from(input.top))];
        let to = [to[0], to[1].min(f64::from(input.top + input.lines as i32))];
        Slant { corner, along, down, spare, from, to, limits }
    }

    /// Bounds of its depths in a chunk's columns of the band.
    #[inline(always)]
    pub(super) fn over(&self, chunk: usize) -> [i32; 2] {
        let x = (chunk * LANES) as f64;
        let (left, right) = (x.max(self.from[0]), (x + LANES as f64).min(self.to[0]));
        let (top, bottom) = (self.from[1], self.to[1]);
        let middle = self.corner + (left + right) / 2.0 * self.along + (top + bottom) / 2.0 * self.down;
        let reach = (right - left) / 2.0 * self.along.abs() + (bottom - top) / 2.0 * self.down.abs() + self.spare;
        let [near, far] = self.limits;
        [((middle - reach).floor() as i32).clamp(near, far), ((middle + reach).ceil() as i32).clamp(near, far)]
    }

    /// Bounds of its depths at the samples of the pixel in the corner of a tile, not yet limited; and their change for one
    /// pixel to the right and down, inside the tile.
    #[inline(always)]
    pub(super) fn pixel(&self, setting: &Setting, place: [i32; 2]) -> [f32; 4] {
        let (x, y) = (f64::from(place[0]) + 0.5, f64::from(place[1]) + 0.5);
        let value = self.corner + x * self.along + y * self.down;
        let half = |bits: u32| (f64::from(CENTRE) - f64::from(1_u32 << bits) / 2.0) / f64::from(PIXEL);
        let slope = self.along.abs() + self.down.abs();
        let rounding = (value.abs() + LANES as f64 * slope) * f64::from(ROUNDING);
        let reach = self.along.abs() * half(setting.pitch[0])
            + self.down.abs() * half(setting.pitch[1])
            + self.spare
            + rounding;
        [(value - reach) as f32, (value + reach) as f32, self.along as f32, self.down as f32]
    }

    /// The nearest and the farthest depth of its vertices, or a little beyond.
    #[inline(always)]
    pub(super) fn limits(&self) -> [f32; 2] {
        floats(self.limits)
    }
}

/// Bounds of depths as f32, or a little beyond.
#[inline(always)]
pub(super) fn floats([near, far]: [i32; 2]) -> [f32; 2] {
    let (near, far) = (near as f32, far as f32);
    [near - near.abs() * ROUNDING, far + far.abs() * ROUNDING]
}
