//! Ink on surfaces: hatching, tones of dots, spotted blacks.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::{Color, picture};
use crate::scene::Image;
use crate::toml_file::list_with;

/// Most stops of a tone curve.
const MAX_TONES: usize = 8;

/// Ink over a surface's colour, by tone (Suzuki 2004, section 3.2).
///
/// The ramp coordinate T gives a tone `Lum` through [`Self::tones`]; a pattern gives `S` in [0, 1],
/// 0 in the middle of a stroke and 1 halfway to the next one. Ink lies where
/// `F = S + 2 (Lum − ½)` is under the threshold: strokes are `clamp(threshold + 1 − 2 Lum, 0, 1)` of
/// their spacing wide, so they end in points towards the light and merge into blacks.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(from = "HatchFile")]
#[schemars(with = "HatchFile")]
pub struct Hatch {
    /// What is drawn.
    pub pattern: HatchPattern,
    /// What the pattern lies on.
    pub mapping: HatchMapping,
    /// Where strokes run to, with the mapping `surface`.
    pub direction: HatchDirection,
    /// Direction of the strokes in the mesh's space, with the direction `fixed`. Of any length but 0.
    pub axis: [f32; 3],
    /// Turns strokes, in degrees, counter-clockwise: from the horizontal of the picture (`screen`)
    /// or from the first texture coordinate (`uv`), or from the direction (`surface`).
    pub angle_deg: f32,
    /// Largest distance between strokes in pixels at the style's reference height; with `image`, the
    /// largest height of the picture.
    pub spacing: f32,
    /// Largest length of a stroke in pixels at the style's reference height; 0 for endless ones.
    pub length: f32,
    /// Ink lies where F is below it.
    pub threshold: f32,
    /// Tone over the ramp coordinate; straight between stops.
    pub tones: Vec<HatchTone>,
    /// How much the brightness of the base colour counts: the tone is multiplied by it in part. 0
    /// for not at all, 1 for all of it. Counts the model's colour, whatever `base` is.
    pub base_tone: f32,
    /// The ink; its alpha is the strength.
    pub color: Color,
    /// Tone under which a second direction is drawn (`cross` only).
    pub cross_below: f32,
    /// Angle of the second direction to the first one in degrees.
    pub cross_angle_deg: f32,
    /// How much strokes differ from each other in place, length, weight and bend: 0 for a ruler, 1
    /// for a quick hand.
    pub irregularity: f32,
    /// Another hand.
    pub seed: u32,
    /// Rows of dots on an inch of the page; only with `dots`.
    pub lines_per_inch: f32,
    /// Height of the printed picture in inches; only with `dots`.
    pub page_height_in: f32,
    /// Pattern of the user's, tiled: black is the middle of strokes, which run to its right; only with
    /// `image`. Its greys count by their order: each tone covers the part of the paper that it
    /// stands for. Strokes in black and white become thinner and wider, too.
    pub image: Option<Arc<Image>>,
}

/// A place of a tone curve.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HatchTone {
    /// Ramp coordinate T: 0 is turned away from the light, 1 faces it.
    #[schemars(range(min = 0, max = 1))]
    pub at: f32,
    /// Tone Lum: 0 is black, 1 is white.
    #[schemars(range(min = 0, max = 1))]
    pub lum: f32,
}

/// What ink is drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HatchPattern {
    /// Nothing.
    #[default]
    None,
    /// Strokes side by side.
    Strokes,
    /// Strokes, and in the dark a second direction over them.
    Cross,
    /// Solid black under a tone.
    Solid,
    /// Points of the pen.
    Stipple,
    /// Soft strokes with the paper's grain; graphite covers 0.9 of what ink would.
    Pencil,
    /// Screen tone: rows of round dots on the page, whatever the mapping.
    Dots,
    /// A picture.
    Image,
}

/// What a pattern lies on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HatchMapping {
    /// The surface at rest: strokes stick to it, follow its form, and keep their distance on the
    /// picture.
    #[default]
    Surface,
    /// Texture coordinates.
    Uv,
    /// The picture: strokes are parallel everywhere and do not move with the surface.
    Screen,
}

/// Which way strokes run over a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HatchDirection {
    /// Where the surface bends most: round limbs and folds.
    #[default]
    Curvature,
    /// Across the bones of the skin; where there is none, by curvature.
    Bone,
    /// From shade to light.
    Light,
    /// Along the vertex attribute `_HATCH`, else by curvature.
    Painted,
    /// Along `axis`.
    Fixed,
}

/// Starting values for a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HatchPreset {
    /// Even strokes round the form.
    #[default]
    Plain,
    /// Few fine strokes that leave most of it open.
    Skin,
    /// Cross-hatching down to black.
    Cloth,
    /// Hard blacks.
    Metal,
    /// Long dense strokes along locks.
    Hair,
    /// A few straight streaks on the picture.
    Glass,
}

/// As files have it: what is left out comes from the preset.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "Hatch")]
struct HatchFile {
    /// Starting values for a material; the other keys change them.
    preset: HatchPreset,
    /// What is drawn; "none" for no ink.
    pattern: Option<HatchPattern>,
    /// What the pattern lies on.
    mapping: Option<HatchMapping>,
    /// Which way strokes run with the mapping "surface".
    direction: Option<HatchDirection>,
    /// Direction of the strokes in the mesh's space, with the direction "fixed".
    #[serde(deserialize_with = "axis")]
    axis: Option<[f32; 3]>,
    /// Turns the strokes, in degrees.
    #[schemars(range(min = -180, max = 180))]
    angle_deg: Option<f32>,
    /// Largest distance between strokes in pixels at the reference height; with the pattern "image",
    /// the largest height of the picture.
    #[schemars(range(min = 1, max = 1000))]
    spacing: Option<f32>,
    /// Largest length of a stroke in pixels at the reference height; 0 for endless ones.
    #[schemars(range(min = 0, max = 10000))]
    length: Option<f32>,
    /// Ink lies where F = S + 2 (Lum − ½) is below it.
    #[schemars(range(min = -1, max = 2))]
    threshold: Option<f32>,
    /// 1 to 8 stops with rising `at`: the tone over the ramp coordinate, straight between them.
    #[serde(deserialize_with = "tones")]
    #[schemars(length(min = 1, max = 8))]
    tones: Option<Vec<HatchTone>>,
    /// How much the brightness of the model's colour darkens the tone: 0 for not at all.
    #[schemars(range(min = 0, max = 1))]
    base_tone: Option<f32>,
    /// The ink; its alpha is the strength.
    color: Option<Color>,
    /// Tone under which a second direction is drawn, with the pattern "cross".
    #[schemars(range(min = 0, max = 1))]
    cross_below: Option<f32>,
    /// Angle of the second direction to the first one in degrees.
    #[schemars(range(min = -90, max = 90))]
    cross_angle_deg: Option<f32>,
    /// How much strokes differ from each other: 0 for a ruler, 1 for a quick hand.
    #[schemars(range(min = 0, max = 1))]
    irregularity: Option<f32>,
    /// Another number, another hand.
    seed: Option<u32>,
    /// Rows of dots on an inch of the page, with the pattern "dots".
    #[schemars(range(min = 1, max = 300))]
    lines_per_inch: Option<f32>,
    /// Height of the printed picture in inches, with the pattern "dots".
    #[schemars(range(min = 0.1, max = 1000))]
    page_height_in: Option<f32>,
    /// A picture that is tiled, with the pattern "image": black is the middle of strokes.
    #[serde(deserialize_with = "picture::load_some")]
    #[schemars(with = "Option<String>")]
    image: Option<Arc<Image>>,
}

impl Hatch {
    /// Starting values for a material.
    #[must_use]
    pub fn preset(preset: HatchPreset) -> Self {
        let tone = |at, lum| HatchTone { at, lum };
        let plain = Self {
            pattern: HatchPattern::None,
            mapping: HatchMapping::Surface,
            direction: HatchDirection::Curvature,
            axis: [0.0, 1.0, 0.0],
            angle_deg: 0.0,
            spacing: 8.0,
            length: 110.0,
            threshold: 0.5,
            tones: vec![tone(0.2, 0.2), tone(0.62, 0.76)],
            base_tone: 0.0,
            color: Color::BLACK,
            cross_below: 0.45,
            cross_angle_deg: 55.0,
            irregularity: 0.5,
            seed: 0,
            lines_per_inch: 27.5,
            page_height_in: 10.0,
            image: None,
        };
        match preset {
            HatchPreset::Plain => plain,
            HatchPreset::Skin => Self {
                pattern: HatchPattern::Strokes,
                spacing: 8.0,
                length: 90.0,
                tones: vec![tone(0.1, 0.3), tone(0.5, 0.76)],
                ..plain
            },
            HatchPreset::Cloth => Self {
                pattern: HatchPattern::Cross,
                spacing: 7.0,
                tones: vec![tone(0.15, 0.22), tone(0.62, 0.76)],
                ..plain
            },
            HatchPreset::Metal => Self {
                pattern: HatchPattern::Solid,
                tones: vec![tone(0.0, 0.0), tone(1.0, 1.0)],
                threshold: 0.2,
                ..plain
            },
            HatchPreset::Hair => Self {
                pattern: HatchPattern::Strokes,
                angle_deg: 90.0,
                spacing: 6.0,
                length: 200.0,
                tones: vec![tone(0.25, 0.2), tone(0.7, 0.76)],
                irregularity: 0.7,
                ..plain
            },
            HatchPreset::Glass => Self {
                pattern: HatchPattern::Strokes,
                mapping: HatchMapping::Screen,
                angle_deg: 55.0,
                spacing: 16.0,
                length: 260.0,
                tones: vec![tone(0.2, 0.55), tone(0.7, 0.7), tone(0.75, 0.76)],
                irregularity: 0.9,
                ..plain
            },
        }
    }
}

impl Default for Hatch {
    fn default() -> Self {
        Self::preset(HatchPreset::Plain)
    }
}

impl From<HatchFile> for Hatch {
    fn from(file: HatchFile) -> Self {
        let from = Self::preset(file.preset);
        Self {
            pattern: file.pattern.unwrap_or(from.pattern),
            mapping: file.mapping.unwrap_or(from.mapping),
            direction: file.direction.unwrap_or(from.direction),
            axis: file.axis.unwrap_or(from.axis),
            angle_deg: file.angle_deg.unwrap_or(from.angle_deg),
            spacing: file.spacing.unwrap_or(from.spacing),
            length: file.length.unwrap_or(from.length),
            threshold: file.threshold.unwrap_or(from.threshold),
            tones: file.tones.unwrap_or(from.tones),
            base_tone: file.base_tone.unwrap_or(from.base_tone),
            color: file.color.unwrap_or(from.color),
            cross_below: file.cross_below.unwrap_or(from.cross_below),
            cross_angle_deg: file.cross_angle_deg.unwrap_or(from.cross_angle_deg),
            irregularity: file.irregularity.unwrap_or(from.irregularity),
            seed: file.seed.unwrap_or(from.seed),
            lines_per_inch: file.lines_per_inch.unwrap_or(from.lines_per_inch),
            page_height_in: file.page_height_in.unwrap_or(from.page_height_in),
            image: file.image.or(from.image),
        }
    }
}

/// Stops rise.
fn tones<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<HatchTone>>, D::Error> {
    let list = list_with(deserializer, |before: &[HatchTone], tone| match before.last() {
        Some(_) if before.len() == MAX_TONES => Err(format!("must have at most {MAX_TONES} stops")),
        Some(last) if tone.at <= last.at => Err(format!(
            "must be in rising order, but one at {} follows one at {}",
            tone.at, last.at
        )),
        _ => Ok(()),
    })?;
    Ok(Some(list))
}

fn axis<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f32; 3]>, D::Error> {
    let axis = <[f32; 3]>::deserialize(deserializer)?;
    let length = glam::Vec3::from(axis).length();
    if length.is_finite() && length > 1e-6 {
        return Ok(Some(axis));
    }
    Err(D::Error::custom("must be a direction: three numbers that are not all 0"))
}
