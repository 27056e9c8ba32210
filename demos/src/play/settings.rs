//! What a scene and the command line ask of the card, whether it has it, and how it is set up so.
//!
//! Duties: [`Settings::resolve`] merges scene and command line and refuses what the card has not, by the name of flag
//! or field; [`Settings::apply`] hands the result to the driver. Inputs from: [`CardSettings`], [`Asked`],
//! [`CardInfo`]. Outputs to: [`super::Session`], [`crate::bench`], reports.

use serde_json::{Value, json};
use zga_abi::format::{DepthFormat, Fidelity, HiddenSurface, SubpixelDepth, SubpixelEdges, SubpixelGrid};
use zga_abi::{Bus, Effects};
use zga_device::Kernel;
use zga_driver::{Antialias, CardInfo, Driver, DriverError, SystolicVariant, ZaSettings};

use crate::error::{Error, Result};
use crate::scene::CardSettings;

/// Pixel kernels by name.
pub const KERNELS: [(&str, Kernel); 6] = [
    ("best", Kernel::Best),
    ("specification", Kernel::Specification),
    ("sse2", Kernel::Sse2),
    ("sse42", Kernel::Sse42),
    ("avx2", Kernel::Avx2),
    ("avx512", Kernel::Avx512),
];

/// Most Za RAM that a card can have, bytes.
pub const MOST_ZA_RAM: u32 = 32 << 20;

/// What the command line asks for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Asked {
    /// Pixels of a row, and rows; `None` leaves it to the scene.
    pub size: Option<[u32; 2]>,
    /// Host threads; 0 takes all cores.
    pub threads: usize,
    /// Pixel code.
    pub kernel: Kernel,
    /// Bits of a pixel that coordinates are snapped to; `None` leaves it to the card.
    pub subpixel_bits: Option<u32>,
    /// What goes before the scene's own settings; `None` leaves it to the scene, and then to the card.
    pub card: CardSettings,
}

/// What a card is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Which path decides what is hidden.
    pub hidden_surface: HiddenSurface,
    /// How the units with a clocked model are simulated.
    pub fidelity: Fidelity,
    /// Number format of depth.
    pub depth: DepthFormat,
    /// Bits of a pixel that coordinates are snapped to.
    pub subpixel_bits: u32,
    /// Anti-aliasing; off where its grid is.
    pub antialias: Antialias,
    /// The Za unit.
    pub za: ZaSettings,
    /// The systolic array.
    pub systolic: SystolicVariant,
    /// Width and height of a tile of the tile unit, pixels.
    pub tile_size: [u32; 2],
}

/// Refuses a kernel that this host cannot run.
///
/// # Errors
/// [`Error::Unsupported`] with those that it can.
pub fn check_kernel(kernel: Kernel) -> Result<()> {
    let available = Kernel::available();
    let name = |wanted: Kernel| KERNELS.iter().find(|(_, kernel)| *kernel == wanted).map_or("", |(name, _)| *name);
    if available.contains(&kernel) {
        return Ok(());
    }
    let names: Vec<&str> = available.into_iter().map(name).collect();
    Err(Error::Unsupported {
        place: "--kernel".to_owned(),
        found: name(kernel).to_owned(),
        has: format!("this processor has {}", names.join(", ")),
    })
}

/// Bytes of Za RAM for pictures of this size: two frames with a word for each pixel, as far as a card can have them.
#[must_use]
pub fn za_ram(size: [u32; 2]) -> u32 {
    let words = 2 * u64::from(size[0]) * u64::from(size[1]);
    (4 * words).next_multiple_of(1 << 20).min(MOST_ZA_RAM.into()) as u32
}

impl Settings {
    /// The settings of a card `info` for a scene called `name` of `size` pixels; the command line goes before the
    /// scene.
    ///
    /// # Errors
    /// [`Error::Unsupported`] with the flag or field, and what the card has.
    pub fn resolve(name: &str, scene: &CardSettings, asked: &Asked, size: [u32; 2], info: &CardInfo) -> Result<Self> {
        let refused = |by_flag: bool, field: &str, found: String, has: String| {
            let place =
                if by_flag { format!("--{}", field.replace('_', "-")) } else { format!("{name}: card.{field}") };
            Err(Error::Unsupported { place, found, has })
        };
        let (flags, card) = (&asked.card, asked.card.or(*scene));

        let hidden_surface = card.hidden_surface.unwrap_or(HiddenSurface::ZBuffer);
        if !info.has_path(hidden_surface) {
            let paths = HiddenSurface::ALL.iter().filter(|path| info.has_path(**path)).map(|path| path.name());
            let has = format!("this card has {}", paths.collect::<Vec<_>>().join(", "));
            let by_flag = flags.hidden_surface.is_some();
            return refused(by_flag, "hidden_surface", hidden_surface.name().to_owned(), has);
        }
        let fidelity = card.fidelity.unwrap_or(Fidelity::Functional);
        if fidelity == Fidelity::Clocked && !info.has_clocked_model() {
            let has = "this card has functional; none of its units has a clocked model".to_owned();
            return refused(flags.fidelity.is_some(), "fidelity", fidelity.name().to_owned(), has);
        }
        let plain = Antialias::default();
        let depth = card.subpixel_depth.unwrap_or(plain.depth);
        // What is ordered sample by sample is supersampling, inside surfaces too.
        let edges = if depth == SubpixelDepth::Exhaustive { SubpixelEdges::All } else { SubpixelEdges::Borders };
        let antialias = Antialias {
            grid: card.antialias.unwrap_or(SubpixelGrid::Off),
            depth,
            resolve: card.antialias_resolve.unwrap_or(plain.resolve),
            pool: card.subpixel_pool.unwrap_or(plain.pool),
            edges: card.antialias_edges.unwrap_or(edges),
        };
        if antialias.grid != SubpixelGrid::Off && !info.effects.contains(Effects::ANTI_ALIAS) {
            let has = "this card has off; it has no sub-pixel unit".to_owned();
            return refused(flags.antialias.is_some(), "antialias", antialias.grid.name().to_owned(), has);
        }
        let plain = DepthFormat::default();
        let bits = card.depth_bits.unwrap_or(plain.bits());
        let fraction = card.depth_fraction_bits.unwrap_or(plain.fraction());
        let Some(depth) = DepthFormat::new(bits, fraction) else {
            let found = format!("{bits} bits with {fraction} fraction bits");
            let has = "this card has 16, 24 or 31 bits with 0, 8, 16 or 24 fraction bits".to_owned();
            let by_flag = flags.depth_bits.is_some() || flags.depth_fraction_bits.is_some();
            return refused(by_flag, "depth_bits", found, has);
        };

        let plain = ZaSettings::default();
        let za = ZaSettings {
            block: card.za_block.unwrap_or(plain.block),
            prediction: card.za_prediction.unwrap_or(plain.prediction),
            bypass: card.za_bypass.unwrap_or(plain.bypass),
        };
        let needed = za.frame_bytes(size[0], size[1]);
        if hidden_surface == HiddenSurface::Za && needed > u64::from(info.za_ram) {
            let ([across, down], [width, height], has) = (za.block, size, info.za_ram);
            let has = format!("{width} x {height} pixels need {needed} bytes of Za RAM then, this card has {has}");
            return refused(flags.za_block.is_some(), "za_block", format!("{across} x {down}"), has);
        }
        let (plain, asked_variant) = (SystolicVariant::default(), card.systolic_variant);
        let systolic = SystolicVariant {
            end_test: asked_variant.end_test.unwrap_or(plain.end_test),
            ports: asked_variant.ports.unwrap_or(plain.ports),
            colour: asked_variant.colour.unwrap_or(plain.colour),
            super_buffer: asked_variant.super_buffer.unwrap_or(plain.super_buffer),
        };
        let tile_size = card.tile_size.unwrap_or([8, 8]);
        let preset_bits = card.preset.map(zga_driver::Preset::subpixel_bits);
        let subpixel_bits = asked.subpixel_bits.or(preset_bits).unwrap_or(8);
        Ok(Self { hidden_surface, fidelity, depth, subpixel_bits, antialias, za, systolic, tile_size })
    }

    /// Sets a driver up, all but the depth format: that is the target's.
    ///
    /// # Errors
    /// What the driver refuses; nothing, if the settings were resolved for its card.
    pub fn apply<B: Bus>(&self, driver: &mut Driver<B>) -> std::result::Result<(), DriverError> {
        driver.set_hidden_surface(self.hidden_surface)?;
        driver.set_fidelity(self.fidelity)?;
        driver.set_subpixel_bits(self.subpixel_bits)?;
        driver.set_antialias(Some(self.antialias))?;
        driver.set_za(self.za)?;
        driver.set_systolic(self.systolic);
        driver.set_tile_size(self.tile_size)
    }

    /// Pixels have samples.
    #[must_use]
    pub fn is_antialiased(&self) -> bool {
        self.antialias.grid != SubpixelGrid::Off
    }

    /// The settings that the path in use and anti-aliasing depend on, named as in a scene's `card`.
    #[must_use]
    pub fn report(&self) -> Value {
        let mut card = json!({
            "depth_bits": self.depth.bits(),
            "depth_fraction_bits": self.depth.fraction(),
            "antialias": self.antialias.grid.name(),
        });
        if self.is_antialiased() {
            card["subpixel_depth"] = self.antialias.depth.name().into();
            card["antialias_resolve"] = self.antialias.resolve.name().into();
            card["subpixel_pool"] = self.antialias.pool.into();
            card["antialias_edges"] = self.antialias.edges.name().into();
        }
        match self.hidden_surface {
            HiddenSurface::ZBuffer => {}
            HiddenSurface::Za => {
                card["za_block"] = json!(self.za.block);
                card["za_prediction"] = self.za.prediction.name().into();
                card["za_bypass"] = self.za.bypass.into();
            }
            HiddenSurface::Systolic => {
                card["systolic_variant"] = json!({
                    "end_test": self.systolic.end_test.name(),
                    "ports": self.systolic.ports.name(),
                    "colour": self.systolic.colour.name(),
                    "super_buffer": self.systolic.super_buffer,
                });
            }
            HiddenSurface::Tile => card["tile_size"] = json!(self.tile_size),
        }
        card
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{SystolicSettings, ZaPrediction};
    use zga_abi::format::{EndTest, SubpixelResolve, TokenColour, TokenPorts};

    const INFO: CardInfo =
        CardInfo { major: 1, minor: 0, effects: Effects::DEPTH, paths: 1, video_memory: 0, za_ram: 0, fifo_words: 0 };
    const ALL_PATHS: CardInfo = CardInfo { paths: 15, za_ram: 1 << 20, ..INFO };
    const SIZE: [u32; 2] = [640, 480];

    fn refused(scene: &CardSettings, asked: &Asked, info: &CardInfo) -> String {
        Settings::resolve("a.json", scene, asked, SIZE, info).expect_err("unsupported").to_string()
    }

    fn asking(card: CardSettings) -> Asked {
        Asked { card, ..Asked::default() }
    }

    #[test]
    fn resolve_flags_go_before_the_scene() {
        let plain = CardSettings::default();
        let zero = SystolicSettings { end_test: Some(EndTest::Zero), ..SystolicSettings::default() };
        let merged = SystolicSettings { ports: Some(TokenPorts::Merged), ..SystolicSettings::default() };
        let scene = CardSettings {
            depth_bits: Some(16),
            depth_fraction_bits: Some(8),
            za_block: Some([8, 8]),
            systolic_variant: zero,
            ..plain
        };
        let flags = CardSettings {
            depth_bits: Some(31),
            za_prediction: Some(ZaPrediction::Plane),
            systolic_variant: merged,
            ..plain
        };
        let asked = Asked { subpixel_bits: Some(4), ..asking(flags) };
        let settings = Settings::resolve("a.json", &scene, &asked, SIZE, &INFO).expect("possible");
        assert_eq!((settings.depth.bits(), settings.depth.fraction(), settings.subpixel_bits), (31, 8, 4));
        assert_eq!(settings.za, ZaSettings { block: [8, 8], prediction: ZaPrediction::Plane, bypass: true });
        let variant = SystolicVariant {
            end_test: EndTest::Zero,
            ports: TokenPorts::Merged,
            colour: TokenColour::Tag,
            super_buffer: false,
        };
        assert_eq!((settings.systolic, settings.tile_size), (variant, [8, 8]));
    }

    #[test]
    fn resolve_what_the_card_has_not_names_flag_or_field() {
        let plain = CardSettings::default();
        let none = Asked::default();
        let asked = asking(CardSettings { hidden_surface: Some(HiddenSurface::Systolic), ..plain });
        assert_eq!(refused(&plain, &asked, &INFO), "--hidden-surface: systolic is not possible: this card has zbuffer");
        let scene = CardSettings { antialias: Some(SubpixelGrid::Grid8x8), ..plain };
        assert!(refused(&scene, &none, &INFO).starts_with("a.json: card.antialias: 8x8 is not possible"));
        let asked = asking(CardSettings { fidelity: Some(Fidelity::Clocked), ..plain });
        assert!(
            refused(&plain, &asked, &INFO).starts_with("--fidelity: clocked is not possible: this card has functional")
        );
        let asked = asking(CardSettings { depth_bits: Some(17), ..plain });
        assert!(refused(&plain, &asked, &INFO).starts_with("--depth-bits: 17 bits"));
    }

    #[test]
    fn resolve_za_blocks_that_za_ram_cannot_hold_are_refused_where_they_are_used() {
        let fine = CardSettings { za_block: Some([1, 1]), ..CardSettings::default() };
        assert!(Settings::resolve("a.json", &fine, &Asked::default(), SIZE, &ALL_PATHS).is_ok(), "not on this path");
        let za = CardSettings { hidden_surface: Some(HiddenSurface::Za), ..fine };
        let reason = "1 x 1 is not possible: 640 x 480 pixels need 1228800 bytes of Za RAM then, this card has 1048576";
        assert_eq!(refused(&za, &Asked::default(), &ALL_PATHS), format!("a.json: card.za_block: {reason}"));
        assert_eq!(refused(&CardSettings::default(), &asking(za), &ALL_PATHS), format!("--za-block: {reason}"));
    }

    #[test]
    fn report_holds_what_the_path_depends_on() {
        let card = |path| {
            let asked = asking(CardSettings { hidden_surface: Some(path), ..CardSettings::default() });
            Settings::resolve("a.json", &CardSettings::default(), &asked, SIZE, &ALL_PATHS).expect("possible").report()
        };
        let keys = |path| card(path).as_object().map_or(0, serde_json::Map::len);
        assert_eq!(card(HiddenSurface::Za)["za_block"], json!([32, 1]));
        assert_eq!(card(HiddenSurface::Systolic)["systolic_variant"]["ports"], "swapped");
        assert_eq!(card(HiddenSurface::Tile)["tile_size"], json!([8, 8]));
        let counts =
            [HiddenSurface::ZBuffer, HiddenSurface::Za, HiddenSurface::Systolic, HiddenSurface::Tile].map(keys);
        assert_eq!(counts, [3, 6, 4, 4]);
    }

    #[test]
    fn resolve_antialias_of_flags_and_scene_and_report_it() {
        let info = CardInfo { effects: Effects::DEPTH | Effects::ANTI_ALIAS, ..ALL_PATHS };
        let plain = CardSettings::default();
        let scene = CardSettings {
            antialias: Some(SubpixelGrid::Grid4x4),
            subpixel_depth: Some(SubpixelDepth::Exhaustive),
            subpixel_pool: Some(999),
            ..plain
        };
        let flags = CardSettings {
            antialias: Some(SubpixelGrid::Grid8x4),
            antialias_resolve: Some(SubpixelResolve::Linear),
            ..plain
        };
        let resolved = |scene: &CardSettings, flags| {
            Settings::resolve("a.json", scene, &asking(flags), SIZE, &info).expect("possible")
        };
        let settings = resolved(&scene, flags);
        let (depth, resolve) = (SubpixelDepth::Exhaustive, SubpixelResolve::Linear);
        assert_eq!(
            settings.antialias,
            Antialias { grid: SubpixelGrid::Grid8x4, depth, resolve, pool: 999, edges: SubpixelEdges::All }
        );
        let report = settings.report();
        assert_eq!((&report["antialias"], &report["subpixel_depth"]), (&json!("8x4"), &json!("exhaustive")));
        assert_eq!((&report["antialias_resolve"], &report["subpixel_pool"]), (&json!("linear"), &json!(999)));
        assert_eq!(report["antialias_edges"], json!("all"));
        // Supersampling has all edges, unless somebody asks for less; the rest has borders.
        let edges = |scene: &CardSettings, flags| resolved(scene, flags).antialias.edges;
        assert_eq!(
            edges(&plain, CardSettings { antialias: Some(SubpixelGrid::Grid8x4), ..plain }),
            SubpixelEdges::Borders
        );
        let asked = CardSettings { antialias_edges: Some(SubpixelEdges::Borders), ..plain };
        assert_eq!(edges(&scene, asked), SubpixelEdges::Borders);
        let off = resolved(&scene, CardSettings { antialias: Some(SubpixelGrid::Off), ..plain });
        assert!(!off.is_antialiased());
        assert_eq!((&off.report()["antialias"], off.report().get("subpixel_depth")), (&json!("off"), None));
    }

    #[test]
    fn za_ram_holds_two_frames_of_the_finest_blocks_up_to_the_most_there_is() {
        assert_eq!(za_ram([640, 480]), 3 << 20);
        assert_eq!([[1, 1], [16384, 16384]].map(za_ram), [1 << 20, MOST_ZA_RAM]);
    }
}
