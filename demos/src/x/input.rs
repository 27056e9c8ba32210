//! Mouse and keyboard of a window, passed on to a server through XTEST.
//!
//! Inputs from: minifb. Outputs to: the server, as events of its core pointer and keyboard.

use std::cell::RefCell;
use std::rc::Rc;

use minifb::{InputCallback, Key, MouseButton, MouseMode, Window};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ConnectionExt as _, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, Keycode,
    MOTION_NOTIFY_EVENT,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use zga_ddx_shim::session::Session;

use super::keys::keysym;
use super::source::connect;
use crate::error::{Error, Result};

/// Buttons of the mouse, in the server's numbers.
const BUTTONS: [(MouseButton, u8); 3] = [(MouseButton::Left, 1), (MouseButton::Middle, 2), (MouseButton::Right, 3)];
/// Button that a step of the wheel presses: up, down.
const WHEEL: [u8; 2] = [4, 5];
/// Most steps of the wheel that are passed on at a time.
const MOST_STEPS: f32 = 10.0;

/// Keys that went down and up, in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strokes(Rc<RefCell<Vec<(Key, bool)>>>);

impl InputCallback for Strokes {
    fn add_char(&mut self, _: u32) {}

    fn set_key_state(&mut self, key: Key, down: bool) {
        self.0.borrow_mut().push((key, down));
    }
}

/// What is passed on, and what the server was told last.
pub(crate) struct Input {
    connection: RustConnection,
    display: String,
    /// Keysym of each key without shift, and its code.
    codes: Vec<(u32, Keycode)>,
    strokes: Strokes,
    held: Vec<Keycode>,
    buttons: [bool; BUTTONS.len()],
    place: Option<[i16; 2]>,
}

impl Input {
    /// Connects a window with a session.
    ///
    /// # Errors
    /// [`Error::Display`].
    pub(crate) fn new(session: &Session, window: &mut Window) -> Result<Input> {
        let (connection, _) = connect(session)?;
        let display = session.display().to_owned();
        let fault = |reason: String| Error::Display { display: display.clone(), reason };
        let (first, last) = (connection.setup().min_keycode, connection.setup().max_keycode);
        let mapping = connection
            .get_keyboard_mapping(first, last - first + 1)
            .map_err(|reason| fault(reason.to_string()))?
            .reply()
            .map_err(|reason| fault(reason.to_string()))?;
        let width = usize::from(mapping.keysyms_per_keycode).max(1);
        let codes = mapping.keysyms.chunks(width).zip(first..=last).map(|(keysyms, code)| (keysyms[0], code)).collect();
        let strokes = Strokes::default();
        window.set_input_callback(Box::new(strokes.clone()));
        let (held, buttons, place) = (Vec::new(), [false; BUTTONS.len()], None);
        Ok(Input { connection, display, codes, strokes, held, buttons, place })
    }

    /// Passes on what has happened since the last call.
    ///
    /// # Errors
    /// [`Error::Display`] when the server is gone.
    pub(crate) fn pass(&mut self, window: &mut Window) -> Result<()> {
        for (key, down) in self.strokes.0.take() {
            let code = keysym(key).and_then(|wanted| self.codes.iter().find(|(known, _)| *known == wanted));
            let Some((_, code)) = code.copied() else { continue };
            // A key that is held says so again and again; the server repeats by itself.
            if down != self.held.contains(&code) {
                self.key(code, down)?;
            }
        }
        if !window.is_active() {
            // What is released elsewhere is never heard of.
            for code in self.held.clone() {
                self.key(code, false)?;
            }
        }
        if let Some((x, y)) = window.get_mouse_pos(MouseMode::Discard) {
            let place = [x as i16, y as i16];
            if self.place != Some(place) {
                self.place = Some(place);
                self.fake(MOTION_NOTIFY_EVENT, 0, place)?;
            }
        }
        for (number, (button, code)) in BUTTONS.into_iter().enumerate() {
            let down = window.get_mouse_down(button);
            if down != self.buttons[number] {
                self.buttons[number] = down;
                self.fake(if down { BUTTON_PRESS_EVENT } else { BUTTON_RELEASE_EVENT }, code, [0, 0])?;
            }
        }
        if let Some((_, steps)) = window.get_scroll_wheel() {
            let code = WHEEL[usize::from(steps < 0.0)];
            for _ in 0..steps.abs().ceil().min(MOST_STEPS) as u32 {
                self.fake(BUTTON_PRESS_EVENT, code, [0, 0])?;
                self.fake(BUTTON_RELEASE_EVENT, code, [0, 0])?;
            }
        }
        let display = &self.display;
        let fault = |reason: String| Error::Display { display: display.clone(), reason };
        self.connection.flush().map_err(|reason| fault(reason.to_string()))?;
        // Nothing is asked for, but what comes must not pile up.
        while self.connection.poll_for_event().map_err(|reason| fault(reason.to_string()))?.is_some() {}
        Ok(())
    }

    fn key(&mut self, code: Keycode, down: bool) -> Result<()> {
        self.held.retain(|held| *held != code);
        if down {
            self.held.push(code);
        }
        self.fake(if down { KEY_PRESS_EVENT } else { KEY_RELEASE_EVENT }, code, [0, 0])
    }

    fn fake(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) -> Result<()> {
        // Time 0: at once. Root 0: the screen that the pointer is on. Device 0: the core ones.
        match self.connection.xtest_fake_input(kind, detail, 0, 0, x, y, 0) {
            Ok(_) => Ok(()),
            Err(reason) => Err(Error::Display { display: self.display.clone(), reason: reason.to_string() }),
        }
    }
}
