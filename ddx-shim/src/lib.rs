//! X.Org video driver module for the ZGA card, and what looks at such a card from other processes.
//!
//! A stock X server (`/usr/lib/xorg/Xorg`) that loads the module `zga_drv.so` runs on a card in its own process: the screen
//! and the clients' pixmaps are the card's video memory, fills, copies, lines, letters and compositions are packets in its ring,
//! the display is its scan-out with its hardware cursor. The module talks to the card through `zga-driver`.
//!
//! | part | holds | needs |
//! | --- | --- | --- |
//! | [`engine`] | card, driver, pixmaps, batches, residency: what the module does, in plain Rust | |
//! | [`options`], [`modes`], [`format`](mod@format) | what a configuration may ask for | |
//! | `ffi` | the border to the server: the only unsafe code of the module | feature `xorg` |
//! | [`link`] | frames and counters of a card for other processes, over a Unix socket | |
//! | [`session`] | X servers on the card, started and ended | an X server at run time |
//!
//! # Build and configuration
//! `cargo build --release -p zga-ddx-shim --features xorg` makes `target/release/libzga_ddx_shim.so`, which is installed
//! as `drivers/zga_drv.so` in a folder of the server's `ModulePath`. It needs the headers of the server that is to load it
//! (the video driver ABI comes from `pkg-config --variable=abi_videodrv xorg-server`) and libclang. Without the feature no
//! header is looked for.
//!
//! ```text
//! Section "Device"
//!     Identifier "card"
//!     Driver     "zga"
//!     Option     "VideoMemory" "64"          # MiB, 2 to 1024
//!     Option     "Accel"       "on"          # off: the server's renderer does everything, in the card's memory
//!     Option     "Threads"     "0"           # that the card computes with; 0: all cores
//!     Option     "CpuLimit"    "32768"       # work in pixels under which an idle card is not woken; 0: it always is
//!     Option     "Link"        "/run/zga"    # a socket for viewers; without, nobody can look and nothing is composed
//! EndSection
//! ```
//!
//! Screens are of depth 24 or 16, from 64 x 64 pixels to 1920 x 1200, or to what `Virtual` says. What a configuration asks for
//! in vain is named in the log, and the screen is refused.
//!
//! # RENDER
//! The card composes with the operators 0 (Clear) to 12 (Add), pictures of a8r8g8b8, x8r8g8b8, a8b8g8r8, x8b8g8r8, r5g6b5 and a8,
//! solid fills, all repeats, masks by components, affine transforms with the nearest pixel, and glyphs of a8 and a8r8g8b8: every
//! channel to the bit as the server's renderer. See [`engine::compose`] for what is left to that.

pub mod engine;
pub mod format;
pub mod link;
pub mod modes;
pub mod options;
pub mod session;

#[cfg(feature = "xorg")]
#[expect(unsafe_code, reason = "the border to the X server: C calls in and out; each block has its proof")]
mod ffi;
