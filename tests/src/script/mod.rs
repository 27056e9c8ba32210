//! Scripts: sequences of scenes on one card, and what comes between them.
//!
//! A script can be run in every way that the card can draw ([`run`]), and by the exact oracle ([`judge()`]). Whatever the
//! way, scan-out shows the same frames and the Z buffer ends with the same depths.
//!
//! | part | what |
//! | --- | --- |
//! | [`Script`], [`Scene`], [`Command`], [`Between`] | what is done |
//! | [`mod@any`] | random ones |
//! | [`run`] | on the card |
//! | [`mod@judge`] | by the oracle |
//! | [`mod@smooth`] | random ones whose pixels have samples, and their oracle |

pub mod any;
pub mod judge;
mod run;
pub mod smooth;

pub use judge::judge;
pub use run::{Outcome, Way, run};

use crate::harness::scenes::{Piece, primitives};
use crate::harness::{Grid, Pixels, Random, State, Subpixel};
use crate::oracle::stencil::Shadow;
use crate::oracle::{DepthFormat, Primitive, Vertex};

/// Scenes on one or two frames that share a Z buffer.
#[derive(Clone, Debug)]
pub struct Script {
    /// Width and height of the target.
    pub size: [u32; 2],
    /// Number format of depth.
    pub format: DepthFormat,
    /// Format of the frames.
    pub pixels: Pixels,
    /// No draw tests depth, no clear has one: the target needs no Z buffer.
    pub depthless: bool,
    /// There is a stencil plane.
    pub stencil: bool,
    /// Colours are interpolated.
    pub gouraud: bool,
    /// Samples of a pixel.
    pub subpixel: Subpixel,
    /// In order.
    pub scenes: Vec<Scene>,
}

/// From BEGIN_SCENE to END_SCENE, and until the next.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Frame drawn to: 0 or 1.
    pub frame: usize,
    /// In the scene.
    pub commands: Vec<Command>,
    /// What END_SCENE darkens, if a draw called for a stencil test.
    pub shadow: Option<Shadow>,
    /// After it.
    pub after: Vec<Between>,
}

/// A part of a scene.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "scripts are short")]
pub enum Command {
    /// Clears planes of a rectangle.
    Clear {
        /// Colour, red in 7:0.
        colour: Option<u32>,
        /// Depth.
        depth: Option<u32>,
        /// Stencil value.
        stencil: Option<u8>,
        /// Left, top, right, bottom; all without it.
        scissor: Option<[u32; 4]>,
    },
    /// Draws.
    Draw {
        /// What.
        pieces: Vec<Piece>,
        /// How.
        state: State,
    },
    /// Somebody uses memory in mid-scene: not on paths that hold the scene back.
    Memory(Between),
    /// The frame is looked at in mid-scene; paths that hold the scene back do not show it yet.
    Look,
}

/// What happens between scenes.
#[derive(Clone, Debug)]
pub enum Between {
    /// FILL of x, y, width, height of the frame with a stored pixel.
    Fill([u32; 4], u32),
    /// FILL of the Z buffer.
    FillDepth([u32; 4], u32),
    /// COPY of x, y, width, height of the frame to another place.
    Copy([u32; 4], [u32; 2]),
    /// UPLOAD of words to the start of a row of the frame.
    Upload(u32, Vec<u32>),
    /// UPLOAD of depths to the start of a row.
    UploadDepths(u32, Vec<u32>),
    /// The Z buffer is read, which brings cleared blocks to memory.
    Depths,
    /// Soft reset; registers are set again.
    Reset,
    /// A snapshot is taken and restored.
    Restore,
}

impl Script {
    /// Somebody uses memory in mid-scene.
    #[must_use]
    pub fn shares_memory(&self) -> bool {
        let mut commands = self.scenes.iter().flat_map(|scene| &scene.commands);
        commands.any(|command| matches!(command, Command::Memory(_)))
    }

    /// The primitives of a draw, coloured by where they stand in the script.
    #[must_use]
    pub fn primitives(&self, place: u64, pieces: &[Piece]) -> Vec<Primitive> {
        let mut random = Random::new(place);
        let mut primitives = primitives(pieces);
        for primitive in &mut primitives {
            let vertices: &mut [Vertex] = match primitive {
                Primitive::Triangle(v) => v,
                Primitive::Line(v) => v,
                Primitive::Point(v) => std::slice::from_mut(v),
            };
            vertices.iter_mut().for_each(|vertex| vertex.colour = (random.bits() as u32).to_le_bytes());
            // Where fragments are translucent alpha matters: often one that makes no layer. One colour, because the
            // two triangles of a line or a point have corners of different ends.
            if self.subpixel.grid != Grid::Off {
                let [r, g, b, alpha] = vertices[0].colour;
                let alpha = [alpha, alpha, 255, 255, 0, 254, 1][random.range(0, 6) as usize];
                vertices.iter_mut().for_each(|vertex| vertex.colour = [r, g, b, alpha]);
            }
        }
        primitives
    }
}
