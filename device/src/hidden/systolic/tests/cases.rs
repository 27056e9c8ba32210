//! The systolic hard cases, 32 to 37.

use super::*;
use crate::geometry::plane::DepthPlane;
use crate::hidden::systolic::feeder::segment;
use zga_firmware::checked::Rectangle;

/// What is seen along a line.
fn seen(pixels: &[Pixel]) -> Vec<Luminance> {
    pixels.iter().map(|pixel| pixel.luminance).collect()
}

fn plane(z: i64, dz: i64) -> DepthPlane {
    DepthPlane { reference: z << 32, dx: dz << 32, minimum: 0, maximum: i32::MAX, ..DepthPlane::default() }
}

const WHOLE: Rectangle = Rectangle { x: 0, y: 0, right: 16, bottom: 1 };

/// Case 32.
#[test]
fn element_enter_and_leave_at_one_element_writes_one_pixel() {
    for setting in VARIANTS {
        for x in [0, 7, 15] {
            let pixels = line(16, &[token(x, 0, 5, 1, 9)], setting);
            let written: Vec<usize> = (0..16).filter(|&x| pixels[x].luminance == Luminance::Tag(9)).collect();
            assert_eq!(written, [x as usize], "{setting:?}");
            assert_eq!(pixels[x as usize].depth, 5, "{setting:?}");
            assert_eq!(pixels.iter().filter(|pixel| pixel.depth == FAR).count(), 15, "{setting:?}");
        }
    }
}

/// Case 32.
#[test]
fn feeder_empty_segment_makes_no_token() {
    for columns in [[4, 4], [5, 4], [-9, 0], [16, 40]] {
        assert_eq!(segment(columns, &WHOLE, 0, &plane(1, 0), DepthTest::LESS, None), None, "{columns:?}");
    }
}

/// Case 33.
#[test]
fn element_back_to_back_tokens_of_equal_depth_first_wins_under_less_last_under_less_equal() {
    for setting in VARIANTS {
        let tokens = [token(2, 9, 100, 3, 1), token(2, 9, 100, 3, 2)];
        let less_equal = tokens.map(|t| Token { test: DepthTest { equal: true, ..DepthTest::LESS }, ..t });
        let [less, less_equal] = [tokens, less_equal].map(|tokens| seen(&line(16, &tokens, setting)));
        assert_eq!(less[2..12], [Luminance::Tag(1); 10], "{setting:?}");
        assert_eq!(less_equal[2..12], [Luminance::Tag(2); 10], "{setting:?}");
    }
}

/// Case 34.
#[test]
fn feeder_segment_beyond_both_ends_begins_at_element_0_with_five_steps_taken() {
    let plane = DepthPlane { anchor: [-5, 0], ..plane(1000, -7) };

    let token = segment([-5, 16 + 5 + 1], &WHOLE, 0, &plane, DepthTest::LESS, Some(Luminance::Tag(1)));

    let token = token.expect("the segment covers the line");
    assert_eq!((token.first, token.more), (0, 15));
    assert_eq!((token.z, token.dz), ((1000 - 5 * 7) << 32, -7 << 32));
    for setting in VARIANTS {
        let depths: Vec<i32> = line(16, &[token], setting).iter().map(|pixel| pixel.depth).collect();
        assert_eq!(depths, (5..21).map(|steps| 1000 - 7 * steps).collect::<Vec<_>>(), "{setting:?}");
    }
}

/// Case 35: the refresh token enters with 0 to W tokens still between it and the far end.
#[test]
fn refresh_any_number_of_tokens_in_flight_none_lost_or_doubled() {
    let width = 16;
    for setting in VARIANTS {
        for count in 0..=width {
            let tokens: Vec<Token> = (0..count).map(|k| token(k, width - 1 - k, i64::from(99 - k), 0, k + 1)).collect();
            let next = [token(0, 15, 50, 0, 77)];
            let mut array = Array::new(width, Rules { setting, below: 32 }, Level::new());
            (0..width as usize).for_each(|element| array.preset(element, FAR));
            let held_back = std::iter::repeat_n(Beat::default(), width as usize);
            let beats = tokens.iter().flat_map(|token| token.beats(&setting)).chain(Beat::REFRESH);
            let beats = beats.chain(next[0].beats(&setting)).chain(held_back).chain(Beat::REFRESH);

            let driven = drive(&mut array, beats, width);

            let (first, second) = driven.split_at(width as usize);
            let pixels = |driven: &[(u64, Pixel)]| driven.iter().map(|(_, pixel)| *pixel).collect::<Vec<_>>();
            assert_eq!(pixels(first), line_by_definition(width, &tokens, 32), "{setting:?}, {count} tokens");
            assert_eq!(pixels(second), line_by_definition(width, &next, 32), "{setting:?}, {count} tokens");
            // One pixel a clock, from the clock in which T3 of the refresh token is at element 0.
            let begun = u64::from(3 * count + 2);
            let clocks: Vec<u64> = first.iter().map(|(clock, _)| *clock).collect();
            assert_eq!(clocks, (begun..begun + u64::from(width)).collect::<Vec<_>>(), "{setting:?}, {count} tokens");
        }
    }
}

/// Case 36.
#[test]
fn element_gradient_at_the_extremes_of_its_register_equals_closed_form() {
    for (z, dz) in [(i64::MAX, i64::MAX), (i64::MIN, i64::MIN), (0, i64::MIN), (-1, i64::MAX), (i64::MAX, 1), (0, -1)] {
        for setting in VARIANTS {
            let always = DepthTest { write: true, ..DepthTest::ALWAYS };
            let token = Token { z, dz, test: always, range: [i32::MIN, i32::MAX], ..token(1, 14, 0, 0, 1) };
            let clocked = line(16, &[token], setting);
            assert_eq!(clocked, line_by_definition(16, &[token], 32), "{z} {dz} {setting:?}");
            let sum = |x: i64| z.wrapping_add((x - 1).wrapping_mul(dz));
            assert_eq!(clocked[15].depth, (sum(15) >> 32) as i32, "{z} {dz} {setting:?}");
        }
    }
}

proptest! {
    /// Case 37.
    #[test]
    fn array_disjoint_segments_in_any_order_make_the_same_line(
        lengths in proptest::collection::vec((0_u32..4, 1_u32..6), 1..12),
        order in any::<proptest::sample::Index>(),
        variant in 0_usize..4,
    ) {
        let mut tokens = Vec::new();
        let mut next = 0;
        for (tag, (gap, length)) in (1..).zip(lengths) {
            tokens.push(token(next + gap, length - 1, i64::from(tag) * 10, 1, tag));
            next += gap + length;
        }
        let expected = line(next, &tokens, VARIANTS[variant]);

        tokens.reverse();
        let shift = order.index(tokens.len());
        tokens.rotate_left(shift);

        prop_assert_eq!(line(next, &tokens, VARIANTS[variant]), expected);
    }
}
