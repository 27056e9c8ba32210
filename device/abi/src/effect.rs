//! Effects a draw can call for, and units of the card the firmware can power.

use bitflags::bitflags;

bitflags! {
    /// What a draw calls for; the bits of the EFFECTS register.
    ///
    /// The firmware ORs them over a scene and powers only the units they need.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Effects: u32 {
        /// Depth test.
        const DEPTH = 1 << 0;
        /// Colours interpolated between the vertices.
        const GOURAUD = 1 << 1;
        /// Colours interpolated perspective-correct.
        const PERSPECTIVE = 1 << 2;
        /// Surface marking: depth through the decal matrix.
        const DECAL = 1 << 3;
        /// Texture.
        const TEXTURE = 1 << 4;
        /// MIP-mapped texture.
        const MIP_MAP = 1 << 5;
        /// Lights and materials.
        const LIGHT = 1 << 6;
        /// Fog and depth cueing.
        const FOG = 1 << 7;
        /// Translucency.
        const BLEND = 1 << 8;
        /// Texels decide visibility.
        const PUNCH_THROUGH = 1 << 9;
        /// Sub-pixel masks.
        const ANTI_ALIAS = 1 << 10;
        /// Stencil test.
        const STENCIL = 1 << 11;
    }
}

bitflags! {
    /// Units of the card; the bits of the UNITS_POWERED register.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Units: u32 {
        /// Register file, FIFO, ring, command processor: always powered.
        const FRONTEND = 1 << 0;
        /// Transform, clip, setup.
        const GEOMETRY = 1 << 1;
        /// Plain Z buffer.
        const Z_BUFFER = 1 << 2;
        /// Za buffer.
        const ZA = 1 << 3;
        /// Systolic scan-line unit.
        const SYSTOLIC = 1 << 4;
        /// Tile unit.
        const TILE = 1 << 5;
        /// Sub-pixel mask unit.
        const SUBPIXEL = 1 << 6;
        /// Texture unit.
        const TEXTURE = 1 << 7;
        /// Shading unit: colours, lights, fog, blending.
        const SHADING = 1 << 8;
        /// Bitmap unit: fills, copies, conversions, stretches, compositions, transfers.
        const BITMAP = 1 << 9;
        /// Display controller.
        const SCANOUT = 1 << 10;
        /// Pixel history.
        const PROBE = 1 << 11;
    }
}
