//! Packets in a run of words: where each begins, and what its words are called.

use zga_abi::packet::{Opcode, payload_words};
use zga_abi::registers::Reg;

/// A packet in a run of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Packet<'a> {
    /// Place of the header in the run.
    pub start: usize,
    /// Header and payload; cut short if the run ends before.
    pub words: &'a [u32],
}

impl Packet<'_> {
    /// The opcode, if it is a known one.
    pub fn opcode(&self) -> Option<Opcode> {
        Opcode::from_code(self.words.first()? >> 24)
    }

    /// Whether it is only valid in a scene.
    pub fn needs_scene(&self) -> bool {
        matches!(self.opcode(), Some(Opcode::Clear | Opcode::DrawInline | Opcode::DrawBuffer | Opcode::EndScene))
    }
}

/// The packets of a run, first to last.
pub(crate) fn packets(words: &[u32]) -> impl Iterator<Item = Packet<'_>> {
    let mut start = 0;
    std::iter::from_fn(move || {
        let header = *words.get(start)?;
        let end = (start + 1 + payload_words(header) as usize).min(words.len());
        let packet = Packet { start, words: &words[start..end] };
        start = end;
        Some(packet)
    })
}

/// What word `word` of a packet is called in the manual; for register writes, the register.
pub(crate) fn field_name(packet: &[u32], word: u32) -> String {
    let Some(opcode) = packet.first().and_then(|header| Opcode::from_code(header >> 24)) else {
        return "header".to_owned();
    };
    if word == 0 {
        return "header".to_owned();
    }
    if opcode == Opcode::RegisterWrite && word >= 2 {
        let offset = packet.get(1).copied().unwrap_or(0).wrapping_add((word - 2).wrapping_mul(4));
        return Reg::at(offset).map_or_else(|| format!("offset {offset:#06x}"), |(reg, _)| reg.info().name.to_owned());
    }
    let names: Vec<&str> = opcode.payload().split(", ").collect();
    let place = (word as usize - 1).min(names.len().saturating_sub(1));
    names.get(place).copied().filter(|name| !name.is_empty()).unwrap_or("payload").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_run_gives_each_with_its_place() {
        let words = [0x0200_0000, 0x0100_0002, 0x288, 5, 0x3000_0001, 9];
        let starts: Vec<usize> = packets(&words).map(|packet| packet.start).collect();
        assert_eq!(starts, [0, 1, 4]);
    }

    #[test]
    fn packets_cut_short_ends_with_the_run() {
        let words = [0x0400_0003, 1];
        assert_eq!(packets(&words).map(|packet| packet.words.len()).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn field_name_of_known_words_is_the_manual_s() {
        assert_eq!(field_name(&[0x0400_0003, 1, 2, 3], 3), "depth");
        assert_eq!(field_name(&[0x0100_0003, 0x284, 0, 0], 3), "MATERIAL_COLOUR");
        assert_eq!(field_name(&[0x0100_0002, 0x2F0, 0], 2), "offset 0x02f0");
        assert_eq!(field_name(&[0x7F00_0000], 0), "header");
    }
}
