//! A whole scene through a machine, line after line, into the frame.
//!
//! Duties: what the feeder does clock by clock (tokens in, refresh tokens held back until the bus is free, what
//! Zb begins the next line with), and what stands at the end of the buses: pixels shaded late by their tags,
//! depths stored where there is a Z buffer. Inputs: a scene that was held back. Outputs: frame buffer, Z buffer,
//! counts, and a waveform if one is wanted.
//!
//! The refresh token of a line sets Zb to what the next line begins with. For the first line that has been
//! done before the first token; it takes no clocks of its own, as the scene is still being collected then.

use super::array::Array;
use super::closed_form::TOKEN;
use super::element::{Elements, Rules};
use super::feeder::Feeder;
use super::super_buffer::{Slot, Specification, SuperBuffer};
use super::token::{Beat, Luminance, Pixel, Token};
use super::waves::Waves;
use super::{Machine, SystolicCounts};
use crate::geometry::plane::below;
use crate::hidden::held::{Depths, Held, HeldDraw, Item};
use crate::hidden::z_buffer::specification::colour_plane;
use crate::probe::account::Clocks;
use crate::shading::pixel::ShadingCounts;
use crate::shading::plane::ColourPlane;
use crate::shading::resolve::{LANES, PixelRow, Planes, Row16, Row32, resolve_row};
use fearless_simd::{Level, dispatch};
use zga_abi::format::PixelFormat;
use zga_firmware::Stopped;
use zga_firmware::checked::{SystolicSetting, Target};

/// Asks whether a scene that has taken so many clocks is to end.
pub type Stop<'a> = &'a dyn Fn(Clocks) -> Option<Stopped>;

/// Draws a scene with the clocked model that the target's variant names. Without a SIMD level the elements are stepped one by one, as they are specified. Before each line
/// `stop` is asked with the clocks so far; what it says ends the scene there, and comes back beside the counts.
pub fn draw_until(
    held: &Held,
    target: &Target,
    colour: &mut [u32],
    depth: Depths<'_>,
    level: Option<Level>,
    waves: Option<&mut Waves>,
    stop: Stop<'_>,
) -> (SystolicCounts, Option<Stopped>) {
    let below = below(target.depth_format);
    let (width, rules) = (target.colour.width, Rules { setting: target.systolic, below });
    let picture = Picture::new(held, target, colour, depth, level);
    // Lanes keep no stencil values.
    match (target.systolic.super_buffer, level.filter(|_| !picture.depth.stencil.is_kept())) {
        (false, Some(level)) => Run::begin(Array::new(width, rules, level), picture, waves, stop).array(),
        (false, None) => Run::begin(Elements::new(width, rules), picture, waves, stop).array(),
        (true, Some(level)) => Run::begin(SuperBuffer::new(width, below, level), picture, waves, stop).super_buffer(),
        (true, None) => Run::begin(Specification::new(width, below), picture, waves, stop).super_buffer(),
    }
}

/// Draws a whole scene.
#[cfg(test)]
pub fn draw_scene(
    held: &Held,
    target: &Target,
    colour: &mut [u32],
    depth: &mut [i32],
    level: Option<Level>,
    waves: Option<&mut Waves>,
) -> SystolicCounts {
    draw_until(held, target, colour, Depths::of(target, depth), level, waves, &|_| None).0
}

/// A scene on its way through a machine.
struct Run<'a, 'w, M> {
    machine: M,
    picture: Picture<'a>,
    waves: Option<&'w mut Waves>,
    /// Clocks so far.
    clock: u64,
    /// Elements.
    width: u32,
    height: u32,
    /// First clock in which a refresh token is at element 0, and the line it ends, for the last one that went in.
    refresh: Option<(u64, u32)>,
    tokens: u64,
    stop: Stop<'w>,
    stopped: Option<Stopped>,
}

impl<'a, 'w, M: Machine> Run<'a, 'w, M> {
    fn begin(mut machine: M, picture: Picture<'a>, waves: Option<&'w mut Waves>, stop: Stop<'w>) -> Self {
        let (width, height) = (picture.target.colour.width, picture.target.colour.height);
        for element in 0..width {
            machine.preset(element as usize, picture.initial_depth(element, 0));
            machine.preset_stencil(element as usize, picture.initial_stencil(element, 0));
        }
        let (clock, refresh, tokens, stopped) = (0, None, 0, None);
        let mut run = Run { machine, picture, waves, clock, width, height, refresh, tokens, stop, stopped };
        if let Some(waves) = &mut run.waves {
            waves.begin_scene::<M>(width);
        }
        run
    }

    /// Whether the scene ends here.
    fn stops(&mut self) -> bool {
        self.stopped = (self.stop)(Clocks(self.clock));
        self.stopped.is_some()
    }

    /// Begins line `y`.
    fn line_begins(&mut self, y: u32, tokens: usize) {
        self.tokens += tokens as u64;
        if let Some(waves) = &mut self.waves {
            waves.begin_line(y, self.clock);
        }
    }

    /// One clock.
    fn step(&mut self, port: M::Port) {
        // The element that the refresh token has come to, and what it begins the next line with.
        let place = self.refresh.and_then(|(begun, line)| {
            let element = self.clock.checked_sub(begun)?;
            (element < u64::from(self.width)).then_some((element as u32, line + 1))
        });
        let reset = place.map(|(element, line)| self.picture.initial_depth(element, line));
        if let Some((element, line)) = place.filter(|_| self.picture.depth.stencil.is_kept()) {
            self.machine.reset_stencil(self.picture.initial_stencil(element, line));
        }
        if let Some(waves) = &mut self.waves {
            waves.clock_begins(self.clock, &self.machine, &port);
        }
        let pixel = self.machine.clock(port, reset.unwrap_or(0));
        if let Some(waves) = &mut self.waves {
            waves.clock_ends(self.clock, pixel.as_ref());
        }
        if let Some(pixel) = pixel {
            self.picture.put(&pixel);
        }
        self.clock += 1;
    }

    /// Bubbles until clock `clock`.
    fn idle_until(&mut self, clock: u64) {
        while self.clock < clock {
            self.step(M::Port::default());
        }
    }

    fn counts(self, spans: u64, holes: ShadingCounts) -> (SystolicCounts, Option<Stopped>) {
        let target = self.picture.target;
        let pixels = u64::from(self.width) * u64::from(self.height);
        let depth = target.depth.is_some();
        let counts = SystolicCounts {
            tokens: self.tokens,
            clocks: self.clock,
            spans,
            reads: if depth && self.picture.held.background.depth.is_none() { pixels } else { 0 },
            writes: if depth { pixels } else { 0 },
            colours: self.picture.colours,
            shaded: self.picture.shaded,
            shading: self.picture.shading.plus(holes),
            stencil: self.machine.stencil_counts(),
        };
        (counts, self.stopped)
    }
}

impl<M: Machine<Port = Beat>> Run<'_, '_, M> {
    /// Through the systolic array.
    fn array(mut self) -> (SystolicCounts, Option<Stopped>) {
        let mut feeder = Feeder::new(self.picture.held, self.picture.target);
        let setting: SystolicSetting = self.picture.target.systolic;
        for y in 0..self.height {
            if self.stops() {
                break;
            }
            let tokens = feeder.line(y);
            self.line_begins(y, tokens.len());
            for token in tokens {
                token.beats(&setting).into_iter().for_each(|beat| self.step(beat));
            }
            // One pixel a clock on one bus: the refresh token before must be at the far end.
            let at_element_0 = TOKEN - 1;
            if let Some((before, _)) = self.refresh {
                self.idle_until(before - at_element_0 + u64::from(self.width));
            }
            // While T1 and T2 enter, the one before may still be at the last two elements.
            let refresh = Some((self.clock + at_element_0, y));
            let [t1, t2, t3] = Beat::REFRESH;
            self.step(t1);
            self.step(t2);
            self.refresh = refresh;
            self.step(t3);
        }
        if let Some((last, _)) = self.refresh {
            self.idle_until(last + u64::from(self.width));
        }
        self.counts(feeder.spans, feeder.shading)
    }
}

impl<M: Machine<Port = Slot>> Run<'_, '_, M> {
    /// Through the Super Buffer.
    fn super_buffer(mut self) -> (SystolicCounts, Option<Stopped>) {
        let mut feeder = Feeder::new(self.picture.held, self.picture.target);
        for y in 0..self.height {
            if self.stops() {
                break;
            }
            let tokens: &[Token] = feeder.line(y);
            self.line_begins(y, tokens.len());
            tokens.iter().for_each(|token| self.step(Slot::from(token)));
            self.refresh = Some((self.clock, y));
            self.step(Slot::REFRESH);
            self.idle_until(self.clock - 1 + 2 * u64::from(self.width));
        }
        self.counts(feeder.spans, feeder.shading)
    }
}

/// The far end of the buses: a line of pixels, and the surfaces it goes to.
struct Picture<'a> {
    held: &'a Held,
    target: &'a Target,
    colour: &'a mut [u32],
    depth: Depths<'a>,
    level: Option<Level>,
    /// The pixel that comes next: column, row.
    place: [u32; 2],
    /// Tags of the line's pixels, 0 where the background or a colour is seen; whole chunks.
    tags: Vec<u32>,
    /// Pixels of the line that came as colours.
    values: Vec<(u32, u32)>,
    seen: SeenPlanes<'a>,
    /// Colours written.
    colours: u64,
    /// Pixels shaded.
    shaded: u64,
    /// What they cost beyond interpolated colours.
    shading: ShadingCounts,
}

impl<'a> Picture<'a> {
    fn new(
        held: &'a Held,
        target: &'a Target,
        colour: &'a mut [u32],
        depth: Depths<'a>,
        level: Option<Level>,
    ) -> Picture<'a> {
        Picture {
            held,
            target,
            colour,
            depth,
            level,
            place: [0, 0],
            tags: vec![0; (target.colour.width as usize).next_multiple_of(LANES)],
            values: Vec::new(),
            seen: SeenPlanes::new(held),
            colours: 0,
            shaded: 0,
            shading: ShadingCounts::default(),
        }
    }

    /// Depth of pixel (`x`, `y`) before the scene; anything below the last line.
    fn initial_depth(&self, x: u32, y: u32) -> i32 {
        self.held.background.depth.or_else(|| self.depth.at(x, y)).unwrap_or(self.target.depth_format.maximum() as i32)
    }

    /// Stencil value of pixel (`x`, `y`) before the scene, if it asks for any.
    fn initial_stencil(&self, x: u32, y: u32) -> u8 {
        self.held.background.stencil.unwrap_or_else(|| self.depth.stencil.at(x, y))
    }

    /// The next pixel on the buses.
    fn put(&mut self, pixel: &Pixel) {
        let [x, y] = self.place;
        match pixel.luminance {
            Luminance::Background => {}
            Luminance::Tag(tag) => self.tags[x as usize] = tag,
            Luminance::Value(colour) => self.values.push((x, colour)),
        }
        if self.depth.pitch != 0 {
            self.depth.rows[y as usize * self.depth.pitch + x as usize] = pixel.depth;
        }
        self.depth.stencil.put(x, y, pixel.stencil);
        self.place = [x + 1, y];
        if x + 1 == self.target.colour.width {
            self.finish_line(y);
            self.place = [0, y + 1];
        }
    }

    /// Shades line `y` and writes it.
    fn finish_line(&mut self, y: u32) {
        let surface = &self.target.colour;
        let width = surface.width as usize;
        let pitch = surface.pitch as usize / 4;
        let words = &mut self.colour[y as usize * pitch..][..pitch];
        let line = Line { tags: &self.tags, values: &self.values, width, y, level: self.level };
        let background = self.held.background.colour.map(|colour| surface.format.encode(colour.to_le_bytes()));
        match surface.format {
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => {
                if let Some(pixel) = background {
                    words[..width].fill(pixel);
                }
                let opaque = if surface.format == PixelFormat::Xrgb8888 { 0xFF00_0000 } else { 0 };
                line.write(&mut Row32 { words, opaque }, &mut self.seen);
            }
            PixelFormat::Rgb565 => {
                let pixels: &mut [u16] = bytemuck::cast_slice_mut(words);
                if let Some(pixel) = background {
                    pixels[..width].fill(pixel as u16);
                }
                line.write(&mut Row16 { pixels }, &mut self.seen);
            }
        }
        let tags = || self.tags.iter().filter(|&&tag| tag != 0);
        for draw in tags().filter_map(|&tag| self.seen.draw(tag)).filter(|draw| draw.is_shaded()) {
            self.shaded += 1;
            self.shading = self.shading.plus(draw.cost());
        }
        let winners = tags().count() + self.values.len();
        self.colours += if background.is_some() { width } else { winners } as u64;
        self.tags.fill(0);
        self.values.clear();
    }
}

/// A line of pixels that is complete.
struct Line<'a> {
    tags: &'a [u32],
    values: &'a [(u32, u32)],
    width: usize,
    y: u32,
    level: Option<Level>,
}

impl Line<'_> {
    /// Writes what is not background.
    fn write(&self, row: &mut impl PixelRow, planes: &mut SeenPlanes<'_>) {
        let y = self.y as usize;
        match self.level {
            Some(level) => dispatch!(level, simd => resolve_row(simd, row, self.tags, 0, y, planes)),
            None => {
                let tags = self.tags[..self.width].iter().enumerate().filter(|(_, tag)| **tag != 0);
                tags.for_each(|(x, &tag)| row.put(x, planes.plane(tag).colour(x as i32, y as i32)));
            }
        }
        self.values.iter().for_each(|&(x, colour)| row.put(x as usize, colour));
    }
}

/// Colour planes of what is seen. Lines that follow one another see much the same primitives: the last plane
/// that was made for each remainder of the tags is kept.
struct SeenPlanes<'a> {
    held: &'a Held,
    tags: Vec<u32>,
    planes: Vec<ColourPlane>,
}

/// Planes that are kept.
const KEPT: usize = 1024;

impl<'a> SeenPlanes<'a> {
    fn new(held: &'a Held) -> SeenPlanes<'a> {
        SeenPlanes { held, tags: vec![0; KEPT], planes: vec![ColourPlane::flat(0); KEPT] }
    }

    fn item(&self, tag: u32) -> Option<&'a Item> {
        self.held.items.get((tag as usize).wrapping_sub(1))
    }

    /// The draw of an item.
    fn draw(&self, tag: u32) -> Option<&'a HeldDraw> {
        match self.item(tag) {
            Some(Item::Primitive(_, draw)) => Some(&self.held.draws[*draw as usize]),
            _ => None,
        }
    }

    fn make(&self, tag: u32) -> ColourPlane {
        match self.item(tag) {
            Some(Item::Primitive(shape, draw)) => colour_plane(shape, &self.held.draws[*draw as usize].shade()),
            Some(Item::Clear { colour, .. }) => ColourPlane::flat(colour.unwrap_or(0)),
            None => ColourPlane::flat(0),
        }
    }
}

impl Planes for SeenPlanes<'_> {
    type Plane = ColourPlane;

    fn plane(&mut self, tag: u32) -> &ColourPlane {
        let place = tag as usize % KEPT;
        if self.tags[place] != tag {
            self.planes[place] = self.make(tag);
            self.tags[place] = tag;
        }
        &self.planes[place]
    }
}
