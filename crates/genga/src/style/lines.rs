use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::{Color, Globs};
use crate::toml_file::list_with;

/// How lines are found and drawn.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Lines {
    /// Which method draws them.
    pub method: LineMethod,
    /// Picture height in pixels at which widths in pixels are meant; they scale with the
    /// picture's height, so that a picture looks the same at every size. > 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub reference_height: f32,
    /// What counts as a line.
    pub detect: Detect,
    /// The hull method's own settings.
    pub hull: Hull,
    /// The rim method's own settings.
    pub rim: Rim,
    /// At most four sets, drawn in order: later ones lie on top. A line belongs to every set
    /// that its type and object match. `hull` and `rim` use the last set's colour and width.
    #[serde(deserialize_with = "sets")]
    #[schemars(length(max = 4))]
    pub sets: Vec<LineSet>,
}

impl Default for Lines {
    fn default() -> Self {
        Self {
            method: LineMethod::Contour,
            reference_height: 1080.0,
            detect: Detect::default(),
            hull: Hull::default(),
            rim: Rim::default(),
            sets: vec![LineSet::default()],
        }
    }
}

/// The ways to draw outlines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LineMethod {
    /// No lines.
    None,
    /// Detected in image space, drawn from the mesh's edges as round-ended strokes.
    #[default]
    Contour,
    /// As Okuya et al. 2015 print it: a quad for every edge of every front face, masked.
    Reference,
    /// Inverted hull along smoothed normals.
    Hull,
    /// A ramp over E·N: Suzuki's thick-and-thin line.
    Rim,
    /// The detected mask itself (Saito and Takahashi 1990): two texels of the supersampled
    /// picture wide, fainter near its thresholds, whatever the sets' widths,
    /// objects and materials are.
    Image,
}

/// What a line is. A line may be of several types at once.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum LineType {
    /// A surface ends in front of something farther away or of the background.
    Silhouette,
    /// Two surfaces meet at an angle.
    Crease,
    /// Two objects meet.
    Object,
    /// Two materials meet.
    Material,
    /// An open end of a mesh.
    Border,
    /// Two user line ids meet.
    User,
}

/// Thresholds of detection (image space). A source that is off finds nothing.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Detect {
    /// Silhouettes: distance from the neighbour to the pixel's plane, in pixel footprints;
    /// 0 is off. Larger finds less.
    #[schemars(range(min = 0))]
    pub depth: f32,
    /// Creases: smallest angle between two normals in degrees; 0 is off.
    #[schemars(range(min = 0, max = 180))]
    pub crease_deg: f32,
    /// Lines between objects.
    pub objects: bool,
    /// Lines between materials.
    pub materials: bool,
    /// Lines between user line ids.
    pub user: bool,
}

impl Default for Detect {
    fn default() -> Self {
        Self { depth: 4.0, crease_deg: 40.0, objects: true, materials: true, user: true }
    }
}

/// The inverted hull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Hull {
    /// Width in metres instead of the last line set's width in pixels.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width_m: Option<f32>,
}

/// The thick-and-thin line: ink where the raw E·N is under a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rim {
    /// E·N below which there is ink, in [0, 1].
    #[schemars(range(min = 0, max = 1))]
    pub threshold: f32,
    /// Width in E·N of the soft edge; 0 for a hard (antialiased) one.
    #[schemars(range(min = 0, max = 1))]
    pub softness: f32,
}

impl Default for Rim {
    fn default() -> Self {
        Self { threshold: 0.3, softness: 0.0 }
    }
}

/// Name of a line set without a name.
pub(super) const DEFAULT_SET: &str = "lines";

/// Lines that are drawn alike.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LineSet {
    /// Name; a style that extends another changes the set of the same name.
    pub name: String,
    /// The types of line that it draws; empty for all.
    pub types: Vec<LineType>,
    /// Globs of object (node) names; empty for all.
    pub objects: Globs,
    /// Globs of material names; empty for all.
    pub materials: Globs,
    /// Colour of the ink.
    pub color: Color,
    /// Opacity in [0, 1], on top of the colour's alpha.
    #[schemars(range(min = 0, max = 1))]
    pub opacity: f32,
    /// Full width in pixels of a picture that is `reference_height` high, ≥ 0.
    #[schemars(range(min = 0))]
    pub width: f32,
}

impl Default for LineSet {
    fn default() -> Self {
        Self {
            name: DEFAULT_SET.to_owned(),
            types: Vec::new(),
            objects: Globs::default(),
            materials: Globs::default(),
            color: Color::BLACK,
            opacity: 1.0,
            width: 3.0,
        }
    }
}

impl LineSet {
    /// Whether it draws lines of that object and material, as far as their names go.
    #[must_use]
    pub fn matches(&self, object: &str, material: &str) -> bool {
        self.objects.matches(object) && self.materials.matches(material)
    }
}

/// Sets are told apart by their names.
fn sets<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<LineSet>, D::Error> {
    list_with(deserializer, |before: &[LineSet], set| {
        match before.iter().any(|other| other.name == set.name) {
            true => Err(format!("must have different names, but there are two '{}'", set.name)),
            false => Ok(()),
        }
    })
}
