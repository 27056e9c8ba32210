//! Crossings: where boundaries of rows cut edges and lines, for the functional model.
//!
//! Duties: floor and ceiling of a crossing, exactly, in a few clocks of the host; the steps of a line on
//! given rows. Inputs: vertices, lines that are set up. Outputs: u and pixels.
//!
//! A boundary crosses an edge at x + n / dy with |n| <= 2^48, dy <= 2^24. The quotient is formed in f64
//! with a reciprocal and is wrong by less than 2^-27; it is a whole number or at least 2^-24 away from
//! one, so adding or taking 2^-25 before rounding gives the exact floor and ceiling. The structural model
//! compares rationals instead ([`super::extent`]).

use crate::geometry::ScreenVertex;
use crate::geometry::line::Line;
use crate::geometry::triangle::WALK;

/// Least and greatest X, u, the fraction rounded away from the polygon.
pub type Across = [i32; 2];

/// The extent of nothing.
pub const NOTHING: Across = [i32::MAX, i32::MIN];

/// The extent of both.
#[must_use]
#[inline(always)]
pub fn union(a: Across, b: Across) -> Across {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// An edge from top to bottom.
#[derive(Clone, Copy, Debug)]
pub struct Slope {
    /// Upper end, u.
    from: [i32; 2],
    dx: i32,
    /// 1 / dy; an edge without height is never crossed.
    inverse: f64,
}

impl Slope {
    #[inline(always)]
    #[must_use]
    pub fn new(a: &ScreenVertex, b: &ScreenVertex) -> Slope {
        Slope { from: [a.x, a.y], dx: b.x - a.x, inverse: 1.0 / f64::from(b.y - a.y) }
    }

    /// Where boundary `y` crosses it: the whole u before and after.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, y: i32) -> Across {
        /// Keeps sums above 0, so that truncation rounds down; leaves 26 fraction bits.
        const OFFSET: i32 = 1 << 25;
        const MARGIN: f64 = 1.0 / (1_u64 << 25) as f64;
        let n = i64::from(y - self.from[1]) * i64::from(self.dx);
        let quotient = n as f64 * self.inverse;
        let floor = |q: f64| (q + f64::from(OFFSET)) as i32 - OFFSET;
        [self.from[0] + floor(quotient + MARGIN), self.from[0] + floor(quotient - MARGIN) + 1]
    }
}

/// The edges of a triangle, as set-up has them: one from top to bottom, two on the other side.
#[derive(Clone, Copy, Debug)]
pub struct Edges {
    long: Slope,
    short: [Slope; 2],
    /// Y of the middle vertex, u.
    middle: i32,
}

impl Edges {
    #[inline(always)]
    #[must_use]
    pub fn new(v: &[ScreenVertex; 3]) -> Edges {
        let (low, high) = if v[1].y < v[0].y { (1, 0) } else { (0, 1) };
        let top = if v[2].y < v[low].y { 2 } else { low };
        let bottom = if v[2].y < v[high].y { high } else { 2 };
        let (top, middle, bottom) = (&v[top], &v[3 - top - bottom], &v[bottom]);
        Edges {
            long: Slope::new(top, bottom),
            short: [Slope::new(top, middle), Slope::new(middle, bottom)],
            middle: middle.y,
        }
    }

    /// Both crossings of a boundary between top and bottom.
    #[inline(always)]
    #[must_use]
    pub fn crossings(&self, y: i32) -> Across {
        let short = &self.short[usize::from(y >= self.middle)];
        union(self.long.at(y), short.at(y))
    }
}

/// Steps of an x-major line that lie on rows `rows`, among `steps`: the first, and the first beyond.
#[must_use]
pub fn steps_on_rows(line: &Line, steps: [i32; 2], rows: [i32; 2]) -> [i32; 2] {
    let start = i64::from(steps[0] - line.steps[0]) * line.slope + line.minor;
    // Distance from the first step to where a row begins.
    let to = |row: i32| (i64::from(row) << WALK) - start;
    // Going down the first step on a row is ceil(distance / slope), going up 1 + floor(distance / slope)
    // is the first above it.
    let [first, beyond] = match line.slope {
        0 => return steps,
        slope if slope > 0 => rows.map(|row| (to(row) + slope - 1).div_euclid(slope)),
        slope => [to(rows[1]), to(rows[0])].map(|distance| (-distance).div_euclid(-slope) + 1),
    };
    let length = i64::from(steps[1] - steps[0]);
    [first, beyond].map(|step| steps[0] + step.clamp(0, length) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::Axis;
    use proptest::prelude::*;
    use zga_abi::format::DepthFormat;

    fn at(x: i32, y: i32) -> ScreenVertex {
        ScreenVertex { x, y, ..ScreenVertex::default() }
    }

    /// Floor and ceiling of the crossing by definition.
    fn exact(a: [i32; 2], dx: i32, dy: i32, y: i32) -> Across {
        let n = i128::from(a[0]) * i128::from(dy) + i128::from(y - a[1]) * i128::from(dx);
        [n.div_euclid(i128::from(dy)) as i32, -(-n).div_euclid(i128::from(dy)) as i32]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        #[test]
        fn slope_random_crossing_equals_rational(x in -(1_i32 << 23)..1 << 23, dx in -(1_i32 << 24)..=1 << 24, dy in 1_i32..=1 << 24, shrink in 0_u32..24, down in 0.0_f64..=1.0) {
            let dy = (dy >> shrink).max(1);
            let y = (f64::from(dy) * down) as i32;
            let slope = Slope::new(&at(x, 0), &at(x + dx, dy));
            prop_assert_eq!(slope.at(y), exact([x, 0], dx, dy, y));
        }

        #[test]
        fn slope_crossing_on_or_next_to_a_whole_u_equals_rational(x in -(1_i32 << 23)..1 << 23, dx in 1_i32..4096, factor in 1_i32..4096, part in 0_i32..=4096, off in -1_i32..=1, left: bool) {
            // The edge meets row `y` at a whole u; moved by a u at one end it just does not.
            let (dx, dy) = (if left { -dx * 4096 } else { dx * 4096 }, factor * 4096 + off);
            let y = (factor * part).min(dy);
            let slope = Slope::new(&at(x, 0), &at(x + dx, dy));
            prop_assert_eq!(slope.at(y), exact([x, 0], dx, dy, y));
        }

        #[test]
        fn steps_on_rows_random_are_those_whose_pixel_lies_there(ends in [[-20_000_i32..20_000, -20_000..20_000], [-20_000..20_000, -20_000..20_000]], rows in [-40_i32..40, -40..40]) {
            let line = Line::new(&ends.map(|[x, y]| at(x, y)), DepthFormat::default());
            let rows = [rows[0].min(rows[1]), rows[0].max(rows[1])];
            for line in line.into_iter().filter(|line| line.axis == Axis::X) {
                let [first, beyond] = steps_on_rows(&line, line.steps, rows);
                for step in line.steps[0]..line.steps[1] {
                    let there = line.slope == 0 || (rows[0]..rows[1]).contains(&line.minor_at(step));
                    prop_assert_eq!((first..beyond).contains(&step), there, "step {} of {:?}", step, line);
                }
            }
        }
    }

    #[test]
    fn slope_longest_edge_least_fraction_is_not_lost() {
        // 2^24 u down and across but one: the crossing is 2^-24 before a whole u.
        let longest = 1 << 24;
        let slope = Slope::new(&at(-longest / 2, 0), &at(longest / 2 - 1, longest));
        assert_eq!(slope.at(1), [-longest / 2, 1 - longest / 2]);
        assert_eq!(slope.at(longest - 1), exact([-longest / 2, 0], longest - 1, longest, longest - 1));
    }
}
