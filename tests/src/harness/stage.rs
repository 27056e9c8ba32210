//! A card and the oracle of the effects that draw the same, and how their pictures differ.

use super::look::registers;
use super::options::{Options, Pixels, State};
use super::picture::Picture;
use super::screen::{Screen, Topology};
use crate::oracle::effects::{Colour, Corner, Memory, Painting, RawDraw, Shade};
use crate::oracle::stencil::Shadow;
use std::fmt;

/// A card with a target, the same target of the oracle, and the region that both read textures and lights from.
#[derive(Debug)]
pub struct Stage {
    /// The card.
    pub screen: Screen,
    painting: Painting,
    memory: Memory,
    size: [u32; 2],
}

/// How a picture differs from the oracle's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels where the oracle has no single answer: what decides lies within the card's rounding.
    pub doubtful: usize,
    /// Other pixels that something was drawn to: the errors are theirs.
    pub drawn: usize,
    /// Pixels farther off than the oracle allows.
    pub wrong: usize,
    /// Pixels that hold another depth.
    pub depths: usize,
    /// Pixels that hold another stencil value.
    pub stencils: usize,
    /// Words written outside the target.
    pub strays: usize,
    /// Largest distance of a channel from the oracle's, in levels.
    pub largest: f64,
    /// Mean distance of a channel, in levels.
    pub mean: f64,
    /// The first wrong pixel or depth.
    pub first: Option<String>,
}

impl Comparison {
    /// Whether everything is as it must be.
    #[must_use]
    pub const fn right(&self) -> bool {
        self.wrong == 0 && self.depths == 0 && self.stencils == 0 && self.strays == 0
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixels, doubtful, drawn, wrong, depths, stencils, strays, largest, mean, first } = self;
        write!(
            f,
            "{pixels} pixels ({drawn} drawn, {doubtful} in doubt), {wrong} colours, {depths} depths and {stencils} "
        )?;
        write!(f, "stencil values wrong, ")?;
        write!(f, "{strays} stray words; errors {largest:.3} at most, {mean:.4} on average")?;
        first.as_ref().map_or(Ok(()), |first| write!(f, "; first {first}"))
    }
}

/// What a colour is when it is read back from a frame buffer.
#[must_use]
pub const fn store(pixels: Pixels) -> fn(Colour) -> Colour {
    match pixels {
        Pixels::Xrgb8888 => |[r, g, b, _]| [r, g, b, 255],
        Pixels::Argb8888 => |colour| colour,
        Pixels::Rgb565 => |[r, g, b, _]| [r & 0xF8 | r >> 5, g & 0xFC | g >> 6, b & 0xF8 | b >> 5, 255],
    }
}

/// The colour of a stored pixel.
#[must_use]
pub const fn load(pixels: Pixels, pixel: u32) -> Colour {
    let [alpha, r, g, b] = pixel.to_be_bytes();
    match pixels {
        Pixels::Xrgb8888 => [r, g, b, 255],
        Pixels::Argb8888 => [r, g, b, alpha],
        Pixels::Rgb565 => {
            let (r, g, b) = (pixel >> 11 & 31, pixel >> 5 & 63, pixel & 31);
            [(r << 3 | r >> 2) as u8, (g << 2 | g >> 4) as u8, (b << 3 | b >> 2) as u8, 255]
        }
    }
}

const fn vertices(topology: Topology) -> usize {
    match topology {
        Topology::Triangles => 3,
        Topology::Lines => 2,
        Topology::Points | Topology::LineStrip => 1,
    }
}

impl Stage {
    /// Powers a card on, puts `region` into its memory, and clears both targets to transparent black.
    #[must_use]
    pub fn new(size: [u32; 2], options: &Options, region: &[u32]) -> Self {
        let options = Options { texture_bytes: 4 * region.len() as u32, ..*options };
        let mut screen = Screen::new(size[0], size[1], &options);
        screen.put_textures(0, region);
        let memory = Memory { at: screen.textures(), words: region.to_vec() };
        let mut stage =
            Self { screen, painting: Painting::new(size, options.depth, store(options.pixels)), memory, size };
        stage.clear([0; 4]);
        stage
    }

    /// Clears the target to a colour and the farthest depth.
    pub fn clear(&mut self, colour: Colour) {
        let far = self.screen.options().depth.greatest();
        self.clear_planes(Some(colour), Some(far), None);
    }

    /// Clears planes of a rectangle; all of it without one.
    pub fn clear_planes(&mut self, colour: Option<Colour>, depth: Option<u32>, area: Option<[u32; 4]>) {
        self.screen.clear_planes(colour.map(u32::from_le_bytes), depth, area);
        self.painting.clear(area.unwrap_or([0, 0, self.size[0], self.size[1]]), colour, depth);
    }

    /// Clears stencil values of a rectangle; of all pixels without one.
    pub fn clear_stencil(&mut self, value: u8, area: Option<[u32; 4]>) {
        self.screen.clear_all_planes(None, None, Some(value), area);
        self.painting.clear_stencil(area.unwrap_or([0, 0, self.size[0], self.size[1]]), value);
    }

    /// Ends a scene that has tested stencil values, with pixels in shadow darkened, and compares.
    pub fn end_in_shadow(&mut self, shadow: &Shadow) -> (Picture, Comparison, Vec<Shade>) {
        self.screen.set_shadow(Some(shadow));
        self.painting.darken(shadow);
        self.end()
    }

    /// Draws on both.
    pub fn draw(&mut self, topology: Topology, corners: &[Corner], state: &State) {
        self.screen.draw_corners(topology, corners, state);
        let registers = registers(state, self.memory.at, self.size);
        let draw = RawDraw { each: vertices(topology), corners, registers: &registers, memory: &self.memory };
        self.painting.draw_raw(&draw);
    }

    /// Draws triangles on both.
    pub fn triangles(&mut self, corners: &[Corner], state: &State) {
        self.draw(Topology::Triangles, corners, state);
    }

    /// Ends the scene and compares.
    pub fn compare(&mut self) -> Comparison {
        self.end().1
    }

    /// The same with the card's picture and the oracle's.
    pub fn end(&mut self) -> (Picture, Comparison, Vec<Shade>) {
        let picture = self.screen.read();
        let shades = self.painting.end();
        let depth_buffer = self.screen.options().depth_buffer;
        let comparison = self.against(&picture, &shades, depth_buffer);
        (picture, comparison, shades)
    }

    fn against(&self, picture: &Picture, shades: &[Shade], depth_buffer: bool) -> Comparison {
        let mut found = Comparison { pixels: shades.len(), strays: picture.strays, ..Comparison::default() };
        let (depths, stencils) = (self.painting.depths(), self.painting.stencils());
        for (k, shade) in shades.iter().enumerate() {
            let (i, j) = (k as u32 % self.size[0], k as u32 / self.size[0]);
            let colour = load(picture.pixels, picture.colour[k]);
            let depth_wrong = depth_buffer && depths[k].is_some_and(|z| z != picture.depth[k]);
            found.depths += usize::from(depth_wrong);
            let stencil_wrong = stencils[k].zip(picture.stencil.get(k)).is_some_and(|(must, found)| must != *found);
            found.stencils += usize::from(stencil_wrong);
            let wrong = !shade.admits(colour);
            found.wrong += usize::from(wrong);
            if (wrong || depth_wrong) && found.first.is_none() {
                let (z, must) = (picture.depth[k], depths[k]);
                found.first = Some(format!("({i}, {j}): {colour:?} depth {z}, must be {shade:?} depth {must:?}"));
            }
            if shade.doubt {
                found.doubtful += 1;
            } else if shade.tolerance > 0.0 {
                found.drawn += 1;
                found.largest = found.largest.max(shade.error(colour));
                found.mean += (0..4).map(|c| (f64::from(colour[c]) - shade.colour[c]).abs()).sum::<f64>() / 4.0;
            }
        }
        found.mean /= found.drawn.max(1) as f64;
        found
    }
}
