//! The picture that the card must show, bit for bit: primitives in submission order, one depth test for each covered
//! pixel with the prescribed stored depths.
//!
//! Nothing is said about colours here: the winner's index tells whose colour a pixel has ([`super::colour`]).

use super::depth::PrescribedDepth;
use super::raster::for_each_pixel;
use super::{DepthFormat, DepthFunction, Primitive};

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
        for primitive in primitives {
            self.draw_one(primitive, function);
        }
    }

    fn draw_one(&mut self, primitive: &Primitive, function: DepthFunction) {
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

/// Draws a scene on a cleared target of `width` x `height` pixels.
#[must_use]
pub fn draw(width: u32, height: u32, primitives: &[Primitive], format: DepthFormat, function: DepthFunction) -> Image {
    let mut image = Image::cleared(width, height, format);
    image.draw(primitives, function);
    image
}

#[cfg(test)]
mod tests {
    use super::super::Vertex;
    use super::super::raster::covers;
    use super::*;
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
