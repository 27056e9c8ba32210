//! Pixmaps that move into video memory and out of it; [`super::residency`] says which.

use super::pixmaps::Place;
use super::residency::{Resident, victims};
use super::{ENTRY_WORK, Engine};
use crate::format::bitmap_format;

impl Engine {
    /// Has the pixmaps in video memory, so that the card can draw; false if one is not and does not come. `bytes` is what
    /// the operation would touch.
    pub(super) fn bring_in(&mut self, numbers: &[usize], bytes: u64) -> bool {
        if !self.draws || self.accesses > 0 {
            return false;
        }
        self.operations += 1;
        for &number in numbers {
            let Some(pixmap) = self.pixmaps.get_mut(number) else { return false };
            match pixmap.place {
                Place::Frame | Place::Card(_) => pixmap.used = self.operations,
                Place::Spilled(_) => {
                    pixmap.credit += bytes.min(pixmap.bytes()).max(ENTRY_WORK);
                    if pixmap.credit < pixmap.asks_at {
                        return false;
                    }
                    // If it does not come to a move the next look is after a quarter more.
                    pixmap.asks_at = pixmap.credit + pixmap.bytes() / 4;
                    if !self.move_in(number, numbers) {
                        return false;
                    }
                }
                Place::Nothing | Place::Host(_) | Place::Foreign => return false,
            }
        }
        true
    }

    /// Moves a pixmap into video memory, and others out of it, but none of `keep`.
    fn move_in(&mut self, number: usize, keep: &[usize]) -> bool {
        let Some(pixmap) = self.pixmaps.get(number) else { return false };
        let (width, height, credit) = (pixmap.width, pixmap.height, pixmap.credit);
        let Some(format) = bitmap_format(pixmap.bits_per_pixel) else { return false };
        let mut residents = self.residents(keep);
        // What was freed is free when the card is done with it, which is waited for below.
        let free = self.driver.memory().free_bytes() + self.leaving;
        let Some(leaving) = victims(residents.clone(), free, pixmap.bytes(), credit) else { return false };
        residents.sort_unstable_by_key(|resident| std::cmp::Reverse(resident.used));
        residents.retain(|resident| !leaving.contains(&resident.pixmap));
        for victim in leaving {
            self.spill(victim);
        }
        // Free memory in pieces: more have to leave, or it stays outside.
        let image = loop {
            if !self.drain() {
                return false;
            }
            match self.take_image(width, height, format) {
                Some(image) => break image,
                None => match residents.pop() {
                    Some(next) => self.spill(next.pixmap),
                    None => return false,
                },
            }
        };
        let used = self.operations;
        let Some(pixmap) = self.pixmaps.get_mut(number) else { return false };
        pixmap.credit = 0;
        pixmap.used = used;
        let Place::Spilled(words) = std::mem::replace(&mut pixmap.place, Place::Nothing) else { return false };
        let first = image.memory().address() as usize / 4;
        // The card is done with everything: nothing that it does can lie in this memory.
        self.card.map()[first..first + words.len()].copy_from_slice(&words);
        pixmap.place = Place::Card(image);
        self.moves[0] += 1;
        true
    }

    /// What could leave video memory.
    fn residents(&self, keep: &[usize]) -> Vec<Resident> {
        let images = self.pixmaps.iter().filter_map(|(pixmap, entry)| match &entry.place {
            Place::Card(image) if !keep.contains(&pixmap) => {
                Some(Resident { pixmap, bytes: u64::from(image.memory().bytes()), used: entry.used })
            }
            _ => None,
        });
        images.collect()
    }

    /// Moves a pixmap out of video memory.
    fn spill(&mut self, number: usize) {
        let Some(batch) = self.pixmaps.get(number).map(|pixmap| pixmap.batch) else { return };
        self.wait_for(batch);
        let Some(pixmap) = self.pixmaps.get_mut(number) else { return };
        (pixmap.credit, pixmap.asks_at) = (0, pixmap.bytes());
        match std::mem::replace(&mut pixmap.place, Place::Nothing) {
            Place::Card(image) => {
                let first = image.memory().address() as usize / 4;
                let count = (pixmap.bytes() / 4) as usize;
                pixmap.place = Place::Spilled(self.card.map()[first..first + count].to_vec());
                self.moves[1] += 1;
                self.release(image);
            }
            other => pixmap.place = other,
        }
    }
}
