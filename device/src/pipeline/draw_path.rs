//! A draw on the hidden-surface path of its target.
//!
//! Duties: says what decides visibility in a draw, gives each path what was assembled, in bins or as a list, and has its events
//! charged. Inputs from: [`Pipeline::draw`]. Outputs to: the four paths of [`crate::hidden`], frame buffer and Z buffer.
//! Clocks: those of the path.

use super::Pipeline;
use super::bands::{Plane, Sight, Surfaces};
use super::sorted::{self, Sorted};
use super::za_path;
use crate::built::Called;
use crate::hidden::z_buffer::band::{Setting, StencilSetting};
use crate::hidden::z_buffer::tile::TILE;
use crate::hidden::z_buffer::{self, DepthTest, all_surfaces, specification};
use crate::hidden::za::{self, ZaDraw};
use crate::memory::VideoMemory;
use crate::probe::account::Account;
use crate::shading::plane::Interpolation;
use fearless_simd::Level;
use zga_abi::Effects;
use zga_abi::format::{Fidelity, HiddenSurface};
use zga_firmware::Stopped;
use zga_firmware::checked::{DrawState, Target};

impl Pipeline {
    /// What decides visibility in a draw.
    pub(super) fn path(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        setting: &Setting,
        account: &mut Account,
    ) -> Path {
        match target.hidden_surface {
            HiddenSurface::ZBuffer => Path::ZBuffer,
            HiddenSurface::Za => za_path::draw(memory, target, setting, account).map_or(Path::ZBuffer, Path::Za),
            HiddenSurface::Systolic | HiddenSurface::Tile => Path::Sorted { held: sorted::is_held(target) },
        }
    }

    /// Draws what was assembled into bins.
    pub(super) fn draw_bins(
        &mut self,
        level: Level,
        memory: &mut VideoMemory,
        target: &Target,
        setting: &Setting,
        path: &Path,
        account: &mut Account,
    ) {
        let Some([first, beyond]) = self.workers.rows() else {
            return;
        };
        let (threads, bands) = (self.threads, first..beyond);
        match path {
            Path::ZBuffer => {
                if let Some(uniform) = &mut self.uniform {
                    uniform.drawn(bands.clone());
                }
                let planes = planes(memory.drawing(), target, setting, first);
                let counts = self.workers.draw(threads, planes, bands, |shares, band, planes, scratch| {
                    setting.draw_band(level, shares, band, planes, scratch)
                });
                z_buffer::charge(&counts, setting, account);
            }
            Path::Za(draw) => {
                let (parts, areas) = memory.parts();
                let area_words = areas.words();
                let mut planes = planes(parts.video, target, setting, first);
                let across = draw.grid.across();
                planes.words =
                    Plane::of_bands(&mut parts.za[area_words], across * TILE / draw.grid.block[1] as usize, first);
                let counts = self.workers.draw(threads, planes, bands, |shares, band, planes, scratch| {
                    let Surfaces { colour, depth, words, .. } = planes;
                    draw.draw_band(level, shares, band, colour.rows, depth.rows, words.rows, scratch)
                });
                za::charge(&counts, draw, account);
            }
            Path::Sorted { .. } => {
                let setting = Setting { depth_pitch: Sorted::depth_pitch(target), ..setting.clone() };
                let planes = self.sorted.planes(memory.drawing(), target, &setting, first);
                let counts = self.workers.draw(threads, planes, bands, |shares, band, planes, scratch| {
                    setting.draw_band(level, shares, band, planes, scratch)
                });
                self.sorted.add(&counts, &setting);
            }
        }
    }

    /// Draws what was assembled into a list.
    pub(super) fn draw_list(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        setting: &Setting,
        path: &Path,
        account: &mut Account,
    ) -> Result<(), Stopped> {
        self.uniform = None;
        let shapes = self.list.shapes.iter().map(|(shape, number)| (shape, *number));
        match path {
            Path::ZBuffer => {
                let (colour, depth, stencil) = all_surfaces(memory.drawing(), target);
                let counts = specification::draw_noting(setting, shapes, colour, depth, stencil, &mut Sight::none());
                z_buffer::charge(&counts, setting, account);
            }
            Path::Za(draw) => {
                let (parts, areas) = memory.parts();
                let (colour, depth, stencil) = all_surfaces(parts.video, target);
                let mut surfaces = za::Surfaces { colour, depth, words: &mut parts.za[areas.words()], stencil };
                let counts = match target.fidelity {
                    Fidelity::Functional => za::specification::draw(draw, shapes, &mut surfaces),
                    Fidelity::Clocked => za::clocked::draw(draw, shapes, &mut surfaces),
                };
                za::charge(&counts, draw, account);
            }
            Path::Sorted { held: true } => {
                self.sorted.hold(target, setting, &self.list);
                if self.sorted.full() {
                    return Err(Stopped::SceneFull);
                }
            }
            Path::Sorted { held: false } => {
                let setting = Setting { depth_pitch: Sorted::depth_pitch(target), ..setting.clone() };
                self.sorted.note(target, setting.scissor, &self.list);
                let Surfaces { colour, depth, stencil, mut sight, .. } =
                    self.sorted.planes(memory.drawing(), target, &setting, 0);
                let (colour, depth, stencil) = (colour.rows, depth.rows, stencil.rows);
                let counts = specification::draw_noting(&setting, shapes, colour, depth, stencil, &mut sight);
                self.sorted.add(&counts, &setting);
            }
        }
        Ok(())
    }
}

/// What decides visibility in a draw.
pub(super) enum Path {
    ZBuffer,
    Za(ZaDraw),
    /// `held` back until the scene ends.
    Sorted {
        held: bool,
    },
}

impl Path {
    /// Whether primitives are drawn from bins where the host can: never where a unit is to be stepped. The Za path has no
    /// fast way for a stencil test.
    pub(super) fn is_fast(&self, fidelity: Fidelity, stencil: bool) -> bool {
        match self {
            Path::ZBuffer => true,
            Path::Za(draw) => fidelity == Fidelity::Functional && draw.fast() && !stencil,
            Path::Sorted { held } => !held,
        }
    }

    pub(super) fn is_sorted(&self) -> bool {
        matches!(self, Path::Sorted { .. })
    }

    /// Takes over what the colours of the primitives at hand go through.
    pub(super) fn set_shading(&mut self, setting: &Setting) {
        if let Path::Za(draw) = self {
            draw.pixels.shading.clone_from(&setting.shading);
        }
    }
}

/// The planes of a target from band `first` on.
fn planes<'m>(memory: &'m mut [u32], target: &Target, setting: &Setting, first: usize) -> Surfaces<'m> {
    let (colour, depth, stencil) = all_surfaces(memory, target);
    // A block that is cleared in Za RAM only gets its depths with the first pixel drawn to it, tested or not.
    let wanted = setting.test.is_some() || target.hidden_surface == HiddenSurface::Za;
    let depth = if wanted { Plane::new(depth, setting.depth_pitch, first) } else { Plane::none() };
    Surfaces {
        colour: Plane::new(colour, setting.colour_pitch, first),
        depth,
        stencil: setting.stencil.map_or(Plane::none(), |setting| Plane::new(stencil, setting.pitch, first)),
        words: Plane::none(),
        sight: Sight::none(),
    }
}

/// What the pixels of a draw share.
pub(super) fn setting(target: &Target, state: &DrawState) -> Setting {
    let effects = state.effects;
    Setting {
        test: effects.contains(Effects::DEPTH).then(|| DepthTest::new(state.depth_function, state.depth_write)),
        format: target.depth_format,
        interpolation: if !effects.contains(Effects::GOURAUD) {
            Interpolation::Flat
        } else if effects.contains(Effects::PERSPECTIVE) {
            Interpolation::Perspective
        } else {
            Interpolation::Affine
        },
        shading: None,
        stencil: match (state.stencil, target.stencil) {
            (Some(rule), Some(plane)) => Called::new(|| StencilSetting { rule, pitch: plane.pitch as usize }),
            _ => None,
        },
        cuts_segments: target.hidden_surface == HiddenSurface::Systolic,
        scissor: state.scissor,
        width: target.colour.width,
        pixel_format: target.colour.format,
        colour_pitch: target.colour.pitch as usize / 4,
        depth_pitch: target.depth.map_or(0, |d| d.pitch as usize / 4),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hidden::za::{Background, Grid};
    use zga_abi::format::{DepthFormat, PixelFormat, ZaPrediction};
    use zga_firmware::checked::Rectangle;

    #[test]
    fn is_fast_of_a_clocked_za_unit_is_not() {
        let pixels = Setting {
            test: Some(DepthTest::LESS),
            format: DepthFormat::default(),
            interpolation: Interpolation::Flat,
            shading: None,
            stencil: None,
            cuts_segments: false,
            scissor: Rectangle { x: 0, y: 0, right: 64, bottom: 64 },
            width: 64,
            pixel_format: PixelFormat::Xrgb8888,
            colour_pitch: 64,
            depth_pitch: 64,
        };
        // Blocks as published, which the functional model draws from bins.
        let path = Path::Za(ZaDraw {
            pixels,
            grid: Grid { block: [32, 1], size: [64, 64] },
            background: Background { pixel: 0, depth: 0 },
            prediction: ZaPrediction::BlockLength,
            bypass: true,
            depth_buffer: true,
        });
        assert!(path.is_fast(Fidelity::Functional, false));
        assert!(!path.is_fast(Fidelity::Functional, true), "no fast way for a stencil test");
        assert!(!path.is_fast(Fidelity::Clocked, false), "the state machine must be stepped whatever the kernel");
    }
}
