//! The shadow bit's way through the pipeline: pixels in shadow are darkened when the opaque picture of a scene is done.
//!
//! On every path the plane is in memory by then. On the za path the cleared blocks that hold a pixel in shadow are brought
//! to memory first; no other block is looked at.

use super::za_path;
use crate::hidden::stencil;
use crate::hidden::z_buffer::surfaces;
use crate::memory::VideoMemory;
use crate::probe::account::{Account, Clocks};
use zga_abi::format::HiddenSurface;
use zga_firmware::Stopped;
use zga_firmware::checked::{Rectangle, Shadow, Target};

/// Rows whose pixels in shadow are held at once; between them it can be stopped.
const ROWS: u32 = 64;

/// Darkens the pixels of a target that are in shadow. `stop` is asked with the clocks since `begun`.
///
/// # Errors
/// [`Stopped`] as `stop` says; the rows above are dark then.
pub(super) fn darken(
    memory: &mut VideoMemory,
    target: &Target,
    shadow: &Shadow,
    account: &mut Account,
    begun: Clocks,
    stop: &dyn Fn(Clocks) -> Option<Stopped>,
) -> Result<(), Stopped> {
    let height = target.colour.height;
    for first in (0..height).step_by(ROWS as usize) {
        let rows = first..(first + ROWS).min(height);
        let runs = stencil::shadowed(memory.words(), target, shadow, rows.clone());
        if target.hidden_surface == HiddenSurface::Za {
            let place = |&[y, x, right]: &[u32; 3]| Rectangle { x, y, right, bottom: y + 1 };
            let places: Vec<Rectangle> = runs.iter().map(place).collect();
            za_path::settle_places(memory, &places, account);
        }
        let (colours, _) = surfaces(memory.drawing(), target);
        stencil::darken(colours, &target.colour, &runs, shadow.intensity);
        stencil::charge_shadow(target, rows.len() as u32, stencil::pixels(&runs), account);
        if let Some(stopped) = stop(Clocks(account.total().0 - begun.0)) {
            return Err(stopped);
        }
    }
    Ok(())
}
