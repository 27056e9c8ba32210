//! Fetch: rows of pictures as ARGB words, and words back to rows.
//!
//! Inputs from: video memory, entries. Outputs to: [`super`], video memory. Clocks: those that [`super`] charges.

use zga_abi::format::{PictureFormat, Repeat};
use zga_abi::packet::compose;
use zga_firmware::checked::{ComposeEntry, Sampled};

use super::super::canvas::Grid;

/// Fetches pixels that lie one after the other from the pixel with index `at` on.
pub(super) fn row(memory: &[u32], format: PictureFormat, at: usize, words: &mut [u32]) {
    match format {
        PictureFormat::Argb8888 => words.copy_from_slice(&memory[at..at + words.len()]),
        PictureFormat::Xrgb8888 => decode::<u32>(memory, PictureFormat::Xrgb8888, at, words),
        PictureFormat::Xbgr8888 => decode::<u32>(memory, PictureFormat::Xbgr8888, at, words),
        PictureFormat::Abgr8888 => decode::<u32>(memory, PictureFormat::Abgr8888, at, words),
        PictureFormat::Rgb565 => decode::<u16>(bytemuck::cast_slice(memory), PictureFormat::Rgb565, at, words),
        PictureFormat::Alpha8 => decode::<u8>(bytemuck::cast_slice(memory), PictureFormat::Alpha8, at, words),
    }
}

/// The format is a constant wherever this becomes a part of.
#[inline(always)]
fn decode<P: Copy + Into<u32>>(pixels: &[P], format: PictureFormat, at: usize, words: &mut [u32]) {
    for (word, &pixel) in words.iter_mut().zip(&pixels[at..]) {
        *word = format.decode(pixel.into());
    }
}

/// Stores pixels one after the other from the pixel with index `at` on.
pub(super) fn store(memory: &mut [u32], format: PictureFormat, at: usize, words: &[u32]) {
    match format {
        PictureFormat::Argb8888 => memory[at..at + words.len()].copy_from_slice(words),
        PictureFormat::Xrgb8888 => encode(&mut memory[at..], PictureFormat::Xrgb8888, words, |pixel| pixel),
        PictureFormat::Xbgr8888 => encode(&mut memory[at..], PictureFormat::Xbgr8888, words, |pixel| pixel),
        PictureFormat::Abgr8888 => encode(&mut memory[at..], PictureFormat::Abgr8888, words, |pixel| pixel),
        PictureFormat::Rgb565 => {
            let pixels: &mut [u16] = bytemuck::cast_slice_mut(memory);
            encode(&mut pixels[at..], PictureFormat::Rgb565, words, |pixel| pixel as u16);
        }
        PictureFormat::Alpha8 => {
            let pixels: &mut [u8] = bytemuck::cast_slice_mut(memory);
            encode(&mut pixels[at..], PictureFormat::Alpha8, words, |pixel| pixel as u8);
        }
    }
}

/// The format is a constant wherever this becomes a part of.
#[inline(always)]
fn encode<P>(pixels: &mut [P], format: PictureFormat, words: &[u32], narrow: impl Fn(u32) -> P) {
    for (pixel, &word) in pixels.iter_mut().zip(words) {
        *pixel = narrow(format.encode(word));
    }
}

/// Fetches the pixels of a picture for as many pixels from `place` to the right.
pub(super) fn sampled(memory: &[u32], sampled: &Sampled, place: [i32; 2], words: &mut [u32]) {
    let [i, j] = [0, 1].map(|axis| place[axis] + sampled.offset[axis]);
    if sampled.transform.is_some() {
        transformed(memory, sampled, [i, j], words);
        return;
    }
    let image = &sampled.picture.image;
    let Some(row) = inside(sampled.repeat, j.into(), image.height) else {
        words.fill(0);
        return;
    };
    let line = Line { memory, format: sampled.picture.format, at: Grid::of(image).at(0, row as i32) };
    let width = image.width as usize;
    match sampled.repeat {
        Repeat::None => {
            let [before, within, _] = split(i, words.len(), width);
            let (left, rest) = words.split_at_mut(before);
            let (middle, right) = rest.split_at_mut(within);
            left.fill(0);
            line.fetch(i.max(0) as usize, middle);
            right.fill(0);
        }
        Repeat::Pad => {
            let [before, within, _] = split(i, words.len(), width);
            let (left, rest) = words.split_at_mut(before);
            let (middle, right) = rest.split_at_mut(within);
            left.fill(line.pixel(0));
            line.fetch(i.max(0) as usize, middle);
            right.fill(line.pixel(width - 1));
        }
        Repeat::Normal if width == 1 => words.fill(line.pixel(0)),
        Repeat::Normal => {
            let mut column = i.rem_euclid(image.width as i32) as usize;
            let mut rest = words;
            while !rest.is_empty() {
                let count = (width - column).min(rest.len());
                let (now, then) = rest.split_at_mut(count);
                line.fetch(column, now);
                (column, rest) = (0, then);
            }
        }
        Repeat::Reflect => {
            for (word, i) in words.iter_mut().zip(i..) {
                *word = inside(Repeat::Reflect, i.into(), image.width).map_or(0, |column| line.pixel(column as usize));
            }
        }
    }
}

/// How many of `count` pixels from column `first` on lie left of a picture, in it, and right of it.
fn split(first: i32, count: usize, width: usize) -> [usize; 3] {
    let (first, count, width) = (i64::from(first), count as i64, width as i64);
    let before = (-first).clamp(0, count);
    let within = (width - first.max(0)).clamp(0, count - before);
    [before as usize, within as usize, (count - before - within) as usize]
}

/// A row of a picture.
#[derive(Clone, Copy)]
struct Line<'m> {
    memory: &'m [u32],
    format: PictureFormat,
    /// Index of its first pixel.
    at: usize,
}

impl Line<'_> {
    fn fetch(self, column: usize, words: &mut [u32]) {
        if !words.is_empty() {
            row(self.memory, self.format, self.at + column, words);
        }
    }

    fn pixel(self, column: usize) -> u32 {
        let at = self.at + column;
        let pixel = match self.format.bytes() {
            4 => self.memory[at],
            2 => u32::from(bytemuck::cast_slice::<u32, u16>(self.memory)[at]),
            _ => u32::from(bytemuck::cast_slice::<u32, u8>(self.memory)[at]),
        };
        self.format.decode(pixel)
    }
}

/// The place in a picture of `size` pixels that stands for a place anywhere; `None` where nothing does.
#[inline(always)]
fn inside(repeat: Repeat, place: i64, size: u32) -> Option<u32> {
    let length = i64::from(size);
    let place = match repeat {
        Repeat::None if !(0..length).contains(&place) => return None,
        Repeat::None => place,
        Repeat::Normal => place.rem_euclid(length),
        Repeat::Pad => place.clamp(0, length - 1),
        Repeat::Reflect => {
            let place = place.rem_euclid(2 * length);
            if place < length { place } else { 2 * length - 1 - place }
        }
    };
    Some(place as u32)
}

/// Fetches the pixels of a transformed picture, pixel by pixel; the steps from one to the next are exact.
fn transformed(memory: &[u32], sampled: &Sampled, [i, j]: [i32; 2], words: &mut [u32]) {
    let Some(transform) = sampled.transform else { return };
    let ([i, j], image) = ([i64::from(i), i64::from(j)], &sampled.picture.image);
    let first = |along: i32, across: i32, at: i32| {
        let [along, across, at] = [along, across, at].map(i64::from);
        along * i + across * j + ((along + across + 1) >> 1) + at - 1
    };
    let mut x = first(transform.xx, transform.xy, transform.x0);
    let mut y = first(transform.yx, transform.yy, transform.y0);
    let grid = Grid::of(image);
    for word in words {
        let place = (inside(sampled.repeat, x >> 16, image.width), inside(sampled.repeat, y >> 16, image.height));
        *word = match place {
            (Some(column), Some(row)) => {
                Line { memory, format: sampled.picture.format, at: grid.at(0, row as i32) }.pixel(column as usize)
            }
            _ => 0,
        };
        x += i64::from(transform.xx);
        y += i64::from(transform.yx);
    }
}

/// Takes the pixels of an entry for as many pixels from `place` to the right, all of which lie in it.
pub(super) fn inline(entry: &ComposeEntry<'_>, format: PictureFormat, place: [i32; 2], words: &mut [u32]) {
    let [column, line] = [place[0] - entry.place.x, place[1] - entry.place.y].map(|pixels| pixels as usize);
    let row_words = compose::row_words(entry.place.width as u32, format.bytes()) as usize;
    row(&entry.rows[line * row_words..][..row_words], format, column, words);
}
