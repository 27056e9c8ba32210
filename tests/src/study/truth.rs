//! What a scene looks like in exact arithmetic: the mean colour of any number of samples of each pixel, every one of them
//! decided by integers.
//!
//! Samples lie at the middles of C x R equal rectangles of the pixel, as the card's do; with many of them the mean is the
//! true picture, with the card's own number it is what that number can show at best. Coverage follows the top-left rule
//! on the unsnapped vertices. Of two triangles at a sample the one whose exact plane is nearer is seen, of equal ones the
//! earlier: planes are compared in f64 where the difference is beyond the rounding of both, else as fractions. A sample
//! has the colour of its own place, in f64: of a triangle in one colour exactly.
//!
//! Rows of pixels are spread over threads; the picture does not depend on how many.

use std::num::NonZero;
use std::thread;

use super::scene::{FAR, Facet, Scene, UNITS};
use crate::oracle::exact::Fraction;

/// Nobody: what is behind everything.
pub const NOBODY: u32 = u32::MAX;

/// The exact picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Pixels of a row, and rows.
    pub size: [u32; 2],
    /// Samples of a pixel.
    pub samples: u32,
    /// Sum over the samples of red, green and blue, row by row.
    pub sums: Vec<[f64; 3]>,
    /// What there is in each pixel.
    pub pixels: Vec<Pixel>,
    /// Who is seen at the sample nearest to the pixel's centre (at it, where the numbers of samples are odd); position in
    /// the scene or [`NOBODY`].
    pub winners: Vec<u32>,
}

/// What a pixel shows at its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    /// More than one triangle, or a triangle and the background.
    pub edge: bool,
    /// Two triangles cut each other inside: each is in front of the other at some sample where both are.
    pub crossing: bool,
}

impl Truth {
    /// Mean colour of a pixel in levels, 0..=255.
    #[must_use]
    pub fn mean(&self, pixel: usize) -> [f64; 3] {
        self.sums[pixel].map(|sum| sum / f64::from(self.samples))
    }

    /// Largest distance of a channel of an XRGB8888 pixel from the mean, levels.
    #[must_use]
    pub fn distance(&self, pixel: usize, shown: u32) -> f64 {
        let [_, red, green, blue] = shown.to_be_bytes();
        let channels = self.mean(pixel).into_iter().zip([red, green, blue]);
        channels.map(|(mean, level)| (mean - f64::from(level)).abs()).fold(0.0, f64::max)
    }

    /// Whether a pixel shows something else than the rounded mean: half a level is the rounding's.
    #[must_use]
    pub fn is_wrong(&self, pixel: usize, shown: u32) -> bool {
        self.distance(pixel, shown) > 0.5 + 1e-9
    }

    /// The picture with levels rounded, XRGB8888.
    #[must_use]
    pub fn rounded(&self) -> Vec<u32> {
        let pixel = |pixel: usize| {
            let [red, green, blue] = self.mean(pixel).map(|level| level.round() as u32);
            red << 16 | green << 8 | blue
        };
        (0..self.sums.len()).map(pixel).collect()
    }
}

/// A triangle set up: edges positive inside, and its plane.
struct Plane {
    /// a x + b y + c; for edges that own their points c is one more, so that all are inside above 0.
    edges: [[i64; 3]; 3],
    /// First and last row and column of samples cannot be outside of these, 1/4096 pixel.
    least: [i32; 2],
    greatest: [i32; 2],
    anchor: [i64; 2],
    /// z - z of the anchor = (a dx + b dy) / d.
    slope: [i128; 2],
    d: i128,
    z: i128,
    /// The same in f64.
    gradient: [f64; 2],
    /// What rounding can do to a depth evaluated in f64.
    error: f64,
    /// Red, green and blue at the anchor, and their steps along x and y.
    colour: [[f64; 3]; 3],
}

impl Plane {
    /// `None` for what covers nothing.
    fn new(facet: &Facet) -> Option<Self> {
        let [p0, p1, p2] = facet.corners.map(|corner| corner.map(i64::from));
        let [z0, z1, z2] = facet.depths.map(i128::from);
        let (dx1, dy1, dx2, dy2) = (p1[0] - p0[0], p1[1] - p0[1], p2[0] - p0[0], p2[1] - p0[1]);
        let area = dx1 * dy2 - dx2 * dy1;
        if area == 0 {
            return None;
        }
        let order = if area > 0 { [p0, p1, p2] } else { [p0, p2, p1] };
        let edges = [0, 1, 2].map(|k| {
            let (from, to) = (order[k], order[(k + 1) % 3]);
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let closed = -dy > 0 || (dy == 0 && dx > 0);
            [-dy, dx, dy * from[0] - dx * from[1] + i64::from(closed)]
        });
        let of = |axis: usize, pick: fn(i32, i32) -> i32| {
            facet.corners.iter().map(|corner| corner[axis]).reduce(pick).unwrap_or(0)
        };
        let sign = i128::from(area.signum());
        let wide = |value: i64| i128::from(value);
        let slope = [
            sign * ((z1 - z0) * wide(dy2) - (z2 - z0) * wide(dy1)),
            sign * ((z2 - z0) * wide(dx1) - (z1 - z0) * wide(dx2)),
        ];
        let d = wide(area.abs());
        let gradient = slope.map(|slope| slope as f64 / d as f64);
        let [first, second, third] = facet.colours.map(|colour| colour.map(f64::from));
        let steps = |a: i64, b: i64| {
            [0, 1, 2].map(|k| ((second[k] - first[k]) * a as f64 - (third[k] - first[k]) * b as f64) / area as f64)
        };
        let extent = |axis: usize| f64::from(of(axis, i32::max)) - f64::from(of(axis, i32::min));
        // Two products, two sums, each good to 2^-53 of the largest number on the way; and as much again.
        let reach = gradient[0].abs() * extent(0) + gradient[1].abs() * extent(1) + f64::from(FAR);
        Some(Self {
            edges,
            least: [of(0, i32::min), of(1, i32::min)],
            greatest: [of(0, i32::max), of(1, i32::max)],
            anchor: p0,
            slope,
            d,
            z: z0,
            gradient,
            error: reach * 16.0 * f64::EPSILON,
            colour: [first, steps(dy2, dy1), steps(-dx2, -dx1)],
        })
    }

    fn depth(&self, x: i64, y: i64) -> f64 {
        self.z as f64 + self.gradient[0] * (x - self.anchor[0]) as f64 + self.gradient[1] * (y - self.anchor[1]) as f64
    }

    fn colour(&self, x: i64, y: i64) -> [f64; 3] {
        let [first, across, down] = &self.colour;
        let [dx, dy] = [x - self.anchor[0], y - self.anchor[1]].map(|way| way as f64);
        [0, 1, 2].map(|k| first[k] + across[k] * dx + down[k] * dy)
    }

    fn exact(&self, x: i64, y: i64) -> Fraction {
        let [dx, dy] = [x - self.anchor[0], y - self.anchor[1]].map(i128::from);
        Fraction::new(self.z * self.d + self.slope[0] * dx + self.slope[1] * dy, self.d)
    }

    /// Rows of pixels that it can touch, of `rows`.
    fn rows(&self, rows: u32) -> std::ops::Range<usize> {
        let clip = |row: i32| row.clamp(0, rows as i32) as usize;
        clip(self.least[1].div_euclid(UNITS))..clip(self.greatest[1].div_euclid(UNITS) + 1)
    }
}

/// The exact picture with `grid` columns and rows of samples in a pixel, each a divisor of 2048.
///
/// # Panics
/// When samples would not lie on whole units.
#[must_use]
pub fn truth(scene: &Scene, grid: [u32; 2]) -> Truth {
    assert!(grid.iter().all(|n| (1..=2048).contains(n) && 2048 % n == 0), "samples lie on whole units");
    let planes: Vec<Option<Plane>> = scene.facets.iter().map(Plane::new).collect();
    let [width, height] = scene.size;
    let mut bins = vec![Vec::new(); height as usize];
    for (number, plane) in planes.iter().enumerate() {
        if let Some(plane) = plane {
            bins[plane.rows(height)].iter_mut().for_each(|bin| bin.push(number as u32));
        }
    }
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(height.max(1) as usize);
    let row = |j: usize| Row::new(width, grid, j as i64).seen(&planes, &bins[j]);
    let worker = |first: usize| (first..height as usize).step_by(threads).map(row).collect::<Vec<_>>();
    let parts: Vec<Vec<Row>> = thread::scope(|scope| {
        let handles: Vec<_> = (0..threads).map(|first| scope.spawn(move || worker(first))).collect();
        handles.into_iter().map(|handle| handle.join().unwrap_or_default()).collect()
    });
    let mut all = Truth { size: scene.size, samples: grid[0] * grid[1], sums: vec![], pixels: vec![], winners: vec![] };
    for j in 0..height as usize {
        let row = &parts[j % threads][j / threads];
        all.sums.extend_from_slice(&row.sums);
        all.pixels.extend_from_slice(&row.pixels);
        all.winners.extend_from_slice(&row.winners);
    }
    all
}

/// One row of pixels: its samples while they are decided, then what they come to.
struct Row {
    width: u32,
    grid: [u32; 2],
    j: i64,
    /// Who is seen, row of samples by row.
    held: Vec<u32>,
    depths: Vec<f64>,
    sums: Vec<[f64; 3]>,
    pixels: Vec<Pixel>,
    winners: Vec<u32>,
}

impl Row {
    fn new(width: u32, grid: [u32; 2], j: i64) -> Self {
        let samples = (width * grid[0] * grid[1]) as usize;
        let (sums, pixels, winners) = (vec![[0.0; 3]; width as usize], vec![Pixel::default(); width as usize], vec![]);
        Self {
            width,
            grid,
            j,
            held: vec![NOBODY; samples],
            depths: vec![f64::INFINITY; samples],
            sums,
            pixels,
            winners,
        }
    }

    /// Places of a row of samples and of its first column, and the step along it, 1/4096 pixel.
    fn place(&self, row: u32) -> (i64, i64, i64) {
        let step = [0, 1].map(|axis| i64::from(UNITS) / i64::from(self.grid[axis]));
        (self.j * i64::from(UNITS) + i64::from(row) * step[1] + step[1] / 2, step[0] / 2, step[0])
    }

    /// Calls `visit` with the number, x and y of each sample that a plane covers.
    fn covered(&self, plane: &Plane, mut visit: impl FnMut(usize, i64, i64)) {
        let columns = self.width * self.grid[0];
        for row in 0..self.grid[1] {
            let (y, x0, step) = self.place(row);
            let clip = |column: i64| column.clamp(0, i64::from(columns));
            let first = clip((i64::from(plane.least[0]) - x0).div_euclid(step));
            let last = clip((i64::from(plane.greatest[0]) - x0).div_euclid(step) + 1);
            let mut e = plane.edges.map(|[a, b, c]| a * (x0 + first * step) + b * y + c);
            for column in first..last {
                if e.iter().all(|e| *e > 0) {
                    visit((i64::from(row * columns) + column) as usize, x0 + column * step, y);
                }
                for (e, [a, ..]) in e.iter_mut().zip(&plane.edges) {
                    *e += a * step;
                }
            }
        }
    }

    fn seen(mut self, planes: &[Option<Plane>], bin: &[u32]) -> Self {
        let of = |number: u32| planes.get(number as usize).and_then(Option::as_ref);
        let (mut held, mut depths) = (std::mem::take(&mut self.held), std::mem::take(&mut self.depths));
        for &number in bin {
            let Some(plane) = of(number) else { continue };
            self.covered(plane, |at, x, y| {
                let z = plane.depth(x, y);
                let nearer = match of(held[at]) {
                    // What is not nearer than the far plane is not seen; no scene here comes there.
                    None => true,
                    Some(other) if (z - depths[at]).abs() > plane.error + other.error => z < depths[at],
                    Some(other) => plane.exact(x, y) < other.exact(x, y),
                };
                if nearer {
                    (held[at], depths[at]) = (number, z);
                }
            });
        }
        self.held = held;
        self.crossings(&of, bin);
        self.sum(&of);
        self.held = Vec::new();
        self
    }

    /// Marks pixels where of two triangles each hides the other somewhere.
    fn crossings<'a>(&mut self, of: &impl Fn(u32) -> Option<&'a Plane>, bin: &[u32]) {
        let columns = self.width * self.grid[0];
        // Hidden and who hides it, by pixel, each pair once.
        let mut pairs: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.width as usize];
        for &number in bin {
            let Some(plane) = of(number) else { continue };
            self.covered(plane, |at, _, _| {
                let winner = self.held[at];
                let pixel = &mut pairs[(at as u32 % columns / self.grid[0]) as usize];
                if winner != number && pixel.last() != Some(&[number, winner]) && !pixel.contains(&[number, winner]) {
                    pixel.push([number, winner]);
                }
            });
        }
        for (pixel, pairs) in self.pixels.iter_mut().zip(&pairs) {
            pixel.crossing = pairs.iter().any(|[hidden, winner]| pairs.contains(&[*winner, *hidden]));
        }
    }

    fn sum<'a>(&mut self, of: &impl Fn(u32) -> Option<&'a Plane>) {
        let [columns, rows] = self.grid;
        for i in 0..self.width {
            let place = |column: u32, row: u32| (row * self.width * columns + i * columns + column) as usize;
            let first = self.held[place(0, 0)];
            let mut sum = [0.0; 3];
            let mut edge = false;
            for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
                let seen = self.held[place(column, row)];
                edge |= seen != first;
                let (y, x0, step) = self.place(row);
                let x = x0 + i64::from(i * columns + column) * step;
                let colour = of(seen).map_or([0.0; 3], |plane| plane.colour(x, y));
                sum = [0, 1, 2].map(|k| sum[k] + colour[k]);
            }
            (self.sums[i as usize], self.pixels[i as usize].edge) = (sum, edge);
            self.winners.push(self.held[place(columns / 2, rows / 2)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::Kind;
    use super::*;
    use crate::harness::Random;
    use crate::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw_true};

    #[test]
    fn truth_at_centres_of_snapped_scenes_is_the_oracles() {
        for kind in Kind::ALL {
            let scene = kind.scene([40, 30], &mut Random::new(9)).snapped();
            // The oracle's units are 1/256 pixel; its depths may be any whole numbers.
            let vertex = |facet: &Facet, k: usize| {
                let [x, y] = facet.corners[k].map(|c| c / 16);
                Vertex::at(x, y, facet.depths[k] as u32)
            };
            let primitives: Vec<Primitive> =
                scene.facets.iter().map(|f| Primitive::Triangle([0, 1, 2].map(|k| vertex(f, k)))).collect();
            let expected = draw_true(40, 30, &primitives, DepthFormat { bits: 31, fraction: 0 }, DepthFunction::Less);

            let found = truth(&scene, [1, 1]);

            let winners: Vec<u32> = expected.winner.iter().map(|winner| winner.unwrap_or(NOBODY)).collect();
            assert!(found.winners == winners, "{kind:?}");
        }
    }

    #[test]
    fn truth_of_a_triangle_in_more_than_one_colour_is_the_mean_of_its_places() {
        let unit = |x: i32, y: i32| [x * UNITS, y * UNITS];
        // 10 levels of red a pixel to the right, 5 of blue a pixel down, from (-4, -4); in either order of the corners.
        let [a, b, c] = [(unit(-4, -4), [0, 7, 0]), (unit(16, -4), [200, 7, 0]), (unit(-4, 16), [0, 7, 100])];
        for three in [[a, b, c], [c, b, a]] {
            let facet = Facet { corners: three.map(|v| v.0), depths: [FAR / 2; 3], colours: three.map(|v| v.1) };
            let found = truth(&Scene { size: [2, 3], facets: vec![facet] }, [4, 2]);
            for pixel in 0..6 {
                let expected = [10.0 * (4.5 + f64::from(pixel % 2)), 7.0, 5.0 * (4.5 + f64::from(pixel / 2))];
                let mean = found.mean(pixel as usize);
                // Rounding of f64 alone.
                assert!((0..3).all(|k| (mean[k] - expected[k]).abs() < 1e-9), "{pixel}: {mean:?}, not {expected:?}");
            }
        }
    }

    #[test]
    fn truth_of_two_planes_that_cross_counts_both_and_marks_the_pixel() {
        let (a, b, c) = ([-8192, -8192], [40_960, -8192], [-8192, 40_960]);
        let facet = |depths, colour| Facet { corners: [a, b, c], depths, colours: [colour; 3] };
        // They meet where x = 2 pixels; left of it the first is nearer.
        let facets = vec![facet([0, 12 << 20, 0], [255, 0, 0]), facet([4 << 20, 4 << 20, 4 << 20], [0, 0, 255])];
        let scene = Scene { size: [4, 1], facets };

        let found = truth(&scene, [4, 4]);

        let all = 16.0 * 255.0;
        assert_eq!(found.sums, [[all, 0.0, 0.0], [all, 0.0, 0.0], [0.0, 0.0, all], [0.0, 0.0, all]]);
        assert!(found.pixels.iter().all(|pixel| !pixel.crossing && !pixel.edge), "the line lies between pixels");
        let mut moved = scene;
        moved.facets[1].depths = [(4 << 20) + (1 << 19); 3];
        let found = truth(&moved, [8, 8]);
        assert_eq!(found.pixels.iter().map(|pixel| pixel.crossing).collect::<Vec<_>>(), [false, false, true, false]);
        assert_eq!(found.sums[2], [32.0 * 255.0, 0.0, 32.0 * 255.0]);
    }
}
