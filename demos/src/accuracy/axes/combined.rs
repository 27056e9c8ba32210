//! All settings together on one scene: picture error against clocks, and the Pareto line.

use zga_tests::harness::{Grid, Order};
use zga_tests::oracle::DepthFormat;
use zga_tests::study::card::{self, Setting};
use zga_tests::study::truth::truth;

use super::super::context::Context;
use super::super::model;
use super::super::report::{Axis, Kind, Plot, Section, Series, Table};
use super::super::verdict::{dominated, figure};
use super::{EXACT, mesh_name};
use crate::error::Result;

/// Every combination that differs in what is drawn: without a grid there is no order.
fn combinations() -> Vec<(String, Setting)> {
    let mut all = Vec::new();
    for (grid, grid_name) in [(Grid::Off, "1"), (Grid::Grid4x4, "4x4"), (Grid::Grid8x4, "8x4"), (Grid::Grid8x8, "8x8")]
    {
        for (order, order_name) in Order::ALL.into_iter().zip(["centre", "search", "exhaustive"]) {
            if grid == Grid::Off && order != Order::Centre {
                continue;
            }
            for (bits, fraction) in [16, 24, 31].into_iter().flat_map(|bits| [0, 8, 16, 24].map(|f| (bits, f))) {
                for coordinate_bits in [4, 8] {
                    let depth = DepthFormat { bits, fraction };
                    let order_name = if grid == Grid::Off { String::new() } else { format!(" {order_name}") };
                    let name = format!("{grid_name}{order_name} Z{bits} F{fraction} 1/{}", 1 << coordinate_bits);
                    all.push((name, Setting { grid, order, depth, coordinate_bits, ..Setting::best() }));
                }
            }
        }
    }
    all
}

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let size = context.effort.pick([160, 120], [320, 240]);
    let scene = model::crossing(&context.mesh, size);
    let exact = truth(&scene, [EXACT; 2]);
    let all = combinations();
    let mut places = Vec::new();
    for (name, setting) in &all {
        context.tell(name);
        let drawn = card::drawn(&scene, &[*setting], context.threads, 0);
        let clocks = drawn[0].clocks as f64 / scene.pixels() as f64;
        places.push([card::error(&exact, &drawn[0].colour).mean, clocks]);
    }
    let lost = dominated(&places);
    let mut line: Vec<usize> = (0..all.len()).filter(|at| lost[*at].is_none()).collect();
    line.sort_by(|a, b| places[*a][1].total_cmp(&places[*b][1]));
    // Of settings in the same place the plainest name is enough.
    line.dedup_by(|a, b| places[*a] == places[*b]);
    let turned = |[error, clocks]: [f64; 2]| [clocks, error];
    let short = |at: usize| all[at].0.split(" Z").next().unwrap_or_default().to_owned();
    let mut labels: Vec<String> = line.iter().map(|at| short(*at)).collect();
    for at in (1..labels.len()).rev() {
        if labels[at] == labels[at - 1] {
            labels[at].clear();
        }
    }
    let plot = Plot {
        title: "All combinations of settings: colour error against clocks".to_owned(),
        x: Axis::linear("clocks of the card for a pixel"),
        y: Axis::logarithmic("mean colour error, levels of 255"),
        series: vec![
            Series {
                name: String::new(),
                points: places.iter().copied().map(turned).collect(),
                labels: all.iter().map(|_| String::new()).collect(),
                kind: Kind::Cloud,
            },
            Series {
                name: String::new(),
                points: line.iter().map(|at| turned(places[*at])).collect(),
                labels,
                kind: Kind::Staircase,
            },
        ],
    };
    let columns = [("setting", ""), ("mean colour error", "levels of 255"), ("clocks/pixel", ""), ("x", "")];
    let mut table = Table::new("The Pareto line: no other setting is both more exact and cheaper", &columns);
    let cheapest = line.first().map_or(1.0, |at| places[*at][1]);
    for at in &line {
        let [error, clocks] = places[*at];
        let row =
            vec![all[*at].0.as_str().into(), error.into(), clocks.into(), format!("{:.2}", clocks / cheapest).into()];
        table.rows.push(row);
    }
    let mut findings = Vec::new();
    if let (Some(first), Some(last)) = (line.first(), line.last()) {
        findings.push(format!(
            "{} of {} combinations are on the Pareto line; from {} to {} the error falls from {} to {} levels for {} times the clocks.",
            line.len(),
            all.len(),
            all[*first].0,
            all[*last].0,
            figure(places[*first][0]),
            figure(places[*last][0]),
            figure(places[*last][1] / cheapest)
        ));
    }
    Ok(Section {
        name: "combined",
        title: "All settings together: what a picture's accuracy costs".to_owned(),
        about: vec![format!(
            "Two copies of the mesh that cut each other ({}), {} x {} pixels, drawn with every combination of grid, sub-pixel depth, \
             depth bits, fraction bits and coordinate bits. Error: mean distance of a pixel's colour from the true picture.",
            mesh_name(context),
            size[0],
            size[1]
        )],
        findings,
        tables: vec![table],
        plots: vec![plot],
        ..Section::default()
    })
}
