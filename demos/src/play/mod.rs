//! A scene through driver and card.
//!
//! Duties: powers a card on, opens it with the driver, turns [`Scene::batches`](crate::scene::Scene::batches) into draw
//! calls, takes frames, and reads what they cost. Inputs from: scenes and [`Settings`]. Outputs to: the commands.
//!
//! | file | holds |
//! | --- | --- |
//! | `settings` | what is asked of the card, what it has, and how it is set up |
//! | `look` | decals, wireframe, filter, light and fog switched |
//! | `change` | one effect more or less, to see what it costs |
//! | `environment` | light for a mesh that is shown alone |
//! | `session` | the card, the driver and the meshes in video memory |
//! | `cost` | effects, units, clocks and counters of a frame |

mod change;
mod cost;
mod environment;
mod look;
mod session;
mod settings;

pub use change::Change;
pub use cost::{Cost, effect_names, unit_names};
pub use environment::Environment;
pub use look::Look;
pub use session::{Session, ZaWords};
pub use settings::{Asked, KERNELS, MOST_ZA_RAM, Settings, check_kernel, za_ram};
