//! Requests of RENDER, past EXA: compositions and text go to the card, and what it does not do to the server's own renderer in
//! one piece.
//!
//! Text: EXA would compose it glyph by glyph. Trapezoids and triangles: EXA's way is not the stock server's. It takes the
//! source's place from each trapezoid in turn and not from the first, and composes in the box around them alone, also
//! with operators that change what lies outside. Compositions: of the fills and copies that EXA could make it cuts some at the
//! clip of the source, which the stock server does not look at, misplaces tiles, and copies within a pixmap as if all were read
//! first; the engine makes fills and copies of the same ones without all that, and leaves small ones to the renderer.

use std::ffi::c_int;

use super::exa;
use super::pictures::{self, Composite};
use super::pixels::Open;
use super::screen::{self, with_engine};
use super::server::{
    self, CARD8, CARD16, DrawablePtr, GlyphListPtr, GlyphPtr, INT16, PictFormatPtr, PicturePtr, PictureScreenRec,
    ScreenPtr, xTrapezoid, xTriangle,
};
use zga_driver::ListRectangle;

/// RENDER's structure of a screen; null without RENDER.
///
/// # Safety
/// `pscreen` is a screen of the server.
unsafe fn picture_screen(pscreen: ScreenPtr) -> *mut PictureScreenRec {
    // SAFETY: the key says where in the screen's private memory the pointer to RENDER's structure is; it is set up with
    // the first screen that has RENDER.
    unsafe {
        let key = &raw const server::PictureScreenPrivateKeyRec;
        if (*key).initialized == 0 || (*key).size != 0 || (*pscreen).devPrivates.is_null() {
            return std::ptr::null_mut();
        }
        let place = (*pscreen).devPrivates.byte_offset((*key).offset as isize);
        place.cast::<*mut PictureScreenRec>().read()
    }
}

/// The functions behind the requests.
#[derive(Clone, Copy, Default)]
struct Functions {
    composite: server::CompositeProcPtr,
    glyphs: server::GlyphsProcPtr,
    trapezoids: server::TrapezoidsProcPtr,
    triangles: server::TrianglesProcPtr,
}

impl Functions {
    /// Those of a screen.
    const fn of(pictures: &PictureScreenRec) -> Functions {
        Functions {
            composite: pictures.Composite,
            glyphs: pictures.Glyphs,
            trapezoids: pictures.Trapezoids,
            triangles: pictures.Triangles,
        }
    }

    /// Makes them those of a screen.
    const fn give(self, pictures: &mut PictureScreenRec) {
        pictures.Composite = self.composite;
        pictures.Glyphs = self.glyphs;
        pictures.Trapezoids = self.trapezoids;
        pictures.Triangles = self.triangles;
    }
}

/// What the requests were drawn by.
#[derive(Clone, Copy, Default)]
pub struct Below {
    /// The server's renderer.
    renderer: Functions,
    /// EXA; none while this layer is not there.
    exa: Option<Functions>,
}

/// Takes note of the server's renderer.
///
/// # Safety
/// `pscreen` is in ScreenInit, after fbPictureInit and before EXA has started.
pub unsafe fn note(pscreen: ScreenPtr) {
    // SAFETY: the caller vouches for it.
    unsafe {
        let (Some(screen), Some(pictures)) = (screen::of_screen(pscreen), picture_screen(pscreen).as_ref()) else {
            return;
        };
        screen.render.renderer = Functions::of(pictures);
    }
}

/// Puts this layer over EXA's.
///
/// # Safety
/// `pscreen` is in ScreenInit, after EXA has started.
pub unsafe fn wrap(pscreen: ScreenPtr) {
    // SAFETY: the caller vouches for it.
    unsafe {
        let (Some(screen), Some(pictures)) = (screen::of_screen(pscreen), picture_screen(pscreen).as_mut()) else {
            return;
        };
        screen.render.exa = Some(Functions::of(pictures));
        Functions {
            composite: Some(composite),
            glyphs: Some(glyphs),
            trapezoids: Some(trapezoids),
            triangles: Some(triangles),
        }
        .give(pictures);
    }
}

/// Takes this layer away, before EXA's goes.
///
/// # Safety
/// `pscreen` is in CloseScreen, with EXA's layer still there.
pub unsafe fn unwrap(pscreen: ScreenPtr) {
    // SAFETY: the caller vouches for it.
    unsafe {
        let (Some(screen), Some(pictures)) = (screen::of_screen(pscreen), picture_screen(pscreen).as_mut()) else {
            return;
        };
        if let Some(exa) = screen.render.exa.take() {
            exa.give(pictures);
        }
    }
}

/// Draws a request by the server's renderer if everything that it reads and writes can be opened, else by EXA.
///
/// # Safety
/// The server calls with pictures of one of this driver's screens, and what is read has been through [`validate`]. `more` opens
/// what there is besides source and destination; `draw` gets the functions to draw by and calls one of them.
unsafe fn draw(
    from: PicturePtr,
    onto: PicturePtr,
    more: impl FnOnce(&mut Open, ScreenPtr) -> bool,
    draw: impl FnOnce(Functions),
) {
    // SAFETY: the caller vouches for it. No reference to the state lives across the calls.
    unsafe {
        let drawable = (*onto).pDrawable;
        let pscreen = (*drawable).pScreen;
        let Some(below) = screen::of_screen(pscreen).map(|screen| screen.render) else { return };
        let mut open = Open::new(pscreen);
        if (*onto).alphaMap.is_null() && open_picture(&mut open, from) && more(&mut open, pscreen) && open.add(drawable)
        {
            draw(below.renderer);
        } else {
            drop(open);
            draw(below.exa.unwrap_or(below.renderer));
        }
    }
}

/// Has the server make a window fit to be read, which may mean to take its own cursor off; that comes back to this driver, so
/// it is done before anything is encoded or open. The renderer asks for the same again, and finds it done.
///
/// # Safety
/// As for [`draw`].
unsafe fn validate(from: PicturePtr) {
    // SAFETY: the caller vouches for it; the screen has the function if the server has a renderer.
    unsafe {
        let source: DrawablePtr = (*from).pDrawable;
        if source.is_null() || u32::from((*source).type_) != server::DRAWABLE_WINDOW {
            return;
        }
        if let Some(validate) = (*(*source).pScreen).SourceValidate {
            let (width, height) = ((*source).width.into(), (*source).height.into());
            validate(source, 0, 0, width, height, (*from).subWindowMode());
        }
    }
}

/// Opens a picture that is read. False: it is EXA's to do.
///
/// # Safety
/// As for [`draw`].
unsafe fn open_picture(open: &mut Open, picture: PicturePtr) -> bool {
    // SAFETY: the caller vouches for it.
    unsafe {
        let drawable: DrawablePtr = (*picture).pDrawable;
        (*picture).alphaMap.is_null() && (drawable.is_null() || open.add(drawable))
    }
}

/// EXA's functions, which number the pixmaps of a screen.
///
/// # Safety
/// The screen is one of this driver's.
unsafe fn functions(pscreen: ScreenPtr) -> Option<exa::Functions> {
    // SAFETY: the caller vouches for it; no reference to the state lives on.
    unsafe { screen::of_screen(pscreen)?.exa }
}

unsafe extern "C" fn composite(
    operator: CARD8,
    from: PicturePtr,
    mask: PicturePtr,
    onto: PicturePtr,
    x: INT16,
    y: INT16,
    mask_x: INT16,
    mask_y: INT16,
    onto_x: INT16,
    onto_y: INT16,
    width: CARD16,
    height: CARD16,
) {
    // SAFETY: the server calls with pictures of one of this driver's screens; there need be no mask.
    unsafe {
        let call = |functions: Functions| {
            if let Some(composite) = functions.composite {
                composite(operator, from, mask, onto, x, y, mask_x, mask_y, onto_x, onto_y, width, height);
            }
        };
        if !mask.is_null() {
            validate(mask);
        }
        validate(from);
        let pscreen = (*(*onto).pDrawable).pScreen;
        let composite = Composite {
            operator,
            source: (from, [x, y]),
            mask: (mask, [mask_x, mask_y]),
            onto: (onto, [onto_x, onto_y]),
        };
        let drawn = functions(pscreen).and_then(|exa| composite.request(exa)).is_some_and(|(request, [x, y])| {
            let (Ok(x), Ok(y)) = (i16::try_from(x), i16::try_from(y)) else { return false };
            let rectangle = ListRectangle { x, y, width, height };
            with_engine("Composite", pscreen, false, |engine, _| engine.compose(&request, rectangle))
        });
        if drawn {
            return;
        }
        let more = |open: &mut Open, _| mask.is_null() || open_picture(open, mask);
        draw(from, onto, more, call);
    }
}

/// Has the card draw text. `None` or false: it is the renderer's.
///
/// # Safety
/// As for [`glyphs`].
unsafe fn glyphs_by_card(
    operator: CARD8,
    from: PicturePtr,
    onto: PicturePtr,
    format: PictFormatPtr,
    at: [INT16; 2],
    (count, lists, letters): (c_int, GlyphListPtr, *mut GlyphPtr),
) -> Option<bool> {
    // SAFETY: the caller vouches for it.
    unsafe {
        let pscreen = (*(*onto).pDrawable).pScreen;
        let exa = functions(pscreen)?;
        let (total, pixels) = pictures::text_size(count, lists, letters);
        if with_engine("Glyphs", pscreen, true, |engine, _| engine.is_small_text(total, pixels)) {
            return None;
        }
        let mask = pictures::mask_format(format)?;
        if count <= 0 {
            return None;
        }
        // The source's place belongs to the first list's.
        let first = [(*lists).xOff, (*lists).yOff];
        let none = (std::ptr::null_mut(), [0; 2]);
        let composite = Composite { operator, source: (from, at), mask: none, onto: (onto, first) };
        let (request, place) = composite.request(exa)?;
        let corner = [place[0] - i32::from(first[0]), place[1] - i32::from(first[1])];
        let list = pictures::glyphs(pscreen, corner, count, lists, letters, exa)?;
        Some(with_engine("Glyphs", pscreen, false, |engine, _| engine.compose_glyphs(&request, &list, mask)))
    }
}

unsafe extern "C" fn glyphs(
    operator: CARD8,
    from: PicturePtr,
    onto: PicturePtr,
    format: PictFormatPtr,
    x: INT16,
    y: INT16,
    count: c_int,
    lists: GlyphListPtr,
    letters: *mut GlyphPtr,
) {
    // SAFETY: the server calls with pictures of one of this driver's screens, and lists of letters that live meanwhile; a
    // letter without picture has none to open.
    unsafe {
        validate(from);
        if glyphs_by_card(operator, from, onto, format, [x, y], (count, lists, letters)) == Some(true) {
            return;
        }
        let more = |open: &mut Open, pscreen| {
            let total: usize =
                (0..usize::try_from(count).unwrap_or(0)).map(|place| usize::from((*lists.add(place)).len)).sum();
            (0..total).all(|place| {
                let picture = server::GetGlyphPicture(*letters.add(place), pscreen);
                picture.is_null() || (*picture).pDrawable.is_null() || open.add((*picture).pDrawable)
            })
        };
        draw(from, onto, more, |functions| {
            if let Some(glyphs) = functions.glyphs {
                glyphs(operator, from, onto, format, x, y, count, lists, letters);
            }
        });
    }
}

/// Draws shapes, which read nothing but their source.
///
/// # Safety
/// As for [`draw`].
unsafe fn draw_shapes(from: PicturePtr, onto: PicturePtr, call: impl FnOnce(Functions)) {
    // SAFETY: the caller vouches for it.
    unsafe {
        validate(from);
        draw(from, onto, |_, _| true, call);
    }
}

unsafe extern "C" fn trapezoids(
    operator: CARD8,
    from: PicturePtr,
    onto: PicturePtr,
    format: PictFormatPtr,
    x: INT16,
    y: INT16,
    count: c_int,
    shapes: *mut xTrapezoid,
) {
    // SAFETY: the server calls with pictures of one of this driver's screens, and shapes that live meanwhile.
    unsafe {
        draw_shapes(from, onto, |functions| {
            if let Some(trapezoids) = functions.trapezoids {
                trapezoids(operator, from, onto, format, x, y, count, shapes);
            }
        });
    }
}

unsafe extern "C" fn triangles(
    operator: CARD8,
    from: PicturePtr,
    onto: PicturePtr,
    format: PictFormatPtr,
    x: INT16,
    y: INT16,
    count: c_int,
    shapes: *mut xTriangle,
) {
    // SAFETY: as above.
    unsafe {
        draw_shapes(from, onto, |functions| {
            if let Some(triangles) = functions.triangles {
                triangles(operator, from, onto, format, x, y, count, shapes);
            }
        });
    }
}
