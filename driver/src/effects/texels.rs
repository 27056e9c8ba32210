//! Texels as the card stores them: formats, palettes, rows of words.
//!
//! A channel of fewer bits takes the value that is nearest to it when the card widens it again; a palette's texel the
//! nearest colour (least sum of squares of the four differences, the first of equals).

use std::collections::HashMap;

use zga_abi::format::TextureFormat;

use super::mip_map::Level;

/// Why a picture has no palette of its own: colours in it, at least.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooManyColours(pub usize);

/// The nearest of `0..=most` for a level of 0..=255.
const fn nearest(level: u8, most: u32) -> u32 {
    (level as u32 * most + 127) / 255
}

/// A stored texel of a format without a palette.
pub(super) const fn encode(format: TextureFormat, [r, g, b, a]: [u8; 4]) -> u32 {
    match format {
        TextureFormat::Rgb565 => nearest(r, 31) << 11 | nearest(g, 63) << 5 | nearest(b, 31),
        TextureFormat::Rgba5551 => nearest(a, 1) << 15 | nearest(r, 31) << 10 | nearest(g, 31) << 5 | nearest(b, 31),
        TextureFormat::Rgba4444 => nearest(a, 15) << 12 | nearest(r, 15) << 8 | nearest(g, 15) << 4 | nearest(b, 15),
        _ => u32::from_le_bytes([r, g, b, a]),
    }
}

/// The colours of a palette, and which of them is nearest to a colour.
#[derive(Debug)]
pub(super) struct Palette {
    colours: Vec<[u8; 4]>,
    known: HashMap<[u8; 4], u32>,
}

impl Palette {
    /// A palette of these colours; at least one.
    pub fn new(colours: &[[u8; 4]]) -> Palette {
        Palette { colours: colours.to_vec(), known: HashMap::new() }
    }

    /// The colours of level 0 in the order in which they first appear, then those of smaller levels, as far as there
    /// is room.
    pub fn of(levels: &[Level], most: usize) -> Result<Palette, TooManyColours> {
        let (mut colours, mut known) = (Vec::new(), HashMap::new());
        for (number, level) in levels.iter().enumerate() {
            for texel in &level.texels {
                if known.contains_key(texel) {
                    continue;
                }
                if colours.len() == most {
                    if number == 0 {
                        return Err(TooManyColours(most + 1));
                    }
                    return Ok(Palette { colours, known });
                }
                known.insert(*texel, colours.len() as u32);
                colours.push(*texel);
            }
        }
        Ok(Palette { colours, known })
    }

    /// The number of the nearest colour.
    fn index(&mut self, colour: [u8; 4]) -> u32 {
        let Palette { colours, known } = self;
        *known.entry(colour).or_insert_with(|| {
            let distance = |other: &[u8; 4]| -> u32 {
                colour.iter().zip(other).map(|(&a, &b)| u32::from(a.abs_diff(b)).pow(2)).sum()
            };
            let nearest = (0..).zip(colours.iter()).min_by_key(|&(_, other)| distance(other));
            nearest.map_or(0, |(index, _)| index)
        })
    }

    /// The words of a palette of `entries` colours; those that are not in use are 0.
    pub fn words(&self, entries: u32) -> Vec<u32> {
        let mut words: Vec<u32> = self.colours.iter().map(|&colour| u32::from_le_bytes(colour)).collect();
        words.resize(entries as usize, 0);
        words
    }
}

/// Words of a row of `width` texels.
pub(super) const fn row_words(format: TextureFormat, width: u32) -> u32 {
    (width * format.bits()).div_ceil(32)
}

/// A level's words: rows from the top, each begins a word; the first texel lies lowest.
pub(super) fn words(format: TextureFormat, level: &Level, palette: Option<&mut Palette>) -> Vec<u32> {
    let [width, _] = level.size;
    let bits = format.bits();
    let each = (32 / bits) as usize;
    let mut texel: Box<dyn FnMut([u8; 4]) -> u32> = match palette {
        Some(palette) => Box::new(|colour| palette.index(colour)),
        None => Box::new(move |colour| encode(format, colour)),
    };
    let mut words = Vec::with_capacity(row_words(format, width) as usize * level.size[1] as usize);
    for row in level.texels.chunks_exact(width as usize) {
        for part in row.chunks(each) {
            words.push((0..).zip(part).fold(0, |word, (place, &colour)| word | texel(colour) << (bits * place)));
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The levels that a channel of `bits` bits is widened to, as the manual says.
    fn widened(bits: u32) -> Vec<u8> {
        (0..1_u32 << bits)
            .map(|value| match bits {
                1 => (value * 255) as u8,
                4 => (value * 17) as u8,
                _ => (value << (8 - bits) | value >> (2 * bits - 8)) as u8,
            })
            .collect()
    }

    #[test]
    fn encode_each_channel_is_the_nearest_that_the_card_widens_to() {
        for bits in [1, 4, 5, 6] {
            let levels = widened(bits);
            for level in 0..=255_u8 {
                let chosen = levels[nearest(level, (1 << bits) - 1) as usize];
                let least = levels.iter().map(|other| other.abs_diff(level)).min();
                assert_eq!(Some(chosen.abs_diff(level)), least, "{bits} bits of {level}");
            }
        }
    }

    #[test]
    fn encode_puts_channels_where_the_manual_has_them() {
        let one = |format, colours: [[u8; 4]; 4]| colours.map(|colour| encode(format, colour));
        let channels = [[255, 0, 0, 0], [0, 255, 0, 0], [0, 0, 255, 0], [0, 0, 0, 255]];
        assert_eq!(one(TextureFormat::Rgba8888, channels), [0xFF, 0xFF00, 0xFF_0000, 0xFF00_0000]);
        assert_eq!(one(TextureFormat::Rgb565, channels), [0xF800, 0x07E0, 0x001F, 0]);
        assert_eq!(one(TextureFormat::Rgba5551, channels), [0x7C00, 0x03E0, 0x001F, 0x8000]);
        assert_eq!(one(TextureFormat::Rgba4444, channels), [0x0F00, 0x00F0, 0x000F, 0xF000]);
    }

    fn row(texels: &[[u8; 4]]) -> Level {
        Level { size: [texels.len() as u32, 1], texels: texels.to_vec() }
    }

    const RED: [u8; 4] = [255, 0, 0, 255];
    const GREEN: [u8; 4] = [0, 255, 0, 255];
    const BLUE: [u8; 4] = [0, 0, 255, 255];

    #[test]
    fn words_first_texel_lies_lowest_and_rows_begin_words() {
        let level = Level { size: [3, 2], texels: vec![RED, GREEN, BLUE, BLUE, RED, GREEN] };
        assert_eq!(words(TextureFormat::Rgb565, &level, None), [0x07E0_F800, 0x001F, 0xF800_001F, 0x07E0]);
        let palette = &mut Palette::of(std::slice::from_ref(&level), 16).expect("three colours");
        assert_eq!(words(TextureFormat::Palette8, &level, Some(palette)), [0x0002_0100, 0x0001_0002]);
        assert_eq!(words(TextureFormat::Palette4, &level, Some(palette)), [0x210, 0x102]);
        assert_eq!(palette.words(4), [0xFF00_00FF, 0xFF00_FF00, 0xFFFF_0000, 0]);
    }

    #[test]
    fn palette_of_a_picture_takes_smaller_levels_as_far_as_there_is_room() {
        let (first, second) = (row(&[RED, GREEN, RED, GREEN]), row(&[[128, 128, 0, 255], BLUE]));
        let levels = [first, second];
        let colours = |most| Palette::of(&levels, most).map(|palette| palette.colours.len());
        assert_eq!([1, 2, 3, 4, 5].map(colours), [Err(TooManyColours(2)), Ok(2), Ok(3), Ok(4), Ok(4)]);
    }

    #[test]
    fn palette_index_is_the_nearest_colour_and_the_first_of_equals() {
        let mut palette = Palette::new(&[[0, 0, 0, 255], [20, 0, 0, 255], [0, 20, 0, 255], [0, 0, 0, 0]]);
        let found = [[9, 0, 0, 255], [11, 0, 0, 255], [15, 15, 0, 255], [0, 0, 0, 120], [0, 0, 0, 128]];
        assert_eq!(found.map(|colour| palette.index(colour)), [0, 1, 1, 3, 0]);
    }
}
