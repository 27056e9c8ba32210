//! A card with a target: draws, reads back, counts.
//!
//! Video memory holds, each at a multiple of 4096: the ring, a gap, one or two frame buffers with a gap behind each, the
//! Z buffer, a gap, room for vertices, room for what comes back, room for textures and lights. Gaps and row ends are filled with canary words, which
//! nothing may change.

use super::depth;
use super::events::{Events, NAMES};
use super::hidden::{Hidden, Path};
use super::look::Look;
use super::options::{Feed, Options, Pixels, State, shadow_words};
use super::packet;
use super::picture::Picture;
use super::subpixel::Subpixel;
use crate::oracle::effects::Corner;
use crate::oracle::stencil::Shadow;
use crate::oracle::{Primitive, Vertex};
use std::time::Duration;
use zga_abi::Bus;
use zga_device::{Card, CardBus, CardOptions, Snapshot};

/// Words of the ring.
const RING_WORDS: u32 = 1 << 17;
/// Bytes between the buffers.
pub(super) const GAP: u32 = 4096;
/// What gaps and row ends hold.
const CANARY: u32 = 0x5AFE_C0DE;
/// Bytes of Za RAM: a word for each pixel of 1024 x 1024.
const ZA_RAM: u32 = 1 << 22;
/// Words that are queued before they are sent.
const QUEUE_WORDS: usize = 1 << 16;
/// Longer than any work of a test.
const PATIENCE: Duration = Duration::from_secs(120);

/// How vertices make primitives; the number is the packet's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topology {
    /// Three vertices each.
    Triangles = 0,
    /// Two vertices each.
    Lines = 1,
    /// One vertex each.
    Points = 2,
    /// One vertex each after the first.
    LineStrip = 3,
}

impl Topology {
    const fn vertices(self) -> usize {
        match self {
            Self::Triangles => 3,
            Self::Lines => 2,
            Self::Points | Self::LineStrip => 1,
        }
    }
}

/// A vertex as a packet carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RawVertex {
    /// x, y, z.
    pub position: [f32; 3],
    /// Red in 7:0.
    pub colour: u32,
}

/// Counters of the drawing units; nothing here depends on the way packets came.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Clocks of geometry, Z buffer, shading.
    pub clocks: [u64; 3],
    /// Vertices transformed.
    pub vertices: u64,
    /// Primitives that arrived.
    pub primitives: u64,
    /// Primitives that a clip plane cut.
    pub clipped: u64,
    /// Primitives dropped.
    pub discarded: u64,
    /// Runs of pixels of a triangle on a row.
    pub spans: u64,
    /// Depths compared.
    pub reads: u64,
    /// Depths written.
    pub writes: u64,
    /// Colours written.
    pub colours: u64,
    /// Colours interpolated.
    pub shaded: u64,
}

/// Places of the buffers, bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places {
    /// Of the frame drawn to.
    pub colour: u32,
    pub colours: [u32; 2],
    pub colour_pitch: u32,
    pub depth: u32,
    pub depth_pitch: u32,
    pub stencil: u32,
    pub stencil_pitch: u32,
    pub vertices: u32,
    /// For what comes back: a word a pixel.
    pub scratch: u32,
    /// For textures, palettes, lights.
    pub textures: u32,
}

/// A card and its target.
#[derive(Debug)]
pub struct Screen {
    card: Card,
    pub(super) bus: CardBus,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) options: Options,
    pub(super) places: Places,
    ring_put: u32,
    sequence: u32,
    in_scene: bool,
    state: Option<State>,
    /// What the registers of the effects hold; `None`: nobody knows.
    look: Option<Look>,
    queue: Vec<Vec<u32>>,
    queued: usize,
    next_id: u32,
}

impl Screen {
    /// Powers a card on and clears a target of `width` x `height` pixels.
    ///
    /// # Panics
    /// When the card does not come up.
    #[must_use]
    pub fn new(width: u32, height: u32, options: &Options) -> Self {
        let pitch = |bytes: u32| bytes.next_multiple_of(64);
        let (colour_pitch, depth_pitch) = (pitch(width * options.pixels.bytes()), pitch(width * 4));
        let colour = 4 * RING_WORDS + GAP;
        let frame = (colour_pitch * height).next_multiple_of(GAP) + GAP;
        let depth = colour + options.frames.clamp(1, 2) * frame;
        let stencil = (depth + depth_pitch * height).next_multiple_of(GAP) + GAP;
        let stencil_pitch = if options.stencil { pitch(width) } else { 0 };
        let vertices =
            if options.stencil { (stencil + stencil_pitch * height).next_multiple_of(GAP) + GAP } else { stencil };
        let scratch = (vertices + options.vertex_bytes).next_multiple_of(GAP);
        let textures = (scratch + 4 * width * height).next_multiple_of(GAP);
        let end = (textures + options.texture_bytes).next_multiple_of(GAP).max(1 << 20);
        let card = Card::power_on(CardOptions {
            video_memory: end,
            za_ram: ZA_RAM,
            threads: options.threads,
            kernel: options.kernel,
        });
        let card = card.expect("the card has power");
        let mut screen = Self {
            bus: card.bus(),
            card,
            width,
            height,
            options: *options,
            places: Places {
                colour,
                colours: [colour, colour + if options.frames == 2 { frame } else { 0 }],
                colour_pitch,
                depth,
                depth_pitch,
                stencil,
                stencil_pitch,
                vertices,
                scratch,
                textures,
            },
            ring_put: 0,
            sequence: 0,
            in_scene: false,
            state: None,
            look: Some(Look::default()),
            queue: Vec::new(),
            queued: 0,
            next_id: 1,
        };
        screen.fill_gaps();
        screen.start();
        screen.clear();
        if options.stencil {
            screen.clear_all_planes(None, None, Some(0), None);
        }
        screen
    }

    /// The depth format, and what else the card was built with.
    #[must_use]
    pub const fn options(&self) -> &Options {
        &self.options
    }

    /// Sets the registers that a reset clears.
    fn start(&mut self) {
        self.bus.write32(packet::INTERRUPT_ENABLE, packet::INTERRUPT_FENCE | packet::INTERRUPT_ERROR);
        self.bus.write32(packet::RING_BASE, 0);
        self.bus.write32(packet::RING_SIZE, RING_WORDS);
        (self.ring_put, self.state, self.in_scene) = (0, None, false);
        self.look = Some(Look::default());
        self.set_target();
    }

    /// Sets the registers that BEGIN_SCENE samples.
    fn set_target(&mut self) {
        let Places { colour, colour_pitch, depth, depth_pitch, .. } = self.places;
        let Options { pixels, depth: format, subpixel_bits, depth_buffer, .. } = self.options;
        let hidden = self.hidden();
        let depth_pitch = if depth_buffer { depth_pitch } else { 0 };
        let size = self.height << 16 | self.width;
        let format = format.bits | format.fraction << 8;
        let target = [size, colour, colour_pitch, pixels as u32, depth, depth_pitch, format];
        self.push(packet::registers(packet::TARGET, &target));
        if self.options.stencil {
            let plane = [self.places.stencil, self.places.stencil_pitch];
            self.push(packet::registers(packet::STENCIL_PLANE, &plane));
        }
        self.push(packet::registers(packet::PATH, &hidden.words(subpixel_bits)));
        self.push(packet::registers(packet::SUBPIXEL, &self.options.subpixel.words()));
    }

    /// The registers as they are for the frame drawn to.
    pub(super) const fn hidden(&self) -> Hidden {
        let (hidden, Places { colour, colours, .. }) = (self.options.hidden, self.places);
        if colour == colours[0] { hidden } else { hidden.of_second_frame(self.width, self.height) }
    }

    /// Ends the scene if one is open.
    pub fn end(&mut self) {
        if self.in_scene {
            self.push(packet::end_scene());
            self.in_scene = false;
        }
    }

    /// Has another path, or the same in another way, draw from the next scene on, with or without the Z buffer.
    pub fn set_hidden(&mut self, hidden: Hidden, depth_buffer: bool) {
        self.end();
        (self.options.hidden, self.options.depth_buffer) = (hidden, depth_buffer);
        self.set_target();
    }

    /// Has pixels have other samples, or the same in another way, from the next scene on.
    pub fn set_subpixel(&mut self, subpixel: Subpixel) {
        self.end();
        self.options.subpixel = subpixel;
        self.set_target();
    }

    /// Draws to another frame buffer from the next scene on.
    pub fn set_frame(&mut self, frame: usize) {
        self.end();
        self.places.colour = self.places.colours[frame];
        self.set_target();
    }

    /// Begins a scene unless one is open.
    pub fn open(&mut self) {
        self.begin(&self.state.unwrap_or_default());
    }

    /// Clears the whole target: black (identity 0) and the farthest depth. Identities begin anew.
    pub fn clear(&mut self) {
        let depth = self.options.has_depth().then(|| self.options.depth.greatest());
        self.clear_planes(Some(0), depth, None);
        self.next_id = 1;
    }

    /// Clears planes of a rectangle: left, top, right, bottom, the last two exclusive.
    pub fn clear_planes(&mut self, colour: Option<u32>, depth: Option<u32>, scissor: Option<[u32; 4]>) {
        self.clear_all_planes(colour, depth, None, scissor);
    }

    /// Clears planes of a rectangle, the stencil plane among them.
    pub fn clear_all_planes(
        &mut self,
        colour: Option<u32>,
        depth: Option<u32>,
        stencil: Option<u8>,
        scissor: Option<[u32; 4]>,
    ) {
        self.begin(&State { scissor, ..State::default() });
        self.push(packet::clear_with_stencil(colour, depth, stencil));
    }

    /// Sets what END_SCENE does with pixels in shadow.
    pub fn set_shadow(&mut self, shadow: Option<&Shadow>) {
        self.push(packet::registers(packet::SHADOW, &shadow_words(shadow)));
    }

    /// Draws primitives in their own colours.
    pub fn draw(&mut self, primitives: &[Primitive], state: &State) {
        self.draw_with(primitives, state, |vertex, _| u32::from_le_bytes(vertex.colour));
    }

    /// Draws primitives, each in a colour that tells its number since the last clear.
    pub fn draw_ids(&mut self, primitives: &[Primitive], state: &State) {
        let (first, pixels) = (self.next_id, self.options.pixels);
        self.next_id += primitives.len() as u32;
        self.draw_with(primitives, state, |_, number| pixels.colour_of(first + number));
    }

    fn draw_with(&mut self, primitives: &[Primitive], state: &State, colour: impl Fn(&Vertex, u32) -> u32) {
        let bits = self.options.depth.bits;
        let mut number = 0;
        for run in primitives.chunk_by(|a, b| topology(a) == topology(b)) {
            let mut vertices = Vec::with_capacity(3 * run.len());
            for primitive in run {
                vertices.extend(primitive.vertices().iter().map(|v| raw(v, bits, colour(v, number))));
                number += 1;
            }
            self.draw_raw(topology(&run[0]), &vertices, None, state);
        }
    }

    /// Draws vertices as they are, from the packet. Primitives are handed out over packets as `state.piece` says;
    /// strips and indexed draws go in one.
    pub fn draw_raw(&mut self, topology: Topology, vertices: &[RawVertex], indices: Option<&[u32]>, state: &State) {
        self.begin(state);
        let flags = topology as u32 | 0x100 | u32::from(indices.is_some()) << 4;
        let whole = indices.is_some() || topology == Topology::LineStrip;
        let fits = (RING_WORDS as usize - 64) / (4 * topology.vertices());
        let piece = if state.piece == 0 || whole { fits } else { state.piece.min(fits) };
        let piece = if whole { vertices.len().max(1) } else { piece * topology.vertices() };
        for part in vertices.chunks(piece) {
            let words = words_of(part);
            self.push(packet::draw_inline(flags, part.len() as u32, &words, indices.unwrap_or(&[])));
        }
    }

    /// Draws vertices with all that the state's look needs of them, from packets as `state.piece` says.
    pub fn draw_corners(&mut self, topology: Topology, corners: &[Corner], state: &State) {
        self.begin(state);
        let (normals, coordinates) = (state.look.light.is_some(), state.look.texture.is_some());
        let flags = topology as u32 | 0x100 | u32::from(normals) << 9 | u32::from(coordinates) << 10;
        let fits = (RING_WORDS as usize - 64) / (9 * topology.vertices());
        let piece = if state.piece == 0 { fits } else { state.piece.min(fits) };
        for part in corners.chunks(piece * topology.vertices()) {
            let mut words = Vec::with_capacity(9 * part.len());
            for corner in part {
                words.extend(corner.position.map(f32::to_bits));
                words.push(corner.colour);
                words.extend(corner.normal.iter().filter(|_| normals).map(|x| x.to_bits()));
                words.extend(corner.coordinates.iter().filter(|_| coordinates).map(|x| x.to_bits()));
            }
            self.push(packet::draw_inline(flags, part.len() as u32, &words, &[]));
        }
    }

    /// First byte of the region for textures and lights.
    #[must_use]
    pub const fn textures(&self) -> u32 {
        self.places.textures
    }

    /// Writes words to the region for textures and lights, from a byte of it on, when all before is done.
    ///
    /// # Panics
    /// When they do not fit `texture_bytes`.
    pub fn put_textures(&mut self, offset: u32, words: &[u32]) {
        assert!(offset + 4 * words.len() as u32 <= self.options.texture_bytes, "texture_bytes is too small");
        self.flush();
        self.bus.write_burst(packet::MEMORY + self.places.textures + offset, words);
    }

    /// EFFECTS_CALLED and UNITS_POWERED of the scene.
    pub fn called(&mut self) -> [u32; 2] {
        self.flush();
        [packet::EFFECTS_CALLED, packet::UNITS_POWERED].map(|at| self.bus.read32(at))
    }

    /// Draws vertices from video memory in one packet.
    ///
    /// # Panics
    /// When they do not fit `vertex_bytes`.
    pub fn draw_buffer(&mut self, topology: Topology, vertices: &[RawVertex], indices: Option<&[u32]>, state: &State) {
        let (at, words) = (self.places.vertices, words_of(vertices));
        let index_at = at + 4 * words.len() as u32;
        let list = indices.unwrap_or(&[]);
        assert!(index_at + 4 * list.len() as u32 <= self.places.scratch, "vertex_bytes is too small");
        self.flush();
        self.bus.write_burst(packet::MEMORY + at, &words);
        self.bus.write_burst(packet::MEMORY + index_at, list);
        self.begin(state);
        let flags = topology as u32 | 0x100 | u32::from(indices.is_some()) << 4;
        let index_at = if indices.is_some() { index_at } else { 0 };
        self.push(packet::draw_buffer(flags, at, vertices.len() as u32, index_at, list.len() as u32));
    }

    /// Ends the scene and reads the target back. What is cleared in Za RAM only is brought to memory for that.
    pub fn read(&mut self) -> Picture {
        self.end();
        if self.options.hidden.path == Path::Za {
            self.settle();
        }
        self.flush();
        let Places { colour, colours, colour_pitch, depth, depth_pitch, stencil, stencil_pitch, vertices, .. } =
            self.places;
        let first = colours[0] - GAP;
        let mut words = vec![0; ((vertices - first) / 4) as usize];
        self.bus.read_burst(packet::MEMORY + first, &mut words);
        let (width, height) = (self.width as usize, self.height as usize);
        let pixels = self.options.pixels;
        let word = |at: u32| ((at - first) / 4) as usize;
        let rows = |base: u32, pitch: u32| (0..height).map(move |j| word(base) + j * (pitch / 4) as usize);
        let (width_pixels, height_pixels) = (self.width, self.height);
        let mut picture = Picture {
            width: width_pixels,
            height: height_pixels,
            pixels,
            colour: vec![],
            depth: vec![],
            stencil: vec![],
            strays: 0,
        };
        // Pixels are taken out; what is left must be canaries.
        for start in rows(colour, colour_pitch) {
            for x in 0..width {
                picture.colour.push(take_pixel(&mut words, start, x, pixels));
            }
        }
        for other in colours.into_iter().filter(|&other| other != colour) {
            for start in rows(other, colour_pitch) {
                for x in 0..width {
                    let _ = take_pixel(&mut words, start, x, pixels);
                }
            }
        }
        for start in rows(depth, depth_pitch) {
            picture.depth.extend(&words[start..start + width]);
            words[start..start + width].fill(CANARY);
        }
        if stencil_pitch != 0 {
            for start in rows(stencil, stencil_pitch) {
                for x in 0..width {
                    let (word, shift) = (&mut words[start + x / 4], 8 * (x % 4));
                    picture.stencil.push((*word >> shift) as u8);
                    *word = *word & !(0xFF << shift) | CANARY & (0xFF << shift);
                }
            }
        }
        picture.strays = words.iter().filter(|&&word| word != CANARY).count();
        picture
    }

    /// All counters since [`Screen::clear_counts`].
    pub fn events(&mut self) -> Events {
        self.flush();
        let mut events = Events([0; NAMES.len()]);
        for (at, value) in (packet::COUNTERS..).step_by(8).zip(&mut events.0) {
            *value = u64::from(self.bus.read32(at)) | u64::from(self.bus.read32(at + 4)) << 32;
        }
        events
    }

    /// Counts of the drawing units since [`Screen::clear_counts`].
    pub fn counts(&mut self) -> Counts {
        let events = self.events();
        let counter = |index: usize| events.0[index];
        Counts {
            clocks: [2, 3, 4].map(counter),
            vertices: counter(10),
            primitives: counter(11),
            clipped: counter(12),
            discarded: counter(13),
            spans: counter(14),
            reads: counter(15),
            writes: counter(16),
            colours: counter(17),
            shaded: counter(18),
        }
    }

    /// Sets all counters to 0.
    pub fn clear_counts(&mut self) {
        self.flush();
        self.bus.write32(packet::COUNTER_CONTROL, 1);
    }

    /// Resets the card and sets its registers again; memory stays.
    pub fn reset(&mut self) {
        self.flush();
        self.bus.write32(packet::RESET, 1);
        self.start();
    }

    /// Everything the card holds.
    ///
    /// # Panics
    /// When the card is gone.
    pub fn snapshot(&mut self) -> Snapshot {
        self.flush();
        self.card.snapshot().expect("the card is there")
    }

    /// Puts the card, and what this harness knows of it, back to a snapshot that this or a like screen took with
    /// nothing but draws since.
    ///
    /// # Panics
    /// When the snapshot is of another card.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.flush();
        self.card.restore(snapshot).expect("a snapshot of such a card");
        self.ring_put = self.bus.read32(packet::RING_PUT);
        (self.state, self.look) = (None, None);
        // STATUS: between begin scene and end scene.
        self.in_scene = self.bus.read32(0x0044) & 8 != 0;
    }

    /// Opens the scene and sets the state where they are not yet.
    fn begin(&mut self, state: &State) {
        if self.state != Some(*state) {
            self.push(packet::registers(packet::DRAW_STATE, &state.words()));
            self.push(packet::registers(packet::GEOMETRY, &state.camera.words()));
            if let Some(stencil) = &state.stencil {
                self.push(packet::registers(packet::STENCIL, &State::stencil_words(stencil)));
            }
            if self.look != Some(state.look) {
                self.set_look(&state.look);
            }
            self.state = Some(*state);
        }
        if !self.in_scene {
            self.push(packet::begin_scene());
            self.in_scene = true;
        }
    }

    fn set_look(&mut self, look: &Look) {
        let region = self.places.textures;
        self.push(packet::registers(packet::TEXTURE, &look.texture_words(region)));
        self.push(packet::registers(packet::FOG, &look.fog_words()));
        self.push(packet::registers(packet::LIGHT, &look.light_words(region)));
        self.look = Some(*look);
    }

    pub(super) fn push(&mut self, packet: Vec<u32>) {
        if self.queued + packet.len() > QUEUE_WORDS {
            self.flush();
        }
        self.queued += packet.len();
        self.queue.push(packet);
    }

    /// Sends what is queued and waits until it is done.
    ///
    /// # Panics
    /// When the card refuses a packet or does not come to an end.
    pub fn flush(&mut self) {
        self.sequence += 1;
        self.queue.push(packet::fence(self.sequence));
        let stream = std::mem::take(&mut self.queue).concat();
        self.queued = 0;
        match self.options.feed {
            Feed::Fifo => self.bus.write_burst(packet::FIFO, &stream),
            Feed::Ring => {
                assert!(stream.len() < RING_WORDS as usize, "{} words do not fit the ring", stream.len());
                let room = (RING_WORDS - self.ring_put) as usize;
                let (first, rest) = stream.split_at(room.min(stream.len()));
                self.bus.write_burst(packet::MEMORY + 4 * self.ring_put, first);
                self.bus.write_burst(packet::MEMORY, rest);
                self.ring_put = (self.ring_put + stream.len() as u32) % RING_WORDS;
                self.bus.write32(packet::RING_PUT, self.ring_put);
                self.bus.write32(packet::DOORBELL, 1);
            }
        }
        let sequence = self.sequence;
        while self.bus.read32(packet::FENCE_SEQUENCE) != sequence {
            let raised = self.bus.wait_interrupt(packet::INTERRUPT_FENCE | packet::INTERRUPT_ERROR, PATIENCE);
            self.bus.write32(packet::INTERRUPT_STATUS, packet::INTERRUPT_FENCE);
            let error = [0, 4, 8, 12, 16, 20].map(|k| self.bus.read32(packet::ERROR_CODE + k));
            assert!(raised != 0 && error[0] == 0, "the card stands still: error registers {error:x?}");
        }
        assert_eq!(self.bus.read32(packet::ERROR_CODE), 0, "a packet was refused");
    }

    fn fill_gaps(&mut self) {
        let from = self.places.colours[0] - GAP;
        let words = vec![CANARY; ((self.places.vertices - from) / 4) as usize];
        self.bus.write_burst(packet::MEMORY + from, &words);
    }
}

/// Takes pixel `x` out of the row that begins at word `start`, and puts the canary's bits in its place.
fn take_pixel(words: &mut [u32], start: usize, x: usize, pixels: Pixels) -> u32 {
    if pixels != Pixels::Rgb565 {
        return std::mem::replace(&mut words[start + x], CANARY);
    }
    let (word, shift) = (&mut words[start + x / 2], 16 * (x % 2));
    let pixel = *word >> shift & 0xFFFF;
    *word = *word & !(0xFFFF << shift) | CANARY & (0xFFFF << shift);
    pixel
}

const fn topology(primitive: &Primitive) -> Topology {
    match primitive {
        Primitive::Triangle(_) => Topology::Triangles,
        Primitive::Line(_) => Topology::Lines,
        Primitive::Point(_) => Topology::Points,
    }
}

/// An oracle's vertex as a packet carries it under the identity camera.
///
/// # Panics
/// When the depth has no f32: take it through [`depth::survivor`] first.
#[must_use]
pub fn raw(vertex: &Vertex, bits: u32, colour: u32) -> RawVertex {
    let z = depth::encode(vertex.z, bits).unwrap_or_else(|| panic!("depth {} of {bits} bits has no f32", vertex.z));
    RawVertex { position: [vertex.x as f32 / 256.0, vertex.y as f32 / 256.0, z], colour }
}

fn words_of(vertices: &[RawVertex]) -> Vec<u32> {
    let words = |v: &RawVertex| [v.position[0].to_bits(), v.position[1].to_bits(), v.position[2].to_bits(), v.colour];
    vertices.iter().flat_map(words).collect()
}
