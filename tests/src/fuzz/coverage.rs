//! Coverage: how often each packet was executed, each fault seen, each unit reached.
//!
//! A fuzzer that is refused at the door finds nothing. These counts tell how deep it came: they are
//! taken from the card's own registers and counters, and from the packets up to where it stopped.

use std::fmt;
use zga_abi::packet::Opcode;
use zga_abi::{Bus, Counter, FaultCode, Reg};
use zga_firmware::Processor;

/// A draw of more primitives than this may be cut into batches.
const ONE_BATCH: u32 = 4000;

/// Counts of one run or of many.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// Packets executed, in the order of [`Opcode::ALL`].
    pub opcodes: [u64; Opcode::ALL.len()],
    /// Draws executed, in the order of the topologies.
    pub topologies: [u64; 4],
    /// First faults seen, in the order of [`FaultCode::ALL`].
    pub faults: [u64; FaultCode::ALL.len()],
    /// The card's counters, summed.
    pub counters: [u64; Counter::COUNT],
    /// Snapshots restored.
    pub restores: u64,
    /// Snapshots refused.
    pub restores_refused: u64,
    /// A packet turned continuous scan-out on.
    pub clock: bool,
}

impl Default for Coverage {
    /// Nothing counted. By hand, as the standard library knows defaults of short arrays only.
    fn default() -> Self {
        Coverage {
            opcodes: [0; Opcode::ALL.len()],
            topologies: [0; 4],
            faults: [0; FaultCode::ALL.len()],
            counters: [0; Counter::COUNT],
            restores: 0,
            restores_refused: 0,
            clock: false,
        }
    }
}

impl Coverage {
    /// Adds another run's counts.
    pub fn add(&mut self, other: &Coverage) {
        let sum = |mine: &mut [u64], others: &[u64]| {
            mine.iter_mut().zip(others).for_each(|(mine, other)| *mine = mine.saturating_add(*other));
        };
        sum(&mut self.opcodes, &other.opcodes);
        sum(&mut self.topologies, &other.topologies);
        sum(&mut self.faults, &other.faults);
        sum(&mut self.counters, &other.counters);
        self.restores += other.restores;
        self.restores_refused += other.restores_refused;
        self.clock |= other.clock;
    }

    /// Counts the packets of `words` that end within the first `done` words. Says whether one of them
    /// is a draw of so many primitives that it may have been done in batches.
    pub(super) fn stream(&mut self, words: &[u32], done: usize) -> bool {
        let (mut rest, mut batches) = (&words[..done.min(words.len())], false);
        while let Some(&header) = rest.first() {
            let length = Processor::packet_length(header).map_or(usize::MAX, |length| length as usize);
            let Some((packet, after)) = rest.split_at_checked(length) else { break };
            batches |= self.packet(packet);
            rest = after;
        }
        batches
    }

    fn packet(&mut self, packet: &[u32]) -> bool {
        let Some(opcode) = Opcode::from_code(packet[0] >> 24) else { return false };
        let place = Opcode::ALL.iter().position(|&other| other == opcode).unwrap_or(0);
        self.opcodes[place] += 1;
        let (from, count) = (packet.get(1).copied().unwrap_or(0), packet.len() as u32 - 1);
        match opcode {
            Opcode::RegisterWrite => {
                let control = Reg::ScanoutControl.offset();
                let index = control.checked_sub(from).map(|bytes| 2 + bytes as usize / 4);
                self.clock |= index.and_then(|index| packet.get(index)).is_some_and(|value| value & 1 != 0);
                false
            }
            Opcode::DrawInline | Opcode::DrawBuffer => {
                self.topologies[(from & 3) as usize] += 1;
                let elements = packet.iter().skip(2).step_by(if opcode == Opcode::DrawBuffer { 2 } else { 1 });
                count > ONE_BATCH || elements.take(2).any(|&elements| elements > ONE_BATCH)
            }
            _ => false,
        }
    }

    /// Counts the value of ERROR_CODE.
    pub(super) fn fault(&mut self, code: u32) {
        if let Some(place) = FaultCode::ALL.iter().position(|&fault| fault as u32 == code) {
            self.faults[place] += 1;
        }
    }

    /// Adds the card's counters, which the next reset clears.
    pub(super) fn add_counters(&mut self, bus: &mut impl Bus) {
        for (sum, &counter) in self.counters.iter_mut().zip(Counter::ALL) {
            let low = bus.read32(counter.offset());
            let high = bus.read32(counter.offset() + 4);
            *sum = sum.saturating_add(u64::from(low) | (u64::from(high) << 32));
        }
    }

    /// Counters of the card that never moved.
    #[must_use]
    pub fn silent(&self) -> Vec<&'static str> {
        let silent = Counter::ALL.iter().zip(self.counters).filter(|(_, count)| *count == 0);
        silent.map(|(counter, _)| counter.name()).collect()
    }

    /// Packet kinds that were never executed.
    #[must_use]
    pub fn missing(&self) -> Vec<&'static str> {
        Opcode::ALL.iter().zip(self.opcodes).filter(|(_, count)| *count == 0).map(|(opcode, _)| opcode.name()).collect()
    }
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "packets executed (where the card tells how far it came):")?;
        for (opcode, count) in Opcode::ALL.iter().zip(self.opcodes) {
            writeln!(f, "  {:<20} {count:>12}", opcode.name())?;
        }
        let [triangles, lines, points, strips] = self.topologies;
        writeln!(f, "draws: {triangles} of triangles, {lines} of lines, {points} of points, {strips} of line strips")?;
        writeln!(f, "faults:")?;
        for (fault, count) in FaultCode::ALL.iter().zip(self.faults) {
            writeln!(f, "  {:<20} {count:>12}", fault.name())?;
        }
        writeln!(f, "the card's counters:")?;
        for (counter, count) in Counter::ALL.iter().zip(self.counters) {
            writeln!(f, "  {:<20} {count:>12}", counter.name())?;
        }
        writeln!(f, "snapshots: {} restored, {} refused", self.restores, self.restores_refused)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stream_cut_packet_is_not_counted() {
        let mut coverage = Coverage::default();
        let words = [0x3000_0001, 7, 0x0300_0000, 0x3000_0001, 8];
        assert!(!coverage.stream(&words, 4));
        assert_eq!(coverage.opcodes.iter().sum::<u64>(), 2);
        assert!(!coverage.missing().contains(&"FENCE"));
        assert!(coverage.missing().contains(&"PRESENT"));
    }

    #[test]
    fn stream_continuous_scan_out_in_a_burst_is_seen() {
        let mut coverage = Coverage::default();
        coverage.stream(&[0x0100_0003, 0x67C, 0, 1], 4);
        assert!(coverage.clock);
    }
}
