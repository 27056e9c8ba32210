//! Texture memory: the texels of a texture while a scene uses it.
//!
//! Duties: decodes formats and palettes to RGBA once, so that look-ups need not; gives texels of a level by their place
//! in its window. Inputs from: video memory. Outputs to: the filter. Clocks: those of look-ups, four texels a clock
//! ([`super`]).
//!
//! In video memory a level's rows are dense, begin on words, and a level begins at the next multiple of 64 bytes. In here
//! each level holds its window only, row after row, in a frame of one texel on all sides, which repeats what the address
//! generator would find out there: the far edge if repeated, the edge itself if mirrored or clamped. So the four texels of
//! a look-up are always two pairs of neighbours. The frame belongs to this host's model, not to the card: it is not counted.

use super::coordinates::{LANES, Wrap, coordinate};
use super::filter::Quads;
use zga_abi::format::TextureFormat;
use zga_firmware::checked;

/// Entries of a table of levels: 15 levels, and one more that a look-up beyond the last may name. A power of two.
const LEVELS: usize = 16;

/// A level's window.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Its first texel, counted in words from the first of all.
    start: i32,
    /// Words from a row to the next.
    stride: i32,
    /// Texels in x and y.
    size: [i32; 2],
    /// The same in 1/256 texels.
    scale: [f64; 2],
}

/// Levels of 16 pixels.
#[derive(Debug)]
pub struct LaneLevels {
    start: [i32; LANES],
    stride: [i32; LANES],
    size: [[i32; LANES]; 2],
    scale: [[f64; LANES]; 2],
}

/// Decoded texels of all levels in use.
#[derive(Debug)]
pub struct Memory {
    /// RGBA.
    texels: Vec<u32>,
    /// Those beyond the last are the last again.
    levels: [Level; LEVELS],
    last: u32,
    opaque: bool,
    /// Texels without frames.
    count: u64,
}

impl Memory {
    /// Decodes the windows of the levels of `texture` that are in use from the words of video memory.
    #[must_use]
    pub fn decode(memory: &[u32], texture: &checked::Texture, wrap: [Wrap; 2]) -> Memory {
        let last = if texture.mip_map { (texture.levels - 1).min(LEVELS as u32 - 2) } else { 0 };
        let mut words = 0;
        let mut next = |level: u32| {
            let (_, size) = window(texture, level);
            let [width, height] = size.map(|side| side + 2);
            // 16386 * 16386 words, and levels a quarter of that each: it fits 31 bits.
            let start = words + width + 1;
            words += if level <= last { width * height } else { 0 };
            let scale = size.map(|side| f64::from(256 * side));
            Level { start: start as i32, stride: width as i32, size: size.map(|side| side as i32), scale }
        };
        let mut levels: [Level; LEVELS] = std::array::from_fn(|level| next(level as u32));
        let (used, unused) = levels.split_at_mut(last as usize + 1);
        unused.fill(used[used.len() - 1]);
        let mut texels = vec![0; words as usize];
        let palette = texture.palette as usize / 4;
        let palette = &memory[palette.min(memory.len())..];
        let (mut opaque, mut count) = (true, 0);
        for (level, places) in (0..=last).zip(&levels) {
            let (offset, [width, height]) = window(texture, level);
            let [width, height] = [width as usize, height as usize];
            let stride = width + 2;
            let frame = places.start as usize - stride - 1;
            let framed = &mut texels[frame..frame + stride * (height + 2)];
            let row_words = texture.row_words(level) as usize;
            let first = texture.base as usize / 4 + texture.level_offset(level) as usize / 4;
            for (y, row) in framed.chunks_exact_mut(stride).skip(1).take(height).enumerate() {
                let source = first + (offset[1] as usize + y) * row_words;
                let texels = &mut row[1..=width];
                decode_row(&memory[source..source + row_words], offset[0] as usize, texture.format, palette, texels);
                opaque &= texels.iter().fold(u32::MAX, |all, texel| all & texel) >> 24 == 0xFF;
                let [left, right] = frame_of(wrap[0], width);
                (row[0], row[width + 1]) = (row[1 + left], row[1 + right]);
            }
            let [above, below] = frame_of(wrap[1], height);
            framed.copy_within((1 + above) * stride..(2 + above) * stride, 0);
            framed.copy_within((1 + below) * stride..(2 + below) * stride, (1 + height) * stride);
            count += (width * height) as u64;
        }
        Memory { texels, levels, last, opaque, count }
    }

    /// Every texel has an alpha of 255.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.opaque
    }

    /// Bytes of the texels.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        4 * self.count
    }

    /// The last level in use.
    #[must_use]
    pub fn last_level(&self) -> u32 {
        self.last
    }

    /// Width and height of the window, texels of level 0.
    #[must_use]
    #[inline(always)]
    pub fn window(&self) -> [f64; 2] {
        self.levels[0].size.map(f64::from)
    }

    /// The texel at a reduced place: the specification.
    #[must_use]
    pub fn nearest(&self, place: [f64; 2], wrap: [Wrap; 2], level: usize) -> u32 {
        let level = &self.levels[level % LEVELS];
        let index = |axis: usize| coordinate(place[axis], level.scale[axis]) >> 8;
        self.texel(level, wrap, [index(0), index(1)])
    }

    /// The four texels around a reduced place, upper left, upper right, lower left, lower right, and where it lies
    /// between them, 1/256: the specification.
    #[must_use]
    pub fn corners(&self, place: [f64; 2], wrap: [Wrap; 2], level: usize) -> ([u32; 4], [u32; 2]) {
        let level = &self.levels[level % LEVELS];
        let [x, y] = [0, 1].map(|axis| coordinate(place[axis], level.scale[axis]) - 128);
        let at = |right: i32, down: i32| self.texel(level, wrap, [(x >> 8) + right, (y >> 8) + down]);
        ([at(0, 0), at(1, 0), at(0, 1), at(1, 1)], [(x & 255) as u32, (y & 255) as u32])
    }

    /// The texel of any index.
    fn texel(&self, level: &Level, wrap: [Wrap; 2], index: [i32; 2]) -> u32 {
        let [x, y] = [0, 1].map(|axis| wrap[axis].wrapped(index[axis], level.size[axis]));
        self.texels[(level.start + y * level.stride + x) as usize]
    }

    /// The levels with these numbers; those of pixels that are masked out are any.
    #[must_use]
    #[inline(always)]
    pub fn lane_levels(&self, level: &[u32; LANES], mask: &[u32; LANES]) -> LaneLevels {
        let one = level.iter().zip(mask).fold(0, |one, (level, mask)| one.max(level & mask));
        let differ = level.iter().zip(mask).fold(0, |differ, (level, mask)| differ | (level ^ one) & mask);
        let first = &self.levels[one as usize % LEVELS];
        let mut lanes = LaneLevels {
            start: [first.start; LANES],
            stride: [first.stride; LANES],
            size: first.size.map(|size| [size; LANES]),
            scale: first.scale.map(|scale| [scale; LANES]),
        };
        if differ != 0 {
            for i in 0..LANES {
                let level = &self.levels[level[i] as usize % LEVELS];
                (lanes.start[i], lanes.stride[i]) = (level.start, level.stride);
                for axis in 0..2 {
                    (lanes.size[axis][i], lanes.scale[axis][i]) = (level.size[axis], level.scale[axis]);
                }
            }
        }
        lanes
    }

    /// [`Memory::nearest`] of 16 pixels.
    #[must_use]
    #[inline(always)]
    pub fn nearest_lanes(&self, place: &[[f64; LANES]; 2], wrap: [Wrap; 2], levels: &LaneLevels) -> [u32; LANES] {
        let x = wrap[0].nearest_lanes(&place[0], &levels.scale[0], &levels.size[0]);
        let y = wrap[1].nearest_lanes(&place[1], &levels.scale[1], &levels.size[1]);
        let index = levels.index(&x, &y);
        let mut texel = [0; LANES];
        for i in 0..LANES {
            texel[i] = self.texels.get(index[i] as usize).copied().unwrap_or(0);
        }
        texel
    }

    /// [`Memory::corners`] of 16 pixels.
    #[must_use]
    #[inline(always)]
    pub fn quads(&self, place: &[[f64; LANES]; 2], wrap: [Wrap; 2], levels: &LaneLevels) -> Quads {
        let (x, right) = wrap[0].pair_lanes(&place[0], &levels.scale[0], &levels.size[0]);
        let (y, lower) = wrap[1].pair_lanes(&place[1], &levels.scale[1], &levels.size[1]);
        let index = levels.index(&x, &y);
        let mut corners = [[0; LANES]; 4];
        let pair = |index: usize| -> [u32; 2] {
            let pair = self.texels.get(index..index.wrapping_add(2)).and_then(|pair| pair.try_into().ok());
            pair.unwrap_or([0; 2])
        };
        for i in 0..LANES {
            let index = index[i] as usize;
            [corners[0][i], corners[1][i]] = pair(index);
            [corners[2][i], corners[3][i]] = pair(index.wrapping_add(levels.stride[i] as usize));
        }
        Quads { corners, weight: [right, lower] }
    }
}

impl LaneLevels {
    /// Words from the first texel of all to those at `x`, `y`.
    #[inline(always)]
    fn index(&self, x: &[i32; LANES], y: &[i32; LANES]) -> [u32; LANES] {
        let mut index = [0; LANES];
        for i in 0..LANES {
            index[i] = self.start[i].wrapping_add(y[i].wrapping_mul(self.stride[i])).wrapping_add(x[i]) as u32;
        }
        index
    }
}

/// First texel and size of the window of level `level`.
fn window(texture: &checked::Texture, level: u32) -> ([u32; 2], [u32; 2]) {
    let extent = texture.level_size(level);
    let offset = [0, 1].map(|axis| (texture.offset[axis] >> level).min(extent[axis] - 1));
    let size = [0, 1].map(|axis| (texture.window[axis] >> level).max(1).min(extent[axis] - offset[axis]));
    (offset, size)
}

/// The texels that a window of `size` is framed with, before its first and behind its last.
fn frame_of(wrap: Wrap, size: usize) -> [usize; 2] {
    if wrap == Wrap::Repeat { [size - 1, 0] } else { [0, size - 1] }
}

/// Decodes the texels from `first` on of a row.
fn decode_row(words: &[u32], first: usize, format: TextureFormat, palette: &[u32], texels: &mut [u32]) {
    match format {
        TextureFormat::Rgba8888 => texels.copy_from_slice(&words[first..first + texels.len()]),
        TextureFormat::Rgb565 => unpack::<16>(words, first, texels, rgb565),
        TextureFormat::Rgba5551 => unpack::<16>(words, first, texels, rgba5551),
        TextureFormat::Rgba4444 => unpack::<16>(words, first, texels, rgba4444),
        TextureFormat::Palette8 => {
            let palette = &palette[..256];
            unpack::<8>(words, first, texels, |index| palette[index as usize]);
        }
        TextureFormat::Palette4 => {
            let palette = &palette[..16];
            unpack::<4>(words, first, texels, |index| palette[index as usize]);
        }
    }
}

/// Texels of `BITS` bits, the first in the lowest bits of a word.
fn unpack<const BITS: usize>(words: &[u32], first: usize, texels: &mut [u32], colour: impl Fn(u32) -> u32) {
    for (x, texel) in (first..).zip(texels) {
        let shift = x * BITS % 32;
        *texel = colour(words[x * BITS / 32] >> shift & ((1 << BITS) - 1));
    }
}

/// 15:11 red, 10:5 green, 4:0 blue; opaque.
fn rgb565(texel: u32) -> u32 {
    let green = texel >> 5 & 63;
    rgba([five(texel >> 11), green * 4 + green / 16, five(texel & 31), 255])
}

/// 15 alpha, 14:10 red, 9:5 green, 4:0 blue.
fn rgba5551(texel: u32) -> u32 {
    rgba([five(texel >> 10 & 31), five(texel >> 5 & 31), five(texel & 31), (texel >> 15) * 255])
}

/// 15:12 alpha, 11:8 red, 7:4 green, 3:0 blue.
fn rgba4444(texel: u32) -> u32 {
    rgba([8, 4, 0, 12].map(|shift| 17 * (texel >> shift & 15)))
}

/// A level of 5 bits, its top bits repeated below them.
fn five(level: u32) -> u32 {
    level * 8 + level / 4
}

/// A word of levels.
fn rgba(levels: [u32; 4]) -> u32 {
    u32::from_le_bytes(levels.map(|level| level as u8))
}
