//! The drawing pipeline: geometry, hidden surfaces, shading, for one draw after another.
//!
//! Duties: cuts a draw into batches, has each assembled and binned (in shares, one a host thread),
//! drawn band by band, and its events charged. Inputs: checked draws and the geometry registers.
//! Outputs: frame buffer and Z buffer in video memory, counters.
//!
//! Clocks: 4 a vertex, 8 / 6 / 1 a triangle / line / point, 4 a clip plane that cuts (see
//! [`crate::geometry`]); the rest is charged by the hidden-surface path.

pub mod bands;
mod draw_path;
mod layers_path;
mod options;
mod shading_path;
mod shadow_path;
mod sorted;
mod subpixel_path;
mod workers;
mod za_path;

use crate::built::{Key, LayerKey, LightKey, StencilKey, SubpixelKey};
use crate::geometry::GeometryRegisters;
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Assembler, GeometryCounts, List, Widths};
use crate::geometry::fetch::{Fetch, VertexLight};
use crate::geometry::transform::Transform;
use crate::hidden::stencil;
use crate::hidden::systolic::Waves;
use crate::hidden::z_buffer;
use crate::hidden::z_buffer::band::{DrawShading, Setting};
use crate::hidden::z_buffer::uniform::Uniform;
use crate::memory::VideoMemory;
use crate::memory::areas::whole;
use crate::probe::account::{Account, Clocks};
use crate::probe::pixel::PixelProbe;
use crate::shading::light::Lights;
use crate::shading::parameters::Parameters;
use crate::shading::pixel::AlphaRule;
use crate::subpixel::map::SubpixelMap;
use crate::subpixel::scene::{Scene, Taken, Taking};
use crate::subpixel::unit::Unit;
use crate::texture::store::TextureStore;
use draw_path::setting;
use fearless_simd::Level;
pub use options::{Kernel, PipelineOptions};
use rayon::prelude::*;
use shading_path::{charge_light, drawn_to, parameter_transform};
use sorted::Sorted;
use std::ops::Range;
use std::sync::Arc;
use workers::{SHARE, Wanted, Workers};
use zga_abi::format::{HiddenSurface, Topology};
use zga_abi::{Counter, Effects};
use zga_firmware::Stopped;
use zga_firmware::checked::{Clear, Draw, DrawState, Rectangle, Shadow, Target};

/// Most host threads.
const MAX_THREADS: usize = 256;

/// Geometry, hidden surfaces and shading of a card.
#[derive(Debug)]
pub struct Pipeline {
    level: Option<Level>,
    threads: usize,
    target: Option<Target>,
    workers: Workers,
    shared: Vec<Option<ScreenVertex>>,
    list: List,
    /// What the Z buffer is known to hold since its last clear.
    uniform: Option<Uniform>,
    /// The scene of a path that sorts before it draws.
    sorted: Sorted,
    /// Textures that draws have called for.
    textures: TextureStore,
    /// Bytes of texels decoded in this scene for what is held back.
    held_texels: u64,
    /// Room for what vertices carry.
    parameters: Vec<Parameters>,
    /// What the sub-pixel unit has of the scene.
    scene: Scene,
    /// The sub-pixel unit.
    unit: Unit,
    /// The layer unit.
    layers: crate::layers::unit::Unit,
    /// What has stopped a clear.
    owed: Option<Stopped>,
    /// The next scene with a grid is to be noted.
    wants_map: bool,
    /// The last one that was.
    map: Option<SubpixelMap>,
}

impl Pipeline {
    /// A pipeline without power: it owns no scratch memory and no threads until it draws.
    #[must_use]
    pub fn new(options: &PipelineOptions) -> Pipeline {
        let processors = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if options.threads == 0 { processors() } else { options.threads };
        let level = match options.kernel {
            Kernel::Specification => None,
            kernel => kernel.level().or_else(|| Kernel::Best.level()),
        };
        Pipeline {
            level,
            threads: threads.clamp(1, MAX_THREADS),
            target: None,
            workers: Workers::default(),
            shared: Vec::new(),
            list: List::default(),
            uniform: None,
            sorted: Sorted::default(),
            textures: TextureStore::default(),
            held_texels: 0,
            parameters: Vec::new(),
            scene: Scene::default(),
            unit: Unit::default(),
            layers: crate::layers::unit::Unit::default(),
            owed: None,
            wants_map: false,
            map: None,
        }
    }

    /// Begins a scene on `target`.
    pub fn begin_scene(&mut self, memory: &mut VideoMemory, target: &Target, account: &mut Account) {
        self.target = Some(*target);
        self.scene.begin();
        self.held_texels = 0;
        self.owed = None;
        // Another frame buffer could lie over the Z buffer that is remembered.
        self.uniform = self.uniform.take().filter(|uniform| uniform.is_of(target));
        if target.hidden_surface == HiddenSurface::Za {
            let (mut parts, areas) = memory.parts();
            areas.begin_scene(&mut parts, target, account);
        } else if !memory.areas().all().is_empty() {
            let (mut parts, areas) = memory.parts();
            areas.release_target(&mut parts, target, account);
        }
        if target.hidden_surface != HiddenSurface::ZBuffer {
            self.uniform = None;
            self.sorted.begin();
        }
        self.remember(memory);
    }

    /// Goes on with a scene on `target` that a snapshot was taken in.
    pub fn resume_scene(&mut self, target: &Target) {
        self.target = Some(*target);
        self.scene.begin();
        self.uniform = None;
    }

    /// Ends the scene; a path that holds it back draws it now, then pixels in `shadow` are darkened, then layers composed.
    /// `stop` is asked with the clocks that takes.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was drawn until then stays.
    pub fn end_scene(
        &mut self,
        memory: &mut VideoMemory,
        shadow: Option<&Shadow>,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        let Some(target) = self.target.take() else {
            return Ok(());
        };
        let begun = account.total();
        let drawn = match target.hidden_surface {
            HiddenSurface::ZBuffer | HiddenSurface::Za => Ok(()),
            HiddenSurface::Systolic | HiddenSurface::Tile => {
                let layers = self.layers_of(&target).is_some();
                self.sorted.end(memory.drawing(), &target, self.level, layers, account, stop)
            }
        };
        let drawn = match (shadow, StencilKey::built()) {
            (Some(shadow), Some(_)) => {
                drawn.and_then(|()| shadow_path::darken(memory, &target, shadow, account, begun, stop))
            }
            _ => drawn,
        };
        let spent = account.total().0 - begun.0;
        let stop = |clocks: Clocks| stop(Clocks(spent + clocks.0));
        let resolved = drawn
            .and_then(|()| self.resolve_subpixels(memory, &target, account, &stop))
            .and_then(|()| self.compose_layers(memory, &target, account, &stop));
        if target.hidden_surface == HiddenSurface::Za {
            memory.parts().1.end_scene();
        }
        resolved
    }

    /// Forgets what a scene took, and keeps the memory of its parameters for the next draw.
    fn close_scene(&mut self) {
        if let Some(vertices) = self.scene.take_parameters() {
            self.parameters = vertices;
        }
        self.scene.begin();
    }

    /// Gives scratch memory and threads back. Which blocks are logically cleared is no scratch: it stays.
    pub fn power_off(&mut self, memory: &mut VideoMemory) {
        self.power_texture_off(memory);
        self.workers = Workers::default();
        self.shared = Vec::new();
        self.list = List::default();
        self.uniform = None;
        self.sorted.power_off();
        self.power_subpixels_off();
        self.power_layers_off();
        self.power_scene_off();
    }

    /// Gives the memory back that scenes wait in.
    pub fn power_scene_off(&mut self) {
        self.scene = Scene::default();
    }

    /// Gives the texture unit's memory back.
    pub fn power_texture_off(&mut self, memory: &mut VideoMemory) {
        self.textures.power_off(memory);
        self.parameters = Vec::new();
    }

    /// Gives the sub-pixel unit's memory back.
    pub fn power_subpixels_off(&mut self) {
        self.unit = Unit::default();
    }

    /// Gives the layer unit's memory back.
    pub fn power_layers_off(&mut self) {
        self.layers = crate::layers::unit::Unit::default();
    }

    /// Has the clocked systolic array's next scene recorded.
    pub fn record(&mut self, waves: Waves) {
        self.sorted.waves = Some(waves);
    }

    /// The waveform of the last scene recorded, given away.
    pub fn take_recorded(&mut self) -> Option<Vec<u8>> {
        self.sorted.recorded.take()
    }

    /// Has the pixels noted that the sub-pixel unit takes up in the next scene with a grid.
    pub fn record_subpixels(&mut self) {
        self.wants_map = true;
    }

    /// The last map noted, given away.
    pub fn take_subpixels(&mut self) -> Option<SubpixelMap> {
        self.map.take()
    }

    /// A scene is open whose state a snapshot does not hold.
    #[must_use]
    pub fn holds_scene(&self) -> bool {
        let sorted = self.target.is_some_and(|target| target.is_sorted()) && self.sorted.is_used();
        sorted || (self.target.is_some() && !self.scene.items.is_empty())
    }

    /// Has the memory count the changes by others to what is remembered of it.
    fn remember(&self, memory: &mut VideoMemory) {
        let uniform = self.uniform.as_ref().map_or(0..0, Uniform::words);
        let areas = memory.areas().remembered();
        let both = match (uniform.is_empty(), areas.is_empty()) {
            (true, _) => areas,
            (_, true) => uniform,
            _ => uniform.start.min(areas.start)..uniform.end.max(areas.end),
        };
        memory.remember(both);
    }

    /// Clears planes of the target.
    /// What `stop` says of the layers that are composed before it is said by the next draw, or when the scene ends.
    pub fn clear(
        &mut self,
        memory: &mut VideoMemory,
        clear: &Clear,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) {
        let Some(target) = self.target else {
            return;
        };
        self.take_clear(memory, &target, clear, account);
        self.clear_layers(memory, &target, clear, account, stop);
        match target.hidden_surface {
            HiddenSurface::ZBuffer => self.clear_z_buffer(memory, &target, clear, account),
            HiddenSurface::Za => za_path::clear(memory, &target, clear, account),
            HiddenSurface::Systolic | HiddenSurface::Tile => self.sorted.clear(memory.drawing(), &target, clear),
        }
        drawn_to(memory, &target);
        self.remember(memory);
    }

    fn clear_z_buffer(&mut self, memory: &mut VideoMemory, target: &Target, clear: &Clear, account: &mut Account) {
        let foreign = memory.foreign();
        let memory = memory.drawing();
        let known = self.uniform.take();
        match (clear.depth, target.depth) {
            (None, _) | (_, None) => {
                z_buffer::clear(memory, target, clear, None, account);
                self.uniform = known;
            }
            (Some(value), Some(surface)) if clear.area == whole(&target.colour) && self.level.is_some() => {
                let mut uniform = Uniform::before_clear(known, target, surface, value, foreign);
                z_buffer::clear(memory, target, clear, Some(&uniform), account);
                uniform.cleared(foreign);
                self.uniform = Some(uniform);
            }
            _ => z_buffer::clear(memory, target, clear, None, account),
        }
    }

    /// Stencil value of a pixel as the path has it; 0 without any.
    fn stencil_at(&mut self, memory: &VideoMemory, x: u32, y: u32) -> u8 {
        let inside = |t: &Target| t.stencil.is_some() && x < t.colour.width && y < t.colour.height;
        match self.target.filter(inside) {
            None => 0,
            Some(target) if target.is_sorted() => self.sorted.values_at(memory.words(), &target, x, y).1,
            Some(target) => stencil::value_at(memory.words(), &target, x, y),
        }
    }

    /// Depth of a pixel as the path has it; 0 without any.
    pub fn depth_at(&mut self, memory: &VideoMemory, x: u32, y: u32) -> u32 {
        let Some(target) = self.target.filter(|t| t.has_depth() && x < t.colour.width && y < t.colour.height) else {
            return 0;
        };
        match target.hidden_surface {
            HiddenSurface::Systolic | HiddenSurface::Tile => {
                self.sorted.values_at(memory.words(), &target, x, y).0 as u32
            }
            HiddenSurface::ZBuffer | HiddenSurface::Za => {
                let word = target.depth.map(|depth| (depth.base / 4 + y * (depth.pitch / 4) + x) as usize);
                let stored = word.and_then(|word| memory.words().get(word)).copied().unwrap_or(0);
                za_path::cleared_depth(memory, &target, x, y).unwrap_or(stored)
            }
        }
    }

    /// Draws. Between batches `stop` is asked with the clocks this draw has taken so far.
    ///
    /// # Errors
    /// [`Stopped`] as `stop` says; what was drawn until then stays.
    #[expect(clippy::too_many_arguments, reason = "the unit's inputs; a struct would only be taken apart again")]
    pub fn draw(
        &mut self,
        memory: &mut VideoMemory,
        geometry: &GeometryRegisters,
        state: &DrawState,
        draw: &Draw<'_>,
        mut probe: Option<&mut PixelProbe>,
        account: &mut Account,
        stop: &dyn Fn(Clocks) -> Option<Stopped>,
    ) -> Result<(), Stopped> {
        let Some(target) = self.target else {
            return Ok(());
        };
        if let Some(stopped) = self.owed {
            return Err(stopped);
        }
        let size = [target.colour.width, target.colour.height];
        let transform = Transform::new(geometry, state.effects, size, target.depth_format, target.subpixel_bits);
        let shading = self.shading(memory, &target, geometry, &transform, state, draw, account)?;
        let per_vertex = state.light.filter(|light| !light.per_pixel && LightKey::built().is_some());
        let light = per_vertex.map(|light| VertexLight {
            lights: Lights::read(memory.words(), &light),
            transform: parameter_transform(geometry, &transform, state, draw),
        });
        let mut setting = setting(&target, state);
        let begun = account.total();
        self.keep(memory, &target, account);
        let mut path = self.path(memory, &target, &setting, account);
        let masks = state.effects.contains(Effects::ANTI_ALIAS);
        let masks = masks.then_some(Widths { line: state.line_width, point: state.point_size });
        let fetch = Fetch::new(memory.words(), draw, state.material_colour, light.as_ref());
        let primitives = draw.topology.primitives(fetch.elements() as u32);
        let shared = fetch.indexed() || fetch.is_lit();
        if shared {
            self.transform_shared(&fetch, &transform);
        }
        if fetch.indexed() {
            let vertices = fetch.vertices() as u64;
            account.add(Counter::GeometryVertices, vertices);
            account.charge(Counter::CyclesGeometry, Clocks(4 * vertices));
            charge_light(light.as_ref(), vertices, account);
        }
        let fast = self.level.filter(|_| probe.is_none() && path.is_fast(target.fidelity, setting.stencil.is_some()));
        let mut first = 0;
        while first < primitives {
            if self.scene.full() {
                return Err(Stopped::SceneFull);
            }
            let taken_before = self.scene.items.len();
            let alphas = shading.as_ref().map_or(AlphaRule::Vertices, |shading| shading.alphas());
            let taken = match target.subpixel {
                Some(_) => SubpixelKey::built()
                    .and_then(|_| self.scene.draw(state, setting.test, setting.interpolation, alphas)),
                None => {
                    LayerKey::built().and_then(|_| self.scene.wait(state, setting.test, setting.interpolation, alphas))
                }
            };
            let assembler = Assembler {
                fetch: Fetch::new(memory.words(), draw, state.material_colour, light.as_ref()),
                transform: &transform,
                format: target.depth_format,
                topology: draw.topology,
                shared: shared.then_some(&self.shared[..]),
                masks,
            };
            let (before, counts);
            (before, (first, counts)) = (
                first,
                match fast {
                    Some(_) => {
                        let sorts = if path.is_sorted() { self.sorted.sorts(&target) } else { None };
                        let wanted = Wanted { sorts, taken, numbers: shading.is_some() };
                        self.workers.assemble(
                            self.threads,
                            &assembler,
                            setting.scissor,
                            size,
                            first..primitives,
                            wanted,
                        )
                    }
                    None => list(&mut self.list, &assembler, setting.scissor, first..primitives, taken),
                },
            );
            let assembled = charge_geometry(&counts, draw, account);
            charge_light(light.as_ref(), assembled, account);
            if let Some(pixel) = &shading {
                let fetch = Fetch::new(memory.words(), draw, state.material_colour, None);
                let mut vertices = std::mem::take(&mut self.parameters);
                vertices.clear();
                vertices.extend((before..first).map(|number| fetch.primitive(draw.topology, number)));
                let both = Arc::new(DrawShading { pixel: Arc::clone(pixel), first: before, vertices });
                self.scene.shade(taken_before, &both);
                setting.shading = Some(both);
                path.set_shading(&setting);
            }
            match fast {
                Some(level) => self.draw_bins(level, memory, &target, &setting, &path, account),
                None => {
                    if let Some(probe) = probe.as_deref_mut() {
                        let stored = self.depth_at(memory, probe.x, probe.y) as i32;
                        let held = (stored, self.stencil_at(memory, probe.x, probe.y));
                        probe.follow(&setting, state.depth_function, state.tag, &self.list.shapes, held);
                    }
                    self.draw_list(memory, &target, &setting, &path, account)?;
                }
            }
            debug_assert!(first > before);
            path.set_shading(&Setting { shading: None, ..setting.clone() });
            if let Some(Ok(spent)) = setting.shading.take().map(Arc::try_unwrap) {
                self.parameters = spent.vertices;
            }
            if let Some(stopped) = stop(Clocks(account.total().0 - begun.0)) {
                return Err(stopped);
            }
        }
        if let Some(probe) = probe {
            probe.draw = probe.draw.wrapping_add(1);
        }
        drawn_to(memory, &target);
        Ok(())
    }

    /// Transforms each vertex of a draw once.
    fn transform_shared(&mut self, fetch: &Fetch<'_>, transform: &Transform) {
        let count = fetch.vertices();
        self.shared.clear();
        match self.workers.pool_for(self.threads, count >= 2 * SHARE as usize) {
            Some(pool) => {
                let vertices = (0..count).into_par_iter().map(|v| transform.inside(&fetch.lit_vertex(v)));
                pool.install(|| vertices.collect_into_vec(&mut self.shared));
            }
            // A closure of its own, in the loop: one that both ways share is a call a vertex, and a copy.
            None => self.shared.extend((0..count).map(
                #[inline(always)]
                |v| transform.inside(&fetch.lit_vertex(v)),
            )),
        }
    }
}

/// Assembles primitives into a plain list.
fn list(
    list: &mut List,
    assembler: &Assembler<'_>,
    scissor: Rectangle,
    range: Range<u32>,
    taken: Option<Taken<'_>>,
) -> (u32, GeometryCounts) {
    let mut counts = GeometryCounts::default();
    list.reset(scissor);
    let first = assembler.run(range, &mut Taking { sink: list, taken }, &mut counts);
    (first, counts)
}

/// Charges the geometry unit's events of one batch; returns how many vertices were transformed for it.
fn charge_geometry(counts: &GeometryCounts, draw: &Draw<'_>, account: &mut Account) -> u64 {
    let (vertices, set_up) = match draw.topology {
        Topology::Triangles => (3, 8),
        Topology::Lines => (2, 6),
        Topology::LineStrip => (1, 6),
        Topology::Points => (1, 1),
    };
    let vertices = if draw.indices.is_some() { 0 } else { counts.primitives * vertices };
    account.add(Counter::GeometryVertices, vertices);
    account.add(Counter::GeometryPrimitives, counts.primitives);
    account.add(Counter::GeometryClipped, counts.clipped);
    account.add(Counter::GeometryDiscarded, counts.discarded);
    let clocks = 4 * vertices + set_up * counts.primitives + 4 * counts.cuts;
    account.charge(Counter::CyclesGeometry, Clocks(clocks));
    vertices
}
