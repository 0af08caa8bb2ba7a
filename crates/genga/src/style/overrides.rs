use std::sync::Arc;

use super::{BaseColor, Color, Ramp};
use crate::scene::Image;

/// What differs for a part of the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Override {
    /// Which part.
    pub select: Selector,
    /// How its surface is filled.
    pub paint: PaintOverride,
    /// How its lines are drawn.
    pub lines: LineOverride,
}

/// A part of the scene: everything that meets all the conditions given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selector {
    /// Globs of object (node) names; empty for all.
    pub objects: Vec<String>,
    /// Globs of material names; empty for all.
    pub materials: Vec<String>,
    /// Range of the vertex colour.
    pub vertex_color: Option<VertexColorRange>,
    /// A colour in an id texture.
    pub id_texture: Option<IdTexture>,
    /// Range of the base colour.
    pub base_color: Option<BaseColorRange>,
}

impl Selector {
    /// Whether it selects single pixels rather than whole objects or materials.
    #[must_use]
    pub fn is_per_pixel(&self) -> bool {
        self.vertex_color.is_some() || self.id_texture.is_some() || self.base_color.is_some()
    }
}

/// Inclusive ranges of COLOR_0's channels as the file has them, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexColorRange {
    /// Red.
    pub red: [f32; 2],
    /// Green.
    pub green: [f32; 2],
    /// Blue.
    pub blue: [f32; 2],
    /// Alpha.
    pub alpha: [f32; 2],
}

/// A colour in a picture that is laid on the first UV set, sampled without filtering.
#[derive(Clone, Debug, PartialEq)]
pub struct IdTexture {
    /// The picture.
    pub image: Arc<Image>,
    /// The colour looked for (alpha is ignored).
    pub color: Color,
    /// Largest difference in any channel, in [0, 1].
    pub tolerance: f32,
}

/// Inclusive ranges of the displayed (sRGB-encoded) base colour in hue, saturation, value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseColorRange {
    /// Hue in degrees; `[350, 20]` goes over 0.
    pub hue: [f32; 2],
    /// Saturation in [0, 1].
    pub saturation: [f32; 2],
    /// Value in [0, 1].
    pub value: [f32; 2],
}

/// Changes to [`super::Paint`]; what is `None` stays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PaintOverride {
    /// See [`super::Paint::base`].
    pub base: Option<BaseColor>,
    /// See [`super::Paint::ramp`].
    pub ramp: Option<Ramp>,
    /// See [`super::Paint::shade_bias`].
    pub shade_bias: Option<f32>,
}

/// Changes to lines; what is `None` stays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineOverride {
    /// Whether it has lines at all.
    pub visible: Option<bool>,
    /// Factor on every line's width, ≥ 0.
    pub width: Option<f32>,
    /// User line id: where two meet there is a line of type `user`. 0 is the default.
    pub line_id: Option<u16>,
    /// Colour of the ink instead of the line set's.
    pub color: Option<Color>,
}
