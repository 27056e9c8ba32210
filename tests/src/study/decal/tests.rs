//! What the study must show, on few scenes; and exact answers that can be worked out by hand.

use super::survey::{Extent, LIMIT, covered, open, total};
use super::*;

fn of(scenes: Vec<Scene>) -> Vec<Subject> {
    subjects(scenes)
}

/// Patches up to the limit and bodies, near to far.
fn in_danger(projection: Projection) -> Vec<Subject> {
    let patches = [1.0, 4.0, 8.0].into_iter().flat_map(|tilt| open(projection, tilt, Extent::Few));
    of(patches.chain([bodies(projection)]).collect())
}

fn counts(subjects: &[Subject], desk: &mut Desk, cure: Cure) -> Counts {
    total(subjects, desk, cure).expect("drawn")
}

#[test]
fn decal_of_slope_eight_buries_nothing_up_to_tilt_eight() {
    let mut desk = Desk::new();
    for projection in Projection::ALL {
        let subjects = in_danger(projection);

        let without = counts(&subjects, &mut desk, Cure::Nothing);
        let marking = counts(&subjects, &mut desk, Cure::Decal(LIMIT));
        let surface = counts(&subjects, &mut desk, Cure::Surface(LIMIT));

        assert!(without.buried_within * 3 > without.seen_within, "{projection:?}: {without:?}");
        assert_eq!((marking.buried_within, surface.buried_within), (0, 0), "{projection:?}: {marking:?}, {surface:?}");
        assert!(marking.ties <= 3, "{projection:?}: {marking:?}");
    }
}

#[test]
fn constant_offset_that_buries_as_little_shows_more_through() {
    let mut desk = Desk::new();
    let subjects = of(vec![bodies(Projection::Perspective)]);
    let decal = counts(&subjects, &mut desk, Cure::Decal(LIMIT));

    // From a body 4 units away to one at 500: what the near one needs is a hundred units and more for the far one.
    let offsets =
        (0..12).map(|k| counts(&subjects, &mut desk, Cure::Offset { factor: 0.0, units: f64::from(1 << (k + 8)) }));
    let enough = offsets.into_iter().find(|found| found.buried <= decal.buried).expect("enough");

    assert!(enough.shown > 10 * decal.shown.max(1), "{enough:?} {decal:?}");
}

#[test]
fn usual_offset_shows_more_through_at_the_limit_in_a_parallel_projection() {
    let mut desk = Desk::new();
    let projection = Projection::Orthographic;
    let subjects = of([open(projection, LIMIT, Extent::Many), covered(projection, LIMIT, Extent::Few)].concat());
    let decal = counts(&subjects, &mut desk, Cure::Decal(LIMIT));

    // The least slope-scaled offset that buries no more, and the usual one. On flatter surfaces, which an offset follows
    // and a decal does not, it is the other way round: the report says where.
    let offsets =
        [0.5, 0.6, 0.7, 0.8, 0.9, 1.0].map(|factor| counts(&subjects, &mut desk, Cure::Offset { factor, units: 1.0 }));
    let usual = offsets[5];
    let enough = offsets.into_iter().find(|found| found.buried <= decal.buried).expect("enough");

    assert!(decal.shown <= enough.shown, "{decal:?} {enough:?}");
    assert!(decal.shown * 4 < usual.shown * 3, "{decal:?} {usual:?}");
}

#[test]
fn decal_of_the_planes_own_slope_shows_no_more_through_than_the_usual_offset() {
    let mut desk = Desk::new();
    for tilt in [0.0, 1.0, 4.0, 8.0, 16.0] {
        let subjects = of(covered(Projection::Orthographic, tilt, Extent::Few));

        // Points need |dz/dx| + |dz/dy|, which is 1.384 tilts where a plane falls away to 33 degrees.
        let decal = counts(&subjects, &mut desk, Cure::Decal(1.384 * tilt));
        let usual = counts(&subjects, &mut desk, Cure::Offset { factor: 1.0, units: 1.0 });

        assert_eq!((decal.buried - decal.ties, usual.buried), (0, 0), "tilt {tilt}: {decal:?} {usual:?}");
        assert!(decal.shown <= usual.shown, "tilt {tilt}: {decal:?} {usual:?}");
    }
}

#[test]
fn offset_of_nothing_equals_no_cure() {
    let mut desk = Desk::new();
    for projection in Projection::ALL {
        let subject = Subject::new(bodies(projection));
        let plain = subject.draw(&mut desk, Cure::Nothing).expect("drawn").picture;

        // Depths go through an f32, which is as fine as a step, so that equal depths may fall either way.
        let moved = subject.draw(&mut desk, Cure::Offset { factor: 0.0, units: 0.0 }).expect("drawn").picture;
        let surfaces = plain.iter().zip(&moved).filter(|(a, b)| a != b && **a != MARKING && **b != MARKING).count();

        assert_eq!(surfaces, 0, "{projection:?}");
    }
}

#[test]
fn markings_have_the_oracles_pixels_with_and_without_a_decal() {
    let mut desk = Desk::new();
    for projection in Projection::ALL {
        for scene in [bodies(projection), floor(projection)] {
            assert_eq!(Subject::new(scene).strays(&mut desk, LIMIT).expect("drawn"), [0; 3], "{projection:?}");
        }
    }
}

#[test]
fn exact_line_behind_half_a_sheet_is_seen_beside_it_and_undecided_at_its_border() {
    // Pixels of 1/64 unit from the middle of the target; a line along row 96 + 10, a sheet over its right part.
    let place = |x: f64, y: f64, z: f64| [x / 64.0, y / 64.0, z].map(|v| v as f32);
    let mut scene = Scene::new("half", Projection::Orthographic);
    let base = scene.sheet([(-80., -80.), (80., -80.), (-80., 80.), (80., 80.)].map(|(x, y)| place(x, y, -20.0)));
    scene
        .markings
        .push(Marking { ends: vec![place(-40.5, -10.25, -20.0), place(40.5, -10.25, -20.0)], carriers: base });
    scene.sheet([(7.0, -50.), (60., -50.), (7.0, 50.), (60., 50.)].map(|(x, y)| place(x, y, -19.0)));

    let subject = Subject::new(scene);

    // From x = -40.5 to before 40.5; pixel 96 is the first right of the middle. The sheet begins at its 7th.
    let answers: Vec<(u32, Answer)> =
        subject.pixels.iter().map(|fragment| (fragment.pixel[0], fragment.answer)).collect();
    let expected = |i: u32| if i < 96 + 7 { Answer::Seen } else { Answer::Hidden };
    assert_eq!(answers, (96 - 41..96 + 40).map(|i| (i, expected(i))).collect::<Vec<_>>());
    assert!(subject.pixels.iter().all(|fragment| fragment.pixel[1] == 96 + 10 && fragment.need == 0.0));
}

#[test]
fn exact_point_beside_a_border_is_undecided_where_its_centre_is_beyond() {
    let place = |x: f64, y: f64, z: f64| [x / 64.0, y / 64.0, z].map(|v| v as f32);
    let mut scene = Scene::new("points", Projection::Orthographic);
    let base = scene.sheet([(-80., -80.), (80., -80.), (-80., 80.), (80., 80.)].map(|(x, y)| place(x, y, -20.0)));
    // The sheet's left border at 7.25: centre 7.5 is covered, a point at 7.125 of the same pixel is not.
    scene.sheet([(7.25, -50.), (60., -50.), (7.25, 50.), (60., 50.)].map(|(x, y)| place(x, y, -19.0)));
    for (x, y) in [(7.125, 3.5), (7.375, 5.5), (6.5, 7.5)] {
        scene.markings.push(Marking { ends: vec![place(x, -y, -20.0)], carriers: base.clone() });
    }

    let answers: Vec<Answer> = Subject::new(scene).pixels.iter().map(|fragment| fragment.answer).collect();

    assert_eq!(answers, [Answer::Undecided, Answer::Hidden, Answer::Seen]);
}
