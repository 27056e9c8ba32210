//! Flags that several commands share.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use zga_device::Kernel;

use crate::limits::MAX_TARGET_PIXELS_PER_SIDE;
use crate::play::{Asked, Environment, KERNELS, Look};
use crate::scene::{
    ANTIALIAS_EDGES, ANTIALIAS_GRIDS, ANTIALIAS_RESOLVES, CardSettings, END_TESTS, FIDELITIES, Fidelity,
    HIDDEN_SURFACES, HiddenSurface, MOST_SUBPIXEL_POOL, PRESETS, Preset, SUBPIXEL_DEPTHS, SubpixelDepth, SubpixelEdges,
    SubpixelGrid, SubpixelResolve, SystolicSettings, TILE_SIDES, TOKEN_COLOURS, TOKEN_PORTS, ZA_PREDICTIONS,
    ZaPrediction,
};

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
    #[arg(long, alias = "path", value_name = "PATH", value_parser = named(&HIDDEN_SURFACES))]
    pub hidden_surface: Option<HiddenSurface>,
    /// Bits of a pixel that coordinates are snapped to
    #[arg(long, value_name = "N", value_parser = number(["4", "8"]))]
    pub subpixel_bits: Option<u32>,
    #[command(flatten)]
    pub units: UnitFlags,
}

impl CardFlags {
    /// The same as plain values.
    pub(super) fn asked(&self) -> Asked {
        Asked {
            size: self.size,
            threads: self.threads,
            kernel: self.kernel,
            subpixel_bits: self.subpixel_bits,
            card: CardSettings { hidden_surface: self.hidden_surface, ..self.units.settings() },
        }
    }
}

/// Settings of depths and of the units that decide what is hidden.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Card")]
pub(super) struct UnitFlags {
    /// Accuracy by name: anti-aliasing, depths and coordinates; other flags go before it. See zga accuracy presets
    #[arg(long, value_name = "NAME", value_parser = named(&PRESETS))]
    preset: Option<Preset>,
    /// How units with a clocked model are simulated; picture and clocks do not depend on it
    #[arg(long, value_name = "NAME", value_parser = named(&FIDELITIES))]
    fidelity: Option<Fidelity>,
    /// Bits of a depth
    #[arg(long, value_name = "N", value_parser = number(["16", "24", "31"]))]
    depth_bits: Option<u32>,
    /// Fraction bits of a depth gradient
    #[arg(long, value_name = "N", value_parser = number(["0", "8", "16", "24"]))]
    depth_fraction_bits: Option<u32>,
    /// Anti-aliasing: samples of a pixel, columns x rows
    #[arg(long, value_name = "GRID", value_parser = named(&ANTIALIAS_GRIDS))]
    antialias: Option<SubpixelGrid>,
    /// anti-aliasing: how fragments of a pixel that share samples are ordered; exhaustive is supersampling
    #[arg(long, value_name = "MODE", value_parser = named(&SUBPIXEL_DEPTHS))]
    subpixel_depth: Option<SubpixelDepth>,
    /// anti-aliasing: average the frame buffer's values, or linear light
    #[arg(long, value_name = "SPACE", value_parser = named(&ANTIALIAS_RESOLVES))]
    antialias_resolve: Option<SubpixelResolve>,
    /// anti-aliasing: fragments that the lists of a line of pixels have room for; pixels that find none keep one sample
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SUBPIXEL_POOL)))]
    subpixel_pool: Option<u32>,
    /// anti-aliasing: all edges, or those where a surface ends and not those inside it, which is the default unless
    /// subpixel-depth is exhaustive
    #[arg(long, value_name = "EDGES", value_parser = named(&ANTIALIAS_EDGES))]
    antialias_edges: Option<SubpixelEdges>,
    /// za: block of pixels that shares a status word, for example 8x8
    #[arg(long, value_name = "WxH", value_parser = size)]
    za_block: Option<[u32; 2]>,
    /// za: how the least depth of a run in a block is predicted
    #[arg(long, value_name = "NAME", value_parser = named(&ZA_PREDICTIONS))]
    za_prediction: Option<ZaPrediction>,
    /// za: bypass no block
    #[arg(long)]
    no_bypass: bool,
    /// systolic: variant, a list of negative|zero, swapped|merged, tag|value, super-buffer
    #[arg(long, value_name = "LIST", value_parser = systolic_variant)]
    systolic_variant: Option<SystolicSettings>,
    /// tile: size of a tile, each side 4, 8, 16, 32 or 64
    #[arg(long, value_name = "WxH", value_parser = tile_size)]
    tile_size: Option<[u32; 2]>,
}

impl UnitFlags {
    /// The same as card settings.
    pub(super) fn settings(&self) -> CardSettings {
        CardSettings {
            preset: self.preset,
            fidelity: self.fidelity,
            antialias: self.antialias,
            subpixel_depth: self.subpixel_depth,
            antialias_resolve: self.antialias_resolve,
            subpixel_pool: self.subpixel_pool,
            antialias_edges: self.antialias_edges,
            depth_bits: self.depth_bits,
            depth_fraction_bits: self.depth_fraction_bits,
            za_block: self.za_block,
            za_prediction: self.za_prediction,
            za_bypass: self.no_bypass.then_some(false),
            systolic_variant: self.systolic_variant.unwrap_or_default(),
            tile_size: self.tile_size,
            ..CardSettings::default()
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
    /// Light that a mesh is shown in; one with materials of its own in the studio if nothing is asked for, else plain
    #[arg(long, value_name = "NAME", value_parser = named(Environment::NAMED))]
    pub environment: Option<Environment>,
}

impl LookFlags {
    /// The same as a plain value.
    pub(super) fn look(self) -> Look {
        Look { decals: !self.no_decals, wireframe: self.wireframe, ..Look::default() }
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

/// Width and height of a tile, as in 8x8.
fn tile_size(text: &str) -> Result<[u32; 2], String> {
    let sides = size(text)?;
    match sides.iter().find(|side| !TILE_SIDES.contains(side)) {
        Some(side) => Err(format!("{side} is no side of a tile: expected 4, 8, 16, 32 or 64 pixels")),
        None => Ok(sides),
    }
}

/// Names of a systolic variant, as in zero,merged: each stands for one of its settings.
fn systolic_variant(text: &str) -> Result<SystolicSettings, String> {
    fn find<T: Copy>(names: &[(&str, T)], name: &str) -> Option<T> {
        names.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }
    let mut variant = SystolicSettings::default();
    for name in text.split(',') {
        let twice = if let Some(test) = find(&END_TESTS, name) {
            variant.end_test.replace(test).is_some()
        } else if let Some(ports) = find(&TOKEN_PORTS, name) {
            variant.ports.replace(ports).is_some()
        } else if let Some(colour) = find(&TOKEN_COLOURS, name) {
            variant.colour.replace(colour).is_some()
        } else if name == "super-buffer" {
            variant.super_buffer.replace(true).is_some()
        } else {
            let expected = "negative or zero, swapped or merged, tag or value, super-buffer";
            return Err(format!("{name:?} is not known: expected {expected}, with commas between"));
        };
        if twice {
            return Err(format!("{name} says again what was said before"));
        }
    }
    Ok(variant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{EndTest, TokenPorts};

    #[test]
    fn size_good_and_bad_texts() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert!(size("640").is_err_and(|fault| fault.contains("expected WxH")));
        assert!(size("0x480").is_err_and(|fault| fault.starts_with("width is \"0\"")));
        assert!(size("640x16385").is_err_and(|fault| fault.starts_with("height is \"16385\"")));
        assert!(size("640x-1").is_err());
    }

    #[test]
    fn tile_size_good_and_bad_texts() {
        assert_eq!(tile_size("64x4"), Ok([64, 4]));
        assert!(tile_size("8x12").is_err_and(|fault| fault.starts_with("12 is no side of a tile")));
    }

    #[test]
    fn systolic_variant_good_and_bad_texts() {
        let found = systolic_variant("merged,zero,super-buffer").expect("all known");
        assert_eq!((found.end_test, found.ports), (Some(EndTest::Zero), Some(TokenPorts::Merged)));
        assert_eq!((found.colour, found.super_buffer), (None, Some(true)));
        assert!(systolic_variant("zero,negative").is_err_and(|fault| fault.contains("says again")));
        assert!(systolic_variant("zero, merged").is_err_and(|fault| fault.contains("\" merged\" is not known")));
    }
}
