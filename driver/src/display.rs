//! What the display shows beside presented targets: an image, the rate of vertical blanks, a cursor.

use std::time::Duration;

use zga_abi::bus::Bus;
use zga_abi::format::CURSOR_SIDE;
use zga_abi::packet::Opcode;
use zga_abi::registers::Reg;

use crate::memory::{Alignment, Allocation};
use crate::target::size_word;
use crate::{Driver, DriverError, Image};

/// Words of a cursor's picture.
const CURSOR_WORDS: usize = (CURSOR_SIDE * CURSOR_SIDE) as usize;
/// Bytes of a row of it.
const CURSOR_PITCH: u32 = 4 * CURSOR_SIDE;

impl<B: Bus> Driver<B> {
    /// Shows the first `width` columns and `height` rows of an image, from the next vertical blank on, until something
    /// else is shown; what happens to the image meanwhile is seen. In continuous mode nothing more is needed, else
    /// [`Driver::blank`].
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for a size that the image has not, or a format that is no frame buffer's; or as
    /// [`Driver::flush`].
    pub fn show_image(&mut self, image: &Image, width: u32, height: u32) -> Result<(), DriverError> {
        let bad = |found, expected| DriverError::BadOption { name: "image shown", found, expected };
        let Some(format) = image.format().pixel_format() else {
            return Err(bad(image.format().name().to_owned(), "a format of frame buffers"));
        };
        if !(1..=image.width()).contains(&width) || !(1..=image.height()).contains(&height) {
            return Err(bad(format!("{width} x {height}"), "at least 1 x 1 and at most the image's size"));
        }
        self.adopt_recovered();
        self.registers.want(Reg::ScanoutBase, &[image.memory().address()]);
        self.registers.want(Reg::ScanoutPitch, &[image.pitch()]);
        self.registers.want(Reg::ScanoutFormat, &[format.code()]);
        self.registers.want(Reg::ScanoutSize, &[size_word(width, height)]);
        self.shown = Some((width, height));
        self.send_registers()
    }

    /// Turns the screen dark until something is shown again.
    ///
    /// # Errors
    /// As [`Driver::flush`].
    pub fn show_nothing(&mut self) -> Result<(), DriverError> {
        self.adopt_recovered();
        self.registers.want(Reg::ScanoutSize, &[0]);
        self.shown = None;
        self.send_registers()
    }

    /// Makes a vertical blank: what is shown goes out to the display. In continuous mode it waits for the next one.
    ///
    /// # Errors
    /// As [`Driver::flush`].
    pub fn blank(&mut self) -> Result<(), DriverError> {
        self.adopt_recovered();
        let base = self.registers.wanted(Reg::ScanoutBase);
        let registers = self.send_registers();
        registers.and(self.encode(Opcode::Present, &[&[base]]))
    }

    /// A vertical blank every `period`, from 1 ms to 1 s, whatever the card does; `None`: one for each frame presented.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for another period, or as [`Driver::flush`].
    pub fn set_refresh(&mut self, period: Option<Duration>) -> Result<(), DriverError> {
        let control = match period.map(|period| period.as_micros()) {
            None => vec![0],
            Some(micros @ 1000..=1_000_000) => vec![1, micros as u32],
            Some(micros) => {
                let found = format!("{micros} microseconds");
                return Err(DriverError::BadOption { name: "refresh period", found, expected: "1 ms to 1 s" });
            }
        };
        self.adopt_recovered();
        self.registers.want(Reg::ScanoutControl, &control);
        self.send_registers()
    }

    /// Gives the cursor a picture: 64 x 64 ARGB8888 pixels in dense rows, colours multiplied by their alpha. It takes
    /// 16 KiB of video memory with the first one; whether it is shown is [`Driver::show_cursor`]'s.
    ///
    /// # Errors
    /// [`DriverError::Memory`] if there is no room for it, or as [`Driver::flush`].
    pub fn set_cursor_image(&mut self, pixels: &[u32; CURSOR_WORDS]) -> Result<(), DriverError> {
        let area = match self.cursor_area.take() {
            Some(area) => area,
            None => self.allocate(4 * CURSOR_WORDS as u64, Alignment::Line)?,
        };
        let address = self.cursor_area.insert(area).address();
        self.adopt_recovered();
        self.registers.want(Reg::CursorBase, &[address]);
        let registers = self.send_registers();
        // One packet: no frame goes out with a part of the picture.
        registers.and(self.encode(Opcode::Upload, &[&[address, CURSOR_PITCH, CURSOR_SIDE, CURSOR_SIDE], pixels]))
    }

    /// Moves the cursor: where its picture's first pixel lies on the screen, from -32768 to 32767; numbers beyond count
    /// as the nearest of these.
    ///
    /// # Errors
    /// As [`Driver::flush`].
    pub fn move_cursor(&mut self, x: i32, y: i32) -> Result<(), DriverError> {
        let half = |place: i32| u32::from(place.clamp(i16::MIN.into(), i16::MAX.into()) as u16);
        self.adopt_recovered();
        self.registers.want(Reg::CursorPosition, &[half(y) << 16 | half(x)]);
        self.send_registers()
    }

    /// Shows or hides the cursor; before it has a picture there is nothing to show.
    ///
    /// # Errors
    /// As [`Driver::flush`].
    pub fn show_cursor(&mut self, shown: bool) -> Result<(), DriverError> {
        self.adopt_recovered();
        self.registers.want(Reg::CursorControl, &[u32::from(shown && self.cursor_area.is_some())]);
        self.send_registers()
    }

    /// Turns the screen dark if what it shows lies in this memory.
    pub(crate) fn darken(&mut self, area: &Allocation) -> Result<(), DriverError> {
        if self.shown.is_some() && self.registers.wanted(Reg::ScanoutBase) == area.address() {
            return self.show_nothing();
        }
        Ok(())
    }
}
