//! The benchmark scenes: fixed, made with integers only, the same on every machine and in every language.
//!
//! Scene k draws from PCG32 with the seed 0x5EED0000 + k and the stream k. All arithmetic is on integers; division
//! truncates toward zero. The check hashes in the tests are those of the definition.

use crate::scene::SubpixelGrid;

/// PCG-XSH-RR 64/32 with the reference seeding.
struct Pcg32 {
    state: u64,
    increment: u64,
}

impl Pcg32 {
    fn new(seed: u64, stream: u64) -> Self {
        let mut generator = Pcg32 { state: 0, increment: (stream << 1) | 1 };
        generator.next();
        generator.state = generator.state.wrapping_add(seed);
        generator.next();
        generator
    }

    fn next(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.increment);
        let word = (((old >> 18) ^ old) >> 27) as u32;
        word.rotate_right((old >> 59) as u32)
    }

    /// A number from 0 up to and without `n`: a 64-bit product, no rejection.
    fn below(&mut self, n: u32) -> i32 {
        ((u64::from(self.next()) * u64::from(n)) >> 32) as i32
    }

    fn colour(&mut self, alpha: u8) -> [u8; 4] {
        let [red, green, blue, _] = self.next().to_le_bytes();
        [red, green, blue, alpha]
    }
}

/// A corner of a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Corner {
    /// Pixels times 256.
    pub x: i32,
    /// Pixels times 256, y down.
    pub y: i32,
    /// Depth times 65536: 0 near, 65536 far.
    pub depth: i32,
    /// Texture coordinate to the right: textures times 2^24.
    pub u: i32,
    /// Texture coordinate downward: textures times 2^24.
    pub v: i32,
    /// Red, green, blue, alpha.
    pub colour: [u8; 4],
}

/// Texels on each side of the texture of S8.
pub const TEXTURE_SIDE: u32 = 256;

/// Level 0 of the texture of S8, RGBA, row by row: squares of 16 texels in which colours run along rows and columns.
#[must_use]
pub fn texture() -> Vec<[u8; 4]> {
    let texel = |at: u32| {
        let (x, y) = (at % TEXTURE_SIDE, at / TEXTURE_SIDE);
        let odd = ((x >> 4) ^ (y >> 4)) & 1 == 1;
        let [x, y] = [x as u8, y as u8];
        [if odd { x } else { 255 - x }, x ^ y, if odd { 255 - y } else { y }, 255]
    };
    (0..TEXTURE_SIDE * TEXTURE_SIDE).map(texel).collect()
}

/// A benchmark scene.
#[derive(Clone, Debug)]
pub struct BenchScene {
    /// Its number, one of [`SCENES`].
    pub number: u32,
    /// Pixels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Lines, else triangles.
    pub lines: bool,
    /// Primitives.
    pub primitives: usize,
    /// Corners of the primitives, in order.
    pub corners: Vec<Corner>,
    /// Nominal pixels: the sum of the triangles' areas, or of the lines' longer sides.
    pub pixels: f64,
}

/// Numbers, names and descriptions of the scenes there are.
pub const SCENES: [(u32, &str, &str); 10] = [
    (1, "clear", "only the clear; its red value changes every frame"),
    (2, "fill far", "64 layers from far to near: every pixel passes"),
    (3, "fill hidden", "64 layers from near to far: all but the first are hidden"),
    (4, "small", "200 000 triangles of about 20 pixels"),
    (5, "medium", "20 000 triangles of about 400 pixels"),
    (6, "slivers", "20 000 triangles, 300 pixels long and 0.75 wide"),
    (7, "lines", "100 000 lines of about 60 pixels"),
    (8, "textured", "2 000 triangles of about 5 000 pixels with a MIP-mapped texture, trilinear: every pixel passes"),
    (9, "translucent", "200 triangles of about 100 000 pixels, one behind the other, a quarter opaque"),
    (10, "smooth", "S5 anti-aliased"),
];

type Triangle = [[i32; 2]; 3];

/// Twice the area, in squared units.
fn cross([a, b, c]: Triangle) -> i64 {
    let part = |p: [i32; 2], axis: usize| i64::from(p[axis]) - i64::from(a[axis]);
    (part(b, 0) * part(c, 1) - part(c, 0) * part(b, 1)).abs()
}

/// A triangle in a box of so many pixels across and down, with an area of `area` pixels.
fn box_triangle(generator: &mut Pcg32, sides: [u32; 2], area: [i64; 2]) -> Triangle {
    loop {
        let mut triangle = Triangle::default();
        for corner in &mut triangle {
            *corner = sides.map(|side| generator.below(side * 256 + 1));
        }
        if (area[0] * 131_072..=area[1] * 131_072).contains(&cross(triangle)) {
            return triangle;
        }
    }
}

/// The ends of a line of `length` pixels in the viewport; for slivers the third corner as well.
fn segment(generator: &mut Pcg32, [width, height]: [i32; 2], length: [i64; 2], sliver: bool) -> Triangle {
    let (right, bottom, most) = (width * 256, height * 256, length[1] as i32 * 256);
    let inside = |x: i32, y: i32| (0..=right).contains(&x) && (0..=bottom).contains(&y);
    loop {
        let (x, y) = (generator.below(right as u32 + 1), generator.below(bottom as u32 + 1));
        let (dx, dy) = (generator.below(2 * most as u32 + 1) - most, generator.below(2 * most as u32 + 1) - most);
        let square = i64::from(dx) * i64::from(dx) + i64::from(dy) * i64::from(dy);
        let third = [x + dx / 2 - dy / 400, y + dy / 2 + dx / 400];
        let fits = (length[0] * length[0] * 65_536..=length[1] * length[1] * 65_536).contains(&square);
        if fits && inside(x + dx, y + dy) && (!sliver || inside(third[0], third[1])) {
            return [[x, y], [x + dx, y + dy], third];
        }
    }
}

/// Puts corners at `places`, at depths near to each other.
fn place(generator: &mut Pcg32, corners: &mut [Corner], places: Triangle) {
    for (corner, [x, y]) in corners.iter_mut().zip(places) {
        (corner.x, corner.y) = (x, y);
    }
    let middle = 1024 + generator.below(62_464);
    for corner in corners {
        corner.depth = middle + generator.below(1025) - 512;
    }
}

impl BenchScene {
    /// Scene `number` for a viewport of this size; `None` for a number that is none of [`SCENES`], or a viewport
    /// too small for its primitives.
    #[must_use]
    pub fn new(number: u32, width: u32, height: u32) -> Option<Self> {
        // S10 is S5, drawn with samples.
        let drawn = if number == 10 { 5 } else { number };
        // The least side that the boxes and segments fit into, with room to spare.
        // The triangles of S9 need their box whole.
        let least = [1, 1, 1, 9, 49, 320, 80, 161, 1].get(drawn.checked_sub(1)? as usize).copied()?;
        let fits = drawn != 9 || (width >= 1024 && height >= 768);
        if !fits || width.min(height) < least || width.max(height) > crate::limits::MAX_TARGET_PIXELS_PER_SIDE {
            return None;
        }
        let primitives = [0, 128, 128, 200_000, 20_000, 20_000, 100_000, 2_000, 200][drawn as usize - 1];
        let lines = drawn == 7;
        let each = if lines { 2 } else { 3 };
        let mut corners = vec![Corner::default(); primitives * each];
        let mut generator = Pcg32::new(0x5EED_0000 + u64::from(drawn), u64::from(drawn));
        let size = [width as i32, height as i32];
        match drawn {
            2 | 3 => layers(&mut generator, &mut corners, size, drawn == 2),
            4 | 5 => {
                let (side, area) = if drawn == 4 { (8, [17, 27]) } else { (48, [300, 500]) };
                for corners in corners.chunks_exact_mut(3) {
                    let left = generator.below((width - side) * 256 + 1);
                    let top = generator.below((height - side) * 256 + 1);
                    let triangle = box_triangle(&mut generator, [side; 2], area);
                    place(&mut generator, corners, triangle.map(|[x, y]| [left + x, top + y]));
                    corners.iter_mut().for_each(|corner| corner.colour = generator.colour(255));
                }
            }
            6 => {
                for corners in corners.chunks_exact_mut(3) {
                    let triangle = segment(&mut generator, size, [290, 310], true);
                    place(&mut generator, corners, triangle);
                    corners.iter_mut().for_each(|corner| corner.colour = generator.colour(255));
                }
            }
            8 => {
                for (number, corners) in (0..).zip(corners.chunks_exact_mut(3)) {
                    textured(&mut generator, corners, size, number);
                }
            }
            9 => {
                for (number, corners) in (0..).zip(corners.chunks_exact_mut(3)) {
                    let left = generator.below((width - 1024) * 256 + 1);
                    let top = generator.below((height - 768) * 256 + 1);
                    let triangle = box_triangle(&mut generator, [1024, 768], [90_000, 110_000]);
                    let colour = generator.colour(64);
                    for (corner, [x, y]) in corners.iter_mut().zip(triangle) {
                        let (x, y, depth) = (left + x, top + y, 65_000 - 300 * number);
                        *corner = Corner { x, y, depth, colour, ..Corner::default() };
                    }
                }
            }
            7 => {
                for corners in corners.chunks_exact_mut(2) {
                    let ends = segment(&mut generator, size, [55, 65], false);
                    place(&mut generator, corners, ends);
                    let colour = generator.colour(255);
                    corners.iter_mut().for_each(|corner| corner.colour = colour);
                }
            }
            _ => {}
        }
        let pixels = match drawn {
            1 => f64::from(width) * f64::from(height),
            7 => corners.chunks_exact(2).map(longer_side).sum(),
            _ => corners.chunks_exact(3).map(area).sum(),
        };
        Some(Self { number, width, height, lines, primitives, corners, pixels })
    }

    /// Samples of a pixel that the scene is drawn with where nothing is asked for.
    #[must_use]
    pub fn antialias(&self) -> Option<SubpixelGrid> {
        (self.number == 10).then_some(SubpixelGrid::Grid8x8)
    }

    /// It is drawn with [`texture`].
    #[must_use]
    pub fn is_textured(&self) -> bool {
        self.number == 8
    }

    /// It is drawn with blending and stores no depths.
    #[must_use]
    pub fn is_translucent(&self) -> bool {
        self.number == 9
    }

    /// FNV-1a over all corners, the check value of the definition.
    #[must_use]
    pub fn fnv(&self) -> u64 {
        let mut hash = 0xCBF2_9CE4_8422_2325_u64;
        let mut put = |byte: u8| hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3);
        for corner in &self.corners {
            for word in [corner.x, corner.y, corner.depth, corner.u, corner.v] {
                word.to_le_bytes().into_iter().for_each(&mut put);
            }
            corner.colour.into_iter().for_each(&mut put);
        }
        hash
    }
}

/// 64 layers of two triangles over the whole viewport.
fn layers(generator: &mut Pcg32, corners: &mut [Corner], [width, height]: [i32; 2], from_far: bool) {
    const PLACES: [[i32; 2]; 6] = [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]];
    for (layer, corners) in (0..).zip(corners.chunks_exact_mut(6)) {
        let colour = generator.colour(255);
        let depth = if from_far { 64 - layer } else { layer + 1 } * 1000;
        for (corner, [x, y]) in corners.iter_mut().zip(PLACES) {
            *corner = Corner { x: x * width * 256, y: y * height * 256, depth, colour, ..Corner::default() };
        }
    }
}

/// Triangle `number` of S8: nearer than those before it, 0.5 to 4 texels a pixel, in half of the cases mirrored at the
/// diagonal of the texture.
fn textured(generator: &mut Pcg32, corners: &mut [Corner], [width, height]: [i32; 2], number: i32) {
    const SIDE: i32 = 160;
    let left = generator.below(((width - SIDE) * 256 + 1) as u32);
    let top = generator.below(((height - SIDE) * 256 + 1) as u32);
    let triangle = box_triangle(generator, [SIDE as u32; 2], [4500, 5500]);
    for (corner, [x, y]) in corners.iter_mut().zip(triangle) {
        (corner.x, corner.y, corner.depth) = (left + x, top + y, 65_000 - 30 * number);
    }
    corners.iter_mut().for_each(|corner| corner.colour = generator.colour(255));
    let texels = 128 + generator.below(897);
    let mirrored = generator.below(2) == 1;
    for corner in corners {
        // Pixels times 256 by texels a pixel times 256; the definition has no target so wide that 32 bits do not hold it.
        let (u, v) = (corner.x.wrapping_mul(texels), corner.y.wrapping_mul(texels));
        (corner.u, corner.v) = if mirrored { (v, u) } else { (u, v) };
    }
}

fn area(corners: &[Corner]) -> f64 {
    let triangle = std::array::from_fn(|i| [corners[i].x, corners[i].y]);
    cross(triangle) as f64 / 131_072.0
}

fn longer_side(corners: &[Corner]) -> f64 {
    f64::from((corners[1].x - corners[0].x).abs().max((corners[1].y - corners[0].y).abs())) / 256.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(number: u32, primitives: usize, pixels: f64, fnv: u64) {
        let scene = BenchScene::new(number, 1024, 768).expect("there");
        assert_eq!(scene.primitives, primitives, "S{number}");
        assert_eq!(scene.fnv(), fnv, "S{number}");
        // The definition gives one digit behind the point.
        assert!((scene.pixels - pixels).abs() < 0.06, "S{number}: {}", scene.pixels);
    }

    #[test]
    fn scenes_have_the_hashes_of_their_definition() {
        check(2, 128, 50_331_648.0, 0xACEF_8BCF_8BE5_0DED);
        check(3, 128, 50_331_648.0, 0xFBC1_978A_70BF_0E4D);
        check(4, 200_000, 3_897_053.7, 0xD7C9_CC82_3D3F_DC57);
        check(5, 20_000, 7_630_619.8, 0x43CC_9361_AFC1_97DA);
        check(6, 20_000, 2_244_101.3, 0xE402_024E_D899_D382);
        check(7, 100_000, 5_418_301.7, 0xC77F_E174_0600_731C);
        check(8, 2_000, 9_904_390.8, 0xE748_6E7D_01D6_CA55);
        check(9, 200, 19_929_622.1, 0x43BE_5B2F_C381_B444);
        check(10, 20_000, 7_630_619.8, 0x43CC_9361_AFC1_97DA);
    }

    #[test]
    fn texture_texels_are_those_of_the_definition() {
        let texture = texture();
        assert_eq!(texture.len(), 65_536);
        // At (3, 2) k = 0; at (20, 2) k = 1; at (255, 254) k = 0.
        assert_eq!(texture[2 * 256 + 3], [252, 1, 2, 255]);
        assert_eq!(texture[2 * 256 + 20], [20, 22, 253, 255]);
        assert_eq!(texture[254 * 256 + 255], [0, 1, 254, 255]);
    }

    #[test]
    fn new_unknown_number_or_small_viewport_is_none() {
        assert!(BenchScene::new(0, 64, 64).is_none());
        assert!(BenchScene::new(8, 160, 768).is_none());
        assert!(BenchScene::new(11, 1024, 768).is_none());
        assert!(BenchScene::new(6, 100, 768).is_none());
        assert!(BenchScene::new(9, 1023, 768).is_none());
        assert!(BenchScene::new(1, 1, 1).is_some_and(|scene| scene.corners.is_empty()));
    }
}
