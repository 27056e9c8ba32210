//! All settings together on one scene: picture error against clocks, and the Pareto line.

use zga_tests::harness::{Grid, Order};
use zga_tests::oracle::DepthFormat;
use zga_tests::study::card::{self, Setting};
use zga_tests::study::truth::truth;

use super::super::context::Context;
use super::super::model;
use super::super::report::{Axis, Kind, Plot, Section, Series, Table};
use super::super::verdict::{dominated, figure};
use super::{EXACT, GRIDS, ORDERS, mesh_name};
use crate::error::Result;

/// Every combination that differs in what is drawn: without a grid there is no order.
fn combinations() -> Vec<(String, Setting)> {
    let mut all = Vec::new();
    for (grid, grid_name) in GRIDS {
        for (order, order_name) in ORDERS {
            if grid == Grid::Off && order != Order::Centre {
                continue;
            }
            let samples = if grid == Grid::Off { "1 sample".to_owned() } else { format!("{grid_name} {order_name}") };
            for (bits, fraction) in [16, 24, 31].into_iter().flat_map(|bits| [0, 8, 16, 24].map(|f| (bits, f))) {
                for coordinate_bits in [4, 8] {
                    let depth = DepthFormat { bits, fraction };
                    let name = format!("{samples} Z{bits} F{fraction} 1/{}", 1 << coordinate_bits);
                    all.push((name, Setting { grid, order, depth, coordinate_bits, ..Setting::best() }));
                }
            }
        }
    }
    all
}

/// Figures within this ratio are called the same: errors, clocks.
const SAME: [f64; 2] = [1.02, 1.005];

/// Positions of the settings on the Pareto line, rising in clocks. Of settings that are the same within [`SAME`] the line
/// has one, and that is the finest, the last in the list.
fn pareto(places: &[[f64; 2]]) -> Vec<usize> {
    let lost = dominated(places);
    let mut front: Vec<usize> = (0..places.len()).filter(|at| lost[*at].is_none()).collect();
    front.sort_by(|a, b| places[*a][1].total_cmp(&places[*b][1]));
    let same = |a: usize, b: usize| (0..2).all(|k| places[a][k] <= places[b][k] * SAME[k]);
    let finest = |at: usize| (0..places.len()).rev().find(|other| same(*other, at)).unwrap_or(at);
    let mut line: Vec<usize> = Vec::new();
    for at in front {
        match line.last() {
            // Hardly more exact than what is on the line already: not worth a place on it.
            Some(last) if places[at][0] * SAME[0] >= places[*last][0] => {}
            // As cheap as that, and more exact: in its place.
            Some(last) if places[at][1] <= places[*last][1] * SAME[1] => {
                line.pop();
                line.push(finest(at));
            }
            _ => line.push(finest(at)),
        }
    }
    line
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
    let line = pareto(&places);
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
        let row = vec![all[*at].0.as_str().into(), error.into(), clocks.into(), (clocks / cheapest).into()];
        table.rows.push(row);
    }
    let mut findings = Vec::new();
    if let (Some(first), Some(last)) = (line.first(), line.last()) {
        findings.push(format!(
            "Of {} combinations of settings only {} are worth having: no other is both more exact and cheaper. From {} to {} the mean \
             colour error falls from {} to {} levels of 255 for {} times the clocks.",
            all.len(),
            line.len(),
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
             depth bits, fraction bits and coordinate bits. Error: mean distance of a pixel's colour from the true picture. Names: 8x4 search \
             Z24 F16 1/256 is a grid of 8x4 samples, the mask search, depths of 24 bits, 16 fraction bits, vertices on 1/256 pixel.",
            mesh_name(context),
            size[0],
            size[1]
        )],
        findings,
        summary: Some(table),
        plots: vec![plot],
        ..Section::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pareto_has_one_of_what_is_the_same_and_takes_the_finest() {
        // The first two are the same; the third costs the same and is more exact; the fourth is hardly more exact and dearer.
        let places = [[8.0, 1.0], [8.01, 1.0], [2.0, 1.001], [1.99, 3.0], [1.0, 4.0], [5.0, 5.0]];
        assert_eq!(pareto(&places), [2, 4]);
        assert_eq!(pareto(&places[..2]), [1]);
        assert_eq!(combinations().len(), 24 + 3 * 3 * 24);
    }
}
