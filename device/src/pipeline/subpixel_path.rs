//! The sub-pixel unit's way through the pipeline: it takes the scene while the path draws it, and overwrites active
//! pixels when it ends.

use super::{Pipeline, za_path};
use crate::built::{Key, SubpixelKey};
use crate::hidden::z_buffer::surfaces;
use crate::memory::VideoMemory;
use crate::memory::areas::whole;
use crate::probe::account::{Account, Clocks};
use crate::subpixel::band::Resolved;
use crate::subpixel::map::SubpixelMap;
use crate::subpixel::scene::Base;
use crate::subpixel::{Setting, charge};
use zga_abi::format::{HiddenSurface, PixelFormat};
use zga_firmware::Stopped;
use zga_firmware::checked::{Clear, Surface, Target};

/// A scene of fewer items than this is resolved by one thread.
const ITEMS: usize = 64;

impl Pipeline {
    /// Before the first item of a scene with a grid: keeps what the pixels are, where no clear has said it.
    pub(super) fn keep(&mut self, memory: &mut VideoMemory, target: &Target, account: &mut Account) {
        if SubpixelKey::built().is_none() || target.subpixel.is_none() {
            return;
        }
        if self.scene.depth == Base::Unknown && target.depth.is_none() {
            self.scene.depth = Base::Uniform(target.depth_format.maximum() as i32);
        }
        let (colours, depths) = (self.scene.colour == Base::Unknown, self.scene.depth == Base::Unknown);
        if !colours && !depths {
            return;
        }
        if target.hidden_surface == HiddenSurface::Za {
            za_path::settle(memory, account);
        }
        let (width, surface) = (target.colour.width as usize, &target.colour);
        let (words, stored) = surfaces(memory.drawing(), target);
        if colours {
            let rows = words.chunks_exact(surface.pitch as usize / 4);
            let pixels = rows.flat_map(|row| {
                (0..width).map(|x| {
                    let pixel = match surface.format {
                        PixelFormat::Rgb565 => u32::from(bytemuck::cast_slice::<u32, u16>(row)[x]),
                        PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => row[x],
                    };
                    u32::from_le_bytes(surface.format.decode(pixel))
                })
            });
            self.scene.colour = Base::Each(pixels.collect());
        }
        if let (true, Some(depth)) = (depths, target.depth) {
            let rows = stored.chunks_exact(depth.pitch as usize / 4);
            self.scene.depth = Base::Each(rows.flat_map(|row| &row[..width]).copied().collect());
        }
    }

    /// A clear, before it is done.
    pub(super) fn take_clear(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        clear: &Clear,
        account: &mut Account,
    ) {
        // A stencil plane is no business of the unit.
        let nothing = clear.colour.is_none() && clear.depth.is_none();
        if SubpixelKey::built().is_none() || target.subpixel.is_none() || nothing {
            return;
        }
        let is_whole = clear.area == whole(&target.colour);
        let planes = clear.colour.is_some() && (clear.depth.is_some() || !target.has_depth());
        let nothing = clear.area.x >= clear.area.right || clear.area.y >= clear.area.bottom;
        if !nothing && !(is_whole && (planes || self.scene.items.is_empty())) {
            self.keep(memory, target, account);
        }
        self.scene.clear(clear, is_whole, planes);
    }

    /// The scene is over: the sub-pixel unit overwrites its active pixels, if a draw called for it.
    pub(super) fn resolve_subpixels(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        if SubpixelKey::built().is_none() || target.subpixel.is_none() {
            return Ok(());
        }
        let mut map =
            std::mem::take(&mut self.wants_map).then(|| SubpixelMap::new(target.colour.width, target.colour.height));
        let setting = Setting::new(target, self.scene.rule()).filter(|_| self.scene.called);
        let mut resolved = if self.scene.overflowed { Err(Stopped::SceneFull) } else { Ok(()) };
        if let Some(setting) = setting.filter(|_| resolved.is_ok()) {
            let level = self.level;
            let worth = level.is_some() && self.scene.items.len() >= ITEMS;
            let pool = self.workers.pool_for(self.threads, worth);
            let za = target.hidden_surface == HiddenSurface::Za;
            let write = |pixels: &[Resolved]| {
                if za {
                    za_path::settle_pixels(memory, pixels, account);
                }
                put(memory, target, pixels);
                if let Some(map) = &mut map {
                    for pixel in pixels {
                        map.reasons[usize::from(pixel.y) * map.width as usize + usize::from(pixel.x)] = pixel.reason;
                    }
                }
            };
            let (counts, stopped) = self.unit.resolve(&setting, &self.scene, level, pool, write, stop);
            charge(&counts, account);
            resolved = stopped;
        }
        self.close_scene();
        self.map = map.or(self.map.take());
        resolved
    }
}

/// Writes resolved pixels.
fn put(memory: &mut VideoMemory, target: &Target, pixels: &[Resolved]) {
    let Surface { pitch, format, .. } = target.colour;
    let (words, _) = surfaces(memory.drawing(), target);
    let pitch = pitch as usize / 4;
    for pixel in pixels.iter().filter(|pixel| !pixel.is_degraded()) {
        let row = &mut words[usize::from(pixel.y) * pitch..][..pitch];
        let value = format.encode(pixel.colour.to_le_bytes());
        match format {
            PixelFormat::Rgb565 => {
                bytemuck::cast_slice_mut::<u32, u16>(row)[usize::from(pixel.x)] = value as u16;
            }
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => row[usize::from(pixel.x)] = value,
        }
    }
}
