//! Items sorted into bands of lines.

use super::band::LINES;
use super::piece::extent;
use super::scene::{Item, Scene};

/// Items by the bands that they can touch.
#[derive(Debug, Default)]
pub struct Bands {
    numbers: Vec<u32>,
    starts: Vec<u32>,
}

impl Bands {
    /// Puts the items of a scene into bands.
    pub fn fill(&mut self, scene: &Scene, height: u32) {
        let count = (height as usize).div_ceil(LINES);
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        let bands = |item: &Item| {
            let [[left, first], [right, beyond]] = extent(item, &scene.draws[item.draw as usize]);
            if left < right && first < beyond {
                first as usize / LINES..(beyond as usize - 1) / LINES + 1
            } else {
                0..0
            }
        };
        for item in &scene.items {
            for band in bands(item) {
                self.starts[band + 1] += 1;
            }
        }
        for band in 0..count {
            self.starts[band + 1] += self.starts[band];
        }
        self.numbers.clear();
        self.numbers.resize(self.starts[count] as usize, 0);
        let mut next = self.starts.clone();
        for (number, item) in scene.items.iter().enumerate() {
            for band in bands(item) {
                self.numbers[next[band] as usize] = number as u32;
                next[band] += 1;
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
    pub fn items(&self, band: usize) -> &[u32] {
        &self.numbers[self.starts[band] as usize..self.starts[band + 1] as usize]
    }
}
