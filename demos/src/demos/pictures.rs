//! Textures that code makes: tiles, checks, noise, leaves, a view over a lake.
//!
//! Each is made once and shared. Noise is a hash of whole numbers and repeats, so that pictures of it do too.

use std::sync::{Arc, LazyLock};

use glam::DVec2;

use super::palette::{AMBER, COBALT, PORCELAIN, mix};
use crate::canvas::Canvas;
use crate::scene::Colour;
use crate::texture::Picture;

/// A picture that is made at its first use.
pub(super) type Shared = LazyLock<Arc<Picture>>;

fn made(size: [u32; 2], colour: impl Fn(u32, u32) -> Colour) -> Arc<Picture> {
    // Every size here is a constant far below the limits; one texel stands in for none.
    let plain = || Picture::from_fn([1, 1], |_, _| [255; 4]);
    Arc::new(Picture::from_fn(size, colour).or_else(plain).expect("one texel is a picture"))
}

/// Well mixed bits of three numbers.
pub(super) fn hash(x: u32, y: u32, seed: u32) -> u32 {
    let mut bits = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0xC2B2_AE3D);
    for (shift, factor) in [(15, 0x2C1B_3C6D), (12, 0x297A_2D39)] {
        bits = (bits ^ bits >> shift).wrapping_mul(factor);
    }
    bits ^ bits >> 15
}

/// A number 0..1 of three numbers.
pub(super) fn chance(x: u32, y: u32, seed: u32) -> f64 {
    f64::from(hash(x, y, seed)) / 4_294_967_296.0
}

/// Smooth noise 0..1 with a value of its own at each whole place; repeats after `period` places.
pub(super) fn noise(at: DVec2, period: u32, seed: u32) -> f64 {
    let floor = at.floor();
    let part = at - floor;
    let smooth = part * part * (DVec2::splat(3.0) - 2.0 * part);
    let whole = |value: f64| (value.rem_euclid(f64::from(period)) as u32) % period;
    let [x, y] = [whole(floor.x), whole(floor.y)];
    let value = |dx, dy| chance((x + dx) % period, (y + dy) % period, seed);
    let row = |dy| value(0, dy) + (value(1, dy) - value(0, dy)) * smooth.x;
    row(0) + (row(1) - row(0)) * smooth.y
}

/// Sum of `octaves` of noise, each twice as fine and half as strong, 0..1.
pub(super) fn fractal(at: DVec2, period: u32, octaves: u32, seed: u32) -> f64 {
    let (mut sum, mut most, mut weight) = (0.0, 0.0, 1.0);
    for octave in 0..octaves {
        let scale = 1 << octave;
        sum += weight * noise(at * f64::from(scale), period * scale, seed + octave);
        most += weight;
        weight /= 2.0;
    }
    sum / most
}

/// Paving with a name in every light stone: 256 x 256.
pub(super) static TILES: Shared = LazyLock::new(|| {
    const SIDE: u32 = 256;
    const STONE: u32 = 64;
    let [light, dark, joint] = [[238, 232, 218], [44, 74, 132], [24, 30, 48]];
    let mut canvas = Canvas::new([SIDE; 2], joint);
    for row in 0..SIDE / STONE {
        for column in 0..SIDE / STONE {
            let [x, y] = [column * STONE, row * STONE];
            let is_light = (row + column) % 2 == 0;
            canvas.fill([x + 1, y + 1], [STONE - 2; 2], if is_light { light } else { dark });
            if is_light {
                canvas.text([x + 15, y + 16], 2, [178, 58, 48], "ZGA");
                canvas.text([x + 15, y + 38], 1, dark, "1234567");
            } else {
                canvas.frame([x + 14, y + 14], [STONE - 28; 2], [120, 150, 206]);
                canvas.frame([x + 24, y + 24], [STONE - 48; 2], [246, 186, 76]);
            }
        }
    }
    let drawn = canvas.into_picture();
    made([SIDE; 2], |x, y| {
        let [r, g, b] = drawn.at(x, y).unwrap_or_default();
        [r, g, b, 255]
    })
});

/// Two light shades, eight by eight squares: 64 x 64.
pub(super) static CHECKS: Shared = LazyLock::new(|| {
    made([64; 2], |x, y| if (x / 8 + y / 8) % 2 == 0 { [236, 232, 224, 255] } else { [150, 156, 172, 255] })
});

/// Strong checks with a mark in each square, eight by eight texels a square, for balls and blocks: 32 x 32.
pub(super) static PATCHES: Shared = LazyLock::new(|| {
    made([32; 2], |x, y| {
        let colour = if (x / 8 + y / 8) % 2 == 0 { PORCELAIN } else { COBALT };
        let middle = (2..6).contains(&(x % 8)) && (2..6).contains(&(y % 8));
        if middle { AMBER } else { colour }
    })
});

/// A lattice with round holes: 32 x 32, four by four holes.
pub(super) static LATTICE: Shared = LazyLock::new(|| {
    made([32; 2], |x, y| {
        let from = |a: u32| i64::from(2 * (a % 8)) - 7;
        let hole = from(x).pow(2) + from(y).pow(2) < 28;
        let [r, g, b, _] = PORCELAIN;
        [r, g, b, if hole { 0 } else { 255 }]
    })
});

/// Grain that shades what it is on by a few levels: 128 x 128.
pub(super) static GRAIN: Shared = LazyLock::new(|| {
    made([128; 2], |x, y| {
        let value = fractal(DVec2::new(f64::from(x), f64::from(y)) / 8.0, 16, 3, 11);
        let level = (176.0 + 79.0 * value) as u8;
        [level, level, level, 255]
    })
});

/// Grass from above: 128 x 128.
pub(super) static MEADOW: Shared = LazyLock::new(|| {
    made([128; 2], |x, y| {
        let at = DVec2::new(f64::from(x), f64::from(y)) / 16.0;
        let (coarse, fine) = (fractal(at, 8, 3, 3), chance(x, y, 77));
        let colour = mix([54, 84, 38, 255], [140, 152, 70, 255], 1.3 * coarse - 0.2);
        mix(colour, [30, 44, 26, 255], 0.35 * fine)
    })
});

/// A spray of leaves, with holes between them: 128 x 128.
pub(super) static LEAVES: Shared = LazyLock::new(|| {
    const LEAVES: u32 = 88;
    let all: Vec<Leaf> = (0..LEAVES).map(Leaf::of_spray).collect();
    made([128; 2], |x, y| {
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        // Later leaves lie on earlier ones. What shows nowhere has the leaves' colour too, so that no rim is dark.
        all.iter().rev().find_map(|leaf| leaf.colour(at)).unwrap_or([78, 116, 48, 0])
    })
});

/// Blades of grass that stand up: 64 x 64.
pub(super) static BLADES: Shared = LazyLock::new(|| {
    const BLADES: u32 = 26;
    made([64; 2], |x, y| {
        let at = DVec2::new(f64::from(x) + 0.5, 64.0 - f64::from(y) - 0.5);
        let blade = |number: u32| {
            let root = 10.0 + 44.0 * chance(number, 0, 5);
            let (lean, height) = (28.0 * chance(number, 1, 5) - 14.0, 30.0 + 32.0 * chance(number, 2, 5));
            let part = at.y / height;
            let middle = root + lean * part * part;
            let half = 2.4 * (1.0 - part * part);
            let shade = mix([64, 100, 40, 255], [150, 176, 84, 255], 0.6 * chance(number, 3, 5) + 0.4 * part);
            (part < 1.0 && (at.x - middle).abs() < half).then_some(shade)
        };
        (0..BLADES).rev().find_map(blade).unwrap_or([96, 132, 58, 0])
    })
});

/// A pointed leaf.
struct Leaf {
    middle: DVec2,
    /// Half its length, along it.
    axis: DVec2,
    shade: f64,
}

impl Leaf {
    /// Leaf `number` of a spray in the middle of 128 x 128 texels.
    fn of_spray(number: u32) -> Self {
        let random = |use_: u32| 2.0 * chance(number, use_, 9) - 1.0;
        let spread = DVec2::new(random(0) + random(1), random(2) + random(3)) * 0.5;
        let direction = DVec2::new(random(4), random(5)).normalize_or(DVec2::X);
        Self {
            middle: DVec2::splat(64.0) + spread * 58.0,
            // Mostly outwards, as leaves grow.
            axis: (direction + spread.normalize_or(DVec2::Y)).normalize_or(DVec2::Y) * (9.0 + 3.0 * random(6)),
            shade: chance(number, 7, 9),
        }
    }

    fn colour(&self, at: DVec2) -> Option<Colour> {
        let along = (at - self.middle).dot(self.axis) / self.axis.length_squared();
        let across = (at - self.middle).perp_dot(self.axis) / self.axis.length();
        let half = 0.42 * self.axis.length() * (1.0 - along * along);
        let inside = along.abs() < 1.0 && across.abs() < half;
        let colour = mix([48, 92, 36, 255], [138, 168, 70, 255], self.shade);
        let rib = if across.abs() < 0.7 { 0.35 } else { 0.12 * (across / half + 1.0) };
        inside.then(|| mix(colour, [196, 204, 120, 255], rib))
    }
}

/// Evening over a lake: soft shades everywhere, which few colours cannot give. 240 x 200.
pub(super) static LAKE: Shared = LazyLock::new(|| {
    const SIZE: [u32; 2] = [240, 200];
    const SHORE: f64 = 128.0;
    made(SIZE, |x, y| {
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        if at.y < SHORE {
            return evening(at, SHORE);
        }
        // The lake mirrors what is above it, rippled more the nearer it is.
        let near = (at.y - SHORE) / (f64::from(SIZE[1]) - SHORE);
        let ripple = noise(DVec2::new(at.x / 22.0, at.y / (1.5 + 3.0 * near)), 256, 21) - 0.5;
        let mirrored = DVec2::new(at.x + 5.0 * ripple, SHORE - (at.y - SHORE) * 1.6 - 9.0 * near * ripple);
        mix(evening(mirrored, SHORE), [18, 32, 62, 255], 0.22 + 0.4 * near)
    })
});

/// Sky, sun and hills.
fn evening(at: DVec2, shore: f64) -> Colour {
    let sun = DVec2::new(158.0, 74.0);
    let height = (at.y / shore).clamp(0.0, 1.0);
    let sky = match height {
        0.0..0.55 => mix([44, 60, 128, 255], [206, 112, 124, 255], height / 0.55),
        _ => mix([206, 112, 124, 255], [255, 206, 132, 255], (height - 0.55) / 0.45),
    };
    let distance = at.distance(sun);
    let glow = 1.0 / (1.0 + (distance / 30.0) * (distance / 30.0));
    let mut colour = mix(sky, [255, 236, 184, 255], 0.8 * glow);
    if distance < 13.0 {
        colour = [255, 248, 220, 255];
    }
    // Three ranges, the nearer the darker.
    for (range, (level, rise, tone)) in
        [(96.0, 26.0, [150, 96, 138, 255]), (110.0, 24.0, [92, 70, 118, 255]), (122.0, 22.0, [38, 62, 74, 255])]
            .into_iter()
            .enumerate()
    {
        let seed = 31 + range as u32;
        let ridge = level - rise * (fractal(DVec2::new(at.x / (46.0 - 10.0 * range as f64), 0.5), 64, 4, seed) - 0.3);
        if at.y > ridge {
            colour = mix(tone, mix(tone, [246, 186, 140, 255], 0.45), (at.y - ridge) / 40.0);
        }
    }
    colour
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_repeats_and_is_whole_at_whole_places() {
        for step in 0..200 {
            let at = DVec2::new(0.37 * f64::from(step), 1.9 + 0.11 * f64::from(step));
            let (here, there) = (noise(at, 16, 4), noise(at + DVec2::new(16.0, -32.0), 16, 4));
            // The place itself is rounded when a period is added.
            assert!((here - there).abs() < 1e-9, "{at}");
            assert!((0.0..1.0).contains(&here) && (0.0..1.0).contains(&fractal(at, 16, 4, 4)));
        }
        assert_eq!(noise(DVec2::new(3.0, 5.0), 16, 4), chance(3, 5, 4));
    }

    #[test]
    fn hash_of_neighbours_differs_in_half_of_its_bits() {
        let pairs = (0..64).flat_map(|x| (0..64).map(move |y| (hash(x, y, 1) ^ hash(x + 1, y, 1)).count_ones()));
        let mean = f64::from(pairs.sum::<u32>()) / 4096.0;
        // The mean of 4096 counts of 32 fair bits has a standard deviation of 0.044.
        assert!((mean - 16.0).abs() < 0.25, "{mean}");
    }

    #[test]
    fn pictures_with_holes_have_both_and_the_others_none() {
        for holed in [&LEAVES, &BLADES, &LATTICE] {
            let open = holed.pixels().iter().filter(|texel| texel[3] == 0).count();
            let part = open as f64 / holed.pixels().len() as f64;
            assert!((0.2..0.8).contains(&part), "{part}");
            assert!(holed.pixels().iter().all(|texel| texel[3] == 0 || texel[3] == 255));
        }
        assert!([&TILES, &CHECKS, &PATCHES, &GRAIN, &MEADOW, &LAKE].iter().all(|picture| picture.is_opaque()));
    }

    #[test]
    fn leaves_keep_clear_of_the_border() {
        let border = |at: u32| [[at, 0], [at, 127], [0, at], [127, at]];
        assert!((0..128).flat_map(border).all(|[x, y]| LEAVES.at(x, y)[3] == 0));
    }

    #[test]
    fn lake_has_more_colours_than_any_palette() {
        let colours: std::collections::HashSet<&Colour> = LAKE.pixels().iter().collect();
        assert!(colours.len() > 4096, "{}", colours.len());
    }
}
