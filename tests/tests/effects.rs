//! Texture, light, fog, blending, holes and stencil tests: the card against the oracle, and against itself in every way it can draw.
//!
//! Visibility, the order of layers, nearest texels, texture functions and blending of flat colours have one right answer,
//! and no tolerance. What is interpolated is compared with f64 within what the card's roundings can add up to
//! ([`zga_tests::oracle::effects::shade`]); the errors found are printed (`--nocapture`).
//!
//! A failing scene is shrunk and printed as the seeds of its draws. With `ZGA_LONG=1` each property runs 20 times as many
//! scenes: `ZGA_LONG=1 cargo test --release -p zga-tests --test effects`.

#[path = "effects/bench.rs"]
mod bench;
#[path = "effects/fog.rs"]
mod fog;
#[path = "effects/holes.rs"]
mod holes;
#[path = "effects/layers.rs"]
mod layers;
#[path = "effects/light.rs"]
mod light;
#[path = "effects/power.rs"]
mod power;
#[path = "effects/stencil.rs"]
mod stencil;
#[path = "effects/texture.rs"]
mod texture;
#[path = "effects/ways.rs"]
mod ways;

use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

/// Scenes for each property.
fn cases(short: u32) -> ProptestConfig {
    let long = std::env::var_os("ZGA_LONG").is_some();
    ProptestConfig {
        cases: if long { 20 * short } else { short },
        max_shrink_iters: 2000,
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("failed"))),
        ..ProptestConfig::default()
    }
}

/// Seeds of up to `most` draws.
fn seeds(most: usize) -> impl Strategy<Value = Vec<u64>> {
    prop::collection::vec(any::<u64>(), 1..=most)
}
