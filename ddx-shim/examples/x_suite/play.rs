//! Play: a scene on a server, and the pixels that come of it.

mod send;
mod stage;

use std::os::unix::net::UnixStream;

use x11rb::connection::Connection;
use x11rb::errors::{ConnectionError, ReplyError, ReplyOrIdError};
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{ConnectionExt as _, Drawable, ImageFormat, Screen};
use x11rb::rust_connection::{DefaultStream, RustConnection};
use zga_ddx_shim::session::Session;

use super::scene::Scene;
use stage::Stage;

/// Why a scene could not be played to its end.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    #[error("cannot connect to display {0}: {1}")]
    Connect(String, String),
    #[error("the connection broke: {0}")]
    Broken(#[from] ConnectionError),
    #[error("the server refused what it must not refuse: {0}")]
    Refused(String),
}

impl From<ReplyOrIdError> for PlayError {
    fn from(error: ReplyOrIdError) -> Self {
        match error {
            ReplyOrIdError::ConnectionError(broken) => Self::Broken(broken),
            other => Self::Refused(other.to_string()),
        }
    }
}

impl From<ReplyError> for PlayError {
    fn from(error: ReplyError) -> Self {
        ReplyOrIdError::from(error).into()
    }
}

/// Connects to a session's display.
pub fn connect(session: &Session) -> Result<(RustConnection, Screen), PlayError> {
    let display = session.display();
    let fault = |reason: String| PlayError::Connect(display.to_owned(), reason);
    let path = format!("/tmp/.X11-unix/X{}", display.trim_start_matches(':'));
    let stream = UnixStream::connect(path).map_err(|reason| fault(reason.to_string()))?;
    let (stream, _) = DefaultStream::from_unix_stream(stream).map_err(|reason| fault(reason.to_string()))?;
    let cookie = session.cookie().map_err(|reason| fault(reason.to_string()))?;
    let connection =
        RustConnection::connect_to_stream_with_auth_info(stream, 0, b"MIT-MAGIC-COOKIE-1".to_vec(), cookie)
            .map_err(|reason| fault(reason.to_string()))?;
    let screen = connection.setup().roots[0].clone();
    Ok((connection, screen))
}

/// Pixels of something at some moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shot {
    pub name: String,
    pub size: [u16; 2],
    pub depth: u8,
    /// As the server gave them; where they are whole pixels, bits that no depth has are 0.
    pub bytes: Vec<u8>,
}

/// What came of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    pub shots: Vec<Shot>,
    /// Numbers of requests that were refused, and the error's code.
    pub errors: Vec<(usize, u8)>,
}

/// Which part of a scene is played.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// So many requests.
    pub requests: usize,
    /// This one left out.
    pub without: Option<usize>,
}

/// Plays a part of a scene and takes the pixels. Everything is gone from the server afterwards, with the connection.
pub fn play(session: &Session, scene: &Scene, part: Part) -> Result<Outcome, PlayError> {
    let (connection, screen) = connect(session)?;
    let stage = Stage::set(&connection, &screen, scene)?;
    let mut outcome = Outcome::default();
    let mut numbers = Vec::new();
    let wanted = |number: &usize| part.without != Some(*number);
    for number in (0..part.requests.min(scene.requests.len())).filter(wanted) {
        let before = stage.request(number, &mut outcome)?;
        numbers.extend(before.map(|sequence| (sequence, number)));
    }
    stage.look(&mut outcome)?;
    while let Some(event) = connection.poll_for_event()? {
        if let Event::Error(error) = event {
            let number = numbers.iter().find(|(sequence, _)| *sequence as u16 == error.sequence);
            outcome.errors.push((number.map_or(usize::MAX, |(_, number)| *number), error.error_code));
        }
    }
    Ok(outcome)
}

/// Bytes of a row of pixels of some depth, as the wire has it.
fn stride(width: u32, depth: u8) -> usize {
    let bits = match depth {
        1 => 1,
        8 => 8,
        16 => 16,
        _ => 32,
    };
    (width as usize * bits).div_ceil(32) * 4
}

impl Stage<'_> {
    /// The pixels of everything at the end.
    fn look(&self, outcome: &mut Outcome) -> Result<(), PlayError> {
        let composited = self.scene.kind.composited;
        let (whole, scene) = ((ImageFormat::Z_PIXMAP, u32::MAX), self.scene);
        if !composited {
            let size = scene.kind.size;
            self.shoot("screen".to_owned(), self.root, [0, 0], size, scene.kind.depth, whole, outcome)?;
        }
        for (on, (surface, id)) in scene.surfaces.iter().zip(&self.surfaces).enumerate() {
            let kind = if surface.window.is_some() { "window" } else { "pixmap" };
            let name = format!("{kind} {on}, depth {}", surface.depth);
            if surface.window.is_none() {
                self.shoot(name, *id, [0, 0], [surface.width, surface.height], surface.depth, whole, outcome)?;
            } else if composited {
                let place = self.connection.get_geometry(*id)?.reply()?;
                let size = [place.width, place.height];
                self.shoot(name, *id, [0, 0], size, surface.depth, whole, outcome)?;
            }
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "a request's own fields")]
    fn shoot(
        &self,
        name: String,
        from: Drawable,
        [x, y]: [i16; 2],
        size: [u16; 2],
        depth: u8,
        (format, planes): (ImageFormat, u32),
        outcome: &mut Outcome,
    ) -> Result<(), PlayError> {
        let [width, height] = size;
        match self.connection.get_image(format, from, x, y, width, height, planes)?.reply() {
            Ok(image) => {
                let mut bytes = image.data;
                // Depth 24 in 32 bits: the protocol leaves the rest undefined. RENDER's pictures of it have no channel there, and
                // what the server's renderer leaves there depends on the way it takes; nothing reads it but as opaque.
                if format == ImageFormat::Z_PIXMAP && depth == 24 {
                    bytes.as_chunks_mut::<4>().0.iter_mut().for_each(|pixel| pixel[3] = 0);
                }
                outcome.shots.push(Shot { name, size, depth, bytes });
                Ok(())
            }
            // A window that is hidden or reaches beyond the screen: the same on both.
            Err(ReplyError::X11Error(error)) => {
                outcome.errors.push((usize::MAX, error.error_code));
                Ok(())
            }
            Err(ReplyError::ConnectionError(broken)) => Err(broken.into()),
        }
    }
}

/// The whole screen of a session, as XRGB8888 words.
pub fn screenshot(session: &Session) -> Result<([u32; 2], Vec<u32>), PlayError> {
    let (connection, screen) = connect(session)?;
    let (width, height) = (screen.width_in_pixels, screen.height_in_pixels);
    let image = connection.get_image(ImageFormat::Z_PIXMAP, screen.root, 0, 0, width, height, u32::MAX)?.reply()?;
    let shot = Shot { name: "screen".to_owned(), size: [width, height], depth: screen.root_depth, bytes: image.data };
    Ok(([width.into(), height.into()], shot.pixels()))
}

/// Has anybody set this property of the root window?
pub fn has_root_property(session: &Session, name: &str) -> Result<bool, PlayError> {
    let (connection, screen) = connect(session)?;
    let atom = connection.intern_atom(true, name.as_bytes())?.reply()?.atom;
    let property = connection.get_property(false, screen.root, atom, 0_u32, 0, 1);
    Ok(atom != 0 && property?.reply()?.type_ != 0)
}

/// Waits until the server has done all that it was sent by anybody before.
pub fn settle(session: &Session) -> Result<(), PlayError> {
    let (connection, _) = connect(session)?;
    connection.get_input_focus()?.reply()?;
    Ok(())
}

impl Shot {
    /// As XRGB8888 words for the eye.
    pub fn pixels(&self) -> Vec<u32> {
        let [width, height] = self.size.map(usize::from);
        let row = stride(width as u32, self.depth);
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            let line = self.bytes.get(y * row..).unwrap_or(&[]);
            let byte = |at: usize| u32::from(line.get(at).copied().unwrap_or(0));
            pixels.extend((0..width).map(|x| match self.depth {
                1 => (byte(x / 8) >> (x % 8) & 1) * 0xFF_FFFF,
                8 => byte(x) * 0x01_0101,
                16 => {
                    let pixel = byte(2 * x) | byte(2 * x + 1) << 8;
                    let (red, green, blue) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
                    (red * 255 / 31) << 16 | (green * 255 / 63) << 8 | (blue * 255 / 31)
                }
                _ => byte(4 * x) | byte(4 * x + 1) << 8 | byte(4 * x + 2) << 16,
            }));
        }
        pixels
    }
}
