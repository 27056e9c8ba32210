//! A few letters as strokes, for captions drawn with lines.

/// Strokes of a glyph on a grid of 4 x 6, origin at the lower left: polylines.
fn glyph(letter: char) -> &'static [&'static [(u8, u8)]] {
    match letter {
        'A' => &[&[(0, 0), (2, 6), (4, 0)], &[(1, 2), (3, 2)]],
        'C' => &[&[(4, 5), (3, 6), (1, 6), (0, 5), (0, 1), (1, 0), (3, 0), (4, 1)]],
        'D' => &[&[(0, 0), (0, 6), (2, 6), (4, 4), (4, 2), (2, 0), (0, 0)]],
        'E' => &[&[(4, 0), (0, 0), (0, 6), (4, 6)], &[(0, 3), (3, 3)]],
        'G' => &[&[(4, 5), (3, 6), (1, 6), (0, 5), (0, 1), (1, 0), (3, 0), (4, 1), (4, 3), (2, 3)]],
        'I' => &[&[(2, 0), (2, 6)], &[(1, 0), (3, 0)], &[(1, 6), (3, 6)]],
        'L' => &[&[(0, 6), (0, 0), (4, 0)]],
        'N' => &[&[(0, 0), (0, 6), (4, 0), (4, 6)]],
        'P' => &[&[(0, 0), (0, 6), (3, 6), (4, 5), (4, 4), (3, 3), (0, 3)]],
        'S' => &[&[(4, 5), (3, 6), (1, 6), (0, 5), (0, 4), (1, 3), (3, 3), (4, 2), (4, 1), (3, 0), (1, 0), (0, 1)]],
        'Z' => &[&[(0, 6), (4, 6), (0, 0), (4, 0)]],
        '1' => &[&[(1, 5), (2, 6), (2, 0)], &[(1, 0), (3, 0)]],
        '4' => &[&[(3, 0), (3, 6), (0, 2), (4, 2)]],
        '7' => &[&[(0, 6), (4, 6), (1, 0)]],
        '9' => &[&[(4, 3), (1, 3), (0, 4), (0, 5), (1, 6), (3, 6), (4, 5), (4, 1), (3, 0), (0, 0)]],
        '.' => &[&[(2, 0), (2, 1)]],
        '=' => &[&[(0, 2), (4, 2)], &[(0, 4), (4, 4)]],
        _ => &[],
    }
}

/// The strokes of a text, one unit high, from the origin at the lower left to the right.
pub(super) fn strokes(text: &str) -> Vec<Vec<[f64; 2]>> {
    let mut all = Vec::new();
    for (place, letter) in text.chars().enumerate() {
        for stroke in glyph(letter) {
            let point = |(x, y): &(u8, u8)| [(f64::from(*x) + 6.0 * place as f64) / 6.0, f64::from(*y) / 6.0];
            all.push(stroke.iter().map(point).collect());
        }
    }
    all
}

/// Width of a text, in heights.
pub(super) fn width(text: &str) -> f64 {
    (text.chars().count() as f64 - 1.0 / 3.0).max(0.0)
}
