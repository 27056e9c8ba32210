//! Registers and packets of the card, restated from the manual.

/// Soft reset.
pub const RESET: u32 = 0x0040;
/// Interrupts that have occurred; writing 1 clears.
pub const INTERRUPT_STATUS: u32 = 0x0080;
/// Interrupts that reach the host.
pub const INTERRUPT_ENABLE: u32 = 0x0084;
/// Why a packet was refused; 0 is no error. The words behind it: source, offset, header, word, value.
pub const ERROR_CODE: u32 = 0x0088;
/// First byte of the ring.
pub const RING_BASE: u32 = 0x0100;
/// Words of the ring.
pub const RING_SIZE: u32 = 0x0104;
/// Word offset after the last word written.
pub const RING_PUT: u32 = 0x0108;
/// Makes the card look at [`RING_PUT`].
pub const DOORBELL: u32 = 0x0110;
/// Number of the last fence executed.
pub const FENCE_SEQUENCE: u32 = 0x0140;
/// Size, colour base, pitch, format, depth base, pitch, format.
pub const TARGET: u32 = 0x0200;
/// Stencil plane: base, pitch.
pub const STENCIL_PLANE: u32 = 0x021C;
/// Hidden-surface path, sub-pixel bits, fidelity, Za block, prediction and base, systolic variant, tile size.
pub const PATH: u32 = 0x0240;
/// Sub-pixel grid, depth, resolve and pool.
pub const SUBPIXEL: u32 = 0x0260;
/// Effects, depth control, material colour, tag, scissor minimum, scissor maximum, line width, point size.
pub const DRAW_STATE: u32 = 0x0280;
/// Texture: base, size, control, offset, window, colour, bias, palette; punch-through reference; blend mode.
pub const TEXTURE: u32 = 0x0300;
/// Stencil test: control, value.
pub const STENCIL: u32 = 0x0328;
/// Shadow bit: control, intensity.
pub const SHADOW: u32 = 0x0380;
/// Fog: function, density, end, depth cue scale and offset, colour.
pub const FOG: u32 = 0x0330;
/// Light: control, base, count, scene ambient, specular, emission, shininess.
pub const LIGHT: u32 = 0x0350;
/// Object to eye, decal, eye to clip (16 each), viewport (6).
pub const GEOMETRY: u32 = 0x0400;
/// Pixel history: control, pixel, base, size.
pub const PROBE: u32 = 0x0600;
/// The frame shown: base, pitch, format, size.
pub const SCANOUT: u32 = 0x0688;
/// Effects that the card has.
pub const CAPABILITY_EFFECTS: u32 = 0x0008;
/// Effects called since begin scene.
pub const EFFECTS_CALLED: u32 = 0x0700;
/// Units powered since begin scene.
pub const UNITS_POWERED: u32 = 0x0704;
/// 1 clears the counters.
pub const COUNTER_CONTROL: u32 = 0x0708;
/// Counters, low word first.
pub const COUNTERS: u32 = 0x1000;
/// The PIO FIFO window.
pub const FIFO: u32 = 0x8000;
/// Za RAM.
pub const ZA: u32 = 0x0200_0000;
/// Video memory.
pub const MEMORY: u32 = 0x4000_0000;
/// The fence interrupt.
pub const INTERRUPT_FENCE: u32 = 1;
/// The interrupt of a packet that was refused.
pub const INTERRUPT_ERROR: u32 = 4;

/// Effect: depth test.
pub const EFFECT_DEPTH: u32 = 1;
/// Effect: colours interpolated.
pub const EFFECT_GOURAUD: u32 = 2;
/// Effect: perspective-correct.
pub const EFFECT_PERSPECTIVE: u32 = 4;
/// Effect: depth through the decal matrix.
pub const EFFECT_DECAL: u32 = 8;
/// Effect: texture.
pub const EFFECT_TEXTURE: u32 = 0x10;
/// Effect: levels of a texture.
pub const EFFECT_MIP_MAP: u32 = 0x20;
/// Effect: lights and materials.
pub const EFFECT_LIGHT: u32 = 0x40;
/// Effect: fog and depth cueing.
pub const EFFECT_FOG: u32 = 0x80;
/// Effect: holes where texels say so.
pub const EFFECT_PUNCH_THROUGH: u32 = 0x200;
/// Effect: translucent layers.
pub const EFFECT_BLEND: u32 = 0x100;
/// Effect: stencil test.
pub const EFFECT_STENCIL: u32 = 0x800;
/// Effect: sub-pixel masks.
pub const EFFECT_ANTI_ALIAS: u32 = 0x400;

/// A packet: opcode in 31:24, number of payload words in 19:0, payload.
#[must_use]
pub fn packet(opcode: u32, payload: &[u32]) -> Vec<u32> {
    assert!(payload.len() < 1 << 20, "the payload does not fit a packet");
    [&[opcode << 24 | payload.len() as u32], payload].concat()
}

/// REGISTER_WRITE from a byte offset upward.
#[must_use]
pub fn registers(offset: u32, values: &[u32]) -> Vec<u32> {
    packet(0x01, &[&[offset], values].concat())
}

/// BEGIN_SCENE.
#[must_use]
pub fn begin_scene() -> Vec<u32> {
    packet(0x02, &[])
}

/// END_SCENE.
#[must_use]
pub fn end_scene() -> Vec<u32> {
    packet(0x03, &[])
}

/// CLEAR of frame buffer, Z buffer or both.
#[must_use]
pub fn clear(colour: Option<u32>, depth: Option<u32>) -> Vec<u32> {
    let planes = u32::from(colour.is_some()) | u32::from(depth.is_some()) << 1;
    packet(0x04, &[planes, colour.unwrap_or(0), depth.unwrap_or(0)])
}

/// CLEAR of frame buffer, Z buffer and stencil plane, or some of them.
#[must_use]
pub fn clear_with_stencil(colour: Option<u32>, depth: Option<u32>, stencil: Option<u8>) -> Vec<u32> {
    let mut words = clear(colour, depth);
    words[1] |= stencil.map_or(0, |value| 4 | u32::from(value) << 8);
    words
}

/// DRAW_INLINE.
#[must_use]
pub fn draw_inline(flags: u32, vertices: u32, words: &[u32], indices: &[u32]) -> Vec<u32> {
    packet(0x10, &[&[flags, vertices, indices.len() as u32], words, indices].concat())
}

/// DRAW_BUFFER.
#[must_use]
pub fn draw_buffer(flags: u32, address: u32, vertices: u32, index_address: u32, indices: u32) -> Vec<u32> {
    packet(0x11, &[flags, address, vertices, index_address, indices])
}

/// FILL of a rectangle x, y, width, height.
#[must_use]
pub fn fill(base: u32, pitch: u32, format: u32, area: [u32; 4], value: u32) -> Vec<u32> {
    packet(0x20, &[&[base, pitch, format][..], &area, &[value]].concat())
}

/// COPY of a rectangle x, y, width, height of a surface to another place in it.
#[must_use]
pub fn copy(base: u32, pitch: u32, format: u32, area: [u32; 4], to: [u32; 2]) -> Vec<u32> {
    let [x, y, width, height] = area;
    packet(0x21, &[format, base, pitch, x, y, base, pitch, to[0], to[1], width, height])
}

/// UPLOAD of one row.
#[must_use]
pub fn upload(address: u32, words: &[u32]) -> Vec<u32> {
    let count = words.len() as u32;
    packet(0x22, &[&[address, 4 * count, count, 1], words].concat())
}

/// DOWNLOAD of rows of words to a dense run.
#[must_use]
pub fn download(address: u32, pitch: u32, words: u32, rows: u32, destination: u32) -> Vec<u32> {
    packet(0x23, &[address, pitch, words, rows, destination])
}

/// WRITE_BACK.
#[must_use]
pub fn write_back(destination: u32) -> Vec<u32> {
    packet(0x32, &[destination])
}

/// FENCE.
#[must_use]
pub fn fence(sequence: u32) -> Vec<u32> {
    packet(0x30, &[sequence])
}
