//! What lights and fog cost on this host, by SIMD level:
//! `cargo run --release --example light_rate -p zga-device`.

use fearless_simd::{Level, dispatch};
use std::hint::black_box;
use std::time::Instant;
use zga_abi::format::{FogFunction, LightType};
use zga_abi::light::LightRecord;
use zga_device::effects::{FogMixer, Lights};
use zga_firmware::checked::{Fog, Lighting};

/// Pixels that go side by side.
const LANES: usize = 16;
/// Chunks of a round.
const CHUNKS: usize = 4096;

/// 16 pixels.
struct Chunk {
    colours: [u32; LANES],
    position: [[f32; LANES]; 3],
    normal: [[f32; LANES]; 3],
}

fn main() {
    let best = Level::new();
    let levels = [
        ("SSE2", best.as_sse2().map(Level::Sse2)),
        ("SSE4.2", best.as_sse4_2().map(Level::Sse4_2)),
        ("AVX2", best.as_avx2().map(Level::Avx2)),
        ("AVX-512", best.as_avx512().map(Level::Avx512)),
    ];
    let chunks: Vec<Chunk> = (0..CHUNKS).map(chunk).collect();
    println!("nanoseconds a pixel, the best of 9 rounds; in brackets without highlights");
    for kind in [LightType::Directional, LightType::Point, LightType::Spot] {
        for count in [1, 4] {
            let [glossy, dull] = [0x00FF_FFFF, 0].map(|specular| lights(kind, count, specular));
            print!("{:>12} {count}: scalar {:6.2}", kind.name(), scalar_rate(&glossy, &chunks));
            for (name, level) in &levels {
                if let Some(level) = *level {
                    print!(", {name} {:5.2} ({:.2})", rate(&glossy, level, &chunks), rate(&dull, level, &chunks));
                }
            }
            println!();
        }
    }
    for function in [FogFunction::Linear, FogFunction::ExponentialSquared] {
        let mixer =
            FogMixer::new(&Fog { function, density: 0.1, end: 20.0, cue_scale: 0.0, cue_offset: 1.0, colour: 0x80 });
        print!("{:>20}:", function.name());
        for (name, level) in &levels {
            if let Some(level) = *level {
                let rate = time(&chunks, |chunk| {
                    dispatch!(level, _simd => mixer.mixed_lanes(&chunk.colours, &chunk.position[2]))[0]
                });
                print!(" {name} {rate:5.2}");
            }
        }
        println!();
    }
}

/// A chunk of a curved surface, seen from all sides.
fn chunk(n: usize) -> Chunk {
    let along = |lane: usize| (n * LANES + lane) as f32 * 0.01;
    Chunk {
        colours: std::array::from_fn(|lane| 0xFF00_0000 | (n * 7919 + lane) as u32),
        position: [
            std::array::from_fn(along),
            std::array::from_fn(|lane| 1.0 - along(lane)),
            std::array::from_fn(|lane| (along(lane) * 0.1) % 20.0),
        ],
        normal: [
            std::array::from_fn(|lane| along(lane).sin()),
            std::array::from_fn(|lane| 0.3 * along(lane).cos()),
            std::array::from_fn(|lane| along(lane).cos()),
        ],
    }
}

/// `count` lights of one kind, and a material.
fn lights(kind: LightType, count: u32, specular: u32) -> Lights {
    let record = |n: u32| LightRecord {
        kind: kind.code(),
        position: [n as f32, 3.0, 5.0],
        direction: [0.1 * n as f32, -0.5, -1.0],
        cut_off: 1000.0,
        spot_exponent: 8.0,
        colour: 0x00C0_B0A0,
        ambient: 0x0010_1010,
        reserved: [0; 5],
    };
    let memory: Vec<u32> = (0..count).flat_map(|n| bytemuck::cast::<LightRecord, [u32; 16]>(record(n))).collect();
    let lighting = Lighting {
        per_pixel: true,
        two_sided: false,
        local_viewer: true,
        lights: 0,
        count,
        ambient: 0x0020_2020,
        specular,
        emission: 0,
        shininess: 20.0,
    };
    Lights::read(&memory, &lighting)
}

/// One pixel after another.
fn scalar_rate(lights: &Lights, chunks: &[Chunk]) -> f64 {
    time(chunks, |chunk| {
        let at = |v: &[[f32; LANES]; 3], lane: usize| [v[0][lane], v[1][lane], v[2][lane]];
        let lit = |lane| lights.lit(chunk.colours[lane], at(&chunk.position, lane), at(&chunk.normal, lane));
        (0..LANES).map(lit).fold(0, |all, colour| all ^ colour)
    })
}

/// 16 pixels at once.
fn rate(lights: &Lights, level: Level, chunks: &[Chunk]) -> f64 {
    time(chunks, |chunk| {
        let lit = dispatch!(level, _simd => lights.lit_lanes(&chunk.colours, &chunk.position, &chunk.normal));
        lit[0]
    })
}

/// Nanoseconds a pixel of the best of 9 rounds.
fn time(chunks: &[Chunk], mut shade: impl FnMut(&Chunk) -> u32) -> f64 {
    let round = |_| {
        let start = Instant::now();
        black_box(chunks.iter().fold(0, |all, chunk| all ^ shade(chunk)));
        start.elapsed().as_nanos() as f64 / (CHUNKS * LANES) as f64
    };
    (0..9).map(round).fold(f64::INFINITY, f64::min)
}
