//! The register map. Every register stands here once; [`Reg`] names it, [`Reg::info`] tells all of it.

use crate::register::{Access, Field, Register, registers};

/// Bits of f32 1.0.
const ONE: u32 = 0x3F80_0000;
/// A 4x4 identity matrix, row-major, as f32 bits.
const IDENTITY: &[u32] = &[ONE, 0, 0, 0, 0, ONE, 0, 0, 0, 0, ONE, 0, 0, 0, 0, ONE];

registers! {
    // Identification -------------------------------------------------------------------------
    /// Says that a ZGA card answers here: ASCII "ZGA1".
    Identification "IDENTIFICATION" @ 0x0000 [1] ReadOnly reset &[crate::IDENTIFICATION], writable 0, w1c 0, {}
    /// Version of registers and packets; a driver refuses a major version it does not know.
    Revision "REVISION" @ 0x0004 [1] ReadOnly reset &[crate::ABI_VERSION], writable 0, w1c 0, {
        31:16 "major" "incompatible changes";
        15:0 "minor" "additions";
    }
    /// Effects that this card has a unit for; bits as in EFFECTS.
    CapabilityEffects "CAPABILITY_EFFECTS" @ 0x0008 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Hidden-surface paths that this card has; bit k stands for value k of HIDDEN_SURFACE.
    CapabilityPaths "CAPABILITY_PATHS" @ 0x000C [1] ReadOnly reset &[0], writable 0, w1c 0, {
        3:3 "tile" "8x8 tiles found by a Y then X sort";
        2:2 "systolic" "systolic scan-line array";
        1:1 "za" "Z buffer with one status word for each block";
        0:0 "zbuffer" "plain Z buffer";
    }
    /// Video memory behind the window, in bytes; chosen at power-on.
    VideoMemorySize "VIDEO_MEMORY_SIZE" @ 0x0010 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Za RAM behind the window, in bytes; chosen at power-on.
    ZaRamSize "ZA_RAM_SIZE" @ 0x0014 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Depth of the PIO FIFO in words.
    FifoDepth "FIFO_DEPTH" @ 0x0018 [1] ReadOnly reset &[crate::bus::FIFO_WORDS], writable 0, w1c 0, {}

    // Control --------------------------------------------------------------------------------
    /// Soft reset: stops work, empties FIFO and ring, ends a scene, sets registers to their reset values, keeps both memories. The write returns when it is done.
    Reset "RESET" @ 0x0040 [1] WriteOnly reset &[0], writable 1, w1c 0, {
        0:0 "reset" "1 resets";
    }
    /// What the card is doing.
    Status "STATUS" @ 0x0044 [1] ReadOnly reset &[0], writable 0, w1c 0, {
        3:3 "in_scene" "between begin scene and end scene";
        2:2 "fifo_halted" "an error stopped the FIFO; a reset starts it again";
        1:1 "ring_halted" "an error stopped the ring; a reset starts it again";
        0:0 "busy" "packets are being executed or wait";
    }
    /// Longest a packet may take, in units of 2^20 clocks; 0 is no limit. A packet over it ends with the fault WATCHDOG.
    Watchdog "WATCHDOG" @ 0x0048 [1] ReadWrite reset &[0x0001_0000], writable 0xFFFF_FFFF, w1c 0, {}
    /// Does nothing; for a driver to see whether writes arrive.
    Scratch "SCRATCH" @ 0x004C [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {}

    // Interrupts and errors ------------------------------------------------------------------
    /// Interrupts that have occurred, enabled or not.
    InterruptStatus "INTERRUPT_STATUS" @ 0x0080 [1] WriteOneToClear reset &[0], writable 0, w1c 0x7, {
        2:2 "error" "a packet was refused";
        1:1 "vertical_blank" "a vertical blank began";
        0:0 "fence" "a fence was executed";
    }
    /// Interrupts that reach the host; bits as in INTERRUPT_STATUS.
    InterruptEnable "INTERRUPT_ENABLE" @ 0x0084 [1] ReadWrite reset &[0], writable 0x7, w1c 0, {}
    /// Why the packet was refused: a fault code (0 = no error since reset).
    ErrorCode "ERROR_CODE" @ 0x0088 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Where the refused packet came from.
    ErrorSource "ERROR_SOURCE" @ 0x008C [1] ReadOnly reset &[0], writable 0, w1c 0, {
        1:0 "source" "0 none, 1 ring, 2 FIFO";
    }
    /// Where the refused packet begins: word offset in the ring, or the number of FIFO words taken before it (modulo 2^32).
    ErrorOffset "ERROR_OFFSET" @ 0x0090 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Header word of the refused packet.
    ErrorPacket "ERROR_PACKET" @ 0x0094 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Which word of the packet is at fault; 0 is the header.
    ErrorWord "ERROR_WORD" @ 0x0098 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// The value found there, or the value derived from it that broke the rule.
    ErrorValue "ERROR_VALUE" @ 0x009C [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Accesses to addresses where nothing is; saturates.
    BusUnmapped "BUS_UNMAPPED" @ 0x00A0 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Writes to read-only registers; saturates.
    BusReadOnly "BUS_READ_ONLY" @ 0x00A4 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Accesses whose address is not a multiple of 4; saturates.
    BusMisaligned "BUS_MISALIGNED" @ 0x00A8 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Words written to a FIFO that an error has halted; saturates. They are not executed.
    BusRejected "BUS_REJECTED" @ 0x00AC [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Address of the last access counted in BUS_UNMAPPED, BUS_READ_ONLY or BUS_MISALIGNED.
    BusFaultAddress "BUS_FAULT_ADDRESS" @ 0x00B0 [1] ReadOnly reset &[0], writable 0, w1c 0, {}

    // FIFO, ring, fence ----------------------------------------------------------------------
    /// Words that can be written to the FIFO now without a stall.
    FifoFree "FIFO_FREE" @ 0x00C0 [1] ReadOnly reset &[crate::bus::FIFO_WORDS], writable 0, w1c 0, {}
    /// First byte of the command ring in video memory, a multiple of 4096. Writing it sets RING_GET and RING_PUT to 0.
    RingBase "RING_BASE" @ 0x0100 [1] ReadWrite reset &[0], writable 0xFFFF_F000, w1c 0, {}
    /// Size of the ring in words, a power of two from 256 to 2^20; 0 is no ring. Writing it sets RING_GET and RING_PUT to 0.
    RingSize "RING_SIZE" @ 0x0104 [1] ReadWrite reset &[0], writable 0x001F_FFFF, w1c 0, {}
    /// Word offset after the last word the driver has written; owned by the driver. Always the end of a packet. The ring is empty when it equals RING_GET and full when one word is left: RING_PUT + 1 = RING_GET (modulo the size).
    RingPut "RING_PUT" @ 0x0108 [1] ReadWrite reset &[0], writable 0x000F_FFFF, w1c 0, {}
    /// Word offset of the next packet; owned by the card.
    RingGet "RING_GET" @ 0x010C [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Any write makes the card look at RING_PUT.
    Doorbell "DOORBELL" @ 0x0110 [1] WriteOnly reset &[0], writable 0xFFFF_FFFF, w1c 0, {}
    /// Sequence number of the last fence executed.
    FenceSequence "FENCE_SEQUENCE" @ 0x0140 [1] ReadOnly reset &[0], writable 0, w1c 0, {}

    // Target: sampled by begin scene ---------------------------------------------------------
    /// Size of the picture drawn to.
    TargetSize "TARGET_SIZE" @ 0x0200 [1] ReadWrite reset &[0], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "height" "pixels, 1..=16384";
        14:0 "width" "pixels, 1..=16384";
    }
    /// First byte of the frame buffer in video memory, a multiple of 64.
    ColourBase "COLOUR_BASE" @ 0x0204 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Bytes from one row of the frame buffer to the next, a multiple of 64.
    ColourPitch "COLOUR_PITCH" @ 0x0208 [1] ReadWrite reset &[0], writable 0x000F_FFC0, w1c 0, {}
    /// Format of a frame buffer pixel.
    ColourFormat "COLOUR_FORMAT" @ 0x020C [1] ReadWrite reset &[0], writable 0x3, w1c 0, {
        1:0 "format" "0 XRGB8888, 1 ARGB8888, 2 RGB565";
    }
    /// First byte of the Z buffer in video memory, a multiple of 64. One 32-bit word a pixel.
    DepthBase "DEPTH_BASE" @ 0x0210 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Bytes from one row of the Z buffer to the next, a multiple of 64.
    DepthPitch "DEPTH_PITCH" @ 0x0214 [1] ReadWrite reset &[0], writable 0x000F_FFC0, w1c 0, {}
    /// Number format of depth.
    DepthFormat "DEPTH_FORMAT" @ 0x0218 [1] ReadWrite reset &[0x0000_1818], writable 0x0000_1F1F, w1c 0, {
        12:8 "fraction" "fraction bits of the gradients: 0, 8, 16 or 24";
        4:0 "bits" "bits of a depth: 16, 24 or 31";
    }
    /// First byte of the stencil plane in video memory, a multiple of 64. One byte a pixel.
    StencilBase "STENCIL_BASE" @ 0x021C [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Bytes from one row of the stencil plane to the next, a multiple of 64; 0 is no plane, and no draw may call for the effect `stencil`.
    StencilPitch "STENCIL_PITCH" @ 0x0220 [1] ReadWrite reset &[0], writable 0x000F_FFC0, w1c 0, {}

    // Path and accuracy: sampled by begin scene ----------------------------------------------
    /// Hidden-surface path that decides visibility.
    HiddenSurface "HIDDEN_SURFACE" @ 0x0240 [1] ReadWrite reset &[0], writable 0x3, w1c 0, {
        1:0 "path" "0 zbuffer, 1 za, 2 systolic, 3 tile; CAPABILITY_PATHS says which exist";
    }
    /// Bits of a pixel that coordinates are snapped to.
    SubpixelBits "SUBPIXEL_BITS" @ 0x0244 [1] ReadWrite reset &[8], writable 0xF, w1c 0, {
        3:0 "bits" "4 or 8";
    }

    /// How units that have a clocked model (Za unit, systolic array, tile unit, search of the sub-pixel unit) are simulated. Pixels, counters and clocks do not depend on it.
    Fidelity "FIDELITY" @ 0x0248 [1] ReadWrite reset &[0], writable 0x1, w1c 0, {
        0:0 "fidelity" "0 functional, 1 clocked";
    }
    /// Block of pixels that shares a Za word.
    ZaBlock "ZA_BLOCK" @ 0x024C [1] ReadWrite reset &[0x0001_0020], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "height" "pixels, 1..=16384";
        14:0 "width" "pixels, 1..=16384";
    }
    /// How the Za unit predicts the least depth of a primitive in a block.
    ZaPrediction "ZA_PREDICTION" @ 0x0250 [1] ReadWrite reset &[0], writable 0x103, w1c 0, {
        8:8 "no_bypass" "1: no block is bypassed, whatever is predicted";
        1:0 "prediction" "0 block-length, 1 covered-run, 2 plane";
    }
    /// First byte of the frame's words in Za RAM, a multiple of 64. Frames with areas of their own keep their logical clears apart.
    ZaBase "ZA_BASE" @ 0x0254 [1] ReadWrite reset &[0], writable 0x01FF_FFC0, w1c 0, {}
    /// Variant of the systolic array.
    SystolicVariant "SYSTOLIC_VARIANT" @ 0x0258 [1] ReadWrite reset &[0], writable 0xF, w1c 0, {
        3:3 "super_buffer" "1: the earlier design: a token a clock, refresh data flow back";
        2:2 "colour" "token carries 0 a tag, 1 the colour where it is flat";
        1:1 "ports" "0 dX on port B at T1 only, 1 X and dX merged on port A";
        0:0 "end_test" "a segment begins or ends where A - 1 is 0 negative, 1 zero";
    }
    /// Size of a tile of the tile unit.
    TileSize "TILE_SIZE" @ 0x025C [1] ReadWrite reset &[0x0008_0008], writable 0x007F_007F, w1c 0, {
        22:16 "height" "pixels: 4, 8, 16, 32 or 64";
        6:0 "width" "pixels: 4, 8, 16, 32 or 64";
    }
    /// Samples of a pixel. With a grid the scene is anti-aliased: its draws may call for the effect `anti_alias`.
    SubpixelGrid "SUBPIXEL_GRID" @ 0x0260 [1] ReadWrite reset &[0], writable 0x3, w1c 0, {
        1:0 "grid" "columns x rows: 0 off, 1 4x4, 2 8x4, 3 8x8";
    }
    /// How fragments of a pixel that share samples are ordered.
    SubpixelDepth "SUBPIXEL_DEPTH" @ 0x0264 [1] ReadWrite reset &[1], writable 0x3, w1c 0, {
        1:0 "depth" "0 centre: by the depth at the pixel's centre; 1 search: by the range of depths that searches of the mask find, sample by sample where ranges overlap; 2 exhaustive: sample by sample";
    }
    /// Space in which the samples of a pixel are averaged and layers composed.
    SubpixelResolve "SUBPIXEL_RESOLVE" @ 0x0268 [1] ReadWrite reset &[0], writable 0x1, w1c 0, {
        0:0 "resolve" "0 values: of the frame buffer's values; 1 linear: of linear light, through the sRGB curve";
    }
    /// Fragments that the lists of one line of pixels have room for, 1..=2^20. Pixels that find none keep one sample.
    SubpixelPool "SUBPIXEL_POOL" @ 0x026C [1] ReadWrite reset &[0x0010_0000], writable 0x001F_FFFF, w1c 0, {
        20:0 "fragments" "1..=1048576, 16 bytes each";
    }
    /// Which edges are anti-aliased.
    SubpixelEdges "SUBPIXEL_EDGES" @ 0x0270 [1] ReadWrite reset &[0], writable 0x1, w1c 0, {
        0:0 "edges" "0 all: those of every triangle; 1 borders: those that a triangle does not share with another of its surface. What lies inside a surface keeps one sample";
    }

    // Draw state: sampled by each draw -------------------------------------------------------
    /// Effects the draws that follow call for.
    Effects "EFFECTS" @ 0x0280 [1] ReadWrite reset &[0x1], writable 0x0000_0FFF, w1c 0, {
        11:11 "stencil" "stencil test";
        10:10 "anti_alias" "sub-pixel masks";
        9:9 "punch_through" "texels decide visibility";
        8:8 "blend" "translucency";
        7:7 "fog" "fog and depth cueing";
        6:6 "light" "lights and materials";
        5:5 "mip_map" "MIP-mapped texture";
        4:4 "texture" "texture";
        3:3 "decal" "surface marking: depth through the DECAL matrix";
        2:2 "perspective" "colours interpolated perspective-correct";
        1:1 "gouraud" "colours interpolated between vertices; else the first vertex's colour";
        0:0 "depth" "depth test";
    }
    /// Depth test.
    DepthControl "DEPTH_CONTROL" @ 0x0284 [1] ReadWrite reset &[0x0000_0101], writable 0x0000_0107, w1c 0, {
        8:8 "write" "1: a passing fragment's depth is stored";
        2:0 "function" "0 never, 1 less, 2 equal, 3 less-equal, 4 greater, 5 not-equal, 6 greater-equal, 7 always";
    }
    /// Colour of primitives whose vertices carry none.
    MaterialColour "MATERIAL_COLOUR" @ 0x0288 [1] ReadWrite reset &[0xFFFF_FFFF], writable 0xFFFF_FFFF, w1c 0, {
        31:24 "alpha" "255 opaque";
        23:16 "blue" "";
        15:8 "green" "";
        7:0 "red" "";
    }
    /// Object the draws that follow belong to; shown by the probe. The sub-pixel unit merges fragments of one.
    ObjectTag "OBJECT_TAG" @ 0x028C [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {}
    /// First pixel inside the scissor.
    ScissorMinimum "SCISSOR_MINIMUM" @ 0x0290 [1] ReadWrite reset &[0], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "y" "pixels, inclusive";
        14:0 "x" "pixels, inclusive";
    }
    /// First pixel beyond the scissor; the target's size cuts it.
    ScissorMaximum "SCISSOR_MAXIMUM" @ 0x0294 [1] ReadWrite reset &[0x7FFF_7FFF], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "y" "pixels, exclusive";
        14:0 "x" "pixels, exclusive";
    }
    /// Width of lines that are drawn with the effect `anti_alias`.
    LineWidth "LINE_WIDTH" @ 0x0298 [1] ReadWrite reset &[0x100], writable 0xFFFF, w1c 0, {
        15:0 "width" "u8.8, pixels, 1/256..=65535/256";
    }
    /// Side of the squares that points are when they are drawn with the effect `anti_alias`.
    PointSize "POINT_SIZE" @ 0x029C [1] ReadWrite reset &[0x100], writable 0xFFFF, w1c 0, {
        15:0 "size" "u8.8, pixels, 1/256..=65535/256";
    }

    // Effects of a draw: sampled by each draw that calls for them ------------------------------
    /// First byte of the texture's level 0, a multiple of 64; further levels follow, each at the next multiple of 64.
    TextureBase "TEXTURE_BASE" @ 0x0300 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Size of the texture's level 0.
    TextureSize "TEXTURE_SIZE" @ 0x0304 [1] ReadWrite reset &[0x0001_0001], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "height" "texels, 1..=16384";
        14:0 "width" "texels, 1..=16384";
    }
    /// How the texture is stored, read and combined.
    TextureControl "TEXTURE_CONTROL" @ 0x0308 [1] ReadWrite reset &[0x0001_0100], writable 0x000F_F337, w1c 0, {
        19:16 "levels" "MIP-map levels in memory, 1..=15, as far as the size can be halved";
        15:15 "mirror_y" "1: every other repetition is mirrored";
        14:14 "mirror_x" "1: every other repetition is mirrored";
        13:13 "repeat_y" "1: the texture repeats, else its edge goes on";
        12:12 "repeat_x" "1: the texture repeats, else its edge goes on";
        9:8 "function" "0 replace, 1 modulate, 2 decal, 3 blend with TEXTURE_COLOUR";
        5:4 "filter" "0 nearest, 1 bilinear, 2 trilinear";
        2:0 "format" "0 rgba8888, 1 rgb565, 2 rgba5551, 3 rgba4444, 4 palette8, 5 palette4";
    }
    /// First texel of level 0 that is used.
    TextureOffset "TEXTURE_OFFSET" @ 0x030C [1] ReadWrite reset &[0], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "y" "texels, inside the texture";
        14:0 "x" "texels, inside the texture";
    }
    /// Texels of level 0 that are used: texture coordinates 0..1.
    TextureWindow "TEXTURE_WINDOW" @ 0x0310 [1] ReadWrite reset &[0], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "height" "texels, inside the texture; 0: to its end";
        14:0 "width" "texels, inside the texture; 0: to its end";
    }
    /// Constant colour of the texture function `blend`.
    TextureColour "TEXTURE_COLOUR" @ 0x0314 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {
        31:24 "alpha" "not in use";
        23:16 "blue" "";
        15:8 "green" "";
        7:0 "red" "";
    }
    /// Added to the level of detail.
    TextureBias "TEXTURE_BIAS" @ 0x0318 [1] ReadWrite reset &[0], writable 0xFFFF, w1c 0, {
        15:0 "bias" "s7.8, levels";
    }
    /// First byte of the texture's palette, a multiple of 64: 256 (palette8) or 16 (palette4) colours as in MATERIAL_COLOUR.
    PaletteBase "PALETTE_BASE" @ 0x031C [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Which texels are holes, where the effect `punch_through` is called.
    PunchThrough "PUNCH_THROUGH" @ 0x0320 [1] ReadWrite reset &[0x80], writable 0xFF, w1c 0, {
        7:0 "reference" "a texel with an alpha below this is a hole";
    }
    /// How translucent fragments are combined with what lies behind them.
    BlendControl "BLEND_CONTROL" @ 0x0324 [1] ReadWrite reset &[0], writable 0x7, w1c 0, {
        2:0 "mode" "0 alpha, 1 add, 2 multiply, 3 premultiplied";
    }
    /// Stencil test, and what becomes of a pixel's stencil value: an operation for a fragment that fails the stencil test, one for a fragment that passes it and fails the depth test, one for a fragment that passes both. The front of a triangle is where its vertices run counter-clockwise on the screen; lines and points show their front. Operations: 0 keep, 1 zero, 2 replace (by the reference), 3 increment, 4 decrement (these stop at 255 and 0), 5 invert, 6 increment-wrap, 7 decrement-wrap.
    StencilControl "STENCIL_CONTROL" @ 0x0328 [1] ReadWrite reset &[0x0000_0007], writable 0x7777_7717, w1c 0, {
        30:28 "back_pass" "operation";
        26:24 "back_depth_fail" "operation";
        22:20 "back_fail" "operation";
        18:16 "front_pass" "operation";
        14:12 "front_depth_fail" "operation";
        10:8 "front_fail" "operation";
        4:4 "colour_off" "1: pixels that pass keep their colour";
        2:0 "function" "reference against stored value, both masked: 0 never, 1 less, 2 equal, 3 less-equal, 4 greater, 5 not-equal, 6 greater-equal, 7 always";
    }
    /// What the stencil test compares and changes.
    StencilValue "STENCIL_VALUE" @ 0x032C [1] ReadWrite reset &[0x00FF_FF00], writable 0x00FF_FFFF, w1c 0, {
        23:16 "write_mask" "bits of the stored value that operations may change";
        15:8 "read_mask" "bits of reference and stored value that are compared";
        7:0 "reference" "";
    }
    /// How fog grows with the distance from the viewer.
    FogControl "FOG_CONTROL" @ 0x0330 [1] ReadWrite reset &[0], writable 0x7, w1c 0, {
        2:0 "function" "0 none, 1 linear, 2 exponential, 3 exponential-squared, 4 depth-cue";
    }
    /// Density of exponential fog, f32, not negative: for each unit of eye space.
    FogDensity "FOG_DENSITY" @ 0x0334 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {}
    /// Distance at which linear fog is full, f32, positive: eye space.
    FogEnd "FOG_END" @ 0x0338 [1] ReadWrite reset &[ONE], writable 0xFFFF_FFFF, w1c 0, {}
    /// Depth cueing, kz, f32: what of the surface's share a unit of eye space takes.
    DepthCueScale "DEPTH_CUE_SCALE" @ 0x033C [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {}
    /// Depth cueing, cz, f32: the surface's share at the viewer.
    DepthCueOffset "DEPTH_CUE_OFFSET" @ 0x0340 [1] ReadWrite reset &[ONE], writable 0xFFFF_FFFF, w1c 0, {}
    /// Colour of the fog.
    FogColour "FOG_COLOUR" @ 0x0344 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {
        31:24 "alpha" "not in use";
        23:16 "blue" "";
        15:8 "green" "";
        7:0 "red" "";
    }
    /// Where light is worked out.
    LightControl "LIGHT_CONTROL" @ 0x0350 [1] ReadWrite reset &[0], writable 0x7, w1c 0, {
        2:2 "local_viewer" "highlights are seen from the eye; else from infinity along +z";
        1:1 "two_sided" "normals that point away from the viewer are turned round";
        0:0 "per_pixel" "at each pixel shaded; else at each vertex";
    }
    /// First byte of the light records in video memory, a multiple of 64. 16 words each: 0 type (0 directional, 1 point, 2 spot), 1..=3 position and 4..=6 direction of the rays (f32, eye space), 7 attenuation cut-off (f32, 0: none), 8 spot exponent (f32, 0..=128), 9 colour and 10 ambient (as in MATERIAL_COLOUR), 11..=15 zero.
    LightBase "LIGHT_BASE" @ 0x0354 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Lights that shine.
    LightCount "LIGHT_COUNT" @ 0x0358 [1] ReadWrite reset &[0], writable 0x1FF, w1c 0, {
        8:0 "count" "0..=256";
    }
    /// Light that is everywhere.
    SceneAmbient "SCENE_AMBIENT" @ 0x035C [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {
        31:24 "alpha" "not in use";
        23:16 "blue" "";
        15:8 "green" "";
        7:0 "red" "";
    }
    /// Colour of the material's highlights.
    MaterialSpecular "MATERIAL_SPECULAR" @ 0x0360 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {
        31:24 "alpha" "not in use";
        23:16 "blue" "";
        15:8 "green" "";
        7:0 "red" "";
    }
    /// Colour that the material gives off by itself.
    MaterialEmission "MATERIAL_EMISSION" @ 0x0364 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {
        31:24 "alpha" "not in use";
        23:16 "blue" "";
        15:8 "green" "";
        7:0 "red" "";
    }
    /// Sharpness of the material's highlights, f32, 0..=128.
    MaterialShininess "MATERIAL_SHININESS" @ 0x0368 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {}

    // Shadow bit: sampled by end scene ---------------------------------------------------------
    /// Which pixels of a scene that called for the effect `stencil` lie in shadow when its opaque picture is done: those whose stencil value passes this test.
    ShadowControl "SHADOW_CONTROL" @ 0x0380 [1] ReadWrite reset &[0x00FF_0050], writable 0x00FF_FF71, w1c 0, {
        23:16 "read_mask" "bits of reference and stored value that are compared";
        15:8 "reference" "";
        6:4 "function" "reference against stored value, both masked; values as in STENCIL_CONTROL";
        0:0 "enable" "1: pixels in shadow are darkened";
    }
    /// What is left of the light in shadow.
    ShadowIntensity "SHADOW_INTENSITY" @ 0x0384 [1] ReadWrite reset &[0x80], writable 0xFF, w1c 0, {
        7:0 "intensity" "each colour channel is multiplied by intensity / 255 and rounded to the nearest level";
    }

    // Geometry: sampled by each draw ---------------------------------------------------------
    /// Object to eye, 4x4 f32, row-major for row vectors.
    ObjectEye "OBJECT_EYE" @ 0x0400 [16] ReadWrite reset IDENTITY, writable 0xFFFF_FFFF, w1c 0, {}
    /// Decal transform in eye space, 4x4 f32: moves surface markings toward the viewer. In use where the effect `decal` is called; depth alone follows it, x and y are those of the undisplaced vertex.
    Decal "DECAL" @ 0x0440 [16] ReadWrite reset IDENTITY, writable 0xFFFF_FFFF, w1c 0, {}
    /// Eye to clip space, 4x4 f32; a point is inside where 0 <= z <= w and w > 0.
    EyeClip "EYE_CLIP" @ 0x0480 [16] ReadWrite reset IDENTITY, writable 0xFFFF_FFFF, w1c 0, {}
    /// Viewport, 6 f32: scale x, y, z, then offset x, y, z. Screen = clip / w * scale + offset: x, y in pixels, y down, z 0 near .. 1 far.
    Viewport "VIEWPORT" @ 0x04C0 [6] ReadWrite reset &[ONE, ONE, ONE, 0, 0, 0], writable 0xFFFF_FFFF, w1c 0, {}

    // Probe ----------------------------------------------------------------------------------
    /// Pixel history.
    ProbeControl "PROBE_CONTROL" @ 0x0600 [1] ReadWrite reset &[0], writable 1, w1c 0, {
        0:0 "enable" "1 records every fragment that comes to the pixel";
    }
    /// The pixel watched.
    ProbePixel "PROBE_PIXEL" @ 0x0604 [1] ReadWrite reset &[0], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "y" "pixels";
        14:0 "x" "pixels";
    }
    /// First byte of the record area in video memory, a multiple of 64.
    ProbeBase "PROBE_BASE" @ 0x0608 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Records that fit there; further fragments are counted but not recorded.
    ProbeSize "PROBE_SIZE" @ 0x060C [1] ReadWrite reset &[0], writable 0x00FF_FFFF, w1c 0, {}
    /// Fragments that have come to the pixel since the probe was enabled.
    ProbeCount "PROBE_COUNT" @ 0x0610 [1] ReadOnly reset &[0], writable 0, w1c 0, {}

    // Scan-out -------------------------------------------------------------------------------
    /// Scan-out.
    ScanoutControl "SCANOUT_CONTROL" @ 0x0680 [1] ReadWrite reset &[0], writable 1, w1c 0, {
        0:0 "continuous" "1: a vertical blank every SCANOUT_PERIOD; 0: one for each present packet";
    }
    /// Time between vertical blanks in microseconds, 1000..=1000000; other values count as the nearest of these.
    ScanoutPeriod "SCANOUT_PERIOD" @ 0x0684 [1] ReadWrite reset &[16_667], writable 0x001F_FFFF, w1c 0, {}
    /// First byte of the frame shown; a present packet changes it at the vertical blank.
    ScanoutBase "SCANOUT_BASE" @ 0x0688 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Bytes from one row of the frame shown to the next, a multiple of 64.
    ScanoutPitch "SCANOUT_PITCH" @ 0x068C [1] ReadWrite reset &[0], writable 0x000F_FFC0, w1c 0, {}
    /// Format of the frame shown; values as in COLOUR_FORMAT.
    ScanoutFormat "SCANOUT_FORMAT" @ 0x0690 [1] ReadWrite reset &[0], writable 0x3, w1c 0, {
        1:0 "format" "0 XRGB8888, 1 ARGB8888, 2 RGB565";
    }
    /// Size of the frame shown; 0 is a dark screen.
    ScanoutSize "SCANOUT_SIZE" @ 0x0694 [1] ReadWrite reset &[0], writable 0x7FFF_7FFF, w1c 0, {
        30:16 "height" "pixels";
        14:0 "width" "pixels";
    }
    /// Vertical blanks since reset (modulo 2^32).
    FrameCount "FRAME_COUNT" @ 0x0698 [1] ReadOnly reset &[0], writable 0, w1c 0, {}

    /// Cursor: a picture that scan-out puts over the frame shown. It stands in no frame buffer and changes none.
    CursorControl "CURSOR_CONTROL" @ 0x06A0 [1] ReadWrite reset &[0], writable 1, w1c 0, {
        0:0 "enable" "1 shows the cursor";
    }
    /// First byte of the cursor's picture, a multiple of 64: 64 x 64 ARGB8888 pixels in dense rows, colours multiplied by their alpha.
    CursorBase "CURSOR_BASE" @ 0x06A4 [1] ReadWrite reset &[0], writable 0xFFFF_FFC0, w1c 0, {}
    /// Where the picture's first pixel lies on the frame shown; what lies outside the frame is not shown.
    CursorPosition "CURSOR_POSITION" @ 0x06A8 [1] ReadWrite reset &[0], writable 0xFFFF_FFFF, w1c 0, {
        31:16 "y" "pixels, two's complement";
        15:0 "x" "pixels, two's complement";
    }

    // What the last scene called for, and what it cost ---------------------------------------
    /// Effects called since begin scene; bits as in EFFECTS.
    EffectsCalled "EFFECTS_CALLED" @ 0x0700 [1] ReadOnly reset &[0], writable 0, w1c 0, {}
    /// Units powered since begin scene.
    UnitsPowered "UNITS_POWERED" @ 0x0704 [1] ReadOnly reset &[0], writable 0, w1c 0, {
        11:11 "probe" "";
        10:10 "scanout" "";
        9:9 "bitmap" "";
        8:8 "shading" "";
        7:7 "texture" "";
        6:6 "subpixel" "";
        5:5 "tile" "";
        4:4 "systolic" "";
        3:3 "za" "";
        2:2 "z_buffer" "";
        1:1 "geometry" "";
        0:0 "frontend" "";
    }
    /// Writing 1 sets every counter to 0.
    CounterControl "COUNTER_CONTROL" @ 0x0708 [1] WriteOnly reset &[0], writable 1, w1c 0, {
        0:0 "clear" "1 clears";
    }
    /// Counters, 64 bits each: low word, then high word; reading the low word latches the high one. The order is that of the counter list.
    Counters "COUNTERS" @ 0x1000 [256] ReadOnly reset &[0], writable 0, w1c 0, {}
}
