//! Items sorted into bands of lines.
//!
//! Duties: for each band what is needed to tell whether an item can be seen there, without the item itself. Inputs from:
//! [`super::scene`]. Outputs to: [`super::band`].

use super::band::LINES;
use super::piece::extent;
use super::scene::{Item, Kind, Rule, Scene};

/// An item that can touch a band.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Entry {
    /// Its place in the scene.
    pub number: u32,
    /// No depth of it is nearer; where the last is seen the later stands for the nearer.
    pub nearest: i32,
    /// None is farther.
    pub farthest: i32,
    /// First column and row of the target that it can touch, pixels.
    pub from: [u16; 2],
    /// First beyond.
    pub to: [u16; 2],
}

/// Items by the bands that they can touch.
#[derive(Debug, Default)]
pub struct Bands {
    /// Of all items that can touch the target.
    all: Vec<Entry>,
    entries: Vec<Entry>,
    starts: Vec<u32>,
    next: Vec<u32>,
    masked: u64,
}

impl Bands {
    /// Puts the items of a scene into bands.
    pub fn fill(&mut self, scene: &Scene, rule: Rule, height: u32) {
        let count = (height as usize).div_ceil(LINES);
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        self.all.clear();
        self.masked = 0;
        for (number, item) in (0..).zip(&scene.items) {
            let [from, to] = extent(item, &scene.draws[item.draw as usize]);
            if from[0] >= to[0] || from[1] >= to[1] {
                continue;
            }
            self.masked += u64::from(item.kind == Kind::Masked);
            let [nearest, farthest] = if rule == Rule::Last { [-(number as i32); 2] } else { range(item) };
            let (from, to) = ([from[0] as u16, from[1] as u16], [to[0] as u16, to[1] as u16]);
            let entry = Entry { number, nearest, farthest, from, to };
            bands(&entry).for_each(|band| self.starts[band + 1] += 1);
            self.all.push(entry);
        }
        for band in 0..count {
            self.starts[band + 1] += self.starts[band];
        }
        self.entries.resize(self.starts[count] as usize, Entry::default());
        self.next.clear();
        self.next.extend_from_slice(&self.starts);
        for entry in &self.all {
            for band in bands(entry) {
                self.entries[self.next[band] as usize] = *entry;
                self.next[band] += 1;
            }
        }
    }

    /// Bands.
    #[must_use]
    pub fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Items of a band, in order of submission.
    #[must_use]
    pub fn items(&self, band: usize) -> &[Entry] {
        &self.entries[self.starts[band] as usize..self.starts[band + 1] as usize]
    }

    /// Triangles drawn with masks that can touch the target.
    #[must_use]
    pub fn masked(&self) -> u64 {
        self.masked
    }
}

/// The bands that an item can touch.
#[inline(always)]
fn bands(entry: &Entry) -> std::ops::Range<usize> {
    usize::from(entry.from[1]) / LINES..(usize::from(entry.to[1]) - 1) / LINES + 1
}

/// The nearest and the farthest depth of an item's vertices.
#[inline(always)]
fn range(item: &Item) -> [i32; 2] {
    let [a, b, c] = &item.vertices;
    [a.z.min(b.z).min(c.z) as i32, a.z.max(b.z).max(c.z) as i32]
}
