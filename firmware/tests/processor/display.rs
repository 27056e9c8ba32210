//! FENCE, PRESENT, WRITE_BACK.

use crate::bench::Bench;
use crate::mock::{Call, MEMORY};
use zga_abi::FaultCode::{BadAlignment, BadValue, OutOfMemory, Overlap};

/// A screen of 64 x 32 pixels, XRGB8888, shown at 0x1000..0x3000.
fn bench() -> Bench {
    let mut bench = Bench::new();
    bench.card.set(0x0688, 0x1000);
    bench.card.set(0x068C, 256);
    bench.card.set(0x0694, (32 << 16) | 64);
    bench
}

#[test]
fn fence_passes_its_number_on_inside_and_outside_a_scene() {
    assert_eq!(Bench::new().good(0x30, &[7]), [Call::Fence(7)]);
    let last = 0xFFFF_FFFF;
    assert_eq!(Bench::in_scene().good(0x30, &[last]), [Call::Fence(last)]);
}

#[test]
fn present_shows_any_frame_in_memory() {
    assert_eq!(bench().last(0x31, &[0x4000]), Call::Present(0x4000));
    let last = MEMORY - 0x2000;
    assert_eq!(bench().last(0x31, &[last]), Call::Present(last));
}

#[test]
fn present_of_a_bad_base_names_the_word() {
    bench().bad(0x31, &[0x1020], BadAlignment, 1, 0x1020);
    bench().bad(0x31, &[MEMORY - 0x1FC0], OutOfMemory, 1, MEMORY - 0x1FC0);
    bench().bad(0x31, &[0xFFFF_FFC0], OutOfMemory, 1, 0xFFFF_FFC0);
}

#[test]
fn present_on_a_dark_screen_is_legal() {
    for size in [0, 64, 32 << 16] {
        let mut bench = bench();
        bench.card.set(0x0694, size);
        bench.card.set(0x068C, 3);
        assert_eq!(bench.last(0x31, &[0xFFFF_FFC0]), Call::Present(0xFFFF_FFC0));
        bench.bad(0x31, &[4], BadAlignment, 1, 4);
    }
}

#[test]
fn present_and_write_back_with_a_register_at_fault_name_its_offset() {
    let cases = [
        (0x068C, 0x0104, BadAlignment, 0x068C),
        (0x068C, 192, BadValue, 0x068C),
        (0x068C, 0, BadValue, 0x068C),
        (0x0690, 3, BadValue, 0x0690),
        (0x0694, (32 << 16) | 16385, BadValue, 0x0694),
        (0x0694, (16385 << 16) | 64, BadValue, 0x0694),
    ];
    for (register, value, code, at_fault) in cases {
        let mut bench = bench();
        bench.card.set(register, value);
        bench.bad(0x31, &[0x4000], code, 0, at_fault);
        bench.bad(0x32, &[0x4000], code, 0, at_fault);
    }
}

#[test]
fn write_back_goes_anywhere_apart_from_the_frame() {
    for destination in [0x3000, 0x3004, MEMORY - 0x2000] {
        let call = bench().last(0x32, &[destination]);
        assert_eq!(call, Call::WriteBack(destination));
    }
}

#[test]
fn write_back_of_sixteen_bit_pixels_takes_twice_their_bytes() {
    let mut bench = bench();
    bench.card.set(0x0690, 2);
    bench.card.set(0x068C, 128);
    let out = MEMORY - 0x1000;
    bench.bad(0x32, &[out], OutOfMemory, 1, out);
    bench.good(0x32, &[0x2000]);
}

#[test]
fn write_back_to_a_bad_destination_names_the_word() {
    bench().bad(0x32, &[0x4002], BadAlignment, 1, 0x4002);
    bench().bad(0x32, &[MEMORY - 0x1FFC], OutOfMemory, 1, MEMORY - 0x1FFC);
    bench().bad(0x32, &[0xFFFF_FFFC], OutOfMemory, 1, 0xFFFF_FFFC);
}

#[test]
fn write_back_onto_the_frame_shown_is_an_overlap() {
    let mut bench = bench();
    for destination in [0x1000, 0x2FFC] {
        bench.bad(0x32, &[destination], Overlap, 1, destination);
    }
    bench.card.set(0x0688, 0x2000);
    bench.bad(0x32, &[4], Overlap, 1, 4);
    bench.good(0x32, &[0]);
}

#[test]
fn write_back_of_a_frame_outside_memory_names_the_register() {
    let mut bench = bench();
    bench.card.set(0x0688, MEMORY - 64);
    bench.bad(0x32, &[0], OutOfMemory, 0, 0x0688);
    bench.card.set(0x0688, 0x1004);
    bench.bad(0x32, &[0], BadAlignment, 0, 0x0688);
}

#[test]
fn write_back_of_a_dark_screen_does_nothing() {
    let mut bench = bench();
    bench.card.set(0x0694, 0);
    assert_eq!(bench.good(0x32, &[0xFFFF_FFFC]), []);
}
