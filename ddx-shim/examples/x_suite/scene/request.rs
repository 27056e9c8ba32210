//! Requests as plain values: what they are, and what they draw with, from and on.

use x11rb::protocol::render::{Color, PictOp, Repeat, Transform, Trapezoid, Triangle};
use x11rb::protocol::xproto::{
    Arc, ArcMode, CapStyle, CoordMode, FillRule, FillStyle, GX, ImageFormat, JoinStyle, LineStyle, Point, PolyShape,
    Rectangle, Segment, SubwindowMode,
};

/// Changes of a graphics context; indices name surfaces and fonts.
#[derive(Clone, Debug, Default)]
pub struct Change {
    pub function: Option<GX>,
    pub planes: Option<u32>,
    pub foreground: Option<u32>,
    pub background: Option<u32>,
    pub width: Option<u32>,
    pub line: Option<LineStyle>,
    pub cap: Option<CapStyle>,
    pub join: Option<JoinStyle>,
    pub fill: Option<FillStyle>,
    pub rule: Option<FillRule>,
    pub tile: Option<usize>,
    pub stipple: Option<usize>,
    pub origin: Option<[i16; 2]>,
    pub font: Option<usize>,
    pub subwindows: Option<SubwindowMode>,
    pub arcs: Option<ArcMode>,
}

/// How a context draws lines.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pen {
    wide: bool,
    dashed: bool,
}

impl Pen {
    pub(super) fn changed(self, change: &Change) -> Pen {
        Pen {
            wide: change.width.map_or(self.wide, |width| width > 0),
            dashed: change.line.map_or(self.dashed, |line| line != LineStyle::SOLID),
        }
    }

    /// Wide dashed lines, of whatever ends and joins: with these the stock server's miWideDash writes beyond its block of the
    /// heap (valgrind shows it with the driver dummy, too), so that it is anybody's guess what becomes of the server.
    pub(super) const fn is_trouble(self) -> bool {
        self.wide && self.dashed
    }
}

impl Request {
    /// The surface that it draws on through a graphics context, and that context.
    const fn drawing(&self) -> Option<(usize, usize)> {
        match self {
            Request::Fill { on, gc, .. }
            | Request::Frames { on, gc, .. }
            | Request::Arcs { on, gc, .. }
            | Request::Polygon { on, gc, .. }
            | Request::Segments { on, gc, .. }
            | Request::Lines { on, gc, .. }
            | Request::Points { on, gc, .. }
            | Request::Copy { on, gc, .. }
            | Request::Plane { on, gc, .. }
            | Request::Put { on, gc, .. }
            | Request::Text { on, gc, .. } => Some((*on, *gc)),
            _ => None,
        }
    }

    /// The graphics context that it uses or changes.
    pub(super) fn context(&self) -> Option<usize> {
        self.changes_context().or_else(|| self.drawing().map(|(_, gc)| gc))
    }

    /// The graphics context that it changes.
    pub(super) const fn changes_context(&self) -> Option<usize> {
        match self {
            Request::Change { gc, .. }
            | Request::Dashes { gc, .. }
            | Request::Clip { gc, .. }
            | Request::ClipMask { gc, .. } => Some(*gc),
            _ => None,
        }
    }

    /// The surface that it draws on through a context.
    pub(super) fn drawn_on(&self) -> Option<usize> {
        self.drawing().map(|(on, _)| on)
    }

    /// The picture that it draws from, its mask, and what it draws to.
    pub(super) fn pictures(&self) -> Vec<usize> {
        match self {
            Request::Compose { from, mask, on, .. } => [Some(*from), *mask, Some(*on)].into_iter().flatten().collect(),
            Request::Paint { on, .. } => vec![*on],
            Request::Trapezoids { from, on, .. }
            | Request::Triangles { from, on, .. }
            | Request::Glyphs { from, on, .. } => vec![*from, *on],
            _ => Vec::new(),
        }
    }
}

/// What a picture is made of.
#[derive(Clone, Copy, Debug)]
pub enum Origin {
    /// A surface, read as one of [`PIXELS`].
    Surface(usize, usize),
    Solid(Color),
    Linear([i32; 4]),
    Radial([i32; 3]),
}

/// Formats of pictures: depth, red shift, red mask, alpha mask. The second is b8g8r8a8, the last is x8r8g8b8 of depth 32.
pub const PIXELS: [(u8, u16, u16, u16); 8] = [
    (32, 16, 0xFF, 0xFF),
    (32, 8, 0xFF, 0xFF),
    (24, 16, 0xFF, 0),
    (24, 0, 0xFF, 0),
    (16, 11, 0x1F, 0),
    (8, 0, 0, 0xFF),
    (1, 0, 0, 1),
    (32, 16, 0xFF, 0),
];

/// One request. `on`: surface, `gc`: graphics context, `pic`: picture.
#[derive(Clone, Debug)]
pub enum Request {
    Change {
        gc: usize,
        change: Change,
    },
    Dashes {
        gc: usize,
        offset: u16,
        list: Vec<u8>,
    },
    Clip {
        gc: usize,
        x: i16,
        y: i16,
        rectangles: Vec<Rectangle>,
    },
    ClipMask {
        gc: usize,
        mask: Option<usize>,
        x: i16,
        y: i16,
    },
    Fill {
        on: usize,
        gc: usize,
        list: Vec<Rectangle>,
    },
    Frames {
        on: usize,
        gc: usize,
        list: Vec<Rectangle>,
    },
    Arcs {
        on: usize,
        gc: usize,
        list: Vec<Arc>,
        filled: bool,
    },
    Polygon {
        on: usize,
        gc: usize,
        shape: PolyShape,
        mode: CoordMode,
        list: Vec<Point>,
    },
    Segments {
        on: usize,
        gc: usize,
        list: Vec<Segment>,
    },
    Lines {
        on: usize,
        gc: usize,
        mode: CoordMode,
        list: Vec<Point>,
    },
    Points {
        on: usize,
        gc: usize,
        mode: CoordMode,
        list: Vec<Point>,
    },
    Copy {
        from: usize,
        on: usize,
        gc: usize,
        at: [i16; 2],
        to: [i16; 2],
        size: [u16; 2],
    },
    Plane {
        from: usize,
        on: usize,
        gc: usize,
        at: [i16; 2],
        to: [i16; 2],
        size: [u16; 2],
        plane: u32,
    },
    Put {
        on: usize,
        gc: usize,
        format: ImageFormat,
        depth: u8,
        to: [i16; 2],
        size: [u16; 2],
        left: u8,
        seed: u64,
    },
    Text {
        on: usize,
        gc: usize,
        to: [i16; 2],
        text: Vec<u8>,
        image: bool,
        wide: bool,
    },
    Clear {
        window: usize,
        at: [i16; 2],
        size: [u16; 2],
    },
    Move {
        window: usize,
        to: [i16; 2],
        size: [u16; 2],
    },
    Stack {
        window: usize,
        above: bool,
    },
    Show {
        window: usize,
        shown: bool,
    },
    /// A look at pixels amid the scene: both servers must have drawn what came before.
    Read {
        on: usize,
        at: [i16; 2],
        size: [u16; 2],
        planes: u32,
        format: ImageFormat,
    },
    Compose {
        op: PictOp,
        from: usize,
        mask: Option<usize>,
        on: usize,
        at: [i16; 2],
        mask_at: [i16; 2],
        to: [i16; 2],
        size: [u16; 2],
    },
    Paint {
        op: PictOp,
        on: usize,
        colour: Color,
        list: Vec<Rectangle>,
    },
    Picture {
        pic: usize,
        repeat: Repeat,
        component: bool,
    },
    PictureClip {
        pic: usize,
        rectangles: Vec<Rectangle>,
    },
    Transformed {
        pic: usize,
        matrix: Transform,
        filter: &'static str,
    },
    Trapezoids {
        op: PictOp,
        from: usize,
        on: usize,
        masked: bool,
        at: [i16; 2],
        list: Vec<Trapezoid>,
    },
    Triangles {
        op: PictOp,
        from: usize,
        on: usize,
        masked: bool,
        at: [i16; 2],
        list: Vec<Triangle>,
    },
    Glyphs {
        op: PictOp,
        from: usize,
        on: usize,
        mask: Option<Gathered>,
        at: [i16; 2],
        /// Numbers from [`GLYPHS`] on are of the second set.
        list: Vec<(u8, [i16; 2])>,
    },
    /// One pixel inverted: what a scene must not differ by without being found out.
    Blot {
        on: usize,
        at: [i16; 2],
    },
}

/// Format of a mask that glyphs are added up in.
#[derive(Clone, Copy, Debug)]
pub enum Gathered {
    /// Alpha alone.
    Alpha,
    /// Each channel by itself.
    Components,
}
