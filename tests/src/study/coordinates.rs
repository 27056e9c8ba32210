//! What the snap of coordinates to a grid of 1/16 or 1/256 pixel does: pixels that show another triangle than the unsnapped
//! vertices say.

use super::card::{self, Setting};
use super::scene::Scene;
use super::truth::{NOBODY, truth};
use crate::harness::{Grid, Screen};

/// Bits that the card can snap to.
pub const BITS: [u32; 2] = [4, 8];

/// Largest error of a vertex along an axis, pixels: half a step of the grid.
#[must_use]
pub fn vertex_error(bits: u32) -> f64 {
    0.5 / f64::from(1_u32 << bits)
}

/// Wrong pixels of a setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Pixels that show another triangle at their centres than is exact.
    pub wrong: u64,
    /// Pixels.
    pub pixels: u64,
    /// Position of each wrong pixel, row by row.
    pub places: Vec<usize>,
}

/// Draws a scene with one sample a pixel and compares who is seen at each centre with exact arithmetic on unsnapped
/// vertices.
#[must_use]
pub fn of_card(scene: &Scene, setting: &Setting) -> Found {
    let [width, height] = scene.size;
    let setting = Setting { grid: Grid::Off, ..*setting };
    let mut screen = Screen::new(width, height, &setting.options(1));
    let _ = card::frame(&mut screen, |screen| scene.draw_numbers(screen, &setting.state()));
    let exact = truth(scene, [1, 1]);
    let shown = screen.read().winners();
    let differs = |(at, winner): (usize, &Option<u32>)| (winner.unwrap_or(NOBODY) != exact.winners[at]).then_some(at);
    let places: Vec<usize> = shown.iter().enumerate().filter_map(differs).collect();
    Found { wrong: places.len() as u64, pixels: shown.len() as u64, places }
}

#[cfg(test)]
mod tests {
    use super::super::scene::Kind;
    use super::*;
    use crate::harness::Random;

    #[test]
    fn of_card_snapped_scenes_are_right_and_coarse_grids_are_wrong_oftener() {
        let scene = Kind::Soup.scene([96, 96], &mut Random::new(11));
        let of = |scene: &Scene, bits| of_card(scene, &Setting { coordinate_bits: bits, ..Setting::best() }).wrong;
        let [coarse, fine] = BITS.map(|bits| of(&scene, bits));
        assert!(coarse > 4 * fine && fine > 0, "{coarse} and {fine} pixels");
        // A depth of 31 bits can still tie.
        assert!(of(&scene.clone().snapped(), 8) <= 1);
        assert_eq!(BITS.map(vertex_error), [1.0 / 32.0, 1.0 / 512.0]);
    }
}
