//! Costs of the variants: numbers worked out by hand, and how they compare.

use super::*;
use crate::hidden::systolic::gates::{Cost, Variant, Widths, clamp, element};

/// 16-bit depths with 12 fraction bits, 1024 elements, 8-bit luminance: about the time of the source.
const SMALL: Widths = Widths { depth: 16, fraction: 12, coordinate: 10, colour: 8 };

#[test]
fn cost_published_element_adds_up_by_hand() {
    let cost = element(Variant::Published(TokenPorts::Swapped, EndTest::Negative), &SMALL);
    let expected = Cost {
        adders: 1,
        adder_bits: 28,
        comparators: 0,
        comparator_bits: 0,
        // A 28, B 28, CTRL 1, IN 1, Zb 16, Ib 8
        register_bits: 82,
        // operand 28 and 16, dX into A 10, kept: A 28, IN 1, Zb 16, Ib 8
        multiplexer_bits: 107,
        // operand 28, all ones 10, Zb set 16, Ib cleared 8, control 8
        logic: 70,
    };
    assert_eq!(cost, expected);
    assert_eq!(cost.gates(), 9 * 28 + 6 * 82 + 4 * 107 + 2 * 70);
}

#[test]
fn cost_super_buffer_element_adds_up_by_hand() {
    let cost = element(Variant::SuperBuffer, &SMALL);
    let expected = Cost {
        adders: 1,
        adder_bits: 28,
        comparators: 3,
        comparator_bits: 10 + 10 + 16,
        // XL 10, XR 10, Z 28, dZ 28, I 8, CTRL 2, back 8 + 1, Zb 16, Ib 8
        register_bits: 119,
        multiplexer_bits: 16 + 8 + 8,
        logic: 28 + 16 + 8 + 3,
    };
    assert_eq!(cost, expected);
}

#[test]
fn cost_zero_test_and_merged_ports_change_coordinates_only() {
    let [negative, zero] = EndTest::ALL else { panic!("two end tests") };
    let cost = |ports, test| element(Variant::Published(ports, test), &SMALL);
    let [swapped, merged] = [TokenPorts::Swapped, TokenPorts::Merged];
    // One bit more of X and dX, and a test that all of them are zero.
    assert_eq!(cost(swapped, *zero).logic, cost(swapped, *negative).logic + 1 + 11);
    assert_eq!(cost(swapped, *zero).register_bits, cost(swapped, *negative).register_bits);
    // Both fit on port A beside each other: the same registers until they do not.
    assert_eq!(cost(merged, *negative).register_bits, cost(swapped, *negative).register_bits);
    let wide = Widths { coordinate: 15, ..SMALL };
    let wide = |ports| element(Variant::Published(ports, EndTest::Negative), &wide);
    assert_eq!(wide(merged).register_bits, wide(swapped).register_bits + 2);
}

#[test]
fn cost_ours_is_published_and_what_it_lists_apart() {
    for ports in [TokenPorts::Swapped, TokenPorts::Merged] {
        for test in [EndTest::Negative, EndTest::Zero] {
            let ours = element(Variant::Ours(ports, test), &SMALL);
            let published = element(Variant::Published(ports, test), &SMALL);
            let clamp = clamp(&SMALL);
            assert_eq!(clamp.register_bits, 32);
            assert_eq!(ours.comparators, clamp.comparators);
            // Two guard bits in A and B, CTRL, the kind of Ib.
            assert_eq!(ours.register_bits, published.register_bits + clamp.register_bits + 2 * 2 + 8 + 1);
            assert!(ours.gates() > published.gates() + clamp.gates());
        }
    }
}

#[test]
fn cost_of_n_elements_is_n_times_one() {
    for variant in Variant::ALL {
        let one = element(variant, &SMALL);
        assert_eq!(one.times(1024).gates(), 1024 * one.gates(), "{}", variant.name());
        assert_eq!(one.plus(&one), one.times(2), "{}", variant.name());
    }
}

#[test]
fn cost_published_element_needs_fewer_gates_than_one_of_the_super_buffer() {
    let published = element(Variant::Published(TokenPorts::Swapped, EndTest::Negative), &SMALL);
    let earlier = element(Variant::SuperBuffer, &SMALL);
    assert!(published.register_bits < earlier.register_bits);
    assert!(published.gates() < earlier.gates());
}
