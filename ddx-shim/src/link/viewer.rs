//! Viewer: the link's end in the program that looks.
//!
//! Inputs from: the server's socket. Outputs to: whoever shows frames or prints counters.
//! The server is believed no more than a viewer is: every length and size is checked.

use std::io::{ErrorKind, Read};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rustix::io::Errno;
use rustix::net::{AddressFamily, SendFlags, SocketAddrUnix, SocketFlags, SocketType, connect, send, socket_with};
use zga_abi::{Effects, IDENTIFICATION};
use zga_driver::CardInfo;

use super::LinkError;
use super::incoming::{Incoming, Message, Step};
use super::message::{FRAME_WORDS, Kind, MAGIC, MOST_SIDE, SERVER_HELLO_WORDS, VERSION, message, take_text};
use super::status::Status;

/// Longest path of a socket: `sun_path` with its zero.
const MOST_PATH_BYTES: usize = 107;

/// Pause before a connection is tried again at a server whose queue is full.
const QUEUE_PAUSE: Duration = Duration::from_millis(5);

/// A frame as it came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The vertical blank at which it went out.
    pub number: u64,
    /// XRGB8888 pixels, dense rows from the top.
    pub pixels: Vec<u32>,
}

/// Looks at a card in another process.
#[derive(Debug)]
pub struct Viewer {
    path: PathBuf,
    socket: UnixStream,
    incoming: Incoming,
    card: CardInfo,
    process: u32,
    /// A frame was asked for and has not come.
    asked_frame: bool,
    asked_status: bool,
    /// A frame that came while a status was waited for.
    waiting: Option<Picture>,
}

/// Refuses a path that does not fit.
pub(super) fn check_length(path: &Path) -> Result<(), LinkError> {
    let bytes = path.as_os_str().as_bytes().len();
    if bytes > MOST_PATH_BYTES {
        return Err(LinkError::PathTooLong { path: path.to_path_buf(), bytes, most: MOST_PATH_BYTES });
    }
    Ok(())
}

/// Connects, and says nothing yet.
pub(super) fn open(path: &Path, timeout: Duration) -> Result<UnixStream, LinkError> {
    check_length(path)?;
    let fault = |reason: Errno| LinkError::System {
        path: path.to_path_buf(),
        doing: "cannot be connected to",
        reason: reason.into(),
    };
    let deadline = Instant::now() + timeout;
    let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
    let address = SocketAddrUnix::new(path).map_err(fault)?;
    loop {
        let socket = socket_with(AddressFamily::UNIX, SocketType::STREAM, flags, None).map_err(fault)?;
        match connect(&socket, &address) {
            Ok(()) => return Ok(socket.into()),
            // A server that is alive and does not come to accept: its queue is full.
            Err(Errno::AGAIN) if Instant::now() < deadline => std::thread::sleep(QUEUE_PAUSE),
            Err(Errno::AGAIN) => return Err(LinkError::Timeout { path: path.to_path_buf(), waited: timeout }),
            Err(Errno::INTR) => {}
            Err(Errno::NOENT | Errno::NOTDIR) => return Err(LinkError::Missing { path: path.to_path_buf() }),
            Err(Errno::CONNREFUSED) if is_socket(path) => return Err(LinkError::Dead { path: path.to_path_buf() }),
            Err(Errno::CONNREFUSED) => return Err(LinkError::NotASocket { path: path.to_path_buf() }),
            Err(reason) => return Err(fault(reason)),
        }
    }
}

fn is_socket(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    path.metadata().is_ok_and(|data| data.file_type().is_socket())
}

impl Viewer {
    /// Attaches to the card whose server listens at `path`; waits at most `timeout` for its answer.
    ///
    /// # Errors
    /// [`LinkError`]: nothing there, nobody alive, not a link, another version, too many viewers, no answer.
    pub fn connect(path: &Path, timeout: Duration) -> Result<Viewer, LinkError> {
        let deadline = Instant::now() + timeout;
        let socket = open(path, timeout)?;
        let [first, second] = MAGIC;
        let card = CardInfo {
            major: 0,
            minor: 0,
            effects: Effects::empty(),
            paths: 0,
            video_memory: 0,
            za_ram: 0,
            fifo_words: 0,
        };
        let mut viewer = Viewer {
            path: path.to_path_buf(),
            socket,
            incoming: Incoming::default(),
            card,
            process: 0,
            asked_frame: false,
            asked_status: false,
            waiting: None,
        };
        viewer.send(Kind::Hello, &[first, second, VERSION], deadline)?;
        let not_a_link = |reason: String| LinkError::NotALink { path: path.to_path_buf(), reason };
        let hello = match viewer.receive(deadline) {
            Ok(Some(message)) => message,
            Ok(None) => return Err(LinkError::Timeout { path: path.to_path_buf(), waited: timeout }),
            Err(LinkError::Damaged { reason, .. }) => return Err(not_a_link(reason)),
            Err(LinkError::HungUp { .. }) => return Err(not_a_link("it hung up at once".to_owned())),
            Err(other) => return Err(other),
        };
        if hello.kind != Kind::Hello || hello.payload.get(..2) != Some(&MAGIC[..]) {
            return Err(not_a_link("no magic number in its hello".to_owned()));
        }
        match hello.payload.get(2) {
            Some(&VERSION) => {}
            found => {
                let found = found.copied().unwrap_or(0);
                return Err(LinkError::Version { path: path.to_path_buf(), found, expected: VERSION });
            }
        }
        let Ok([_, _, _, process, identification, revision, effects, paths, video_memory, za_ram, fifo_words]) =
            <[u32; SERVER_HELLO_WORDS]>::try_from(hello.payload)
        else {
            return Err(not_a_link(format!("its hello has not {SERVER_HELLO_WORDS} words")));
        };
        if identification != IDENTIFICATION {
            return Err(not_a_link(format!("identification {identification:#010x}, expected {IDENTIFICATION:#010x}")));
        }
        let effects = Effects::from_bits_truncate(effects);
        let (major, minor) = (revision >> 16, revision & 0xFFFF);
        viewer.card = CardInfo { major, minor, effects, paths, video_memory, za_ram, fifo_words };
        viewer.process = process;
        Ok(viewer)
    }

    /// What the card is.
    #[must_use]
    pub fn card(&self) -> &CardInfo {
        &self.card
    }

    /// The process that it is in.
    #[must_use]
    pub fn process(&self) -> u32 {
        self.process
    }

    /// The newest frame that shows something else than the one before, waiting at most `timeout` for it. The first one
    /// comes at the next vertical blank. `None` while nothing changes.
    ///
    /// # Errors
    /// [`LinkError::HungUp`] when the server has ended, [`LinkError::Damaged`] for what makes no sense.
    pub fn next_frame(&mut self, timeout: Duration) -> Result<Option<Picture>, LinkError> {
        if let Some(picture) = self.waiting.take() {
            return Ok(Some(picture));
        }
        let deadline = Instant::now() + timeout;
        if !self.asked_frame {
            self.send(Kind::NextFrame, &[], deadline)?;
            self.asked_frame = true;
        }
        let Some(message) = self.receive(deadline)? else {
            return Ok(None);
        };
        match message.kind {
            Kind::Frame => self.picture(message.payload).map(Some),
            kind => Err(self.damaged(format!("{kind:?}, expected a frame"))),
        }
    }

    /// Counters, effects and units as they stand.
    ///
    /// # Errors
    /// [`LinkError::Timeout`], [`LinkError::HungUp`], [`LinkError::Damaged`].
    pub fn status(&mut self, timeout: Duration) -> Result<Status, LinkError> {
        let deadline = Instant::now() + timeout;
        // What was asked for in vain before will still come, and is as good.
        if !self.asked_status {
            self.send(Kind::Status, &[], deadline)?;
            self.asked_status = true;
        }
        loop {
            let Some(message) = self.receive(deadline)? else {
                return Err(LinkError::Timeout { path: self.path.clone(), waited: timeout });
            };
            match message.kind {
                Kind::Status => {
                    self.asked_status = false;
                    return Status::from_words(&message.payload).map_err(|reason| self.damaged(reason));
                }
                Kind::Frame => self.waiting = Some(self.picture(message.payload)?),
                kind => return Err(self.damaged(format!("{kind:?}, expected a status"))),
            }
        }
    }

    fn damaged(&self, reason: String) -> LinkError {
        LinkError::Damaged { path: self.path.clone(), reason }
    }

    /// Makes a picture of a frame's words.
    fn picture(&mut self, mut words: Vec<u32>) -> Result<Picture, LinkError> {
        self.asked_frame = false;
        let [width, height, low, high, pixels @ ..] = &words[..] else {
            return Err(self.damaged(format!("a frame of {} words, expected at least {FRAME_WORDS}", words.len())));
        };
        let (width, height, number) = (*width, *height, u64::from(*low) | u64::from(*high) << 32);
        if !(1..=MOST_SIDE).contains(&width) || !(1..=MOST_SIDE).contains(&height) {
            return Err(self.damaged(format!("a frame of {width} x {height}, expected 1 to {MOST_SIDE} on a side")));
        }
        let expected = width as usize * height as usize;
        if pixels.len() != expected {
            let found = pixels.len();
            return Err(self.damaged(format!("{found} pixels of a frame of {width} x {height}, expected {expected}")));
        }
        words.drain(..FRAME_WORDS);
        Ok(Picture { width, height, number, pixels: words })
    }

    /// Sends a request, which is short.
    fn send(&mut self, kind: Kind, payload: &[u32], deadline: Instant) -> Result<(), LinkError> {
        let words = message(kind, payload);
        let mut rest: &[u8] = bytemuck::cast_slice(&words);
        while !rest.is_empty() {
            match send(&self.socket, rest, SendFlags::NOSIGNAL) {
                Ok(count) => rest = &rest[count..],
                Err(Errno::INTR) => {}
                // The socket holds hundreds of requests, and two are the most that are ever under way.
                Err(Errno::AGAIN) if Instant::now() < deadline => std::thread::sleep(QUEUE_PAUSE),
                Err(Errno::AGAIN) => {
                    return Err(LinkError::Timeout { path: self.path.clone(), waited: Duration::ZERO });
                }
                // Why it hung up is perhaps still to be read.
                Err(_) => return Ok(()),
            }
        }
        Ok(())
    }

    /// The next message, or `None` at the deadline.
    fn receive(&mut self, deadline: Instant) -> Result<Option<Message>, LinkError> {
        let system =
            |path: &Path, reason| LinkError::System { path: path.to_path_buf(), doing: "cannot be read", reason };
        self.socket.set_nonblocking(false).map_err(|reason| system(&self.path, reason))?;
        loop {
            // A time of zero would be none at all.
            let left = deadline.saturating_duration_since(Instant::now()).max(Duration::from_millis(1));
            self.socket.set_read_timeout(Some(left)).map_err(|reason| system(&self.path, reason))?;
            match self.incoming.step(&mut Until { socket: &self.socket, deadline, looked: false }, Kind::most_of_server)
            {
                Step::Whole(Message { kind: Kind::Refused, payload }) => {
                    let reason = take_text(&mut &payload[..]).unwrap_or_else(|| "without a reason".to_owned());
                    return Err(LinkError::Refused { path: self.path.clone(), reason });
                }
                Step::Whole(message) => return Ok(Some(message)),
                Step::Wait if Instant::now() >= deadline => return Ok(None),
                Step::Wait => {}
                Step::HungUp => return Err(LinkError::HungUp { path: self.path.clone() }),
                Step::Damaged(reason) => return Err(self.damaged(reason)),
            }
        }
    }
}

/// A socket that gives nothing more after a moment: one that drips could keep its reader for ever.
struct Until<'a> {
    socket: &'a UnixStream,
    deadline: Instant,
    /// One look is always taken.
    looked: bool,
}

impl Read for Until<'_> {
    fn read(&mut self, room: &mut [u8]) -> std::io::Result<usize> {
        if self.looked && Instant::now() >= self.deadline {
            return Err(ErrorKind::WouldBlock.into());
        }
        self.looked = true;
        self.socket.read(room)
    }
}
