//! Fill list: rectangles of one value through a raster operation, each cut to clip boxes.
//!
//! Duties and clocks: see [`super`]; as a fill of each part by itself: 1 clock for each line written, and 1 more where what
//! is there has to be read. Finding the parts costs nothing: an entry takes the front end two clocks, which is longer.
//! Inputs: [`FillList`] from the firmware. Outputs: pixels. Specification: [`super::list_specification`].

use super::canvas::{Grid, Painted, parts};
use super::combine::{Masks, Pixel};
use super::fill::fill_row;
use super::{Bitmap, charge, list_specification};
use crate::probe::account::Account;
use zga_abi::Counter;
use zga_firmware::checked::{ClipBox, FillList};

impl Bitmap {
    /// Fills rectangles.
    pub(crate) fn fill_list(&mut self, memory: &mut [u32], list: &FillList<'_>, account: &mut Account) {
        self.clips.clear();
        self.clips.extend(list.canvas.clip_boxes());
        let painted = if self.specification {
            list_specification::fill_list(memory, list);
            paint(list, &self.clips, |_| ())
        } else {
            match list.canvas.surface.format.bytes() {
                4 => fill::<u32>(memory, list, &self.clips),
                2 => fill::<u16>(bytemuck::cast_slice_mut(memory), list, &self.clips),
                _ => fill::<u8>(bytemuck::cast_slice_mut(memory), list, &self.clips),
            }
        };
        let there = u64::from(list.canvas.reads_destination());
        account.add(Counter::BitmapEntries, list.rectangles().len() as u64);
        account.add(Counter::BitmapCombined, there * painted.pixels);
        charge(account, painted.pixels, (1 + there) * painted.lines);
    }
}

/// Calls `paint` for each part of each rectangle, and counts them.
#[inline(always)]
fn paint(list: &FillList<'_>, clips: &[ClipBox], mut paint: impl FnMut(ClipBox)) -> Painted {
    let mut painted = Painted::default();
    for rectangle in list.rectangles() {
        for part in parts(rectangle.as_box(), clips) {
            painted.add(&list.canvas.surface, part);
            paint(part);
        }
    }
    painted
}

fn fill<P: Pixel>(memory: &mut [P], list: &FillList<'_>, clips: &[ClipBox]) -> Painted {
    let grid = Grid::of(&list.canvas.surface);
    let [keep, flip] = Masks::<P>::new(list.canvas.operation, list.canvas.planes).under(P::of(list.value));
    let mut rows = |part: ClipBox, draw: fn(&mut [P], P, P)| {
        let width = (part.x2 - part.x1) as usize;
        let mut at = grid.at(part.x1, part.y1);
        for _ in part.y1..part.y2 {
            draw(&mut memory[at..at + width], keep, flip);
            at += grid.pitch;
        }
    };
    if keep == P::of(0) {
        paint(list, clips, |part| rows(part, |row, _, flip| fill_row(row, flip)))
    } else {
        let combine = |row: &mut [P], keep, flip| row.iter_mut().for_each(|pixel| *pixel = (*pixel & keep) ^ flip);
        paint(list, clips, |part| rows(part, combine))
    }
}
