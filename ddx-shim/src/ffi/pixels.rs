//! Pixmaps opened for the server's own renderer, past EXA.
//!
//! While one is open the renderer may report damage, and the server then take its own cursor off the screen, by EXA. At the
//! end of EXA's access the address in the header is gone; the driver's hook puts it back ([`address`]) if the pixmap is
//! still open here.

use std::cell::RefCell;
use std::ffi::c_void;

use super::screen::{pixmap_of, with_engine};
use super::server::{DrawablePtr, PixmapPtr, ScreenPtr};

thread_local! {
    /// Open pixmaps and their addresses.
    static OPEN: RefCell<Vec<(PixmapPtr, *mut c_void)>> = const { RefCell::new(Vec::new()) };
}

/// The address of a pixmap that is open here; null for others.
pub fn address(pixmap: PixmapPtr) -> *mut c_void {
    OPEN.with_borrow(|open| {
        open.iter().find(|(other, _)| *other == pixmap).map_or(std::ptr::null_mut(), |found| found.1)
    })
}

/// Pixmaps whose pixels have an address for as long as this lives.
pub struct Open {
    pscreen: ScreenPtr,
    /// Pixmap, and whether the engine has to be told that it ends.
    opened: Vec<(PixmapPtr, bool)>,
}

impl Open {
    /// Nothing is open.
    pub const fn new(pscreen: ScreenPtr) -> Open {
        Open { pscreen, opened: Vec::new() }
    }

    /// Opens the pixmap of a drawable. False: its pixels are not to be had here. One that is open already stays as it is.
    ///
    /// # Safety
    /// `drawable` is a drawable of the screen, and lives as long as this.
    pub unsafe fn add(&mut self, drawable: DrawablePtr) -> bool {
        // SAFETY: the caller vouches for it; the address is good until the access ends, and is taken away before that.
        unsafe {
            let (pixmap, _) = pixmap_of(drawable);
            if pixmap.is_null() {
                return false;
            }
            if !(*pixmap).devPrivate.ptr.is_null() {
                return true;
            }
            let found = with_engine("access", self.pscreen, None, |engine, exa| {
                let number = exa.number(pixmap)?;
                if let Some(address) = engine.host_address(number) {
                    return Some((address, false));
                }
                Some((engine.access(number)?, true))
            });
            let Some((address, told)) = found else { return false };
            (*pixmap).devPrivate.ptr = address.cast();
            OPEN.with_borrow_mut(|open| open.push((pixmap, address.cast())));
            self.opened.push((pixmap, told));
            true
        }
    }
}

impl Drop for Open {
    fn drop(&mut self) {
        for (pixmap, told) in self.opened.drain(..) {
            OPEN.with_borrow_mut(|open| open.retain(|(other, _)| *other != pixmap));
            // SAFETY: it was opened here and lives, as the caller of `add` vouched.
            unsafe {
                (*pixmap).devPrivate.ptr = std::ptr::null_mut();
                if told {
                    with_engine("access", self.pscreen, (), |engine, _| engine.finish());
                }
            }
        }
    }
}
