//! Session: a stock X server with its clients, from start to clean end.
//!
//! Duties: finds server and module, writes the configuration into a folder of its own, starts the server on a free
//! display that only the user can reach, starts clients in it, and takes all of it away again: clients, server, folder.
//! Inputs from: [`Options`]. Outputs to: processes, the folder; what failed comes back with the end of the server's log.
//!
//! Nothing here knows the card: `zga x` and the test programs stand on it, with the module of this crate or with the
//! server's own driver `dummy`, which draws by the same renderer without a card and is what pictures are compared with.

mod client;
mod config;
mod error;
mod find;
mod server;

pub use client::Client;
pub use config::{Driver, Options};
pub use error::SessionError;
pub use find::{MODULE, SERVER, find_module};
pub use server::Session;
