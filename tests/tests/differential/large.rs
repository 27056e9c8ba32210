//! Draws that are large enough for threads, full bins and several batches.

use zga_device::Kernel;
use zga_tests::harness::scenes::fixed;
use zga_tests::harness::screen::raw;
use zga_tests::harness::{Counts, Feed, Options, Picture, Random, RawVertex, Screen, State, Topology};
use zga_tests::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};

/// Draws a scene in its own colours on 333 x 201 pixels.
fn drawn(primitives: &[Primitive], options: &Options, state: &State) -> (Picture, Counts) {
    let mut screen = Screen::new(333, 201, options);
    screen.clear_counts();
    screen.draw(primitives, state);
    (screen.read(), screen.counts())
}

#[test]
fn draw_large_scene_every_kernel_thread_count_piece_and_feed_is_identical() {
    let primitives = fixed(1, [333, 201], 5000, 14);
    let state = State { gouraud: true, ..State::default() };
    let reference = drawn(&primitives, &Options { kernel: Kernel::Specification, ..Options::default() }, &state);
    for kernel in Kernel::available() {
        for threads in 1..=4 {
            for (piece, feed) in [(0, Feed::Ring), (2500, Feed::Ring), (0, Feed::Fifo), (100, Feed::Ring)] {
                let options = Options { kernel, threads, feed, ..Options::default() };
                let found = drawn(&primitives, &options, &State { piece, ..state });
                assert!(
                    found == reference,
                    "{kernel:?}, {threads} threads, pieces of {piece}, {feed:?}: {:?}",
                    found.1
                );
            }
        }
    }
}

#[test]
fn draw_large_scene_four_threads_equals_the_oracle() {
    let primitives = fixed(2, [333, 201], 5000, 14);
    let mut screen = Screen::new(333, 201, &Options { threads: 4, ..Options::default() });

    screen.draw_ids(&primitives, &State::default());

    let image = draw(333, 201, &primitives, DepthFormat::default(), DepthFunction::Less);
    let found = screen.read().against(&image);
    assert!(found.none(), "{found}");
}

#[test]
fn draw_buffer_of_several_batches_equals_the_oracle() {
    // More than 2^18 triangles in one packet: the card cuts it into batches.
    let primitives: Vec<Primitive> = fixed(3, [200, 120], 300_000, 2)[..300_000].to_vec();
    let ids = |number: usize| number as u32 + 1;
    let vertices: Vec<RawVertex> = (0..)
        .zip(&primitives)
        .flat_map(|(n, p)| p.vertices().iter().map(move |v| raw(v, 24, 0xFF00_0000 | ids(n).swap_bytes() >> 8)))
        .collect();
    let image = draw(200, 120, &primitives, DepthFormat::default(), DepthFunction::LessEqual);
    for threads in [1, 3] {
        let options = Options { threads, vertex_bytes: 16 << 20, ..Options::default() };
        let mut screen = Screen::new(200, 120, &options);
        screen.draw_buffer(Topology::Triangles, &vertices, None, &State::with(DepthFunction::LessEqual));
        let found = screen.read().against(&image);
        assert!(found.none(), "{threads} threads: {found}");
    }
}

#[test]
fn draw_of_full_bins_equals_the_same_in_pieces() {
    // 5400 triangles over 256 tiles each fill the bins (64 MiB) of every share before it is through.
    let mut random = Random::new(4);
    let triangles: Vec<Primitive> = (0..5400)
        .map(|_| {
            let mut at = |x: i32, y: i32| {
                let z = random.depth((1 << 24) - 1);
                Vertex::at(x * 256 + random.int(-9000, 9000), y * 256, z).coloured((random.bits() as u32).to_le_bytes())
            };
            Primitive::Triangle([at(-40, -20_000), at(16_424, -20_000), at(8000, 25_000)])
        })
        .collect();
    let draw = |threads: usize, piece: usize| {
        let mut screen = Screen::new(16_384, 2, &Options { threads, ..Options::default() });
        screen.clear_counts();
        screen.draw(&triangles, &State { piece, ..State::default() });
        (screen.read(), screen.counts())
    };

    let reference = draw(1, 500);

    assert!(draw(1, 0) == reference, "one thread");
    assert!(draw(2, 0) == reference, "two threads");
    assert!(draw(3, 0) == reference, "three threads");
}
