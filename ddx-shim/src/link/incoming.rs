//! Incoming: puts messages together from the pieces in which a socket delivers them.
//!
//! Inputs from: a socket. Outputs to: seat (requests), viewer (frames, status).
//! Nothing is believed: a length beyond what its kind may have is refused before anything is stored, and room is made
//! only for what has arrived.

use std::io::{ErrorKind, Read};

use super::message::{HEADER_WORDS, Kind};

/// Words for which room is made at a time.
const STEP_WORDS: usize = 1 << 18;

/// A whole message.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Message {
    pub kind: Kind,
    pub payload: Vec<u32>,
}

/// What a look at the socket gave.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// A message is whole.
    Whole(Message),
    /// Nothing more to be had at the moment.
    Wait,
    /// The other end hung up.
    HungUp,
    /// What came makes no sense.
    Damaged(String),
}

/// A message on its way.
#[derive(Debug, Default)]
pub(super) struct Incoming {
    header: [u32; HEADER_WORDS],
    payload: Vec<u32>,
    /// Bytes of header and payload that have come.
    bytes: usize,
}

impl Incoming {
    /// Bytes have come of a message that is not whole.
    pub(super) fn is_amid(&self) -> bool {
        self.bytes > 0
    }

    /// Reads until a message is whole or the socket has nothing more. `most` is the longest payload of a kind.
    pub(super) fn step(&mut self, socket: &mut impl Read, most: fn(Kind) -> Option<usize>) -> Step {
        const HEADER_BYTES: usize = 4 * HEADER_WORDS;
        loop {
            let room: &mut [u8] = if self.bytes < HEADER_BYTES {
                &mut bytemuck::cast_slice_mut(&mut self.header)[self.bytes..]
            } else {
                let [kind, words] = self.header;
                let words = words as usize;
                let Some((kind, most)) = Kind::of(kind).and_then(|kind| Some((kind, most(kind)?))) else {
                    return Step::Damaged(format!("kind {kind}, expected one of this side's messages"));
                };
                if words > most {
                    return Step::Damaged(format!("{words} words, expected at most {most} of kind {kind:?}"));
                }
                let have = self.bytes - HEADER_BYTES;
                if have == 4 * words {
                    let payload = std::mem::take(&mut self.payload);
                    self.bytes = 0;
                    return Step::Whole(Message { kind, payload });
                }
                if have == 4 * self.payload.len() {
                    self.payload.resize(words.min(self.payload.len() + STEP_WORDS), 0);
                }
                &mut bytemuck::cast_slice_mut(&mut self.payload)[have..]
            };
            match socket.read(room) {
                Ok(0) => return Step::HungUp,
                Ok(count) => self.bytes += count,
                Err(reason) if reason.kind() == ErrorKind::Interrupted => {}
                Err(reason) if matches!(reason.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    return Step::Wait;
                }
                // Whatever else a socket says, nothing more will come from it.
                Err(_) => return Step::HungUp,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives one byte at a time, and a pause after each.
    struct Drip<'a>(&'a [u8], bool);

    impl Read for Drip<'_> {
        fn read(&mut self, room: &mut [u8]) -> std::io::Result<usize> {
            self.1 = !self.1;
            if self.1 {
                return Err(ErrorKind::WouldBlock.into());
            }
            self.0.read(&mut room[..1])
        }
    }

    #[test]
    fn message_in_single_bytes_is_put_together() {
        let words = [Kind::Hello as u32, 3, 7, 8, 9];
        let (mut drip, mut incoming) = (Drip(bytemuck::cast_slice(&words), false), Incoming::default());
        let waits = (0..words.len() * 4)
            .map(|_| incoming.step(&mut drip, Kind::most_of_viewer))
            .filter(|step| *step == Step::Wait)
            .count();
        assert_eq!(waits, words.len() * 4);
        let whole = Message { kind: Kind::Hello, payload: vec![7, 8, 9] };
        assert_eq!(incoming.step(&mut drip, Kind::most_of_viewer), Step::Whole(whole));
        assert!(!incoming.is_amid());
    }

    #[test]
    fn length_beyond_its_kind_is_refused_before_room_is_made() {
        let words = [Kind::Hello as u32, u32::MAX];
        let mut incoming = Incoming::default();
        let step = incoming.step(&mut bytemuck::cast_slice::<u32, u8>(&words), Kind::most_of_viewer);
        assert_eq!(step, Step::Damaged("4294967295 words, expected at most 3 of kind Hello".to_owned()));
        assert_eq!(incoming.payload.capacity(), 0);
    }

    #[test]
    fn room_is_made_as_words_arrive() {
        let words = [Kind::Frame as u32, 1 << 28, 1, 2];
        let mut incoming = Incoming::default();
        let step = incoming.step(&mut bytemuck::cast_slice::<u32, u8>(&words), Kind::most_of_server);
        assert_eq!(step, Step::HungUp);
        assert!(incoming.payload.capacity() <= 2 * STEP_WORDS, "{}", incoming.payload.capacity());
    }

    #[test]
    fn kind_of_the_other_side_or_of_nobody_is_refused() {
        for kind in [Kind::Frame as u32, 0, 99] {
            let step = Incoming::default().step(&mut bytemuck::cast_slice::<u32, u8>(&[kind, 0]), Kind::most_of_viewer);
            assert_eq!(step, Step::Damaged(format!("kind {kind}, expected one of this side's messages")));
        }
    }
}
