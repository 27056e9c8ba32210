//! X.Org video driver module for the ZGA card: the door, not yet the house.
//!
//! The module will let a stock X server run on the card: the screen is the card's video memory,
//! solid fills, copies and lines go through its ring, and the display is its scan-out. It will stand on
//! `zga-driver` and talk to the card in no other way.
//!
//! Nothing of it is here yet, and nothing pretends to be: the crate builds to this page, and exports
//! what any X driver has to know about the card it was built for.
//!
//! # What the module has to match
//!
//! | what | from where |
//! | --- | --- |
//! | video driver ABI | `pkg-config --variable=abi_videodrv xorg-server`, at build time |
//! | depth 24 screens | [`SCREEN_FORMAT`]: one 32-bit word a pixel, as the server's `fb` layer draws it |
//! | depth 16 screens | [`SCREEN_FORMAT_16`] |
//! | alignment of pixmaps | [`PITCH_ALIGNMENT`]: what the card asks of a scan-out or render target |

use zga_abi::format::PixelFormat;

/// Frame buffer format of a screen of depth 24.
pub const SCREEN_FORMAT: PixelFormat = PixelFormat::Xrgb8888;

/// Frame buffer format of a screen of depth 16.
pub const SCREEN_FORMAT_16: PixelFormat = PixelFormat::Rgb565;

/// Bytes that the base and pitch of a scan-out or render target are multiples of.
pub const PITCH_ALIGNMENT: u32 = 64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_pixel_sizes_are_those_of_the_x_depths() {
        assert_eq!(SCREEN_FORMAT.bytes(), 4);
        assert_eq!(SCREEN_FORMAT_16.bytes(), 2);
    }

    #[test]
    fn pitch_alignment_is_what_the_registers_keep() {
        let writable = zga_abi::Reg::ColourPitch.info().writable;
        assert_eq!(1 << writable.trailing_zeros(), PITCH_ALIGNMENT);
    }
}
