use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::{Color, Globs, WidthBy, Wobble};
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
    /// How visible pieces become strokes (`contour`).
    pub strokes: Strokes,
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
            strokes: Strokes::default(),
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
    /// The texture coordinates of the first set tear.
    UvSeam,
}

/// What counts as a line. A source that is off finds nothing.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Detect {
    /// Size of the detection's own picture against the drawn one: a smaller one is faster.
    pub scale: DetectScale,
    /// Silhouettes by the distance of a surface from its neighbour's plane, in footprints of a
    /// pixel at `reference_height`; 0 is off. Larger finds less.
    #[schemars(range(min = 0))]
    pub depth: f32,
    /// Silhouettes by the second difference of the inverse distance, which is 0 on every plane, in
    /// the same unit; 0 is off. Larger finds less.
    #[schemars(range(min = 0))]
    pub laplacian: f32,
    /// Creases: smallest angle between two normals in degrees; 0 is off.
    #[schemars(range(min = 0, max = 180))]
    pub crease_deg: f32,
    /// Lines between objects.
    pub objects: bool,
    /// Lines between materials.
    pub materials: bool,
    /// Lines between user line ids (`_LINE_ID`, `override.lines.line_id`).
    pub user: bool,
    /// Lines along open ends of meshes.
    pub borders: bool,
    /// Lines where the texture coordinates of the first set tear. Only `contour` finds them.
    pub uv_seams: bool,
}

impl Default for Detect {
    fn default() -> Self {
        Self {
            scale: DetectScale::Full,
            depth: 0.0,
            laplacian: 4.0,
            crease_deg: 40.0,
            objects: true,
            materials: true,
            user: true,
            borders: true,
            uv_seams: false,
        }
    }
}

/// Pixels of the detection per pixel of the picture, along each axis (Okuya et al. 2015, section
/// 5.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum DetectScale {
    /// As many.
    #[default]
    #[serde(rename = "1")]
    Full,
    /// Two for three.
    #[serde(rename = "2/3")]
    TwoThirds,
    /// One for three.
    #[serde(rename = "1/3")]
    Third,
    /// One for six.
    #[serde(rename = "1/6")]
    Sixth,
}

impl DetectScale {
    /// The number.
    #[must_use]
    pub fn factor(self) -> f32 {
        match self {
            Self::Full => 1.0,
            Self::TwoThirds => 2.0 / 3.0,
            Self::Third => 1.0 / 3.0,
            Self::Sixth => 1.0 / 6.0,
        }
    }
}

/// How visible pieces of lines become strokes.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Strokes {
    /// Strokes shorter than this are not drawn, and those up to twice as long are thinner, in
    /// pixels at `reference_height`.
    #[schemars(range(min = 0, max = 1000))]
    pub min_length: f32,
    /// Gaps up to this length between two visible parts of one stroke are closed, and strokes that
    /// run out are drawn on to another one that goes on so near, in pixels at `reference_height`.
    /// What lies in front still covers them.
    #[schemars(range(min = 0, max = 1000))]
    pub gap: f32,
}

impl Default for Strokes {
    fn default() -> Self {
        Self { min_length: 4.0, gap: 6.0 }
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
    /// Whether it draws the visible or the hidden parts (`contour` only).
    pub parts: LineParts,
    /// Globs of materials that do not hide its lines, such as hair before eyebrows (`contour`
    /// only).
    pub through: Globs,
    /// Colour of the ink.
    pub color: Color,
    /// Where the colour comes from (`contour` only).
    pub color_by: LineColorBy,
    /// With `color_by = "base"`: factor on the surface's base colour, in [0, 1].
    #[schemars(range(min = 0, max = 1))]
    pub darken: f32,
    /// With `color_by = "light"`: the colour where light falls; `color` is the one in shade.
    pub lit_color: Color,
    /// Opacity in [0, 1], on top of the colour's alpha.
    #[schemars(range(min = 0, max = 1))]
    pub opacity: f32,
    /// Full width in pixels of a picture that is `reference_height` high, ≥ 0.
    #[schemars(range(min = 0))]
    pub width: f32,
    /// Full width in metres instead of `width` (`contour` only).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width_m: Option<f32>,
    /// What else the width depends on (`contour` only).
    pub width_by: WidthBy,
    /// Lengths of dash and gap in pixels at `reference_height` (`contour` only).
    #[serde(deserialize_with = "dash")]
    #[schemars(inner(range(min = 0)))]
    pub dash: Option<[f32; 2]>,
    /// An unsteady hand (`contour` only).
    pub wobble: Option<Wobble>,
}

/// Which parts of lines a set draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LineParts {
    /// Those that nothing covers.
    #[default]
    Visible,
    /// Those behind something.
    Hidden,
}

/// Where the colour of a line comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LineColorBy {
    /// `color`.
    #[default]
    Fixed,
    /// The surface's base colour times `darken`.
    Base,
    /// From `color` in shade to `lit_color` where light falls.
    Light,
}

impl Default for LineSet {
    fn default() -> Self {
        Self {
            name: DEFAULT_SET.to_owned(),
            types: Vec::new(),
            objects: Globs::default(),
            materials: Globs::default(),
            parts: LineParts::Visible,
            through: Globs::default(),
            color: Color::BLACK,
            color_by: LineColorBy::Fixed,
            darken: 0.4,
            lit_color: Color::WHITE,
            opacity: 1.0,
            width: 3.0,
            width_m: None,
            width_by: WidthBy::default(),
            dash: None,
            wobble: None,
        }
    }
}

/// A dash needs a length.
fn dash<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f32; 2]>, D::Error> {
    use serde::de::Error as _;
    match Option::<[f32; 2]>::deserialize(deserializer)? {
        Some([dash, gap]) if dash + gap < 1.0 => Err(D::Error::custom(format!(
            "must be at least 1 pixel together, not {dash} and {gap}"
        ))),
        other => Ok(other),
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
