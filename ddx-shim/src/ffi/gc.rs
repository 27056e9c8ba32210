//! Drawing requests: lists go to the card as they are.
//!
//! The operations of a GC are in layers: damage on top (it reports what is drawn before and after), then these, then EXA,
//! then the server's renderer. `CreateGC` is wrapped after EXA and before the layers above, so that the table that a new
//! GC has is EXA's; it gets a copy of that table with some entries replaced. An entry that does not want a request hands
//! it down to EXA's.

use std::cell::Cell;
use std::ffi::{c_int, c_uint, c_void};

use super::screen::{pixmap_of, with_engine};
use super::server::{self, DrawablePtr, GCOps, GCPtr, ScreenPtr, xRectangle, xSegment};
use zga_driver::{BitmapGlyph, ClipBox, ListRectangle, Segment};

use super::pixels::Open;
use super::screen;
use crate::engine::Engine;
use crate::engine::lists::{Onto, Points};
use crate::format::raster;

/// The tables of operations.
#[derive(Clone, Copy)]
pub struct Tables {
    /// EXA's.
    below: *const GCOps,
    /// The same with some entries replaced.
    ours: *const GCOps,
}

thread_local! {
    // One pair for all screens and generations: EXA has one table.
    static TABLES: Cell<Option<Tables>> = const { Cell::new(None) };
}

/// Puts this layer over EXA's.
///
/// # Safety
/// `pscreen` is in ScreenInit, after EXA has started.
pub unsafe fn wrap(pscreen: ScreenPtr) {
    // SAFETY: the caller vouches for it.
    unsafe {
        if let Some(screen) = screen::of_screen(pscreen) {
            screen.wrapped.create_gc = (*pscreen).CreateGC;
            (*pscreen).CreateGC = Some(create_gc);
        }
    }
}

unsafe extern "C" fn create_gc(gc: GCPtr) -> server::Bool {
    // SAFETY: the server calls with a GC of a screen of this driver; the wrapped function is called with its own pointer in
    // place; no reference to the state lives across the call.
    unsafe {
        let pscreen = (*gc).pScreen;
        let Some(below) = screen::of_screen(pscreen).and_then(|screen| screen.wrapped.create_gc) else { return 0 };
        (*pscreen).CreateGC = Some(below);
        let made = below(gc);
        (*pscreen).CreateGC = Some(create_gc);
        if made != 0 {
            (*gc).ops = tables((*gc).ops).ours;
        }
        made
    }
}

/// The tables over EXA's `below`.
///
/// # Safety
/// `below` is EXA's table, which lives as long as the server.
unsafe fn tables(below: *const GCOps) -> Tables {
    if let Some(tables) = TABLES.get().filter(|tables| tables.below == below) {
        return tables;
    }
    // SAFETY: the caller vouches for it.
    let mut ours = unsafe { *below };
    ours.FillSpans = Some(fill_spans);
    ours.PolyPoint = Some(poly_point);
    ours.Polylines = Some(polylines);
    ours.PolySegment = Some(poly_segment);
    ours.PolyFillRect = Some(poly_fill_rectangle);
    ours.ImageGlyphBlt = Some(image_glyph_blt);
    ours.PolyGlyphBlt = Some(poly_glyph_blt);
    // Once in the life of the server; GCs point to it.
    let tables = Tables { below, ours: Box::leak(Box::new(ours)) };
    TABLES.set(Some(tables));
    tables
}

/// EXA's table.
fn below() -> &'static GCOps {
    let Some(tables) = TABLES.get() else {
        // A GC that calls here was given the table.
        unreachable!("no GC was made")
    };
    // SAFETY: EXA's table lives as long as the server, and nobody writes to it.
    unsafe { &*tables.below }
}

/// Has the engine draw a list of a GC.
///
/// # Safety
/// Drawable and GC are the server's, and validated for each other.
unsafe fn draw(
    hook: &str,
    drawable: DrawablePtr,
    gc: GCPtr,
    function: u32,
    body: impl FnOnce(&mut Engine, &Onto<'_>) -> bool,
) -> bool {
    // SAFETY: the caller vouches for it; the clip of a validated GC is a region of boxes, which lives while the request is
    // drawn.
    unsafe {
        let (pixmap, moved) = pixmap_of(drawable);
        if pixmap.is_null() {
            return false;
        }
        let (drawable, gc) = (&*drawable, &*gc);
        let Some(raster) = raster(function, gc.planemask, drawable.depth.into()) else { return false };
        let clips = boxes(gc.pCompositeClip);
        let origin = [i32::from(drawable.x) + moved[0], i32::from(drawable.y) + moved[1]];
        with_engine(hook, drawable.pScreen, false, |engine, exa| {
            let Some(pixmap) = exa.number(pixmap) else { return false };
            body(engine, &Onto { pixmap, origin, moved, clips, raster })
        })
    }
}

/// The boxes of a region.
///
/// # Safety
/// `region` is null or a region of the server, which lives for `'a`.
pub unsafe fn boxes<'a>(region: server::RegionPtr) -> &'a [ClipBox] {
    // SAFETY: without data a region is its extents; else the boxes follow the data's header. ClipBox is laid out as BoxRec.
    unsafe {
        let Some(region) = region.as_ref() else { return &[] };
        match region.data.as_ref() {
            None => std::slice::from_raw_parts((&raw const region.extents).cast(), 1),
            Some(data) => {
                let count = usize::try_from(data.numRects).unwrap_or(0);
                std::slice::from_raw_parts(region.data.add(1).cast(), count)
            }
        }
    }
}

/// A list of the server's; empty if there is none.
///
/// # Safety
/// `list` is null or points to `count` entries that live for `'a` and are laid out as `T`.
unsafe fn list<'a, S, T>(list: *const S, count: c_int) -> &'a [T] {
    const { assert!(size_of::<S>() == size_of::<T>() && align_of::<S>() >= align_of::<T>()) };
    match usize::try_from(count) {
        // SAFETY: the caller vouches for it.
        Ok(count) if count > 0 && !list.is_null() => unsafe { std::slice::from_raw_parts(list.cast(), count) },
        _ => &[],
    }
}

/// A solid fill style.
///
/// # Safety
/// `gc` is the server's.
unsafe fn is_solid(gc: GCPtr) -> bool {
    // SAFETY: the caller vouches for it.
    unsafe { (*gc).fillStyle() == server::FillSolid }
}

/// Lines of one pixel's width without dashes, of a solid fill style.
///
/// # Safety
/// `gc` is the server's.
unsafe fn is_thin(gc: GCPtr) -> bool {
    // SAFETY: the caller vouches for it.
    unsafe { (*gc).lineWidth == 0 && (*gc).lineStyle() == server::LineSolid && is_solid(gc) }
}

/// Draws what the card has not drawn: by the server's own renderer if `past_exa`, else by EXA.
///
/// EXA draws lines along the axes as rectangles, whose ends it draws twice where lines meet, and so not what raster
/// operations like Xor make of them.
///
/// # Safety
/// `drawable` is the server's; `renderer` draws to it and calls nothing that could come back to this driver.
unsafe fn otherwise(
    drawn: bool,
    past_exa: bool,
    drawable: DrawablePtr,
    renderer: impl FnOnce(),
    exa: impl FnOnce(&GCOps),
) {
    if drawn {
        return;
    }
    if past_exa {
        // SAFETY: the caller vouches for it.
        unsafe {
            let mut open = Open::new((*drawable).pScreen);
            if open.add(drawable) {
                renderer();
                return;
            }
        }
    }
    exa(below());
}

/// Calls an entry of a table, if it is there.
macro_rules! call {
    ($table:expr, $entry:ident, $($argument:expr),*) => {
        if let Some(entry) = $table.$entry {
            entry($($argument),*);
        }
    };
}

unsafe extern "C" fn fill_spans(
    drawable: DrawablePtr,
    gc: GCPtr,
    count: c_int,
    points: server::DDXPointPtr,
    widths: *mut c_int,
    sorted: c_int,
) {
    // SAFETY: the server calls with a drawable, a GC validated for it, and as many points and widths as it says; spans are
    // in the screen's coordinates.
    unsafe {
        let solid = is_solid(gc);
        let drawn = solid
            && draw("FillSpans", drawable, gc, (*gc).alu.into(), |engine, onto| {
                let onto = Onto { origin: onto.moved, ..*onto };
                engine.spans(&onto, (*gc).fgPixel, list(points, count), list(widths, count))
            });
        otherwise(
            drawn,
            solid,
            drawable,
            || server::fbFillSpans(drawable, gc, count, points, widths, sorted),
            |exa| call!(exa, FillSpans, drawable, gc, count, points, widths, sorted),
        );
    }
}

unsafe extern "C" fn poly_point(
    drawable: DrawablePtr,
    gc: GCPtr,
    mode: c_int,
    count: c_int,
    points: server::DDXPointPtr,
) {
    // SAFETY: as above.
    unsafe {
        let solid = is_solid(gc);
        let drawn = solid
            && draw("PolyPoint", drawable, gc, (*gc).alu.into(), |engine, onto| {
                engine.points(onto, (*gc).fgPixel, places(points, count, mode))
            });
        otherwise(
            drawn,
            solid,
            drawable,
            || server::fbPolyPoint(drawable, gc, mode, count, points),
            |exa| call!(exa, PolyPoint, drawable, gc, mode, count, points),
        );
    }
}

/// Points as a request has them.
///
/// # Safety
/// As for [`list`].
unsafe fn places<'a>(points: server::DDXPointPtr, count: c_int, mode: c_int) -> Points<'a> {
    // SAFETY: the caller vouches for it.
    Points { list: unsafe { list(points, count) }, steps: mode == server::CoordModePrevious as c_int }
}

unsafe extern "C" fn polylines(
    drawable: DrawablePtr,
    gc: GCPtr,
    mode: c_int,
    count: c_int,
    points: server::DDXPointPtr,
) {
    // SAFETY: as above.
    unsafe {
        let thin = count > 1 && is_thin(gc);
        let drawn = thin
            && draw("Polylines", drawable, gc, (*gc).alu.into(), |engine, onto| {
                let corner = [(*drawable).x.into(), (*drawable).y.into()];
                let cap = (*gc).capStyle() != server::CapNotLast;
                engine.polyline(onto, (*gc).fgPixel, places(points, count, mode), corner, cap)
            });
        otherwise(
            drawn,
            thin,
            drawable,
            || server::fbPolyLine(drawable, gc, mode, count, points),
            |exa| call!(exa, Polylines, drawable, gc, mode, count, points),
        );
    }
}

unsafe extern "C" fn poly_segment(drawable: DrawablePtr, gc: GCPtr, count: c_int, segments: *mut xSegment) {
    // SAFETY: as above.
    unsafe {
        let thin = is_thin(gc);
        let drawn = thin
            && draw("PolySegment", drawable, gc, (*gc).alu.into(), |engine, onto| {
                let given: &[Segment] = list(segments, count);
                engine.segments(onto, (*gc).fgPixel, given, (*gc).capStyle() != server::CapNotLast)
            });
        otherwise(
            drawn,
            thin,
            drawable,
            || server::fbPolySegment(drawable, gc, count, segments),
            |exa| call!(exa, PolySegment, drawable, gc, count, segments),
        );
    }
}

unsafe extern "C" fn poly_fill_rectangle(drawable: DrawablePtr, gc: GCPtr, count: c_int, rectangles: *mut xRectangle) {
    // SAFETY: as above.
    unsafe {
        let solid = is_solid(gc);
        let drawn = solid
            && draw("PolyFillRect", drawable, gc, (*gc).alu.into(), |engine, onto| {
                engine.fill_list(onto, (*gc).fgPixel, list(rectangles, count))
            });
        otherwise(
            drawn,
            solid,
            drawable,
            || server::fbPolyFillRect(drawable, gc, count, rectangles),
            |exa| call!(exa, PolyFillRect, drawable, gc, count, rectangles),
        );
    }
}

/// A text: its letters one after the other, from a pen's place on.
#[derive(Clone, Copy)]
struct Text<'a> {
    characters: &'a [server::CharInfoPtr],
    pen: i32,
    y: i32,
}

impl<'a> Text<'a> {
    /// The text of a request; `None` if a letter lies outside of what 16 bits reach.
    ///
    /// # Safety
    /// `characters` points to `count` pointers to characters with their bits, which live for `'a`.
    unsafe fn new(x: c_int, y: c_int, count: c_uint, characters: *const server::CharInfoPtr) -> Option<Text<'a>> {
        // SAFETY: the caller vouches for it.
        let characters = unsafe { list(characters, c_int::try_from(count).ok()?) };
        let text = Text { characters, pen: x, y };
        let mut pen = x;
        let reaches = characters.iter().all(|&character| {
            // SAFETY: the caller vouches for it.
            let metrics = unsafe { &(*character).metrics };
            let left = pen + i32::from(metrics.leftSideBearing);
            pen += i32::from(metrics.characterWidth);
            i16::try_from(left).is_ok() && i16::try_from(y - i32::from(metrics.ascent)).is_ok()
        });
        reaches.then_some(text)
    }

    /// How far the pen goes.
    fn advance(self) -> i32 {
        // SAFETY: who made the text vouched for its characters.
        self.characters.iter().map(|&character| i32::from(unsafe { (*character).metrics.characterWidth })).sum()
    }
}

impl<'a> Iterator for Text<'a> {
    type Item = BitmapGlyph<'a>;

    fn next(&mut self) -> Option<BitmapGlyph<'a>> {
        while let Some((&character, rest)) = self.characters.split_first() {
            self.characters = rest;
            // SAFETY: who made the text vouched for its characters; one with pixels has rows padded to 32 bits, as this
            // server asks fonts for (GLYPHPADBYTES).
            unsafe {
                let metrics = &(*character).metrics;
                let left = self.pen + i32::from(metrics.leftSideBearing);
                self.pen += i32::from(metrics.characterWidth);
                let width = i32::from(metrics.rightSideBearing) - i32::from(metrics.leftSideBearing);
                let height = i32::from(metrics.ascent) + i32::from(metrics.descent);
                if let (Ok(width @ 1..), Ok(height @ 1..)) = (u16::try_from(width), u16::try_from(height)) {
                    let bytes = usize::from(width).div_ceil(32) * 4 * usize::from(height);
                    return Some(BitmapGlyph {
                        x: left as i16,
                        y: (self.y - i32::from(metrics.ascent)) as i16,
                        width,
                        height,
                        bits: std::slice::from_raw_parts((*character).bits.cast(), bytes),
                    });
                }
            }
        }
        None
    }
}

unsafe extern "C" fn poly_glyph_blt(
    drawable: DrawablePtr,
    gc: GCPtr,
    x: c_int,
    y: c_int,
    count: c_uint,
    characters: *mut server::CharInfoPtr,
    base: *mut c_void,
) {
    // SAFETY: as above, with as many characters as it says.
    unsafe {
        let solid = is_solid(gc);
        let drawn = solid
            && Text::new(x, y, count, characters).is_some_and(|text| {
                draw("PolyGlyphBlt", drawable, gc, (*gc).alu.into(), |engine, onto| {
                    engine.letters(onto, (*gc).fgPixel, &text)
                })
            });
        otherwise(
            drawn,
            solid,
            drawable,
            || server::fbPolyGlyphBlt(drawable, gc, x, y, count, characters, base),
            |exa| call!(exa, PolyGlyphBlt, drawable, gc, x, y, count, characters, base),
        );
    }
}

unsafe extern "C" fn image_glyph_blt(
    drawable: DrawablePtr,
    gc: GCPtr,
    x: c_int,
    y: c_int,
    count: c_uint,
    characters: *mut server::CharInfoPtr,
    base: *mut c_void,
) {
    // SAFETY: as above; a GC that draws text has a font.
    unsafe {
        let font = &(*(*gc).font).info;
        let drawn = Text::new(x, y, count, characters).is_some_and(|text| {
            let (ascent, descent, width) = (i32::from(font.fontAscent), i32::from(font.fontDescent), text.advance());
            let background = background(x.min(x + width), y - ascent, width.abs(), ascent + descent);
            background.is_some_and(|background| {
                // Text on a background knows no raster operation but copy.
                draw("ImageGlyphBlt", drawable, gc, server::GXcopy, |engine, onto| {
                    engine.fill_list(onto, (*gc).bgPixel, &[background]) && engine.letters(onto, (*gc).fgPixel, &text)
                })
            })
        });
        otherwise(
            drawn,
            true,
            drawable,
            || server::fbImageGlyphBlt(drawable, gc, x, y, count, characters, base),
            |exa| call!(exa, ImageGlyphBlt, drawable, gc, x, y, count, characters, base),
        );
    }
}

/// The rectangle behind a text; `None` if it does not fit 16 bits.
fn background(x: i32, y: i32, width: i32, height: i32) -> Option<ListRectangle> {
    Some(ListRectangle {
        x: x.try_into().ok()?,
        y: y.try_into().ok()?,
        width: width.try_into().ok()?,
        height: height.try_into().ok()?,
    })
}
