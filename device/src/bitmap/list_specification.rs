//! The units of lists as one would write them down: every pixel by itself.
//!
//! Duties: says what [`super::fill_list`], [`super::copy_list`], [`super::segments`] and [`super::expand`] must come to; runs
//! in their place with [`crate::Kernel::Specification`]. Inputs, outputs and clocks: theirs.

use super::specification::{load, operate, store};
use zga_firmware::checked::{Canvas, ClipBox, CopyList, ExpandList, FillList, SegmentList};

/// Columns and rows of a box, row by row.
fn pixels(part: ClipBox) -> impl Iterator<Item = (i32, i32)> {
    (part.y1..part.y2).flat_map(move |y| (part.x1..part.x2).map(move |x| (x, y)))
}

/// Combines a source with a pixel of the canvas.
fn put(memory: &mut [u32], canvas: &Canvas<'_>, (x, y): (i32, i32), source: u32) {
    let (x, y) = (x as u32, y as u32);
    let old = load(memory, &canvas.surface, x, y);
    let new = operate(canvas.operation, source, old);
    store(memory, &canvas.surface, x, y, (new & canvas.planes) | (old & !canvas.planes));
}

/// Fills rectangles.
pub(super) fn fill_list(memory: &mut [u32], list: &FillList<'_>) {
    for rectangle in list.rectangles() {
        for clip in list.canvas.clip_boxes() {
            for place in pixels(clip.cut(rectangle.as_box())) {
                put(memory, &list.canvas, place, list.value);
            }
        }
    }
}

/// Copies a part that lies in the surface and whose pixels have a source.
pub(super) fn copy_part(memory: &mut [u32], list: &CopyList<'_>, part: ClipBox) {
    let [dx, dy] = list.offset;
    let from = |(x, y): (i32, i32)| load(memory, &list.source, (x + dx) as u32, (y + dy) as u32);
    let sources: Vec<u32> = pixels(part).map(from).collect();
    for (place, source) in pixels(part).zip(sources) {
        put(memory, &list.canvas, place, source);
    }
}

/// Draws lines, pixel after pixel from their first on; returns how many pixels lay in clip boxes.
pub(super) fn segments(memory: &mut [u32], list: &SegmentList<'_>) -> u64 {
    let mut lit = 0;
    for segment in list.segments() {
        let [dx, dy] = [segment.to.x - segment.from.x, segment.to.y - segment.from.y];
        let steep = dy.abs() >= dx.abs();
        let (long, short) = if steep { (dy, dx) } else { (dx, dy) };
        let (n, m) = (long.abs(), short.abs());
        for clip in list.canvas.clip_boxes() {
            let (mut x, mut y) = (segment.from.x, segment.from.y);
            let mut error = -n - i32::from(long < 0);
            for _ in 0..n + i32::from(segment.last) {
                if clip.x1 <= x && x < clip.x2 && clip.y1 <= y && y < clip.y2 {
                    put(memory, &list.canvas, (x, y), list.value);
                    lit += 1;
                }
                error += 2 * m;
                let across = error >= 0;
                if across {
                    error -= 2 * n;
                }
                if across || !steep {
                    x += dx.signum();
                }
                if across || steep {
                    y += dy.signum();
                }
            }
        }
    }
    lit
}

/// Draws bitmaps.
pub(super) fn expand(memory: &mut [u32], list: &ExpandList<'_>) {
    for bitmap in list.bitmaps() {
        for clip in list.canvas.clip_boxes() {
            for (x, y) in pixels(clip.cut(bitmap.place.as_box())) {
                let [column, row] = [x - bitmap.place.x, y - bitmap.place.y].map(|pixels| pixels as usize);
                let word = bitmap.rows[row * bitmap.row_words() + column / 32];
                let value = if word >> (column % 32) & 1 == 1 { Some(list.foreground) } else { list.background };
                if let Some(value) = value {
                    put(memory, &list.canvas, (x, y), value);
                }
            }
        }
    }
}
