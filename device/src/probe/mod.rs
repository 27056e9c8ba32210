//! Probe: what tells about a card's inside.
//!
//! Duties: cycle accounts and counters, the history of one pixel, snapshots.
//! Inputs: every unit. Outputs: COUNTERS, probe records in video memory, snapshots.
//! Clocks: none; a probe must not change what it measures. Records are written beside the account.
//!
//! | file | part |
//! | --- | --- |
//! | [`account`] | counters and cycle accounts |
//! | [`pixel`] | the records of the probed pixel |
//! | [`snapshot`] | the whole state, to be restored |
//! | `snapshot_bytes` | snapshots as bytes |

pub(crate) mod account;
pub(crate) mod pixel;
pub(crate) mod snapshot;
mod snapshot_bytes;

use crate::frontend::register_file::RegisterFile;
use crate::memory::VideoMemory;
use account::Account;
use pixel::{KIND_CLEAR, PixelProbe};
use zga_abi::packet::PROBE_RECORD_WORDS;
use zga_abi::{Counter, Reg};
use zga_firmware::checked::Clear;

/// The pixel history: watches a pixel during clears and draws, writes its records to video memory
/// after each.
#[derive(Debug, Default)]
pub(crate) struct Probe {
    watch: PixelProbe,
    /// Draws of the scene so far.
    pub(crate) draws: u32,
}

impl Probe {
    /// A scene begins: draws count from 0.
    pub(crate) fn begin_scene(&mut self) {
        self.draws = 0;
    }

    /// After a reset: nothing recorded, and no memory held.
    pub(crate) fn reset(&mut self) {
        *self = Probe::default();
    }

    /// The next draw's watch on the pixel, if the probe is enabled.
    pub(crate) fn watch(&mut self, registers: &RegisterFile) -> Option<&mut PixelProbe> {
        let draw = self.draws;
        self.draws = draw.wrapping_add(1);
        self.aim(registers, draw)
    }

    /// Notes a clear that is about to be done, if the probe is enabled and its pixel is cleared; `depth` tells a
    /// pixel's depth as it stands.
    pub(crate) fn clear(&mut self, registers: &RegisterFile, clear: &Clear, depth: impl FnOnce(u32, u32) -> u32) {
        let draws = self.draws;
        let Some(watch) = self.aim(registers, draws) else { return };
        let (x, y, area) = (watch.x, watch.y, clear.area);
        if clear.colour.is_none() && clear.depth.is_none() {
            return;
        }
        if (area.x..area.right).contains(&x) && (area.y..area.bottom).contains(&y) {
            let before = depth(x, y);
            watch.clear(before, clear.depth.unwrap_or(before), clear.colour.unwrap_or(0));
        }
    }

    fn aim(&mut self, registers: &RegisterFile, draw: u32) -> Option<&mut PixelProbe> {
        if registers.get(Reg::ProbeControl) & 1 == 0 {
            return None;
        }
        let pixel = registers.get(Reg::ProbePixel);
        (self.watch.x, self.watch.y) = (pixel & 0x7FFF, (pixel >> 16) & 0x7FFF);
        self.watch.draw = draw;
        Some(&mut self.watch)
    }

    /// Writes the records to PROBE_BASE, behind those that are there, and counts them. Records beyond
    /// PROBE_SIZE, or beyond memory if a host moved PROBE_BASE meanwhile, are only counted.
    pub(crate) fn store(&mut self, registers: &RegisterFile, memory: &mut VideoMemory, account: &mut Account) {
        let records = &mut self.watch.records;
        if records.is_empty() {
            return;
        }
        let count = registers.get(Reg::ProbeCount);
        let room = registers.get(Reg::ProbeSize).saturating_sub(count) as usize;
        let record_words = PROBE_RECORD_WORDS as usize;
        let first = (registers.get(Reg::ProbeBase) / 4) as usize + count as usize * record_words;
        let area = memory.words_mut().get_mut(first..).unwrap_or_default();
        for (slot, record) in area.chunks_exact_mut(record_words).take(room).zip(&*records) {
            slot.copy_from_slice(bytemuck::cast_slice(std::slice::from_ref(record)));
        }
        registers.count(Reg::ProbeCount, records.len());
        let fragments = records.iter().filter(|record| record.verdict & 0xFF != KIND_CLEAR).count();
        account.add(Counter::ProbeFragments, fragments as u64);
        records.clear();
    }
}
