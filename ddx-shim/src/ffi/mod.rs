//! The border to the X server: everything that is unsafe, and nothing that decides.
//!
//! | file | is |
//! | --- | --- |
//! | `server` | declarations made by bindgen from the server's headers |
//! | [`border`] | log, panics caught, signals blocked |
//! | [`module`] | what the module loader looks for; probing |
//! | [`screen`] | the state of a screen, and the way to it from the server's structures |
//! | [`configure`] | PreInit |
//! | [`start`] | ScreenInit, CloseScreen and what lies between |
//! | [`modes`] | the one CRTC and the one output |
//! | [`cursor`] | the hardware cursor |
//! | [`exa`] | EXA's hooks: pixmaps, accesses, fills, copies |
//! | [`gc`] | drawing requests: lists |
//! | [`render`] | compositions, text, trapezoids and triangles of RENDER |
//! | [`pictures`] | pictures, masks and glyphs of RENDER, as the engine has them |
//! | [`pixels`] | pixmaps opened for the server's own renderer |
//!
//! # What all SAFETY comments here rest on
//! * **One thread.** The server calls a driver from its main thread only. (Positions of the cursor can come from its
//!   input thread; they go through atomics.) So a `&mut Screen` is the only one, as long as none is kept across a call
//!   back into the server: closures given to [`screen::with_engine`] make no such call, and what is called
//!   back is called before or after.
//! * **The server's pointers.** Structures handed to a hook live until it returns, are aligned, and are not changed by
//!   others meanwhile; that is the contract of the driver interface. Fields that may be null are looked at first.
//! * **No unwinding into C.** Every hook's body runs in [`border::catch`].

#[expect(
    warnings,
    clippy::all,
    clippy::unreadable_literal,
    reason = "made by bindgen from the server's headers, in their style"
)]
mod server {
    include!(concat!(env!("OUT_DIR"), "/server.rs"));
}

mod border;
mod configure;
mod cursor;
mod exa;
mod gc;
mod modes;
mod module;
mod pictures;
mod pixels;
mod render;
mod screen;
mod start;
