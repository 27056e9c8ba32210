//! Lists as the server's drawing requests have them: rectangles, points, lines, letters, each through every box of a clip.

use zga_driver::{BitmapGlyph, Canvas, ClipBox, Drawable, ListRectangle, Point, Raster, Segment};

use super::Engine;
use super::closing::closes;
use super::draw::image;

/// What a list is drawn onto.
#[derive(Clone, Copy, Debug)]
pub struct Onto<'a> {
    /// Number of the pixmap.
    pub pixmap: usize,
    /// Where the drawable's upper left lies in the pixmap: added to every coordinate of the list.
    pub origin: [i32; 2],
    /// Added to the boxes of the clip, which are in the screen's coordinates.
    pub moved: [i32; 2],
    /// The clip: boxes that do not overlap.
    pub clips: &'a [ClipBox],
    /// Raster operation and plane mask.
    pub raster: Raster,
}

/// Points as the server has them.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// Places.
    pub list: &'a [Point],
    /// Each after the first is a step from the one before.
    pub steps: bool,
}

impl Points<'_> {
    /// The places from the drawable's origin on. Sums are those of the server's renderer, in 16 bits.
    fn places(self) -> impl Iterator<Item = Point> {
        let mut at = Point { x: 0, y: 0 };
        self.list.iter().map(move |point| {
            let before = if self.steps { at } else { Point { x: 0, y: 0 } };
            at = Point { x: before.x.wrapping_add(point.x), y: before.y.wrapping_add(point.y) };
            at
        })
    }
}

/// Room for what lists are made of, kept from call to call.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub clips: Vec<ClipBox>,
    /// Glyphs added up.
    pub mask: Vec<u8>,
    points: Vec<Point>,
    pub rectangles: Vec<ListRectangle>,
}

/// Work of rectangles, in pixels.
pub(super) fn work_of(rectangles: &[ListRectangle]) -> u64 {
    rectangles.iter().map(|one| ENTRY + u64::from(one.width) * u64::from(one.height)).sum()
}

impl Engine {
    /// Fills rectangles, in their order. False, here and below: the server's renderer has to do it.
    pub fn fill_list(&mut self, onto: &Onto<'_>, value: u32, rectangles: &[ListRectangle]) -> bool {
        self.list(onto, work_of(rectangles), |driver, canvas| driver.fill_list(canvas, value, rectangles))
    }

    /// Fills runs of pixels, each `widths` pixels long from its start to the right; those that are not longer than 0 are none.
    pub fn spans(&mut self, onto: &Onto<'_>, value: u32, starts: &[Point], widths: &[i32]) -> bool {
        let runs = starts.iter().zip(widths).filter(|(_, width)| **width > 0);
        let spans = runs.map(|(start, &width)| (*start, u16::try_from(width).ok()));
        self.rows(onto, value, spans)
    }

    /// Fills single pixels.
    pub fn points(&mut self, onto: &Onto<'_>, value: u32, points: Points<'_>) -> bool {
        self.rows(onto, value, points.places().map(|place| (place, Some(1))))
    }

    /// Fills runs of pixels; false if one is too long for a list.
    fn rows(&mut self, onto: &Onto<'_>, value: u32, mut rows: impl Iterator<Item = (Point, Option<u16>)>) -> bool {
        let mut rectangles = std::mem::take(&mut self.scratch.rectangles);
        let row = |(Point { x, y }, width): (Point, Option<u16>)| {
            width.map(|width| rectangles.push(ListRectangle { x, y, width, height: 1 })).is_some()
        };
        let drawn = rows.all(row) && self.fill_list(onto, value, &rectangles);
        rectangles.clear();
        self.scratch.rectangles = rectangles;
        drawn
    }

    /// Lines of one pixel's width, each by itself; `last`: with its last pixel.
    pub fn segments(&mut self, onto: &Onto<'_>, value: u32, segments: &[Segment], last: bool) -> bool {
        let work = segments.iter().map(|one| ENTRY + length([one.x1, one.y1], [one.x2, one.y2])).sum();
        self.list(onto, work, |driver, canvas| driver.segments(canvas, value, segments, last))
    }

    /// Lines of one pixel's width from point to point; `cap`: with the very last pixel, if it is not the first of a figure that
    /// closes (`closing.rs`), `corner` being the drawable's upper left in the clip's coordinates.
    pub fn polyline(&mut self, onto: &Onto<'_>, value: u32, points: Points<'_>, corner: [i32; 2], cap: bool) -> bool {
        let mut places = std::mem::take(&mut self.scratch.points);
        let line = if points.steps {
            places.extend(points.places());
            &places
        } else {
            points.list
        };
        let last = cap && !closes(line, corner, onto.clips);
        let work = line.windows(2).map(|two| ENTRY + length([two[0].x, two[0].y], [two[1].x, two[1].y])).sum();
        let drawn = self.list(onto, work, |driver, canvas| driver.polyline(canvas, value, line, last));
        places.clear();
        self.scratch.points = places;
        drawn
    }

    /// Letters: their set bits in one colour.
    pub fn letters<'b>(
        &mut self,
        onto: &Onto<'_>,
        value: u32,
        letters: &(impl Iterator<Item = BitmapGlyph<'b>> + Clone),
    ) -> bool {
        let work = letters.clone().map(|one| ENTRY + u64::from(one.width) * u64::from(one.height)).sum();
        self.list(onto, work, |driver, canvas| driver.expand(canvas, value, None, letters.clone()))
    }

    /// Encodes a list.
    fn list(
        &mut self,
        onto: &Onto<'_>,
        work: u64,
        encode: impl Fn(&mut zga_driver::Driver<zga_device::CardBus>, &Canvas<'_>) -> Result<(), zga_driver::DriverError>,
    ) -> bool {
        let half = |number: i32| i16::try_from(number).ok();
        let (Some(x), Some(y)) = (half(onto.origin[0]), half(onto.origin[1])) else { return false };
        if self.is_small(work) || !self.bring_in(&[onto.pixmap], 4 * work) {
            return false;
        }
        let Some(image) = self.pixmaps.get(onto.pixmap).and_then(|pixmap| image(&self.frame, pixmap)) else {
            return false;
        };
        let clips = if onto.moved == [0; 2] {
            onto.clips
        } else {
            self.scratch.clips.clear();
            self.scratch.clips.extend(onto.clips.iter().map(|clip| moved(*clip, onto.moved)));
            &self.scratch.clips
        };
        // Boxes of a clip do not overlap, so it is all the same whether entries or boxes come first.
        let encoded = clips.chunks(MOST_CLIPS).try_for_each(|clips| {
            let canvas = Canvas { drawable: Drawable::Image(image), origin: [x, y], clips, raster: onto.raster };
            encode(&mut self.driver, &canvas)
        });
        self.drawn(encoded, &[onto.pixmap], work)
    }
}

/// Boxes of a clip that travel with one packet, 2 words each. Even the ring of 2 MiB of memory takes packets of 4094 words.
pub(super) const MOST_CLIPS: usize = 1024;
/// Work that an entry is at least, in pixels.
pub(super) const ENTRY: u64 = 16;

/// Pixels of a line.
fn length(from: [i16; 2], to: [i16; 2]) -> u64 {
    let across = |axis: usize| u64::from((i32::from(to[axis]) - i32::from(from[axis])).unsigned_abs());
    across(0).max(across(1)) + 1
}

/// A box somewhere else; what leaves 16 bits is cut off, for no pixmap reaches there.
pub(super) fn moved(clip: ClipBox, [x, y]: [i32; 2]) -> ClipBox {
    let add = |coordinate: i16, by: i32| (i32::from(coordinate) + by).clamp(i16::MIN.into(), i16::MAX.into()) as i16;
    ClipBox { x1: add(clip.x1, x), y1: add(clip.y1, y), x2: add(clip.x2, x), y2: add(clip.y2, y) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_steps_add_up_in_16_bits() {
        let list = [Point { x: 30_000, y: 1 }, Point { x: 30_000, y: -3 }, Point { x: 5_000, y: 0 }];
        let places = |steps| Points { list: &list, steps }.places().map(|place| (place.x, place.y)).collect::<Vec<_>>();
        assert_eq!(places(false), [(30_000, 1), (30_000, -3), (5_000, 0)]);
        assert_eq!(places(true), [(30_000, 1), (-5_536, -2), (-536, -2)]);
    }

    #[test]
    fn moved_box_stays_within_16_bits() {
        const CLIP: ClipBox = ClipBox { x1: 10, y1: 20, x2: 110, y2: 220 };
        assert_eq!(moved(CLIP, [-5, 7]), ClipBox { x1: 5, y1: 27, x2: 105, y2: 227 });
        assert_eq!(moved(CLIP, [40_000, 0]).x2, i16::MAX);
    }
}
