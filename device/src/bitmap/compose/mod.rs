//! Compose: a source through a mask put together with what is there, in entries cut to clip boxes.
//!
//! Source: T. Porter, T. Duff, "Compositing Digital Images", SIGGRAPH 1984, in the form of the X Rendering Extension, and with
//! the 8-bit arithmetic that its renderers share.
//!
//! Duties and clocks: see [`super`]; for each part 1 clock for each line written, 1 for each line of what is there where the
//! operator needs it, and 1 for each line of source and mask, or 1 for each pixel of one that is transformed or repeated: its
//! pixels are fetched one by one. Pixels in entries come from the front end, which has charged them.
//! Inputs: [`Compose`] from the firmware. Outputs: pixels. What a pixel comes to: [`zga_abi::packet::compose`].
//!
//! | file | stage |
//! | --- | --- |
//! | [`fetch`] | rows of pictures to ARGB words, and back |
//! | [`mix`] | words of source, mask and destination into one, 16 at a time |
//! | [`specification`] | the whole of it, pixel by pixel |
//!
//! A row of a part is done in runs of [`RUN`] pixels, so that all that a run needs stays close.

mod fetch;
mod mix;
mod specification;
#[cfg(test)]
mod tests;

use super::canvas::{Grid, Painted, parts};
use super::{Bitmap, charge};
use crate::probe::account::Account;
use fearless_simd::{Level, dispatch};
use mix::Mix;
use zga_abi::Counter;
use zga_abi::format::{ComposeOperator, Repeat};
use zga_firmware::checked::{ClipBox, Compose, ComposeEntry, Mask, Paint, Picture};

/// Pixels of a run: a multiple of the 16 that are mixed at a time.
const RUN: usize = 256;

/// ARGB words of a run.
struct Runs {
    source: [u32; RUN],
    mask: [u32; RUN],
    there: [u32; RUN],
}

impl Bitmap {
    /// Composes.
    pub(crate) fn compose(&mut self, memory: &mut [u32], compose: &Compose<'_>, account: &mut Account) {
        self.clips.clear();
        self.clips.extend(compose.clip_boxes());
        let onto = &compose.onto;
        let mut painted = Painted::default();
        let (mut entries, mut read) = (0, 0);
        let mut painter = Painter::new(compose);
        for entry in compose.entries() {
            entries += 1;
            for part in parts(entry.place.as_box(), &self.clips) {
                painted.add(&onto.image, part);
                read += lines_read(compose, part);
                match self.level {
                    Some(level) => painter.paint(level, memory, compose, &entry, part),
                    None => specification::paint(memory, compose, &entry, part),
                }
            }
        }
        let there = u64::from(compose.operator.reads_destination());
        account.add(Counter::BitmapEntries, entries);
        account.add(Counter::BitmapComposed, painted.pixels);
        charge(account, painted.pixels, read + (1 + there) * painted.lines);
    }
}

/// Clocks of reading source and mask of a part.
fn lines_read(compose: &Compose<'_>, part: ClipBox) -> u64 {
    let source = compose.operator.reads_source().then_some(&compose.source);
    let mask = match &compose.mask {
        Mask::Paint(paint) if compose.operator.reads_source() => Some(paint),
        _ => None,
    };
    [source, mask].into_iter().flatten().map(|paint| paint_lines(paint, part)).sum()
}

/// Clocks of reading a paint for a part.
fn paint_lines(paint: &Paint, part: ClipBox) -> u64 {
    let Paint::Picture(sampled) = paint else { return 0 };
    if sampled.transform.is_some() || sampled.repeat != Repeat::None {
        return (part.x2 - part.x1) as u64 * (part.y2 - part.y1) as u64;
    }
    let ([x, y], image) = (sampled.offset, &sampled.picture.image);
    let whole = ClipBox { x1: 0, y1: 0, x2: image.width as i32, y2: image.height as i32 };
    let from = ClipBox { x1: part.x1 + x, y1: part.y1 + y, x2: part.x2 + x, y2: part.y2 + y }.cut(whole);
    let mut read = Painted::default();
    if !from.is_empty() {
        read.add(image, from);
    }
    read.lines
}

/// Draws parts of one composition.
struct Painter {
    mix: Mix,
    runs: Runs,
}

impl Painter {
    fn new(compose: &Compose<'_>) -> Painter {
        let colour = |paint: &Paint| if let Paint::Colour(argb) = paint { [*argb; RUN] } else { [0; RUN] };
        let mask = if let Mask::Paint(paint) = &compose.mask { colour(paint) } else { [0; RUN] };
        let runs = Runs { source: colour(&compose.source), mask, there: [0; RUN] };
        Painter { mix: Mix::new(compose), runs }
    }

    fn paint(
        &mut self,
        level: Level,
        memory: &mut [u32],
        compose: &Compose<'_>,
        entry: &ComposeEntry<'_>,
        part: ClipBox,
    ) {
        let Painter { mix, runs } = self;
        let Picture { image, format } = compose.onto;
        let grid = Grid::of(&image);
        let reads = compose.operator.reads_destination();
        // Nothing has to be mixed: the source's words are the result.
        let plain = compose.operator == ComposeOperator::Source && compose.mask == Mask::None;
        for y in part.y1..part.y2 {
            let mut x = part.x1;
            while x < part.x2 {
                let count = ((part.x2 - x) as usize).min(RUN);
                if compose.operator.reads_source() {
                    if let Paint::Picture(source) = &compose.source {
                        fetch::sampled(memory, source, [x, y], &mut runs.source[..count]);
                    }
                    match &compose.mask {
                        Mask::Paint(Paint::Picture(mask)) => {
                            fetch::sampled(memory, mask, [x, y], &mut runs.mask[..count]);
                        }
                        Mask::Inline(format) => fetch::inline(entry, *format, [x, y], &mut runs.mask[..count]),
                        Mask::None | Mask::Paint(Paint::Colour(_)) => {}
                    }
                }
                let at = grid.at(x, y);
                if plain {
                    fetch::store(memory, format, at, &runs.source[..count]);
                    x += count as i32;
                    continue;
                }
                if reads {
                    fetch::row(memory, format, at, &mut runs.there[..count]);
                }
                let whole = count.next_multiple_of(16);
                let [source, mask] = [&runs.source[..whole], &runs.mask[..whole]];
                dispatch!(level, simd => mix.mix(simd, source, mask, &mut runs.there[..whole]));
                fetch::store(memory, format, at, &runs.there[..count]);
                x += count as i32;
            }
        }
    }
}
