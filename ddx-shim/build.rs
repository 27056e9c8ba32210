//! With feature `xorg`: Rust declarations of the X server's headers, and the ABI number of its video drivers.
//!
//! Without the feature nothing is looked for and nothing is made.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "xorg")]
    xorg::main();
}

#[cfg(feature = "xorg")]
mod xorg {
    use std::path::PathBuf;
    use std::process::Command;

    /// Package that `pkg-config` knows the server's headers by.
    const PACKAGE: &str = "xorg-server";

    /// What the module calls and what it fills in; what these name comes with them.
    const FUNCTIONS: &[&str] = &[
        "xf86.*",
        "Loader.*",
        "ErrorF",
        "LogMessage.*",
        "fb(ScreenInit|PictureInit|PolyLine|PolySegment|PolyFillRect|FillSpans|PolyPoint|PolyGlyphBlt|ImageGlyphBlt)",
        "mi(ClearVisualTypes|SetVisualTypes|SetPixmapDepths|SetZeroLineBias|DCInitialize|CreateDefColormap|InstallColormap|UninstallColormap|ListInstalledColormaps)",
        "dix(RegisterPrivateKey)",
        "pthread_sigmask",
        "sigfillset",
        "GetGlyphPicture",
        "free",
        "XNF.*",
    ];
    const TYPES: &[&str] = &[
        "DriverRec",
        "XF86ModuleData",
        "XF86ModuleVersionInfo",
        "ScrnInfoRec",
        "ScreenRec",
        "ExaDriverRec",
        "GCOps",
        "GC",
        "PixmapRec",
        "WindowRec",
        "DrawableRec",
        "RegDataRec",
        "RegionRec",
        "xRectangle",
        "xSegment",
        "CharInfoRec",
        "FontRec",
        "PictureRec",
        "SolidFillRec?",
        "xf86Crtc.*",
        "xf86Output.*",
        "xf86CursorInfoRec",
        "OptionInfoRec",
        "ModeFlags",
        "LoaderErrorCode",
        "DisplayModeRec",
        "xorgHWFlags",
        "GDevRec",
        "CursorRec",
        "CursorBits",
        "_SourcePict.*",
        "PictTransform",
        "PictureScreenRec",
        "GlyphRec",
        "VisualRec",
    ];
    const VARIABLES: &[&str] = &[
        "HW_.*",
        "GET_REQUIRED_.*",
        "SUPPORTS_.*",
        "EXA_.*",
        "HARDWARE_CURSOR_.*",
        "V_.*",
        "M_T_.*",
        "DRAWABLE_.*",
        "GX[a-z].*",
        "Fill.*",
        "Line(Solid|OnOffDash|DoubleDash)",
        "Cap.*",
        "CoordMode.*",
        "[XYZ]{1,2}(Bitmap|Pixmap)",
        "PictOp.*",
        "PIXMAN_.*",
        "PictFormat.*",
        "PICT.*",
        "Repeat.*",
        "PictFilter.*",
        "Support32bppFb",
        "PreferConvert24to32",
        "DPMSMode.*",
        "X_[A-Z].*",
        "ABI_.*",
        "MODULE.*",
        "MODINFO.*",
        "XORG_VERSION_CURRENT",
        "OPTV_.*",
        "TrueColorMask",
        "TrueColor",
        "DirectColorMask",
        "xf86(Screens|NumScreens|CurrentScreen)",
        "CREATE_PIXMAP_.*",
        "XF86_.*",
        "Subpixel.*",
        "MODE_.*",
        "RR_.*",
        "SIG_.*",
        "SourcePict.*",
        "serverGeneration",
        "PictureScreenPrivateKeyRec",
        "SubPixel.*",
        "MOD_.*",
        "HaveDriverFuncs",
        "PROBE_.*",
        "TRUE",
        "Dash.*",
    ];

    pub fn main() {
        println!("cargo::rerun-if-changed=src/ffi/server.h");
        let flags = ask(&["--cflags", PACKAGE]);
        let abi = ask(&["--variable=abi_videodrv", PACKAGE]);
        let (major, minor) = abi.split_once('.').unwrap_or_else(|| {
            panic!("pkg-config --variable=abi_videodrv {PACKAGE} says {abi:?}, expected MAJOR.MINOR");
        });
        println!("cargo::rustc-env=ZGA_ABI_VIDEODRV_MAJOR={major}");
        println!("cargo::rustc-env=ZGA_ABI_VIDEODRV_MINOR={minor}");

        let mut builder = bindgen::Builder::default()
            .header("src/ffi/server.h")
            // Declarations that are hidden by default are none for bindgen; those of the C library would be.
            .clang_args(flags.split_whitespace().filter(|flag| !flag.starts_with("-fvisibility")))
            .allowlist_recursively(true)
            .default_enum_style(bindgen::EnumVariation::Consts)
            .prepend_enum_name(false)
            .derive_default(false)
            .layout_tests(false)
            .generate_comments(false)
            .merge_extern_blocks(true)
            .use_core()
            .rust_edition(bindgen::RustEdition::Edition2024);
        for function in FUNCTIONS {
            builder = builder.allowlist_function(function);
        }
        for name in TYPES {
            builder = builder.allowlist_type(name);
        }
        for variable in VARIABLES {
            builder = builder.allowlist_var(variable);
        }
        let made =
            builder.generate().unwrap_or_else(|error| panic!("the headers of {PACKAGE} do not translate: {error}"));
        let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
        made.write_to_file(out.join("server.rs")).expect("OUT_DIR can be written to");
    }

    /// What `pkg-config` answers.
    fn ask(arguments: &[&str]) -> String {
        let asked = format!("pkg-config {}", arguments.join(" "));
        let answer = Command::new("pkg-config").args(arguments).output();
        match answer {
            Ok(answer) if answer.status.success() => String::from_utf8_lossy(&answer.stdout).trim().to_owned(),
            Ok(answer) => panic!("{asked}: {}", String::from_utf8_lossy(&answer.stderr).trim()),
            Err(error) => panic!("{asked}: {error} (feature xorg needs pkg-config and xserver-xorg-dev)"),
        }
    }
}
