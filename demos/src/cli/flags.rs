//! Flags that several commands share.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use zga_device::Kernel;

use crate::limits::MAX_TARGET_PIXELS_PER_SIDE;
use crate::play::{Asked, KERNELS, Look};
use crate::scene::{Antialias, Fidelity, HiddenSurface};

/// What is asked of the card.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Card")]
pub(super) struct CardFlags {
    /// Size of the picture in pixels, for example 640x480
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// Host threads that draw; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Pixel code; the picture does not depend on it
    #[arg(long, value_name = "NAME", default_value = "best", value_parser = named(&KERNELS))]
    pub kernel: Kernel,
    /// Path that decides what is hidden
    #[arg(long, value_name = "PATH", value_parser = named(HiddenSurface::NAMED))]
    pub hidden_surface: Option<HiddenSurface>,
    /// How the units are simulated
    #[arg(long, value_name = "NAME", value_parser = named(Fidelity::NAMED))]
    pub fidelity: Option<Fidelity>,
    /// Sub-pixels of a pixel
    #[arg(long, value_name = "GRID", value_parser = named(Antialias::NAMED))]
    pub antialias: Option<Antialias>,
    /// Bits of a depth
    #[arg(long, value_name = "N", value_parser = number(["16", "24", "31"]))]
    pub depth_bits: Option<u32>,
    /// Fraction bits of a depth gradient
    #[arg(long, value_name = "N", value_parser = number(["0", "8", "16", "24"]))]
    pub depth_fraction_bits: Option<u32>,
    /// Bits of a pixel that coordinates are snapped to
    #[arg(long, value_name = "N", value_parser = number(["4", "8"]))]
    pub subpixel_bits: Option<u32>,
}

impl CardFlags {
    /// The same as plain values.
    pub(super) fn asked(&self) -> Asked {
        Asked {
            size: self.size,
            threads: self.threads,
            kernel: self.kernel,
            hidden_surface: self.hidden_surface,
            fidelity: self.fidelity,
            antialias: self.antialias,
            depth_bits: self.depth_bits,
            depth_fraction_bits: self.depth_fraction_bits,
            subpixel_bits: self.subpixel_bits,
        }
    }
}

/// How the scene is looked at.
#[derive(Args, Clone, Copy, Debug, Default)]
#[command(next_help_heading = "Look")]
pub(super) struct LookFlags {
    /// Draw surface markings without the decal transform
    #[arg(long)]
    no_decals: bool,
    /// Draw triangles as their edges, with hidden ones removed
    #[arg(long)]
    wireframe: bool,
}

impl LookFlags {
    /// The same as a plain value.
    pub(super) fn look(self) -> Look {
        Look { decals: !self.no_decals, wireframe: self.wireframe }
    }
}

/// A parser for a value that has a name.
pub(super) fn named<T>(values: &'static [(&'static str, T)]) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    PossibleValuesParser::new(values.iter().map(|(name, _)| *name)).try_map(|text| {
        let found = values.iter().find(|(name, _)| *name == text);
        found.map(|(_, value)| *value).ok_or_else(|| format!("{text} is not a value"))
    })
}

/// A parser for one of a few numbers.
fn number<const N: usize>(values: [&'static str; N]) -> impl TypedValueParser<Value = u32> {
    PossibleValuesParser::new(values).try_map(|text| text.parse::<u32>())
}

/// Width and height, as in 640x480.
pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once('x').ok_or("expected WxH, for example 640x480")?;
    let side = |name: &str, text: &str| match text.parse::<u32>() {
        Ok(pixels @ 1..=MAX_TARGET_PIXELS_PER_SIDE) => Ok(pixels),
        _ => Err(format!("{name} is {text:?}, expected 1 to {MAX_TARGET_PIXELS_PER_SIDE} pixels")),
    };
    Ok([side("width", width)?, side("height", height)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn size_good_and_bad_texts() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert!(size("640").is_err_and(|fault| fault.contains("expected WxH")));
        assert!(size("0x480").is_err_and(|fault| fault.starts_with("width is \"0\"")));
        assert!(size("640x16385").is_err_and(|fault| fault.starts_with("height is \"16385\"")));
        assert!(size("640x-1").is_err());
    }
}
