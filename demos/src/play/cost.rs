//! What a frame called for and what it cost, as a report and as a table.

use std::time::Duration;

use serde_json::{Map, Value, json};
use zga_abi::{Counter, Effects, Units};
use zga_driver::Counters;

use super::Settings;
use crate::table::{Align, columns, grouped, row};

/// Prefix of the counters that are cycle accounts.
const CYCLES: &str = "cycles.";

/// What one frame called for and what it cost, its present included.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// All counters, from before the frame to after its present.
    pub counters: Counters,
    /// Effects that its draws called.
    pub called: Effects,
    /// Units that were powered for it.
    pub powered: Units,
    /// Host time from begin scene to the fence behind it.
    pub host: Duration,
}

/// Names of effects, as they stand in the register map.
#[must_use]
pub fn effect_names(effects: Effects) -> Vec<String> {
    effects.iter_names().map(|(name, _)| name.to_lowercase()).collect()
}

/// Names of units, as they stand in the register map.
#[must_use]
pub fn unit_names(units: Units) -> Vec<String> {
    units.iter_names().map(|(name, _)| name.to_lowercase()).collect()
}

impl Cost {
    /// Host time in milliseconds.
    #[must_use]
    pub fn host_ms(&self) -> f64 {
        self.host.as_secs_f64() * 1e3
    }

    /// The report of a frame: `size`, `hidden_surface`, `fidelity`, `card` (what the path depends on), `frame_hash`,
    /// `cycles`, `counters`, `effects`, `host_ms`.
    #[must_use]
    pub fn report(&self, size: [u32; 2], settings: &Settings, frame_hash: &str) -> Value {
        let (mut cycles, mut counters) = (Map::new(), Map::new());
        for (name, value) in self.counters.iter() {
            match name.strip_prefix(CYCLES) {
                Some(unit) => cycles.insert(unit.to_owned(), value.into()),
                None => counters.insert(name.to_owned(), value.into()),
            };
        }
        json!({
            "size": size,
            "hidden_surface": settings.hidden_surface.name(),
            "fidelity": settings.fidelity.name(),
            "card": settings.report(),
            "frame_hash": frame_hash,
            "cycles": cycles,
            "counters": counters,
            "effects": { "called": effect_names(self.called), "powered": unit_names(self.powered) },
            "host_ms": self.host_ms(),
        })
    }

    /// The same for the terminal.
    #[must_use]
    pub fn table(&self) -> String {
        let called = effect_names(self.called);
        let called = if called.is_empty() { "none".to_owned() } else { called.join(", ") };
        let mut text = columns(
            "  ",
            &[],
            &[row(["effects called", &called]), row(["units powered", &unit_names(self.powered).join(", ")])],
        );
        text.push_str("\n  Clocks of the card\n");
        text.push_str(&columns("    ", &[Align::Left, Align::Right, Align::Right], &self.clocks()));
        text.push_str("\n  Work of the card\n");
        let worked = Counter::ALL
            .iter()
            .filter(|counter| !counter.name().starts_with(CYCLES) && self.counters.get(**counter) > 0);
        let rows = worked.map(|counter| {
            vec![counter.name().to_owned(), grouped(self.counters.get(*counter)), counter.doc().to_owned()]
        });
        text.push_str(&columns("    ", &[Align::Left, Align::Right], &rows.collect::<Vec<_>>()));
        text.push_str(&format!("\n  Host time: {:.2} ms from the first packet to the fence\n", self.host_ms()));
        text
    }

    /// A row for each unit that spent clocks, and the sum.
    fn clocks(&self) -> Vec<Vec<String>> {
        const BAR: f64 = 30.0;
        let total = self.counters.get(Counter::CyclesTotal);
        let mut rows = Vec::new();
        for counter in Counter::ALL {
            let (Some(unit), clocks) = (counter.name().strip_prefix(CYCLES), self.counters.get(*counter)) else {
                continue;
            };
            if clocks == 0 || *counter == Counter::CyclesTotal {
                continue;
            }
            let part = clocks as f64 / total.max(1) as f64;
            let bar = "#".repeat((part * BAR).round() as usize);
            rows.push(vec![unit.to_owned(), grouped(clocks), format!("{:.1} %", 100.0 * part), bar]);
        }
        rows.push(row(["total", &grouped(total), "", ""]));
        rows
    }
}
