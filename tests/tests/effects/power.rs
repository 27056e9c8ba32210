//! What is not called for has no power and counts nothing; at the level of registers.

use super::bench::{sheet, specified};
use zga_tests::harness::events::NAMES;
use zga_tests::harness::look::{Fog, Lights, Record};
use zga_tests::harness::{Events, Hidden, Look, Path, Sampler, Screen, State, Topology};

const TEXTURE: u32 = 1 << 7;
const SHADING: u32 = 1 << 8;
const SUBPIXEL: u32 = 1 << 6;

/// EFFECTS_CALLED, UNITS_POWERED and counters of a scene of one sheet in 16 pixels.
fn drawn(path: Path, state: &State) -> ([u32; 2], Events) {
    let region = Record { colour: 0x00FF_FFFF, ..Record::default() }.words();
    let options = zga_tests::harness::Options { texture_bytes: 64, ..specified(Hidden::on(path)) };
    let mut screen = Screen::new(4, 4, &options);
    screen.put_textures(0, &region);
    screen.end();
    screen.clear_counts();
    screen.draw_corners(Topology::Triangles, &sheet([4, 4], 0.5, 0x80FF_FFFF), state);
    screen.end();
    (screen.called(), screen.events())
}

/// Counters of a kind that are not 0.
fn counted(events: &Events, kinds: &[&str]) -> Vec<(&'static str, u64)> {
    let of_kind = |name: &str| kinds.iter().any(|kind| name.starts_with(kind));
    NAMES.into_iter().zip(events.0).filter(|(name, value)| *value > 0 && of_kind(name)).collect()
}

const TEXTURES: [&str; 2] = ["texture.", "cycles.texture"];
const LAYERS: [&str; 2] = ["layers.", "cycles.layers"];

#[test]
fn draw_without_effects_powers_and_counts_nothing_of_them() {
    for path in Path::ALL {
        let ([called, units], events) = drawn(path, &State::default());

        assert_eq!((called, units & (TEXTURE | SHADING | SUBPIXEL)), (1, 0), "{path:?}");
        let kinds = [&TEXTURES[..], &LAYERS, &["shading.", "cycles.shading", "subpixel.", "cycles.subpixel"]].concat();
        assert_eq!(counted(&events, &kinds), vec![], "{path:?}");
    }
}

#[test]
fn draw_levels_and_holes_without_a_texture_call_for_nothing() {
    for path in Path::ALL {
        let look = Look { mip_map: true, punch_through: Some(200), ..Look::default() };
        let ([called, units], events) = drawn(path, &State { look, ..State::default() });

        assert_eq!((called, units & TEXTURE), (1, 0), "{path:?}");
        assert_eq!(counted(&events, &TEXTURES), vec![], "{path:?}");
    }
}

#[test]
fn draw_fog_without_a_function_calls_for_nothing() {
    for path in Path::ALL {
        let look = Look { fog: Some(Fog::default()), ..Look::default() };
        let ([called, units], events) = drawn(path, &State { look, ..State::default() });

        assert_eq!((called, units & SHADING), (1, 0), "{path:?}");
        assert_eq!(counted(&events, &["shading.fogged"]), vec![], "{path:?}");
    }
}

#[test]
fn draw_each_effect_alone_powers_its_unit_and_counts_nothing_of_others() {
    let look = Look::default();
    let fog = Fog { function: 1, end: 9.0, ..Fog::default() };
    let light = Lights { count: 1, ..Lights::default() };
    let lit = State { look: Look { light: Some(light), ..look }, ..State::default() };
    let fogged = State { look: Look { fog: Some(fog), ..look }, ..State::default() };
    let textured = State { look: Look::textured(Sampler::default()), ..State::default() };
    for path in Path::ALL {
        for (name, state, effect, units, silent) in [
            ("texture", textured, 0x10, TEXTURE, &["shading.lights", "shading.fogged", "layers.", "cycles.layers"][..]),
            (
                "light",
                lit,
                0x40,
                SHADING,
                &["texture.", "cycles.texture", "shading.fogged", "layers.", "cycles.layers"],
            ),
            (
                "fog",
                fogged,
                0x80,
                SHADING,
                &["texture.", "cycles.texture", "shading.lights", "layers.", "cycles.layers"],
            ),
            (
                "blend",
                State::blended(0),
                0x100,
                SHADING,
                &["texture.", "cycles.texture", "shading.lights", "shading.fogged"],
            ),
        ] {
            let ([called, powered], events) = drawn(path, &state);

            assert_eq!(called, 1 | effect, "{name} on {path:?}");
            assert_eq!(powered & (TEXTURE | SHADING | SUBPIXEL), units, "{name} on {path:?}");
            assert_eq!(counted(&events, silent), vec![], "{name} on {path:?}");
        }
    }
}

#[test]
fn draw_effects_of_an_earlier_scene_are_not_called_in_the_next() {
    for path in Path::ALL {
        let options = zga_tests::harness::Options { texture_bytes: 64, ..specified(Hidden::on(path)) };
        let mut screen = Screen::new(4, 4, &options);
        let corners = sheet([4, 4], 0.5, 0x80FF_FFFF);
        let look = Look { fog: Some(Fog { function: 1, ..Fog::default() }), ..Look::textured(Sampler::default()) };
        screen.draw_corners(Topology::Triangles, &corners, &State { look, ..State::default() });
        screen.end();
        screen.clear_counts();
        screen.draw_corners(Topology::Triangles, &corners, &State::default());
        screen.end();

        let ([called, units], events) = (screen.called(), screen.events());

        assert_eq!((called, units & (TEXTURE | SHADING)), (1, 0), "{path:?}");
        assert_eq!(counted(&events, &[&TEXTURES[..], &["shading."]].concat()), vec![], "{path:?}");
    }
}
