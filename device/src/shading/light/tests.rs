//! Lights: facts, the specification against f64, lanes against the specification.

mod cases;
mod reference;

use super::Lights;
use fearless_simd::Level;
use zga_abi::format::LightType;
use zga_abi::light::LightRecord;
use zga_firmware::checked::Lighting;

/// White.
const WHITE: u32 = 0xFFFF_FFFF;

/// A dull, black material in the dark: what is seen of it lights add.
fn dull() -> Lighting {
    Lighting {
        per_pixel: true,
        two_sided: false,
        local_viewer: false,
        lights: 0,
        count: 1,
        ambient: 0,
        specular: 0,
        emission: 0,
        shininess: 0.0,
    }
}

/// A white light without ambient at (0, 0, 4) that shines down -z.
fn white(kind: LightType) -> LightRecord {
    LightRecord {
        kind: kind.code(),
        position: [0.0, 0.0, 4.0],
        direction: [0.0, 0.0, -1.0],
        colour: WHITE,
        ..LightRecord::default()
    }
}

/// The records as words of video memory.
fn words(records: &[LightRecord]) -> Vec<u32> {
    bytemuck::cast_slice(records).to_vec()
}

/// The lights of `records` on a material.
fn lights(lighting: &Lighting, records: &[LightRecord]) -> Lights {
    Lights::read(&words(records), &Lighting { count: records.len() as u32, ..*lighting })
}

/// Red that `record` makes of a dull white surface at `position` with `normal`.
fn red(record: LightRecord, position: [f32; 3], normal: [f32; 3]) -> u32 {
    lights(&dull(), &[record]).lit(WHITE, position, normal) & 0xFF
}

/// The levels of SIMD that this host has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ]
    .into_iter()
    .flatten()
    .chain([best])
    .collect()
}
