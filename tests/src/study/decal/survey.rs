//! The scenes of the study, and sums over them.

use zga_driver::DriverError;

use super::{Counts, Cure, Desk, Patch, Projection, Scene, Subject, bodies, floor};

/// Slope that the study asks about.
pub const LIMIT: f64 = 8.0;

/// Factors of slope-scaled polygon offsets that are tried; markings in all directions need 1/2 of the steeper gradient,
/// points up to 1.
pub const FACTORS: &[f64] = &[0.25, 0.5, 0.55, 0.6, 0.7, 0.8, 0.85, 0.9, 1.0, 1.5, 2.0, 4.0];

/// How many scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Each kind, few of each.
    Few,
    /// More tilts, directions and gaps.
    Many,
}

/// A patch's distance in the survey: the middle of the depth range, or 20 units.
const fn distance(projection: Projection) -> f64 {
    match projection {
        Projection::Orthographic => 500.0,
        Projection::Perspective => 20.0,
    }
}

/// Patches of a tilt without anything in front.
#[must_use]
pub fn open(projection: Projection, tilt: f64, extent: Extent) -> Vec<Scene> {
    let azimuths: &[f64] = if extent == Extent::Many { &[0.0, 15.0, 33.0, 45.0, 60.0, 90.0] } else { &[0.0, 33.0] };
    let patch = |&azimuth: &f64| {
        let patch = Patch { projection, tilt, azimuth, distance: distance(projection), reach: 80.0 };
        patch.marked(format!("tilt {tilt} to {azimuth} degrees"))
    };
    azimuths.iter().map(patch).collect()
}

/// Patches of a tilt behind parallel sheets, 1 to 12 pixels in front.
#[must_use]
pub fn covered(projection: Projection, tilt: f64, extent: Extent) -> Vec<Scene> {
    let gaps: &[f64] = if extent == Extent::Many { &[1.0, 2.0, 3.0, 5.0, 8.0, 12.0] } else { &[1.0, 3.0, 5.0, 8.0] };
    let patch = |&gap: &f64| {
        let patch = Patch { projection, tilt, azimuth: 33.0, distance: distance(projection), reach: 80.0 };
        patch.behind(format!("tilt {tilt}, {gap} pixels behind a sheet"), gap)
    };
    gaps.iter().map(patch).collect()
}

/// Everything in a projection.
#[must_use]
pub fn scenes(projection: Projection, extent: Extent) -> Vec<Scene> {
    let tilts: &[f64] = if extent == Extent::Many {
        &[0.5, 1.0, 2.0, 4.0, 6.0, 7.9, 8.0, 8.1, 10.0, 16.0, 32.0]
    } else {
        &[1.0, 4.0, 7.9, 8.0, 8.1, 16.0]
    };
    let sheets: &[f64] =
        if extent == Extent::Many { &[0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 16.0] } else { &[0.0, 4.0, 8.0, 16.0] };
    let mut scenes: Vec<Scene> = tilts.iter().flat_map(|&tilt| open(projection, tilt, extent)).collect();
    scenes.extend(sheets.iter().flat_map(|&tilt| covered(projection, tilt, extent)));
    scenes.extend([floor(projection), bodies(projection)]);
    scenes
}

/// The slope-scaled offset that is best by hindsight: of [`FACTORS`] with 1 unit the one that shows the fewest through of
/// those that bury no more than `buried` pixels, and what it makes of the subjects.
///
/// # Errors
/// What the driver refuses.
pub fn best_offset(subjects: &[Subject], desk: &mut Desk, buried: u64) -> Result<Option<(f64, Counts)>, DriverError> {
    let mut best: Option<(f64, Counts)> = None;
    for &factor in FACTORS {
        let found = total(subjects, desk, Cure::Offset { factor, units: 1.0 })?;
        if found.buried <= buried && best.is_none_or(|(_, best)| found.shown < best.shown) {
            best = Some((factor, found));
        }
    }
    Ok(best)
}

/// What a cure makes of all the subjects together, with [`LIMIT`].
///
/// # Errors
/// What the driver refuses.
pub fn total(subjects: &[Subject], desk: &mut Desk, cure: Cure) -> Result<Counts, DriverError> {
    let mut sum = Counts::default();
    for subject in subjects {
        let outcome = subject.draw(desk, cure)?;
        sum += subject.count(&outcome, LIMIT);
    }
    Ok(sum)
}
