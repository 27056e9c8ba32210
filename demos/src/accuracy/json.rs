//! The report as JSON, schema `zga.accuracy/1`.
//!
//! ```text
//! { "schema": "zga.accuracy/1",
//!   "seed": 1, "date": "2026-01-31", "version": "0.1.0", "effort": "quick",
//!   "machine": { "processor": "...", "threads": 2 },
//!   "headlines": ["..."],
//!   "sections": [ {
//!     "name": "grid", "title": "...", "about": ["..."], "findings": ["..."], "notes": ["..."],
//!     "sweeps": [ {
//!       "scene": "...", "measure": "...", "unit": "...", "by": "mean" | "maximum" | "rate",
//!       "points": [ {
//!         "setting": "8x8",
//!         "error": { "mean": 0.01, "maximum": 0.06, "rate_percent": null, "standard_error": 1e-4, "samples": 100000,
//!                    "published": 0.0112 },
//!         "clocks_per_pixel": 12.5, "host_ns_per_pixel": 30.1, "host_ns_spread": 0.4,
//!         "dominated_by": null } ] } ],
//!     "tables": [ { "title": "...", "columns": [ { "name": "...", "unit": "..." } ], "rows": [ ["text", 1.5, 3, null] ] } ],
//!     "plots": [ { "title": "...", "x": { "label": "...", "scale": "linear" | "logarithmic" }, "y": {...},
//!                  "series": [ { "name": "...", "points": [[1, 2]], "labels": ["..."] } ] } ] } ] }
//! ```
//! What is not measured is `null`. `rate_percent`, and `standard_error` and `published` where `by` is `rate`, are in
//! percent; all other errors in `unit`. Pictures are in the page alone.

use serde_json::{Value, json};

use super::report::{Axis, By, Cell, Plot, Report, Scale, Section, Sweep, Table};
use super::verdict::of_sweep;

/// All of it.
#[must_use]
pub fn json(report: &Report) -> Value {
    let origin = &report.origin;
    json!({
        "schema": "zga.accuracy/1",
        "seed": origin.seed,
        "date": origin.date,
        "version": origin.version,
        "effort": origin.effort,
        "machine": { "processor": origin.processor, "threads": origin.threads },
        "headlines": report.headlines,
        "sections": report.sections.iter().map(section).collect::<Vec<_>>(),
    })
}

fn section(section: &Section) -> Value {
    json!({
        "name": section.name,
        "title": section.title,
        "about": section.about,
        "findings": section.findings,
        "notes": section.notes,
        "sweeps": section.sweeps.iter().map(sweep).collect::<Vec<_>>(),
        "tables": section.tables.iter().map(table).collect::<Vec<_>>(),
        "plots": section.plots.iter().map(plot).collect::<Vec<_>>(),
    })
}

fn sweep(sweep: &Sweep) -> Value {
    let by = match sweep.by {
        By::Mean => "mean",
        By::Maximum => "maximum",
        By::Rate => "rate",
    };
    let points = sweep.points.iter().zip(of_sweep(sweep)).map(|(point, dominated)| {
        json!({
            "setting": point.setting,
            "error": {
                "mean": point.error.mean,
                "maximum": point.error.maximum,
                "rate_percent": point.error.rate,
                "standard_error": point.error.standard_error,
                "samples": point.error.samples,
                "published": point.error.published,
            },
            "clocks_per_pixel": point.price.clocks,
            "host_ns_per_pixel": point.price.nanoseconds,
            "host_ns_spread": point.price.spread,
            "dominated_by": dominated.map(|by| sweep.points[by].setting.as_str()),
        })
    });
    json!({
        "scene": sweep.scene,
        "measure": sweep.measure,
        "unit": sweep.unit,
        "by": by,
        "points": points.collect::<Vec<_>>(),
    })
}

fn table(table: &Table) -> Value {
    let columns = table.columns.iter().map(|column| json!({ "name": column.name, "unit": column.unit }));
    let cell = |cell: &Cell| match cell {
        Cell::Text(text) => json!(text),
        Cell::Number(number) => json!(number),
        Cell::Count(count) => json!(count),
        Cell::Nothing => Value::Null,
    };
    let rows = table.rows.iter().map(|row| row.iter().map(cell).collect::<Vec<_>>());
    json!({ "title": table.title, "columns": columns.collect::<Vec<_>>(), "rows": rows.collect::<Vec<_>>() })
}

fn plot(plot: &Plot) -> Value {
    let axis = |axis: &Axis| {
        let scale = if axis.scale == Scale::Linear { "linear" } else { "logarithmic" };
        json!({ "label": axis.label, "scale": scale })
    };
    let series = plot
        .series
        .iter()
        .map(|series| json!({ "name": series.name, "points": series.points, "labels": series.labels }));
    json!({ "title": plot.title, "x": axis(&plot.x), "y": axis(&plot.y), "series": series.collect::<Vec<_>>() })
}
