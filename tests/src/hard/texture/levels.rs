//! Cases 52 and 53: levels of detail at their ends.

use super::{corner, quad, sheet};
use crate::hard::{Row, Tally};
use crate::harness::{Camera, Look, Options, Pixels, Sampler, Stage, State, Topology};
use crate::oracle::effects::texel::Filter;

/// Case 52.
#[must_use]
pub fn level_weights() -> Row {
    // Levels black and white in turn: what is seen is the weight, whose turning points are the levels.
    const LAST: u32 = 9;
    let colours: Vec<u32> = (0..=LAST).map(|k| if k % 2 == 0 { 0xFF00_0000 } else { u32::MAX }).collect();
    let (sampler, words) = Sampler::plain_levels([512, 512], &colours);
    let sampler = Sampler { filter: Filter::Trilinear, repeat: [true; 2], ..sampler };
    let options = Options { pixels: Pixels::Argb8888, ..Options::default() };
    let mut stage = Stage::new([8, 8], &options, &words);
    let (mut tally, mut steps) = (Tally::default(), 0);
    for k in 1..LAST {
        // From 2^-6 below a level to 2^-6 above it in steps of 2^-11; 2^-9 is half a step of the card's.
        let weights: Vec<(i32, u32)> = (-32..=32)
            .map(|step| {
                let texels = 2.0_f64.powf(f64::from(k) + f64::from(step) / 2048.0);
                let mut corners = sheet([8, 8], 0.5, u32::MAX);
                corners
                    .iter_mut()
                    .for_each(|c| c.coordinates = [(f64::from(c.position[0]) * texels / 512.0) as f32, 0.5]);
                let look = Look { mip_map: true, ..Look::textured(sampler) };
                stage.clear([0; 4]);
                stage.triangles(&corners, &State::looking(look));
                let (picture, found, _) = stage.end();
                tally.compared(&found, || format!("level {k} and {step} / 2048"));
                let first = picture.colour[0];
                let others = picture.colour.iter().filter(|&&pixel| pixel != first).count();
                tally.note(others, || format!("level {k} and {step} / 2048: {others} pixels unlike the first"));
                // The distance from the level's own colour.
                (step, if k % 2 == 0 { first & 255 } else { 255 - (first & 255) })
            })
            .collect();
        steps += weights.len();
        let (below, above) = (&weights[..=32], &weights[32..]);
        tally.expect(below.is_sorted_by(|a, b| a.1 >= b.1), || format!("below level {k}: {below:?}"));
        tally.expect(above.is_sorted_by(|a, b| a.1 <= b.1), || format!("above level {k}: {above:?}"));
        // At the level none of another; 2^-9 beside it at most 1/256 of another, a level of 255 with its rounding.
        let near = weights.iter().filter(|(step, _)| step.abs() <= 4);
        tally.expect(near.clone().all(|(_, off)| *off <= 1), || format!("at level {k}: {near:?}"));
        tally.expect(weights[32].1 == 0, || format!("level {k} itself: {}", weights[32].1));
    }
    Row {
        case: 52,
        name: "texture::level_weights",
        construction: "a trilinear texture of 10 levels, black and white in turn; the level of detail goes from k - 2^-6 to k + 2^-6 \
                       in steps of 2^-11, k = 1 to 8",
        property: "weights monotone on both sides of k, none of another level at k, at most 1/256 of one at k +- 2^-9; within the \
                   tolerance of f64",
        measured: format!("{tally}; {steps} levels of detail"),
        passed: tally.wrong == 0,
    }
}

/// Case 53.
#[must_use]
pub fn quad_across_the_eye() -> Row {
    // Level k has red 20 k; green is always 77: what is read from elsewhere shows.
    const LAST: u32 = 8;
    let colours: Vec<u32> = (0..=LAST).map(|k| 0xFF00_4D00 | (20 * k)).collect();
    let (sampler, words) = Sampler::plain_levels([256, 256], &colours);
    let size = [64, 64];
    let options = Options { pixels: Pixels::Argb8888, ..Options::default() };
    let mut stage = Stage::new(size, &options, &words);
    let (mut tally, mut last, mut drawn) = (Tally::default(), 0, 0);
    for filter in Filter::ALL {
        for (mirror, near) in
            [(false, 0.5), (true, 0.0), (false, -1.0e-30), (true, -3.0), (false, 1.0e-20), (false, -1.0e6)]
        {
            // A floor from `near` in front of the eye (or behind it) to far away, without a near plane to speak of: w is
            // clip z's own, so clipping is at w = 0.
            let floor = |x: f32, z: f32| corner([x * z.abs().max(1.0), 1.0], z, u32::MAX, [x / 4.0, z / 10.0]);
            let corners = quad([floor(-1.0, 1.0e6), floor(1.0, 1.0e6), floor(-1.0, near), floor(1.0, near)]);
            let camera = Camera {
                eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.],
                viewport: [32., 32., 1., 32., 32., 0.],
                ..Camera::default()
            };
            let sampler = Sampler { filter, repeat: [true; 2], mirror: [mirror; 2], ..sampler };
            let look = Look { mip_map: true, ..Look::textured(sampler) };
            stage.screen.clear();
            stage.screen.draw_corners(Topology::Triangles, &corners, &State { camera, ..State::looking(look) });
            let picture = stage.screen.read();
            tally.pictures += 1;
            tally.pixels += picture.colour.len();
            let seen: Vec<u32> = picture.colour.iter().copied().filter(|&pixel| pixel != 0).collect();
            let odd = seen
                .iter()
                .filter(|&&pixel| pixel & 0xFF00_FFFF != 0xFF00_4D00 || (pixel >> 16 & 255) > 20 * LAST)
                .count();
            tally.note(odd + picture.strays, || format!("{filter:?} from {near}: {odd} pixels of no level"));
            tally.expect(!seen.is_empty(), || format!("{filter:?} from {near}: nothing is seen"));
            drawn += seen.len();
            // At the horizon a pixel covers any number of texels.
            last += seen.iter().filter(|&&pixel| (pixel >> 16 & 255) == 20 * LAST).count();
        }
    }
    Row {
        case: 53,
        name: "texture::quad_across_the_eye",
        construction: "a floor of 2 x 10^6 units, 10^5 repetitions, from in front of the eye, from it, and from behind it to the \
                       horizon; 3 filters, 9 levels, plain and mirrored",
        property: "level of detail finite and within the levels: every pixel shows colours of levels; the last at the horizon",
        measured: format!("{tally}; {drawn} pixels drawn, {last} of the last level"),
        passed: tally.wrong == 0 && last > 0 && last < drawn,
    }
}
