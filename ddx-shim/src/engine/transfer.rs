//! Pixels from the server's memory into a pixmap, without its renderer.

use zga_driver::Rectangle;

use super::Engine;
use super::draw::image;
use super::pixmaps::Place;

/// Most bytes that go through the ring: they are copied twice on that way, which costs less than to wait for the card as
/// long as they are few.
const MOST_QUEUED: usize = 1 << 16;

impl Engine {
    /// Writes `height` rows of `width` bytes, which stand `stride` bytes apart in `rows`, from byte `x` of row `y` of a pixmap
    /// on: as a packet if the card still works on the pixmap and the bytes are few, else in place when it is done with it.
    /// False: the server's renderer has to do it.
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
        if self.queue_upload(pixmap, (x, y), (width, height), rows, stride) {
            return true;
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

    /// Writes the rows by a packet, behind what the card has to do with the pixmap. False: it is not worth it, or cannot be.
    fn queue_upload(
        &mut self,
        number: usize,
        (x, y): (u32, u32),
        (width, height): (u32, u32),
        rows: &[u8],
        stride: usize,
    ) -> bool {
        let bytes = u64::from(width) * u64::from(height);
        if !self.draws || bytes > MOST_QUEUED as u64 || self.is_idle() && !self.batches.pending() {
            return false;
        }
        let Some(pixmap) = self.pixmaps.get(number).filter(|pixmap| !self.batches.is_done(pixmap.batch)) else {
            return false;
        };
        let Some(onto) = image(&self.frame, pixmap) else { return false };
        let pixel = onto.format().bytes();
        if !x.is_multiple_of(4) || !width.is_multiple_of(4) {
            return false;
        }
        let rectangle = Rectangle { x: x / pixel, y, right: (x + width) / pixel, bottom: y + height };
        let written = self.driver.upload(onto, rectangle, rows, stride);
        self.drawn(written, &[number], bytes / u64::from(pixel))
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
