//! What packets and registers become once they are checked.
//!
//! Invariants hold by construction in [`crate::Processor`]: every address range lies in video
//! memory, every alignment is right, every enumeration has a meaning. Units do not check again.

mod bitmap;
mod compose;
mod draw;
mod effects;
mod lists;
mod settings;
mod stencil;
mod surfaces;

pub use bitmap::{Combine, CombineSource, Convert, Copy, Fill, Image, Rows, Stretch};
pub(crate) use compose::are_entries;
pub use compose::{Compose, ComposeEntry, Mask, Paint, Picture, Sampled};
pub use draw::{Clear, Draw, DrawState, Words};
pub use effects::{Fog, Lighting, Texture};
pub(crate) use lists::are_bitmaps;
pub use lists::{Bitmap, Canvas, ClipBox, CopyList, ExpandList, FillList, ListRectangle, Point, Segment, SegmentList};
pub use settings::{SubpixelSetting, SystolicSetting, ZaSetting};
pub use stencil::{Shadow, Stencil, StencilOperations, StencilTest};
pub use surfaces::{DepthSurface, Rectangle, StencilSurface, Surface, Target};
