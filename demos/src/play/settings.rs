//! What a scene and the command line ask of the card, and whether it has it.

use zga_abi::Effects;
use zga_abi::format::{self, DepthFormat};
use zga_device::Kernel;
use zga_driver::CardInfo;

use crate::error::{Error, Result};
use crate::scene::{Antialias, CardSettings, Fidelity, HiddenSurface};

/// Pixel kernels by name.
pub const KERNELS: [(&str, Kernel); 6] = [
    ("best", Kernel::Best),
    ("specification", Kernel::Specification),
    ("sse2", Kernel::Sse2),
    ("sse42", Kernel::Sse42),
    ("avx2", Kernel::Avx2),
    ("avx512", Kernel::Avx512),
];

/// What the command line asks for; `None` leaves it to the scene, and then to the card.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Asked {
    /// Pixels of a row, and rows.
    pub size: Option<[u32; 2]>,
    /// Host threads; 0 takes all cores.
    pub threads: usize,
    /// Pixel code.
    pub kernel: Kernel,
    /// Which path decides what is hidden.
    pub hidden_surface: Option<HiddenSurface>,
    /// How the units are simulated.
    pub fidelity: Option<Fidelity>,
    /// Sub-pixels of a pixel.
    pub antialias: Option<Antialias>,
    /// Bits of a depth.
    pub depth_bits: Option<u32>,
    /// Fraction bits of a depth gradient.
    pub depth_fraction_bits: Option<u32>,
    /// Bits of a pixel that coordinates are snapped to.
    pub subpixel_bits: Option<u32>,
}

/// What a card is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Which path decides what is hidden.
    pub hidden_surface: format::HiddenSurface,
    /// How the units are simulated.
    pub fidelity: Fidelity,
    /// Number format of depth.
    pub depth: DepthFormat,
    /// Bits of a pixel that coordinates are snapped to.
    pub subpixel_bits: u32,
}

/// Refuses a kernel that this host cannot run.
///
/// # Errors
/// [`Error::Unsupported`] with those that it can.
pub fn check_kernel(kernel: Kernel) -> Result<()> {
    let available = Kernel::available();
    let name = |wanted: Kernel| KERNELS.iter().find(|(_, kernel)| *kernel == wanted).map_or("", |(name, _)| *name);
    if available.contains(&kernel) {
        return Ok(());
    }
    let names: Vec<&str> = available.into_iter().map(name).collect();
    Err(Error::Unsupported {
        place: "--kernel".to_owned(),
        found: name(kernel).to_owned(),
        has: format!("this processor has {}", names.join(", ")),
    })
}

impl Settings {
    /// The settings of a card `info` for a scene called `name`; the command line goes before the scene.
    ///
    /// # Errors
    /// [`Error::Unsupported`] with the flag or field, and what the card has.
    pub fn resolve(name: &str, scene: &CardSettings, asked: &Asked, info: &CardInfo) -> Result<Self> {
        let place = |by_flag: bool, flag: &str, field: &str| {
            if by_flag { format!("--{flag}") } else { format!("{name}: card.{field}") }
        };
        let hidden = asked.hidden_surface.or(scene.hidden_surface).unwrap_or(HiddenSurface::ZBuffer);
        let hidden_surface = match hidden {
            HiddenSurface::ZBuffer => format::HiddenSurface::ZBuffer,
            HiddenSurface::Za => format::HiddenSurface::Za,
            HiddenSurface::Systolic => format::HiddenSurface::Systolic,
            HiddenSurface::Tile => format::HiddenSurface::Tile,
        };
        if !info.has_path(hidden_surface) {
            let has = format::HiddenSurface::ALL.iter().filter(|path| info.has_path(**path)).map(|path| path.name());
            return Err(Error::Unsupported {
                place: place(asked.hidden_surface.is_some(), "hidden-surface", "hidden_surface"),
                found: hidden.name().to_owned(),
                has: format!("this card has {}", has.collect::<Vec<_>>().join(", ")),
            });
        }
        let fidelity = asked.fidelity.or(scene.fidelity).unwrap_or(Fidelity::Functional);
        if fidelity != Fidelity::Functional {
            return Err(Error::Unsupported {
                place: place(asked.fidelity.is_some(), "fidelity", "fidelity"),
                found: fidelity.name().to_owned(),
                has: "this card has functional; none of its units has a clocked model".to_owned(),
            });
        }
        let antialias = asked.antialias.or(scene.antialias).unwrap_or(Antialias::Off);
        if antialias != Antialias::Off && !info.effects.contains(Effects::ANTI_ALIAS) {
            return Err(Error::Unsupported {
                place: place(asked.antialias.is_some(), "antialias", "antialias"),
                found: antialias.name().to_owned(),
                has: "this card has off; it has no sub-pixel unit".to_owned(),
            });
        }
        let plain = DepthFormat::default();
        let bits = asked.depth_bits.or(scene.depth_bits).unwrap_or(plain.bits());
        let fraction = asked.depth_fraction_bits.or(scene.depth_fraction_bits).unwrap_or(plain.fraction());
        let depth = DepthFormat::new(bits, fraction).ok_or_else(|| Error::Unsupported {
            place: place(asked.depth_bits.is_some() || asked.depth_fraction_bits.is_some(), "depth-bits", "depth_bits"),
            found: format!("{bits} bits with {fraction} fraction bits"),
            has: "this card has 16, 24 or 31 bits with 0, 8, 16 or 24 fraction bits".to_owned(),
        })?;
        let subpixel_bits = asked.subpixel_bits.unwrap_or(8);
        Ok(Self { hidden_surface, fidelity, depth, subpixel_bits })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFO: CardInfo =
        CardInfo { major: 1, minor: 0, effects: Effects::DEPTH, paths: 1, video_memory: 0, za_ram: 0, fifo_words: 0 };

    fn refused(scene: &CardSettings, asked: &Asked) -> String {
        Settings::resolve("a.json", scene, asked, &INFO).expect_err("unsupported").to_string()
    }

    #[test]
    fn resolve_flags_go_before_the_scene() {
        let scene = CardSettings { depth_bits: Some(16), depth_fraction_bits: Some(8), ..CardSettings::default() };
        let asked = Asked { depth_bits: Some(31), subpixel_bits: Some(4), ..Asked::default() };
        let settings = Settings::resolve("a.json", &scene, &asked, &INFO).expect("possible");
        assert_eq!((settings.depth.bits(), settings.depth.fraction(), settings.subpixel_bits), (31, 8, 4));
    }

    #[test]
    fn resolve_what_the_card_has_not_names_flag_or_field() {
        let plain = CardSettings::default();
        let asked = Asked { hidden_surface: Some(HiddenSurface::Systolic), ..Asked::default() };
        assert_eq!(refused(&plain, &asked), "--hidden-surface: systolic is not possible: this card has zbuffer");
        let scene = CardSettings { antialias: Some(Antialias::Grid8x8), ..CardSettings::default() };
        assert!(refused(&scene, &Asked::default()).starts_with("a.json: card.antialias: 8x8 is not possible"));
        let asked = Asked { fidelity: Some(Fidelity::Clocked), ..Asked::default() };
        assert!(refused(&plain, &asked).starts_with("--fidelity: clocked is not possible: this card has functional"));
        let asked = Asked { depth_bits: Some(17), ..Asked::default() };
        assert!(refused(&plain, &asked).starts_with("--depth-bits: 17 bits"));
    }
}
