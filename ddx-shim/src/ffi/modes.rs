//! The one CRTC and the one output, for the server's mode setting and RandR.

use std::ffi::c_int;
use std::ptr::null_mut;

use super::server::{self, Bool, DisplayModePtr, ScrnInfoPtr, xf86CrtcPtr, xf86OutputPtr};
use super::{border, cursor, screen};
use crate::modes::{PREFERRED, SIZES, SMALLEST, Timing, Verdict, verdict};

/// Tables that the server reads and never writes.
#[repr(transparent)]
struct Table<T>(T);
// SAFETY: only functions are in them.
unsafe impl<T> Sync for Table<T> {}

static CONFIGURATION: Table<server::xf86CrtcConfigFuncsRec> =
    Table(server::xf86CrtcConfigFuncsRec { resize: Some(resize), create_lease: None, terminate_lease: None });

static CRTC: Table<server::xf86CrtcFuncsRec> = Table(server::xf86CrtcFuncsRec {
    dpms: Some(crtc_dpms),
    set_mode_major: Some(set_mode),
    set_cursor_position: Some(cursor::set_position),
    show_cursor: Some(cursor::show),
    hide_cursor: Some(cursor::hide),
    load_cursor_argb: Some(cursor::load_argb),
    destroy: Some(crtc_destroy),
    // SAFETY: the rest are function pointers and such, which may be null.
    ..unsafe { std::mem::zeroed() }
});

static OUTPUT: Table<server::xf86OutputFuncsRec> = Table(server::xf86OutputFuncsRec {
    dpms: Some(output_dpms),
    detect: Some(detect),
    mode_valid: Some(output_mode_valid),
    get_modes: Some(get_modes),
    destroy: Some(output_destroy),
    // SAFETY: as above.
    ..unsafe { std::mem::zeroed() }
});

/// Makes CRTC and output, and chooses the first mode.
///
/// # Safety
/// `scrn` is a screen of this driver in PreInit, with its `Screen` in place.
pub unsafe fn create(scrn: ScrnInfoPtr) -> Result<(), String> {
    // SAFETY: the calls are those of the server's mode setting, in its order; the tables live for ever.
    unsafe {
        let Some(screen) = screen::of_scrn(scrn) else { return Err("the screen has no state".to_owned()) };
        let frame = screen.frame;
        server::xf86CrtcConfigInit(scrn, &raw const CONFIGURATION.0);
        let (width, height) = (frame.0 as c_int, frame.1 as c_int);
        server::xf86CrtcSetSizeRange(scrn, SMALLEST.0 as c_int, SMALLEST.1 as c_int, width, height);
        let crtc = server::xf86CrtcCreate(scrn, &raw const CRTC.0);
        let output = server::xf86OutputCreate(scrn, &raw const OUTPUT.0, c"ZGA-1".as_ptr());
        if crtc.is_null() || output.is_null() {
            return Err("the server makes no CRTC and output".to_owned());
        }
        // The place lives as long as the screen's state, which goes after the CRTCs.
        (*crtc).driver_private = std::sync::Arc::as_ptr(&screen.cursor).cast_mut().cast();
        (*output).possible_crtcs = 1;
        (*output).possible_clones = 0;
        (*output).interlaceAllowed = 0;
        (*output).doubleScanAllowed = 0;
        (*output).subpixel_order = server::SubPixelUnknown as c_int;
        if server::xf86InitialConfiguration(scrn, 1) == 0 || (*scrn).modes.is_null() {
            return Err("no mode of the configuration can be shown".to_owned());
        }
        (*scrn).currentMode = (*scrn).modes;
    }
    Ok(())
}

/// A mode in plain numbers.
///
/// # Safety
/// `mode` is a mode of the server.
unsafe fn timing(mode: *const server::DisplayModeRec) -> Timing {
    // SAFETY: the caller vouches for it.
    let mode = unsafe { &*mode };
    let number = |number: c_int| u32::try_from(number).unwrap_or(0);
    Timing {
        width: number(mode.HDisplay),
        height: number(mode.VDisplay),
        total_width: number(mode.HTotal),
        total_height: number(mode.VTotal),
        clock: number(mode.Clock),
        interlaced: mode.Flags & server::V_INTERLACE as c_int != 0,
        double_scanned: mode.Flags & server::V_DBLSCAN as c_int != 0,
    }
}

/// What the server calls a verdict.
const fn status(verdict: Verdict) -> server::ModeStatus {
    match verdict {
        Verdict::Good => server::MODE_OK,
        Verdict::Width => server::MODE_VIRTUAL_X,
        Verdict::Height => server::MODE_VIRTUAL_Y,
        Verdict::Interlaced => server::MODE_NO_INTERLACE,
        Verdict::DoubleScanned => server::MODE_NO_DBLESCAN,
        Verdict::Totals => server::MODE_BAD,
    }
}

pub unsafe extern "C" fn valid_mode(scrn: ScrnInfoPtr, mode: DisplayModePtr, _: Bool, _: c_int) -> server::ModeStatus {
    border::catch("ValidMode", server::MODE_ERROR, || {
        // SAFETY: the server asks about one of its modes for one of this driver's screens.
        unsafe {
            let Some(screen) = screen::of_scrn(scrn) else { return server::MODE_ERROR };
            status(verdict(&timing(mode), screen.frame))
        }
    })
}

unsafe extern "C" fn output_mode_valid(output: xf86OutputPtr, mode: DisplayModePtr) -> c_int {
    // SAFETY: as for ValidMode.
    unsafe { valid_mode((*output).scrn, mode, 0, 0) as c_int }
}

/// There is always somebody who could look.
unsafe extern "C" fn detect(_: xf86OutputPtr) -> server::xf86OutputStatus {
    server::XF86OutputStatusConnected
}

/// The modes offered beside those of the configuration.
unsafe extern "C" fn get_modes(output: xf86OutputPtr) -> DisplayModePtr {
    border::catch("get_modes", null_mut(), || {
        // SAFETY: modes that xf86CVTMode allocates are handed to the server, which frees the list; it makes and owns
        // their names.
        unsafe {
            let Some(screen) = screen::of_scrn((*output).scrn) else { return null_mut() };
            let frame = screen.frame;
            let mut list = null_mut();
            let own = (!SIZES.contains(&frame)).then_some(frame);
            for (width, height) in own.into_iter().chain(SIZES) {
                if width > frame.0 || height > frame.1 {
                    continue;
                }
                let mode = server::xf86CVTMode(width as c_int, height as c_int, 60.0, 0, 0);
                if mode.is_null() {
                    continue;
                }
                // CVT rounds widths down to multiples of 8: these modes have the size that was meant.
                (*mode).HDisplay = width as c_int;
                (*mode).CrtcHDisplay = width as c_int;
                server::xf86SetModeDefaultName(mode);
                (*mode).type_ = server::M_T_DRIVER as c_int;
                if (width, height) == PREFERRED {
                    (*mode).type_ |= server::M_T_PREFERRED as c_int;
                }
                list = server::xf86ModesAdd(list, mode);
            }
            list
        }
    })
}

/// A screen of another size: the same rows, more or fewer of their pixels.
unsafe extern "C" fn resize(scrn: ScrnInfoPtr, width: c_int, height: c_int) -> Bool {
    border::catch("resize", 0, || {
        // SAFETY: the server calls for a screen of this driver, whose pScreen is null before ScreenInit; a screen has a
        // pixmap as soon as it has its functions; the reference to the state ends before the server is called.
        unsafe {
            let Some((frame, pitch)) = screen::of_scrn(scrn)
                .map(|screen| (screen.frame, screen.engine.as_ref().map_or(0, crate::engine::Engine::frame_pitch)))
            else {
                return 0;
            };
            let inside =
                |pixels: c_int, most: u32| u32::try_from(pixels).is_ok_and(|pixels| (1..=most).contains(&pixels));
            if !inside(width, frame.0) || !inside(height, frame.1) {
                border::complain(
                    (*scrn).scrnIndex,
                    &format!(
                        "a screen of {width} x {height} pixels: the frame buffer has {} x {} (Virtual)",
                        frame.0, frame.1
                    ),
                );
                return 0;
            }
            (*scrn).virtualX = width;
            (*scrn).virtualY = height;
            let pscreen = (*scrn).pScreen;
            if pscreen.is_null() {
                return 1;
            }
            let (Some(get), Some(modify)) = ((*pscreen).GetScreenPixmap, (*pscreen).ModifyPixmapHeader) else {
                return 0;
            };
            let pixmap = get(pscreen);
            if pixmap.is_null() {
                return 1;
            }
            modify(pixmap, width, height, -1, -1, pitch as c_int, null_mut())
        }
    })
}

/// Sets a mode: scan-out shows the upper left of the frame buffer.
unsafe extern "C" fn set_mode(
    crtc: xf86CrtcPtr,
    mode: DisplayModePtr,
    rotation: server::Rotation,
    x: c_int,
    y: c_int,
) -> Bool {
    border::catch("set_mode_major", 0, || {
        // SAFETY: the server sets one of its modes on this driver's CRTC.
        unsafe {
            let scrn = (*crtc).scrn;
            let Some(screen) = screen::of_scrn(scrn) else { return 0 };
            let timing = timing(mode);
            let verdict = verdict(&timing, screen.frame);
            if verdict != Verdict::Good || u32::from(rotation) != server::RR_Rotate_0 || (x, y) != (0, 0) {
                border::complain(
                    (*scrn).scrnIndex,
                    &format!(
                        "mode {} x {} at ({x}, {y}), rotation {rotation:#x}: {verdict:?}; the card shows the upper left of a \
                     frame buffer of {} x {}, upright",
                        timing.width, timing.height, screen.frame.0, screen.frame.1
                    ),
                );
                return 0;
            }
            (*crtc).mode = *mode;
            (*crtc).x = x;
            (*crtc).y = y;
            (*crtc).rotation = rotation;
            screen.mode = Some(timing);
            i32::from(display(screen, true))
        }
    })
}

/// Puts the mode that is set on the display, or nothing.
pub fn display(screen: &mut screen::Screen, on: bool) -> bool {
    let size = screen.mode.filter(|_| on).map(|mode| (mode.width, mode.height));
    let watched = screen.options.link.is_some();
    let period = screen
        .mode
        .filter(|_| on && watched)
        .map(|mode| std::time::Duration::from_micros(crate::modes::period(&mode).into()));
    let Some(engine) = &mut screen.engine else { return true };
    let shown = engine.show(size).and_then(|()| engine.set_refresh(period));
    if let Err(error) = shown {
        border::complain(screen.index, &format!("the display: {error}"));
        return false;
    }
    engine.flush();
    true
}

/// Display power: anything but on is dark.
unsafe extern "C" fn crtc_dpms(crtc: xf86CrtcPtr, mode: c_int) {
    border::catch("dpms", (), || {
        // SAFETY: the server calls for this driver's CRTC.
        if let Some(screen) = unsafe { screen::of_scrn((*crtc).scrn) } {
            display(screen, mode == server::DPMSModeOn as c_int);
        }
    });
}

/// The output has no power of its own.
unsafe extern "C" fn output_dpms(_: xf86OutputPtr, _: c_int) {}

unsafe extern "C" fn crtc_destroy(_: xf86CrtcPtr) {}

unsafe extern "C" fn output_destroy(_: xf86OutputPtr) {}
