//! Depths, pixel sizes, raster operations and plane masks of the X server, as the card has them.

use zga_abi::format::{BitmapFormat, PixelFormat, RasterOperation};
use zga_driver::Raster;

/// Frame buffer format of a screen of depth 24.
pub const SCREEN_FORMAT: PixelFormat = PixelFormat::Xrgb8888;

/// Frame buffer format of a screen of depth 16.
pub const SCREEN_FORMAT_16: PixelFormat = PixelFormat::Rgb565;

/// Bytes that the base and pitch of a scan-out or render target are multiples of.
pub const PITCH_ALIGNMENT: u32 = 64;

/// Frame buffer format and bits of a pixel of a screen of this depth; `None` for depths the card cannot show.
#[must_use]
pub const fn screen_format(depth: u32) -> Option<(PixelFormat, u32)> {
    match depth {
        16 => Some((SCREEN_FORMAT_16, 16)),
        24 => Some((SCREEN_FORMAT, 32)),
        _ => None,
    }
}

/// Format of a pixmap with so many bits a pixel; `None` for what the card has no format for.
///
/// What fills, copies and lines do to stored bits does not depend on the depth, so all pixmaps of one size of pixel have
/// one format and can be copied into each other.
#[must_use]
pub const fn bitmap_format(bits_per_pixel: u32) -> Option<BitmapFormat> {
    match bits_per_pixel {
        8 => Some(BitmapFormat::Alpha8),
        16 => Some(BitmapFormat::Rgb565),
        32 => Some(BitmapFormat::Xrgb8888),
        _ => None,
    }
}

/// The raster operation of a GC: its function, and its plane mask as the server's own renderer takes it. A mask that holds
/// all planes of the depth is no mask: the bits beyond the depth change with the others.
#[must_use]
pub fn raster(function: u32, plane_mask: u32, depth: u32) -> Option<Raster> {
    let operation = RasterOperation::from_code(function)?;
    let all = u32::MAX >> (32 - depth.clamp(1, 32));
    let planes = if plane_mask & all == all { u32::MAX } else { plane_mask };
    Some(Raster { operation, planes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_pixel_sizes_are_those_of_the_x_depths() {
        assert_eq!(screen_format(24).map(|(format, bits)| (format.bytes() * 8, bits)), Some((32, 32)));
        assert_eq!(screen_format(16).map(|(format, bits)| (format.bytes() * 8, bits)), Some((16, 16)));
        assert_eq!([1, 4, 8, 15, 30, 32].map(screen_format), [None; 6]);
        for bits in [8, 16, 32] {
            assert_eq!(bitmap_format(bits).map(|format| format.bytes() * 8), Some(bits));
        }
        assert_eq!([1, 4, 24].map(bitmap_format), [None; 3]);
    }

    #[test]
    fn pitch_alignment_is_what_the_registers_keep() {
        let writable = zga_abi::Reg::ColourPitch.info().writable;
        assert_eq!(1 << writable.trailing_zeros(), PITCH_ALIGNMENT);
    }

    #[test]
    fn raster_full_mask_of_the_depth_is_no_mask() {
        assert_eq!(raster(3, 0x00FF_FFFF, 24), Some(Raster::new(RasterOperation::Copy)));
        assert_eq!(raster(3, 0xFFFF_FFFF, 32), Some(Raster::new(RasterOperation::Copy)));
        assert_eq!(raster(6, 0x00FF_FFFE, 24), Some(Raster { operation: RasterOperation::Xor, planes: 0x00FF_FFFE }));
        assert_eq!(raster(16, u32::MAX, 24), None);
    }
}
