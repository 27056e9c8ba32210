//! Case 47: offsets that the Z buffer cannot tell.

use super::{Row, Tally, refused};
use zga_abi::format::{DepthFormat, DepthFunction};
use zga_device::{Card, CardOptions};
use zga_driver::{Camera, Driver, DriverError, TargetOptions, Vertex, Warning};

const WIDTH: u32 = 2000;

/// Near 1, far 1000, K = 1000: 90 degrees over 2000 pixels.
const CAMERA: Camera = Camera::Perspective {
    eye: [0.0; 3],
    target: [0.0, 0.0, -1.0],
    up: [0.0, 1.0, 0.0],
    fov_x_degrees: 90.0,
    near: 1.0,
    far: 1000.0,
};

/// What was said and what the Z buffer holds.
struct Found {
    warned: Vec<f64>,
    /// Distance, and how many steps nearer the marking is stored.
    moved: Vec<(f64, i64)>,
    steps: [f64; 2],
}

fn measure(bits: u32, slope: f64) -> Result<Found, DriverError> {
    let card = Card::power_on(CardOptions::default()).map_err(|error| DriverError::BadOption {
        name: "card",
        found: error.to_string(),
        expected: "a card",
    })?;
    let mut driver = Driver::open(card.bus())?;
    let depth = DepthFormat::new(bits, 24);
    let target = driver.create_target(TargetOptions { depth, ..TargetOptions::new(WIDTH, 2) })?;
    driver.set_camera(CAMERA)?;
    let info = driver.decal_info(&target, slope)?;
    // A point in each column, from behind the near plane, where nothing can be nearer, to far; equally spaced in
    // 1 / distance and in distance by turns.
    let distances: Vec<f64> = (0..WIDTH)
        .map(|column| {
            let part = f64::from(column / 2) / f64::from(WIDTH / 2);
            if column % 2 == 0 { 1.002 / (1.0 - 0.9985 * part) } else { 1.002 + 998.0 * part }
        })
        .collect();
    let at = |(column, distance): (usize, &f64)| {
        let x = (column as f64 + 0.5 - 1000.0) / 1000.0 * distance;
        Vertex::new([x, 0.0005 * distance, -distance].map(|v| v as f32), [255; 4])
    };
    let points: Vec<Vertex> = distances.iter().enumerate().map(at).collect();
    let mut stored = Vec::new();
    for marked in [false, true] {
        driver.begin_scene(&target)?;
        driver.clear(Some([0, 0, 0, 255]), Some(1.0))?;
        driver.set_depth_function(DepthFunction::Always);
        if marked {
            driver.decal(slope, |driver| driver.draw_points(&points))?;
        } else {
            driver.draw_points(&points)?;
        }
        driver.end_scene()?;
        stored.push(driver.capture_depth(&target)?);
    }
    let warned = driver.take_warnings().into_iter().filter_map(|warning| match warning {
        Warning::DecalUnderOneStep { distance, .. } => Some(distance),
        Warning::DepthBeginsFar { .. } => None,
    });
    let nearer = |column: usize| i64::from(stored[0][column]) - i64::from(stored[1][column]);
    Ok(Found {
        warned: warned.collect(),
        moved: distances.iter().enumerate().map(|(column, &distance)| (distance, nearer(column))).collect(),
        steps: [info.depth_steps_near, info.depth_steps_far],
    })
}

/// Case 47.
#[must_use]
pub fn offset_under_one_step() -> Row {
    let mut tally = Tally::default();
    let mut said = Vec::new();
    // Slope, depth bits, and where the offset is one step by hand: near far / (far - near) * (S/2K) / (1 - S/2K) *
    // (2^n - 1) units from the viewer, if that is before the far plane.
    let by_hand = |bits: u32, slope: f64| {
        let part = slope / 2000.0;
        let distance = 1000.0 / 999.0 * part / (1.0 - part) * ((1_u64 << bits) - 1) as f64;
        (distance < 1000.0).then_some(distance.max(1.0))
    };
    for (bits, slope) in [16, 24, 31].into_iter().flat_map(|bits| [0.05, 0.5, 8.0, 64.0].map(|slope| (bits, slope))) {
        let found = match measure(bits, slope) {
            Ok(found) => found,
            Err(error) => {
                refused(&mut tally, &error);
                continue;
            }
        };
        let reach = by_hand(bits, slope);
        tally.pictures += 1;
        tally.pixels += found.moved.len();
        // The matrix entry is an f32: 1 - S/2K is good for 2^-24 of 1, so S/2K for 2^-25 / (S/2K) of itself.
        let slack = 1.0 + 2.0_f64.powi(-24) / (slope / 2000.0) + 1e-6;
        let near = |a: f64, b: f64| a / b < slack && b / a < slack;
        let right = match (reach, &found.warned[..]) {
            (Some(reach), &[distance]) => near(reach, distance),
            (None, []) => true,
            _ => false,
        };
        tally.expect(right, || format!("{bits} bits, S = {slope}: warned of {:?}, by hand {reach:?}", found.warned));
        let limit = reach.unwrap_or(f64::INFINITY);
        let wrong = found.moved.iter().filter(|&&(distance, steps)| {
            // Two stored depths that are one step apart or more differ; two that are less than one apart, by 0 or 1.
            if distance * slack < limit { steps < 1 } else { distance > limit * slack && !(0..=1).contains(&steps) }
        });
        tally.note(wrong.count(), || format!("{bits} bits, S = {slope}: {:?} steps", found.steps));
        said.extend(reach.map(|reach| format!("{bits} bits, S = {slope}: beyond {reach:.0}")));
    }
    Row {
        case: 47,
        name: "decals::offset_under_one_step",
        construction: "near 1, far 1000, K = 1000; points at 2000 distances with and without the offset; 16, 24 and 31 bits, \
                       S = 0.05, 0.5, 8, 64",
        property: "the driver says beyond which distance the offset is under one step, and only then; before it stored depths \
                   differ, beyond it by at most one step",
        measured: format!("warned {} times ({}); {tally}", said.len(), said.join(", ")),
        passed: tally.wrong == 0 && tally.pictures == 12 && !said.is_empty(),
    }
}
