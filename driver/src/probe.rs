//! Pixel history: which fragments came to one pixel, and what became of them.

use zga_abi::bus::{Bus, MEMORY_BASE};
use zga_abi::packet::{PROBE_RECORD_WORDS, ProbeRecord};
use zga_abi::registers::Reg;

use crate::memory::Alignment;
use crate::{Driver, DriverError};

/// What the probe has seen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PixelHistory {
    /// Fragments that came since the probe was set.
    pub fragments: u32,
    /// The first of them, in order; fewer than `fragments` if the record area was full.
    pub records: Vec<ProbeRecord>,
}

impl<B: Bus> Driver<B> {
    /// Records what comes to pixel (x, y) from here on in the stream of packets, at most `records` fragments.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for coordinates over 32767 or records over 2^24 - 1,
    /// [`DriverError::Memory`] if there is no room, or as [`Driver::flush`].
    pub fn probe_pixel(&mut self, x: u32, y: u32, records: u32) -> Result<(), DriverError> {
        for (name, found, most, expected) in [
            ("probe x", x, 0x7FFF, "0 to 32767"),
            ("probe y", y, 0x7FFF, "0 to 32767"),
            ("probe records", records, 0x00FF_FFFF, "0 to 16777215"),
        ] {
            if found > most {
                return Err(DriverError::BadOption { name, found: found.to_string(), expected });
            }
        }
        self.probe_off()?;
        let bytes = u64::from(records) * 4 * u64::from(PROBE_RECORD_WORDS);
        let area = self.allocate(bytes, Alignment::Line)?;
        self.registers.want(Reg::ProbePixel, &[x | y << 16, area.address(), records]);
        self.probe_area = Some(area);
        self.send_registers()?;
        // Enabled by a packet of its own, when all else is set.
        self.registers.want(Reg::ProbeControl, &[1]);
        self.send_registers()
    }

    /// Stops recording and forgets the records.
    ///
    /// # Errors
    /// As [`Driver::flush`].
    pub fn probe_off(&mut self) -> Result<(), DriverError> {
        self.adopt_recovered();
        self.registers.want(Reg::ProbeControl, &[0]);
        let sent = self.send_registers();
        if let Some(area) = self.probe_area.take() {
            self.free(area)?;
        }
        sent
    }

    /// Waits for all work and reads what the probe has seen; nothing if it is off.
    ///
    /// # Errors
    /// As [`Driver::wait`].
    pub fn pixel_history(&mut self) -> Result<PixelHistory, DriverError> {
        self.finish()?;
        let Some(area) = &self.probe_area else { return Ok(PixelHistory::default()) };
        let address = MEMORY_BASE + area.address();
        let fragments = self.bus.read32(Reg::ProbeCount.offset());
        let count = fragments.min(self.registers.wanted(Reg::ProbeSize));
        let mut records = vec![ProbeRecord::default(); count as usize];
        self.bus.read_burst(address, bytemuck::cast_slice_mut(&mut records));
        Ok(PixelHistory { fragments, records })
    }
}
