//! Thin things in every direction: a star of wedges that meet in a point, and fans of lines of several widths.
//!
//! Toward the centre of the star the wedges are thinner than a pixel, and only samples tell how much of it they
//! cover; a line keeps its weight whatever way it runs.

use std::f64::consts::TAU;

use super::palette::{MIST, NIGHT, PORCELAIN, hue, mix};
use super::{SIZE, shapes, smooth_scene};
use crate::scene::{Colours, Draw, Primitives, Scene};

/// The star turns by a wedge and the gap beside it, the fans by a line.
pub(super) const FRAMES: u32 = 60;

/// Centre, on no pixel's centre, and radius of the star, in pixels.
const STAR: ([f64; 2], f64) = ([304.4, 300.7], 280.0);
/// Wedges of the star; the gaps are as wide.
const WEDGES: u32 = 120;
/// Widths of the lines, in pixels, a fan each.
const WIDTHS: [f32; 5] = [0.5, 1.0, 1.5, 2.5, 4.0];
/// Lines of a fan.
const LINES: u32 = 28;
/// Where the lines of a fan begin and end, in pixels from its centre.
const FAN: [f64; 2] = [9.0, 53.0];

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = smooth_scene(SIZE, NIGHT);
    let part = f64::from(frame) / f64::from(FRAMES);
    scene.draw.push(Draw::Triangles(star(part)));
    for (place, width) in (0..).zip(WIDTHS) {
        let colour = mix(hue(f64::from(place) / 5.0), PORCELAIN, 0.35);
        scene.draw.push(shapes::wide_lines(fan([698.3, 68.4 + 116.0 * f64::from(place)], part), colour, width));
    }
    scene
}

/// Wedges turned by a part of the step from one to the next; every other one is darker.
fn star(part: f64) -> Primitives {
    let (centre, radius) = STAR;
    let half_step = TAU / f64::from(2 * WEDGES);
    let (mut vertices, mut colours) = (Vec::new(), Vec::new());
    for wedge in 0..WEDGES {
        let from = TAU * (f64::from(wedge) + 2.0 * part) / f64::from(WEDGES);
        vertices.extend([at(centre, 0.0, 0.0), at(centre, radius, from), at(centre, radius, from + half_step)]);
        colours.push(if wedge % 2 == 0 { PORCELAIN } else { MIST });
    }
    Primitives { vertices, colours: Colours::PerFace(colours), ..Default::default() }
}

/// Lines outwards, turned by a part of the step from one to the next.
fn fan(centre: [f64; 2], part: f64) -> Vec<[f32; 3]> {
    let ends = |line: u32| FAN.map(|radius| at(centre, radius, TAU * (f64::from(line) + part) / f64::from(LINES)));
    (0..LINES).flat_map(ends).collect()
}

fn at([x, y]: [f64; 2], radius: f64, angle: f64) -> [f32; 3] {
    let (sine, cosine) = angle.sin_cos();
    [x + radius * cosine, y - radius * sine, 0.5].map(|coordinate| coordinate as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn star_covers_half_of_its_disc_in_every_direction() {
        let star = star(0.25);
        let area = |[a, b, c]: &[[f32; 3]; 3]| {
            let [b, c] = [b, c].map(|corner| [corner[0] - a[0], corner[1] - a[1]].map(f64::from));
            (b[0] * c[1] - b[1] * c[0]).abs() / 2.0
        };
        let wedges = star.vertices.as_chunks::<3>().0;
        let covered: f64 = wedges.iter().map(area).sum();
        let disc = TAU / 2.0 * STAR.1 * STAR.1;
        assert!((covered / disc - 0.5).abs() < 0.001, "{covered} of {disc}");
        let below = wedges.iter().filter(|wedge| f64::from(wedge[1][1]) > STAR.0[1]).count();
        assert_eq!((wedges.len(), below), (WEDGES as usize, WEDGES as usize / 2));
    }

    #[test]
    fn scene_has_a_fan_for_each_width_and_none_meets_another() {
        let scene = scene(0);
        let extents: Vec<f32> = scene
            .draw
            .iter()
            .filter_map(|draw| match draw {
                Draw::Lines(lines) => lines.extent,
                _ => None,
            })
            .collect();
        assert_eq!(extents, WIDTHS);
        let batches = scene.batches();
        let bottom = |batch: usize| batches[batch].positions.iter().map(|at| at[1]).fold(0.0, f32::max);
        let top = |batch: usize| batches[batch].positions.iter().map(|at| at[1]).fold(f32::MAX, f32::min);
        assert!((1..WIDTHS.len()).all(|fan| bottom(fan) + WIDTHS[fan] < top(fan + 1)));
        assert!(bottom(WIDTHS.len()) < SIZE[1] as f32 && top(1) > 0.0);
    }
}
