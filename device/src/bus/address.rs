//! Address decoder: which block of the card answers at an address.
//!
//! Duties: splits the address map of [`zga_abi::bus`] into apertures.
//! Inputs: byte addresses from the bus. Outputs: an [`Aperture`] and how far it reaches.
//! Clocks: none; decoding is part of the bus cycle, which is not device time.

use zga_abi::bus::{
    FIFO_BASE, FIFO_BYTES, MEMORY_BASE, MEMORY_BYTES, REGISTERS_BASE, REGISTERS_BYTES, ZA_BASE, ZA_BYTES,
};

/// What answers at an aligned address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aperture {
    /// Register file: byte offset.
    Registers(u32),
    /// PIO FIFO window.
    Fifo,
    /// Za RAM: word index.
    Za(usize),
    /// Video memory: word index.
    Memory(usize),
    /// Nothing.
    Nothing,
}

/// The aperture at byte `address`, and the words from there to its end.
pub(crate) fn decode(address: u32) -> (Aperture, usize) {
    let within = |base: u32, bytes: u32| {
        let offset = address.wrapping_sub(base);
        (offset < bytes).then(|| (offset, ((bytes - offset) / 4).max(1) as usize))
    };
    if let Some((offset, words)) = within(MEMORY_BASE, MEMORY_BYTES) {
        (Aperture::Memory((offset / 4) as usize), words)
    } else if let Some((_, words)) = within(FIFO_BASE, FIFO_BYTES) {
        (Aperture::Fifo, words)
    } else if let Some((offset, words)) = within(REGISTERS_BASE, REGISTERS_BYTES) {
        (Aperture::Registers(offset), words)
    } else if let Some((offset, words)) = within(ZA_BASE, ZA_BYTES) {
        (Aperture::Za((offset / 4) as usize), words)
    } else {
        (Aperture::Nothing, 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decode_edges_belong_to_one_aperture() {
        assert_eq!(decode(0x0000_0000), (Aperture::Registers(0), 0x2000));
        assert_eq!(decode(0x0000_7FFC), (Aperture::Registers(0x7FFC), 1));
        assert_eq!(decode(0x0000_8000), (Aperture::Fifo, 1024));
        assert_eq!(decode(0x0000_8FFC), (Aperture::Fifo, 1));
        assert_eq!(decode(0x0000_9000).0, Aperture::Nothing);
        assert_eq!(decode(0x01FF_FFFC).0, Aperture::Nothing);
        assert_eq!(decode(0x0200_0000), (Aperture::Za(0), 0x80_0000));
        assert_eq!(decode(0x0400_0000).0, Aperture::Nothing);
        assert_eq!(decode(0x3FFF_FFFC).0, Aperture::Nothing);
        assert_eq!(decode(0x4000_0000), (Aperture::Memory(0), 0x1000_0000));
        assert_eq!(decode(0x7FFF_FFFC), (Aperture::Memory(0x0FFF_FFFF), 1));
        assert_eq!(decode(0x8000_0000).0, Aperture::Nothing);
        assert_eq!(decode(0xFFFF_FFFC).0, Aperture::Nothing);
    }
}
