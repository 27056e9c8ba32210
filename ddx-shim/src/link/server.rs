//! Server: the link's end at the card.
//!
//! Duties: binds the socket, seats viewers, plugs a monitor in while somebody watches, hands the newest frame to those
//! who wait for one. Inputs from: the card's connector and bus, seat. Outputs to: seat.
//! One thread; it sleeps while there is nothing to do.

use std::fs::{File, Permissions};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use zga_abi::bus::FLOATING;
use zga_abi::{Bus, Reg};
use zga_device::{CardBus, Connector, Frame, Monitor};

use super::message::{IDENTITY_WORDS, Kind, MAGIC, VERSION, message};
use super::seat::Seat;
use super::status::Status;
use super::{LinkError, viewer};

/// Most viewers at a time; one more is refused.
pub const MOST_VIEWERS: usize = 16;

/// Longest wait for a frame before sockets are looked at again.
const FRAME_WAIT: Duration = Duration::from_millis(4);

/// Pause after the system could not give a socket.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// How long the start waits for another start in the same folder.
const LOCK_WAIT: Duration = Duration::from_secs(2);

/// Shows a card to viewers. Dropping it ends its thread and removes its socket.
#[derive(Debug)]
pub struct Server {
    path: PathBuf,
    /// Device and node of the socket: what is removed is this one and no other.
    node: (u64, u64),
    /// Hanging up here ends the thread.
    stop: Option<UnixStream>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Serves the card at the socket `path`, from a thread of its own. The socket of a server that has died is taken over;
    /// only the user can attach. The thread has the caller's signal mask.
    ///
    /// # Errors
    /// [`LinkError::InUse`] where another server answers, [`LinkError::NotASocket`] where another file is,
    /// [`LinkError::PathTooLong`], and [`LinkError::System`] for what the system refuses.
    pub fn start(path: &Path, connector: Connector, bus: CardBus) -> Result<Server, LinkError> {
        let fault = |doing| move |reason| LinkError::System { path: path.to_path_buf(), doing, reason };
        let listener = bind(path)?;
        listener.set_nonblocking(true).map_err(fault("cannot be set up"))?;
        let data = path.symlink_metadata().map_err(fault("cannot be looked at"))?;
        let (stop, stopped) = UnixStream::pair().map_err(fault("cannot be set up"))?;
        let mut server = Server {
            path: std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf()),
            node: (data.dev(), data.ino()),
            stop: Some(stop),
            thread: None,
        };
        let desk = Desk {
            listener,
            stopped,
            connector,
            bus,
            monitor: None,
            newest: None,
            seats: Vec::new(),
            accept_from: None,
        };
        let thread = std::thread::Builder::new().name("zga-link".to_owned()).spawn(move || desk.run());
        server.thread = Some(thread.map_err(fault("has no thread"))?);
        Ok(server)
    }

    /// The socket.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let ours = self.path.symlink_metadata().is_ok_and(|data| (data.dev(), data.ino()) == self.node);
        if ours {
            // It is of no use to anybody; if it cannot be removed, the next server will.
            let _ = std::fs::remove_file(&self.path);
        }
        self.stop = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Binds a socket for this user alone; takes over what a dead server left.
fn bind(path: &Path) -> Result<UnixListener, LinkError> {
    viewer::check_length(path)?;
    let fault = |doing| move |reason| LinkError::System { path: path.to_path_buf(), doing, reason };
    // Two servers that find the same dead socket must not remove each other's: the folder is locked meanwhile.
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = File::open(folder).map_err(fault("its folder cannot be opened"))?;
    let deadline = Instant::now() + LOCK_WAIT;
    while folder.try_lock().is_err() {
        if Instant::now() >= deadline {
            let reason = std::io::Error::other("another process has locked it");
            return Err(fault("its folder cannot be locked")(reason));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    if let Ok(data) = path.symlink_metadata() {
        if !data.file_type().is_socket() {
            return Err(LinkError::NotASocket { path: path.to_path_buf() });
        }
        if viewer::open(path, LOCK_WAIT).is_ok() {
            return Err(LinkError::InUse { path: path.to_path_buf() });
        }
        std::fs::remove_file(path).map_err(fault("a dead server's socket cannot be removed"))?;
    }
    let listener = UnixListener::bind(path).map_err(fault("cannot be bound"))?;
    std::fs::set_permissions(path, Permissions::from_mode(0o600)).map_err(fault("cannot be closed to others"))?;
    Ok(listener)
}

/// What the thread works with.
struct Desk {
    listener: UnixListener,
    stopped: UnixStream,
    connector: Connector,
    bus: CardBus,
    /// Plugged in while somebody watches.
    monitor: Option<Monitor>,
    newest: Option<Frame>,
    seats: Vec<Seat>,
    /// No viewer is let in before this moment.
    accept_from: Option<Instant>,
}

impl Desk {
    fn run(mut self) {
        loop {
            self.take_frame();
            if self.wait() {
                return;
            }
            self.serve();
        }
    }

    /// Takes the newest frame of the monitor. Waits a little for it where somebody wants one and nothing else is to do.
    fn take_frame(&mut self) {
        if !self.seats.iter().any(Seat::watches) {
            (self.monitor, self.newest) = (None, None);
            return;
        }
        let busy = self.seats.iter().any(Seat::is_writing) || !self.seats.iter().any(Seat::awaits_frame);
        let monitor = self.monitor.get_or_insert_with(|| self.connector.plug());
        let wait = if busy { Duration::ZERO } else { FRAME_WAIT };
        let began = Instant::now();
        match monitor.wait_next(wait) {
            Some(frame) => self.newest = Some(frame),
            // A card without power has nothing to wait for and says so at once.
            None => std::thread::sleep(wait.saturating_sub(began.elapsed())),
        }
    }

    /// Waits for sockets; true if the server is to end.
    fn wait(&mut self) -> bool {
        let now = Instant::now();
        let timeout = self.timeout(now);
        let accepts = self.accept_from.is_none_or(|from| now >= from);
        let mut watched = Vec::with_capacity(2 + self.seats.len());
        watched.push(PollFd::new(&self.stopped, PollFlags::IN));
        watched.extend(self.seats.iter().map(|seat| {
            let flags = if seat.is_writing() { PollFlags::OUT } else { PollFlags::IN };
            PollFd::new(&seat.socket, flags)
        }));
        if accepts {
            watched.push(PollFd::new(&self.listener, PollFlags::IN));
        }
        let timeout = timeout.and_then(|timeout| Timespec::try_from(timeout).ok());
        // An interrupted wait is one that found nothing; any other failure must not become a loop without a pause.
        if poll(&mut watched, timeout.as_ref()).is_err_and(|reason| reason != rustix::io::Errno::INTR) {
            std::thread::sleep(FRAME_WAIT);
        }
        !watched[0].revents().is_empty()
    }

    /// How long sockets may be waited for; `None` for as long as it takes.
    fn timeout(&self, now: Instant) -> Option<Duration> {
        // The monitor has had its wait if nobody is being written to.
        let frame = if self.seats.iter().any(Seat::is_writing) { now + FRAME_WAIT } else { now };
        let seats = self.seats.iter().flat_map(|seat| {
            [seat.deadline(), seat.awaits_status(), seat.awaits_frame().then_some(frame)].into_iter().flatten()
        });
        let until = seats.chain(self.accept_from.filter(|from| *from > now)).min();
        until.map(|moment| moment.saturating_duration_since(now))
    }

    /// Does what there is to do for each.
    fn serve(&mut self) {
        let now = Instant::now();
        self.accept(now);
        for seat in &mut self.seats {
            seat.write();
            seat.read();
            if seat.awaits_status().is_some_and(|from| now >= from) {
                seat.give_status(&Status::read(&mut self.bus).words(), now);
            }
            if let Some(frame) = &self.newest {
                seat.offer(frame);
            }
            seat.judge(now);
        }
        self.seats.retain(|seat| !seat.is_gone());
    }

    /// Lets one viewer in.
    fn accept(&mut self, now: Instant) {
        if self.accept_from.is_some_and(|from| now < from) {
            return;
        }
        self.accept_from = None;
        match self.listener.accept() {
            Ok((socket, _)) => {
                if socket.set_nonblocking(true).is_err() {
                    return;
                }
                if self.seats.len() >= MOST_VIEWERS {
                    // One that does not take even this gets nothing: there is no seat for it.
                    Seat::new(socket, Vec::new()).refuse(&format!("{MOST_VIEWERS} viewers are attached already"));
                    return;
                }
                let seat = Seat::new(socket, self.hello());
                self.seats.push(seat);
            }
            Err(reason) if reason.kind() == std::io::ErrorKind::WouldBlock => {}
            // Out of descriptors: the listener would be ready again at once.
            Err(_) => self.accept_from = Some(now + ACCEPT_PAUSE),
        }
    }

    /// What a viewer is told first: who answers, and which card that is.
    fn hello(&mut self) -> Vec<u32> {
        let mut identity = [FLOATING; IDENTITY_WORDS];
        self.bus.read_burst(Reg::Identification.offset(), &mut identity);
        let [first, second] = MAGIC;
        message(Kind::Hello, &[&[first, second, VERSION, std::process::id()], &identity[..]].concat())
    }
}
