//! Texture filters, by FLIP and PSNR against the texture integrated over each pixel.

use zga_tests::study::filter::{Found, View, of_card};
use zga_tests::study::{flip, psnr::psnr};

use super::super::context::Context;
use super::super::report::{By, ErrorFigures, Panel, Point, Price, Section, Strip, Sweep, Table};
use super::super::verdict::sentences;
use super::{cropped, heat};
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
             that runs to the far shows texels smaller than pixels, a near wall larger ones."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut table = Table::new(
        "The same pictures by PSNR, and how far the card is from the same filter in f64",
        &[("view", ""), ("filter", ""), ("PSNR", "dB"), ("rounding, mean", "levels"), ("rounding, largest", "levels")],
    );
    for (view, name) in [(View::Floor, "floor, minified"), (View::Wall, "wall, magnified")] {
        context.tell(name);
        let samples = context.effort.pick(12, 32);
        let repeats = context.effort.pick(5, 21);
        let found = of_card(view, context.size, samples, context.threads, repeats, context.seed);
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
                name.into(),
                outcome.way.name().into(),
                psnr(&found.truth, &outcome.picture).into(),
                outcome.rounding[0].into(),
                outcome.rounding[1].into(),
            ]);
            maps.push(map);
        }
        section.strips.push(strip(name, &found, &maps));
        let measure = "FLIP against the true picture".to_owned();
        section.sweeps.push(Sweep { scene: name.to_owned(), measure, unit: "FLIP", by: By::Mean, points });
    }
    section.findings = section.sweeps.iter().flat_map(sentences).collect();
    section.tables.push(table);
    Ok(section)
}

/// A part of the true picture, of the filters and of their FLIP maps.
fn strip(name: &str, found: &Found, maps: &[Vec<f64>]) -> Strip {
    let size = found.size;
    let part = |whole: &Picture| cropped(whole, [size[0] / 2 - 40.min(size[0] / 2), 0], [80, 50]);
    let mut panels = vec![Panel { name: "exact".to_owned(), picture: part(&shown(&found.truth, size)) }];
    for (outcome, map) in
        found.outcomes.iter().zip(maps).filter(|(o, _)| o.way.levels || o.way.name().starts_with("near"))
    {
        let name = outcome.way.name();
        panels.push(Panel { name: name.to_owned(), picture: part(&shown(&outcome.picture, size)) });
        let levels: Vec<f64> = map.iter().map(|difference| difference * 255.0).collect();
        panels.push(Panel { name: format!("FLIP of {name}"), picture: part(&heat(&levels, size)) });
    }
    let caption = "FLIP maps: white looks the same, black looks altogether different.".to_owned();
    Strip { title: format!("{name}: true picture, filters, FLIP"), panels, caption }
}
