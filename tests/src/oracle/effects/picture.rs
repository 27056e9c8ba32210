//! The picture: one sample at each pixel's centre, holes, translucent layers, clears.
//!
//! A fragment that is a hole is not there. An opaque one is tested and stored as ever. What is translucent waits as a
//! *layer* until the scene ends or its pixel is cleared; then it is tested by its own depth function against the
//! pixel's opaque depth, stores none, and is composed from the farthest to the nearest, of equal depths the earlier
//! first. A layer without a depth test is nearer than all with one. What is opaque and has no depth test hides the layers
//! before it, unless a stencil test lets it through.
//!
//! With a stencil test a fragment that is no hole comes to that first. A layer comes to it when it is composed, and
//! changes nothing. Before that, pixels in shadow are darkened.
//!
//! Visibility and order are exact. Colours are as [`super::shade`] knows them: exact while all that was composed is.

use std::cmp::Reverse;

use super::super::canvas::{Area, Test};
use super::super::depth::PrescribedDepth;
use super::super::raster::for_each_pixel;
use super::super::stencil::{Shadow, Stencil, shows_front};
use super::super::{DepthFormat, DepthFunction, Primitive};
use super::shade::{Fragment, Shade};
use super::{Colour, blend};

/// How a primitive is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Brush {
    /// Depth test and scissor.
    pub test: Test,
    /// Blend mode of what is translucent; `None` is opaque.
    pub mode: Option<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Layer {
    /// In steps; `None`: in front of all that have one.
    depth: Option<u32>,
    function: Option<DepthFunction>,
    mode: u32,
    stencil: Option<Stencil>,
    shade: Shade,
}

#[derive(Clone, Debug)]
struct Pixel {
    shade: Shade,
    depth: u32,
    stencil: u8,
    /// Whether the depth, or what is visible, is in doubt.
    torn: bool,
    /// In order of submission.
    layers: Vec<Layer>,
}

/// A target while scenes are drawn to it.
#[derive(Clone, Debug)]
pub struct Painting {
    width: u32,
    height: u32,
    format: DepthFormat,
    /// What the frame buffer makes of a colour: fewer bits, no alpha.
    store: fn(Colour) -> Colour,
    pixels: Vec<Pixel>,
}

impl Painting {
    /// Transparent black and the farthest depth everywhere. `store` says what a colour is when read back.
    #[must_use]
    pub fn new([width, height]: [u32; 2], format: DepthFormat, store: fn(Colour) -> Colour) -> Self {
        let black = Shade::exactly(store([0; 4]));
        let pixel = Pixel { shade: black, depth: format.greatest(), stencil: 0, torn: false, layers: vec![] };
        Self { width, height, format, store, pixels: vec![pixel; (width * height) as usize] }
    }

    /// Width and height, pixels.
    #[must_use]
    pub const fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// How depths are stored.
    #[must_use]
    pub const fn format(&self) -> DepthFormat {
        self.format
    }

    /// Clears planes of a rectangle, whose layers are composed first.
    pub fn clear(&mut self, [left, top, right, bottom]: Area, colour: Option<Colour>, depth: Option<u32>) {
        let store = self.store;
        for j in top..bottom.min(self.height) {
            for i in left..right.min(self.width) {
                let pixel = &mut self.pixels[(j * self.width + i) as usize];
                pixel.compose(store);
                if let Some(colour) = colour {
                    pixel.shade = Shade::exactly(store(colour));
                }
                pixel.depth = depth.unwrap_or(pixel.depth);
                // With both planes nothing is left of what was in doubt.
                pixel.torn &= colour.is_none() || depth.is_none();
            }
        }
    }

    /// Clears stencil values of a rectangle, whose layers are composed first.
    pub fn clear_stencil(&mut self, area: Area, value: u8) {
        self.clear(area, None, None);
        let [left, top, right, bottom] = area;
        for j in top..bottom.min(self.height) {
            for i in left..right.min(self.width) {
                self.pixels[(j * self.width + i) as usize].stencil = value;
            }
        }
    }

    /// Darkens the pixels in shadow; the scene ends next.
    pub fn darken(&mut self, shadow: &Shadow) {
        let store = self.store;
        for pixel in self.pixels.iter_mut().filter(|pixel| shadow.falls_on(pixel.stencil)) {
            let part = f64::from(shadow.intensity) / 255.0;
            let Shade { colour: [r, g, b, a], tolerance, doubt } = pixel.shade;
            pixel.shade = match pixel.shade.exact() {
                Some([r, g, b, a]) => {
                    let [r, g, b] = [r, g, b].map(|level| shadow.darken(level));
                    Shade { doubt, ..Shade::exactly(store([r, g, b, a])) }
                }
                // A level that is off by the tolerance, and rounded.
                None => Shade {
                    colour: [r * part, g * part, b * part, a],
                    tolerance: tolerance.max(tolerance * part + 0.5),
                    doubt,
                },
            };
        }
    }

    /// Stored stencil values; `None` where they are in doubt.
    #[must_use]
    pub fn stencils(&self) -> Vec<Option<u8>> {
        self.pixels.iter().map(|pixel| (!pixel.torn).then_some(pixel.stencil)).collect()
    }

    /// Draws a primitive whose fragments are what `fragment` says for a column and row.
    pub fn draw(&mut self, primitive: &Primitive, brush: &Brush, mut fragment: impl FnMut(i32, i32) -> Fragment) {
        let Some(plane) = PrescribedDepth::new(primitive, self.format) else { return };
        let Test { function, write, scissor: [left, top, right, bottom], stencil } = brush.test;
        let (width, height, store, front) = (self.width, self.height, self.store, shows_front(primitive));
        for_each_pixel(primitive, width, height, |i, j| {
            if !(left..right).contains(&i) || !(top..bottom).contains(&j) {
                return;
            }
            let depth = plane.stored(i as i32, j as i32);
            let pixel = &mut self.pixels[(j * width + i) as usize];
            let Fragment { shade, hole, torn } = fragment(i as i32, j as i32);
            pixel.torn |= torn;
            if hole {
                return;
            }
            if let Some(mode) = brush.mode {
                pixel.layers.push(Layer { depth: function.map(|_| depth), function, mode, stencil, shade });
                return;
            }
            if function.is_none() && stencil.is_none() {
                pixel.layers.clear();
            }
            let mut drawn = function.is_none_or(|function| function.passes(&depth, &pixel.depth));
            if let Some(stencil) = &stencil {
                (drawn, pixel.stencil) = stencil.outcome(front, pixel.stencil, drawn);
            }
            if drawn {
                if stencil.is_none_or(|stencil| stencil.colours) {
                    pixel.shade = stored(shade, store);
                }
                pixel.depth = if function.is_some() && write { depth } else { pixel.depth };
            }
        });
    }

    /// The scene ends: layers are composed. What each pixel shows; where visibility is in doubt, so is the colour.
    pub fn end(&mut self) -> Vec<Shade> {
        let store = self.store;
        let shown = |pixel: &mut Pixel| {
            pixel.compose(store);
            Shade { doubt: pixel.shade.doubt || pixel.torn, ..pixel.shade }
        };
        self.pixels.iter_mut().map(shown).collect()
    }

    /// Stored depths; `None` where they are in doubt.
    #[must_use]
    pub fn depths(&self) -> Vec<Option<u32>> {
        self.pixels.iter().map(|pixel| (!pixel.torn).then_some(pixel.depth)).collect()
    }

    /// The most layers that wait in a pixel.
    #[must_use]
    pub fn deepest(&self) -> usize {
        self.pixels.iter().map(|pixel| pixel.layers.len()).max().unwrap_or(0)
    }
}

/// As the frame buffer has it.
fn stored(shade: Shade, store: fn(Colour) -> Colour) -> Shade {
    shade.exact().map_or(shade, |colour| Shade { doubt: shade.doubt, ..Shade::exactly(store(colour)) })
}

impl Pixel {
    fn compose(&mut self, store: fn(Colour) -> Colour) {
        if self.layers.is_empty() {
            return;
        }
        let passes = |layer: &Layer| layer.depth.zip(layer.function).is_none_or(|(z, f)| f.passes(&z, &self.depth));
        let value = self.stencil;
        let tested = |layer: &Layer| layer.stencil.is_none_or(|stencil| stencil.outcome(true, value, true).0);
        let mut seen: Vec<Layer> = self.layers.drain(..).filter(passes).filter(tested).collect();
        // Stable: of equals the earlier is composed first. Without a depth last.
        seen.sort_by_key(|layer| Reverse(layer.depth.map_or(-1, i64::from)));
        for layer in seen {
            self.shade = over(layer.mode, self.shade, layer.shade);
        }
        self.shade = stored(self.shade, store);
    }
}

/// A layer over what is below it: exact of exact colours.
fn over(mode: u32, below: Shade, source: Shade) -> Shade {
    let doubt = below.doubt || source.doubt;
    match (below.exact(), source.exact()) {
        (Some(below), Some(source)) => Shade { doubt, ..Shade::exactly(blend::exact(mode, below, source)) },
        _ => Shade {
            colour: blend::unrounded(mode, below.colour, source.colour),
            tolerance: blend::tolerance(below.tolerance, source.tolerance),
            doubt,
        },
    }
}

#[cfg(test)]
#[path = "picture_tests.rs"]
mod tests;
