//! Texture filters, by FLIP and PSNR against the texture integrated over each pixel.

use zga_tests::harness::Random;
use zga_tests::study::filter::{Found, Textured, View, of_card};
use zga_tests::study::{flip, psnr::psnr};

use super::super::context::Context;
use super::super::model;
use super::super::report::{By, ErrorFigures, Panel, Point, Price, Section, Strip, Sweep, Table};
use super::super::verdict::sentences;
use super::{cropped, heat, mesh_name};
use crate::error::Result;
use crate::picture::Picture;

/// A picture of levels, rounded.
pub(super) fn shown(levels: &[[f64; 3]], [width, height]: [u32; 2]) -> Picture {
    Picture { width, height, rgb: levels.iter().flatten().map(|level| level.round().clamp(0.0, 255.0) as u8).collect() }
}

/// Middle of rising times for each pixel, and half the distance between the quartiles.
pub(super) fn price(clocks: u64, times: &[f64], pixels: u64) -> Price {
    let pixels = pixels.max(1) as f64;
    let at = |part: usize| times.get(times.len() * part / 4).map(|time| time / pixels);
    let spread = at(3).zip(at(1)).map(|(three, one)| (three - one) / 2.0);
    Price { clocks: Some(clocks as f64 / pixels), nanoseconds: at(2), spread }
}

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let mut section = Section {
        name: "texture",
        title: "Texture filter: what is between texels".to_owned(),
        about: vec![
            "The true colour of a pixel is the mean of the texture over it, worked out in f64 from hundreds of rays. FLIP (Andersson \
             et al. 2020) says how different two pictures look to an eye, 0 to 1; PSNR how far apart their numbers are. A floor \
             that runs to the far shows texels smaller than pixels, a near wall larger ones; 60 random triangles both, and so does the mesh, \
             with its own texture coordinates if it has them, else wrapped round its vertical. A pixel's texture is that of the triangle \
             that is seen at its centre."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut table = Table::new(
        "The same pictures by PSNR, and how far the card is from the same filter in f64",
        &[("view", ""), ("filter", ""), ("PSNR", "dB"), ("rounding, mean", "levels"), ("rounding, largest", "levels")],
    );
    let height = context.size[1];
    let subjects = [
        ("floor, minified".to_owned(), View::Floor.textured(height)),
        ("wall, magnified".to_owned(), View::Wall.textured(height)),
        ("random triangles".to_owned(), Textured::random(context.size, &mut Random::new(context.seed))),
        (mesh_name(context), Textured { corners: model::textured(&context.mesh, context.size, 25.0), first_row: 0 }),
    ];
    for (name, subject) in &subjects {
        context.tell(name);
        let samples = context.effort.pick(12, 32);
        let repeats = context.effort.pick(11, 31);
        let found = of_card(subject, context.size, samples, context.threads, repeats, context.seed);
        let mut points = Vec::new();
        let mut maps = Vec::new();
        for outcome in &found.outcomes {
            let map = flip::flip(&found.truth, &outcome.picture, found.size[0] as usize, flip::PIXELS_PER_DEGREE);
            let error = ErrorFigures {
                mean: Some(flip::mean(&map)),
                maximum: Some(map.iter().copied().fold(0.0, f64::max)),
                samples: map.len() as u64,
                ..ErrorFigures::default()
            };
            let price = price(outcome.clocks, &outcome.nanoseconds, found.pixels);
            points.push(Point { setting: outcome.way.name().to_owned(), error, price });
            table.rows.push(vec![
                name.as_str().into(),
                outcome.way.name().into(),
                psnr(&found.truth, &outcome.picture).into(),
                outcome.rounding[0].into(),
                outcome.rounding[1].into(),
            ]);
            maps.push(map);
        }
        section.strips.push(strip(name, &found, &maps));
        let measure = "FLIP against the true picture".to_owned();
        section.sweeps.push(Sweep { scene: name.clone(), measure, unit: "FLIP", by: By::Mean, points });
    }
    section.findings = section.sweeps.iter().flat_map(sentences).collect();
    section.tables.push(table);
    Ok(section)
}

/// A part of the true picture, of the filters and of their FLIP maps.
fn strip(name: &str, found: &Found, maps: &[Vec<f64>]) -> Strip {
    let size = found.size;
    // What fills the picture is best looked at near its edge, a mesh in the middle.
    let top = if found.truth[0] == [0.0; 3] { (size[1] / 2).saturating_sub(25) } else { 0 };
    let part = |whole: &Picture| cropped(whole, [size[0] / 2 - 40.min(size[0] / 2), top], [80, 50]);
    let mut panels = Vec::new();
    for (outcome, map) in found.outcomes.iter().zip(maps).filter(|(outcome, _)| outcome.way.levels) {
        let levels: Vec<f64> = map.iter().map(|difference| difference * 255.0).collect();
        panels.push(Panel { name: "true picture".to_owned(), picture: part(&shown(&found.truth, size)) });
        panels.push(Panel { name: outcome.way.name().to_owned(), picture: part(&shown(&outcome.picture, size)) });
        panels.push(Panel { name: "FLIP".to_owned(), picture: part(&heat(&levels, size)) });
    }
    let caption = "FLIP maps: white looks the same, black looks altogether different.".to_owned();
    Strip { title: format!("{name}: true picture, filters, FLIP"), panels, caption }
}
