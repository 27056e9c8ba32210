//! Frames and depths out of the card.

use xxhash_rust::xxh3::Xxh3;
use zga_abi::bus::{Bus, MEMORY_BASE};
use zga_abi::packet::Opcode;

use crate::memory::{Alignment, Allocation};
use crate::{Driver, DriverError, Target, trace};

/// A frame as it was scanned out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Dense rows of XRGB8888: 23:16 red, 15:8 green, 7:0 blue.
    pub pixels: Vec<u32>,
    /// [`frame_hash`] of it all: "xxh3:" and 16 hexadecimal digits.
    pub hash: String,
}

impl Frame {
    /// A frame of these pixels, with its hash.
    pub(crate) fn new(width: u32, height: u32, pixels: Vec<u32>) -> Frame {
        let hash = hash_text(frame_hash(width, height, &pixels));
        Frame { width, height, pixels, hash }
    }

    /// Dense rows of 4 bytes a pixel: red, green, blue, 255.
    #[must_use]
    pub fn rgba(&self) -> Vec<u8> {
        let bytes = self.pixels.iter().map(|pixel| {
            let [_, red, green, blue] = pixel.to_be_bytes();
            [red, green, blue, 255]
        });
        bytes.flatten().collect()
    }
}

/// The hash that equal frames share on every machine and path: XXH3, 64 bits, seed 0, over width and height
/// and then the pixels row by row, all as 32-bit little-endian words; 31:24 of each pixel counts as 255.
#[must_use]
pub fn frame_hash(width: u32, height: u32, pixels: &[u32]) -> u64 {
    let mut hash = Xxh3::new();
    hash.update(&width.to_le_bytes());
    hash.update(&height.to_le_bytes());
    let mut bytes = Vec::with_capacity(4 * 1024);
    for run in pixels.chunks(1024) {
        bytes.clear();
        bytes.extend(run.iter().flat_map(|pixel| (pixel | 0xFF00_0000).to_le_bytes()));
        hash.update(&bytes);
    }
    hash.digest()
}

/// A frame hash as reports show it.
#[must_use]
pub fn hash_text(hash: u64) -> String {
    format!("xxh3:{hash:016x}")
}

impl<B: Bus> Driver<B> {
    /// Takes the frame that is shown: waits for all work, has the card compose it, reads it in one burst.
    ///
    /// # Errors
    /// [`DriverError::NothingShown`] before the first present, [`DriverError::InsideScene`],
    /// [`DriverError::Memory`] if there is no room for the copy, or as [`Driver::wait`].
    pub fn capture(&mut self) -> Result<Frame, DriverError> {
        if self.scene.is_some() {
            return Err(DriverError::InsideScene { call: "capture" });
        }
        let (width, height) = self.shown.ok_or(DriverError::NothingShown)?;
        let count = width as usize * height as usize;
        let address = self.capture_area(count)?;
        self.encode(Opcode::WriteBack, &[&[address]])?;
        self.finish()?;
        let mut pixels = vec![0; count];
        self.bus.read_burst(MEMORY_BASE + address, &mut pixels);
        let frame = Frame::new(width, height, pixels);
        self.bus.mark(&trace::frame_mark(&frame));
        Ok(frame)
    }

    /// Takes the Z buffer of a target, dense rows, as it is after all work so far.
    ///
    /// # Errors
    /// [`DriverError::NoDepthBuffer`]; [`DriverError::DepthNotKept`] after a scene that left no depths behind, see
    /// [`Driver::set_keep_depth`]; or as [`Driver::capture`].
    pub fn capture_depth(&mut self, target: &Target) -> Result<Vec<u32>, DriverError> {
        if self.scene.is_some() {
            return Err(DriverError::InsideScene { call: "capture_depth" });
        }
        let state = self.target_state(target)?;
        let (pitch, rows) = (state.depth_pitch, state.options.height);
        let from = state.depth.as_ref().map(Allocation::address);
        let from = from.ok_or(DriverError::NoDepthBuffer { id: Self::target_id(target) })?;
        if let Some(path) = state.depth_lost {
            return Err(DriverError::DepthNotKept { id: Self::target_id(target), path: path.name() });
        }
        let count = target.width() as usize * rows as usize;
        let address = self.capture_area(count)?;
        self.encode(Opcode::Download, &[&[from, pitch, target.width(), rows, address]])?;
        self.finish()?;
        let mut depths = vec![0; count];
        self.bus.read_burst(MEMORY_BASE + address, &mut depths);
        Ok(depths)
    }

    /// First byte of an area of at least `words` words; kept for the next capture.
    fn capture_area(&mut self, words: usize) -> Result<u32, DriverError> {
        let bytes = 4 * words as u64;
        if let Some(area) = self.capture_area.take() {
            if u64::from(area.bytes()) >= bytes {
                return Ok(self.capture_area.insert(area).address());
            }
            self.free(area)?;
        }
        let area = self.allocate(bytes, Alignment::Line)?;
        Ok(self.capture_area.insert(area).address())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_hash_ignores_the_top_byte_and_tells_shapes_apart() {
        let pixels = [0x0012_3456, 0xFF00_0001];
        assert_eq!(frame_hash(2, 1, &pixels), frame_hash(2, 1, &pixels.map(|pixel| pixel ^ 0x5500_0000)));
        assert_ne!(frame_hash(2, 1, &pixels), frame_hash(1, 2, &pixels));
        assert_ne!(frame_hash(2, 1, &pixels), frame_hash(2, 1, &[0x0012_3456, 2]));
    }

    #[test]
    fn frame_hash_known_bytes_equals_plain_xxh3() {
        let bytes = [2, 0, 0, 0, 1, 0, 0, 0, 0x56, 0x34, 0x12, 0xFF, 1, 0, 0, 0xFF];
        assert_eq!(frame_hash(2, 1, &[0x0012_3456, 1]), xxhash_rust::xxh3::xxh3_64(&bytes));
    }

    #[test]
    fn rgba_is_red_green_blue_255() {
        assert_eq!(Frame::new(1, 1, vec![0x0001_0203]).rgba(), [1, 2, 3, 255]);
    }
}
