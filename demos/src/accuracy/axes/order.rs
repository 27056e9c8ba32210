//! Depth inside a pixel: by the centre, by the mask search, or sample by sample.

use zga_tests::harness::{Grid, Order};
use zga_tests::study::card::{Drawn, Setting, error_of_rate};
use zga_tests::study::order::{self, percent};
use zga_tests::study::scene::Kind;

use super::super::context::Context;
use super::super::model;
use super::super::report::{By, Cell, ErrorFigures, Point, Section, Sweep, Table};
use super::super::verdict::{figure, sentences};
use super::{ORDERS, crossing_name, magnified, pictures, price};
use crate::error::Result;

/// In the order of [`ORDERS`].
const NAMES: [&str; 3] = [ORDERS[0].1, ORDERS[1].1, ORDERS[2].1];

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let (scenes, repeats) = context.effort.pick((1, 5), (10, 9));
    let mut section = Section {
        name: "subpixel-depth",
        title: "Sub-pixel depth: who is in front inside a pixel".to_owned(),
        about: vec![
            "Where fragments share samples of a pixel somebody must be in front. The card can compare one depth at the pixel's \
             centre, the depths that the published mask search finds, or the depths of all samples. Rate: pixels with more than \
             one thing in them that differ from the exact picture of the same 64 samples by more than rounding. No such rate \
             was published before."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut table = Table::new(
        "Pixels in which triangles cut each other, and depths worked out",
        &[
            ("scene", ""),
            ("setting", ""),
            ("pixels with a cut", ""),
            ("wrong", "%"),
            ("standard error", "%"),
            ("depths worked out", ""),
        ],
    );
    for kind in Kind::ALL {
        context.tell(kind.name());
        let (outcomes, example) = order::of_card(Grid::Grid8x8, kind, scenes, context.threads, repeats, context.seed);
        let mut points = Vec::new();
        for (setting, outcome) in NAMES.into_iter().zip(&outcomes) {
            let mut times = outcome.nanoseconds.clone();
            times.sort_by(f64::total_cmp);
            let drawn = Drawn { clocks: outcome.clocks, nanoseconds: times, ..empty() };
            let error = ErrorFigures {
                mean: Some(outcome.levels / outcome.edges.max(1) as f64),
                maximum: Some(outcome.largest),
                rate: Some(percent(outcome.wrong, outcome.edges)),
                standard_error: Some(error_of_rate(outcome.wrong, outcome.edges)),
                samples: outcome.edges,
                published: None,
            };
            points.push(Point { setting: setting.to_owned(), error, price: price(&drawn, outcome.pixels as usize) });
            if outcome.crossings > 0 {
                table.rows.push(vec![
                    kind.name().into(),
                    setting.into(),
                    outcome.crossings.into(),
                    percent(outcome.wrong_crossings, outcome.crossings).into(),
                    error_of_rate(outcome.wrong_crossings, outcome.crossings).into(),
                    Cell::Count(outcome.evaluations),
                ]);
            }
        }
        if kind == Kind::Crossing {
            let shown: Vec<(&str, &[u32])> =
                NAMES.into_iter().zip(&example.pictures).map(|(name, colour)| (name, colour.as_slice())).collect();
            let caption = "By the centre the line where two planes cut each other is a staircase.";
            section.strips.push(magnified("Planes that cross", &example.truth, &shown, caption));
        }
        section.sweeps.push(Sweep {
            scene: kind.name().to_owned(),
            measure: "wrong edge pixels".to_owned(),
            unit: "levels of 255",
            by: By::Rate,
            points,
        });
    }
    let settings: Vec<(String, Setting)> = NAMES
        .into_iter()
        .zip(Order::ALL)
        .map(|(name, order)| (name.to_owned(), Setting { order, ..Setting::best() }))
        .collect();
    let scene = model::crossing(&context.mesh, context.size).snapped();
    let name = crossing_name(context);
    let mesh = pictures(context, &name, &scene, &settings, By::Mean);
    section.sweeps.push(mesh.sweep);
    section.findings = section.sweeps.iter().flat_map(sentences).collect();
    let worst = |setting: usize| {
        table.rows.iter().filter(move |row| row[1] == Cell::from(NAMES[setting])).filter_map(|row| match row[3] {
            Cell::Number(rate) => Some(rate),
            _ => None,
        })
    };
    let share = |setting: usize| match worst(setting).fold(0.0, f64::max) {
        0.0 => "in none".to_owned(),
        rate => format!("in up to {} %", figure(rate)),
    };
    section.findings.push(format!(
        "Where triangles cut each other inside a pixel, one depth at the centre gets the pixel wrong {}, the mask search {}, a depth for \
         each sample {}.",
        share(0),
        share(1),
        share(2)
    ));
    section.tables.push(table);
    Ok(section)
}

/// A price without anything in it.
fn empty() -> Drawn {
    Drawn { colour: Vec::new(), events: zga_tests::harness::Events::NONE, clocks: 0, nanoseconds: Vec::new() }
}
