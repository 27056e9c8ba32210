//! The target as others see it: scan-out, the bitmap unit, and a host that looks at raw memory.

use super::options::Pixels;
use super::packet;
use super::screen::Screen;
use zga_abi::Bus;

impl Screen {
    /// The frame as scan-out composes it: XRGB8888, row by row. In mid-scene too.
    pub fn shown(&mut self) -> Vec<u32> {
        self.shown_frame(self.places.colour)
    }

    /// The frame that is not drawn to, as scan-out composes it; the only one where there is but one.
    pub fn other_shown(&mut self) -> Vec<u32> {
        let [first, second] = self.places.colours;
        self.shown_frame(if self.places.colour == first { second } else { first })
    }

    fn shown_frame(&mut self, base: u32) -> Vec<u32> {
        let size = self.height << 16 | self.width;
        let scratch = self.places.scratch;
        self.push(packet::registers(
            packet::SCANOUT,
            &[base, self.places.colour_pitch, self.options.pixels as u32, size],
        ));
        self.push(packet::write_back(scratch));
        self.fetch(scratch, self.width * self.height)
    }

    /// The Z buffer, row by row, as the bitmap unit reads it: blocks cleared in Za RAM come to memory.
    pub fn depths(&mut self) -> Vec<u32> {
        let scratch = self.places.scratch;
        self.push(packet::download(self.places.depth, self.places.depth_pitch, self.width, self.height, scratch));
        self.fetch(scratch, self.width * self.height)
    }

    /// Has the bitmap unit read a word of the frame and of the Z buffer: what is cleared in Za RAM comes to memory.
    pub fn settle(&mut self) {
        for at in [self.places.colour, self.places.depth] {
            self.push(packet::download(at, 4, 1, 1, self.places.scratch));
        }
    }

    fn fetch(&mut self, at: u32, words: u32) -> Vec<u32> {
        self.flush();
        let mut fetched = vec![0; words as usize];
        self.bus.read_burst(packet::MEMORY + at, &mut fetched);
        fetched
    }

    /// Fills a rectangle (x, y, width, height) of the frame with a stored pixel.
    pub fn fill(&mut self, area: [u32; 4], value: u32) {
        let (base, pitch) = (self.places.colour, self.places.colour_pitch);
        self.push(packet::fill(base, pitch, self.options.pixels as u32, area, value));
    }

    /// Fills a rectangle (x, y, width, height) of the Z buffer.
    pub fn fill_depth(&mut self, area: [u32; 4], value: u32) {
        let (base, pitch) = (self.places.depth, self.places.depth_pitch);
        self.push(packet::fill(base, pitch, Pixels::Xrgb8888 as u32, area, value));
    }

    /// Copies a rectangle (x, y, width, height) of the frame to another place in it.
    pub fn copy(&mut self, area: [u32; 4], to: [u32; 2]) {
        let (base, pitch) = (self.places.colour, self.places.colour_pitch);
        self.push(packet::copy(base, pitch, self.options.pixels as u32, area, to));
    }

    /// Uploads words to the start of a row of the frame.
    pub fn upload(&mut self, row: u32, words: &[u32]) {
        self.push(packet::upload(self.places.colour + row * self.places.colour_pitch, words));
    }

    /// Uploads depths to the start of a row of the Z buffer.
    pub fn upload_depths(&mut self, row: u32, words: &[u32]) {
        self.push(packet::upload(self.places.depth + row * self.places.depth_pitch, words));
    }

    /// The words of the frame drawn to in Za RAM.
    pub fn za_words(&mut self) -> Vec<i32> {
        self.flush();
        let hidden = self.hidden();
        let mut words = vec![0; hidden.za_words(self.width, self.height) as usize];
        self.bus.read_burst(packet::ZA + hidden.base, &mut words);
        words.into_iter().map(|word| word as i32).collect()
    }

    /// Compares the words with the Z buffer's memory: how many blocks are not cleared, and where the first of them has
    /// another word than the maximum of its pixels' depths.
    pub fn za_check(&mut self) -> (usize, Option<String>) {
        let (words, depths) = (self.za_words(), self.raw_depths());
        let ([across_pixels, down_pixels], width) = (self.options.hidden.block, self.width);
        let across = width.div_ceil(across_pixels);
        let (mut initialised, mut first) = (0, None);
        for (number, &word) in (0..).zip(&words).filter(|(_, word)| **word >= 0) {
            let (left, top) = (number % across * across_pixels, number / across * down_pixels);
            let (right, bottom) = ((left + across_pixels).min(width), (top + down_pixels).min(self.height));
            let rows = (top..bottom).flat_map(|y| &depths[(y * width + left) as usize..(y * width + right) as usize]);
            let greatest = rows.copied().max().unwrap_or(0);
            initialised += 1;
            if first.is_none() && word as u32 != greatest {
                first = Some(format!("block at ({left}, {top}): word {word}, greatest depth {greatest}"));
            }
        }
        (initialised, first)
    }

    /// The Z buffer's memory as it is, row by row.
    pub fn raw_depths(&mut self) -> Vec<u32> {
        self.flush();
        let mut depths = Vec::with_capacity((self.width * self.height) as usize);
        let mut row = vec![0; self.width as usize];
        for j in 0..self.height {
            self.bus.read_burst(packet::MEMORY + self.places.depth + j * self.places.depth_pitch, &mut row);
            depths.extend(&row);
        }
        depths
    }

    /// The frame's memory as it is, pixel by pixel.
    pub fn raw_pixels(&mut self) -> Vec<u32> {
        self.flush();
        let bytes = self.options.pixels.bytes();
        let mut row = vec![0; (self.width * bytes).div_ceil(4) as usize];
        let mut pixels = Vec::with_capacity((self.width * self.height) as usize);
        for j in 0..self.height {
            self.bus.read_burst(packet::MEMORY + self.places.colour + j * self.places.colour_pitch, &mut row);
            let of_word = |word: u32, half: u32| if bytes == 4 { word } else { word >> (16 * half) & 0xFFFF };
            pixels.extend((0..self.width).map(|x| of_word(row[(x * bytes / 4) as usize], x % 2)));
        }
        pixels
    }

    /// A host that writes over the memory of pixels: colour and depth, as they are stored. `garbage` says for column and
    /// row whether.
    pub fn garble(&mut self, mut garbage: impl FnMut(u32, u32) -> Option<[u32; 2]>) {
        let bytes = self.options.pixels.bytes();
        let mut pixels = self.raw_pixels();
        let mut depths = self.raw_depths();
        for j in 0..self.height {
            let row = (j * self.width) as usize;
            let mut touched = false;
            for i in 0..self.width {
                if let Some([pixel, depth]) = garbage(i, j) {
                    (pixels[row + i as usize], depths[row + i as usize]) = (pixel, depth);
                    touched = true;
                }
            }
            if touched {
                let end = row + self.width as usize;
                let at = packet::MEMORY + self.places.colour + j * self.places.colour_pitch;
                if bytes == 4 {
                    self.bus.write_burst(at, &pixels[row..end]);
                } else {
                    let mut words = vec![0; (2 * self.width).div_ceil(4) as usize];
                    self.bus.read_burst(at, &mut words);
                    for (word, pair) in words.iter_mut().zip(pixels[row..end].chunks(2)) {
                        let high = pair.get(1).map_or(*word >> 16, |pixel| pixel & 0xFFFF);
                        *word = pair[0] & 0xFFFF | high << 16;
                    }
                    self.bus.write_burst(at, &words);
                }
                let at = packet::MEMORY + self.places.depth + j * self.places.depth_pitch;
                self.bus.write_burst(at, &depths[row..end]);
            }
        }
    }

    /// Pixel history: has the card record what comes to a pixel from now on.
    pub fn probe(&mut self, pixel: [u32; 2], records: u32) {
        let [x, y] = pixel;
        self.push(packet::registers(packet::PROBE, &[1, y << 16 | x, self.places.vertices, records]));
    }

    /// The words of the records so far, 8 a fragment.
    pub fn probe_records(&mut self, records: u32) -> Vec<u32> {
        self.flush();
        let count = self.bus.read32(packet::PROBE + 16).min(records);
        self.fetch(self.places.vertices, 8 * count)
    }
}
