//! Scenes of opaque triangles whose numbers are exact: what is drawn, before any rounding of the card.
//!
//! Coordinates are whole 1/4096 pixels and depths whole 2^-24 of the range, so each is an f32 that the card reads without
//! error, finer than any grid that it snaps to. Colours run evenly over a triangle, on the screen, between whole levels at
//! its corners.

use crate::harness::{Random, RawVertex, Screen, State, Topology};

/// Units of a coordinate in a pixel.
pub const UNITS: i32 = 4096;
/// The farthest depth.
pub const FAR: i32 = 1 << 24;
/// Largest coordinate, either way: an f32 has it exactly.
pub const REACH: i32 = (1 << 24) - 1;
/// Units of a coordinate that is on the card's finest grid.
const SNAPPED: i32 = UNITS / 256;

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facet {
    /// x to the right and y down, 1/4096 pixel, within [`REACH`].
    pub corners: [[i32; 2]; 3],
    /// 2^-24 of the range, 0 near to [`FAR`].
    pub depths: [i32; 3],
    /// Red, green, blue at each corner.
    pub colours: [[u8; 3]; 3],
}

/// A picture to be drawn on black.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scene {
    /// Pixels of a row, and rows.
    pub size: [u32; 2],
    /// In order of submission.
    pub facets: Vec<Facet>,
}

/// Random scenes of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Triangles of a few pixels, deep in one another.
    Soup,
    /// Large planes that cross.
    Crossing,
    /// Two surfaces of many triangles, a little apart, that cross here and there.
    Terrain,
}

impl Kind {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Soup, Self::Crossing, Self::Terrain];

    /// A word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Soup => "random small triangles",
            Self::Crossing => "planes that cross",
            Self::Terrain => "two terrains",
        }
    }

    /// A scene with vertices anywhere; colours tell triangles apart, but those of a terrain are alike.
    #[must_use]
    pub fn scene(self, size: [u32; 2], random: &mut Random) -> Scene {
        let area = (size[0] * size[1]) as usize;
        let facets = match self {
            // As many as make each pixel deep: 1500 on 96 x 96.
            Self::Soup => (0..area / 6).map(|_| soup(size, random)).collect(),
            Self::Crossing => (0..24).map(|_| crossing(size, random)).collect(),
            Self::Terrain => [0, 1].into_iter().flat_map(|number| terrain(size, random, number)).collect(),
        };
        Scene { size, facets }
    }
}

impl Facet {
    /// Whether it is in one colour.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.colours[1..].iter().all(|colour| *colour == self.colours[0])
    }
}

impl Scene {
    /// The same with vertices moved to the card's finest grid, 1/256 pixel: then the snap is no error.
    #[must_use]
    pub fn snapped(mut self) -> Self {
        for facet in &mut self.facets {
            let snap = |c: i32| (c + SNAPPED / 2).div_euclid(SNAPPED) * SNAPPED;
            facet.corners = facet.corners.map(|corner| corner.map(snap));
        }
        self
    }

    /// Pixels.
    #[must_use]
    pub const fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Draws it on a card, in its colours: interpolated if there is a triangle with more than one.
    pub fn draw(&self, screen: &mut Screen, state: &State) {
        let gouraud = !self.facets.iter().all(Facet::is_flat);
        let colours = |_: usize, facet: &Facet| facet.colours.map(|[r, g, b]| u32::from_le_bytes([r, g, b, 255]));
        self.draw_in(screen, &State { gouraud, ..*state }, colours);
    }

    /// Draws it with its position in the list, from 1, as colour.
    pub fn draw_numbers(&self, screen: &mut Screen, state: &State) {
        let pixels = screen.options().pixels;
        self.draw_in(screen, state, |number, _| [pixels.colour_of(number as u32 + 1); 3]);
    }

    fn draw_in(&self, screen: &mut Screen, state: &State, colours: impl Fn(usize, &Facet) -> [u32; 3]) {
        let mut vertices = Vec::with_capacity(3 * self.facets.len());
        for (number, facet) in self.facets.iter().enumerate() {
            let corners = facet.corners.iter().zip(facet.depths).zip(colours(number, facet));
            vertices.extend(corners.map(|(([x, y], z), colour)| RawVertex {
                position: [*x as f32 / UNITS as f32, *y as f32 / UNITS as f32, z as f32 / FAR as f32],
                colour,
            }));
        }
        screen.draw_raw(Topology::Triangles, &vertices, None, state);
    }
}

fn colour(random: &mut Random) -> [u8; 3] {
    let [r, g, b, _] = (random.bits() as u32).to_le_bytes();
    [r, g, b]
}

fn soup(size: [u32; 2], random: &mut Random) -> Facet {
    let place = size.map(|side| random.int(0, side as i32 * UNITS));
    let (z, colour) = (random.int(FAR / 16, FAR / 2), colour(random));
    let corner = |random: &mut Random| place.map(|c| c + random.int(-6 * UNITS, 6 * UNITS));
    let corners = [corner(random), corner(random), corner(random)];
    Facet { corners, depths: [0; 3].map(|_| z + random.int(-FAR / 64, FAR / 64)), colours: [colour; 3] }
}

fn crossing(size: [u32; 2], random: &mut Random) -> Facet {
    let colour = colour(random);
    let corners = [(-0.6, -0.6), (2.1, -0.4), (0.3, 2.3)].map(|(x, y)| {
        let place = [x * f64::from(size[0]), y * f64::from(size[1])];
        place.map(|c| (c * f64::from(UNITS)) as i32 + random.int(-20 * UNITS, 20 * UNITS))
    });
    Facet { corners, depths: [0; 3].map(|_| random.int(FAR / 16, FAR / 2)), colours: [colour; 3] }
}

/// A height field over the frame, cells of 4 pixels, corners moved by up to a pixel.
fn terrain(size: [u32; 2], random: &mut Random, number: usize) -> Vec<Facet> {
    let colours = [[[230, 60, 20], [20, 90, 240]][number]; 3];
    let [columns, rows] = size.map(|side| side.div_ceil(4) as usize + 1);
    let vertices: Vec<([i32; 2], i32)> = (0..columns * rows)
        .map(|k| {
            let place = [k % columns, k / columns].map(|c| c as i32 * 4 * UNITS + random.int(-UNITS, UNITS));
            (place, FAR / 4 + random.int(-FAR / 256, FAR / 256))
        })
        .collect();
    let cell = |k: usize| {
        let [a, b, c, d] = [k, k + 1, k + columns, k + columns + 1].map(|k| vertices[k]);
        [[a, b, c], [c, b, d]]
    };
    let cells = (0..columns * (rows - 1)).filter(|k| k % columns < columns - 1);
    let facet =
        |three: [([i32; 2], i32); 3]| Facet { corners: three.map(|v| v.0), depths: three.map(|v| v.1), colours };
    cells.flat_map(|k| cell(k).map(facet)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harness::Options;

    #[test]
    fn draw_of_a_triangle_in_more_than_one_colour_interpolates() {
        let (a, b, c) = ([0, 0], [16 * UNITS, 0], [0, 16 * UNITS]);
        let colours = [[0; 3], [160, 0, 32], [0; 3]];
        let scene = Scene { size: [4, 4], facets: vec![Facet { corners: [a, b, c], depths: [FAR / 2; 3], colours }] };
        let mut screen = Screen::new(4, 4, &Options::default());
        screen.clear();
        scene.draw(&mut screen, &State::default());
        // 10 levels of red and 2 of blue a pixel to the right, at the centres.
        let row = [0x05_0001, 0x0F_0003, 0x19_0005, 0x23_0007];
        assert!(screen.read().colour.chunks(4).all(|found| found.iter().zip(row).all(|(a, b)| a & 0x00FF_FFFF == b)));
    }

    #[test]
    fn scenes_are_within_what_an_f32_carries() {
        for kind in Kind::ALL {
            let scene = kind.scene([64, 48], &mut Random::new(5));
            assert!(scene.facets.len() >= 24);
            for facet in &scene.facets {
                assert!(facet.corners.as_flattened().iter().all(|c| c.abs() <= REACH));
                assert!(facet.depths.iter().all(|z| (0..=FAR).contains(z)));
            }
            let snapped = scene.clone().snapped();
            assert!(snapped.facets.iter().flat_map(|f| f.corners.into_iter().flatten()).all(|c| c % SNAPPED == 0));
            assert_ne!(snapped, scene);
        }
    }
}
