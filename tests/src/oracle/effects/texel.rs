//! Texels as they lie in memory.
//!
//! Level k has `max(1, width >> k) x max(1, height >> k)` texels; a row takes whole words; each level begins at the next
//! multiple of 64 bytes after the one before. Within a word the first texel is lowest.

use super::Colour;

/// A part of video memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Byte address of the first word.
    pub at: u32,
    /// What is there.
    pub words: Vec<u32>,
}

impl Memory {
    /// The word at a byte address.
    ///
    /// # Panics
    /// Outside of the part.
    #[must_use]
    pub fn word(&self, address: u32) -> u32 {
        self.words[((address - self.at) / 4) as usize]
    }
}

/// How texels are stored: the numbers of TEXTURE_CONTROL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Red in 7:0, alpha in 31:24.
    Rgba8888 = 0,
    /// 15:11 red, 10:5 green, 4:0 blue.
    Rgb565 = 1,
    /// 15 alpha, 14:10 red, 9:5 green, 4:0 blue.
    Rgba5551 = 2,
    /// 15:12 alpha, 11:8 red, 7:4 green, 3:0 blue.
    Rgba4444 = 3,
    /// One of 256 colours.
    Palette8 = 4,
    /// One of 16 colours.
    Palette4 = 5,
}

impl Format {
    /// All six, in the order of their numbers.
    pub const ALL: [Self; 6] =
        [Self::Rgba8888, Self::Rgb565, Self::Rgba5551, Self::Rgba4444, Self::Palette8, Self::Palette4];

    /// Bits of a texel.
    #[must_use]
    pub const fn bits(self) -> u32 {
        [32, 16, 16, 16, 8, 4][self as usize]
    }

    /// Colours of the palette, 0 without one.
    #[must_use]
    pub const fn palette(self) -> u32 {
        [0, 0, 0, 0, 256, 16][self as usize]
    }

    /// The colour of a stored texel.
    #[must_use]
    pub fn decode(self, texel: u32, palette: &[Colour]) -> Colour {
        let field = |low: u32, bits: u32| texel >> low & ((1 << bits) - 1);
        // A level of n bits widened to 8 by repeating its top bits.
        let five = |low: u32| (field(low, 5) << 3 | field(low, 5) >> 2) as u8;
        let four = |low: u32| (field(low, 4) * 17) as u8;
        match self {
            Self::Rgba8888 => texel.to_le_bytes(),
            Self::Rgb565 => [five(11), (field(5, 6) << 2 | field(5, 6) >> 4) as u8, five(0), 255],
            Self::Rgba5551 => [five(10), five(5), five(0), (field(15, 1) * 255) as u8],
            Self::Rgba4444 => [four(8), four(4), four(0), four(12)],
            Self::Palette8 | Self::Palette4 => palette[texel as usize],
        }
    }
}

/// Bytes from the start of a texture to that of level `level`.
#[must_use]
pub fn level_offset(format: Format, size: [u32; 2], level: u32) -> u32 {
    (0..level).map(|k| level_words(format, extent(size, k)).next_multiple_of(16) * 4).sum()
}

/// Words of a level of `width` x `height` texels.
#[must_use]
pub const fn level_words(format: Format, [width, height]: [u32; 2]) -> u32 {
    (width * format.bits()).div_ceil(32) * height
}

/// Width and height of level `level`, texels.
#[must_use]
pub fn extent(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| (side >> level).max(1))
}

/// One level, decoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    /// Texels.
    pub size: [u32; 2],
    /// Row by row.
    pub texels: Vec<Colour>,
}

impl Level {
    /// The texel at column `x`, row `y`.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Colour {
        self.texels[(y * self.size[0] + x) as usize]
    }
}

/// Between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest texel of the nearest level.
    Nearest = 0,
    /// Four texels of the nearest level.
    Bilinear = 1,
    /// Four texels of each of two levels.
    Trilinear = 2,
}

impl Filter {
    /// All three, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Nearest, Self::Bilinear, Self::Trilinear];
}

/// A texture as a draw samples it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// How texels are stored.
    pub format: Format,
    /// Those that are in memory.
    pub levels: Vec<Level>,
    /// First texel of level 0 that is used.
    pub offset: [u32; 2],
    /// Texels of level 0 that are used.
    pub window: [u32; 2],
    /// By axis.
    pub repeat: [bool; 2],
    /// By axis; implies repetition.
    pub mirror: [bool; 2],
    /// Between texels.
    pub filter: Filter,
    /// 0 replace, 1 modulate, 2 decal, 3 blend.
    pub function: u32,
    /// Constant of the function blend.
    pub constant: Colour,
    /// 1/256 levels.
    pub bias: i32,
    /// Levels beyond the first are used.
    pub mip_map: bool,
}

impl Texture {
    /// What TEXTURE_BASE to PALETTE_BASE describe.
    ///
    /// # Panics
    /// When they describe nothing: numbers without a meaning, levels outside of `memory`.
    #[must_use]
    pub fn read(registers: &[u32; 8], memory: &Memory, mip_map: bool) -> Self {
        let [base, size, control, offset, window, constant, bias, palette] = *registers;
        let pair = |word: u32| [word & 0x7FFF, word >> 16 & 0x7FFF];
        let flag = |bit: u32| control >> bit & 1 == 1;
        let (size, offset, used) = (pair(size), pair(offset), pair(window));
        let format = Format::ALL[(control & 7) as usize];
        let colours: Vec<Colour> = (0..format.palette()).map(|k| memory.word(palette + 4 * k).to_le_bytes()).collect();
        let level = |k: u32| {
            let [width, height] = extent(size, k);
            let row = (width * format.bits()).div_ceil(32);
            let start = base + level_offset(format, size, k);
            let texel = |x: u32, y: u32| {
                let bit = x * format.bits();
                let word = memory.word(start + 4 * (y * row + bit / 32));
                let mask = (1_u64 << format.bits()) - 1;
                format.decode((u64::from(word >> (bit % 32)) & mask) as u32, &colours)
            };
            let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            Level { size: [width, height], texels: rows.map(|(x, y)| texel(x, y)).collect() }
        };
        Self {
            format,
            levels: (0..control >> 16 & 15).map(level).collect(),
            offset,
            window: [0, 1].map(|axis| if used[axis] == 0 { size[axis] - offset[axis] } else { used[axis] }),
            repeat: [flag(12), flag(13)],
            mirror: [flag(14), flag(15)],
            filter: Filter::ALL[(control >> 4 & 3) as usize],
            function: control >> 8 & 3,
            constant: constant.to_le_bytes(),
            bias: i32::from(bias as u16 as i16),
            mip_map,
        }
    }

    /// Levels that a lookup can choose from.
    #[must_use]
    pub fn used_levels(&self) -> u32 {
        if self.mip_map { self.levels.len() as u32 } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decode_corners_of_every_format_are_the_published_ones() {
        let palette = [[1, 2, 3, 4], [5, 6, 7, 8]];
        let of = |format: Format, texel: u32| format.decode(texel, &palette);

        assert_eq!(of(Format::Rgba8888, 0x4030_2010), [0x10, 0x20, 0x30, 0x40]);
        assert_eq!(
            [0xF800, 0x07E0, 0x001F].map(|t| of(Format::Rgb565, t)),
            [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]]
        );
        // 10000 widens to 10000100, 100000 to 10000010.
        assert_eq!(of(Format::Rgb565, 0x8410), [132, 130, 132, 255]);
        assert_eq!(of(Format::Rgba5551, 0xFC00), [255, 0, 0, 255]);
        assert_eq!(of(Format::Rgba5551, 0x03E1), [0, 255, 8, 0]);
        assert_eq!(of(Format::Rgba4444, 0x8F01), [255, 0, 17, 136]);
        assert_eq!(of(Format::Palette8, 1), [5, 6, 7, 8]);
        assert_eq!(of(Format::Palette4, 0), [1, 2, 3, 4]);
    }

    #[test]
    fn level_offset_levels_begin_at_chunks_of_64_bytes() {
        // 5 x 3 of 4 bits: 1 word a row, 12 bytes; then 2 x 1, then 1 x 1.
        let offsets = [0, 1, 2, 3].map(|level| level_offset(Format::Palette4, [5, 3], level));
        assert_eq!(offsets, [0, 64, 128, 192]);
        // 20 x 2 of 32 bits: 160 bytes, so 192.
        assert_eq!(level_offset(Format::Rgba8888, [20, 2], 1), 192);
        assert_eq!(level_words(Format::Rgba5551, [5, 3]), 9);
    }

    #[test]
    fn read_palette4_low_half_of_a_byte_is_first() {
        let mut words = vec![0; 32];
        words[0] = 0x0000_0210;
        (0..16).for_each(|k| words[16 + k as usize] = 0xFF00_0000 | k);
        let memory = Memory { at: 0x1000, words };
        let control = 5 | 1 << 16;

        let texture = Texture::read(&[0x1000, 1 << 16 | 3, control, 0, 0, 0, 0xFFFF, 0x1040], &memory, false);

        assert_eq!(texture.levels[0].texels, [[0, 0, 0, 255], [1, 0, 0, 255], [2, 0, 0, 255]]);
        assert_eq!((texture.window, texture.bias), ([3, 1], -1));
    }

    #[test]
    fn read_second_level_and_window_are_found() {
        let mut words = vec![0; 48];
        words[16] = 77;
        words[17] = 88;
        let memory = Memory { at: 0, words };

        let texture = Texture::read(&[0, 2 << 16 | 4, 2 << 16 | 0x5210, 1 << 16 | 2, 2, 0, 256, 0], &memory, true);

        assert_eq!(texture.levels[1], Level { size: [2, 1], texels: vec![[77, 0, 0, 0], [88, 0, 0, 0]] });
        assert_eq!((texture.offset, texture.window), ([2, 1], [2, 1]));
        assert_eq!((texture.repeat, texture.mirror), ([true, false], [true, false]));
        assert_eq!((texture.filter, texture.function, texture.bias), (Filter::Bilinear, 2, 256));
    }
}
