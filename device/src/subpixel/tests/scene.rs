//! What a scene takes, and by which rule its opaque fragments are ordered.

use super::super::scene::{Base, ITEM_LIMIT, Item, Kind, Rule, Scene};
use crate::geometry::transform::Transform;
use crate::geometry::{GeometryRegisters, ScreenVertex};
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::band::DrawShading;
use crate::shading::parameters::{ParameterTransform, VertexParameters};
use crate::shading::pixel::{AlphaRule, PixelShading};
use crate::shading::plane::Interpolation;
use std::sync::Arc;
use zga_abi::Effects;
use zga_abi::format::{BlendMode, DepthFormat, DepthFunction, Topology};
use zga_firmware::checked::{Clear, DrawState, Rectangle};

const AREA: Rectangle = Rectangle { x: 0, y: 0, right: 8, bottom: 8 };

pub(super) fn state(effects: Effects, tag: u32) -> DrawState {
    DrawState {
        effects,
        depth_function: DepthFunction::Less,
        depth_write: true,
        material_colour: 0,
        tag,
        scissor: AREA,
        line_width: 256,
        point_size: 256,
        texture: None,
        punch_through: None,
        light: None,
        fog: None,
        blend: BlendMode::Alpha,
        stencil: None,
    }
}

/// Takes one triangle with an alpha.
fn draw(scene: &mut Scene, effects: Effects, test: Option<DepthTest>, alpha: u32) {
    if let Some(taken) = scene.draw(&state(effects, 0), test, Interpolation::Flat, AlphaRule::Vertices) {
        let vertices = [ScreenVertex { colour: alpha << 24, ..ScreenVertex::default() }; 3];
        taken.items.push(Item { vertices, draw: taken.draw, number: 0, kind: Kind::Masked });
    }
}

fn rule(draws: &[(Effects, Option<DepthTest>, u32)]) -> Rule {
    let mut scene = Scene::default();
    draws.iter().for_each(|&(effects, test, alpha)| draw(&mut scene, effects, test, alpha));
    scene.rule()
}

#[test]
fn rule_is_nearest_last_or_in_order() {
    let (masks, blend) = (Effects::ANTI_ALIAS, Effects::BLEND);
    let less = Some(DepthTest::LESS);
    let less_equal = Some(DepthTest { equal: true, ..DepthTest::LESS });
    let greater = Some(DepthTest { greater: true, less: false, ..DepthTest::LESS });
    let unwritten = Some(DepthTest { write: false, ..DepthTest::LESS });

    assert_eq!(rule(&[(masks, less, 255), (masks, less_equal, 255)]), Rule::Nearest);
    assert_eq!(rule(&[(masks, None, 255), (masks, None, 255)]), Rule::Last);
    assert_eq!(rule(&[(masks, None, 255), (masks, less, 255)]), Rule::InOrder);
    assert_eq!(rule(&[(masks, greater, 255)]), Rule::InOrder);
    assert_eq!(rule(&[(masks, unwritten, 255)]), Rule::InOrder);
    // Translucent, it stores nothing and may say so; opaque, it must store.
    assert_eq!(rule(&[(masks, less, 255), (blend, unwritten, 128)]), Rule::Nearest);
    assert_eq!(rule(&[(masks, less, 255), (blend, unwritten, 255)]), Rule::InOrder);
}

#[test]
fn clear_of_everything_forgets_and_of_a_part_is_an_item() {
    let mut scene = Scene::default();
    draw(&mut scene, Effects::ANTI_ALIAS, Some(DepthTest::LESS), 255);
    let part = Clear { area: Rectangle { right: 3, ..AREA }, colour: Some(5), depth: None, stencil: None };
    scene.clear(&part, false, false);
    assert_eq!((scene.items.len(), scene.items[1].kind, scene.rule()), (2, Kind::Clear, Rule::InOrder));

    scene.clear(&Clear { area: AREA, colour: Some(6), depth: Some(7), stencil: None }, true, true);
    assert_eq!((scene.items.len(), &scene.colour, &scene.depth), (0, &Base::Uniform(6), &Base::Uniform(7)));
    assert!(scene.called, "what a draw has called for stays called for");
    draw(&mut scene, Effects::empty(), None, 255);
    assert_eq!(scene.rule(), Rule::Last);
}

#[test]
fn draws_that_leave_no_item_take_no_room() {
    let mut scene = Scene::default();
    for tag in 0..1000 {
        assert!(
            scene
                .draw(&state(Effects::ANTI_ALIAS, tag), Some(DepthTest::LESS), Interpolation::Flat, AlphaRule::Vertices)
                .is_some()
        );
    }
    assert_eq!(scene.draws.len(), 1);
    let never = DrawState { depth_function: DepthFunction::Never, ..state(Effects::ANTI_ALIAS, 0) };
    let test = Some(DepthTest::new(DepthFunction::Never, true));
    assert!(scene.draw(&never, test, Interpolation::Flat, AlphaRule::Vertices).is_none());
}

#[test]
fn clear_beyond_the_limit_overflows_and_keeps_what_is_there() {
    let mut scene = Scene::default();
    draw(&mut scene, Effects::ANTI_ALIAS, Some(DepthTest::LESS), 255);
    let item = scene.items[0];
    scene.items.resize(ITEM_LIMIT, item);
    let part = Clear { area: Rectangle { right: 3, ..AREA }, colour: Some(5), depth: None, stencil: None };
    scene.clear(&part, false, false);
    assert!(scene.overflowed && scene.full());
    assert_eq!(scene.items.len(), ITEM_LIMIT);
}

/// What the colours of so many primitives go through, each of which carries its number.
fn shading(count: u32) -> Arc<DrawShading> {
    let transform = ParameterTransform {
        screen: Transform::new(&GeometryRegisters::IDENTITY, Effects::empty(), [8, 8], DepthFormat::default(), 8),
        eye: [[0.0; 4]; 4],
        normal: [[0.0; 3]; 3],
        perspective: false,
        topology: Topology::Triangles,
    };
    let pixel = Arc::new(PixelShading { transform, light: None, texture: None, fog: None });
    let carries = |n: u32| [VertexParameters { coordinates: [n as f32; 2], ..VertexParameters::default() }; 3];
    // The batch begins with the 100th of its draw.
    Arc::new(DrawShading { pixel, first: 100, vertices: (100..100 + count).map(carries).collect() })
}

#[test]
fn shade_gives_each_item_what_it_carries_and_holds_no_more_than_twice_that() {
    for taken in [vec![100, 101, 105], vec![107], (100..108).collect(), vec![]] {
        let mut scene = Scene::default();
        // One of another draw in the same state, without shading.
        draw(&mut scene, Effects::ANTI_ALIAS, None, 255);
        let before = scene.items.len();
        for &number in &taken {
            draw(&mut scene, Effects::ANTI_ALIAS, None, 255);
            scene.items.last_mut().expect("taken").number = number;
        }
        let shading = shading(8);
        scene.shade(before, &shading);
        let shade = |item: &Item| scene.draws[item.draw as usize].shade(item.number);
        assert!(shade(&scene.items[0]).pixel.is_none());
        for (item, number) in scene.items[before..].iter().zip(&taken) {
            let (pixel, carried) = shade(item).pixel.expect("shaded");
            assert!(Arc::ptr_eq(pixel, &shading.pixel));
            assert_eq!(carried[2].coordinates[0], *number as f32);
        }
        let held: usize = scene.draws.iter().filter_map(|draw| Some(draw.shading.as_ref()?.vertices.len())).sum();
        assert!(held <= 2 * taken.len(), "{held} held for {}", taken.len());
        drop(shading);
        assert_eq!(scene.take_parameters().is_some(), !taken.is_empty());
    }
}
