//! The pixmap table: what each of the server's pixmaps is made of.

use zga_driver::Image;

use super::batches::Batch;

/// Where a pixmap's pixels are.
#[derive(Debug)]
pub enum Place {
    /// Nowhere: a header without pixels.
    Nothing,
    /// The upper left of the frame buffer.
    Frame,
    /// An image of its own in video memory.
    Card(Image),
    /// In host memory for now; the words of its rows.
    Spilled(Vec<u32>),
    /// In host memory for good: the card has no format for it, or the server wants it there.
    Host(Vec<u32>),
    /// In memory that somebody else gave.
    Foreign,
}

/// What the engine knows of a pixmap.
#[derive(Debug)]
pub struct Pixmap {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// 1, 4, 8, 16 or 32.
    pub bits_per_pixel: u32,
    /// Bytes from row to row.
    pub pitch: u32,
    /// Where its pixels are.
    pub place: Place,
    /// The last batch that reads or writes it.
    pub batch: Batch,
    /// When the card last used it, counted in operations.
    pub used: u64,
    /// What it has earned towards a move into video memory, bytes.
    pub credit: u64,
    /// The credit at which it is looked whether that is enough.
    pub asks_at: u64,
}

impl Pixmap {
    /// The card can draw to it, now or after it has moved.
    #[must_use]
    pub const fn is_movable(&self) -> bool {
        matches!(self.place, Place::Frame | Place::Card(_) | Place::Spilled(_))
    }

    /// Bytes of its rows.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        u64::from(self.pitch) * u64::from(self.height)
    }
}

/// Pixmaps by number. Numbers of pixmaps that are gone are given again.
#[derive(Debug, Default)]
pub struct Pixmaps {
    entries: Vec<Option<Pixmap>>,
    free: Vec<usize>,
}

impl Pixmaps {
    /// Takes a pixmap in; its number.
    pub fn insert(&mut self, pixmap: Pixmap) -> usize {
        if let Some(number) = self.free.pop() {
            self.entries[number] = Some(pixmap);
            return number;
        }
        self.entries.push(Some(pixmap));
        self.entries.len() - 1
    }

    /// Lets a pixmap go.
    pub fn remove(&mut self, number: usize) -> Option<Pixmap> {
        let pixmap = self.entries.get_mut(number)?.take()?;
        self.free.push(number);
        Some(pixmap)
    }

    /// The pixmap with this number.
    #[must_use]
    pub fn get(&self, number: usize) -> Option<&Pixmap> {
        self.entries.get(number)?.as_ref()
    }

    /// The pixmap with this number.
    pub fn get_mut(&mut self, number: usize) -> Option<&mut Pixmap> {
        self.entries.get_mut(number)?.as_mut()
    }

    /// All pixmaps with their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &Pixmap)> {
        self.entries.iter().enumerate().filter_map(|(number, pixmap)| Some((number, pixmap.as_ref()?)))
    }
}
