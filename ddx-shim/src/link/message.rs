//! Messages of the link: kinds, lengths, what the first ones say.

/// Version of the protocol; ends of different versions part at once.
pub const VERSION: u32 = 1;

/// First words of a hello: "ZGA link" in the host's order.
pub(super) const MAGIC: [u32; 2] = [u32::from_ne_bytes(*b"ZGA "), u32::from_ne_bytes(*b"link")];

/// Words before the payload: kind, length in words.
pub(super) const HEADER_WORDS: usize = 2;

/// Registers of the identification block, from the card's first register on.
pub(super) const IDENTITY_WORDS: usize = 7;

/// Words of a viewer's hello.
pub(super) const VIEWER_HELLO_WORDS: usize = 3;

/// Words of a server's hello: those, its process, the identity.
pub(super) const SERVER_HELLO_WORDS: usize = VIEWER_HELLO_WORDS + 1 + IDENTITY_WORDS;

/// Words of a frame before its pixels: width, height, number in two.
pub(super) const FRAME_WORDS: usize = 4;

/// Longest text of a refusal in bytes; the rest is cut off.
pub(super) const MOST_TEXT_BYTES: usize = 1024;

/// Most words of a status.
pub(super) const MOST_STATUS_WORDS: usize = 1 << 16;

/// Most pixels of a frame on a side, as SCANOUT_SIZE says it.
pub(super) const MOST_SIDE: u32 = 16384;

/// Kinds of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Hello = 1,
    NextFrame = 2,
    Status = 3,
    Frame = 4,
    Refused = 5,
}

impl Kind {
    pub(super) fn of(word: u32) -> Option<Kind> {
        [Kind::Hello, Kind::NextFrame, Kind::Status, Kind::Frame, Kind::Refused]
            .into_iter()
            .find(|kind| *kind as u32 == word)
    }

    /// Most words that a viewer may send with this kind; `None` if it may not send it.
    pub(super) fn most_of_viewer(self) -> Option<usize> {
        match self {
            Kind::Hello => Some(VIEWER_HELLO_WORDS),
            Kind::NextFrame | Kind::Status => Some(0),
            Kind::Frame | Kind::Refused => None,
        }
    }

    /// The same of a server.
    pub(super) fn most_of_server(self) -> Option<usize> {
        match self {
            Kind::Hello => Some(SERVER_HELLO_WORDS),
            Kind::Status => Some(MOST_STATUS_WORDS),
            Kind::Frame => Some(FRAME_WORDS + MOST_SIDE as usize * MOST_SIDE as usize),
            Kind::Refused => Some(1 + MOST_TEXT_BYTES / 4),
            Kind::NextFrame => None,
        }
    }
}

/// A message with a payload that is at hand.
pub(super) fn message(kind: Kind, payload: &[u32]) -> Vec<u32> {
    [&[kind as u32, payload.len() as u32], payload].concat()
}

/// A text as words: its length in bytes, the bytes, zeros up to a whole word.
pub(super) fn text_words(text: &str) -> Vec<u32> {
    let mut end = text.len().min(MOST_TEXT_BYTES);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let bytes = &text.as_bytes()[..end];
    let mut words = vec![bytes.len() as u32];
    words.extend(bytes.chunks(4).map(|chunk| {
        let mut word = [0; 4];
        word[..chunk.len()].copy_from_slice(chunk);
        u32::from_ne_bytes(word)
    }));
    words
}

/// Takes a text off the front of `words`; `None` if it is not whole or not UTF-8.
pub(super) fn take_text(words: &mut &[u32]) -> Option<String> {
    let (bytes, rest) = words.split_first()?;
    let bytes = *bytes as usize;
    let used = bytes.div_ceil(4);
    if bytes > MOST_TEXT_BYTES || used > rest.len() {
        return None;
    }
    let text: Vec<u8> = rest[..used].iter().flat_map(|word| word.to_ne_bytes()).take(bytes).collect();
    *words = &rest[used..];
    String::from_utf8(text).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_any_length_comes_back() {
        for text in ["", "a", "abcd", "abcde", "größe"] {
            let words = text_words(text);
            assert_eq!(take_text(&mut &words[..]), Some(text.to_owned()));
        }
        // Cut between characters, of which this has two bytes each.
        let long = text_words(&"ö".repeat(MOST_TEXT_BYTES));
        assert_eq!(take_text(&mut &long[..]), Some("ö".repeat(MOST_TEXT_BYTES / 2)));
    }

    #[test]
    fn text_that_is_not_whole_is_none() {
        assert_eq!(take_text(&mut &[][..]), None);
        assert_eq!(take_text(&mut &[5, 0][..]), None);
        assert_eq!(take_text(&mut &[u32::MAX, 0][..]), None);
        assert_eq!(take_text(&mut &[1, 0xFF][..]), None);
    }
}
