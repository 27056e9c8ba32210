//! How long the exact oracle takes, fast forms and plain ones.
//!
//! ```text
//! cargo run --release -p zga-tests --example oracle_time -- --triangles 10000 --seed 1
//! ```
//! Scenes of 1024x768 pixels with triangles whose corners are uniform in squares of 40 and 200 pixels, and on the whole
//! target; 4x4 and 8x8 are supersampled pictures, with the mean of their samples. `--plain 1` times the definitions as well, and compares: it takes minutes.

use std::process::ExitCode;
use std::time::Instant;
use zga_tests::harness::{Random, scenes};
use zga_tests::oracle::canvas::Test;
use zga_tests::oracle::image::draw_plain;
use zga_tests::oracle::supersample::{Brush, Resolve, Supersampled};
use zga_tests::oracle::truth::draw_true_plain;
use zga_tests::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw, draw_true};

const SIZE: [u32; 2] = [1024, 768];

/// Corners anywhere on the target.
fn over_everything(seed: u64, count: usize) -> Vec<Primitive> {
    let mut random = Random::new(seed);
    let mut vertex = || {
        let [x, y] = SIZE.map(|side| random.int(0, side as i32 * 256));
        Vertex::at(x, y, random.depth((1 << 24) - 1))
    };
    (0..count).map(|_| Primitive::Triangle([vertex(), vertex(), vertex()])).collect()
}

fn seconds<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

fn main() -> ExitCode {
    let (mut triangles, mut seed, mut plain) = (10_000, 1, false);
    let mut given = std::env::args().skip(1);
    while let Some(name) = given.next() {
        let value: Option<u64> = given.next().and_then(|value| value.parse().ok());
        match (name.as_str(), value) {
            ("--triangles", Some(value)) => triangles = value as usize,
            ("--seed", Some(value)) => seed = value,
            ("--plain", Some(value)) => plain = value != 0,
            _ => {
                eprintln!("{name}: expected --triangles N, --seed N and --plain 0 or 1");
                return ExitCode::from(2);
            }
        }
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("{}x{} pixels, {triangles} triangles, {threads} threads, seed {seed}", SIZE[0], SIZE[1]);
    let columns = ["fragments", "draw", "draw_true", "4x4", "8x8"];
    print!("{:<16}", "corners within");
    columns.iter().for_each(|name| print!(" {name:>12}"));
    println!();
    let scenes = [
        ("40 px", scenes::fixed(seed, SIZE, triangles, 40)),
        ("200 px", scenes::fixed(seed, SIZE, triangles, 200)),
        ("the target", over_everything(seed, triangles)),
    ];
    let (format, function) = (DepthFormat::default(), DepthFunction::Less);
    let mut same = true;
    for (name, scene) in scenes {
        let (image, draw_s) = seconds(|| draw(SIZE[0], SIZE[1], &scene, format, function));
        let (truth, true_s) = seconds(|| draw_true(SIZE[0], SIZE[1], &scene, format, function));
        let fragments: u64 = image.layers.iter().map(|&layers| u64::from(layers)).sum();
        print!("{name:<16} {fragments:>12} {draw_s:>10.2} s {true_s:>10.2} s");
        // 64 samples of every fragment of triangles as large as the target: too much.
        if fragments < 100_000_000 {
            for grid in [[4, 4], [8, 8]] {
                let test =
                    Test { function: Some(function), write: true, scissor: [0, 0, SIZE[0], SIZE[1]], stencil: None };
                let mut target = Supersampled::new(SIZE, grid, format, Resolve::Values);
                let (_, s) = seconds(|| {
                    target.draw(&scene, &Brush::masked(test));
                    target.end()
                });
                print!(" {s:>10.2} s");
            }
        }
        println!();
        if plain {
            let (slow, draw_s) = seconds(|| draw_plain(SIZE[0], SIZE[1], &scene, format, function));
            let (slow_truth, true_s) = seconds(|| draw_true_plain(SIZE[0], SIZE[1], &scene, format, function));
            same &= image == slow && truth.winner == slow_truth.winner && truth.depth == slow_truth.depth;
            println!("{:<16} {:>12} {draw_s:>10.2} s {true_s:>10.2} s", "  plain", "");
        }
    }
    if !same {
        eprintln!("a fast form is not the plain one's");
    }
    ExitCode::from(u8::from(!same))
}
