//! What a look-up of the texture unit costs on this host, nanoseconds a pixel, for each filter and SIMD level:
//! `cargo run --release --example texel_rate -p zga-device`.

use fearless_simd::{Level, dispatch};
use std::hint::black_box;
use std::time::Instant;
use zga_abi::format::{TextureFilter, TextureFormat, TextureFunction};
use zga_device::texture::{Texture, combine_lanes};
use zga_firmware::checked;

/// Side of the texture, texels.
const SIDE: u32 = 512;

/// Chunks of 16 pixels in a round.
const CHUNKS: u32 = 1 << 14;

fn main() {
    let levels: Vec<(&str, Level)> = levels();
    let memory: Vec<u32> = (0..SIDE * SIDE * 2).map(|word| word.wrapping_mul(0x9E37_79B9)).collect();
    let show = |name: &str, round: &dyn Fn(Level)| {
        print!("{name:>32}:");
        for &(level, simd) in &levels {
            print!("  {level} {:6.2}", best(|| round(simd)));
        }
        println!();
    };
    println!("nanoseconds a pixel, the best of 20 rounds");
    let unit = |filter, repeat, mirror| Texture::decode(&memory, &texture(filter, repeat, mirror));
    let trilinear = unit(TextureFilter::Trilinear, false, false);
    show("level of detail", &|level| {
        black_box(dispatch!(level, _simd => levels_of_detail(&trilinear)));
    });
    for function in [TextureFunction::Modulate, TextureFunction::Decal, TextureFunction::Blend] {
        show(&format!("function {}", function.name()), &|level| {
            black_box(dispatch!(level, _simd => combinations(function)));
        });
    }
    // Levels of detail, 1/256 levels, of the first pixel of a chunk, and from a pixel to the next.
    for (name, filter, lambda) in [
        ("nearest", TextureFilter::Nearest, [100, 0]),
        ("bilinear", TextureFilter::Bilinear, [100, 0]),
        ("trilinear magnified", TextureFilter::Trilinear, [0, 0]),
        ("trilinear", TextureFilter::Trilinear, [100, 1]),
        ("trilinear levels differ", TextureFilter::Trilinear, [100, 30]),
    ] {
        for (wrap, repeat, mirror) in [("clamp", false, false), ("repeat", true, false), ("mirror", false, true)] {
            let texture = unit(filter, repeat, mirror);
            show(&format!("{name}, {wrap}"), &|level| {
                black_box(dispatch!(level, _simd => look_ups(&texture, lambda)));
            });
        }
    }
}

/// The least time of 20 rounds, nanoseconds a pixel.
fn best(round: impl Fn()) -> f64 {
    let time = |_| {
        let begun = Instant::now();
        round();
        begun.elapsed().as_secs_f64() * 1e9 / f64::from(CHUNKS) / 16.0
    };
    (0..20).map(time).fold(f64::INFINITY, f64::min)
}

/// SIMD levels of this host.
fn levels() -> Vec<(&'static str, Level)> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let others = [
        ("SSE2", best.as_sse2().map(Level::Sse2)),
        ("SSE4.2", best.as_sse4_2().map(Level::Sse4_2)),
        ("AVX2", best.as_avx2().map(Level::Avx2)),
        ("AVX-512", best.as_avx512().map(Level::Avx512)),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let others = [("best", Some(best))];
    others.into_iter().filter_map(|(name, level)| Some((name, level?))).collect()
}

/// A square texture with all levels.
fn texture(filter: TextureFilter, repeat: bool, mirror: bool) -> checked::Texture {
    checked::Texture {
        base: 0,
        size: [SIDE; 2],
        format: TextureFormat::Rgba8888,
        levels: 10,
        palette: 0,
        offset: [0; 2],
        window: [SIDE; 2],
        repeat: [repeat; 2],
        mirror: [mirror; 2],
        filter,
        function: TextureFunction::Modulate,
        colour: 0,
        bias: 0,
        mip_map: true,
    }
}

/// Adds up what is found, lest it be left out. The loops around the calls are written out: a closure that is not
/// inlined would be compiled for the least SIMD level.
#[inline(always)]
fn add(sum: &mut [u32; 16], values: [u32; 16]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum = sum.wrapping_add(value);
    }
}

/// Levels of detail of all chunks.
#[inline(always)]
fn levels_of_detail(texture: &Texture) -> [u32; 16] {
    let gradients = [[0.003; 16], [0.0001; 16], [0.001; 16], [0.002; 16]];
    let mut sum = [0; 16];
    for _ in 0..CHUNKS {
        let [a, b, c, d] = black_box(&gradients);
        add(&mut sum, texture.level_of_detail_lanes([a, b, c, d]).map(|lambda| lambda as u32));
    }
    sum
}

/// Texture function of all chunks.
#[inline(always)]
fn combinations(function: TextureFunction) -> [u32; 16] {
    let (colour, texel) = ([0xFF80_C040; 16], [0x7F12_3456; 16]);
    let mut sum = [0; 16];
    for chunk in 0..CHUNKS {
        add(&mut sum, combine_lanes(function, black_box(&colour), black_box(&texel), chunk));
    }
    sum
}

/// Look-ups of all chunks, rows of a picture of 512 pixels.
#[inline(always)]
fn look_ups(texture: &Texture, [first, step]: [i32; 2]) -> [u32; 16] {
    let mut rows = [[0.0; 16]; 32];
    for (pixel, u) in rows.as_flattened_mut().iter_mut().enumerate() {
        *u = pixel as f64 * 1.3 / f64::from(SIDE) + 0.001;
    }
    let mut lambda = [first; 16];
    for (lane, lambda) in lambda.iter_mut().enumerate() {
        *lambda += step * lane as i32;
    }
    let mut sum = [0; 16];
    for chunk in 0..CHUNKS {
        let v = [f64::from(chunk >> 5) * 0.0019; 16];
        let u = black_box(&rows[chunk as usize & 31]);
        add(&mut sum, texture.texels(u, &v, black_box(&lambda), black_box(0xFFFF)));
    }
    sum
}
