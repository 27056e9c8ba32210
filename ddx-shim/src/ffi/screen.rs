//! The state of a screen, and the way to it from the server's structures.

use std::ffi::c_int;
use std::sync::Arc;

use super::server::{self, DrawablePtr, PixmapPtr, ScreenPtr, ScrnInfoPtr};
use super::{border, cursor, exa};
use crate::engine::Engine;
use crate::options::Options;
use zga_abi::format::PixelFormat;

/// What the server's functions were before this driver put its own in their place.
#[derive(Clone, Copy, Default)]
pub struct Wrapped {
    pub create_gc: server::CreateGCProcPtr,
    pub close_screen: server::CloseScreenProcPtr,
    pub block_handler: server::ScreenBlockHandlerProcPtr,
}

/// A screen of the server.
pub struct Screen {
    /// Number in the server's log.
    pub index: c_int,
    pub options: Options,
    /// Pixels of the frame buffer.
    pub frame: (u32, u32),
    pub format: PixelFormat,
    /// Serves viewers while the screen is open. It goes before the card.
    pub link: Option<crate::link::Server>,
    /// While the screen is open.
    pub engine: Option<Engine>,
    pub exa: Option<exa::Functions>,
    /// The driver record that EXA works with, until the screen closes.
    pub exa_driver: *mut server::ExaDriverRec,
    pub wrapped: Wrapped,
    pub render: super::render::Below,
    pub cursor: Arc<cursor::Place>,
    /// Size and refresh of the mode that is set; dark when the display is off.
    pub mode: Option<crate::modes::Timing>,
}

/// The screen of a ScrnInfo; `None` before PreInit and after FreeScreen.
///
/// # Safety
/// `scrn` is null or one of the server's screens that belong to this driver, and no other `&mut Screen` of it is alive.
pub unsafe fn of_scrn<'a>(scrn: ScrnInfoPtr) -> Option<&'a mut Screen> {
    // SAFETY: a screen of this driver has in driverPrivate null or what PreInit put there: a Box<Screen> made raw, which
    // lives until FreeScreen. The caller vouches for the rest.
    unsafe { scrn.as_ref()?.driverPrivate.cast::<Screen>().as_mut() }
}

/// The screen of a ScreenRec.
///
/// # Safety
/// As [`of_scrn`].
pub unsafe fn of_screen<'a>(screen: ScreenPtr) -> Option<&'a mut Screen> {
    // SAFETY: the server finds the ScrnInfo of any of its screens; the caller vouches for the rest.
    unsafe { of_scrn(server::xf86ScreenToScrn(screen)) }
}

/// Runs a hook's body with the engine of a screen; `otherwise` if there is none, or if the body panics.
///
/// # Safety
/// As [`of_scrn`]; the body calls nothing of the server that could come back to this driver.
pub unsafe fn with_engine<R: Copy>(
    hook: &str,
    screen: ScreenPtr,
    otherwise: R,
    body: impl FnOnce(&mut Engine, exa::Functions) -> R,
) -> R {
    border::catch(hook, otherwise, || {
        // SAFETY: the caller vouches for it.
        let Some(screen) = (unsafe { of_screen(screen) }) else { return otherwise };
        let (Some(engine), Some(exa)) = (&mut screen.engine, screen.exa) else { return otherwise };
        if border::has_panicked() {
            engine.refuse_everything();
        }
        body(engine, exa)
    })
}

/// The pixmap that a drawable's pixels are in, and what has to be added to the drawable's screen coordinates.
///
/// # Safety
/// `drawable` is a window or pixmap of the server.
pub unsafe fn pixmap_of(drawable: DrawablePtr) -> (PixmapPtr, [i32; 2]) {
    // SAFETY: a drawable's `type` says which structure it is the beginning of; GetWindowPixmap is set on every screen.
    unsafe {
        if u32::from((*drawable).type_) == server::DRAWABLE_WINDOW {
            let Some(window_pixmap) = (*(*drawable).pScreen).GetWindowPixmap else {
                return (std::ptr::null_mut(), [0; 2]);
            };
            let pixmap = window_pixmap(drawable.cast());
            (pixmap, [-i32::from((*pixmap).screen_x), -i32::from((*pixmap).screen_y)])
        } else {
            (drawable.cast(), [0; 2])
        }
    }
}
