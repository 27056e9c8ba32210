//! Copy list: rectangles with one displacement through a raster operation, each cut to clip boxes.
//!
//! Duties and clocks: see [`super`]; as a copy of each part by itself: 1 clock for each line read, 1 for each line written,
//! and 1 more for each of those where what is there has to be read. A source that decides nothing is not read.
//! Inputs: [`CopyList`] from the firmware. Outputs: pixels. Specification: [`super::list_specification`].
//!
//! A part is an entry in one clip box, where its pixels have a source. Each part is read before it is written; what one
//! has written, the next can read.

use super::canvas::{Painted, parts};
use super::combine::{Masks, Pixel};
use super::copy::move_pixels;
use super::{Bitmap, Span, charge, list_specification};
use crate::probe::account::Account;
use zga_abi::Counter;
use zga_firmware::checked::{ClipBox, CopyList, Image};

/// A part of an image as rows of its own.
fn rows_of(image: &Image, part: ClipBox) -> Span {
    let bytes = u64::from(image.format.bytes());
    Span {
        base: u64::from(image.base) + part.y1 as u64 * u64::from(image.pitch) + part.x1 as u64 * bytes,
        pitch: u64::from(image.pitch),
        row_bytes: (part.x2 - part.x1) as u64 * bytes,
        rows: (part.y2 - part.y1) as u64,
    }
}

impl Bitmap {
    /// Copies rectangles.
    pub(crate) fn copy_list(&mut self, memory: &mut [u32], list: &CopyList<'_>, account: &mut Account) {
        self.clips.clear();
        self.clips.extend(list.canvas.clip_boxes());
        let clips = std::mem::take(&mut self.clips);
        let (mut painted, mut read) = (Painted::default(), Painted::default());
        let reach = list.reach();
        let [x, y] = list.offset;
        for rectangle in list.rectangles() {
            for part in parts(rectangle.as_box().cut(reach), &clips) {
                let from = ClipBox { x1: part.x1 + x, y1: part.y1 + y, x2: part.x2 + x, y2: part.y2 + y };
                painted.add(&list.canvas.surface, part);
                read.add(&list.source, from);
                if self.specification {
                    list_specification::copy_part(memory, list, part);
                } else {
                    self.copy_part(memory, list, from, part);
                }
            }
        }
        self.clips = clips;
        let there = u64::from(list.canvas.reads_destination());
        let source = u64::from(list.canvas.operation.reads_source());
        account.add(Counter::BitmapEntries, list.rectangles().len() as u64);
        account.add(Counter::BitmapCombined, there * painted.pixels);
        charge(account, painted.pixels, source * read.lines + (1 + there) * painted.lines);
    }

    fn copy_part(&mut self, memory: &mut [u32], list: &CopyList<'_>, from: ClipBox, part: ClipBox) {
        let (from, to) = (rows_of(&list.source, from), rows_of(&list.canvas.surface, part));
        match list.source.format.bytes() {
            4 => self.copy_rows::<u32>(memory, list, from, to),
            2 => self.copy_rows::<u16>(bytemuck::cast_slice_mut(memory), list, from, to),
            _ => self.copy_rows::<u8>(bytemuck::cast_slice_mut(memory), list, from, to),
        }
    }

    fn copy_rows<P: Pixel>(&mut self, memory: &mut [P], list: &CopyList<'_>, from: Span, to: Span) {
        let masks = Masks::<P>::new(list.canvas.operation, list.canvas.planes);
        if masks.is_copy() {
            move_pixels(memory, from, to, &mut self.scratch);
        } else {
            self.combine_rows(memory, masks, from, to);
        }
    }
}
