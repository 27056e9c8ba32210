//! The sub-pixel mask unit.
//!
//! Source: JP 2569952 B2 (1990).
//!
//! | file | part |
//! | --- | --- |
//! | [`grid`] | samples of a pixel, bits of a mask |
//! | [`search`](mod@search) | the nearest or the farthest sub-pixel of a mask |
//! | [`search_clocked`] | the same as registers and clocks |

pub mod grid;
pub mod search;
pub mod search_clocked;
#[cfg(test)]
mod tests;
