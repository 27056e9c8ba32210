//! Buses that are not a card: a model for tests, and a recorder.

mod mock;
mod recording;

pub use mock::{MockAccess, MockBus, Pace};
pub use recording::RecordingBus;
