//! Boxes of pixels.

use zga_driver::{ClipBox, ListRectangle};

use super::request::{MOST_SIDE, Surface};

/// A box of pixels, ends exclusive, that is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    pub x1: i32,
    pub y1: i32,
    pub x2: i32,
    pub y2: i32,
}

impl Area {
    /// What two boxes have in common.
    pub fn common(self, other: Area) -> Option<Area> {
        let (x1, y1) = (self.x1.max(other.x1), self.y1.max(other.y1));
        let (x2, y2) = (self.x2.min(other.x2), self.y2.min(other.y2));
        (x1 < x2 && y1 < y2).then_some(Area { x1, y1, x2, y2 })
    }

    /// Somewhere else.
    pub fn plus(self, [x, y]: [i32; 2]) -> Area {
        Area { x1: self.x1 + x, y1: self.y1 + y, x2: self.x2 + x, y2: self.y2 + y }
    }

    /// Pixels in it.
    pub fn pixels(self) -> u64 {
        u64::from((self.x2 - self.x1).unsigned_abs()) * u64::from((self.y2 - self.y1).unsigned_abs())
    }

    /// All of a surface.
    pub fn of(surface: Surface) -> Area {
        let [x2, y2] = surface.size.map(|side| side.min(MOST_SIDE) as i32);
        Area { x1: 0, y1: 0, x2, y2 }
    }
}

impl From<ClipBox> for Area {
    fn from(clip: ClipBox) -> Area {
        Area { x1: clip.x1.into(), y1: clip.y1.into(), x2: clip.x2.into(), y2: clip.y2.into() }
    }
}

impl From<ListRectangle> for Area {
    fn from(one: ListRectangle) -> Area {
        let (x1, y1) = (i32::from(one.x), i32::from(one.y));
        Area { x1, y1, x2: x1 + i32::from(one.width), y2: y1 + i32::from(one.height) }
    }
}
