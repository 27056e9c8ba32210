//! Bits of a coordinate behind the point.

use zga_tests::study::card::{Setting, error_of_rate};
use zga_tests::study::coordinates::{BITS, of_card, vertex_error};

use super::super::context::Context;
use super::super::report::{By, Section};
use super::super::verdict::sentences;
use super::{pictures, scenes};
use crate::error::Result;

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let mut section = Section {
        name: "coordinates",
        title: "Coordinate bits: the grid that vertices are snapped to".to_owned(),
        about: vec![
            "Vertices are moved to the nearest 1/16 or 1/256 pixel before anything is decided. With one sample a pixel: pixels whose \
             centre shows another triangle than the unsnapped vertices say. The price is that of the same pictures."
                .to_owned(),
        ],
        ..Section::default()
    };
    let settings = BITS.map(|bits| (format!("{bits} bits"), Setting { coordinate_bits: bits, ..Setting::centres() }));
    for (name, scene) in scenes(context) {
        let mut sweep = pictures(context, &name, &scene, &settings, By::Rate).sweep;
        sweep.measure = "pixels that show another triangle".to_owned();
        sweep.unit = "px";
        for (point, (_, setting)) in sweep.points.iter_mut().zip(&settings) {
            let found = of_card(&scene, setting);
            point.error.rate = Some(100.0 * found.wrong as f64 / found.pixels.max(1) as f64);
            point.error.standard_error = Some(error_of_rate(found.wrong, found.pixels));
            (point.error.mean, point.error.maximum) = (None, Some(vertex_error(setting.coordinate_bits)));
        }
        section.sweeps.push(sweep);
    }
    section.findings = section.sweeps.iter().flat_map(sentences).collect();
    section.notes = vec![
        "Largest error: how far a vertex can move along an axis, half a step of the grid: 1/32 and 1/512 pixel, as published."
            .to_owned(),
    ];
    Ok(section)
}
