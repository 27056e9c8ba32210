//! Where frames come from.

use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt, ImageFormat, Screen};
use x11rb::rust_connection::{DefaultStream, RustConnection};
use zga_ddx_shim::link::Viewer;
use zga_ddx_shim::session::Session;

use crate::error::{Error, Result};
use crate::picture::Picture;

/// Shortest time between two looks at a server without a card.
const LOOK_PERIOD: Duration = Duration::from_millis(33);

/// A frame: width, height, XRGB8888 words.
pub(crate) struct Seen {
    pub size: [u32; 2],
    pub pixels: Vec<u32>,
}

impl Seen {
    /// As it is saved.
    pub(crate) fn picture(&self) -> Picture {
        Picture::of_xrgb(self.size, &self.pixels)
    }
}

/// Gives frames.
pub(crate) trait Source {
    /// The newest frame if it shows something new, waiting at most `wait`.
    ///
    /// # Errors
    /// Whatever ended the source.
    fn next(&mut self, wait: Duration) -> Result<Option<Seen>>;
}

impl Source for Viewer {
    fn next(&mut self, wait: Duration) -> Result<Option<Seen>> {
        let frame = self.next_frame(wait)?;
        Ok(frame.map(|frame| Seen { size: [frame.width, frame.height], pixels: frame.pixels }))
    }
}

/// Connects to a session's display.
pub(crate) fn connect(session: &Session) -> Result<(RustConnection, Screen)> {
    let fault = |reason: String| Error::Display { display: session.display().to_owned(), reason };
    let path = format!("/tmp/.X11-unix/X{}", session.display().trim_start_matches(':'));
    let stream = UnixStream::connect(path).map_err(|reason| fault(reason.to_string()))?;
    let (stream, _) = DefaultStream::from_unix_stream(stream).map_err(|reason| fault(reason.to_string()))?;
    let secret = session.cookie()?;
    let connection =
        RustConnection::connect_to_stream_with_auth_info(stream, 0, b"MIT-MAGIC-COOKIE-1".to_vec(), secret)
            .map_err(|reason| fault(reason.to_string()))?;
    match connection.setup().roots.first().cloned() {
        Some(screen) => Ok((connection, screen)),
        None => Err(fault("it has no screen".to_owned())),
    }
}

/// A server whose driver has no link: its screen as the protocol gives it.
pub(crate) struct Screens {
    connection: RustConnection,
    screen: Screen,
    display: String,
    shown: Vec<u32>,
    looked: Option<Instant>,
}

impl Screens {
    /// Looks at a session's screen.
    ///
    /// # Errors
    /// [`Error::Display`].
    pub(crate) fn new(session: &Session) -> Result<Screens> {
        let (connection, screen) = connect(session)?;
        Ok(Screens { connection, screen, display: session.display().to_owned(), shown: Vec::new(), looked: None })
    }
}

impl Source for Screens {
    fn next(&mut self, wait: Duration) -> Result<Option<Seen>> {
        let due = self.looked.map_or(Duration::ZERO, |looked| LOOK_PERIOD.saturating_sub(looked.elapsed()));
        std::thread::sleep(due.min(wait));
        if due > wait {
            return Ok(None);
        }
        self.looked = Some(Instant::now());
        let fault = |reason: String| Error::Display { display: self.display.clone(), reason };
        let (width, height) = (self.screen.width_in_pixels, self.screen.height_in_pixels);
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.screen.root, 0, 0, width, height, u32::MAX)
            .map_err(|reason| fault(reason.to_string()))?
            .reply()
            .map_err(|reason| fault(reason.to_string()))?;
        let row = (usize::from(width) * if image.depth == 16 { 2 } else { 4 }).next_multiple_of(4);
        let lines = image.data.chunks_exact(row);
        let pixels: Vec<u32> = match image.depth {
            16 => {
                lines.flat_map(|line| line.as_chunks().0.iter().take(width.into()).map(|pair| of_565(*pair))).collect()
            }
            _ => lines.flat_map(|line| line.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word))).collect(),
        };
        if pixels == self.shown {
            return Ok(None);
        }
        self.shown.clone_from(&pixels);
        Ok(Some(Seen { size: [width.into(), height.into()], pixels }))
    }
}

/// A pixel of 16 bits, widened by repeating its top bits, as the card's scan-out does it.
fn of_565(pair: [u8; 2]) -> u32 {
    let pixel = u32::from(u16::from_le_bytes(pair));
    let (red, green, blue) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
    (red << 3 | red >> 2) << 16 | (green << 2 | green >> 4) << 8 | blue << 3 | blue >> 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_of_16_bits_reach_from_black_to_white() {
        assert_eq!(of_565([0, 0]), 0);
        assert_eq!(of_565([0xFF, 0xFF]), 0xFF_FFFF);
        assert_eq!(of_565([0x00, 0xF8]), 0xFF_0000);
        assert_eq!(of_565([0xE0, 0x07]), 0x00_FF00);
    }
}
