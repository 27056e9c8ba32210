//! The hardware cursor: a picture that scan-out puts over the frame.

use std::ffi::c_int;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::SeqCst};

use super::server::{self, xf86CrtcPtr};
use super::{border, screen};

/// Columns and rows of the picture.
pub const SIDE: c_int = 64;
/// Pixels of the picture.
const PIXELS: usize = (SIDE * SIDE) as usize;

/// Where the cursor shall be. The server's input thread moves it too, so it is noted here, and told to the card by the
/// main thread when that is about to sleep.
#[derive(Debug, Default)]
pub struct Place {
    /// x in 63:32, y in 31:0.
    position: AtomicU64,
    moved: AtomicBool,
}

impl Place {
    fn set(&self, x: i32, y: i32) {
        self.position.store(u64::from(x.cast_unsigned()) << 32 | u64::from(y.cast_unsigned()), SeqCst);
        self.moved.store(true, SeqCst);
    }

    /// The place, if it has changed since the last call.
    pub fn take(&self) -> Option<(i32, i32)> {
        self.moved.swap(false, SeqCst).then(|| {
            let position = self.position.load(SeqCst);
            (((position >> 32) as u32).cast_signed(), (position as u32).cast_signed())
        })
    }
}

/// Called from the main thread and from the input thread.
pub unsafe extern "C" fn set_position(crtc: xf86CrtcPtr, x: c_int, y: c_int) {
    border::catch("set_cursor_position", (), || {
        // SAFETY: driver_private is null, or points to the place in the Arc of the screen, which outlives the CRTC's
        // use; only a shared reference is made, of atomics.
        if let Some(place) = unsafe { (*crtc).driver_private.cast::<Place>().as_ref() } {
            place.set(x, y);
        }
    });
}

/// Runs a call for the cursor; what goes wrong is told in the log.
///
/// # Safety
/// `crtc` is this driver's.
unsafe fn call(
    crtc: xf86CrtcPtr,
    hook: &str,
    body: impl FnOnce(&mut crate::engine::Engine) -> Result<(), zga_driver::DriverError>,
) {
    border::catch(hook, (), || {
        // SAFETY: the caller vouches for it.
        let Some(screen) = (unsafe { screen::of_scrn((*crtc).scrn) }) else { return };
        let Some(engine) = &mut screen.engine else { return };
        if let Err(error) = body(engine) {
            border::complain(screen.index, &format!("{hook}: {error}"));
        }
    });
}

pub unsafe extern "C" fn show(crtc: xf86CrtcPtr) {
    // SAFETY: the server calls for this driver's CRTC.
    unsafe { call(crtc, "show_cursor", |engine| engine.show_cursor(true)) };
}

pub unsafe extern "C" fn hide(crtc: xf86CrtcPtr) {
    // SAFETY: the server calls for this driver's CRTC.
    unsafe { call(crtc, "hide_cursor", |engine| engine.show_cursor(false)) };
}

pub unsafe extern "C" fn load_argb(crtc: xf86CrtcPtr, image: *mut server::CARD32) {
    if image.is_null() {
        return;
    }
    // SAFETY: the server hands the picture in the size that xf86_cursors_init was told.
    let pixels: &[u32; PIXELS] = unsafe { &*image.cast() };
    // SAFETY: the server calls for this driver's CRTC.
    unsafe { call(crtc, "load_cursor_argb", |engine| engine.set_cursor_image(pixels)) };
}
