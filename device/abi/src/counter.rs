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
}

counters! {
    CyclesTotal "cycles.total" "Device time: the sum of all units' clocks (units do not overlap on this card).",
    CyclesFrontend "cycles.frontend" "Clocks of the front end: ring fetch, FIFO, packet decode.",
    CyclesGeometry "cycles.geometry" "Clocks of transform, clip and setup.",
    CyclesZBuffer "cycles.z_buffer" "Clocks of the Z buffer unit: edge walk, depth compare, depth and colour write.",
    CyclesShading "cycles.shading" "Clocks of the colour interpolators.",
    CyclesBitmap "cycles.bitmap" "Clocks of fills, copies and transfers.",
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
}
