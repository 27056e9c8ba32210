//! Cases 38 to 45: masks, order and layers inside a pixel.
//!
//! A pixel is seen only as the mean of its samples. White on black, where no level stands for two counts (there are at
//! most 64 samples and 255 steps), it tells how many samples are covered; which ones, the oracle's equal picture tells.

mod coverage;
mod layers;
mod order;

pub use coverage::{
    doubling_back_on_a_diagonal, edges_through_samples, fans_inside_a_pixel, triangles_between_samples,
};
pub use layers::many_layers;
pub use order::{interpenetration, merge_in_any_order, start_corner_ties};

use super::Tally;
use crate::harness::{Options, Order, Pixels, Random, Screen, State, Subpixel};
use crate::oracle::supersample::Supersampled;
use crate::oracle::{DepthFormat, Primitive, Vertex};
use crate::script::smooth::{brush, target};

const WHITE: [u8; 4] = [255; 4];

/// A card and the oracle that draw the same.
struct Pair {
    screen: Screen,
    target: Supersampled,
    size: [u32; 2],
}

impl Pair {
    fn new(size: [u32; 2], subpixel: Subpixel) -> Self {
        let options = Options { pixels: Pixels::Argb8888, subpixel, ..Options::default() };
        let screen = Screen::new(size[0], size[1], &options);
        Self { screen, target: target(size, options.depth, &subpixel), size }
    }

    /// Both to a colour and the farthest depth.
    fn clear(&mut self, colour: [u8; 4]) {
        let (all, far) = ([0, 0, self.size[0], self.size[1]], DepthFormat::default().greatest());
        self.screen.clear_planes(Some(u32::from_le_bytes(colour)), Some(far), None);
        self.target.clear(all, Some(colour), Some(far));
    }

    fn draw(&mut self, scene: &[Primitive], state: &State) {
        self.screen.draw(scene, state);
        self.target.draw(scene, &brush(state, self.size));
    }

    /// Ends the scene and counts the pixels that are not the oracle's. The picture: red, green, blue, alpha.
    fn end(&mut self) -> (Vec<[u8; 4]>, usize) {
        let colours: Vec<[u8; 4]> = self.screen.read().colour.into_iter().map(rgba).collect();
        let right = self.target.end();
        let fits = |(colour, levels): (&[u8; 4], &[_; 4])| {
            let levels: &[crate::oracle::supersample::Level; 4] = levels;
            colour.iter().zip(levels).all(|(channel, level)| level.admits(*channel))
        };
        let wrong = colours.iter().zip(&right).filter(|&pair| !fits(pair)).count();
        (colours, wrong)
    }

    /// The same, put down in a tally.
    fn compare(&mut self, tally: &mut Tally, what: &str) -> Vec<[u8; 4]> {
        let (colours, wrong) = self.end();
        tally.pictures += 1;
        tally.pixels += colours.len();
        tally.note(wrong, || format!("{what}: {wrong} pixels are not the oracle's"));
        colours
    }
}

/// Red, green, blue, alpha of a stored ARGB pixel.
const fn rgba(pixel: u32) -> [u8; 4] {
    let [a, r, g, b] = pixel.to_be_bytes();
    [r, g, b, a]
}

/// The state of a draw to one pixel.
fn inside(i: i32, j: i32) -> State {
    let [left, top] = [i, j].map(|pixel| pixel as u32);
    State { scissor: Some([left, top, left + 1, top + 1]), ..State::masked() }
}

/// Samples of a grid that a level of white on black stands for.
fn count(level: u8, subpixel: Subpixel) -> u32 {
    let [columns, rows] = subpixel.grid.size();
    (u32::from(level) * columns * rows + 127) / 255
}

fn samples(subpixel: Subpixel) -> u32 {
    let [columns, rows] = subpixel.grid.size();
    columns * rows
}

/// The grids with each way to order.
fn settings() -> impl Iterator<Item = Subpixel> {
    crate::harness::Grid::ALL
        .into_iter()
        .flat_map(|grid| Order::ALL.map(|depth| Subpixel { depth, ..Subpixel::on(grid) }))
}

/// A triangle of one depth and colour.
fn flat(corners: [(i32, i32); 3], z: u32, colour: [u8; 4]) -> Primitive {
    Primitive::Triangle(corners.map(|(x, y)| Vertex::at(x, y, z).coloured(colour)))
}

/// A plane through depth `z` at the centre of pixel `(i, j)`, with a gradient in steps a pixel, bounded by an edge at a
/// random angle that crosses the pixel; without `edge` it covers the pixel.
fn plane(random: &mut Random, [i, j]: [i32; 2], z: i32, gradient: [f64; 2], edge: bool) -> [Vertex; 3] {
    let angle = random.between(0.0, std::f64::consts::TAU);
    let offset = if edge { random.between(-140.0, 140.0) } else { 400.0 };
    let (sin, cos) = angle.sin_cos();
    let corner = |along: f64, across: f64| {
        let dx = (cos * (offset + across) - sin * along).round();
        let dy = (sin * (offset + across) + cos * along).round();
        let depth = f64::from(z) + ((gradient[0] * dx + gradient[1] * dy) / 256.0).round();
        let [x, y] = [(i, dx), (j, dy)].map(|(pixel, d)| pixel * 256 + 128 + d as i32);
        Vertex::at(x, y, depth.clamp(0.0, 16_777_215.0) as u32)
    };
    [corner(-5000.0, 0.0), corner(5000.0, 0.0), corner(0.0, -5000.0)]
}

fn coloured(triangle: [Vertex; 3], colour: [u8; 4]) -> Primitive {
    Primitive::Triangle(triangle.map(|vertex| vertex.coloured(colour)))
}

/// An opaque colour at random.
fn any_colour(random: &mut Random) -> [u8; 4] {
    let [r, g, b, _] = (random.bits() as u32).to_le_bytes();
    [r, g, b, 255]
}
