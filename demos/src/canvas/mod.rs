//! Pictures put together from rectangles, other pictures and captions.
//!
//! Duties: what charts and contact sheets are drawn with; no smoothing, so equal input gives equal bytes on every
//! machine. Inputs from: [`crate::paths`]. Outputs to: [`Picture`].

mod font;

use crate::picture::Picture;
use font::{CELL, GLYPH, descent, glyph};

/// Red, green, blue.
pub(crate) type Ink = [u8; 3];

/// Colours of a heat map from little to much, dark to light, so that they can be told apart without hue as well.
const HEAT: [Ink; 7] =
    [[22, 24, 48], [58, 38, 112], [128, 42, 120], [200, 62, 94], [242, 118, 62], [252, 188, 84], [255, 250, 210]];

/// A picture that is drawn on. What lies outside is left out.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    picture: Picture,
}

impl Canvas {
    /// A picture of one colour.
    pub(crate) fn new([width, height]: [u32; 2], ink: Ink) -> Self {
        let rgb = std::iter::repeat_n(ink, width as usize * height as usize).flatten().collect();
        Self { picture: Picture { width, height, rgb } }
    }

    /// Width and height, pixels.
    pub(crate) const fn size(&self) -> [u32; 2] {
        [self.picture.width, self.picture.height]
    }

    /// The picture, done.
    pub(crate) fn into_picture(self) -> Picture {
        self.picture
    }

    /// Colours one pixel.
    pub(crate) fn set(&mut self, x: u32, y: u32, ink: Ink) {
        self.blend(x, y, ink, 255);
    }

    /// Moves the colour of one pixel toward `ink`: by nothing at `part` 0, all the way at 255.
    pub(crate) fn blend(&mut self, x: u32, y: u32, ink: Ink, part: u8) {
        if x >= self.picture.width || y >= self.picture.height {
            return;
        }
        let place = (y as usize * self.picture.width as usize + x as usize) * 3;
        for (byte, ink) in self.picture.rgb[place..place + 3].iter_mut().zip(ink) {
            let (from, to, part) = (u32::from(*byte), u32::from(ink), u32::from(part));
            *byte = ((from * (255 - part) + to * part + 127) / 255) as u8;
        }
    }

    /// Fills a rectangle.
    pub(crate) fn fill(&mut self, at: [u32; 2], size: [u32; 2], ink: Ink) {
        self.tint(at, size, ink, 255);
    }

    /// Moves the colours of a rectangle toward `ink`, as [`Canvas::blend`].
    pub(crate) fn tint(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], ink: Ink, part: u8) {
        for row in y..(y + height).min(self.picture.height) {
            for column in x..(x + width).min(self.picture.width) {
                self.blend(column, row, ink, part);
            }
        }
    }

    /// The outline of a rectangle, one pixel wide, inside it.
    pub(crate) fn frame(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], ink: Ink) {
        if width == 0 || height == 0 {
            return;
        }
        self.fill([x, y], [width, 1], ink);
        self.fill([x, y + height - 1], [width, 1], ink);
        self.fill([x, y], [1, height], ink);
        self.fill([x + width - 1, y], [1, height], ink);
    }

    /// Writes a line of text from its upper left corner on, each pixel of a letter `scale` pixels wide and high.
    pub(crate) fn text(&mut self, [x, y]: [u32; 2], scale: u32, ink: Ink, text: &str) {
        for (place, letter) in (0_u32..).zip(text.chars()) {
            for (row, bits) in (0_u32..).zip(glyph(letter).unwrap_or_default()) {
                for column in (0..GLYPH[0]).filter(|column| bits >> (GLYPH[0] - 1 - column) & 1 == 1) {
                    let left = x + scale * (place * CELL[0] + column);
                    self.fill([left, y + scale * (row + descent(letter))], [scale; 2], ink);
                }
            }
        }
    }

    /// Puts a picture with its upper left corner at a place, each of its pixels `times` wide and high.
    pub(crate) fn put(&mut self, [x, y]: [u32; 2], times: u32, picture: &Picture) {
        for row in 0..picture.height {
            for column in 0..picture.width {
                if let Some(ink) = picture.at(column, row) {
                    self.fill([x + times * column, y + times * row], [times; 2], ink);
                }
            }
        }
    }
}

/// Width and height of a line of text, pixels.
pub(crate) fn text_size(scale: u32, text: &str) -> [u32; 2] {
    [scale * CELL[0] * text.chars().count() as u32, scale * CELL[1]]
}

/// The colour of a heat map for a part 0..=1 of the most.
pub(crate) fn heat(part: f64) -> Ink {
    let place = part.clamp(0.0, 1.0) * (HEAT.len() - 1) as f64;
    let first = (place as usize).min(HEAT.len() - 2);
    let t = place - first as f64;
    std::array::from_fn(|channel| {
        let [from, to] = [HEAT[first], HEAT[first + 1]].map(|ink| f64::from(ink[channel]));
        (from + (to - from) * t).round() as u8
    })
}

/// The picture at a whole part of its size, by means of squares of pixels, so that it fits into `most`; as it is if it
/// fits already.
pub(crate) fn shrunk(picture: &Picture, most: [u32; 2]) -> Picture {
    let step = picture.width.div_ceil(most[0].max(1)).max(picture.height.div_ceil(most[1].max(1))).max(1);
    if step == 1 {
        return picture.clone();
    }
    let [width, height] = [picture.width.div_ceil(step), picture.height.div_ceil(step)];
    let mut rgb = Vec::with_capacity(width as usize * height as usize * 3);
    for y in 0..height {
        for x in 0..width {
            rgb.extend(mean(picture, [x * step, y * step], step));
        }
    }
    Picture { width, height, rgb }
}

/// The mean colour of a square of `side` pixels, of those that the picture has.
fn mean(picture: &Picture, [x, y]: [u32; 2], side: u32) -> Ink {
    let mut sum = [0_u32; 3];
    let mut count = 0;
    for row in y..(y + side).min(picture.height) {
        for column in x..(x + side).min(picture.width) {
            let ink = picture.at(column, row).unwrap_or_default();
            sum.iter_mut().zip(ink).for_each(|(sum, ink)| *sum += u32::from(ink));
            count += 1;
        }
    }
    sum.map(|sum| (sum / count.max(1)) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lit(canvas: Canvas) -> Vec<[u32; 2]> {
        let picture = canvas.into_picture();
        let places = (0..picture.height).flat_map(|y| (0..picture.width).map(move |x| [x, y]));
        places.filter(|[x, y]| picture.at(*x, *y) == Some([255; 3])).collect()
    }

    #[test]
    fn fill_beyond_the_edge_is_cut_off() {
        let mut canvas = Canvas::new([3, 2], [0; 3]);
        canvas.fill([2, 1], [5, 5], [255; 3]);
        assert_eq!(lit(canvas), [[2, 1]]);
    }

    #[test]
    fn text_of_a_point_sets_its_four_pixels() {
        let mut canvas = Canvas::new([12, 10], [0; 3]);
        canvas.text([6, 0], 1, [255; 3], ".");
        assert_eq!(lit(canvas), [[7, 5], [8, 5], [7, 6], [8, 6]]);
        assert_eq!(text_size(2, "ab"), [24, 20]);
    }

    #[test]
    fn blend_goes_part_of_the_way() {
        let mut canvas = Canvas::new([1, 1], [0, 100, 200]);
        canvas.blend(0, 0, [255, 100, 0], 51);
        assert_eq!(canvas.into_picture().at(0, 0), Some([51, 100, 160]));
    }

    #[test]
    fn heat_grows_lighter_all_the_way() {
        let light = |ink: Ink| ink.iter().map(|channel| u32::from(*channel)).sum::<u32>();
        let steps: Vec<u32> = (0..=60).map(|part| light(heat(f64::from(part) / 60.0))).collect();
        assert!(steps.is_sorted_by(|a, b| a < b), "{steps:?}");
    }

    #[test]
    fn shrunk_takes_means_and_keeps_what_fits() {
        let picture = Picture { width: 3, height: 1, rgb: vec![0, 0, 0, 100, 50, 0, 9, 9, 9] };
        assert_eq!(shrunk(&picture, [3, 1]), picture);
        assert_eq!(shrunk(&picture, [2, 1]), Picture { width: 2, height: 1, rgb: vec![50, 25, 0, 9, 9, 9] });
    }
}
