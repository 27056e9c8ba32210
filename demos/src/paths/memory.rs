//! What a path moves to and from memory and what it keeps on the chip, from the card's counters.
//!
//! Words are of 32 bits. Of each frame are counted:
//!
//! | words read | formula |
//! | --- | --- |
//! | depths | `z.reads` |
//! | Za words | `za.blocks_initialised + za.blocks_bypassed + za.blocks_compared`: each visit reads one |
//! | scan-out | pixels of the picture; those of cleared Za blocks come from the background register |
//!
//! | words written | formula |
//! | --- | --- |
//! | depths | `z.writes` |
//! | colours | `colour.writes` |
//! | Za words | `za.words_written` |
//!
//! The sub-pixel unit works behind each path, on the same fragments, in a pool of its own. The most bytes that the
//! lists of a line took are told beside the path's storage, and its clocks with those of the other units; the words
//! that it moves in its pool are not counted. Packets and vertices are the same on all paths and stand beside them
//! once. The tile unit's sort memory is its own: its size is told, and `tile.links_walked` is its traffic.
//!
//! | on the chip | bits |
//! | --- | --- |
//! | za | 32 a block of the picture |
//! | systolic | register bits of an element (ours, with the clamp) times the pixels of a row |
//! | tile | comparators, parameter buffer and both banks of the colour buffer |

use zga_abi::Counter;
use zga_abi::format::HiddenSurface;
use zga_device::cost::{systolic, tile};
use zga_driver::Counters;

use crate::play::{Settings, ZaWords};

/// Bits of a word.
const WORD_BITS: u32 = 32;

/// Words that a frame moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// Depths read.
    pub depths_read: u64,
    /// Za words read.
    pub za_read: u64,
    /// Colours read by scan-out, once a frame.
    pub scan_out_read: u64,
    /// Depths written.
    pub depths_written: u64,
    /// Colours written.
    pub colours_written: u64,
    /// Za words written.
    pub za_written: u64,
}

impl Words {
    /// The words of a frame of `size` pixels; `za`: its Za words, where it has some.
    #[must_use]
    pub fn new(counters: &Counters, size: [u32; 2], za: Option<&ZaWords>) -> Self {
        let get = |counter| counters.get(counter);
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        Self {
            depths_read: get(Counter::ZReads),
            za_read: get(Counter::ZaBlocksInitialised)
                + get(Counter::ZaBlocksBypassed)
                + get(Counter::ZaBlocksCompared),
            scan_out_read: pixels - za.map_or(0, |words| words.cleared_pixels(size)).min(pixels),
            depths_written: get(Counter::ZWrites),
            colours_written: get(Counter::ColourWrites),
            za_written: get(Counter::ZaWordsWritten),
        }
    }

    /// All words read.
    #[must_use]
    pub const fn read(&self) -> u64 {
        self.depths_read + self.za_read + self.scan_out_read
    }

    /// All words written.
    #[must_use]
    pub const fn written(&self) -> u64 {
        self.depths_written + self.colours_written + self.za_written
    }
}

/// Where a path keeps what it knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Storage {
    /// Parts on the chip by name, bits.
    pub on_chip: [(&'static str, u64); 3],
    /// Z buffer in memory, bytes; 0 where the path needs none.
    pub z_buffer_bytes: u64,
    /// Sort memory of the tile unit, bytes.
    pub sort_memory_bytes: u64,
    /// Most bytes that the lists of a line took in the sub-pixel unit's pool; 0 without a grid of samples.
    pub subpixel_pool_bytes: u64,
}

impl Storage {
    /// Storage of a path for a picture of `size` pixels and a scene that ends without anybody reading its depths.
    #[must_use]
    pub fn new(settings: &Settings, size: [u32; 2], counters: &Counters) -> Self {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let z_buffer_bytes = 4 * pixels;
        let none = ("", 0);
        let subpixel_pool_bytes = counters.get(Counter::SubpixelPoolPeakBytes);
        let plain = Self { on_chip: [none; 3], subpixel_pool_bytes, ..Self::default() };
        match settings.hidden_surface {
            HiddenSurface::ZBuffer => Self { z_buffer_bytes, ..plain },
            HiddenSurface::Za => {
                let bits = 8 * settings.za.frame_bytes(size[0], size[1]);
                Self { on_chip: [("za_ram", bits), none, none], z_buffer_bytes, ..plain }
            }
            HiddenSurface::Systolic => {
                let bits = element(settings, size[0]).register_bits * u64::from(size[0]);
                Self { on_chip: [("element_registers", bits), none, none], ..plain }
            }
            HiddenSurface::Tile => {
                let unit = tile::Storage::of(settings.tile_size, settings.depth.bits(), false);
                let on_chip = [
                    ("comparators", unit.register_bits()),
                    ("parameter_buffer", 8 * unit.parameter_bytes),
                    ("colour_buffer", 8 * unit.colour_bytes),
                ];
                let sort_memory_bytes = counters.get(Counter::TileSortMemoryBytes);
                Self { on_chip, sort_memory_bytes, ..plain }
            }
        }
    }

    /// All bits on the chip.
    #[must_use]
    pub fn on_chip_bits(&self) -> u64 {
        self.on_chip.iter().map(|(_, bits)| bits).sum()
    }
}

/// One element of the array that is set up, for rows of `width` pixels.
#[must_use]
pub fn element(settings: &Settings, width: u32) -> systolic::Cost {
    let variant = if settings.systolic.super_buffer {
        systolic::Variant::SuperBuffer
    } else {
        systolic::Variant::Ours(settings.systolic.ports, settings.systolic.end_test)
    };
    systolic::element(variant, &widths(settings, width))
}

/// Widths of the array's registers. A tag takes a word as a colour does.
fn widths(settings: &Settings, width: u32) -> systolic::Widths {
    let coordinate = width.next_power_of_two().ilog2().max(1);
    let (depth, fraction) = (settings.depth.bits(), settings.depth.fraction());
    systolic::Widths { depth, fraction, coordinate, colour: WORD_BITS }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::tests::settings;
    use zga_driver::ZaSettings;

    fn storage(path: HiddenSurface, size: [u32; 2]) -> Storage {
        let za = ZaSettings { block: [8, 8], ..ZaSettings::default() };
        let settings = Settings { hidden_surface: path, za, ..settings() };
        Storage::new(&settings, size, &Counters::default())
    }

    #[test]
    fn storage_za_is_a_word_a_block_and_a_z_buffer() {
        let found = storage(HiddenSurface::Za, [20, 9]);
        assert_eq!((found.on_chip_bits(), found.z_buffer_bytes), (3 * 2 * 32, 4 * 20 * 9));
    }

    #[test]
    fn storage_systolic_grows_with_the_row_and_tile_does_not() {
        let [narrow, wide] = [64, 128].map(|width| storage(HiddenSurface::Systolic, [width, 64]).on_chip_bits());
        assert_eq!(wide, 2 * narrow, "a coordinate of one bit more fits into a register for depths");
        let [narrow, wide] = [64, 128].map(|width| storage(HiddenSurface::Tile, [width, 64]).on_chip_bits());
        assert_eq!(narrow, wide);
        assert_eq!(storage(HiddenSurface::Tile, [64, 64]).z_buffer_bytes, 0);
    }

    #[test]
    fn words_scan_out_leaves_cleared_blocks_out() {
        let za = ZaWords { block: [8, 8], blocks: [2, 1], words: vec![-1, 7] };
        let words = Words::new(&Counters::default(), [12, 8], Some(&za));
        assert_eq!((words.read(), words.written()), (12 * 8 - 64, 0));
    }
}
