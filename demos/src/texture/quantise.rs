//! Palettes: a picture in at most 256 colours.
//!
//! Median cut: a box of all colours is cut in two, and again the box with the greatest square error, at the mean of
//! the channel that errs most. Whole numbers throughout and ties to the first, so every host finds the same palette. A
//! picture that has few enough colours keeps them all.

use std::collections::HashMap;
use std::ops::Range;

use super::Picture;
use crate::scene::Colour;

/// Most different colours that are told apart; a picture with more is divided into cells of the colour space first.
const MOST_DISTINCT: usize = 1 << 16;
/// Bits of a channel that a cell's number has: red, green, blue, alpha.
const CELL_BITS: [u32; 4] = [5, 5, 5, 3];
const CELLS: usize = 1 << (5 + 5 + 5 + 3);

/// A picture as places in a palette.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Indexed {
    /// 1..=256 colours.
    pub palette: Vec<Colour>,
    /// For each texel, row by row, a place in the palette.
    pub indices: Vec<u8>,
}

impl Picture {
    /// The picture in at most `most` (1..=256) colours of its own: exact if it has no more.
    #[must_use]
    pub fn quantised(&self, most: usize) -> Indexed {
        let colours = Shades::of(self);
        let palette = median_cut(&colours.list, most.clamp(1, 256));
        colours.indexed(self, palette)
    }

    /// The picture in given colours (of which the first 256 count): each texel's nearest, of equally near ones the
    /// first. Without a colour all texels are white. In a picture of more than 65,536 different colours, those that
    /// agree in their upper bits take their mean's.
    #[must_use]
    pub fn in_palette(&self, palette: &[Colour]) -> Indexed {
        let palette = if palette.is_empty() { vec![[255; 4]] } else { palette[..palette.len().min(256)].to_vec() };
        Shades::of(self).indexed(self, palette)
    }
}

/// The different colours of a picture, in rising order.
struct Shades {
    list: Vec<Shade>,
    /// For each cell, its place in `list`; without it each shade is one colour.
    cells: Option<Vec<u32>>,
}

#[derive(Clone, Copy)]
struct Shade {
    colour: Colour,
    texels: u64,
}

impl Shades {
    fn of(picture: &Picture) -> Self {
        let mut counts: HashMap<Colour, u64> = HashMap::new();
        // Neighbours are often the same, and one look-up does for all of them.
        for run in picture.pixels.chunk_by(|a, b| a == b) {
            *counts.entry(run[0]).or_insert(0) += run.len() as u64;
            if counts.len() > MOST_DISTINCT {
                return Self::of_cells(picture);
            }
        }
        let mut list: Vec<Shade> = counts.into_iter().map(|(colour, texels)| Shade { colour, texels }).collect();
        list.sort_unstable_by_key(|shade| shade.colour);
        Self { list, cells: None }
    }

    fn of_cells(picture: &Picture) -> Self {
        let mut sums = vec![[0_u64; 5]; CELLS];
        for pixel in &picture.pixels {
            let sum = &mut sums[cell(*pixel)];
            sum[4] += 1;
            for channel in 0..4 {
                sum[channel] += u64::from(pixel[channel]);
            }
        }
        let mut list = Vec::new();
        let mut cells = vec![0; CELLS];
        for (cell, [sums @ .., texels]) in sums.into_iter().enumerate().filter(|(_, sum)| sum[4] > 0) {
            cells[cell] = list.len() as u32;
            list.push(Shade { colour: sums.map(|sum| mean(sum, texels)), texels });
        }
        Self { list, cells: Some(cells) }
    }

    fn place(&self, colour: Colour) -> usize {
        match &self.cells {
            Some(cells) => cells[cell(colour)] as usize,
            None => self.list.binary_search_by_key(&colour, |shade| shade.colour).unwrap_or_default(),
        }
    }

    fn indexed(&self, picture: &Picture, palette: Vec<Colour>) -> Indexed {
        let nearest: Vec<u8> = self.list.iter().map(|shade| nearest(&palette, shade.colour)).collect();
        let mut indices = Vec::with_capacity(picture.pixels.len());
        for run in picture.pixels.chunk_by(|a, b| a == b) {
            indices.resize(indices.len() + run.len(), nearest[self.place(run[0])]);
        }
        Indexed { palette, indices }
    }
}

/// Number of the cell that a colour lies in.
fn cell(colour: Colour) -> usize {
    let join = |number: u32, (channel, bits): (u8, u32)| number << bits | u32::from(channel) >> (8 - bits);
    colour.into_iter().zip(CELL_BITS).fold(0, join) as usize
}

fn mean(sum: u64, count: u64) -> u8 {
    ((sum + count / 2) / count) as u8
}

/// Place of the colour of a palette that is nearest, by the sum of squares.
fn nearest(palette: &[Colour], colour: Colour) -> u8 {
    let square = |known: &Colour| -> u32 { (0..4).map(|i| u32::from(known[i].abs_diff(colour[i])).pow(2)).sum() };
    let found = (0..=255_u8).zip(palette).min_by_key(|(_, known)| square(known));
    found.map_or(0, |(place, _)| place)
}

/// Shades that are to have one colour.
struct Group {
    range: Range<usize>,
    /// The channel that errs most, and the sum of its squared errors, rounded up: 0 only where there is none.
    channel: usize,
    error: u128,
}

impl Group {
    fn of(shades: &[Shade], range: Range<usize>) -> Self {
        let shades = &shades[range.clone()];
        let error = |channel: usize| {
            let (mut texels, mut sum, mut squares) = (0_u128, 0_u128, 0_u128);
            for shade in shades {
                let (value, count) = (u128::from(shade.colour[channel]), u128::from(shade.texels));
                texels += count;
                sum += value * count;
                squares += value * value * count;
            }
            (squares * texels - sum * sum).div_ceil(texels.max(1))
        };
        let errors = [0, 1, 2, 3].map(error);
        // The last of the greatest would be found by max_by_key alone.
        let channel = (0..4).rev().max_by_key(|channel| errors[*channel]).unwrap_or_default();
        Self { range, channel, error: errors[channel] }
    }
}

/// At most `most` colours for these shades, in rising order.
fn median_cut(shades: &[Shade], most: usize) -> Vec<Colour> {
    let mut shades = shades.to_vec();
    let mut groups = vec![Group::of(&shades, 0..shades.len())];
    while groups.len() < most {
        let worst = (0..groups.len()).rev().max_by_key(|group| groups[*group].error).unwrap_or_default();
        let Group { range, channel, error } = &groups[worst];
        if *error == 0 {
            break;
        }
        let (start, end, channel) = (range.start, range.end, *channel);
        let part = &mut shades[start..end];
        let texels: u64 = part.iter().map(|shade| shade.texels).sum();
        let sum: u64 = part.iter().map(|shade| u64::from(shade.colour[channel]) * shade.texels).sum();
        // Rounded down: some shade is above the mean and some is not, since they differ.
        let middle = sum / texels;
        part.sort_by_key(|shade| (shade.colour[channel], shade.colour));
        let cut = start + part.partition_point(|shade| u64::from(shade.colour[channel]) <= middle);
        groups[worst] = Group::of(&shades, start..cut);
        groups.push(Group::of(&shades, cut..end));
    }
    let colour = |group: &Group| {
        let shades = &shades[group.range.clone()];
        let texels = shades.iter().map(|shade| shade.texels).sum();
        std::array::from_fn(|channel| {
            mean(shades.iter().map(|shade| u64::from(shade.colour[channel]) * shade.texels).sum(), texels)
        })
    };
    let mut palette: Vec<Colour> = groups.iter().map(colour).collect();
    palette.sort_unstable();
    palette.dedup();
    palette
}
