//! Hidden surfaces: which primitive is seen at each pixel.
//!
//! | file | path |
//! | --- | --- |
//! | [`z_buffer`] | plain Z buffer: one depth a pixel, one comparison a fragment |

pub mod z_buffer;
