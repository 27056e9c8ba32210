//! Cases 19 to 21: depths of two pictures related to each other, and depths at their limits.

use super::formats;
use crate::hard::{Row, Tally};
use crate::harness::options::IDENTITY;
use crate::harness::scenes::fixed;
use crate::harness::{Camera, Options, Random, RawVertex, Screen, State, Topology, depth};
use crate::oracle::clip::stored_depth;
use crate::oracle::exact::from_f64;
use crate::oracle::{DepthFunction, Image, Primitive, Vertex, draw};

const SIZE: [u32; 2] = [120, 90];

/// A scene with other depths.
fn with_depths(scene: &[Primitive], mut z: impl FnMut(u32) -> u32) -> Vec<Primitive> {
    let mut change = |v: &Vertex| Vertex { z: z(v.z), ..*v };
    let primitive = |p: &Primitive| match p {
        Primitive::Triangle(v) => Primitive::Triangle([change(&v[0]), change(&v[1]), change(&v[2])]),
        Primitive::Line(v) => Primitive::Line([change(&v[0]), change(&v[1])]),
        Primitive::Point(v) => Primitive::Point(change(v)),
    };
    scene.iter().map(primitive).collect()
}

/// Case 19.
#[must_use]
pub fn offset_of_all_depths() -> Row {
    let (mut random, mut tally) = (Random::new(19), Tally::default());
    for format in formats() {
        let mut screen = Screen::new(SIZE[0], SIZE[1], &Options { depth: format, ..Options::default() });
        // Below 2^30 every multiple of 64 survives an f32 as it is, with 31 bits; with fewer bits every depth does.
        let unit = if format.bits == 31 { 64 } else { 1 };
        let half = format.greatest() / 2 / unit;
        let scene = with_depths(&fixed(190, SIZE, 150, 40), |_| random.depth(half / 2) * unit);
        let mut drawn = |scene: &[Primitive]| {
            screen.clear();
            screen.draw_ids(scene, &State::default());
            screen.read()
        };
        let first = drawn(&scene);
        for k in [1, 7, half / 3, half / 2] {
            let moved = drawn(&with_depths(&scene, |z| z + k * unit));
            tally.pictures += 1;
            tally.pixels += moved.depth.len();
            for (pixel, winner) in first.winners().iter().enumerate() {
                let expected = first.depth[pixel] + winner.map_or(0, |_| k * unit);
                let same = moved.depth[pixel] == expected && moved.colour[pixel] == first.colour[pixel];
                tally.expect(same, || format!("{format:?}, + {}: pixel {pixel} has {}", k * unit, moved.depth[pixel]));
            }
        }
    }
    Row {
        case: 19,
        name: "depth::offset_of_all_depths",
        construction: "214 primitives, all depths + k for 4 values of k, every depth format",
        property: "every pixel differs by exactly k, the same primitive is seen",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 20.
#[must_use]
pub fn equal_after_less() -> Row {
    let (mut tally, mut again) = (Tally::default(), 0);
    for format in formats() {
        let mut screen = Screen::new(SIZE[0], SIZE[1], &Options { depth: format, ..Options::default() });
        let scene = fixed(20, SIZE, 150, 40);
        let scene = with_depths(&scene, |z| depth::survivor((u64::from(z) << format.bits >> 24) as u32, format.bits));
        for order in [[1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let permuted: Vec<Primitive> = scene
                .iter()
                .map(|p| match p {
                    Primitive::Triangle(v) => Primitive::Triangle(order.map(|k| v[k])),
                    other => *other,
                })
                .collect();
            screen.clear();
            screen.draw_ids(&scene, &State::default());
            let first = screen.read();
            screen.draw_ids(&permuted, &State::with(DepthFunction::Equal));
            let second = screen.read();

            let mut image: Image = draw(SIZE[0], SIZE[1], &scene, format, DepthFunction::Less);
            image.draw(&permuted, DepthFunction::Equal);
            tally.add(&second.against(&image));
            let count = scene.len() as u32;
            for (before, after) in first.winners().iter().zip(second.winners()) {
                let passed = before.is_none() == after.is_none() && after.is_none_or(|id| id >= count);
                again += usize::from(after.is_some());
                tally.expect(passed, || format!("{format:?}, {order:?}: {before:?} became {after:?}"));
            }
            tally.expect(first.depth == second.depth, || "depths changed".into());
        }
    }
    Row {
        case: 20,
        name: "depth::equal_after_less",
        construction: "214 primitives under less, then equal with the vertices permuted (5 orders), every depth format",
        property: "every visible pixel passes again; equal to the oracle",
        measured: format!("{tally}; {again} pixels passed again"),
        passed: tally.wrong == 0 && again > 0,
    }
}

/// Case 21.
#[must_use]
pub fn offsets_at_the_limits() -> Row {
    let (mut tally, mut limited) = (Tally::default(), 0);
    let mut random = Random::new(21);
    for format in formats() {
        let greatest = format.greatest();
        let mut screen = Screen::new(16, 16, &Options { depth: format, ..Options::default() });
        let ends = [0, 1, 8, 9, 10, greatest - 10, greatest - 9, greatest - 8, greatest - 1, greatest];
        let ends = ends.map(|z| depth::survivor(z, format.bits));
        for units in [-9_i32, -8, -1, 0, 1, 8, 9] {
            // A surface marking moved by so many units along z, in the card's f32 register.
            let offset = (f64::from(units) / f64::from(greatest)) as f32;
            let mut decal = IDENTITY;
            decal[14] = offset;
            let state = State {
                decal: true,
                camera: Camera { decal, ..Camera::default() },
                ..State::with(DepthFunction::Always)
            };
            // What the transform must store: the exact sum, cut to the range, rounded.
            let moved = |z: u32| {
                let d = depth::encode(z, format.bits).map_or(0.0, f64::from) + f64::from(offset);
                from_f64(d).map_or(0, |d| stored_depth(&d, format.bits))
            };
            for _ in 0..40 {
                let z = [0; 3].map(|_| ends[random.range(0, 9) as usize]);
                let z = if random.range(0, 1) == 0 { [z[0]; 3] } else { z };
                let corners = [(-3000, -2000), (9000, -500), (1000, 8000)];
                let place = |k: usize, z: u32| Vertex::at(corners[k].0, corners[k].1, z);
                let vertices = [0, 1, 2].map(|k| {
                    let [x, y] = [corners[k].0, corners[k].1].map(|c| c as f32 / 256.0);
                    let d = depth::encode(z[k], format.bits).unwrap_or(0.0);
                    RawVertex { position: [x, y, d], colour: screen.options().pixels.colour_of(1) }
                });
                screen.clear();
                screen.draw_raw(Topology::Triangles, &vertices, None, &state);
                let expected = [Primitive::Triangle([0, 1, 2].map(|k| place(k, moved(z[k]))))];
                limited += z.iter().filter(|&&z| i64::from(moved(z)) != i64::from(z) + i64::from(units)).count();
                tally.add(&screen.read().against(&draw(16, 16, &expected, format, DepthFunction::Always)));
            }
        }
    }
    Row {
        case: 21,
        name: "depth::offsets_at_the_limits",
        construction: "3360 triangles with depths within 10 units of 0 and of the maximum, moved by 0, +-1, +-8, +-9 units, every \
                       depth format",
        property: "limited to 0 ..= maximum, never wrapped: equal to the oracle with limited vertex depths",
        measured: format!("{tally}; {limited} vertex depths limited"),
        passed: tally.wrong == 0 && limited > 0,
    }
}
