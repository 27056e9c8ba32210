//! Stretch: a rectangle over a whole of another size, of which a part is written; nearest pixel or bilinear.
//!
//! Duties and clocks: see [`super`]; 1 clock for each line read, 1 for each pixel made and 1 for each line written. The
//! unit has two line buffers, which hold rows of the source: each row that is needed is read once, from the first pixel
//! needed of it to the last, since rows are needed in rising order, at most two at a time; a row that weighs 0 is needed,
//! too. A buffer has two banks, even and odd columns, so the four pixels of a bilinear one come in the same clock as a
//! nearest one. The buffers have one port: they are filled, then read, so making a pixel does not hide behind memory as
//! other work does.
//! Inputs: [`Stretch`] from the firmware. Outputs: pixels. Specification: [`super::specification`].
//!
//! # Where a pixel is taken from
//! The source, S pixels along an axis, is stretched over the whole, D pixels. The centre of pixel i of the whole stands
//! at u = floor((2 i + 1) * S * 2^15 / D) of the source, 16.16, whose pixel k reaches from k to k + 1.
//! Nearest: pixel u >> 16. Bilinear: with t = u - 0x8000, pixels t >> 16 and the one behind it, both clamped to the
//! source, with weights 256 - f and f, f = (t >> 8) & 255. A channel is the sum of four pixels weighed by column and by
//! row, + 2^15, >> 16. Channels are taken as they are stored: alpha multiplies nothing, so that colours multiplied by
//! alpha already come out right.
//!
//! # The fast way
//! Four channels of 8 bits lie in the 16-bit fields of a 64-bit word; a sum of two pixels weighed by column has at most
//! 255 * 256 and fits. Such rows are what is kept of the source. Weighed by row, two fields at a time have 32 bits each.

use super::convert::{read_line, write_line};
use super::{Bitmap, Span, charge, specification};
use crate::memory::lines;
use crate::probe::account::Account;
use zga_abi::Counter;
use zga_abi::format::StretchFilter;
use zga_firmware::checked::{Image, Stretch};

/// Where a pixel is taken from along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tap {
    /// The pixel that weighs 256 - `fraction`.
    pub(super) first: u32,
    /// The pixel that weighs `fraction`; not before the first.
    pub(super) second: u32,
    /// 0..=255, in 1/256.
    pub(super) fraction: u32,
}

/// Where pixel `place` of `whole` is taken from when `source` pixels are stretched over them.
pub(super) fn tap(place: u32, source: u32, whole: u32, filter: StretchFilter) -> Tap {
    // Below 2^15 * 2^14 * 2^15; the quotient is below source * 2^16, so at most 30 bits.
    let centre = ((2 * u64::from(place) + 1) * (u64::from(source) << 15) / u64::from(whole)) as i32;
    match filter {
        StretchFilter::Nearest => {
            let pixel = (centre >> 16) as u32;
            Tap { first: pixel, second: pixel, fraction: 0 }
        }
        StretchFilter::Bilinear => {
            let left = centre - 0x8000;
            let clamped = |pixel: i32| pixel.clamp(0, source as i32 - 1) as u32;
            let first = left >> 16;
            Tap { first: clamped(first), second: clamped(first + 1), fraction: ((left >> 8) & 255) as u32 }
        }
    }
}

/// What the stretch keeps between rows.
#[derive(Debug, Default)]
pub(super) struct LineBuffers {
    /// Where each column is taken from, counted from the first column that is read.
    columns: Vec<Tap>,
    /// A row of the source, ARGB8888.
    read: Vec<u32>,
    /// The row to be written, ARGB8888.
    made: Vec<u32>,
    /// Two rows of the source as wide as what is written, and which they are.
    rows: [(Option<u32>, Vec<u64>); 2],
}

/// The pixels of a source that a stretch needs.
struct Needed {
    /// First column, and number of columns.
    columns: [u32; 2],
    /// Lines of all rows that are needed.
    lines: u64,
}

/// The columns and lines that a stretch reads.
fn needed(stretch: &Stretch) -> Needed {
    let Stretch { source, destination, whole: [width, height], part: [left, top], filter } = *stretch;
    let first = tap(left, source.width, width, filter).first;
    let columns = tap(left + destination.width - 1, source.width, width, filter).second + 1 - first;
    let bytes = u64::from(source.format.bytes());
    let (mut all, mut below) = (0, 0);
    for y in 0..destination.height {
        let down = tap(top + y, source.height, height, filter);
        // Rows rise, and the second is the first or the next: each is met for the first time at the end.
        for row in down.first.max(below)..=down.second {
            all += lines(pixel_address(&source, first, row), u64::from(columns) * bytes);
            below = row + 1;
        }
    }
    Needed { columns: [first, columns], lines: all }
}

/// Byte address of a pixel.
fn pixel_address(image: &Image, x: u32, y: u32) -> u64 {
    image.row(u64::from(y)).start + u64::from(x) * u64::from(image.format.bytes())
}

impl Bitmap {
    /// Stretches a rectangle to another size.
    pub(crate) fn stretch(&mut self, memory: &mut [u32], stretch: &Stretch, account: &mut Account) {
        let needed = needed(stretch);
        if self.specification {
            specification::stretch(memory, stretch);
        } else {
            self.buffers.stretch(memory, stretch, needed.columns);
        }
        let pixels = u64::from(stretch.destination.width) * u64::from(stretch.destination.height);
        account.add(Counter::BitmapStretched, pixels);
        charge(account, pixels, needed.lines + pixels + Span::of(&stretch.destination).lines());
    }
}

impl LineBuffers {
    fn stretch(&mut self, memory: &mut [u32], stretch: &Stretch, [first, count]: [u32; 2]) {
        let Stretch { source, destination, whole: [width, height], part: [left, top], filter } = *stretch;
        self.columns.clear();
        self.columns.extend((left..left + destination.width).map(|x| {
            let Tap { first: one, second: other, fraction } = tap(x, source.width, width, filter);
            Tap { first: one - first, second: other - first, fraction }
        }));
        self.read.resize(count as usize, 0);
        self.made.resize(destination.width as usize, 0);
        self.rows.iter_mut().for_each(|(row, _)| *row = None);
        let mut last = None;
        for y in 0..destination.height {
            let down = tap(top + y, source.height, height, filter);
            match filter {
                StretchFilter::Nearest if last == Some(down.first) => {}
                StretchFilter::Nearest => {
                    read_line(memory, pixel_address(&source, first, down.first), source.format, &mut self.read);
                    for (made, column) in self.made.iter_mut().zip(&self.columns) {
                        *made = self.read[column.first as usize];
                    }
                }
                StretchFilter::Bilinear => {
                    if self.rows[1].0 == Some(down.first) {
                        self.rows.swap(0, 1);
                    }
                    for (place, row) in [down.first, down.second].into_iter().enumerate() {
                        if self.rows[place].0 != Some(row) {
                            read_line(memory, pixel_address(&source, first, row), source.format, &mut self.read);
                            self.weigh_columns(place);
                            self.rows[place].0 = Some(row);
                        }
                    }
                    self.weigh_rows(down.fraction);
                }
            }
            last = Some(down.first);
            write_line(memory, destination.row(u64::from(y)).start, destination.format, &self.made);
        }
    }

    /// Puts the row that was read into a buffer, weighed by column.
    fn weigh_columns(&mut self, place: usize) {
        let row = &mut self.rows[place].1;
        row.clear();
        row.extend(self.columns.iter().map(|column| {
            let [first, second] = [column.first, column.second].map(|x| spread(self.read[x as usize]));
            let fraction = u64::from(column.fraction);
            first * (256 - fraction) + second * fraction
        }));
    }

    /// Makes a row of both buffers.
    fn weigh_rows(&mut self, fraction: u32) {
        let (above, below) = (256 - u64::from(fraction), u64::from(fraction));
        let [(_, first), (_, second)] = &self.rows;
        for ((made, &first), &second) in self.made.iter_mut().zip(first).zip(second) {
            // Red and blue, or alpha and green, in 32 bits each.
            let mean = |shift: u32| {
                let [first, second] = [first, second].map(|fields| (fields >> shift) & 0x0000_FFFF_0000_FFFF);
                let sum = first * above + second * below + 0x0000_8000_0000_8000;
                let low = (sum >> 16) as u32 & 0xFF;
                let high = (sum >> 48) as u32 & 0xFF;
                (high << 16) | low
            };
            *made = mean(0) | (mean(16) << 8);
        }
    }
}

/// The channels of an ARGB8888 word in the 16-bit fields of a 64-bit one.
const fn spread(argb: u32) -> u64 {
    let pairs = (argb as u64 | ((argb as u64) << 16)) & 0x0000_FFFF_0000_FFFF;
    (pairs | (pairs << 8)) & 0x00FF_00FF_00FF_00FF
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tap_of_equal_sizes_is_the_pixel_itself() {
        for filter in [StretchFilter::Nearest, StretchFilter::Bilinear] {
            for place in [0, 1, 7, 16383] {
                let tap = tap(place, 16384, 16384, filter);
                assert_eq!((tap.first, tap.fraction), (place, 0), "{filter:?}");
            }
        }
    }

    #[test]
    fn tap_at_the_ends_stays_in_the_source() {
        for (source, whole) in [(1, 16384), (16384, 1), (16384, 16383), (3, 7), (16383, 16384)] {
            for place in [0, whole - 1] {
                for filter in [StretchFilter::Nearest, StretchFilter::Bilinear] {
                    let tap = tap(place, source, whole, filter);
                    assert!(tap.first <= tap.second && tap.second < source && tap.fraction < 256, "{tap:?}");
                }
            }
        }
    }

    #[test]
    fn tap_doubled_weighs_a_quarter_and_three() {
        let taps = [0, 1, 2, 3].map(|place| tap(place, 2, 4, StretchFilter::Bilinear));
        let expected = [(0, 0, 192), (0, 1, 64), (0, 1, 192), (1, 1, 64)];
        assert_eq!(taps.map(|tap| (tap.first, tap.second, tap.fraction)), expected);
    }

    #[test]
    fn spread_puts_each_channel_into_a_field() {
        assert_eq!(spread(0x1234_5678), 0x0012_0034_0056_0078);
        assert_eq!(spread(u32::MAX), 0x00FF_00FF_00FF_00FF);
    }
}
