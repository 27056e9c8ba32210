//! The fast models against their specifications: every register after every clock.

use super::*;
use crate::hidden::systolic::super_buffer::{Slot, Specification, SuperBuffer};

/// Something that enters on a clock: a token, a refresh token, or some bubbles.
#[derive(Clone, Debug)]
enum Entry {
    Token(Token),
    Refresh,
    Bubbles(usize),
}

fn entries(width: u32) -> impl Strategy<Value = Vec<Entry>> {
    let entry = prop_oneof![
        6 => tokens(width).prop_map(Entry::Token),
        1 => Just(Entry::Refresh),
        1 => (0_usize..20).prop_map(Entry::Bubbles),
    ];
    proptest::collection::vec(entry, 0..40)
}

/// Beats of `entries`; refresh tokens are held back until the one before has passed all `width` elements.
fn beats(entries: &[Entry], width: u32, setting: &SystolicSetting) -> Vec<Beat> {
    let mut beats: Vec<Beat> = Vec::new();
    let mut free = 0;
    for entry in entries {
        match entry {
            Entry::Token(token) => beats.extend(token.beats(setting)),
            Entry::Bubbles(count) => beats.extend(std::iter::repeat_n(Beat::default(), *count)),
            Entry::Refresh => {
                beats.resize(beats.len().max(free), Beat::default());
                free = beats.len() + width as usize;
                beats.extend(Beat::REFRESH);
            }
        }
    }
    beats
}

fn slots(entries: &[Entry], width: u32) -> Vec<Slot> {
    let mut slots: Vec<Slot> = Vec::new();
    let mut free = 0;
    for entry in entries {
        match entry {
            Entry::Token(token) => slots.push(Slot::from(token)),
            Entry::Bubbles(count) => slots.extend(std::iter::repeat_n(Slot::default(), *count)),
            Entry::Refresh => {
                slots.resize(slots.len().max(free), Slot::default());
                free = slots.len() + 2 * width as usize;
                slots.push(Slot::REFRESH);
            }
        }
    }
    slots
}

proptest! {
    #[test]
    fn array_any_level_equals_elements_register_by_register(
        (width, entries) in (1_u32..70).prop_flat_map(|width| (Just(width), entries(width))),
        variant in 0_usize..4,
        below in prop_oneof![Just(24_u32), Just(32)],
        resets in proptest::collection::vec(any::<i32>(), 1..9),
    ) {
        let setting = VARIANTS[variant];
        for level in levels() {
            let mut specification = elements(width, setting, below);
            let mut array = Array::new(width, Rules { setting, below }, level);
            (0..width as usize).for_each(|element| array.preset(element, FAR));
            let idle = std::iter::repeat_n(Beat::default(), width as usize);
            let beats = beats(&entries, width, &setting).into_iter().chain(idle);
            for ((clock, beat), reset) in beats.enumerate().zip(resets.iter().cycle()) {
                let expected = specification.clock(beat, *reset);
                prop_assert_eq!(array.clock(beat, *reset), expected, "clock {}", clock);
                for (number, element) in specification.elements.iter().enumerate() {
                    prop_assert_eq!(array.element(number), *element, "clock {}, element {}", clock, number);
                }
            }
        }
    }

    #[test]
    fn super_buffer_any_level_equals_specification_register_by_register(
        (width, entries) in (1_u32..70).prop_flat_map(|width| (Just(width), entries(width))),
        below in prop_oneof![Just(24_u32), Just(32)],
        resets in proptest::collection::vec(any::<i32>(), 1..9),
    ) {
        for level in levels() {
            let mut specification = Specification::new(width, below);
            let mut fast = SuperBuffer::new(width, below, level);
            let slots = slots(&entries, width);
            let idle = std::iter::repeat_n(Slot::default(), 2 * width as usize);
            for ((clock, slot), reset) in slots.into_iter().chain(idle).enumerate().zip(resets.iter().cycle()) {
                let expected = specification.clock(slot, *reset);
                prop_assert_eq!(fast.clock(slot, *reset), expected, "clock {}", clock);
                for (number, element) in specification.elements.iter().enumerate() {
                    prop_assert_eq!(fast.element(number), *element, "clock {}, element {}", clock, number);
                }
            }
        }
    }

    #[test]
    fn array_random_line_equals_spans_against_a_line_of_depths(
        (width, tokens) in (1_u32..90).prop_flat_map(|w| (Just(w), proptest::collection::vec(tokens(w), 0..30))),
        variant in 0_usize..4,
    ) {
        prop_assert_eq!(line(width, &tokens, VARIANTS[variant]), line_by_definition(width, &tokens, 32));
    }
}

/// The tape comes to its end and is copied back many times over.
#[test]
fn array_many_lines_equal_elements_pixel_by_pixel() {
    let setting = SystolicSetting::default();
    let (width, lines) = (37, 400);
    let mut specification = elements(width, setting, 32);
    let mut array = Array::new(width, Rules { setting, below: 32 }, Level::new());
    (0..width as usize).for_each(|element| array.preset(element, FAR));
    let line = |y: u32| {
        let tokens = [token(y % 30, y % 7, i64::from(y % 11), 1, 2 * y + 1), token(3, 30, 5, 0, 2 * y + 2)];
        let beats: Vec<Beat> = tokens.iter().flat_map(|token| token.beats(&setting)).collect();
        let held_back = std::iter::repeat_n(Beat::default(), width as usize - 9);
        beats.into_iter().chain(held_back).chain(Beat::REFRESH).collect::<Vec<_>>()
    };
    let beats: Vec<Beat> = (0..lines).flat_map(line).collect();

    let expected = drive(&mut specification, beats.iter().copied(), width);
    let pixels = drive(&mut array, beats, width);

    assert_eq!(pixels.len(), (width * lines) as usize);
    assert_eq!(pixels, expected);
}
