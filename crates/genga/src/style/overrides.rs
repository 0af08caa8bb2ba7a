use std::sync::Arc;

use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use super::{
    BaseColor, Color, Globs, Hatch, Ramp, RimLight, ShadeMap, ShadowOverride, Sheen, Specular,
    picture,
};
use crate::scene::Image;

/// What differs for a part of the scene.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Override {
    /// Which part.
    pub select: Selector,
    /// How its surface is filled.
    pub paint: PaintOverride,
    /// How its lines are drawn.
    pub lines: LineOverride,
}

/// A part of the scene: everything that meets all the conditions given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Selector {
    /// Globs of object (node) names; empty for all.
    pub objects: Globs,
    /// Globs of material names; empty for all.
    pub materials: Globs,
    /// Range of the vertex colour.
    pub vertex_color: Option<VertexColorRange>,
    /// A colour in an id texture.
    pub id_texture: Option<IdTexture>,
    /// Range of the base colour.
    pub base_color: Option<BaseColorRange>,
}

impl Selector {
    /// Whether it selects that object and material, as far as their names go. Where
    /// [`Self::is_per_pixel`], the pixels must still meet the other conditions.
    #[must_use]
    pub fn matches(&self, object: &str, material: &str) -> bool {
        self.objects.matches(object) && self.materials.matches(material)
    }

    /// Whether it selects single pixels rather than whole objects or materials.
    #[must_use]
    pub fn is_per_pixel(&self) -> bool {
        self.vertex_color.is_some() || self.id_texture.is_some() || self.base_color.is_some()
    }
}

/// Inclusive ranges of COLOR_0's channels as the file has them, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VertexColorRange {
    /// Red.
    #[serde(deserialize_with = "rising")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub red: [f32; 2],
    /// Green.
    #[serde(deserialize_with = "rising")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub green: [f32; 2],
    /// Blue.
    #[serde(deserialize_with = "rising")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub blue: [f32; 2],
    /// Alpha.
    #[serde(deserialize_with = "rising")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub alpha: [f32; 2],
}

/// A colour in a picture that is laid on the first UV set, sampled without filtering.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IdTexture {
    /// The picture.
    #[serde(deserialize_with = "picture::load")]
    #[schemars(with = "String")]
    pub image: Arc<Image>,
    /// The colour looked for (alpha is ignored).
    pub color: Color,
    /// Largest difference in any channel, in [0, 1].
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub tolerance: f32,
}

/// Inclusive ranges of the displayed (sRGB-encoded) base colour in hue, saturation, value.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BaseColorRange {
    /// Hue in degrees; `[350, 20]` goes over 0. Greys have the hue 0.
    #[schemars(inner(range(min = 0, max = 360)))]
    pub hue: [f32; 2],
    /// Saturation in [0, 1].
    #[serde(deserialize_with = "rising")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub saturation: [f32; 2],
    /// Value in [0, 1].
    #[serde(deserialize_with = "rising")]
    #[schemars(inner(range(min = 0, max = 1)))]
    pub value: [f32; 2],
}

/// Changes to [`super::Paint`]; what is `None` stays.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PaintOverride {
    /// Instead of the style's `paint.base`.
    pub base: Option<BaseColor>,
    /// Instead of the style's `paint.ramp`.
    pub ramp: Option<Ramp>,
    /// Instead of the style's `paint.shade_bias`.
    #[schemars(range(min = -1, max = 1))]
    pub shade_bias: Option<f32>,
    /// Instead of the style's `paint.shade_map`; a strength of 0 is none.
    pub shade_map: Option<ShadeMap>,
    /// Cast shadows.
    pub shadow: ShadowOverride,
    /// Instead of the style's `paint.hatch`, all of it.
    pub hatch: Option<Hatch>,
    /// Instead of the style's `paint.specular`; a strength of 0 is none.
    pub specular: Option<Specular>,
    /// Instead of the style's `paint.rim_light`; a strength of 0 is none.
    pub rim_light: Option<RimLight>,
    /// Instead of the style's `paint.sheen`; a strength of 0 is none.
    pub sheen: Option<Sheen>,
}

/// Changes to lines; what is `None` stays.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LineOverride {
    /// Whether it has lines at all.
    pub visible: Option<bool>,
    /// Factor on every line's width, ≥ 0.
    #[schemars(range(min = 0))]
    pub width: Option<f32>,
    /// User line id: where two meet there is a line of type `user`. 0 is the default.
    pub line_id: Option<u16>,
}

impl Default for VertexColorRange {
    fn default() -> Self {
        let all = [0.0, 1.0];
        Self { red: all, green: all, blue: all, alpha: all }
    }
}

impl BaseColorRange {
    /// Whether a colour lies within all three ranges. Greys have the hue 0.
    #[must_use]
    pub fn contains(&self, color: Color) -> bool {
        let Color { r, g, b, a: _ } = color;
        let value = r.max(g).max(b);
        let span = value - r.min(g).min(b);
        let sixths = match span {
            span if span <= 0.0 => 0.0,
            span if value == r => ((g - b) / span).rem_euclid(6.0),
            span if value == g => 2.0 + (b - r) / span,
            span => 4.0 + (r - g) / span,
        };
        let saturation = if value > 0.0 { span / value } else { 0.0 };
        let within = |[low, high]: [f32; 2], x: f32| low <= x && x <= high;
        let [first, last] = self.hue;
        let hue = 60.0 * sixths;
        let hue_within =
            if first <= last { within(self.hue, hue) } else { hue >= first || hue <= last };
        hue_within && within(self.saturation, saturation) && within(self.value, value)
    }
}

impl Default for BaseColorRange {
    fn default() -> Self {
        Self { hue: [0.0, 360.0], saturation: [0.0, 1.0], value: [0.0, 1.0] }
    }
}

/// A range whose ends are in order.
fn rising<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f32; 2], D::Error> {
    let [low, high] = <[f32; 2]>::deserialize(deserializer)?;
    if low <= high {
        return Ok([low, high]);
    }
    Err(D::Error::custom(format!(
        "must go from a smaller to a larger number, not from {low} to {high}"
    )))
}
