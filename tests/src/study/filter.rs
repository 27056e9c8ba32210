//! Texture filters against the texture itself.
//!
//! Triangles in perspective carry a repeated texture: a floor, a wall, random ones, or a mesh. The true colour of a pixel is
//! the mean of the texture over the pixel: of bilinear interpolations of level 0 in f64, at many samples, each carried along
//! its ray to the plane of the triangle that is seen at the pixel's centre. Which that is the card says, drawn with numbers for
//! colours: what is visible is the business of other axes. What the card makes of it differs by the filter's own error; how far
//! it is from the same filter in f64 is told beside it.

use super::card::{clocks, frame};
use crate::harness::look::Sampler;
use crate::harness::{Camera, Events, Look, Options, Pixels, Random, RawVertex, Screen, Stage, State, Topology};
use crate::oracle::effects::Corner;
use crate::oracle::effects::texel::{Filter, Format, level_offset};

/// Texels a side of the texture.
const SIDE: u32 = 64;

/// A filter, with or without the levels of the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// Between texels.
    pub filter: Filter,
    /// Coarser levels are used where they fit.
    pub levels: bool,
}

impl Way {
    /// From the coarsest to the finest.
    pub const ALL: [Self; 5] = [
        Self { filter: Filter::Nearest, levels: false },
        Self { filter: Filter::Nearest, levels: true },
        Self { filter: Filter::Bilinear, levels: false },
        Self { filter: Filter::Bilinear, levels: true },
        Self { filter: Filter::Trilinear, levels: true },
    ];

    /// A name for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match (self.filter, self.levels) {
            (Filter::Nearest, false) => "nearest at level 0",
            (Filter::Nearest, true) => "nearest",
            (Filter::Bilinear, false) => "bilinear at level 0",
            (Filter::Bilinear, true) => "bilinear",
            (Filter::Trilinear, _) => "trilinear",
        }
    }
}

/// What the plane is to the viewer. Eye space: x to the right, y up, looking down -z, 90 degrees wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// A floor below the eye that runs to the far: texels get smaller than pixels.
    Floor,
    /// A wall, turned and near: texels are larger than pixels.
    Wall,
}

impl View {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Floor, Self::Wall];

    /// A corner of the plane, and its two sides.
    const fn plane(self) -> [[f64; 3]; 3] {
        match self {
            Self::Floor => [[-80.0, -1.0, -1.001], [160.0, 0.0, 0.0], [0.0, 0.0, -80.0]],
            Self::Wall => [[-6.0, -9.0, -3.0], [16.0, 4.0, -1.0], [-4.0, 16.0, -1.0]],
        }
    }

    /// How often the texture is repeated along both sides.
    const fn repeat(self) -> [f64; 2] {
        match self {
            Self::Floor => [120.0, 60.0],
            Self::Wall => [1.0, 1.0],
        }
    }

    /// The plane as two triangles, on a picture of `height` rows.
    #[must_use]
    pub fn textured(self, height: u32) -> Textured {
        let [origin, across, down] = self.plane();
        let repeat = self.repeat();
        let corner = |s: f64, t: f64| Corner {
            position: [0, 1, 2].map(|k| (origin[k] + s * across[k] + t * down[k]) as f32),
            colour: u32::MAX,
            normal: [0.0, 0.0, 1.0],
            coordinates: [(s * repeat[0]) as f32, (t * repeat[1]) as f32],
        };
        let corners = [
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(0.0, 1.0),
            corner(0.0, 1.0),
            corner(1.0, 0.0),
            corner(1.0, 1.0),
        ];
        Textured { corners: corners.to_vec(), first_row: self.first_row(height) }
    }

    /// First of the rows of pixels that show nothing but the plane, of `height`.
    const fn first_row(self, height: u32) -> u32 {
        match self {
            Self::Floor => height / 2 + height / 64 + 2,
            Self::Wall => 0,
        }
    }
}

/// What was found of one way.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Which.
    pub way: Way,
    /// The card's picture of the rows looked at, levels.
    pub picture: Vec<[f64; 3]>,
    /// Mean and largest distance of a channel from the same filter in f64, levels, where that has a single answer.
    pub rounding: [f64; 2],
    /// Clocks of all units but the front end.
    pub clocks: u64,
    /// Counters of a frame.
    pub events: Events,
    /// Host times of frames, rising, nanoseconds.
    pub nanoseconds: Vec<f64>,
}

/// All ways on one view.
#[derive(Clone, Debug)]
pub struct Found {
    /// Pixels of a row, and rows looked at.
    pub size: [u32; 2],
    /// Pixels of the whole picture.
    pub pixels: u64,
    /// The true picture, levels.
    pub truth: Vec<[f64; 3]>,
    /// In the order of [`Way::ALL`].
    pub outcomes: Vec<Outcome>,
}

/// Level 0: tiles with fine lines, rings and a little noise, so that there is something of every size.
fn texture(random: &mut Random) -> Vec<[u8; 3]> {
    let texel = |at: u32, noise: i32| {
        let [x, y] = [at % SIDE, at / SIDE].map(|c| c as i32);
        let (tile, line) = ((x / 16 + y / 16) % 2, x % 16 == 0 || y % 16 == 0);
        let ring = ((x - 32).pow(2) + (y - 32).pow(2)) / 40 % 2;
        let base = match (line, tile) {
            (true, _) => [30, 30, 40],
            (_, 0) => [225, 205, 160],
            _ => [50, 100 + 40 * ring, 170],
        };
        base.map(|level: i32| (level + noise).clamp(0, 255) as u8)
    };
    (0..SIDE * SIDE).map(|at| texel(at, random.int(-16, 16))).collect()
}

/// The texture in memory with all levels, each texel the rounded mean of four.
fn words(level_0: &[[u8; 3]]) -> (Sampler, Vec<u32>) {
    let levels = 1 + SIDE.ilog2();
    let sampler = Sampler { size: [SIDE; 2], levels, function: 0, repeat: [true; 2], ..Sampler::default() };
    let mut words = Vec::new();
    let mut level = level_0.to_vec();
    for number in 0..levels {
        words.resize(level_offset(Format::Rgba8888, [SIDE; 2], number) as usize / 4, 0);
        words.extend(level.iter().map(|[r, g, b]| u32::from_le_bytes([*r, *g, *b, 255])));
        let side = (SIDE >> number) as usize;
        let mean = |at: usize| {
            let (x, y) = (2 * (at % (side / 2)), 2 * (at / (side / 2)));
            let four = [
                level[y * side + x],
                level[y * side + x + 1],
                level[(y + 1) * side + x],
                level[(y + 1) * side + x + 1],
            ];
            [0, 1, 2].map(|k| ((four.iter().map(|texel| u32::from(texel[k])).sum::<u32>() + 2) / 4) as u8)
        };
        level = if side > 1 { (0..side * side / 4).map(mean).collect() } else { Vec::new() };
    }
    (sampler, words)
}

/// Where pixels' rays meet the plane of a triangle: texture coordinates, 1 the whole texture.
#[derive(Clone, Copy, Debug)]
struct Rays {
    origin: [f64; 3],
    across: [f64; 3],
    down: [f64; 3],
    normal: [f64; 3],
    /// At the first corner, and the ways from it to the other two.
    coordinates: [[f64; 2]; 3],
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Rays {
    fn new(corners: &[Corner; 3]) -> Self {
        let [origin, b, c] = corners.each_ref().map(|corner| corner.position.map(f64::from));
        let [first, second, third] = corners.each_ref().map(|corner| corner.coordinates.map(f64::from));
        let (across, down) = ([0, 1, 2].map(|k| b[k] - origin[k]), [0, 1, 2].map(|k| c[k] - origin[k]));
        let way = |to: [f64; 2]| [0, 1].map(|k| to[k] - first[k]);
        Self { origin, across, down, normal: cross(across, down), coordinates: [first, way(second), way(third)] }
    }

    /// `None` where a ray does not meet the plane before the eye.
    fn at(&self, pixel: [f64; 2], size: [u32; 2]) -> Option<[f64; 2]> {
        let Self { origin, across, down, normal, coordinates: [first, second, third] } = *self;
        let half = size.map(|side| f64::from(side) / 2.0);
        let ray = [pixel[0] / half[0] - 1.0, 1.0 - pixel[1] / half[1], -1.0];
        let distance = dot(origin, normal) / dot(ray, normal);
        let from = [0, 1, 2].map(|k| ray[k] * distance - origin[k]);
        // Cramer's rule in the plane.
        let length = dot(normal, normal);
        let [s, t] = [dot(cross(from, down), normal) / length, dot(cross(across, from), normal) / length];
        let meets = distance > 0.0 && s.is_finite() && t.is_finite();
        meets.then(|| [0, 1].map(|k| first[k] + s * second[k] + t * third[k]))
    }
}

/// Level 0 between texels, repeated.
fn looked_up(texture: &[[u8; 3]], [u, v]: [f64; 2]) -> [f64; 3] {
    let side = f64::from(SIDE);
    let split = |c: f64| {
        let texel = c * side - 0.5;
        (texel.floor(), texel - texel.floor())
    };
    let ((i, s), (j, t)) = (split(u), split(v));
    let at = |i: f64, j: f64| texture[(j.rem_euclid(side) * side + i.rem_euclid(side)) as usize].map(f64::from);
    let four = [at(i, j), at(i + 1.0, j), at(i, j + 1.0), at(i + 1.0, j + 1.0)];
    [0, 1, 2]
        .map(|k| (four[0][k] * (1.0 - s) + four[1][k] * s) * (1.0 - t) + (four[2][k] * (1.0 - s) + four[3][k] * s) * t)
}

/// The true picture of the rows from the first that is looked at, with `samples` x `samples` samples a pixel; black where
/// nothing is seen. `winners`: the triangle at each pixel.
fn true_picture(
    texture: &[[u8; 3]],
    subject: &Textured,
    winners: &[Option<u32>],
    size: [u32; 2],
    samples: u32,
) -> Vec<[f64; 3]> {
    let rays: Vec<Rays> = subject.corners.as_chunks::<3>().0.iter().map(Rays::new).collect();
    let offset = |k: u32| (f64::from(k) + 0.5) / f64::from(samples);
    let pixel = |i: u32, j: u32| {
        let Some(winner) = winners[(j * size[0] + i) as usize] else { return [0.0; 3] };
        let (mut sum, mut met) = ([0.0; 3], 0.0);
        for (s, t) in (0..samples * samples).map(|k| (offset(k % samples), offset(k / samples))) {
            // A plane seen nearly from its edge can end within the pixel.
            if let Some(place) = rays[winner as usize].at([f64::from(i) + s, f64::from(j) + t], size) {
                let colour = looked_up(texture, place);
                sum = [0, 1, 2].map(|k| sum[k] + colour[k]);
                met += 1.0;
            }
        }
        sum.map(|sum| sum / f64::max(met, 1.0))
    };
    let rows = subject.first_row..size[1];
    let half = rows.start + (rows.end - rows.start) / 2;
    let part = |rows: std::ops::Range<u32>| -> Vec<[f64; 3]> {
        rows.flat_map(|j| (0..size[0]).map(move |i| (i, j))).map(|(i, j)| pixel(i, j)).collect()
    };
    std::thread::scope(|scope| {
        let second = scope.spawn(|| part(half..rows.end));
        let mut all = part(rows.start..half);
        all.extend(second.join().unwrap_or_default());
        all
    })
}

/// Triangles that carry the texture, in eye space between the near plane, 1 before the eye, and 1000.
#[derive(Clone, Debug)]
pub struct Textured {
    /// Three for each triangle; texture coordinates, 1 the whole texture.
    pub corners: Vec<Corner>,
    /// First row of pixels that is looked at.
    pub first_row: u32,
}

impl Textured {
    /// Random triangles from near to far, any way round, one behind another; from 8 pixels a texel to 8 texels a pixel.
    #[must_use]
    pub fn random(size: [u32; 2], random: &mut Random) -> Self {
        let triangles = 60;
        let mut corners = Vec::with_capacity(3 * triangles);
        while corners.len() < 3 * triangles {
            let distance = 2.0 * 12.0_f64.powf(random.unit());
            let [x, y] = [0; 2].map(|_| random.between(-0.95, 0.95) * distance);
            let offset = |random: &mut Random, most: f64| random.between(-most, most) * distance;
            let positions: [[f64; 3]; 3] = std::array::from_fn(|_| {
                [x + offset(random, 0.35), y + offset(random, 0.35), -distance + offset(random, 0.45)]
            });
            let texels_a_pixel = 8.0_f64.powf(random.between(-1.0, 1.0));
            let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
            let begin = [0; 2].map(|_| random.unit());
            let [a, b, c] = positions;
            let sides = [[0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k])];
            let normal = cross(sides[0], sides[1]);
            // Leaning away by less than 84 degrees where it is.
            let facing = dot(normal, a).abs() > 0.1 * (dot(normal, normal) * dot(a, a)).sqrt();
            if !facing || positions.iter().any(|position| position[2] > -1.05) {
                continue;
            }
            // In the triangle's own plane: lengths along its first side and across, so that the texture is not sheared.
            let length = dot(sides[0], sides[0]).sqrt();
            let along = sides[0].map(|part| part / length);
            let across = cross(normal, along).map(|part| part / dot(normal, normal).sqrt());
            let scale = texels_a_pixel * f64::from(size[1]) / (2.0 * distance) / f64::from(SIDE);
            let at = |position: [f64; 3]| {
                let from = [0, 1, 2].map(|k| position[k] - a[k]);
                let [s, t] = [dot(from, along) * scale, dot(from, across) * scale];
                [begin[0] + cos * s - sin * t, begin[1] + sin * s + cos * t]
            };
            corners.extend(positions.map(|position| Corner {
                position: position.map(|part| part as f32),
                colour: u32::MAX,
                normal: [0.0, 0.0, 1.0],
                coordinates: at(position).map(|part| part as f32),
            }));
        }
        Self { corners, first_row: 0 }
    }

    /// The number of the triangle at each pixel.
    fn winners(&self, size: [u32; 2], options: &Options) -> Vec<Option<u32>> {
        let mut screen = Screen::new(size[0], size[1], options);
        let number = |at: usize| options.pixels.colour_of(at as u32 / 3 + 1);
        let vertices: Vec<RawVertex> = self
            .corners
            .iter()
            .enumerate()
            .map(|(at, corner)| RawVertex { position: corner.position, colour: number(at) })
            .collect();
        let state = State { camera: Camera::perspective(size), ..State::default() };
        screen.clear();
        screen.draw_raw(Topology::Triangles, &vertices, None, &state);
        screen.read().winners()
    }
}

/// Every way on one subject.
#[must_use]
pub fn of_card(subject: &Textured, size: [u32; 2], samples: u32, threads: usize, repeats: usize, seed: u64) -> Found {
    let level_0 = texture(&mut Random::new(seed));
    let (sampler, words) = words(&level_0);
    let first = (subject.first_row * size[0]) as usize;
    let corners = &subject.corners;
    let options = Options { pixels: Pixels::Argb8888, threads, ..Options::default() };
    let state = |way: Way| {
        let sampler = Sampler { filter: way.filter, ..sampler };
        let look = Look { mip_map: way.levels, ..Look::textured(sampler) };
        State { camera: Camera::perspective(size), ..State::looking(look) }
    };
    let mut stages = Vec::new();
    let mut outcomes = Vec::new();
    for way in Way::ALL {
        let mut stage = Stage::new(size, &options, &words);
        stage.triangles(corners, &state(way));
        let (picture, comparison, _) = stage.end();
        let levels = |pixel: &u32| {
            let [_, red, green, blue] = pixel.to_be_bytes();
            [red, green, blue].map(f64::from)
        };
        let picture = picture.colour[first..].iter().map(levels).collect();
        let (_, events) =
            frame(&mut stage.screen, |screen| screen.draw_corners(Topology::Triangles, corners, &state(way)));
        let rounding = [comparison.mean, comparison.largest];
        outcomes.push(Outcome { way, picture, rounding, clocks: clocks(&events), events, nanoseconds: Vec::new() });
        stages.push(stage);
    }
    for _ in 0..repeats {
        for (stage, outcome) in stages.iter_mut().zip(&mut outcomes) {
            let state = state(outcome.way);
            let (time, _) =
                frame(&mut stage.screen, |screen| screen.draw_corners(Topology::Triangles, corners, &state));
            outcome.nanoseconds.push(time);
        }
    }
    outcomes.iter_mut().for_each(|outcome| outcome.nanoseconds.sort_by(f64::total_cmp));
    Found {
        size: [size[0], size[1] - subject.first_row],
        pixels: u64::from(size[0]) * u64::from(size[1]),
        truth: true_picture(&level_0, subject, &subject.winners(size, &options), size, samples),
        outcomes,
    }
}

#[cfg(test)]
mod tests {
    use super::super::psnr::psnr;
    use super::*;

    #[test]
    fn of_card_filters_order_as_they_should_and_round_as_stated() {
        for view in View::ALL {
            let found = of_card(&view.textured(64), [96, 64], 12, 1, 1, 1);
            let quality: Vec<f64> = found.outcomes.iter().map(|o| psnr(&found.truth, &o.picture)).collect();
            println!("{view:?}: {quality:?}");
            // What the card rounds is little beside what a filter leaves out: bounds of tests/effects/texture.rs.
            assert!(found.outcomes.iter().all(|o| o.rounding[0] < 1.0 && o.rounding[1] < 5.0), "{view:?}");
            match view {
                View::Floor => assert!(quality[4] > quality[2] + 2.0 && quality[1] > quality[0], "{quality:?}"),
                // Magnified, bilinear is the reference itself but for what a pixel's mean smooths.
                View::Wall => assert!(quality[2] > 30.0 && quality[2] > quality[0] + 5.0, "{quality:?}"),
            }
        }
    }

    #[test]
    fn of_card_on_random_triangles_orders_filters_and_rounds_as_stated() {
        for seed in [1, 2, 3] {
            let subject = Textured::random([160, 120], &mut Random::new(seed));
            let found = of_card(&subject, [160, 120], 12, 1, 1, seed);
            let quality: Vec<f64> = found.outcomes.iter().map(|o| psnr(&found.truth, &o.picture)).collect();
            println!("seed {seed}: {quality:?}");
            assert!(found.truth.iter().filter(|pixel| **pixel != [0.0; 3]).count() > 4000);
            assert!(found.outcomes.iter().all(|o| o.rounding[0] < 1.0 && o.rounding[1] < 5.0), "seed {seed}");
            // Minified and magnified in one picture: levels help, and so does what lies between texels.
            assert!(quality[3] > quality[0] && quality[3] > quality[1] && quality[4] > quality[0], "{quality:?}");
        }
    }

    #[test]
    fn rays_meet_the_corners_at_their_coordinates_and_nothing_behind_the_eye() {
        let subject = View::Wall.textured(64);
        let triangle = &subject.corners.as_chunks::<3>().0[0];
        let rays = Rays::new(triangle);
        for corner in triangle {
            let [x, y, z] = corner.position.map(f64::from);
            let pixel = [48.0 * (1.0 - x / z), 32.0 * (1.0 + y / z)];
            let found = rays.at(pixel, [96, 64]).expect("before the eye");
            assert!((0..2).all(|k| (found[k] - f64::from(corner.coordinates[k])).abs() < 1e-6), "{found:?} {corner:?}");
        }
        // A floor is not met above the horizon, row 32.
        let floor = Rays::new(&View::Floor.textured(64).corners.as_chunks::<3>().0[0]);
        assert!(floor.at([48.0, 33.0], [96, 64]).is_some() && floor.at([48.0, 31.0], [96, 64]).is_none());
    }
}
