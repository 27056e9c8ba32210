//! PreInit: what the configuration asks for is judged, and a screen is refused before anything of it exists.

use std::ffi::{CStr, c_int};

use super::screen::{Screen, Wrapped};
use super::server::{self, Bool, ScrnInfoPtr};
use super::{border, cursor, modes};
use crate::engine::Severity;
use crate::format::screen_format;
use crate::modes::frame_size;
use crate::options::Options;
use std::sync::Arc;

/// Called once for each screen, before the first generation.
pub unsafe extern "C" fn pre_init(scrn: ScrnInfoPtr, flags: c_int) -> Bool {
    border::catch("PreInit", 0, || {
        if flags & server::PROBE_DETECT as c_int != 0 {
            return 1;
        }
        // SAFETY: the server calls with a screen that `probe` made.
        let done = unsafe { configure(scrn) };
        match done {
            Ok(()) => 1,
            Err(reason) => {
                // SAFETY: as above.
                border::complain(unsafe { (*scrn).scrnIndex }, &reason);
                0
            }
        }
    })
}

/// # Safety
/// `scrn` is a screen that `probe` made.
unsafe fn configure(scrn: ScrnInfoPtr) -> Result<(), String> {
    // SAFETY: of the whole function: the calls are those of the server's driver interface, in its order, with a screen of
    // this driver; what they need has been set before them.
    unsafe {
        if (*scrn).numEntities != 1 {
            return Err(format!("{} devices for one screen, expected 1", (*scrn).numEntities));
        }
        (*scrn).monitor = (*(*scrn).confScreen).monitor;
        if server::xf86SetDepthBpp(scrn, 0, 0, 0, server::Support32bppFb as c_int) == 0 {
            return Err("the server does not set the screen's depth".to_owned());
        }
        let depth = u32::try_from((*scrn).depth).unwrap_or(0);
        let bits = u32::try_from((*scrn).bitsPerPixel).unwrap_or(0);
        let format = match screen_format(depth) {
            Some((format, format_bits)) if format_bits == bits => format,
            _ => {
                return Err(format!(
                    "depth {depth} with {bits} bits a pixel: this card has screens of depth 24 (32 bits) and 16 (16 bits)"
                ));
            }
        };
        server::xf86PrintDepthBpp(scrn);
        let zeros = server::rgb { red: 0, green: 0, blue: 0 };
        if server::xf86SetWeight(scrn, zeros, zeros) == 0 || server::xf86SetDefaultVisual(scrn, -1) == 0 {
            return Err("the server does not set the screen's visual".to_owned());
        }
        if (*scrn).defaultVisual != server::TrueColor as c_int {
            return Err("this card has TrueColor screens only, the configuration asks for another Visual".to_owned());
        }
        let none = server::Gamma { red: 0.0, green: 0.0, blue: 0.0 };
        server::xf86SetGamma(scrn, none);
        (*scrn).progClock = 1;
        (*scrn).rgbBits = 8;

        let options = options(scrn)?;
        // The server's own options of outputs are read from this list.
        server::xf86CollectOptions(scrn, std::ptr::null_mut());
        let memory = u64::from(options.video_memory) << 20;
        let frame = frame_size(memory, format.bytes(), asked(scrn)).map_err(|error| error.to_string())?;
        let index = (*scrn).scrnIndex;
        border::say(
            index,
            Severity::Information,
            &format!(
                "{} MiB of video memory, screens up to {} x {}, acceleration {}",
                options.video_memory,
                frame.0,
                frame.1,
                if options.accel { "on" } else { "off" }
            ),
        );
        (*scrn).videoRam = c_int::try_from(memory >> 10).unwrap_or(c_int::MAX);
        let screen = Box::new(Screen {
            index,
            options,
            frame,
            format,
            link: None,
            engine: None,
            exa: None,
            exa_driver: std::ptr::null_mut(),
            wrapped: Wrapped::default(),
            render: super::render::Below::default(),
            cursor: Arc::new(cursor::Place::default()),
            mode: None,
        });
        (*scrn).driverPrivate = Box::into_raw(screen).cast();
        modes::create(scrn)?;
        server::xf86SetDpi(scrn, 0, 0);
        if server::xf86LoadSubModule(scrn, c"exa".as_ptr()).is_null() {
            return Err("the server has no module exa".to_owned());
        }
    }
    Ok(())
}

/// The options of the Device section.
///
/// # Safety
/// `scrn` is a screen with one entity.
unsafe fn options(scrn: ScrnInfoPtr) -> Result<Options, String> {
    let mut section = Vec::new();
    // SAFETY: an entity of this driver has a Device section; its options are a list that ends with null, of strings that
    // end with a zero byte; an option without a value has null there.
    unsafe {
        let device = server::xf86GetDevFromEntity(*(*scrn).entityList, *(*scrn).entityInstanceList);
        let mut option: server::XF86OptionPtr =
            if device.is_null() { std::ptr::null_mut() } else { (*device).options.cast() };
        let text = |string: *const std::ffi::c_char| {
            if string.is_null() { String::new() } else { CStr::from_ptr(string).to_string_lossy().into_owned() }
        };
        while !option.is_null() {
            section.push((text(server::xf86OptionName(option)), text(server::xf86OptionValue(option))));
            server::xf86MarkOptionUsed(option);
            option = server::xf86NextOption(option);
        }
    }
    let entries = section.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    Options::parse(entries).map_err(|error| format!("Device section: {error}"))
}

/// The size that the Display subsection asks for with Virtual.
///
/// # Safety
/// `scrn` is a screen with its depth set.
unsafe fn asked(scrn: ScrnInfoPtr) -> Option<(u32, u32)> {
    // SAFETY: xf86SetDepthBpp has chosen the subsection, or made one.
    let display = unsafe { (*scrn).display.as_ref()? };
    let (width, height) = (u32::try_from(display.virtualX).ok()?, u32::try_from(display.virtualY).ok()?);
    (width > 0 && height > 0).then_some((width, height))
}
