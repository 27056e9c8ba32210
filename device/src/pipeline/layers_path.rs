//! The layer unit's way through the pipeline: what may be translucent waits while the path draws the rest, and is
//! composed over it when the scene ends.
//!
//! In its midst that is done before a clear of depths or stencil values without colours, since these decide what is seen of
//! the layers: in the pixels cleared, which hold no layer from there on; elsewhere they go on waiting. A path that sorts before it draws first draws what it has, and
//! begins anew with that.

use super::{Pipeline, za_path};
use crate::built::{Key, LayerKey};
use crate::hidden::z_buffer::all_surfaces;
use crate::layers::piece::pixels_of;
use crate::layers::unit::weight;
use crate::layers::{Setting, charge};
use crate::memory::VideoMemory;
use crate::memory::areas::whole;
use crate::probe::account::{Account, Clocks};
use zga_abi::format::HiddenSurface;
use zga_firmware::Stopped;
use zga_firmware::checked::{Clear, Rectangle, Target};

/// Layers of fewer pixels in bounding boxes than this are composed by one thread.
const PIXELS: u64 = 1 << 16;

impl Pipeline {
    /// Layers of the open scene wait for the layer unit.
    pub(super) fn layers_of(&self, target: &Target) -> Option<LayerKey> {
        LayerKey::built().filter(|_| target.subpixel.is_none() && !self.scene.items.is_empty())
    }

    /// A clear, before it is done. What stops it is said by the next draw, or when the scene ends.
    pub(super) fn clear_layers(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        clear: &Clear,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) {
        let area = clear.area;
        if self.layers_of(target).is_none() || area.x >= area.right || area.y >= area.bottom {
            return;
        }
        if clear.colour.is_none() {
            if (clear.depth.is_none() && clear.stencil.is_none()) || !self.scene.waits_in(&area) {
                return;
            }
            let composed = self.compose_in_midst(memory, target, &area, account, stop);
            self.owed = self.owed.or(composed.err());
        }
        self.scene.take_back(&area, area == whole(&target.colour));
    }

    fn compose_in_midst(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        area: &Rectangle,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        let begun = account.total();
        if target.is_sorted() {
            self.sorted.draw_so_far(memory.drawing(), target, self.level, account, stop)?;
        }
        let spent = account.total().0 - begun.0;
        self.compose(memory, target, area, account, &|clocks| stop(Clocks(spent + clocks.0)))
    }

    /// The path has finished its opaque picture: the layers that wait are composed over it.
    pub(super) fn compose_layers(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        if target.subpixel.is_some() {
            return Ok(());
        }
        let composed = match (self.owed.take(), self.scene.overflowed) {
            (Some(stopped), _) => Err(stopped),
            (None, true) => Err(Stopped::SceneFull),
            (None, false) => match self.layers_of(target) {
                Some(_) => self.compose(memory, target, &whole(&target.colour), account, stop),
                None => Ok(()),
            },
        };
        self.close_scene();
        composed
    }

    fn compose(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        area: &Rectangle,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        let mut setting = Setting {
            format: target.depth_format,
            pixel_format: target.colour.format,
            colour_pitch: target.colour.pitch as usize / 4,
            depth_pitch: target.depth.map_or(0, |depth| depth.pitch as usize / 4),
            area: pixels_of(area),
            stencil_pitch: target.stencil.map_or(0, |plane| plane.pitch as usize),
        };
        if target.hidden_surface == HiddenSurface::Za {
            let touched = self.layers.touched(&setting, &self.scene);
            za_path::settle_places(memory, &touched, account);
        }
        let (colours, depths, values) = if target.is_sorted() {
            let (colours, depths, values, pitch) = self.sorted.picture(memory.drawing(), target);
            setting.depth_pitch = pitch;
            (colours, depths, values)
        } else {
            all_surfaces(memory.drawing(), target)
        };
        let worth = self.level.is_some() && weight(&self.scene, &setting) >= PIXELS;
        let pool = self.workers.pool_for(self.threads, worth);
        let (counts, stopped) =
            self.layers.compose(&setting, &self.scene, self.level, pool, colours, depths, values, stop);
        charge(&counts, account);
        stopped
    }
}
