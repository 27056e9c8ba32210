//! What is said of the figures.

use zga_tests::study::decal::survey::LIMIT;
use zga_tests::study::decal::{Counts, Cure, Desk, Patch, Projection, Subject};

use super::super::verdict::figure;
use super::measure::{Measured, Tilt};
use super::{Drawn, name, percent, shown};

pub(super) fn about() -> Vec<String> {
    [
        "A line on a surface is drawn at pixel centres up to half a pixel beside it, with the line's depth; where the surface \
         slopes it sinks. The decal transform moves markings toward the viewer by S/2K, enough for surfaces of slope S. \
         Too small an S buries marking pixels; a large one lets markings show through what lies closely in front.",
        "A fitted decal is told the surface of its markings (decal_on of the driver, surfaces in a scene's decal). Depth is linear on \
         the screen, so a plane has one gradient there, and half a pixel of it, the snap of vertices and the rounding of \
         depths are what its markings need: the driver moves them by that, and S is only the limit. The bound is proved beside \
         the code.",
        "Exact arithmetic says what must be seen: each pixel of a marking stands for the point of the true line at the same \
         major coordinate, and another surface hides it if it covers that point, unsnapped, and is strictly nearer there; all \
         in rationals from the vertices that the card was given. Pixels with the border of a surface between that point and \
         their centre are not counted. Buried: must be seen, and is not. Shown through: must be hidden, and is shown.",
        "Scenes, in both projections: lines in all directions, a curve and points on tilted planes, in the open and behind \
         parallel sheets 1 to 12 pixels in front; a floor up to the horizon; faceted bodies near to far with all edges marked. \
         The comparison of cures leaves out what is steeper than tilt 8 as a whole: planes of tilt 0, 1, 4, 8 and the bodies.",
    ]
    .map(str::to_owned)
    .to_vec()
}

pub(super) fn findings(measured: &Measured) -> Vec<String> {
    let name_of = measured.projection.name();
    let (decal, nothing) = (measured.of(Cure::Decal(LIMIT)), measured.of(Cure::Nothing));
    let mut said = vec![format!(
        "{name_of}: with S = 8, {} of {} marking pixels on surfaces up to slope 8 are buried, without a cure {}% of them{}.",
        decal.buried_within,
        decal.seen_within,
        figure(percent(nothing.buried_within, nothing.seen_within)),
        match decal.ties {
            0 => String::new(),
            ties => format!(
                "; {ties} more where marking and surface meet exactly (half a pixel off on slope 8), and the last step of \
                 depth decides"
            ),
        },
    )];
    if let Some((_, all)) = measured.slopes.iter().find(|(slope, _)| *slope == LIMIT) {
        let missed = all.buried - all.buried_within - all.ties;
        said.push(format!(
            "{name_of}: beyond the limit it wears off. Of {} marking pixels on surfaces steeper than 8 (up to 100), S = 8 buries \
             {}%.",
            all.seen - all.seen_within,
            figure(percent(missed, all.seen - all.seen_within))
        ));
    }
    let fitted = measured.of(Cure::Fitted(LIMIT));
    said.push(format!(
        "{name_of}: fitted to its surface, S up to 8, a decal buries {} of {} marking pixels on surfaces up to slope 8, half-pixel \
         ties and points among them, and shows {}% of what must be hidden; S = 8 for all shows {}%.",
        fitted.buried_within + fitted.ties,
        fitted.seen_within,
        figure(shown(&fitted)),
        figure(shown(&decal))
    ));
    for (cure, sloped, kind) in [
        (Cure::Decal(LIMIT), false, "constant"),
        (Cure::Decal(LIMIT), true, "slope-scaled"),
        (Cure::Fitted(LIMIT), true, "slope-scaled"),
    ] {
        let (own, who) = (measured.of(cure), name(cure));
        said.push(match measured.rival(cure, sloped) {
            Some((rival, counts)) => format!(
                "{name_of}: of the {kind} polygon offsets that bury as little as the {who} ({} pixels), the one that shows the \
                 fewest through is {}: {}% of what must be hidden, the decal {}%. {}",
                own.buried,
                name(rival),
                figure(shown(&counts)),
                figure(shown(&own)),
                if own.shown <= counts.shown { "The decal is no worse." } else { "The offset is better there." }
            ),
            None => format!(
                "{name_of}: no {kind} polygon offset that was tried buries as little as the {who} ({} pixels).",
                own.buried
            ),
        });
    }
    said.push(by_hindsight(measured));
    let better = |of: fn(&Tilt) -> &Counts| {
        let some = measured.tilts.iter().filter(|found| found.tilt <= LIMIT && of(found).shown <= found.usual.shown);
        let some: Vec<String> = some.map(|found| found.tilt.to_string()).collect();
        if some.is_empty() { "none".to_owned() } else { some.join(", ") }
    };
    said.push(format!(
        "{name_of}: a decal moves by S/2K whatever the slope, a slope-scaled offset by the slope of each triangle. Of the tilts 0 \
         to 8 the decal with S = 8 shows no more through than polygon offset 1, 1 at {}; with S = 1.39 tilts, which its \
         points need, at {}.",
        better(|found| &found.decal),
        better(|found| &found.own)
    ));
    said
}

/// The fitted decal beside the offset whose factor is the best for each tilt by itself.
fn by_hindsight(measured: &Measured) -> String {
    let within: Vec<_> = measured.tilts.iter().filter(|found| found.tilt <= LIMIT).collect();
    let worse = within.iter().filter(|found| found.best.is_some_and(|(_, best)| found.fitted.shown > best.shown));
    let worse: Vec<String> = worse.map(|found| found.tilt.to_string()).collect();
    let factors: Vec<String> = within
        .iter()
        .map(|found| found.best.map_or_else(|| "-".to_owned(), |(factor, _)| factor.to_string()))
        .collect();
    format!(
        "{}: even if the offset's factor is chosen for each tilt by hindsight, so that it buries no more than the fitted decal (tilts 0 \
         to 8: {}), the fitted decal shows {} through at {}. It wins by moving lines by what lines need and points by what points \
         need: of lines alone, an offset whose factor is known to be 0.5 and a little would show as much.",
        measured.projection.name(),
        factors.join(", "),
        if worse.is_empty() { "no more" } else { "more" },
        if worse.is_empty() { "every one".to_owned() } else { worse.join(", ") }
    )
}

/// What points need.
pub(super) fn points(desk: &mut Desk) -> Drawn<String> {
    let patch =
        Patch { projection: Projection::Orthographic, tilt: LIMIT, azimuth: 45.0, distance: 500.0, reach: 80.0 };
    let subject = Subject::new(patch.marked("points"));
    let mut of = |slope| subject.draw(desk, Cure::Decal(slope)).map(|outcome| subject.count(&outcome, slope).buried);
    let (limit, sum) = (of(LIMIT)?, of(LIMIT * std::f64::consts::SQRT_2)?);
    Ok(format!(
        "Points are off by half a pixel in both axes, so for them S must reach |dz/dx| + |dz/dy|: on tilt 8 along the diagonal \
         S = 8 buries {limit} points, S = 11.3 {sum}."
    ))
}

pub(super) fn notes() -> Vec<String> {
    [
        "A decal costs no clocks: it is one matrix more in a product that is made once a state. Polygon offset needs the \
         gradient of each triangle; the card has none, so the host transforms the triangles and adds it to their vertices, \
         as a driver without decals would.",
        "In perspective the tilt of a plane is its steepest slope on the patch, the change of distance over a pixel in units of a \
         pixel's size there; elsewhere it is flatter. All pixels are judged by the slope at their place.",
        "Vertices off the card's grid are snapped by up to 1/512 pixel: on a slope between S / (1 + 1/64) and S a marking may \
         lose single pixels by that. The orthographic patches lie on the grid.",
        "Factors of slope-scaled offsets are those of the table, with 1 unit; the best by hindsight is the one that shows the fewest through \
         of those that bury no more than the fitted decal. A driver cannot know it; the fitted decal's displacement is a proved bound.",
        "Depths have 24 bits. Where an offset falls under one step the driver warns: hard case 47 (zga stability 47).",
    ]
    .map(str::to_owned)
    .to_vec()
}
