//! Material libraries of .obj files as materials.
//!
//! Duties: brings the lines of a library into a form that `tobj` takes, and makes of each material the colour that goes
//! into the vertices and the [`Material`] of the part. Inputs from: `tobj`. Outputs to: the .obj loader.
//!
//! `Kd` is the colour and `d` its alpha; `Ks` and `Ns` make the highlight (`illum` 0 and 1 know none), `Ke` what is
//! given off. `map_Kd` is modulated, as the format has it. The alphas of `map_d` go into the same texture: if there
//! are none but 0 and 255 they are holes, else translucency. Alphas of `map_Kd` itself count only where `map_d` names
//! the same file. What cannot be read or is not supported is a warning.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use super::obj::{finite, write_numbers};
use super::{PLAIN_COLOUR, highlight};
use crate::scene::{Blend, Colour, DARK, Material, Texture, TextureFilter};
use crate::texture::{Picture, Room};

/// Keyword by which the plain form of a library says that a picture is not repeated.
const CLAMP: &str = "clamp_Kd";

/// The lines of a material library that are used, in a form that `tobj` takes.
pub(super) fn plain_library(text: &str, warnings: &mut Vec<String>) -> String {
    let mut kept = String::new();
    let mut left_out = BTreeSet::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or("").trim();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let values = finite(rest.split_whitespace());
        match (word, values.as_deref()) {
            ("newmtl", _) if !rest.trim().is_empty() => {
                let _ = writeln!(kept, "newmtl {}", rest.trim());
            }
            ("Kd" | "Ks" | "Ke", Ok([r, g, b, ..])) => write_numbers(&mut kept, word, &[*r, *g, *b]),
            ("Kd" | "Ks" | "Ke", Ok([grey])) => write_numbers(&mut kept, word, &[*grey; 3]),
            ("Ns" | "d", Ok([value, ..])) => write_numbers(&mut kept, word, &[*value]),
            ("Tr", Ok([transparency, ..])) => write_numbers(&mut kept, "d", &[1.0 - transparency]),
            ("illum", Ok([model, ..])) => {
                let _ = writeln!(kept, "illum {}", *model as u8);
            }
            ("map_Kd" | "map_d", _) => {
                let map = Map::of(rest);
                left_out.extend(map.left_out.iter().map(|option| format!("{word} {option}")));
                if !map.file.is_empty() {
                    let _ = writeln!(kept, "{word} {}", map.file);
                }
                if map.clamped && word == "map_Kd" {
                    let _ = writeln!(kept, "{CLAMP} on");
                }
            }
            (map, _) if map.starts_with("map_") || ["bump", "disp", "decal", "refl", "norm"].contains(&map) => {
                left_out.insert(super::shortened(map));
            }
            _ => {}
        }
    }
    if !left_out.is_empty() {
        let names: Vec<String> = left_out.into_iter().take(8).collect();
        warnings.push(format!("of materials left out: {}", names.join(", ")));
    }
    kept
}

/// What a line like `map_Kd -s 2 2 -clamp on brick.png` says.
struct Map<'a> {
    file: &'a str,
    clamped: bool,
    /// Options that change the picture and are not read.
    left_out: Vec<&'static str>,
}

impl<'a> Map<'a> {
    fn of(mut rest: &'a str) -> Self {
        // Words behind each option; of those with three, numbers only, and not all need be there.
        const OPTIONS: [(&str, usize); 13] = [
            ("-blendu", 1),
            ("-blendv", 1),
            ("-boost", 1),
            ("-bm", 1),
            ("-cc", 1),
            ("-clamp", 1),
            ("-imfchan", 1),
            ("-texres", 1),
            ("-type", 1),
            ("-mm", 2),
            ("-o", 3),
            ("-s", 3),
            ("-t", 3),
        ];
        let mut map = Self { file: "", clamped: false, left_out: Vec::new() };
        let split = |text: &'a str| text.split_once(char::is_whitespace).map(|(word, rest)| (word, rest.trim_start()));
        rest = rest.trim();
        while let Some((word, mut behind)) = split(rest)
            && let Some((option, count)) = OPTIONS.iter().find(|(option, _)| *option == word)
        {
            let mut values = Vec::new();
            while values.len() < *count
                && let Some((value, next)) = split(behind)
                && (*count < 3 || value.parse::<f32>().is_ok())
            {
                values.push(value);
                behind = next;
            }
            let all = |number: f32| values.iter().all(|value| value.parse() == Ok(number));
            match *option {
                "-clamp" => map.clamped = values == ["on"],
                "-s" if all(1.0) => {}
                "-o" | "-t" if all(0.0) => {}
                "-mm" | "-imfchan" | "-type" | "-s" | "-o" | "-t" => map.left_out.push(option),
                _ => {}
            }
            rest = behind;
        }
        map.file = rest;
        map
    }
}

/// A part of the 0..=1 scale as a level.
pub(super) fn channel(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// How a part looks.
#[derive(Clone)]
pub(super) struct Surface {
    /// For the part's vertices.
    pub(super) colour: Colour,
    pub(super) material: Arc<Material>,
}

/// Materials of a file, each made when it is used first.
pub(super) struct Surfaces<'a> {
    materials: &'a [tobj::Material],
    folder: &'a Path,
    /// By number, and whether the part has texture coordinates.
    made: HashMap<(usize, bool), Surface>,
    /// Pictures by name; none for what cannot be read.
    pictures: BTreeMap<String, Option<Arc<Picture>>>,
    /// Pictures for a `map_Kd` and a `map_d`.
    joined: BTreeMap<[Option<String>; 2], Option<Arc<Picture>>>,
    room: Room,
    warnings: Vec<String>,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(materials: &'a [tobj::Material], folder: &'a Path) -> Self {
        Self {
            materials,
            folder,
            made: HashMap::new(),
            pictures: BTreeMap::new(),
            joined: BTreeMap::new(),
            room: Room::default(),
            warnings: Vec::new(),
        }
    }

    /// What was left out, each line once.
    pub(super) fn into_warnings(mut self) -> Vec<String> {
        self.warnings.sort();
        self.warnings.dedup();
        self.warnings
    }

    /// How the parts with material number `id` look.
    pub(super) fn of(&mut self, id: Option<usize>, has_coordinates: bool) -> Surface {
        let Some((id, material)) = id.and_then(|id| self.materials.get(id).map(|material| (id, material))) else {
            return Surface { colour: PLAIN_COLOUR, material: Arc::default() };
        };
        if let Some(known) = self.made.get(&(id, has_coordinates)) {
            return known.clone();
        }
        let made = self.make(material, has_coordinates);
        self.made.insert((id, has_coordinates), made.clone());
        made
    }

    fn make(&mut self, file: &tobj::Material, has_coordinates: bool) -> Surface {
        let maps = [&file.diffuse_texture, &file.dissolve_texture].map(Clone::clone);
        let image = match (&maps, has_coordinates) {
            ([None, None], _) => None,
            (_, true) => self.picture(maps.clone()),
            (_, false) => {
                let name = super::shortened(&file.name);
                self.warnings.push(format!("texture of material {name} left out where there are no coordinates"));
                None
            }
        };
        let opacity = file.dissolve.unwrap_or(1.0);
        let usual = if image.is_some() { [255; 3] } else { [PLAIN_COLOUR[0], PLAIN_COLOUR[1], PLAIN_COLOUR[2]] };
        let [r, g, b] = file.diffuse.map_or(usual, |rgb| rgb.map(channel));
        let shines = !matches!(file.illumination_model, Some(0 | 1));
        let specular = file.specular.filter(|_| shines).unwrap_or_default().map(channel);
        let (specular, shininess) = highlight(specular, file.shininess.unwrap_or(0.0));
        let [er, eg, eb] = file.emissive.unwrap_or_default().map(channel);
        // Alphas are there only if `map_d` gave them.
        let partly = image.as_ref().is_some_and(|image| image.pixels().iter().any(|p| (1..=254).contains(&p[3])));
        let holes = image.as_ref().is_some_and(|image| !partly && !image.is_opaque());
        let material = Material {
            specular,
            shininess,
            emission: [er, eg, eb, DARK[3]],
            blend: if opacity < 1.0 || partly { Blend::Alpha } else { Blend::Opaque },
            punch_through: holes.then_some(128),
            texture: image.map(|image| Texture {
                file: maps.iter().flatten().next().cloned().unwrap_or_default(),
                filter: TextureFilter::Trilinear,
                mip_map: true,
                repeat: [!file.unknown_param.contains_key(CLAMP); 2],
                ..Texture::of(image)
            }),
            ..Material::default()
        };
        Surface { colour: [r, g, b, channel(opacity)], material: Arc::new(material) }
    }

    /// The picture for `map_Kd` and `map_d`: the colours of the one, white without it, and the alphas of the other.
    fn picture(&mut self, names: [Option<String>; 2]) -> Option<Arc<Picture>> {
        if let Some(known) = self.joined.get(&names) {
            return known.clone();
        }
        let [colours, alphas] = names.clone().map(|name| name.and_then(|name| self.read(&name)));
        let joined = match (colours, alphas) {
            (None, None) => None,
            (Some(colours), None) if colours.is_opaque() => Some(colours),
            (Some(colours), None) => {
                let name = names[0].as_deref().map(super::shortened).unwrap_or_default();
                self.warnings.push(format!("alphas of {name} left out, because no map_d names it"));
                self.with_alphas(&colours, |_, _| 255)
            }
            (colours, Some(alphas)) => {
                let [width, height] = alphas.size();
                let white = || Picture::from_fn([width, height], |_, _| [255; 4]).map(Arc::new);
                let colours = colours.or_else(white)?;
                let [columns, rows] = colours.size();
                // A picture without alphas of its own says it in grey.
                let grey = alphas.is_opaque();
                self.with_alphas(&colours, |x, y| {
                    // Sides are at most 16384, so the products fit.
                    let [r, g, b, alpha] = alphas.at(x * width / columns, y * height / rows);
                    if grey { ((u32::from(r) + u32::from(g) + u32::from(b) + 1) / 3) as u8 } else { alpha }
                })
            }
        };
        self.joined.insert(names, joined.clone());
        joined
    }

    fn with_alphas(&mut self, picture: &Picture, alpha: impl Fn(u32, u32) -> u8) -> Option<Arc<Picture>> {
        match self.room.take(picture.size()) {
            Ok(()) => Some(Arc::new(picture.with_alphas(alpha))),
            Err(reason) => {
                self.warnings.push(format!("texture left out: {reason}"));
                None
            }
        }
    }

    fn read(&mut self, name: &str) -> Option<Arc<Picture>> {
        if let Some(known) = self.pictures.get(name) {
            return known.clone();
        }
        // Libraries from other systems part folders otherwise.
        let file = self.folder.join(name.replace('\\', "/"));
        let read = Picture::load_within(&file, &mut self.room);
        let picture = read.map_err(|reason| self.warnings.push(format!("texture left out: {reason}"))).ok();
        let picture = picture.map(Arc::new);
        self.pictures.insert(name.to_owned(), picture.clone());
        picture
    }
}
