//! What can go wrong with a session, in the words of whoever started it.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// A fault of a session.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// There is no X server on this machine.
    #[error("{}: there is no X server here; ddx-shim/setup.sh installs it", path.display())]
    NoServer {
        /// Where it was looked for.
        path: PathBuf,
    },
    /// The module has not been built.
    #[error(
        "zga_drv.so: the module for the X server is not there ({}); ddx-shim/setup.sh installs what it is built with, ddx-shim/test.sh build builds it, and --module names another place",
        looked(tried)
    )]
    NoModule {
        /// Where it was looked for.
        tried: Vec<PathBuf>,
    },
    /// The system refused.
    #[error("{}: {doing}: {reason}", path.display())]
    System {
        /// The file or program.
        path: PathBuf,
        /// What was being done.
        doing: &'static str,
        /// What the system said.
        reason: io::Error,
    },
    /// The server ended before it could be used.
    #[error("the X server did not start ({status}); the end of its log:\n{log}")]
    DidNotStart {
        /// How it ended.
        status: String,
        /// Last lines of its log.
        log: String,
    },
    /// The server is there but does not come up.
    #[error("the X server was not ready within {} s; the end of its log:\n{log}", waited.as_secs())]
    NotReady {
        /// How long was waited.
        waited: Duration,
        /// Last lines of its log.
        log: String,
    },
    /// The server ended while it was in use.
    #[error("the X server ended ({status}); the end of its log:\n{log}")]
    Ended {
        /// How it ended.
        status: String,
        /// Last lines of its log.
        log: String,
    },
    /// A client could not be started.
    #[error("{command}: cannot be started: {reason}")]
    Client {
        /// What was to run.
        command: String,
        /// What the system said.
        reason: io::Error,
    },
}

fn looked(tried: &[PathBuf]) -> String {
    let tried: Vec<_> = tried.iter().map(|path| path.display().to_string()).collect();
    format!("looked for {}", tried.join(", "))
}
