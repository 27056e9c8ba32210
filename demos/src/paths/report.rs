//! A comparison as tables for the terminal and as JSON.
//!
//! The JSON, schema `zga.paths/1`; fields are added, never changed in meaning:
//!
//! | field | holds |
//! | --- | --- |
//! | `schema`, `scene`, `size` | `zga.paths/1`, the name, width and height in pixels |
//! | `same` | every picture is the same, and every clocked run counted what the functional one did |
//! | `shared` | the same for all: `packet_words`, `vertices`, `primitives` |
//! | `runs[].path`, `.fidelity`, `.variant` | names; `variant` is null for the plain case |
//! | `runs[].card` | settings that the path depends on, named as in a scene's `card` |
//! | `runs[].frame_hash`, `.same_picture`, `.same_counters` | the last is null for functional runs |
//! | `runs[].cycles` | clocks of each unit, and `total` |
//! | `runs[].counters` | all other counters by their names |
//! | `runs[].memory_words` | `read`: `depths`, `za`, `scan_out`, `total`; `written`: `depths`, `colours`, `za`, `total` |
//! | `runs[].storage` | `on_chip_bits`: parts by name, and `total`; `z_buffer_bytes`; `sort_memory_bytes`; `subpixel_pool_bytes` |
//! | `runs[].host_ms`, `.host_ratio` | median of the frames, and the same over that of the first run |
//! | `maps[]` | present with a picture: `name`, `cell`, `units`, `cells`, `values`, `sum`, `whole`, `adds_up` |

use serde_json::{Map, Value, json};
use zga_abi::Counter;
use zga_abi::format::HiddenSurface;

use super::{Comparison, Run, Survey, element};
use crate::table::{Align, columns, grouped, row};

/// Prefix of the counters that are cycle accounts.
const CYCLES: &str = "cycles.";

/// The comparison, and the maps if some were made, as JSON.
#[must_use]
pub fn json(found: &Comparison, maps: Option<&[Survey]>) -> Value {
    let get = |counter| found.reference().map_or(0, |run| run.counters.get(counter));
    let mut report = json!({
        "schema": "zga.paths/1",
        "scene": found.name,
        "size": found.size,
        "same": found.is_good(),
        "shared": {
            "packet_words": get(Counter::FrontendWords),
            "vertices": get(Counter::GeometryVertices),
            "primitives": get(Counter::GeometryPrimitives),
        },
        "runs": found.runs.iter().map(|run| run_json(found, run)).collect::<Vec<_>>(),
    });
    if let Some(maps) = maps {
        report["maps"] = maps.iter().map(map_json).collect();
    }
    report
}

fn run_json(found: &Comparison, run: &Run) -> Value {
    let settings = &run.case.settings;
    let (mut cycles, mut counters) = (Map::new(), Map::new());
    for (name, value) in run.counters.iter() {
        match name.strip_prefix(CYCLES) {
            Some(unit) => cycles.insert(unit.to_owned(), value.into()),
            None => counters.insert(name.to_owned(), value.into()),
        };
    }
    let parts = run.storage.on_chip.iter().filter(|(name, _)| !name.is_empty());
    let mut on_chip: Map<String, Value> = parts.map(|(name, bits)| ((*name).to_owned(), (*bits).into())).collect();
    on_chip.insert("total".to_owned(), run.storage.on_chip_bits().into());
    let words = &run.words;
    json!({
        "path": settings.hidden_surface.name(),
        "fidelity": settings.fidelity.name(),
        "variant": (!run.case.variant.is_empty()).then_some(&run.case.variant),
        "card": settings.report(),
        "frame_hash": run.frame.hash,
        "same_picture": found.same_picture(run),
        "same_counters": found.same_counters(run),
        "cycles": cycles,
        "counters": counters,
        "memory_words": {
            "read": {
                "depths": words.depths_read, "za": words.za_read, "scan_out": words.scan_out_read, "total": words.read(),
            },
            "written": {
                "depths": words.depths_written, "colours": words.colours_written, "za": words.za_written,
                "total": words.written(),
            },
        },
        "storage": {
            "on_chip_bits": on_chip,
            "z_buffer_bytes": run.storage.z_buffer_bytes,
            "sort_memory_bytes": run.storage.sort_memory_bytes,
            "subpixel_pool_bytes": run.storage.subpixel_pool_bytes,
        },
        "host_ms": run.host_ms,
        "host_ratio": host_ratio(found, run),
    })
}

fn map_json(map: &Survey) -> Value {
    json!({
        "name": map.name, "cell": map.cell, "units": map.units, "cells": map.cells, "values": map.values,
        "sum": map.sum(), "whole": map.whole, "adds_up": map.adds_up(),
    })
}

/// Host time of a run over that of the first.
fn host_ratio(found: &Comparison, run: &Run) -> f64 {
    found.reference().map_or(1.0, |reference| run.host_ms / reference.host_ms)
}

/// The comparison for the terminal.
#[must_use]
pub fn table(found: &Comparison) -> String {
    let [width, height] = found.size;
    let get = |counter| found.reference().map_or(0, |run| run.counters.get(counter));
    let mut text = format!(
        "{}, {width} x {height} pixels, {} primitives, {} vertices, {} words of packets\n\n",
        found.name,
        grouped(get(Counter::GeometryPrimitives)),
        grouped(get(Counter::GeometryVertices)),
        grouped(get(Counter::FrontendWords)),
    );
    text.push_str(&runs(found));
    text.push_str("\n  Clocks of the units\n");
    text.push_str(&by_path(found, &clocks(found)));
    text.push_str("\n  Memory, words of 32 bits for a frame and its scan-out\n");
    text.push_str(&by_path(found, &memory(found)));
    text.push_str("\n  Storage of the path\n");
    text.push_str(&by_path(found, &storage(found)));
    text.push_str("\n  Work of the path\n");
    text.push_str(&work(&plain(found), &["za.", "systolic.", "tile."]));
    // It has the same work behind every path.
    let samples = found.reference().map_or_else(String::new, |run| work(&[run], &["subpixel."]));
    if !samples.is_empty() {
        text.push_str("\n  Work of the sub-pixel unit\n");
        text.push_str(&samples);
    }
    text
}

/// A row for each run.
fn runs(found: &Comparison) -> String {
    let head = ["path", "", "picture", "clocks", "", "words read", "written", "on-chip bits", "host ms", ""];
    let mut rows = vec![row(head)];
    let total = |run: &Run| run.counters.get(Counter::CyclesTotal);
    let reference = found.reference().map_or(0, total).max(1);
    for run in &found.runs {
        let settings = &run.case.settings;
        let case = if run.case.variant.is_empty() { settings.fidelity.name() } else { &run.case.variant };
        let picture = match (found.same_picture(run), found.same_counters(run)) {
            (false, _) => "DIFFERS",
            (true, Some(false)) => "same, COUNTS DIFFER",
            (true, _) => "same",
        };
        rows.push(row([
            settings.hidden_surface.name(),
            case,
            picture,
            &grouped(total(run)),
            &format!("{:.2} x", total(run) as f64 / reference as f64),
            &grouped(run.words.read()),
            &grouped(run.words.written()),
            &grouped(run.storage.on_chip_bits()),
            &format!("{:.2}", run.host_ms),
            &format!("{:.2} x", host_ratio(found, run)),
        ]));
    }
    let (l, r) = (Align::Left, Align::Right);
    columns("  ", &[l, l, l, r, r, r, r, r, r, r], &rows)
}

/// The plain runs of the paths that there are.
fn plain(found: &Comparison) -> Vec<&Run> {
    HiddenSurface::ALL.iter().filter_map(|path| found.plain(*path)).collect()
}

/// Rows with a number for each path, below the paths' names; rows of zeros are left out.
fn by_path(found: &Comparison, rows: &[(String, Vec<u64>)]) -> String {
    let runs = plain(found);
    let mut head = vec![String::new()];
    head.extend(runs.iter().map(|run| run.case.settings.hidden_surface.name().to_owned()));
    let mut all = vec![head];
    for (name, values) in rows.iter().filter(|(_, values)| values.iter().any(|value| *value > 0)) {
        let mut cells = vec![name.clone()];
        cells.extend(values.iter().map(|value| if *value == 0 { "-".to_owned() } else { grouped(*value) }));
        all.push(cells);
    }
    let mut aligns = vec![Align::Right; runs.len() + 1];
    aligns[0] = Align::Left;
    columns("    ", &aligns, &all)
}

fn clocks(found: &Comparison) -> Vec<(String, Vec<u64>)> {
    let runs = plain(found);
    let mut accounts: Vec<&Counter> = Counter::ALL.iter().filter(|c| c.name().starts_with(CYCLES)).collect();
    // The sum comes first in the registers and last in a table.
    accounts.sort_by_key(|counter| **counter == Counter::CyclesTotal);
    let values = |counter: Counter| runs.iter().map(|run| run.counters.get(counter)).collect();
    let name = |counter: &Counter| counter.name().trim_start_matches(CYCLES).to_owned();
    accounts.into_iter().map(|counter| (name(counter), values(*counter))).collect()
}

fn memory(found: &Comparison) -> Vec<(String, Vec<u64>)> {
    let runs = plain(found);
    let of = |name: &str, get: fn(&Run) -> u64| (name.to_owned(), runs.iter().map(|run| get(run)).collect());
    vec![
        of("depths read", |run| run.words.depths_read),
        of("Za words read", |run| run.words.za_read),
        of("colours read by scan-out", |run| run.words.scan_out_read),
        of("depths written", |run| run.words.depths_written),
        of("colours written", |run| run.words.colours_written),
        of("Za words written", |run| run.words.za_written),
        of("all", |run| run.words.read() + run.words.written()),
    ]
}

fn storage(found: &Comparison) -> Vec<(String, Vec<u64>)> {
    let runs = plain(found);
    let of = |name: &str, get: &dyn Fn(&Run) -> u64| (name.to_owned(), runs.iter().map(|run| get(run)).collect());
    let systolic = |run: &Run| run.case.settings.hidden_surface == HiddenSurface::Systolic;
    let cost = |run: &Run| element(&run.case.settings, found.size[0]);
    let part = |name: &'static str| {
        move |run: &Run| run.storage.on_chip.iter().find(|(known, _)| *known == name).map_or(0, |(_, bits)| *bits)
    };
    vec![
        of("Za RAM, bits", &part("za_ram")),
        of("element registers, bits", &part("element_registers")),
        of("elements", &|run| {
            if systolic(run) { found.size[0].into() } else { 0 }
        }),
        of("register bits of an element", &|run| {
            if systolic(run) { cost(run).register_bits } else { 0 }
        }),
        of("gates of an element", &|run| {
            if systolic(run) { cost(run).gates() } else { 0 }
        }),
        of("comparators, bits", &part("comparators")),
        of("parameter buffer, bits", &part("parameter_buffer")),
        of("colour buffer, bits", &part("colour_buffer")),
        of("Z buffer in memory, bytes", &|run| run.storage.z_buffer_bytes),
        of("sort memory, bytes", &|run| run.storage.sort_memory_bytes),
        of("sub-pixel lists of a line, bytes", &|run| run.storage.subpixel_pool_bytes),
    ]
}

/// The counters of some units that are not zero.
fn work(runs: &[&Run], units: &[&str]) -> String {
    let mut rows = Vec::new();
    for run in runs {
        let counters = Counter::ALL.iter().filter(|counter| units.iter().any(|unit| counter.name().starts_with(unit)));
        for counter in counters.filter(|counter| run.counters.get(**counter) > 0) {
            rows.push(row([counter.name(), &grouped(run.counters.get(*counter)), counter.doc()]));
        }
    }
    crate::table::wrapped("    ", &[Align::Left, Align::Right], &rows, 100)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::tests::compared;

    #[test]
    fn json_has_every_run_with_its_sums() {
        let (_, found) = compared("za", [96, 64], false);
        let report = json(&found, None);
        assert_eq!((&report["schema"], &report["same"]), (&json!("zga.paths/1"), &json!(true)));
        let runs = report["runs"].as_array().expect("a list");
        assert_eq!(runs.len(), found.runs.len());
        for run in runs {
            let number = |pointer: &str| run.pointer(pointer).and_then(Value::as_u64).expect("a number");
            let read = ["depths", "za", "scan_out"].map(|kind| number(&format!("/memory_words/read/{kind}")));
            assert_eq!(number("/memory_words/read/total"), read.iter().sum::<u64>());
            let written = ["depths", "colours", "za"].map(|kind| number(&format!("/memory_words/written/{kind}")));
            assert_eq!(number("/memory_words/written/total"), written.iter().sum::<u64>());
            assert_eq!(run["same_picture"], true);
        }
        assert_eq!(runs[0]["same_counters"], Value::Null);
        assert_eq!(report.get("maps"), None);
    }

    #[test]
    fn table_names_what_differs() {
        let (_, mut found) = compared("tile", [96, 64], false);
        assert!(!table(&found).contains("DIFFERS"));
        if let Some(last) = found.runs.last_mut() {
            last.frame.hash.clear();
        }
        let text = table(&found);
        assert_eq!(text.lines().filter(|line| line.contains("DIFFERS")).count(), 1);
        assert!(text.contains("element registers, bits") && text.contains("tile.links_walked"), "{text}");
    }
}
