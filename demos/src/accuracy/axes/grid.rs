//! Samples of a pixel: how far the covered share is from the covered area, and the picture from the true one.

use zga_tests::study::card::Setting;
use zga_tests::study::coverage;

use super::super::context::Context;
use super::super::report::{By, ErrorFigures, Point, Section, Sweep, Table};
use super::super::verdict::sentences;
use super::{GRIDS, magnified, pictures, scenes};
use crate::error::Result;

/// Of each grid the published root mean square error, that near an axis, and the largest single error.
const PUBLISHED: [[f64; 3]; 4] =
    [[0.249, 0.282, 0.5], [0.0315, 0.060, 0.124], [0.0213, 0.045, 0.124], [0.0112, 0.0246, 0.062]];

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let settings: Vec<(String, Setting)> =
        GRIDS.iter().map(|(grid, name)| ((*name).to_owned(), Setting { grid: *grid, ..Setting::best() })).collect();
    let mut section = Section {
        name: "grid",
        title: "Mask grid: how many samples a pixel has".to_owned(),
        about: vec![
            "A pixel that an edge crosses should show each side by the part it covers. The card counts samples instead: 1, 16, \
             32 or 64 of them. First, half-planes with a random angle and offset, each against the exact area of its snapped \
             edge; then whole pictures against the true picture, which has 256 exactly decided samples a pixel."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut swept: Vec<_> =
        scenes(context).iter().map(|(name, scene)| pictures(context, name, scene, &settings, By::Mean)).collect();
    let samples = context.effort.pick(30_000, 500_000);
    let mut near = Table::new(
        "Half-planes within 5 degrees of an axis, and the largest single error",
        &[
            ("grid", ""),
            ("near an axis", "pixel areas"),
            ("published", ""),
            ("largest", "pixel areas"),
            ("published", ""),
        ],
    );
    let mut points = Vec::new();
    for (((grid, name), published), priced) in GRIDS.into_iter().zip(PUBLISHED).zip(&swept[0].sweep.points) {
        let found = coverage::of_card(grid, samples, context.seed);
        let error = ErrorFigures {
            mean: Some(found.rmse),
            maximum: Some(found.largest),
            standard_error: Some(found.standard_error),
            samples: found.samples.into(),
            published: Some(published[0]),
            ..ErrorFigures::default()
        };
        near.rows.push(vec![
            name.into(),
            found.near_axis.into(),
            published[1].into(),
            found.largest.into(),
            published[2].into(),
        ]);
        points.push(Point { setting: name.to_owned(), error, price: priced.price });
    }
    let far = points.iter().filter_map(|point| {
        let (found, known, noise) = (point.error.mean?, point.error.published?, point.error.standard_error?);
        // Published figures have three digits: half of the last one is theirs.
        ((found - known).abs() > 3.0 * noise + 0.0006).then_some(point.setting.as_str())
    });
    let far: Vec<&str> = far.collect();
    section.notes.push(if far.is_empty() {
        "All coverage errors agree with the published ones within three standard errors and the rounding of these."
            .to_owned()
    } else {
        format!("Coverage errors of {} differ from the published ones by more than sampling noise.", far.join(", "))
    });
    section.notes.push("The price beside the half-planes is that of the random small triangles.".to_owned());
    let half_planes = Sweep {
        scene: "random half-planes".to_owned(),
        measure: "coverage error, root mean square".to_owned(),
        unit: "pixel areas",
        by: By::Mean,
        points,
    };
    section.strips = swept
        .last()
        .map(|mesh| {
            let shown: Vec<(&str, &[u32])> =
                GRIDS.iter().zip(&mesh.drawn).map(|((_, name), drawn)| (*name, drawn.colour.as_slice())).collect();
            let pick = [shown[0], shown[1], shown[3]];
            magnified(
                "Where one sample is worst",
                &mesh.truth,
                &pick,
                "Differences: white none, black 128 levels or more.",
            )
        })
        .into_iter()
        .collect();
    section.sweeps.push(half_planes);
    section.sweeps.extend(swept.drain(..).map(|swept| swept.sweep));
    section.findings = section.sweeps.iter().flat_map(sentences).collect();
    section.tables.push(near);
    Ok(section)
}
