//! Anti-aliasing: samples of a pixel, widths of lines and points.
//!
//! Duties: checks the settings, wants the registers that BEGIN_SCENE samples, and says which effects a draw calls
//! for. Inputs from: the user. Outputs to: [`Driver::begin_scene`], every draw. A scene has a grid from its begin
//! to its end; its registers travel only when a scene has one.

use zga_abi::Effects;
use zga_abi::bus::Bus;
use zga_abi::format::{SubpixelDepth, SubpixelEdges, SubpixelGrid, SubpixelResolve};
use zga_abi::registers::Reg;

use crate::target::Scene;
use crate::{Driver, DriverError};

/// Most fragments of [`Antialias::pool`].
const MOST_FRAGMENTS: u32 = 1 << 20;
/// Largest width of a line and side of a point, in 1/256 pixels.
const WIDEST: f64 = 65_535.0;

/// How a scene is anti-aliased.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Antialias {
    /// Samples of a pixel; with [`SubpixelGrid::Off`] there is no anti-aliasing.
    pub grid: SubpixelGrid,
    /// How fragments of a pixel that share samples are ordered.
    pub depth: SubpixelDepth,
    /// Space in which samples are averaged and layers composed.
    pub resolve: SubpixelResolve,
    /// Fragments that the lists of one line of pixels have room for, 1..=2^20. Pixels that find none keep one
    /// sample.
    pub pool: u32,
    /// Which edges are anti-aliased: those of every triangle, or the borders of smooth surfaces, which on a smooth mesh
    /// costs a fraction and looks the same.
    pub edges: SubpixelEdges,
}

impl Default for Antialias {
    /// 64 samples; the rest as after a reset of the card.
    fn default() -> Self {
        Antialias {
            grid: SubpixelGrid::Grid8x8,
            depth: SubpixelDepth::Search,
            resolve: SubpixelResolve::Values,
            pool: MOST_FRAGMENTS,
            edges: SubpixelEdges::All,
        }
    }
}

/// What the user has set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AntialiasState {
    pub setting: Option<Antialias>,
    /// u8.8, pixels.
    pub line_width: u32,
    /// u8.8, pixels.
    pub point_size: u32,
}

impl AntialiasState {
    pub const fn new() -> AntialiasState {
        AntialiasState { setting: None, line_width: 0x100, point_size: 0x100 }
    }
}

impl<B: Bus> Driver<B> {
    /// Sets anti-aliasing, from the next begin scene on; off after opening.
    ///
    /// While it is set, draws in a scene that began with it call for the effect `anti_alias`: triangles cover
    /// samples instead of pixels, lines and points are as wide as [`Driver::set_line_width`] and
    /// [`Driver::set_point_size`] say. `None` inside such a scene has the draws that follow cover all samples of
    /// a pixel or none, as without anti-aliasing; the scene keeps its grid.
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without a sub-pixel unit; [`DriverError::BadOption`] for a pool of
    /// 0 or over 2^20 fragments. The setting stays as it was.
    pub fn set_antialias(&mut self, setting: Option<Antialias>) -> Result<(), DriverError> {
        let setting = setting.filter(|setting| setting.grid != SubpixelGrid::Off);
        if let Some(Antialias { pool, .. }) = setting {
            self.has_effect(Effects::ANTI_ALIAS, "sub-pixel unit")?;
            if !(1..=MOST_FRAGMENTS).contains(&pool) {
                let found = pool.to_string();
                return Err(DriverError::BadOption {
                    name: "sub-pixel pool",
                    found,
                    expected: "1 to 1048576 fragments",
                });
            }
        }
        self.state.antialias.setting = setting;
        Ok(())
    }

    /// Anti-aliasing from the next begin scene on.
    #[must_use]
    pub const fn antialias(&self) -> Option<Antialias> {
        self.state.antialias.setting
    }

    /// Sets the width of the anti-aliased lines that follow, pixels, to the nearest 1/256; 1 after opening. Other
    /// lines are one pixel wide whatever is set.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for widths that are not 1/256 to 65535/256 pixels.
    pub fn set_line_width(&mut self, pixels: f64) -> Result<(), DriverError> {
        self.state.antialias.line_width = steps("line width", pixels)?;
        Ok(())
    }

    /// Sets the side of the squares that the anti-aliased points that follow are, pixels, to the nearest 1/256; 1
    /// after opening. Other points are one pixel whatever is set.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for sides that are not 1/256 to 65535/256 pixels.
    pub fn set_point_size(&mut self, pixels: f64) -> Result<(), DriverError> {
        self.state.antialias.point_size = steps("point size", pixels)?;
        Ok(())
    }

    /// Wants what begin scene samples; says whether the scene has a grid.
    pub(crate) fn want_antialias(&mut self) -> bool {
        let setting = self.state.antialias.setting;
        let grid = setting.map_or(SubpixelGrid::Off, |setting| setting.grid);
        self.registers.want(Reg::SubpixelGrid, &[grid.code()]);
        if let Some(Antialias { depth, resolve, pool, edges, .. }) = setting {
            self.registers.want(Reg::SubpixelDepth, &[depth.code()]);
            self.registers.want(Reg::SubpixelResolve, &[resolve.code()]);
            self.registers.want(Reg::SubpixelPool, &[pool]);
            self.registers.want(Reg::SubpixelEdges, &[edges.code()]);
        }
        setting.is_some()
    }

    /// The sub-pixel unit's effect, if a draw in `scene` calls for it; wants widths where they count.
    pub(crate) fn want_masks(&mut self, scene: &Scene) -> Effects {
        let AntialiasState { setting, line_width, point_size } = self.state.antialias;
        let masks = scene.grid && setting.is_some();
        if masks {
            self.registers.want(Reg::LineWidth, &[line_width]);
            self.registers.want(Reg::PointSize, &[point_size]);
        }
        if masks { Effects::ANTI_ALIAS } else { Effects::empty() }
    }
}

/// 1/256 pixels, 1..=65535.
fn steps(name: &'static str, pixels: f64) -> Result<u32, DriverError> {
    let steps = (pixels * 256.0).round();
    if (1.0..=WIDEST).contains(&steps) {
        return Ok(steps as u32);
    }
    Err(DriverError::BadOption { name, found: pixels.to_string(), expected: "1/256 to 65535/256 pixels" })
}
