//! Clocks of a scene without stepping it.
//!
//! The array. A token takes 3 clocks to enter, a refresh token as well. Let K be the tokens of a line, N the
//! elements. The refresh token of line 0 begins to enter after 3 K clocks, that of line y
//! max(3 K + 3, N) clocks after the one before: the tokens in between need 3 K + 3, and the bus, on which a
//! refresh token's pixels stand for N clocks from its beat T3 on, is free again after N. In steady state that
//! is the period of a line. The last refresh token's T3 is at element 0 two clocks after it began to enter and
//! at element N - 1 another N - 1 clocks later, in the clock that puts the last pixel out. So a scene whose
//! last refresh token begins to enter in clock r (from 0) takes r + N + 2 clocks.
//!
//! The Super Buffer: K clocks for the tokens, then 2 N until the last pixel is out, line after line.
//!
//! Both are what the clocked models show; tests compare them.

use zga_firmware::checked::SystolicSetting;

/// Clocks that a token takes to enter the array.
pub const TOKEN: u64 = 3;

/// Clocks from the first token to the last pixel, for lines of `tokens` tokens on `width` elements.
#[must_use]
pub fn closed_form(tokens: &[u32], width: u32, setting: &SystolicSetting) -> u64 {
    let width = u64::from(width);
    let lines = tokens.iter().map(|&count| u64::from(count));
    if setting.super_buffer {
        return lines.map(|count| count + 2 * width).sum();
    }
    let mut last_refresh = None;
    for count in lines {
        last_refresh = Some(match last_refresh {
            None => TOKEN * count,
            Some(before) => before + (TOKEN * count + TOKEN).max(width),
        });
    }
    last_refresh.map_or(0, |refresh| refresh + width + TOKEN - 1)
}
