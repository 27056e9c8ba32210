//! Place: where sockets are by default, and which of them are alive.

use std::fs::DirBuilder;
use std::os::unix::fs::{DirBuilderExt, FileTypeExt, MetadataExt};
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use super::{LinkError, Viewer};

/// How long a server may take to answer while living ones are looked for.
const ANSWER: Duration = Duration::from_millis(500);

/// The folder of this user's sockets, made if need be for this user alone: `$XDG_RUNTIME_DIR/zga`, or `/tmp/zga-UID`
/// where there is no such variable.
///
/// # Errors
/// [`LinkError::Folder`] if it cannot be made, is another user's, or is open to others.
pub fn folder() -> Result<PathBuf, LinkError> {
    let user = rustix::process::getuid().as_raw();
    let path = match std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from).filter(|path| path.is_dir()) {
        Some(path) => path.join("zga"),
        None => PathBuf::from(format!("/tmp/zga-{user}")),
    };
    let fault = |reason: String| LinkError::Folder { path: path.clone(), reason };
    match DirBuilder::new().mode(0o700).create(&path) {
        Err(reason) if reason.kind() != std::io::ErrorKind::AlreadyExists => {
            return Err(fault(format!("cannot be made: {reason}")));
        }
        _ => {}
    }
    // Not followed if it is a link: in /tmp anybody could have put one there.
    let found = path.symlink_metadata().map_err(|reason| fault(reason.to_string()))?;
    if !found.is_dir() {
        return Err(fault("is not a folder".to_owned()));
    }
    if found.uid() != user {
        return Err(fault(format!("belongs to user {}, expected {user}", found.uid())));
    }
    if found.mode() & 0o077 != 0 {
        return Err(fault(format!("has mode {:04o}, expected 0700: others could attach", found.mode() & 0o7777)));
    }
    Ok(path)
}

/// The default path of the socket of process `process`.
///
/// # Errors
/// As [`folder`].
pub fn socket_path(process: u32) -> Result<PathBuf, LinkError> {
    Ok(folder()?.join(format!("card-{process}")))
}

/// Sockets in the default folder at which a server answers, the newest first.
///
/// # Errors
/// As [`folder`]; [`LinkError::Folder`] if it cannot be read.
pub fn living() -> Result<Vec<PathBuf>, LinkError> {
    let folder = folder()?;
    let fault = |reason: std::io::Error| LinkError::Folder { path: folder.clone(), reason: reason.to_string() };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(fault)? {
        let entry = entry.map_err(fault)?;
        let data = entry.metadata().ok().filter(|data| data.file_type().is_socket());
        if let Some(made) = data.map(|data| data.modified().unwrap_or(SystemTime::UNIX_EPOCH)) {
            found.push((made, entry.path()));
        }
    }
    found.sort();
    Ok(found.into_iter().rev().map(|(_, path)| path).filter(|path| Viewer::connect(path, ANSWER).is_ok()).collect())
}
