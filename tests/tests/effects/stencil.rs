//! Stencil tests beside all that a fragment can go through: holes, textures, layers, clears, the shadow bit, on every path
//! in every way, against the oracle.

use super::bench::{Mapping, any_way, chance, pick, triangle};
use super::{cases, seeds};
use proptest::prelude::*;
use zga_device::Kernel;
use zga_tests::harness::{Events, Hidden, Look, Options, Picture, Random, Sampler, Stage, State};
use zga_tests::oracle::DepthFunction;
use zga_tests::oracle::effects::texel::Format;
use zga_tests::oracle::stencil::{Operation, Shadow, Stencil};

const SIZE: [u32; 2] = [34, 27];

fn any_stencil(random: &mut Random, blends: bool) -> Stencil {
    let mut operations = || {
        let all = Operation::ALL;
        if blends || chance(random, 20) { [Operation::Keep; 3] } else { [(); 3].map(|()| pick(random, &all)) }
    };
    let (front, back) = (operations(), operations());
    let mask = |random: &mut Random| if chance(random, 75) { 0xFF } else { random.bits() as u8 };
    Stencil {
        function: if chance(random, 30) { DepthFunction::Always } else { pick(random, &DepthFunction::ALL) },
        reference: random.range(0, 3) as u8,
        read_mask: mask(random),
        write_mask: mask(random),
        front,
        back,
        colours: blends || chance(random, 70),
    }
}

/// A draw, or a clear of stencil values.
fn step(stage: &mut Stage, sampler: &Sampler, seed: u64, piece: usize) {
    let mut random = Random::new(seed);
    if chance(&mut random, 12) {
        let corner = SIZE.map(|side| random.range(0, i64::from(side)) as u32);
        let area = chance(&mut random, 60).then_some([corner[0] / 2, 0, corner[0], corner[1]]);
        stage.clear_stencil(random.range(0, 2) as u8, area);
        return;
    }
    let mapping = Mapping::any(&mut random, [8, 8]);
    let blends = chance(&mut random, 30);
    let alpha = if blends { random.range(1, 254) as u32 } else { 255 };
    let mut corners = Vec::new();
    for _ in 0..random.range(1, 4) {
        let colour = random.bits() as u32 & 0x00FF_FFFF | alpha << 24;
        corners.extend(triangle(&mut random, SIZE, colour));
    }
    for corner in &mut corners {
        corner.coordinates = mapping.at([corner.position[0], corner.position[1]]);
    }
    let textured = Look { punch_through: chance(&mut random, 80).then_some(100), ..Look::textured(*sampler) };
    let look = if chance(&mut random, 60) { textured } else { Look::default() };
    let state = State {
        blend: blends,
        depth_test: chance(&mut random, 85),
        function: if chance(&mut random, 60) { DepthFunction::Less } else { pick(&mut random, &DepthFunction::ALL) },
        write: chance(&mut random, 80),
        stencil: chance(&mut random, 80).then(|| any_stencil(&mut random, blends)),
        piece,
        ..State::looking(look)
    };
    stage.triangles(&corners, &state);
}

/// The scene of these seeds; its first draw tests stencil values, so that there can be shadows.
fn drawn(options: &Options, seeds: &[u64], piece: usize) -> (Picture, Events, String) {
    let mut random = Random::new(seeds[0]);
    let format = pick(&mut random, &Format::ALL);
    let (sampler, words) = Sampler::noise(&mut random, format, [8, 8]);
    let sampler = Sampler { repeat: [true; 2], ..sampler };
    let mut stage = Stage::new(SIZE, &Options { stencil: true, ..*options }, &words);
    stage.screen.clear_counts();
    let all = any_stencil(&mut random, false);
    let first = triangle(&mut random, SIZE, 0xFF20_4060);
    stage.triangles(&first, &State { stencil: Some(all), piece, ..State::default() });
    seeds.iter().for_each(|&seed| step(&mut stage, &sampler, seed, piece));
    let shadow = Shadow {
        function: pick(&mut random, &DepthFunction::ALL),
        reference: random.range(0, 2) as u8,
        mask: 0xFF,
        intensity: random.bits() as u8,
    };
    let (picture, found, _) = stage.end_in_shadow(&shadow);
    let fault = if found.right() && found.doubtful == 0 { String::new() } else { found.to_string() };
    (picture, stage.screen.events().of_units(), fault)
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn draw_any_stencil_tests_with_holes_and_layers_are_exact_on_every_path(seeds in seeds(8)) {
        let options = any_way(&mut Random::new(seeds[0]));
        let (_, events, fault) = drawn(&options, &seeds, 0);
        prop_assert!(fault.is_empty(), "{:?}: {}", options, fault);
        prop_assert!(events["stencil.failed"] <= events["stencil.tested"]);
        // The same card functional and clocked, by the specification and the fastest kernel.
        let other = Options { hidden: Hidden { clocked: !options.hidden.clocked, ..options.hidden }, ..options };
        let other = Options { kernel: Kernel::Specification, threads: 1, ..other };
        let (_, counted, fault) = drawn(&other, &seeds, 2);
        prop_assert!(fault.is_empty(), "{:?}: {}", other, fault);
        let differences = counted.differences(&events);
        prop_assert!(differences.is_empty(), "{:?} and {:?}: {:?}", options, other, differences);
    }
}
