//! Lists as the server's drawing requests have them: rectangles, points, lines, letters, each through every box of a clip.

use zga_driver::{BitmapGlyph, Canvas, ClipBox, Drawable, ListRectangle, Point, Raster, Segment};

use super::Engine;
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

/// Scratch of the lists, kept from call to call.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub clips: Vec<ClipBox>,
    /// Glyphs added up.
    pub mask: Vec<u8>,
}

impl Engine {
    /// Fills rectangles, in their order. False, here and below: the server's renderer has to do it.
    pub fn fill_list(&mut self, onto: &Onto<'_>, value: u32, rectangles: &[ListRectangle]) -> bool {
        let work = rectangles.iter().map(|one| ENTRY + u64::from(one.width) * u64::from(one.height)).sum();
        self.list(onto, work, |driver, canvas| driver.fill_list(canvas, value, rectangles))
    }

    /// Lines of one pixel's width, each by itself; `last`: with its last pixel.
    pub fn segments(&mut self, onto: &Onto<'_>, value: u32, segments: &[Segment], last: bool) -> bool {
        let work = segments.iter().map(|one| ENTRY + length([one.x1, one.y1], [one.x2, one.y2])).sum();
        self.list(onto, work, |driver, canvas| driver.segments(canvas, value, segments, last))
    }

    /// Lines of one pixel's width from point to point; `last`: with the very last pixel.
    pub fn polyline(&mut self, onto: &Onto<'_>, value: u32, points: &[Point], last: bool) -> bool {
        let work = points.windows(2).map(|two| ENTRY + length([two[0].x, two[0].y], [two[1].x, two[1].y])).sum();
        self.list(onto, work, |driver, canvas| driver.polyline(canvas, value, points, last))
    }

    /// Letters: their set bits in one colour.
    pub fn letters(&mut self, onto: &Onto<'_>, value: u32, letters: &[BitmapGlyph<'_>]) -> bool {
        let work = letters.iter().map(|one| ENTRY + u64::from(one.width) * u64::from(one.height)).sum();
        self.list(onto, work, |driver, canvas| driver.expand(canvas, value, None, letters.iter().copied()))
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
        self.drawn(encoded, &[onto.pixmap], work * clips.len().max(1) as u64);
        true
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

/// Whether the server's renderer leaves a polyline's last pixel out because the figure is closed: it does so when there is
/// one clip box only and neither end of the last segment is outside of it, and draws the pixel a second time otherwise.
///
/// The test for "outside" is the renderer's own, on two coordinates packed into 32 bits, so that coordinates whose
/// differences leave 16 bits come out the same.
#[must_use]
pub fn closes(points: &[Point], origin: [i32; 2], clips: &[ClipBox]) -> bool {
    let ([clip], [first, .., before, last]) = (clips, points) else {
        // Of two points that are one the renderer takes the fast way, too.
        if let ([clip], [first, last]) = (clips, points) {
            return first == last && inside(*first, origin, *clip);
        }
        return false;
    };
    first == last && inside(*before, origin, *clip) && inside(*last, origin, *clip)
}

/// The renderer's test whether a point is in its clip box.
fn inside(point: Point, [x, y]: [i32; 2], clip: ClipBox) -> bool {
    let pack = |x: i32, y: i32| (y << 16) | (x & 0xFFFF);
    let upper_left = pack(i32::from(clip.x1) - x, i32::from(clip.y1) - y);
    let lower_right = pack(i32::from(clip.x2) - x - 1, i32::from(clip.y2) - y - 1);
    let point = pack(point.x.into(), point.y.into());
    let outside = point.wrapping_sub(upper_left) | lower_right.wrapping_sub(point);
    outside.cast_unsigned() & 0x8000_8000 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLIP: ClipBox = ClipBox { x1: 10, y1: 20, x2: 110, y2: 220 };

    fn points(list: &[(i16, i16)]) -> Vec<Point> {
        list.iter().map(|&(x, y)| Point { x, y }).collect()
    }

    #[test]
    fn closes_figure_inside_one_box() {
        let figure = points(&[(0, 0), (50, 3), (20, 90), (0, 0)]);
        assert!(closes(&figure, [10, 20], &[CLIP]));
        assert!(!closes(&figure, [9, 20], &[CLIP]), "the last point is left of the box");
        assert!(!closes(&figure, [10, 20], &[CLIP, ClipBox { x1: 300, x2: 310, ..CLIP }]));
        assert!(!closes(&figure[..3], [10, 20], &[CLIP]), "the figure is open");
    }

    #[test]
    fn closes_only_the_last_segment_counts() {
        let figure = points(&[(30, 30), (500, 30), (40, 40), (30, 30)]);
        assert!(closes(&figure, [0, 0], &[CLIP]));
        let figure = points(&[(30, 30), (40, 40), (500, 30), (30, 30)]);
        assert!(!closes(&figure, [0, 0], &[CLIP]));
    }

    #[test]
    fn closes_point_of_two_ends() {
        assert!(closes(&points(&[(30, 30), (30, 30)]), [0, 0], &[CLIP]));
        assert!(!closes(&points(&[(30, 30), (31, 30)]), [0, 0], &[CLIP]));
    }

    #[test]
    fn inside_is_inclusive_of_the_box_and_exclusive_of_its_end() {
        for (x, y, expected) in [(10, 20, true), (109, 219, true), (9, 20, false), (110, 20, false), (10, 220, false)] {
            assert_eq!(inside(Point { x, y }, [0, 0], CLIP), expected, "{x} {y}");
        }
    }

    #[test]
    fn moved_box_stays_within_16_bits() {
        assert_eq!(moved(CLIP, [-5, 7]), ClipBox { x1: 5, y1: 27, x2: 105, y2: 227 });
        assert_eq!(moved(CLIP, [40_000, 0]).x2, i16::MAX);
    }
}
