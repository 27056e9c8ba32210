//! A request of RENDER: what is read, what is drawn onto, and the same request with as little to do as possible.

use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_driver::{ClipBox, Transform};

use super::area::Area;

/// One in the 16.16 of transforms.
const ONE: i32 = 1 << 16;
/// Most pixels each way of an image that the renderer reads.
pub(super) const MOST_SIDE: u32 = 0x7FFE;
/// What the card and its driver take as a way from destination to image, pixels.
const MOST_OFFSET: i32 = 65535;
/// How far the renderer's positions in a transformed image stay from the ends of its 16.16 numbers.
const MARGIN: i64 = 1 << 17;
/// Farthest way of a transform with which the renderer takes a filter between pixels for none, in 16.16.
const FARTHEST: u32 = 30_000 << 16;

/// The upper left of a pixmap as a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Number of the pixmap.
    pub pixmap: usize,
    /// Pixels each way.
    pub size: [u32; 2],
    /// What its pixels mean.
    pub format: PictureFormat,
}

/// An image that is read.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// Its pixels.
    pub surface: Surface,
    /// Added to a pixel of the destination's pixmap, before the transform.
    pub offset: [i32; 2],
    /// What lies outside.
    pub repeat: Repeat,
    /// From there to a place in the image; the nearest pixel counts.
    pub transform: Option<Transform>,
}

/// Where colours and coverages come from.
#[derive(Clone, Copy, Debug)]
pub enum Ink {
    /// One colour, ARGB.
    Colour(u32),
    /// An image.
    Sampled(Sampled),
}

/// What the source is multiplied with.
#[derive(Clone, Copy, Debug)]
pub enum Cover {
    /// Nothing.
    None,
    /// All channels with alpha.
    Unified(Ink),
    /// Each channel with its own.
    Components(Ink),
}

/// What is composed, and onto what.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// How source and destination come together.
    pub operator: ComposeOperator,
    /// The source.
    pub source: Ink,
    /// The mask.
    pub mask: Cover,
    /// The destination.
    pub onto: Surface,
    /// The clip: boxes that do not overlap.
    pub clips: &'a [ClipBox],
    /// Added to the boxes of the clip, which are in the screen's coordinates.
    pub moved: [i32; 2],
}

/// Whether a filter between pixels has nothing to do, for every place is that of a pixel.
#[must_use]
pub fn finds_pixels(transform: Option<&Transform>) -> bool {
    match transform {
        None => true,
        Some(Transform { xx: ONE, xy: 0, x0, yx: 0, yy: ONE, y0 }) => {
            [x0, y0].iter().all(|way| way.trailing_zeros() >= 16 && way.unsigned_abs() <= FARTHEST)
        }
        Some(_) => false,
    }
}

/// Where pixel (x, y) is read from, in 16.16.
fn place(transform: &Transform, x: i32, y: i32) -> [i64; 2] {
    let [x, y] = [x, y].map(i64::from);
    let along = |a: i32, b: i32, c: i32| {
        let [a, b, c] = [a, b, c].map(i64::from);
        a * x + b * y + ((a + b + 1) >> 1) + c
    };
    [along(transform.xx, transform.xy, transform.x0), along(transform.yx, transform.yy, transform.y0)]
}

impl Sampled {
    /// The same image with as little to do as possible: a transform that moves only is an offset, for the nearest pixel counts.
    fn simple(mut self) -> Sampled {
        if let Some(Transform { xx: ONE, xy: 0, x0, yx: 0, yy: ONE, y0 }) = self.transform {
            // As in `place`: half a pixel, less the smallest number, rounded down.
            for (offset, way) in self.offset.iter_mut().zip([x0, y0]) {
                *offset += ((i64::from(way) + i64::from(ONE / 2 - 1)) >> 16) as i32;
            }
            self.transform = None;
        }
        self
    }

    /// Every pixel of an area of the destination is read from inside the image, and from where it stands.
    fn covers(&self, area: Area) -> bool {
        let read = area.plus(self.offset);
        self.transform.is_none() && read.common(Area::of(self.surface)) == Some(read)
    }

    /// All that is read for an area is opaque.
    fn is_opaque(&self, area: Area) -> bool {
        use PictureFormat::{Rgb565, Xbgr8888, Xrgb8888};
        matches!(self.surface.format, Xrgb8888 | Xbgr8888 | Rgb565)
            && (self.repeat != Repeat::None || self.covers(area))
    }
}

/// Whether the renderer reads an image for this area of the destination at all. Its coordinates have 16 bits before the point; where
/// they end it draws nothing. It looks one pixel around the area.
fn reaches(sampled: &Sampled, area: Area) -> bool {
    let area = area.plus(sampled.offset);
    let short = |number: i32| i16::try_from(number).is_ok();
    let good = [area.x1 - 1, area.y1 - 1, area.x2 + 1, area.y2 + 1].into_iter().all(short)
        && sampled.surface.size.iter().all(|side| *side <= MOST_SIDE);
    let Some(transform) = sampled.transform else { return good };
    let most = i64::from(i32::MAX) - MARGIN;
    let corners = [area.x1 - 1, area.x2].into_iter().flat_map(|x| [area.y1 - 1, area.y2].map(|y| (x, y)));
    good && corners.flat_map(|(x, y)| place(&transform, x, y)).all(|number| number.abs() <= most)
}

impl Ink {
    pub(super) const fn sampled(&self) -> Option<&Sampled> {
        match self {
            Ink::Colour(_) => None,
            Ink::Sampled(sampled) => Some(sampled),
        }
    }

    fn simple(self) -> Ink {
        match self {
            Ink::Colour(_) => self,
            Ink::Sampled(sampled) => Ink::Sampled(sampled.simple()),
        }
    }
}

impl Cover {
    pub(super) const fn ink(&self) -> Option<&Ink> {
        match self {
            Cover::None => None,
            Cover::Unified(ink) | Cover::Components(ink) => Some(ink),
        }
    }
}

/// What comes to the same, and is done without composing.
pub(super) enum Plain {
    /// A stored pixel value.
    Fill(u32),
    /// Stored pixels, this far away.
    Copy(Surface, [i32; 2]),
}

impl Request<'_> {
    /// The same request with images that are as simple as they can be.
    pub(in super::super) fn simple(self) -> Self {
        let mask = match self.mask {
            Cover::None => Cover::None,
            Cover::Unified(ink) => Cover::Unified(ink.simple()),
            Cover::Components(ink) => Cover::Components(ink.simple()),
        };
        Request { source: self.source.simple(), mask, ..self }
    }

    /// The same request with an operator that is as simple as it can be in this area.
    pub(super) fn reduced(self, area: Area) -> Self {
        let opaque = match &self.source {
            Ink::Colour(colour) => colour >> 24 == 255,
            Ink::Sampled(sampled) => sampled.is_opaque(area),
        };
        match self.operator {
            ComposeOperator::Clear => {
                let (operator, source, mask) = (ComposeOperator::Source, Ink::Colour(0), Cover::None);
                Request { operator, source, mask, ..self }
            }
            ComposeOperator::Over if opaque && matches!(self.mask, Cover::None) => {
                Request { operator: ComposeOperator::Source, ..self }
            }
            _ => self,
        }
    }

    /// A fill or a copy, if it comes to that in this area.
    pub(super) fn plain(&self, area: Area) -> Option<Plain> {
        use PictureFormat::{Abgr8888, Argb8888, Xbgr8888, Xrgb8888};
        if self.operator != ComposeOperator::Source || !matches!(self.mask, Cover::None) {
            return None;
        }
        match &self.source {
            Ink::Colour(colour) => Some(Plain::Fill(self.onto.format.encode(*colour))),
            Ink::Sampled(sampled) => {
                let (from, to) = (sampled.surface.format, self.onto.format);
                // What has an alpha goes as it is to what has none: into bits that no channel has.
                let equal = from == to || matches!((from, to), (Argb8888, Xrgb8888) | (Abgr8888, Xbgr8888));
                let read = area.plus(sampled.offset);
                let apart = sampled.surface.pixmap != self.onto.pixmap || read.common(area).is_none();
                (equal && apart && sampled.covers(area)).then_some(Plain::Copy(sampled.surface, sampled.offset))
            }
        }
    }

    /// The images that are read.
    fn images(&self) -> impl Iterator<Item = &Sampled> {
        [Some(&self.source), self.mask.ink()].into_iter().flatten().filter_map(Ink::sampled)
    }

    /// The renderer draws something in this area: see [`reaches`].
    pub(in super::super) fn reaches(&self, area: Area) -> bool {
        self.images().all(|sampled| reaches(sampled, area))
    }

    /// What the card does not take: an image in the destination, or one that is too far away.
    pub(super) fn is_refused(&self) -> bool {
        let far = |way: &i32| way.abs() > MOST_OFFSET;
        self.images().any(|sampled| sampled.surface.pixmap == self.onto.pixmap || sampled.offset.iter().any(far))
    }

    /// Times that each pixel is touched: it is written, maybe read, and so are the images.
    pub(super) fn touches(&self) -> u64 {
        1 + u64::from(self.operator.reads_destination()) + self.images().count() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOVED: Transform = Transform { xx: ONE, xy: 0, x0: 5 << 16, yx: 0, yy: ONE, y0: -(7 << 16) };
    const AREA: Area = Area { x1: 10, y1: 20, x2: 30, y2: 40 };

    fn sampled(offset: [i32; 2], transform: Option<Transform>) -> Sampled {
        let surface = Surface { pixmap: 1, size: [50, 60], format: PictureFormat::Xrgb8888 };
        Sampled { surface, offset, repeat: Repeat::None, transform }
    }

    #[test]
    fn finds_pixels_whole_pixels_aside_and_no_more() {
        assert!(finds_pixels(None) && finds_pixels(Some(&MOVED)));
        assert!(!finds_pixels(Some(&Transform { x0: 5 << 15, ..MOVED })), "half a pixel aside");
        assert!(!finds_pixels(Some(&Transform { xx: ONE + 1, ..MOVED })), "a little wider");
        assert!(!finds_pixels(Some(&Transform { y0: 30_001 << 16, ..MOVED })), "too far");
    }

    #[test]
    fn simple_transform_that_moves_is_the_offset_of_the_same_pixels() {
        for (x0, y0) in [(0, 0), (5 << 16, -(7 << 16)), (0x8000, 0x8001), (-0x8000, -0x7FFF), (i32::MAX, i32::MIN)] {
            let before = Transform { x0, y0, ..MOVED };
            let after = sampled([3, -4], Some(before)).simple();
            assert_eq!(after.transform, None);
            // The pixel is that of the place less the smallest number.
            let [x, y] = place(&before, 11 + 3, 22 - 4).map(|number| ((number - 1) >> 16) as i32);
            assert_eq!(after.offset, [x - 11, y - 22], "{x0} {y0}");
        }
        assert!(sampled([0; 2], Some(Transform { xy: 1, ..MOVED })).simple().transform.is_some());
    }

    #[test]
    fn covers_pixels_that_stand_inside() {
        assert!(sampled([-10, -20], None).covers(AREA) && sampled([20, 20], None).covers(AREA));
        assert!(!sampled([-11, -20], None).covers(AREA) && !sampled([20, 21], None).covers(AREA));
        assert!(!sampled([0, 0], Some(MOVED)).covers(AREA));
    }

    #[test]
    fn reaches_as_far_as_16_bits_do() {
        assert!(reaches(&sampled([32_736, 0], None), AREA) && !reaches(&sampled([32_737, 0], None), AREA));
        assert!(reaches(&sampled([0, -32_787], None), AREA) && !reaches(&sampled([0, -32_788], None), AREA));
        let wide = |xx| sampled([0; 2], Some(Transform { xx, x0: 0, ..MOVED }));
        assert!(reaches(&wide(1000 << 16), AREA) && !reaches(&wide(1100 << 16), AREA));
    }

    #[test]
    fn reduced_opaque_source_over_is_the_source() {
        let onto = Surface { pixmap: 0, size: [100, 100], format: PictureFormat::Argb8888 };
        let over = |source| {
            let operator = ComposeOperator::Over;
            let request = Request { operator, source, mask: Cover::None, onto, clips: &[], moved: [0; 2] };
            request.reduced(AREA).operator
        };
        assert_eq!(over(Ink::Colour(0xFF12_3456)), ComposeOperator::Source);
        assert_eq!(over(Ink::Colour(0xFE12_3456)), ComposeOperator::Over);
        assert_eq!(over(Ink::Sampled(sampled([0, 0], None))), ComposeOperator::Source);
        assert_eq!(over(Ink::Sampled(sampled([30, 0], None))), ComposeOperator::Over, "transparent beyond its edge");
    }

    #[test]
    fn plain_copy_within_a_pixmap_only_from_what_is_not_written() {
        let plain = |way| {
            let source = sampled([way, 0], None);
            let onto = Surface { size: [100, 100], ..source.surface };
            let (operator, source) = (ComposeOperator::Source, Ink::Sampled(source));
            let request = Request { operator, source, mask: Cover::None, onto, clips: &[], moved: [0; 2] };
            request.plain(AREA).is_some()
        };
        assert!(plain(20) && !plain(19));
    }
}
