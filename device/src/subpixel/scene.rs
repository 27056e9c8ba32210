//! A scene as the unit takes it: all of its primitives and clears, in order of submission.
//!
//! Duties: takes what is assembled while the hidden-surface path draws it; knows from which rule the order of opaque
//! fragments follows, and what pixels were before the first of them. Inputs from: the assembly stage, clears. Outputs
//! to: [`super::band`], [`super::specification`], [`crate::layers`]. Clocks: none of its own.
//!
//! Without a grid the unit has no part in a scene. What may be translucent is taken here all the same, and nothing else:
//! it waits for [`crate::layers`], with the clears that take some of it back.

use super::piece::extent;
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Point, Sink};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::band::DrawShading;
use crate::shading::parameters::Parameters;
use crate::shading::pixel::AlphaRule;
use crate::shading::plane::{Interpolation, Shade};
use std::sync::Arc;
use zga_abi::Effects;
use zga_abi::format::{BlendMode, DepthFunction};
use zga_firmware::checked::{Clear, DrawState, Rectangle, StencilTest};

/// Most primitives and clears of a scene: 72 MiB, less for the draws, and at most 192 MiB for what their vertices carry.
pub const ITEM_LIMIT: usize = 1 << 20;

/// What an item covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The samples inside a triangle.
    Masked,
    /// All samples of the pixels whose centres lie in a triangle.
    Triangle,
    /// All samples of a line's pixels; the third vertex repeats the second.
    Line,
    /// All samples of a point's pixel; one vertex, three times.
    Point,
    /// All samples of a rectangle: a clear. The vertices mean nothing.
    Clear,
}

/// A primitive or a clear.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Snapped vertices.
    pub vertices: [ScreenVertex; 3],
    /// Its place in [`Scene::draws`].
    pub draw: u32,
    /// Its number in the draw's [`ItemDraw::shading`].
    pub number: u32,
    /// What it covers.
    pub kind: Kind,
}

/// What the items of a draw share, or what a clear does.
#[derive(Clone, Debug, PartialEq)]
pub struct ItemDraw {
    /// Depth test; `None` where depth is not called for: everything passes, no depth is stored.
    pub test: Option<DepthTest>,
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// What interpolated colours go through.
    pub shading: Option<Arc<DrawShading>>,
    /// Fragments with an alpha below 255 are translucent.
    pub blend: bool,
    /// How they are combined with what lies behind them.
    pub mode: BlendMode,
    /// Object tag.
    pub tag: u32,
    /// Stencil test of layers without a grid, which change no stencil value.
    pub stencil: Option<StencilTest>,
    /// Pixels that may change, inside the target.
    pub scissor: Rectangle,
    /// Of a clear: RGBA to be written.
    pub colour: Option<u32>,
    /// Of a clear: depth to be stored.
    pub depth: Option<i32>,
}

impl ItemDraw {
    /// Whether the state that items are drawn with is that of `other`.
    #[must_use]
    fn is_like(&self, other: &ItemDraw) -> bool {
        let [mine, others] = [self, other].map(|draw| draw.shading.as_ref().map(|shading| &shading.pixel));
        mine == others
            && (self.test, self.interpolation, self.mode, self.tag)
                == (other.test, other.interpolation, other.mode, other.tag)
    }

    /// How the pixels of item `number` get their colours.
    #[must_use]
    pub fn shade(&self, number: u32) -> Shade<'_> {
        Shade { interpolation: self.interpolation, pixel: self.shading.as_ref().map(|shading| shading.of(number)) }
    }

    /// What decides whether an item is translucent.
    fn translucency(&self) -> Translucency {
        let alphas = self.shading.as_ref().map_or(AlphaRule::Vertices, |shading| shading.pixel.alphas());
        Translucency { interpolation: self.interpolation, mode: self.mode, alphas }
    }

    /// Whether an item with these vertices hides what lies behind it, wherever it is not a hole.
    #[must_use]
    pub fn is_opaque(&self, vertices: &[ScreenVertex]) -> bool {
        !self.blend || self.translucency().is_opaque(vertices)
    }

    /// Whether fragments of an item with these vertices can hide what lies behind them.
    #[must_use]
    pub fn may_hide(&self, vertices: &[ScreenVertex]) -> bool {
        !self.blend || self.translucency().may_hide(vertices)
    }

    /// Whether an item with these vertices changes nothing.
    #[must_use]
    pub fn is_nothing(&self, vertices: &[ScreenVertex]) -> bool {
        self.blend && self.translucency().is_nothing(vertices)
    }

    /// Whether one of its fragments with this alpha hides what lies behind it.
    #[must_use]
    pub fn hides(&self, alpha: u32) -> bool {
        !self.blend || (self.mode == BlendMode::Alpha && alpha == 255)
    }

    /// Whether shading does anything for their pixels.
    #[must_use]
    pub fn is_shaded(&self) -> bool {
        self.interpolation != Interpolation::Flat || self.shading.is_some()
    }

    /// Whether items can have holes.
    #[must_use]
    pub fn has_holes(&self) -> bool {
        self.shading.as_ref().is_some_and(|shading| shading.pixel.punch_through().is_some())
    }

    /// A draw that is opaque and has no tag.
    fn new(test: Option<DepthTest>, interpolation: Interpolation, mode: BlendMode, scissor: Rectangle) -> ItemDraw {
        ItemDraw {
            test,
            interpolation,
            shading: None,
            blend: false,
            mode,
            tag: 0,
            stencil: None,
            scissor,
            colour: None,
            depth: None,
        }
    }
}

/// What the pixels of a plane are before the first item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Base<T> {
    /// Nobody has said yet.
    Unknown,
    /// The same for all.
    Uniform(T),
    /// One each, row by row without gaps.
    Each(Vec<T>),
}

impl<T: Copy + Default> Base<T> {
    /// Value of pixel `at`, counted row by row.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, at: usize) -> T {
        match self {
            Base::Unknown => T::default(),
            Base::Uniform(value) => *value,
            Base::Each(values) => values[at],
        }
    }
}

/// From which rule it follows what of the opaque is seen, so far as one holds for a whole scene. With one, a fragment
/// that another hides wholly need never be looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Every draw tests for nearer, or nearer or equal, and stores: the nearest is seen.
    Nearest,
    /// No draw has depths: the last is seen.
    Last,
    /// Any other: the order of submission decides each test.
    InOrder,
}

/// The open scene.
#[derive(Debug)]
pub struct Scene {
    /// In order of submission.
    pub items: Vec<Item>,
    /// State of the draws, and clears.
    pub draws: Vec<ItemDraw>,
    /// RGBA before the first item.
    pub colour: Base<u32>,
    /// Depth before the first item.
    pub depth: Base<i32>,
    /// A draw has called for masks or layers.
    pub called: bool,
    /// A clear found no room: the scene cannot be resolved.
    pub overflowed: bool,
    /// Rule of the draws so far; none yet.
    rule: Option<Rule>,
}

impl Default for Scene {
    fn default() -> Self {
        Scene {
            items: Vec::new(),
            draws: Vec::new(),
            colour: Base::Unknown,
            depth: Base::Unknown,
            called: false,
            overflowed: false,
            rule: None,
        }
    }
}

impl Scene {
    /// A scene begins.
    pub fn begin(&mut self) {
        self.items.clear();
        self.draws.clear();
        (self.colour, self.depth) = (Base::Unknown, Base::Unknown);
        (self.called, self.overflowed, self.rule) = (false, false, None);
    }

    /// What decides between the opaque fragments of the scene.
    #[must_use]
    pub fn rule(&self) -> Rule {
        let rule = self.rule.unwrap_or(Rule::InOrder);
        // A draw that blends counts as one that stores, which its opaque fragments must do.
        let stores = |draw: &ItemDraw| draw.test.is_none_or(|test| test.write);
        let opaque = |item: &Item| self.draws[item.draw as usize].may_hide(&item.vertices);
        if rule == Rule::Nearest
            && !self.draws.iter().all(stores)
            && self.items.iter().any(|item| !stores(&self.draws[item.draw as usize]) && opaque(item))
        {
            return Rule::InOrder;
        }
        rule
    }

    /// Takes no more.
    #[must_use]
    pub fn full(&self) -> bool {
        self.items.len() >= ITEM_LIMIT
    }

    /// Begins a draw: where its items go. `None` if it can change nothing.
    pub fn draw(
        &mut self,
        state: &DrawState,
        test: Option<DepthTest>,
        interpolation: Interpolation,
        alphas: AlphaRule,
    ) -> Option<Taken<'_>> {
        let area = state.scissor;
        let never = test.is_some() && state.depth_function == DepthFunction::Never;
        if never || area.x >= area.right || area.y >= area.bottom {
            return None;
        }
        let blend = state.effects.contains(Effects::BLEND);
        let masked = state.effects.contains(Effects::ANTI_ALIAS);
        let draw = ItemDraw { blend, tag: state.tag, ..ItemDraw::new(test, interpolation, state.blend, area) };
        self.called |= blend || masked;
        let rule = match test {
            None => Rule::Last,
            Some(test) if test.less && !test.greater && (test.write || blend) => Rule::Nearest,
            Some(_) => Rule::InOrder,
        };
        self.add_rule(rule);
        let draw = self.place(draw);
        let translucent = blend.then_some(Translucency { interpolation, mode: state.blend, alphas });
        Some(Taken { items: &mut self.items, draw, masked, translucent, without_grid: None })
    }

    /// Begins a draw without a grid: where that of it which may be translucent waits. `None` if all of it is opaque.
    pub fn wait(
        &mut self,
        state: &DrawState,
        test: Option<DepthTest>,
        interpolation: Interpolation,
        alphas: AlphaRule,
    ) -> Option<Taken<'_>> {
        let blend = state.effects.contains(Effects::BLEND);
        // What is opaque and asks for no depth lies over the layers that came before it. Where a stencil test let it through
        // is not known any more when these are composed: with one it takes none of them back.
        let stencil = state.stencil.map(|stencil| stencil.test);
        let covers = test.is_none() && stencil.is_none() && (blend || !self.items.is_empty());
        if !blend && !covers {
            return None;
        }
        let draw = ItemDraw { blend, stencil, ..ItemDraw::new(test, interpolation, state.blend, state.scissor) };
        let draw = self.place(draw);
        let translucent = blend.then_some(Translucency { interpolation, mode: state.blend, alphas });
        let without_grid = Some(WithoutGrid { covers });
        Some(Taken { items: &mut self.items, draw, masked: false, translucent, without_grid })
    }

    /// Whether an item of a scene without a grid is a layer: no clear, and nothing opaque.
    #[must_use]
    pub fn is_layer(&self, item: &Item) -> bool {
        item.kind != Kind::Clear && !self.draws[item.draw as usize].is_opaque(&item.vertices)
    }

    /// Whether a layer waits that may touch `area`.
    #[must_use]
    pub fn waits_in(&self, area: &Rectangle) -> bool {
        let meets = |item: &Item| {
            let [low, high] = extent(item, &self.draws[item.draw as usize]);
            self.is_layer(item)
                && low[0].max(area.x as i32) < high[0].min(area.right as i32)
                && low[1].max(area.y as i32) < high[1].min(area.bottom as i32)
        };
        self.items.iter().any(meets)
    }

    /// Takes back all layers that wait in `area`; `whole` if it is all there is.
    pub fn take_back(&mut self, area: &Rectangle, whole: bool) {
        if whole {
            self.items.clear();
            self.draws.clear();
            self.overflowed = false;
            return;
        }
        if self.items.is_empty() || area.x >= area.right || area.y >= area.bottom {
            return;
        }
        if self.full() {
            self.overflowed = true;
            return;
        }
        let draw = self.place(ItemDraw::new(None, Interpolation::Flat, BlendMode::Alpha, *area));
        self.items.push(Item { vertices: [ScreenVertex::default(); 3], draw, number: 0, kind: Kind::Clear });
    }

    /// The place of what the next items share. What has left no item leaves its place too: there are never more draws
    /// than items, and one.
    fn place(&mut self, draw: ItemDraw) -> u32 {
        if self.draws.last() != Some(&draw) {
            self.draws.truncate(self.items.last().map_or(0, |item| item.draw as usize + 1));
            self.draws.push(draw);
        }
        self.draws.len() as u32 - 1
    }

    fn add_rule(&mut self, rule: Rule) {
        self.rule = match self.rule {
            Some(known) if known != rule => Some(Rule::InOrder),
            _ => Some(rule),
        };
    }

    /// Whether what is drawn goes on across an edge of item `a` in item `b`, where corners of the two are one; these are
    /// given by their numbers.
    #[must_use]
    #[inline(always)]
    pub(super) fn goes_on(&self, a: &Item, b: &Item, corners: [(usize, usize); 2]) -> bool {
        let [first, second] = [a, b].map(|item| &self.draws[item.draw as usize]);
        let carried = match (&first.shading, &second.shading) {
            (Some(mine), Some(others)) => {
                let (mine, others) = (mine.of(a.number).1, others.of(b.number).1);
                corners.iter().all(|&(j, k)| mine[j] == others[k])
            }
            _ => true,
        };
        carried && (a.draw == b.draw || first.is_like(second))
    }

    /// Gives the items from place `first` on, all of one draw, what their colours go through.
    pub fn shade(&mut self, first: usize, shading: &Arc<DrawShading>) {
        let Some(draw) = self.items.get(first).map(|item| item.draw as usize) else {
            return;
        };
        // A draw of which little is taken is not held for that: memory is bounded by items.
        let shading = if 2 * (self.items.len() - first) < shading.vertices.len() {
            let items = &mut self.items[first..];
            let vertices = items.iter().map(|item| *shading.of(item.number).1).collect();
            items.iter_mut().zip(0..).for_each(|(item, place)| item.number = place);
            Arc::new(DrawShading { pixel: Arc::clone(&shading.pixel), first: 0, vertices })
        } else {
            Arc::clone(shading)
        };
        let with = ItemDraw { shading: Some(shading), ..self.draws[draw].clone() };
        // What came before the batch may share the draw.
        if first > 0 && self.items[first - 1].draw as usize == draw {
            self.items[first..].iter_mut().for_each(|item| item.draw = self.draws.len() as u32);
            self.draws.push(with);
        } else {
            self.draws[draw] = with;
        }
    }

    /// Memory for parameters that nobody needs any more; the scene is over.
    pub fn take_parameters(&mut self) -> Option<Vec<Parameters>> {
        let shadings = self.draws.drain(..).filter_map(|draw| Arc::into_inner(draw.shading?));
        shadings.map(|shading| shading.vertices).max_by_key(Vec::capacity)
    }

    /// A clear; `whole` if it is of all pixels, `planes` if it is of all planes that the target has.
    pub fn clear(&mut self, clear: &Clear, whole: bool, planes: bool) {
        let area = clear.area;
        if area.x >= area.right || area.y >= area.bottom {
            return;
        }
        if whole && planes {
            // Nothing from before is seen.
            self.items.clear();
            self.draws.clear();
            (self.overflowed, self.rule) = (false, None);
        }
        if whole && self.items.is_empty() {
            if let Some(colour) = clear.colour {
                self.colour = Base::Uniform(colour);
            }
            if let Some(depth) = clear.depth {
                self.depth = Base::Uniform(depth as i32);
            }
            return;
        }
        if self.full() {
            self.overflowed = true;
            return;
        }
        self.add_rule(Rule::InOrder);
        let draw = self.place(ItemDraw {
            colour: clear.colour,
            depth: clear.depth.map(|depth| depth as i32),
            ..ItemDraw::new(None, Interpolation::Flat, BlendMode::Alpha, area)
        });
        self.items.push(Item { vertices: [ScreenVertex::default(); 3], draw, number: 0, kind: Kind::Clear });
    }
}

/// The least and the greatest alpha of a primitive's vertices.
#[must_use]
pub fn vertex_alphas(vertices: &[ScreenVertex], interpolation: Interpolation) -> [u32; 2] {
    let seen = if interpolation == Interpolation::Flat { &vertices[..1] } else { vertices };
    let alphas = || seen.iter().map(|v| v.colour >> 24);
    [alphas().min().unwrap_or(255), alphas().max().unwrap_or(0)]
}

/// Where the items of one draw go.
#[derive(Debug)]
pub struct Taken<'a> {
    /// In order of submission.
    pub items: &'a mut Vec<Item>,
    /// Their place in [`Scene::draws`].
    pub draw: u32,
    /// They are drawn with masks.
    pub masked: bool,
    /// They can be translucent.
    pub translucent: Option<Translucency>,
    /// There is no grid.
    pub without_grid: Option<WithoutGrid>,
}

/// What is taken where there is no grid: layers, and of what is opaque only that which lies over them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WithoutGrid {
    /// Opaque primitives lie over the layers that came before them.
    pub covers: bool,
}

/// What decides whether a primitive of a draw that blends is translucent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Translucency {
    /// How its colours are interpolated.
    pub interpolation: Interpolation,
    /// How it is combined with what lies behind it.
    pub mode: BlendMode,
    /// What becomes of the alphas of its vertices.
    pub alphas: AlphaRule,
}

impl Translucency {
    /// Whether a primitive hides what lies behind it.
    #[inline(always)]
    fn is_opaque(self, vertices: &[ScreenVertex]) -> bool {
        self.mode == BlendMode::Alpha && self.alphas.range(vertex_alphas(vertices, self.interpolation))[0] == 255
    }

    /// Whether fragments of a primitive can hide what lies behind them.
    #[inline(always)]
    fn may_hide(self, vertices: &[ScreenVertex]) -> bool {
        self.mode == BlendMode::Alpha && self.alphas.range(vertex_alphas(vertices, self.interpolation))[1] == 255
    }

    /// Whether a primitive changes nothing.
    #[inline(always)]
    fn is_nothing(self, vertices: &[ScreenVertex]) -> bool {
        self.mode == BlendMode::Alpha && self.alphas.range(vertex_alphas(vertices, self.interpolation))[1] == 0
    }
}

impl Taken<'_> {
    /// Whether the hidden-surface path draws a primitive too: one that may be translucent is the unit's alone, since the
    /// path would hide with it.
    #[inline(always)]
    fn is_opaque(&self, vertices: &[ScreenVertex]) -> bool {
        self.translucent.is_none_or(|translucency| translucency.is_opaque(vertices))
    }

    /// Takes a primitive that is drawn without masks; whether it goes to the path too. Apart from the loop over
    /// primitives, most of which nobody takes.
    #[inline(never)]
    fn take(&mut self, vertices: [ScreenVertex; 3], kind: Kind, number: u32) -> bool {
        if self.wants(&vertices) {
            self.push(vertices, kind, number);
        }
        self.is_opaque(&vertices)
    }

    /// Whether the unit takes a primitive.
    fn wants(&self, vertices: &[ScreenVertex]) -> bool {
        let Some(WithoutGrid { covers }) = self.without_grid else {
            return !self.masked;
        };
        if self.is_opaque(vertices) { covers } else { !self.translucent.is_some_and(|of| of.is_nothing(vertices)) }
    }

    #[inline(always)]
    fn push(&mut self, vertices: [ScreenVertex; 3], kind: Kind, number: u32) {
        self.items.push(Item { vertices, draw: self.draw, number, kind });
    }
}

/// A sink that has the primitives taken on the way to another.
pub struct Taking<'a, 't, S> {
    /// Where primitives go.
    pub sink: &'a mut S,
    /// Who takes them too.
    pub taken: Option<Taken<'t>>,
}

impl<S> Taking<'_, '_, S> {
    /// Takes a primitive that is drawn without masks; whether it goes to the path too.
    #[inline(always)]
    fn take(&mut self, vertices: [ScreenVertex; 3], kind: Kind, number: u32) -> bool {
        match &mut self.taken {
            None => true,
            Some(taken) => taken.take(vertices, kind, number),
        }
    }
}

impl<S: Sink> Sink for Taking<'_, '_, S> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle, columns: [i32; 2], vertices: &[ScreenVertex; 3], number: u32) {
        if self.take(*vertices, Kind::Triangle, number) {
            self.sink.triangle(triangle, columns, vertices, number);
        }
    }

    #[inline(always)]
    fn line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: u32) {
        if self.take([vertices[0], vertices[1], vertices[1]], Kind::Line, number) {
            self.sink.line(line, vertices, number);
        }
    }

    #[inline(always)]
    fn point(&mut self, point: &Point, vertex: &ScreenVertex, number: u32) {
        if self.take([*vertex; 3], Kind::Point, number) {
            self.sink.point(point, vertex, number);
        }
    }

    #[inline(always)]
    fn masked(&mut self, vertices: &[ScreenVertex; 3], number: u32) {
        if let Some(taken) = &mut self.taken {
            taken.push(*vertices, Kind::Masked, number);
        }
        self.sink.masked(vertices, number);
    }

    #[inline(always)]
    fn full(&self) -> bool {
        self.sink.full() || self.taken.as_ref().is_some_and(|taken| taken.items.len() >= ITEM_LIMIT)
    }
}
