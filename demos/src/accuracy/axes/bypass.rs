//! Za prediction: blocks that could have been bypassed and were not. The picture must not change.

use zga_tests::harness::{Prediction, Random};
use zga_tests::study::bypass::of_card;
use zga_tests::study::card::error_of_rate;
use zga_tests::study::scene::Kind;

use super::super::context::Context;
use super::super::report::{By, ErrorFigures, Point, Section, Sweep, Table};
use super::super::verdict::sentences;
use super::{price, scenes};
use crate::error::{Error, Result};

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let mut section = Section {
        name: "za-prediction",
        title: "Za prediction: how well the card knows that a block is hidden".to_owned(),
        about: vec![
            "The Za unit rejects a primitive in a whole block of 32 pixels when its least depth there, as predicted, lies behind the \
             block's greatest. A low prediction is safe but misses blocks. Rate: blocks that a perfect prediction would have \
             bypassed and this one did not. The picture is compared with the plain Z buffer's, pixel by pixel."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut table = Table::new(
        "Blocks met",
        &[
            ("scene", ""),
            ("initialised blocks met", ""),
            ("hidden altogether", ""),
            ("a perfect prediction bypasses", ""),
        ],
    );
    let mut all = scenes(context);
    // Small triangles on an empty target hide no block: planes that cover all of it come first.
    let mut random = Random::new(context.seed);
    let mut covered = Kind::Crossing.scene(all[0].1.size, &mut random);
    covered.facets.append(&mut all[0].1.facets);
    all[0] = ("small triangles behind planes".to_owned(), covered);
    for (name, scene) in all {
        let found = of_card(&scene, [32, 1], context.threads, context.effort.pick(5, 21));
        if !found.same_picture {
            return Err(Error::Use(format!("{name}: a prediction of the Za unit changed the picture")));
        }
        let chances = found.chances;
        let mut points = Vec::new();
        for outcome in &found.outcomes {
            let missed = chances.bypassable.saturating_sub(outcome.bypassed);
            let setting = match outcome.prediction {
                None => "no bypass",
                Some(Prediction::BlockLength) => "block-length",
                Some(Prediction::CoveredRun) => "covered-run",
                Some(Prediction::Plane) => "plane",
            };
            let error = ErrorFigures {
                rate: Some(100.0 * missed as f64 / chances.bypassable.max(1) as f64),
                standard_error: (missed > 0).then(|| error_of_rate(missed, chances.bypassable)),
                samples: chances.bypassable,
                ..ErrorFigures::default()
            };
            points.push(Point { setting: setting.to_owned(), error, price: price(&outcome.drawn, scene.pixels()) });
        }
        table.rows.push(vec![
            name.as_str().into(),
            chances.meetings.into(),
            chances.hidden.into(),
            chances.bypassable.into(),
        ]);
        let measure = "bypasses missed".to_owned();
        section.sweeps.push(Sweep { scene: name, measure, unit: "", by: By::Rate, points });
    }
    section.findings.push("The picture is the same under every prediction, bit for bit.".to_owned());
    section.findings.extend(section.sweeps.iter().flat_map(sentences));
    section.tables.push(table);
    Ok(section)
}
