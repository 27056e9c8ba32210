//! One picture: random scripts on every hidden-surface path, in every way the card can draw.
//!
//! The plain Z buffer, drawn by the specification, says what the frames and depths are; where colours are flat the exact
//! oracle says so too. Functional and clocked models must count the same events and clocks, and so must every kernel and
//! number of threads. A failing script is shrunk and printed; proptest also prints the seed. The default run draws more
//! than 2,000 scenes; with `ZGA_LONG=1` it is 20 times as many, each in more ways:
//! `ZGA_LONG=1 cargo test --release -p zga-tests --test paths`.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{FileFailurePersistence, TestCaseError};
use zga_device::Kernel;
use zga_tests::harness::hidden::SUPER_BUFFER;
use zga_tests::harness::scenes::Piece;
use zga_tests::harness::{Hidden, Path, Pixels, Prediction, State, Subpixel};
use zga_tests::oracle::{DepthFormat, Vertex};
use zga_tests::script::any::{script, stencil_script};
use zga_tests::script::{Command, Outcome, Scene, Script, Way, judge, run};

fn long() -> bool {
    std::env::var_os("ZGA_LONG").is_some()
}

fn cases(short: u32) -> ProptestConfig {
    ProptestConfig {
        cases: if long() { 20 * short } else { short },
        max_shrink_iters: 3000,
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("failed"))),
        ..ProptestConfig::default()
    }
}

/// The settings that a script is run with.
#[derive(Clone, Debug)]
struct Settings {
    za: [Hidden; 2],
    systolic: Hidden,
    tile: Hidden,
    /// The sorting paths get a Z buffer.
    depth_buffer: bool,
    kernel: Kernel,
    threads: usize,
    piece: usize,
    /// Paths of a run that changes them from scene to scene.
    order: Vec<usize>,
}

fn block() -> impl Strategy<Value = [u32; 2]> {
    let published = vec![[32, 1], [16, 2], [8, 4], [8, 8]];
    let odd = prop_oneof![
        Just([1, 1]),
        Just([3, 5]),
        Just([64, 64]),
        Just([16384, 1]),
        Just([1, 16384]),
        Just([16384, 16384]),
        [1_u32..70, 1_u32..70],
    ];
    prop_oneof![1 => prop::sample::select(published), 1 => odd]
}

fn za() -> impl Strategy<Value = Hidden> {
    let prediction = prop::sample::select(Prediction::ALL.to_vec());
    (block(), prediction, prop::bool::weighted(0.9), 0_u32..3, any::<bool>()).prop_map(
        |(block, prediction, bypass, lines, apart)| Hidden {
            prediction,
            bypass,
            base: 64 * lines,
            apart,
            ..Hidden::za(block)
        },
    )
}

fn settings() -> impl Strategy<Value = Settings> {
    let tile = prop::sample::select(vec![4, 8, 16, 32, 64]);
    let tile = [tile.clone(), tile].prop_map(Hidden::tile);
    let systolic = (0..2 * SUPER_BUFFER).prop_map(Hidden::systolic);
    let kernel = prop::sample::select(Kernel::available());
    let piece = prop_oneof![2 => Just(0), 1 => 1_usize..6];
    let ways = (any::<bool>(), kernel, 1_usize..4, piece, prop::collection::vec(0_usize..8, 2..5));
    ([za(), za()], systolic, tile, ways).prop_map(|(za, systolic, tile, ways)| {
        let (depth_buffer, kernel, threads, piece, order) = ways;
        Settings { za, systolic, tile, depth_buffer, kernel, threads, piece, order }
    })
}

/// Fails unless the picture is that of the reference, and says how it differs.
fn same(found: &Outcome, reference: &Outcome, way: &Way) -> Result<(), TestCaseError> {
    let difference = found.difference(reference);
    prop_assert!(difference.is_none(), "{:?}: {}", way, difference.unwrap());
    Ok(())
}

/// Runs a script in three ways, functional and clocked, that must count the same; the picture must be the reference's.
fn check(
    script: &Script,
    hidden: Hidden,
    depth_buffer: bool,
    settings: &Settings,
    reference: &Outcome,
) -> Result<(), TestCaseError> {
    let plain = Way { depth_buffer, ..Way::plain(hidden) };
    let first = run(script, &plain);
    same(&first, reference, &plain)?;
    let Settings { kernel, threads, piece, .. } = *settings;
    let mut ways = vec![
        Way { kernel, threads, piece, ..plain.clone() },
        Way { hidden: vec![hidden.clocked()], kernel, threads, ..plain.clone() },
    ];
    if long() {
        ways.extend(Kernel::available().into_iter().map(|kernel| Way { kernel, ..plain.clone() }));
        ways.extend((2..5).map(|threads| Way { kernel: Kernel::Best, threads, ..plain.clone() }));
    }
    for way in &ways {
        let found = run(script, way);
        same(&found, reference, way)?;
        let differences = found.events.differences(&first.events);
        prop_assert!(differences.is_empty(), "{:?} and the specification count {:?}", way, differences);
    }
    Ok(())
}

/// A script on all paths.
fn every_path(script: &Script, settings: &Settings) -> Result<(), TestCaseError> {
    let Settings { za, systolic, tile, depth_buffer, kernel, threads, ref order, .. } = *settings;
    let z_buffer = Hidden::default();
    let plain = Way { depth_buffer: !script.depthless, ..Way::plain(z_buffer) };
    let reference = run(script, &plain);
    let judgement = judge(script, false);
    let fault = judgement.as_ref().and_then(|judgement| judgement.fault(&reference));
    prop_assert!(fault.is_none(), "the plain Z buffer against the oracle: {}", fault.unwrap());
    let other = Way { kernel, threads, ..plain };
    same(&run(script, &other), &reference, &other)?;

    for hidden in za {
        check(script, hidden, depth_buffer || !script.depthless, settings, &reference)?;
    }
    if script.shares_memory() {
        return Ok(());
    }
    if depth_buffer || script.depthless {
        check(script, systolic, depth_buffer, settings, &reference)?;
        check(script, tile, depth_buffer, settings, &reference)?;
    } else {
        let forgetful = run(script, &Way { forgets: true, ..Way::plain(z_buffer) });
        let judgement = judge(script, true);
        let fault = judgement.as_ref().and_then(|judgement| judgement.fault(&forgetful));
        prop_assert!(fault.is_none(), "the Z buffer without memory against the oracle: {}", fault.unwrap());
        check(script, systolic, false, settings, &forgetful)?;
        check(script, tile, false, settings, &forgetful)?;
    }
    if !script.depthless {
        let paths = [z_buffer, za[0], systolic, tile];
        let of = |&number: &usize| if number < 4 { paths[number] } else { paths[number - 4].clocked() };
        let way = Way { hidden: order.iter().map(of).collect(), kernel, threads, ..Way::plain(z_buffer) };
        same(&run(script, &way), &reference, &way)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(700))]

    #[test]
    fn run_any_script_every_path_gives_one_picture_and_both_fidelities_one_count(
        script in script(65, 3), settings in settings(),
    ) {
        every_path(&script, &settings)?;
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn run_any_larger_script_every_path_gives_one_picture_and_both_fidelities_one_count(
        script in script(200, 2), settings in settings(),
    ) {
        every_path(&script, &settings)?;
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn run_any_single_scene_every_path_gives_one_picture_and_both_fidelities_one_count(
        script in script(40, 1), settings in settings(),
    ) {
        every_path(&script, &settings)?;
    }
}

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn run_any_script_with_a_stencil_plane_every_path_gives_one_picture_and_one_plane(
        script in stencil_script(65, 3), settings in settings(),
    ) {
        every_path(&script, &settings)?;
    }
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn run_any_larger_script_with_a_stencil_plane_every_path_gives_one_picture_and_one_plane(
        script in stencil_script(200, 2), settings in settings(),
    ) {
        every_path(&script, &settings)?;
    }
}

#[test]
fn clear_after_a_draw_that_meets_nothing_is_no_background_in_either_fidelity() {
    let corner = |x: i32| Vertex { x, y: 0, z: 0, colour: [0; 4] };
    let clear = Command::Clear { colour: Some(1), depth: Some(5), stencil: None, scissor: None };
    let outside = Command::Draw { pieces: vec![Piece::Point(corner(-999))], state: State::default() };
    let script = Script {
        size: [17, 9],
        format: DepthFormat { bits: 24, fraction: 24 },
        pixels: Pixels::Xrgb8888,
        depthless: false,
        stencil: false,
        gouraud: false,
        subpixel: Subpixel::default(),
        scenes: vec![Scene { frame: 0, commands: vec![clear.clone(), outside, clear], shadow: None, after: vec![] }],
    };
    for hidden in [Hidden::systolic(0), Hidden::tile([8, 8])] {
        let events = [hidden, hidden.clocked()].map(|hidden| run(&script, &Way::plain(hidden)).events);
        assert_eq!(events[1].differences(&events[0]), vec![], "{hidden:?}");
        let fast = run(&script, &Way { kernel: Kernel::Best, ..Way::plain(hidden) }).events;
        assert_eq!(fast.differences(&events[0]), vec![], "{hidden:?}");
    }
    let tokens = run(&script, &Way::plain(Hidden::systolic(0))).events["systolic.tokens"];
    assert_eq!(tokens, 9, "the second clear is a segment on each line");
}

#[test]
fn script_random_ones_have_everything() {
    // The strategies reach what the tests above are for: otherwise they would prove little.
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut seen = [false; 6];
    for _ in 0..200 {
        let script = script(65, 3).new_tree(&mut runner).expect("a script").current();
        let commands: Vec<&Command> = script.scenes.iter().flat_map(|scene| &scene.commands).collect();
        seen[0] |= script.shares_memory();
        seen[1] |= script.scenes.iter().any(|scene| scene.frame == 1);
        seen[2] |= script.scenes.iter().any(|scene| !scene.after.is_empty());
        seen[3] |= commands.iter().any(|command| matches!(command, Command::Clear { depth: None, .. }));
        seen[4] |= commands.iter().any(|command| matches!(command, Command::Clear { scissor: Some(_), .. }));
        seen[5] |= commands.iter().any(|command| matches!(command, Command::Draw { state, .. } if !state.write));
    }
    assert_eq!(seen, [true; 6]);
    assert_eq!(Path::ALL.map(Path::keeps_depths), [false, false, true, true]);
}
