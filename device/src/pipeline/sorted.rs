//! Sorted scenes: the systolic array and the tile unit, which decide visibility when a scene ends.
//!
//! Clocked, the scene is held back and the unit's model draws it at END_SCENE. Functional, the host
//! draws at once, as the plain Z buffer does, and keeps what the unit's events follow from: which pixels
//! were drawn to and which of them have interpolated colours, how many segments each line has, how far
//! polygons reach in each row of tiles. Pixels, counters and clocks are the same.
//!
//! Neither unit has a Z buffer. Where the target gives one all the same, depths are loaded from it
//! unless the scene begins with a clear, and stored to it when the scene ends. Where it gives none, the
//! functional model compares in memory of its own, which stands for the units' depth registers.

use super::bands::{Plane, Sight, Surfaces};
use crate::geometry::assembly::{List, Shape, Sink};
use crate::geometry::plane::below;
use crate::hidden::held::{Background, Depths, Held, HeldDraw, HeldShading, Item};
use crate::hidden::stencil::{self, StencilCounts, StencilRows};
use crate::hidden::systolic::{self, SystolicCounts, Waves};
use crate::hidden::tile::Grid;
use crate::hidden::tile::closed_form::{PixelCounts, Sorts, pixels_of_tile};
use crate::hidden::tile::{self, scene};
use crate::hidden::z_buffer::band::Setting;
use crate::hidden::z_buffer::specification::{colour_plane, meets};
use crate::hidden::z_buffer::tile::TileCounts;
use crate::hidden::z_buffer::{all_surfaces, fill_colour, fill_depth, surfaces};
use crate::probe::account::{Account, Clocks};
use crate::shading::pixel::ShadingCounts;
use fearless_simd::Level;
use zga_abi::format::{Fidelity, HiddenSurface};
use zga_firmware::Stopped;
use zga_firmware::checked::{Clear, Rectangle, Target};

/// Pixels in one element of a bit plane.
const CHUNK: usize = 16;

/// The open scene of a path that sorts, and memory that is kept from scene to scene.
#[derive(Debug, Default)]
pub(super) struct Sorted {
    /// Something was drawn or cleared.
    used: bool,
    /// There was a draw, or a clear that is drawn: no clear is the background any more. A draw of which nothing meets
    /// the target counts, so that this does not depend on who finds that out.
    drawn: bool,
    background: Background,
    /// Depths where the target has no Z buffer; rows of `depth_pitch`. Of a scene that is held back only where layers
    /// ask for them.
    depth: Vec<i32>,
    /// Those of the scene so far are in `depth`, or in the Z buffer: layers were composed in its midst.
    carried: bool,
    winner: Vec<u16>,
    late: Vec<u16>,
    /// By what each pixel is shaded beyond its interpolated colour: a place in `prices`, plus 1. Empty until a draw calls
    /// for more.
    costs: Vec<u16>,
    /// What pixels can cost, each once.
    prices: Vec<ShadingCounts>,
    /// Plane segments on each line.
    tokens: Vec<u32>,
    /// The tile unit's sorts.
    sorts: Option<Sorts>,
    /// Runs of triangles on rows.
    spans: u64,
    /// What looking for holes has cost.
    looked_up: ShadingCounts,
    /// Events of stencil tests.
    stencil: StencilCounts,
    /// The scene, where it is held back.
    held: Held,
    /// Depth and stencil value at the probed pixel of a scene that is held back, after so many of its items.
    probed: Option<([u32; 2], usize, (i32, u8))>,
    /// What is to be recorded of the next scene that the clocked array draws.
    pub(super) waves: Option<Waves>,
    /// The last waveform recorded.
    pub(super) recorded: Option<Vec<u8>>,
}

/// The rows that functional drawing needs, elements each.
struct Pitches {
    depth: usize,
    bits: usize,
}

impl Pitches {
    fn of(target: &Target) -> Pitches {
        let chunks = (target.colour.width as usize).div_ceil(CHUNK);
        let depth = target.depth.map_or(chunks * CHUNK, |depth| depth.pitch as usize / 4);
        Pitches { depth, bits: chunks }
    }
}

/// Whether the scene on `target` is held back until it ends.
pub(super) fn is_held(target: &Target) -> bool {
    target.fidelity == Fidelity::Clocked
}

impl Sorted {
    /// Gives memory back, but for what an instrument is set to and what it has seen: it belongs to the host.
    pub(super) fn power_off(&mut self) {
        *self = Sorted { waves: self.waves.take(), recorded: self.recorded.take(), ..Sorted::default() };
    }

    /// A scene begins.
    pub(super) fn begin(&mut self) {
        self.used = false;
        self.drawn = false;
        self.carried = false;
        self.spans = 0;
        self.looked_up = ShadingCounts::default();
        self.stencil = StencilCounts::default();
        self.background = Background::default();
        self.held.reset();
        self.probed = None;
    }

    /// Makes room before the first command of a scene.
    fn make_ready(&mut self, target: &Target) {
        if std::mem::replace(&mut self.used, true) || is_held(target) {
            return;
        }
        let (pitches, height) = (Pitches::of(target), target.colour.height as usize);
        for bits in [&mut self.winner, &mut self.late] {
            bits.clear();
            bits.resize(pitches.bits * height, 0);
        }
        self.costs.clear();
        self.prices.clear();
        self.tokens.clear();
        self.tokens.resize(height, 0);
        if target.depth.is_none() {
            // Filled by the clear that follows, as a rule: see `clear` and `before_draw`.
            self.depth.resize(pitches.depth * height, 0);
        }
        self.sorts = (target.hidden_surface == HiddenSurface::Tile).then(|| Sorts::new(target));
    }

    /// Before the first draw: depths that nobody has given are the farthest.
    fn before_draw(&mut self, target: &Target) {
        self.make_ready(target);
        let first = !std::mem::replace(&mut self.drawn, true);
        let unknown = !self.carried && target.depth.is_none() && self.background.depth.is_none();
        if first && unknown && !is_held(target) {
            self.depth.fill(target.depth_format.maximum() as i32);
        }
    }

    /// A clear. One of all pixels before anything is drawn is the scene's background; any other is drawn
    /// like a rectangle that passes always.
    pub(super) fn clear(&mut self, memory: &mut [u32], target: &Target, clear: &Clear) {
        let area = clear.area;
        if area.x >= area.right || area.y >= area.bottom {
            return;
        }
        self.make_ready(target);
        let depth = clear.depth.map(|depth| depth as i32);
        let background = area == crate::memory::areas::whole(&target.colour) && !self.drawn;
        if !background {
            self.before_draw(target);
        }
        if is_held(target) {
            self.held.clear(background, area, clear.colour, depth, clear.stencil);
            return;
        }
        if background {
            self.background.add(clear.colour, depth, clear.stencil);
        } else {
            self.draw_rectangle(target, &area, clear.colour.is_some());
        }
        if let Some(value) = clear.stencil {
            stencil::fill(memory, target, &area, value);
        }
        let pitches = Pitches::of(target);
        let (colours, depths) = surfaces(memory, target);
        if let Some(colour) = clear.colour {
            fill_colour(colours, &target.colour, &area, colour);
        }
        if let Some(depth) = depth {
            let depths = if target.depth.is_some() { depths } else { &mut self.depth[..] };
            fill_depth(depths, pitches.depth, &area, depth, |_| false);
        }
    }

    /// Notes a rectangle that passes always.
    fn draw_rectangle(&mut self, target: &Target, area: &Rectangle, coloured: bool) {
        for tokens in &mut self.tokens[area.y as usize..area.bottom as usize] {
            *tokens += 1;
        }
        if let Some(sorts) = &mut self.sorts {
            sorts.clear(*area);
        }
        if coloured {
            let pitch = Pitches::of(target).bits;
            for y in area.y as usize..area.bottom as usize {
                let row = y * pitch..(y + 1) * pitch;
                for (chunk, (winner, late)) in self.winner[row.clone()].iter_mut().zip(&mut self.late[row]).enumerate()
                {
                    let mask = chunk_mask(chunk, area);
                    *winner |= mask;
                    *late &= !mask;
                }
                if !self.costs.is_empty() {
                    let row = y * pitch * CHUNK;
                    self.costs[row + area.x as usize..row + area.right as usize].fill(0);
                }
            }
        }
    }

    /// The rows of depths that a draw works on: elements from a row to the next.
    pub(super) fn depth_pitch(target: &Target) -> usize {
        Pitches::of(target).depth
    }

    /// Surfaces for a functional draw, from band `first` on.
    pub(super) fn planes<'m>(
        &'m mut self,
        memory: &'m mut [u32],
        target: &Target,
        setting: &Setting,
        first: usize,
    ) -> Surfaces<'m> {
        let pitches = Pitches::of(target);
        let cost = setting.shading.as_ref().map_or(0, |shading| self.price(target, shading.pixel.cost()));
        let (colours, depths, values) = all_surfaces(memory, target);
        let depths = if target.depth.is_some() { depths } else { &mut self.depth[..] };
        Surfaces {
            stencil: setting.stencil.map_or(Plane::none(), |setting| Plane::new(values, setting.pitch, first)),
            colour: Plane::new(colours, setting.colour_pitch, first),
            depth: if setting.test.is_some() { Plane::new(depths, pitches.depth, first) } else { Plane::none() },
            words: Plane::none(),
            sight: Sight {
                winner: Plane::new(&mut self.winner, pitches.bits, first),
                late: Plane::new(&mut self.late, pitches.bits, first),
                tokens: Plane::new(&mut self.tokens, 1, first),
                costs: Plane::new(&mut self.costs, pitches.bits * CHUNK, first),
                cost,
            },
        }
    }

    /// What stands for pixels that cost so much beyond interpolated colours.
    fn price(&mut self, target: &Target, cost: ShadingCounts) -> u16 {
        if self.costs.is_empty() {
            self.costs.resize(Pitches::of(target).bits * CHUNK * target.colour.height as usize, 0);
        }
        // Filters, lights and fog make fewer prices than 2^16.
        let place = self.prices.iter().position(|price| *price == cost).unwrap_or_else(|| {
            self.prices.push(cost);
            self.prices.len() - 1
        });
        place as u16 + 1
    }

    /// What all pixels seen cost beyond interpolated colours.
    fn shading(&self) -> ShadingCounts {
        let mut pixels = vec![0_u64; self.prices.len() + 1];
        self.costs.iter().for_each(|place| pixels[usize::from(*place)] += 1);
        let sums = self.prices.iter().zip(&pixels[1..]).map(|(price, pixels)| price.times(*pixels));
        sums.fold(self.looked_up, ShadingCounts::plus)
    }

    /// Where primitives of a functional draw are noted for the tile unit.
    pub(super) fn sorts(&mut self, target: &Target) -> Option<&mut Sorts> {
        self.before_draw(target);
        self.sorts.as_mut()
    }

    /// Notes the primitives of a list, where none were noted when they were assembled.
    pub(super) fn note(&mut self, target: &Target, scissor: Rectangle, list: &List) {
        if let Some(sorts) = self.sorts(target) {
            sorts.scissor(scissor);
            for (shape, number) in &list.shapes {
                match shape {
                    // The columns are the bins' business.
                    Shape::Triangle(triangle, vertices) => sorts.triangle(triangle, [0, 0], vertices, *number),
                    Shape::Line(line, vertices) => sorts.line(line, vertices, *number),
                    Shape::Point(point, vertex) => sorts.point(point, vertex, *number),
                }
            }
        }
    }

    /// Adds events of a functional draw.
    pub(super) fn add(&mut self, counts: &TileCounts, setting: &Setting) {
        self.spans += counts.spans;
        self.stencil = self.stencil.plus(counts.stencil);
        self.looked_up = self.looked_up.plus(setting.looked_up(counts.covered, counts.holes));
    }

    /// Holds primitives back.
    pub(super) fn hold(&mut self, target: &Target, setting: &Setting, list: &List) {
        self.before_draw(target);
        let (test, interpolation, scissor) = (setting.test, setting.interpolation, setting.scissor);
        let stencil = setting.stencil.map(|setting| setting.rule);
        let draw = HeldDraw { test, interpolation, shading: None, scissor, stencil };
        self.held.add(&draw, list, |number| HeldShading::of(setting, number));
    }

    /// No more primitives can be held back.
    pub(super) fn full(&self) -> bool {
        self.held.full()
    }

    /// Depth and stencil value at pixel (`x`, `y`) as they stand.
    pub(super) fn values_at(&mut self, memory: &[u32], target: &Target, x: u32, y: u32) -> (i32, u8) {
        let value = stencil::value_at(memory, target, x, y);
        let pitch = Pitches::of(target).depth;
        let at = y as usize * pitch + x as usize;
        let surface = target.depth.map(|depth| memory.get(depth.base as usize / 4 + at).copied().unwrap_or(0) as i32);
        let maximum = target.depth_format.maximum() as i32;
        if !is_held(target) {
            let known = self.drawn || self.carried || self.background.depth.is_some();
            let own = if known { self.depth.get(at).copied() } else { None };
            return (surface.or(own).unwrap_or(maximum), value);
        }
        let surface = surface.or_else(|| if self.carried { self.depth.get(at).copied() } else { None });
        let (pixel, mut done, mut values) = self.probed.unwrap_or(([x, y], 0, (0, 0)));
        if done == 0 || pixel != [x, y] {
            let background = &self.held.background;
            let depth = background.depth.or(surface).unwrap_or(maximum);
            (done, values) = (0, (depth, background.stencil.unwrap_or(value)));
        }
        for item in &self.held.items[done..] {
            values = after(item, &self.held.draws, target, [x as i32, y as i32], values);
        }
        self.probed = Some(([x, y], self.held.items.len(), values));
        values
    }

    /// The scene has begun in earnest.
    pub(super) fn is_used(&self) -> bool {
        self.used
    }

    /// Layers are to be composed in the midst of a scene: what there is of it is drawn, and the scene begins anew with
    /// that.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was drawn until then stays.
    pub(super) fn draw_so_far(
        &mut self,
        memory: &mut [u32],
        target: &Target,
        level: Option<Level>,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        let drawn = self.end(memory, target, level, true, account, stop);
        self.begin();
        self.carried = true;
        drawn
    }

    /// Frame buffer, depths and stencil values of what is drawn, for layers: elements from a row of depths to the next.
    pub(super) fn picture<'m>(
        &'m mut self,
        memory: &'m mut [u32],
        target: &Target,
    ) -> (&'m mut [u32], &'m mut [i32], &'m mut [u8], usize) {
        let (colours, depths, values) = all_surfaces(memory, target);
        let depths = if target.depth.is_some() { depths } else { &mut self.depth[..] };
        (colours, depths, values, Pitches::of(target).depth)
    }

    /// The scene ends: a scene that was held back is drawn, and its events are charged. With `layers` somebody asks for
    /// its depths.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was drawn until then stays.
    pub(super) fn end(
        &mut self,
        memory: &mut [u32],
        target: &Target,
        level: Option<Level>,
        layers: bool,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        if !self.used {
            return Ok(());
        }
        let (colours, depths, values) = all_surfaces(memory, target);
        let mut depths = if target.depth.is_none() && is_held(target) && (layers || self.carried) {
            let Pitches { depth: pitch, .. } = Pitches::of(target);
            self.depth.resize(pitch * target.colour.height as usize, 0);
            if !self.carried {
                self.depth.fill(target.depth_format.maximum() as i32);
            }
            Depths { rows: &mut self.depth, pitch, stencil: StencilRows::none() }
        } else {
            Depths::of(target, depths)
        };
        if let Some(plane) = target.stencil.filter(|_| is_held(target) && self.held.asks_for_stencil()) {
            depths.stencil = StencilRows { rows: values, pitch: plane.pitch as usize };
        }
        match (target.hidden_surface, is_held(target)) {
            (HiddenSurface::Systolic, true) => {
                let mut waves = self.waves.take();
                let (counts, stopped) =
                    systolic::draw_until(&self.held, target, colours, depths, level, waves.as_mut(), stop);
                self.recorded = waves.map(Waves::finish).or(self.recorded.take());
                systolic::charge(&counts, account);
                return stopped.map_or(Ok(()), Err);
            }
            (HiddenSurface::Systolic, false) => systolic::charge(&self.systolic_counts(target), account),
            (_, true) => {
                let (counts, stopped) = scene::draw_until(&self.held, target, colours, depths, stop);
                tile::charge(&counts, account);
                return stopped.map_or(Ok(()), Err);
            }
            (_, false) => {
                let (grid, pitch) = (Grid::new(target), Pitches::of(target).bits);
                let (spans, shaded, shading) = (self.spans, ones(&self.late), self.shading());
                let pixels = PixelCounts { spans, shaded, shading, stencil: self.stencil };
                let won = |column, row| pixels_of_tile(&self.winner, pitch, &grid.pixels(column, row));
                if let Some(sorts) = &self.sorts {
                    tile::charge(&sorts.finish(target, &self.background, pixels, won), account);
                }
            }
        }
        Ok(())
    }

    /// The systolic array's events, from what was noted.
    fn systolic_counts(&self, target: &Target) -> SystolicCounts {
        let width = target.colour.width;
        let pixels = u64::from(width) * u64::from(target.colour.height);
        let (depth, background) = (target.depth.is_some(), &self.background);
        SystolicCounts {
            tokens: self.tokens.iter().map(|&tokens| u64::from(tokens)).sum(),
            clocks: systolic::closed_form(&self.tokens, width, &target.systolic),
            spans: self.spans,
            reads: if depth && background.depth.is_none() { pixels } else { 0 },
            writes: if depth { pixels } else { 0 },
            colours: if background.colour.is_some() { pixels } else { ones(&self.winner) },
            shaded: ones(&self.late),
            shading: self.shading(),
            stencil: self.stencil,
        }
    }
}

/// Bits that are set in a plane.
fn ones(bits: &[u16]) -> u64 {
    bits.iter().map(|chunk| u64::from(chunk.count_ones())).sum()
}

/// The bits of chunk `chunk` of a row that lie in the columns of `area`.
fn chunk_mask(chunk: usize, area: &Rectangle) -> u16 {
    let first = (chunk * CHUNK) as u32;
    let below = |column: u32| ((1_u32 << column.saturating_sub(first).min(CHUNK as u32)) - 1) as u16;
    below(area.right) & !below(area.x)
}

/// Depth and stencil value of pixel (`x`, `y`) after an item, `depth` and `value` before it.
fn after(
    item: &Item,
    draws: &[HeldDraw],
    target: &Target,
    [x, y]: [i32; 2],
    (depth, mut value): (i32, u8),
) -> (i32, u8) {
    let inside = |area: &Rectangle| {
        (area.x as i32..area.right as i32).contains(&x) && (area.y as i32..area.bottom as i32).contains(&y)
    };
    match item {
        Item::Clear { area, depth: cleared, stencil, .. } if inside(area) => {
            (cleared.unwrap_or(depth), stencil.unwrap_or(value))
        }
        Item::Clear { .. } => (depth, value),
        Item::Primitive(shape, draw) => {
            let draw = &draws[*draw as usize];
            let decides = draw.test.is_some_and(|test| test.write) || draw.stencil.is_some();
            if !decides || !inside(&draw.scissor) || !meets(shape, x, y) {
                return (depth, value);
            }
            if draw.has_holes() && colour_plane(shape, &draw.shade()).is_hole(x, y) {
                return (depth, value);
            }
            let plane = shape.plane(target.depth_format);
            let z = plane.stored(plane.value(x, y), below(target.depth_format));
            let passes = || draw.test.is_none_or(|test| test.passes(z, depth));
            let drawn = draw.stencil_rule(shape).decide(&mut value, &mut StencilCounts::default(), passes);
            (if drawn && draw.test.is_some_and(|test| test.write) { z } else { depth }, value)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunk_mask_columns_of_the_area_only() {
        let area = Rectangle { x: 18, y: 0, right: 33, bottom: 1 };
        assert_eq!([0, 1, 2, 3].map(|chunk| chunk_mask(chunk, &area)), [0, 0xFFFC, 1, 0]);
    }
}
