//! Segments: lines of single pixels, as window systems define lines of width zero.
//!
//! Source: J. E. Bresenham, "Ambiguities in Incremental Line Rastering", IEEE Computer Graphics and Applications, May 1987,
//! with the preference of the axial step in the octants that the X Window System's sample server biases. The pixels stand in
//! [`zga_abi::packet::SegmentFlags`]. A clip box takes pixels away and moves none.
//!
//! Duties and clocks: see [`super`]; 1 clock for the setup of each segment, 1 for each pixel lit, since pixels of a line
//! lie in one line of memory only by chance, and 1 more for each where what is there has to be read.
//! Inputs: [`SegmentList`] from the firmware. Outputs: pixels. Specification: [`super::list_specification`].
//!
//! Fast way: the step along the shorter axis is a sum in fixed point, rounded up, with 40 fraction bits. The true quotients
//! are multiples of 1 / 2n, n < 2^17, and a sum of i <= n steps is off by less than 2^-22: the integer part is the floor
//! that the definition asks for. So pixel i needs no pixel before it. Which pixels lie in a clip box follows from the
//! definition turned round, in 64-bit integers.

use super::canvas::Grid;
use super::combine::{Masks, Pixel};
use super::{Bitmap, list_specification};
use crate::probe::account::{Account, Clocks};
use std::ops::Range;
use zga_abi::Counter;
use zga_firmware::checked::{ClipBox, Segment, SegmentList};

/// Fraction bits of the walk along the shorter axis.
const FRACTION: u32 = 40;

/// A segment, as steps along its longer and its shorter axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// y is the longer one, or both are equal.
    steep: bool,
    /// Steps along the longer and the shorter one, below 2^18.
    steps: [i64; 2],
    /// First place on the longer and the shorter one.
    from: [i64; 2],
    /// Direction on the longer and the shorter one: 1 or -1.
    sign: [i64; 2],
    /// An error of exactly zero is no step along the shorter one.
    bias: i64,
}

impl Axes {
    /// The axes of a segment.
    #[inline(always)]
    pub(super) fn of(segment: &Segment) -> Axes {
        let along = |from: i32, to: i32| (i64::from(from), i64::from(to) - i64::from(from));
        let (x, y) = (along(segment.from.x, segment.to.x), along(segment.from.y, segment.to.y));
        let steep = y.1.abs() >= x.1.abs();
        let (long, short) = if steep { (y, x) } else { (x, y) };
        Axes {
            steep,
            steps: [long.1.abs(), short.1.abs()],
            from: [long.0, short.0],
            sign: [long.1, short.1].map(|difference| if difference < 0 { -1 } else { 1 }),
            bias: i64::from(long.1 < 0),
        }
    }

    /// Pixels of the segment without a clip box.
    pub(super) fn pixels(&self, last: bool) -> Range<i64> {
        0..self.steps[0] + i64::from(last)
    }

    /// Steps along the shorter axis before pixel `i`.
    #[cfg(test)]
    fn across(&self, i: i64) -> i64 {
        let [n, m] = self.steps;
        if n == 0 { 0 } else { (2 * m * i + n - self.bias).div_euclid(2 * n) }
    }

    /// Those of the pixels `all` that lie in a clip box.
    #[inline(always)]
    pub(super) fn inside(&self, all: Range<i64>, clip: ClipBox) -> Range<i64> {
        let (columns, rows) = ([clip.x1, clip.x2], [clip.y1, clip.y2]);
        let (long, short) = if self.steep { (rows, columns) } else { (columns, rows) };
        // Steps from the first place, where the box begins and ends.
        let reach = |axis: usize, [low, beyond]: [i32; 2]| {
            let (low, beyond, from) = (i64::from(low), i64::from(beyond), self.from[axis]);
            if self.sign[axis] > 0 { low - from..beyond - from } else { from - beyond + 1..from - low + 1 }
        };
        let (long, short) = (reach(0, long), reach(1, short));
        let [n, m] = self.steps;
        let mut inside = all.start.max(long.start)..all.end.min(long.end);
        if m == 0 {
            if short.start > 0 || short.end <= 0 {
                inside.end = inside.start;
            }
            return inside;
        }
        // Pixel i has made k steps across or more from 2 m i >= 2 n k - n + b on.
        let first = |k: i64| (2 * n * k - n + self.bias + 2 * m - 1).div_euclid(2 * m);
        if short.start > 0 {
            inside.start = inside.start.max(first(short.start));
        }
        if short.end <= m {
            inside.end = inside.end.min(first(short.end));
        }
        inside
    }
}

impl Bitmap {
    /// Draws lines of single pixels.
    pub(crate) fn segments(&mut self, memory: &mut [u32], list: &SegmentList<'_>, account: &mut Account) {
        self.clips.clear();
        self.clips.extend(list.canvas.clip_boxes());
        let lit = if self.specification {
            list_specification::segments(memory, list)
        } else {
            match list.canvas.surface.format.bytes() {
                4 => light_all::<u32>(memory, list, &self.clips),
                2 => light_all::<u16>(bytemuck::cast_slice_mut(memory), list, &self.clips),
                _ => light_all::<u8>(bytemuck::cast_slice_mut(memory), list, &self.clips),
            }
        };
        let there = u64::from(list.canvas.reads_destination());
        let entries = list.segments().len() as u64;
        account.add(Counter::BitmapEntries, entries);
        account.add(Counter::BitmapPixels, lit);
        account.add(Counter::BitmapSegmentPixels, lit);
        account.add(Counter::BitmapCombined, there * lit);
        account.charge(Counter::CyclesBitmap, Clocks(entries + (1 + there) * lit));
    }
}

/// Lights the pixels of all segments; returns how many.
fn light_all<P: Pixel>(memory: &mut [P], list: &SegmentList<'_>, clips: &[ClipBox]) -> u64 {
    let [keep, flip] = Masks::<P>::new(list.canvas.operation, list.canvas.planes).under(P::of(list.value));
    if keep == P::of(0) {
        light_each(memory, list, clips, |pixel| *pixel = flip)
    } else {
        light_each(memory, list, clips, |pixel| *pixel = (*pixel & keep) ^ flip)
    }
}

#[inline(always)]
fn light_each<P: Pixel>(
    memory: &mut [P],
    list: &SegmentList<'_>,
    clips: &[ClipBox],
    mut light: impl FnMut(&mut P),
) -> u64 {
    let grid = Grid::of(&list.canvas.surface);
    let mut lit = 0;
    for segment in list.segments() {
        let axes = Axes::of(&segment);
        let all = axes.pixels(segment.last);
        let holds = |clip: &ClipBox, x, y| (clip.x1..clip.x2).contains(&x) && (clip.y1..clip.y2).contains(&y);
        for &clip in clips {
            let [from, to] = [segment.from, segment.to].map(|point| holds(&clip, point.x, point.y));
            let range = if from && to { all.clone() } else { axes.inside(all.clone(), clip) };
            if range.start < range.end {
                lit += (range.end - range.start) as u64;
                walk(memory, grid, &segment, &axes, range, &mut light);
            }
        }
    }
    lit
}

/// Lights the pixels `range` of a segment, which lie in the surface.
#[inline(always)]
fn walk<P: Pixel>(
    memory: &mut [P],
    grid: Grid,
    segment: &Segment,
    axes: &Axes,
    range: Range<i64>,
    light: &mut impl FnMut(&mut P),
) {
    let [n, m] = axes.steps;
    let strides = if axes.steep { [grid.pitch as i64, 1] } else { [1, grid.pitch as i64] };
    let [along, across] = [0, 1].map(|axis| axes.sign[axis] * strides[axis]);
    let first = grid.reckon(segment.from.x, segment.from.y);
    if m == 0 && !axes.steep {
        let ends = [range.start, range.end - 1].map(|i| (first + i * along) as usize);
        memory[ends[0].min(ends[1])..=ends[0].max(ends[1])].iter_mut().for_each(light);
        return;
    }
    // Truncated and one added: above the quotient by at most 1.001, since f64 has more digits than the quotient.
    let quotient = |dividend: i64, divisor: i64| (((dividend << FRACTION) as f64 / divisor as f64) as u64) + 1;
    let (step, half) = if n == 0 { (0, 0) } else { (quotient(m, n), quotient(n - axes.bias, 2 * n)) };
    let mut short = half + step * range.start as u64;
    let mut long = first + along * range.start;
    for _ in range {
        light(&mut memory[(long + across * (short >> FRACTION) as i64) as usize]);
        long += along;
        short += step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use zga_firmware::checked::Point;

    fn place() -> impl Strategy<Value = i32> {
        prop_oneof![4 => -40..40_i32, 1 => -65536..65535_i32, 1 => Just(-65536), 1 => Just(65534)]
    }

    proptest! {
        /// The definition turned round gives the pixels that the definition puts in the box.
        #[test]
        fn inside_any_segment_and_box_is_what_lies_in_it(
            ends in [place(), place(), place(), place()],
            corner in [-30..30_i32, -30..30_i32],
            size in [1..30_i32, 1..30_i32],
            last in any::<bool>(),
        ) {
            let [x1, y1, x2, y2] = ends;
            let segment = Segment { from: Point { x: x1, y: y1 }, to: Point { x: x2, y: y2 }, last };
            let axes = Axes::of(&segment);
            let clip = ClipBox { x1: corner[0], y1: corner[1], x2: corner[0] + size[0], y2: corner[1] + size[1] };
            let holds = |i: &i64| {
                let (long, short) = (axes.from[0] + axes.sign[0] * i, axes.from[1] + axes.sign[1] * axes.across(*i));
                let (x, y) = if axes.steep { (short, long) } else { (long, short) };
                (i64::from(clip.x1)..i64::from(clip.x2)).contains(&x)
                    && (i64::from(clip.y1)..i64::from(clip.y2)).contains(&y)
            };
            let expected: Vec<i64> = axes.pixels(last).filter(holds).collect();
            let found: Vec<i64> = axes.inside(axes.pixels(last), clip).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
