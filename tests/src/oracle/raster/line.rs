//! Lines of width 1 under the diamond-exit rule.
//!
//! OpenGL 4.6 (core profile), section 14.5.1: the diamond of a pixel is `|x - xc| + |y - yc| < 1/2` (in pixels); a
//! segment from `a` to `b` draws each pixel whose diamond it meets, unless `b` lies in that diamond. To make ties
//! impossible both end points are moved by `(-e, -e^2)`, where e is smaller than every difference that matters.
//! The specification does so with y up; here the shift is taken in the card's own coordinates, y down.
//!
//! This file asks just that question: the moved segment is clipped against the four open half-planes of the diamond,
//! with numbers of the form `p + q e + r e^2` that are compared lexicographically. No stepping, no error term.

use std::cmp::Ordering;

use super::super::Vertex;

/// Half of a diamond's diagonal: half a pixel, in u.
const RADIUS: i128 = 128;

/// `(p + q e + r e^2) / over` for an infinitesimal e > 0; `over` is positive.
#[derive(Clone, Copy, Debug)]
struct Perturbed {
    parts: [i128; 3],
    over: i128,
}

impl Perturbed {
    const ZERO: Self = Self { parts: [0; 3], over: 1 };
    const ONE: Self = Self { parts: [1, 0, 0], over: 1 };

    /// `parts / divisor` for a divisor of either sign, not 0.
    fn quotient(parts: [i128; 3], divisor: i128) -> Self {
        Self { parts: parts.map(|part| part * divisor.signum()), over: divisor.abs() }
    }

    fn cmp(&self, other: &Self) -> Ordering {
        let left = self.parts.map(|part| part * other.over);
        let right = other.parts.map(|part| part * self.over);
        left.cmp(&right)
    }

    fn below(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Less
    }
}

/// How far the moved vertex lies inside the half-plane `sx a + sy b < RADIUS` of the diamond, where `(a, b)` is its
/// offset from the centre: `RADIUS - sx (a - e) - sy (b - e^2)`. Positive is inside.
fn slack(vertex: &Vertex, centre: [i128; 2], [sx, sy]: [i128; 2]) -> [i128; 3] {
    let a = i128::from(vertex.x) - centre[0];
    let b = i128::from(vertex.y) - centre[1];
    [RADIUS - sx * a - sy * b, sx, sy]
}

const SIDES: [[i128; 2]; 4] = [[1, 1], [1, -1], [-1, 1], [-1, -1]];

/// Whether the moved vertex lies in the open diamond with the given centre, in u.
fn in_diamond(vertex: &Vertex, centre: [i128; 2]) -> bool {
    SIDES.iter().all(|&side| slack(vertex, centre, side) > [0; 3])
}

/// Whether the moved segment, both ends included, meets the open diamond with the given centre.
///
/// A point of it is `start + t (end - start)`, `0 <= t <= 1`; each side of the diamond bounds t from above, from below,
/// or not at all. Intervals of a line meet in a common point when any two of them do.
fn meets_diamond(line: &[Vertex; 2], centre: [i128; 2]) -> bool {
    let dx = i128::from(line[1].x) - i128::from(line[0].x);
    let dy = i128::from(line[1].y) - i128::from(line[0].y);
    // Open bounds: above < t < below.
    let mut above: Vec<Perturbed> = Vec::with_capacity(4);
    let mut below: Vec<Perturbed> = Vec::with_capacity(4);
    for [sx, sy] in SIDES {
        let slack = slack(&line[0], centre, [sx, sy]);
        // Inside where slope * t < slack.
        let slope = sx * dx + sy * dy;
        match slope.cmp(&0) {
            Ordering::Greater => below.push(Perturbed::quotient(slack, slope)),
            Ordering::Less => above.push(Perturbed::quotient(slack, slope)),
            Ordering::Equal if slack > [0; 3] => {}
            Ordering::Equal => return false,
        }
    }
    above.iter().all(|low| low.below(&Perturbed::ONE) && below.iter().all(|high| low.below(high)))
        && below.iter().all(|high| Perturbed::ZERO.below(high))
}

/// Whether the line from the first vertex to the second draws pixel `(i, j)`. A line of length 0 draws nothing.
#[must_use]
pub fn line_covers(line: &[Vertex; 2], i: i32, j: i32) -> bool {
    let centre = [i, j].map(|pixel| i128::from(pixel) * 256 + 128);
    meets_diamond(line, centre) && !in_diamond(&line[1], centre)
}

/// Whether columns (true) or rows count along the line: x-major when `|dx| >= |dy|`.
#[must_use]
pub fn is_x_major(line: &[Vertex; 2]) -> bool {
    line[0].x.abs_diff(line[1].x) >= line[0].y.abs_diff(line[1].y)
}

/// Visits the drawn pixels of the target along the major axis. Only pixels whose squares the segment can touch are
/// put to [`line_covers`], so that long lines stay affordable.
pub(super) fn visit(line: &[Vertex; 2], width: u32, height: u32, visit: &mut impl FnMut(u32, u32)) {
    let x_major = is_x_major(line);
    // (major, minor) coordinates, by rising major coordinate.
    let mut ends = line.map(|v| if x_major { (v.x, v.y) } else { (v.y, v.x) });
    ends.sort_unstable();
    let [(m0, n0), (m1, n1)] = ends;
    if m0 == m1 {
        return;
    }
    let (major_size, minor_size) = if x_major { (width, height) } else { (height, width) };
    for major in super::touched(m0, m1, major_size) {
        // The minor coordinate where the segment enters and leaves this column or row.
        let minor_at = |m: i64| {
            let m = i128::from(m.clamp(m0.into(), m1.into()));
            let run = i128::from(m1) - i128::from(m0);
            let rise = i128::from(n1) - i128::from(n0);
            let offset = ((m - i128::from(m0)) * rise).div_euclid(run);
            (i128::from(n0) + offset) as i32
        };
        let start = i64::from(major) * 256;
        let (first, last) = (minor_at(start), minor_at(start + 256));
        for minor in super::touched(first.min(last), first.max(last), minor_size) {
            let (i, j) = if x_major { (major, minor) } else { (minor, major) };
            if line_covers(line, i as i32, j as i32) {
                visit(i, j);
            }
        }
    }
}

#[cfg(test)]
#[path = "line_tests.rs"]
mod tests;
