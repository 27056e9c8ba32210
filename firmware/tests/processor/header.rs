//! Headers and lengths.

use crate::bench::{Bench, packet};
use crate::mock::Call;
use zga_abi::{Fault, FaultCode};
use zga_firmware::Processor;

/// Opcode, payload words, whether more are possible.
const LENGTHS: [(u32, u32, bool); 23] = [
    (0x00, 0, true),
    (0x01, 2, true),
    (0x02, 0, false),
    (0x03, 0, false),
    (0x04, 3, false),
    (0x10, 3, true),
    (0x11, 5, false),
    (0x20, 8, false),
    (0x21, 11, false),
    (0x22, 4, true),
    (0x23, 5, false),
    (0x24, 10, false),
    (0x25, 13, false),
    (0x26, 12, false),
    (0x27, 19, false),
    (0x28, 9, true),
    (0x29, 13, true),
    (0x2A, 10, true),
    (0x2B, 11, true),
    (0x2C, 36, true),
    (0x30, 1, false),
    (0x31, 1, false),
    (0x32, 1, false),
];

#[test]
fn packet_length_of_the_least_payload_is_one_more() {
    for (opcode, words, _) in LENGTHS {
        let length = Processor::packet_length((opcode << 24) | words);
        assert_eq!(length, Ok(1 + words), "opcode {opcode:#x}");
    }
}

#[test]
fn packet_length_of_too_few_words_is_a_bad_length() {
    for (opcode, words, _) in LENGTHS.into_iter().filter(|&(_, words, _)| words > 0) {
        let header = (opcode << 24) | (words - 1);
        let fault = Fault::new(FaultCode::BadLength, 0, header);
        assert_eq!(Processor::packet_length(header), Err(fault));
    }
}

#[test]
fn packet_length_of_too_many_words_is_a_bad_length_where_the_length_is_fixed() {
    for (opcode, words, _) in LENGTHS.into_iter().filter(|&(_, _, open)| !open) {
        let header = (opcode << 24) | (words + 1);
        let fault = Fault::new(FaultCode::BadLength, 0, header);
        assert_eq!(Processor::packet_length(header), Err(fault));
    }
}

#[test]
fn packet_length_of_the_longest_packet_is_two_to_the_twenty() {
    for (opcode, _, _) in LENGTHS.into_iter().filter(|&(_, _, open)| open) {
        let length = Processor::packet_length((opcode << 24) | 0x000F_FFFF);
        assert_eq!(length, Ok(1 << 20), "opcode {opcode:#x}");
    }
}

#[test]
fn packet_length_of_any_other_opcode_is_unknown() {
    let known = LENGTHS.map(|(opcode, _, _)| opcode);
    for opcode in (0..=0xFF).filter(|opcode| !known.contains(opcode)) {
        let header = opcode << 24;
        let fault = Fault::new(FaultCode::UnknownOpcode, 0, header);
        assert_eq!(Processor::packet_length(header), Err(fault));
    }
}

#[test]
fn packet_length_with_a_reserved_bit_is_refused() {
    for bit in 20..24 {
        let header = 0x3000_0001 | (1 << bit);
        let fault = Fault::new(FaultCode::ReservedBits, 0, header);
        assert_eq!(Processor::packet_length(header), Err(fault));
    }
}

#[test]
fn execute_unknown_opcode_faults_after_the_packet_was_taken() {
    Bench::new().bad(0x7F, &[1], FaultCode::UnknownOpcode, 0, 0x7F00_0001);
}

#[test]
fn execute_reserved_bits_faults() {
    let (result, calls) = Bench::new().run(&[0x0010_0000]);
    let fault = Fault::new(FaultCode::ReservedBits, 0, 0x0010_0000);
    assert_eq!((result, calls), (Err(fault), vec![]));
}

#[test]
fn execute_slice_of_another_length_than_the_header_says_is_a_bad_length() {
    for packet in [&[0x3000_0001][..], &[0x3000_0001, 1, 2], &[0x0000_0001], &[0x0000_0000, 1]] {
        let (result, calls) = Bench::new().run(packet);
        let fault = Fault::new(FaultCode::BadLength, 0, packet[0]);
        assert_eq!((result, calls), (Err(fault), vec![]));
    }
}

#[test]
fn execute_empty_slice_is_a_bad_length() {
    let (result, calls) = Bench::new().run(&[]);
    let fault = Fault::new(FaultCode::BadLength, 0, 0);
    assert_eq!((result, calls), (Err(fault), vec![]));
}

#[test]
fn no_operation_of_any_length_does_nothing() {
    let mut bench = Bench::new();
    assert_eq!(bench.good(0x00, &[]), []);
    assert_eq!(bench.good(0x00, &[0xFFFF_FFFF; 100]), []);
}

#[test]
fn packet_taken_is_told_the_header_too() {
    let mut bench = Bench::new();
    let packet = packet(0x00, &[0; 7]);
    bench.processor.execute(&mut bench.card, &packet).expect("a good packet");
    assert_eq!(bench.card.calls, [Call::PacketTaken(8)]);
}
