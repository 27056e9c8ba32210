//! Parts of pictures with the wrong pixels marked.

use zga_tests::study::decal::survey::LIMIT;
use zga_tests::study::decal::{Answer, Cure, Desk, MARKING, Outcome, Patch, Projection, SIDE, Subject, bodies, place};

use super::super::context::picture;
use super::super::report::{Panel, Strip};
use super::measure::USUAL;
use super::{Drawn, name};

/// XRGB.
const BURIED: u32 = 0x00FF_2020;
const THROUGH: u32 = 0x00FF_40FF;

/// A part of a picture with the wrong pixels marked.
fn crop(subject: &Subject, outcome: &Outcome, [left, top]: [u32; 2], size: u32) -> crate::picture::Picture {
    // Markings in the pale colour of paper, so that what is wrong stands out.
    let mut marked: Vec<u32> =
        outcome.picture.iter().map(|&pixel| if pixel == MARKING { 0x00E8_E4D8 } else { pixel }).collect();
    for (fragment, &seen) in subject.pixels.iter().zip(&outcome.shown) {
        match (fragment.answer, seen) {
            (Answer::Seen, false) => marked[place(fragment.pixel)] = BURIED,
            (Answer::Hidden, true) => marked[place(fragment.pixel)] = THROUGH,
            _ => {}
        }
    }
    let rows = (top..top + size).flat_map(|j| (left..left + size).map(move |i| [i, j]));
    let pixels: Vec<u32> = rows.map(|pixel| marked[place(pixel)]).collect();
    picture([size, size], &pixels)
}

fn strip(desk: &mut Desk, subject: &Subject, corner: [u32; 2], size: u32, cures: &[Cure]) -> Drawn<Vec<Panel>> {
    let mut panels = Vec::new();
    for &cure in cures {
        let outcome = subject.draw(desk, cure)?;
        let counts = subject.count(&outcome, LIMIT);
        let name = format!("{}: {} buried, {} shown through", name(cure), counts.buried, counts.shown);
        panels.push(Panel { name, picture: crop(subject, &outcome, corner, size) });
    }
    Ok(panels)
}

pub(super) fn body_strip(desk: &mut Desk) -> Drawn<Strip> {
    let subject = Subject::new(bodies(Projection::Perspective));
    let constant = Cure::Offset { factor: 0.0, units: 16_384.0 };
    let cures = [Cure::Nothing, Cure::Decal(LIMIT), Cure::Fitted(LIMIT), Cure::Decal(64.0), USUAL, constant];
    Ok(Strip {
        title: "Faceted bodies 4 to 500 units away, all edges marked".to_owned(),
        panels: strip(desk, &subject, [0, 0], SIDE, &cures)?,
        caption: "Red: buried. Magenta: shown through. Counts are those of the whole picture.".to_owned(),
    })
}

pub(super) fn patch_strip(desk: &mut Desk) -> Drawn<Strip> {
    let patch =
        Patch { projection: Projection::Orthographic, tilt: LIMIT, azimuth: 33.0, distance: 500.0, reach: 80.0 };
    let subject = Subject::new(patch.behind("", 5.0));
    let cures = [Cure::Nothing, Cure::Decal(4.0), Cure::Decal(LIMIT), Cure::Fitted(LIMIT), Cure::Decal(16.0), USUAL];
    Ok(Strip {
        title: "A plane of tilt 8, five pixels behind a parallel sheet; the upper left corner".to_owned(),
        panels: strip(desk, &subject, [10, 10], 88, &cures)?,
        caption:
            "Red: buried, beside the sheet. Magenta: shown through the sheet. Counts are those of the whole picture."
                .to_owned(),
    })
}
