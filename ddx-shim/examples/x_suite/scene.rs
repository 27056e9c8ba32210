//! Scenes: random requests of the core protocol and of RENDER as plain values.
//!
//! A scene is made from its seed alone and does not know a server: whatever plays it, on whichever server, plays the same
//! requests, all of them or the first so many.

mod request;
mod shapes;

use x11rb::protocol::render::{PictOp, Pointfix, Repeat, Triangle};
use x11rb::protocol::xproto::{
    Arc, ArcMode, CapStyle, CoordMode, FillRule, FillStyle, GX, ImageFormat, JoinStyle, LineStyle, Point, PolyShape,
    Rectangle, Segment, SubwindowMode,
};

use request::Pen;
pub use request::{Change, Gathered, Origin, PIXELS, Request};
use shapes::{colour, fixed, matrix, pictures, trapezoid};

use super::random::Random;

/// Something that can be drawn on, and its size; windows first.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub width: u16,
    pub height: u16,
    pub depth: u8,
    pub window: Option<Placed>,
}

impl Surface {
    /// Its pixels have alpha in the lowest byte.
    pub fn is_reversed(&self) -> bool {
        self.depth == 32 && self.width == REVERSED_WIDTH
    }

    /// Its pixels have no alpha, but a byte where others have it.
    fn is_without_alpha(&self) -> bool {
        self.depth == 32 && self.width == OPAQUE_WIDTH
    }
}

/// What surfaces of the other order of bytes are told by.
const REVERSED_WIDTH: u16 = 61;
/// What surfaces of depth 32 without alpha are told by.
const OPAQUE_WIDTH: u16 = 57;

/// A window's place.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    pub parent: Option<usize>,
    pub x: i16,
    pub y: i16,
    pub border: u16,
}

/// What kind of scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Requests in it.
    pub requests: usize,
    /// Bits of a pixel of the screen.
    pub depth: u8,
    /// Pixels of the screen.
    pub size: [u16; 2],
    /// RENDER requests besides.
    pub render: bool,
    /// Many large pixmaps.
    pub pressure: bool,
    /// Under a compositing manager, which paints the screen when it likes: windows are looked at one by one and stay on
    /// the screen, for what is read from a hidden one is the screen.
    pub composited: bool,
}

impl Scene {
    /// A request with what it depends on: the changes of its context, its pictures and their changes, in their order.
    pub fn told(&self, number: usize) -> String {
        let Some(request) = self.requests.get(number) else { return String::new() };
        let (context, pictures) = (request.context(), request.pictures());
        let mut text = format!("{request:?}\n");
        for picture in &pictures {
            text.push_str(&format!("    picture {picture}: {:?}\n", self.pictures[*picture]));
        }
        for (at, before) in self.requests[..number].iter().enumerate() {
            let told = match before {
                Request::Picture { pic, .. } | Request::PictureClip { pic, .. } | Request::Transformed { pic, .. } => {
                    pictures.contains(pic)
                }
                _ => before.changes_context().is_some_and(|gc| context == Some(gc)),
            };
            if told {
                text.push_str(&format!("    {at}: {before:?}\n"));
            }
        }
        text
    }
}

/// Core fonts that are used.
pub const FONTS: [&str; 5] = ["fixed", "6x10", "9x15bold", "10x20", "8x13"];

/// Graphics contexts of each depth.
pub const CONTEXTS: usize = 2;

/// A scene.
#[derive(Clone, Debug)]
pub struct Scene {
    pub seed: u64,
    pub kind: Kind,
    pub surfaces: Vec<Surface>,
    pub pictures: Vec<Origin>,
    /// Depths that have contexts, [`CONTEXTS`] each.
    pub depths: Vec<u8>,
    pub requests: Vec<Request>,
}

impl Scene {
    /// The scene of a seed.
    pub fn new(seed: u64, kind: Kind) -> Scene {
        let mut random = Random::new(seed);
        let mut surfaces = Vec::new();
        let mut window = |parent, x, y, width, height, border| {
            surfaces.push(Surface { width, height, depth: kind.depth, window: Some(Placed { parent, x, y, border }) });
        };
        window(None, 10, 10, 380, 280, 0);
        window(Some(0), 50, 40, 200, 150, 3);
        window(Some(1), 20, 20, 90, 60, 1);
        window(None, 250, 150, 300, 250, 2);
        window(None, 120, 200, 150, 120, 0);
        let screen = kind.depth;
        let mut pixmaps = vec![
            (200, 150, screen),
            (64, 64, screen),
            (33, 17, screen),
            (8, 8, screen),
            (16, 16, screen),
            (1, 1, screen),
            (200, 150, 1),
            (32, 32, 1),
            (8, 8, 1),
            (13, 7, 1),
            (100, 80, 8),
            (16, 16, 8),
            (150, 100, 32),
            (16, 16, 32),
            (REVERSED_WIDTH, 47, 32),
        ];
        let mut depths = vec![screen, 1, 8, 32];
        if kind.render {
            pixmaps.push((OPAQUE_WIDTH, 40, 32));
            if screen != 16 {
                pixmaps.extend([(120, 90, 16), (16, 16, 16)]);
                depths.push(16);
            }
        }
        if kind.pressure {
            pixmaps.extend((0..14).map(|_| (random.between(200, 500) as u16, random.between(200, 500) as u16, screen)));
        }
        surfaces.extend(pixmaps.into_iter().map(|(width, height, depth)| Surface {
            width,
            height,
            depth,
            window: None,
        }));
        let pictures = if kind.render { pictures(&surfaces, &mut random) } else { Vec::new() };
        let mut scene = Scene { seed, kind, surfaces, pictures, depths, requests: Vec::new() };
        // Tile and stipple of each context. A surface is not filled with itself: which of its pixels are read after they
        // have been written is left open by the protocol.
        let mut patterns = vec![[None; 2]; scene.depths.len() * CONTEXTS];
        let mut pens = vec![Pen::default(); scene.depths.len() * CONTEXTS];
        while scene.requests.len() < kind.requests {
            let request = scene.request(&mut random);
            if let Request::Change { gc, change } = &request {
                let pen = pens[*gc].changed(change);
                if pen.is_trouble() {
                    continue;
                }
                pens[*gc] = pen;
                let [tile, stipple] = patterns[*gc];
                patterns[*gc] = [change.tile.or(tile), change.stipple.or(stipple)];
            }
            let itself =
                request.context().zip(request.drawn_on()).is_some_and(|(gc, on)| patterns[gc].contains(&Some(on)));
            if !itself {
                scene.requests.push(request);
            }
        }
        scene
    }

    /// Contexts that fit a surface.
    fn context(&self, on: usize, random: &mut Random) -> usize {
        let depth = self.surfaces[on].depth;
        let class = self.depths.iter().position(|known| *known == depth).expect("every depth has contexts");
        class * CONTEXTS + random.below(CONTEXTS as u32) as usize
    }

    fn windows(&self) -> usize {
        self.surfaces.iter().filter(|surface| surface.window.is_some()).count()
    }

    /// A surface to draw on: half of the time one of the screen. What pictures read as premultiplied is drawn on by RENDER alone:
    /// of colours above their alpha no two renderers need to be of one mind.
    fn any(&self, random: &mut Random) -> usize {
        loop {
            let on = match random.below(2) {
                0 => random.below(self.windows() as u32 + 1) as usize,
                _ => random.below(self.surfaces.len() as u32) as usize,
            };
            if !(self.kind.render && self.surfaces[on].depth == 32) {
                return on;
            }
        }
    }

    fn of_depth(&self, depth: u8, random: &mut Random) -> usize {
        let fitting: Vec<usize> = (0..self.surfaces.len()).filter(|on| self.surfaces[*on].depth == depth).collect();
        random.of(&fitting)
    }

    fn pixmap_of_depth(&self, depth: u8, random: &mut Random) -> usize {
        loop {
            let on = self.of_depth(depth, random);
            if self.surfaces[on].window.is_none() {
                return on;
            }
        }
    }

    /// A place in or near a surface.
    fn place(&self, on: usize, random: &mut Random) -> [i16; 2] {
        let surface = &self.surfaces[on];
        [surface.width, surface.height].map(|side| random.between(-20, i32::from(side) + 10) as i16)
    }

    fn points(&self, on: usize, most: u32, random: &mut Random) -> (CoordMode, Vec<Point>) {
        let count = random.below(most) + 1;
        match random.once_in(3) {
            true => {
                let [x, y] = self.place(on, random);
                let first = Point { x, y };
                let step = |random: &mut Random| Point {
                    x: random.between(-40, 40) as i16,
                    y: random.between(-40, 40) as i16,
                };
                let mut list = vec![first];
                list.extend((0..count).map(|_| step(random)));
                (CoordMode::PREVIOUS, list)
            }
            false => {
                let mut list: Vec<Point> =
                    (0..=count).map(|_| self.place(on, random)).map(|[x, y]| Point { x, y }).collect();
                // Closed figures end where they begin.
                if random.once_in(3) {
                    list.push(list[0]);
                }
                (CoordMode::ORIGIN, list)
            }
        }
    }

    fn rectangles(&self, on: usize, most: u32, random: &mut Random) -> Vec<Rectangle> {
        let count = random.below(most) + 1;
        (0..count)
            .map(|_| {
                let [x, y] = self.place(on, random);
                let side = |random: &mut Random| match random.below(6) {
                    0 => random.below(3),
                    1 => random.below(400),
                    _ => random.below(60),
                };
                Rectangle { x, y, width: side(random) as u16, height: side(random) as u16 }
            })
            .collect()
    }

    fn size(&self, random: &mut Random) -> [u16; 2] {
        let most = random.of(&[8, 40, 120, 300]);
        [random.below(most) as u16 + 1, random.below(most) as u16 + 1]
    }

    fn request(&self, random: &mut Random) -> Request {
        if self.kind.render && random.below(5) < 3 {
            return self.render(random);
        }
        let on = self.any(random);
        let gc = self.context(on, random);
        match random.below(40) {
            0..=7 => Request::Change { gc, change: self.change(gc, random) },
            8 => {
                let list = (0..random.below(5) + 1).map(|_| random.below(12) as u8 + 1).collect();
                Request::Dashes { gc, offset: random.below(30) as u16, list }
            }
            9 => {
                let [x, y] = [random.between(-10, 30) as i16, random.between(-10, 30) as i16];
                let rectangles = if random.once_in(8) { Vec::new() } else { self.rectangles(on, 6, random) };
                Request::Clip { gc, x, y, rectangles }
            }
            10 => {
                let mask = (!random.once_in(2)).then(|| self.pixmap_of_depth(1, random));
                Request::ClipMask { gc, mask, x: random.between(-10, 50) as i16, y: random.between(-10, 50) as i16 }
            }
            11..=13 => Request::Fill { on, gc, list: self.rectangles(on, 12, random) },
            14 => Request::Frames { on, gc, list: self.rectangles(on, 4, random) },
            15 | 16 => {
                let arcs = self.rectangles(on, 4, random).into_iter().map(|Rectangle { x, y, width, height }| Arc {
                    x,
                    y,
                    width,
                    height,
                    angle1: random.between(-360 * 64, 360 * 64) as i16,
                    angle2: random.of(&[360 * 64, 90 * 64, -45 * 64, 200 * 64, 17]),
                });
                let list = arcs.collect();
                Request::Arcs { on, gc, list, filled: random.once_in(2) }
            }
            17 => {
                let (mode, list) = self.points(on, 9, random);
                // The other shapes are promises that random points do not keep.
                Request::Polygon { on, gc, shape: PolyShape::COMPLEX, mode, list }
            }
            18..=20 => {
                let count = random.below(12) + 1;
                let list = (0..count).map(|_| {
                    let ([x1, y1], [x2, y2]) = (self.place(on, random), self.place(on, random));
                    match random.below(4) {
                        0 => Segment { x1, y1, x2, y2: y1 },
                        1 => Segment { x1, y1, x2: x1, y2 },
                        _ => Segment { x1, y1, x2, y2 },
                    }
                });
                let list = list.collect();
                Request::Segments { on, gc, list }
            }
            21..=23 => {
                let (mode, list) = self.points(on, 9, random);
                Request::Lines { on, gc, mode, list }
            }
            24 => {
                let (mode, list) = self.points(on, 30, random);
                Request::Points { on, gc, mode, list }
            }
            25..=28 => {
                // Half of the time onto itself a little aside, which is where order matters.
                let (from, at) = match random.once_in(2) {
                    true => (on, self.place(on, random)),
                    false => {
                        let from = self.of_depth(self.surfaces[on].depth, random);
                        (from, self.place(from, random))
                    }
                };
                let to = match from == on {
                    true => at.map(|at| at + random.between(-9, 9) as i16),
                    false => self.place(on, random),
                };
                Request::Copy { from, on, gc, at, to, size: self.size(random) }
            }
            29 => {
                let depth = random.of(&[1, self.kind.depth]);
                let from = self.of_depth(depth, random);
                let plane = 1 << random.below(self.surfaces[from].depth.into());
                let (at, to) = (self.place(from, random), self.place(on, random));
                Request::Plane { from, on, gc, at, to, size: self.size(random), plane }
            }
            30 | 31 => {
                let format = random.of(&[ImageFormat::Z_PIXMAP, ImageFormat::XY_PIXMAP, ImageFormat::XY_BITMAP]);
                let depth = if format == ImageFormat::XY_BITMAP { 1 } else { self.surfaces[on].depth };
                let left = if format == ImageFormat::Z_PIXMAP { 0 } else { random.below(32) as u8 };
                let size = [random.below(90) as u16 + 1, random.below(60) as u16 + 1];
                Request::Put { on, gc, format, depth, to: self.place(on, random), size, left, seed: random.bits() }
            }
            32..=34 => {
                let text = (0..random.below(24) + 1).map(|_| random.between(32, 126) as u8).collect();
                let (image, wide) = (random.once_in(2), random.once_in(4));
                Request::Text { on, gc, to: self.place(on, random), text, image, wide }
            }
            35 => {
                let window = random.below(self.windows() as u32) as usize;
                Request::Clear { window, at: self.place(window, random), size: self.size(random) }
            }
            36 | 37 => self.rearrange(random),
            38 => {
                // Whole only where it lies inside; what does not is an error on both.
                let surface = self.surfaces[on];
                let width = random.below(surface.width.into()) as u16 + 1;
                let height = random.below(surface.height.into()) as u16 + 1;
                let at = [surface.width - width, surface.height - height]
                    .map(|most| random.below(u32::from(most) + 1) as i16);
                let format = random.of(&[ImageFormat::Z_PIXMAP, ImageFormat::XY_PIXMAP]);
                let planes = if random.once_in(2) { u32::MAX } else { random.bits() as u32 };
                Request::Read { on, at, size: [width, height], planes, format }
            }
            _ => Request::Fill { on, gc, list: self.rectangles(on, 40, random) },
        }
    }

    /// Windows moved, restacked, hidden and shown.
    fn rearrange(&self, random: &mut Random) -> Request {
        let window = random.below(self.windows() as u32) as usize;
        match random.below(4) {
            0 => Request::Stack { window, above: random.once_in(2) },
            1 => Request::Show { window, shown: !random.once_in(3) || self.kind.composited },
            _ => {
                let [width, height] = [random.between(60, 260) as u16, random.between(50, 200) as u16];
                let inside = self.surfaces[window].window.is_some_and(|placed| placed.parent.is_none());
                // Inside the screen, with its border: the picture of the whole can be had then.
                let to = match inside {
                    true => [
                        random.below(u32::from(self.kind.size[0] - width - 8)) as i16,
                        random.below(u32::from(self.kind.size[1] - height - 8)) as i16,
                    ],
                    false => [random.between(-40, 150) as i16, random.between(-40, 150) as i16],
                };
                Request::Move { window, to, size: [width, height] }
            }
        }
    }

    fn change(&self, gc: usize, random: &mut Random) -> Change {
        let depth = self.depths[gc / CONTEXTS];
        let mut change = Change::default();
        let functions = [
            GX::CLEAR,
            GX::AND,
            GX::AND_REVERSE,
            GX::COPY,
            GX::AND_INVERTED,
            GX::NOOP,
            GX::XOR,
            GX::OR,
            GX::NOR,
            GX::EQUIV,
            GX::INVERT,
            GX::OR_REVERSE,
            GX::COPY_INVERTED,
            GX::OR_INVERTED,
            GX::NAND,
            GX::SET,
        ];
        for _ in 0..random.below(4) + 1 {
            match random.below(14) {
                0 => change.function = Some(if random.once_in(2) { GX::COPY } else { random.of(&functions) }),
                1 => change.planes = Some(if random.once_in(2) { u32::MAX } else { random.bits() as u32 }),
                2 | 3 => change.foreground = Some(random.bits() as u32),
                4 => change.background = Some(random.bits() as u32),
                5 => change.width = Some(if random.once_in(2) { 0 } else { random.below(14) }),
                6 => {
                    change.line = Some(random.of(&[
                        LineStyle::SOLID,
                        LineStyle::SOLID,
                        LineStyle::ON_OFF_DASH,
                        LineStyle::DOUBLE_DASH,
                    ]));
                }
                7 => {
                    change.cap =
                        Some(random.of(&[CapStyle::NOT_LAST, CapStyle::BUTT, CapStyle::ROUND, CapStyle::PROJECTING]));
                }
                8 => change.join = Some(random.of(&[JoinStyle::MITER, JoinStyle::ROUND, JoinStyle::BEVEL])),
                9 => {
                    change.fill = Some(random.of(&[
                        FillStyle::SOLID,
                        FillStyle::SOLID,
                        FillStyle::TILED,
                        FillStyle::STIPPLED,
                        FillStyle::OPAQUE_STIPPLED,
                    ]));
                    change.tile = Some(self.pixmap_of_depth(depth, random));
                    change.stipple = Some(self.pixmap_of_depth(1, random));
                }
                10 => change.origin = Some([random.between(-50, 50) as i16, random.between(-50, 50) as i16]),
                11 => change.font = Some(random.below(FONTS.len() as u32) as usize),
                12 => {
                    change.subwindows =
                        Some(random.of(&[SubwindowMode::CLIP_BY_CHILDREN, SubwindowMode::INCLUDE_INFERIORS]));
                }
                _ => {
                    change.rule = Some(random.of(&[FillRule::EVEN_ODD, FillRule::WINDING]));
                    change.arcs = Some(random.of(&[ArcMode::CHORD, ArcMode::PIE_SLICE]));
                }
            }
        }
        change
    }

    /// Pictures that can be drawn on.
    fn drawn_picture(&self, random: &mut Random) -> (usize, usize) {
        loop {
            let pic = random.below(self.pictures.len() as u32) as usize;
            // What lies in the byte that is nobody's goes from surface to surface, and is seen in this one alone.
            if let Origin::Surface(on, _) = self.pictures[pic]
                && !self.surfaces[on].is_without_alpha()
            {
                return (pic, on);
            }
        }
    }

    fn render(&self, random: &mut Random) -> Request {
        let (on, surface) = self.drawn_picture(random);
        let from = random.below(self.pictures.len() as u32) as usize;
        let op = match random.below(3) {
            0 => PictOp::OVER,
            1 => random.of(&[PictOp::SRC, PictOp::ADD]),
            // The disjoint, conjoint and blend operators as well, if rarely: no card need have them.
            _ if random.once_in(6) => PictOp::from(random.of(&[13, 16, 20, 27, 32, 35, 43, 48, 54, 62_u8])),
            _ => PictOp::from(random.below(13) as u8),
        };
        let (at, to) = ([random.between(-20, 60) as i16, random.between(-20, 60) as i16], self.place(surface, random));
        match random.below(16) {
            0..=5 => {
                let mask = random.once_in(2).then(|| random.below(self.pictures.len() as u32) as usize);
                let mask_at = [random.between(-20, 40) as i16, random.between(-20, 40) as i16];
                Request::Compose { op, from, mask, on, at, mask_at, to, size: self.size(random) }
            }
            6 => Request::Paint { op, on, colour: colour(random), list: self.rectangles(surface, 5, random) },
            7 => {
                let repeat = random.of(&[Repeat::NONE, Repeat::NORMAL, Repeat::PAD, Repeat::REFLECT]);
                Request::Picture { pic: from, repeat, component: random.once_in(3) }
            }
            8 => {
                let rectangles = match random.once_in(2) {
                    true => vec![Rectangle { x: 0, y: 0, width: 1000, height: 1000 }],
                    false => self.rectangles(surface, 5, random),
                };
                Request::PictureClip { pic: on, rectangles }
            }
            9 => Request::Transformed {
                pic: from,
                matrix: matrix(random),
                filter: random.of(&["nearest", "nearest", "nearest", "bilinear"]),
            },
            10 | 11 => {
                let list = (0..random.below(4) + 1).map(|_| trapezoid(self.place(surface, random), random)).collect();
                Request::Trapezoids { op, from, on, masked: random.once_in(2), at, list }
            }
            12 => {
                let corner = |random: &mut Random| {
                    let [x, y] = self.place(surface, random);
                    Pointfix { x: fixed(x, random), y: fixed(y, random) }
                };
                let list = (0..random.below(3) + 1)
                    .map(|_| Triangle { p1: corner(random), p2: corner(random), p3: corner(random) })
                    .collect();
                Request::Triangles { op, from, on, masked: random.once_in(2), at, list }
            }
            _ => {
                // Of one set, of the other, or of both.
                let (first, sorts) = random.of(&[(0, 1), (0, 1), (GLYPHS, 1), (0, 2)]);
                // Over each other, or mostly side by side.
                let near = random.of(&[-18, 0]);
                let glyph = |random: &mut Random| {
                    let number = first + random.below(sorts * GLYPHS);
                    (number as u8, [random.between(near, near + 20) as i16, random.between(-3, 3) as i16])
                };
                let count = random.of(&[1, 12]);
                let mut list: Vec<_> = (0..random.below(count) + 1).map(|_| glyph(random)).collect();
                list[0].1 = to;
                let mask = random.of(&[None, None, Some(Gathered::Alpha), Some(Gathered::Components)]);
                Request::Glyphs { op, from, on, mask, at, list }
            }
        }
    }
}

/// Glyphs of each of the two glyph sets, one of alpha alone, one of components.
pub const GLYPHS: u32 = 24;
