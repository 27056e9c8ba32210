//! Random words never panic, and never make the card do what it must not.
//!
//! The mock checks every argument it gets; a refused packet must have done nothing at all.

use crate::bench::{Bench, packet};
use crate::mock::{Call, MEMORY};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use zga_abi::FaultCode;
use zga_firmware::{Processor, ProcessorState};

/// COMPOSE of an rgb565 source, repeated, through a transformed alpha8 mask; a clip box, a rectangle.
const COMPOSE: [u32; 40] = [
    0x1000,
    256,
    1,
    0x0008_0010,
    3,
    1,
    0,
    1,
    2,
    2,
    1,
    0x8000,
    64,
    0x0008_0010,
    1,
    2,
    0,
    0,
    0,
    0,
    0,
    0,
    3,
    3,
    0,
    0xA001,
    17,
    0x0008_0010,
    3,
    4,
    0x1_0000,
    5,
    6,
    7,
    0x1_0000,
    9,
    0,
    0x0008_0010,
    1,
    0x0002_0003,
];

/// Something the host does.
#[derive(Clone, Debug)]
enum Step {
    /// Writes any value to a register that packets or hosts may write.
    Poke(u32, u32),
    /// Sends a packet.
    Send(Vec<u32>),
}

/// Numbers that are likely to mean something somewhere.
fn number() -> impl Strategy<Value = u32> {
    let edges = vec![
        0,
        1,
        2,
        3,
        4,
        8,
        64,
        128,
        256,
        0x1000,
        0x4000,
        0x8000,
        16384,
        16385,
        0x0001_0001,
        0x0020_0040,
        0x1818,
        MEMORY - 64,
        MEMORY - 4,
        MEMORY,
        0x5555_5556,
        0x7FFF_FFFF,
        0x8000_0000,
        0xFFFF_FFC0,
        0xFFFF_FFFC,
        0xFFFF_FFFF,
    ];
    prop_oneof![
        3 => 0..20_u32,
        3 => prop::sample::select(edges),
        2 => (0..MEMORY / 64).prop_map(|chunk| chunk * 64),
        1 => any::<u32>(),
    ]
}

/// A packet whose header is right for its opcode and whose payload is anything.
fn shaped() -> impl Strategy<Value = Vec<u32>> {
    let lengths = vec![
        (0x00, 0..3),
        (0x01, 2..6),
        (0x02, 0..1),
        (0x02, 0..1),
        (0x03, 0..1),
        (0x04, 3..4),
        (0x10, 3..40),
        (0x11, 5..6),
        (0x20, 8..9),
        (0x21, 11..12),
        (0x22, 4..12),
        (0x23, 5..6),
        (0x24, 10..11),
        (0x25, 13..14),
        (0x26, 12..13),
        (0x27, 19..20),
        (0x28, 9..16),
        (0x29, 13..20),
        (0x2A, 10..17),
        (0x2B, 11..20),
        (0x2C, 36..46),
        (0x30, 1..2),
        (0x31, 1..2),
        (0x32, 1..2),
    ];
    prop::sample::select(lengths).prop_flat_map(|(opcode, words)| {
        prop::collection::vec(number(), words).prop_map(move |payload| packet(opcode, &payload))
    })
}

/// A packet that is right but for at most two words.
fn nearly() -> impl Strategy<Value = Vec<u32>> {
    let right: Vec<Vec<u32>> = vec![
        packet(0x04, &[3, 0, 0xFFFF]),
        packet(0x04, &[0x3307, 0, 0xFFFF]),
        packet(0x20, &[0x1000, 256, 0, 2, 3, 10, 20, 5]),
        packet(0x21, &[2, 0x1000, 128, 2, 3, 0x8000, 64, 4, 5, 10, 20]),
        packet(0x22, &[0x1004, 12, 3, 2, 1, 2, 3, 4, 5, 6]),
        packet(0x23, &[0x1004, 16, 3, 2, 0x8004]),
        packet(0x24, &[0x1000, 256, 3, 2, 3, 10, 20, 5, 6, 0xF0]),
        packet(0x25, &[2, 0x1000, 128, 2, 3, 0x1000, 128, 4, 5, 10, 20, 7, 0xFFFF]),
        packet(0x26, &[2, 0x1000, 128, 2, 3, 0, 0x8000, 64, 4, 5, 10, 20]),
        packet(0x27, &[1, 2, 0x1000, 128, 2, 3, 8, 9, 1, 0x1020, 128, 4, 5, 10, 20, 40, 30, 8, 9]),
        packet(0x28, &[0x1000, 256, 0, 0x0008_0010, 6, 7, 0xFFFF_0001, 1, 5, 0, 0x0008_0010, 1, 0x0002_0003]),
        packet(0x29, &[0x1000, 64, 3, 0x0008_0010, 3, 7, 0, 1, 0x1000, 64, 0x0008_0010, 1, 1, 0, 99, 1, 0x0002_0003]),
        packet(0x2A, &[0x1000, 256, 2, 0x0008_0010, 3, 7, 0, 1, 5, 3, 0, 0x0008_0010, 1, 0x0002_0003]),
        packet(0x2B, &[0x1000, 256, 1, 0x0008_0010, 3, 7, 0, 1, 5, 6, 1, 0, 99, 1, 0x0002_0003, 5, 6]),
        packet(0x2C, &COMPOSE),
        packet(0x31, &[0x4000]),
        packet(0x32, &[0x8000]),
    ];
    let changes = prop::collection::vec((any::<prop::sample::Index>(), number()), 0..3);
    (prop::sample::select(right), changes).prop_map(|(mut packet, changes)| {
        for (place, value) in changes {
            let payload = &mut packet[1..];
            payload[place.index(payload.len())] = value;
        }
        packet
    })
}

/// A draw from memory that is nearly right.
fn draw_buffer() -> impl Strategy<Value = Vec<u32>> {
    let flags = prop::sample::select(vec![0_u32, 1, 2, 3, 0x10, 0x11, 0x110, 0x100, 0x200, 0x610, 0x700]);
    (flags, 0..MEMORY / 4, 0..9_u32, 0..MEMORY / 4, 0..9_u32).prop_map(
        |(flags, vertices, count, indices, index_count)| {
            let indexed = (flags >> 4) & 1;
            let tail = [indexed * indices * 4, indexed * index_count];
            packet(0x11, &[flags, vertices * 4, count, tail[0], tail[1]])
        },
    )
}

/// A draw in the packet whose counts fit.
fn draw_inline() -> impl Strategy<Value = Vec<u32>> {
    let flags = prop::sample::select(vec![0_u32, 1, 2, 3, 0x10, 0x13, 0x110, 0x100, 0x400, 0x310, 0x700]);
    (flags, 0..6_u32, prop::collection::vec(0..7_u32, 0..6)).prop_map(|(flags, count, indices)| {
        let carries = |bit: u32, words: u32| (flags >> bit & 1) * words;
        let vertex_words = 3 + carries(8, 1) + carries(9, 3) + carries(10, 2);
        let indices = if flags & 0x10 == 0 { &[] } else { &indices[..] };
        let vertices = vec![0; (count * vertex_words) as usize];
        packet(0x10, &[&[flags, count, indices.len() as u32], &vertices[..], indices].concat())
    })
}

/// The register groups that have an effect on packets.
fn poke() -> impl Strategy<Value = Step> {
    let offsets = vec![
        0x0200, 0x0204, 0x0208, 0x020C, 0x0210, 0x0214, 0x0218, 0x021C, 0x0220, 0x0328, 0x032C, 0x0380, 0x0240, 0x0244,
        0x0260, 0x0264, 0x0268, 0x026C, 0x0270, 0x0280, 0x0284, 0x0290, 0x0294, 0x0298, 0x029C, 0x0300, 0x0304, 0x0308,
        0x030C, 0x0310, 0x0318, 0x031C, 0x0320, 0x0324, 0x0330, 0x0334, 0x0338, 0x033C, 0x0340, 0x0350, 0x0354, 0x0358,
        0x0368, 0x0600, 0x0608, 0x060C, 0x0680, 0x0688, 0x068C, 0x0690, 0x0694,
    ];
    // A target and a screen that make sense, word by word.
    let sensible = vec![
        (0x0200, 0x0020_0040),
        (0x0208, 256),
        (0x020C, 0),
        (0x0214, 256),
        (0x0218, 0x1818),
        (0x0240, 1),
        (0x0244, 8),
        (0x0260, 3),
        (0x0264, 2),
        (0x0268, 1),
        (0x026C, 0x1000),
        (0x0270, 1),
        (0x0280, 3),
        (0x0280, 0x503),
        (0x0280, 0xBFE),
        (0x0280, 0xBFE),
        (0x0304, 0x0007_0009),
        (0x0308, 0x0004_F125),
        (0x030C, 0x0001_0002),
        (0x0310, 0x0003_0000),
        (0x0324, 2),
        (0x0330, 3),
        (0x0334, 0x3F00_0000),
        (0x0338, 0x4200_0000),
        (0x033C, 0x3F00_0000),
        (0x0340, 0x3F80_0000),
        (0x0358, 3),
        (0x0368, 0x4100_0000),
        (0x0298, 0x180),
        (0x029C, 0x180),
        (0x0600, 0),
        (0x068C, 256),
        (0x0690, 1),
        (0x0694, 0x0020_0040),
    ];
    prop_oneof![(prop::sample::select(offsets), number()), prop::sample::select(sensible),]
        .prop_map(|(offset, value)| Step::Poke(offset, value))
}

fn step() -> impl Strategy<Value = Step> {
    prop_oneof![
        3 => poke(),
        4 => shaped().prop_map(Step::Send),
        4 => nearly().prop_map(Step::Send),
        2 => draw_buffer().prop_map(Step::Send),
        2 => draw_inline().prop_map(Step::Send),
        1 => Just(Step::Send(packet(0x02, &[]))),
        1 => prop::collection::vec(any::<u32>(), 0..20).prop_map(Step::Send),
    ]
}

/// The card after these steps; every packet has kept the rules.
fn follow(mut bench: Bench, steps: Vec<Step>) -> Result<(), TestCaseError> {
    for step in steps {
        let packet = match step {
            Step::Poke(offset, value) => {
                bench.card.set(offset, value);
                continue;
            }
            Step::Send(packet) => packet,
        };
        let before = bench.processor.state();
        let (result, calls) = bench.run(&packet);
        if let Err(fault) = result {
            prop_assert_eq!(calls, vec![], "{} left something done", fault);
            prop_assert_eq!(bench.processor.state(), before);
            prop_assert!((fault.word as usize) < packet.len().max(1), "{}", fault);
        }
        prop_assert_eq!(bench.processor.in_scene(), bench.card.target.is_some());
        prop_assert_eq!(bench.processor.units_powered(), bench.card.units);
        prop_assert_eq!(bench.card.units.bits(), bench.card.get(0x0704));
        let effects = bench.processor.effects_called();
        prop_assert_eq!(effects.bits(), bench.card.get(0x0700));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn execute_any_stream_after_power_on_keeps_every_promise(
        steps in prop::collection::vec(step(), 1..30)
    ) {
        follow(Bench::new(), steps)?;
    }

    #[test]
    fn execute_any_stream_in_a_scene_keeps_every_promise(
        steps in prop::collection::vec(step(), 1..30)
    ) {
        follow(Bench::in_scene(), steps)?;
    }

    #[test]
    fn execute_any_stream_on_a_small_card_keeps_every_promise(
        steps in prop::collection::vec(step(), 1..30), effects in 0..0x1000_u32, paths in 0..16_u32,
    ) {
        let mut bench = Bench::with_target();
        bench.card.set(0x0008, effects);
        bench.card.set(0x000C, paths);
        follow(bench, steps)?;
    }

    #[test]
    fn packet_length_of_any_header_is_one_more_than_its_payload_or_a_header_fault(header: u32) {
        match Processor::packet_length(header) {
            Ok(words) => {
                prop_assert_eq!(words, 1 + (header & 0x000F_FFFF));
                prop_assert_eq!(header & 0x00F0_0000, 0);
            }
            Err(fault) => {
                prop_assert_eq!((fault.word, fault.value), (0, header));
                prop_assert!(matches!(
                    fault.code,
                    FaultCode::UnknownOpcode | FaultCode::ReservedBits | FaultCode::BadLength
                ));
            }
        }
    }

    #[test]
    fn packet_length_faults_exactly_when_execute_refuses_the_header(packet in shaped(), word: u32) {
        let mut bench = Bench::in_scene();
        let mut bad = packet.clone();
        bad[0] = word;
        let early = Processor::packet_length(word).err();
        let (result, calls) = bench.run(&bad);
        prop_assert!(early.is_none() || result == Err(early.unwrap()));
        prop_assert!(early.is_none() || calls.is_empty());
    }

    #[test]
    fn from_state_of_any_words_is_refused_or_gives_them_back(
        head in (0..3_u32, 0..0x1100_u32, 0..0x1100_u32), target in prop::array::uniform22(number())
    ) {
        let state = ProcessorState {
            in_scene: head.0,
            effects_called: head.1,
            units_powered: head.2,
            target,
        };
        let bench = Bench::new();
        if let Ok(processor) = Processor::from_state(&bench.card, &state) {
            prop_assert_eq!(processor.in_scene(), state.in_scene == 1);
            prop_assert_eq!(processor.effects_called().bits(), state.effects_called);
            if let Some(target) = processor.target() {
                crate::invariants::target(&bench.card, target);
                prop_assert_eq!(processor.state(), state);
            }
        }
    }
}

#[test]
fn random_streams_reach_every_unit() {
    // The strategies above would prove little if nearly all of their packets were refused.
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..3000 {
        let steps = prop::collection::vec(step(), 30).new_tree(&mut runner).expect("steps").current();
        let mut bench = Bench::in_scene_with_stencil_plane();
        for step in steps {
            match step {
                Step::Poke(offset, value) => bench.card.set(offset, value),
                Step::Send(packet) => seen.extend(bench.run(&packet).1.iter().flat_map(kinds)),
            }
        }
    }
    let all = [
        "begin",
        "clear",
        "combine",
        "convert",
        "copy",
        "download",
        "draw",
        "end",
        "fence",
        "fill",
        "fogged draw",
        "list",
        "lit draw",
        "power",
        "present",
        "register",
        "stencil draw",
        "stretch",
        "textured draw",
        "textured draw with holes",
        "upload",
        "write back",
    ];
    assert_eq!(seen.into_iter().collect::<Vec<_>>(), all);
}

/// The name of a call, and of what a draw has beside depth and colour.
fn kinds(call: &Call) -> impl Iterator<Item = &'static str> {
    let effects = match call {
        Call::Draw(state, _) => [
            state.texture.map(|_| "textured draw"),
            state.punch_through.map(|_| "textured draw with holes"),
            state.light.map(|_| "lit draw"),
            state.fog.map(|_| "fogged draw"),
            state.stencil.map(|_| "stencil draw"),
        ],
        _ => [None; 5],
    };
    std::iter::once(kind(call)).chain(effects.into_iter().flatten())
}

/// The name of a call.
fn kind(call: &Call) -> &'static str {
    match call {
        Call::PacketTaken(_) => "packet",
        Call::SetRegister(..) => "register",
        Call::Power(_) => "power",
        Call::BeginScene(_) => "begin",
        Call::EndScene(_) => "end",
        Call::Clear(_) => "clear",
        Call::Draw(..) => "draw",
        Call::Fill(_) => "fill",
        Call::Copy(_) => "copy",
        Call::Combine(_) => "combine",
        Call::Convert(_) => "convert",
        Call::Stretch(_) => "stretch",
        Call::Upload(..) => "upload",
        Call::Download(..) => "download",
        Call::Fence(_) => "fence",
        Call::Present(_) => "present",
        Call::WriteBack(_) => "write back",
        Call::List(_) => "list",
    }
}
