//! Materials, textures and images of a glTF file.
//!
//! Duties: makes of each material a [`Material`] of the card, and of each image in use a picture, once. Inputs from: the
//! document, [`Buffers`], files beside it. Outputs to: the glTF loader.
//!
//! The base colour is in the vertices, so its texture is modulated. Alpha modes: `OPAQUE` is opaque, `BLEND` is
//! translucency by alpha, `MASK` makes holes of the texels below the cut-off. Metal and roughness become a highlight of
//! Blinn's model: with alpha = roughness squared its exponent is n = 2 / alpha^2 - 2 (at most 128, the card's most), and
//! its colour F0 (n + 2) / 8, where F0 goes from 0.04 to the base colour with the metal; n below 1 (a roughness above
//! 0.9) is no highlight. The diffuse colour stays even of metals, since there is nothing for them to mirror.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use std::sync::Arc;

use gltf::material::AlphaMode;
use gltf::texture::{MagFilter, MinFilter, Sampler, WrappingMode};

use super::accessor::{Buffers, from_uri};
use super::gltf_file::shown;
use super::{highlight, shortened};
use crate::scene::{Blend, DARK, Lighting, Material, Texture, TextureFilter};
use crate::texture::{Picture, Room};

/// Extension: colours are shown as they are.
pub(super) const UNLIT: &str = "KHR_materials_unlit";
/// Extension: texture coordinates are moved.
pub(super) const TRANSFORM: &str = "KHR_texture_transform";

/// Highest set of texture coordinates that is read.
const MOST_SET: u32 = 1;
/// Most lines of warnings.
const MOST_WARNINGS: usize = 64;

/// Which texture coordinates a material takes, and what becomes of them: times `scale`, plus `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) set: u32,
    pub(super) scale: [f64; 2],
    pub(super) offset: [f64; 2],
}

/// The materials of a document, each made when it is used first.
pub(super) struct Materials<'a> {
    document: &'a gltf::Document,
    buffers: &'a Buffers,
    folder: &'a Path,
    /// By number, and whether the primitive has the texture coordinates.
    made: HashMap<(usize, bool), Arc<Material>>,
    /// By number; none for what cannot be read.
    images: HashMap<usize, Option<Arc<Picture>>>,
    plain: Arc<Material>,
    room: Room,
    warnings: BTreeSet<String>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(document: &'a gltf::Document, buffers: &'a Buffers, folder: &'a Path) -> Self {
        Self {
            document,
            buffers,
            folder,
            made: HashMap::new(),
            images: HashMap::new(),
            plain: Arc::default(),
            room: Room::default(),
            warnings: BTreeSet::new(),
        }
    }

    /// What was left out, a line each.
    pub(super) fn into_warnings(self) -> BTreeSet<String> {
        self.warnings
    }

    fn warn(&mut self, line: String) {
        if self.warnings.len() < MOST_WARNINGS {
            self.warnings.insert(line);
        }
    }

    /// Which texture coordinates primitives with this material are given: the first set where nothing asks for others.
    pub(super) fn placement(&mut self, material: &gltf::Material<'_>) -> Placement {
        let plain = Placement { set: 0, scale: [1.0; 2], offset: [0.0; 2] };
        let Some(info) = material.pbr_metallic_roughness().base_color_texture() else { return plain };
        let Some(transform) = info.texture_transform() else { return Placement { set: info.tex_coord(), ..plain } };
        if transform.rotation() != 0.0 {
            let name = name_of(material);
            self.warn(format!("rotation of {TRANSFORM} left out of material {name}"));
        }
        let [scale, offset] = [transform.scale(), transform.offset()].map(|pair| pair.map(f64::from));
        let set = transform.tex_coord().unwrap_or(info.tex_coord());
        if scale.iter().chain(&offset).all(|number| number.is_finite()) {
            Placement { set, scale, offset }
        } else {
            Placement { set, ..plain }
        }
    }

    /// How primitives with this material look; `has_coordinates` says whether they have those of
    /// [`Materials::placement`].
    pub(super) fn of(&mut self, material: &gltf::Material<'_>, has_coordinates: bool) -> Arc<Material> {
        // The default material is rough white: plain.
        let Some(index) = material.index() else { return Arc::clone(&self.plain) };
        if let Some(known) = self.made.get(&(index, has_coordinates)) {
            return Arc::clone(known);
        }
        let made = Arc::new(self.make(material, has_coordinates));
        self.made.insert((index, has_coordinates), Arc::clone(&made));
        made
    }

    fn make(&mut self, file: &gltf::Material<'_>, has_coordinates: bool) -> Material {
        self.warn_of_maps(file);
        let base = file.pbr_metallic_roughness();
        let texture = self.texture(file, has_coordinates);
        let alpha = base.base_color_factor()[3];
        let (blend, punch_through) = match file.alpha_mode() {
            AlphaMode::Opaque => (Blend::Opaque, None),
            AlphaMode::Blend => (Blend::Alpha, None),
            AlphaMode::Mask => {
                let cut_off = file.alpha_cutoff().unwrap_or(0.5);
                if texture.is_none() && alpha < cut_off {
                    self.warn(format!("material {} is drawn though its alpha is below its cut-off", name_of(file)));
                }
                (Blend::Opaque, texture.as_ref().and_then(|_| holes_below(cut_off / alpha.max(f32::MIN_POSITIVE))))
            }
        };
        let plain = Material { two_sided: file.double_sided(), blend, punch_through, texture, ..Material::default() };
        if file.unlit() {
            return Material { light: Some(Lighting::None), ..plain };
        }
        let (specular, shininess) = highlight_of(&base);
        let [r, g, b] = file.emissive_factor();
        let [r, g, b, _] = shown([r, g, b, 1.0]);
        Material { specular, shininess, emission: [r, g, b, DARK[3]], ..plain }
    }

    fn warn_of_maps(&mut self, file: &gltf::Material<'_>) {
        let maps = [
            ("normal", file.normal_texture().is_some()),
            ("occlusion", file.occlusion_texture().is_some()),
            ("emissive", file.emissive_texture().is_some()),
            ("metallic-roughness", file.pbr_metallic_roughness().metallic_roughness_texture().is_some()),
        ];
        for (what, _) in maps.iter().filter(|(_, there)| *there) {
            self.warn(format!("{what} textures left out"));
        }
    }

    fn texture(&mut self, file: &gltf::Material<'_>, has_coordinates: bool) -> Option<Texture> {
        let texture = file.pbr_metallic_roughness().base_color_texture()?.texture();
        let set = self.placement(file).set;
        if !has_coordinates || set > MOST_SET {
            let name = name_of(file);
            self.warn(format!("texture of material {name} left out where there is no TEXCOORD_{set}"));
            return None;
        }
        let Some(image) = texture.source() else {
            self.warn(format!("texture {} left out: it has no image", texture.index()));
            return None;
        };
        let picture = self.image(image.index())?;
        let sampler = texture.sampler();
        let (filter, mip_map) = filter_of(&sampler);
        let wraps = [sampler.wrap_s(), sampler.wrap_t()];
        Some(Texture {
            file: format!("image {}", image.index()),
            filter,
            mip_map,
            repeat: wraps.map(|wrap| wrap != WrappingMode::ClampToEdge),
            mirror: wraps.map(|wrap| wrap == WrappingMode::MirroredRepeat),
            ..Texture::of(picture)
        })
    }

    fn image(&mut self, index: usize) -> Option<Arc<Picture>> {
        if let Some(known) = self.images.get(&index) {
            return known.clone();
        }
        let picture = self.read(index).map(Arc::new);
        let picture = picture.map_err(|reason| self.warn(format!("image {index} left out: {reason}"))).ok();
        self.images.insert(index, picture.clone());
        picture
    }

    fn read(&mut self, index: usize) -> Result<Picture, String> {
        // The crate's own way to the source expects fields that the document may lack.
        let image = self.document.as_json().images.get(index).ok_or("does not exist")?;
        match (&image.buffer_view, &image.uri) {
            (Some(view), _) => {
                let view = self.document.views().nth(view.value()).ok_or("its buffer view does not exist")?;
                Picture::decode(self.buffers.view(&view)?, &mut self.room)
            }
            (None, Some(uri)) => Picture::decode(&from_uri(uri, self.folder)?, &mut self.room),
            (None, None) => Err("has neither a buffer view nor a URI".to_owned()),
        }
    }
}

fn name_of(material: &gltf::Material<'_>) -> String {
    match (material.name(), material.index()) {
        (Some(name), _) => shortened(name),
        (None, index) => index.map_or_else(String::new, |index| index.to_string()),
    }
}

/// The least alpha of a texel that is no hole, for a part of the 0..=1 scale.
fn holes_below(cut_off: f32) -> Option<u8> {
    let level = (cut_off * 255.0).ceil().clamp(0.0, 255.0) as u8;
    (level > 0).then_some(level)
}

fn highlight_of(base: &gltf::material::PbrMetallicRoughness<'_>) -> (crate::scene::Colour, f32) {
    let [metal, rough] = [base.metallic_factor(), base.roughness_factor()].map(|part| part.clamp(0.0, 1.0));
    let alpha = f32::max(rough * rough, 1e-3);
    let exponent = f32::min(2.0 / (alpha * alpha) - 2.0, 128.0);
    let strength = |base: f32| (0.04 + (base - 0.04) * metal) * (exponent + 2.0) / 8.0;
    let [r, g, b, _] = base.base_color_factor().map(strength);
    let [r, g, b, _] = shown([r, g, b, 1.0]);
    highlight([r, g, b], exponent)
}

/// How a texture is read, and whether from smaller levels: as it is made smaller, unless it is to show its texels when
/// it is made larger. A sampler that says nothing gets the best.
fn filter_of(sampler: &Sampler<'_>) -> (TextureFilter, bool) {
    let (smaller, larger) = (sampler.min_filter(), sampler.mag_filter());
    let mip_map = !matches!(smaller, Some(MinFilter::Nearest | MinFilter::Linear));
    let filter = match (larger, smaller) {
        (Some(MagFilter::Nearest), _) | (None, Some(MinFilter::Nearest | MinFilter::NearestMipmapNearest)) => {
            TextureFilter::Nearest
        }
        (_, None | Some(MinFilter::LinearMipmapLinear | MinFilter::NearestMipmapLinear)) => TextureFilter::Trilinear,
        _ => TextureFilter::Bilinear,
    };
    (filter, mip_map)
}
