//! What a scene may ask of the card. Every setting is optional: what is absent stays as the card has it.

pub use zga_driver::Preset;

pub use zga_abi::format::{
    EndTest, Fidelity, HiddenSurface, SubpixelDepth, SubpixelEdges, SubpixelGrid, SubpixelResolve, TokenColour,
    TokenPorts, ZaPrediction,
};

/// Declares an enumeration whose values have names in scene files and on the command line.
macro_rules! named_values {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $text:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$variant_doc])* $variant,)+ }

        impl $name {
            /// Every value with its name.
            pub const NAMED: &'static [(&'static str, Self)] = &[$(($text, Self::$variant),)+];

            /// The value's name in scene files.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text,)+ }
            }
        }
    };
}
pub(super) use named_values;

/// The values of an enumeration of the register map with their names in scene files and on the command line.
macro_rules! names_of {
    ($type:ident) => {{
        let mut names = [("", $type::ALL[0]); $type::ALL.len()];
        let mut at = 0;
        while at < names.len() {
            names[at] = ($type::ALL[at].name(), $type::ALL[at]);
            at += 1;
        }
        names
    }};
}
pub(super) use names_of;

/// Paths that decide what is hidden, by name.
pub const HIDDEN_SURFACES: [(&str, HiddenSurface); HiddenSurface::ALL.len()] = names_of!(HiddenSurface);
/// Ways to simulate units with a clocked model, by name.
pub const FIDELITIES: [(&str, Fidelity); Fidelity::ALL.len()] = names_of!(Fidelity);
/// Ways to predict the least depth of a run in a block, by name.
pub const ZA_PREDICTIONS: [(&str, ZaPrediction); ZaPrediction::ALL.len()] = names_of!(ZaPrediction);
/// End tests of the systolic array, by name.
pub const END_TESTS: [(&str, EndTest); EndTest::ALL.len()] = names_of!(EndTest);
/// Ways into the systolic array, by name.
pub const TOKEN_PORTS: [(&str, TokenPorts); TokenPorts::ALL.len()] = names_of!(TokenPorts);
/// What tokens of the systolic array carry, by name.
pub const TOKEN_COLOURS: [(&str, TokenColour); TokenColour::ALL.len()] = names_of!(TokenColour);
/// Grids of samples, by name.
pub const ANTIALIAS_GRIDS: [(&str, SubpixelGrid); SubpixelGrid::ALL.len()] = names_of!(SubpixelGrid);
/// Ways to order fragments that share samples, by name.
pub const SUBPIXEL_DEPTHS: [(&str, SubpixelDepth); SubpixelDepth::ALL.len()] = names_of!(SubpixelDepth);
/// Spaces in which samples are averaged, by name.
pub const ANTIALIAS_RESOLVES: [(&str, SubpixelResolve); SubpixelResolve::ALL.len()] = names_of!(SubpixelResolve);
/// Edges that are anti-aliased, by name.
pub const ANTIALIAS_EDGES: [(&str, SubpixelEdges); SubpixelEdges::ALL.len()] = names_of!(SubpixelEdges);
/// Most fragments that the lists of one line of pixels can have room for.
pub const MOST_SUBPIXEL_POOL: u32 = 1 << 20;
/// Sides that a tile of the tile unit can have, in pixels.
pub const TILE_SIDES: [u32; 5] = [4, 8, 16, 32, 64];

/// Presets of accuracy, by name.
pub const PRESETS: [(&str, Preset); Preset::ALL.len()] = names_of!(Preset);

/// Settings of the card; `None` leaves the card's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CardSettings {
    /// Settings of accuracy that belong together; those that are named beside it go before it.
    pub preset: Option<Preset>,
    /// Which path decides what is hidden.
    pub hidden_surface: Option<HiddenSurface>,
    /// How the units with a clocked model are simulated.
    pub fidelity: Option<Fidelity>,
    /// Samples of a pixel.
    pub antialias: Option<SubpixelGrid>,
    /// How fragments that share samples are ordered.
    pub subpixel_depth: Option<SubpixelDepth>,
    /// Space in which samples are averaged.
    pub antialias_resolve: Option<SubpixelResolve>,
    /// Fragments that the lists of one line of pixels have room for, 1..=[`MOST_SUBPIXEL_POOL`].
    pub subpixel_pool: Option<u32>,
    /// Which edges are anti-aliased.
    pub antialias_edges: Option<SubpixelEdges>,
    /// Width and height of a Za block, in pixels, each 1..=16384.
    pub za_block: Option<[u32; 2]>,
    /// How the least depth of a run is predicted.
    pub za_prediction: Option<ZaPrediction>,
    /// Blocks behind the prediction are bypassed.
    pub za_bypass: Option<bool>,
    /// Variant of the systolic array.
    pub systolic_variant: SystolicSettings,
    /// Width and height of a tile, in pixels, each one of [`TILE_SIDES`].
    pub tile_size: Option<[u32; 2]>,
    /// Bits of a depth: 16, 24 or 31.
    pub depth_bits: Option<u32>,
    /// Fraction bits of a depth gradient: 0, 8, 16 or 24.
    pub depth_fraction_bits: Option<u32>,
}

/// Variant of the systolic array; `None` leaves the card's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SystolicSettings {
    /// When an element sees that a segment has begun or ended.
    pub end_test: Option<EndTest>,
    /// How X and dX of a segment enter.
    pub ports: Option<TokenPorts>,
    /// What a token carries for the picture.
    pub colour: Option<TokenColour>,
    /// The earlier design in place of the array.
    pub super_buffer: Option<bool>,
}

impl CardSettings {
    /// What the preset stands for is filled in where nothing else is asked for.
    #[must_use]
    pub fn filled(self) -> Self {
        let Some(preset) = self.preset else { return self };
        let (antialias, depth) = (preset.antialias(), preset.depth());
        Self {
            antialias: self.antialias.or(Some(antialias.grid)),
            subpixel_depth: self.subpixel_depth.or(Some(antialias.depth)),
            antialias_edges: self.antialias_edges.or(Some(antialias.edges)),
            depth_bits: self.depth_bits.or(Some(depth.bits())),
            depth_fraction_bits: self.depth_fraction_bits.or(Some(depth.fraction())),
            ..self
        }
    }

    /// These settings, presets filled in; what they leave open is as in `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        let (this, other) = (self.filled(), other.filled());
        this.before(other)
    }

    fn before(self, other: Self) -> Self {
        let (systolic, others) = (self.systolic_variant, other.systolic_variant);
        Self {
            preset: self.preset.or(other.preset),
            hidden_surface: self.hidden_surface.or(other.hidden_surface),
            fidelity: self.fidelity.or(other.fidelity),
            antialias: self.antialias.or(other.antialias),
            subpixel_depth: self.subpixel_depth.or(other.subpixel_depth),
            antialias_resolve: self.antialias_resolve.or(other.antialias_resolve),
            subpixel_pool: self.subpixel_pool.or(other.subpixel_pool),
            antialias_edges: self.antialias_edges.or(other.antialias_edges),
            za_block: self.za_block.or(other.za_block),
            za_prediction: self.za_prediction.or(other.za_prediction),
            za_bypass: self.za_bypass.or(other.za_bypass),
            systolic_variant: SystolicSettings {
                end_test: systolic.end_test.or(others.end_test),
                ports: systolic.ports.or(others.ports),
                colour: systolic.colour.or(others.colour),
                super_buffer: systolic.super_buffer.or(others.super_buffer),
            },
            tile_size: self.tile_size.or(other.tile_size),
            depth_bits: self.depth_bits.or(other.depth_bits),
            depth_fraction_bits: self.depth_fraction_bits.or(other.depth_fraction_bits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn or_presets_fill_in_and_what_is_named_goes_before_them() {
        let plain = CardSettings::default();
        let scene = CardSettings { preset: Some(Preset::Exact), antialias: Some(SubpixelGrid::Grid8x4), ..plain };
        let own = plain.or(scene);
        assert_eq!((own.antialias, own.depth_bits), (Some(SubpixelGrid::Grid8x4), Some(31)));
        // A preset of the command line goes before all that the scene says of accuracy.
        let asked = CardSettings { preset: Some(Preset::Draft), depth_bits: Some(16), ..plain };
        let both = asked.or(scene);
        assert_eq!(
            (both.antialias, both.depth_bits, both.depth_fraction_bits),
            (Some(SubpixelGrid::Off), Some(16), Some(24))
        );
        assert_eq!(both.preset, Some(Preset::Draft));
        let borders = CardSettings { antialias_edges: Some(SubpixelEdges::Borders), ..plain };
        let edges = |settings: CardSettings| settings.antialias_edges;
        assert_eq!(
            [borders.or(scene), scene.or(borders), plain].map(edges),
            [Some(SubpixelEdges::Borders), Some(SubpixelEdges::All), None]
        );
    }
}
