//! Decals fitted to their surface: nothing buried up to the limit, and no more shown through than by the slope-scaled
//! polygon offset that is best by hindsight.

use zga_abi::format::DepthFormat;

use super::survey::{Extent, LIMIT, best_offset, covered, open, total};
use super::*;
use crate::harness::Random;

/// Tilts up to the limit.
const TILTS: [f64; 7] = [0.0, 0.5, 1.0, 2.0, 4.0, 7.9, 8.0];

/// Seeds of this run: 4, and with `ZGA_LONG=1` 32.
fn seeds() -> std::ops::Range<u64> {
    let long = std::env::var("ZGA_LONG").is_ok_and(|value| value == "1");
    0..if long { 32 } else { 4 }
}

/// A patch of a tilt anywhere in the depth range, falling away anywhere, off the card's grid: in the open, and behind sheets.
fn random(projection: Projection, tilt: f64, seed: u64) -> Vec<Subject> {
    let mut random = Random::new(seed << 8 | (tilt * 10.0) as u64);
    let mut patch = || {
        let distance = match projection {
            // Far enough from the ends of the depth range that a patch of tilt 8 lies within.
            Projection::Orthographic => random.between(40.0, 960.0),
            Projection::Perspective => 3.0 * 60.0_f64.powf(random.unit()),
        };
        let (azimuth, reach) = (random.between(0.0, 360.0), random.between(60.0, 80.0));
        let by = [0; 2].map(|_| random.between(-0.5, 0.5));
        (Patch { projection, tilt, azimuth, distance, reach }, by, random.between(0.5, 9.0))
    };
    let (in_the_open, by, _) = patch();
    let mut scenes = vec![in_the_open.marked(format!("seed {seed}, tilt {tilt}")).shifted(by)];
    for _ in 0..2 {
        let (patch, by, gap) = patch();
        scenes.push(patch.behind(format!("seed {seed}, tilt {tilt}, {gap} behind a sheet"), gap).shifted(by));
    }
    subjects(scenes)
}

#[test]
fn fitted_decal_up_to_tilt_eight_buries_nothing_and_shows_no_more_than_the_best_offset() {
    let mut desk = Desk::new();
    for projection in Projection::ALL {
        for tilt in TILTS {
            let subjects: Vec<Subject> = seeds().flat_map(|seed| random(projection, tilt, seed)).collect();

            let fitted = total(&subjects, &mut desk, Cure::Fitted(LIMIT)).expect("drawn");
            let plain = total(&subjects, &mut desk, Cure::Decal(LIMIT)).expect("drawn");
            let best = best_offset(&subjects, &mut desk, fitted.buried).expect("drawn");

            // Points and ties too, on which S = 8 has less to spare.
            assert_eq!(fitted.buried, 0, "{projection:?}, tilt {tilt}: {fitted:?}");
            assert!(fitted.hidden > 500 && fitted.shown <= plain.shown, "{projection:?}, {tilt}: {fitted:?} {plain:?}");
            let (factor, best) = best.expect("a factor of 4 buries nothing");
            assert!(fitted.shown <= best.shown, "{projection:?}, {tilt}: {fitted:?}, offset {factor}, 1 {best:?}");
        }
    }
}

#[test]
fn fitted_decal_on_the_surveys_patches_shows_no_more_than_any_offset_that_buries_as_little() {
    let mut desk = Desk::new();
    for projection in Projection::ALL {
        for tilt in [0.0, 1.0, 2.0, 4.0, 6.0, 7.9, 8.0] {
            let scenes = [open(projection, tilt, Extent::Few), covered(projection, tilt, Extent::Many)].concat();
            let subjects = subjects(scenes);

            let fitted = total(&subjects, &mut desk, Cure::Fitted(LIMIT)).expect("drawn");
            let (factor, best) = best_offset(&subjects, &mut desk, fitted.buried).expect("drawn").expect("one");

            assert_eq!(fitted.buried, 0, "{projection:?}, tilt {tilt}: {fitted:?}");
            assert!(fitted.shown <= best.shown, "{projection:?}, {tilt}: {fitted:?}, offset {factor}, 1 {best:?}");
        }
    }
}

#[test]
fn fitted_decal_on_bodies_buries_nothing_up_to_the_limit_and_shows_less_than_the_plain_one() {
    let mut desk = Desk::new();
    for projection in Projection::ALL {
        let bodies = [Subject::new(bodies(projection))];

        let fitted = total(&bodies, &mut desk, Cure::Fitted(LIMIT)).expect("drawn");
        let plain = total(&bodies, &mut desk, Cure::Decal(LIMIT)).expect("drawn");

        assert_eq!((fitted.buried_within, fitted.ties), (0, 0), "{projection:?}: {fitted:?}");
        assert!(fitted.buried <= plain.buried, "{projection:?}: {fitted:?} {plain:?}");
        assert!(fitted.shown < plain.shown, "{projection:?}: {fitted:?} {plain:?}");
    }
}

#[test]
fn fitted_decal_with_coarse_or_fine_depths_buries_nothing() {
    for (bits, fraction) in [(16, 8), (16, 24), (24, 0), (24, 8), (31, 24)] {
        let mut desk = Desk::with(DepthFormat::new(bits, fraction).expect("a format"));
        for projection in Projection::ALL {
            let subjects: Vec<Subject> =
                [0.5, 4.0, 8.0].into_iter().flat_map(|tilt| random(projection, tilt, 9)).collect();

            let fitted = total(&subjects, &mut desk, Cure::Fitted(LIMIT)).expect("drawn");

            assert_eq!(fitted.buried, 0, "Z{bits} F{fraction}, {projection:?}: {fitted:?}");
        }
    }
}

#[test]
fn fitted_decal_on_a_floor_that_is_partly_steeper_than_the_limit_buries_nothing_of_it() {
    let mut desk = Desk::new();
    let floor = [Subject::new(floor(Projection::Perspective))];

    // Its slope goes from 2 to 100: a part is within the limit, so all of it is followed.
    let fitted = total(&floor, &mut desk, Cure::Fitted(LIMIT)).expect("drawn");
    let plain = total(&floor, &mut desk, Cure::Decal(LIMIT)).expect("drawn");

    assert_eq!(fitted.buried, 0, "{fitted:?}");
    assert!(plain.buried > 100, "{plain:?}");
}
