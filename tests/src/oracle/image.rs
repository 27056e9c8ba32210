//! The picture that the card must show, bit for bit: primitives in submission order, one depth test for each covered
//! pixel with the prescribed stored depths.
//!
//! [`draw_plain`] says it in so many words, pixel by pixel. [`draw`] is the same faster, and tests hold it to that: rows
//! are exact runs ([`super::raster::rows`]), depths are summed along them (in 64 bits where both ends of the run say that
//! these are enough), and bands of rows go to threads (`bands`).
//!
//! Nothing is said about colours here: the winner's index tells whose colour a pixel has ([`super::colour`]).

use super::bands;
use super::depth::{Along, PrescribedDepth};
use super::raster::{Rows, for_each_pixel};
use super::{DepthFormat, DepthFunction, Primitive};
use std::ops::Range;

/// What each pixel holds, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// How depths are stored.
    pub format: DepthFormat,
    /// The stored depths, in steps; `2^n - 1` where nothing passed.
    pub depth: Vec<u32>,
    /// The last primitive that passed the depth test: its position in submission order.
    pub winner: Vec<Option<u32>>,
    /// How many primitives cover the pixel, whatever the depth test said.
    pub layers: Vec<u32>,
    /// How many fragments passed the depth test: writes to the pixel.
    pub writes: Vec<u32>,
    /// Primitives submitted so far.
    pub submitted: u32,
}

impl Image {
    /// A cleared target of `width` x `height` pixels.
    #[must_use]
    pub fn cleared(width: u32, height: u32, format: DepthFormat) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            format,
            depth: vec![format.greatest(); pixels],
            winner: vec![None; pixels],
            layers: vec![0; pixels],
            writes: vec![0; pixels],
            submitted: 0,
        }
    }

    /// Draws more primitives over what is there. Their indices go on from the earlier ones.
    pub fn draw(&mut self, primitives: &[Primitive], function: DepthFunction) {
        let (width, height) = (self.width, self.height);
        let first = self.submitted;
        self.submitted += primitives.len() as u32;
        if width == 0 || height == 0 {
            return;
        }
        let set_up = |primitive| (Rows::new(primitive, width, height), PrescribedDepth::new(primitive, self.format));
        let set_up: Vec<(Rows, Option<PrescribedDepth>)> = primitives.iter().map(set_up).collect();
        let bins = bands::bins(height, set_up.iter().map(|(rows, _)| rows.rows()));
        let pixels = (bands::ROWS * width) as usize;
        let planes = self.depth.chunks_mut(pixels).zip(self.winner.chunks_mut(pixels));
        let counts = self.layers.chunks_mut(pixels).zip(self.writes.chunks_mut(pixels));
        let bands =
            (0..).zip(bins).zip(planes.zip(counts)).map(|((band, bin), ((depth, winner), (layers, writes)))| {
                (Band { top: band * bands::ROWS, width, depth, winner, layers, writes }, bin)
            });
        let work = set_up.iter().map(|(rows, _)| rows.work()).sum();
        bands::each(bands, work, |(mut band, bin)| {
            for index in bin {
                if let (rows, Some(depth)) = &set_up[index as usize] {
                    band.draw(rows, depth, first + index, function);
                }
            }
        });
    }

    fn draw_one_plain(&mut self, primitive: &Primitive, function: DepthFunction) {
        let index = self.submitted;
        self.submitted += 1;
        let Some(depth) = PrescribedDepth::new(primitive, self.format) else {
            return;
        };
        for_each_pixel(primitive, self.width, self.height, |i, j| {
            let pixel = self.position(i, j);
            let new = depth.stored(i as i32, j as i32);
            self.layers[pixel] += 1;
            if function.passes(&new, &self.depth[pixel]) {
                self.depth[pixel] = new;
                self.winner[pixel] = Some(index);
                self.writes[pixel] += 1;
            }
        });
    }

    /// Where pixel `(i, j)` is in the lists.
    #[must_use]
    pub fn position(&self, i: u32, j: u32) -> usize {
        j as usize * self.width as usize + i as usize
    }
}

/// Some rows of an image.
struct Band<'a> {
    top: u32,
    width: u32,
    depth: &'a mut [u32],
    winner: &'a mut [Option<u32>],
    layers: &'a mut [u32],
    writes: &'a mut [u32],
}

impl Band<'_> {
    fn draw(&mut self, rows: &Rows, depth: &PrescribedDepth, index: u32, function: DepthFunction) {
        for row in 0..self.depth.len() as u32 / self.width {
            let j = self.top + row;
            rows.for_each_run(j, |run| {
                let pixels = (row * self.width + run.start) as usize..(row * self.width + run.end) as usize;
                self.run(pixels, &depth.along(run, j), index, function);
            });
        }
    }

    fn run(&mut self, pixels: Range<usize>, depths: &Along, index: u32, function: DepthFunction) {
        self.layers[pixels.clone()].iter_mut().for_each(|layers| *layers += 1);
        let held = self.depth[pixels.clone()].iter_mut().zip(&mut self.winner[pixels.clone()]);
        let held = held.zip(&mut self.writes[pixels]);
        let put = |(((depth, winner), writes), new): (((&mut u32, &mut Option<u32>), &mut u32), u32)| {
            if function.passes(&new, depth) {
                *depth = new;
                *winner = Some(index);
                *writes += 1;
            }
        };
        match depths {
            Along::Narrow(depths) => held.zip(depths.iter()).for_each(put),
            Along::Wide(depths) => held.zip(depths.iter().copied()).for_each(put),
        }
    }
}

/// Draws a scene on a cleared target of `width` x `height` pixels.
#[must_use]
pub fn draw(width: u32, height: u32, primitives: &[Primitive], format: DepthFormat, function: DepthFunction) -> Image {
    let mut image = Image::cleared(width, height, format);
    image.draw(primitives, function);
    image
}

/// [`draw`] by definition: primitive by primitive, pixel by pixel, each depth worked out on its own.
#[must_use]
pub fn draw_plain(
    width: u32,
    height: u32,
    primitives: &[Primitive],
    format: DepthFormat,
    function: DepthFunction,
) -> Image {
    let mut image = Image::cleared(width, height, format);
    primitives.iter().for_each(|primitive| image.draw_one_plain(primitive, function));
    image
}

#[cfg(test)]
mod tests {
    use super::super::Vertex;
    use super::super::raster::covers;
    use super::*;
    use crate::harness::scenes;
    use proptest::prelude::*;

    fn quad(size: i32, z: u32) -> [Primitive; 2] {
        let [a, b, c, d] = [(0, 0), (size, 0), (0, size), (size, size)].map(|(x, y)| Vertex::at(x * 256, y * 256, z));
        [Primitive::Triangle([a, b, c]), Primitive::Triangle([c, b, d])]
    }

    /// 31-bit depths in a few steps, so that ties occur.
    fn scene() -> impl Strategy<Value = Vec<Primitive>> {
        let vertex = (-300i32..2400, -300i32..2400, 0u32..40).prop_map(|(x, y, z)| Vertex::at(x, y, z));
        let primitive = (prop::array::uniform3(vertex), 0u8..6).prop_map(|(v, kind)| match kind {
            0 => Primitive::Point(v[0]),
            1 => Primitive::Line([v[0], v[1]]),
            _ => Primitive::Triangle(v),
        });
        prop::collection::vec(primitive, 0..24)
    }

    #[test]
    fn draw_full_quad_covers_every_pixel_once() {
        let image = draw(16, 16, &quad(16, 7), DepthFormat::default(), DepthFunction::Less);

        assert_eq!(image.layers, [1; 256]);
        assert_eq!(image.depth, [7; 256]);
    }

    #[test]
    fn draw_equal_depths_under_less_keep_the_earlier() {
        let scene = [quad(4, 9), quad(4, 9)].concat();
        let winners = |function| {
            let image = draw(4, 4, &scene, DepthFormat::default(), function);
            [image.winner[0], image.winner[15]]
        };

        assert_eq!(winners(DepthFunction::Less), [Some(0), Some(1)]);
        assert_eq!(winners(DepthFunction::LessEqual), [Some(2), Some(3)]);
        assert_eq!(winners(DepthFunction::Greater), [None, None]);
        assert_eq!(winners(DepthFunction::Always), [Some(2), Some(3)]);
    }

    #[test]
    fn draw_nothing_leaves_the_clear_depth() {
        let image = draw(3, 2, &[], DepthFormat { bits: 16, fraction: 0 }, DepthFunction::Less);

        assert_eq!(image.depth, [0xffff; 6]);
        assert_eq!(image.winner, [None; 6]);
    }

    #[test]
    fn draw_area_zero_keeps_its_number() {
        let line = Primitive::Triangle([(0, 0), (256, 256), (512, 512)].map(|(x, y)| Vertex::at(x, y, 0)));
        let scene = [vec![line], quad(2, 3).to_vec()].concat();

        let image = draw(2, 2, &scene, DepthFormat::default(), DepthFunction::Less);

        // The quad's diagonal passes the centres of (1, 0) and (0, 1): a right edge of its first half.
        assert_eq!(image.winner, [Some(1), Some(2), Some(2), Some(2)]);
    }

    proptest! {
        #[test]
        fn draw_any_scene_equals_pixel_by_pixel(scene in scene(), f in 0u32..4, function in 0usize..8) {
            let (format, function) = (DepthFormat { bits: 24, fraction: f * 8 }, DepthFunction::ALL[function]);

            let image = draw(8, 8, &scene, format, function);

            for pixel in 0..64 {
                let (i, j) = (pixel % 8, pixel / 8);
                let mut held = (format.greatest(), None);
                for (index, primitive) in (0..).zip(&scene).filter(|(_, p)| covers(p, i, j)) {
                    let new = PrescribedDepth::new(primitive, format).unwrap().stored(i, j);
                    held = [held, (new, Some(index))][usize::from(function.passes(&new, &held.0))];
                }
                prop_assert_eq!((image.depth[pixel as usize], image.winner[pixel as usize]), held);
            }
        }

        #[test]
        fn draw_any_scene_equals_the_plain_form(
            pieces in scenes::scene([70, 41], 24, 20), f in 0u32..4, bits in 0usize..3, function in 0usize..8,
        ) {
            let (format, function) = (DepthFormat { bits: [16, 24, 31][bits], fraction: f * 8 }, DepthFunction::ALL[function]);
            // More than one thread's worth of work, with large depths for small formats too.
            let scene: Vec<Primitive> = (0..16).flat_map(|_| scenes::primitives(&pieces)).collect();

            prop_assert_eq!(draw(70, 41, &scene, format, function), draw_plain(70, 41, &scene, format, function));
        }

        #[test]
        fn draw_prepass_then_equal_writes_every_visible_pixel_again(scene in scene()) {
            let permuted: Vec<_> = scene.iter().map(|primitive| match primitive {
                Primitive::Triangle([a, b, c]) => Primitive::Triangle([*c, *a, *b]),
                other => *other,
            }).collect();
            let mut image = draw(8, 8, &scene, DepthFormat::default(), DepthFunction::Less);
            let visible: Vec<bool> = image.winner.iter().map(Option::is_some).collect();
            let (depth, writes) = (image.depth.clone(), image.writes.clone());

            image.draw(&permuted, DepthFunction::Equal);

            let again: Vec<bool> = image.writes.iter().zip(&writes).map(|(now, before)| now > before).collect();
            prop_assert_eq!(again, visible);
            prop_assert_eq!(image.depth, depth);
        }

        #[test]
        fn draw_in_two_pieces_is_the_same(scene in scene(), cut in 0usize..24, function in 0usize..8) {
            let function = DepthFunction::ALL[function];
            let (first, second) = scene.split_at(cut.min(scene.len()));
            let mut image = Image::cleared(8, 8, DepthFormat::default());

            image.draw(first, function);
            image.draw(second, function);

            prop_assert_eq!(image, draw(8, 8, &scene, DepthFormat::default(), function));
        }
    }
}
