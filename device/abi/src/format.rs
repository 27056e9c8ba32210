//! Pixel and depth formats, depth functions, topologies: every enumeration a register or packet holds.

macro_rules! enumeration {
    ($(#[doc = $doc:literal])+ $type:ident { $( $(#[doc = $vdoc:literal])+ $variant:ident = $value:literal $name:literal, )+ }) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u32)]
        pub enum $type { $( $(#[doc = $vdoc])+ $variant = $value, )+ }

        impl $type {
            /// Every value, in rising order of its code.
            pub const ALL: &'static [$type] = &[ $( $type::$variant, )+ ];

            /// The value with this code, if there is one.
            #[must_use]
            pub const fn from_code(code: u32) -> Option<$type> {
                match code { $( $value => Some($type::$variant), )+ _ => None }
            }

            /// The code as it stands in registers and packets.
            #[must_use]
            pub const fn code(self) -> u32 {
                self as u32
            }

            /// The name as it stands in scene files and reports.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $( $type::$variant => $name, )+ }
            }
        }
    };
}

/// Columns and rows of the cursor's picture.
pub const CURSOR_SIDE: u32 = 64;

enumeration! {
    /// Format of a pixel in a frame buffer.
    PixelFormat {
        /// 32 bits: 31:24 written as 255, 23:16 red, 15:8 green, 7:0 blue.
        Xrgb8888 = 0 "xrgb8888",
        /// 32 bits: 31:24 alpha, 23:16 red, 15:8 green, 7:0 blue.
        Argb8888 = 1 "argb8888",
        /// 16 bits: 15:11 red, 10:5 green, 4:0 blue; the top bits of each 8-bit channel.
        Rgb565 = 2 "rgb565",
    }
}

impl PixelFormat {
    /// Bytes of a pixel.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => 4,
            PixelFormat::Rgb565 => 2,
        }
    }

    /// The stored pixel of an RGBA colour.
    #[must_use]
    #[inline]
    pub const fn encode(self, [r, g, b, a]: [u8; 4]) -> u32 {
        match self {
            PixelFormat::Xrgb8888 => u32::from_be_bytes([255, r, g, b]),
            PixelFormat::Argb8888 => u32::from_be_bytes([a, r, g, b]),
            PixelFormat::Rgb565 => ((r as u32 >> 3) << 11) | ((g as u32 >> 2) << 5) | (b as u32 >> 3),
        }
    }

    /// The RGBA colour of a stored pixel; 5 and 6 bits are widened by repeating their top bits.
    #[must_use]
    #[inline]
    pub const fn decode(self, pixel: u32) -> [u8; 4] {
        let [top, r, g, b] = pixel.to_be_bytes();
        match self {
            PixelFormat::Xrgb8888 => [r, g, b, 255],
            PixelFormat::Argb8888 => [r, g, b, top],
            PixelFormat::Rgb565 => {
                let (r, g, b) = ((pixel >> 11) & 31, (pixel >> 5) & 63, pixel & 31);
                [((r << 3) | (r >> 2)) as u8, ((g << 2) | (g >> 4)) as u8, ((b << 3) | (b >> 2)) as u8, 255]
            }
        }
    }
}

enumeration! {
    /// Format of a pixel of the bitmap unit: those of frame buffers, and coverage alone.
    BitmapFormat {
        /// As [`PixelFormat::Xrgb8888`].
        Xrgb8888 = 0 "xrgb8888",
        /// As [`PixelFormat::Argb8888`].
        Argb8888 = 1 "argb8888",
        /// As [`PixelFormat::Rgb565`].
        Rgb565 = 2 "rgb565",
        /// 8 bits: alpha. Its colour reads as black.
        Alpha8 = 3 "alpha8",
    }
}

impl BitmapFormat {
    /// The format of a frame buffer that it is; `None` for coverage alone.
    #[must_use]
    pub const fn pixel_format(self) -> Option<PixelFormat> {
        PixelFormat::from_code(self.code())
    }

    /// Bytes of a pixel.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self.pixel_format() {
            Some(format) => format.bytes(),
            None => 1,
        }
    }

    /// All bits of a stored pixel.
    #[must_use]
    pub const fn bits(self) -> u32 {
        u32::MAX >> (32 - 8 * self.bytes())
    }

    /// The stored pixel of an RGBA colour.
    #[must_use]
    pub const fn encode(self, colour: [u8; 4]) -> u32 {
        match self.pixel_format() {
            Some(format) => format.encode(colour),
            None => colour[3] as u32,
        }
    }

    /// The RGBA colour of a stored pixel; bits beyond the format do not count.
    #[must_use]
    pub const fn decode(self, pixel: u32) -> [u8; 4] {
        match self.pixel_format() {
            Some(format) => format.decode(pixel),
            None => [0, 0, 0, pixel as u8],
        }
    }
}

impl From<PixelFormat> for BitmapFormat {
    fn from(format: PixelFormat) -> BitmapFormat {
        match format {
            PixelFormat::Xrgb8888 => BitmapFormat::Xrgb8888,
            PixelFormat::Argb8888 => BitmapFormat::Argb8888,
            PixelFormat::Rgb565 => BitmapFormat::Rgb565,
        }
    }
}

enumeration! {
    /// What becomes of a destination bit d under a source bit s, in the numbering of the X Window System: bit 0 of
    /// the code is the result for s = d = 1, bit 1 for s = 1, d = 0, bit 2 for s = 0, d = 1, bit 3 for s = d = 0.
    RasterOperation {
        /// 0.
        Clear = 0 "clear",
        /// s and d.
        And = 1 "and",
        /// s and not d.
        AndReverse = 2 "and-reverse",
        /// s.
        Copy = 3 "copy",
        /// not s, and d.
        AndInverted = 4 "and-inverted",
        /// d: nothing changes.
        NoOperation = 5 "no-operation",
        /// s or d, not both.
        Xor = 6 "xor",
        /// s or d.
        Or = 7 "or",
        /// neither s nor d.
        Nor = 8 "nor",
        /// s equals d.
        Equivalent = 9 "equivalent",
        /// not d.
        Invert = 10 "invert",
        /// s or not d.
        OrReverse = 11 "or-reverse",
        /// not s.
        CopyInverted = 12 "copy-inverted",
        /// not s, or d.
        OrInverted = 13 "or-inverted",
        /// not both s and d.
        Nand = 14 "nand",
        /// 1.
        Set = 15 "set",
    }
}

impl RasterOperation {
    /// The result depends on the source.
    #[must_use]
    pub const fn reads_source(self) -> bool {
        self.code() & 3 != self.code() >> 2
    }

    /// The result depends on what is there.
    #[must_use]
    pub const fn reads_destination(self) -> bool {
        self.code() & 5 != (self.code() >> 1) & 5
    }
}

enumeration! {
    /// How a stretch reads between the pixels of its source.
    StretchFilter {
        /// The nearest pixel.
        Nearest = 0 "nearest",
        /// Four pixels, weighed by their distances in 1/256 pixel.
        Bilinear = 1 "bilinear",
    }
}

enumeration! {
    /// Comparison of a fragment's depth (left) with the stored depth (right).
    DepthFunction {
        /// Nothing passes.
        Never = 0 "never",
        /// Strictly nearer passes: at equal depth the earlier command stays.
        Less = 1 "less",
        /// Equal passes.
        Equal = 2 "equal",
        /// Nearer or equal passes.
        LessEqual = 3 "less-equal",
        /// Farther passes.
        Greater = 4 "greater",
        /// Different passes.
        NotEqual = 5 "not-equal",
        /// Farther or equal passes.
        GreaterEqual = 6 "greater-equal",
        /// Everything passes.
        Always = 7 "always",
    }
}

enumeration! {
    /// What becomes of a pixel's stencil value. Only bits of the write mask change.
    StencilOperation {
        /// It stays.
        Keep = 0 "keep",
        /// 0.
        Zero = 1 "zero",
        /// The reference.
        Replace = 2 "replace",
        /// One more; 255 stays.
        Increment = 3 "increment",
        /// One less; 0 stays.
        Decrement = 4 "decrement",
        /// All bits change.
        Invert = 5 "invert",
        /// One more; 0 follows 255.
        IncrementWrap = 6 "increment-wrap",
        /// One less; 255 follows 0.
        DecrementWrap = 7 "decrement-wrap",
    }
}

enumeration! {
    /// How the vertices of a draw make primitives.
    Topology {
        /// Three vertices each.
        Triangles = 0 "triangles",
        /// Two vertices each.
        Lines = 1 "lines",
        /// One vertex each.
        Points = 2 "points",
        /// Each vertex after the first ends a line that starts at the one before.
        LineStrip = 3 "line-strip",
    }
}

impl Topology {
    /// Primitives that `vertices` vertices (or indices) make; those left over make none.
    #[must_use]
    pub const fn primitives(self, vertices: u32) -> u32 {
        match self {
            Topology::Triangles => vertices / 3,
            Topology::Lines => vertices / 2,
            Topology::Points => vertices,
            Topology::LineStrip => vertices.saturating_sub(1),
        }
    }
}

enumeration! {
    /// How visibility is decided.
    HiddenSurface {
        /// Plain Z buffer.
        ZBuffer = 0 "zbuffer",
        /// Z buffer with a status word for each block of pixels.
        Za = 1 "za",
        /// Systolic scan-line array.
        Systolic = 2 "systolic",
        /// Tiles found by a Y then X sort.
        Tile = 3 "tile",
    }
}

enumeration! {
    /// How units that have a clocked model are simulated. Pixels, counters and clocks do not depend on it.
    Fidelity {
        /// The host's fastest way; clocks by closed form.
        Functional = 0 "functional",
        /// Stepped register by register.
        Clocked = 1 "clocked",
    }
}

enumeration! {
    /// How the Za unit predicts the least depth of a primitive in a block. All are safe; they differ in
    /// how tight they are and in clocks.
    ZaPrediction {
        /// From the first covered pixel over the whole length of a block, as published.
        BlockLength = 0 "block-length",
        /// Over the covered pixels only.
        CoveredRun = 1 "covered-run",
        /// The least depth that the primitive really has in the block.
        Plane = 2 "plane",
    }
}

enumeration! {
    /// When an element of the systolic array sees that a segment has begun or ended.
    EndTest {
        /// A - 1 is negative.
        Negative = 0 "negative",
        /// A - 1 is zero; X and dX enter one larger.
        Zero = 1 "zero",
    }
}

enumeration! {
    /// How X and dX of a segment enter the systolic array.
    TokenPorts {
        /// X on port A; dX on port B at T1 only, the first element of the segment swaps it in.
        Swapped = 0 "swapped",
        /// X and dX share port A.
        Merged = 1 "merged",
    }
}

enumeration! {
    /// What a token of the systolic array carries at T3.
    TokenColour {
        /// The tag of its segment: what is seen is shaded after the line.
        Tag = 0 "tag",
        /// The colour itself, as published; primitives with interpolated colours still carry their tag.
        Value = 1 "value",
    }
}

enumeration! {
    /// Samples of a pixel, columns x rows.
    SubpixelGrid {
        /// One, at the pixel's centre: no anti-aliasing.
        Off = 0 "off",
        /// 16 samples.
        Grid4x4 = 1 "4x4",
        /// 32 samples.
        Grid8x4 = 2 "8x4",
        /// 64 samples.
        Grid8x8 = 3 "8x8",
    }
}

impl SubpixelGrid {
    /// Columns and rows of samples; 1 and 1 where it is off.
    #[must_use]
    pub const fn size(self) -> [u32; 2] {
        match self {
            SubpixelGrid::Off => [1, 1],
            SubpixelGrid::Grid4x4 => [4, 4],
            SubpixelGrid::Grid8x4 => [8, 4],
            SubpixelGrid::Grid8x8 => [8, 8],
        }
    }

    /// Samples of a pixel.
    #[must_use]
    pub const fn samples(self) -> u32 {
        let [columns, rows] = self.size();
        columns * rows
    }
}

enumeration! {
    /// How fragments of a pixel that share samples are ordered.
    SubpixelDepth {
        /// By one depth each, that at the pixel's centre.
        Centre = 0 "centre",
        /// By the range of depths that a search over the mask finds; sample by sample only where ranges overlap.
        Search = 1 "search",
        /// Sample by sample: supersampling.
        Exhaustive = 2 "exhaustive",
    }
}

enumeration! {
    /// Which edges are anti-aliased.
    SubpixelEdges {
        /// Those of every triangle.
        All = 0 "all",
        /// Those that a triangle does not share with another of its surface; the rest lie inside the surface.
        Borders = 1 "borders",
    }
}

enumeration! {
    /// Space in which the samples of a pixel are averaged and layers composed.
    SubpixelResolve {
        /// The values of the frame buffer.
        Values = 0 "values",
        /// Linear light, through the sRGB curve.
        Linear = 1 "linear",
    }
}

enumeration! {
    /// How texels are stored.
    TextureFormat {
        /// 32 bits: red in 7:0, green, blue, alpha in 31:24.
        Rgba8888 = 0 "rgba8888",
        /// 16 bits: 15:11 red, 10:5 green, 4:0 blue; opaque.
        Rgb565 = 1 "rgb565",
        /// 16 bits: 15 alpha, 14:10 red, 9:5 green, 4:0 blue.
        Rgba5551 = 2 "rgba5551",
        /// 16 bits: 15:12 alpha, 11:8 red, 7:4 green, 3:0 blue.
        Rgba4444 = 3 "rgba4444",
        /// 8 bits: one of 256 colours of a palette.
        Palette8 = 4 "palette8",
        /// 4 bits: one of 16 colours of a palette; the low half of a byte is the first texel.
        Palette4 = 5 "palette4",
    }
}

impl TextureFormat {
    /// Bits of a texel.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            TextureFormat::Rgba8888 => 32,
            TextureFormat::Rgb565 | TextureFormat::Rgba5551 | TextureFormat::Rgba4444 => 16,
            TextureFormat::Palette8 => 8,
            TextureFormat::Palette4 => 4,
        }
    }

    /// Colours of its palette; 0 without one.
    #[must_use]
    pub const fn palette(self) -> u32 {
        match self {
            TextureFormat::Palette8 => 256,
            TextureFormat::Palette4 => 16,
            _ => 0,
        }
    }
}

enumeration! {
    /// How a texture is read between texels.
    TextureFilter {
        /// The nearest texel of the nearest level.
        Nearest = 0 "nearest",
        /// Four texels of the nearest level.
        Bilinear = 1 "bilinear",
        /// Four texels of each of two levels.
        Trilinear = 2 "trilinear",
    }
}

enumeration! {
    /// How a texel is combined with the colour of the polygon.
    TextureFunction {
        /// The texel.
        Replace = 0 "replace",
        /// Their product.
        Modulate = 1 "modulate",
        /// The texel over the colour, by the texel's alpha.
        Decal = 2 "decal",
        /// From the colour to TEXTURE_COLOUR, by the texel.
        Blend = 3 "blend",
    }
}

enumeration! {
    /// How a translucent fragment is combined with what lies behind it.
    BlendMode {
        /// Over it by its alpha.
        Alpha = 0 "alpha",
        /// Added, by its alpha.
        Add = 1 "add",
        /// Multiplied, by its alpha.
        Multiply = 2 "multiply",
        /// Over it, its colour multiplied by alpha already.
        Premultiplied = 3 "premultiplied",
    }
}

enumeration! {
    /// How fog grows with the distance from the viewer.
    FogFunction {
        /// No fog.
        None = 0 "none",
        /// In proportion, full at FOG_END.
        Linear = 1 "linear",
        /// Exponentially, by FOG_DENSITY.
        Exponential = 2 "exponential",
        /// Exponentially with the square.
        ExponentialSquared = 3 "exponential-squared",
        /// Depth cueing: a straight line of DEPTH_CUE_SCALE and DEPTH_CUE_OFFSET.
        DepthCue = 4 "depth-cue",
    }
}

enumeration! {
    /// What a light is like.
    LightType {
        /// Parallel rays.
        Directional = 0 "directional",
        /// All round from a place.
        Point = 1 "point",
        /// A cone from a place.
        Spot = 2 "spot",
    }
}

/// Number format of depth: unsigned integers 0 (near) ..= 2^bits - 1 (far).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DepthFormat {
    bits: u32,
    fraction: u32,
}

impl Default for DepthFormat {
    /// 24 bits with 24 fraction bits.
    fn default() -> Self {
        DepthFormat { bits: 24, fraction: 24 }
    }
}

impl DepthFormat {
    /// A format of `bits` (16, 24 or 31) with gradients of `fraction` bits (0, 8, 16 or 24); else `None`.
    #[must_use]
    pub const fn new(bits: u32, fraction: u32) -> Option<DepthFormat> {
        match (bits, fraction) {
            (16 | 24 | 31, 0 | 8 | 16 | 24) => Some(DepthFormat { bits, fraction }),
            _ => None,
        }
    }

    /// The format in a DEPTH_FORMAT register.
    #[must_use]
    pub const fn from_code(code: u32) -> Option<DepthFormat> {
        DepthFormat::new(code & 0x1F, (code >> 8) & 0x1F)
    }

    /// The value for a DEPTH_FORMAT register.
    #[must_use]
    pub const fn code(self) -> u32 {
        self.bits | (self.fraction << 8)
    }

    /// Bits of a depth.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.bits
    }

    /// Fraction bits of the gradients.
    #[must_use]
    pub const fn fraction(self) -> u32 {
        self.fraction
    }

    /// The farthest depth, 2^bits - 1; also the clear value.
    #[must_use]
    pub const fn maximum(self) -> u32 {
        (1 << self.bits) - 1
    }
}

enumeration! {
    /// Format of a pixel of a picture that is composed.
    PictureFormat {
        /// As [`PixelFormat::Xrgb8888`].
        Xrgb8888 = 0 "xrgb8888",
        /// As [`PixelFormat::Argb8888`].
        Argb8888 = 1 "argb8888",
        /// As [`PixelFormat::Rgb565`].
        Rgb565 = 2 "rgb565",
        /// As [`BitmapFormat::Alpha8`].
        Alpha8 = 3 "alpha8",
        /// 32 bits: 31:24 written as 255, 23:16 blue, 15:8 green, 7:0 red.
        Xbgr8888 = 4 "xbgr8888",
        /// 32 bits: 31:24 alpha, 23:16 blue, 15:8 green, 7:0 red.
        Abgr8888 = 5 "abgr8888",
    }
}

impl PictureFormat {
    /// Bytes of a pixel.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        self.layout().bytes()
    }

    /// A format of the bitmap unit whose pixels take as many bytes.
    #[must_use]
    pub const fn layout(self) -> BitmapFormat {
        match self {
            PictureFormat::Rgb565 => BitmapFormat::Rgb565,
            PictureFormat::Alpha8 => BitmapFormat::Alpha8,
            _ => BitmapFormat::Argb8888,
        }
    }

    /// A pixel has colours, and not coverage alone.
    #[must_use]
    pub const fn has_colours(self) -> bool {
        !matches!(self, PictureFormat::Alpha8)
    }

    /// The ARGB word (alpha in 31:24, blue in 7:0) of a stored pixel; bits beyond the format do not count.
    #[must_use]
    #[inline]
    pub const fn decode(self, pixel: u32) -> u32 {
        match self {
            PictureFormat::Xrgb8888 => pixel | 0xFF00_0000,
            PictureFormat::Argb8888 => pixel,
            PictureFormat::Rgb565 => {
                let [r, g, b, a] = PixelFormat::Rgb565.decode(pixel);
                u32::from_be_bytes([a, r, g, b])
            }
            PictureFormat::Alpha8 => pixel << 24,
            PictureFormat::Xbgr8888 => red_for_blue(pixel) | 0xFF00_0000,
            PictureFormat::Abgr8888 => red_for_blue(pixel),
        }
    }

    /// The stored pixel of an ARGB word.
    #[must_use]
    #[inline]
    pub const fn encode(self, argb: u32) -> u32 {
        match self {
            PictureFormat::Xrgb8888 => argb | 0xFF00_0000,
            PictureFormat::Argb8888 => argb,
            PictureFormat::Rgb565 => {
                let [a, r, g, b] = argb.to_be_bytes();
                PixelFormat::Rgb565.encode([r, g, b, a])
            }
            PictureFormat::Alpha8 => argb >> 24,
            PictureFormat::Xbgr8888 => red_for_blue(argb) | 0xFF00_0000,
            PictureFormat::Abgr8888 => red_for_blue(argb),
        }
    }
}

/// A word with its bytes 0 and 2 in each other's place.
#[inline]
const fn red_for_blue(word: u32) -> u32 {
    (word & 0xFF00_FF00) | (word >> 16 & 0xFF) | (word & 0xFF) << 16
}

enumeration! {
    /// How a composition puts a source and a destination together, in the numbering of the RENDER extension: the channels
    /// of the source times a factor and those of the destination times another, their sum at most 255. S and D are the
    /// alphas of source and destination.
    ComposeOperator {
        /// 0 and 0.
        Clear = 0 "clear",
        /// 1 and 0.
        Source = 1 "source",
        /// 0 and 1: nothing changes.
        Destination = 2 "destination",
        /// 1 and 1 - S.
        Over = 3 "over",
        /// 1 - D and 1.
        OverReverse = 4 "over-reverse",
        /// D and 0.
        In = 5 "in",
        /// 0 and S.
        InReverse = 6 "in-reverse",
        /// 1 - D and 0.
        Out = 7 "out",
        /// 0 and 1 - S.
        OutReverse = 8 "out-reverse",
        /// D and 1 - S.
        Atop = 9 "atop",
        /// 1 - D and S.
        AtopReverse = 10 "atop-reverse",
        /// 1 - D and 1 - S.
        Xor = 11 "xor",
        /// 1 and 1.
        Add = 12 "add",
    }
}

/// A factor of a composition, from an alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComposeFactor {
    /// 0.
    Zero,
    /// 1.
    One,
    /// The alpha of the other side.
    Alpha,
    /// 1 less the alpha of the other side.
    Inverse,
}

impl ComposeOperator {
    /// The factors of source and destination.
    #[must_use]
    pub const fn factors(self) -> [ComposeFactor; 2] {
        use ComposeFactor::{Alpha, Inverse, One, Zero};
        match self {
            ComposeOperator::Clear => [Zero, Zero],
            ComposeOperator::Source => [One, Zero],
            ComposeOperator::Destination => [Zero, One],
            ComposeOperator::Over => [One, Inverse],
            ComposeOperator::OverReverse => [Inverse, One],
            ComposeOperator::In => [Alpha, Zero],
            ComposeOperator::InReverse => [Zero, Alpha],
            ComposeOperator::Out => [Inverse, Zero],
            ComposeOperator::OutReverse => [Zero, Inverse],
            ComposeOperator::Atop => [Alpha, Inverse],
            ComposeOperator::AtopReverse => [Inverse, Alpha],
            ComposeOperator::Xor => [Inverse, Inverse],
            ComposeOperator::Add => [One, One],
        }
    }

    /// The result depends on the source, or on its mask.
    #[must_use]
    pub const fn reads_source(self) -> bool {
        !matches!(self, ComposeOperator::Clear | ComposeOperator::Destination)
    }

    /// The result depends on what is there.
    #[must_use]
    pub const fn reads_destination(self) -> bool {
        !matches!(self, ComposeOperator::Clear | ComposeOperator::Source)
    }
}

enumeration! {
    /// What lies outside of a picture that is composed, in the numbering of the RENDER extension.
    Repeat {
        /// Nothing: transparent black, whatever the format.
        None = 0 "none",
        /// The picture again.
        Normal = 1 "normal",
        /// Its nearest pixel.
        Pad = 2 "pad",
        /// The picture mirrored at its sides.
        Reflect = 3 "reflect",
    }
}
