//! Everything at once: every path, kernel, number of threads and both fidelities give the same bits and the same counts,
//! and the oracle's picture.

use super::bench::{any_fog, any_lights, any_record, chance, paths, pick, seen, specified, stretched};
use super::{cases, seeds};
use proptest::prelude::*;
use zga_device::Kernel;
use zga_tests::harness::look::Record;
use zga_tests::harness::{Comparison, Events, Hidden, Look, Options, Picture, Random, Sampler, Stage, State};
use zga_tests::oracle::DepthFunction;
use zga_tests::oracle::effects::texel::{Filter, Format};

const SIZE: [u32; 2] = [70, 45];
const LIGHTS: u32 = 4;

/// A texture behind the lights' records, both in one region.
fn region(random: &mut Random) -> (Sampler, Vec<u32>) {
    let records: Vec<Record> = (0..LIGHTS).map(|_| any_record(random)).collect();
    let mut words: Vec<u32> = records.iter().flat_map(Record::words).collect();
    let base = 4 * words.len() as u32;
    let format = pick(random, &Format::ALL);
    let (sampler, texels) = Sampler::noise(random, format, [32, 16]);
    words.extend(texels);
    (Sampler { base, palette: base + sampler.palette, ..sampler }, words)
}

/// A draw with any effects.
fn step(stage: &mut Stage, sampler: &Sampler, seed: u64, piece: usize) {
    let mut random = Random::new(seed);
    let texture = chance(&mut random, 60).then(|| {
        let bits = random.bits();
        let flag = |bit: u32| bits >> bit & 1 == 1;
        Sampler {
            filter: pick(&mut random, &Filter::ALL),
            function: random.range(0, 3) as u32,
            repeat: [flag(0), flag(1)],
            mirror: [flag(2), flag(3)],
            bias: random.range(-300, 300) as i16,
            constant: (bits >> 32) as u32,
            ..*sampler
        }
    });
    let look = Look {
        texture,
        mip_map: chance(&mut random, 60),
        punch_through: chance(&mut random, 30).then(|| random.bits() as u8),
        mode: random.range(0, 3) as u32,
        fog: chance(&mut random, 40).then(|| any_fog(&mut random)),
        light: chance(&mut random, 40).then(|| any_lights(&mut random, 0, LIGHTS)),
    };
    let blend = chance(&mut random, 40);
    // Alpha below 255 throughout is a layer, whatever the texture.
    let alpha = if blend { random.range(1, 254) as u32 } else { 255 };
    let gouraud = chance(&mut random, 60);
    let colours = [(); 3].map(|()| random.bits() as u32 & 0x00FF_FFFF | alpha << 24);
    let state = State {
        gouraud,
        blend,
        camera: stretched(SIZE),
        function: if chance(&mut random, 80) { DepthFunction::Less } else { pick(&mut random, &DepthFunction::ALL) },
        write: chance(&mut random, 90),
        piece,
        ..State::looking(look)
    };
    let corners: Vec<_> = (0..random.range(1, 6)).flat_map(|_| seen(&mut random, 25.0, colours)).collect();
    stage.triangles(&corners, &state);
}

fn drawn(options: &Options, seeds: &[u64], piece: usize) -> (Picture, Events, Comparison) {
    let (sampler, words) = region(&mut Random::new(seeds[0]));
    let mut stage = Stage::new(SIZE, options, &words);
    stage.screen.clear_counts();
    seeds.iter().for_each(|&seed| step(&mut stage, &sampler, seed, piece));
    let (picture, found, _) = stage.end();
    (picture, stage.screen.events().of_units(), found)
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn draw_any_effects_every_path_and_way_gives_one_picture(seeds in seeds(6)) {
        let mut first: Option<Picture> = None;
        for hidden in paths().into_iter().filter(|hidden| !hidden.clocked) {
            let plain = specified(hidden);
            let (picture, events, found) = drawn(&plain, &seeds, 0);
            prop_assert!(found.right(), "{:?}: {}", hidden, found);
            let ways = [
                (Options { hidden: hidden.clocked(), ..plain }, 0),
                (Options { kernel: Kernel::Best, threads: 3, ..plain }, 2),
            ];
            let kernels = Kernel::available().into_iter().map(|kernel| (Options { kernel, ..plain }, 0));
            for (options, piece) in ways.into_iter().chain(kernels) {
                let (other, counted, _) = drawn(&options, &seeds, piece);
                prop_assert!(other == picture, "{:?} in pieces of {}", options, piece);
                let differences = counted.differences(&events);
                // Smaller packets are more draws; what they cost in all is the same.
                prop_assert!(differences.is_empty(), "{:?} in pieces of {}: {:?}", options, piece, differences);
            }
            match &first {
                Some(first) => prop_assert!(*first == picture, "{:?} and the first path", hidden),
                None => first = Some(picture),
            }
        }
    }

    #[test]
    fn draw_any_effects_over_each_other_are_seldom_in_doubt(seeds in seeds(3)) {
        let (_, _, found) = drawn(&specified(Hidden::default()), &seeds, 0);

        // Otherwise the comparisons above would say little: holes of a filtered texture are in doubt where its alpha is
        // within the tolerance of the reference, a texel of 60 or so, through at most 18 triangles.
        prop_assert!(found.doubtful * 3 <= found.pixels, "{}", found);
    }
}
