//! Client: a program that draws on the server, with all the processes that it starts.

use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process_group};

use super::SessionError;

/// How long clients may take to end when they are asked to.
const END_WAIT: Duration = Duration::from_secs(3);

/// A running client. Dropping it ends it and what it has started.
#[derive(Debug)]
pub struct Client {
    name: String,
    child: Child,
    /// Its process, which is the group's as well.
    group: Pid,
}

impl Client {
    /// Starts `arguments` on `display`: a single one with a space in it is a command for the shell. What the client writes goes
    /// to `log`, or where this program's goes.
    pub(super) fn start(
        arguments: &[OsString],
        display: &str,
        authority: &Path,
        log: Option<&Path>,
    ) -> Result<Client, SessionError> {
        let name = arguments.iter().map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
        let fault = |reason| SessionError::Client { command: name.clone(), reason };
        let mut command = match arguments {
            [] => return Err(fault(std::io::Error::other("no command"))),
            [line] if line.to_string_lossy().contains(char::is_whitespace) => {
                let mut shell = Command::new("/bin/sh");
                shell.arg("-c").arg(line);
                shell
            }
            [program, arguments @ ..] => {
                let mut command = Command::new(program);
                command.args(arguments);
                command
            }
        };
        let outputs = match log {
            Some(log) => {
                let file = File::options().create(true).append(true).open(log).map_err(fault)?;
                [Stdio::from(file.try_clone().map_err(fault)?), Stdio::from(file)]
            }
            None => [Stdio::inherit(), Stdio::inherit()],
        };
        let [out, err] = outputs;
        // A group of its own: Ctrl-C is this program's to answer, and everything that the client starts can be ended.
        command.env("DISPLAY", display).env("XAUTHORITY", authority).process_group(0);
        // A toolkit that can would rather show its windows elsewhere.
        command.env_remove("WAYLAND_DISPLAY").env("GDK_BACKEND", "x11").env("QT_QPA_PLATFORM", "xcb");
        let child = command.stdin(Stdio::null()).stdout(out).stderr(err).spawn().map_err(fault)?;
        let group = Pid::from_child(&child);
        Ok(Client { name, child, group })
    }

    /// What was started.
    #[must_use]
    pub fn name(&self) -> &OsStr {
        self.name.as_ref()
    }

    /// Its process.
    #[must_use]
    pub fn process(&self) -> u32 {
        self.child.id()
    }

    /// How it ended, if it has.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.child.try_wait().ok().flatten()
    }

    /// Waits until it ends, at most `timeout`.
    pub fn wait(&mut self, timeout: Duration) -> Option<ExitStatus> {
        let deadline = Instant::now() + timeout;
        loop {
            match self.ended() {
                None if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(10)),
                ended => return ended,
            }
        }
    }

    /// Ends it and what it has started, at once.
    pub fn kill(&mut self) {
        // A group that is gone is what is wanted.
        let _ = kill_process_group(self.group, Signal::KILL);
        let _ = self.child.wait();
    }

    /// Asks it to end; ends it if it does not.
    pub fn end(&mut self) {
        let _ = kill_process_group(self.group, Signal::TERM);
        if self.wait(END_WAIT).is_none() {
            self.kill();
        }
        // What it has started and left behind.
        let _ = kill_process_group(self.group, Signal::KILL);
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.end();
    }
}
