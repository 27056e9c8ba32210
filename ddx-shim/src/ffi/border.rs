//! Log, panics, signals.

use std::ffi::{CString, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::server;
use crate::engine::Severity;

/// A hook has panicked: nothing is drawn by the card any more.
static PANICKED: AtomicBool = AtomicBool::new(false);

/// A line in the server's log.
pub fn say(screen: c_int, severity: Severity, text: &str) {
    let kind = match severity {
        Severity::Information => server::X_INFO,
        Severity::Error => server::X_ERROR,
    };
    // A text with a zero byte is cut there.
    let line = CString::new(text.split('\0').next().unwrap_or_default()).unwrap_or_default();
    // SAFETY: the format takes one string, which is one and ends with a zero byte; the server copies it.
    unsafe { server::xf86DrvMsg(screen, kind, c"%s\n".as_ptr(), line.as_ptr()) };
}

/// An error in the server's log.
pub fn complain(screen: c_int, text: &str) {
    say(screen, Severity::Error, text);
}

/// Runs the body of a hook. If it panics that is told in the log, and `otherwise` is the hook's answer: one that has the
/// server's own renderer do the work.
pub fn catch<R>(hook: &str, otherwise: R, body: impl FnOnce() -> R) -> R {
    // What was in work is not trusted afterwards: see `has_panicked`.
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| {
        PANICKED.store(true, Relaxed);
        complain(-1, &format!("zga: {hook} panicked; the server's own renderer draws from here on"));
        otherwise
    })
}

/// Whether a hook has panicked.
pub fn has_panicked() -> bool {
    PANICKED.load(Relaxed)
}

/// Runs `body` with all signals blocked, so that the threads it starts never take one: the server's handlers are for the
/// main thread.
pub fn without_signals<R>(body: impl FnOnce() -> R) -> R {
    let mut all = std::mem::MaybeUninit::uninit();
    let mut before = std::mem::MaybeUninit::uninit();
    // SAFETY: both sets are written by the calls before they are read: sigfillset writes the first, pthread_sigmask the
    // second.
    unsafe {
        server::sigfillset(all.as_mut_ptr());
        server::pthread_sigmask(server::SIG_SETMASK as c_int, all.as_ptr(), before.as_mut_ptr());
    }
    let result = body();
    // SAFETY: `before` was written above; the old mask is not asked for.
    unsafe { server::pthread_sigmask(server::SIG_SETMASK as c_int, before.as_ptr(), std::ptr::null_mut()) };
    result
}
