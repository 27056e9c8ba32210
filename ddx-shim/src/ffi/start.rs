//! ScreenInit, CloseScreen, and what lies between.

use std::ffi::{c_char, c_int, c_void};

use super::server::{self, Bool, DisplayModePtr, ScreenPtr, ScrnInfoPtr};
use super::{border, cursor, exa, screen};
use crate::engine::{Engine, EngineOptions, Severity};
use crate::link::Server;

/// Called once for each screen in each generation.
pub unsafe extern "C" fn screen_init(pscreen: ScreenPtr, _: c_int, _: *mut *mut c_char) -> Bool {
    border::catch("ScreenInit", 0, || {
        // SAFETY: the server calls with a screen of this driver.
        unsafe {
            let scrn = server::xf86ScreenToScrn(pscreen);
            match init(pscreen, scrn) {
                Ok(()) => 1,
                Err(reason) => {
                    border::complain((*scrn).scrnIndex, &reason);
                    0
                }
            }
        }
    })
}

/// Powers a card on for the screen, and looks where its frame buffer is.
///
/// # Safety
/// `scrn` is a screen of this driver after PreInit.
unsafe fn power_on(scrn: ScrnInfoPtr) -> Result<(usize, u32), String> {
    // SAFETY: the caller vouches for it.
    let screen = unsafe { screen::of_scrn(scrn) }.ok_or("the screen was not configured")?;
    let index = screen.index;
    let options = EngineOptions {
        video_memory: screen.options.video_memory << 20,
        threads: screen.options.threads,
        accel: screen.options.accel,
        frame: screen.frame,
        format: screen.format.into(),
        cpu_limit: screen.options.cpu_limit.into(),
    };
    let log = Box::new(move |severity, text: &str| border::say(index, severity, text));
    let path = screen.options.link.clone();
    // Threads start here: the card's, those that it computes with, and the link's.
    let (mut engine, link) = border::without_signals(|| {
        let engine = Engine::new(&options, log)?;
        let link = path.map(|path| Server::start(&path, engine.card().connector(), engine.card().bus())).transpose();
        let link = link.map_err(|error| format!("Option \"Link\": {error}"))?;
        Ok::<_, String>((engine, link))
    })?;
    let frame = (engine.frame_address(), engine.frame_pitch());
    screen.link = link;
    screen.engine = Some(engine);
    Ok(frame)
}

/// # Safety
/// `pscreen` and `scrn` are one screen of this driver in ScreenInit.
unsafe fn init(pscreen: ScreenPtr, scrn: ScrnInfoPtr) -> Result<(), String> {
    /// What a call of the server answers.
    fn ok(answer: Bool, what: &str) -> Result<(), String> {
        if answer == 0 { Err(format!("the server refuses {what}")) } else { Ok(()) }
    }

    // SAFETY: of the whole function: the calls are those of a driver's ScreenInit in their order. `Screen` is reached for
    // between them and never kept across one that could come back to this driver.
    unsafe {
        let (address, pitch) = power_on(scrn)?;
        let (depth, bits) = ((*scrn).depth, (*scrn).bitsPerPixel);
        let stride = pitch as c_int * 8 / bits;
        (*scrn).displayWidth = stride;
        server::miClearVisualTypes();
        ok(
            server::miSetVisualTypes(depth, server::TrueColorMask as c_int, (*scrn).rgbBits, (*scrn).defaultVisual),
            "visuals",
        )?;
        ok(server::miSetPixmapDepths(), "depths of pixmaps")?;
        let pixels = std::ptr::with_exposed_provenance_mut(address);
        let (width, height) = ((*scrn).virtualX, (*scrn).virtualY);
        ok(
            server::fbScreenInit(pscreen, pixels, width, height, (*scrn).xDpi, (*scrn).yDpi, stride, bits),
            "the screen",
        )?;
        for place in 0..usize::try_from((*pscreen).numVisuals).unwrap_or(0) {
            let visual = &mut *(*pscreen).visuals.add(place);
            if c_int::from(visual.class) == server::TrueColor as c_int {
                visual.offsetRed = (*scrn).offset.red as c_int;
                visual.offsetGreen = (*scrn).offset.green as c_int;
                visual.offsetBlue = (*scrn).offset.blue as c_int;
                visual.redMask = (*scrn).mask.red.into();
                visual.greenMask = (*scrn).mask.green.into();
                visual.blueMask = (*scrn).mask.blue.into();
            }
        }
        ok(server::fbPictureInit(pscreen, std::ptr::null_mut(), 0), "RENDER")?;
        super::render::note(pscreen);
        server::xf86SetBlackWhitePixels(pscreen);

        let functions = exa::Functions::find().ok_or("module exa lacks a function")?;
        if let Some(screen) = screen::of_scrn(scrn) {
            screen.exa = Some(functions);
        }
        let record = exa::start(functions, pscreen).ok_or("EXA does not start")?;
        super::gc::wrap(pscreen);
        super::render::wrap(pscreen);

        server::xf86SetBackingStore(pscreen);
        server::xf86SetSilkenMouse(pscreen);
        ok(server::miDCInitialize(pscreen, server::xf86GetPointerScreenFuncs().cast()), "the pointer")?;
        cursors(pscreen)?;
        (*pscreen).SaveScreen = Some(server::xf86SaveScreen);
        if let Some(screen) = screen::of_scrn(scrn) {
            screen.exa_driver = record;
            screen.wrapped.close_screen = (*pscreen).CloseScreen;
            screen.wrapped.block_handler = (*pscreen).BlockHandler;
        }
        (*pscreen).CloseScreen = Some(close_screen);
        (*pscreen).BlockHandler = Some(block_handler);
        ok(server::xf86CrtcScreenInit(pscreen), "RandR")?;
        ok(server::miCreateDefColormap(pscreen), "the colormap")?;
        server::xf86DPMSInit(pscreen, Some(server::xf86DPMSSet), 0);
        ok(server::xf86SetDesiredModes(scrn), "the first mode")?;
        if server::serverGeneration == 1 {
            server::xf86ShowUnusedOptions((*scrn).scrnIndex, (*scrn).options.cast());
        }
    }
    Ok(())
}

/// # Safety
/// As [`init`].
unsafe fn cursors(pscreen: ScreenPtr) -> Result<(), String> {
    // SAFETY: the caller vouches for the screen; the CRTC has its cursor functions.
    unsafe {
        let flags = server::HARDWARE_CURSOR_TRUECOLOR_AT_8BPP
            | server::HARDWARE_CURSOR_SOURCE_MASK_INTERLEAVE_64
            | server::HARDWARE_CURSOR_UPDATE_UNHIDDEN
            | server::HARDWARE_CURSOR_ARGB;
        if server::xf86_cursors_init(pscreen, cursor::SIDE, cursor::SIDE, flags as c_int) == 0 {
            return Err("the server refuses the hardware cursor".to_owned());
        }
    }
    Ok(())
}

/// The server is about to sleep: what was encoded goes to the card.
unsafe extern "C" fn block_handler(pscreen: ScreenPtr, timeout: *mut c_void) {
    // SAFETY: the server calls with a screen of this driver; the wrapped handler is called with its own pointer in place,
    // as all who wrap it do; no reference to the state lives across the call.
    unsafe {
        let Some(below) = screen::of_screen(pscreen).map(|screen| screen.wrapped.block_handler) else { return };
        (*pscreen).BlockHandler = below;
        if let Some(below) = below {
            below(pscreen, timeout);
        }
        let now = (*pscreen).BlockHandler;
        (*pscreen).BlockHandler = Some(block_handler);
        border::catch("BlockHandler", (), || {
            let Some(screen) = screen::of_screen(pscreen) else { return };
            screen.wrapped.block_handler = now;
            let moved = screen.cursor.take();
            let Some(engine) = &mut screen.engine else { return };
            if let Some((x, y)) = moved
                && let Err(error) = engine.move_cursor(x, y)
            {
                border::complain(screen.index, &format!("the cursor: {error}"));
            }
            // The server says how long it may sleep: not at all if there are requests.
            let sleeps = timeout.cast::<c_int>().as_ref().is_none_or(|timeout| *timeout != 0);
            engine.rest(sleeps);
        });
    }
}

/// End of a generation: the screen goes, and the card with it.
unsafe extern "C" fn close_screen(pscreen: ScreenPtr) -> Bool {
    // SAFETY: the server calls with a screen of this driver. EXA is a layer below this hook: its pixmaps are given back
    // while the layers below close, so the engine goes after them.
    unsafe {
        let scrn = server::xf86ScreenToScrn(pscreen);
        super::render::unwrap(pscreen);
        let Some(screen) = screen::of_scrn(scrn) else { return 1 };
        let (wrapped, functions) = (screen.wrapped, screen.exa);
        let record = std::mem::replace(&mut screen.exa_driver, std::ptr::null_mut());
        (*pscreen).CloseScreen = wrapped.close_screen;
        (*pscreen).CreateGC = wrapped.create_gc;
        (*pscreen).BlockHandler = wrapped.block_handler;
        if let Some(functions) = functions {
            (functions.fini)(pscreen);
        }
        let closed = wrapped.close_screen.map_or(1, |close| close(pscreen));
        border::catch("CloseScreen", (), || {
            if let Some(screen) = screen::of_scrn(scrn) {
                screen.link = None;
                if let Some(engine) = screen.engine.take() {
                    border::say(screen.index, Severity::Information, &engine.summary());
                }
                screen.exa = None;
                border::say(screen.index, Severity::Information, "the card is off");
            }
        });
        // The record is from EXA's calloc and is the driver's to free.
        server::free(record.cast());
        closed
    }
}

pub unsafe extern "C" fn switch_mode(scrn: ScrnInfoPtr, mode: DisplayModePtr) -> Bool {
    // SAFETY: the server calls for a screen of this driver.
    unsafe { server::xf86SetSingleMode(scrn, mode, server::RR_Rotate_0 as server::Rotation) }
}

/// There is no panning: the display shows the whole screen.
pub unsafe extern "C" fn adjust_frame(_: ScrnInfoPtr, _: c_int, _: c_int) {}

pub unsafe extern "C" fn enter_vt(scrn: ScrnInfoPtr) -> Bool {
    // SAFETY: the server calls for a screen of this driver.
    unsafe { server::xf86SetDesiredModes(scrn) }
}

/// The card is this process's own: nobody else wants it.
pub unsafe extern "C" fn leave_vt(_: ScrnInfoPtr) {}

pub unsafe extern "C" fn free_screen(scrn: ScrnInfoPtr) {
    border::catch("FreeScreen", (), || {
        // SAFETY: the last call for this screen; driverPrivate is null or the Box of PreInit.
        unsafe {
            let state = std::mem::replace(&mut (*scrn).driverPrivate, std::ptr::null_mut());
            if !state.is_null() {
                drop(Box::from_raw(state.cast::<screen::Screen>()));
            }
        }
    });
}
