//! Case 54: 1/w over a span of 2^20.

use crate::hard::{Row, Tally};
use crate::harness::{Camera, Look, Options, Pixels, Random, Sampler, Stage, State};
use crate::oracle::effects::Corner;
use crate::oracle::effects::texel::Filter;

/// Case 54.
#[must_use]
pub fn widest_span_of_w() -> Row {
    // Two texels, black and white, again and again: bilinear, the level goes up and down by 255 a texel, and tells the
    // coordinate to 1/255 texel.
    let words = [0xFF00_0000, u32::MAX];
    let sampler =
        Sampler { size: [2, 1], filter: Filter::Bilinear, function: 0, repeat: [true; 2], ..Sampler::default() };
    let camera =
        Camera { eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.], ..Camera::default() };
    let options = Options { pixels: Pixels::Argb8888, ..Options::default() };
    let mut stage = Stage::new([256, 64], &options, &words);
    let (mut tally, mut random) = (Tally::default(), Random::new(54));
    let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for number in 0..60 {
        // Object coordinates are x w, y w in pixels, and w. Places on quarters of a pixel: x w is exact.
        let spans = [[1.0, 1_048_576.0, 1.0], [1_048_576.0, 1.0, 1.0], [1.0, 1024.0, 1_048_576.0]];
        let w: [f32; 3] = spans[number % 3];
        let places = [[-8, -30], [264, 20], [-8, 90]]
            .map(|place: [i32; 2]| place.map(|c| (c * 4 + random.int(-20, 20)) as f32 / 4.0));
        // So many texels that the pixels near the near vertex have some, and a screen's width some more.
        let reach = [1.0, 64.0, 4096.0, 65536.0][random.range(0, 3) as usize];
        let corners = [0, 1, 2].map(|k| Corner {
            position: [places[k][0] * w[k], places[k][1] * w[k], w[k]],
            colour: u32::MAX,
            coordinates: [random.between(0.0, reach) as f32, 0.5],
            ..Corner::default()
        });
        stage.clear([0; 4]);
        stage.triangles(&corners, &State { camera, ..State::looking(Look::textured(sampler)) });
        let (picture, found, shades) = stage.end();
        tally.compared(&found, || format!("triangle {number}"));
        for (shade, pixel) in shades.iter().zip(&picture.colour).filter(|(shade, _)| shade.tolerance > 0.0) {
            // Red is 255 a texel, less its own rounding.
            let off = (f64::from(pixel >> 16 & 255) - shade.colour[0]).abs();
            let texels = (off - 0.5).max(0.0) / 255.0;
            (largest, sum, count) = (largest.max(texels), sum + texels, count + 1);
        }
    }
    tally.expect(largest <= 1.0 / 256.0, || format!("off by {largest} texels"));
    Row {
        case: 54,
        name: "texture::widest_span_of_w",
        construction: "60 triangles whose vertices' 1/w span 2^20 over 256 pixels, up to 131072 texels between vertices; a bilinear \
                       ramp of 255 levels a texel",
        property: "texel coordinates within 1/256 of f64",
        measured: format!(
            "{tally}; {count} pixels, off by {largest:.6} texels at most, {:.6} on average",
            sum / f64::from(count.max(1))
        ),
        passed: tally.wrong == 0 && count > 100_000,
    }
}
