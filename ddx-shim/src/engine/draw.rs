//! Drawing as EXA asks for it: one call prepares, any number draw, one ends.

use zga_driver::{Raster, Rectangle};

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
    /// Copies.
    Copy { from: usize, to: usize, raster: Raster },
}

/// A rectangle in the corners that EXA has; `None` if it is empty or begins left of or above the pixmap.
fn rectangle(x: i32, y: i32, right: i32, bottom: i32) -> Option<Rectangle> {
    let number = |number: i32| u32::try_from(number).ok();
    let rectangle = Rectangle { x: number(x)?, y: number(y)?, right: number(right)?, bottom: number(bottom)? };
    (rectangle.x < rectangle.right && rectangle.y < rectangle.bottom).then_some(rectangle)
}

/// Pixels of a rectangle.
pub(super) const fn area(rectangle: Rectangle) -> u64 {
    (rectangle.right - rectangle.x) as u64 * (rectangle.bottom - rectangle.y) as u64
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
        let Current::Solid { pixmap, value, raster } = self.current else { return };
        let Some(rectangle) = rectangle(x, y, right, bottom) else { return };
        let Some(onto) = self.pixmaps.get(pixmap).and_then(|pixmap| image(&self.frame, pixmap)) else { return };
        let filled = if raster == Raster::new(zga_abi::format::RasterOperation::Copy) {
            self.driver.fill(onto, rectangle, value)
        } else {
            self.driver.fill_rop(onto, rectangle, value, raster)
        };
        self.drawn(filled, &[pixmap], area(rectangle));
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
        self.current = Current::Copy { from, to, raster };
        true
    }

    /// Copies a rectangle as prepared.
    pub fn copy(&mut self, from: (i32, i32), to: (i32, i32), width: i32, height: i32) {
        let Current::Copy { from: source, to: onto, raster } = self.current else { return };
        let Some(rectangle) = rectangle(to.0, to.1, to.0 + width, to.1 + height) else { return };
        let (Ok(x), Ok(y)) = (u32::try_from(from.0), u32::try_from(from.1)) else { return };
        let image = |number| self.pixmaps.get(number).and_then(|pixmap| image(&self.frame, pixmap));
        let (Some(read), Some(written)) = (image(source), image(onto)) else { return };
        let copied = self.driver.copy_rop(read, [x, y], written, rectangle, raster);
        self.drawn(copied, &[source, onto], 2 * area(rectangle));
    }

    /// Ends what was prepared.
    pub fn done(&mut self) {
        self.current = Current::Nothing;
    }

    /// Takes note of an operation that was encoded, or of why it was not.
    pub(super) fn drawn(&mut self, encoded: Result<(), zga_driver::DriverError>, pixmaps: &[usize], work: u64) {
        if let Err(error) = encoded {
            self.report(&error);
        }
        let batch = self.batches.encoded();
        for &number in pixmaps {
            if let Some(pixmap) = self.pixmaps.get_mut(number) {
                pixmap.batch = batch;
            }
        }
        self.encoded(work);
    }
}
