//! Pixels from the server's memory into a pixmap, without its renderer.

use super::Engine;
use super::pixmaps::Place;

impl Engine {
    /// Writes `height` rows of `width` bytes, which stand `stride` bytes apart in `rows`, from byte `x` of row `y` of a pixmap
    /// on. Waits for the card to be done with the pixmap. False: the server's renderer has to do it.
    pub fn upload(
        &mut self,
        pixmap: usize,
        (x, y): (u32, u32),
        (width, height): (u32, u32),
        rows: &[u8],
        stride: usize,
    ) -> bool {
        if self.accesses > 0 || width == 0 || height == 0 {
            return false;
        }
        let Some(entry) = self.pixmaps.get_mut(pixmap) else { return false };
        let (pitch, batch) = (entry.pitch as usize, entry.batch);
        let (start, width, height) = (y as usize * pitch + x as usize, width as usize, height as usize);
        let first = match &mut entry.place {
            Place::Frame => self.frame.memory().address(),
            Place::Card(image) => image.memory().address(),
            Place::Spilled(words) => {
                write(bytemuck::cast_slice_mut(words), start, pitch, (width, height), rows, stride);
                return true;
            }
            Place::Nothing | Place::Host(_) | Place::Foreign => return false,
        };
        self.wait_for(batch);
        let mut mapping = self.card.map();
        let words = mapping.get_mut(first as usize / 4..).unwrap_or_default();
        write(bytemuck::cast_slice_mut(words), start, pitch, (width, height), rows, stride);
        true
    }
}

/// Copies rows from where they stand `stride` bytes apart to where they stand `pitch` bytes apart.
fn write(onto: &mut [u8], start: usize, pitch: usize, (width, height): (usize, usize), rows: &[u8], stride: usize) {
    let places = (start..).step_by(pitch.max(1)).zip((0..).step_by(stride.max(1)));
    for (to, from) in places.take(height) {
        if let (Some(to), Some(from)) = (onto.get_mut(to..to + width), rows.get(from..from + width)) {
            to.copy_from_slice(from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn write_rows_to_their_places_and_nowhere_else() {
        let mut onto = [0; 12];
        write(&mut onto, 5, 4, (2, 2), &[1, 2, 9, 3, 4], 3);
        assert_eq!(onto, [0, 0, 0, 0, 0, 1, 2, 0, 0, 3, 4, 0]);
    }

    #[test]
    fn write_rows_beyond_the_end_are_left_out() {
        let mut onto = [0; 4];
        write(&mut onto, 1, 2, (2, 3), &[1, 2, 3, 4, 5, 6], 2);
        assert_eq!(onto, [0, 1, 2, 0]);
    }
}
