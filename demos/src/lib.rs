//! The program `zga` and what it draws.
//!
//! | module | holds |
//! | --- | --- |
//! | [`scene`], [`mesh`], [`teapot`], [`demos`] | what is drawn, independent of any card |
//! | [`texture`] | pictures for textures: reading and palettes |
//! | [`play`] | a scene through driver and card, and what it cost |
//! | [`accuracy`] | what accuracy costs: errors against exact arithmetic, and prices |
//! | [`mod@bench`] | the benchmark scenes |
//! | [`effects`] | what each unit charges for a scene, and what an effect more or less would cost |
//! | [`paths`] | a scene on every hidden-surface path, compared |
//! | [`registers`] | the manual of the register map |
//! | [`picture`] | PNG files and exact comparison |
//! | [`cli`] | the commands |
//!
//! A [`scene::Scene`] is a plain value. It comes from a scene file ([`scene::load`]), from a mesh file
//! ([`mesh::load`] and [`scene::Scene::showing`]) or from a named demonstration ([`demos::find`]), and
//! [`scene::Scene::batches`] turns it into flat lists of triangles, lines and points for a driver.
//!
//! ```
//! let demo = zga_demos::demos::find("teapot").expect("the main demonstration");
//! let scene = demo.build(0);
//! let batches = scene.batches();
//! assert!(batches.iter().any(|batch| batch.slope.is_some()), "markings are drawn as decals");
//! ```

pub mod accuracy;
pub mod bench;
mod canvas;
pub mod cli;
pub mod demos;
pub mod effects;
mod error;
mod limits;
pub mod mesh;
pub mod paths;
pub mod picture;
pub mod play;
pub mod registers;
pub mod scene;
mod table;
pub mod teapot;
pub mod texture;
mod window;
mod x;

pub use error::{Error, Result};
pub use limits::{
    MAX_FILE_BYTES, MAX_JSON_VALUES, MAX_MESH_INDICES, MAX_MESH_VERTICES, MAX_PICTURE_SIDE, MAX_PICTURE_TEXELS,
    MAX_TARGET_PIXELS_PER_SIDE, MAX_TEXELS,
};
