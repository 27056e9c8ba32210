//! Monitor: what sees the frames, and the cable between it and the card.
//!
//! Duties: carries the newest frame; tells scan-out whether anybody looks.
//! Inputs: frames of scan-out. Outputs: [`Frame`]s to the host's program.
//! Clocks: none; the pixels were charged when they were put out.

use parking_lot::{Condvar, Mutex};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::time::{Duration, Instant};

/// A frame as it left the card. Clones share the pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    width: u32,
    height: u32,
    number: u64,
    pixels: Arc<Vec<u32>>,
}

impl Frame {
    /// A frame of `width * height` pixels.
    pub(crate) fn new(width: u32, height: u32, number: u64, pixels: Arc<Vec<u32>>) -> Frame {
        Frame { width, height, number, pixels }
    }

    /// Pixels of a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The vertical blank at which it went out, counted from power-on; rises from frame to frame.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// XRGB8888 pixels, dense rows from the top; 31:24 is 255.
    #[must_use]
    pub fn pixels(&self) -> &[u32] {
        &self.pixels
    }

    /// Have the two the very same pixels in memory, because nothing changed between them?
    #[must_use]
    pub fn shares_pixels(&self, other: &Frame) -> bool {
        Arc::ptr_eq(&self.pixels, &other.pixels)
    }
}

/// What is at the end of the cable.
#[derive(Debug, Default)]
struct Signal {
    newest: Option<Frame>,
    unplugged: bool,
}

/// The cable between scan-out and the monitors.
#[derive(Debug, Default)]
pub(crate) struct Cable {
    signal: Mutex<Signal>,
    changed: Condvar,
    monitors: AtomicUsize,
    /// A monitor was plugged in and has seen nothing yet.
    fresh: AtomicBool,
}

impl Cable {
    /// Does anybody look?
    pub(crate) fn is_watched(&self) -> bool {
        self.monitors.load(SeqCst) > 0
    }

    /// Was a monitor plugged in since the last call?
    pub(crate) fn take_fresh(&self) -> bool {
        self.fresh.swap(false, SeqCst)
    }

    /// Shows a frame.
    pub(crate) fn put(&self, frame: Frame) {
        self.signal.lock().newest = Some(frame);
        self.changed.notify_all();
    }

    /// The card has lost power: nothing more will come.
    pub(crate) fn unplug(&self) {
        self.signal.lock().unplugged = true;
        self.changed.notify_all();
    }
}

/// The card's video connector: monitors can be plugged in, now or later. Holding it watches nothing.
#[derive(Clone, Debug)]
pub struct Connector {
    cable: Arc<Cable>,
}

impl Connector {
    /// The connector that `cable` hangs at.
    pub(crate) fn new(cable: Arc<Cable>) -> Connector {
        Connector { cable }
    }

    /// Plugs a display in. Frames are composed only while there is one.
    #[must_use]
    pub fn plug(&self) -> Monitor {
        Monitor::new(Arc::clone(&self.cable))
    }

    /// Does any display hang at the card?
    #[must_use]
    pub fn is_watched(&self) -> bool {
        self.cable.is_watched()
    }
}

/// A display at the card's cable. While one exists, frames are composed; a clone is another display.
///
/// It sees the frames that go out from the moment it is plugged in; in continuous mode the next
/// vertical blank is one, whether or not anything changed.
#[derive(Debug)]
pub struct Monitor {
    cable: Arc<Cable>,
    /// Number of the last frame that [`Monitor::wait_next`] gave, or that was there before.
    seen: u64,
}

impl Monitor {
    /// Plugs a monitor in.
    pub(crate) fn new(cable: Arc<Cable>) -> Monitor {
        cable.monitors.fetch_add(1, SeqCst);
        cable.fresh.store(true, SeqCst);
        let seen = cable.signal.lock().newest.as_ref().map_or(0, |frame| frame.number);
        Monitor { cable, seen }
    }

    /// The newest frame, if one has come.
    #[must_use]
    pub fn latest(&self) -> Option<Frame> {
        self.cable.signal.lock().newest.clone()
    }

    /// The newest frame that this call has not given yet, waiting at most `timeout` for it; `None`
    /// after that, or when the card has lost power.
    pub fn wait_next(&mut self, timeout: Duration) -> Option<Frame> {
        let deadline = Instant::now().checked_add(timeout);
        let mut signal = self.cable.signal.lock();
        loop {
            let next = signal.newest.as_ref().filter(|frame| frame.number > self.seen);
            if let Some(frame) = next.cloned() {
                self.seen = frame.number;
                return Some(frame);
            }
            if signal.unplugged {
                return None;
            }
            match deadline {
                Some(deadline) if Instant::now() >= deadline => return None,
                Some(deadline) => {
                    self.cable.changed.wait_until(&mut signal, deadline);
                }
                None => self.cable.changed.wait(&mut signal),
            }
        }
    }
}

impl Clone for Monitor {
    fn clone(&self) -> Self {
        let mut monitor = Monitor::new(Arc::clone(&self.cable));
        monitor.seen = self.seen;
        monitor
    }
}

impl Drop for Monitor {
    fn drop(&mut self) {
        self.cable.monitors.fetch_sub(1, SeqCst);
    }
}
