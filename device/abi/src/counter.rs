//! Counters and cycle accounts, in the order in which they stand in the COUNTERS registers.

macro_rules! counters {
    ($( $id:ident $name:literal $doc:literal, )+) => {
        /// A 64-bit event counter or cycle account of the card.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum Counter { $( #[doc = $doc] $id, )+ }

        impl Counter {
            /// Every counter, in register order.
            pub const ALL: &'static [Counter] = &[ $( Counter::$id, )+ ];
            /// Number of counters.
            pub const COUNT: usize = Counter::ALL.len();

            /// The name in reports.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $( Counter::$id => $name, )+ }
            }

            /// One line: what is counted.
            #[must_use]
            pub const fn doc(self) -> &'static str {
                match self { $( Counter::$id => $doc, )+ }
            }
        }
    };
}

impl Counter {
    /// Byte offset of the counter's low word in the register aperture; the high word follows.
    #[must_use]
    pub const fn offset(self) -> u32 {
        crate::Reg::Counters.offset() + 8 * self as u32
    }

    /// The counter holds the largest of its events, not their sum.
    #[must_use]
    pub const fn is_maximum(self) -> bool {
        matches!(self, Counter::SubpixelPoolPeakBytes | Counter::SubpixelEdgePeakBytes | Counter::TextureDecodedBytes)
    }
}

counters! {
    CyclesTotal "cycles.total" "Device time: the sum of all units' clocks (units do not overlap on this card).",
    CyclesFrontend "cycles.frontend" "Clocks of the front end: ring fetch, FIFO, packet decode.",
    CyclesGeometry "cycles.geometry" "Clocks of transform, clip and setup.",
    CyclesZBuffer "cycles.z_buffer" "Clocks of the Z buffer unit: edge walk, depth compare, depth and colour write.",
    CyclesShading "cycles.shading" "Clocks of the colour interpolators.",
    CyclesBitmap "cycles.bitmap" "Clocks of fills, copies, conversions, stretches, compositions and transfers.",
    CyclesScanout "cycles.scanout" "Clocks of frame composition.",
    FrontendPackets "frontend.packets" "Packets executed.",
    FrontendWords "frontend.words" "Words of packets executed, headers included.",
    FrontendFences "frontend.fences" "Fences executed.",
    GeometryVertices "geometry.vertices" "Vertices transformed.",
    GeometryPrimitives "geometry.primitives" "Primitives that arrived.",
    GeometryClipped "geometry.clipped" "Primitives that a clip plane cut.",
    GeometryDiscarded "geometry.discarded" "Primitives that were dropped: a NaN, or nothing left inside the clip volume, or no pixel centre inside.",
    ZSpans "z.spans" "Runs of pixels of one triangle on one row.",
    ZReads "z.reads" "Depths read and compared.",
    ZWrites "z.writes" "Depths written, clears included.",
    ColourWrites "colour.writes" "Colours written, clears included.",
    ShadingPixels "shading.pixels" "Colours interpolated.",
    BitmapPixels "bitmap.pixels" "Pixels or words moved by the bitmap unit.",
    ScanoutFrames "scanout.frames" "Frames composed.",
    ScanoutPixels "scanout.pixels" "Pixels put out.",
    ProbeFragments "probe.fragments" "Fragments that came to the probed pixel.",
    CyclesZa "cycles.za" "Clocks of the Za unit: Za words, predictions, depth and colour of the blocks visited.",
    CyclesSystolic "cycles.systolic" "Clocks of the systolic array.",
    CyclesTile "cycles.tile" "Clocks of the tile unit: sorts, comparators, colour buffer.",
    ZaClears "za.clears" "Logical clears of a frame.",
    ZaWordsWritten "za.words_written" "Za words written.",
    ZaBlocksInitialised "za.blocks_initialised" "Cleared blocks that were drawn to first.",
    ZaBlocksBypassed "za.blocks_bypassed" "Blocks that one comparison rejected for a primitive.",
    ZaPixelsBypassed "za.pixels_bypassed" "Covered pixels in those blocks.",
    ZaBlocksCompared "za.blocks_compared" "Initialised blocks whose pixels were visited for a primitive.",
    ZaBlocksSettled "za.blocks_settled" "Cleared blocks whose background was written to memory because somebody else needs it there.",
    ScanoutBackgroundBlocks "scanout.background_blocks" "Cleared blocks for which scan-out put out the background.",
    SystolicTokens "systolic.tokens" "Plane segments that entered the array: one for each primitive and scan line with a covered pixel, and one for each line of a clear inside a scene.",
    SystolicClocks "systolic.clocks" "Clocks from the first token of a scene to the last pixel on the luminance bus.",
    TileVisited "tile.visited" "Tiles visited.",
    TileEmpty "tile.empty" "Tiles visited whose list was empty.",
    TileLinksWalked "tile.links_walked" "Links followed: polygons of a row for the X sort, polygons of a tile for its pixels.",
    TileLinksRemoved "tile.links_removed" "Polygons unlinked because they end in the tile or row just done.",
    TileSortMemoryBytes "tile.sort_memory_bytes" "Bytes of Y_INDEX, X index and sort buffer that scenes needed, summed over scenes.",
    TileFragmentsNotStored "tile.fragments_not_stored" "Records that cutting each polygon into tiles would have stored beyond one a polygon.",
    CyclesSubpixel "cycles.subpixel" "Clocks of the sub-pixel mask unit: edges compared, masks, searches, depths, merges, packing, pixels written.",
    SubpixelMasks "subpixel.masks" "Masks made: one for each fragment of an active pixel that covers a part of it, or its centre alone, and one for each triangle, in which its edges begin.",
    SubpixelSearches "subpixel.searches" "Searches of masks: two for a fragment, for its nearest and its farthest depth.",
    SubpixelSearchSteps "subpixel.search_steps" "Bands of samples that those searches looked at.",
    SubpixelDepthEvaluations "subpixel.depth_evaluations" "Depths of fragments evaluated, at samples or at the pixel's centre.",
    SubpixelMerges "subpixel.merges" "Fragments of a pixel that went on as one with another of their object tag.",
    SubpixelPacked "subpixel.packed" "Fragments, layers and bases whose samples went into a pixel's colour.",
    SubpixelPixelsActive "subpixel.pixels_active" "Pixels that the unit averaged and wrote.",
    SubpixelFragments "subpixel.fragments" "Fragments stored in the lists of pixels.",
    SubpixelPoolPeakBytes "subpixel.pool_peak_bytes" "Most bytes that the lists of one line of pixels took, 16 a fragment: a maximum, not a sum.",
    SubpixelPixelsDegraded "subpixel.pixels_degraded" "Pixels that kept one sample because the pool had no room for their list.",
    CyclesTexture "cycles.texture" "Clocks of the texture unit: 1 a texel looked up, 2 a trilinear one.",
    CyclesLayers "cycles.layers" "Clocks of blending without a sub-pixel grid: fragments tested, blended, compared by a sort.",
    TextureTexels "texture.texels" "Texels looked up: one for each textured pixel shaded or fragment tested for a hole.",
    TextureFetches "texture.fetches" "Texels read from memory: 1, 4 or 8 a look-up.",
    TextureDecodedBytes "texture.decoded_bytes" "Most bytes of texels that the texture unit held: a maximum, not a sum.",
    TextureHoles "texture.holes" "Fragments that were holes of their texture, whatever their depth.",
    ShadingLights "shading.lights" "Lights evaluated, at vertices or pixels.",
    ShadingFogged "shading.fogged" "Pixels that fog was mixed into.",
    LayersFragments "layers.fragments" "Translucent fragments that came to the depth test, without a sub-pixel grid.",
    LayersBlended "layers.blended" "Translucent fragments blended into the frame, without a sub-pixel grid.",
    LayersSortedPixels "layers.sorted_pixels" "Pixels whose translucent fragments had to be sorted one by one.",
    BitmapCombined "bitmap.combined" "Pixels that a raster operation or a plane mask combined with what was there.",
    BitmapStretched "bitmap.stretched" "Pixels that a stretch made.",
    StencilTested "stencil.tested" "Fragments whose pixel's stencil value was read and compared.",
    StencilFailed "stencil.failed" "Fragments among them that failed the stencil test.",
    StencilShadowed "stencil.shadowed" "Pixels that the shadow bit darkened.",
    ScanoutCursorPixels "scanout.cursor_pixels" "Pixels of the cursor put out over the frame.",
    BitmapEntries "bitmap.entries" "Entries of lists: rectangles, segments, bitmaps.",
    BitmapSegmentPixels "bitmap.segment_pixels" "Pixels that segments lit.",
    BitmapExpanded "bitmap.expanded" "Pixels that bitmaps of 1 bit a pixel covered, drawn or not.",
    BitmapComposed "bitmap.composed" "Pixels that were composed.",
    SubpixelEdges "subpixel.edges" "Edges of triangles that looked for another to share, where only borders are anti-aliased.",
    SubpixelEdgePeakBytes "subpixel.edge_peak_bytes" "Most bytes that those edges took in a scene, 8 an edge that waited and 1 a primitive: a maximum, not a sum.",
}
