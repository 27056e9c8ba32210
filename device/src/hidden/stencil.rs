//! Stencil test: eight bits a pixel beside its depth, and the shadow bit that follows from them.
//!
//! Duties: decides, for each fragment that is no hole, whether it comes to the depth test; changes the pixel's stencil
//! value by what becomes of it; darkens pixels in shadow when the opaque picture of a scene is done. Inputs from: a draw's
//! [`Stencil`], which side of a triangle is seen, the stencil plane. Outputs to: the plane, the verdict, frame buffer.
//!
//! The test is a part of every path's Z comparator, as window, stencil and shadow bits are of the tile unit's: there is
//! one rule, [`Stencilled::decide`], and each path asks it where its own comparison is made.
//!
//! # Clocks
//! Z buffer and Za: 1 a fragment tested, since its value is one more access to memory; they are those of that unit.
//! Systolic array and tile unit: none. A comparator keeps the value in a register that is loaded and stored along with the
//! line or the tile. The shadow bit: 1 for 64 bytes of the plane read, 1 a pixel darkened; the path's unit is charged.

use crate::geometry::assembly::Shape;
use crate::geometry::triangle::runs_counter_clockwise;
use crate::probe::account::{Account, Clocks};
use std::ops::Range;
use zga_abi::Counter;
use zga_abi::format::{HiddenSurface, PixelFormat};
use zga_firmware::checked::{Rectangle, Shadow, Stencil, Surface, Target};

/// Bytes of the plane that are read or written in a clock.
const LINE: u32 = 64;

/// Events of the test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StencilCounts {
    /// Fragments that were tested.
    pub tested: u64,
    /// Fragments that failed.
    pub failed: u64,
}

impl StencilCounts {
    /// The sum of two counts.
    #[must_use]
    #[inline(always)]
    pub fn plus(self, other: StencilCounts) -> StencilCounts {
        StencilCounts { tested: self.tested + other.tested, failed: self.failed + other.failed }
    }

    /// Adds the events to the counters; the clocks are their unit's business.
    pub fn charge(&self, account: &mut Account) {
        account.add(Counter::StencilTested, self.tested);
        account.add(Counter::StencilFailed, self.failed);
    }
}

/// A draw's stencil test, for primitives that show one of their sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stencilled {
    /// The test of the draw.
    pub rule: Stencil,
    /// The front is seen.
    pub front: bool,
}

impl Stencilled {
    /// The test of a primitive.
    #[must_use]
    pub fn of(rule: Stencil, shape: &Shape) -> Stencilled {
        Stencilled { rule, front: is_front(shape) }
    }

    /// A fragment comes to a pixel that holds `stored`: whether it is drawn. `passes` is its depth test, which is asked
    /// only if the stencil test passes.
    #[inline(always)]
    pub fn decide(&self, stored: &mut u8, counts: &mut StencilCounts, passes: impl FnOnce() -> bool) -> bool {
        let operations = if self.front { self.rule.front } else { self.rule.back };
        counts.tested += 1;
        let (operation, drawn) = if !self.rule.test.passes(*stored) {
            counts.failed += 1;
            (operations.fail, false)
        } else if passes() {
            (operations.pass, true)
        } else {
            (operations.depth_fail, false)
        };
        *stored = self.rule.apply(operation, *stored);
        drawn
    }
}

/// What a comparator that keeps the value in a register does with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StencilRule {
    /// It stays, and decides nothing.
    #[default]
    Keep,
    /// It becomes this one: a clear.
    Store(u8),
    /// It is tested.
    Test(Stencilled),
}

impl StencilRule {
    /// What becomes of a fragment that passes the depth test or not, and of the value.
    #[inline(always)]
    pub fn decide(&self, stored: &mut u8, counts: &mut StencilCounts, passes: impl FnOnce() -> bool) -> bool {
        match self {
            StencilRule::Keep => passes(),
            StencilRule::Store(value) => {
                *stored = *value;
                passes()
            }
            StencilRule::Test(stencilled) => stencilled.decide(stored, counts, passes),
        }
    }
}

/// Whether a primitive shows its front: a triangle whose vertices run counter-clockwise on the screen, any line or point.
#[must_use]
pub fn is_front(shape: &Shape) -> bool {
    match shape {
        Shape::Triangle(_, v) => runs_counter_clockwise(v.each_ref().map(|v| [v.x, v.y])),
        Shape::Line(..) | Shape::Point(..) => true,
    }
}

/// Rows of stencil values.
#[derive(Debug)]
pub struct StencilRows<'m> {
    /// Rows of `pitch` bytes; empty where nobody asks for them.
    pub rows: &'m mut [u8],
    /// Bytes from a row to the next.
    pub pitch: usize,
}

impl StencilRows<'_> {
    /// No values.
    #[must_use]
    pub fn none() -> Self {
        StencilRows { rows: &mut [], pitch: 0 }
    }

    /// Somebody asks for them.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        self.pitch != 0
    }

    /// Value of pixel (`x`, `y`); 0 where there is none.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> u8 {
        self.rows.get(y as usize * self.pitch + x as usize).copied().unwrap_or(0)
    }

    /// Sets the value of pixel (`x`, `y`), where there are any.
    pub fn put(&mut self, x: u32, y: u32, value: u8) {
        if let Some(stored) = self.rows.get_mut(y as usize * self.pitch + x as usize) {
            *stored = value;
        }
    }
}

/// Words of video memory that the stencil plane of a target takes; none without one.
#[must_use]
pub fn words(target: &Target) -> Range<usize> {
    target.stencil.map_or(0..0, |plane| {
        let first = plane.base as usize / 4;
        first..first + plane.pitch as usize / 4 * target.colour.height as usize
    })
}

/// Value of a pixel in video memory; 0 without a plane.
#[must_use]
pub fn value_at(memory: &[u32], target: &Target, x: u32, y: u32) -> u8 {
    let at = target.stencil.map(|plane| plane.base as usize + y as usize * plane.pitch as usize + x as usize);
    at.and_then(|at| bytemuck::cast_slice::<u32, u8>(memory).get(at)).copied().unwrap_or(0)
}

/// Writes a value to the pixels of `area`; returns the clocks where that is done in memory.
pub fn fill(memory: &mut [u32], target: &Target, area: &Rectangle, value: u8) -> Clocks {
    let Some(plane) = target.stencil else {
        return Clocks(0);
    };
    let rows: &mut [u8] = bytemuck::cast_slice_mut(&mut memory[words(target)]);
    for row in rows.chunks_exact_mut(plane.pitch as usize).take(area.bottom as usize).skip(area.y as usize) {
        row[area.x as usize..area.right as usize].fill(value);
    }
    Clocks(u64::from((area.right - area.x).div_ceil(LINE)) * u64::from(area.bottom - area.y))
}

/// Runs of pixels in shadow on `lines` of a target, one after another: row, first column, first column beyond.
#[must_use]
pub fn shadowed(memory: &[u32], target: &Target, shadow: &Shadow, lines: Range<u32>) -> Vec<[u32; 3]> {
    let Some(plane) = target.stencil else {
        return Vec::new();
    };
    let dark: Vec<bool> = (0..=255).map(|value| shadow.test.passes(value)).collect();
    let rows: &[u8] = bytemuck::cast_slice(&memory[words(target)]);
    let mut runs = Vec::new();
    for (row, y) in rows.chunks_exact(plane.pitch as usize).skip(lines.start as usize).zip(lines) {
        let mut x = 0;
        for run in row[..target.colour.width as usize].chunk_by(|a, b| dark[usize::from(*a)] == dark[usize::from(*b)]) {
            let beyond = x + run.len() as u32;
            if dark[usize::from(run[0])] {
                runs.push([y, x, beyond]);
            }
            x = beyond;
        }
    }
    runs
}

/// Darkens runs of pixels in a frame buffer.
pub fn darken(colours: &mut [u32], surface: &Surface, runs: &[[u32; 3]], intensity: u8) {
    // Rounded to the nearest level: 255 is odd, so there is no tie.
    let levels: Vec<u8> = (0..=255_u32).map(|level| ((level * u32::from(intensity) + 127) / 255) as u8).collect();
    let level = |level: u8| levels[usize::from(level)];
    let format = surface.format;
    let pixel = |stored: u32| {
        let [r, g, b, a] = format.decode(stored);
        format.encode([level(r), level(g), level(b), a])
    };
    let pitch = surface.pitch as usize / 4;
    for &[y, first, beyond] in runs {
        let row = &mut colours[y as usize * pitch..][..pitch];
        let columns = first as usize..beyond as usize;
        match format {
            PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => {
                row[columns].iter_mut().for_each(|stored| *stored = pixel(*stored));
            }
            PixelFormat::Rgb565 => {
                let pixels: &mut [u16] = bytemuck::cast_slice_mut(row);
                pixels[columns].iter_mut().for_each(|stored| *stored = pixel(u32::from(*stored)) as u16);
            }
        }
    }
}

/// Pixels of runs.
#[must_use]
pub fn pixels(runs: &[[u32; 3]]) -> u64 {
    runs.iter().map(|&[_, first, beyond]| u64::from(beyond - first)).sum()
}

/// Charges the shadow bit over so many rows of a target, of which so many pixels were in shadow, to the unit of its path.
pub fn charge_shadow(target: &Target, rows: u32, pixels: u64, account: &mut Account) {
    let lines = u64::from(target.colour.width.div_ceil(LINE)) * u64::from(rows);
    account.add(Counter::StencilShadowed, pixels);
    account.add(Counter::ColourWrites, pixels);
    account.charge(cycles(target), Clocks(lines + pixels));
}

/// The cycle account of a path's unit.
#[must_use]
pub fn cycles(target: &Target) -> Counter {
    match target.hidden_surface {
        HiddenSurface::ZBuffer => Counter::CyclesZBuffer,
        HiddenSurface::Za => Counter::CyclesZa,
        HiddenSurface::Systolic => Counter::CyclesSystolic,
        HiddenSurface::Tile => Counter::CyclesTile,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zga_abi::format::{DepthFormat, DepthFunction, Fidelity, StencilOperation};
    use zga_firmware::checked::{StencilOperations, StencilSurface, StencilTest, SystolicSetting, ZaSetting};

    fn target(format: PixelFormat) -> Target {
        Target {
            colour: Surface { base: 0, pitch: 64, width: 5, height: 2, format },
            depth: None,
            depth_format: DepthFormat::default(),
            subpixel_bits: 8,
            hidden_surface: HiddenSurface::Tile,
            fidelity: Fidelity::Functional,
            za: ZaSetting::default(),
            systolic: SystolicSetting::default(),
            tile: [8, 8],
            subpixel: None,
            stencil: Some(StencilSurface { base: 128, pitch: 64 }),
        }
    }

    #[test]
    fn decide_each_outcome_has_its_operation_and_is_counted() {
        use StencilOperation::{Increment, Invert, Zero};
        let test = StencilTest { function: DepthFunction::LessEqual, reference: 4, read_mask: 0x0F };
        let keep = StencilOperation::Keep;
        let back = StencilOperations { fail: keep, depth_fail: keep, pass: keep };
        let front = StencilOperations { fail: Zero, depth_fail: Increment, pass: Invert };
        let rule = Stencil { test, write_mask: 0x3F, front, back, colour_off: false };
        let (mut counts, stencilled) = (StencilCounts::default(), Stencilled { rule, front: true });
        let mut outcome = |stencilled: &Stencilled, mut stored: u8, passes: bool| {
            let drawn = stencilled.decide(&mut stored, &mut counts, || passes);
            (drawn, stored)
        };
        assert_eq!(outcome(&stencilled, 0xF3, true), (false, 0xC0), "4 is not at most 3");
        assert_eq!(outcome(&stencilled, 0xF4, false), (false, 0xF5));
        assert_eq!(outcome(&stencilled, 0xF4, true), (true, 0xCB));
        assert_eq!(outcome(&Stencilled { front: false, ..stencilled }, 0xF4, true), (true, 0xF4));
        assert_eq!(counts, StencilCounts { tested: 4, failed: 1 });
    }

    #[test]
    fn decide_asks_for_depth_only_what_passes_the_stencil_test() {
        let keep = StencilOperations {
            fail: StencilOperation::Keep,
            depth_fail: StencilOperation::Keep,
            pass: StencilOperation::Keep,
        };
        let test = StencilTest { function: DepthFunction::Never, reference: 0, read_mask: 0xFF };
        let rule = Stencil { test, write_mask: 0xFF, front: keep, back: keep, colour_off: false };
        let mut asked = false;
        let drawn = Stencilled { rule, front: true }.decide(&mut 0, &mut StencilCounts::default(), || {
            asked = true;
            true
        });
        assert_eq!((drawn, asked), (false, false));
    }

    #[test]
    fn fill_and_shadowed_find_runs_inside_the_target_only() {
        let target = target(PixelFormat::Xrgb8888);
        let mut memory = vec![u32::MAX; 64];
        assert_eq!(fill(&mut memory, &target, &Rectangle { x: 0, y: 0, right: 5, bottom: 2 }, 0), Clocks(2));
        let clocks = fill(&mut memory, &target, &Rectangle { x: 1, y: 1, right: 4, bottom: 2 }, 3);
        assert_eq!(clocks, Clocks(1));
        assert_eq!((memory[32], memory[33], memory[48], memory[49]), (0, 0xFFFF_FF00, 0x0303_0300, 0xFFFF_FF00));
        assert_eq!([0, 1, 3, 4].map(|x| value_at(&memory, &target, x, 1)), [0, 3, 3, 0]);
        let test = StencilTest { function: DepthFunction::NotEqual, reference: 0, read_mask: 0xFF };
        assert_eq!(shadowed(&memory, &target, &Shadow { test, intensity: 0 }, 0..2), [[1, 1, 4]]);
        let test = StencilTest { function: DepthFunction::Equal, ..test };
        assert_eq!(shadowed(&memory, &target, &Shadow { test, intensity: 0 }, 0..2), [[0, 0, 5], [1, 0, 1], [1, 4, 5]]);
        assert_eq!(shadowed(&memory, &target, &Shadow { test, intensity: 0 }, 1..2), [[1, 0, 1], [1, 4, 5]]);
    }

    #[test]
    fn darken_rounds_to_the_nearest_level_and_leaves_alpha() {
        let mut surface = target(PixelFormat::Argb8888).colour;
        let mut colours = vec![0x80FF_0203; 32];
        darken(&mut colours, &surface, &[[0, 1, 2]], 128);
        assert_eq!(colours[..3], [0x80FF_0203, 0x8080_0102, 0x80FF_0203]);
        surface.format = PixelFormat::Rgb565;
        let mut colours = vec![0xFFFF_FFFF; 32];
        darken(&mut colours, &surface, &[[1, 0, 1]], 0);
        assert_eq!((colours[15], colours[16]), (0xFFFF_FFFF, 0xFFFF_0000));
    }

    #[test]
    fn charge_shadow_reads_the_plane_and_writes_what_is_darkened() {
        let mut account = Account::default();
        charge_shadow(&target(PixelFormat::Rgb565), 2, pixels(&[[0, 0, 5], [1, 2, 4]]), &mut account);
        let found = [Counter::StencilShadowed, Counter::ColourWrites, Counter::CyclesTile].map(|c| account.get(c));
        assert_eq!(found, [7, 7, 9]);
    }
}
