//! How often fragments are put in the wrong order inside a pixel, and how many depths are worked out for it.
//!
//! Random scenes in the three ways to order fragments, each compared with the exact picture of the grid's own samples:
//! every sample shows the triangle whose exact plane is nearest there. A pixel is wrong when it differs from the mean of
//! that by more than rounding. Vertices lie on the card's grid and depths have 31 bits with 24 fraction bits, so that
//! neither the snap nor the depth format has a part in it.

use super::card::{self, Setting};
use super::scene::Kind;
use super::truth::{Truth, truth};
use crate::harness::{Grid, Order, Random};

/// Pixels a side.
pub const SIDE: u32 = 96;

/// What a way to order cost and did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Pixels of all scenes.
    pub pixels: u64,
    /// Those that show more than one thing at their samples.
    pub edges: u64,
    /// Of these the wrong ones.
    pub wrong: u64,
    /// Those in which two triangles cut each other.
    pub crossings: u64,
    /// Of these the wrong ones.
    pub wrong_crossings: u64,
    /// Sum over the edge pixels of the distance of the farthest channel, levels.
    pub levels: f64,
    /// Largest such distance.
    pub largest: f64,
    /// `subpixel.depth_evaluations`.
    pub evaluations: u64,
    /// Clocks of all units but the front end.
    pub clocks: u64,
    /// Host time of a scene, nanoseconds: for each repeat the sum over the scenes.
    pub nanoseconds: Vec<f64>,
}

/// Wrong of all, percent.
#[must_use]
pub fn percent(wrong: u64, all: u64) -> f64 {
    100.0 * wrong as f64 / all.max(1) as f64
}

/// A scene with one wrong pixel that is worth looking at.
#[derive(Clone, Debug)]
pub struct Example {
    /// The exact picture.
    pub truth: Truth,
    /// In the three ways, XRGB8888.
    pub pictures: [Vec<u32>; 3],
}

/// The three ways, in the order of [`Order::ALL`], over `scenes` scenes, and the first scene.
#[must_use]
pub fn of_card(
    grid: Grid,
    kind: Kind,
    scenes: usize,
    threads: usize,
    repeats: usize,
    seed: u64,
) -> ([Outcome; 3], Example) {
    let mut random = Random::new(seed);
    let mut outcomes = [Outcome::default(), Outcome::default(), Outcome::default()];
    let mut example = None;
    let settings = Order::ALL.map(|order| Setting { grid, order, ..Setting::best() });
    for _ in 0..scenes.max(1) {
        let scene = kind.scene([SIDE; 2], &mut random).snapped();
        let exact = truth(&scene, grid.size());
        let all = card::drawn(&scene, &settings, threads, repeats);
        for (outcome, drawn) in outcomes.iter_mut().zip(&all) {
            outcome.pixels += drawn.colour.len() as u64;
            for (at, (&shown, pixel)) in drawn.colour.iter().zip(&exact.pixels).enumerate().filter(|(_, p)| p.1.edge) {
                let wrong = u64::from(exact.is_wrong(at, shown));
                outcome.edges += 1;
                outcome.wrong += wrong;
                outcome.crossings += u64::from(pixel.crossing);
                outcome.wrong_crossings += wrong * u64::from(pixel.crossing);
                outcome.levels += exact.distance(at, shown);
                outcome.largest = outcome.largest.max(exact.distance(at, shown));
            }
            outcome.evaluations += drawn.events["subpixel.depth_evaluations"];
            outcome.clocks += drawn.clocks;
            outcome.nanoseconds.resize(repeats, 0.0);
            outcome.nanoseconds.iter_mut().zip(&drawn.nanoseconds).for_each(|(sum, time)| *sum += time);
        }
        let pictures =
            || all.iter().map(|drawn| drawn.colour.clone()).collect::<Vec<_>>().try_into().unwrap_or_default();
        example.get_or_insert_with(|| Example { truth: exact, pictures: pictures() });
    }
    let empty = || Example { truth: truth(&kind.scene([1; 2], &mut random), [1, 1]), pictures: Default::default() };
    (outcomes, example.unwrap_or_else(empty))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_card_exhaustive_is_right_and_centre_is_not_where_planes_cross() {
        let ([centre, search, exhaustive], _) = of_card(Grid::Grid8x8, Kind::Crossing, 1, 1, 1, 2);

        assert_eq!((exhaustive.wrong, exhaustive.wrong_crossings), (0, 0));
        assert!(centre.wrong_crossings * 2 > centre.crossings && centre.crossings > 50, "{centre:?}");
        assert!(search.wrong < centre.wrong / 4, "{search:?}");
        assert!(centre.evaluations < search.evaluations);
    }
}
