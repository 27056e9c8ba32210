//! Driver of the ZGA card: finds it on a bus, submits work, draws, captures frames.
//!
//! | module | holds |
//! | --- | --- |
//! | [`Driver`] | the card: opening, submission, fences, memory; scenes, state, hidden-surface paths, anti-aliasing, textures, lights, fog, blending, stencil and shadows, drawing, capture, probe; images and the bitmap unit |
//! | [`view`] | cameras and the decal transform |
//! | [`memory`] | the video memory allocator |
//! | [`bus`] | a bus model for tests, a bus that records |
//! | [`trace`] | recorded runs: file format, reader, replay |
//!
//! # How work travels
//!
//! Calls encode packets on the host. Registers travel only when they differ from what the card has. A
//! batch of packets ends with a fence and goes into the card's ring in one burst with one doorbell; the
//! card works while the host goes on. [`Driver::wait`] sleeps until the fence interrupt. A frame that draws
//! a mesh from video memory costs some fifteen words and six bus accesses.
//!
//! # A triangle with a marking
//!
//! ```
//! use zga_device::{Card, CardOptions};
//! use zga_driver::{Driver, TargetOptions, Vertex};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let card = Card::power_on(CardOptions::default())?;
//! let mut driver = Driver::open(card.bus())?;
//! let target = driver.create_target(TargetOptions::new(64, 48))?;
//!
//! // The screen camera: x and y are pixels, z is depth.
//! let red = [255, 0, 0, 255];
//! let white = [255; 4];
//! driver.begin_scene(&target)?;
//! driver.clear(Some([0, 0, 64, 255]), Some(1.0))?;
//! driver.draw_triangle([
//!     Vertex::new([4.0, 4.0, 0.2], red),
//!     Vertex::new([60.0, 24.0, 0.8], red),
//!     Vertex::new([4.0, 44.0, 0.2], red),
//! ])?;
//! // A line in the triangle's plane: the decal keeps the surface from burying it.
//! driver.decal(8.0, |driver| {
//!     driver.draw_line([Vertex::new([4.5, 24.5, 0.207], white), Vertex::new([56.5, 24.5, 0.764], white)])
//! })?;
//! driver.end_scene()?;
//! driver.present(&target)?;
//!
//! let frame = driver.capture()?;
//! assert_eq!(frame.pixels[24 * 64 + 20], 0xFFFF_FFFF);
//! assert_eq!(frame.pixels[20 * 64 + 10], 0xFFFF_0000);
//! println!("{} {:?}", frame.hash, driver.effects_called());
//! # Ok(())
//! # }
//! ```

mod antialias;
mod bitmap;
pub mod bus;
mod capture;
mod compose;
mod display;
mod draw;
mod driver;
mod effects;
mod error;
mod hidden;
mod info;
mod lists;
pub mod memory;
mod preset;
mod probe;
mod state;
mod submit;
mod target;
pub mod trace;
pub mod view;
mod warning;

pub use antialias::Antialias;
pub use bitmap::{Drawable, Image, ImageError, Placement, Raster};
pub use capture::{Frame, frame_hash, hash_text};
pub use compose::{Composition, Mask, MaskGlyph, Paint, Picture};
pub use draw::{Curve, MeshBuffer, Vertex, Vertices};
pub use driver::{Driver, DriverOptions};
pub use effects::{
    Blend, Fog, FogCurve, Light, LightSource, Material, Shadow, Stencil, StencilSide, Texture, TextureOptions,
    TextureState,
};
pub use error::DriverError;
pub use hidden::{SystolicVariant, ZaSettings};
pub use info::{CardInfo, Counters};
pub use lists::{BitmapGlyph, Canvas, ClipBox, ListRectangle, Point, Segment};
pub use memory::{Alignment, Allocation};
pub use preset::Preset;
pub use probe::PixelHistory;
pub use state::Rectangle;
pub use submit::{CardFault, FaultSource, Fence, Submit};
pub use target::{Target, TargetOptions};
pub use view::{Camera, Corners, Decal, DecalInfo, FitInfo, Matrix, ViewError};
pub use warning::Warning;
pub use zga_abi::packet::compose::Transform;
