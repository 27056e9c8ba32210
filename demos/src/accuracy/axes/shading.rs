//! Where light is worked out, by FLIP and PSNR against light at each pixel in f64.

use zga_tests::study::shading::{ball, of_card};
use zga_tests::study::{flip, psnr::psnr};

use super::super::context::Context;
use super::super::model;
use super::super::report::{By, ErrorFigures, Panel, Point, Section, Strip, Sweep, Table};
use super::super::verdict::sentences;
use super::filter::{price, shown};
use super::{cropped, heat, mesh_name};
use crate::error::Result;

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let mut section = Section {
        name: "shading",
        title: "Shading: light once a triangle, at vertices, or at pixels".to_owned(),
        about: vec![
            "Two lights with a highlight on a coarse ball and on the mesh. Reference: light at each pixel in f64, on normals \
             interpolated in f64."
                .to_owned(),
        ],
        ..Section::default()
    };
    let size = context.size;
    let mut table = Table::new("The same pictures by PSNR", &[("model", ""), ("shading", ""), ("PSNR", "dB")]);
    let models = [
        ("ball of 288 triangles".to_owned(), ball(12)),
        (mesh_name(context), model::corners(&context.mesh, size, 25.0)),
    ];
    for (name, corners) in models {
        context.tell(&name);
        let found = of_card(&corners, size, context.threads, context.effort.pick(5, 21));
        let mut points = Vec::new();
        let mut panels = Vec::new();
        let part = |levels: &[[f64; 3]]| {
            cropped(&shown(levels, size), [size[0] / 4, size[1] / 6], [size[0] / 2, size[1] * 2 / 3])
        };
        panels.push(Panel { name: "exact".to_owned(), picture: part(&found.truth) });
        for outcome in &found.outcomes {
            let map = flip::flip(&found.truth, &outcome.picture, size[0] as usize, flip::PIXELS_PER_DEGREE);
            let error = ErrorFigures {
                mean: Some(flip::mean(&map)),
                maximum: Some(map.iter().copied().fold(0.0, f64::max)),
                samples: map.len() as u64,
                ..ErrorFigures::default()
            };
            let price = price(outcome.clocks, &outcome.nanoseconds, u64::from(size[0]) * u64::from(size[1]));
            points.push(Point { setting: outcome.way.name().to_owned(), error, price });
            table.rows.push(vec![
                name.as_str().into(),
                outcome.way.name().into(),
                psnr(&found.truth, &outcome.picture).into(),
            ]);
            panels.push(Panel { name: outcome.way.name().to_owned(), picture: part(&outcome.picture) });
            let levels: Vec<f64> = map.iter().map(|difference| difference * 255.0).collect();
            let whole = heat(&levels, size);
            let picture = cropped(&whole, [size[0] / 4, size[1] / 6], [size[0] / 2, size[1] * 2 / 3]);
            panels.push(Panel { name: format!("FLIP of {}", outcome.way.name()), picture });
        }
        let caption = "FLIP maps: white looks the same, black looks altogether different.".to_owned();
        section.strips.push(Strip { title: name.clone(), panels, caption });
        let measure = "FLIP against light at each pixel in f64".to_owned();
        section.sweeps.push(Sweep { scene: name, measure, unit: "FLIP", by: By::Mean, points });
    }
    section.findings = section.sweeps.iter().flat_map(sentences).collect();
    section.tables.push(table);
    Ok(section)
}
