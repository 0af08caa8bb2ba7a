use glam::{Quat, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer};

use super::Located;
use crate::scene::{
    AngleKey, BuiltInDrawing, FreeKey, FreePlacement, HighlightBlend, HighlightTone,
    KeyInterpolation, Moment, PanoramaPlacement, Placement,
};
use crate::style::{Color, Globs};
use crate::toml_file::list_with;

/// An anime highlight: a drawing on surfaces, placed by keys for light and view.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Highlight")]
pub struct HighlightEntry {
    /// Name for messages.
    #[serde(default)]
    pub name: String,
    /// "disc", "band", "angel-ring", "window", "star", "heart", "double-dot", "streak", or a
    /// picture's path relative to this file: its alpha, or without transparency its brightness,
    /// from one half on.
    pub drawing: Located<String>,
    /// Name of the model that it belongs to; needed if there are several.
    pub model: Option<Located<String>>,
    /// Name of the node or bone in whose frame everything below is; the model itself by default.
    pub node: Option<Located<String>>,
    /// Globs of the objects that it lies on; all by default.
    #[serde(default)]
    pub objects: Globs,
    /// Globs of the materials that it lies on; all by default.
    #[serde(default)]
    pub materials: Globs,
    /// The smooth shape whose normals stand in for the surface's; a sphere that is fitted to the
    /// surfaces by default.
    #[serde(default)]
    pub proxy: Located<ProxyEntry>,
    /// Part of the proxy's normals in the blend with the surface's own.
    #[serde(default = "one")]
    #[schemars(range(min = 0, max = 1))]
    pub gamma: f32,
    /// Width and height in degrees of the reflected direction, of which a distant eye sees half.
    #[serde(default = "size")]
    #[schemars(inner(range(min = 0.01, max = 350)))]
    pub size_deg: [f32; 2],
    /// Turn in degrees, counter-clockwise.
    #[serde(default)]
    #[schemars(range(min = -36000, max = 36000))]
    pub angle_deg: f32,
    /// Its colour; alpha is its strength.
    #[serde(default = "white")]
    pub color: Color,
    /// How it goes over the paint.
    #[serde(default)]
    pub blend: HighlightBlend,
    /// The tones of the ramp that it shows in.
    #[serde(default)]
    pub tone: HighlightTone,
    /// Picture that says where it shows, by the base colour's texture coordinates.
    pub mask: Option<Located<String>>,
    /// Name of the light that it belongs to; the strongest one by default.
    pub light: Option<Located<String>>,
    /// The drawing moves on a panorama of yaw and pitch.
    pub panorama: Option<PanoramaEntry>,
    /// Direction where the drawing is upright along the node's +Y; +Z by default. Without
    /// 'panorama' only.
    pub front: Option<[f32; 3]>,
    /// The drawing is level everywhere round the node's Y axis, as a ring on hair is, instead of
    /// turned the shortest way from 'front'.
    #[serde(default)]
    pub level: bool,
    /// Keys for directions of light and view; without any the drawing stands at the light's mirror
    /// direction.
    #[serde(default, deserialize_with = "keys")]
    #[schemars(length(max = 1000))]
    pub key: Vec<FreeKeyEntry>,
}

/// Yaw turns to the right, pitch down; both are angles of light less view, from the node's +Z.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Panorama")]
pub struct PanoramaEntry {
    /// Lowest and highest pitch of the drawing's middle.
    #[serde(default = "limits")]
    #[schemars(inner(range(min = -90, max = 90)))]
    pub limits_deg: [f32; 2],
    /// Yaw of the drawing's middle over the relative yaw, which is periodic.
    #[serde(default, deserialize_with = "yaw_keys")]
    #[schemars(length(max = 1000))]
    pub yaw_key: Vec<AngleKeyEntry>,
    /// Pitch of the drawing's middle over the relative pitch.
    #[serde(default, deserialize_with = "pitch_keys")]
    #[schemars(length(max = 1000))]
    pub pitch_key: Vec<AngleKeyEntry>,
}

/// A place on one axis of the panorama.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "AngleKey")]
pub struct AngleKeyEntry {
    /// Angle of the light less that of the view.
    #[schemars(range(min = -180, max = 180))]
    pub at_deg: f32,
    /// Where the drawing's middle stands.
    #[schemars(range(min = -720, max = 720))]
    pub place_deg: f32,
    /// How it goes on to the next key.
    #[serde(default)]
    pub interpolation: KeyInterpolation,
}

/// What the drawing is like for one light and view.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "HighlightKey")]
pub struct FreeKeyEntry {
    /// Where the light is, in the node's frame: degrees to the right of +Z, and above the horizon.
    #[schemars(inner(range(min = -36000, max = 36000)))]
    pub light_deg: [f32; 2],
    /// Where the eye is, in the same way.
    #[schemars(inner(range(min = -36000, max = 36000)))]
    pub view_deg: [f32; 2],
    /// How far the drawing is right of the light's mirror direction, and above it.
    #[serde(default)]
    #[schemars(inner(range(min = -180, max = 180)))]
    pub offset_deg: [f32; 2],
    /// Turn in degrees, counter-clockwise.
    #[serde(default)]
    #[schemars(range(min = -36000, max = 36000))]
    pub rotation_deg: f32,
    /// Factors on width and height.
    #[serde(default = "ones")]
    #[schemars(inner(range(min = 0.001, max = 1000)))]
    pub scale: [f32; 2],
    /// How far the halves are moved apart along both axes; 1 is half of the drawing's side.
    #[serde(default)]
    #[schemars(inner(range(min = -10, max = 10)))]
    pub split: [f32; 2],
    /// How square it is.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub square: f32,
    /// How it goes on towards the other keys.
    #[serde(default)]
    pub interpolation: KeyInterpolation,
    /// Largest angle of the light to that of the key at which the drawing shows; it shows where any
    /// key allows it.
    #[schemars(range(min = 0, max = 180))]
    pub light_range_deg: Option<f32>,
    /// Largest angle of the view to that of the key at which the drawing shows.
    #[schemars(range(min = 0, max = 180))]
    pub view_range_deg: Option<f32>,
}

/// Which shape stands in for a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "ProxyType")]
pub enum ProxyKind {
    /// Round 'center'.
    #[default]
    Sphere,
    /// Round 'center', with 'radii' and 'rotation_deg'.
    Ellipsoid,
    /// Round the line from 'from' to 'to' or 'to_node'.
    Capsule,
    /// With 'normal'.
    Plane,
    /// That of the node 'mesh', seen from 'center'.
    Mesh,
}

/// The smooth shape whose normals stand in for a surface's, in the highlight's node.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Proxy")]
pub struct ProxyEntry {
    /// The shape; a sphere by default.
    #[serde(default)]
    pub r#type: ProxyKind,
    /// Its middle in metres; the node's origin by default, but the sphere of a highlight is fitted to
    /// its surfaces at rest.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub center: Option<[f32; 3]>,
    /// Sphere: radius in metres of the ball that the drawing is seen on, so that locks which stand
    /// off it do not move the drawing; fitted to the surfaces at rest by default. 0 for normals from
    /// the centre at the surface itself, as in the paper on anime highlights.
    #[schemars(range(min = 0, max = 1e6))]
    pub radius: Option<f32>,
    /// Ellipsoid: half axes, of which only the ratios count.
    #[schemars(inner(range(min = 1e-6, max = 1e6)))]
    pub radii: Option<[f32; 3]>,
    /// Ellipsoid: rotations in degrees about the node's x, then y, then z axis.
    #[schemars(inner(range(min = -36000, max = 36000)))]
    pub rotation_deg: Option<[f32; 3]>,
    /// Capsule: one end in metres; the node's origin by default.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub from: Option<[f32; 3]>,
    /// Capsule: the other end.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub to: Option<[f32; 3]>,
    /// Capsule: the node at whose origin the other end is, such as the bone's child.
    pub to_node: Option<Located<String>>,
    /// Plane: its normal.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub normal: Option<[f32; 3]>,
    /// Mesh: the node whose mesh it is, which may be hidden.
    pub mesh: Option<Located<String>>,
}

fn one() -> f32 {
    1.0
}

fn ones() -> [f32; 2] {
    [1.0; 2]
}

fn size() -> [f32; 2] {
    [40.0; 2]
}

fn white() -> Color {
    Color::WHITE
}

fn limits() -> [f32; 2] {
    [-90.0, 90.0]
}

fn keys<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<FreeKeyEntry>, D::Error> {
    list_with(deserializer, |before: &[FreeKeyEntry], key: &FreeKeyEntry| {
        let mut placement = FreePlacement::default();
        placement.keys.extend(before.iter().map(FreeKeyEntry::key));
        match placement.key_at(&key.moment()) {
            Some(index) => Err(format!(
                "must not have the same 'light_deg' and 'view_deg' as key {} of this highlight",
                index + 1
            )),
            None => Ok(()),
        }
    })
}

fn yaw_keys<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<AngleKeyEntry>, D::Error> {
    list_with(deserializer, |before, key| angle_is_new(before, key, true))
}

fn pitch_keys<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<AngleKeyEntry>, D::Error> {
    list_with(deserializer, |before, key| angle_is_new(before, key, false))
}

fn angle_is_new(
    before: &[AngleKeyEntry],
    key: &AngleKeyEntry,
    periodic: bool,
) -> Result<(), String> {
    let same = |other: &AngleKeyEntry| {
        let apart = (other.at_deg - key.at_deg).abs();
        apart < 1e-3 || (periodic && (apart - 360.0).abs() < 1e-3)
    };
    match before.iter().position(same) {
        Some(index) => {
            Err(format!("must not have the same 'at_deg' as key {} of this list", index + 1))
        }
        None => Ok(()),
    }
}

pub(super) fn highlights<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<HighlightEntry>, D::Error> {
    list_with(deserializer, |_, entry: &HighlightEntry| entry.check())
}

impl HighlightEntry {
    /// What the schema cannot say.
    fn check(&self) -> Result<(), String> {
        if let Some(panorama) = &self.panorama {
            if !self.key.is_empty() || self.front.is_some() || self.level {
                let message = "must not have 'panorama' together with 'key', 'front' or 'level'";
                return Err(message.to_owned());
            }
            let [low, high] = panorama.limits_deg;
            if low > high {
                return Err(format!(
                    "must have the lower of its 'limits_deg' first, not {low} and {high}"
                ));
            }
        }
        if self.front.is_some_and(|front| Vec3::from(front).try_normalize().is_none()) {
            return Err("must have a 'front' that is not zero".to_owned());
        }
        self.proxy.check().map_err(|problem| format!("must have another 'proxy': {problem}"))
    }

    /// The drawing, if it is one that comes with the library.
    pub(super) fn built_in(&self) -> Option<BuiltInDrawing> {
        BuiltInDrawing::ALL.into_iter().find(|drawing| drawing.name() == self.drawing.as_str())
    }

    pub(super) fn placement(&self) -> Placement {
        if let Some(entry) = &self.panorama {
            let key = |key: &AngleKeyEntry| AngleKey {
                at: key.at_deg.to_radians(),
                place: key.place_deg.to_radians(),
                interpolation: key.interpolation,
            };
            let mut panorama = PanoramaPlacement::default();
            panorama.limits = entry.limits_deg.map(f32::to_radians);
            entry.yaw_key.iter().map(key).for_each(|key| panorama.set_yaw_key(key));
            entry.pitch_key.iter().map(key).for_each(|key| panorama.set_pitch_key(key));
            return Placement::Panorama(panorama);
        }
        Placement::Free(FreePlacement {
            front: self.front.map_or(Vec3::Z, Vec3::from),
            level: self.level,
            keys: self.key.iter().map(FreeKeyEntry::key).collect(),
        })
    }
}

impl FreeKeyEntry {
    fn moment(&self) -> Moment {
        Moment { light: direction(self.light_deg), view: direction(self.view_deg) }
    }

    fn key(&self) -> FreeKey {
        FreeKey {
            offset: Vec2::from(self.offset_deg.map(f32::to_radians)),
            rotation: self.rotation_deg.to_radians(),
            scale: Vec2::from(self.scale),
            split: Vec2::from(self.split),
            square: self.square,
            interpolation: self.interpolation,
            light_range: self.light_range_deg.map(f32::to_radians),
            view_range: self.view_range_deg.map(f32::to_radians),
            ..FreeKey::at(&self.moment())
        }
    }
}

/// The unit vector of an azimuth and an elevation in degrees.
fn direction([azimuth, elevation]: [f32; 2]) -> Vec3 {
    crate::scene::direction_of(azimuth.to_radians(), -elevation.to_radians())
}

impl ProxyEntry {
    pub(super) fn check(&self) -> Result<(), String> {
        use ProxyKind as K;
        let kind = self.r#type;
        let given = [
            ("center", self.center.is_some(), kind != K::Capsule),
            ("radius", self.radius.is_some(), kind == K::Sphere),
            ("radii", self.radii.is_some(), kind == K::Ellipsoid),
            ("rotation_deg", self.rotation_deg.is_some(), kind == K::Ellipsoid),
            ("from", self.from.is_some(), kind == K::Capsule),
            ("to", self.to.is_some(), kind == K::Capsule),
            ("to_node", self.to_node.is_some(), kind == K::Capsule),
            ("normal", self.normal.is_some(), kind == K::Plane),
            ("mesh", self.mesh.is_some(), kind == K::Mesh),
        ];
        if let Some((key, ..)) = given.iter().find(|(_, is_given, fits)| *is_given && !fits) {
            return Err(format!("its 'type' has no '{key}'"));
        }
        match kind {
            K::Ellipsoid if self.radii.is_none() => Err("an ellipsoid needs 'radii'".to_owned()),
            K::Capsule if self.to.is_some() == self.to_node.is_some() => {
                Err("a capsule needs either 'to' or 'to_node'".to_owned())
            }
            K::Plane if self.normal.and_then(|n| Vec3::from(n).try_normalize()).is_none() => {
                Err("a plane needs a 'normal' that is not zero".to_owned())
            }
            K::Mesh if self.mesh.is_none() => Err("a mesh needs the node 'mesh'".to_owned()),
            _ => Ok(()),
        }
    }

    pub(super) fn rotation(&self) -> Quat {
        let [x, y, z] = self.rotation_deg.unwrap_or_default().map(f32::to_radians);
        Quat::from_rotation_z(z) * Quat::from_rotation_y(y) * Quat::from_rotation_x(x)
    }
}
