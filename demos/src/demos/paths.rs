//! Scenes for the hidden-surface paths, small enough to follow by eye: what `zga paths`, `zga waves` and
//! `zga show --view` are tried on first.

use std::f64::consts::TAU;

use super::palette::{AMBER, CORAL, NIGHT, PORCELAIN, SKY, TEAL, hue, mix};
use crate::scene::{Colour, Colours, Draw, HiddenSurface, Primitives, Scene};

/// Triangles on the screen: pixels, depth 0 near to 1 far.
#[derive(Default)]
struct Cut {
    vertices: Vec<[f32; 3]>,
    colours: Vec<Colour>,
}

impl Cut {
    fn triangle(&mut self, corners: [[f64; 3]; 3], colours: [Colour; 3]) {
        self.vertices.extend(corners.map(|corner| corner.map(|coordinate| coordinate as f32)));
        self.colours.extend(colours);
    }

    /// An upright rectangle from (`left`, `top`) to (`right`, `bottom`), its depth from left to right.
    fn wall(&mut self, [left, top, right, bottom]: [f64; 4], depth: [f64; 2], colour: Colour) {
        let corner = |x: f64, y: f64| [x, y, depth[usize::from(x == right)]];
        let [a, b, c, d] = [corner(left, top), corner(right, top), corner(right, bottom), corner(left, bottom)];
        self.triangle([a, b, c], [colour; 3]);
        self.triangle([a, c, d], [colour; 3]);
    }

    fn disc(&mut self, [x, y]: [f64; 2], radius: f64, depth: f64, colours: [Colour; 2]) {
        const SIDES: u32 = 24;
        let rim = |side: u32| {
            let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            [x + radius * cosine, y + radius * sine, depth]
        };
        for side in 0..SIDES {
            self.triangle([[x, y, depth], rim(side), rim(side + 1)], [colours[0], colours[1], colours[1]]);
        }
    }

    fn into_draw(self) -> Draw {
        let colours = Colours::PerVertex(self.colours);
        Draw::Triangles(Primitives { vertices: self.vertices, colours, ..Default::default() })
    }
}

fn scene(size: [u32; 2], path: HiddenSurface, draw: Vec<Draw>) -> Scene {
    let mut scene = Scene::new(size, NIGHT);
    scene.card.hidden_surface = Some(path);
    scene.draw = draw;
    scene
}

/// Front to back: a disc, a wall that fills whole blocks, a slanting strip that runs through it, pillars behind all. Za
/// blocks of the wall are closed, so that one comparison each rejects the pillars; the sky stays cleared.
pub(super) fn za(_frame: u32) -> Scene {
    let (mut disc, mut wall, mut strip, mut pillars) = (Cut::default(), Cut::default(), Cut::default(), Cut::default());
    disc.disc([70.0, 58.0], 30.0, 0.15, [PORCELAIN, CORAL]);
    wall.wall([64.0, 24.0, 160.0, 96.0], [0.4, 0.4], TEAL);
    strip.wall([24.0, 70.0, 176.0, 82.0], [0.2, 0.6], AMBER);
    for pillar in 0..9 {
        let left = 12.0 + 20.0 * f64::from(pillar);
        pillars.wall([left, 16.0, left + 9.0, 112.0], [0.8, 0.8], mix(NIGHT, SKY, 0.35 + 0.06 * f64::from(pillar)));
    }
    scene([192, 128], HiddenSurface::Za, [disc, wall, strip, pillars].map(Cut::into_draw).into())
}

/// Tents one before the other: each line down cuts more of them, up to twice as many as fit beside the pixels on the
/// bus.
pub(super) fn systolic(_frame: u32) -> Scene {
    const TENTS: u32 = 62;
    let mut tents = Cut::default();
    for tent in 0..TENTS {
        let part = f64::from(tent) / f64::from(TENTS);
        let (top, half, depth) = (3.0 + 88.0 * part, 44.0 * (1.0 - 0.85 * part), 0.9 - 0.8 * part);
        let colour = mix(hue(0.55 - 0.5 * part), NIGHT, if tent % 2 == 0 { 0.0 } else { 0.3 });
        let corners = [[48.0, top, depth], [48.0 + half, 94.0, depth], [48.0 - half, 94.0, depth]];
        tents.triangle(corners, [mix(colour, PORCELAIN, 0.5), colour, colour]);
    }
    scene([96, 96], HiddenSurface::Systolic, vec![tents.into_draw()])
}

/// A triangle over many tiles, a sliver across, a swarm of small ones in a few tiles, and tiles with nothing at all.
pub(super) fn tile(_frame: u32) -> Scene {
    let (mut large, mut swarm, mut sliver) = (Cut::default(), Cut::default(), Cut::default());
    large.triangle([[6.0, 90.0, 0.9], [60.0, 10.0, 0.5], [104.0, 82.0, 0.7]], [TEAL, SKY, mix(SKY, NIGHT, 0.4)]);
    for index in 0..48 {
        // Steps by the golden section: a sunflower.
        let part = f64::from(index) / 48.0;
        let (sine, cosine) = (TAU * f64::from(index) * 0.618_034).sin_cos();
        let [x, y] = [60.0 + 15.0 * part.sqrt() * cosine, 56.0 + 15.0 * part.sqrt() * sine];
        let side = 2.2 + 1.6 * part;
        let corners = [[x, y - side, 0.4], [x + side, y + side, 0.4], [x - side, y + side, 0.4]];
        swarm.triangle(corners, [hue(part), mix(hue(part), NIGHT, 0.3), mix(hue(part), NIGHT, 0.3)]);
    }
    sliver.triangle([[4.0, 6.0, 0.2], [124.0, 72.0, 0.2], [122.0, 75.0, 0.2]], [AMBER, CORAL, CORAL]);
    scene([128, 96], HiddenSurface::Tile, [large, swarm, sliver].map(Cut::into_draw).into())
}
