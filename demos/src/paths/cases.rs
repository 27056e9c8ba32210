//! What is run: every path, both fidelities, and on request the variants of each unit.

use zga_abi::format::{EndTest, Fidelity, HiddenSurface, TokenColour, TokenPorts, ZaPrediction};
use zga_driver::{CardInfo, SystolicVariant, ZaSettings};

use crate::play::Settings;

/// Block shapes that are tried.
const BLOCKS: [[u32; 2]; 5] = [[32, 1], [16, 2], [8, 4], [8, 8], [16, 16]];
/// Tile sides that are tried.
const TILES: [u32; 5] = [4, 8, 16, 32, 64];

/// A way to draw the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// What distinguishes it from the path's plain case; empty for that.
    pub variant: String,
    /// The card's settings.
    pub settings: Settings,
}

/// Every path that the card has, with each fidelity it can be simulated in, as `base` sets it up otherwise; the plain
/// Z buffer first. With `variants` those of each unit as well, simulated functionally.
#[must_use]
pub fn cases(base: &Settings, card: &CardInfo, variants: bool) -> Vec<Case> {
    let mut all = Vec::new();
    for path in HiddenSurface::ALL.iter().copied().filter(|path| card.has_path(*path)) {
        let functional = Settings { hidden_surface: path, fidelity: Fidelity::Functional, ..*base };
        all.push(Case { variant: String::new(), settings: functional });
        // The plain Z buffer has one simulation only.
        if path != HiddenSurface::ZBuffer {
            let settings = Settings { fidelity: Fidelity::Clocked, ..functional };
            all.push(Case { variant: String::new(), settings });
        }
        if variants {
            all.extend(of_path(&functional).into_iter().filter(|case| case.settings != functional));
        }
    }
    all
}

/// The variants of the path that `plain` has set.
fn of_path(plain: &Settings) -> Vec<Case> {
    let mut all = Vec::new();
    let mut add = |variant: String, settings: Settings| all.push(Case { variant, settings });
    match plain.hidden_surface {
        HiddenSurface::ZBuffer => {}
        HiddenSurface::Za => {
            for block in BLOCKS {
                let za = ZaSettings { block, ..plain.za };
                add(format!("{}x{} blocks", block[0], block[1]), Settings { za, ..*plain });
            }
            for prediction in ZaPrediction::ALL {
                let za = ZaSettings { prediction: *prediction, ..plain.za };
                add(prediction.name().to_owned(), Settings { za, ..*plain });
            }
            add("no bypass".to_owned(), Settings { za: ZaSettings { bypass: false, ..plain.za }, ..*plain });
        }
        HiddenSurface::Systolic => {
            let variants = [
                ("zero test", SystolicVariant { end_test: EndTest::Zero, ..plain.systolic }),
                ("merged ports", SystolicVariant { ports: TokenPorts::Merged, ..plain.systolic }),
                ("colour values", SystolicVariant { colour: TokenColour::Value, ..plain.systolic }),
                ("Super Buffer", SystolicVariant { super_buffer: true, ..plain.systolic }),
            ];
            for (name, systolic) in variants {
                add(name.to_owned(), Settings { systolic, ..*plain });
            }
        }
        HiddenSurface::Tile => {
            for side in TILES {
                add(format!("{side}x{side} tiles"), Settings { tile_size: [side; 2], ..*plain });
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::tests::{ALL_PATHS, settings};

    #[test]
    fn cases_without_variants_are_each_path_in_each_fidelity() {
        let all = cases(&settings(), &ALL_PATHS, false);
        let names: Vec<_> =
            all.iter().map(|case| (case.settings.hidden_surface.name(), case.settings.fidelity.name())).collect();
        let expected = [
            ("zbuffer", "functional"),
            ("za", "functional"),
            ("za", "clocked"),
            ("systolic", "functional"),
            ("systolic", "clocked"),
            ("tile", "functional"),
            ("tile", "clocked"),
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn cases_of_a_card_with_one_path_are_that_path() {
        let card = CardInfo { paths: 1, ..ALL_PATHS };
        assert_eq!(cases(&settings(), &card, true).len(), 1);
    }

    #[test]
    fn cases_variants_leave_out_what_is_set_already() {
        let all = cases(&settings(), &ALL_PATHS, true);
        let names: Vec<&str> = all.iter().map(|case| case.variant.as_str()).filter(|name| !name.is_empty()).collect();
        assert!(!names.contains(&"32x1 blocks") && !names.contains(&"8x8 tiles"), "{names:?}");
        assert!(names.contains(&"8x8 blocks") && names.contains(&"Super Buffer") && names.contains(&"64x64 tiles"));
        assert_eq!(all.len(), 7 + 4 + 2 + 1 + 4 + 4);
    }
}
