//! Hidden surfaces: which primitive is seen at each pixel.
//!
//! | module | path |
//! | --- | --- |
//! | [`z_buffer`] | plain Z buffer: one depth a pixel, one comparison a fragment |
//! | [`za`] | Z buffer with a status word for each block of pixels: clears and rejects a block at once |
//! | [`systolic`] | array of one processing element a pixel; plane segments flow through it |
//! | [`tile`] | tiles found by a Y, then X sort; 64 comparators |
//! | [`stencil`] | stencil test and shadow bit, a part of every path's comparator |
//! | [`held`] | a scene held back for the models that need all of it |
//!
//! All paths give one picture, bit for bit; they differ in what they cost.

pub mod held;
pub mod stencil;
pub mod systolic;
pub mod tile;
pub mod z_buffer;
pub mod za;
