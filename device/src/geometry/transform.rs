//! Transform: object -> eye -> [decal] -> clip -> screen, and the snap to the sub-pixel grid.
//!
//! The product of the matrices is formed once a draw in f64 and applied in f64 (separate
//! multiplications and additions, so every machine gives the same bits). Where a decal is called,
//! x, y and w come from the undisplaced vertex and only z / w from the displaced one: a marking's
//! pixels are the same with and without the offset.

use super::fetch::RawVertex;
use super::{GUARD_BAND, GeometryRegisters, PIXEL, ScreenVertex};
use zga_abi::Effects;
use zga_abi::format::DepthFormat;

/// A 4x4 matrix for row vectors, row-major.
type Matrix = [[f64; 4]; 4];

/// A vertex in clip space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipVertex {
    /// x, y, z, w of the undisplaced vertex.
    pub position: [f64; 4],
    /// z, w of the vertex whose depth is stored: displaced where a decal is called.
    pub depth: [f64; 2],
    /// RGBA, R in 7:0; as numbers, since clipping mixes them.
    pub colour: [f64; 4],
}

/// The geometry unit's state for one draw.
#[derive(Clone, Debug)]
pub struct Transform {
    clip: Matrix,
    depth: Option<Matrix>,
    scale: [f64; 3],
    offset: [f64; 3],
    centre: [f64; 2],
    /// Steps of the depth format, 2^bits.
    depth_range: f64,
    grid: f64,
    identity: bool,
    flat: bool,
}

/// Adding and subtracting 1.5 * 2^52 rounds an f64 of magnitude below 2^51 to an integer, ties to even.
const ROUND: f64 = 6_755_399_441_055_744.0;

impl Transform {
    /// Forms the products for a draw to a target of `size` pixels.
    #[must_use]
    pub fn new(
        registers: &GeometryRegisters,
        effects: Effects,
        size: [u32; 2],
        format: DepthFormat,
        subpixel_bits: u32,
    ) -> Transform {
        let (object_eye, eye_clip) = (matrix(&registers.object_eye), matrix(&registers.eye_clip));
        let clip = multiply(&object_eye, &eye_clip);
        let depth = effects
            .contains(Effects::DECAL)
            .then(|| multiply(&multiply(&object_eye, &matrix(&registers.decal)), &eye_clip));
        let [sx, sy, sz, ox, oy, oz] = registers.viewport.map(f64::from);
        let unit = [sx, sy, sz, ox, oy, oz] == [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        Transform {
            clip,
            depth,
            scale: [sx, sy, sz],
            offset: [ox, oy, oz],
            centre: size.map(|s| f64::from(s) / 2.0),
            depth_range: f64::from(1_u32 << format.bits()),
            grid: f64::from(1_u32 << subpixel_bits),
            flat: !effects.contains(Effects::GOURAUD),
            identity: unit
                && depth.is_none()
                && clip == matrix(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.]),
        }
    }

    /// The vertex on the screen, or `None` if a clip plane (or a NaN) has to be looked at.
    #[must_use]
    #[inline(always)]
    pub fn inside(&self, raw: &RawVertex) -> Option<ScreenVertex> {
        let [x, y, z] = raw.position;
        let (x, y, z) = (f64::from(x), f64::from(y), f64::from(z));
        let (screen, reciprocal_w, depth) = if self.identity {
            ([x, y], 1.0, z)
        } else {
            let p = apply(&self.clip, x, y, z);
            let reciprocal_w = 1.0 / p[3];
            if !(p[3] > 0.0 && p[2] >= 0.0 && p[2] <= p[3]) {
                return None;
            }
            let depth = match &self.depth {
                None => p[2] / p[3] * self.scale[2] + self.offset[2],
                Some(matrix) => {
                    let d = apply(matrix, x, y, z);
                    (d[2] / d[3]).clamp(0.0, 1.0) * self.scale[2] + self.offset[2]
                }
            };
            // Quotients, not products with 1 / w: those round twice, and a tie at the snap would go either way.
            let at = |k: usize| p[k] / p[3] * self.scale[k] + self.offset[k];
            ([at(0), at(1)], reciprocal_w, depth)
        };
        // A NaN fails every comparison.
        let in_band =
            (screen[0] - self.centre[0]).abs() <= GUARD_BAND && (screen[1] - self.centre[1]).abs() <= GUARD_BAND;
        let in_depth = !self.identity || (0.0..=1.0).contains(&depth);
        (in_band && in_depth && !depth.is_nan()).then(|| self.snap(screen, depth, raw.colour, reciprocal_w))
    }

    /// The vertex in homogeneous screen coordinates: x w, y w, w, with x, y in pixels; snapped where it lies in front of
    /// the viewer and in the guard band.
    #[must_use]
    pub fn homogeneous(&self, position: [f32; 3]) -> [f64; 3] {
        let [x, y, z] = position.map(f64::from);
        let p = if self.identity { [x, y, z, 1.0] } else { apply(&self.clip, x, y, z) };
        let w = p[3];
        let screen = [0, 1].map(|k| p[k] / w * self.scale[k] + self.offset[k]);
        if w > 0.0 && (0..2).all(|k| (screen[k] - self.centre[k]).abs() <= GUARD_BAND) {
            let [x, y] = screen.map(|c| ((c * self.grid + ROUND) - ROUND) / self.grid * w);
            return [x, y, w];
        }
        [p[0] * self.scale[0] + w * self.offset[0], p[1] * self.scale[1] + w * self.offset[1], w]
    }

    /// The vertex in clip space, for the clip stage; `None` if it holds a NaN.
    #[must_use]
    pub fn clip_space(&self, raw: &RawVertex) -> Option<ClipVertex> {
        let [x, y, z] = raw.position.map(f64::from);
        let position = apply(&self.clip, x, y, z);
        let depth = match &self.depth {
            None => [position[2], position[3]],
            Some(matrix) => {
                let d = apply(matrix, x, y, z);
                [d[2], d[3]]
            }
        };
        let colour = raw.colour.to_le_bytes().map(f64::from);
        let finite = position.iter().chain(&depth).all(|c| c.is_finite());
        finite.then_some(ClipVertex { position, depth, colour })
    }

    /// Signed distances (times w, up to a factor) to the clip planes; negative is outside. Near, far,
    /// then left, right, top, bottom of the guard band.
    #[must_use]
    pub fn distances(&self, v: &ClipVertex) -> [f64; 6] {
        let [x, y, z, w] = v.position;
        let [px, py] = [x * self.scale[0] + w * self.offset[0], y * self.scale[1] + w * self.offset[1]];
        let [cx, cy] = self.centre;
        [
            z,
            w - z,
            px - w * (cx - GUARD_BAND),
            w * (cx + GUARD_BAND) - px,
            py - w * (cy - GUARD_BAND),
            w * (cy + GUARD_BAND) - py,
        ]
    }

    /// A clipped vertex on the screen; `None` where w is 0, which only a point without extent has.
    #[must_use]
    pub fn project(&self, v: &ClipVertex) -> Option<ScreenVertex> {
        let [x, y, _, w] = v.position;
        let reciprocal_w = 1.0 / w;
        // Rounding in the clip can leave a vertex a trifle outside; the grid is clamped like depth.
        let screen = [0, 1].map(|k| {
            let at = [x, y][k] / w * self.scale[k] + self.offset[k];
            at.clamp(self.centre[k] - GUARD_BAND, self.centre[k] + GUARD_BAND)
        });
        let depth = (v.depth[0] / v.depth[1]).clamp(0.0, 1.0) * self.scale[2] + self.offset[2];
        let colour = u32::from_le_bytes(v.colour.map(|c| (c + 0.5) as u8));
        (w > 0.0 && ![screen[0], screen[1], depth].iter().any(|c| c.is_nan()))
            .then(|| self.snap(screen, depth, colour, reciprocal_w))
    }

    /// The draw takes the first vertex's colour.
    #[must_use]
    pub fn flat_colour(&self) -> bool {
        self.flat
    }

    #[inline(always)]
    fn snap(&self, screen: [f64; 2], depth: f64, colour: u32, reciprocal_w: f64) -> ScreenVertex {
        // The scale of the register's grid back to u is a power of two and exact.
        let to_u = f64::from(PIXEL) / self.grid;
        let grid = |c: f64| (((c * self.grid + ROUND) - ROUND) * to_u) as i32;
        let (x, y) = (grid(screen[0]), grid(screen[1]));
        let z = depth_step(depth.clamp(0.0, 1.0), self.depth_range);
        ScreenVertex { x, y, z, colour, reciprocal_w: reciprocal_w as f32 }
    }
}

/// floor(`depth` (`range` - 1) + 1/2) without rounding on the way: `range` is a power of two, `depth` in 0..=1 (0 for a
/// NaN). The product itself can have more bits than an f64, with 31 bits even that of an f32.
#[inline(always)]
fn depth_step(depth: f64, range: f64) -> u32 {
    // depth range + 1/2 - depth; its floor is that of the first but for one step up or down. All of these are exact: a
    // difference from 1/2 is where it is not negative.
    let scaled = depth * range;
    let whole = scaled as u32;
    let part = scaled - f64::from(whole);
    whole + u32::from(part - 0.5 >= depth) - u32::from(part < depth - 0.5)
}

fn matrix(m: &[f32; 16]) -> Matrix {
    [0, 1, 2, 3].map(|r| [0, 1, 2, 3].map(|c| f64::from(m[4 * r + c])))
}

/// a * b for row vectors: first a, then b.
fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| [0, 1, 2, 3].map(|c| row[0] * b[0][c] + row[1] * b[1][c] + row[2] * b[2][c] + row[3] * b[3][c]))
}

#[inline(always)]
fn apply(m: &Matrix, x: f64, y: f64, z: f64) -> [f64; 4] {
    let column = |c: usize| x * m[0][c] + y * m[1][c] + z * m[2][c] + m[3][c];
    [column(0), column(1), column(2), column(3)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn depth_step_of_31_bits_is_not_rounded_up_on_the_way() {
        // (2^30 + 256) / 2^31: the product with 2^31 - 1 is 2^30 + 255.5 less 2^-24, plus 1/2 more bits than an f64 has.
        let depth = f64::from((1_u32 << 30) + 256) / f64::from(1_u32 << 31);
        assert_eq!(depth_step(depth, f64::from(1_u32 << 31)), (1 << 30) + 255);
        assert_eq!([0.0, 1.0, f64::NAN].map(|depth| depth_step(depth, f64::from(1_u32 << 31))), [0, 0x7FFF_FFFF, 0]);
    }

    proptest! {
        #[test]
        fn depth_step_any_is_the_floor(mantissa in 0_u64..=1 << 53, down in 0_u32..40, bits in prop::sample::select(vec![16_u32, 24, 31])) {
            let depth = mantissa as f64 / (1_u64 << 53) as f64 / (1_u64 << down) as f64;
            let doubled = 2 * u128::from(mantissa) * ((1 << bits) - 1) + (1_u128 << (53 + down));
            prop_assert_eq!(u128::from(depth_step(depth, f64::from(1_u32 << bits))), doubled >> (54 + down));
        }
    }
}
