//! Accesses: pixels for the server's own renderer.

use super::Engine;
use super::pixmaps::{Pixmap, Place};

impl Engine {
    /// Bytes from row to row of a pixmap.
    #[must_use]
    pub fn pitch(&self, number: usize) -> u32 {
        self.pixmaps.get(number).map_or(0, |pixmap| pixmap.pitch)
    }

    /// The card may draw to this pixmap, so the server has to ask before it touches its pixels.
    #[must_use]
    pub fn is_movable(&self, number: usize) -> bool {
        self.pixmaps.get(number).is_some_and(Pixmap::is_movable)
    }

    /// First byte of a pixmap in host memory for good; `None` for others.
    pub fn host_address(&mut self, number: usize) -> Option<*mut u8> {
        match &mut self.pixmaps.get_mut(number)?.place {
            Place::Host(words) => Some(words.as_mut_ptr().cast()),
            _ => None,
        }
    }

    /// Opens a pixmap to the server's own renderer: waits for the card to be done with it and keeps the card off memory.
    /// First byte of its rows, good until the matching [`Engine::finish`]; `None` for a pixmap that has no pixels here.
    pub fn access(&mut self, number: usize) -> Option<*mut u8> {
        let pixmap = self.pixmaps.get(number)?;
        let address = match &pixmap.place {
            Place::Frame => self.frame.memory().address(),
            Place::Card(image) => image.memory().address(),
            Place::Spilled(_) => {
                self.accesses += 1;
                let Place::Spilled(words) = &mut self.pixmaps.get_mut(number)?.place else { return None };
                return Some(words.as_mut_ptr().cast());
            }
            Place::Nothing | Place::Host(_) | Place::Foreign => return None,
        };
        if self.mapping.is_none() {
            let batch = pixmap.batch;
            self.wait_for(batch);
            self.mapping = Some(self.card.map());
        } else if !self.batches.is_done(pixmap.batch) {
            // Another pixmap is open. Its mapping is given back for the wait and taken again: the words stay where they
            // are, and nobody but this thread's renderer touches the pixels that are open.
            let batch = pixmap.batch;
            self.mapping = None;
            self.wait_for(batch);
            self.mapping = Some(self.card.map());
        }
        self.accesses += 1;
        let words = self.mapping.as_mut()?.get_mut(address as usize / 4..)?;
        Some(words.as_mut_ptr().cast())
    }

    /// Ends an access.
    pub fn finish(&mut self) {
        self.accesses = self.accesses.saturating_sub(1);
        if self.accesses == 0 {
            self.mapping = None;
        }
    }
}
