//! A card on the bench, for tests that compare what it draws.
//!
//! The card is driven through its bus alone, with packets that this harness encodes itself from the numbers of the
//! manual ([`packet`]): neither the driver nor the declarations of the card's interface take part, so that a mistake in
//! either cannot hide here.
//!
//! Vertices come as [`crate::oracle`] has them: x and y in u = 1/256 pixel, z in steps of the stored depth. Under the
//! identity camera they go to the card as f32 pixels (exact below 2^16 pixels) and an f32 depth from which the card
//! gets back just that z ([`depth`]).
//!
//! ```
//! use zga_tests::harness::{Options, Screen, State};
//! use zga_tests::oracle::{DepthFunction, Primitive, Vertex, draw};
//!
//! let triangle = Primitive::Triangle([Vertex::at(0, 0, 5), Vertex::at(1024, 0, 5), Vertex::at(0, 1024, 5)]);
//! let options = Options::default();
//! let mut screen = Screen::new(4, 4, &options);
//! screen.draw_ids(&[triangle], &State::default());
//! let image = draw(4, 4, &[triangle], options.depth, DepthFunction::Less);
//! assert_eq!(screen.read().against(&image).to_string(), "16 pixels, none differ");
//! ```

pub mod depth;
pub mod events;
pub mod hidden;
pub mod look;
mod memory;
pub mod options;
pub mod packet;
pub mod picture;
pub mod random;
pub mod scenes;
pub mod screen;
pub mod stage;
pub mod subpixel;

pub use events::Events;
pub use hidden::{Hidden, Path, Prediction};
pub use look::{Look, Sampler};
pub use options::{Camera, Feed, Options, Pixels, State};
pub use picture::{Differences, Picture};
pub use random::Random;
pub use screen::{Counts, RawVertex, Screen, Topology};
pub use stage::{Comparison, Stage};
pub use subpixel::{Edges, Grid, Order, Resolve, Subpixel};
