use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A comic highlight: Blinn–Phong's `I = (N·H)^n`, cut off at a threshold (Suzuki 2004, section
/// 3.3.3), from the strongest light. H may be changed as in Anjyo and Hiramitsu 2003: u is to the
/// right and v upwards on the surface as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Specular {
    /// Opacity, or the part that is added; 0 for none.
    #[schemars(range(min = 0, max = 1))]
    pub strength: f32,
    /// Its colour; not used for `paper`.
    pub color: Color,
    /// How it meets the colours below.
    pub blend: ShineBlend,
    /// Even, or brighter towards its middle.
    pub form: SpecularForm,
    /// The exponent n: larger makes a smaller highlight.
    #[schemars(range(min = 1, max = 10000))]
    pub exponent: f32,
    /// The threshold b on I, in [0, 1): larger makes a smaller highlight.
    #[schemars(range(min = 0, max = 0.999))]
    pub threshold: f32,
    /// `gradient`: the exponent m in `((I − b)(5b/2 + I)^m)/2`; larger makes a harder one.
    #[schemars(range(min = 0, max = 16))]
    pub gradient: f32,
    /// H is moved by `α du + β dv`.
    #[schemars(inner(range(min = -2, max = 2)))]
    pub translate: [f32; 2],
    /// H is scaled by 1 − σ along u and v: 0 changes nothing, 0.9 makes it ten times as long.
    #[schemars(inner(range(min = -10, max = 0.99)))]
    pub scale: [f32; 2],
    /// Degrees by which the axes of scale, split and square are turned.
    #[schemars(range(min = -360, max = 360))]
    pub rotate_deg: f32,
    /// H is split by γ1 along u and γ2 along v.
    #[schemars(inner(range(min = 0, max = 2)))]
    pub split: [f32; 2],
    /// From 0 (round) to 1 (a square).
    #[schemars(range(min = 0, max = 1))]
    pub square: f32,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            strength: 1.0,
            color: Color::WHITE,
            blend: ShineBlend::Add,
            form: SpecularForm::Threshold,
            exponent: 40.0,
            threshold: 0.5,
            gradient: 5.0,
            translate: [0.0; 2],
            scale: [0.0; 2],
            rotate_deg: 0.0,
            split: [0.0; 2],
            square: 0.0,
        }
    }
}

/// How bright a comic highlight is inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpecularForm {
    /// Even, with a crisp edge.
    #[default]
    Threshold,
    /// `I_a = ((I − b)(5b/2 + I)^m)/2`, at most 1: none at its edge, brightest in its middle.
    Gradient,
}

/// How a highlight meets the colours below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ShineBlend {
    /// Its colour is added.
    #[default]
    Add,
    /// Its colour instead of them.
    Replace,
    /// Bare paper: the background's colour instead of them.
    Paper,
}

/// A light behind the object as the camera sees it, which rims it: a ramp from black to white over
/// `(L'·N + 1)/2` (Suzuki 2004, section 3.3.3).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RimLight {
    /// Opacity, or the part that is added; 0 for none.
    #[schemars(range(min = 0, max = 1))]
    pub strength: f32,
    /// Its colour; not used for `paper`.
    pub color: Color,
    /// How it meets the colours below.
    pub blend: ShineBlend,
    /// Where it comes from, in degrees from behind: positive from the right of the picture.
    #[schemars(range(min = -180, max = 180))]
    pub azimuth_deg: f32,
    /// Where it comes from, in degrees: positive from above.
    #[schemars(range(min = -90, max = 90))]
    pub elevation_deg: f32,
    /// Where the ramp turns from black to white, in [0, 1]: larger makes a thinner rim.
    #[schemars(range(min = 0, max = 1))]
    pub threshold: f32,
    /// Width of the turn; 0 for a hard (antialiased) edge.
    #[schemars(range(min = 0, max = 1))]
    pub softness: f32,
}

impl Default for RimLight {
    fn default() -> Self {
        Self {
            strength: 1.0,
            color: Color::WHITE,
            blend: ShineBlend::Add,
            azimuth_deg: 40.0,
            elevation_deg: 30.0,
            threshold: 0.72,
            softness: 0.0,
        }
    }
}

/// Linear sheen: parallel, straight streaks across a surface, as comics draw glass and chrome. They
/// stand still in the world and are straight from every view: things move below them.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Sheen {
    /// Opacity, or the part that is added; 0 for none.
    #[schemars(range(min = 0, max = 1))]
    pub strength: f32,
    /// Their colour; not used for `paper`.
    pub color: Color,
    /// How they meet the colours below.
    pub blend: ShineBlend,
    /// Degrees by which they lean to the right on the picture.
    #[schemars(range(min = -180, max = 180))]
    pub lean_deg: f32,
    /// Metres from one streak to the next.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing_m: f32,
    /// Width of a streak as a part of the spacing.
    #[schemars(range(min = 0, max = 1))]
    pub width: f32,
    /// Width of the thinner streak beside it; 0 for none.
    #[schemars(range(min = 0, max = 1))]
    pub second: f32,
    /// Gap between both, as a part of the spacing.
    #[schemars(range(min = 0, max = 1))]
    pub gap: f32,
    /// Metres by which they are moved.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub offset_m: f32,
}

impl Default for Sheen {
    fn default() -> Self {
        Self {
            strength: 0.6,
            color: Color::WHITE,
            blend: ShineBlend::Add,
            lean_deg: 30.0,
            spacing_m: 0.5,
            width: 0.2,
            second: 0.06,
            gap: 0.07,
            offset_m: 0.0,
        }
    }
}

/// Dots of the old four-colour print: cyan, magenta and yellow screens over white paper, whose dots
/// have the area that the colour asks for. Ink and lines stay solid.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Dots {
    /// Pixels from dot to dot in a picture of the lines' reference height.
    #[schemars(range(min = 2, max = 200))]
    pub spacing: f32,
    /// Degrees by which the screens of cyan, magenta and yellow are turned.
    #[schemars(inner(range(min = -180, max = 180)))]
    pub angles_deg: [f32; 3],
}

impl Default for Dots {
    fn default() -> Self {
        Self { spacing: 7.0, angles_deg: [15.0, 75.0, 0.0] }
    }
}
