//! Expand: bitmaps of 1 bit a pixel in two values through a raster operation, each cut to clip boxes.
//!
//! Duties and clocks: see [`super`]; as a fill of each part by itself: 1 clock for each line written, and 1 more where what
//! is there has to be read, which it is where zeros stay. The bits come from the front end, which has charged them.
//! Inputs: [`ExpandList`] from the firmware. Outputs: pixels. Specification: [`super::list_specification`].
//!
//! Fast way: ones and zeros are each drawn as a raster operation under the mask of their bits, eight pixels at a time
//! without a branch: where a bit is not set all of the pixel is kept.

use super::canvas::{Grid, Painted, parts};
use super::combine::{Masks, Pixel};
use super::{Bitmap, charge, list_specification};
use crate::probe::account::Account;
use zga_abi::Counter;
use zga_firmware::checked::{Bitmap as Bits, ClipBox, ExpandList};

/// Pixels that are drawn at a time.
const GROUP: usize = 8;

impl Bitmap {
    /// Draws bitmaps.
    pub(crate) fn expand(&mut self, memory: &mut [u32], list: &ExpandList<'_>, account: &mut Account) {
        self.clips.clear();
        self.clips.extend(list.canvas.clip_boxes());
        let (entries, painted) = if self.specification {
            list_specification::expand(memory, list);
            paint(list, &self.clips, |_, _| ())
        } else {
            match list.canvas.surface.format.bytes() {
                4 => expand::<u32>(memory, list, &self.clips),
                2 => expand::<u16>(bytemuck::cast_slice_mut(memory), list, &self.clips),
                _ => expand::<u8>(bytemuck::cast_slice_mut(memory), list, &self.clips),
            }
        };
        let there = u64::from(list.canvas.reads_destination() || list.background.is_none());
        account.add(Counter::BitmapEntries, entries);
        account.add(Counter::BitmapExpanded, painted.pixels);
        account.add(Counter::BitmapCombined, there * painted.pixels);
        charge(account, painted.pixels, (1 + there) * painted.lines);
    }
}

/// Calls `paint` for each part of each bitmap; counts bitmaps and parts.
#[inline(always)]
fn paint(list: &ExpandList<'_>, clips: &[ClipBox], mut paint: impl FnMut(&Bits<'_>, ClipBox)) -> (u64, Painted) {
    let (mut entries, mut painted) = (0, Painted::default());
    for bits in list.bitmaps() {
        entries += 1;
        for part in parts(bits.place.as_box(), clips) {
            painted.add(&list.canvas.surface, part);
            paint(&bits, part);
        }
    }
    (entries, painted)
}

fn expand<P: Pixel>(memory: &mut [P], list: &ExpandList<'_>, clips: &[ClipBox]) -> (u64, Painted) {
    let grid = Grid::of(&list.canvas.surface);
    let masks = Masks::<P>::new(list.canvas.operation, list.canvas.planes);
    let ones = masks.under(P::of(list.foreground));
    match list.background.map(|value| masks.under(P::of(value))) {
        None => paint(list, clips, |bits, part| {
            rows(memory, grid, bits, part, |pixels, ones_here, _| draw(pixels, ones_here, ones));
        }),
        Some(zeros) => paint(list, clips, |bits, part| {
            rows(memory, grid, bits, part, |pixels, ones_here, valid| {
                draw(pixels, ones_here, ones);
                draw(pixels, valid & !ones_here, zeros);
            });
        }),
    }
}

/// Calls `draw` for each run of up to 32 pixels of a part: the pixels from the run's first on, its bits, and all bits that
/// it has.
#[inline(always)]
fn rows<P: Pixel>(
    memory: &mut [P],
    grid: Grid,
    bits: &Bits<'_>,
    part: ClipBox,
    mut draw: impl FnMut(&mut [P], u32, u32),
) {
    let (row_words, width) = (bits.row_words(), (part.x2 - part.x1) as usize);
    let [skipped, above] = [part.x1 - bits.place.x, part.y1 - bits.place.y].map(|pixels| pixels as usize);
    let (word, shift) = (skipped / 32, skipped % 32);
    let mut at = grid.at(part.x1, part.y1);
    for row in bits.rows.chunks_exact(row_words).skip(above).take((part.y2 - part.y1) as usize) {
        let row = &row[word..];
        let mut done = 0;
        while done < width {
            let place = (shift + done) / 32;
            let low = (shift + done) % 32;
            let count = (32 - low).min(width - done);
            let valid = u32::MAX >> (32 - count);
            draw(&mut memory[at + done..], (row[place] >> low) & valid, valid);
            done += count;
        }
        at += grid.pitch;
    }
}

/// Draws the pixels whose bits are set: `(d & keep) ^ flip`.
#[inline(always)]
fn draw<P: Pixel>(mut pixels: &mut [P], mut bits: u32, [keep, flip]: [P; 2]) {
    let (none, all) = (P::of(0), P::of(u32::MAX));
    while bits != 0 {
        if pixels.len() < GROUP {
            // The last pixels of memory.
            for (place, pixel) in pixels.iter_mut().enumerate() {
                if bits >> place & 1 == 1 {
                    *pixel = (*pixel & keep) ^ flip;
                }
            }
            return;
        }
        let (group, rest) = pixels.split_at_mut(GROUP);
        for (place, pixel) in group.iter_mut().enumerate() {
            let mask = if bits & (1 << place) != 0 { all } else { none };
            *pixel = (*pixel & (keep | !mask)) ^ (flip & mask);
        }
        (pixels, bits) = (rest, bits >> GROUP);
    }
}
