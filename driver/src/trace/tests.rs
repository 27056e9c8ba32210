//! Traces: round trip, replay, and damage at every byte of a small one.

use std::time::Duration;

use proptest::prelude::*;
use zga_abi::bus::Bus;
use zga_abi::registers::Reg;

use super::*;
use crate::bus::{MockBus, RecordingBus};
use crate::{Driver, DriverOptions, TargetOptions};

const MEMORY: u32 = 1 << 20;
const TIMEOUT: Duration = Duration::from_millis(10);

/// A run with a frame, recorded.
fn recorded_run() -> Vec<u8> {
    let bus = RecordingBus::new(MockBus::new(MEMORY), Vec::new()).expect("a vector takes all");
    let options = DriverOptions { ring_words: 4096, ..DriverOptions::default() };
    let mut driver = Driver::open_with(bus, options).expect("opens");
    let target = driver.create_target(TargetOptions::new(8, 4)).expect("room");
    driver.begin_scene(&target).expect("begins");
    driver.end_scene().expect("ends");
    driver.present(&target).expect("presents");
    driver.capture().expect("captures");
    driver.close().expect("closes").finish().expect("a vector takes all").1
}

/// All records of a trace, as text.
fn records(trace: &[u8]) -> Result<Vec<String>, TraceError> {
    let mut reader = TraceReader::new(trace)?;
    let mut all = Vec::new();
    while let Some(record) = reader.next_record()? {
        all.push(format!("{record:?}"));
    }
    Ok(all)
}

#[test]
fn writer_every_kind_of_record_comes_back() {
    let kinds = [
        Record::Write { address: 0x100, value: 7 },
        Record::WriteBurst { address: 0x4000_0000, words: &[1, 2, 3] },
        Record::ReadBurst { address: 0x4000_0000, words: 3, hash: 0x0123_4567_89AB_CDEF },
        Record::WaitInterrupt { mask: 5, lines: 1 },
        Record::FenceReached { sequence: 9 },
        Record::Mark { words: &[4, 5] },
    ];
    let mut writer = TraceWriter::new(Vec::new(), MEMORY).expect("a vector takes all");
    for record in &kinds {
        writer.record(record).expect("a vector takes all");
    }
    let trace = writer.finish().expect("a vector takes all");
    assert_eq!(records(&trace).expect("whole"), kinds.map(|record| format!("{record:?}")));
}

#[test]
fn writer_large_bursts_make_several_blocks() {
    let mut bus = RecordingBus::new(MockBus::new(MEMORY), Vec::new()).expect("a vector takes all");
    let words: Vec<u32> = (0..200_000_u32).map(|i| i.wrapping_mul(2_654_435_761)).collect();
    bus.write_burst(0x4000_0000, &words);
    let (mock, trace) = bus.finish().expect("a vector takes all");
    assert_eq!(&mock.memory()[..words.len()], &words);
    let info = info(&trace[..]).expect("whole");
    assert_eq!((info.words_written, info.records), (200_000, 4));
    assert!(info.blocks >= 2 && info.file_bytes == trace.len() as u64, "{info:?}");
    let mut other = MockBus::new(MEMORY);
    replay(&trace[..], &mut other, TIMEOUT).expect("replays");
    assert_eq!(mock.memory(), other.memory());
}

#[test]
fn replay_same_card_finds_no_difference_and_the_frame() {
    let trace = recorded_run();
    let report = replay(&trace[..], &mut MockBus::new(MEMORY), TIMEOUT).expect("replays");
    assert!(report.is_equal() && report.first_difference.is_none(), "{report:?}");
    assert_eq!((report.compared, report.frames.len()), (1, 1));
    assert_eq!((report.frames[0].width, report.frames[0].height), (8, 4));
    assert_eq!(info(&trace[..]).expect("whole").frames, [report.frames[0].expected.clone()]);
}

#[test]
fn replay_card_with_other_memory_contents_tells_the_first_difference() {
    let mut bus = MockBus::new(MEMORY);
    bus.write_burst(0x4000_0000, &vec![1; (MEMORY / 4) as usize]);
    let report = replay(&recorded_run()[..], &mut bus, TIMEOUT).expect("replays");
    let difference = report.first_difference.expect("the frame");
    assert!(!report.is_equal() && difference.words == 32 && report.differences == 1);
    assert_ne!(report.frames[0].expected, report.frames[0].found);
}

#[test]
fn replay_card_with_less_memory_is_refused() {
    let refused = replay(&recorded_run()[..], &mut MockBus::new(MEMORY / 2), TIMEOUT).expect_err("other card");
    assert!(matches!(refused, TraceError::OtherCard { recorded: MEMORY, found: 0x8_0000 }));
}

#[test]
fn replay_fence_that_does_not_come_stalls_with_its_number() {
    let mut bus = MockBus::new(MEMORY);
    bus.set_pace(crate::bus::Pace::Never);
    let refused = replay(&recorded_run()[..], &mut bus, TIMEOUT).expect_err("stalls");
    assert!(refused.to_string().contains("fence 1 did not come"), "{refused}");
}

#[test]
fn replay_read_outside_of_memory_is_refused() {
    let mut writer = TraceWriter::new(Vec::new(), MEMORY).expect("a vector takes all");
    writer.record(&Record::ReadBurst { address: 0x4000_0000, words: u32::MAX, hash: 0 }).expect("a vector takes all");
    let trace = writer.finish().expect("a vector takes all");
    let refused = replay(&trace[..], &mut MockBus::new(MEMORY), TIMEOUT);
    assert!(matches!(refused, Err(TraceError::BadRead { record: 0, words: u32::MAX, .. })));
}

#[test]
fn replay_error_interrupt_is_waited_for_and_recovered_from() {
    let mut mock = MockBus::new(MEMORY);
    let fault = zga_abi::Fault::new(zga_abi::FaultCode::BadValue, 1, 2);
    mock.refuse_packet(3, fault);
    let bus = RecordingBus::new(mock, Vec::new()).expect("a vector takes all");
    let options = DriverOptions { ring_words: 4096, ..DriverOptions::default() };
    let mut driver = Driver::open_with(bus, options).expect("opens");
    for number in 0..6 {
        driver.packet(zga_abi::packet::Opcode::NoOperation, &[number]).expect("encoded");
    }
    driver.finish().expect_err("packet 3");
    let trace = driver.close().expect("works on").finish().expect("a vector takes all").1;
    let mut again = MockBus::new(MEMORY);
    again.refuse_packet(3, fault);
    replay(&trace[..], &mut again, TIMEOUT).expect("replays");
    assert_eq!(again.read32(Reg::FenceSequence.offset()), 1);
    assert_eq!(again.take_packets().len(), 6, "five packets and the fence");
}

#[test]
fn reader_a_flipped_bit_anywhere_is_refused() {
    let trace = recorded_run();
    for at in 0..trace.len() {
        for bit in 0..8 {
            let mut damaged = trace.clone();
            damaged[at] ^= 1 << bit;
            assert!(records(&damaged).is_err(), "byte {at}, bit {bit}");
        }
    }
}

#[test]
fn reader_a_trace_cut_short_anywhere_is_refused() {
    let trace = recorded_run();
    for length in 0..trace.len() {
        assert!(records(&trace[..length]).is_err(), "{length} bytes");
    }
}

#[test]
fn reader_damage_is_told_with_block_and_offset() {
    let mut trace = recorded_run();
    trace[60] ^= 1;
    let refused = records(&trace).expect_err("damaged");
    assert_eq!(refused.to_string(), "trace is damaged in block 0 at offset 24: the block's checksum does not match");
    let mut longer = recorded_run();
    longer.push(0);
    let refused = records(&longer).expect_err("too long");
    assert!(refused.to_string().contains("block 1") && refused.to_string().contains("something follows"), "{refused}");
}

#[test]
fn reader_wrong_magic_version_or_enormous_block_is_refused() {
    assert!(matches!(records(b"PNG and more than that"), Err(TraceError::NotATrace { .. })));
    let mut newer = recorded_run();
    newer[8] = 2;
    assert!(matches!(records(&newer), Err(TraceError::UnknownVersion { found: 2 })));
    let mut enormous = recorded_run();
    enormous[24..32].fill(0xFF);
    assert!(records(&enormous).expect_err("too large").to_string().contains("larger than blocks can be"));
}

#[test]
fn recording_full_disk_is_told_at_the_end() {
    let mut disk = [0_u8; 40];
    let mut bus = RecordingBus::new(MockBus::new(MEMORY), &mut disk[..]).expect("the header fits");
    bus.write32(0x4C, 1);
    assert_eq!(bus.read32(0x4C), 1, "the card goes on");
    assert!(matches!(bus.finish(), Err(TraceError::Io { .. })));
}

/// A trace with one block of these bytes, whole as far as checksums tell.
fn trace_of(records: &[u8]) -> Vec<u8> {
    let mut trace =
        TraceWriter::new(Vec::new(), MEMORY).expect("a vector takes all").finish().expect("a vector takes all");
    trace.truncate(format::HEADER_BYTES);
    let payload = lz4_flex::block::compress(records);
    for (number, lengths, payload) in
        [(0, [records.len() as u32, payload.len() as u32], &payload[..]), (1, [0, 0], &[])]
    {
        trace.extend(lengths.iter().flat_map(|length| length.to_le_bytes()));
        trace.extend(format::block_hash(number, lengths, payload).to_le_bytes());
        trace.extend(payload);
    }
    trace
}

#[test]
fn reader_words_beyond_the_block_are_refused() {
    for record in [&[2, 0, 0, 0, 0x40, 0, 0, 1, 0, 9][..], &[6, 255, 255, 255, 255], &[7], &[1, 0]] {
        assert!(matches!(records(&trace_of(record)), Err(TraceError::Damaged { block: 0, offset: 24, .. })));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn replay_random_records_end_without_a_panic(bytes in prop::collection::vec(prop_oneof![0_u8..8, any::<u8>()], 1..200)) {
        let _ = replay(&trace_of(&bytes)[..], &mut MockBus::new(MEMORY), Duration::ZERO);
    }
}
