use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Color, Dots, Hatch, RimLight, ShadeMap, Shadow, Sheen, Specular, picture};
use crate::scene::Image;
use crate::toml_file::list_with;

/// What stands behind everything: one colour, or a gradient from top to bottom.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Background {
    /// Colour at the top.
    pub color: Color,
    /// Colour at the bottom; the same as at the top by default.
    pub bottom: Option<Color>,
}

impl Default for Background {
    fn default() -> Self {
        Self { color: Color::WHITE, bottom: None }
    }
}

/// The directional light that a style brings for scenes without lights.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StyleLight {
    /// Where the light comes from, in degrees: 0 from the front, positive from the right.
    #[schemars(range(min = -360, max = 360))]
    pub azimuth_deg: f32,
    /// Where the light comes from, in degrees: positive from above.
    #[schemars(range(min = -90, max = 90))]
    pub elevation_deg: f32,
    /// What the angles turn with.
    pub pinned_to: PinnedTo,
    /// Whether it is used even where the model or scene has lights of its own.
    pub replace_model_lights: bool,
}

impl Default for StyleLight {
    fn default() -> Self {
        Self {
            azimuth_deg: -35.0,
            elevation_deg: 40.0,
            pinned_to: PinnedTo::Camera,
            replace_model_lights: false,
        }
    }
}

/// What a light turns with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PinnedTo {
    /// The camera: the same side is lit from everywhere.
    #[default]
    Camera,
    /// The world: `front` is +Z, `right` is +X.
    World,
}

/// How surfaces are filled.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Paint {
    /// Where the colour comes from before the ramp.
    pub base: BaseColor,
    /// Which values are multiplied and added.
    pub blend_space: BlendSpace,
    /// Tones from shade to light.
    pub ramp: Ramp,
    /// Added to the ramp coordinate T: positive keeps a surface lighter. In [−1, 1].
    #[schemars(range(min = -1, max = 1))]
    pub shade_bias: f32,
    /// Shade bias by vertex or texel; none by default.
    pub shade_map: Option<ShadeMap>,
    /// How much the colours of lights show on what they light: 1 wholly, 0 not at all, so that
    /// only their brightness counts. The step from the ramp's darkest tone to a lighter one takes on
    /// the light's colour: that of the light that gives most there, on a `smooth` ramp the mean.
    #[schemars(range(min = 0, max = 1))]
    pub light_color: f32,
    /// Cast shadows.
    pub shadow: Shadow,
    /// Ink over the colour: hatching, screen tone, blacks.
    pub hatch: Hatch,
    /// A comic highlight; none by default.
    pub specular: Option<Specular>,
    /// A rim of light from behind; none by default.
    pub rim_light: Option<RimLight>,
    /// Straight streaks; none by default.
    pub sheen: Option<Sheen>,
    /// Surfaces take the nearest of these colours after the ramp; empty for all colours.
    #[schemars(length(max = 16))]
    pub palette: Vec<Color>,
    /// Colours as dots of the old four-colour print; not by default.
    pub dots: Option<Dots>,
}

impl Default for Paint {
    fn default() -> Self {
        Self {
            base: BaseColor::Model,
            blend_space: BlendSpace::Display,
            ramp: Ramp::default(),
            shade_bias: 0.0,
            shade_map: None,
            light_color: 1.0,
            shadow: Shadow::default(),
            hatch: Hatch::default(),
            specular: None,
            rim_light: None,
            sheen: None,
            palette: Vec::new(),
            dots: None,
        }
    }
}

/// Where a surface's colour comes from. In files: `"model"`, `"none"`, `"paper"` or a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BaseColor {
    /// The model's base colour: factor × texture × vertex colour.
    #[default]
    Model,
    /// Nothing is painted; the background shows. Surfaces still hide what is behind them.
    None,
    /// The background's colour: bare paper that ink and shade lie on.
    Paper,
    /// One colour.
    Fixed(Color),
}

/// Which values a style multiplies, adds and grades.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BlendSpace {
    /// sRGB-encoded values, as painters and the papers do.
    #[default]
    Display,
    /// Linear light.
    Linear,
}

/// A one-dimensional gradient over `T = (N·L + 1)/2` (Suzuki 2004; one ramp over the sum of all
/// lights): 0 is turned away from the light, 0.5 is the terminator, 1 faces the light.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ramp {
    /// 1 to 8 stops with rising `at`; the first one is at 0. Not used with an `image`.
    #[serde(deserialize_with = "stops")]
    #[schemars(length(min = 1, max = 8))]
    pub stops: Vec<RampStop>,
    /// False: each tone reaches from its `at` to the next stop's (cel). True: colours are
    /// interpolated between stops (gradient).
    pub smooth: bool,
    /// A picture whose middle row is the ramp, left dark, right light; multiplied.
    #[serde(deserialize_with = "picture::load_some")]
    #[schemars(with = "Option<String>")]
    pub image: Option<Arc<Image>>,
    /// Factor on the sum of lights before it is clamped to [−1, 1].
    #[schemars(range(min = 0))]
    pub gain: f32,
}

impl Default for Ramp {
    fn default() -> Self {
        Self {
            stops: vec![RampStop {
                at: 0.0,
                color: Color::WHITE,
                softness: 0.0,
                blend: ToneBlend::Multiply,
            }],
            smooth: false,
            image: None,
            gain: 1.0,
        }
    }
}

/// One tone of a ramp.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RampStop {
    /// Where on the ramp it begins, in [0, 1].
    #[schemars(range(min = 0, max = 1))]
    pub at: f32,
    /// The tone; its alpha is the strength of the blend.
    pub color: Color,
    /// Width in T over which it blends with the tone before; 0 for a hard (antialiased) edge.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub softness: f32,
    /// How the tone meets the base colour.
    #[serde(default)]
    pub blend: ToneBlend,
}

/// How a tone meets the base colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ToneBlend {
    /// Base colour × tone.
    #[default]
    Multiply,
    /// The tone instead of the base colour.
    Replace,
}

/// Stops rise from 0.
fn stops<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RampStop>, D::Error> {
    list_with(deserializer, |before: &[RampStop], stop| match before.last() {
        None if stop.at != 0.0 => Err(format!("must begin with a stop at 0, not at {}", stop.at)),
        Some(last) if stop.at <= last.at => Err(format!(
            "must be in rising order, but one at {} follows one at {}",
            stop.at, last.at
        )),
        _ => Ok(()),
    })
}

impl<'de> Deserialize<'de> for BaseColor {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "model" => Ok(Self::Model),
            "none" => Ok(Self::None),
            "paper" => Ok(Self::Paper),
            text => text.parse().map(Self::Fixed).map_err(|_| {
                serde::de::Error::custom(
                    "must be \"model\", \"none\", \"paper\" or a colour such as \"#ff8800\"",
                )
            }),
        }
    }
}

impl Serialize for BaseColor {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Model => serializer.serialize_str("model"),
            Self::None => serializer.serialize_str("none"),
            Self::Paper => serializer.serialize_str("paper"),
            Self::Fixed(color) => color.serialize(serializer),
        }
    }
}

impl JsonSchema for BaseColor {
    fn schema_name() -> Cow<'static, str> {
        "BaseColor".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Where a surface's colour comes from: \"model\" (its own colours), \"none\" (the background shows), \"paper\" (the background's colour) or one colour such as \"#ff8800\".",
            "type": "string",
            "pattern": "^(model|none|paper|#([0-9a-fA-F]{3,4}|[0-9a-fA-F]{6}|[0-9a-fA-F]{8}))$",
        })
    }
}
