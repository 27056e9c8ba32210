//! How the host runs the pipeline.
//!
//! Duties: names the kernels, and says which of them this host has. Inputs from: whoever powers a card on. Outputs to:
//! [`super::Pipeline::new`]. Clocks: none; the card's time does not depend on the host.

use fearless_simd::Level;

/// Which code draws the pixels. All give the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// The widest SIMD level of this host.
    #[default]
    Best,
    /// The specification: pixel by pixel, one thread.
    Specification,
    /// 4 lanes, SSE2; on other hosts the least level there is.
    Sse2,
    /// 4 lanes, SSE4.2.
    Sse42,
    /// 8 lanes, AVX2.
    Avx2,
    /// 16 lanes, AVX-512.
    Avx512,
}

impl Kernel {
    /// The kernels that this host can run.
    #[must_use]
    pub fn available() -> Vec<Kernel> {
        let all = [Kernel::Specification, Kernel::Sse2, Kernel::Sse42, Kernel::Avx2, Kernel::Avx512];
        all.into_iter().filter(|k| *k == Kernel::Specification || k.level().is_some()).chain([Kernel::Best]).collect()
    }

    /// The level of host instructions; `None` for the specification, and for what the host cannot run.
    #[cfg(target_arch = "x86_64")]
    pub(crate) fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            Kernel::Best => Some(best),
            Kernel::Specification => None,
            Kernel::Sse2 => best.as_sse2().map(Level::Sse2),
            Kernel::Sse42 => best.as_sse4_2().map(Level::Sse4_2),
            Kernel::Avx2 => best.as_avx2().map(Level::Avx2),
            Kernel::Avx512 => best.as_avx512().map(Level::Avx512),
        }
    }

    /// The level of host instructions; `None` for the specification.
    #[cfg(not(target_arch = "x86_64"))]
    pub(crate) fn level(self) -> Option<Level> {
        (self == Kernel::Best).then(Level::new)
    }
}

/// How the host runs the pipeline; the picture and the counts do not depend on it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PipelineOptions {
    /// Host threads; 0 is one for each processor.
    pub threads: usize,
    /// Which code draws the pixels; one the host cannot run counts as [`Kernel::Best`].
    pub kernel: Kernel,
}
