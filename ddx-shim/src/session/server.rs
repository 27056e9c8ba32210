//! Server: the X server's process, its folder, its log.

use std::ffi::OsString;
use std::fs::{DirBuilder, File};
use std::io::Read;
use std::os::unix::fs::DirBuilderExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, Signal, kill_process};

use super::config::{Driver, Options};
use super::{Client, SessionError, find};

/// How long a server may take until it can be used.
const START_WAIT: Duration = Duration::from_secs(30);
/// How long it may take to end when it is asked to.
const END_WAIT: Duration = Duration::from_secs(5);
/// Lines of the log that an error shows.
const LOG_LINES: usize = 20;
/// Longest piece of the log that is looked through for them.
const LOG_BYTES: u64 = 64 << 10;

/// A running X server. Dropping it ends it and removes its folder.
#[derive(Debug)]
pub struct Session {
    child: Child,
    display: String,
    folder: Folder,
    options: Options,
}

/// A folder that goes with its owner.
#[derive(Debug)]
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Folder, SessionError> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let (process, temporary) = (std::process::id(), std::env::temp_dir());
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let path = temporary.join(format!("zga-x-{process}-{number}"));
            match DirBuilder::new().mode(0o700).create(&path) {
                Ok(()) => return Ok(Folder(path)),
                // Left by a process of the same number that was killed.
                Err(reason) if reason.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(reason) => return Err(SessionError::System { path, doing: "cannot be made", reason }),
            }
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // It is temporary; whoever cleans the place of temporary files will have it.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl Session {
    /// Starts a server and waits until clients can come.
    ///
    /// # Errors
    /// [`SessionError`]: no server, a module that is not there, a server that does not start, with the end of its log.
    pub fn start(options: &Options) -> Result<Session, SessionError> {
        let program = find::server()?;
        let folder = Folder::new()?;
        let [modules, config, log, authority] =
            ["modules", "zga.conf", "server.log", "authority"].map(|name| folder.0.join(name));
        let fault = |path: &Path, doing| {
            let path = path.to_path_buf();
            move |reason| SessionError::System { path, doing, reason }
        };
        std::fs::create_dir(&modules).map_err(fault(&modules, "cannot be made"))?;
        if let Driver::Zga { module, .. } = &options.driver {
            if !module.is_file() {
                return Err(SessionError::NoModule { tried: vec![module.clone()] });
            }
            // The server looks for the driver by this name, wherever the file is.
            let link = modules.join(find::MODULE);
            std::os::unix::fs::symlink(module, &link).map_err(fault(&link, "cannot be made"))?;
        }
        std::fs::write(&config, options.text(&modules)).map_err(fault(&config, "cannot be written"))?;
        std::fs::write(&authority, cookie()?).map_err(fault(&authority, "cannot be written"))?;
        let told = File::create(folder.0.join("server.out")).map_err(fault(&folder.0, "cannot be written to"))?;

        let mut child = Command::new(program)
            .args(["-noreset", "-nolisten", "tcp", "-displayfd", "1"])
            .arg("-config")
            .arg(&config)
            .arg("-logfile")
            .arg(&log)
            .arg("-auth")
            .arg(&authority)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(told)
            .process_group(0)
            .spawn()
            .map_err(fault(program, "cannot be started"))?;
        let number = child.stdout.take();
        let mut session = Session { child, display: String::new(), folder, options: options.clone() };
        let deadline = Instant::now() + START_WAIT;
        match number.and_then(|pipe| display_number(pipe, deadline)) {
            Some(number) => session.display = format!(":{number}"),
            // It is gone or going; a moment more tells how.
            None => match session.wait(Duration::from_secs(1)) {
                Some(status) => {
                    let (status, log) = (status.to_string(), session.log_tail());
                    return Err(SessionError::DidNotStart { status, log });
                }
                None => return Err(SessionError::NotReady { waited: START_WAIT, log: session.log_tail() }),
            },
        }
        Ok(session)
    }

    /// The display, as DISPLAY has it.
    #[must_use]
    pub fn display(&self) -> &str {
        &self.display
    }

    /// The file with the display's secret, as XAUTHORITY has it.
    #[must_use]
    pub fn authority(&self) -> PathBuf {
        self.folder.0.join("authority")
    }

    /// The secret itself.
    ///
    /// # Errors
    /// [`SessionError::System`].
    pub fn cookie(&self) -> Result<Vec<u8>, SessionError> {
        let path = self.authority();
        let bytes =
            std::fs::read(&path).map_err(|reason| SessionError::System { path, doing: "cannot be read", reason })?;
        Ok(bytes[bytes.len().saturating_sub(COOKIE_BYTES)..].to_vec())
    }

    /// What was asked for.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The server's process.
    #[must_use]
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// Starts a client; what it writes goes to this program's outputs, or with `quiet` into the session's folder.
    ///
    /// # Errors
    /// [`SessionError::Client`].
    pub fn client(&self, arguments: &[OsString], quiet: bool) -> Result<Client, SessionError> {
        let log = self.folder.0.join("clients.log");
        Client::start(arguments, &self.display, &self.authority(), quiet.then_some(log.as_path()))
    }

    /// How the server ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// An error if the server has ended.
    ///
    /// # Errors
    /// [`SessionError::Ended`] with the end of the log.
    pub fn check(&mut self) -> Result<(), SessionError> {
        match self.ended() {
            None => Ok(()),
            Some(status) => Err(SessionError::Ended { status: status.to_string(), log: self.log_tail() }),
        }
    }

    /// Resident memory of the server in bytes; `None` if the system does not tell.
    #[must_use]
    pub fn resident_bytes(&self) -> Option<u64> {
        let text = std::fs::read_to_string(format!("/proc/{}/status", self.process())).ok()?;
        let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
        line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib << 10)
    }

    /// The last lines of the server's log, and of what it wrote elsewhere if there is no log.
    #[must_use]
    pub fn log_tail(&self) -> String {
        let log = tail(&self.folder.0.join("server.log"));
        let text = if log.is_empty() { tail(&self.folder.0.join("server.out")) } else { log };
        if text.is_empty() { "  (it wrote nothing)".to_owned() } else { text }
    }

    /// The whole of the server's log as it stands.
    #[must_use]
    pub fn log(&self) -> String {
        std::fs::read(self.folder.0.join("server.log"))
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
            .unwrap_or_default()
    }

    /// Waits until the server ends, at most `timeout`.
    fn wait(&mut self, timeout: Duration) -> Option<ExitStatus> {
        let deadline = Instant::now() + timeout;
        loop {
            match self.ended() {
                None if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(5)),
                ended => return ended,
            }
        }
    }

    /// Asks the server to end, and ends it if it does not; how it ended.
    ///
    /// # Errors
    /// [`SessionError::Ended`] if it had crashed before, or ended otherwise than well.
    pub fn end(mut self) -> Result<(), SessionError> {
        self.check()?;
        match self.stop() {
            Some(status) if status.success() => Ok(()),
            status => {
                let status = status.map_or("it had to be killed".to_owned(), |status| status.to_string());
                Err(SessionError::Ended { status, log: self.log_tail() })
            }
        }
    }

    /// Ends the server without mercy, as a crash would.
    pub fn kill(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    fn stop(&mut self) -> Option<ExitStatus> {
        if let Some(status) = self.ended() {
            return Some(status);
        }
        let _ = kill_process(Pid::from_child(&self.child), Signal::TERM);
        let ended = self.wait(END_WAIT);
        if ended.is_none() {
            self.kill();
        }
        ended
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.stop();
        self.remove_leftovers();
    }
}

impl Session {
    /// A server that was killed leaves its lock and socket; they are this one's if the lock names its process.
    fn remove_leftovers(&self) {
        let Some(number) = self.display.strip_prefix(':') else { return };
        let lock = format!("/tmp/.X{number}-lock");
        let owner = std::fs::read_to_string(&lock).ok().and_then(|text| text.trim().parse::<u32>().ok());
        if owner == Some(self.process()) {
            let _ = std::fs::remove_file(format!("/tmp/.X11-unix/X{number}"));
            let _ = std::fs::remove_file(lock);
        }
    }
}

/// Bytes of a display's secret.
const COOKIE_BYTES: usize = 16;

/// A new secret in the form of an authority file: one entry for any host and any display.
fn cookie() -> Result<Vec<u8>, SessionError> {
    const RANDOM: &str = "/dev/urandom";
    const NAME: &[u8] = b"MIT-MAGIC-COOKIE-1";
    let mut secret = [0; COOKIE_BYTES];
    File::open(RANDOM)
        .and_then(|mut random| random.read_exact(&mut secret))
        .map_err(|reason| SessionError::System { path: RANDOM.into(), doing: "cannot be read", reason })?;
    // Family "wild", then address, display, name, data, each with its length, all big-endian.
    let mut entry = vec![0xFF, 0xFF];
    for field in [&b""[..], b"", NAME, &secret] {
        entry.extend((field.len() as u16).to_be_bytes());
        entry.extend(field);
    }
    Ok(entry)
}

/// The display's number, which the server writes when it is ready.
fn display_number(mut pipe: ChildStdout, deadline: Instant) -> Option<u32> {
    let mut text = Vec::new();
    loop {
        let left = deadline.checked_duration_since(Instant::now())?;
        let mut watched = [PollFd::new(&pipe, PollFlags::IN)];
        poll(&mut watched, Timespec::try_from(left).ok().as_ref()).ok();
        if watched[0].revents().is_empty() {
            continue;
        }
        let mut piece = [0; 32];
        let count = pipe.read(&mut piece).ok().filter(|count| *count > 0)?;
        text.extend(&piece[..count]);
        if let Some(end) = text.iter().position(|byte| *byte == b'\n') {
            return std::str::from_utf8(&text[..end]).ok()?.trim().parse().ok();
        }
        if text.len() > 64 {
            return None;
        }
    }
}

/// The last lines of a file, indented; nothing if there is none.
fn tail(file: &Path) -> String {
    use std::io::{Seek, SeekFrom};
    let mut bytes = Vec::new();
    let read = File::open(file).and_then(|mut file| {
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(LOG_BYTES)))?;
        file.take(LOG_BYTES).read_to_end(&mut bytes)
    });
    if read.is_err() {
        return String::new();
    }
    let text = String::from_utf8_lossy(&bytes);
    let lines: Vec<&str> = text.lines().collect();
    let last = &lines[lines.len().saturating_sub(LOG_LINES)..];
    last.iter().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cookie_is_an_entry_for_any_host_and_display() {
        let (one, other) = (cookie().expect("random"), cookie().expect("random"));
        assert_eq!(one[..8], [0xFF, 0xFF, 0, 0, 0, 0, 0, 18]);
        assert_eq!(&one[8..26], b"MIT-MAGIC-COOKIE-1");
        assert_eq!((one[26..28].to_vec(), one.len()), (vec![0, 16], 44));
        assert_ne!(one, other, "a secret is new each time");
    }

    #[test]
    fn tail_is_the_last_lines() {
        let folder = Folder::new().expect("folder");
        let file = folder.0.join("log");
        let text: String = (0..100).map(|line| format!("line {line}\n")).collect();
        std::fs::write(&file, text).expect("written");
        let last = tail(&file);
        assert!(last.starts_with("  line 80\n") && last.ends_with("  line 99"), "{last}");
        assert_eq!(tail(&folder.0.join("none")), "");
        let path = folder.0.clone();
        drop(folder);
        assert!(!path.exists());
    }
}
