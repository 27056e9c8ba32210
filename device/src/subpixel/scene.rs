//! A scene as the unit takes it: all of its primitives and clears, in order of submission.
//!
//! Duties: takes what is assembled while the hidden-surface path draws it; knows from which rule the order of opaque
//! fragments follows, and what pixels were before the first of them. Inputs from: the assembly stage, clears. Outputs
//! to: [`super::band`], [`super::specification`]. Clocks: none of its own.
//!
//! Nothing is kept of a scene on a target without a grid.

use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Point, Sink};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::DepthTest;
use crate::shading::plane::Interpolation;
use zga_abi::Effects;
use zga_abi::format::DepthFunction;
use zga_firmware::checked::{Clear, DrawState, Rectangle};

/// Most primitives and clears of a scene with a grid: 68 MiB, and less for the draws.
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
    /// What it covers.
    pub kind: Kind,
}

/// What the items of a draw share, or what a clear does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ItemDraw {
    /// Depth test; `None` where depth is not called for: everything passes, no depth is stored.
    pub test: Option<DepthTest>,
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// Fragments with an alpha below 255 are translucent.
    pub blend: bool,
    /// Object tag.
    pub tag: u32,
    /// Pixels that may change, inside the target.
    pub scissor: Rectangle,
    /// Of a clear: RGBA to be written.
    pub colour: Option<u32>,
    /// Of a clear: depth to be stored.
    pub depth: Option<i32>,
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
        let opaque = |item: &Item| greatest_alpha(&item.vertices, self.draws[item.draw as usize].interpolation) == 255;
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
    ) -> Option<Taken<'_>> {
        let area = state.scissor;
        let never = test.is_some() && state.depth_function == DepthFunction::Never;
        if never || area.x >= area.right || area.y >= area.bottom {
            return None;
        }
        let blend = state.effects.contains(Effects::BLEND);
        let masked = state.effects.contains(Effects::ANTI_ALIAS);
        let draw = ItemDraw { test, interpolation, blend, tag: state.tag, scissor: area, colour: None, depth: None };
        self.called |= blend || masked;
        let rule = match test {
            None => Rule::Last,
            Some(test) if test.less && !test.greater && (test.write || blend) => Rule::Nearest,
            Some(_) => Rule::InOrder,
        };
        self.add_rule(rule);
        let draw = self.place(draw);
        let translucent = blend.then_some(interpolation);
        Some(Taken { items: &mut self.items, draw, masked, translucent })
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
            test: None,
            interpolation: Interpolation::Flat,
            blend: false,
            tag: 0,
            scissor: area,
            colour: clear.colour,
            depth: clear.depth.map(|depth| depth as i32),
        });
        self.items.push(Item { vertices: [ScreenVertex::default(); 3], draw, kind: Kind::Clear });
    }
}

/// The least alpha of a primitive.
#[must_use]
pub fn least_alpha(vertices: &[ScreenVertex], interpolation: Interpolation) -> u32 {
    let seen = if interpolation == Interpolation::Flat { &vertices[..1] } else { vertices };
    seen.iter().map(|v| v.colour >> 24).min().unwrap_or(255)
}

/// The greatest alpha of a primitive.
#[must_use]
pub fn greatest_alpha(vertices: &[ScreenVertex], interpolation: Interpolation) -> u32 {
    let seen = if interpolation == Interpolation::Flat { &vertices[..1] } else { vertices };
    seen.iter().map(|v| v.colour >> 24).max().unwrap_or(0)
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
    /// They can be translucent: then how their colours are interpolated.
    pub translucent: Option<Interpolation>,
}

impl Taken<'_> {
    /// Whether the hidden-surface path draws a primitive too: one that may be translucent is the unit's alone, since the
    /// path would hide with it.
    #[inline(always)]
    fn is_opaque(&self, vertices: &[ScreenVertex]) -> bool {
        self.translucent.is_none_or(|interpolation| least_alpha(vertices, interpolation) == 255)
    }

    #[inline(always)]
    fn push(&mut self, vertices: [ScreenVertex; 3], kind: Kind) {
        self.items.push(Item { vertices, draw: self.draw, kind });
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
    fn take(&mut self, vertices: [ScreenVertex; 3], kind: Kind) -> bool {
        let Some(taken) = &mut self.taken else {
            return true;
        };
        if !taken.masked {
            taken.push(vertices, kind);
        }
        taken.is_opaque(&vertices)
    }
}

impl<S: Sink> Sink for Taking<'_, '_, S> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle, columns: [i32; 2], vertices: &[ScreenVertex; 3], number: u32) {
        if self.take(*vertices, Kind::Triangle) {
            self.sink.triangle(triangle, columns, vertices, number);
        }
    }

    #[inline(always)]
    fn line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: u32) {
        if self.take([vertices[0], vertices[1], vertices[1]], Kind::Line) {
            self.sink.line(line, vertices, number);
        }
    }

    #[inline(always)]
    fn point(&mut self, point: &Point, vertex: &ScreenVertex, number: u32) {
        if self.take([*vertex; 3], Kind::Point) {
            self.sink.point(point, vertex, number);
        }
    }

    #[inline(always)]
    fn masked(&mut self, vertices: &[ScreenVertex; 3]) {
        if let Some(taken) = &mut self.taken {
            taken.push(*vertices, Kind::Masked);
        }
        self.sink.masked(vertices);
    }

    #[inline(always)]
    fn full(&self) -> bool {
        self.sink.full() || self.taken.as_ref().is_some_and(|taken| taken.items.len() >= ITEM_LIMIT)
    }
}
