//! One map over a picture: what the Za words say, tokens of the lines, lists of the tiles, pixels of the sub-pixel
//! unit.
//!
//! Inputs from: frames, [`ZaWords`], [`Survey`], [`SubpixelMap`]. Outputs to: `zga show --view`, the window,
//! [`super::sheet`].
//!
//! * za: cleared blocks are hatched, initialised ones are shaded by their word from light (near) to dark, and blue where
//!   the word is the farthest depth: some of the block is still background.
//! * tokens: a bar on each line, as long as its tokens; what is left of the mark hides behind the luminance bus.
//! * tiles: the longer a tile's list, the lighter.
//! * subpixel: a colour for each reason why the unit took a pixel up; the others are the path's and stay grey.

use zga_abi::format::HiddenSurface;
use zga_device::{Reason, SubpixelMap};
use zga_driver::Frame;

use super::survey::{Survey, lines, tiles};
use crate::canvas::{Canvas, Ink, heat};
use crate::error::Result;
use crate::picture::Picture;
use crate::play::{Look, Session, Settings, ZaWords};
use crate::scene::Scene;

/// Cleared blocks.
pub(super) const CLEARED: Ink = [18, 22, 34];
/// Their hatching.
pub(super) const HATCH: Ink = [44, 52, 76];
/// Blocks that are initialised and hold background still.
pub(super) const OPEN: Ink = [40, 84, 150];
/// The nearest and the farthest of the other words.
pub(super) const NEAR_FAR: [Ink; 2] = [[255, 240, 200], [120, 50, 40]];
/// The tokens of a line that take no longer than its pixels on the bus.
pub(super) const FREE: Ink = [60, 190, 180];
/// The tokens beyond.
pub(super) const COSTLY: Ink = [244, 130, 70];
/// Pixels that a fragment covers a part of.
const EDGE: Ink = [44, 168, 172];
/// Pixels where two fragments that cover all of it cross.
const CROSSING: Ink = [255, 214, 92];
/// Pixels with a translucent fragment.
const LAYER: Ink = [150, 92, 214];
/// Pixels that found no room.
const DEGRADED: Ink = [255, 56, 48];
/// Lines between cells, part of 255.
const LINES: u8 = 70;
/// Clocks that a token takes to enter the array.
const TOKEN_CLOCKS: u64 = 3;

/// What is painted over a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// The Za words after the frame.
    Za,
    /// The tokens of each line.
    Tokens,
    /// The list of each tile.
    Tiles,
    /// The pixels that the sub-pixel unit took up.
    Subpixel,
}

impl View {
    /// Every view with its name on the command line.
    pub const NAMED: &'static [(&'static str, Self)] =
        &[("za", Self::Za), ("tokens", Self::Tokens), ("tiles", Self::Tiles), ("subpixel", Self::Subpixel)];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Za => "za",
            Self::Tokens => "tokens",
            Self::Tiles => "tiles",
            Self::Subpixel => "subpixel",
        }
    }

    /// The view of a path; `None` for the plain Z buffer, which knows nothing beside its depths.
    #[must_use]
    pub fn of(path: HiddenSurface) -> Option<Self> {
        Self::NAMED.iter().map(|(_, view)| *view).find(|view| view.path() == Some(path))
    }

    /// The path that the view is of; `None` for the view of the sub-pixel unit, which works behind each of them.
    #[must_use]
    pub const fn path(self) -> Option<HiddenSurface> {
        match self {
            Self::Za => Some(HiddenSurface::Za),
            Self::Tokens => Some(HiddenSurface::Systolic),
            Self::Tiles => Some(HiddenSurface::Tile),
            Self::Subpixel => None,
        }
    }

    /// What its colours mean, in a line.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Za => {
                "hatched: cleared; blue: initialised, some of the block is background; light to dark: its farthest \
                 depth, near to far"
            }
            Self::Tokens => {
                "bar: tokens of the line; the mark is where they begin to take longer than the pixels on the bus"
            }
            Self::Tiles => "dark to light: polygons in the list of the tile",
            Self::Subpixel => {
                "teal: edge, covered in part; yellow: crossing, two that cover all of it; violet: layer, translucent; \
                 red: degraded, no room in the pool; grey: left as the path drew it"
            }
        }
    }

    /// The view over a frame of the scene, which the session has just drawn. The pixels of the sub-pixel unit are found
    /// by drawing it once more; tokens and tiles by drawing it many times more, see [`Survey`].
    ///
    /// # Errors
    /// [`crate::Error::Driver`]; [`crate::Error::Card`] where the card's thread is gone.
    pub fn paint(self, session: &mut Session, scene: &Scene, look: Look, frame: &Frame) -> Result<Picture> {
        let picture = Picture::of_frame(frame);
        let maximum = session.settings().depth.maximum() as i32;
        Ok(match self {
            Self::Za => session.za_words()?.map_or(picture.clone(), |words| za(&picture, &words, maximum, 1)),
            Self::Tokens => {
                let map = lines(session, scene, look)?;
                tokens(&picture, &map, free_tokens(session.settings(), picture.width, map.units), 1)
            }
            Self::Tiles => cells(&picture, &tiles(session, scene, look)?, 1),
            Self::Subpixel => session.subpixels()?.map_or(picture.clone(), |map| subpixels(&picture, &map)),
        })
    }
}

/// The Za words in place of the picture, with a little of it left; `times` as large.
pub(super) fn za(picture: &Picture, words: &ZaWords, maximum: i32, times: u32) -> Picture {
    let known = || words.words.iter().copied().filter(|word| (0..maximum).contains(word));
    let (near, far) = (known().min().unwrap_or(0), known().max().unwrap_or(maximum));
    let range = f64::from(far - near).max(1.0);
    let ink = |x: u32, y: u32| match words.at(x / times, y / times) {
        Some(word) if word < 0 => (if (x + y).is_multiple_of(6) { HATCH } else { CLEARED }, 235),
        Some(word) if word >= maximum => (OPEN, 190),
        Some(word) => (mix(NEAR_FAR, f64::from(word - near) / range), 215),
        None => (CLEARED, 0),
    };
    let mut canvas = over(picture, times, ink);
    grid(&mut canvas, words.block.map(|side| side * times));
    canvas.into_picture()
}

/// A heat map of cells over the grey picture; `times` as large.
pub(super) fn cells(picture: &Picture, map: &Survey, times: u32) -> Picture {
    let most = (map.most().max(1)) as f64;
    let ink = |x: u32, y: u32| match map.at(x / times, y / times) {
        0 => (CLEARED, 205),
        // A root tells few apart as well as many.
        count => (heat(0.12 + 0.88 * (count as f64 / most).sqrt()), 225),
    };
    let mut canvas = over(picture, times, ink);
    grid(&mut canvas, map.cell.map(|side| side * times));
    canvas.into_picture()
}

/// A bar on each line, the longest three quarters of the picture, with a mark at `free` tokens; `times` as large.
pub(super) fn tokens(picture: &Picture, map: &Survey, free: u64, times: u32) -> Picture {
    let width = picture.width * times;
    let room = f64::from(width) * 0.75;
    let most = map.most().max(1);
    let length = |count: u64| (room * count as f64 / most as f64).round() as u32;
    let ink = |x: u32, y: u32| {
        let count = map.at(0, y / times);
        match x < length(count) {
            true if x < length(free.min(most)) => (FREE, 205),
            true => (COSTLY, 215),
            false => (CLEARED, 165),
        }
    };
    let mut canvas = over(picture, times, ink);
    if free < most {
        canvas.tint([length(free), 0], [1, picture.height * times], [255; 3], 150);
    }
    canvas.into_picture()
}

/// A colour for each reason over the grey picture.
fn subpixels(picture: &Picture, map: &SubpixelMap) -> Picture {
    let ink = |x: u32, y: u32| match map.at(x, y) {
        Reason::Untouched => (CLEARED, 150),
        Reason::Edge => (EDGE, 215),
        Reason::Crossing => (CROSSING, 235),
        Reason::Layer => (LAYER, 205),
        Reason::Degraded => (DEGRADED, 245),
    };
    over(picture, 1, ink).into_picture()
}

/// The most tokens of `lines` lines of `width` pixels that do not make them any longer: a line takes the longer of
/// its pixels on the bus and its tokens with the refresh token. A Super Buffer takes in none meanwhile.
pub(super) fn free_tokens(settings: &Settings, width: u32, lines: u32) -> u64 {
    let of_a_line = if settings.systolic.super_buffer { 0 } else { u64::from(width) / TOKEN_CLOCKS };
    u64::from(lines) * of_a_line.saturating_sub(1)
}

/// The picture in grey, `times` as large, with each pixel moved toward an ink as far as `ink` says.
fn over(picture: &Picture, times: u32, ink: impl Fn(u32, u32) -> (Ink, u8)) -> Canvas {
    let size = [picture.width * times, picture.height * times];
    let mut canvas = Canvas::new(size, [0; 3]);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let [r, g, b] = picture.at(x / times, y / times).unwrap_or_default().map(u32::from);
            let grey = ((54 * r + 183 * g + 19 * b) / 256) as u8;
            canvas.set(x, y, [grey; 3]);
            let (ink, part) = ink(x, y);
            canvas.blend(x, y, ink, part);
        }
    }
    canvas
}

/// Lines between cells that are large enough to have some.
fn grid(canvas: &mut Canvas, [width, height]: [u32; 2]) {
    let size = canvas.size();
    if width < 4 || height < 4 {
        return;
    }
    for x in (width..size[0]).step_by(width as usize) {
        canvas.tint([x, 0], [1, size[1]], [0; 3], LINES);
    }
    for y in (height..size[1]).step_by(height as usize) {
        canvas.tint([0, y], [size[0], 1], [0; 3], LINES);
    }
}

/// A colour between two.
pub(super) fn mix([from, to]: [Ink; 2], t: f64) -> Ink {
    std::array::from_fn(|c| (f64::from(from[c]) + (f64::from(to[c]) - f64::from(from[c])) * t).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::tests::settings;
    use zga_driver::SystolicVariant;

    fn plain(width: u32, height: u32) -> Picture {
        Picture { width, height, rgb: vec![128; (width * height * 3) as usize] }
    }

    #[test]
    fn za_cleared_open_and_near_blocks_look_different() {
        let words = ZaWords { block: [2, 2], blocks: [3, 1], words: vec![-1, 255, 7] };
        let painted = za(&plain(6, 2), &words, 255, 2);
        assert_eq!((painted.width, painted.height), (12, 4));
        let inks = [1, 5, 9].map(|x| painted.at(x, 1));
        assert!(inks[0] != inks[1] && inks[1] != inks[2] && inks[0] != inks[2], "{inks:?}");
    }

    #[test]
    fn tokens_bars_are_as_long_as_the_tokens() {
        let map = Survey { name: "", cell: [8, 1], units: 1, cells: [1, 2], values: vec![4, 2], whole: None };
        let painted = tokens(&plain(8, 2), &map, 1, 1);
        let lit = |y: u32| (0..8).filter(|x| painted.at(*x, y).is_some_and(|[r, g, _]| r.max(g) > 110)).count();
        assert_eq!([lit(0), lit(1)], [6, 3]);
    }

    #[test]
    fn subpixels_every_reason_has_an_ink_of_its_own() {
        let width = Reason::ALL.len() as u32;
        let map = SubpixelMap { width, height: 1, reasons: Reason::ALL.to_vec() };
        let painted = subpixels(&plain(width, 1), &map);
        let inks: Vec<_> = (0..width).filter_map(|x| painted.at(x, 0)).collect();
        let light = |[r, g, b]: Ink| (54 * u32::from(r) + 183 * u32::from(g) + 19 * u32::from(b)) / 256;
        assert_eq!(inks.len(), Reason::ALL.len());
        for (place, ink) in inks.iter().enumerate() {
            let apart = |other: &Ink| (0..3).map(|c| u32::from(ink[c].abs_diff(other[c]))).sum::<u32>();
            assert!(inks[..place].iter().all(|other| apart(other) > 150), "{inks:?}");
        }
        assert!(
            inks[1..].iter().all(|ink| light(*ink) > light(inks[0]) + 16),
            "what is left alone is darkest: {inks:?}"
        );
    }

    #[test]
    fn of_each_path_but_the_plain_one_is_found_and_the_unit_belongs_to_none() {
        let found = HiddenSurface::ALL.iter().map(|path| View::of(*path)).collect::<Vec<_>>();
        assert_eq!(found, [None, Some(View::Za), Some(View::Tokens), Some(View::Tiles)]);
        assert_eq!(View::Subpixel.path(), None);
    }

    #[test]
    fn free_tokens_leave_room_for_the_refresh_token() {
        // 3 (31 + 1) = 96: tokens and refresh token take as long as the pixels.
        let array = settings();
        assert_eq!((free_tokens(&array, 96, 1), free_tokens(&array, 2, 1)), (31, 0));
        let systolic = SystolicVariant { super_buffer: true, ..array.systolic };
        assert_eq!(free_tokens(&Settings { systolic, ..array }, 96, 1), 0);
    }
}
