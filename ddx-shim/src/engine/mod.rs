//! The engine: a card with its driver, and what the X server keeps in its memory.
//!
//! Everything here is plain Rust over `zga-driver`: pixmaps, accesses of the server's own renderer, batches of work.
//! The module `ffi` (feature `xorg`) is what the server calls; it hands numbers, rectangles and lists to this one.
//!
//! # Who may touch video memory when
//! The card works by itself on what was sent. The server's renderer touches pixels only between [`Engine::access`] and
//! [`Engine::finish`]: the first access waits for the batches that use the pixmap and takes the card's memory
//! arbitration ([`zga_device::MappedMemory`]), the last one gives it back. Between the two nothing is encoded or sent,
//! for the ring lies in video memory as well: every drawing call says no, and the server's renderer does the work.
//!
//! # When work is sent
//! Nothing is sent call by call. A batch goes out when the server has nothing else to do ([`Engine::flush`]), when an
//! access needs it, or when it holds enough work to keep the card busy (`BATCH_WORK`).

mod access;
mod batches;
mod closing;
pub mod compose;
mod display;
mod draw;
pub mod glyphs;
pub mod lists;
mod moves;
mod pixmaps;
mod residency;
#[cfg(test)]
mod tests;
mod transfer;

use std::time::Duration;

use zga_abi::format::BitmapFormat;
use zga_abi::{Bus, Reg};
use zga_device::{Card, CardBus, CardOptions, Kernel, MappedMemory};
use zga_driver::memory::MemoryError;
use zga_driver::{Driver, DriverError, DriverOptions, Image, Submit};

use crate::format::bitmap_format;
use batches::{Batch, Batches};
use draw::Current;
use pixmaps::{Pixmap, Pixmaps, Place};

/// Work in a batch after which it is sent at once, in pixels: about a millisecond of the card's time.
const BATCH_WORK: u64 = 1 << 22;
/// Work that an entry of a list or a packet is at least, in pixels.
const ENTRY_WORK: u64 = 64;
/// Batches that may be under way; a client that draws faster waits for the card, so that no other waits long for it.
const MOST_BATCHES: usize = 8;
/// Bytes of video memory for each word of the ring: it takes a thirty-second of the memory. The longer it is, the more
/// goes into it at once.
const MEMORY_A_WORD: u32 = 128;
/// Longest wait for the card; it works in this process and never takes so long.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Refused packets that a wait goes over before it gives up.
const MOST_FAULTS: u32 = 16;
/// Pixels each way that an image can have.
const MOST_PIXELS: u32 = 16384;

/// How serious a line for the log is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// What is so.
    Information,
    /// Something does not work; the server goes on.
    Error,
}

/// Where lines for the server's log go.
pub type Log = Box<dyn Fn(Severity, &str)>;

/// How an engine is made.
#[derive(Clone, Copy, Debug)]
pub struct EngineOptions {
    /// Bytes of video memory.
    pub video_memory: u32,
    /// Threads that the card computes with; 0: all cores.
    pub threads: usize,
    /// The card draws; without, everything is refused.
    pub accel: bool,
    /// Pixels of the frame buffer.
    pub frame: (u32, u32),
    /// Format of the frame buffer.
    pub format: BitmapFormat,
    /// Pixels of work under which an idle card is not woken.
    pub cpu_limit: u64,
}

/// How a pixmap is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Where the card can draw, if there is room.
    Anywhere,
    /// In host memory for good.
    InHostMemory,
}

/// A card, its driver, and the pixmaps of a screen.
pub struct Engine {
    mapping: Option<MappedMemory>,
    driver: Driver<CardBus>,
    /// Behind the driver: it is dropped after it.
    card: Card,
    frame: Image,
    pixmaps: Pixmaps,
    batches: Batches,
    /// Accesses that are open.
    accesses: u32,
    /// Work in the current batch, pixels.
    work: u64,
    /// Operations so far: the clock of "used longest ago".
    operations: u64,
    /// The card draws; off for good after an error of the card.
    draws: bool,
    current: Current,
    scratch: lists::Scratch,
    /// Pixels of work under which an idle card is not woken.
    cpu_limit: u64,
    /// Bytes given back that the card may still use.
    leaving: u64,
    /// Pixmaps that moved into video memory, and out of it.
    moves: [u64; 2],
    log: Log,
}

impl std::fmt::Debug for Engine {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Engine").field("driver", &self.driver).field("card", &self.card).finish_non_exhaustive()
    }
}

impl Engine {
    /// Powers a card on, opens it and takes the frame buffer, which is black then.
    ///
    /// # Errors
    /// What the card or its driver refuses, as text for the log.
    pub fn new(options: &EngineOptions, log: Log) -> Result<Engine, String> {
        let card = Card::power_on(CardOptions {
            video_memory: options.video_memory,
            za_ram: 0,
            threads: options.threads,
            kernel: Kernel::default(),
        })
        .map_err(|error| format!("no card: {error}"))?;
        let ring_words = (options.video_memory / MEMORY_A_WORD + 1).next_power_of_two() / 2;
        let mut driver =
            Driver::open_with(card.bus(), DriverOptions { submit: Submit::Ring, ring_words, timeout: TIMEOUT })
                .map_err(|error| format!("the card does not open: {error}"))?;
        let (width, height) = options.frame;
        let frame = driver
            .create_image(width, height, options.format)
            .map_err(|error| format!("no frame buffer of {width} x {height} pixels: {error}"))?;
        Ok(Engine {
            mapping: None,
            driver,
            card,
            frame,
            pixmaps: Pixmaps::default(),
            batches: Batches::default(),
            accesses: 0,
            work: 0,
            operations: 0,
            draws: options.accel,
            current: Current::Nothing,
            scratch: lists::Scratch::default(),
            cpu_limit: options.cpu_limit,
            leaving: 0,
            moves: [0; 2],
            log,
        })
    }

    /// What there was, for the log.
    #[must_use]
    pub fn summary(&self) -> String {
        let [came, left] = self.moves;
        format!("{} operations; {came} pixmaps moved into video memory, {left} out of it", self.operations)
    }

    /// The card, for who looks at it.
    #[must_use]
    pub const fn card(&self) -> &Card {
        &self.card
    }

    /// Bytes from row to row of the frame buffer.
    #[must_use]
    pub const fn frame_pitch(&self) -> u32 {
        self.frame.pitch()
    }

    /// The frame buffer's first byte in the host's address space: good for telling it apart, and for access only while
    /// [`Engine::access`] to the frame is open.
    pub fn frame_address(&mut self) -> usize {
        let word = self.frame.memory().address() as usize / 4;
        if let Some(mapping) = &self.mapping {
            return mapping[word..].as_ptr() as usize;
        }
        self.card.map()[word..].as_ptr() as usize
    }

    /// Takes a pixmap in. Its pixels are what was there before.
    pub fn create_pixmap(&mut self, size: (u32, u32), bits_per_pixel: u32, wanted: Wanted) -> usize {
        let (width, height) = size;
        let format = bitmap_format(bits_per_pixel).filter(|_| {
            wanted == Wanted::Anywhere && width <= MOST_PIXELS && height <= MOST_PIXELS && width > 0 && height > 0
        });
        let (pitch, place) = match format {
            _ if width == 0 || height == 0 => (0, Place::Nothing),
            Some(format) => {
                let pitch = pitch_of(width * format.bytes());
                let image = if self.accesses == 0 { self.take_image(width, height, format) } else { None };
                (pitch, image.map_or_else(|| Place::Spilled(words(pitch, height)), Place::Card))
            }
            None => {
                // As the server pads rows: whole words of 32 bits.
                let pitch = (width * bits_per_pixel).div_ceil(32) * 4;
                (pitch, Place::Host(words(pitch, height)))
            }
        };
        let used = self.operations;
        let asks_at = u64::from(pitch) * u64::from(height);
        self.pixmaps.insert(Pixmap { width, height, bits_per_pixel, pitch, place, batch: 0, used, credit: 0, asks_at })
    }

    /// An image, if there is room for one whose rows are as long as they have to be.
    fn take_image(&mut self, width: u32, height: u32, format: BitmapFormat) -> Option<Image> {
        let pitch = pitch_of(width * format.bytes());
        let bytes = u64::from(pitch) * u64::from(height);
        if self.driver.memory().largest_free() < bytes {
            // Freed memory comes back when the card is done with it: worth waiting for if it is enough.
            if self.leaving < bytes || !self.drain() || self.driver.memory().largest_free() < bytes {
                return None;
            }
        }
        let image = match self.driver.create_image(width, height, format) {
            Ok(image) if image.pitch() == pitch => image,
            Ok(image) => {
                self.release(image);
                return None;
            }
            Err(DriverError::Memory(MemoryError::OutOfMemory { .. })) => return None,
            Err(error) => {
                self.report(&error);
                return None;
            }
        };
        Some(image)
    }

    /// Gives an image back.
    fn release(&mut self, image: Image) {
        self.leaving += u64::from(image.memory().bytes());
        if let Err(error) = self.driver.destroy_image(image) {
            self.report(&error);
        }
    }

    /// Sends everything and waits for it, so that all freed memory is free. False: the card does not do it.
    fn drain(&mut self) -> bool {
        self.leaving = 0;
        self.flush();
        if let Err(error) = self.driver.finish() {
            self.report(&error);
            return false;
        }
        self.batches.all_executed();
        true
    }

    /// Lets a pixmap go; what is encoded still uses it.
    pub fn destroy_pixmap(&mut self, number: usize) {
        if let Some(Pixmap { place: Place::Card(image), .. }) = self.pixmaps.remove(number) {
            self.release(image);
        }
    }

    /// The pixmap is the upper left of the frame buffer from now on.
    pub fn make_frame(&mut self, number: usize) {
        let pitch = self.frame.pitch();
        self.replace(number, pitch, Place::Frame);
    }

    /// The pixmap's pixels are in memory that is not this engine's from now on.
    pub fn make_foreign(&mut self, number: usize, pitch: u32) {
        self.replace(number, pitch, Place::Foreign);
    }

    fn replace(&mut self, number: usize, pitch: u32, place: Place) {
        let Some(pixmap) = self.pixmaps.get_mut(number) else { return };
        pixmap.pitch = pitch;
        if let Place::Card(image) = std::mem::replace(&mut pixmap.place, place) {
            self.release(image);
        }
    }

    /// Called when the server looks for new requests, and before it sleeps if there are none: sends what is encoded, unless
    /// the server goes on and the card has still something to do.
    pub fn rest(&mut self, sleeps: bool) {
        if self.batches.pending() && (sleeps || self.is_idle()) {
            self.flush();
        }
    }

    /// The card has executed everything that was sent.
    fn is_idle(&mut self) -> bool {
        if self.batches.under_way() > 0 {
            let now = self.driver.bus_mut().read32(Reg::FenceSequence.offset());
            self.batches.seen(now);
        }
        self.batches.under_way() == 0
    }

    /// So little work, and nothing to do for the card: the server's renderer does it in the time that waking the card's
    /// thread takes, and no access has to wait for it afterwards.
    fn is_small(&mut self, work: u64) -> bool {
        work < self.cpu_limit && !self.batches.pending() && self.is_idle()
    }

    /// Sends what is encoded.
    pub fn flush(&mut self) {
        if !self.batches.pending() || self.mapping.is_some() {
            return;
        }
        self.work = 0;
        for _ in 0..MOST_FAULTS {
            match self.driver.fence() {
                Ok(fence) => {
                    self.batches.sent(fence);
                    return;
                }
                Err(error) => {
                    self.report(&error);
                    if !matches!(error, DriverError::CardFault(_)) {
                        return;
                    }
                }
            }
        }
    }

    /// Waits until the card has executed this batch.
    fn wait_for(&mut self, batch: Batch) {
        if self.batches.is_done(batch) {
            return;
        }
        if self.batches.fence_of(batch).is_none() {
            self.flush();
        }
        let Some(fence) = self.batches.fence_of(batch) else { return };
        for _ in 0..MOST_FAULTS {
            match self.driver.wait(fence) {
                Ok(()) => {
                    self.batches.executed(batch);
                    return;
                }
                Err(error) => {
                    self.report(&error);
                    if !matches!(error, DriverError::CardFault(_)) {
                        break;
                    }
                }
            }
        }
        self.batches.all_executed();
    }

    /// Takes note of `work` pixels of work that were encoded; sends the batch when it is large.
    fn encoded(&mut self, work: u64) -> Batch {
        let batch = self.batches.encoded();
        self.work += work.max(ENTRY_WORK);
        if self.work >= BATCH_WORK {
            self.flush();
            if self.batches.under_way() > MOST_BATCHES
                && let Some(middle) = self.batches.middle()
            {
                self.wait_for(middle);
            }
        }
        batch
    }

    /// Tells the log, and stops drawing by the card: what it was to draw may be missing, and nobody knows why.
    fn report(&mut self, error: &DriverError) {
        (self.log)(Severity::Error, &format!("the card: {error}"));
        if self.draws {
            self.draws = false;
            (self.log)(Severity::Error, "the server's own renderer draws from here on");
        }
    }

    /// Says something in the log.
    pub fn say(&self, severity: Severity, text: &str) {
        (self.log)(severity, text);
    }

    /// Something went wrong that must not be met again: the card draws no more.
    pub fn refuse_everything(&mut self) {
        self.draws = false;
    }
}

/// Bytes from row to row of an image whose rows hold `bytes` bytes, as the driver lays it out.
const fn pitch_of(bytes: u32) -> u32 {
    let pitch = bytes.next_multiple_of(64);
    if pitch.is_multiple_of(4096) { pitch + 64 } else { pitch }
}

/// Words of zeros for `height` rows of `pitch` bytes.
fn words(pitch: u32, height: u32) -> Vec<u32> {
    vec![0; pitch as usize / 4 * height as usize]
}
