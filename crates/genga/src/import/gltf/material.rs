//! Materials, textures and the pictures that they use.

use std::borrow::Cow;
use std::collections::HashMap;

use glam::{Vec2, Vec3, Vec4};

use super::super::files;
use super::document::{Image as ImageItem, Material as Item, Sampler as SamplerItem, TextureInfo};
use super::{GltfFile, capitalised, label, picture, usable};
use crate::scene::{
    AlphaMode, Filter, Image, Material, MipFilter, Sampler, Texture, TextureRef, UvTransform, Wrap,
};

/// Materials with all that they refer to.
pub(super) struct Materials {
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
    pub(super) images: Vec<Image>,
}

/// Reads all materials. Only textures that a base colour or emission uses are decoded.
pub(super) fn read(file: &GltfFile) -> Materials {
    let mut textures = Textures {
        file,
        textures: Vec::new(),
        images: Vec::new(),
        texture_of: HashMap::new(),
        image_of: HashMap::new(),
        decoder: picture::Decoder::default(),
    };
    let materials = file
        .document
        .materials
        .iter()
        .enumerate()
        .map(|(index, item)| read_material(index, item, &mut textures))
        .collect();
    Materials { materials, textures: textures.textures, images: textures.images }
}

fn read_material(index: usize, item: &Item, textures: &mut Textures) -> Material {
    let file = textures.file;
    let what = || label("material", index, item.name.as_deref());
    let extensions = &item.extensions;
    let pbr = &item.pbr_metallic_roughness;
    // The older specular-glossiness model replaces the base colour by its diffuse colour.
    let (factor, texture) = match &extensions.specular_glossiness {
        Some(old) => (old.diffuse_factor, &old.diffuse_texture),
        None => (pbr.base_color_factor, &pbr.base_color_texture),
    };
    let strength = extensions.emissive_strength.as_ref().and_then(|e| e.emissive_strength);
    let strength = strength.filter(|s| usable(&[*s]) && *s >= 0.0).unwrap_or(1.0);
    let emissive = item.emissive_factor.filter(|f| usable(f)).map_or(Vec3::ZERO, Vec3::from);
    let alpha = match item.alpha_mode.as_deref() {
        None | Some("OPAQUE") => AlphaMode::Opaque,
        Some("MASK") => {
            let cutoff = item.alpha_cutoff.filter(|cutoff| usable(&[*cutoff])).unwrap_or(0.5);
            AlphaMode::Mask { cutoff: cutoff.max(0.0) }
        }
        Some("BLEND") => AlphaMode::Blend,
        Some(_) => {
            file.warn(format!("The alpha mode of {} is unknown; it is drawn opaque.", what()));
            AlphaMode::Opaque
        }
    };
    let factor = factor.filter(|factor| usable(factor)).map_or(Vec4::ONE, Vec4::from);
    Material {
        name: match &item.name {
            Some(name) if !name.is_empty() => name.clone(),
            _ => format!("material-{index}"),
        },
        base_color: factor.clamp(Vec4::ZERO, Vec4::ONE),
        base_color_texture: texture.as_ref().and_then(|info| textures.reference(info, &what)),
        emissive: emissive.clamp(Vec3::ZERO, Vec3::ONE) * strength,
        emissive_texture: item
            .emissive_texture
            .as_ref()
            .and_then(|info| textures.reference(info, &what)),
        alpha,
        double_sided: item.double_sided,
        unlit: extensions.unlit.is_some(),
    }
}

/// Where a picture comes from; equal sources are decoded once.
#[derive(PartialEq, Eq, Hash)]
enum Source<'a> {
    View(usize),
    Uri(&'a str),
}

/// Collects the textures that are used.
struct Textures<'a, 'f> {
    file: &'a GltfFile<'f>,
    textures: Vec<Texture>,
    images: Vec<Image>,
    /// The file's texture index → ours.
    texture_of: HashMap<usize, usize>,
    image_of: HashMap<Source<'a>, Option<usize>>,
    decoder: picture::Decoder,
}

impl<'a> Textures<'a, '_> {
    /// A material's use of a texture, or `None` if there is no such texture.
    fn reference(&mut self, info: &TextureInfo, what: &dyn Fn() -> String) -> Option<TextureRef> {
        let transform = info.extensions.transform.as_ref();
        let uv_set = transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord).0;
        let texture = self.texture(info.index.0, what)?;
        let vec2 = |value: Option<[f32; 2]>, default| {
            value.filter(|value| usable(value)).map_or(default, Vec2::from)
        };
        let transform = transform.map_or_else(UvTransform::default, |t| UvTransform {
            offset: vec2(t.offset, Vec2::ZERO),
            rotation: t.rotation.filter(|r| usable(&[*r])).unwrap_or(0.0),
            scale: vec2(t.scale, Vec2::ONE),
        });
        Some(TextureRef { texture, uv_set, transform })
    }

    fn texture(&mut self, index: usize, what: &dyn Fn() -> String) -> Option<usize> {
        if let Some(&ours) = self.texture_of.get(&index) {
            return Some(ours);
        }
        let document = &self.file.document;
        let Some(item) = document.textures.get(index) else {
            self.file.warn(format!(
                "{} uses texture {index}, which does not exist; its flat colour is drawn.",
                capitalised(&what())
            ));
            return None;
        };
        let webp = item.extensions.webp.as_ref().and_then(|webp| webp.source);
        let image = match webp.or(item.source) {
            Some(source) => match document.images.get(source.0) {
                Some(image) => self.image(source.0, image),
                None => {
                    self.file.warn(format!(
                        "Texture {index} uses image {}, which does not exist; it is drawn white.",
                        source.0
                    ));
                    None
                }
            },
            None => {
                self.file.warn(format!(
                    "Texture {index} has no PNG, JPEG or WebP picture; it is drawn white."
                ));
                None
            }
        };
        let sampler = item
            .sampler
            .and_then(|sampler| document.samplers.get(sampler.0))
            .map_or_else(Sampler::default, read_sampler);
        self.textures.push(Texture { name: item.name.clone().unwrap_or_default(), image, sampler });
        let ours = self.textures.len() - 1;
        self.texture_of.insert(index, ours);
        Some(ours)
    }

    /// Our index of a picture, decoded at its first use; `None` if it is missing or broken.
    fn image(&mut self, index: usize, item: &'a ImageItem) -> Option<usize> {
        let source = match (item.buffer_view, &item.uri) {
            (Some(view), _) => Source::View(view.0),
            (None, Some(uri)) => Source::Uri(uri),
            (None, None) => {
                let what = label("image", index, item.name.as_deref());
                self.file.warn(format!("{} has no data; white is drawn.", capitalised(&what)));
                return None;
            }
        };
        if let Some(&known) = self.image_of.get(&source) {
            return known;
        }
        let image = match self.decode(&source, item) {
            Ok(image) => {
                self.images.push(image);
                Some(self.images.len() - 1)
            }
            Err(why) => {
                let what = label("image", index, item.name.as_deref());
                self.file.warn(format!("{} is drawn white: {why}.", capitalised(&what)));
                None
            }
        };
        self.image_of.insert(source, image);
        image
    }

    fn decode(&mut self, source: &Source, item: &ImageItem) -> Result<Image, String> {
        let (bytes, path): (Cow<[u8]>, _) = match *source {
            Source::View(view) => {
                let bytes = self.file.view(view).map_err(|problem| problem.to_string())?;
                (Cow::Borrowed(bytes), "")
            }
            Source::Uri(uri) => (Cow::Owned(files::read_uri(uri, self.file.files)?), uri),
        };
        let is_data = path.get(..5).is_some_and(|head| head.eq_ignore_ascii_case("data:"));
        let name = match &item.name {
            Some(name) if !name.is_empty() => name,
            _ if is_data => "",
            _ => path,
        };
        self.decoder.decode(name, &bytes, path)
    }
}

fn read_sampler(item: &SamplerItem) -> Sampler {
    let default = Sampler::default();
    let mag = match item.mag_filter.map(|filter| filter.0) {
        Some(9728) => Filter::Nearest,
        _ => default.mag,
    };
    let (min, mip) = match item.min_filter.map(|filter| filter.0) {
        Some(9728) => (Filter::Nearest, MipFilter::None),
        Some(9729) => (Filter::Linear, MipFilter::None),
        Some(9984) => (Filter::Nearest, MipFilter::Nearest),
        Some(9985) => (Filter::Linear, MipFilter::Nearest),
        Some(9986) => (Filter::Nearest, MipFilter::Linear),
        _ => (default.min, default.mip),
    };
    let wrap = |code: Option<super::document::Int>| match code.map(|code| code.0) {
        Some(33_071) => Wrap::Clamp,
        Some(33_648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    Sampler { mag, min, mip, wrap_u: wrap(item.wrap_s), wrap_v: wrap(item.wrap_t) }
}
