//! Case 22: how often planes that nearly coincide are seen in the wrong order. The measuring is
//! [`crate::study::visibility`].

use super::formats;
use crate::hard::Row;
use crate::oracle::DepthFormat;
use crate::study::visibility::of_card;

/// Samples for each depth format.
const SAMPLES: u64 = 2500;
/// Published rates in percent, for F = 0, 8, 16 in turn; 16 and 24 bits.
const PUBLISHED: [[f64; 3]; 2] = [[34.0, 21.0, 5.1], [17.0, 0.12, 0.0]];

/// Case 22.
#[must_use]
pub fn planes_that_cross() -> Row {
    let rates: Vec<(DepthFormat, f64)> =
        formats().map(|format| (format, of_card(format, SAMPLES, 22).rate())).collect();
    let of = |bits: u32, fraction: u32| {
        rates.iter().find(|(f, _)| *f == DepthFormat { bits, fraction }).map_or(f64::NAN, |(_, rate)| *rate)
    };
    // An order of magnitude: a factor of ten either way. Where none or next to none is published, three wrong samples of
    // 2500 are let through.
    let near = |bits: u32, published: &[f64; 3]| {
        let of_order = |(found, published): (f64, f64)| {
            found <= f64::max(10.0 * published, 0.12) && (found >= published / 10.0 || published < 0.2)
        };
        [0, 8, 16].map(|fraction| of(bits, fraction)).into_iter().zip(*published).all(of_order)
    };
    // More bits never make it worse, but for the chance in 2500 samples: three standard deviations.
    let chance = |percent: f64| 300.0 * (percent / 100.0 * (1.0 - percent / 100.0) / SAMPLES as f64).sqrt();
    let no_worse = |worse: f64, better: f64| better <= worse + chance(worse);
    let falling = [16, 24, 31]
        .iter()
        .all(|&bits| [(0, 8), (8, 16), (16, 24)].iter().all(|&(less, more)| no_worse(of(bits, less), of(bits, more))));
    let passed =
        near(16, &PUBLISHED[0]) && near(24, &PUBLISHED[1]) && falling && of(24, 24) == 0.0 && of(31, 24) == 0.0;
    let table: Vec<String> = rates.iter().map(|(f, rate)| format!("Z{} F{} {rate:.2} %", f.bits, f.fraction)).collect();
    Row {
        case: 22,
        name: "depth::planes_that_cross",
        construction: "2500 pairs of triangles a format over one pixel of a 16384 x 8 strip; corners uniform within 8192 px \
                       of it along both axes, depths uniform in the middle 80 % of the range, the second moved so that the depths at the pixel differ by \
                       a uniform +-1e-4 of the range",
        property: "wrong-visibility rate of the order of Z16 34 21 5.1 %, Z24 17 .12 0 % (F = 0, 8, 16), never worse with more bits",
        measured: table.join(", "),
        passed,
    }
}
