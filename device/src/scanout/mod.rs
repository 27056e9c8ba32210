//! Scan-out: the display controller.
//!
//! Duties: makes vertical blanks, on demand (one for each PRESENT) or continuous (one every
//! SCANOUT_PERIOD); shows the frame that the SCANOUT registers describe; writes a frame back.
//! For blocks of the frame that are cleared in Za RAM only it puts the background out; over all of it the [`cursor`].
//! Inputs: SCANOUT and CURSOR registers, PRESENT and WRITE_BACK from the firmware, the frame in video memory, Za words.
//! Outputs: frames on the display cable; FRAME_COUNT; the vertical blank interrupt; words in memory.
//! Clocks (`cycles.scanout`): 1 for each pixel put out, at every vertical blank and every write back:
//! the display takes one pixel a clock, and takes it whether or not anybody looks at the screen.
//! So the account does not depend on who holds a monitor; only the host's work does. A cursor: see [`cursor`].
//!
//! In continuous mode a blank that comes due during a long packet is late; blanks that were missed
//! meanwhile are left out, not made up for.

pub(crate) mod compose;
mod cursor;
pub(crate) mod monitor;

use crate::bus::backplane::Backplane;
use crate::memory::VideoMemory;
use crate::probe::account::{Account, Clocks};
use compose::{Cleared, compose};
use cursor::Cursor;
use monitor::Frame;
use parking_lot::MutexGuard;
use std::sync::Arc;
use std::time::{Duration, Instant};
use zga_abi::bus::INTERRUPT_VERTICAL_BLANK;
use zga_abi::format::PixelFormat;
use zga_abi::{Counter, Reg};
use zga_firmware::checked::Surface;

/// Frames that are kept to be used again: one on the cable, one at the monitor, one in work.
const FRAMES_KEPT: usize = 3;

/// Pixels of frames, shared with the monitors.
type Pixels = Arc<Vec<u32>>;

/// The display controller.
#[derive(Debug, Default)]
pub(crate) struct Scanout {
    /// Blanks since power-on; the number of a frame. Not touched by a reset.
    blanks: u64,
    /// What the frame on the cable was composed from: surface, cursor and generation of memory.
    composed: Option<(Surface, Option<Cursor>, u64)>,
    /// Frames in the order of their use, the last composed at the end.
    kept: Vec<Pixels>,
    /// When the next blank comes, in continuous mode.
    next: Option<Instant>,
    /// A frame to be written back.
    scratch: Vec<u32>,
}

impl Scanout {
    /// Gives its memory back.
    pub(crate) fn power_off(&mut self) {
        *self = Scanout { blanks: self.blanks, next: self.next, ..Scanout::default() };
    }

    /// When the next blank is due by itself; `None` in on-demand mode.
    pub(crate) fn deadline(&mut self, backplane: &Backplane) -> Option<Instant> {
        if backplane.registers.get(Reg::ScanoutControl) & 1 == 0 {
            self.next = None;
        } else if self.next.is_none() {
            self.next = Some(Instant::now() + period(backplane));
        }
        self.next
    }

    /// Makes the vertical blank if it is due by itself.
    pub(crate) fn tick(&mut self, backplane: &Backplane, memory: &mut VideoMemory, account: &mut Account) {
        let Some(due) = self.deadline(backplane) else { return };
        let now = Instant::now();
        if now >= due {
            let next = due + period(backplane);
            self.next = Some(if next > now { next } else { now + period(backplane) });
            self.blank(backplane, memory, account);
        }
    }

    /// PRESENT: shows the frame at byte `base` from the next vertical blank on, and returns when that
    /// has begun. The host can use memory while the card waits; a reset or power-off ends the wait.
    pub(crate) fn present(
        &mut self,
        backplane: &Backplane,
        memory: &mut MutexGuard<'_, VideoMemory>,
        base: u32,
        account: &mut Account,
    ) {
        while let Some(due) = self.deadline(backplane) {
            let wait = due.saturating_duration_since(Instant::now());
            if wait.is_zero() {
                break;
            }
            if backplane.control.stopping() {
                return;
            }
            MutexGuard::unlocked(memory, || std::thread::park_timeout(wait));
        }
        backplane.registers.set(Reg::ScanoutBase, base);
        match self.next {
            Some(_) => self.tick(backplane, memory, account),
            None => self.blank(backplane, memory, account),
        }
    }

    /// A vertical blank: the frame shown goes out, is counted, and the interrupt is raised.
    pub(crate) fn blank(&mut self, backplane: &Backplane, memory: &mut VideoMemory, account: &mut Account) {
        // A snapshot can hold any number; at the end of all numbers frames no longer rise.
        self.blanks = self.blanks.saturating_add(1);
        let count = backplane.registers.get(Reg::FrameCount);
        if let Some(surface) = shown(backplane, memory) {
            let cursor = Cursor::shown(backplane, memory);
            charge(account, &surface, &Cleared::of(memory, &surface), cursor.as_ref());
            if backplane.cable.is_watched() {
                self.put_out(backplane, memory, surface, cursor);
            }
        }
        backplane.publish(account);
        backplane.registers.set(Reg::FrameCount, count.wrapping_add(1));
        backplane.interrupts.raise(INTERRUPT_VERTICAL_BLANK);
    }

    /// Puts the frame on the cable; composes it only if something changed since it was composed last.
    fn put_out(&mut self, backplane: &Backplane, memory: &mut VideoMemory, surface: Surface, cursor: Option<Cursor>) {
        let fresh = backplane.cable.take_fresh();
        let unchanged = self.composed == Some((surface, cursor, memory.generation()));
        if unchanged && !fresh && self.next.is_some() {
            return;
        }
        if !unchanged || self.kept.is_empty() {
            let mut pixels = self.spare();
            picture(memory, &surface, cursor.as_ref(), Arc::make_mut(&mut pixels));
            self.kept.push(pixels);
            let first = (surface.base / 4) as usize;
            let frame = first..first + (surface.pitch as usize / 4) * surface.height as usize;
            memory.watch([frame, cursor.map_or(0..0, |cursor| cursor.words())]);
            self.composed = Some((surface, cursor, memory.generation()));
        }
        if let Some(pixels) = self.kept.last() {
            let pixels = Arc::clone(pixels);
            backplane.cable.put(Frame::new(surface.width, surface.height, self.blanks, pixels));
        }
    }

    /// Room for a frame: one that nobody looks at any more, else new.
    fn spare(&mut self) -> Pixels {
        let idle = self.kept.iter_mut().position(|pixels| Arc::get_mut(pixels).is_some());
        match idle {
            Some(index) => self.kept.remove(index),
            None => {
                if self.kept.len() >= FRAMES_KEPT {
                    self.kept.remove(0);
                }
                Pixels::default()
            }
        }
    }

    /// Composes the frame shown to dense XRGB8888 rows at byte `destination`.
    ///
    /// The firmware has checked both, but a host can have changed the SCANOUT registers since: what
    /// does not fit into memory any more is not written.
    pub(crate) fn write_back(
        &mut self,
        backplane: &Backplane,
        memory: &mut VideoMemory,
        destination: u32,
        account: &mut Account,
    ) {
        let Some(surface) = shown(backplane, memory) else { return };
        let cursor = Cursor::shown(backplane, memory);
        picture(memory, &surface, cursor.as_ref(), &mut self.scratch);
        charge(account, &surface, &Cleared::of(memory, &surface), cursor.as_ref());
        let bytes = u64::from(destination)..u64::from(destination) + 4 * self.scratch.len() as u64;
        let room = memory.using(0..0, bytes, account).get_mut((destination / 4) as usize..).unwrap_or_default();
        if let Some(room) = room.get_mut(..self.scratch.len()) {
            room.copy_from_slice(&self.scratch);
        }
    }

    /// Blanks since power-on.
    pub(crate) fn blanks(&self) -> u64 {
        self.blanks
    }

    /// Begins again from a snapshot.
    pub(crate) fn load(&mut self, blanks: u64) {
        // A monitor has seen frames up to the old number: numbers never fall.
        *self = Scanout { blanks: self.blanks.max(blanks), ..Scanout::default() };
    }

    /// After a reset: on demand, nothing composed.
    pub(crate) fn reset(&mut self) {
        *self = Scanout { blanks: self.blanks, ..Scanout::default() };
    }
}

/// SCANOUT_PERIOD.
fn period(backplane: &Backplane) -> Duration {
    Duration::from_micros(u64::from(backplane.registers.get(Reg::ScanoutPeriod).clamp(1000, 1_000_000)))
}

/// Composes what the display shows: the frame, and the cursor over it.
fn picture(memory: &VideoMemory, surface: &Surface, cursor: Option<&Cursor>, frame: &mut Vec<u32>) {
    compose(memory.words(), surface, &Cleared::of(memory, surface), frame);
    if let Some(cursor) = cursor {
        cursor.overlay(memory, surface, frame);
    }
}

/// Charges a frame put out.
fn charge(account: &mut Account, surface: &Surface, cleared: &Cleared<'_>, cursor: Option<&Cursor>) {
    let pixels = u64::from(surface.width) * u64::from(surface.height);
    account.add(Counter::ScanoutFrames, 1);
    account.add(Counter::ScanoutPixels, pixels);
    account.add(Counter::ScanoutBackgroundBlocks, cleared.blocks());
    let [covered, fetches] = cursor.map_or([0; 2], |cursor| cursor.cost(surface));
    account.add(Counter::ScanoutCursorPixels, covered);
    account.charge(Counter::CyclesScanout, Clocks(pixels + fetches));
}

/// The frame that the SCANOUT registers describe; `None` is a dark screen.
///
/// A host can write the registers with any values at any time, so they are checked here each time.
fn shown(backplane: &Backplane, memory: &VideoMemory) -> Option<Surface> {
    let get = |reg| backplane.registers.get(reg);
    let (size, base, pitch) = (get(Reg::ScanoutSize), get(Reg::ScanoutBase), get(Reg::ScanoutPitch));
    let (width, height) = (size & 0x7FFF, (size >> 16) & 0x7FFF);
    let format = PixelFormat::from_code(get(Reg::ScanoutFormat))?;
    let sides = 1..=16384;
    let whole = sides.contains(&width)
        && sides.contains(&height)
        && base.is_multiple_of(64)
        && pitch.is_multiple_of(64)
        && width * format.bytes() <= pitch
        && u64::from(base) + u64::from(pitch) * u64::from(height) <= 4 * memory.words().len() as u64;
    whole.then_some(Surface { base, pitch, width, height, format })
}
