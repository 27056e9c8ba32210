//! Seat: one viewer, as the server sees it.
//!
//! Duties: takes its requests, writes answers as its socket takes them, judges whether it is still alive.
//! Inputs from: the viewer's socket, the newest frame. Outputs to: the viewer's socket.

use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use rustix::io::Errno;
use rustix::net::{SendFlags, send};
use zga_device::Frame;

use super::incoming::{Incoming, Step};
use super::message::{FRAME_WORDS, Kind, MAGIC, VERSION, message, text_words};

/// How long a viewer may take nothing of an answer, or not say who it is, before it is dropped.
pub const STALL_LIMIT: Duration = Duration::from_secs(10);

/// Shortest time between two answers about counters: reading them is the card's bus.
const STATUS_PERIOD: Duration = Duration::from_millis(5);

/// Bytes that are written to one viewer before the others have their turn.
const TURN_BYTES: usize = 4 << 20;

/// An answer on its way out.
#[derive(Debug)]
struct Outgoing {
    /// Header and what comes before the pixels.
    head: Vec<u32>,
    frame: Option<Frame>,
    /// Bytes that the socket has taken.
    sent: usize,
}

impl Outgoing {
    /// The next bytes to send; none when all are sent.
    fn rest(&self) -> &[u8] {
        let head: &[u8] = bytemuck::cast_slice(&self.head);
        let pixels: &[u8] = self.frame.as_ref().map_or(&[], |frame| bytemuck::cast_slice(frame.pixels()));
        match self.sent.checked_sub(head.len()) {
            None => &head[self.sent..],
            Some(sent) => &pixels[sent.min(pixels.len())..],
        }
    }
}

/// One viewer.
#[derive(Debug)]
pub(super) struct Seat {
    pub socket: UnixStream,
    incoming: Incoming,
    outgoing: Option<Outgoing>,
    /// It has said hello.
    greeted: bool,
    wants_frame: bool,
    wants_status: bool,
    /// It has asked for a frame before: the screen is watched as long as it stays.
    watches: bool,
    /// No status before this moment.
    status_from: Instant,
    /// Last sign of life that was due.
    alive: Instant,
    /// The frame that it was sent last.
    shown: Option<Frame>,
    /// Number of the newest frame that was compared with that one.
    compared: u64,
    /// Hang up once what is on its way has been sent.
    leaving: bool,
    gone: bool,
}

impl Seat {
    /// A viewer that has just come; `hello` is what it is told first.
    pub(super) fn new(socket: UnixStream, hello: Vec<u32>) -> Seat {
        let now = Instant::now();
        Seat {
            socket,
            incoming: Incoming::default(),
            outgoing: Some(Outgoing { head: hello, frame: None, sent: 0 }),
            greeted: false,
            wants_frame: false,
            wants_status: false,
            watches: false,
            status_from: now,
            alive: now,
            shown: None,
            compared: 0,
            leaving: false,
            gone: false,
        }
    }

    /// It has hung up, or was dropped.
    pub(super) fn is_gone(&self) -> bool {
        self.gone
    }

    /// Something is on its way out to it.
    pub(super) fn is_writing(&self) -> bool {
        self.outgoing.is_some()
    }

    /// It waits for a frame.
    pub(super) fn awaits_frame(&self) -> bool {
        self.wants_frame && self.outgoing.is_none()
    }

    /// It has ever asked for a frame.
    pub(super) fn watches(&self) -> bool {
        self.watches
    }

    /// It waits for a status, and since when it may have one.
    pub(super) fn awaits_status(&self) -> Option<Instant> {
        (self.wants_status && self.outgoing.is_none()).then_some(self.status_from)
    }

    /// When it is dropped if nothing happens; `None` if nothing has to.
    pub(super) fn deadline(&self) -> Option<Instant> {
        (self.is_writing() || !self.greeted || self.incoming.is_amid()).then(|| self.alive + STALL_LIMIT)
    }

    /// Drops it if it has been silent for too long.
    pub(super) fn judge(&mut self, now: Instant) {
        self.gone |= self.deadline().is_some_and(|deadline| now >= deadline);
    }

    /// Takes a request, if one has come and nothing is on its way out.
    pub(super) fn read(&mut self) {
        if self.is_writing() || self.gone {
            return;
        }
        let amid = self.incoming.is_amid();
        let step = self.incoming.step(&mut &self.socket, Kind::most_of_viewer);
        // The clock of a request starts with its first byte: one byte in a while keeps nobody alive.
        if !amid && self.greeted {
            self.alive = Instant::now();
        }
        match step {
            Step::Wait => {}
            Step::HungUp => self.gone = true,
            Step::Damaged(reason) => self.refuse(&reason),
            Step::Whole(request) => match (request.kind, self.greeted) {
                (Kind::Hello, false) => self.greet(&request.payload),
                (Kind::NextFrame, true) if !self.wants_frame => {
                    (self.wants_frame, self.watches) = (true, true);
                }
                (Kind::Status, true) if !self.wants_status => self.wants_status = true,
                (kind, false) => self.refuse(&format!("{kind:?} before a hello")),
                (kind, true) => self.refuse(&format!("{kind:?} again before the answer")),
            },
        }
    }

    fn greet(&mut self, payload: &[u32]) {
        match *payload {
            [first, second, VERSION] if [first, second] == MAGIC => self.greeted = true,
            [first, second, version] if [first, second] == MAGIC => {
                self.refuse(&format!("version {version} of the link, expected {VERSION}"));
            }
            _ => self.refuse("no magic number in the hello"),
        }
    }

    /// Tells it why, and hangs up.
    pub(super) fn refuse(&mut self, reason: &str) {
        self.leaving = true;
        self.answer(message(Kind::Refused, &text_words(reason)), None);
    }

    /// Sends a status.
    pub(super) fn give_status(&mut self, words: &[u32], now: Instant) {
        self.wants_status = false;
        self.status_from = now + STATUS_PERIOD;
        self.answer(message(Kind::Status, words), None);
    }

    /// Sends the newest frame if it shows something else than the one before.
    pub(super) fn offer(&mut self, frame: &Frame) {
        if !self.awaits_frame() || frame.number() <= self.compared {
            return;
        }
        self.compared = frame.number();
        if self.shown.as_ref().is_some_and(|shown| same_picture(shown, frame)) {
            return;
        }
        self.wants_frame = false;
        self.shown = Some(frame.clone());
        let number = frame.number();
        let words = FRAME_WORDS + frame.pixels().len();
        let head = [frame.width(), frame.height(), number as u32, (number >> 32) as u32];
        self.answer([&[Kind::Frame as u32, words as u32], &head[..]].concat(), Some(frame.clone()));
    }

    /// Puts an answer on its way. What was on its way before is sent first if it has begun.
    fn answer(&mut self, head: Vec<u32>, frame: Option<Frame>) {
        match &mut self.outgoing {
            // Only a refusal can come while something is being sent, and only short heads are sent then.
            Some(outgoing) if outgoing.frame.is_none() => outgoing.head.extend(head),
            _ => self.outgoing = Some(Outgoing { head, frame, sent: 0 }),
        }
        self.alive = Instant::now();
        self.write();
    }

    /// Writes what the socket takes.
    pub(super) fn write(&mut self) {
        let mut turn = 0;
        while let (Some(outgoing), true) = (&mut self.outgoing, turn < TURN_BYTES && !self.gone) {
            let rest = outgoing.rest();
            if rest.is_empty() {
                self.outgoing = None;
                self.gone |= self.leaving;
                return;
            }
            // No signal: the process may have other plans for it than to ignore it.
            match send(&self.socket, rest, SendFlags::NOSIGNAL | SendFlags::DONTWAIT) {
                Ok(count) => {
                    outgoing.sent += count;
                    turn += count;
                    if count > 0 {
                        self.alive = Instant::now();
                    }
                }
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN) => return,
                Err(_) => self.gone = true,
            }
        }
    }
}

/// Do two frames show the same?
fn same_picture(one: &Frame, other: &Frame) -> bool {
    let alike = [one.width(), one.height()] == [other.width(), other.height()];
    alike && (one.shares_pixels(other) || one.pixels() == other.pixels())
}
