//! An X server on the card, seen from outside: frames, input, figures.
//!
//! | file | holds |
//! | --- | --- |
//! | `source` | where frames come from: the card's link, or the server itself where there is no card |
//! | `watch` | a window or files that follow the frames until something ends |
//! | `input` | mouse and keyboard of the window, passed on through XTEST |
//! | `keys` | the window's keys as X keysyms |
//! | `report` | counters, effects and units as table and JSON |
//!
//! The card lives in the server's process. Nothing here draws: clients draw, and this looks.

pub(crate) mod input;
mod keys;
pub(crate) mod report;
pub(crate) mod source;
pub(crate) mod watch;
