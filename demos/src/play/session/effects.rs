//! What the material of a batch and the lights of a scene are to the driver; textures in video memory.
//!
//! Duties: [`Textures`] keeps one texture for each distinct picture and way to store it, from frame to frame; the
//! functions turn the values of a scene into those of the driver; [`reduce`] takes out what the card has no unit for.
//! Inputs from: [`crate::scene::Batch`]. Outputs to: [`super::Session`], which sets them draw by draw.

use std::sync::Arc;

use zga_abi::format::{self, BlendMode, TextureFormat};
use zga_abi::{Bus, Effects};
use zga_driver::{Driver, DriverError, Fog, FogCurve, LightSource, Texture, TextureOptions, TextureState};

use crate::scene::{self, Batch, Blend, Colour, FogFunction, LightType, Lighting, Material, TextureFilter};
use crate::texture::Picture;

/// A picture in video memory.
#[derive(Debug)]
struct Placed {
    picture: Arc<Picture>,
    palette: Option<Vec<Colour>>,
    texture: Texture,
}

impl Placed {
    /// Whether it is what a texture of a scene asks for.
    fn is(&self, wanted: &scene::Texture, picture: &Arc<Picture>) -> bool {
        self.texture.format() == wanted.format
            && (self.texture.levels() > 1) == (has_levels(wanted) && picture.size() != [1, 1])
            && self.palette == wanted.palette
            && (Arc::ptr_eq(&self.picture, picture) || self.picture == *picture)
    }
}

/// The textures of a session.
#[derive(Debug, Default)]
pub(super) struct Textures {
    placed: Vec<Placed>,
    /// Of the frame before; what nobody asks for again is given back.
    before: Vec<Placed>,
}

impl Textures {
    /// A new list of batches begins.
    pub(super) fn begin(&mut self) {
        self.before.append(&mut self.placed);
    }

    /// The number of the texture that a batch is drawn with; it is brought to video memory if it is not there.
    pub(super) fn place<B: Bus>(
        &mut self,
        driver: &mut Driver<B>,
        wanted: &scene::Texture,
    ) -> Result<Option<usize>, DriverError> {
        let Some(picture) = &wanted.image else { return Ok(None) };
        if let Some(number) = self.placed.iter().position(|placed| placed.is(wanted, picture)) {
            return Ok(Some(number));
        }
        let placed = match self.before.iter().position(|placed| placed.is(wanted, picture)) {
            // The next look at it compares addresses.
            Some(number) => Placed { picture: Arc::clone(picture), ..self.before.swap_remove(number) },
            None => upload(driver, wanted, picture)?,
        };
        self.placed.push(placed);
        Ok(Some(self.placed.len() - 1))
    }

    /// The list of batches is complete: gives back what they do not use.
    pub(super) fn end<B: Bus>(&mut self, driver: &mut Driver<B>) -> Result<(), DriverError> {
        self.before.drain(..).try_for_each(|placed| driver.free_texture(placed.texture))
    }

    /// The texture of this number.
    pub(super) fn get(&self, number: usize) -> Option<&Texture> {
        self.placed.get(number).map(|placed| &placed.texture)
    }
}

/// Smaller levels are in use.
fn has_levels(texture: &scene::Texture) -> bool {
    texture.mip_map || texture.filter == TextureFilter::Trilinear
}

fn upload<B: Bus>(
    driver: &mut Driver<B>,
    wanted: &scene::Texture,
    picture: &Arc<Picture>,
) -> Result<Placed, DriverError> {
    let [width, height] = picture.size();
    let options = TextureOptions { width, height, format: wanted.format, mip_map: has_levels(wanted) };
    let texture = driver.create_texture(&options)?;
    let written = match wanted.indexed() {
        Some(indexed) => driver.upload_texture_with_palette(&texture, picture.pixels(), &indexed.palette),
        None => driver.upload_texture(&texture, picture.pixels()),
    };
    match written {
        Ok(()) => Ok(Placed { picture: Arc::clone(picture), palette: wanted.palette.clone(), texture }),
        Err(refused) => {
            driver.free_texture(texture)?;
            Err(refused)
        }
    }
}

/// Bytes of video memory that the textures of batches take at most: levels are a third on top of the first, and each
/// row and level may have to be rounded up.
pub(super) fn texture_bytes(batches: &[Batch]) -> u64 {
    let mut known: Vec<(*const Picture, TextureFormat)> = Vec::new();
    let mut bytes = 0;
    for texture in batches.iter().filter_map(|batch| batch.material.texture.as_ref()) {
        let Some(picture) = &texture.image else { continue };
        // Pictures in different places may be equal; counted twice they only make the card larger.
        let key = (Arc::as_ptr(picture), texture.format);
        if !known.contains(&key) {
            known.push(key);
            let [width, height] = picture.size().map(u64::from);
            bytes += 2 * (4 * (width + 4) * (height + 4)) + (4 << 10);
        }
    }
    bytes
}

/// How a batch reads its texture.
pub(super) fn texture_state<'a>(wanted: &scene::Texture, texture: &'a Texture) -> TextureState<'a> {
    TextureState {
        filter: match wanted.filter {
            TextureFilter::Nearest => format::TextureFilter::Nearest,
            TextureFilter::Bilinear => format::TextureFilter::Bilinear,
            TextureFilter::Trilinear => format::TextureFilter::Trilinear,
        },
        function: wanted.function,
        repeat: wanted.repeat,
        mirror: wanted.mirror,
        offset: wanted.offset,
        window: wanted.size,
        bias: wanted.bias.into(),
        colour: wanted.colour,
        ..TextureState::new(texture)
    }
}

/// How a surface is blended; `None` where it is not.
pub(super) const fn blend_mode(blend: Blend) -> Option<BlendMode> {
    match blend {
        Blend::Opaque => None,
        Blend::Alpha => Some(BlendMode::Alpha),
        Blend::Add => Some(BlendMode::Add),
        Blend::Multiply => Some(BlendMode::Multiply),
        Blend::Premultiplied => Some(BlendMode::Premultiplied),
    }
}

/// The fog of a material.
pub(super) fn fog(material: &Material) -> Option<Fog> {
    let density = material.fog_density;
    let curve = match material.fog_function {
        FogFunction::None => return None,
        FogFunction::Linear => FogCurve::Linear { end: material.fog_end },
        FogFunction::Exponential => FogCurve::Exponential { density },
        FogFunction::ExponentialSquared => FogCurve::ExponentialSquared { density },
        FogFunction::DepthCue => {
            FogCurve::DepthCue { scale: material.depth_cue_scale, offset: material.depth_cue_offset }
        }
    };
    Some(Fog { curve, colour: material.fog_colour })
}

/// A light of a scene.
pub(super) fn light(light: &scene::Light) -> zga_driver::Light {
    let scene::Light { position, direction, spot_exponent: exponent, .. } = *light;
    let source = match light.kind {
        LightType::Directional => LightSource::Directional { direction },
        LightType::Point => LightSource::Point { position },
        LightType::Spot => LightSource::Spot { position, direction, exponent },
    };
    zga_driver::Light { source, cut_off: light.attenuation_cut_off, colour: light.colour, ambient: light.ambient }
}

/// The material of a lit batch.
pub(super) fn material(material: &Material, lighting: Lighting) -> zga_driver::Material {
    let Material { specular, emission, shininess, two_sided, .. } = *material;
    zga_driver::Material { specular, emission, shininess, two_sided, per_pixel: lighting == Lighting::Pixel }
}

/// Takes out of batches what a card of these effects has no unit for; the names of what was taken out.
pub(super) fn reduce(batches: &mut [Batch], has: Effects) -> Vec<&'static str> {
    let mut names = Vec::new();
    let mut lacks = |effect: Effects, name: &'static str, called: bool| {
        let lacks = called && !has.contains(effect);
        if lacks && !names.contains(&name) {
            names.push(name);
        }
        lacks
    };
    for batch in batches {
        let mut material = (*batch.material).clone();
        if lacks(Effects::LIGHT, "lights", batch.light != Lighting::None) {
            batch.light = Lighting::None;
        }
        if lacks(Effects::FOG, "fog", material.fog_function != FogFunction::None) {
            material.fog_function = FogFunction::None;
        }
        if lacks(Effects::BLEND, "translucency", batch.translucent) {
            material.blend = Blend::Opaque;
            batch.translucent = false;
        }
        if lacks(Effects::PUNCH_THROUGH, "punch-through", material.punch_through.is_some()) {
            material.punch_through = None;
        }
        if lacks(Effects::TEXTURE, "textures", material.texture.is_some()) {
            material.texture = None;
        }
        if lacks(Effects::STENCIL, "stencil tests", material.stencil.is_some()) {
            // What draws stencil values alone has nothing left to draw.
            if material.stencil.is_some_and(|stencil| !stencil.colours) {
                batch.indices.clear();
            }
            material.stencil = None;
        }
        if let Some(texture) = &mut material.texture
            && lacks(Effects::MIP_MAP, "MIP maps", has_levels(texture))
        {
            texture.mip_map = false;
            if texture.filter == TextureFilter::Trilinear {
                texture.filter = TextureFilter::Bilinear;
            }
        }
        if material != *batch.material {
            batch.material = Arc::new(material);
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::{Asked, Look, Session};
    use crate::scene::{Camera, Colours, Draw, HIDDEN_SURFACES, Orthographic, Primitives, Scene, TextureFunction};

    const RED: Colour = [255, 0, 0, 255];
    const GREEN: Colour = [0, 255, 0, 255];
    const HOLE: Colour = [0, 0, 255, 0];

    /// Two triangles over the whole of 8 x 8 pixels, 4 units before the eye, in `colour` and with this material, over a
    /// background of (40, 60, 80).
    fn quad(colour: Colour, material: Material) -> Scene {
        let mut scene = Scene::new([8, 8], [40, 60, 80, 255]);
        let (eye, up) = ([0.0, 0.0, 4.0], [0.0, 1.0, 0.0]);
        scene.camera =
            Camera::Orthographic(Orthographic { eye, target: [0.0; 3], up, width: 2.0, near: 1.0, far: 9.0 });
        scene.materials.insert("surface".to_owned(), material);
        scene.draw.push(Draw::Triangles(Primitives {
            vertices: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
            indices: Some(vec![0, 1, 2, 0, 2, 3]),
            colours: Colours::One(colour),
            normals: Some(vec![[0.0, 0.0, 1.0]; 4]),
            texture_coordinates: Some(vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]),
            material: Some("surface".to_owned()),
            ..Primitives::default()
        }));
        scene
    }

    /// A texture that is red on the left and `right` on the right.
    fn halves(right: Colour) -> scene::Texture {
        let picture = Picture::from_fn([2, 2], |x, _| if x == 0 { RED } else { right });
        let picture = picture.expect("a possible size");
        scene::Texture {
            function: TextureFunction::Replace,
            filter: TextureFilter::Nearest,
            ..scene::Texture::of(picture)
        }
    }

    /// Red, green and blue of the pixels in columns 1 and 6 of row 4, on every path, which agree.
    fn pixels(scene: &Scene) -> [[u8; 3]; 2] {
        let found = HIDDEN_SURFACES.map(|(_, path)| {
            let mut asked = Asked { threads: 1, ..Asked::default() };
            asked.card.hidden_surface = Some(path);
            let mut session = Session::open("quad", scene, &asked).expect("a card");
            let (frame, _) = session.frame(scene, Look::default()).expect("drawn");
            [1, 6].map(|x| {
                let [blue, green, red, _] = frame.pixels[4 * 8 + x].to_le_bytes();
                [red, green, blue]
            })
        });
        assert_eq!(found, [found[0]; 4]);
        found[0]
    }

    #[test]
    fn frame_texture_shows_its_halves_and_holes_the_background() {
        let texture = Some(halves(GREEN));
        let scene = quad([255; 4], Material { texture, ..Material::default() });
        assert_eq!(pixels(&scene), [[255, 0, 0], [0, 255, 0]]);
        let (texture, punch_through) = (Some(halves(HOLE)), Some(1));
        let scene = quad([255; 4], Material { texture, punch_through, ..Material::default() });
        assert_eq!(pixels(&scene), [[255, 0, 0], [40, 60, 80]]);
    }

    #[test]
    fn frame_texture_formats_with_palettes_show_the_same() {
        for format in [TextureFormat::Palette4, TextureFormat::Palette8, TextureFormat::Rgb565] {
            let texture = Some(scene::Texture { format, ..halves(GREEN) });
            let scene = quad([255; 4], Material { texture, ..Material::default() });
            assert_eq!(pixels(&scene), [[255, 0, 0], [0, 255, 0]], "{format:?}");
        }
    }

    #[test]
    fn frame_blend_modes_mix_with_the_background() {
        let shown = |blend| pixels(&quad([200, 100, 0, 128], Material { blend, ..Material::default() }))[0];
        // 128/255 of (200, 100, 0) over (40, 60, 80): 120.3, 80.1, 39.8.
        assert_eq!(shown(Blend::Alpha), [120, 80, 40]);
        // (100.4, 50.2, 0) rounded, added.
        assert_eq!(shown(Blend::Add), [140, 110, 80]);
        assert_eq!(shown(Blend::Opaque), [200, 100, 0]);
    }

    #[test]
    fn frame_light_at_vertices_and_pixels_is_ambient_and_diffuse() {
        for light in [Lighting::Vertex, Lighting::Pixel] {
            let mut scene = quad([200, 255, 100, 255], Material { light: Some(light), ..Material::default() });
            scene.ambient = [51, 51, 51, 255];
            let sun = scene::Light {
                kind: LightType::Directional,
                position: [0.0; 3],
                direction: [0.0, 0.0, -1.0],
                attenuation_cut_off: None,
                spot_exponent: 0.0,
                colour: [102, 102, 102, 255],
                ambient: [0, 0, 0, 255],
            };
            scene.lights.push(sun);
            // A fifth of the colour everywhere and two fifths of it from the light.
            assert_eq!(pixels(&scene), [[120, 153, 60]; 2], "{light:?}");
        }
    }

    #[test]
    fn frame_fog_takes_half_of_the_colour_at_half_of_its_end() {
        let fog = Material {
            fog_function: FogFunction::Linear,
            fog_end: 8.0,
            fog_colour: [0, 0, 200, 255],
            ..Material::default()
        };
        // The share of the surface is 128 of 255.
        assert_eq!(pixels(&quad([255, 51, 0, 255], fog)), [[128, 26, 100]; 2]);
    }

    #[test]
    fn frame_equal_pictures_are_one_texture_and_unused_ones_are_given_back() {
        let material = || Material { texture: Some(halves(GREEN)), ..Material::default() };
        let mut scene = quad([255; 4], material());
        scene.materials.insert("other".to_owned(), material());
        let Draw::Triangles(mut again) = scene.draw[0].clone() else { panic!("triangles") };
        again.material = Some("other".to_owned());
        scene.draw.push(Draw::Triangles(again));
        let mut session = Session::open("two", &scene, &Asked::default()).expect("a card");
        session.frame(&scene, Look::default()).expect("drawn");
        assert_eq!((session.textures.placed.len(), session.textures.before.len()), (1, 0));
        let coarse = Look { filter: Some(TextureFilter::Trilinear), ..Look::default() };
        session.frame(&scene, coarse).expect("drawn");
        assert_eq!(session.textures.placed.len(), 1);
        assert_eq!(session.textures.get(0).map(Texture::levels), Some(2));
        session.frame(&quad(RED, Material::default()), Look::default()).expect("drawn");
        assert_eq!((session.textures.placed.len(), session.textures.before.len()), (0, 0));
    }

    #[test]
    fn reduce_takes_out_what_the_card_has_no_unit_for() {
        let material = Material { texture: Some(halves(GREEN)), blend: Blend::Add, ..Material::default() };
        let mut batches = quad(RED, material).batches();
        assert_eq!(reduce(&mut batches, Effects::all()), Vec::<&str>::new());
        assert_eq!(reduce(&mut batches, Effects::DEPTH | Effects::BLEND), ["textures"]);
        assert!(batches[0].material.texture.is_none() && batches[0].translucent);
        assert_eq!(reduce(&mut batches, Effects::DEPTH), ["translucency"]);
        assert_eq!((batches[0].material.blend, batches[0].translucent), (Blend::Opaque, false));
    }
}
