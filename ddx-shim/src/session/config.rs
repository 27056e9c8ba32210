//! Configuration: what the server is told about card, screen and itself.

use std::path::{Path, PathBuf};

use super::find::SYSTEM_MODULES;

/// Pixel clocks that the dummy driver can do, in MHz, with a little left.
const SLOWEST_CLOCK: f64 = 11.5;
const FASTEST_CLOCK: f64 = 290.0;

/// Which driver the server takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The module of this crate.
    Zga {
        /// The module's file.
        module: PathBuf,
        /// Socket of the live view; none without.
        link: Option<PathBuf>,
        /// Has the card draw; without, the server draws in the card's memory.
        accel: bool,
        /// Work in pixels under which an idle card is not woken; the module's default without.
        cpu_limit: Option<u32>,
    },
    /// The server's own driver without a card: memory alone.
    Dummy,
}

/// What a session is to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The server's driver.
    pub driver: Driver,
    /// Pixels of the screen.
    pub size: [u32; 2],
    /// Bits of a pixel that count: 24 or 16.
    pub depth: u32,
    /// Video memory in MiB; the driver's default without.
    pub memory: Option<u32>,
    /// Host threads that the card draws with; the module's default without.
    pub threads: Option<u32>,
}

impl Default for Options {
    /// The dummy driver, 1024 x 768, depth 24.
    fn default() -> Options {
        Options { driver: Driver::Dummy, size: [1024, 768], depth: 24, memory: None, threads: None }
    }
}

impl Options {
    /// The name of the driver as the server knows it.
    #[must_use]
    pub fn driver_name(&self) -> &'static str {
        match self.driver {
            Driver::Zga { .. } => "zga",
            Driver::Dummy => "dummy",
        }
    }

    /// The configuration as the server reads it. `modules`: the folder with the module.
    pub(super) fn text(&self, modules: &Path) -> String {
        let [width, height] = self.size;
        let mut device = format!("  Driver \"{}\"\n", self.driver_name());
        let mut option = |name: &str, value: &str| device.push_str(&format!("  Option \"{name}\" \"{value}\"\n"));
        if let Driver::Zga { link, accel, cpu_limit, .. } = &self.driver {
            option("Accel", if *accel { "true" } else { "false" });
            if let Some(link) = link {
                option("Link", &link.display().to_string());
            }
            if let Some(memory) = self.memory {
                option("VideoMemory", &memory.to_string());
            }
            if let Some(limit) = cpu_limit {
                option("CpuLimit", &limit.to_string());
            }
            if let Some(threads) = self.threads {
                option("Threads", &threads.to_string());
            }
        } else {
            // The dummy driver wants its memory in KiB; its own default is too small for a screen of today.
            let kib = self.memory.map_or(256 << 10, |mib| mib << 10);
            device.push_str(&format!("  VideoRam {kib}\n"));
        }
        // 60 Hz, or what the dummy driver's pixel clock can do. More than 160 pixels of blanking: less is "reduced", which
        // the server keeps from monitors that do not say they can.
        let (columns, rows) = (width + 240, height + 30);
        let clock = (f64::from(columns) * f64::from(rows) * 60.0 / 1e6).clamp(SLOWEST_CLOCK, FASTEST_CLOCK);
        let mode = format!(
            "  Modeline \"{width}x{height}\" {clock:.3} {width} {} {} {columns} {height} {} {} {rows}\n",
            width + 48,
            width + 120,
            height + 3,
            height + 9,
        );
        format!(
            "Section \"ServerFlags\"\n  Option \"AutoAddDevices\" \"false\"\n  Option \"AutoEnableDevices\" \"false\"\n  \
             Option \"AutoAddGPU\" \"false\"\n  Option \"AutoBindGPU\" \"false\"\n  Option \"DontVTSwitch\" \"true\"\n  \
             Option \"BlankTime\" \"0\"\n  Option \"StandbyTime\" \"0\"\n  Option \"SuspendTime\" \"0\"\n  \
             Option \"OffTime\" \"0\"\nEndSection\n\
             Section \"Files\"\n  ModulePath \"{},{SYSTEM_MODULES}\"\nEndSection\n\
             Section \"Device\"\n  Identifier \"card\"\n{device}EndSection\n\
             Section \"Monitor\"\n  Identifier \"monitor\"\n  HorizSync 5.0-1000.0\n  VertRefresh 5.0-200.0\n{mode}EndSection\n\
             Section \"Screen\"\n  Identifier \"screen\"\n  Device \"card\"\n  Monitor \"monitor\"\n  DefaultDepth {depth}\n  \
             SubSection \"Display\"\n    Depth {depth}\n    Modes \"{width}x{height}\"\n    Virtual {width} {height}\n  \
             EndSubSection\nEndSection\n",
            modules.display(),
            depth = self.depth,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_names_module_link_and_options() {
        let driver = Driver::Zga {
            module: "/m/zga_drv.so".into(),
            link: Some("/run/card".into()),
            accel: false,
            cpu_limit: Some(0),
        };
        let options = Options { driver, size: [800, 600], depth: 16, memory: Some(5), threads: Some(1) };
        let text = options.text(Path::new("/tmp/modules"));
        for line in [
            "  ModulePath \"/tmp/modules,/usr/lib/xorg/modules\"\n",
            "  Driver \"zga\"\n",
            "  Option \"Link\" \"/run/card\"\n",
            "  Option \"Accel\" \"false\"\n",
            "  Option \"VideoMemory\" \"5\"\n",
            "  Option \"CpuLimit\" \"0\"\n",
            "  Option \"Threads\" \"1\"\n",
            "  DefaultDepth 16\n",
            "    Modes \"800x600\"\n",
            "  Modeline \"800x600\" 39.312 800 848 920 1040 600 603 609 630\n",
        ] {
            assert!(text.contains(line), "{line} in {text}");
        }
    }

    #[test]
    fn text_of_the_dummy_has_none_of_the_cards_options() {
        let text = Options::default().text(Path::new("/tmp/modules"));
        assert!(text.contains("  Driver \"dummy\"\n  VideoRam 262144\n"), "{text}");
        assert!(!text.contains("Accel") && !text.contains("Link"), "{text}");
    }
}
