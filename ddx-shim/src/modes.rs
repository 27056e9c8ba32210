//! Screens: how large one can be, and which video modes it takes.
//!
//! There is no monitor with limits of its own at the end of the card's cable, so a mode is good if its pixels are in the
//! frame buffer. The frame buffer is taken once, for the largest screen there can be; smaller screens are its upper left.

/// Sizes offered beside those of the configuration, largest first.
pub const SIZES: [(u32, u32); 14] = [
    (1920, 1200),
    (1920, 1080),
    (1680, 1050),
    (1600, 1200),
    (1440, 900),
    (1400, 1050),
    (1366, 768),
    (1280, 1024),
    (1280, 800),
    (1280, 720),
    (1152, 864),
    (1024, 768),
    (800, 600),
    (640, 480),
];
/// The size that is taken when the configuration says nothing.
pub const PREFERRED: (u32, u32) = (1024, 768);
/// Smallest screen.
pub const SMALLEST: (u32, u32) = (64, 64);
/// Pixels each way that an image can have.
const MOST: u32 = 16384;

/// Why there is no frame buffer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// The configuration asks for a size that no card has.
    #[error("Virtual {width} {height}: a screen has from 64 x 64 to 16384 x 16384 pixels")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// It does not fit.
    #[error(
        "a frame buffer of {width} x {height} pixels takes {bytes} bytes, of {memory} bytes of video memory it may have \
         {most} (Option \"VideoMemory\")"
    )]
    Memory {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Bytes.
        bytes: u64,
        /// Bytes.
        memory: u64,
        /// Bytes.
        most: u64,
    },
}

/// Size of the frame buffer in pixels: what the configuration asks for, or the largest of [`SIZES`] that leaves an eighth
/// of video memory to the ring and to pixmaps.
///
/// # Errors
/// [`FrameError`].
pub fn frame_size(memory: u64, bytes_per_pixel: u32, asked: Option<(u32, u32)>) -> Result<(u32, u32), FrameError> {
    let most = memory / 8 * 7;
    let bytes = |(width, height): (u32, u32)| {
        // As the driver lays images out: rows of whole lines, one more where rows would share sets of a host's cache.
        let row = (width * bytes_per_pixel).next_multiple_of(64);
        u64::from(if row.is_multiple_of(4096) { row + 64 } else { row }) * u64::from(height)
    };
    if let Some((width, height)) = asked
        && (width < SMALLEST.0 || height < SMALLEST.1 || width > MOST || height > MOST)
    {
        return Err(FrameError::Size { width, height });
    }
    let smallest = SIZES[SIZES.len() - 1];
    let size = asked.or_else(|| SIZES.into_iter().find(|&size| bytes(size) <= most)).unwrap_or(smallest);
    if bytes(size) > most {
        let (width, height) = size;
        return Err(FrameError::Memory { width, height, bytes: bytes(size), memory, most });
    }
    Ok(size)
}

/// A video mode as the server asks about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Pixels shown.
    pub width: u32,
    /// Pixels shown.
    pub height: u32,
    /// Clocks of a line.
    pub total_width: u32,
    /// Lines of a frame.
    pub total_height: u32,
    /// kHz.
    pub clock: u32,
    /// Every other line at a time.
    pub interlaced: bool,
    /// Every line twice.
    pub double_scanned: bool,
}

/// What a mode is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It can be shown.
    Good,
    /// More columns than the frame buffer has, or hardly any.
    Width,
    /// More rows than the frame buffer has, or hardly any.
    Height,
    /// Scan-out does not interlace.
    Interlaced,
    /// Scan-out does not double lines.
    DoubleScanned,
    /// No time to put the pixels out.
    Totals,
}

/// Whether a frame buffer of this size can show a mode.
#[must_use]
pub const fn verdict(timing: &Timing, frame: (u32, u32)) -> Verdict {
    if timing.interlaced {
        Verdict::Interlaced
    } else if timing.double_scanned {
        Verdict::DoubleScanned
    } else if timing.width < SMALLEST.0 || timing.width > frame.0 {
        Verdict::Width
    } else if timing.height < SMALLEST.1 || timing.height > frame.1 {
        Verdict::Height
    } else if timing.total_width < timing.width || timing.total_height < timing.height || timing.clock == 0 {
        Verdict::Totals
    } else {
        Verdict::Good
    }
}

/// Time between two vertical blanks of a mode in microseconds, as near as scan-out's register can have it.
#[must_use]
pub fn period(timing: &Timing) -> u32 {
    let clocks = u64::from(timing.total_width) * u64::from(timing.total_height);
    let micros = clocks * 1000 / u64::from(timing.clock.max(1));
    u32::try_from(micros).unwrap_or(u32::MAX).clamp(1000, 1_000_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    const VGA: Timing = Timing {
        width: 640,
        height: 480,
        total_width: 800,
        total_height: 525,
        clock: 25_175,
        interlaced: false,
        double_scanned: false,
    };

    #[test]
    fn frame_size_default_is_the_largest_that_fits() {
        assert_eq!(frame_size(64 << 20, 4, None), Ok((1920, 1200)));
        assert_eq!(frame_size(4 << 20, 4, None), Ok((1024, 768)));
        assert_eq!(frame_size(4 << 20, 2, None), Ok((1680, 1050)));
    }

    #[test]
    fn frame_size_asked_for_is_taken_or_refused() {
        assert_eq!(frame_size(64 << 20, 4, Some((3000, 2000))), Ok((3000, 2000)));
        let refused = frame_size(4 << 20, 4, Some((1920, 1200))).expect_err("too large");
        assert!(refused.to_string().contains("1920 x 1200"));
        assert_eq!(frame_size(64 << 20, 4, Some((63, 64))), Err(FrameError::Size { width: 63, height: 64 }));
        assert!(frame_size(1 << 20, 4, None).is_err());
    }

    #[test]
    fn verdict_tells_what_is_wrong() {
        let frame = (1024, 768);
        assert_eq!(verdict(&VGA, frame), Verdict::Good);
        assert_eq!(verdict(&Timing { width: 1025, total_width: 1300, ..VGA }, frame), Verdict::Width);
        assert_eq!(verdict(&Timing { height: 769, total_height: 800, ..VGA }, frame), Verdict::Height);
        assert_eq!(verdict(&Timing { height: 10, ..VGA }, frame), Verdict::Height);
        assert_eq!(verdict(&Timing { interlaced: true, ..VGA }, frame), Verdict::Interlaced);
        assert_eq!(verdict(&Timing { double_scanned: true, ..VGA }, frame), Verdict::DoubleScanned);
        assert_eq!(verdict(&Timing { total_width: 639, ..VGA }, frame), Verdict::Totals);
        assert_eq!(verdict(&Timing { clock: 0, ..VGA }, frame), Verdict::Totals);
    }

    #[test]
    fn period_is_that_of_the_mode() {
        assert_eq!(period(&VGA), 16_683);
        assert_eq!(period(&Timing { clock: 1, ..VGA }), 1_000_000);
    }
}
