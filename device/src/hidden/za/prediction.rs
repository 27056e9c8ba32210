//! Prediction: the least depth that a primitive can have in a block, before any pixel is looked at.
//!
//! A block is bypassed where the prediction is farther than everything in it. So a prediction must
//! never be farther than the nearest covered pixel; how near it comes to that pixel is what the three
//! differ in. With P the primitive's plane and gx, gy its gradients, (xf, yf) the least and (xl, yl) the
//! greatest column and row that it covers in the block of W x H pixels:
//!
//! | prediction | value | clocks |
//! | --- | --- | --- |
//! | block-length | P(xf, yf) + min(0, W gx) + min(0, (H - 1) gy) | 1 |
//! | covered-run | P(xf, yf) + min(0, (xl - xf) gx) + min(0, (yl - yf) gy) | 2 |
//! | plane | least of P over the covered pixels: one end of each row | 1 + rows |
//!
//! For blocks of one row the first is the published rule: it takes a whole block length from the first
//! covered pixel on, one pixel more than the block has (JP H07-120435 B2). The second needs a
//! multiplication more, the third looks at the rows one after another.
//!
//! Safe: a covered pixel (x, y) has x - xf in 0 ..= xl - xf <= W - 1 and the same for y, so each of the
//! three is at most P(x, y), and each at most the next. The value is then rounded and clamped as the
//! pixel's own is, and both are monotone.
//!
//! Planes wrap at 64 bits. Where the gradients themselves may have wrapped (`steep`) all three say the
//! primitive's least depth. Else a gradient is below 2^53 and everything here is taken in 128 bits: the
//! corner (xf, yf) need not be covered, and may be 16384 pixels from what is. For blocks with
//! W + H <= 512 ([`fits_64_bits`]) no sum leaves 64 bits: a covered pixel's value is below 2^57, and what
//! is added to it below 512 * 2^53 = 2^62.

use crate::geometry::assembly::Shape;
use crate::geometry::plane::{DepthPlane, below};
use zga_abi::format::{DepthFormat, ZaPrediction};

/// What a primitive covers of one row of a block: all columns from first to last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowRun {
    /// Row.
    pub y: i32,
    /// First column covered.
    pub first: i32,
    /// Last column covered.
    pub last: i32,
}

/// Least and greatest column and row that a primitive covers in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// Least column and row.
    pub first: [i32; 2],
    /// Greatest column and row.
    pub last: [i32; 2],
}

impl Extent {
    /// The extent of rows of runs, of which there is at least one.
    #[must_use]
    pub fn of(rows: &[RowRun]) -> Extent {
        let mut extent = Extent { first: [i32::MAX; 2], last: [i32::MIN; 2] };
        for row in rows {
            extent.first = [extent.first[0].min(row.first), extent.first[1].min(row.y)];
            extent.last = [extent.last[0].max(row.last), extent.last[1].max(row.y)];
        }
        extent
    }
}

/// Whether the first two predictions for blocks of this shape can be taken in 64 bits.
#[must_use]
pub const fn fits_64_bits(block: [u32; 2]) -> bool {
    block[0] + block[1] <= 512
}

/// Clocks of a prediction for a run of `rows` rows.
#[must_use]
#[inline(always)]
pub const fn clocks(prediction: ZaPrediction, rows: u64) -> u64 {
    match prediction {
        ZaPrediction::BlockLength => 1,
        ZaPrediction::CoveredRun => 2,
        ZaPrediction::Plane => 1 + rows,
    }
}

/// A primitive's depths as the predictor sees them.
#[derive(Clone, Copy, Debug)]
pub struct Predictor {
    /// Depth.
    pub plane: DepthPlane,
    /// The gradients mean nothing.
    pub steep: bool,
    /// Bits below the binary point of the plane's values.
    pub below: u32,
}

impl Predictor {
    /// The predictor of a primitive.
    #[must_use]
    pub fn new(shape: &Shape, format: DepthFormat) -> Predictor {
        let steep = match shape {
            Shape::Triangle(triangle, _) => triangle.steep,
            Shape::Line(line, _) => line.steep,
            Shape::Point(..) => false,
        };
        Predictor { plane: shape.plane(format), steep, below: below(format) }
    }

    /// The least depth, as stored, that the primitive can have at `rows` of a block of `block` pixels.
    #[must_use]
    pub fn predict(&self, prediction: ZaPrediction, block: [u32; 2], rows: &[RowRun]) -> i32 {
        match prediction {
            ZaPrediction::BlockLength => self.block_length(block, Extent::of(rows).first),
            ZaPrediction::CoveredRun => self.covered_run(&Extent::of(rows)),
            ZaPrediction::Plane => self.plane(rows),
        }
    }

    /// From the first covered pixel over the whole length of a block.
    #[must_use]
    pub fn block_length(&self, block: [u32; 2], first: [i32; 2]) -> i32 {
        self.corner(first, [i64::from(block[0]), i64::from(block[1]) - 1])
    }

    /// Over the covered columns and rows only.
    #[must_use]
    pub fn covered_run(&self, extent: &Extent) -> i32 {
        let along = |axis: usize| i64::from(extent.last[axis]) - i64::from(extent.first[axis]);
        self.corner(extent.first, [along(0), along(1)])
    }

    /// The least depth of the covered pixels themselves.
    #[must_use]
    pub fn plane(&self, rows: &[RowRun]) -> i32 {
        if self.steep {
            return self.plane.minimum;
        }
        let mut least = i32::MAX;
        for row in rows {
            let x = if self.plane.dx < 0 { row.last } else { row.first };
            least = least.min(self.plane.stored(self.plane.value(x, row.y), self.below));
        }
        least
    }

    /// Least value at `first` and up to `length` steps along each axis from it.
    fn corner(&self, first: [i32; 2], length: [i64; 2]) -> i32 {
        if self.steep {
            return self.plane.minimum;
        }
        let plane = &self.plane;
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        let from_anchor = |axis: usize| i64::from(first[axis]) - i64::from(plane.anchor[axis]);
        let value = i128::from(plane.reference)
            + product(from_anchor(0), plane.dx)
            + product(from_anchor(1), plane.dy)
            + product(length[0], plane.dx).min(0)
            + product(length[1], plane.dy).min(0);
        (value >> self.below).clamp(i128::from(plane.minimum), i128::from(plane.maximum)) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ScreenVertex;
    use crate::geometry::triangle::Triangle;
    use proptest::prelude::*;
    use proptest::sample::select;

    fn vertex(range: i32) -> impl Strategy<Value = ScreenVertex> {
        (-range..=range, -range..=range, 0_u32..=0xFFFF).prop_map(|(x, y, z)| ScreenVertex {
            x,
            y,
            z,
            ..ScreenVertex::default()
        })
    }

    /// What a triangle covers of the block from `corner` on.
    fn rows_in_block(t: &Triangle, corner: [i32; 2], block: [u32; 2]) -> Vec<RowRun> {
        let [right, bottom] = [0, 1].map(|axis| corner[axis].saturating_add(block[axis] as i32));
        (corner[1].max(t.rows[0])..bottom.min(t.rows[2]))
            .map(|y| (y, t.span(y)))
            .map(|(y, [first, beyond])| RowRun { y, first: first.max(corner[0]), last: beyond.min(right) - 1 })
            .filter(|row| row.first <= row.last)
            .collect()
    }

    /// The first two predictions in 64 bits, modulo 2^64.
    fn corner_64(p: &Predictor, first: [i32; 2], length: [i64; 2]) -> i32 {
        let plane = &p.plane;
        let slack = length[0].wrapping_mul(plane.dx).min(0).wrapping_add(length[1].wrapping_mul(plane.dy).min(0));
        plane.stored(plane.value(first[0], first[1]).wrapping_add(slack), p.below)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4096, ..ProptestConfig::default() })]

        #[test]
        fn predictions_are_safe_and_in_order_of_tightness(
            range in select(vec![600, 4000, 60_000, 1 << 23]),
            shares in [(-1.0_f64..1.0, -1.0_f64..1.0), (-1.0..1.0, -1.0..1.0), (-1.0..1.0, -1.0..1.0)],
            depths in [vertex(1), vertex(1), vertex(1)],
            flat in any::<bool>(),
            block in select(vec![
                [32, 1], [33, 1], [8, 8], [16, 2], [1, 1], [256, 256], [511, 1],
                [16_384, 1], [1, 16_384], [16_384, 16_384],
            ]),
            format in (select(vec![16_u32, 24, 31]), select(vec![0_u32, 8, 16, 24])),
            place in 0.0_f64..1.0,
        ) {
            let format = DepthFormat::new(format.0, format.1).unwrap();
            let mut v = depths;
            for (v, share) in v.iter_mut().zip(shares) {
                let z = u64::from(if flat { v.z / 64 + 0x8000 } else { v.z }) * u64::from(format.maximum()) / 0xFFFF;
                *v = ScreenVertex {
                    x: (f64::from(range) * share.0) as i32,
                    y: (f64::from(range) * share.1) as i32,
                    z: z as u32,
                    ..*v
                };
            }
            let Some((t, _)) = Triangle::new(&v, format) else {
                return Ok(());
            };
            let row = t.rows[0] + (f64::from(t.rows[2] - t.rows[0]) * place) as i32;
            let corner = [t.span(row)[0], row - (block[1] / 2) as i32];
            let rows = rows_in_block(&t, corner, block);
            if rows.is_empty() {
                return Ok(());
            }
            let predictor = Predictor::new(&Shape::Triangle(t, v), format);
            let depth = |x: i32, y: i32| t.plane.stored(t.plane.value(x, y), predictor.below);

            let in_turn = [ZaPrediction::BlockLength, ZaPrediction::CoveredRun, ZaPrediction::Plane];
            let predicted = in_turn.map(|prediction| predictor.predict(prediction, block, &rows));

            let nearest = rows.iter().map(|row| {
                let step = ((row.last - row.first) / 16).max(1) as usize;
                (row.first..=row.last).step_by(step).chain([row.last]).map(|x| depth(x, row.y)).min().unwrap()
            }).min().unwrap();
            prop_assert!(predicted[0] <= predicted[1] && predicted[1] <= predicted[2], "{:?}", predicted);
            prop_assert!(predicted[2] <= nearest, "{:?} {}", predicted, nearest);
            prop_assert!(t.steep || predicted[2] == nearest, "{:?} {}", predicted, nearest);
            prop_assert!(!t.steep || predicted == [t.plane.minimum; 3]);
            if fits_64_bits(block) && !t.steep {
                let extent = Extent::of(&rows);
                let covered = [0, 1].map(|k| i64::from(extent.last[k] - extent.first[k]));
                let lengths = [[i64::from(block[0]), i64::from(block[1]) - 1], covered];
                let in_64 = lengths.map(|length| corner_64(&predictor, extent.first, length));
                prop_assert_eq!(&in_64[..], &predicted[..2]);
            }
        }
    }

    #[test]
    fn gradient_toward_the_viewer_takes_one_pixel_more_than_a_block_has() {
        let plane = DepthPlane { reference: 195 << 32, dx: -1 << 32, maximum: 300, ..DepthPlane::default() };
        let predictor = Predictor { plane, steep: false, below: 32 };
        let rows = [RowRun { y: 0, first: 0, last: 31 }];

        let predicted = ZaPrediction::ALL.iter().map(|&p| predictor.predict(p, [32, 1], &rows)).collect::<Vec<_>>();

        assert_eq!(predicted, [163, 164, 164]);
        assert_eq!(ZaPrediction::ALL.iter().map(|&p| clocks(p, 1)).collect::<Vec<_>>(), [1, 2, 2]);
    }

    #[test]
    fn steep_plane_predicts_the_primitives_least_depth() {
        let plane = DepthPlane { reference: 9 << 32, dx: i64::MIN, dy: 7, minimum: 3, maximum: 20, anchor: [0, 0] };
        let predictor = Predictor { plane, steep: true, below: 32 };
        let rows = [RowRun { y: -5, first: -4, last: 900 }, RowRun { y: 16_000, first: 1, last: 1 }];

        let predicted = ZaPrediction::ALL.iter().map(|&p| predictor.predict(p, [16_384, 16_384], &rows));

        assert_eq!(predicted.collect::<Vec<_>>(), [3; 3]);
    }
}
