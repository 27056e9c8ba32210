//! What can be wrong with a link, with the path at fault.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// A fault of the link.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The path does not fit into a socket's address.
    #[error("{}: has {bytes} bytes, expected at most {most} for the path of a socket", path.display())]
    PathTooLong {
        /// The path.
        path: PathBuf,
        /// Its length.
        bytes: usize,
        /// The largest length.
        most: usize,
    },
    /// Another server answers there.
    #[error("{}: another card is attached to this socket", path.display())]
    InUse {
        /// The socket.
        path: PathBuf,
    },
    /// Something else than a socket is there; it is left alone.
    #[error("{}: exists and is not a socket", path.display())]
    NotASocket {
        /// What is there.
        path: PathBuf,
    },
    /// The folder of sockets belongs to somebody else, or others may write to it.
    #[error("{}: {reason}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The system refused.
    #[error("{}: {doing}: {reason}", path.display())]
    System {
        /// The socket.
        path: PathBuf,
        /// What was being done.
        doing: &'static str,
        /// What the system said.
        reason: io::Error,
    },
    /// Nothing is there.
    #[error("{}: there is no socket here: no card runs, or it was started without a link", path.display())]
    Missing {
        /// Where it was looked for.
        path: PathBuf,
    },
    /// The server that made the socket is gone.
    #[error("{}: nobody answers: the server that made this socket has ended", path.display())]
    Dead {
        /// The socket.
        path: PathBuf,
    },
    /// No answer within the time.
    #[error("{}: no answer within {} ms", path.display(), waited.as_millis())]
    Timeout {
        /// The socket.
        path: PathBuf,
        /// How long was waited.
        waited: Duration,
    },
    /// What answers is no card's link.
    #[error("{}: what answers is not the link of a card: {reason}", path.display())]
    NotALink {
        /// The socket.
        path: PathBuf,
        /// What is wrong with its first words.
        reason: String,
    },
    /// The other end speaks another version.
    #[error("{}: speaks version {found} of the link, expected {expected}", path.display())]
    Version {
        /// The socket.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// Ours, [`super::VERSION`].
        expected: u32,
    },
    /// The server refused this viewer.
    #[error("{}: refused: {reason}", path.display())]
    Refused {
        /// The socket.
        path: PathBuf,
        /// What the server says.
        reason: String,
    },
    /// A message makes no sense.
    #[error("{}: damaged message: {reason}", path.display())]
    Damaged {
        /// The socket.
        path: PathBuf,
        /// What was expected and found.
        reason: String,
    },
    /// The other end hung up.
    #[error("{}: the server has ended", path.display())]
    HungUp {
        /// The socket.
        path: PathBuf,
    },
}
