//! What the module loader looks for, and probing.

use std::ffi::{c_int, c_void};
use std::ptr::null_mut;

use super::server::{self, Bool, DriverPtr, DriverRec, OptionInfoRec, ScrnInfoPtr};
use super::{border, configure, start};

/// What `Driver "zga"` names.
const NAME: &std::ffi::CStr = c"zga";
/// How the log calls it.
pub const TITLE: &std::ffi::CStr = c"ZGA";
/// Version for the server: major in 31:24, minor in 23:16.
const VERSION: c_int = 1;

/// A value that the server reads, and writes to in places that it was made for.
#[repr(transparent)]
struct Shared<T>(T);
// SAFETY: only the server's main thread uses it.
unsafe impl<T> Sync for Shared<T> {}

/// Number of a macro like `SET_ABI_VERSION`.
const fn number(text: &str) -> u32 {
    let (bytes, mut value, mut at) = (text.as_bytes(), 0, 0);
    while at < bytes.len() {
        value = 10 * value + (bytes[at] - b'0') as u32;
        at += 1;
    }
    value
}

/// Video driver ABI that the module was built against.
const ABI: u32 = number(env!("ZGA_ABI_VIDEODRV_MAJOR")) << 16 | number(env!("ZGA_ABI_VIDEODRV_MINOR"));

static VERSION_RECORD: Shared<server::XF86ModuleVersionInfo> = Shared(server::XF86ModuleVersionInfo {
    modname: NAME.as_ptr(),
    vendor: c"ZGA".as_ptr(),
    _modinfo1_: server::MODINFOSTRING1 as _,
    _modinfo2_: server::MODINFOSTRING2 as _,
    xf86version: server::XORG_VERSION_CURRENT as _,
    majorversion: 0,
    minorversion: 1,
    patchlevel: 0,
    abiclass: server::ABI_CLASS_VIDEODRV.as_ptr().cast(),
    abiversion: ABI,
    moduleclass: server::MOD_CLASS_VIDEODRV.as_ptr().cast(),
    checksum: [0; 4],
});

/// What the module loader looks for in `zga_drv.so`.
#[unsafe(no_mangle)]
static zgaModuleData: Shared<server::XF86ModuleData> =
    Shared(server::XF86ModuleData { vers: &raw const VERSION_RECORD.0 as *mut _, setup: Some(setup), teardown: None });

static mut DRIVER: DriverRec = DriverRec {
    driverVersion: VERSION,
    driverName: NAME.as_ptr(),
    Identify: Some(identify),
    Probe: Some(probe),
    AvailableOptions: Some(available_options),
    module: null_mut(),
    refCount: 0,
    driverFunc: Some(answer),
    supported_devices: std::ptr::null(),
    PciProbe: None,
    platformProbe: None,
};

/// Called once when the module is loaded.
unsafe extern "C" fn setup(module: *mut c_void, _: *mut c_void, _: *mut c_int, minor: *mut c_int) -> *mut c_void {
    static LOADED: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(false);
    if LOADED.swap(true, std::sync::atomic::Ordering::Relaxed) {
        // SAFETY: the loader gives a place for the reason or null.
        unsafe {
            if !minor.is_null() {
                *minor = server::LDR_ONCEONLY as c_int;
            }
        }
        return null_mut();
    }
    // SAFETY: the driver record lives as long as the module; the server keeps it and writes to its reference count.
    unsafe { server::xf86AddDriver(&raw mut DRIVER, module, server::HaveDriverFuncs as c_int) };
    // Any address but null says that all is well.
    (&raw const VERSION_RECORD).cast_mut().cast()
}

unsafe extern "C" fn identify(_: c_int) {
    border::say(-1, crate::engine::Severity::Information, "ZGA: driver for the ZGA card");
}

unsafe extern "C" fn available_options(_: c_int, _: c_int) -> *const OptionInfoRec {
    // The options are in no table of the server's kind: `crate::options` reads and judges them.
    static NONE: Shared<[OptionInfoRec; 1]> = Shared([OptionInfoRec {
        token: -1,
        name: std::ptr::null(),
        type_: server::OPTV_NONE,
        value: server::ValueUnion { num: 0 },
        found: 0,
    }]);
    (&raw const NONE.0).cast()
}

/// The server asks what hardware the driver touches: none.
unsafe extern "C" fn answer(_: ScrnInfoPtr, question: server::xorgDriverFuncOp, data: *mut c_void) -> Bool {
    if question != server::GET_REQUIRED_HW_INTERFACES || data.is_null() {
        return 0;
    }
    // SAFETY: with this question `data` is a place for flags.
    unsafe { *data.cast::<server::xorgHWFlags>() = server::HW_SKIP_CONSOLE };
    1
}

/// Claims a screen for each Device section that names this driver. There is no hardware to look for: the card is made.
unsafe extern "C" fn probe(driver: DriverPtr, flags: c_int) -> Bool {
    border::catch("Probe", 0, || {
        if flags & server::PROBE_DETECT as c_int != 0 {
            return 0;
        }
        let mut sections: *mut server::GDevPtr = null_mut();
        // SAFETY: the server writes an array of as many pointers as it says, which is the caller's to free; it stays (a
        // few bytes, once). Entity and screen are made in the order that the server's documentation has.
        unsafe {
            let count = server::xf86MatchDevice(NAME.as_ptr(), &raw mut sections);
            let mut found = 0;
            for place in 0..usize::try_from(count).unwrap_or(0) {
                let entity = server::xf86ClaimNoSlot(driver, 0, *sections.add(place), 1);
                let scrn = server::xf86AllocateScreen(driver, 0);
                if scrn.is_null() {
                    continue;
                }
                server::xf86AddEntityToScreen(scrn, entity);
                let scrn = &mut *scrn;
                scrn.driverVersion = VERSION;
                scrn.driverName = NAME.as_ptr().cast_mut();
                scrn.name = TITLE.as_ptr().cast_mut();
                scrn.Probe = Some(probe);
                scrn.PreInit = Some(configure::pre_init);
                scrn.ScreenInit = Some(start::screen_init);
                scrn.SwitchMode = Some(start::switch_mode);
                scrn.AdjustFrame = Some(start::adjust_frame);
                scrn.EnterVT = Some(start::enter_vt);
                scrn.LeaveVT = Some(start::leave_vt);
                scrn.FreeScreen = Some(start::free_screen);
                scrn.ValidMode = Some(super::modes::valid_mode);
                found = 1;
            }
            found
        }
    })
}
