//! Cases 48, 50 and 51: what moves, and what does not.

use super::{Row, Tally, draw, matrix, refused, screen, state};
use crate::harness::{Random, Topology};
use crate::study::decal::{Projection, SIDE};

/// Vertices in eye space all over the view, some outside of it.
fn places(random: &mut Random, projection: Projection, count: usize) -> Vec<[f32; 3]> {
    let place = |random: &mut Random| {
        let distance = 1.5 * 500.0_f64.powf(random.unit());
        let pixel = projection.pixel(distance);
        let reach = 0.6 * f64::from(SIDE);
        let [x, y] = [0; 2].map(|_| random.between(-reach, reach) * pixel);
        [x, y, -distance].map(|v| v as f32)
    };
    (0..count).map(|_| place(random)).collect()
}

/// Case 48.
#[must_use]
pub fn same_pixels_with_and_without() -> Row {
    let mut tally = Tally::default();
    let mut random = Random::new(48);
    let mut moved = 0;
    for projection in Projection::ALL {
        let mut screen = screen();
        for topology in [Topology::Triangles, Topology::Lines, Topology::Points, Topology::LineStrip] {
            let places = places(&mut random, projection, 300);
            let mut plain = None;
            for slope in [None, Some(0.0), Some(1.0), Some(8.0), Some(64.0), Some(-8.0)] {
                let made = slope.map(|slope| matrix(projection, slope)).transpose();
                let state = match made.and_then(|decal| state(projection, decal)) {
                    Ok(state) => state,
                    Err(error) => {
                        refused(&mut tally, &error);
                        continue;
                    }
                };
                screen.clear();
                draw(&mut screen, topology, &places, 1, &state);
                let picture = screen.read();
                let plain = plain.get_or_insert_with(|| picture.clone());
                let differ = |a: &[u32], b: &[u32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
                tally.pictures += 1;
                tally.pixels += picture.drawn();
                tally.note(differ(&picture.colour, &plain.colour), || {
                    format!("{projection:?}, {topology:?}, S {slope:?}")
                });
                moved += differ(&picture.depth, &plain.depth);
            }
        }
    }
    Row {
        case: 48,
        name: "decals::same_pixels_with_and_without",
        construction: "300 random vertices as triangles, lines, points and a strip, some outside the view; S = none, 0, 1, 8, 64, -8; \
                       both projections",
        property: "every pixel shows the same primitive with and without the offset: x and y are bit-identical",
        measured: format!("{tally}; {moved} depths moved"),
        passed: tally.wrong == 0 && tally.pictures == 48 && moved > 10_000,
    }
}

/// Case 50.
#[must_use]
pub fn silhouettes_and_refusal() -> Row {
    let mut tally = Tally::default();
    let mut marked = 0;
    for projection in Projection::ALL {
        let mut screen = screen();
        // A tilted, turned quadrilateral; markings between points of it, the outermost a pixel and a half inside.
        let pixel = |distance: f64| projection.pixel(distance);
        let at = |x: f64, y: f64| {
            let distance = 40.0 / (1.0 - (x + y) / 400.0);
            [x * pixel(distance), y * pixel(distance), -distance].map(|v| v as f32)
        };
        let corners = [at(-70.0, -31.0), at(40.0, -66.0), at(-33.0, 58.0), at(71.0, 23.0)];
        let base = [corners[0], corners[1], corners[2], corners[2], corners[1], corners[3]];
        let inner = |s: f64, t: f64| {
            let mix = |a: f64, b: f64, part: f64| a + part * (b - a);
            let (s, t) = (0.5 + 0.966 * (s - 0.5), 0.5 + 0.966 * (t - 0.5));
            let x = mix(mix(-70.0, 40.0, s), mix(-33.0, 71.0, s), t);
            at(x, mix(mix(-31.0, -66.0, s), mix(58.0, 23.0, s), t))
        };
        let border = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(s, t)| inner(s, t));
        let mut lines: Vec<[f32; 3]> = (0..4).flat_map(|k| [border[k], border[(k + 1) % 4]]).collect();
        for k in 0..=20 {
            let part = f64::from(k) / 20.0;
            lines.extend([inner(part, 0.0), inner(1.0 - part, 1.0), inner(0.0, part), inner(1.0, part)]);
        }
        let most = 2.0 * projection.camera().pixels_per_unit(SIDE);
        for slope in [1.0, 8.0, 64.0, 0.9 * most, 0.999 * most] {
            let states = (state(projection, None), matrix(projection, slope).and_then(|m| state(projection, Some(m))));
            let (Ok(plain), Ok(decal)) = states else {
                refused(&mut tally, &format!("slope {slope}"));
                continue;
            };
            screen.clear();
            draw(&mut screen, Topology::Triangles, &base, 1, &plain);
            let under = screen.read();
            draw(&mut screen, Topology::Lines, &lines, 100, &decal);
            let over = screen.read();
            tally.pictures += 1;
            tally.pixels += under.drawn();
            let (over, under) = (over.winners(), under.winners());
            let outside = over.iter().zip(&under).filter(|(over, under)| over.is_some() && under.is_none());
            tally.note(outside.count(), || format!("{projection:?}, S = {slope}: outside the base"));
            marked += over.iter().zip(&under).filter(|(over, under)| over != under).count();
        }
    }
    let most = 2.0 * Projection::Perspective.camera().pixels_per_unit(SIDE);
    let answers = [0.999 * most, most, 1.5 * most, 1e9].map(|slope| matrix(Projection::Perspective, slope).is_ok());
    tally.expect(answers == [true, false, false, false], || format!("accepted in perspective: {answers:?}"));
    Row {
        case: 50,
        name: "decals::silhouettes_and_refusal",
        construction: "lines up to 1.5 pixels inside the border of a tilted quadrilateral, S up to 0.999 of 2K, both projections; \
                       S = 2K and more in perspective (in a parallel projection S/2K is a length, without limit)",
        property: "no marking pixel outside the base; S/2K >= 1 is refused",
        measured: format!("{tally}; {marked} marking pixels; S/2K = 0.999, 1, 1.5 and more accepted: {answers:?}"),
        passed: tally.wrong == 0 && tally.pictures == 10 && marked > 5_000,
    }
}

/// Case 51.
#[must_use]
pub fn edge_on_surface() -> Row {
    let mut tally = Tally::default();
    let mut marked = 0;
    for projection in Projection::ALL {
        let mut screen = screen();
        for (slope, tilt) in
            [8.0, 64.0].into_iter().flat_map(|slope| [1e4, 1e7, f64::INFINITY].map(|tilt| (slope, tilt)))
        {
            // A plane through the line of sight, or nearly: over `reach` it moves sideways by reach / tilt.
            let at = |y: f64, distance: f64| {
                let pixel = projection.pixel(distance);
                let x = (10.0 + (distance - 5.0) / tilt / pixel) * pixel;
                [x, y * pixel, -distance].map(|v| v as f32)
            };
            let base =
                [at(-60.0, 5.0), at(60.0, 5.0), at(-60.0, 900.0), at(-60.0, 900.0), at(60.0, 5.0), at(60.0, 900.0)];
            let lines =
                [at(-50.0, 6.0), at(50.0, 700.0), at(-40.0, 800.0), at(30.0, 7.0), at(0.0, 6.0), at(0.0, 800.0)];
            let states = (state(projection, None), matrix(projection, slope).and_then(|m| state(projection, Some(m))));
            let (Ok(plain), Ok(decal)) = states else {
                refused(&mut tally, &format!("slope {slope}"));
                continue;
            };
            screen.clear();
            screen.clear_counts();
            draw(&mut screen, Topology::Lines, &lines, 100, &plain);
            let without = screen.read();
            // A line seen from its end has no length on the screen.
            let dropped = screen.counts().discarded;
            screen.clear();
            draw(&mut screen, Topology::Triangles, &base, 1, &decal);
            // Triangles without area may be dropped; markings may not.
            screen.read();
            screen.clear_counts();
            draw(&mut screen, Topology::Lines, &lines, 100, &decal);
            let with = screen.read();
            tally.pictures += 1;
            tally.pixels += with.drawn();
            tally.expect(screen.counts().discarded == dropped, || "a marking was dropped".to_owned());
            // Lines have identities from 100 on; what is seen of the surface is none of them.
            let lines_of = |picture: &crate::harness::Picture| -> Vec<Option<u32>> {
                picture.winners().into_iter().map(|winner| winner.filter(|&id| id >= 99)).collect()
            };
            let (here, there) = (lines_of(&with), lines_of(&without));
            let moved = here.iter().zip(&there).filter(|(here, there)| here != there);
            tally.note(moved.count(), || format!("{projection:?}, S {slope}, tan {tilt}: other pixels"));
            // Nearer than without, and not on the near plane: the offset is finite.
            let pixels = (0..there.len()).filter(|&k| there[k].is_some());
            let wild = pixels.clone().filter(|&k| with.depth[k] >= without.depth[k] || with.depth[k] == 0);
            tally.note(wild.count(), || format!("{projection:?}, S {slope}, tan {tilt}: depths"));
            marked += pixels.count();
        }
    }
    Row {
        case: 51,
        name: "decals::edge_on_surface",
        construction: "markings on a plane of tan 10^4, 10^7 and one seen exactly from its edge, S = 8 and 64, both projections",
        property: "no 0 * Inf: no marking discarded but those without length, the same pixels as without the offset, every depth nearer by a finite amount",
        measured: format!("{tally}; {marked} marking pixels"),
        passed: tally.wrong == 0 && tally.pictures == 12 && marked > 1_000,
    }
}
