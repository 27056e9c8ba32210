//! The bitmap unit: images, and fills, copies, raster operations, conversions and stretches between images and targets.
//!
//! All of it happens in video memory, in the order of the calls, between what other calls encode. A target's frame
//! buffer is the one that is drawn to, as for [`Driver::begin_scene`]; while a scene on the target is open its pixels may
//! be anywhere, so it takes part in none of this then.

use zga_abi::bus::Bus;
use zga_abi::format::{BitmapFormat, RasterOperation, StretchFilter};
use zga_abi::packet::Opcode;

use crate::memory::{Alignment, Allocation};
use crate::target::{MOST_PIXELS, pitch_of};
use crate::{Driver, DriverError, Rectangle, Target};

/// Pixels in video memory that nothing is drawn to by scenes. Given back with [`Driver::destroy_image`].
#[derive(Debug, PartialEq, Eq)]
#[must_use = "an image that is dropped keeps its video memory until the driver is gone"]
pub struct Image {
    memory: Allocation,
    pitch: u32,
    width: u32,
    height: u32,
    format: BitmapFormat,
}

impl Image {
    /// Pixels.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Pixels.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Format of a pixel.
    #[must_use]
    pub const fn format(&self) -> BitmapFormat {
        self.format
    }

    /// Bytes from a row to the next, a multiple of 64.
    #[must_use]
    pub const fn pitch(&self) -> u32 {
        self.pitch
    }

    /// Where it lies, for [`Driver::write_memory`] and [`Driver::read_memory`].
    pub const fn memory(&self) -> &Allocation {
        &self.memory
    }
}

/// Something that the bitmap unit reads or writes.
#[derive(Clone, Copy, Debug)]
pub enum Drawable<'a> {
    /// An image.
    Image(&'a Image),
    /// The frame buffer of a target that is drawn to.
    Target(&'a Target),
}

impl<'a> From<&'a Image> for Drawable<'a> {
    fn from(image: &'a Image) -> Drawable<'a> {
        Drawable::Image(image)
    }
}

impl<'a> From<&'a Target> for Drawable<'a> {
    fn from(target: &'a Target) -> Drawable<'a> {
        Drawable::Target(target)
    }
}

/// What becomes of the bits of a stored pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Raster {
    /// What becomes of a bit.
    pub operation: RasterOperation,
    /// Bits of the stored pixel that may change; bits beyond the format do not count.
    pub planes: u32,
}

impl Raster {
    /// An operation on all planes.
    #[must_use]
    pub const fn new(operation: RasterOperation) -> Raster {
        Raster { operation, planes: u32::MAX }
    }
}

/// Where a stretched rectangle goes: it may reach beyond its destination on every side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// Column of its first pixel.
    pub x: i32,
    /// Row of its first pixel.
    pub y: i32,
    /// Pixels, 1..=16384.
    pub width: u32,
    /// Pixels, 1..=16384.
    pub height: u32,
}

/// Why the bitmap unit was not asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// A rectangle reaches beyond its image or target.
    #[error(
        "{call}: the {side} is {width} x {height} pixels, the rectangle goes from ({}, {}) to ({}, {})",
        rectangle.x, rectangle.y, rectangle.right, rectangle.bottom
    )]
    Outside {
        /// The method called.
        call: &'static str,
        /// Source or destination.
        side: &'static str,
        /// The rectangle.
        rectangle: Rectangle,
        /// Pixels there are.
        width: u32,
        /// Pixels there are.
        height: u32,
    },
    /// The call moves stored pixels as they are, between equal formats only.
    #[error("{call} from {from} to {to}: the formats differ, see convert")]
    FormatsDiffer {
        /// The method called.
        call: &'static str,
        /// Format of the source.
        from: &'static str,
        /// Format of the destination.
        to: &'static str,
    },
    /// A stretch or composition would write to its own source.
    #[error("what is written would lie in its own source, copy that first")]
    Overlap,
    /// A bitmap has too few bytes.
    #[error("a bitmap of {width} x {height} pixels has {found} bytes, {needed} are needed")]
    Bits {
        /// Pixels.
        width: u16,
        /// Pixels.
        height: u16,
        /// Bytes that it needs.
        needed: usize,
        /// Bytes given.
        found: usize,
    },
    /// An upload does not begin and end at whole words.
    #[error("upload of {width} pixels of {pixel} bytes at column {x}: both must be multiples of 4 bytes")]
    Unaligned {
        /// First column.
        x: u32,
        /// Pixels of a row.
        width: u32,
        /// Bytes of a pixel.
        pixel: u32,
    },
    /// An upload has too few bytes, or rows that run into each other.
    #[error("upload of {rows} rows of {row_bytes} bytes, {stride} from one to the next: {found} bytes do not fit that")]
    Rows {
        /// Bytes of a row.
        row_bytes: usize,
        /// Bytes from a row to the next.
        stride: usize,
        /// Rows.
        rows: u32,
        /// Bytes given.
        found: usize,
    },
}

/// A drawable as packets have it.
#[derive(Clone, Copy)]
pub(crate) struct Surface {
    pub(crate) base: u32,
    pub(crate) pitch: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) format: BitmapFormat,
}

impl Surface {
    /// Refuses a rectangle that reaches beyond.
    pub(crate) fn hold(&self, call: &'static str, side: &'static str, rectangle: Rectangle) -> Result<(), ImageError> {
        let &Surface { width, height, .. } = self;
        let holds = rectangle.right <= width && rectangle.bottom <= height;
        if holds { Ok(()) } else { Err(ImageError::Outside { call, side, rectangle, width, height }) }
    }
}

/// Width and height; `None` if it is empty.
pub(crate) fn size(rectangle: Rectangle) -> Option<[u32; 2]> {
    let Rectangle { x, y, right, bottom } = rectangle;
    let size = [right.checked_sub(x)?, bottom.checked_sub(y)?];
    size.into_iter().all(|pixels| pixels > 0).then_some(size)
}

/// The rectangle of this size from a place on; its ends saturate, where nothing reaches anyway.
const fn rectangle_at([x, y]: [u32; 2], [width, height]: [u32; 2]) -> Rectangle {
    Rectangle { x, y, right: x.saturating_add(width), bottom: y.saturating_add(height) }
}

/// A pixel lies in both.
const fn meet(a: Rectangle, b: Rectangle) -> bool {
    a.x < b.right && b.x < a.right && a.y < b.bottom && b.y < a.bottom
}

/// Of a range that begins at `start` and has `length`, what lies in `from..to`: first and length, and how many are
/// skipped before; `None` if nothing does.
fn clipped(start: i32, length: u32, from: u32, to: u32) -> Option<[u32; 3]> {
    let (start, end) = (i64::from(start), i64::from(start) + i64::from(length));
    let first = start.max(i64::from(from));
    let count = end.min(i64::from(to)) - first;
    let numbers = [first, count, first - start].map(|number| u32::try_from(number).ok());
    match numbers {
        [Some(first), Some(count), Some(skipped)] if count > 0 => Some([first, count, skipped]),
        _ => None,
    }
}

impl<B: Bus> Driver<B> {
    /// Takes video memory for an image. Its contents are what was there before: fill it.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for a size out of range, [`DriverError::Memory`] if there is no room.
    pub fn create_image(&mut self, width: u32, height: u32, format: BitmapFormat) -> Result<Image, DriverError> {
        for (name, pixels) in [("image width", width), ("image height", height)] {
            if !(1..=MOST_PIXELS).contains(&pixels) {
                return Err(DriverError::BadOption { name, found: pixels.to_string(), expected: "1 to 16384 pixels" });
            }
        }
        let pitch = pitch_of(width * format.bytes());
        let memory = self.allocate(u64::from(pitch) * u64::from(height), Alignment::Line)?;
        Ok(Image { memory, pitch, width, height, format })
    }

    /// Gives an image's memory back; it is used again when the card has executed what was encoded before. If the image is
    /// shown, the screen goes dark.
    ///
    /// # Errors
    /// As [`Driver::free`].
    pub fn destroy_image(&mut self, image: Image) -> Result<(), DriverError> {
        self.darken(&image.memory)?;
        self.free(image.memory)
    }

    /// Fills a rectangle with a stored pixel value, see [`BitmapFormat::encode`]. An empty one is nothing.
    ///
    /// # Errors
    /// [`ImageError::Outside`]; [`DriverError::InsideScene`] for the target of the open scene;
    /// [`DriverError::UnknownTarget`]; or as [`Driver::flush`].
    pub fn fill<'a>(
        &mut self,
        destination: impl Into<Drawable<'a>>,
        rectangle: Rectangle,
        value: u32,
    ) -> Result<(), DriverError> {
        let to = self.surface("fill", destination.into())?;
        to.hold("fill", "destination", rectangle)?;
        let Some([width, height]) = size(rectangle) else { return Ok(()) };
        let Rectangle { x, y, .. } = rectangle;
        let payload = [to.base, to.pitch, to.format.code(), x, y, width, height, value];
        if to.format.pixel_format().is_some() {
            self.encode(Opcode::Fill, &[&payload])
        } else {
            self.encode(Opcode::FillRop, &[&payload, &[RasterOperation::Copy.code(), u32::MAX]])
        }
    }

    /// Combines a stored pixel value with a rectangle through a raster operation. An empty one is nothing.
    ///
    /// # Errors
    /// As [`Driver::fill`].
    pub fn fill_rop<'a>(
        &mut self,
        destination: impl Into<Drawable<'a>>,
        rectangle: Rectangle,
        value: u32,
        raster: Raster,
    ) -> Result<(), DriverError> {
        let to = self.surface("fill_rop", destination.into())?;
        to.hold("fill_rop", "destination", rectangle)?;
        let Some([width, height]) = size(rectangle) else { return Ok(()) };
        let Rectangle { x, y, .. } = rectangle;
        let payload = [to.base, to.pitch, to.format.code(), x, y, width, height, value];
        self.encode(Opcode::FillRop, &[&payload, &[raster.operation.code(), raster.planes]])
    }

    /// Copies to `rectangle` of the destination what lies from column and row `from` of the source on, as if all of it
    /// were read before any is written. An empty rectangle is nothing.
    ///
    /// # Errors
    /// [`ImageError::FormatsDiffer`], or as [`Driver::fill`].
    pub fn copy<'a, 'b>(
        &mut self,
        source: impl Into<Drawable<'a>>,
        from: [u32; 2],
        destination: impl Into<Drawable<'b>>,
        rectangle: Rectangle,
    ) -> Result<(), DriverError> {
        let raster = Raster::new(RasterOperation::Copy);
        self.copy_stored("copy", [source.into(), destination.into()], from, rectangle, raster)
    }

    /// [`Driver::copy`] through a raster operation.
    ///
    /// # Errors
    /// As [`Driver::copy`].
    pub fn copy_rop<'a, 'b>(
        &mut self,
        source: impl Into<Drawable<'a>>,
        from: [u32; 2],
        destination: impl Into<Drawable<'b>>,
        rectangle: Rectangle,
        raster: Raster,
    ) -> Result<(), DriverError> {
        self.copy_stored("copy_rop", [source.into(), destination.into()], from, rectangle, raster)
    }

    fn copy_stored(
        &mut self,
        call: &'static str,
        drawables: [Drawable<'_>; 2],
        from: [u32; 2],
        rectangle: Rectangle,
        raster: Raster,
    ) -> Result<(), DriverError> {
        let [source, to] = [self.surface(call, drawables[0])?, self.surface(call, drawables[1])?];
        if source.format != to.format {
            let [from, to] = [source.format.name(), to.format.name()];
            return Err(ImageError::FormatsDiffer { call, from, to }.into());
        }
        let Some(place) = Self::same_size(call, &source, from, &to, rectangle)? else { return Ok(()) };
        let format = [to.format.code()];
        if raster == Raster::new(RasterOperation::Copy) && to.format.pixel_format().is_some() {
            self.encode(Opcode::Copy, &[&format, &place])
        } else {
            self.encode(Opcode::CopyRop, &[&format, &place, &[raster.operation.code(), raster.planes]])
        }
    }

    /// [`Driver::copy`] into another format: the RGBA value of each pixel, as [`BitmapFormat::decode`] and
    /// [`BitmapFormat::encode`] have it. It may overlap itself.
    ///
    /// # Errors
    /// As [`Driver::fill`].
    pub fn convert<'a, 'b>(
        &mut self,
        source: impl Into<Drawable<'a>>,
        from: [u32; 2],
        destination: impl Into<Drawable<'b>>,
        rectangle: Rectangle,
    ) -> Result<(), DriverError> {
        let [source, to] = [self.surface("convert", source.into())?, self.surface("convert", destination.into())?];
        let Some(place) = Self::same_size("convert", &source, from, &to, rectangle)? else { return Ok(()) };
        let (read, written) = place.split_at(4);
        self.encode(Opcode::Convert, &[&[source.format.code()], read, &[to.format.code()], written])
    }

    /// Base, pitch, x and y of source and destination, and their size; `None` if they are empty.
    fn same_size(
        call: &'static str,
        source: &Surface,
        from: [u32; 2],
        to: &Surface,
        rectangle: Rectangle,
    ) -> Result<Option<[u32; 10]>, ImageError> {
        to.hold(call, "destination", rectangle)?;
        let Some([width, height]) = size(rectangle) else { return Ok(None) };
        source.hold(call, "source", rectangle_at(from, [width, height]))?;
        let Rectangle { x, y, .. } = rectangle;
        Ok(Some([source.base, source.pitch, from[0], from[1], to.base, to.pitch, x, y, width, height]))
    }

    /// Stretches rectangle `from` of the source over `to`; what of it lies in the destination and in `clip` is written.
    ///
    /// Any number of clips of one placement come to the pixels of a single stretch. An empty clip is nothing.
    ///
    /// # Errors
    /// [`ImageError::Outside`] for the source; [`ImageError::Overlap`] where what is written lies in its own source;
    /// [`DriverError::BadOption`] for a placement or a source without a size from 1 to 16384; or as [`Driver::fill`].
    pub fn stretch<'a, 'b>(
        &mut self,
        source: impl Into<Drawable<'a>>,
        from: Rectangle,
        destination: impl Into<Drawable<'b>>,
        to: Placement,
        clip: Rectangle,
        filter: StretchFilter,
    ) -> Result<(), DriverError> {
        let [source, onto] = [self.surface("stretch", source.into())?, self.surface("stretch", destination.into())?];
        source.hold("stretch", "source", from)?;
        let bad = |name, width: u32, height: u32| DriverError::BadOption {
            name,
            found: format!("{width} x {height}"),
            expected: "1 to 16384 pixels each way",
        };
        let from_size = size(from).ok_or_else(|| {
            bad("stretch source", from.right.saturating_sub(from.x), from.bottom.saturating_sub(from.y))
        })?;
        if ![to.width, to.height].iter().all(|pixels| (1..=MOST_PIXELS).contains(pixels)) {
            return Err(bad("stretch placement", to.width, to.height));
        }
        let across = clipped(to.x, to.width, clip.x, clip.right.min(onto.width));
        let down = clipped(to.y, to.height, clip.y, clip.bottom.min(onto.height));
        let (Some([x, width, part_x]), Some([y, height, part_y])) = (across, down) else { return Ok(()) };
        let written = rectangle_at([x, y], [width, height]);
        if source.base == onto.base && meet(from, written) {
            return Err(ImageError::Overlap.into());
        }
        let [from_width, from_height] = from_size;
        let read = [source.format.code(), source.base, source.pitch, from.x, from.y, from_width, from_height];
        let made = [onto.format.code(), onto.base, onto.pitch, x, y, width, height];
        let part = [to.width, to.height, part_x, part_y];
        self.encode(Opcode::Stretch, &[&[filter.code()], &read, &made, &part])
    }

    /// Where a drawable lies.
    pub(crate) fn surface(&self, call: &'static str, drawable: Drawable<'_>) -> Result<Surface, DriverError> {
        match drawable {
            Drawable::Image(image) => {
                let &Image { ref memory, pitch, width, height, format } = image;
                Ok(Surface { base: memory.address(), pitch, width, height, format })
            }
            Drawable::Target(target) => {
                let state = self.target_state(target)?;
                if self.scene.is_some_and(|scene| scene.id == Self::target_id(target)) {
                    return Err(DriverError::InsideScene { call });
                }
                let format = state.options.pixel_format.into();
                let (base, pitch) = state.frame_surface();
                Ok(Surface { base, pitch, width: target.width(), height: target.height(), format })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipped_range_has_what_lies_inside_and_what_is_skipped() {
        assert_eq!(clipped(5, 10, 0, 100), Some([5, 10, 0]));
        assert_eq!(clipped(-5, 10, 0, 100), Some([0, 5, 5]));
        assert_eq!(clipped(95, 10, 0, 100), Some([95, 5, 0]));
        assert_eq!(clipped(5, 10, 7, 9), Some([7, 2, 2]));
        assert_eq!(clipped(-10, 10, 0, 100), None);
        assert_eq!(clipped(100, 10, 0, 100), None);
        assert_eq!(clipped(i32::MAX, 16384, 0, 100), None);
        assert_eq!(clipped(i32::MIN, 16384, 9, 3), None);
    }

    #[test]
    fn size_of_an_empty_or_turned_rectangle_is_none() {
        let rectangle = |x, right| Rectangle { x, y: 0, right, bottom: 4 };
        assert_eq!([(2, 5), (5, 5), (5, 2)].map(|(x, right)| size(rectangle(x, right))), [Some([3, 4]), None, None]);
    }
}
