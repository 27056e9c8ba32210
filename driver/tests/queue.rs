//! Ring, FIFO, fences and recovery on the mock bus.

mod common;

use common::{driver, opcodes, target, triangle};
use zga_abi::bus::{Bus, FIFO_BASE};
use zga_abi::packet::Opcode;
use zga_abi::registers::Reg;
use zga_abi::{Fault, FaultCode};
use zga_driver::bus::{MockAccess, Pace};
use zga_driver::{Alignment, DriverError, FaultSource, Submit};

const RED: [u8; 4] = [255, 0, 0, 255];

#[test]
fn ring_wraps_many_times_and_every_packet_arrives_in_order() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    for number in 0..400 {
        driver.packet(Opcode::NoOperation, &vec![number; 1 + (number as usize * 37) % 300]).expect("sent");
    }
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    // Padding at the end of the ring is a NO_OPERATION too: it repeats words that came before.
    let ours = packets.iter().filter(|packet| packet[0] >> 24 == 0 && packet.len() > 1);
    let mut numbers: Vec<u32> = ours.filter(|p| p[1..].iter().all(|&w| w == p[1])).map(|p| p[1]).collect();
    numbers.dedup();
    let expected: Vec<u32> = (0..400).collect();
    assert!(expected.iter().all(|number| numbers.contains(number)));
    assert_eq!(driver.bus().register(Reg::ErrorCode.offset()), 0);
}

#[test]
fn ring_never_polls_its_get_pointer() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    for _ in 0..100 {
        driver.packet(Opcode::NoOperation, &[0; 500]).expect("sent");
    }
    driver.finish().expect("done");
    let accesses = driver.bus_mut().take_accesses();
    assert!(!accesses.contains(&MockAccess::Read(0x10C)));
}

#[test]
fn fifo_takes_packets_without_a_ring() {
    let mut driver = driver(Submit::Fifo);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [1, 2, 0x10, 3, 0x30]);
    let to_fifo = |access: &MockAccess| matches!(access, MockAccess::WriteBurst(0x8000, _));
    assert_eq!(driver.bus_mut().take_accesses().iter().filter(|access| to_fifo(access)).count(), 1);
    assert_eq!(driver.bus().register(0x0104), 0, "no ring");
}

#[test]
fn packet_longer_than_the_ring_takes_is_refused() {
    let mut driver = driver(Submit::Ring);
    let refused = driver.packet(Opcode::NoOperation, &[0; 4000]).expect_err("too long");
    assert_eq!(refused.to_string(), "NO_OPERATION of 4001 words is too long: at most 1022 words");
}

#[test]
fn wait_card_that_does_not_answer_times_out_with_what_is_pending() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().set_pace(Pace::Never);
    driver.packet(Opcode::NoOperation, &[0; 5]).expect("encoded");
    let fence = driver.fence().expect("sent");
    let text = driver.wait(fence).expect_err("nothing comes").to_string();
    assert!(
        text.contains("fence 1 was not reached") && text.contains("8 words wait, RING_GET 0x0, RING_PUT 0x8"),
        "{text}"
    );
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    driver.wait(fence).expect("it was only late");
}

#[test]
fn fence_nothing_new_is_the_one_before() {
    let mut driver = driver(Submit::Ring);
    let first = driver.fence().expect("nothing to send");
    driver.packet(Opcode::NoOperation, &[]).expect("encoded");
    let second = driver.fence().expect("sent");
    assert_eq!((first.sequence(), second.sequence()), (0, 1));
    assert_eq!(driver.fence().expect("nothing to send"), second);
    driver.wait(first).expect("reached from the start");
}

#[test]
fn free_memory_in_use_comes_back_after_the_fence() {
    let mut driver = driver(Submit::Ring);
    let all = driver.memory().largest_free();
    let run = driver.allocate(all, Alignment::Line).expect("room");
    driver.packet(Opcode::NoOperation, &[]).expect("encoded");
    driver.free(run).expect("own");
    assert_eq!(driver.memory().largest_free(), 0, "the card may still use it");
    let again = driver.allocate(all, Alignment::Line).expect("waits for it");
    assert_eq!(u64::from(again.bytes()), all);
    assert!(matches!(driver.write_memory(&again, u32::MAX, &[0]), Err(DriverError::OutOfAllocation { .. })));
}

#[test]
fn recovery_drops_the_bad_packet_and_runs_the_rest() {
    for (submit, source) in [(Submit::Ring, FaultSource::Ring), (Submit::Fifo, FaultSource::Fifo)] {
        let mut driver = driver(submit);
        let target = target(&mut driver);
        driver.set_tag(7);
        driver.begin_scene(&target).expect("begins");
        driver.draw_triangle(triangle(RED)).expect("draws");
        driver.draw_triangle(triangle([0, 255, 0, 255])).expect("draws");
        driver.set_tag(8);
        driver.draw_triangle(triangle([0, 0, 255, 255])).expect("draws");
        driver.end_scene().expect("ends");
        // Registers, begin, registers, first draw, second draw.
        driver.bus_mut().refuse_packet(4, Fault::new(FaultCode::BadValue, 5, 0x1234));
        let fence = driver.fence().expect("sent");
        let refused = driver.wait(fence).expect_err("the second triangle");
        let DriverError::CardFault(fault) = &refused else { panic!("{refused}") };
        assert_eq!((fault.code, fault.from, fault.word, fault.value), (Some(FaultCode::BadValue), source, 5, 0x1234));
        assert_eq!(
            (fault.packet.as_str(), fault.header, fault.field.as_str()),
            ("DRAW_INLINE", 0x1000_000F, "index words ...")
        );
        driver.wait(fence).expect("the rest was done");
        let packets = driver.bus_mut().take_packets();
        assert_eq!(opcodes(&packets), [1, 2, 1, 0x10, 2, 1, 0x10, 3, 0x30], "scene begun again, bad draw gone");
        assert_eq!((packets[3][7], packets[6][7]), (0xFF00_00FF, 0xFFFF_0000));
        // Restored by the driver: the target; by the packet behind the bad one: the tag.
        assert_eq!((driver.bus().register(0x0200), driver.bus().register(0x028C)), (64 | 48 << 16, 8));
        driver.begin_scene(&target).expect("works on");
        driver.draw_triangle(triangle(RED)).expect("works on");
        driver.end_scene().expect("works on");
        driver.finish().expect("works on");
        assert_eq!(opcodes(&driver.bus_mut().take_packets()), [2, 0x10, 3, 0x30]);
    }
}

#[test]
fn recovery_restores_registers_of_batches_long_done() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.end_scene().expect("ends");
    driver.present(&target).expect("presents");
    driver.finish().expect("done");
    let next = driver.bus().packets_met();
    driver.bus_mut().refuse_packet(next, Fault::new(FaultCode::UnknownOpcode, 0, 0));
    driver.packet(Opcode::NoOperation, &[]).expect("encoded");
    assert!(matches!(driver.finish(), Err(DriverError::CardFault(_))));
    driver.finish().expect("works on");
    assert_eq!(
        [0x200, 0x204, 0x688, 0x694].map(|at| driver.bus().register(at)),
        [64 | 48 << 16, 0x4000, 0x4000, 64 | 48 << 16]
    );
    assert_eq!(driver.bus().register(0x0084), 0b101);
}

#[test]
fn recovery_refused_begin_scene_drops_the_scene_only() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.bus_mut().refuse_packet(1, Fault::new(FaultCode::BadValue, 0, 0x208));
    let fault = driver.finish().expect_err("begin refused");
    assert!(fault.to_string().contains("BAD_VALUE at word 0 (register COLOUR_PITCH)"), "{fault}");
    assert!(matches!(driver.draw_triangle(triangle(RED)), Err(DriverError::OutsideScene { .. })));
    driver.end_scene().expect("ends what is lost");
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    let mut left = opcodes(&driver.bus_mut().take_packets());
    left.retain(|&opcode| opcode != 1);
    assert_eq!(left, [0x30, 2, 0x10, 3, 0x30]);
}

#[test]
fn recovery_two_bad_packets_are_told_one_after_the_other() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().refuse_packet(1, Fault::new(FaultCode::UnknownOpcode, 0, 1));
    driver.bus_mut().refuse_packet(3, Fault::new(FaultCode::UnknownOpcode, 0, 2));
    for number in 0..4 {
        driver.packet(Opcode::NoOperation, &[number]).expect("encoded");
    }
    let fence = driver.fence().expect("sent");
    let values = [(); 2].map(|()| match driver.wait(fence) {
        Err(DriverError::CardFault(fault)) => fault.value,
        other => panic!("{other:?}"),
    });
    driver.wait(fence).expect("the rest was done");
    assert_eq!(values, [1, 2]);
    let packets = driver.bus_mut().take_packets();
    assert_eq!(packets, [[0x0000_0001, 0], [0x0000_0001, 2], [0x3000_0001, 1]]);
}

#[test]
fn recovery_with_a_full_ring_loses_nothing_else() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    driver.bus_mut().refuse_packet(40, Fault::new(FaultCode::BadLength, 0, 0));
    let mut told = 0;
    for number in 0..200 {
        // The packet is encoded even if the call tells of the fault.
        told += u32::from(driver.packet(Opcode::NoOperation, &[number; 101]).is_err());
    }
    told += u32::from(driver.finish().is_err());
    driver.finish().expect("works on");
    assert_eq!(told, 1);
    let packets = driver.bus_mut().take_packets();
    let mut numbers: Vec<u32> = packets.iter().filter(|p| p.len() == 102).map(|p| p[1]).collect();
    numbers.dedup();
    assert_eq!(numbers.len(), 199, "one of 200 was dropped");
    assert!(numbers.is_sorted());
}

#[test]
fn recover_error_of_a_stranger_s_packet_keeps_fences_and_registers() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.finish().expect("done");
    let next = driver.bus().packets_met();
    driver.bus_mut().refuse_packet(next, Fault::new(FaultCode::UnknownOpcode, 0, 0xEE00_0000));
    driver.bus_mut().write32(FIFO_BASE, 0xEE00_0000);
    let fault = driver.recover().expect("an error");
    assert_eq!((fault.from, fault.packet.as_str()), (FaultSource::Fifo, "opcode 0xee"));
    driver.draw_triangle(triangle(RED)).expect("the scene was begun again");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(driver.recover(), None);
}

#[test]
fn flush_after_a_timeout_sends_everything_in_order() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().set_pace(Pace::Never);
    let mut late = 0;
    for number in 0..40 {
        late += u32::from(driver.packet(Opcode::NoOperation, &[number; 200]).is_err());
    }
    assert!(late > 10, "the ring was full {late} times");
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    driver.finish().expect("it was only late");
    let packets = driver.bus_mut().take_packets();
    let numbers: Vec<u32> = packets.iter().filter(|packet| packet.len() == 201).map(|packet| packet[1]).collect();
    assert_eq!(numbers, (0..40).collect::<Vec<u32>>());
}

#[test]
fn wait_fence_line_that_sticks_times_out() {
    let mut driver = driver(Submit::Ring);
    driver.bus_mut().set_pace(Pace::Never);
    driver.packet(Opcode::NoOperation, &[]).expect("encoded");
    let fence = driver.fence().expect("sent");
    driver.bus_mut().set_stuck_lines(1);
    assert!(matches!(driver.wait(fence), Err(DriverError::Timeout { .. })));
}
