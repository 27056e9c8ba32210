//! How often fragments are put in the wrong order inside a pixel, and how many depths are worked out for it.
//!
//! The same scene in the three ways to order fragments; sample by sample is right by definition. A pixel is wrong when it
//! differs from that.

use crate::harness::{Grid, Options, Order, Random, Screen, State, Subpixel};
use crate::oracle::{Primitive, Vertex};

/// Pixels a side.
const SIDE: u32 = 96;

/// Random scenes of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Triangles of a few pixels, deep in one another.
    Soup,
    /// Large planes that cross.
    Crossing,
    /// Two surfaces of many triangles, a little apart, that cross here and there.
    Terrain,
}

impl Kind {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Soup, Self::Crossing, Self::Terrain];

    /// A scene; colours tell primitives apart, but those of a surface are alike.
    #[must_use]
    pub fn scene(self, random: &mut Random) -> Vec<Primitive> {
        match self {
            Self::Soup => (0..1500).map(|_| soup(random)).collect(),
            Self::Crossing => (0..24).map(|_| crossing(random)).collect(),
            Self::Terrain => [0, 1].into_iter().flat_map(|number| terrain(random, number)).collect(),
        }
    }
}

fn colour(random: &mut Random) -> [u8; 4] {
    let [r, g, b, _] = (random.bits() as u32).to_le_bytes();
    [r, g, b, 255]
}

fn soup(random: &mut Random) -> Primitive {
    let place = [0; 2].map(|_: i32| random.int(0, SIDE as i32 * 256));
    let (z, colour) = (random.int(1 << 20, 1 << 23), colour(random));
    Primitive::Triangle([0; 3].map(|_: i32| {
        let [x, y] = place.map(|c| c + random.int(-1500, 1500));
        Vertex::at(x, y, (z + random.int(-1 << 18, 1 << 18)) as u32).coloured(colour)
    }))
}

fn crossing(random: &mut Random) -> Primitive {
    let colour = colour(random);
    let corners = [(-60, -60), (200, -40), (30, 220)];
    Primitive::Triangle(corners.map(|(x, y)| {
        let [x, y] = [x, y].map(|c| c * 256 + random.int(-5000, 5000));
        Vertex::at(x, y, random.int(1 << 20, 1 << 23) as u32).coloured(colour)
    }))
}

/// A height field over the frame, 24 x 24 cells of 4 pixels, corners moved by up to a pixel.
fn terrain(random: &mut Random, number: i32) -> Vec<Primitive> {
    let colour = [[230, 60, 20, 255], [20, 90, 240, 255]][number as usize];
    let vertices: Vec<Vertex> = (0..25 * 25)
        .map(|k| {
            let [x, y] = [k % 25, k / 25].map(|c| c * 1024 + random.int(-256, 256));
            Vertex::at(x, y, ((1 << 22) + random.int(-1 << 16, 1 << 16)) as u32).coloured(colour)
        })
        .collect();
    let cell = |k: usize| {
        let [a, b, c, d] = [k, k + 1, k + 25, k + 26].map(|k| vertices[k]);
        [Primitive::Triangle([a, b, c]), Primitive::Triangle([c, b, d])]
    };
    (0..24 * 25).filter(|k| k % 25 < 24).flat_map(cell).collect()
}

/// What a way to order cost and did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Pixels of the sub-pixel unit.
    pub active: u64,
    /// Those that are not as sample by sample.
    pub wrong: u64,
    /// Sum of the wrong pixels' largest channel errors, levels.
    pub levels: u64,
    /// `subpixel.depth_evaluations`.
    pub evaluations: u64,
    /// `cycles.subpixel`.
    pub clocks: u64,
}

/// The three ways, in the order of [`Order::ALL`], over `scenes` scenes.
#[must_use]
pub fn of_card(grid: Grid, kind: Kind, scenes: usize, seed: u64) -> [Outcome; 3] {
    let mut random = Random::new(seed);
    let mut outcomes = [Outcome::default(); 3];
    let mut screens = Order::ALL.map(|depth| {
        let subpixel = Subpixel { depth, ..Subpixel::on(grid) };
        Screen::new(SIDE, SIDE, &Options { subpixel, ..Options::default() })
    });
    for _ in 0..scenes {
        let scene = kind.scene(&mut random);
        let pictures = screens.each_mut().map(|screen| {
            screen.clear();
            screen.clear_counts();
            screen.draw(&scene, &State::masked());
            (screen.read().colour, screen.events())
        });
        let exact = &pictures[Order::Exhaustive as usize].0;
        for (outcome, (colour, events)) in outcomes.iter_mut().zip(&pictures) {
            let channels = |pixel: u32| pixel.to_be_bytes();
            let far = |(&a, &b): (&u32, &u32)| {
                channels(a).into_iter().zip(channels(b)).map(|(a, b)| u64::from(a.abs_diff(b))).max().unwrap_or(0)
            };
            let distances: Vec<u64> = colour.iter().zip(exact).map(far).filter(|&levels| levels > 0).collect();
            outcome.active += events["subpixel.pixels_active"];
            outcome.wrong += distances.len() as u64;
            outcome.levels += distances.iter().sum::<u64>();
            outcome.evaluations += events["subpixel.depth_evaluations"];
            outcome.clocks += events["cycles.subpixel"];
        }
    }
    outcomes
}
