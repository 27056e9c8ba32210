//! How far depths drift from the exact plane over the widest target.
//!
//! Planes through random depths of the whole range over a strip 16384 pixels wide. A stored depth is a whole number of
//! steps, so it is off by up to 1/2 in any case; the drift is what the largest distance has beyond that.

use super::card::{self, Drawn};
use crate::harness::depth::survivor;
use crate::harness::{Options, Random, Screen, State};
use crate::oracle::depth::TrueDepth;
use crate::oracle::{DepthFormat, Primitive, Vertex};

/// Pixels of a row, and rows.
pub const STRIP: [u32; 2] = [16_384, 4];

/// What was found.
#[derive(Clone, Debug)]
pub struct Drift {
    /// Depths looked at.
    pub samples: u64,
    /// Mean distance from the exact plane, steps.
    pub mean: f64,
    /// Largest distance, steps, less the 1/2 of rounding.
    pub largest: f64,
    /// Clocks and times of a plane; its colours are left out.
    pub drawn: Drawn,
}

/// Two triangles of one plane over the strip: the plane's depths at three corners are random, that at the fourth follows.
fn plane(random: &mut Random, format: DepthFormat) -> Primitive {
    let [width, height] = STRIP.map(|side| side as i32 * 256);
    // A large triangle over all of the strip; its depths use the whole range along it.
    let corners = [(0, -height), (width, random.int(-height, 0)), (random.int(0, width), 4 * height)];
    Primitive::Triangle(corners.map(|(x, y)| Vertex::at(x, y, survivor(random.depth(format.greatest()), format.bits))))
}

/// The drift of each format over `planes` planes, the same for all formats of as many bits.
#[must_use]
pub fn of_card(formats: &[DepthFormat], planes: usize, threads: usize, seed: u64) -> Vec<Drift> {
    formats.iter().map(|format| of_format(*format, planes, threads, seed)).collect()
}

fn of_format(format: DepthFormat, planes: usize, threads: usize, seed: u64) -> Drift {
    let mut random = Random::new(seed);
    let [width, height] = STRIP;
    let mut screen = Screen::new(width, height, &Options { depth: format, threads, ..Options::default() });
    let (mut samples, mut sum, mut largest) = (0_u64, 0.0, 0.0_f64);
    let mut times = Vec::new();
    let mut last = None;
    for _ in 0..planes.max(1) {
        let plane = plane(&mut random, format);
        let (time, events) = card::frame(&mut screen, |screen| screen.draw(&[plane], &State::default()));
        times.push(time);
        last = Some(events);
        let Some(exact) = TrueDepth::new(&plane) else { continue };
        let picture = screen.read();
        let drawn = picture.depth.iter().enumerate().filter(|(_, depth)| **depth != format.greatest());
        for (pixel, depth) in drawn {
            let (i, j) = (pixel as u32 % width, pixel as u32 / width);
            let exact = exact.at(i as i32, j as i32);
            // The difference is exact before it becomes a float.
            let difference = i128::from(*depth) * exact.denominator() - exact.numerator();
            let distance = (difference as f64 / exact.denominator() as f64).abs();
            (samples, sum, largest) = (samples + 1, sum + distance, largest.max(distance));
        }
    }
    times.sort_by(f64::total_cmp);
    let events = last.unwrap_or_else(|| screen.events());
    let drawn = Drawn { colour: Vec::new(), clocks: card::clocks(&events), events, nanoseconds: times };
    Drift { samples, mean: sum / samples.max(1) as f64, largest: (largest - 0.5).max(0.0), drawn }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_card_drift_falls_with_fraction_bits_and_keeps_its_bound() {
        let formats = [0, 8, 16, 24].map(|fraction| DepthFormat { bits: 24, fraction });

        let found = of_card(&formats, 4, 1, 7);

        for (drift, format) in found.iter().zip(formats) {
            // The bound of the depth format: (|i| + |j| + 1) 2^-(F + 1) steps, and what f64 does to the difference.
            let bound = f64::from(STRIP[0] + STRIP[1] + 8) / f64::from(1_u32 << (format.fraction + 1)) + 1e-9;
            assert!(drift.largest <= bound, "{format:?}: {} steps", drift.largest);
            assert!(drift.samples > 50_000);
        }
        assert!(found[0].largest > 100.0 * found[2].largest && found[1].largest > found[3].largest);
    }
}
