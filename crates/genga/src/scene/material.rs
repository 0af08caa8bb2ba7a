use glam::{Vec2, Vec3, Vec4};

/// How a material's alpha is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Drawn where alpha is at least the cutoff.
    Mask {
        /// Smallest alpha that is drawn.
        cutoff: f32,
    },
    /// Blended over what lies behind.
    Blend,
}

/// The look that the file gives to a surface. Styles decide how it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file; may be empty.
    pub name: String,
    /// Linear RGBA factor of the base colour.
    pub base_color: Vec4,
    /// Base-colour texture (sRGB with straight alpha).
    pub base_color_texture: Option<TextureRef>,
    /// Linear RGB of emitted light, already multiplied by its strength; may be over 1.
    pub emissive: Vec3,
    /// Emissive texture (sRGB).
    pub emissive_texture: Option<TextureRef>,
    /// Opaque, masked or blended.
    pub alpha: AlphaMode,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// KHR_materials_unlit: drawn in its base colour without light.
    pub unlit: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
        }
    }
}

/// A texture as one material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into [`super::Scene::textures`].
    pub texture: usize,
    /// Which set of [`super::Primitive::uvs`] it uses.
    pub uv_set: usize,
    /// KHR_texture_transform.
    pub transform: UvTransform,
}

/// `uv' = offset + rotation · (scale ∘ uv)`, as KHR_texture_transform defines it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Offset in texture widths and heights.
    pub offset: Vec2,
    /// Counter-clockwise rotation in radians about the UV origin.
    pub rotation: f32,
    /// Scale of the coordinates.
    pub scale: Vec2,
}

impl Default for UvTransform {
    fn default() -> Self {
        Self { offset: Vec2::ZERO, rotation: 0.0, scale: Vec2::ONE }
    }
}

/// A picture with the way it is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Name in the file; may be empty.
    pub name: String,
    /// Index into [`super::Scene::images`]; `None` where the picture was missing or broken
    /// (drawn as white).
    pub image: Option<usize>,
    /// Filters and wrapping.
    pub sampler: Sampler,
}

/// Straight-alpha RGBA pixels as the file has them (8 bits, sRGB for colours), row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Name in the file or its path; may be empty.
    pub name: String,
    /// Width in pixels, > 0.
    pub width: u32,
    /// Height in pixels, > 0.
    pub height: u32,
    /// `width · height · 4` bytes.
    pub rgba: Vec<u8>,
}

/// Filters and wrapping of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Filter when texels are larger than pixels.
    pub mag: Filter,
    /// Filter when texels are smaller than pixels.
    pub min: Filter,
    /// Filter between mip levels; [`MipFilter::None`] uses only the full picture.
    pub mip: MipFilter,
    /// What lies beyond the left and right sides.
    pub wrap_u: Wrap,
    /// What lies beyond top and bottom.
    pub wrap_v: Wrap,
}

impl Default for Sampler {
    fn default() -> Self {
        Self {
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: MipFilter::Linear,
            wrap_u: Wrap::Repeat,
            wrap_v: Wrap::Repeat,
        }
    }
}

/// Filter within one mip level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Four texels, interpolated.
    Linear,
}

/// Filter between mip levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MipFilter {
    /// No mip levels.
    None,
    /// The nearest level.
    Nearest,
    /// Two levels, interpolated.
    Linear,
}

/// What lies beyond a texture's sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The last texel.
    Clamp,
    /// The picture again.
    Repeat,
    /// The picture again, mirrored.
    Mirror,
}
