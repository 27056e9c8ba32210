//! The anti-aliased picture: n x m supersampling by definition, sample by sample.
//!
//! A pixel of a C x R grid has samples at the middles of C x R equal rectangles. A primitive drawn with masks is one or
//! two triangles ([`faces`]), which cover a sample by the top-left rule and have there the depth that the card's formats
//! prescribe; one drawn without is there at all samples of the pixels that it draws, or at none. Opaque fragments are
//! drawn in order, each with its own depth test at each sample. Fragments with an alpha below 255 of a draw that blends
//! are *layers*: they wait until the pixel is composed ([`compose`]), at the end or at a clear of depths alone;
//! what is opaque and has no depth test takes the samples it covers from the layers before it.
//!
//! [`Supersampled::draw_plain`] is that in so many words; [`Supersampled::draw`] does the same by runs of rows, and tests
//! hold it to that.
//!
//! Nothing is ordered, merged, packed or skipped here, and no pixel is treated unlike another. Colours are flat: that of
//! a primitive's first vertex.
//!
//! Beside its samples a pixel has the depth that the hidden-surface path keeps, one at the centre, by the same rules.

mod bands;
pub mod compose;
mod faces;

pub use compose::{Level, Resolve};
pub use faces::faces;

use super::canvas::{Area, Test};
use super::depth::PrescribedDepth;
use super::raster::{Outline, for_each_pixel};
use super::{DepthFormat, DepthFunction, Primitive, Vertex};
use compose::Colour;

/// State of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Brush {
    /// Depth test and scissor.
    pub test: Test,
    /// Samples are covered one by one.
    pub anti_alias: bool,
    /// Fragments are translucent.
    pub blend: bool,
    /// Width of lines drawn with masks, u.
    pub line_width: u32,
    /// Side of points drawn with masks, u.
    pub point_size: u32,
}

impl Brush {
    /// Opaque masks with a test; lines and points are one pixel wide.
    #[must_use]
    pub const fn masked(test: Test) -> Self {
        Self { test, anti_alias: true, blend: false, line_width: 256, point_size: 256 }
    }
}

#[derive(Clone, Debug)]
struct Sample {
    colour: Colour,
    depth: u32,
}

/// A translucent fragment, at each of the samples it covers.
#[derive(Clone, Debug)]
struct Layer {
    /// By sample; `None` where it is not.
    depths: Vec<Option<u32>>,
    /// `None`: in front of everything before it.
    function: Option<DepthFunction>,
    colour: [u8; 4],
}

#[derive(Clone, Debug)]
struct Pixel {
    samples: Vec<Sample>,
    /// In order of submission.
    layers: Vec<Layer>,
    /// Of the hidden-surface path.
    centre: u32,
}

/// A fragment of a primitive in one pixel: depths of the samples it covers, and at the centre if it covers that.
struct Fragment {
    depths: Vec<Option<u32>>,
    centre: Option<u32>,
}

impl Pixel {
    fn new(samples: usize, colour: [u8; 4], depth: u32) -> Self {
        let sample = Sample { colour: Colour::Plain(colour), depth };
        Self { samples: vec![sample; samples], layers: Vec::new(), centre: depth }
    }

    /// Draws an opaque fragment.
    fn put(&mut self, fragment: &Fragment, colour: [u8; 4], test: &Test) {
        if test.function.is_none() {
            // It has no depth that a layer could be nearer than: it is in front of all that came before it.
            for (place, _) in fragment.depths.iter().enumerate().filter(|(_, depth)| depth.is_some()) {
                self.layers.iter_mut().for_each(|layer| layer.depths[place] = None);
            }
        }
        let passes = |new: u32, stored: u32| test.function.is_none_or(|function| function.passes(&new, &stored));
        let write = test.function.is_some() && test.write;
        for (sample, &depth) in self.samples.iter_mut().zip(&fragment.depths) {
            let Some(new) = depth.filter(|&new| passes(new, sample.depth)) else { continue };
            sample.colour = Colour::Plain(colour);
            sample.depth = if write { new } else { sample.depth };
        }
        if let Some(new) = fragment.centre.filter(|&new| write && passes(new, self.centre)) {
            self.centre = new;
        }
    }

    /// Draws a fragment, or keeps it for later if it is translucent.
    fn take(&mut self, fragment: &Fragment, colour: [u8; 4], brush: &Brush) {
        match colour[3] {
            0 if brush.blend => {}
            1..=254 if brush.blend => {
                let depths = fragment.depths.clone();
                self.layers.push(Layer { depths, function: brush.test.function, colour });
            }
            _ => self.put(fragment, colour, &brush.test),
        }
    }

    /// Composes the layers with what is behind them.
    fn compose(&mut self) {
        for (place, sample) in self.samples.iter_mut().enumerate() {
            let here = self.layers.iter().filter_map(|layer| Some((layer, layer.depths[place]?)));
            let seen = here.filter(|(layer, z)| layer.function.is_none_or(|f| f.passes(z, &sample.depth)));
            // Farthest first; a stable sort keeps the later of equals in front. What has no depth is nearest.
            let mut seen: Vec<_> = seen.map(|(layer, z)| (layer, layer.function.map(|_| z))).collect();
            seen.sort_by_key(|(_, z)| std::cmp::Reverse(z.map_or(-1, i64::from)));
            for (layer, _) in seen {
                sample.colour = sample.colour.under(layer.colour);
            }
        }
        self.layers.clear();
    }
}

/// A target whose pixels have samples.
#[derive(Clone, Debug)]
pub struct Supersampled {
    width: u32,
    height: u32,
    format: DepthFormat,
    resolve: Resolve,
    /// 1/256 pixel from the pixel's upper left corner, row by row.
    positions: Vec<[u32; 2]>,
    pixels: Vec<Pixel>,
}

impl Supersampled {
    /// All samples transparent black and farthest. `grid` is columns and rows of samples.
    #[must_use]
    pub fn new([width, height]: [u32; 2], grid: [u32; 2], format: DepthFormat, resolve: Resolve) -> Self {
        let [columns, rows] = grid;
        let middle = |place: u32, of: u32| 256 * (2 * place + 1) / (2 * of);
        let positions: Vec<_> = (0..columns * rows)
            .map(|sample| [middle(sample % columns, columns), middle(sample / columns, rows)])
            .collect();
        let pixel = Pixel::new(positions.len(), [0; 4], format.greatest());
        let pixels = vec![pixel; (width * height) as usize];
        Self { width, height, format, resolve, positions, pixels }
    }

    /// A scene begins: all samples of a pixel have its colour and depth.
    ///
    /// # Panics
    /// When there is not one of each for each pixel.
    pub fn load(&mut self, colours: &[[u8; 4]], depths: &[u32]) {
        assert_eq!((colours.len(), depths.len()), (self.pixels.len(), self.pixels.len()), "a colour and a depth each");
        for (pixel, (&colour, &depth)) in self.pixels.iter_mut().zip(colours.iter().zip(depths)) {
            *pixel = Pixel::new(self.positions.len(), colour, depth);
        }
    }

    /// Clears planes of a rectangle. What is composed over a colour goes with it.
    pub fn clear(&mut self, [left, top, right, bottom]: Area, colour: Option<[u8; 4]>, depth: Option<u32>) {
        for j in top..bottom.min(self.height) {
            for i in left..right.min(self.width) {
                let pixel = &mut self.pixels[(j * self.width + i) as usize];
                // With a colour the composed one is not seen, so it does not matter that nobody composed it.
                pixel.compose();
                for sample in &mut pixel.samples {
                    sample.depth = depth.unwrap_or(sample.depth);
                    if let Some(colour) = colour {
                        sample.colour = Colour::Plain(colour);
                    }
                }
                pixel.centre = depth.unwrap_or(pixel.centre);
            }
        }
    }

    /// Draws primitives in order.
    pub fn draw(&mut self, primitives: &[Primitive], brush: &Brush) {
        let target = bands::Target { size: [self.width, self.height], format: self.format, positions: &self.positions };
        target.draw(&mut self.pixels, primitives, brush);
    }

    /// [`Supersampled::draw`] by definition: primitive by primitive, pixel by pixel, sample by sample.
    pub fn draw_plain(&mut self, primitives: &[Primitive], brush: &Brush) {
        for primitive in primitives {
            if brush.anti_alias {
                for face in faces(primitive, brush.line_width, brush.point_size) {
                    self.face(&face, primitive.vertices()[0].colour, brush);
                }
            } else {
                self.whole_pixels(primitive, brush);
            }
        }
    }

    /// Draws a triangle sample by sample.
    fn face(&mut self, triangle: &[Vertex; 3], colour: [u8; 4], brush: &Brush) {
        let plane = PrescribedDepth::new(&Primitive::Triangle(*triangle), self.format);
        let (Some(outline), Some(plane)) = (Outline::new(triangle), plane) else { return };
        // Pixels of the scissor whose squares the bounding box touches.
        let [left, top, right, bottom] = brush.test.scissor;
        let touched = |coordinates: [i32; 3], from: u32, to: u32| {
            let least = coordinates.into_iter().fold(i32::MAX, i32::min).div_euclid(256).max(from as i32);
            let greatest = coordinates.into_iter().fold(i32::MIN, i32::max).div_euclid(256).min(to as i32 - 1);
            least..greatest + 1
        };
        let columns = touched(triangle.map(|v| v.x), left, right.min(self.width));
        let rows = touched(triangle.map(|v| v.y), top, bottom.min(self.height));
        for (i, j) in rows.flat_map(|j| columns.clone().map(move |i| (i, j))) {
            let depth = |at: [u32; 2]| {
                let [x, y] = [i64::from(i) * 256 + i64::from(at[0]), i64::from(j) * 256 + i64::from(at[1])];
                outline.covers(x, y).then(|| plane.stored_in(i, j, at))
            };
            let depths = self.positions.iter().map(|&at| depth(at)).collect();
            self.fragment([i as u32, j as u32], &Fragment { depths, centre: depth([128, 128]) }, colour, brush);
        }
    }

    /// Draws a primitive to all samples of its pixels.
    fn whole_pixels(&mut self, primitive: &Primitive, brush: &Brush) {
        let Some(plane) = PrescribedDepth::new(primitive, self.format) else { return };
        let colour = primitive.vertices()[0].colour;
        for_each_pixel(primitive, self.width, self.height, |i, j| {
            let depth = Some(plane.stored(i as i32, j as i32));
            let fragment = Fragment { depths: vec![depth; self.positions.len()], centre: depth };
            self.fragment([i, j], &fragment, colour, brush);
        });
    }

    fn fragment(&mut self, [i, j]: [u32; 2], fragment: &Fragment, colour: [u8; 4], brush: &Brush) {
        let [left, top, right, bottom] = brush.test.scissor;
        if (left..right).contains(&i) && (top..bottom).contains(&j) {
            self.pixels[(j * self.width + i) as usize].take(fragment, colour, brush);
        }
    }

    /// The scene ends: the layers are composed, the samples averaged. Red, green, blue, alpha of each pixel.
    pub fn end(&mut self) -> Vec<[Level; 4]> {
        let resolve = self.resolve;
        let resolved = |pixel: &mut Pixel| {
            pixel.compose();
            compose::mean(&pixel.samples.iter().map(|sample| &sample.colour).collect::<Vec<_>>(), resolve)
        };
        let mut picture = vec![[Level::exactly(0); 4]; self.pixels.len()];
        let size = (super::bands::ROWS * self.width).max(1) as usize;
        let work = (self.pixels.len() * self.positions.len()) as u64;
        let bands = self.pixels.chunks_mut(size).zip(picture.chunks_mut(size));
        super::bands::each(bands, work, |(pixels, levels)| {
            pixels.iter_mut().zip(levels).for_each(|(pixel, levels)| *levels = resolved(pixel));
        });
        picture
    }

    /// The depths at the pixels' centres, as the hidden-surface path keeps them.
    #[must_use]
    pub fn centre_depths(&self) -> Vec<u32> {
        self.pixels.iter().map(|pixel| pixel.centre).collect()
    }

    /// The depths of a pixel's samples, row by row.
    #[must_use]
    pub fn sample_depths(&self, i: u32, j: u32) -> Vec<u32> {
        self.pixels[(j * self.width + i) as usize].samples.iter().map(|sample| sample.depth).collect()
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
