//! Cases 46 to 51: surface markings in both projections.

mod buried;
mod moved;
mod steps;

pub use buried::{nothing_buried_up_to_the_limit, occluder_at_the_offset};
pub use moved::{edge_on_surface, same_pixels_with_and_without, silhouettes_and_refusal};
pub use steps::offset_under_one_step;

use super::{Row, Tally};
use crate::harness::options::{Camera, IDENTITY};
use crate::harness::{Options, Pixels, RawVertex, Screen, State, Topology};
use crate::oracle::DepthFunction;
use crate::study::decal::{Projection, SIDE};
use zga_abi::format::DepthFormat as CardFormat;
use zga_driver::{Decal, ViewError};

/// The decal matrix that the driver makes.
fn matrix(projection: Projection, slope: f64) -> Result<[f32; 16], ViewError> {
    Decal::new(&projection.camera(), SIDE, slope, CardFormat::default()).map(|decal| decal.matrix)
}

/// Everything passes; through the driver's camera, and its decal matrix where there is one.
fn state(projection: Projection, decal: Option<[f32; 16]>) -> Result<State, ViewError> {
    let matrices = projection.camera().matrices(SIDE, SIDE)?;
    let camera = Camera {
        object_eye: matrices.world_eye,
        decal: decal.unwrap_or(IDENTITY),
        eye_clip: matrices.eye_clip,
        viewport: matrices.viewport,
    };
    Ok(State { camera, decal: decal.is_some(), ..State::with(DepthFunction::Always) })
}

/// A new card with a target of the study's size.
fn screen() -> Screen {
    Screen::new(SIDE, SIDE, &Options::default())
}

/// Draws places in eye space, each primitive in a colour of its own from `id` on.
fn draw(screen: &mut Screen, topology: Topology, places: &[[f32; 3]], id: u32, state: &State) {
    let each = match topology {
        Topology::Triangles => 3,
        Topology::Lines => 2,
        Topology::Points | Topology::LineStrip => 1,
    };
    let vertex = |(k, &position): (usize, &[f32; 3])| RawVertex {
        position,
        colour: Pixels::Xrgb8888.colour_of(id + (k / each) as u32),
    };
    let vertices: Vec<RawVertex> = places.iter().enumerate().map(vertex).collect();
    screen.draw_raw(topology, &vertices, None, state);
}

/// What a driver or a camera refused is a wrong sample.
fn refused(tally: &mut Tally, what: &impl std::fmt::Display) {
    tally.note(1, || format!("refused: {what}"));
}
