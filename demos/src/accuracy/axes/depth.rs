//! Depths: fraction bits of their gradients, and bits of what is stored.

use zga_tests::oracle::DepthFormat;
use zga_tests::study::card::{Setting, error_of_rate};
use zga_tests::study::{drift, visibility};

use super::super::context::Context;
use super::super::model;
use super::super::report::{By, ErrorFigures, Point, Section, Sweep};
use super::super::verdict::sentences;
use super::{magnified, mesh_name, pictures, price};
use crate::error::Result;

const FRACTIONS: [u32; 4] = [0, 8, 16, 24];

/// Fraction bits: how far depths drift over the widest target.
pub fn fraction(context: &mut Context<'_>) -> Result<Section> {
    let formats = FRACTIONS.map(|fraction| DepthFormat { bits: 24, fraction });
    let found = drift::of_card(&formats, context.effort.pick(12, 120), context.threads, context.seed);
    let published = [7700.0, 31.0, 0.12, 0.0004];
    let pixels = (drift::STRIP[0] * drift::STRIP[1]) as usize;
    let points = FRACTIONS.iter().zip(&found).zip(published).map(|((fraction, drift), published)| {
        let error = ErrorFigures {
            mean: Some(drift.mean),
            maximum: Some(drift.largest),
            samples: drift.samples,
            published: Some(published),
            ..ErrorFigures::default()
        };
        Point { setting: format!("F{fraction}"), error, price: price(&drift.drawn, pixels) }
    });
    let strip = Sweep {
        scene: "planes over 16384 pixels".to_owned(),
        measure: "largest drift of a depth".to_owned(),
        unit: "LSB",
        by: By::Maximum,
        points: points.collect(),
    };
    let settings: Vec<(String, Setting)> = formats
        .iter()
        .map(|depth| (format!("F{}", depth.fraction), Setting { depth: *depth, ..Setting::best() }))
        .collect();
    let scene = model::crossing(&context.mesh, context.size);
    let name = format!("two crossing copies of {}", mesh_name(context));
    let mesh = pictures(context, &name, &scene, &settings, By::Mean);
    let shown = [("F0", mesh.drawn[0].colour.as_slice()), ("F24", mesh.drawn[3].colour.as_slice())];
    let strips =
        vec![magnified("Where F0 is worst", &mesh.truth, &shown, "Differences: white none, black 128 levels or more.")];
    let sweeps = vec![strip, mesh.sweep];
    Ok(Section {
        name: "depth-fraction",
        title: "Depth fraction: bits behind the point of a depth's gradient".to_owned(),
        about: vec![
            "A depth is added up pixel by pixel, so what its gradient lacks grows with the distance. Random planes through the \
             whole range over a strip 16384 pixels wide, depths of 24 bits, each against the exact plane. The mean includes the \
             rounding to a whole step; the drift is what the largest distance has beyond that half step."
                .to_owned(),
        ],
        findings: sweeps.iter().flat_map(sentences).collect(),
        sweeps,
        strips,
        notes: vec![
            "The published drifts are the largest of another random sample; the bound is (|i| + |j| + 1) 2^-(F+1) LSB, 8192 for F0. \
             Largest values of so few planes scatter by tens of percent."
                .to_owned(),
        ],
        ..Section::default()
    })
}

/// Bits of a depth and of its fraction: how often the farther of two near planes is seen.
pub fn bits(context: &mut Context<'_>) -> Result<Section> {
    let formats: Vec<DepthFormat> =
        [16, 24, 31].into_iter().flat_map(|bits| FRACTIONS.map(|fraction| DepthFormat { bits, fraction })).collect();
    let name = |format: &DepthFormat| format!("Z{} F{}", format.bits, format.fraction);
    let settings: Vec<(String, Setting)> =
        formats.iter().map(|depth| (name(depth), Setting { depth: *depth, ..Setting::best() })).collect();
    let scene = model::crossing(&context.mesh, context.size);
    let scene_name = format!("two crossing copies of {}", mesh_name(context));
    let mesh = pictures(context, &scene_name, &scene, &settings, By::Mean);
    let samples = context.effort.pick(1500, 25_000);
    let published = |format: &DepthFormat| -> Option<f64> {
        match (format.bits, format.fraction) {
            (16, 0) => Some(34.0),
            (16, 8) => Some(21.0),
            (16, 16) => Some(5.1),
            (24, 0) => Some(17.0),
            (24, 8) => Some(0.12),
            (24, 16) => Some(0.0),
            _ => None,
        }
    };
    let mut points = Vec::new();
    let mut far = Vec::new();
    for (format, priced) in formats.iter().zip(&mesh.sweep.points) {
        context.tell(&format!("near planes, {}", name(format)));
        let found = visibility::of_card(*format, samples, context.seed);
        let noise = error_of_rate(found.wrong, found.samples);
        let theirs = published(format);
        if let Some(theirs) = theirs {
            // They were taken from about 2500 samples too.
            let their_noise = error_of_rate((theirs * 25.0).round() as u64, 2500);
            if (found.rate() - theirs).abs() > 3.0 * noise.hypot(their_noise) {
                far.push(format!("{} ({:.1} %, published {theirs} %)", name(format), found.rate()));
            }
        }
        let error = ErrorFigures {
            rate: Some(found.rate()),
            standard_error: Some(noise),
            samples: found.samples,
            published: theirs,
            ..ErrorFigures::default()
        };
        points.push(Point { setting: name(format), error, price: priced.price });
    }
    let planes = Sweep {
        scene: "planes that nearly coincide".to_owned(),
        measure: "wrong one seen".to_owned(),
        unit: "",
        by: By::Rate,
        points,
    };
    let mut notes = vec!["The price beside the near planes is that of the crossing meshes.".to_owned()];
    notes.push(if far.is_empty() {
        "All rates agree with the published ones within three standard errors of both.".to_owned()
    } else {
        format!(
            "Beyond sampling noise from the published rates: {}. Those are of another distribution of triangles, good for the \
             order of magnitude; here corners are uniform within 8192 pixels of the pixel looked at, depths uniform in the middle \
             80 % of the range, and the two planes within 1e-4 of the range of each other.",
            far.join(", ")
        )
    });
    let sweeps = vec![planes, mesh.sweep];
    Ok(Section {
        name: "depth-bits",
        title: "Depth bits: width of a stored depth, and of its fraction".to_owned(),
        about: vec![
            "Two large random triangles meet a pixel at depths that differ by at most a ten-thousandth of the range. Exact \
             arithmetic says which is nearer; how often does the card show the other?"
                .to_owned(),
        ],
        findings: sweeps.iter().flat_map(sentences).collect(),
        sweeps,
        notes,
        ..Section::default()
    })
}
