//! The shadow bit's way through the pipeline: pixels in shadow are darkened when the opaque picture of a scene is done.
//!
//! On every path the plane is in memory by then. On the za path the cleared blocks that hold a pixel in shadow are brought
//! to memory first; no other block is looked at.

use super::za_path;
use crate::hidden::stencil;
use crate::hidden::z_buffer::surfaces;
use crate::memory::VideoMemory;
use crate::probe::account::Account;
use zga_abi::format::HiddenSurface;
use zga_firmware::checked::{Rectangle, Shadow, Target};

/// Rows whose pixels in shadow are held at once.
const ROWS: u32 = 64;

/// Darkens the pixels of a target that are in shadow.
pub(super) fn darken(memory: &mut VideoMemory, target: &Target, shadow: &Shadow, account: &mut Account) {
    let (mut pixels, height) = (0, target.colour.height);
    for first in (0..height).step_by(ROWS as usize) {
        let runs = stencil::shadowed(memory.words(), target, shadow, first..(first + ROWS).min(height));
        if runs.is_empty() {
            continue;
        }
        if target.hidden_surface == HiddenSurface::Za {
            let place = |&[y, x, right]: &[u32; 3]| Rectangle { x, y, right, bottom: y + 1 };
            let places: Vec<Rectangle> = runs.iter().map(place).collect();
            za_path::settle_places(memory, &places, account);
        }
        let (colours, _) = surfaces(memory.drawing(), target);
        stencil::darken(colours, &target.colour, &runs, shadow.intensity);
        pixels += stencil::pixels(&runs);
    }
    stencil::charge_shadow(target, pixels, account);
}
