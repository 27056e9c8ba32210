//! A scene in a window: the monitor at the card's cable.
//!
//! Duties: turns mouse and keys into cameras, looks and settings, has the card draw when something changed, and shows
//! what scan-out puts on the cable. Inputs from: minifb, [`zga_device::Monitor`]. Outputs to: [`Session`].

use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;

use minifb::{InputCallback, Key, MouseButton, MouseMode, Window, WindowOptions};
use zga_abi::format::{Fidelity, HiddenSurface, SubpixelGrid};
use zga_abi::packet::Opcode;
use zga_abi::{Counter, Effects, Reg};
use zga_driver::CardInfo;

use crate::error::{Error, Result};
use crate::paths::View;
use crate::picture::Picture;
use crate::play::{Look, Session, Settings};
use crate::scene::{Lighting, Scene, TextureFilter};
use crate::table::grouped;

/// Radians of a turn for each pixel that the mouse is dragged.
const TURN_PER_PIXEL: f64 = 0.008;
/// Distance factor of a step of the wheel.
const ZOOM_STEP: f64 = 0.92;
/// Longest wait for a frame: scan-out gives one every 17 ms.
const FRAME_WAIT: Duration = Duration::from_millis(50);
/// What the keys do.
const HELP: &str = "drag: orbit, wheel: zoom, P path, F fidelity, A anti-aliasing, V view of path or samples, D decals, \
     W wireframe, T texture filter, L light, G fog, Space animation, S save, Esc end";

/// A window for a picture of this size; none where there is no display.
pub(crate) fn open(name: &str, size: [u32; 2]) -> Option<Window> {
    let [width, height] = size.map(|pixels| pixels as usize);
    Window::new(&format!("ZGA: {name} (H for help)"), width, height, WindowOptions::default()).ok()
}

/// What is shown.
pub(crate) struct Show<'a> {
    /// Its name.
    pub name: &'a str,
    /// The scene at a frame.
    pub scene: &'a dyn Fn(u32) -> Scene,
    /// File for saved picture number n.
    pub save: &'a dyn Fn(u32) -> PathBuf,
    /// How it is looked at first.
    pub look: Look,
    /// What is painted over it at first.
    pub view: Option<View>,
}

/// Keys in the order in which they went down. A key that is down and up again while a frame is drawn is among them, which
/// a look at the keyboard once a frame would miss.
#[derive(Clone, Debug, Default)]
struct Taps(Rc<RefCell<Keys>>);

#[derive(Debug, Default)]
struct Keys {
    /// What is down: a key that is held says so again and again.
    down: Vec<Key>,
    tapped: Vec<Key>,
}

impl Taps {
    /// The keys since the last call.
    fn take(&self) -> Vec<Key> {
        std::mem::take(&mut self.0.borrow_mut().tapped)
    }
}

impl InputCallback for Taps {
    fn add_char(&mut self, _: u32) {}

    fn set_key_state(&mut self, key: Key, down: bool) {
        let mut keys = self.0.borrow_mut();
        if !down {
            keys.down.retain(|held| *held != key);
        } else if !keys.down.contains(&key) {
            keys.down.push(key);
            keys.tapped.push(key);
        }
    }
}

/// What is painted over the picture. A view of the path follows the path, and that of the samples the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Over {
    /// Nothing.
    Nothing,
    /// What the path knows; where it knows nothing, what the sub-pixel unit took up.
    Path,
    /// What the sub-pixel unit took up.
    Samples,
}

/// What mouse and keys have set.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Controls {
    look: Look,
    settings: Settings,
    yaw: f64,
    pitch: f64,
    zoom: f64,
    frame: u32,
    animated: bool,
    help: bool,
    over: Over,
}

impl Show<'_> {
    /// Shows until the window is closed.
    ///
    /// # Errors
    /// [`Error::Driver`]; [`Error::Write`] if a picture cannot be saved.
    pub(crate) fn run(&self, session: &mut Session, mut window: Window) -> Result<()> {
        let fault = || Error::driver(self.name);
        let mut monitor = session.monitor();
        let driver = session.driver();
        driver.packet(Opcode::RegisterWrite, &[Reg::ScanoutControl.offset(), 1]).map_err(fault())?;
        let mut controls = Controls {
            look: self.look,
            settings: *session.settings(),
            yaw: 0.0,
            pitch: 0.0,
            zoom: 1.0,
            frame: 0,
            animated: false,
            help: false,
            over: match self.view {
                None => Over::Nothing,
                Some(View::Subpixel) => Over::Samples,
                Some(_) => Over::Path,
            },
        };
        let mut painted: Option<Picture> = None;
        let mut shown: Option<(Controls, bool)> = None;
        let mut title = String::new();
        let mut mouse: Option<(f32, f32)> = None;
        let mut saved = 0;
        let taps = Taps::default();
        window.set_input_callback(Box::new(taps.clone()));
        while window.is_open() {
            let tapped = taps.take();
            if tapped.contains(&Key::Escape) {
                break;
            }
            for key in &tapped {
                controls.press(*key, session.driver().card_info());
            }
            let dragged = window.get_mouse_down(MouseButton::Left);
            let at = window.get_mouse_pos(MouseMode::Pass);
            if let (Some(from), Some(to), true) = (mouse, at, dragged) {
                controls.drag(to.0 - from.0, to.1 - from.1);
            }
            mouse = at;
            if let Some((_, steps)) = window.get_scroll_wheel() {
                controls.zoom = (controls.zoom * ZOOM_STEP.powf(f64::from(steps.signum()))).clamp(0.1, 10.0);
            }
            if controls.animated {
                controls.frame = controls.frame.wrapping_add(1);
            }
            if shown != Some((controls, dragged)) {
                let mut scene = (self.scene)(controls.frame);
                scene.camera = scene.camera.orbited(controls.yaw, controls.pitch, controls.zoom);
                session.set(controls.settings)?;
                session.driver().clear_counters();
                session.draw(&scene, controls.look)?;
                session.driver().finish().map_err(fault())?;
                shown = Some((controls, dragged));
                let counters = session.driver().counters();
                // How often the picture was scanned out meanwhile depends on the host.
                let clocks = counters.get(Counter::CyclesTotal) - counters.get(Counter::CyclesScanout);
                // Some views take seconds: too long to follow the mouse.
                painted = if dragged { None } else { controls.painted(session, &scene).transpose()? };
                let told = controls.title(self.name, clocks);
                if told != title {
                    window.set_title(&told);
                    title = told;
                }
            }
            match monitor.wait_next(FRAME_WAIT) {
                Some(frame) => {
                    let size = [frame.width(), frame.height()].map(|pixels| pixels as usize);
                    let view = painted.as_ref().map(Picture::xrgb);
                    // A window that cannot be drawn to any more is as good as closed.
                    if window.update_with_buffer(view.as_deref().unwrap_or(frame.pixels()), size[0], size[1]).is_err() {
                        break;
                    }
                }
                None => window.update(),
            }
            if tapped.contains(&Key::S) {
                let file = self.free_file(&mut saved);
                match &painted {
                    Some(view) => view.save(&file)?,
                    None => Picture::of_frame(&session.driver().capture().map_err(fault())?).save(&file)?,
                }
                window.set_title(&format!("ZGA: saved {}", file.display()));
            }
        }
        Ok(())
    }

    /// The next file that is not there yet.
    fn free_file(&self, number: &mut u32) -> PathBuf {
        loop {
            *number += 1;
            let file = (self.save)(*number);
            if !file.exists() {
                return file;
            }
        }
    }
}

impl Controls {
    /// What a key does on this card.
    fn press(&mut self, key: Key, card: &CardInfo) {
        match key {
            Key::D => self.look.decals = !self.look.decals,
            Key::W => self.look.wireframe = !self.look.wireframe,
            Key::P => self.settings.hidden_surface = next_path(self.settings.hidden_surface, card),
            Key::F if card.has_clocked_model() => {
                self.settings.fidelity = match self.settings.fidelity {
                    Fidelity::Functional => Fidelity::Clocked,
                    Fidelity::Clocked => Fidelity::Functional,
                };
            }
            Key::A if card.effects.contains(Effects::ANTI_ALIAS) => {
                self.settings.antialias.grid = next_grid(self.settings.antialias.grid);
            }
            Key::T if card.effects.contains(Effects::TEXTURE) => {
                self.look.filter = next_of(TextureFilter::NAMED, self.look.filter);
            }
            Key::L if card.effects.contains(Effects::LIGHT) => {
                self.look.lighting = next_of(&Lighting::NAMED[1..], self.look.lighting);
            }
            Key::G if card.effects.contains(Effects::FOG) => self.look.other_fog = !self.look.other_fog,
            Key::Space => self.animated = !self.animated,
            Key::V => self.over = self.next_over(),
            Key::H => self.help = !self.help,
            _ => {}
        }
    }

    /// What is painted over the picture after this: the view of the path, that of the samples where both are to be had,
    /// nothing.
    fn next_over(&self) -> Over {
        let both = View::of(self.settings.hidden_surface).is_some() && self.settings.is_antialiased();
        match self.over {
            Over::Nothing => Over::Path,
            Over::Path if both => Over::Samples,
            Over::Path | Over::Samples => Over::Nothing,
        }
    }

    /// The view that is painted over the picture, if what is asked for is to be had.
    fn view(&self) -> Option<View> {
        let samples = Some(View::Subpixel).filter(|_| self.settings.is_antialiased());
        match self.over {
            Over::Nothing => None,
            Over::Path => View::of(self.settings.hidden_surface).or(samples),
            Over::Samples => samples,
        }
    }

    /// The view over the frame that was just drawn.
    fn painted(&self, session: &mut Session, scene: &Scene) -> Option<Result<Picture>> {
        let view = self.view()?;
        let frame = session.driver().capture().map_err(Error::driver("view"));
        Some(frame.and_then(|frame| view.paint(session, scene, self.look, &frame)))
    }

    fn drag(&mut self, right: f32, down: f32) {
        self.yaw = (self.yaw - f64::from(right) * TURN_PER_PIXEL) % std::f64::consts::TAU;
        self.pitch = (self.pitch + f64::from(down) * TURN_PER_PIXEL).clamp(-3.0, 3.0);
    }

    /// The window's title; `clocks`: what drawing the frame cost.
    fn title(&self, name: &str, clocks: u64) -> String {
        if self.help {
            return format!("ZGA: {name}: {HELP}");
        }
        let path = self.settings.hidden_surface.name();
        let clocked = if self.settings.fidelity == Fidelity::Clocked { ", clocked" } else { "" };
        let grid = self.settings.antialias.grid.name();
        let grid = if self.settings.is_antialiased() { format!(", {grid} anti-aliased") } else { String::new() };
        let decals = if self.look.decals { "" } else { ", without decals" };
        let filter = self.look.filter.map_or(String::new(), |filter| format!(", {} texels", filter.name()));
        let light = self.look.lighting.map_or(String::new(), |light| format!(", light at each {}", light.name()));
        let fog = if self.look.other_fog { ", other fog" } else { "" };
        let view = self.view().map_or(String::new(), |view| format!(", view of {}", view.name()));
        let wires = if self.look.wireframe { ", wireframe" } else { "" };
        format!(
            "ZGA: {name}, {path} path{clocked}{grid}{view}{decals}{wires}{filter}{light}{fog}, {} clocks to draw (H for help)",
            grouped(clocks)
        )
    }
}

/// The value after this one; none, which leaves it to the materials, after the last.
fn next_of<T: Copy + PartialEq>(named: &[(&str, T)], value: Option<T>) -> Option<T> {
    let place = value.map_or(Some(0), |value| Some(named.iter().position(|(_, known)| *known == value)? + 1));
    named.get(place?).map(|(_, value)| *value)
}

/// The grid after this one.
fn next_grid(grid: SubpixelGrid) -> SubpixelGrid {
    let place = SubpixelGrid::ALL.iter().position(|known| *known == grid).unwrap_or(0);
    SubpixelGrid::ALL[(place + 1) % SubpixelGrid::ALL.len()]
}

/// The path after this one, among those that the card has.
fn next_path(path: HiddenSurface, card: &CardInfo) -> HiddenSurface {
    let paths = HiddenSurface::ALL.iter().copied().filter(|path| card.has_path(*path));
    let mut after = paths.cycle().skip_while(|known| *known != path).skip(1);
    // A card that has not even this one has no other: cycle() would look for ever.
    if card.has_path(path) { after.next().unwrap_or(path) } else { path }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zga_abi::format::DepthFormat;
    use zga_driver::{Antialias, SystolicVariant, ZaSettings};

    fn start() -> Controls {
        let settings = Settings {
            hidden_surface: HiddenSurface::ZBuffer,
            fidelity: Fidelity::Functional,
            depth: DepthFormat::default(),
            subpixel_bits: 8,
            antialias: Antialias { grid: SubpixelGrid::Off, ..Antialias::default() },
            za: ZaSettings::default(),
            systolic: SystolicVariant::default(),
            tile_size: [8, 8],
        };
        let look = Look::default();
        Controls {
            look,
            settings,
            yaw: 0.0,
            pitch: 0.0,
            zoom: 1.0,
            frame: 0,
            animated: false,
            help: false,
            over: Over::Nothing,
        }
    }

    fn card(paths: u32) -> CardInfo {
        let effects = Effects::DEPTH;
        CardInfo { major: 1, minor: 0, effects, paths, video_memory: 0, za_ram: 0, fifo_words: 0 }
    }

    #[test]
    fn title_tells_what_is_switched_and_the_keys() {
        assert_eq!(start().title("teapot", 1234), "ZGA: teapot, zbuffer path, 1 234 clocks to draw (H for help)");
        let mut bare = Controls { look: Look { decals: false, wireframe: true, ..Look::default() }, ..start() };
        bare.settings.fidelity = Fidelity::Clocked;
        assert_eq!(
            bare.title("teapot", 5),
            "ZGA: teapot, zbuffer path, clocked, without decals, wireframe, 5 clocks to draw (H for help)"
        );
        assert!(Controls { help: true, ..start() }.title("teapot", 5).contains("P path, F fidelity, A anti-aliasing"));
    }

    #[test]
    fn taps_keys_that_are_up_again_and_held_ones_count_once() {
        let mut taps = Taps::default();
        let events = [(Key::P, true), (Key::P, false), (Key::F, true), (Key::F, true), (Key::P, true)];
        events.into_iter().for_each(|(key, down)| taps.set_key_state(key, down));
        assert_eq!(taps.take(), [Key::P, Key::F, Key::P]);
        taps.set_key_state(Key::F, true);
        assert!(taps.take().is_empty());
    }

    #[test]
    fn press_t_l_and_g_switch_filter_light_and_fog_where_the_card_has_them() {
        let mut controls = start();
        let all = CardInfo { effects: Effects::all(), ..card(1) };
        [Key::T, Key::L, Key::G].into_iter().for_each(|key| controls.press(key, &card(1)));
        assert_eq!(controls, start());
        let filters = [(); 4].map(|()| {
            controls.press(Key::T, &all);
            controls.look.filter.map(TextureFilter::name)
        });
        assert_eq!(filters, [Some("nearest"), Some("bilinear"), Some("trilinear"), None]);
        let lights = [(); 3].map(|()| {
            controls.press(Key::L, &all);
            controls.look.lighting.map(Lighting::name)
        });
        assert_eq!(lights, [Some("vertex"), Some("pixel"), None]);
        [Key::T, Key::L, Key::G].into_iter().for_each(|key| controls.press(key, &all));
        let title = controls.title("teapot", 5);
        assert!(title.contains("zbuffer path, nearest texels, light at each vertex, other fog, 5 clocks"), "{title}");
    }

    #[test]
    fn press_v_views_what_the_path_knows() {
        let mut controls = start();
        controls.press(Key::V, &card(0b1111));
        assert!(!controls.title("teapot", 5).contains("view"), "the plain Z buffer has none");
        controls.settings.hidden_surface = HiddenSurface::Systolic;
        assert_eq!(
            controls.title("teapot", 5),
            "ZGA: teapot, systolic path, view of tokens, 5 clocks to draw (H for help)"
        );
    }

    #[test]
    fn press_v_with_a_grid_views_the_samples_after_the_path() {
        let names = |path: HiddenSurface, grid: SubpixelGrid| {
            let mut controls = start();
            controls.settings.hidden_surface = path;
            controls.settings.antialias.grid = grid;
            [(); 3].map(|()| {
                controls.press(Key::V, &card(0b1111));
                controls.view().map(View::name)
            })
        };
        assert_eq!(names(HiddenSurface::Za, SubpixelGrid::Grid8x8), [Some("za"), Some("subpixel"), None]);
        assert_eq!(names(HiddenSurface::ZBuffer, SubpixelGrid::Grid4x4), [Some("subpixel"), None, Some("subpixel")]);
        assert_eq!(names(HiddenSurface::Tile, SubpixelGrid::Off), [Some("tiles"), None, Some("tiles")]);
        assert_eq!(names(HiddenSurface::ZBuffer, SubpixelGrid::Off), [None; 3]);
    }

    #[test]
    fn press_a_to_no_grid_ends_the_view_of_the_samples() {
        let mut controls = Controls { over: Over::Samples, ..start() };
        controls.settings.antialias.grid = SubpixelGrid::Grid8x8;
        assert_eq!(
            controls.title("teapot", 5),
            "ZGA: teapot, zbuffer path, 8x8 anti-aliased, view of subpixel, 5 clocks to draw (H for help)"
        );
        controls.press(Key::A, &CardInfo { effects: Effects::DEPTH | Effects::ANTI_ALIAS, ..card(0b1111) });
        assert!(!controls.title("teapot", 5).contains("view"));
    }

    #[test]
    fn press_p_goes_round_the_paths_that_the_card_has() {
        let round = |paths: u32| {
            let mut controls = start();
            [(); 3].map(|()| {
                controls.press(Key::P, &card(paths));
                controls.settings.hidden_surface.name()
            })
        };
        assert_eq!(round(0b1101), ["systolic", "tile", "zbuffer"]);
        assert_eq!(round(0b0001), ["zbuffer"; 3]);
        assert_eq!(round(0b0110), ["zbuffer"; 3], "there is no way on from a path that is not there");
    }

    #[test]
    fn press_f_switches_fidelity_where_there_is_a_clocked_model() {
        let mut controls = start();
        controls.press(Key::F, &card(0b0001));
        assert_eq!(controls.settings.fidelity, Fidelity::Functional);
        controls.press(Key::F, &card(0b0011));
        assert_eq!(controls.settings.fidelity, Fidelity::Clocked);
        controls.press(Key::F, &card(0b0011));
        assert_eq!(controls.settings.fidelity, Fidelity::Functional);
    }

    #[test]
    fn press_a_goes_round_the_grids_where_there_is_a_unit() {
        let mut controls = start();
        controls.press(Key::A, &card(0b0001));
        assert!(!controls.settings.is_antialiased());
        let unit = CardInfo { effects: Effects::DEPTH | Effects::ANTI_ALIAS, ..card(0b0001) };
        let names = [(); 4].map(|()| {
            controls.press(Key::A, &unit);
            controls.settings.antialias.grid.name()
        });
        assert_eq!(names, ["4x4", "8x4", "8x8", "off"]);
        controls.press(Key::A, &unit);
        assert_eq!(
            controls.title("teapot", 5),
            "ZGA: teapot, zbuffer path, 4x4 anti-aliased, 5 clocks to draw (H for help)"
        );
    }

    #[test]
    fn drag_to_the_right_turns_the_camera_to_the_left() {
        let mut controls = start();
        controls.drag(10.0, 2000.0);
        assert!(controls.yaw < 0.0);
        assert!(controls.pitch <= 3.0);
    }
}
