//! Case 56: alphas at the reference of punch-through.

use super::{sheet, ways};
use crate::hard::{Row, Tally};
use crate::harness::{Look, Sampler, Stage, State};
use crate::oracle::effects::texel::Filter;

/// Case 56.
#[must_use]
pub fn holes_at_the_reference() -> Row {
    let (mut tally, mut holes) = (Tally::default(), 0);
    for options in ways() {
        for reference in [0_u8, 1, 128, 254, 255] {
            // A column for each alpha of interest.
            let near = [reference.saturating_sub(1), reference, reference.saturating_add(1)];
            let alphas = [0, near[0], near[1], near[2], 254, 255, 1, 127];
            let words = alphas.map(|alpha| u32::from(alpha) << 24 | 0x0060_4020);
            for filter in [Filter::Nearest, Filter::Bilinear] {
                let sampler = Sampler { size: [8, 1], filter, function: 0, ..Sampler::default() };
                let mut stage = Stage::new([8, 5], &options, &words);
                stage.triangles(&sheet([8, 5], 0.75, 0xFF00_0011), &State::default());
                stage.screen.clear_counts();
                // In front: a pixel for each texel, centre on centre, where every filter reads that texel alone.
                let look = Look { punch_through: Some(reference), ..Look::textured(sampler) };
                stage.triangles(&sheet([8, 5], 0.5, u32::MAX), &State::looking(look));
                // Behind it, but before what is seen through the holes.
                stage.triangles(&sheet([8, 5], 0.625, 0xFF22_0000), &State::default());
                let (picture, found, _) = stage.end();
                tally.compared(&found, || format!("{:?}, {filter:?}, reference {reference}", options.hidden));
                for (k, &pixel) in picture.colour.iter().enumerate() {
                    let hole = alphas[k % 8] < reference;
                    let right = if hole { 0xFF00_0022 } else { u32::from(alphas[k % 8]) << 24 | 0x0020_4060 };
                    holes += usize::from(hole);
                    tally.expect(pixel == right, || {
                        format!(
                            "{:?}, {filter:?}: alpha {} at reference {reference}: {pixel:08x}",
                            options.hidden,
                            alphas[k % 8]
                        )
                    });
                }
            }
        }
    }
    Row {
        case: 56,
        name: "texture::holes_at_the_reference",
        construction: "texels with alphas 0, 1, 127, 254, 255, and the reference and one beside it, references 0, 1, 128, 254, 255, \
                       between two sheets; nearest and bilinear at texel centres; every path and tile size, both fidelities, two \
                       kernels",
        property: "a hole exactly where the alpha is below the reference; what is behind shows, its depth counts",
        measured: format!("{tally}; {holes} pixels of holes"),
        passed: tally.wrong == 0 && holes > 0,
    }
}
