//! Cases 46 and 49: what must be seen and what must be hidden, by exact arithmetic.

use super::{Row, Tally, refused};
use crate::study::decal::{Counts, Cure, Desk, Patch, Projection, Subject, subjects};

const LIMIT: f64 = 8.0;

/// Case 46.
#[must_use]
pub fn nothing_buried_up_to_the_limit() -> Row {
    let mut scenes = Vec::new();
    for projection in Projection::ALL {
        let distances = match projection {
            // Far enough from the near plane that the steepest patch lies behind it.
            Projection::Orthographic => [120.0, 500.0, 890.0],
            Projection::Perspective => [3.0, 40.0, 250.0],
        };
        for (distance, tilt) in distances.into_iter().flat_map(|far| [1.0, 4.0, 7.9, 8.0, 8.1].map(|tilt| (far, tilt)))
        {
            for azimuth in [0.0, 90.0, 33.0] {
                let patch = Patch { projection, tilt, azimuth, distance, reach: 80.0 };
                scenes.push(patch.marked(format!("tilt {tilt} to {azimuth} degrees at {distance}")));
            }
        }
    }
    let (mut tally, mut desk) = (Tally::default(), Desk::new());
    let (mut all, mut without) = (Counts::default(), Counts::default());
    for subject in subjects(scenes) {
        for (cure, sum) in [(Cure::Decal(LIMIT), &mut all), (Cure::Nothing, &mut without)] {
            match subject.draw(&mut desk, cure) {
                Ok(outcome) => {
                    let counts = subject.count(&outcome, LIMIT);
                    tally.pictures += 1;
                    tally.pixels += counts.seen as usize;
                    if cure != Cure::Nothing {
                        tally.note(counts.buried_within as usize, || subject.scene.name.clone());
                    }
                    *sum += counts;
                }
                Err(error) => refused(&mut tally, &error),
            }
        }
    }
    let Counts { seen_within, buried, buried_within, ties, .. } = all;
    let beyond = (all.seen - seen_within, buried - buried_within - ties);
    Row {
        case: 46,
        name: "decals::nothing_buried_up_to_the_limit",
        construction: "lines in 24 directions, a curve and points on planes of tan 1, 4, 7.9, 8, 8.1, three ways round, near to far, \
                       in both projections; S = 8",
        property: "no marking pixel buried where |dz/dx| and |dz/dy| (of a point their sum) are up to S; beyond it counted. \
                   Where a pixel is half a pixel off on slope S exactly, marking and surface meet, and the last step of depth \
                   may decide",
        measured: format!(
            "{buried_within} of {seen_within} buried up to S, {ties} more where they meet, {} of {} beyond; without decals {}; \
             {tally}",
            beyond.1, beyond.0, without.buried
        ),
        // Something must be in danger, and some of it beyond the limit.
        passed: tally.wrong == 0 && ties <= 9 && beyond.0 > 0 && without.buried_within > seen_within / 10,
    }
}

/// Case 49.
#[must_use]
pub fn occluder_at_the_offset() -> Row {
    let (mut tally, mut desk) = (Tally::default(), Desk::new());
    let mut at_one = Vec::new();
    for (projection, distance) in
        [(Projection::Orthographic, 20.0), (Projection::Perspective, 20.0), (Projection::Perspective, 3.0)]
    {
        // A step of depth in pixels of distance: 999 units are 2^24 - 1 steps; in perspective (d^2 - d S / 2K) as many.
        let per_step = match projection {
            Projection::Orthographic => 999.0 / 16_777_215.0,
            Projection::Perspective => 0.999 * distance * distance / 16_777_215.0,
        };
        let step = per_step / projection.pixel(distance);
        let patch = Patch { projection, tilt: 0.0, azimuth: 0.0, distance, reach: 80.0 };
        let mut share = |slope: f64, gap: f64| -> Option<(u64, u64)> {
            let subject = Subject::new(patch.behind("", gap));
            let drawn = subject.draw(&mut desk, Cure::Decal(slope));
            drawn.ok().map(|outcome| subject.count(&outcome, slope)).map(|counts| (counts.shown, counts.hidden))
        };
        for slope in [2.0, 8.0, 40.0] {
            let offset = slope / 2.0;
            // Occluders at parts of the offset, then at it give or take steps; two steps are beyond all roundings.
            let gaps = [(offset / 2.0, Some(true)), (offset - 2.0 * step, Some(true)), (offset, None)];
            for (gap, through) in
                gaps.into_iter().chain([(offset + 2.0 * step, Some(false)), (2.0 * offset, Some(false))])
            {
                let Some((shown, hidden)) = share(slope, gap) else {
                    refused(&mut tally, &format!("slope {slope}"));
                    continue;
                };
                tally.pictures += 1;
                tally.pixels += hidden as usize;
                match through {
                    Some(true) => tally.note((hidden - shown) as usize, || format!("gap {gap} of {offset}: hidden")),
                    Some(false) => tally.note(shown as usize, || format!("gap {gap} of {offset}: shown")),
                    None => at_one.push(shown * 100 / hidden.max(1)),
                }
            }
        }
    }
    Row {
        case: 49,
        name: "decals::occluder_at_the_offset",
        construction: "a sheet in front of flat markings at 1/2, 1 - 2 steps, 1, 1 + 2 steps and 2 times S/2K; S = 2, 8, 40; \
                       both projections, two distances",
        property: "shows through only below 1, give or take 1 step of depth for the rounding of each",
        measured: format!("{tally}; at 1 exactly {at_one:?} % show through"),
        passed: tally.wrong == 0 && tally.pictures == 45 && tally.pixels > 10_000,
    }
}
