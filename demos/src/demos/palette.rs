//! The colours of the demonstrations.

use crate::scene::Colour;

/// Behind everything: a night blue, dark enough for light lines and light enough to show black ones.
pub(super) const NIGHT: Colour = [19, 23, 36, 255];
/// A little lighter, for floors and quiet surfaces.
pub(super) const DUSK: Colour = [52, 60, 84, 255];
/// Quiet lines.
pub(super) const MIST: Colour = [112, 122, 150, 255];
/// Glazed porcelain.
pub(super) const PORCELAIN: Colour = [244, 238, 226, 255];
/// Cobalt, as porcelain is painted with.
pub(super) const COBALT: Colour = [28, 62, 150, 255];
/// Coral red.
pub(super) const CORAL: Colour = [236, 98, 84, 255];
/// Warm yellow.
pub(super) const AMBER: Colour = [246, 186, 76, 255];
/// Blue green.
pub(super) const TEAL: Colour = [44, 166, 164, 255];
/// Light blue.
pub(super) const SKY: Colour = [120, 182, 240, 255];

/// A colour between two; `t` in 0..=1.
pub(super) fn mix(from: Colour, to: Colour, t: f64) -> Colour {
    let t = t.clamp(0.0, 1.0);
    std::array::from_fn(|channel| {
        (f64::from(from[channel]) + (f64::from(to[channel]) - f64::from(from[channel])) * t).round() as u8
    })
}

/// A hue, all equally light to the eye; `t` counts whole turns. Oklch of B. Ottosson (2020) at lightness and
/// chroma where every hue can be shown.
pub(super) fn hue(t: f64) -> Colour {
    oklch(0.76, 0.125, t)
}

/// A colour of lightness 0..=1, chroma 0..about 0.3 and hue in turns; what cannot be shown is cut off.
pub(super) fn oklch(lightness: f64, chroma: f64, turns: f64) -> Colour {
    let (sine, cosine) = (turns * std::f64::consts::TAU).sin_cos();
    let (a, b) = (chroma * cosine, chroma * sine);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    let encode = |value: f64| {
        let value = value.clamp(0.0, 1.0);
        let shown = if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
        (shown * 255.0).round() as u8
    };
    let [r, g, b] = linear.map(encode);
    [r, g, b, 255]
}
