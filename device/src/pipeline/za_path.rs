//! The Za path's way through the pipeline: clears and draws of the scene's frame.

use crate::hidden::stencil;
use crate::hidden::z_buffer::band::Setting;
use crate::hidden::za::{self, Background, ZaDraw};
use crate::memory::VideoMemory;
use crate::memory::areas::whole;
use crate::probe::account::Account;
use crate::subpixel::band::Resolved;
use zga_abi::Counter;
use zga_firmware::checked::{Clear, Rectangle, Target};

/// A draw to the scene's frame, whose words are exact now.
pub(super) fn draw(
    memory: &mut VideoMemory,
    target: &Target,
    pixels: &Setting,
    account: &mut Account,
) -> Option<ZaDraw> {
    let (mut parts, areas) = memory.parts();
    let area = areas.ready(&mut parts, account)?;
    Some(ZaDraw {
        pixels: pixels.clone(),
        grid: area.grid(),
        background: area.background,
        prediction: target.za.prediction,
        bypass: target.za.bypass,
        depth_buffer: target.depth.is_some(),
    })
}

/// A clear: of all planes of all pixels in Za words alone, of anything else in memory.
pub(super) fn clear(memory: &mut VideoMemory, target: &Target, clear: &Clear, account: &mut Account) {
    let area = clear.area;
    if area.x >= area.right || area.y >= area.bottom {
        return;
    }
    if let Some(value) = clear.stencil {
        account.charge(Counter::CyclesZa, stencil::fill(memory.drawing(), target, &area, value));
        if clear.colour.is_none() && clear.depth.is_none() {
            return;
        }
    }
    let (mut parts, areas) = memory.parts();
    let all = clear.colour.is_some() && (clear.depth.is_some() || target.depth.is_none());
    let pixel = |colour: u32| target.colour.format.encode(colour.to_le_bytes());
    if let (true, true, Some(colour)) = (area == whole(&target.colour), all, clear.colour) {
        let depth = clear.depth.unwrap_or(target.depth_format.maximum()) as i32;
        let Some(area) = areas.clear_all(&parts, Background { pixel: pixel(colour), depth }) else {
            return;
        };
        za::memory::clear_logically(&mut parts.za[area.words()]).charge(account);
        account.add(Counter::ZaClears, 1);
        return;
    }
    let Some(mine) = areas.ready(&mut parts, account) else {
        return;
    };
    let cleared = mine.clear_rectangle(&mut parts, &area, clear.colour.map(pixel), clear.depth.map(|d| d as i32));
    cleared.charge(account);
}

/// Brings all cleared blocks of the scene's frame to memory.
pub(super) fn settle(memory: &mut VideoMemory, account: &mut Account) {
    let (mut parts, areas) = memory.parts();
    areas.settle_open(&mut parts, std::iter::once(None), account);
}

/// Brings the cleared blocks of the scene's frame to memory that have pixels in one of `places`.
pub(super) fn settle_places(memory: &mut VideoMemory, places: &[Rectangle], account: &mut Account) {
    let (mut parts, areas) = memory.parts();
    areas.settle_open(&mut parts, places.iter().copied().map(Some), account);
}

/// Brings the cleared blocks of the scene's frame to memory in which pixels are about to be written.
pub(super) fn settle_pixels(memory: &mut VideoMemory, pixels: &[Resolved], account: &mut Account) {
    let (mut parts, areas) = memory.parts();
    let written = pixels.iter().filter(|pixel| !pixel.is_degraded());
    let places = written.map(|pixel| {
        let (x, y) = (u32::from(pixel.x), u32::from(pixel.y));
        Some(Rectangle { x, y, right: x + 1, bottom: y + 1 })
    });
    areas.settle_open(&mut parts, places, account);
}

/// Depth of pixel (`x`, `y`) if its block in the scene's frame is logically cleared.
pub(super) fn cleared_depth(memory: &VideoMemory, target: &Target, x: u32, y: u32) -> Option<u32> {
    let area = memory.areas().open_area().filter(|area| area.is_of(target))?;
    let grid = area.grid();
    let block = (y / grid.block[1]) as usize * grid.across() + (x / grid.block[0]) as usize;
    let word = memory.za().words().get(area.words())?.get(block).copied()?;
    (word < 0).then_some(area.background.depth as u32)
}
