//! How often planes that nearly coincide are seen in the wrong order.
//!
//! Pairs of triangles over one pixel of a strip 16384 pixels wide; corners uniform within 8192 pixels of it along both
//! axes, depths uniform in the middle 80 % of the range, the second triangle moved so that the depths at the pixel differ
//! by a uniform +-1e-4 of the range.

use super::card;
use crate::harness::depth::survivor;
use crate::harness::{Events, Options, Random, Screen, State};
use crate::oracle::depth::TrueDepth;
use crate::oracle::raster::covers;
use crate::oracle::{DepthFormat, Primitive, Vertex};

/// Pixels of a row, and rows.
const STRIP: [u32; 2] = [16_384, 8];

/// What was found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Pairs.
    pub samples: u64,
    /// Pairs of which the farther is seen.
    pub wrong: u64,
    /// Counters of all pairs together.
    pub events: Events,
    /// Host time of all pairs, nanoseconds.
    pub nanoseconds: f64,
}

impl Found {
    /// Share of wrong ones, percent.
    #[must_use]
    pub fn rate(&self) -> f64 {
        100.0 * self.wrong as f64 / self.samples.max(1) as f64
    }
}

/// A triangle over the pixel, and its exact depth there in steps.
fn over(random: &mut Random, pixel: [i32; 2], format: DepthFormat, z: impl Fn(&mut Random) -> u32) -> (Primitive, f64) {
    loop {
        let corner = |random: &mut Random| {
            let [x, y] = pixel.map(|c| c * 256 + random.int(-8192 * 256, 8192 * 256));
            Vertex::at(x, y, survivor(z(random), format.bits))
        };
        let triangle = Primitive::Triangle([corner(random), corner(random), corner(random)]);
        if covers(&triangle, pixel[0], pixel[1])
            && let Some(depth) = TrueDepth::new(&triangle)
        {
            let exact = depth.at(pixel[0], pixel[1]);
            return (triangle, exact.numerator() as f64 / exact.denominator() as f64);
        }
    }
}

/// Two triangles over the pixel whose depths there nearly agree.
fn pair(random: &mut Random, pixel: [i32; 2], format: DepthFormat) -> [Primitive; 2] {
    let range = f64::from(format.greatest());
    let middle = |random: &mut Random| random.between(0.1 * range, 0.9 * range) as u32;
    loop {
        let (first, depth) = over(random, pixel, format, middle);
        let (second, other) = over(random, pixel, format, middle);
        let shift = depth - other + random.between(-1e-4, 1e-4) * range;
        let Primitive::Triangle(corners) = second else { continue };
        let moved = corners.map(|v| f64::from(v.z) + shift);
        if moved.iter().all(|&z| (0.0..range).contains(&z)) {
            let z = moved.map(|z| survivor(z as u32, format.bits));
            return [first, Primitive::Triangle([0, 1, 2].map(|k| Vertex { z: z[k], ..corners[k] }))];
        }
    }
}

/// At most as many pairs as the strip is wide, 6 pixels apart, are drawn to one frame.
const FRAME: u64 = STRIP[0] as u64 / 6;

/// A format's wrong pairs of `samples`.
#[must_use]
pub fn of_card(format: DepthFormat, samples: u64, seed: u64) -> Found {
    let mut random = Random::new(seed);
    let [width, height] = STRIP;
    let mut screen = Screen::new(width, height, &Options { depth: format, ..Options::default() });
    let (mut wrong, mut done, mut nanoseconds, mut all) = (0, 0, 0.0, None::<Events>);
    while done < samples {
        let count = FRAME.min(samples - done);
        let mut draws = Vec::new();
        let mut expected = Vec::new();
        for sample in 0..count as i32 {
            let pixel = [sample * 6 + random.int(0, 5), random.int(0, 7)];
            let scene = pair(&mut random, pixel, format);
            let depths = scene.map(|p| TrueDepth::new(&p).map(|d| d.at(pixel[0], pixel[1])));
            let [i, j] = pixel.map(|c| c as u32);
            // Of equal depths the earlier is seen.
            expected.push((i, j, 2 * sample as u32 + u32::from(depths[1] < depths[0])));
            draws.push((scene, State { scissor: Some([i, j, i + 1, j + 1]), ..State::default() }));
        }
        let (time, events) = card::frame(&mut screen, |screen| {
            for (scene, state) in &draws {
                screen.draw_ids(scene, state);
            }
        });
        let winners = screen.read().winners();
        wrong += expected.iter().filter(|(i, j, winner)| winners[(j * width + i) as usize] != Some(*winner)).count();
        nanoseconds += time;
        done += count;
        all = Some(all.map_or(events, |sum| sum.plus(&events)));
    }
    let events = all.unwrap_or_else(|| screen.events());
    Found { samples: done, wrong: wrong as u64, events, nanoseconds }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_card_few_bits_are_often_wrong_and_many_never() {
        let coarse = of_card(DepthFormat { bits: 16, fraction: 0 }, 120, 1);
        let fine = of_card(DepthFormat { bits: 31, fraction: 24 }, 120, 1);

        // A third of 120 is expected; four standard deviations are 20.
        assert!((20..=60).contains(&coarse.wrong), "{} of {}", coarse.wrong, coarse.samples);
        assert_eq!((fine.wrong, fine.samples), (0, 120));
    }
}
