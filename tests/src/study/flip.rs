//! FLIP: how different two pictures look when one flips from one to the other in place.
//!
//! Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "FLIP: A Difference Evaluator for
//! Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3 (2), for pictures of low
//! dynamic range. Section numbers below are the paper's.
//!
//! * *Colour pipeline* (4.1): sRGB to linear to YCxCz; each channel through the spatial filter of the eye's contrast
//!   sensitivity; back to linear, held to 0..=1; to L*a*b*, a* and b* scaled by L* (Hunt effect); HyAB distance, raised to
//!   0.7, and mapped so that the distance from green to blue is 1.
//! * *Feature pipeline* (4.2): edges and points of the unfiltered Y by first and second derivatives of a Gaussian.
//! * *Pooling* (4.3): colour difference to the power of 1 - feature difference.
//!
//! Pictures are continued beyond their borders by their border pixels. Arithmetic is f64.

/// Pixels in a degree of sight: a screen 0.7 m wide with 3840 pixels, seen from 0.7 m (5.1).
pub const PIXELS_PER_DEGREE: f64 = 67.020_643_276_582_25;

/// Exponent of the colour difference.
const Q_COLOUR: f64 = 0.7;
/// Where the mapping of colour differences bends, and to what.
const BEND: [f64; 2] = [0.4, 0.95];
/// Exponent of the feature difference.
const Q_FEATURE: f64 = 0.5;
/// Width of features, degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// White of the standard illuminant D65 for colours 0..=1: linear sRGB (1, 1, 1).
const WHITE: [f64; 3] = [0.950_428_545_377_181_5, 1.0, 1.088_900_370_798_128];

type Rgb = [f64; 3];

/// The difference of each pixel, 0 (none) to 1, row by row; pictures as red, green, blue in levels 0..=255. `width` is
/// pixels of a row.
///
/// Empty where the pictures have not as many pixels, or `width` does not divide them.
#[must_use]
pub fn flip(reference: &[Rgb], test: &[Rgb], width: usize, pixels_per_degree: f64) -> Vec<f64> {
    if width == 0 || reference.len() != test.len() || !reference.len().is_multiple_of(width) {
        return Vec::new();
    }
    let [a, b] = [reference, test].map(|picture| Planes::of(picture, width));
    let colours = colour_difference(&a, &b, pixels_per_degree);
    let features = feature_difference(&a, &b, pixels_per_degree);
    colours.into_iter().zip(features).map(|(colour, feature)| colour.powf(1.0 - feature)).collect()
}

/// The mean of the differences (not a number where there are none).
#[must_use]
pub fn mean(differences: &[f64]) -> f64 {
    differences.iter().sum::<f64>() / differences.len() as f64
}

/// A picture as YCxCz, a plane a channel.
struct Planes {
    width: usize,
    channels: [Vec<f64>; 3],
}

impl Planes {
    fn of(picture: &[Rgb], width: usize) -> Self {
        let colours: Vec<Rgb> =
            picture.iter().map(|pixel| ycxcz(xyz(pixel.map(|level| linear(level / 255.0))))).collect();
        Self { width, channels: [0, 1, 2].map(|k| colours.iter().map(|colour| colour[k]).collect()) }
    }

    /// Filters rows, then columns.
    fn filtered(&self, plane: &[f64], rows: &[f64], columns: &[f64]) -> Vec<f64> {
        let (width, height) = (self.width, plane.len() / self.width);
        let convolve = |plane: &[f64], kernel: &[f64], along_x: bool| -> Vec<f64> {
            let reach = (kernel.len() / 2) as isize;
            let held = |at: isize, size: usize| at.clamp(0, size as isize - 1) as usize;
            let mut all = Vec::with_capacity(plane.len());
            for y in 0..height {
                for x in 0..width {
                    let value = |k: usize| {
                        let offset = k as isize - reach;
                        if along_x {
                            plane[y * width + held(x as isize + offset, width)]
                        } else {
                            plane[held(y as isize + offset, height) * width + x]
                        }
                    };
                    all.push(kernel.iter().enumerate().map(|(k, weight)| weight * value(k)).sum());
                }
            }
            all
        };
        convolve(&convolve(plane, rows, true), columns, false)
    }
}

/// sRGB to linear light.
fn linear(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Linear sRGB to CIE XYZ (the matrix of the standard in rationals, as the authors have it).
fn xyz([r, g, b]: Rgb) -> Rgb {
    [
        10_135_552.0 / 24_577_794.0 * r + 8_788_810.0 / 24_577_794.0 * g + 4_435_075.0 / 24_577_794.0 * b,
        2_613_072.0 / 12_288_897.0 * r + 8_788_810.0 / 12_288_897.0 * g + 887_015.0 / 12_288_897.0 * b,
        1_425_312.0 / 73_733_382.0 * r + 8_788_810.0 / 73_733_382.0 * g + 70_074_185.0 / 73_733_382.0 * b,
    ]
}

/// The inverse.
fn linear_rgb([x, y, z]: Rgb) -> Rgb {
    [
        3.241_003_232_976_359 * x - 1.537_398_969_488_786 * y - 0.498_615_881_996_363 * z,
        -0.969_224_252_202_516 * x + 1.875_929_983_695_175 * y + 0.041_554_226_340_085 * z,
        0.055_639_419_851_975 * x - 0.204_011_206_123_909 * y + 1.057_148_977_187_533 * z,
    ]
}

fn ycxcz(xyz: Rgb) -> Rgb {
    let [x, y, z] = [0, 1, 2].map(|k| xyz[k] / WHITE[k]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn of_ycxcz([y, cx, cz]: Rgb) -> Rgb {
    let y = (y + 16.0) / 116.0;
    let white = [y + cx / 500.0, y, y - cz / 200.0];
    [0, 1, 2].map(|k| white[k] * WHITE[k])
}

fn lab(xyz: Rgb) -> Rgb {
    const DELTA: f64 = 6.0 / 29.0;
    let [x, y, z] = [0, 1, 2].map(|k| {
        let t = xyz[k] / WHITE[k];
        if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// L*a*b* with a* and b* weighed by lightness.
fn hunt([l, a, b]: Rgb) -> Rgb {
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// HyAB: city-block in lightness, Euclidean in a* and b*.
fn hyab(a: Rgb, b: Rgb) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Largest colour difference, from green to blue, raised.
fn largest() -> f64 {
    let of = |colour: Rgb| hunt(lab(xyz(colour)));
    hyab(of([0.0, 1.0, 0.0]), of([0.0, 0.0, 1.0])).powf(Q_COLOUR)
}

/// Sums of Gaussians, a1 sqrt(pi / b1) exp(-pi^2 r^2 / b1) + the same of a2 and b2, of each channel; r in degrees.
const SENSITIVITY: [[f64; 4]; 3] = [[1.0, 0.0047, 0.0, 1e-5], [1.0, 0.0053, 0.0, 1e-5], [34.1, 0.04, 13.5, 0.025]];

/// Filters a channel by the eye's sensitivity. A two-dimensional Gaussian is the product of two of one dimension; their
/// sum is not, so each is filtered by itself; together the weights are 1.
fn sensed(planes: &Planes, channel: usize, pixels_per_degree: f64) -> Vec<f64> {
    use std::f64::consts::PI;
    let [a1, b1, a2, b2] = SENSITIVITY[channel];
    // The same reach for all channels: three standard deviations of the widest, sqrt(b / 2) / pi degrees.
    let widest = SENSITIVITY.iter().flat_map(|[_, b1, _, b2]| [*b1, *b2]).fold(0.0, f64::max);
    let reach = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    let kernel = |b: f64| -> Vec<f64> {
        (-reach..=reach).map(|k| (-PI * PI * (f64::from(k) / pixels_per_degree).powi(2) / b).exp()).collect()
    };
    let mut sum = vec![0.0; planes.channels[channel].len()];
    let mut weights = 0.0;
    for (a, b) in [(a1, b1), (a2, b2)].into_iter().filter(|(a, _)| *a > 0.0) {
        let (kernel, height) = (kernel(b), a * (PI / b).sqrt());
        let weight = kernel.iter().sum::<f64>();
        weights += height * weight * weight;
        let part = planes.filtered(&planes.channels[channel], &kernel, &kernel);
        sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += height * part);
    }
    sum.into_iter().map(|value| value / weights).collect()
}

fn colour_difference(a: &Planes, b: &Planes, pixels_per_degree: f64) -> Vec<f64> {
    let seen = |planes: &Planes| -> Vec<Rgb> {
        let channels = [0, 1, 2].map(|channel| sensed(planes, channel, pixels_per_degree));
        let colour = |at: usize| {
            let rgb = linear_rgb(of_ycxcz([0, 1, 2].map(|k| channels[k][at])));
            hunt(lab(xyz(rgb.map(|value| value.clamp(0.0, 1.0)))))
        };
        (0..channels[0].len()).map(colour).collect()
    };
    let [bend, height] = BEND;
    let most = largest();
    let mapped = |difference: f64| {
        if difference < bend * most {
            height / (bend * most) * difference
        } else {
            height + (difference - bend * most) / (most - bend * most) * (1.0 - height)
        }
    };
    seen(a).into_iter().zip(seen(b)).map(|(a, b)| mapped(hyab(a, b).powf(Q_COLOUR))).collect()
}

/// Edges and points: for each the length of the gradient of Y by x and y.
fn features(planes: &Planes, pixels_per_degree: f64) -> [Vec<f64>; 2] {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let reach = (3.0 * deviation).ceil() as i32;
    let places: Vec<f64> = (-reach..=reach).map(f64::from).collect();
    let gauss: Vec<f64> = places.iter().map(|x| (-x * x / (2.0 * deviation * deviation)).exp()).collect();
    let sum: f64 = gauss.iter().sum();
    let smooth: Vec<f64> = gauss.iter().map(|g| g / sum).collect();
    // Positive weights are made 1 together, and negative ones -1.
    let balanced = |weights: Vec<f64>| -> Vec<f64> {
        let part = |sign: f64| weights.iter().map(|w| (w * sign).max(0.0)).sum::<f64>();
        let (positive, negative) = (part(1.0), part(-1.0));
        weights.iter().map(|w| if *w > 0.0 { w / positive } else { w / negative }).collect()
    };
    let edge = balanced(places.iter().zip(&gauss).map(|(x, g)| -x * g).collect());
    let point = balanced(places.iter().zip(&gauss).map(|(x, g)| (x * x / (deviation * deviation) - 1.0) * g).collect());
    // Y as 0..=1.
    let y: Vec<f64> = planes.channels[0].iter().map(|y| (y + 16.0) / 116.0).collect();
    [edge, point].map(|kernel| {
        let along = planes.filtered(&y, &kernel, &smooth);
        let across = planes.filtered(&y, &smooth, &kernel);
        along.into_iter().zip(across).map(|(x, y)| x.hypot(y)).collect()
    })
}

fn feature_difference(a: &Planes, b: &Planes, pixels_per_degree: f64) -> Vec<f64> {
    let ([edges, points], [other_edges, other_points]) =
        (features(a, pixels_per_degree), features(b, pixels_per_degree));
    let difference = |at: usize| {
        let edge = (edges[at] - other_edges[at]).abs();
        let point = (points[at] - other_points[at]).abs();
        (edge.max(point) / std::f64::consts::SQRT_2).powf(Q_FEATURE)
    };
    (0..edges.len()).map(difference).collect()
}

#[cfg(test)]
#[path = "flip_tests.rs"]
mod tests;
