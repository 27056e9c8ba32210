//! Clocks: the clocked models against the closed form.

use super::scenes::{clocked, target};
use super::*;
use crate::hidden::held::{Held, Item};
use crate::hidden::systolic::closed_form;
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::{Rectangle, Target};

/// A scene with as many tokens on its lines as `tokens` says: clears of one pixel.
fn scene(tokens: &[u32], width: u32, super_buffer: bool) -> (Held, Target) {
    let target = target(width, tokens.len() as u32, DepthFormat::default(), PixelFormat::Xrgb8888, false);
    let setting = SystolicSetting { super_buffer, ..SystolicSetting::default() };
    let clear = |y: u32| {
        let area = Rectangle { x: 0, y, right: 1, bottom: y + 1 };
        Item::Clear { area, colour: Some(0), depth: None, stencil: None }
    };
    let lines = (0..).zip(tokens).flat_map(|(y, &count)| std::iter::repeat_n(clear(y), count as usize));
    (Held { items: lines.collect(), ..Held::default() }, Target { systolic: setting, ..target })
}

/// Clocks of the clocked model, and by closed form.
fn clocks(tokens: &[u32], width: u32, super_buffer: bool) -> (u64, u64) {
    let (held, target) = scene(tokens, width, super_buffer);
    let counts = clocked(&held, &target, Some(Level::new())).counts;
    assert_eq!(counts.tokens, tokens.iter().map(|&count| u64::from(count)).sum::<u64>());
    (counts.clocks, closed_form(tokens, width, &target.systolic))
}

#[test]
fn closed_form_one_line_of_any_length_equals_the_clocked_models() {
    for width in [1, 2, 3, 4, 7, 16, 17, 64] {
        for count in 0..70 {
            for super_buffer in [false, true] {
                let (clocked, closed_form) = clocks(&[count], width, super_buffer);
                assert_eq!(clocked, closed_form, "{count} tokens on {width} elements, Super Buffer {super_buffer}");
            }
        }
    }
}

#[test]
fn closed_form_known_lines_has_known_clocks() {
    let array = SystolicSetting::default();
    let super_buffer = SystolicSetting { super_buffer: true, ..array };
    // Two tokens, then the refresh token; the last pixel in clock 6 + 2 + 7.
    assert_eq!(closed_form(&[2], 8, &array), 16);
    // The second refresh token waits for the bus, the third enters as soon as it is there.
    assert_eq!(closed_form(&[2, 0, 100], 8, &array), 6 + 8 + 303 + 8 + 2);
    assert_eq!(closed_form(&[0; 768], 1024, &array), 768 * 1024 + 2);
    assert_eq!(closed_form(&[2, 0, 100], 8, &super_buffer), 102 + 3 * 16);
    assert_eq!(closed_form(&[], 8, &array), 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn closed_form_lines_back_to_back_equals_the_clocked_models(
        width in prop_oneof![1_u32..300, Just(1024), 1_u32..=4096, Just(4096)],
        lines in proptest::collection::vec(prop_oneof![Just(0_f64), 0.0_f64..1.0, 0.0_f64..0.1], 1..6),
        super_buffer in any::<bool>(),
    ) {
        // From empty lines to those that take longer to enter than to pass the array.
        let tokens: Vec<u32> = lines.iter().map(|share| (share * f64::from(width / 2 + 20)) as u32).collect();
        let (clocked, closed_form) = clocks(&tokens, width, super_buffer);
        prop_assert_eq!(clocked, closed_form, "{:?}", tokens);
    }
}
