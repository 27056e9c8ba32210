//! The window's keys as X keysyms, those of an unshifted key: shift is a key of its own and is passed on as such.

use minifb::Key;

/// The keysym of a key; `None` for what the window cannot name.
pub(super) fn keysym(key: Key) -> Option<u32> {
    let number = |from: Key, to: Key, first: u32| {
        (from as u32..=to as u32).contains(&(key as u32)).then(|| first + key as u32 - from as u32)
    };
    let runs = [
        (Key::Key0, Key::Key9, 0x30),
        (Key::A, Key::Z, 0x61),
        (Key::F1, Key::F15, 0xFFBE),
        (Key::NumPad0, Key::NumPad9, 0xFFB0),
    ];
    if let Some(keysym) = runs.into_iter().find_map(|(from, to, first)| number(from, to, first)) {
        return Some(keysym);
    }
    Some(match key {
        Key::Left => 0xFF51,
        Key::Up => 0xFF52,
        Key::Right => 0xFF53,
        Key::Down => 0xFF54,
        Key::Apostrophe => 0x27,
        Key::Backquote => 0x60,
        Key::Backslash => 0x5C,
        Key::Comma => 0x2C,
        Key::Equal => 0x3D,
        Key::LeftBracket => 0x5B,
        Key::RightBracket => 0x5D,
        Key::Minus => 0x2D,
        Key::Period => 0x2E,
        Key::Semicolon => 0x3B,
        Key::Slash => 0x2F,
        Key::Space => 0x20,
        Key::Backspace => 0xFF08,
        Key::Tab => 0xFF09,
        Key::Enter => 0xFF0D,
        Key::Pause => 0xFF13,
        Key::ScrollLock => 0xFF14,
        Key::Escape => 0xFF1B,
        Key::Home => 0xFF50,
        Key::PageUp => 0xFF55,
        Key::PageDown => 0xFF56,
        Key::End => 0xFF57,
        Key::Insert => 0xFF63,
        Key::Menu => 0xFF67,
        Key::NumLock => 0xFF7F,
        Key::NumPadEnter => 0xFF8D,
        Key::NumPadAsterisk => 0xFFAA,
        Key::NumPadPlus => 0xFFAB,
        Key::NumPadMinus => 0xFFAD,
        Key::NumPadDot => 0xFFAE,
        Key::NumPadSlash => 0xFFAF,
        Key::LeftShift => 0xFFE1,
        Key::RightShift => 0xFFE2,
        Key::LeftCtrl => 0xFFE3,
        Key::RightCtrl => 0xFFE4,
        Key::CapsLock => 0xFFE5,
        Key::LeftAlt => 0xFFE9,
        Key::RightAlt => 0xFFEA,
        Key::LeftSuper => 0xFFEB,
        Key::RightSuper => 0xFFEC,
        Key::Delete => 0xFFFF,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_keys_have_the_keysyms_of_their_names() {
        let expected = [
            (Key::Key0, 0x30),
            (Key::Key9, 0x39),
            (Key::A, u32::from(b'a')),
            (Key::Q, u32::from(b'q')),
            (Key::Z, u32::from(b'z')),
            (Key::F1, 0xFFBE),
            (Key::F12, 0xFFC9),
            (Key::NumPad7, 0xFFB7),
        ];
        assert_eq!(expected.map(|(key, _)| keysym(key)), expected.map(|(_, keysym)| Some(keysym)));
        assert_eq!(keysym(Key::Unknown), None);
    }
}
