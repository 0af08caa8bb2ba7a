//! Pictures on the GPU, with mip levels.

use std::{
    collections::HashMap,
    sync::{Arc, LazyLock},
};

use wgpu::util::DeviceExt as _;

use crate::scene::{Filter, Image, MipFilter, Sampler, Scene, TextureRef, Wrap};
use crate::srgb::{linear_from_srgb, srgb_from_linear};

/// Textures and samplers of a scene, each uploaded once.
pub(crate) struct Textures<'a> {
    device: &'a wgpu::Device,
    queue: &'a wgpu::Queue,
    scene: &'a Scene,
    images: HashMap<usize, wgpu::TextureView>,
    /// By address.
    hatch_pictures: HashMap<usize, wgpu::TextureView>,
    samplers: HashMap<Sampler, wgpu::Sampler>,
    white: wgpu::TextureView,
    pub(crate) warnings: Vec<String>,
}

impl<'a> Textures<'a> {
    pub(crate) fn new(device: &'a wgpu::Device, queue: &'a wgpu::Queue, scene: &'a Scene) -> Self {
        let white = Image { name: String::new(), width: 1, height: 1, rgba: vec![255; 4] };
        let white = upload(device, queue, &white, Mips::None);
        Self {
            device,
            queue,
            scene,
            images: HashMap::new(),
            hatch_pictures: HashMap::new(),
            samplers: HashMap::new(),
            white,
            warnings: Vec::new(),
        }
    }

    /// The picture and sampler of a material's texture; white where there is none.
    pub(crate) fn get(
        &mut self,
        texture: Option<TextureRef>,
    ) -> (wgpu::TextureView, wgpu::Sampler) {
        let texture = texture.and_then(|t| self.scene.textures.get(t.texture));
        let sampler = texture.map_or_else(Sampler::default, |t| t.sampler);
        let view = match texture.and_then(|t| t.image) {
            Some(index) => self.image(index),
            None => self.white.clone(),
        };
        (view, self.sampler(sampler))
    }

    /// A picture of a style; white where there is none.
    pub(crate) fn style_image(&self, image: Option<&Arc<Image>>) -> wgpu::TextureView {
        image.map_or_else(
            || self.white.clone(),
            |image| upload(self.device, self.queue, &fitted(self.device, image).0, Mips::None),
        )
    }

    /// A picture of a style as a hatching pattern; white where there is none.
    pub(crate) fn hatch_picture(&mut self, image: Option<&Arc<Image>>) -> wgpu::TextureView {
        let Some(image) = image.filter(|image| is_complete(image)) else {
            return self.white.clone();
        };
        let make =
            || upload(self.device, self.queue, &super::hatch_picture::prepare(image), Mips::Raw);
        self.hatch_pictures.entry(Arc::as_ptr(image) as usize).or_insert_with(make).clone()
    }

    fn image(&mut self, index: usize) -> wgpu::TextureView {
        if let Some(view) = self.images.get(&index) {
            return view.clone();
        }
        let Some(image) = self.scene.images.get(index).filter(|image| is_complete(image)) else {
            return self.white.clone();
        };
        let (fitting, was_reduced) = fitted(self.device, image);
        if was_reduced {
            self.warnings.push(format!(
                "image '{}' of {}×{} pixels is over this adapter's limit and was reduced to {}×{}",
                image.name, image.width, image.height, fitting.width, fitting.height,
            ));
        }
        let view = upload(self.device, self.queue, &fitting, Mips::Color);
        self.images.insert(index, view.clone());
        view
    }

    pub(crate) fn sampler(&mut self, sampler: Sampler) -> wgpu::Sampler {
        let device = self.device;
        let wrap = |wrap| match wrap {
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        };
        let filter = |filter| match filter {
            Filter::Nearest => wgpu::FilterMode::Nearest,
            Filter::Linear => wgpu::FilterMode::Linear,
        };
        let make = || {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("material"),
                address_mode_u: wrap(sampler.wrap_u),
                address_mode_v: wrap(sampler.wrap_v),
                mag_filter: filter(sampler.mag),
                min_filter: filter(sampler.min),
                mipmap_filter: match sampler.mip {
                    MipFilter::Linear => wgpu::MipmapFilterMode::Linear,
                    MipFilter::None | MipFilter::Nearest => wgpu::MipmapFilterMode::Nearest,
                },
                lod_max_clamp: if sampler.mip == MipFilter::None { 0.0 } else { 32.0 },
                ..Default::default()
            })
        };
        self.samplers.entry(sampler).or_insert_with(make).clone()
    }
}

fn is_complete(image: &Image) -> bool {
    let pixels = image.width as usize * image.height as usize;
    pixels > 0 && image.rgba.len() == 4 * pixels
}

/// The image, halved until the adapter takes it, and whether that was needed.
fn fitted<'a>(device: &wgpu::Device, image: &'a Image) -> (std::borrow::Cow<'a, Image>, bool) {
    let limit = device.limits().max_texture_dimension_2d;
    let mut result = std::borrow::Cow::Borrowed(image);
    while result.width > limit || result.height > limit {
        result = std::borrow::Cow::Owned(half(&result));
    }
    let was_reduced = matches!(result, std::borrow::Cow::Owned(_));
    (result, was_reduced)
}

/// Smaller levels of a picture.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mips {
    None,
    /// Means in linear light.
    Color,
    /// Means of the values.
    Raw,
}

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    image: &Image,
    mips: Mips,
) -> wgpu::TextureView {
    let mut data = image.rgba.clone();
    let mut levels = 1;
    let half = match mips {
        Mips::Raw => half_raw,
        Mips::None | Mips::Color => half,
    };
    if mips != Mips::None {
        let mut level = half(image);
        let count = 32 - image.width.max(image.height).leading_zeros();
        while levels < count {
            data.extend_from_slice(&level.rgba);
            levels += 1;
            if levels < count {
                level = half(&level);
            }
        }
    }
    // Raw values: the shaders decode them where they need linear ones, so that an untouched base
    // colour leaves exactly as the file has it.
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some("image"),
            size: wgpu::Extent3d {
                width: image.width,
                height: image.height,
                depth_or_array_layers: 1,
            },
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &data,
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// The next mip level: means of 2×2 texels in linear light, weighted by alpha.
fn half(image: &Image) -> Image {
    let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
    let (linear, encoded) = (&*LINEAR, &*ENCODED);
    let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
    for y in 0..height {
        let rows = [2 * y, (2 * y + 1).min(image.height - 1)];
        for x in 0..width {
            let columns = [2 * x, (2 * x + 1).min(image.width - 1)];
            let (mut sum, mut alpha, mut plain) = ([0.0_f32; 3], 0.0_f32, [0.0_f32; 3]);
            for row in rows {
                for column in columns {
                    let at = 4 * (row as usize * image.width as usize + column as usize);
                    let texel = &image.rgba[at..at + 4];
                    let a = f32::from(texel[3]) / 255.0;
                    alpha += a;
                    for c in 0..3 {
                        let value = linear[texel[c] as usize];
                        sum[c] += a * value;
                        plain[c] += value;
                    }
                }
            }
            for c in 0..3 {
                let value = if alpha > 0.0 { sum[c] / alpha } else { plain[c] / 4.0 };
                rgba.push(encoded[(value.clamp(0.0, 1.0).sqrt() * 65536.0).round() as usize]);
            }
            rgba.push((alpha / 4.0 * 255.0).round() as u8);
        }
    }
    Image { name: image.name.clone(), width, height, rgba }
}

/// The next mip level of raw values.
fn half_raw(image: &Image) -> Image {
    let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
    let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let corners = [0, 1]
                .map(|i| [(2 * x + i).min(image.width - 1), (2 * y + i).min(image.height - 1)]);
            let [[left, top], [right, bottom]] = corners;
            for c in 0..4 {
                let sum: u32 = [[left, top], [right, top], [left, bottom], [right, bottom]]
                    .iter()
                    .map(|[x, y]| u32::from(image.rgba[4 * (y * image.width + x) as usize + c]))
                    .sum();
                rgba.push(((sum + 2) / 4) as u8);
            }
        }
    }
    Image { name: image.name.clone(), width, height, rgba }
}

/// Linear light of each 8-bit sRGB value.
static LINEAR: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..256).map(|v| linear_from_srgb(v as f32 / 255.0)).collect());

/// The 8-bit sRGB value by the square root of linear light, which spreads the darkest tones.
static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let encode = |i: u32| {
        let root = i as f32 / 65536.0;
        (srgb_from_linear(root * root) * 255.0).round() as u8
    };
    (0..=65536).map(encode).collect()
});

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, rgba: &[u8]) -> Image {
        Image { name: String::new(), width, height, rgba: rgba.to_vec() }
    }

    #[test]
    fn mips_average_in_linear_light() {
        let checker =
            image(2, 2, &[255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255]);
        assert_eq!(half(&checker).rgba, [188, 188, 188, 255]);
    }

    #[test]
    fn mips_keep_equal_texels_and_ignore_the_colour_of_transparent_ones() {
        for v in 0..=255 {
            assert_eq!(half(&image(2, 1, &[v, v, v, 255, v, v, v, 255])).rgba, [v, v, v, 255]);
        }
        let cut_out = image(2, 1, &[200, 10, 10, 255, 0, 255, 0, 0]);
        assert_eq!(half(&cut_out).rgba, [200, 10, 10, 128]);
    }
}
