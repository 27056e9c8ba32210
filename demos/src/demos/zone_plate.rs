//! A zone plate: rings whose bounds have radii that grow as the square root of their number, so that each has the
//! same area and they get thinner outwards, in the end than a pixel.
//!
//! One sample a pixel takes rings thinner than that for other, thicker ones: false centres beside the true one, which
//! wander as the rings grow. With enough samples the rim is an even grey.

use std::f64::consts::TAU;

use super::palette::{NIGHT, PORCELAIN};
use super::{SIZE, smooth_scene};
use crate::scene::{Colours, Draw, Primitives, Scene};

/// A light and a dark ring further out.
pub(super) const FRAMES: u32 = 60;

/// Centre, on no pixel's centre, and radius, in pixels.
const CENTRE: [f64; 2] = [400.2, 300.3];
const RADIUS: f64 = 285.0;
/// Radius of the first bound: from this radius squared over 2 outwards the rings are thinner than a pixel.
const FIRST: f64 = 17.0;
/// Sides of a ring; all have their corners in the same directions, so that no ring cuts another.
const SIDES: u32 = 144;

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = smooth_scene(SIZE, NIGHT);
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for [inner, outer] in light_rings(2.0 * f64::from(frame) / f64::from(FRAMES)) {
        let first = vertices.len() as u32;
        for side in 0..SIDES {
            let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            let at = |radius: f64| [CENTRE[0] + radius * cosine, CENTRE[1] - radius * sine, 0.5].map(|at| at as f32);
            vertices.extend([at(inner), at(outer)]);
            let [a, b] = [first + 2 * side, first + 2 * ((side + 1) % SIDES)];
            indices.extend([a, a + 1, b + 1]);
            // The innermost ring may be a disc.
            if inner > 0.0 {
                indices.extend([a, b + 1, b]);
            }
        }
    }
    let colours = Colours::One(PORCELAIN);
    scene.draw.push(Draw::Triangles(Primitives { vertices, indices: Some(indices), colours, ..Default::default() }));
    scene
}

/// Inner and outer radius of the light rings, outwards, when they have grown by `phase` rings of 0..2.
fn light_rings(phase: f64) -> Vec<[f64; 2]> {
    let bound = |number: f64| FIRST * number.max(0.0).sqrt();
    let pairs = (-1..).map(|pair| 2.0 * f64::from(pair) + phase);
    let rings = pairs.map(|from| [bound(from), bound(from + 1.0).min(RADIUS)]);
    rings.skip_while(|[_, outer]| *outer <= 0.0).take_while(|[inner, _]| *inner < RADIUS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_rings_have_the_same_area_and_the_outer_ones_are_thinner_than_a_pixel() {
        let rings = light_rings(0.0);
        let area = |ring: &[f64; 2]| ring[1] * ring[1] - ring[0] * ring[0];
        let whole = &rings[..rings.len() - 1];
        assert!(whole.iter().all(|ring| (area(ring) - FIRST * FIRST).abs() < 1e-6));
        let light: f64 = rings.iter().map(area).sum();
        assert!((light / (RADIUS * RADIUS) - 0.5).abs() < 0.005, "{light}");
        let thin = rings.iter().filter(|[inner, outer]| outer - inner < 1.0).count();
        assert!(thin > rings.len() / 2 && thin < rings.len(), "{thin} of {}", rings.len());
    }

    #[test]
    fn light_rings_grow_into_themselves_in_two_steps() {
        let [start, half, late] = [0.0, 1.0, 1.999_999].map(light_rings);
        assert_eq!(half[0], [FIRST, FIRST * 2.0_f64.sqrt()], "dark in the middle");
        assert_eq!(late.len(), start.len());
        for (late, start) in late.iter().flatten().zip(start.iter().flatten()) {
            assert!((late - start).abs() < 1e-3, "{late} {start}");
        }
    }
}
