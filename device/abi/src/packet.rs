//! Command packets: a header word, then payload words. Every opcode and payload stands here once.
//!
//! Header: 31:24 opcode, 23:20 zero, 19:0 number of payload words.

macro_rules! opcodes {
    ($( $(#[doc = $doc:literal])+ $id:ident = $code:literal $name:literal $payload:literal, )+) => {
        /// Opcodes.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u32)]
        pub enum Opcode { $( $(#[doc = $doc])+ $id = $code, )+ }

        impl Opcode {
            /// Every opcode, rising.
            pub const ALL: &'static [Opcode] = &[ $( Opcode::$id, )+ ];

            /// The opcode with this code, if there is one.
            #[must_use]
            pub const fn from_code(code: u32) -> Option<Opcode> {
                match code { $( $code => Some(Opcode::$id), )+ _ => None }
            }

            /// The name in manual and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $( Opcode::$id => $name, )+ }
            }

            /// What the packet does.
            #[must_use]
            pub const fn doc(self) -> &'static str {
                match self { $( Opcode::$id => concat!($($doc),+), )+ }
            }

            /// The payload words, for the manual.
            #[must_use]
            pub const fn payload(self) -> &'static str {
                match self { $( Opcode::$id => $payload, )+ }
            }
        }
    };
}

/// Most payload words of one packet.
pub const MAX_PAYLOAD: u32 = (1 << 20) - 1;

opcodes! {
    /// Does nothing; the payload is skipped.
    NoOperation = 0x00 "NO_OPERATION" "any",
    /// Writes registers of the ranges 0x0048..0x0050 and 0x0200..0x0700 from a byte offset upward, in stream order.
    RegisterWrite = 0x01 "REGISTER_WRITE" "offset, value, ...",
    /// Samples target, path and accuracy registers, and begins a scene.
    BeginScene = 0x02 "BEGIN_SCENE" "",
    /// Ends the scene: everything drawn is in memory.
    EndScene = 0x03 "END_SCENE" "",
    /// Clears frame buffer (bit 0 of planes), Z buffer (bit 1) and stencil plane (bit 2, to bits 15:8 of planes; no mask) inside the scissor. Colour as in MATERIAL_COLOUR.
    Clear = 0x04 "CLEAR" "planes, colour, depth",
    /// Draws from vertices (and indices) in the packet. Flags as in [`DrawFlags`].
    DrawInline = 0x10 "DRAW_INLINE" "flags, vertices, indices, vertex words ..., index words ...",
    /// Draws from vertices (and indices) in video memory: byte addresses, multiples of 4. Without indices, the last two words are 0.
    DrawBuffer = 0x11 "DRAW_BUFFER" "flags, vertex address, vertices, index address, indices",
    /// Fills a rectangle of a surface with a stored pixel value.
    Fill = 0x20 "FILL" "base, pitch, format, x, y, width, height, value",
    /// Copies a rectangle between surfaces of the same format; overlap is right.
    Copy = 0x21 "COPY" "format, source base, source pitch, x, y, destination base, destination pitch, x, y, width, height",
    /// Writes words from the packet to rows in video memory.
    Upload = 0x22 "UPLOAD" "address, pitch, words a row, rows, words ...",
    /// Gathers rows of words in video memory into one dense run there.
    Download = 0x23 "DOWNLOAD" "address, pitch, words a row, rows, destination",
    /// Fills a rectangle through a raster operation, on the bits of the stored pixel that are set in planes; others stay.
    FillRop = 0x24 "FILL_ROP" "base, pitch, format, x, y, width, height, value, operation, planes",
    /// Copies a rectangle through a raster operation, on the bits of the stored pixel that are set in planes; overlap is right.
    CopyRop = 0x25 "COPY_ROP" "format, source base, source pitch, x, y, destination base, destination pitch, x, y, width, height, operation, planes",
    /// Copies a rectangle into another format: the RGBA value of each pixel; overlap is right.
    Convert = 0x26 "CONVERT" "source format, source base, source pitch, x, y, destination format, destination base, destination pitch, x, y, width, height",
    /// Stretches a rectangle over a whole of other size and writes a part of it, whose first pixel goes to x, y; source and part share no byte.
    Stretch = 0x27 "STRETCH" "filter, source format, source base, source pitch, x, y, width, height, destination format, destination base, destination pitch, x, y, width, height, whole width, whole height, part x, part y",
    /// Fills rectangles of a surface through a raster operation, each through each clip box. Entries as in [`list`]: x, y, width, height.
    FillList = 0x28 "FILL_LIST" "base, pitch, format, size, operation, planes, origin, clips, value, clip boxes and rectangles ...",
    /// Copies rectangles through a raster operation from where the offset leads in a source of the same format, each through each clip box; each is read before it is written. Pixels without a source stay. Entries as of FILL_LIST.
    CopyList = 0x29 "COPY_LIST" "base, pitch, format, size, operation, planes, origin, clips, source base, source pitch, source size, offset x, offset y, clip boxes and rectangles ...",
    /// Draws lines of single pixels through a raster operation, each through each clip box. Entries as in [`list`]: x1, y1, x2, y2, or of a strip x, y. Flags as in [`SegmentFlags`].
    Segments = 0x2A "SEGMENTS" "base, pitch, format, size, operation, planes, origin, clips, value, flags, clip boxes and segments ...",
    /// Draws bitmaps of 1 bit a pixel in two values through a raster operation, each through each clip box. Entries as in [`list`]: x, y, width, height, then rows of whole words whose bit 0 is the leftmost pixel. Bit 0 of flags: zeros are drawn in the background value; else they stay.
    Expand = 0x2B "EXPAND" "base, pitch, format, size, operation, planes, origin, clips, foreground, background, flags, clip boxes and bitmaps ...",
    /// Composes a source through a mask with what is there, as in [`compose`]. Entries as of FILL_LIST; behind an inline mask's x, y, width, height stand its rows.
    Compose = 0x2C "COMPOSE" "base, pitch, format, size, operator, flags, origin, clips, source paint (14 words), mask paint (14 words), clip boxes and rectangles ...",
    /// Stores the sequence number in FENCE_SEQUENCE and raises the fence interrupt when all before it is done.
    Fence = 0x30 "FENCE" "sequence",
    /// Shows the frame buffer at this byte address from the next vertical blank on; waits for it.
    Present = 0x31 "PRESENT" "base",
    /// Composes the frame as scan-out would show it into video memory: XRGB8888, dense rows.
    WriteBack = 0x32 "WRITE_BACK" "destination",
}

/// The header of a packet with `payload` words behind it.
///
/// Only the low 20 bits of `payload` fit; [`MAX_PAYLOAD`] is the most.
#[must_use]
pub const fn header(opcode: Opcode, payload: u32) -> u32 {
    ((opcode as u32) << 24) | (payload & MAX_PAYLOAD)
}

/// Number of payload words in a header.
#[must_use]
pub const fn payload_words(header: u32) -> u32 {
    header & MAX_PAYLOAD
}

/// Clears the frame buffer.
pub const CLEAR_COLOUR: u32 = 1 << 0;
/// Clears the Z buffer.
pub const CLEAR_DEPTH: u32 = 1 << 1;
/// Clears the stencil plane.
pub const CLEAR_STENCIL: u32 = 1 << 2;
/// Place of the value that the stencil plane is cleared to: 8 bits, in the word that names the planes.
pub const CLEAR_STENCIL_SHIFT: u32 = 8;

/// The flags word of a draw packet.
///
/// 1:0 topology, 4 indexed, 8 vertices carry a colour, 9 a normal, 10 texture coordinates; all other bits are zero.
/// A vertex is x, y, z as f32, then (if bit 8 is set) a colour word: red in 7:0, alpha in 31:24, then (bit 9) a normal,
/// 3 f32 in object space, then (bit 10) texture coordinates u, v, 2 f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawFlags {
    /// How vertices make primitives.
    pub topology: crate::format::Topology,
    /// Vertices are named by 32-bit indices.
    pub indexed: bool,
    /// Each vertex has a colour word; else MATERIAL_COLOUR is used.
    pub coloured: bool,
    /// Each vertex has a normal; else light falls on it from everywhere alike: its normal is 0.
    pub normals: bool,
    /// Each vertex has texture coordinates; else they are 0.
    pub coordinates: bool,
}

impl DrawFlags {
    /// The flags in a word, if it is a valid one.
    #[must_use]
    pub const fn from_code(code: u32) -> Option<DrawFlags> {
        if code & !0x713 != 0 {
            return None;
        }
        match crate::format::Topology::from_code(code & 3) {
            Some(topology) => Some(DrawFlags {
                topology,
                indexed: code & 0x10 != 0,
                coloured: code & 0x100 != 0,
                normals: code & 0x200 != 0,
                coordinates: code & 0x400 != 0,
            }),
            None => None,
        }
    }

    /// The word.
    #[must_use]
    pub const fn code(self) -> u32 {
        self.topology as u32
            | ((self.indexed as u32) << 4)
            | ((self.coloured as u32) << 8)
            | ((self.normals as u32) << 9)
            | ((self.coordinates as u32) << 10)
    }

    /// Words of a vertex.
    #[must_use]
    pub const fn vertex_words(self) -> u32 {
        3 + self.coloured as u32 + 3 * self.normals as u32 + 2 * self.coordinates as u32
    }
}

/// What the packets with lists have in common.
///
/// A surface is `base` and `pitch` (bytes) and `size`: width in 15:0, height in 31:16. `origin` is added to the places of
/// entries: x in 15:0, y in 31:16, signed. Behind the fixed words stand `clips` clip boxes of two words: x1, y1 inclusive,
/// then x2, y2 exclusive, in pixels of the surface, to which they are cut; without a box nothing is drawn. Entries follow
/// up to the end of the packet. All places are pairs of signed 16-bit numbers, x in 15:0; sizes are unsigned. Entries are
/// drawn one after the other, each through the boxes one after the other.
pub mod list {
    /// Payload words of FILL_LIST before its clip boxes.
    pub const FILL_WORDS: u32 = 9;
    /// Payload words of COPY_LIST before its clip boxes.
    pub const COPY_WORDS: u32 = 13;
    /// Payload words of SEGMENTS before its clip boxes.
    pub const SEGMENTS_WORDS: u32 = 10;
    /// Payload words of EXPAND before its clip boxes.
    pub const EXPAND_WORDS: u32 = 11;
    /// Flags of EXPAND: zeros are drawn, too.
    pub const EXPAND_OPAQUE: u32 = 1;

    /// Payload words of COMPOSE before its clip boxes.
    pub const COMPOSE_WORDS: u32 = 8 + 2 * super::compose::PAINT_WORDS;

    /// A word of two 16-bit numbers.
    #[must_use]
    pub const fn pair(low: u16, high: u16) -> u32 {
        low as u32 | (high as u32) << 16
    }

    /// Words of a row of `width` pixels of 1 bit.
    #[must_use]
    pub const fn bitmap_row_words(width: u32) -> u32 {
        width.div_ceil(32)
    }
}

/// What COMPOSE means.
///
/// Surface, origin, clip boxes and entries are those of [`list`]; the format is a [`PictureFormat`](crate::format::PictureFormat).
/// A paint is `kind, format, repeat, base or colour, pitch, size, offset x, offset y, xx, xy, x0, yx, yy, y0`; words that a kind
/// does not use are not looked at. Offsets are signed, at most 65535 pixels; the last six are 16.16.
///
/// All channels are 8 bits; a format without alpha reads as opaque, one without colours as black. With
/// mul(a, b) = (t + t / 256) / 256 for t = a b + 128, a pixel is, channel by channel, min(255, mul(s, F) + mul(d, G)): s the
/// source, d what is there, F and G the factors of the operator ([`ComposeOperator`](crate::format::ComposeOperator)) with
/// 255 for 1, F from the alpha of d, G from that of s. A mask m comes before: s becomes mul(s, alpha of m). A mask by components
/// ([`COMPONENTS`](compose::COMPONENTS)) has each channel of s multiplied by its own channel of m, and the alpha of s, for G,
/// in each channel by that.
///
/// The pixel of a paint for the pixel (x, y) of the surface is i = x + offset x, j = y + offset y; transformed, column
/// (xx i + xy j + (xx + xy + 1) / 2 + x0 - 1) / 65536 and row (yx i + yy j + (yx + yy + 1) / 2 + y0 - 1) / 65536: the nearest pixel;
/// quotients are rounded down. What lies outside is the repeat's. An image shares no byte with the surface, gaps between
/// its rows counted in.
pub mod compose {
    /// Words of a paint.
    pub const PAINT_WORDS: u32 = 14;
    /// Flags: the mask is one by components.
    pub const COMPONENTS: u32 = 1;
    /// Kind: there is none; a mask alone.
    pub const NONE: u32 = 0;
    /// Kind: an ARGB word everywhere.
    pub const COLOUR: u32 = 1;
    /// Kind: an image, pixel by pixel.
    pub const IMAGE: u32 = 2;
    /// Kind: an image, transformed.
    pub const TRANSFORMED: u32 = 3;
    /// Kind: pixels in the entries, alpha8 or argb8888, each row padded to whole words, whose first is the entry's; a mask alone.
    pub const INLINE: u32 = 4;

    /// From a place in the destination, moved, to that of a pixel, 16.16, any values: x' = xx x + xy y + x0,
    /// y' = yx x + yy y + y0. In a packet its numbers stand in this order.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Transform {
        /// Columns for a column.
        pub xx: i32,
        /// Columns for a row.
        pub xy: i32,
        /// Columns at the origin.
        pub x0: i32,
        /// Rows for a column.
        pub yx: i32,
        /// Rows for a row.
        pub yy: i32,
        /// Rows at the origin.
        pub y0: i32,
    }

    /// Words of a row of `width` pixels of `bytes` bytes in an entry.
    #[must_use]
    pub const fn row_words(width: u32, bytes: u32) -> u32 {
        (width * bytes).div_ceil(4)
    }
}

/// The flags word of SEGMENTS: 0 the last pixel is drawn, 1 strip; all other bits are zero.
///
/// Of a segment from (x1, y1) to (x2, y2) the pixels i = 0 .. n are drawn, n = max(|x2 - x1|, |y2 - y1|): i pixels along the
/// longer axis (y where they are equal) and floor((2 m i + n - b) / 2 n) along the other, m = min(...). b is 1 where the
/// longer axis is y and y falls, or it is x and x falls; else 0. Pixel n is drawn where the last pixel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SegmentFlags {
    /// The last pixel of each segment is drawn, or that of a strip.
    pub last: bool,
    /// Entries are points: each after the first ends a segment that starts at the one before and has no last pixel.
    pub strip: bool,
}

impl SegmentFlags {
    /// The flags in a word, if it is a valid one.
    #[must_use]
    pub const fn from_code(code: u32) -> Option<SegmentFlags> {
        if code & !3 != 0 {
            return None;
        }
        Some(SegmentFlags { last: code & 1 != 0, strip: code & 2 != 0 })
    }

    /// The word.
    #[must_use]
    pub const fn code(self) -> u32 {
        self.last as u32 | (self.strip as u32) << 1
    }
}

/// Words of one record that the probe writes: see [`ProbeRecord`].
pub const PROBE_RECORD_WORDS: u32 = 8;

/// One fragment that came to the probed pixel, as it stands in video memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct ProbeRecord {
    /// Primitive number in its draw, from 0.
    pub primitive: u32,
    /// OBJECT_TAG of the draw.
    pub tag: u32,
    /// Kind in 7:0 (0 clear, 1 triangle, 2 line, 3 point), depth function in 15:8, verdict in 16 (1 = passed), depth written in 17.
    pub verdict: u32,
    /// Depth of the fragment.
    pub depth: u32,
    /// Depth stored before it.
    pub depth_before: u32,
    /// Colour of the fragment, as in MATERIAL_COLOUR.
    pub colour: u32,
    /// Draw number in its scene, from 0.
    pub draw: u32,
    /// 0.
    pub reserved: u32,
}
