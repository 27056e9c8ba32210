//! What a scene may ask of the card. Every setting is optional: what is absent stays as the card has it.

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

named_values! {
    /// Which path decides what is hidden.
    HiddenSurface {
        /// A plain Z buffer.
        ZBuffer = "zbuffer",
        /// Z buffer with block status words.
        Za = "za",
        /// Systolic scan-line array.
        Systolic = "systolic",
        /// Sorted tiles.
        Tile = "tile",
    }
}

named_values! {
    /// How the units with a clocked model are simulated.
    Fidelity {
        /// The host's fastest way to the same pixels and clock counts.
        Functional = "functional",
        /// Register by register.
        Clocked = "clocked",
    }
}

named_values! {
    /// Sub-pixels of a pixel.
    Antialias {
        /// One sample at the pixel centre.
        Off = "off",
        /// 16 sub-pixels.
        Grid4x4 = "4x4",
        /// 32 sub-pixels.
        Grid8x4 = "8x4",
        /// 64 sub-pixels.
        Grid8x8 = "8x8",
    }
}

named_values! {
    /// Where the depth of a partly covering fragment is taken.
    SubpixelDepth {
        /// At the pixel centre.
        Centre = "centre",
        /// At the sub-pixels that the mask search finds.
        Search = "search",
        /// At every covered sub-pixel.
        Exhaustive = "exhaustive",
    }
}

named_values! {
    /// How the least depth of a run in a block is predicted.
    ZaPrediction {
        /// From the whole block length.
        BlockLength = "block-length",
        /// From the covered pixels.
        CoveredRun = "covered-run",
        /// The primitive's exact least depth in the block.
        Plane = "plane",
    }
}

/// Settings of the card; `None` leaves the card's own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CardSettings {
    /// Which path decides what is hidden.
    pub hidden_surface: Option<HiddenSurface>,
    /// How the units are simulated.
    pub fidelity: Option<Fidelity>,
    /// Sub-pixels of a pixel.
    pub antialias: Option<Antialias>,
    /// Where a fragment's depth is taken.
    pub subpixel_depth: Option<SubpixelDepth>,
    /// Width and height of a Za block, in pixels, each 1..=1024.
    pub za_block: Option<[u32; 2]>,
    /// How the least depth of a run is predicted.
    pub za_prediction: Option<ZaPrediction>,
    /// Bits of a depth: 16, 24 or 31.
    pub depth_bits: Option<u32>,
    /// Fraction bits of a depth gradient: 0, 8, 16 or 24.
    pub depth_fraction_bits: Option<u32>,
}
