//! A host tile, layer by layer: where one order of the layers holds for all of its pixels.
//!
//! Most translucent things lie one behind the other. If the depths that each layer has in the tile do not overlap with
//! those of any other, or are one and the same depth, the order of the layers at each pixel is their order in the tile:
//! they are painted from the farthest to the nearest, row by row, 16 pixels at a time, as an opaque triangle would be.
//! Bounds of the opaque depths in the tile say for most layers that all or none of it is seen. A tile in which depths
//! overlap is looked at in blocks of 16x16 pixels ([`super::unit`]): in most of them there is an order, and they are painted
//! in the same way. What is left goes to [`super::pixels`].
//!
//! Duties: order of layers, depth tests, blending. Inputs from: [`super::piece`], opaque depths. Outputs to:
//! [`super::canvas`], counts. Clocks: those of [`super`]. Everything here must equal [`super::specification`] bit for bit
//! at every SIMD level.

use super::Counts;
use super::blend::Factors;
use super::canvas::Canvas;
use super::piece::{Colours, Palette, Part, Piece, Pixels};
use crate::geometry::plane::below;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use crate::hidden::z_buffer::tile::TILE;
use crate::subpixel::scene::ItemDraw;
use fearless_simd::prelude::*;
use fearless_simd::{i32x16, mask32x16, u32x16};
use zga_abi::format::DepthFormat;

/// Where a tile stands, and the opaque depths behind it.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// First column and row.
    pub corner: [i32; 2],
    /// Pixels that may change.
    pub area: Pixels,
    /// Depths, from the tile's first row on; empty where there are none.
    pub depth: &'a [i32],
    /// Words from a row of depths to the next.
    pub depth_pitch: usize,
    /// Number format of depth.
    pub format: DepthFormat,
    /// State of the layers' draws.
    pub draws: &'a [ItemDraw],
    /// Stencil values, from the tile's first row on; empty where there are none.
    pub stencil: &'a [u8],
    /// Bytes from a row of stencil values to the next.
    pub stencil_pitch: usize,
}

impl Place<'_> {
    /// Place of pixel (`x`, `y`) in the tile: row and column.
    #[must_use]
    #[inline(always)]
    pub fn of(&self, x: i32, y: i32) -> [usize; 2] {
        [(y - self.corner[1]) as usize, (x - self.corner[0]) as usize]
    }

    /// Opaque depth of pixel (`x`, `y`); means nothing where there are none.
    #[must_use]
    #[inline(always)]
    pub fn depth_at(&self, x: i32, y: i32) -> i32 {
        let row = (y - self.corner[1]) as usize;
        self.depth.get(row * self.depth_pitch + x as usize).copied().unwrap_or(0)
    }

    /// Stencil value of pixel (`x`, `y`); means nothing where there are none.
    #[must_use]
    pub fn stencil_at(&self, x: i32, y: i32) -> u8 {
        let row = (y - self.corner[1]) as usize;
        self.stencil.get(row * self.stencil_pitch + x as usize).copied().unwrap_or(0)
    }

    /// Least and greatest opaque depth of the tile's pixels.
    #[inline(always)]
    fn bounds(&self) -> [i32; 2] {
        let [[left, right], [top, bottom]] = self.area;
        let mut bounds = [i32::MAX, i32::MIN];
        for y in top..bottom {
            let row = (y - self.corner[1]) as usize * self.depth_pitch;
            let depths = self.depth.get(row + left as usize..row + right as usize).unwrap_or_default();
            for &depth in depths {
                bounds = [bounds[0].min(depth), bounds[1].max(depth)];
            }
        }
        bounds
    }
}

/// What is known of a layer's tests in a tile beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    All,
    None,
    Open,
}

/// Verdict of a test of depths in `range` against depths in `bounds`.
fn verdict(test: DepthTest, range: [i32; 2], bounds: [i32; 2]) -> Verdict {
    let less = range[0] < bounds[1];
    let equal = range[0] <= bounds[1] && bounds[0] <= range[1];
    let greater = range[1] > bounds[0];
    let outcomes = [(less, test.less), (equal, test.equal), (greater, test.greater)];
    let mut possible = outcomes.iter().filter(|(possible, _)| *possible);
    if possible.clone().all(|(_, passes)| *passes) {
        Verdict::All
    } else if possible.all(|(_, passes)| !passes) {
        Verdict::None
    } else {
        Verdict::Open
    }
}

/// The order that holds for a whole tile.
#[derive(Debug, Default)]
pub struct Order {
    /// Range of depths and place of each layer; sorted, the farthest first.
    places: Vec<([i32; 2], u32)>,
}

impl Order {
    /// Puts the layers of a tile in order; `false` if no order holds for all of its pixels, or a layer has a stencil test,
    /// which is made pixel by pixel.
    #[inline(always)]
    pub fn find(&mut self, parts: &[Part], format: DepthFormat, draws: &[ItemDraw]) -> bool {
        self.places.clear();
        for (place, part) in (0..).zip(parts) {
            match part {
                Part::Layer(piece) if piece.stencil(draws).is_none() => self.places.push((piece.range(format), place)),
                Part::Layer(_) | Part::Clear(_) | Part::Cover(_) => return false,
            }
        }
        self.places.sort_unstable_by_key(|&([near, _], place)| (std::cmp::Reverse(near), place));
        // What stands further up has depths at least as far; of equal depths the earlier comes first.
        let mut pairs = self.places.iter().zip(self.places.iter().skip(1));
        pairs.all(|((far, earlier), (near, later))| near[1] < far[0] || (near[1] == far[0] && earlier < later))
    }

    /// Whether that is the order of submission.
    #[must_use]
    pub fn is_of_submission(&self) -> bool {
        self.places.is_sorted_by_key(|&(_, place)| place)
    }
}

/// Paints the layers of a tile in an order that was found; the canvas holds its pixels.
#[inline(always)]
pub fn paint<S: Simd>(
    simd: S,
    parts: &[Part],
    order: &Order,
    place: &Place<'_>,
    palette: &mut Palette,
    canvas: &mut Canvas,
    counts: &mut Counts,
) {
    let mut bounds = None;
    let ordered = order.is_of_submission();
    for &(range, number) in &order.places {
        let Part::Layer(piece) = &parts[number as usize] else {
            continue;
        };
        let verdict = match piece.test {
            None => Verdict::All,
            Some(test) if test.less && test.equal && test.greater => Verdict::All,
            Some(test) => verdict(test, range, *bounds.get_or_insert_with(|| place.bounds())),
        };
        let before = counts.blended;
        // From 1 on: 0 is nobody.
        let number = if ordered { None } else { Some(number + 1) };
        if verdict == Verdict::None {
            counts.fragments += (piece.area[1][0]..piece.area[1][1]).map(|y| width(piece.span(y))).sum::<u64>();
        } else {
            let colours = palette.of(piece, place.draws);
            let brush = Brush::new(simd, piece, colours, verdict == Verdict::Open, number, place);
            brush.paint(simd, place, canvas, counts);
        }
        piece.count_shaded(place.draws, counts.blended - before, counts);
    }
}

/// Pixels of a span.
#[inline(always)]
fn width([from, to]: [i32; 2]) -> u64 {
    (to - from).max(0) as u64
}

/// A layer that is painted.
struct Brush<'a, S: Simd> {
    piece: &'a Piece,
    colours: &'a Colours,
    /// Of a layer of one colour.
    flat: Option<Factors<S>>,
    /// Its test has to be made.
    tested: bool,
    /// Its number, where the order of layers is looked at.
    number: Option<u32>,
    steps: Steps<S>,
    /// Outcomes that pass: nearer, equal, farther.
    outcomes: [mask32x16<S>; 3],
    below: u32,
}

impl<'a, S: Simd> Brush<'a, S> {
    #[inline(always)]
    fn new(
        simd: S,
        piece: &'a Piece,
        colours: &'a Colours,
        tested: bool,
        number: Option<u32>,
        place: &Place<'_>,
    ) -> Self {
        let format = place.format;
        #[expect(clippy::manual_map, reason = "a closure is not sure to become part of code for the level it runs at")]
        let flat = match colours.flat() {
            Some(colour) => Some(Factors::new(simd, piece.mode, u32x16::splat(simd, colour))),
            None => None,
        };
        let test = piece.test.unwrap_or(DepthTest::ALWAYS);
        let outcomes = [
            mask32x16::splat(simd, test.less),
            mask32x16::splat(simd, test.equal),
            mask32x16::splat(simd, test.greater),
        ];
        let (steps, below) = (Steps::new(simd, piece.plane.dx), below(format));
        Brush { piece, colours, flat, tested, number, steps, outcomes, below }
    }

    #[inline(always)]
    fn paint(&self, simd: S, place: &Place<'_>, canvas: &mut Canvas, counts: &mut Counts) {
        let [top, bottom] = self.piece.area[1];
        let [left, first] = place.corner;
        for y in top..bottom {
            let [from, to] = self.piece.span(y);
            if from >= to {
                continue;
            }
            let (row, [from, to]) = ((y - first) as usize, [from, to].map(|x| (x - left) as usize));
            counts.fragments += (to - from) as u64;
            // Bits of columns from..to; at least one, at most 64.
            let bits = (u64::MAX >> (TILE - (to - from))) << from;
            let passed = self.row(simd, place, canvas, row, bits, [from, to]);
            canvas.blended[row] |= passed;
            counts.blended += u64::from(passed.count_ones());
        }
    }

    /// Blends the layer into the pixels of a row that `bits` has a bit for, columns `from..to`; returns those that passed.
    #[inline(always)]
    fn row(
        &self,
        simd: S,
        place: &Place<'_>,
        canvas: &mut Canvas,
        row: usize,
        bits: u64,
        [from, to]: [usize; 2],
    ) -> u64 {
        let [left, y] = [place.corner[0], place.corner[1] + row as i32];
        let lane = u32x16::from_slice(simd, &LANE);
        let mut passed = bits;
        let mut first = from & !(LANES - 1);
        while first < to {
            let x = left + first as i32;
            let mut mine = (lane - (from as u32).wrapping_sub(first as u32)).simd_lt((to - from) as u32);
            if self.tested {
                let depths = &place.depth[row * place.depth_pitch + x as usize..][..LANES];
                mine &= self.passes(simd, i32x16::from_slice(simd, depths), x, y);
                let (found, all) = (mine.to_bitmask() & 0xFFFF, 0xFFFF_u64 << first);
                passed &= !all | (found << first);
                if found == 0 {
                    first += LANES;
                    continue;
                }
            }
            let pixels = &mut canvas.colours[row * TILE + first..][..LANES];
            let behind = u32x16::from_slice(simd, pixels);
            let composed = match &self.flat {
                Some(factors) => factors.over(simd, behind),
                None => Factors::new(simd, self.piece.mode, self.colours.sixteen(simd, x, y)).over(simd, behind),
            };
            mine.select(composed, behind).store_slice(pixels);
            if let Some(number) = self.number {
                canvas.note(simd, row, first, (passed >> first) as u32 & 0xFFFF, number);
            }
            first += LANES;
        }
        passed
    }

    /// Which of 16 pixels from (`x`, `y`) on pass the test against `stored`.
    #[inline(always)]
    fn passes(&self, simd: S, stored: i32x16<S>, x: i32, y: i32) -> mask32x16<S> {
        let plane = &self.piece.plane;
        let value = plane.value(x, y);
        let depths = if self.below == 32 {
            self.steps.upper(simd, value).max(plane.minimum).min(plane.maximum)
        } else {
            let at = |lane: u32| plane.stored(value.wrapping_add(i64::from(lane).wrapping_mul(plane.dx)), self.below);
            i32x16::from_slice(simd, &LANE.map(at))
        };
        let [less, equal, greater] = self.outcomes;
        (less & depths.simd_lt(stored)) | (equal & depths.simd_eq(stored)) | (greater & depths.simd_gt(stored))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdict_less_against_one_depth() {
        let test = DepthTest::LESS;
        assert_eq!(verdict(test, [3, 9], [10, 10]), Verdict::All);
        assert_eq!(verdict(test, [3, 10], [10, 10]), Verdict::Open);
        assert_eq!(verdict(test, [10, 12], [10, 10]), Verdict::None);
        let equal = DepthTest { less: false, equal: true, ..test };
        assert_eq!(verdict(equal, [10, 10], [10, 10]), Verdict::All);
        assert_eq!(verdict(equal, [11, 12], [10, 10]), Verdict::None);
    }
}
