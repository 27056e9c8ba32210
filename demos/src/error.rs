//! Everything that can be wrong with what the user hands in, with the file and the place at fault; and what the card
//! can refuse.

use std::path::{Path, PathBuf};

use zga_ddx_shim::link::LinkError;
use zga_ddx_shim::session::SessionError;
use zga_device::CardError;
use zga_driver::DriverError;
use zga_driver::trace::TraceError;

/// The result of this crate's fallible functions.
pub type Result<T> = std::result::Result<T, Error>;

/// A fault in what was to be shown, or in the way to it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file could not be opened or read.
    #[error("{}: cannot be read: {reason}", file.display())]
    Read {
        /// The file at fault.
        file: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// The file is larger than the program is prepared to hold.
    #[error("{}: has {bytes} bytes, expected at most {limit}", file.display())]
    TooLarge {
        /// The file at fault.
        file: PathBuf,
        /// Its size.
        bytes: u64,
        /// The largest size that is accepted.
        limit: u64,
    },
    /// The text is not JSON (or repeats a field, or holds too many values).
    #[error("{}:{line}:{column}: not a valid scene: {reason}", file.display())]
    Syntax {
        /// The file at fault.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        reason: String,
    },
    /// A field of a scene has a value that it must not have.
    #[error("{}: {path}: expected {expected}, found {found}", file.display())]
    Field {
        /// The file at fault.
        file: PathBuf,
        /// The field, for example `draw[2].triangles.vertices[1]`.
        path: String,
        /// What the field may hold.
        expected: String,
        /// What it held.
        found: String,
    },
    /// A mesh file is damaged or holds something that cannot be drawn.
    #[error("{}: {reason}", file.display())]
    Mesh {
        /// The file at fault.
        file: PathBuf,
        /// What is wrong, with the line or the element.
        reason: String,
    },
    /// A file could not be written.
    #[error("{}: cannot be written: {reason}", file.display())]
    Write {
        /// The file at fault.
        file: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// A picture cannot be decoded.
    #[error("{}: is not a picture to compare with: {reason}", file.display())]
    Picture {
        /// The file at fault.
        file: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The words of a command have no meaning.
    #[error("{0}")]
    Use(String),
    /// The card has no unit for a setting.
    #[error("{place}: {found} is not possible: {has}")]
    Unsupported {
        /// The flag, or the file and the field.
        place: String,
        /// What was asked for.
        found: String,
        /// What there is.
        has: String,
    },
    /// The driver or the card refused.
    #[error("{place}: {reason}")]
    Driver {
        /// What was being drawn: a scene and, if it is one draw's fault, its path.
        place: String,
        /// What the driver says.
        reason: Box<DriverError>,
    },
    /// A card could not be powered on.
    #[error("{place}: {reason}")]
    Card {
        /// What it was for.
        place: String,
        /// What the card says.
        reason: CardError,
    },
    /// A trace is damaged, or does not fit.
    #[error("{}: {reason}", file.display())]
    Trace {
        /// The file at fault.
        file: PathBuf,
        /// What is wrong with it.
        reason: TraceError,
    },
    /// A card in another process cannot be looked at.
    #[error("{0}")]
    Link(#[from] LinkError),
    /// An X server or one of its clients.
    #[error("{0}")]
    Session(#[from] SessionError),
    /// The X server's own protocol.
    #[error("display {display}: {reason}")]
    Display {
        /// The display.
        display: String,
        /// What is wrong with the connection.
        reason: String,
    },
}

impl Error {
    /// The program's exit code: 1 where the card failed at work, 2 where what was handed in is at fault.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Driver { reason, .. } => match **reason {
                DriverError::Timeout { .. } | DriverError::CardFault(_) => 1,
                _ => 2,
            },
            Self::Trace { reason: TraceError::Stalled { .. }, .. }
            | Self::Link(LinkError::HungUp { .. } | LinkError::Timeout { .. } | LinkError::Damaged { .. })
            | Self::Session(
                SessionError::DidNotStart { .. } | SessionError::NotReady { .. } | SessionError::Ended { .. },
            )
            | Self::Display { .. } => 1,
            _ => 2,
        }
    }

    /// What the driver said while `place` was drawn.
    pub(crate) fn driver(place: impl Into<String>) -> impl FnOnce(DriverError) -> Self {
        let place = place.into();
        |reason| Self::Driver { place, reason: Box::new(reason) }
    }

    /// The system refused to write `file`.
    pub(crate) fn write(file: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        |reason| Self::Write { file: file.to_path_buf(), reason }
    }

    /// A fault in the mesh file `file`.
    pub(crate) fn mesh(file: &Path, reason: impl Into<String>) -> Self {
        Self::Mesh { file: file.to_path_buf(), reason: reason.into() }
    }
}
