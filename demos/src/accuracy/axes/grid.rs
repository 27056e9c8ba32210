//! Samples of a pixel: how far the covered share is from the covered area.

use zga_tests::harness::Grid;
use zga_tests::study::coverage;

use super::super::context::Context;
use super::super::report::{By, ErrorFigures, Point, Price, Section, Sweep};
use crate::error::Result;

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let samples = context.effort.pick(20_000, 400_000);
    let mut points = Vec::new();
    for (grid, name, published) in [
        (Grid::Off, "1", 0.249),
        (Grid::Grid4x4, "4x4", 0.0315),
        (Grid::Grid8x4, "8x4", 0.0213),
        (Grid::Grid8x8, "8x8", 0.0112),
    ] {
        let found = coverage::of_card(grid, samples, context.seed);
        let error = ErrorFigures {
            mean: Some(found.rmse),
            maximum: Some(found.largest),
            samples: found.samples.into(),
            published: Some(published),
            ..ErrorFigures::default()
        };
        points.push(Point { setting: name.to_owned(), error, price: Price::default() });
    }
    Ok(Section {
        name: "grid",
        title: "Mask grid: samples of a pixel".to_owned(),
        sweeps: vec![Sweep {
            scene: "random half-planes".to_owned(),
            measure: "coverage error (root mean square)".to_owned(),
            unit: "pixel areas",
            by: By::Mean,
            points,
        }],
        ..Section::default()
    })
}
