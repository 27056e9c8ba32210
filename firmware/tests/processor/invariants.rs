//! What every argument of a hardware call promises, said again without the firmware's code.

use crate::mock::Mock;
use zga_abi::format::{DepthFormat, FogFunction, HiddenSurface, PixelFormat, SubpixelGrid};
use zga_abi::{Access, Effects, Reg, Units};
use zga_firmware::checked::{
    Canvas, Clear, Combine, CombineSource, Compose, Draw, DrawState, Fog, Image, Lighting, Mask, Paint, Rectangle,
    Rows, Stretch, Surface, Target, Texture, Words,
};

fn memory(mock: &Mock) -> u64 {
    u64::from(mock.get(0x0010))
}

/// A register changes only where packets or the firmware itself may change it.
pub fn register_write(register: Reg, word: u32, old: u32, value: u32) {
    let info = register.info();
    assert!(word < info.count);
    if matches!(register, Reg::EffectsCalled | Reg::UnitsPowered) {
        assert_ne!(old, value, "{} is set only when it changes", info.name);
        assert_eq!(value & !0xFFF, 0);
        return;
    }
    let offset = info.word_offset(word);
    assert!((0x48..0x50).contains(&offset) || (0x200..0x700).contains(&offset));
    assert_eq!(info.access, Access::ReadWrite, "{}", info.name);
    assert_eq!((old ^ value) & !info.writable, 0, "{}", info.name);
    match register {
        Reg::ColourFormat | Reg::ScanoutFormat => assert!(value & 3 <= 2),
        Reg::SubpixelBits => assert!(value == 4 || value == 8),
        Reg::DepthFormat => assert!(DepthFormat::from_code(value).is_some()),
        Reg::SubpixelDepth => assert!(value <= 2),
        Reg::SubpixelPool => assert!((1..=1 << 20).contains(&value)),
        Reg::LineWidth | Reg::PointSize => assert!((1..=0xFFFF).contains(&value)),
        Reg::TextureSize => assert!([value & 0x7FFF, value >> 16].iter().all(|side| (1..=16384).contains(side))),
        Reg::TextureControl => {
            assert!((value & 7) < 6 && (value >> 4 & 3) < 3 && (1..=15).contains(&(value >> 16)));
        }
        Reg::TextureOffset | Reg::TextureWindow => assert!(value & 0x7FFF <= 16384 && value >> 16 <= 16384),
        Reg::BlendControl => assert!(value < 4),
        Reg::FogControl => assert!(value < 5),
        Reg::FogDensity => assert!(f32::from_bits(value).is_finite() && f32::from_bits(value) >= 0.0),
        Reg::FogEnd => assert!(f32::from_bits(value).is_finite() && f32::from_bits(value) > 0.0),
        Reg::DepthCueScale | Reg::DepthCueOffset => assert!(f32::from_bits(value).is_finite()),
        Reg::LightCount => assert!(value <= 256),
        Reg::MaterialShininess => assert!((0.0..=128.0).contains(&f32::from_bits(value))),
        _ => {}
    }
}

/// A run of words in video memory.
pub fn run(mock: &Mock, address: u32, words: u64) {
    assert_eq!(address % 4, 0);
    assert!(words == 0 || u64::from(address) + 4 * words <= memory(mock));
}

/// A run of words anywhere.
pub fn words(mock: &Mock, words: &Words<'_>) {
    if let &Words::Memory { address, words } = words {
        run(mock, address, u64::from(words));
    }
}

/// The words of a run; 0 where the mock's memory holds nothing.
pub fn each(mock: &Mock, words: &Words<'_>) -> impl Iterator<Item = u32> {
    let all: Vec<u32> = match *words {
        Words::Inline(words) => words.to_vec(),
        Words::Memory { address, words } => {
            (0..words).map(|k| mock.memory.get(&(address + 4 * k)).copied().unwrap_or(0)).collect()
        }
    };
    all.into_iter()
}

/// Pixels for the bitmap unit.
pub fn surface(mock: &Mock, surface: &Surface) {
    let pixel = surface.format.bytes();
    assert!((1..=16384).contains(&surface.width));
    assert!((1..=16384).contains(&surface.height));
    assert_eq!(surface.base % pixel, 0);
    assert_eq!(surface.pitch % pixel, 0);
    assert!(surface.pitch >= surface.width * pixel);
    let rows = u64::from(surface.height - 1) * u64::from(surface.pitch);
    let end = u64::from(surface.base) + rows + u64::from(surface.width * pixel);
    assert!(end <= memory(mock), "{surface:?}");
}

/// Pixels for the bitmap unit, in any of its formats.
pub fn image(mock: &Mock, image: &Image) {
    let pixel = [4, 4, 2, 1][image.format.code() as usize];
    assert!((1..=16384).contains(&image.width) && (1..=16384).contains(&image.height));
    assert_eq!((image.base % pixel, image.pitch % pixel), (0, 0));
    assert!(image.pitch >= image.width * pixel);
    let rows = u64::from(image.height - 1) * u64::from(image.pitch);
    let end = u64::from(image.base) + rows + u64::from(image.width * pixel);
    assert!(end <= memory(mock), "{image:?}");
}

/// A raster operation changes something, and has a source image only where it looks at it.
pub fn combine(mock: &Mock, combine: &Combine) {
    image(mock, &combine.destination);
    let operation = combine.operation.code();
    assert_ne!(operation, 5, "no-operation");
    let planes = [0xFFFF_FFFF, 0xFFFF_FFFF, 0xFFFF, 0xFF][combine.destination.format.code() as usize];
    assert_ne!(combine.planes, 0);
    assert_eq!(combine.planes & !planes, 0);
    if let CombineSource::Image(source) = &combine.source {
        image(mock, source);
        assert!(![0, 10, 15].contains(&operation), "clear, invert, set");
        let size = |image: &Image| (image.width, image.height, image.format);
        assert_eq!(size(source), size(&combine.destination));
    }
}

/// A list is drawn onto a surface, changes something, and is cut to what lies in it.
pub fn canvas(mock: &Mock, canvas: &Canvas<'_>) {
    image(mock, &canvas.surface);
    let planes = [0xFFFF_FFFF, 0xFFFF_FFFF, 0xFFFF, 0xFF][canvas.surface.format.code() as usize];
    assert_ne!(canvas.operation.code(), 5, "no-operation");
    assert_ne!(canvas.planes, 0);
    assert_eq!(canvas.planes & !planes, 0);
    assert!(!canvas.clips.is_empty() && canvas.clips.len().is_multiple_of(2));
    for clip in canvas.clip_boxes() {
        assert!(0 <= clip.x1 && clip.x1 < clip.x2 && clip.x2 <= canvas.surface.width as i32);
        assert!(0 <= clip.y1 && clip.y1 < clip.y2 && clip.y2 <= canvas.surface.height as i32);
    }
}

/// A composition changes something, and reads nothing that it writes.
pub fn compose(mock: &Mock, compose: &Compose<'_>) {
    let onto = &compose.onto.image;
    image(mock, onto);
    assert_ne!(compose.operator.code(), 2, "destination");
    assert!(!compose.clips.is_empty() && compose.clips.len().is_multiple_of(2));
    let mask = match &compose.mask {
        Mask::Paint(paint) => Some(paint),
        Mask::Inline(_) => None,
        Mask::None => {
            assert!(!compose.components);
            None
        }
    };
    for paint in [Some(&compose.source), mask].into_iter().flatten() {
        let Paint::Picture(sampled) = paint else { continue };
        let read = &sampled.picture.image;
        image(mock, read);
        assert_eq!(read.format.bytes(), sampled.picture.format.bytes());
        assert!(read.bytes().end <= onto.bytes().start || onto.bytes().end <= read.bytes().start);
        assert!(sampled.offset.iter().all(|pixels| pixels.abs() <= 65535));
    }
    let words: usize = compose.entries().map(|entry| 2 + entry.rows.len()).sum();
    assert_eq!(words, compose.entries.len());
}

/// A stretch writes a part of the whole and nothing of its source.
pub fn stretch(mock: &Mock, stretch: &Stretch) {
    let (source, destination) = (&stretch.source, &stretch.destination);
    image(mock, source);
    image(mock, destination);
    for (start, (length, whole)) in
        stretch.part.into_iter().zip([destination.width, destination.height].into_iter().zip(stretch.whole))
    {
        assert!(u64::from(start) + u64::from(length) <= u64::from(whole) && whole <= 16384, "{stretch:?}");
    }
    // Rows are few: the mock's memory is 1 MiB and a row is at least a byte.
    let rows = |image: &Image| {
        let (base, pitch, bytes) = (image.base, image.pitch, image.width * image.format.bytes());
        (0..image.height).map(move |row| (base + row * pitch, base + row * pitch + bytes)).collect::<Vec<_>>()
    };
    for (start, end) in rows(source) {
        // Of rows that rise, only the first that ends behind the start can be the first to meet.
        let others = rows(destination);
        let next = others.partition_point(|&(_, other_end)| other_end <= start);
        assert!(others.get(next).is_none_or(|&(other, _)| end <= other), "{stretch:?}");
    }
}

/// Rows of words.
pub fn rows(mock: &Mock, rows: &Rows) {
    assert!(rows.words > 0 && rows.rows > 0);
    assert_eq!((rows.address % 4, rows.pitch % 4), (0, 0));
    let last = u64::from(rows.rows - 1) * u64::from(rows.pitch);
    let end = u64::from(rows.address) + last + 4 * u64::from(rows.words);
    assert!(end <= memory(mock), "{rows:?}");
}

/// Whole rows on chunk boundaries; start and end of what they take.
fn frame(mock: &Mock, base: u32, pitch: u32, row_bytes: u32, height: u32) -> (u64, u64) {
    assert_eq!((base % 64, pitch % 64), (0, 0));
    assert!(pitch >= row_bytes);
    let end = u64::from(base) + u64::from(pitch) * u64::from(height);
    assert!(end <= memory(mock));
    (u64::from(base), end)
}

/// The target of a scene.
pub fn target(mock: &Mock, target: &Target) {
    let colour = &target.colour;
    surface(mock, colour);
    let row_bytes = colour.width * colour.format.bytes();
    let a = frame(mock, colour.base, colour.pitch, row_bytes, colour.height);
    let mut others = vec![a];
    if let Some(depth) = target.depth {
        let b = frame(mock, depth.base, depth.pitch, colour.width * 4, colour.height);
        assert!(a.1 <= b.0 || b.1 <= a.0, "{target:?}");
        others.push(b);
    }
    if let Some(stencil) = target.stencil {
        let c = frame(mock, stencil.base, stencil.pitch, colour.width, colour.height);
        assert!(others.iter().all(|other| c.1 <= other.0 || other.1 <= c.0), "{target:?}");
    }
    assert!(matches!(target.subpixel_bits, 4 | 8));
    let [across, down] = target.za.block;
    assert!((1..=16384).contains(&across) && (1..=16384).contains(&down) && target.za.base.is_multiple_of(16));
    if target.hidden_surface == HiddenSurface::Za {
        let blocks = u64::from(target.colour.width.div_ceil(across)) * u64::from(target.colour.height.div_ceil(down));
        assert!(4 * (u64::from(target.za.base) + blocks) <= u64::from(mock.get(0x0014)));
    }
    assert!(target.tile.iter().all(|side| matches!(side, 4 | 8 | 16 | 32 | 64)));
    if let Some(subpixel) = target.subpixel {
        assert_ne!(subpixel.grid, SubpixelGrid::Off);
        assert!((1..=1 << 20).contains(&subpixel.pool));
    }
    assert_ne!(mock.get(0x000C) & (1 << target.hidden_surface.code()), 0);
}

/// Pixels inside a target.
fn inside(target: &Target, rectangle: &Rectangle) {
    assert!(rectangle.x <= rectangle.right && rectangle.y <= rectangle.bottom);
    assert!(rectangle.right <= target.colour.width);
    assert!(rectangle.bottom <= target.colour.height);
}

/// Systolic array and tile unit compare depths in registers of their own; other paths need a Z buffer.
fn may_have_depth(target: &Target) -> bool {
    target.depth.is_some() || matches!(target.hidden_surface, HiddenSurface::Systolic | HiddenSurface::Tile)
}

/// A clear.
pub fn clear(target: &Target, clear: &Clear) {
    inside(target, &clear.area);
    assert!(clear.colour.is_some() || clear.depth.is_some() || clear.stencil.is_some());
    assert!(target.stencil.is_some() || clear.stencil.is_none());
    if let Some(depth) = clear.depth {
        assert!(may_have_depth(target));
        assert!(depth <= target.depth_format.maximum());
    }
}

/// A draw.
pub fn draw(mock: &Mock, target: &Target, state: &DrawState, draw: &Draw<'_>) {
    inside(target, &state.scissor);
    assert_eq!(state.effects.bits() & !mock.get(0x0008), 0);
    assert!(may_have_depth(target) || !state.effects.contains(Effects::DEPTH));
    assert!(target.subpixel.is_some() || !state.effects.contains(Effects::ANTI_ALIAS));
    assert!((1..=0xFFFF).contains(&state.line_width) && (1..=0xFFFF).contains(&state.point_size));
    assert_eq!(state.stencil.is_some(), state.effects.contains(Effects::STENCIL));
    if let Some(stencil) = &state.stencil {
        assert!(target.stencil.is_some() && target.subpixel.is_none());
        let blends = state.effects.contains(Effects::BLEND);
        assert!(!blends || !(stencil.colour_off || stencil.changes_values()), "{stencil:?}");
    }
    effects(mock, state);
    words(mock, &draw.vertices);
    let vertex_words = 3 + [(draw.coloured, 1), (draw.normals, 3), (draw.coordinates, 2)]
        .iter()
        .filter_map(|&(carries, words)| carries.then_some(words))
        .sum::<u64>();
    let given = match draw.vertices {
        Words::Inline(words) => words.len() as u64,
        Words::Memory { words, .. } => u64::from(words),
    };
    assert_eq!(given, u64::from(draw.vertex_count) * vertex_words);
    if let Some(indices) = draw.indices {
        words(mock, &indices);
        assert!(each(mock, &indices).all(|index| index < draw.vertex_count));
    }
}

/// What the effects of a draw are given: all that they need where they are called for, else nothing.
fn effects(mock: &Mock, state: &DrawState) {
    let called = |effects| state.effects.contains(effects);
    assert_eq!(state.texture.is_some(), called(Effects::TEXTURE));
    assert_eq!(state.punch_through.is_some(), called(Effects::TEXTURE | Effects::PUNCH_THROUGH));
    assert_eq!(state.light.is_some(), called(Effects::LIGHT));
    assert_eq!(state.fog.is_some(), called(Effects::FOG) && mock.get(0x0330) != 0);
    assert!(called(Effects::BLEND) || state.blend as u32 == 0);
    if let Some(map) = state.texture {
        texture(mock, &map);
        assert_eq!(map.mip_map, called(Effects::MIP_MAP));
    }
    if let Some(Lighting { lights, count, shininess, .. }) = state.light {
        assert_eq!(lights % 64, 0);
        assert!(count <= 256 && (0.0..=128.0).contains(&shininess));
        run(mock, lights, u64::from(count) * 16);
    }
    if let Some(Fog { function, density, end, cue_scale, cue_offset, .. }) = state.fog {
        assert_ne!(function, FogFunction::None);
        assert!([density, end, cue_scale, cue_offset].iter().all(|number| number.is_finite()));
        assert!(density >= 0.0 && end > 0.0);
    }
}

/// A texture: window inside, levels as far as it can be halved, all of it in memory.
fn texture(mock: &Mock, texture: &Texture) {
    let Texture { base, size: [width, height], format, levels, palette, offset, window, .. } = *texture;
    assert_eq!(base % 64, 0);
    assert!((1..=16384).contains(&width) && (1..=16384).contains(&height));
    assert!(levels >= 1 && width.max(height) >> (levels - 1) >= 1, "{texture:?}");
    for (axis, side) in [width, height].into_iter().enumerate() {
        assert!(window[axis] >= 1 && offset[axis] + window[axis] <= side, "{texture:?}");
    }
    let mut end = u64::from(base);
    for level in 0..levels {
        let begin = end.next_multiple_of(64);
        assert_eq!(texture.level_offset(level), begin - u64::from(base), "{texture:?}");
        let bits = u64::from((width >> level).max(1)) * u64::from(format.bits());
        end = begin + bits.div_ceil(32) * 4 * u64::from((height >> level).max(1));
    }
    assert_eq!(texture.bytes(), end - u64::from(base), "{texture:?}");
    assert!(end <= memory(mock), "{texture:?}");
    if format.palette() != 0 {
        assert_eq!(palette % 64, 0);
        run(mock, palette, u64::from(format.palette()));
    }
}

/// The frame shown when it begins at `base`; its width and height.
pub fn shown(mock: &Mock, base: u32) -> (u32, u32) {
    let size = mock.get(0x0694);
    let (width, height) = (size & 0x7FFF, (size >> 16) & 0x7FFF);
    assert_eq!(base % 64, 0);
    if width != 0 && height != 0 {
        assert!(width <= 16384 && height <= 16384);
        let format = PixelFormat::from_code(mock.get(0x0690)).expect("a format");
        frame(mock, base, mock.get(0x068C), width * format.bytes(), height);
    }
    (width, height)
}

/// The unit of a target's hidden-surface path.
pub fn path_unit(target: &Target) -> Units {
    match target.hidden_surface {
        HiddenSurface::ZBuffer => Units::Z_BUFFER,
        HiddenSurface::Za => Units::ZA,
        HiddenSurface::Systolic => Units::SYSTOLIC,
        HiddenSurface::Tile => Units::TILE,
    }
}
