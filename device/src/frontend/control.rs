//! Control: requests of the host to the card's thread, and the wires that wake it.
//!
//! Duties: carries reset, save, restore and power-off to the card's thread, which serves them
//! between two packets; interrupts a packet in work for reset and power-off.
//! Inputs: the RESET register, [`crate::Card`]. Outputs: [`Request`]s, one wake-up wire, a stop wire.
//! Clocks: none; device time stands still.

use crate::error::CardError;
use crate::hidden::systolic::Waves;
use crate::probe::snapshot::State;
use crate::subpixel::map::SubpixelMap;
use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::SeqCst};
use std::sync::{Arc, OnceLock};
use std::thread::Thread;

/// What the host asks of the card's thread.
#[derive(Debug)]
pub(crate) enum Request {
    /// Soft reset; answer when done.
    Reset(Sender<()>),
    /// Save everything.
    Save(Sender<Result<State, CardError>>),
    /// Restore everything.
    Restore(Arc<State>, Sender<Result<(), CardError>>),
    /// Record the next scene of the clocked systolic array.
    Record(Waves, Sender<()>),
    /// Give the waveform that was recorded away.
    TakeRecorded(Sender<Option<Vec<u8>>>),
    /// Note which pixels the sub-pixel unit takes up in the next scene with a grid.
    RecordSubpixels(Sender<()>),
    /// Give what was noted of them away.
    TakeSubpixels(Sender<Option<SubpixelMap>>),
    /// End the thread.
    PowerOff,
}

/// The host's end.
#[derive(Debug)]
pub(crate) struct Control {
    requests: Sender<Request>,
    bell: Sender<()>,
    /// Resets and power-offs on their way; while not 0 the card stops at its next stop point.
    stops: AtomicU32,
    power_lost: AtomicBool,
    thread: OnceLock<Thread>,
}

/// The card's end.
#[derive(Debug)]
pub(crate) struct ControlPort {
    /// Requests, in order.
    pub(crate) requests: Receiver<Request>,
    /// There is something to do somewhere: words, a doorbell, a request.
    pub(crate) bell: Receiver<()>,
}

/// Both ends.
pub(crate) fn control() -> (Control, ControlPort) {
    let (requests, requests_port) = unbounded();
    let (bell, bell_port) = bounded(1);
    let control = Control {
        requests,
        bell,
        stops: AtomicU32::new(0),
        power_lost: AtomicBool::new(false),
        thread: OnceLock::new(),
    };
    (control, ControlPort { requests: requests_port, bell: bell_port })
}

impl Control {
    /// Names the card's thread, once.
    pub(crate) fn set_thread(&self, thread: Thread) {
        // It is set before the card is handed out; a second call would name the same thread.
        let _ = self.thread.set(thread);
    }

    /// Makes the card's thread look for work; a bell that still rings is enough.
    pub(crate) fn wake(&self) {
        let _ = self.bell.try_send(());
    }

    /// Resets the card; returns when it is done or the card has no power.
    pub(crate) fn reset(&self) {
        self.stops.fetch_add(1, SeqCst);
        self.ask(Request::Reset);
    }

    /// Saves the card's state.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`].
    pub(crate) fn save(&self) -> Result<State, CardError> {
        self.ask(Request::Save).unwrap_or(Err(CardError::PoweredOff))
    }

    /// Restores the card's state.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`], or what the card finds wrong with the state.
    pub(crate) fn restore(&self, state: Arc<State>) -> Result<(), CardError> {
        self.ask(|answer| Request::Restore(state, answer)).unwrap_or(Err(CardError::PoweredOff))
    }

    /// Has the next scene of the clocked systolic array recorded.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`].
    pub(crate) fn record(&self, waves: Waves) -> Result<(), CardError> {
        self.ask(|answer| Request::Record(waves, answer)).ok_or(CardError::PoweredOff)
    }

    /// The waveform that was recorded last, if there is one.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`].
    pub(crate) fn take_recorded(&self) -> Result<Option<Vec<u8>>, CardError> {
        self.ask(Request::TakeRecorded).ok_or(CardError::PoweredOff)
    }

    /// Has the pixels noted that the sub-pixel unit takes up in the next scene with a grid.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`].
    pub(crate) fn record_subpixels(&self) -> Result<(), CardError> {
        self.ask(Request::RecordSubpixels).ok_or(CardError::PoweredOff)
    }

    /// The map that was noted last, if there is one.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`].
    pub(crate) fn take_subpixels(&self) -> Result<Option<SubpixelMap>, CardError> {
        self.ask(Request::TakeSubpixels).ok_or(CardError::PoweredOff)
    }

    /// Tells the card's thread to end.
    pub(crate) fn power_off(&self) {
        self.stops.fetch_add(1, SeqCst);
        let _ = self.requests.send(Request::PowerOff);
        self.interrupt();
    }

    /// Sends a request and waits for its answer; `None` when the card has no power.
    fn ask<A>(&self, request: impl FnOnce(Sender<A>) -> Request) -> Option<A> {
        let (answer, answered) = bounded(1);
        self.requests.send(request(answer)).ok()?;
        self.interrupt();
        // The sender travels with the request: it is dropped, answered or not, with the request.
        answered.recv().ok()
    }

    /// Wakes the card's thread, also from the wait for a vertical blank.
    fn interrupt(&self) {
        self.wake();
        if let Some(thread) = self.thread.get() {
            thread.unpark();
        }
    }

    /// Has the packet in work to stop?
    pub(crate) fn stopping(&self) -> bool {
        self.stops.load(SeqCst) != 0
    }

    /// A reset was served.
    pub(crate) fn reset_done(&self) {
        self.stops.fetch_sub(1, SeqCst);
    }

    /// Set when the card has lost power.
    pub(crate) fn power_lost(&self) -> &AtomicBool {
        &self.power_lost
    }
}
