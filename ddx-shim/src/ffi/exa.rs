//! EXA's hooks: pixmaps, accesses, fills, copies, uploads.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::null_mut;

use super::screen::with_engine;
use super::server::{self, Bool, Pixel, PixmapPtr, ScreenPtr};
use crate::engine::Wanted;

/// Functions of the module `exa`. The server loads it after this module, so they are looked up by name.
#[derive(Clone, Copy)]
pub struct Functions {
    pub alloc: unsafe extern "C" fn() -> *mut server::ExaDriverRec,
    pub init: unsafe extern "C" fn(ScreenPtr, *mut server::ExaDriverRec) -> Bool,
    pub fini: unsafe extern "C" fn(ScreenPtr),
    pub private: unsafe extern "C" fn(PixmapPtr) -> *mut c_void,
}

impl Functions {
    /// Looks them up; `None` if one is not there.
    pub fn find() -> Option<Functions> {
        /// # Safety
        /// `F` is the type of the function with this name.
        unsafe fn symbol<F: Copy>(name: &CStr) -> Option<F> {
            const { assert!(size_of::<F>() == size_of::<*mut c_void>()) };
            // SAFETY: the loader gives the address of the function with this name or null; the caller vouches for the type,
            // which is one of a function pointer and so of this size.
            unsafe {
                let address = server::LoaderSymbol(name.as_ptr());
                (!address.is_null()).then(|| std::mem::transmute_copy(&address))
            }
        }
        // SAFETY: the types are those of exa.h, which the ABI check of the loader holds the server to.
        unsafe {
            Some(Functions {
                alloc: symbol(c"exaDriverAlloc")?,
                init: symbol(c"exaDriverInit")?,
                fini: symbol(c"exaDriverFini")?,
                private: symbol(c"exaGetPixmapDriverPrivate")?,
            })
        }
    }

    /// The engine's number of a pixmap; `None` for one that is not EXA's.
    ///
    /// # Safety
    /// `pixmap` is a pixmap of a screen with EXA.
    pub unsafe fn number(self, pixmap: PixmapPtr) -> Option<usize> {
        // SAFETY: the caller vouches for it.
        let private = unsafe { (self.private)(pixmap) };
        (private as usize).checked_sub(1)
    }
}

/// The number of a pixmap as EXA keeps it: never null, never followed.
fn private(number: usize) -> *mut c_void {
    std::ptr::without_provenance_mut(number + 1)
}

/// Makes the driver record and starts EXA.
///
/// # Safety
/// `pscreen` is in ScreenInit, after fbScreenInit and fbPictureInit.
pub unsafe fn start(functions: Functions, pscreen: ScreenPtr) -> Option<*mut server::ExaDriverRec> {
    // SAFETY: EXA allocates the record and keeps it until the screen closes; the fields are set before it is used.
    unsafe {
        let record = (functions.alloc)();
        let exa = record.as_mut()?;
        exa.exa_major = server::EXA_VERSION_MAJOR as c_int;
        exa.exa_minor = server::EXA_VERSION_MINOR as c_int;
        exa.flags =
            (server::EXA_OFFSCREEN_PIXMAPS | server::EXA_HANDLES_PIXMAPS | server::EXA_SUPPORTS_PREPARE_AUX) as c_int;
        exa.pixmapOffsetAlign = crate::format::PITCH_ALIGNMENT as c_int;
        exa.pixmapPitchAlign = crate::format::PITCH_ALIGNMENT as c_int;
        exa.maxX = 16384;
        exa.maxY = 16384;
        exa.CreatePixmap2 = Some(create_pixmap);
        exa.DestroyPixmap = Some(destroy_pixmap);
        exa.ModifyPixmapHeader = Some(modify_pixmap_header);
        exa.PixmapIsOffscreen = Some(pixmap_is_offscreen);
        exa.PrepareAccess = Some(prepare_access);
        exa.FinishAccess = Some(finish_access);
        exa.MarkSync = Some(mark_sync);
        exa.WaitMarker = Some(wait_marker);
        exa.PrepareSolid = Some(prepare_solid);
        exa.Solid = Some(solid);
        exa.DoneSolid = Some(done);
        exa.PrepareCopy = Some(prepare_copy);
        exa.Copy = Some(copy);
        exa.DoneCopy = Some(done);
        exa.UploadToScreen = Some(upload);
        if (functions.init)(pscreen, record) == 0 {
            return None;
        }
        Some(record)
    }
}

unsafe extern "C" fn create_pixmap(
    pscreen: ScreenPtr,
    width: c_int,
    height: c_int,
    _depth: c_int,
    usage: c_int,
    bits: c_int,
    pitch: *mut c_int,
) -> *mut c_void {
    // SAFETY: EXA calls with its screen and a place for the pitch; the engine calls nothing of the server.
    unsafe {
        with_engine("CreatePixmap2", pscreen, null_mut(), |engine, _| {
            let size = |pixels: c_int| u32::try_from(pixels).ok();
            let (Some(width), Some(height), Some(bits)) = (size(width), size(height), size(bits)) else {
                return null_mut();
            };
            // Pictures of single glyphs go into EXA's atlas from host memory.
            let glyph = usage == server::CREATE_PIXMAP_USAGE_GLYPH_PICTURE as c_int;
            let wanted = if glyph { Wanted::InHostMemory } else { Wanted::Anywhere };
            let number = engine.create_pixmap((width, height), bits, wanted);
            *pitch = engine.pitch(number) as c_int;
            private(number)
        })
    }
}

unsafe extern "C" fn destroy_pixmap(pscreen: ScreenPtr, pixmap: *mut c_void) {
    // SAFETY: as above.
    unsafe {
        with_engine("DestroyPixmap", pscreen, (), |engine, _| {
            if let Some(number) = (pixmap as usize).checked_sub(1) {
                engine.destroy_pixmap(number);
            }
        });
    }
}

unsafe extern "C" fn modify_pixmap_header(
    pixmap: PixmapPtr,
    _width: c_int,
    _height: c_int,
    _depth: c_int,
    _bits: c_int,
    pitch: c_int,
    data: *mut c_void,
) -> Bool {
    // SAFETY: EXA calls with one of its pixmaps; the server then changes the header itself, as the answer says.
    unsafe {
        with_engine("ModifyPixmapHeader", (*pixmap).drawable.pScreen, 0, |engine, exa| {
            let Some(number) = exa.number(pixmap) else { return 0 };
            if !data.is_null() {
                if data as usize == engine.frame_address() {
                    engine.make_frame(number);
                } else {
                    engine.make_foreign(number, u32::try_from(pitch).unwrap_or(0));
                }
            } else if let Some(address) = engine.host_address(number) {
                // EXA notes the address and never asks for access then.
                (*pixmap).devPrivate.ptr = address.cast();
                (*pixmap).devKind = engine.pitch(number) as c_int;
            }
            0
        })
    }
}

unsafe extern "C" fn pixmap_is_offscreen(pixmap: PixmapPtr) -> Bool {
    // SAFETY: EXA calls with one of its pixmaps.
    unsafe {
        with_engine("PixmapIsOffscreen", (*pixmap).drawable.pScreen, 0, |engine, exa| {
            i32::from(exa.number(pixmap).is_some_and(|number| engine.is_movable(number)))
        })
    }
}

unsafe extern "C" fn prepare_access(pixmap: PixmapPtr, _index: c_int) -> Bool {
    // SAFETY: EXA calls with one of its pixmaps and takes the address away from the header when the access ends, which is
    // when it calls finish_access: the address is good until then.
    unsafe {
        with_engine("PrepareAccess", (*pixmap).drawable.pScreen, 0, |engine, exa| {
            let Some(address) = exa.number(pixmap).and_then(|number| engine.access(number)) else { return 0 };
            (*pixmap).devPrivate.ptr = address.cast();
            1
        })
    }
}

unsafe extern "C" fn finish_access(pixmap: PixmapPtr, _index: c_int) {
    // SAFETY: as above. EXA has just taken the address away; within a request that this driver has opened the pixmap for, it
    // is still good, and goes back.
    unsafe {
        (*pixmap).devPrivate.ptr = super::pixels::address(pixmap);
        with_engine("FinishAccess", (*pixmap).drawable.pScreen, (), |engine, _| engine.finish());
    }
}

/// EXA asks to mark work that is under way. Waiting is not by marks: each access waits for the batches that use its pixmap.
unsafe extern "C" fn mark_sync(_: ScreenPtr) -> c_int {
    0
}

/// EXA calls this before it asks for an access, which waits.
unsafe extern "C" fn wait_marker(_: ScreenPtr, _: c_int) {}

unsafe extern "C" fn prepare_solid(pixmap: PixmapPtr, function: c_int, planes: Pixel, value: Pixel) -> Bool {
    // SAFETY: EXA calls with one of its pixmaps.
    unsafe {
        let depth = u32::from((*pixmap).drawable.depth);
        with_engine("PrepareSolid", (*pixmap).drawable.pScreen, 0, |engine, exa| {
            let Some(number) = exa.number(pixmap) else { return 0 };
            i32::from(engine.prepare_solid(number, depth, function.cast_unsigned(), planes, value))
        })
    }
}

unsafe extern "C" fn solid(pixmap: PixmapPtr, x: c_int, y: c_int, right: c_int, bottom: c_int) {
    // SAFETY: as above.
    unsafe { with_engine("Solid", (*pixmap).drawable.pScreen, (), |engine, _| engine.solid(x, y, right, bottom)) };
}

unsafe extern "C" fn prepare_copy(
    from: PixmapPtr,
    to: PixmapPtr,
    _dx: c_int,
    _dy: c_int,
    function: c_int,
    planes: Pixel,
) -> Bool {
    // SAFETY: as above.
    unsafe {
        let depth = u32::from((*to).drawable.depth);
        with_engine("PrepareCopy", (*to).drawable.pScreen, 0, |engine, exa| {
            let (Some(from), Some(to)) = (exa.number(from), exa.number(to)) else { return 0 };
            i32::from(engine.prepare_copy(from, to, depth, function.cast_unsigned(), planes))
        })
    }
}

unsafe extern "C" fn copy(
    pixmap: PixmapPtr,
    from_x: c_int,
    from_y: c_int,
    x: c_int,
    y: c_int,
    width: c_int,
    height: c_int,
) {
    // SAFETY: as above.
    unsafe {
        with_engine("Copy", (*pixmap).drawable.pScreen, (), |engine, _| {
            engine.copy((from_x, from_y), (x, y), width, height);
        });
    }
}

unsafe extern "C" fn done(pixmap: PixmapPtr) {
    // SAFETY: as above.
    unsafe { with_engine("Done", (*pixmap).drawable.pScreen, (), |engine, _| engine.done()) };
}

unsafe extern "C" fn upload(
    pixmap: PixmapPtr,
    x: c_int,
    y: c_int,
    width: c_int,
    height: c_int,
    bits: *mut c_char,
    stride: c_int,
) -> Bool {
    // SAFETY: EXA calls with one of its pixmaps, a rectangle inside of it, and rows of that rectangle's pixels.
    unsafe {
        let bytes = c_int::from((*pixmap).drawable.bitsPerPixel) / 8;
        let number = |number: c_int| u32::try_from(number).unwrap_or(0);
        let (row, rows) = (number(width * bytes), number(height));
        if row == 0 || rows == 0 || stride <= 0 || x < 0 || y < 0 {
            return 0;
        }
        let length = (rows as usize - 1) * stride as usize + row as usize;
        let rows_there = std::slice::from_raw_parts(bits.cast::<u8>(), length);
        with_engine("UploadToScreen", (*pixmap).drawable.pScreen, 0, |engine, exa| {
            let Some(entry) = exa.number(pixmap) else { return 0 };
            let place = (number(x * bytes), number(y));
            i32::from(engine.upload(entry, place, (row, rows), rows_there, stride as usize))
        })
    }
}
