//! Snapshots of the processor.

use crate::bench::{Bench, TRIANGLE};
use crate::mock::Mock;
use zga_abi::{Fault, FaultCode};
use zga_firmware::{Processor, ProcessorState};

#[test]
fn state_after_power_on_is_all_zero() {
    assert_eq!(Processor::new().state(), ProcessorState::default());
    assert_eq!(Processor::default().state().to_words(), [0; 25]);
}

#[test]
fn state_words_round_trip() {
    let words = std::array::from_fn(|k| 100 + k as u32);
    let state = ProcessorState::from_words(&words);
    assert_eq!(state.to_words(), words);
    assert_eq!((state.in_scene, state.target[8]), (100, 111));
}

#[test]
fn from_state_in_a_scene_goes_on_where_it_was() {
    let mut bench = Bench::in_scene();
    bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
    let state = bench.processor.state();
    let target = bench.processor.target().copied();
    // The registers have changed since begin scene.
    bench.card.set(0x0200, 0);
    let restored = Processor::from_state(&bench.card, &state).expect("a good state");
    assert_eq!(restored.state(), state);
    assert_eq!(restored.target().copied(), target);
    assert_eq!(restored.effects_called(), bench.processor.effects_called());
    assert_eq!(restored.units_powered(), bench.processor.units_powered());
    bench.processor = restored;
    bench.good(0x03, &[]);
}

#[test]
fn from_state_in_a_scene_with_a_grid_has_its_grid() {
    let mut bench = Bench::in_scene_with_grid();
    let state = bench.processor.state();
    assert_eq!(state.to_words()[18..23], [3, 1, 0, 1 << 20, 0]);
    bench.card.set(0x0260, 0);
    let restored = Processor::from_state(&bench.card, &state).expect("a good state");
    assert_eq!(restored.target(), bench.processor.target());
    let mut words = state.to_words();
    words[21] = 0;
    let refused = Processor::from_state(&bench.card, &ProcessorState::from_words(&words)).map(|_| ());
    assert_eq!(refused, Err(Fault::new(FaultCode::BadValue, 0, 0x026C)));
}

#[test]
fn from_state_of_a_scene_that_cannot_be_names_the_register() {
    let state = Bench::in_scene().processor.state();
    let mut small = Mock::new();
    small.set(0x0010, 0x2000);
    let fault = Fault::new(FaultCode::OutOfMemory, 0, 0x0204);
    let result = Processor::from_state(&small, &state).map(|_| ());
    assert_eq!(result, Err(fault));
}

#[test]
fn from_state_of_unknown_bits_names_the_register() {
    let cases = [(0, 2, 0x0044), (1, 0x1000, 0x0700), (2, 0x1000, 0x0704)];
    for (word, value, register) in cases {
        let mut words = [0; ProcessorState::WORDS];
        words[word] = value;
        let state = ProcessorState::from_words(&words);
        let result = Processor::from_state(&Mock::new(), &state).map(|_| ());
        assert_eq!(result, Err(Fault::new(FaultCode::BadValue, 0, register)));
    }
}
