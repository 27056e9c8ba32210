//! The picture of a whole sequence of commands: draws with any state, clears of planes and rectangles.
//!
//! Colours are flat, that of a primitive's first vertex, and stored as the canvas is told. Where no Z buffer remembers
//! depths from one scene to the next, the caller starts a scene with [`Canvas::forget_depths`].

use super::depth::PrescribedDepth;
use super::raster::for_each_pixel;
use super::stencil::{Stencil, shows_front};
use super::{DepthFormat, DepthFunction, Primitive};

/// A rectangle of pixels: left, top, right, bottom, the last two exclusive; cut to the canvas.
pub type Area = [u32; 4];

/// State of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Test {
    /// Depth test; `None` where depth is not called for: everything passes, no depth is stored.
    pub function: Option<DepthFunction>,
    /// A passing depth is stored.
    pub write: bool,
    /// Pixels that may change.
    pub scissor: Area,
    /// Stencil test; `None` where it is not called for.
    pub stencil: Option<Stencil>,
}

/// Colours and depths of a target, row by row.
#[derive(Clone, Debug)]
pub struct Canvas {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// How depths are stored.
    pub format: DepthFormat,
    /// The stored pixel of red, green, blue, alpha.
    pub encode: fn([u8; 4]) -> u32,
    /// Stored pixels.
    pub colour: Vec<u32>,
    /// Stored depths.
    pub depth: Vec<u32>,
    /// Stored stencil values.
    pub stencil: Vec<u8>,
}

impl Canvas {
    /// Pixels of 0, as far as can be.
    #[must_use]
    pub fn new(width: u32, height: u32, format: DepthFormat, encode: fn([u8; 4]) -> u32) -> Self {
        let pixels = width as usize * height as usize;
        let (colour, depth) = (vec![0; pixels], vec![format.greatest(); pixels]);
        Self { width, height, format, encode, colour, depth, stencil: vec![0; pixels] }
    }

    /// All depths are the greatest.
    pub fn forget_depths(&mut self) {
        self.depth.fill(self.format.greatest());
    }

    /// Calls `visit` for the positions of a rectangle's pixels.
    pub fn for_each(&mut self, [left, top, right, bottom]: Area, mut visit: impl FnMut(&mut u32, &mut u32)) {
        for j in top..bottom.min(self.height) {
            for i in left..right.min(self.width) {
                let place = (j * self.width + i) as usize;
                visit(&mut self.colour[place], &mut self.depth[place]);
            }
        }
    }

    /// Clears planes of a rectangle.
    pub fn clear(&mut self, area: Area, colour: Option<[u8; 4]>, depth: Option<u32>) {
        let colour = colour.map(self.encode);
        self.for_each(area, |pixel, z| {
            *pixel = colour.unwrap_or(*pixel);
            *z = depth.unwrap_or(*z);
        });
    }

    /// Clears stencil values of a rectangle.
    pub fn clear_stencil(&mut self, [left, top, right, bottom]: Area, value: u8) {
        for j in top..bottom.min(self.height) {
            for i in left..right.min(self.width) {
                self.stencil[(j * self.width + i) as usize] = value;
            }
        }
    }

    /// Draws primitives in order.
    pub fn draw(&mut self, primitives: &[Primitive], test: &Test) {
        let [left, top, right, bottom] = test.scissor;
        for primitive in primitives {
            let Some(plane) = PrescribedDepth::new(primitive, self.format) else { continue };
            let colour = (self.encode)(primitive.vertices()[0].colour);
            let (width, height, front) = (self.width, self.height, shows_front(primitive));
            for_each_pixel(primitive, width, height, |i, j| {
                if !(left..right).contains(&i) || !(top..bottom).contains(&j) {
                    return;
                }
                let place = (j * width + i) as usize;
                let new = plane.stored(i as i32, j as i32);
                let mut drawn = test.function.is_none_or(|function| function.passes(&new, &self.depth[place]));
                if let Some(stencil) = &test.stencil {
                    (drawn, self.stencil[place]) = stencil.outcome(front, self.stencil[place], drawn);
                }
                if drawn {
                    if test.stencil.is_none_or(|stencil| stencil.colours) {
                        self.colour[place] = colour;
                    }
                    if test.function.is_some() && test.write {
                        self.depth[place] = new;
                    }
                }
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Vertex, draw};
    use super::*;

    fn quad(z: u32, colour: [u8; 4]) -> Primitive {
        Primitive::Triangle([(0, 0), (9000, 0), (0, 9000)].map(|(x, y)| Vertex::at(x, y, z).coloured(colour)))
    }

    #[test]
    fn draw_less_equals_the_picture_of_one_draw() {
        let scene = [quad(9, [1; 4]), quad(5, [2; 4]), quad(7, [3; 4])];
        let mut canvas = Canvas::new(5, 3, DepthFormat::default(), u32::from_le_bytes);
        canvas.draw(
            &scene,
            &Test { function: Some(DepthFunction::Less), write: true, scissor: [0, 0, 9, 9], stencil: None },
        );
        let image = draw(5, 3, &scene, DepthFormat::default(), DepthFunction::Less);
        assert_eq!(canvas.depth, image.depth);
        assert_eq!(canvas.colour, [0x0202_0202; 15]);
    }

    #[test]
    fn clear_rectangle_and_plane_leave_the_rest() {
        let mut canvas = Canvas::new(3, 1, DepthFormat::default(), u32::from_le_bytes);
        canvas.clear([1, 0, 9, 9], Some([7; 4]), None);
        canvas.clear([2, 0, 9, 9], None, Some(4));
        let far = canvas.format.greatest();
        assert_eq!((canvas.colour, canvas.depth), (vec![0, 0x0707_0707, 0x0707_0707], vec![far, far, 4]));
    }

    #[test]
    fn draw_without_test_or_write_keeps_depths() {
        let mut canvas = Canvas::new(2, 1, DepthFormat::default(), u32::from_le_bytes);
        let test = Test { function: None, write: true, scissor: [0, 0, 1, 1], stencil: None };
        canvas.draw(&[quad(3, [1; 4])], &test);
        canvas.draw(&[quad(2, [4; 4])], &Test { function: Some(DepthFunction::Less), write: false, ..test });
        let far = canvas.format.greatest();
        assert_eq!((canvas.colour, canvas.depth), (vec![0x0404_0404, 0], vec![far, far]));
    }
}
