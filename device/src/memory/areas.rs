//! Areas: the frames whose logical clears Za RAM holds.
//!
//! Duties: knows for each such frame which words of Za RAM are its own, what its cleared blocks stand
//! for, and whether its words still describe its Z buffer; brings cleared blocks to memory before
//! somebody else needs what is there.
//! Inputs: targets of scenes, clears; what the host and other units change. Outputs: Za words, pixels and
//! depths of cleared blocks. Clocks: those of [`za::memory`].
//!
//! A frame is known by its surfaces, format and block shape. Two frames can share a Z buffer, as those of
//! a double-buffered picture do: the one drawn to last owns the depths, the words of the other still say
//! which of its blocks are cleared, which is all that scan-out asks for.

use crate::hidden::z_buffer::surfaces_of;
use crate::hidden::za::memory::{Frame, MemoryCounts, Settle};
use crate::hidden::za::{Background, Grid, Surfaces};
use crate::probe::account::Account;
use std::ops::Range;
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::{DepthSurface, Rectangle, Surface, Target};

/// Most frames with logical clears at a time; the one that was used least lately gives its place up.
pub(crate) const MOST_AREAS: usize = 16;

/// A frame whose logical clears Za RAM holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    /// Frame buffer.
    pub(crate) colour: Surface,
    /// Z buffer.
    pub(crate) depth: Option<DepthSurface>,
    /// Bits of a depth; the fraction bits of gradients do not matter here and are the default's.
    pub(crate) depth_format: DepthFormat,
    /// First word in Za RAM.
    pub(crate) base: u32,
    /// Width and height of a block.
    pub(crate) block: [u32; 2],
    /// What a cleared block stands for.
    pub(crate) background: Background,
    /// The words of initialised blocks are the maxima of the Z buffer.
    pub(crate) exact: bool,
    /// The Z buffer holds this frame's depths, and those of its cleared blocks are still to be written.
    pub(crate) owns_depth: bool,
}

impl Area {
    /// The area of a scene's target, with words that mean nothing yet.
    fn of(target: &Target) -> Area {
        Area {
            colour: target.colour,
            depth: target.depth,
            depth_format: DepthFormat::new(target.depth_format.bits(), DepthFormat::default().fraction())
                .unwrap_or_default(),
            base: target.za.base,
            block: target.za.block,
            background: Background { pixel: 0, depth: target.depth_format.maximum() as i32 },
            exact: false,
            owns_depth: false,
        }
    }

    /// Whether this is the area of `target`.
    pub(crate) fn is_of(&self, target: &Target) -> bool {
        let other = Area::of(target);
        Area { background: other.background, exact: other.exact, owns_depth: other.owns_depth, ..*self } == other
    }

    /// The blocks.
    pub(crate) fn grid(&self) -> Grid {
        Grid { block: self.block, size: [self.colour.width, self.colour.height] }
    }

    /// Its words in Za RAM.
    pub(crate) fn words(&self) -> Range<usize> {
        let first = self.base as usize;
        first..first + self.grid().words()
    }

    /// Where its pixels lie.
    fn frame(&self) -> Frame {
        Frame {
            grid: self.grid(),
            pixel_format: self.colour.format,
            colour_pitch: self.colour.pitch as usize / 4,
            depth_format: self.depth_format,
            depth_pitch: self.depth.map(|depth| depth.pitch as usize / 4),
        }
    }

    /// Bytes of its frame buffer.
    fn colour_bytes(&self) -> Range<u64> {
        bytes(self.colour.base, self.colour.pitch, self.colour.height)
    }

    /// Bytes of its Z buffer.
    fn depth_bytes(&self) -> Range<u64> {
        self.depth.map_or(0..0, |depth| bytes(depth.base, depth.pitch, self.colour.height))
    }

    /// Its part of both memories.
    fn surfaces<'m>(&self, video: &'m mut [u32], za: &'m mut [i32]) -> Surfaces<'m> {
        let (colour, depth) = surfaces_of(video, &self.colour, self.depth.as_ref());
        Surfaces { colour, depth, words: &mut za[self.words()], stencil: &mut [] }
    }

    /// Clears a part of the frame, or one of its planes; `pixel` as it is stored. The words must be exact.
    pub(crate) fn clear_rectangle(
        &self,
        parts: &mut Parts<'_>,
        area: &Rectangle,
        pixel: Option<u32>,
        depth: Option<i32>,
    ) -> MemoryCounts {
        let mut surfaces = self.surfaces(parts.video, parts.za);
        self.frame().clear_rectangle(area, pixel, depth, Some(&self.background), &mut surfaces)
    }
}

/// Words of an area in a snapshot.
const AREA_WORDS: usize = 16;
/// An area's flag in a snapshot: there is a Z buffer.
const HAS_DEPTH: u32 = 1;
/// An area's flag in a snapshot: it owns its depths.
const OWNS_DEPTH: u32 = 2;

impl Area {
    fn words_of(&self) -> [u32; AREA_WORDS] {
        let depth = self.depth.unwrap_or(DepthSurface { base: 0, pitch: 0 });
        let has_depth = if self.depth.is_some() { HAS_DEPTH } else { 0 };
        let owns_depth = if self.owns_depth { OWNS_DEPTH } else { 0 };
        let Surface { base, pitch, width, height, format } = self.colour;
        let Background { pixel, depth: background } = self.background;
        let [across, down] = self.block;
        let bits = self.depth_format.bits();
        let flags = has_depth | owns_depth;
        let (depth_base, depth_pitch) = (depth.base, depth.pitch);
        [
            base,
            pitch,
            width,
            height,
            format.code(),
            flags,
            depth_base,
            depth_pitch,
            bits,
            self.base,
            across,
            down,
            pixel,
            background as u32,
            0,
            0,
        ]
    }

    /// The reverse, checked as the firmware checks a target. What happened to the Z buffer since is not
    /// known: the words are not exact.
    fn from_words(record: &[u32; AREA_WORDS], video: usize, za_bytes: u32) -> Option<Area> {
        let &[
            base,
            pitch,
            width,
            height,
            format,
            flags,
            depth_base,
            depth_pitch,
            bits,
            za,
            across,
            down,
            pixel,
            z,
            _,
            _,
        ] = record;
        let sides = 1..=16384;
        let depth_format = DepthFormat::new(bits, DepthFormat::default().fraction())?;
        let area = Area {
            colour: Surface { base, pitch, width, height, format: PixelFormat::from_code(format)? },
            depth: (flags & HAS_DEPTH != 0).then_some(DepthSurface { base: depth_base, pitch: depth_pitch }),
            depth_format,
            base: za,
            block: [across, down],
            background: Background { pixel, depth: i32::try_from(z).ok()? },
            exact: false,
            owns_depth: flags & OWNS_DEPTH != 0,
        };
        let inside = |bytes: Range<u64>| bytes.end <= 4 * video as u64;
        let aligned = [base, pitch, depth_base, depth_pitch].iter().all(|value| value.is_multiple_of(64));
        let whole = [width, height, across, down].iter().all(|side| sides.contains(side))
            && aligned
            && za.is_multiple_of(16)
            && z <= depth_format.maximum()
            && u64::from(width) * u64::from(area.colour.format.bytes()) <= u64::from(pitch)
            && (area.depth.is_none() || 4 * u64::from(width) <= u64::from(depth_pitch))
            && inside(area.colour_bytes())
            && inside(area.depth_bytes())
            && !overlap(&area.colour_bytes(), &area.depth_bytes())
            && area.words().end <= za_bytes as usize / 4;
        whole.then_some(area)
    }
}

/// Bytes of a surface's rows.
fn bytes(base: u32, pitch: u32, height: u32) -> Range<u64> {
    u64::from(base)..u64::from(base) + u64::from(pitch) * u64::from(height)
}

fn overlap<T: Ord>(a: &Range<T>, b: &Range<T>) -> bool {
    a.start < b.end && b.start < a.end
}

/// What the Za unit and scan-out know of logical clears.
#[derive(Debug, Default)]
pub(crate) struct Areas {
    /// The one used last stands at the end.
    areas: Vec<Area>,
    /// The last one is the frame of a scene on the Za path.
    open: bool,
    /// Changes by others to the Z buffers when the words were last known to be exact.
    foreign: u64,
}

/// Both memories, to work on.
pub(crate) struct Parts<'m> {
    /// Words of video memory.
    pub(crate) video: &'m mut [u32],
    /// Words of Za RAM.
    pub(crate) za: &'m mut [i32],
    /// Changes by others to what is remembered.
    pub(crate) foreign: u64,
}

impl Areas {
    /// All of them.
    pub(crate) fn all(&self) -> &[Area] {
        &self.areas
    }

    /// All of them as words, for a snapshot.
    pub(crate) fn to_words(&self) -> Vec<u32> {
        self.areas.iter().flat_map(Area::words_of).collect()
    }

    /// The reverse of [`Areas::to_words`], on a card with so many words of video memory and bytes of Za RAM;
    /// `open` is the target of a scene that is open on the Za path. `None` where no card can be so.
    pub(crate) fn from_words(words: &[u32], video: usize, za_bytes: u32, open: Option<&Target>) -> Option<Areas> {
        let (records, rest) = words.as_chunks::<AREA_WORDS>();
        if !rest.is_empty() || records.len() > MOST_AREAS {
            return None;
        }
        let areas =
            records.iter().map(|record| Area::from_words(record, video, za_bytes)).collect::<Option<Vec<_>>>()?;
        let matches = open.is_none_or(|target| areas.last().is_some_and(|area| area.is_of(target)));
        matches.then_some(Areas { areas, open: open.is_some(), foreign: 0 })
    }

    /// The area of the frame of the scene that is open on the Za path.
    pub(crate) fn open_area(&self) -> Option<&Area> {
        self.areas.last().filter(|_| self.open)
    }

    /// Its words in Za RAM.
    pub(crate) fn words(&self) -> Range<usize> {
        self.open_area().map_or(0..0, Area::words)
    }

    /// The scene is over.
    pub(crate) fn end_scene(&mut self) {
        self.open = false;
    }

    /// Words of video memory whose changes by others matter: the Z buffers.
    pub(crate) fn remembered(&self) -> Range<usize> {
        let depths = self.areas.iter().map(Area::depth_bytes).filter(|bytes| !bytes.is_empty());
        let all = depths.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end)).unwrap_or(0..0);
        (all.start / 4) as usize..(all.end / 4) as usize
    }

    /// The area of a frame that is shown.
    pub(crate) fn shown(&self, surface: &Surface) -> Option<&Area> {
        self.areas.iter().rev().find(|area| area.colour == *surface)
    }

    /// A scene on the Za path begins: its frame gets its area.
    pub(crate) fn begin_scene(&mut self, parts: &mut Parts<'_>, target: &Target, account: &mut Account) {
        let mine = Area::of(target);
        let (colour, depth, words) = (mine.colour_bytes(), mine.depth_bytes(), mine.words());
        let stencil = stencil_bytes(target);
        // Frames that lie in the way go to memory. A Z buffer can be shared as long as the first command
        // is a clear: that is seen then.
        self.settle_where(parts, account, |area| {
            !area.is_of(target)
                && (overlap(&area.words(), &words)
                    || overlap(&area.colour_bytes(), &colour)
                    || overlap(&area.colour_bytes(), &depth)
                    || overlap(&area.depth_bytes(), &colour)
                    || overlap(&area.colour_bytes(), &stencil)
                    || overlap(&area.depth_bytes(), &stencil)
                    || (overlap(&area.depth_bytes(), &depth) && area.depth_bytes() != depth))
        });
        match self.areas.iter().position(|area| area.is_of(target)) {
            Some(found) => self.areas[found..].rotate_left(1),
            None => {
                if self.areas.len() == MOST_AREAS {
                    let oldest = self.areas[0];
                    self.settle_where(parts, account, |area| *area == oldest);
                }
                // A new frame has no cleared blocks, whatever the words say; the depths are not its own.
                parts.za[words].fill(0);
                self.areas.push(mine);
            }
        }
        self.open = true;
    }

    /// The area of the scene's frame, with words that are exact, before anything is drawn to it or a part
    /// of it is cleared.
    pub(crate) fn ready(&mut self, parts: &mut Parts<'_>, account: &mut Account) -> Option<Area> {
        self.notice(parts.foreign);
        let index = self.areas.len().checked_sub(1).filter(|_| self.open)?;
        let mine = self.areas[index];
        if mine.exact && mine.owns_depth {
            return Some(mine);
        }
        if !mine.owns_depth {
            // The depths are another frame's: all of them must be in memory, and none of ours count.
            let depth = mine.depth_bytes();
            for other in 0..index {
                if self.areas[other].owns_depth && overlap(&self.areas[other].depth_bytes(), &depth) {
                    settle(&mut self.areas[other], parts, account);
                    self.areas[other].owns_depth = false;
                }
            }
            settle(&mut self.areas[index], parts, account);
        }
        let area = &mut self.areas[index];
        let (frame, words) = (area.frame(), 0..area.words().len());
        let mut surfaces = area.surfaces(parts.video, parts.za);
        frame.derive(words, area.owns_depth, &mut surfaces).charge(account);
        (area.exact, area.owns_depth) = (true, true);
        Some(*area)
    }

    /// Brings cleared blocks of the scene's frame to memory that lie in one of `places`; `None` is everywhere.
    pub(crate) fn settle_open(
        &mut self,
        parts: &mut Parts<'_>,
        places: impl Iterator<Item = Option<Rectangle>>,
        account: &mut Account,
    ) {
        let Some(area) = self.ready(parts, account) else {
            return;
        };
        let frame = area.frame();
        let mut surfaces = area.surfaces(parts.video, parts.za);
        for place in places {
            frame.settle(&area.background, place.as_ref(), Settle::All, &mut surfaces).charge(account);
        }
    }

    /// All of the scene's frame is cleared: no word, no depth and no pixel from before counts. Returns the
    /// area, whose words are to be written now.
    pub(crate) fn clear_all(&mut self, parts: &Parts<'_>, background: Background) -> Option<Area> {
        self.notice(parts.foreign);
        let index = self.areas.len().checked_sub(1).filter(|_| self.open)?;
        let depth = self.areas[index].depth_bytes();
        for other in &mut self.areas[..index] {
            if overlap(&other.depth_bytes(), &depth) {
                other.owns_depth = false;
            }
        }
        let area = &mut self.areas[index];
        (area.background, area.exact, area.owns_depth) = (background, true, true);
        Some(*area)
    }

    /// Somebody else is about to use `bytes` of video memory: cleared blocks of frames there go to memory.
    /// If they are going to be `changed`, the words of Z buffers there are not exact any more.
    pub(crate) fn release(&mut self, parts: &mut Parts<'_>, bytes: Range<u64>, changed: bool, account: &mut Account) {
        for area in &mut self.areas {
            let depth = overlap(&area.depth_bytes(), &bytes);
            if depth || overlap(&area.colour_bytes(), &bytes) {
                settle(area, parts, account);
            }
            area.exact &= !(depth && changed);
        }
    }

    /// Another path begins a scene on `target`: frames that it touches go to memory and are forgotten.
    pub(crate) fn release_target(&mut self, parts: &mut Parts<'_>, target: &Target, account: &mut Account) {
        let mine = Area::of(target);
        let surfaces = [mine.colour_bytes(), mine.depth_bytes(), stencil_bytes(target)];
        self.settle_where(parts, account, |area| {
            surfaces.iter().any(|s| overlap(&area.colour_bytes(), s) || overlap(&area.depth_bytes(), s))
        });
    }

    /// Brings frames to memory and forgets them.
    fn settle_where(&mut self, parts: &mut Parts<'_>, account: &mut Account, which: impl Fn(&Area) -> bool) {
        for area in self.areas.iter_mut().filter(|area| which(area)) {
            settle(area, parts, account);
        }
        self.areas.retain(|area| !which(area));
    }

    /// After changes by others no word is sure.
    fn notice(&mut self, foreign: u64) {
        if self.foreign != foreign {
            self.foreign = foreign;
            self.areas.iter_mut().for_each(|area| area.exact = false);
        }
    }
}

/// Bytes of a target's stencil plane; none without one.
fn stencil_bytes(target: &Target) -> Range<u64> {
    target.stencil.map_or(0..0, |plane| bytes(plane.base, plane.pitch, target.colour.height))
}

/// Brings an area's cleared blocks to memory: depths too, unless the Z buffer is another frame's by now.
fn settle(area: &mut Area, parts: &mut Parts<'_>, account: &mut Account) {
    let planes = if area.owns_depth { Settle::All } else { Settle::Colour };
    let mut surfaces = area.surfaces(parts.video, parts.za);
    area.frame().settle(&area.background, None, planes, &mut surfaces).charge(account);
    if planes == Settle::Colour {
        // Not cleared any more; what the words are is found out when the depths are wanted.
        surfaces.words.iter_mut().for_each(|word| *word = (*word).max(0));
        area.exact = false;
    }
}

/// A rectangle of a whole surface.
pub(crate) fn whole(surface: &Surface) -> Rectangle {
    Rectangle { x: 0, y: 0, right: surface.width, bottom: surface.height }
}
