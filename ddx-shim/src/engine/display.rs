//! The display: what scan-out shows, and the cursor over it.

use std::time::Duration;

use zga_device::CardBus;
use zga_driver::{Driver, DriverError, Image};

use super::Engine;

impl Engine {
    /// Shows the upper left of the frame buffer; `None` turns the screen dark.
    ///
    /// # Errors
    /// What the driver refuses.
    pub fn show(&mut self, size: Option<(u32, u32)>) -> Result<(), DriverError> {
        self.display(|driver, frame| match size {
            Some((width, height)) => driver.show_image(frame, width, height),
            None => driver.show_nothing(),
        })
    }

    /// A vertical blank every `period`, for viewers; `None`: none by itself.
    ///
    /// # Errors
    /// What the driver refuses.
    pub fn set_refresh(&mut self, period: Option<Duration>) -> Result<(), DriverError> {
        self.display(|driver, _| driver.set_refresh(period))
    }

    /// Gives the cursor a picture.
    ///
    /// # Errors
    /// What the driver refuses.
    pub fn set_cursor_image(&mut self, pixels: &[u32; 4096]) -> Result<(), DriverError> {
        self.display(|driver, _| driver.set_cursor_image(pixels))
    }

    /// Moves the cursor.
    ///
    /// # Errors
    /// What the driver refuses.
    pub fn move_cursor(&mut self, x: i32, y: i32) -> Result<(), DriverError> {
        self.display(|driver, _| driver.move_cursor(x, y))
    }

    /// Shows or hides the cursor.
    ///
    /// # Errors
    /// What the driver refuses.
    pub fn show_cursor(&mut self, shown: bool) -> Result<(), DriverError> {
        self.display(|driver, _| driver.show_cursor(shown))
    }

    /// A call for the display. It may send, so a mapping is put aside for it.
    fn display(
        &mut self,
        call: impl FnOnce(&mut Driver<CardBus>, &Image) -> Result<(), DriverError>,
    ) -> Result<(), DriverError> {
        let mapped = self.mapping.take().is_some();
        let done = call(&mut self.driver, &self.frame);
        self.encoded(0);
        if mapped {
            self.mapping = Some(self.card.map());
        }
        done
    }
}
