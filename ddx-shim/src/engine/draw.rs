//! Drawing as EXA asks for it: one call prepares, any number draw, one ends. What they draw is encoded as one list at the end.

use zga_driver::{Canvas, DriverError, ListRectangle, Raster};

use super::lists::work_of;
use super::pixmaps::{Pixmap, Place};
use super::{Engine, Image};
use crate::format::raster;

/// What was prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Current {
    /// Nothing.
    Nothing,
    /// Fills.
    Solid { pixmap: usize, value: u32, raster: Raster },
    /// Copies; the offset leads from a pixel to its source, and is that of the rectangles that wait.
    Copy { from: usize, to: usize, raster: Raster, offset: [i32; 2] },
}

/// A rectangle in the corners that EXA has; `None` if it is empty or leaves the pixmaps that the card takes.
fn rectangle(x: i32, y: i32, right: i32, bottom: i32) -> Option<ListRectangle> {
    let (left, top) = (x.try_into().ok()?, y.try_into().ok()?);
    let [width, height] = [right.checked_sub(x)?, bottom.checked_sub(y)?].map(|side| u16::try_from(side).ok());
    let rectangle = ListRectangle { x: left, y: top, width: width?, height: height? };
    (rectangle.width > 0 && rectangle.height > 0).then_some(rectangle)
}

/// The image that a pixmap's pixels are in.
pub(super) const fn image<'a>(frame: &'a Image, pixmap: &'a Pixmap) -> Option<&'a Image> {
    match &pixmap.place {
        Place::Frame => Some(frame),
        Place::Card(image) => Some(image),
        _ => None,
    }
}

impl Engine {
    /// Prepares fills of a pixmap of `depth` with a pixel value. False: the server's renderer has to do it.
    pub fn prepare_solid(&mut self, pixmap: usize, depth: u32, function: u32, planes: u32, value: u32) -> bool {
        let Some(raster) = raster(function, planes, depth) else { return false };
        if !self.bring_in(&[pixmap], 0) {
            return false;
        }
        self.current = Current::Solid { pixmap, value, raster };
        true
    }

    /// Fills a rectangle as prepared; right and bottom are exclusive.
    pub fn solid(&mut self, x: i32, y: i32, right: i32, bottom: i32) {
        self.scratch.rectangles.extend(rectangle(x, y, right, bottom));
    }

    /// Prepares copies between pixmaps of one depth, or within one.
    pub fn prepare_copy(&mut self, from: usize, to: usize, depth: u32, function: u32, planes: u32) -> bool {
        let Some(raster) = raster(function, planes, depth) else { return false };
        if !self.bring_in(&[from, to], 0) {
            return false;
        }
        let format = |number| self.pixmaps.get(number).and_then(|pixmap| image(&self.frame, pixmap)).map(Image::format);
        if format(from) != format(to) {
            return false;
        }
        self.current = Current::Copy { from, to, raster, offset: [0; 2] };
        true
    }

    /// Copies a rectangle as prepared.
    pub fn copy(&mut self, from: (i32, i32), to: (i32, i32), width: i32, height: i32) {
        let Current::Copy { offset, .. } = self.current else { return };
        let wanted = [from.0 - to.0, from.1 - to.1];
        if wanted != offset {
            self.encode_prepared();
            if let Current::Copy { offset, .. } = &mut self.current {
                *offset = wanted;
            }
        }
        self.scratch.rectangles.extend(rectangle(to.0, to.1, to.0 + width, to.1 + height));
    }

    /// Ends what was prepared.
    pub fn done(&mut self) {
        self.encode_prepared();
        self.current = Current::Nothing;
    }

    /// Encodes the rectangles that wait.
    fn encode_prepared(&mut self) {
        if self.scratch.rectangles.is_empty() {
            return;
        }
        let rectangles = std::mem::take(&mut self.scratch.rectangles);
        let place = |number| self.pixmaps.get(number).and_then(|pixmap| image(&self.frame, pixmap));
        let work = work_of(&rectangles);
        match self.current {
            Current::Nothing => {}
            Current::Solid { pixmap, value, raster } => {
                let Some(onto) = place(pixmap) else { return };
                let filled = self.driver.fill_list(&Canvas::whole(onto, raster), value, &rectangles);
                self.drawn(filled, &[pixmap], work);
            }
            Current::Copy { from, to, raster, offset } => {
                let (Some(read), Some(onto)) = (place(from), place(to)) else { return };
                let copied = self.driver.copy_list(read, offset, &Canvas::whole(onto, raster), &rectangles);
                self.drawn(copied, &[from, to], 2 * work);
            }
        }
        self.scratch.rectangles = rectangles;
        self.scratch.rectangles.clear();
    }

    /// Takes note of an operation that was encoded, or of why it was not. False: nothing of it was encoded, and the
    /// server's renderer can do it.
    pub(super) fn drawn(&mut self, encoded: Result<(), DriverError>, pixmaps: &[usize], work: u64) -> bool {
        if let Err(error) = encoded {
            self.report(&error);
            // Other errors are those of sending, which the driver meets with all of the operation encoded.
            if !matches!(error, DriverError::CardFault(_) | DriverError::Timeout { .. }) {
                return false;
            }
        }
        let batch = self.batches.encoded();
        for &number in pixmaps {
            if let Some(pixmap) = self.pixmaps.get_mut(number) {
                pixmap.batch = batch;
            }
        }
        self.encoded(work);
        true
    }
}
