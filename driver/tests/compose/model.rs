//! What compositions come to, pixel by pixel, with quotients for products.

use super::calls::{Brush, Call, Glyph, HEIGHT, Part, Through, WIDTH};
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_driver::{ListRectangle, Rectangle};

/// An image of `WIDTH` x `HEIGHT` pixels as numbers.
pub type Pixels = Vec<u32>;

/// Alpha, red, green, blue.
type Argb = [u32; 4];

fn read_pixel(format: PictureFormat, pixel: u32) -> Argb {
    let field = |place: u32, bits: u32| {
        let value = pixel >> place & ((1 << bits) - 1);
        // The bits again and again, from the top.
        (0..8).fold(0, |word, place| word << 1 | value >> (bits - 1 - place % bits) & 1)
    };
    match format.name() {
        "argb8888" => [field(24, 8), field(16, 8), field(8, 8), field(0, 8)],
        "xrgb8888" => [255, field(16, 8), field(8, 8), field(0, 8)],
        "abgr8888" => [field(24, 8), field(0, 8), field(8, 8), field(16, 8)],
        "xbgr8888" => [255, field(0, 8), field(8, 8), field(16, 8)],
        "rgb565" => [255, field(11, 5), field(5, 6), field(0, 5)],
        "alpha8" => [field(0, 8), 0, 0, 0],
        name => panic!("the model does not know {name}"),
    }
}

fn write_pixel(format: PictureFormat, [a, r, g, b]: Argb) -> u32 {
    match format.name() {
        "argb8888" => a << 24 | r << 16 | g << 8 | b,
        "xrgb8888" => 0xFF00_0000 | r << 16 | g << 8 | b,
        "abgr8888" => a << 24 | b << 16 | g << 8 | r,
        "xbgr8888" => 0xFF00_0000 | b << 16 | g << 8 | r,
        "rgb565" => r >> 3 << 11 | g >> 2 << 5 | b >> 3,
        "alpha8" => a,
        name => panic!("the model does not know {name}"),
    }
}

/// a b / 255 to the nearest; nothing lies half way, since 255 is odd.
fn times(a: u32, b: u32) -> u32 {
    (2 * a * b + 255) / 510
}

/// Factors of source and destination, from the alphas of destination and source.
fn factors(operator: ComposeOperator, d: u32, s: u32) -> [u32; 2] {
    match operator.name() {
        "clear" => [0, 0],
        "source" => [255, 0],
        "destination" => [0, 255],
        "over" => [255, 255 - s],
        "over-reverse" => [255 - d, 255],
        "in" => [d, 0],
        "in-reverse" => [0, s],
        "out" => [255 - d, 0],
        "out-reverse" => [0, 255 - s],
        "atop" => [d, 255 - s],
        "atop-reverse" => [255 - d, s],
        "xor" => [255 - d, 255 - s],
        "add" => [255, 255],
        name => panic!("the model does not know {name}"),
    }
}

impl Part {
    /// First column and row, width and height.
    fn place(&self) -> [i64; 4] {
        let Rectangle { x, y, right, bottom } =
            self.part.unwrap_or(Rectangle { x: 0, y: 0, right: WIDTH, bottom: HEIGHT });
        [x, y, right - x, bottom - y].map(i64::from)
    }
}

/// Where in a row of `size` a place is found.
fn found(repeat: Repeat, place: i64, size: i64) -> Option<i64> {
    let (turn, rest) = (place.div_euclid(size), place.rem_euclid(size));
    match repeat.name() {
        "none" => (turn == 0).then_some(rest),
        "normal" => Some(rest),
        "pad" => Some(place.max(0).min(size - 1)),
        "reflect" => Some(if turn % 2 == 0 { rest } else { size - 1 - rest }),
        name => panic!("the model does not know {name}"),
    }
}

impl Brush {
    fn at(&self, image: &Pixels, x: i64, y: i64) -> Argb {
        match self {
            Brush::Colour(argb) => read_pixel(PictureFormat::Argb8888, *argb),
            Brush::Image { part, offset, repeat, transform } => {
                let (i, j) = (x + i64::from(offset[0]), y + i64::from(offset[1]));
                let (i, j) = match transform.map(|numbers| numbers.map(i128::from)) {
                    None => (i, j),
                    Some([xx, xy, x0, yx, yy, y0]) => {
                        // Twice the place of the pixel's centre, halved and rounded up where it is half way.
                        let nearest = |a: i128, b: i128, c: i128| {
                            let twice = a * i128::from(2 * i + 1) + b * i128::from(2 * j + 1);
                            ((twice + 1).div_euclid(2) + c - 1).div_euclid(1 << 16) as i64
                        };
                        (nearest(xx, xy, x0), nearest(yx, yy, y0))
                    }
                };
                let [left, top, width, height] = part.place();
                match (found(*repeat, i, width), found(*repeat, j, height)) {
                    (Some(column), Some(row)) => {
                        let at = (top + row) * i64::from(WIDTH) + left + column;
                        read_pixel(part.format, image[at as usize])
                    }
                    _ => [0; 4],
                }
            }
        }
    }
}

impl Glyph {
    fn at(&self, format: PictureFormat, rows: &[u8], column: i64, row: i64) -> Argb {
        let bytes = format.bytes() as usize;
        let at = row as usize * self.stride(format) + column as usize * bytes;
        let pixel = rows[at..at + bytes].iter().rev().fold(0, |pixel, &byte| pixel << 8 | u32::from(byte));
        read_pixel(format, pixel)
    }
}

impl Call {
    /// What becomes of the destination.
    pub fn model(&self, onto: &mut Pixels, source: &Pixels, mask: &Pixels) {
        match &self.through {
            Through::Nothing(list) => {
                for rectangle in list {
                    self.entry(onto, source, rectangle, None, |_, _| [255; 4]);
                }
            }
            Through::Paint { components, brush, list } => {
                for rectangle in list {
                    self.entry(onto, source, rectangle, Some(*components), |x, y| brush.at(mask, x, y));
                }
            }
            Through::Glyphs { components, format, glyphs } => {
                for glyph in glyphs {
                    let ([x, y], [width, height]) = (glyph.place, glyph.size);
                    let rows = glyph.rows(*format);
                    let [left, top] = [0, 1].map(|k| i64::from(glyph.place[k]) + i64::from(self.origin[k]));
                    let rectangle = ListRectangle { x, y, width, height };
                    self.entry(onto, source, &rectangle, Some(*components), |x, y| {
                        glyph.at(*format, &rows, x - left, y - top)
                    });
                }
            }
        }
    }

    fn entry(
        &self,
        onto: &mut Pixels,
        source: &Pixels,
        entry: &ListRectangle,
        components: Option<bool>,
        mask: impl Fn(i64, i64) -> Argb,
    ) {
        let [left, top, width, height] = self.onto.place();
        let [x, y] = [i64::from(entry.x) + i64::from(self.origin[0]), i64::from(entry.y) + i64::from(self.origin[1])];
        for clip in &self.clips {
            let columns = [x, clip.x1.into(), 0].into_iter().max().unwrap()
                ..[x + i64::from(entry.width), clip.x2.into(), width].into_iter().min().unwrap();
            let rows = [y, clip.y1.into(), 0].into_iter().max().unwrap()
                ..[y + i64::from(entry.height), clip.y2.into(), height].into_iter().min().unwrap();
            for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
                let pixel = &mut onto[((top + y) * i64::from(WIDTH) + left + x) as usize];
                let there = read_pixel(self.onto.format, *pixel);
                let result = self.mixed(self.source.at(source, x, y), components.map(|by| (by, mask(x, y))), there);
                if self.operator.name() != "destination" {
                    *pixel = write_pixel(self.onto.format, result);
                }
            }
        }
    }

    fn mixed(&self, source: Argb, mask: Option<(bool, Argb)>, there: Argb) -> Argb {
        [0, 1, 2, 3].map(|channel| {
            let of = match mask {
                None => 255,
                Some((true, mask)) => mask[channel],
                Some((false, mask)) => mask[0],
            };
            let (level, alpha) = (times(source[channel], of), times(source[0], of));
            let [f, g] = factors(self.operator, there[0], alpha);
            (times(level, f) + times(there[channel], g)).min(255)
        })
    }
}
