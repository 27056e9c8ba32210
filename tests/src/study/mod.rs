//! What accuracy costs: figures that are measured, not only held.
//!
//! Each study draws on a card, through its bus, and compares with exact arithmetic; it returns plain data. [`scene`] is
//! what most of them draw, [`truth`] what that should look like, [`card`] what a card makes of it and at which price.
//!
//! | study | axis | error |
//! | --- | --- | --- |
//! | [`coverage`] | samples of a pixel | covered share against covered area |
//! | [`drift`] | fraction bits of a depth | depth against the exact plane, over 16384 pixels |
//! | [`visibility`] | bits of a depth | planes that nearly coincide, seen in the wrong order |
//! | [`order`] | depths inside a pixel | edge pixels that show something else than their samples |
//! | [`coordinates`] | bits of a coordinate | pixels that show another triangle than unsnapped ones would |
//! | [`bypass`] | prediction of the Za unit | blocks that could have been bypassed and were not |
//! | [`filter`] | texture filters | picture against the texture integrated over each pixel |
//! | [`shading`] | where light is worked out | picture against light at each pixel in f64 |
//! | [`decal`] | slope S of surface markings | marking pixels buried, and shown through what hides them |
//! | [`flip`], [`psnr`] | - | how different two pictures look, and are |

pub mod bypass;
pub mod card;
pub mod coordinates;
pub mod coverage;
pub mod decal;
pub mod drift;
pub mod filter;
pub mod flip;
pub mod order;
pub mod psnr;
pub mod scene;
pub mod shading;
pub mod truth;
pub mod visibility;
