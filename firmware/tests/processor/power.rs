//! Effects called and units powered.

use crate::bench::{Bench, TRIANGLE};
use crate::mock::Call;
use zga_abi::{Effects, Units};

const GOURAUD: u32 = 1 << 1;
const PERSPECTIVE: u32 = 1 << 2;

/// What every draw on the plain Z buffer needs.
fn plain() -> Units {
    Units::FRONTEND | Units::GEOMETRY | Units::Z_BUFFER
}

/// A texture of 4 x 4 texels with all of its levels, and linear fog.
fn with_effects(mut bench: Bench) -> Bench {
    bench.card.set(0x0304, 0x0004_0004);
    bench.card.set(0x0308, 0x0003_0100);
    bench.card.set(0x0330, 1);
    bench
}

/// The effects that a draw of a triangle with `effects` in EFFECTS really uses.
fn used(mut bench: Bench, effects: Effects, coloured: bool) -> Effects {
    draw(&mut bench, effects.bits(), coloured);
    bench.processor.effects_called()
}

/// Draws a triangle with these effects; with colours if asked for.
fn draw(bench: &mut Bench, effects: u32, coloured: bool) -> Vec<Call> {
    bench.card.set(0x0280, effects);
    let plain = [&[0x000, 3, 0], &TRIANGLE[..]].concat();
    let colours = [&[0x100, 3, 0], &[0; 12][..]].concat();
    bench.good(0x10, if coloured { &colours } else { &plain })
}

#[test]
fn new_processor_has_powered_nothing() {
    let bench = Bench::new();
    assert_eq!(bench.processor.units_powered(), Units::empty());
    assert_eq!(bench.processor.effects_called(), Effects::empty());
}

#[test]
fn begin_scene_powers_the_front_end_alone_before_the_scene_begins() {
    let calls = Bench::with_target().good(0x02, &[]);
    assert_eq!(calls[0], Call::Power(Units::FRONTEND));
    assert_eq!(calls[1], Call::SetRegister(0x0704, 0x001));
    assert!(matches!(calls[2..], [Call::BeginScene(_)]));
}

#[test]
fn begin_scene_keeps_continuous_scanout_powered() {
    let mut bench = Bench::with_target();
    bench.card.set(0x0680, 1);
    bench.good(0x02, &[]);
    assert_eq!(bench.card.units, Units::FRONTEND | Units::SCANOUT);
}

#[test]
fn begin_scene_takes_power_and_effects_of_the_last_scene_away() {
    let mut bench = Bench::in_scene_with_grid();
    draw(&mut bench, 0x7FF, true);
    bench.good(0x31, &[0]);
    bench.good(0x03, &[]);
    assert_ne!(bench.processor.effects_called(), Effects::empty());
    let calls = bench.good(0x02, &[]);
    assert_eq!(calls[0], Call::SetRegister(0x0700, 0));
    assert_eq!(calls[1], Call::Power(Units::FRONTEND));
    assert_eq!(calls[2], Call::SetRegister(0x0704, 0x001));
    assert_eq!(bench.processor.effects_called(), Effects::empty());
    assert_eq!(bench.processor.units_powered(), Units::FRONTEND);
}

#[test]
fn draw_each_effect_powers_its_unit_and_no_other() {
    let cases = [
        (Effects::DEPTH, Units::empty()),
        (Effects::GOURAUD, Units::SHADING),
        (Effects::DECAL, Units::empty()),
        (Effects::TEXTURE, Units::TEXTURE),
        (Effects::TEXTURE.union(Effects::MIP_MAP), Units::TEXTURE),
        (Effects::LIGHT, Units::SHADING),
        (Effects::FOG, Units::SHADING),
        (Effects::BLEND, Units::SHADING | Units::SUBPIXEL),
        (Effects::TEXTURE.union(Effects::PUNCH_THROUGH), Units::TEXTURE),
        (Effects::ANTI_ALIAS, Units::SUBPIXEL),
        (Effects::STENCIL, Units::empty()),
        (Effects::GOURAUD.union(Effects::PERSPECTIVE), Units::SHADING),
        (Effects::TEXTURE.union(Effects::PERSPECTIVE), Units::TEXTURE),
        (Effects::FOG.union(Effects::PERSPECTIVE), Units::SHADING),
    ];
    for (effects, units) in cases {
        // A grid excludes the stencil test.
        let bench = if effects == Effects::STENCIL {
            Bench::in_scene_with_stencil_plane()
        } else {
            Bench::in_scene_with_grid()
        };
        let mut bench = with_effects(bench);
        let calls = draw(&mut bench, effects.bits(), true);
        let powered = plain() | units;
        assert_eq!(calls[0], Call::SetRegister(0x0700, effects.bits()));
        assert_eq!(calls[1], Call::Power(powered), "{effects:?}");
        assert_eq!(calls[2], Call::SetRegister(0x0704, powered.bits()));
        assert!(matches!(calls[3..], [Call::Draw(..)]));
        assert_eq!(bench.processor.effects_called(), effects);
        assert_eq!(bench.processor.units_powered(), powered);
    }
}

#[test]
fn draw_blend_without_a_grid_leaves_the_sub_pixel_unit_alone() {
    let mut bench = Bench::in_scene();
    draw(&mut bench, Effects::BLEND.bits(), false);
    assert_eq!(bench.processor.effects_called(), Effects::BLEND);
    assert_eq!(bench.card.units, plain() | Units::SHADING);
}

#[test]
fn draw_levels_and_holes_without_a_texture_are_not_called() {
    let bench = || with_effects(Bench::in_scene());
    let both = Effects::MIP_MAP | Effects::PUNCH_THROUGH;
    assert_eq!(used(bench(), both, false), Effects::empty());
    assert_eq!(used(bench(), both | Effects::TEXTURE, false), both | Effects::TEXTURE);
    let mut bench = bench();
    draw(&mut bench, both.bits(), false);
    assert_eq!(bench.card.units, plain());
}

#[test]
fn draw_mip_map_of_one_level_is_not_called() {
    let mut bench = with_effects(Bench::in_scene());
    bench.card.set(0x0308, 0x0001_0100);
    assert_eq!(used(bench, Effects::TEXTURE | Effects::MIP_MAP, false), Effects::TEXTURE);
}

#[test]
fn draw_fog_whose_function_is_none_is_not_called() {
    let mut bench = Bench::in_scene();
    draw(&mut bench, (Effects::FOG | Effects::PERSPECTIVE).bits(), false);
    assert_eq!(bench.processor.effects_called(), Effects::empty());
    assert_eq!(bench.card.units, plain());
}

#[test]
fn draw_gouraud_between_vertices_that_light_falls_on_is_called_without_vertex_colours() {
    let lit = Effects::LIGHT | Effects::GOURAUD | Effects::PERSPECTIVE;
    assert_eq!(used(Bench::in_scene(), lit, false), lit);
    // At each pixel: colours are those of the material, but normals and places vary.
    let mut bench = Bench::in_scene();
    bench.card.set(0x0350, 1);
    assert_eq!(used(bench, lit, false), Effects::LIGHT | Effects::PERSPECTIVE);
    let mut bench = Bench::in_scene();
    bench.card.set(0x0350, 1);
    assert_eq!(used(bench, lit, true), lit);
}

#[test]
fn draw_perspective_of_a_flat_lit_triangle_has_nothing_to_correct() {
    assert_eq!(used(Bench::in_scene(), Effects::LIGHT | Effects::PERSPECTIVE, true), Effects::LIGHT);
}

#[test]
fn draw_points_have_nothing_to_correct() {
    let mut bench = with_effects(Bench::in_scene());
    let called = Effects::TEXTURE | Effects::FOG | Effects::LIGHT;
    bench.card.set(0x0280, (called | Effects::PERSPECTIVE | Effects::GOURAUD).bits());
    bench.good(0x10, &[0x702, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bench.processor.effects_called(), called);
}

#[test]
fn draw_without_masks_in_a_scene_with_a_grid_leaves_the_sub_pixel_unit_alone() {
    let mut bench = Bench::in_scene_with_grid();
    draw(&mut bench, 1, false);
    assert_eq!(bench.card.units, plain());
}

#[test]
fn draw_on_each_path_powers_its_unit() {
    let paths = [Units::Z_BUFFER, Units::ZA, Units::SYSTOLIC, Units::TILE];
    for (path, unit) in (0..).zip(paths) {
        let mut bench = Bench::with_target();
        bench.card.set(0x0240, path);
        bench.good(0x02, &[]);
        draw(&mut bench, 1, false);
        let units = Units::FRONTEND | Units::GEOMETRY | unit;
        assert_eq!(bench.card.units, units);
    }
}

#[test]
fn draw_gouraud_without_vertex_colours_is_not_called() {
    let mut bench = Bench::in_scene();
    draw(&mut bench, 1 | GOURAUD | PERSPECTIVE, false);
    assert_eq!(bench.processor.effects_called(), Effects::DEPTH);
    assert_eq!(bench.card.units, plain());
}

#[test]
fn draw_gouraud_points_interpolate_nothing() {
    let mut bench = Bench::in_scene();
    bench.card.set(0x0280, GOURAUD);
    bench.good(0x10, &[0x102, 1, 0, 0, 0, 0, 0]);
    assert_eq!(bench.processor.effects_called(), Effects::empty());
    assert_eq!(bench.card.units, plain());
}

#[test]
fn draw_effects_add_up_over_the_scene() {
    let mut bench = Bench::in_scene();
    draw(&mut bench, 0x001, false);
    draw(&mut bench, 0x008, false);
    draw(&mut bench, GOURAUD, true);
    assert_eq!(bench.card.get(0x0700), 0x00B);
    assert_eq!(bench.card.get(0x0704), (plain() | Units::SHADING).bits());
}

#[test]
fn draw_again_with_the_same_effects_changes_no_power_and_no_register() {
    let mut bench = Bench::in_scene();
    draw(&mut bench, 0x003, true);
    let calls = draw(&mut bench, 0x003, true);
    assert!(matches!(calls[..], [Call::Draw(..)]));
}

#[test]
fn draw_that_makes_no_primitive_calls_for_nothing() {
    let mut bench = Bench::in_scene_with_grid();
    bench.card.set(0x0280, 0x7FF);
    bench.good(0x10, &[0, 0, 0]);
    assert_eq!(bench.processor.effects_called(), Effects::empty());
    assert_eq!(bench.card.units, Units::FRONTEND);
}

#[test]
fn clear_powers_the_path_without_geometry() {
    for planes in 1..4 {
        let mut bench = Bench::in_scene();
        bench.good(0x04, &[planes, 0, 0]);
        assert_eq!(bench.card.units, Units::FRONTEND | Units::Z_BUFFER);
        assert_eq!(bench.processor.effects_called(), Effects::empty());
    }
}

#[test]
fn probe_is_powered_by_clears_and_draws_while_enabled() {
    let mut bench = Bench::in_scene();
    bench.card.set(0x0600, 1);
    bench.good(0x04, &[1, 0, 0]);
    let clear = Units::FRONTEND | Units::Z_BUFFER | Units::PROBE;
    assert_eq!(bench.card.units, clear);

    let mut bench = Bench::in_scene();
    bench.card.set(0x0600, 1);
    draw(&mut bench, 1, false);
    assert_eq!(bench.card.units, plain() | Units::PROBE);
}

#[test]
fn bitmap_packets_power_the_bitmap_unit() {
    // A colour without a mask.
    let mut compose = [0; 40];
    compose[..9].copy_from_slice(&[0, 64, 1, 0x0001_0001, 3, 0, 0, 1, 1]);
    let packets: [(u32, &[u32]); 13] = [
        (0x20, &[0, 64, 0, 0, 0, 1, 1, 0]),
        (0x21, &[0, 0, 64, 0, 0, 64, 64, 0, 0, 1, 1]),
        (0x22, &[0, 4, 1, 1, 0]),
        (0x23, &[0, 4, 1, 1, 8]),
        (0x24, &[0, 64, 0, 0, 0, 1, 1, 0, 6, 1]),
        (0x25, &[0, 0, 64, 0, 0, 64, 64, 0, 0, 1, 1, 6, 1]),
        (0x26, &[0, 0, 64, 0, 0, 1, 64, 64, 0, 0, 1, 1]),
        (0x27, &[0, 0, 0, 64, 0, 0, 1, 1, 0, 64, 64, 0, 0, 1, 1, 1, 1, 0, 0]),
        (0x28, &[0, 64, 0, 0x0001_0001, 3, 1, 0, 1, 5, 0, 0, 0, 0]),
        (0x29, &[0, 64, 0, 0x0001_0001, 3, 1, 0, 1, 0, 64, 0x0001_0001, 0, 0, 0, 0, 0, 0]),
        (0x2A, &[0, 64, 0, 0x0001_0001, 3, 1, 0, 1, 5, 0, 0, 0, 0, 0]),
        (0x2B, &[0, 64, 0, 0x0001_0001, 3, 1, 0, 1, 5, 0, 0, 0, 0, 0, 0]),
        (0x2C, &compose),
    ];
    for (opcode, payload) in packets {
        let mut bench = Bench::new();
        bench.good(opcode, payload);
        assert_eq!(bench.card.units, Units::FRONTEND | Units::BITMAP);
        assert_eq!(bench.card.get(0x0704), bench.card.units.bits());
    }
}

#[test]
fn present_and_write_back_power_scanout() {
    let mut bench = Bench::new();
    bench.good(0x31, &[0]);
    assert_eq!(bench.card.units, Units::FRONTEND | Units::SCANOUT);

    let mut bench = Bench::new();
    bench.card.set(0x068C, 64);
    bench.card.set(0x0694, (1 << 16) | 1);
    bench.good(0x32, &[64]);
    assert_eq!(bench.card.units, Units::FRONTEND | Units::SCANOUT);
}
