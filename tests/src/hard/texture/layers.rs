//! Case 55: translucent layers of one depth.

use super::{corner, sheet, ways};
use crate::hard::{Row, Tally};
use crate::harness::{Look, Random, Stage, State};
use crate::oracle::DepthFunction;
use crate::oracle::effects::Corner;

/// Case 55.
#[must_use]
pub fn equal_layers() -> Row {
    let size = [70, 67];
    let mut random = Random::new(55);
    // Sheets and triangles of one depth; a few before and behind them, of equal depths too.
    let mut layers: Vec<(Vec<Corner>, u32)> = Vec::new();
    for number in 0..24 {
        let z = [0.5, 0.5, 0.5, 0.25, 0.75][number % 5];
        let colour = random.bits() as u32 & 0x00FF_FFFF | (random.range(30, 254) as u32) << 24;
        let corners = if number % 3 == 0 {
            sheet(size, z, colour).to_vec()
        } else {
            let mut place = || [random.int(-20, 90) as f32, random.int(-20, 90) as f32];
            [place(), place(), place()].map(|place| corner(place, z, colour, [0.0; 2])).to_vec()
        };
        layers.push((corners, random.range(0, 3) as u32));
    }
    let mut tally = Tally::default();
    let mut first: Option<Vec<u32>> = None;
    let ways = ways();
    for options in &ways {
        for piece in [0, 1] {
            let mut stage = Stage::new(size, options, &[]);
            stage.clear([90, 80, 70, 255]);
            for (corners, mode) in &layers {
                let look = Look { mode: *mode, ..Look::default() };
                let state = State { blend: true, function: DepthFunction::LessEqual, piece, look, ..State::default() };
                stage.triangles(corners, &state);
            }
            let (picture, found, _) = stage.end();
            tally.compared(&found, || format!("{:?}", options.hidden));
            let same = first.get_or_insert_with(|| picture.colour.clone()) == &picture.colour;
            tally.expect(same, || format!("{:?}: another picture", options.hidden));
        }
    }
    Row {
        case: 55,
        name: "texture::equal_layers",
        construction: "24 translucent sheets and triangles at three depths, in four blend modes; 25 sizes of tiles and the other \
                       paths, both fidelities, two kernels, two ways of cutting into packets",
        property: "equal depths in order of submission: exactly the oracle's levels, one picture",
        measured: format!("{tally}; {} ways", 2 * ways.len()),
        passed: tally.wrong == 0,
    }
}
