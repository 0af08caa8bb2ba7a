//! MTL materials.
//!
//! MTL is older than linear colour: its colours are taken for displayed (sRGB) ones.

use std::collections::{HashMap, HashSet};
use std::convert::Infallible;
use std::io;

use glam::{Vec2, Vec3};

use super::{files, for_each_line, number, numbers, picture, quoted, split_keyword};
use crate::import::warnings::Warnings;
use crate::scene::{AlphaMode, Material, Sampler, Scene, Texture, TextureRef, UvTransform, Wrap};
use crate::srgb::linear_from_srgb;

/// Linear light from a displayed colour (IEC 61966-2-1).
pub(super) fn linear_color(color: Vec3) -> Vec3 {
    color.clamp(Vec3::ZERO, Vec3::ONE).map(linear_from_srgb)
}

/// A picture with the way a material places it.
#[derive(Clone, Debug, PartialEq)]
struct Map {
    path: String,
    transform: UvTransform,
    clamp: bool,
}

/// A material while its statements are read.
#[derive(Clone, Debug, Default)]
struct Entry {
    material: Material,
    is_defined: bool,
    has_diffuse: bool,
    has_alpha_map: bool,
    base: Option<Map>,
    emissive: Option<Map>,
}

/// All materials that were named so far.
pub(super) struct Materials<'a> {
    files: &'a dyn Fn(&str) -> io::Result<Vec<u8>>,
    entries: Vec<Entry>,
    entry_of_name: HashMap<String, usize>,
    libraries: HashSet<String>,
    is_library_missing: bool,
}

impl<'a> Materials<'a> {
    pub(super) fn new(files: &'a dyn Fn(&str) -> io::Result<Vec<u8>>) -> Self {
        Self {
            files,
            entries: Vec::new(),
            entry_of_name: HashMap::new(),
            libraries: HashSet::new(),
            is_library_missing: false,
        }
    }

    /// The index of a material; one that no library has yet is white.
    pub(super) fn find_or_add(&mut self, name: &str) -> usize {
        let next = self.entries.len();
        let index = *self.entry_of_name.entry(name.to_owned()).or_insert(next);
        if index == next {
            let shown = if name.is_empty() { format!("material-{next}") } else { name.to_owned() };
            let material = Material { name: shown, ..Material::default() };
            self.entries.push(Entry { material, ..Entry::default() });
        }
        index
    }

    /// Reads the libraries of a `mtllib` statement: one file whose name may have spaces, or
    /// several.
    pub(super) fn load_library(&mut self, names: &str, warnings: &mut Warnings) {
        if !self.libraries.insert(names.to_owned()) {
            return;
        }
        let whole = files::read_relative(names, self.files);
        let libraries = match &whole {
            Err(_) if names.contains(char::is_whitespace) => names
                .split_whitespace()
                .filter(|name| self.libraries.insert((*name).to_owned()))
                .map(|name| (name, files::read_relative(name, self.files)))
                .collect(),
            _ => vec![(names, whole)],
        };
        for (name, library) in libraries {
            match library {
                Ok(bytes) => self.read_library(name, &bytes, warnings),
                Err(why) => {
                    self.is_library_missing = true;
                    warnings.add(format!(
                        "The material library {} is left out, its materials are white: {why}.",
                        quoted(name)
                    ));
                }
            }
        }
    }

    fn read_library(&mut self, name: &str, bytes: &[u8], warnings: &mut Warnings) {
        let mut current = None;
        let Ok(()) = for_each_line::<Infallible>(bytes, |line_number, line| {
            let (keyword, rest) = split_keyword(line);
            if keyword == "newmtl" {
                let index = self.find_or_add(rest);
                if let Some(entry) = self.entries.get_mut(index) {
                    entry.is_defined = true;
                }
                current = Some(index);
                return Ok(());
            }
            let Some(entry) = current.and_then(|index: usize| self.entries.get_mut(index)) else {
                return Ok(());
            };
            if let Err(why) = entry.statement(keyword, rest) {
                warnings
                    .add(format!("In {}, line {line_number} is left out: {why}.", quoted(name)));
            }
            Ok(())
        });
    }

    /// Puts the materials with their pictures into the scene.
    pub(super) fn finish(self, scene: &mut Scene, warnings: &mut Warnings) {
        let mut textures = Textures {
            files: self.files,
            image_of: HashMap::new(),
            texture_of: HashMap::new(),
            decoder: picture::Decoder::default(),
            scene,
        };
        let mut materials = Vec::with_capacity(self.entries.len());
        for entry in self.entries {
            if !entry.is_defined && !self.is_library_missing {
                warnings.add(format!(
                    "The material {} is in no library; it is white.",
                    quoted(&entry.material.name)
                ));
            }
            let mut material = entry.material;
            if let Some(map) = &entry.base {
                material.base_color_texture = Some(textures.reference(map, warnings));
                // Black under a picture is what exporters write that do not know the factor.
                if !entry.has_diffuse || material.base_color.truncate() == Vec3::ZERO {
                    material.base_color = Vec3::ONE.extend(material.base_color.w);
                }
            }
            if let Some(map) = &entry.emissive {
                material.emissive_texture = Some(textures.reference(map, warnings));
                if material.emissive == Vec3::ZERO {
                    material.emissive = Vec3::ONE;
                }
            }
            if material.base_color.w < 1.0 || (entry.has_alpha_map && entry.base.is_some()) {
                material.alpha = AlphaMode::Blend;
            }
            materials.push(material);
        }
        scene.materials = materials;
    }
}

impl Entry {
    fn statement(&mut self, keyword: &str, rest: &str) -> Result<(), String> {
        match keyword.to_ascii_lowercase().as_str() {
            "kd" => {
                let color = linear_color(color(rest)?);
                self.material.base_color = color.extend(self.material.base_color.w);
                self.has_diffuse = true;
            }
            "ke" => self.material.emissive = linear_color(color(rest)?),
            "d" => {
                let alpha = number(rest.trim_start_matches("-halo").trim())?;
                self.material.base_color.w = alpha.clamp(0.0, 1.0);
            }
            "tr" => {
                let ([transparency], _) = numbers(rest, 1)?;
                self.material.base_color.w = (1.0 - transparency).clamp(0.0, 1.0);
            }
            "map_kd" => self.base = Some(map(rest)?),
            "map_ke" => self.emissive = Some(map(rest)?),
            "map_d" => self.has_alpha_map = true,
            // Everything else describes reflections, which styles replace.
            _ => {}
        }
        Ok(())
    }
}

/// A colour of one grey value or three.
fn color(rest: &str) -> Result<Vec3, String> {
    let ([r, g, b], count) = numbers(rest, 1)?;
    Ok(if count == 3 { Vec3::new(r, g, b) } else { Vec3::splat(r) })
}

/// A `map_` statement: options, then a file name, which may have spaces.
fn map(rest: &str) -> Result<Map, String> {
    let mut rest = rest;
    let mut offset = Vec2::ZERO;
    let mut scale = Vec2::ONE;
    let mut clamp = false;
    while rest.starts_with('-') {
        let (option, mut after) = split_keyword(rest);
        let mut take = |least: usize, most: usize| {
            let mut values = Vec::new();
            while values.len() < most {
                let (word, next) = split_keyword(after);
                if word.is_empty() || (values.len() >= least && number(word).is_err()) {
                    break;
                }
                values.push(word);
                after = next;
            }
            values
        };
        let pair = |words: &[&str], default: f32| -> Result<Vec2, String> {
            let at = |i: usize| words.get(i).map_or(Ok(default), |word| number(word));
            Ok(Vec2::new(at(0)?, at(1)?))
        };
        match option {
            "-o" => offset = pair(&take(1, 3), 0.0)?,
            "-s" => scale = pair(&take(1, 3), 1.0)?,
            "-t" => drop(take(1, 3)),
            "-mm" => drop(take(2, 2)),
            "-clamp" => clamp = take(1, 1).first() == Some(&"on"),
            _ => drop(take(1, 1)),
        }
        rest = after;
    }
    if rest.is_empty() {
        return Err("it names no picture".to_owned());
    }
    // With v counted from the top, o + s·v becomes (1 − o − s) + s·v.
    let offset = Vec2::new(offset.x, 1.0 - offset.y - scale.y);
    let transform = UvTransform { offset, scale, rotation: 0.0 };
    Ok(Map { path: rest.to_owned(), transform, clamp })
}

/// Adds textures to the scene, each picture once.
struct Textures<'a, 'f> {
    files: &'f dyn Fn(&str) -> io::Result<Vec<u8>>,
    image_of: HashMap<String, Option<usize>>,
    /// The texture of a path and whether it is clamped.
    texture_of: HashMap<(String, bool), usize>,
    decoder: picture::Decoder,
    scene: &'a mut Scene,
}

impl Textures<'_, '_> {
    fn reference(&mut self, map: &Map, warnings: &mut Warnings) -> TextureRef {
        let image = match self.image_of.get(&map.path) {
            Some(known) => *known,
            None => {
                let image = self.load(&map.path, warnings);
                self.image_of.insert(map.path.clone(), image);
                image
            }
        };
        let next = self.scene.textures.len();
        let texture = *self.texture_of.entry((map.path.clone(), map.clamp)).or_insert(next);
        if texture == next {
            let wrap = if map.clamp { Wrap::Clamp } else { Wrap::Repeat };
            let sampler = Sampler { wrap_u: wrap, wrap_v: wrap, ..Sampler::default() };
            self.scene.textures.push(Texture { name: map.path.clone(), image, sampler });
        }
        TextureRef { texture, uv_set: 0, transform: map.transform }
    }

    fn load(&mut self, path: &str, warnings: &mut Warnings) -> Option<usize> {
        let decoded = files::read_relative(path, self.files)
            .and_then(|bytes| self.decoder.decode(path, &bytes, path));
        match decoded {
            Ok(image) => {
                self.scene.images.push(image);
                Some(self.scene.images.len() - 1)
            }
            Err(why) => {
                warnings.add(format!("The picture {} is drawn white: {why}.", quoted(path)));
                None
            }
        }
    }
}
