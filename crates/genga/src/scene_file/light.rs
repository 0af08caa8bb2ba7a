use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::Located;
use crate::scene::{Light, LightKind, Transform};
use crate::srgb::linear_from_srgb;
use crate::style::{Color, PinnedTo};

/// A light of a scene file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub struct LightEntry {
    /// What shines.
    pub light: Light,
    /// Where it stands, in the scene's space, the camera's or its node's.
    pub transform: Transform,
    /// The node or bone that it moves with, as the file names it.
    pub node: Option<Located<String>>,
}

/// What a light shines like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "LightType")]
enum Kind {
    /// Parallel rays, as from the sun.
    Directional,
    /// From a place in all directions.
    Point,
    /// A cone.
    Spot,
    /// The sky: what looks up is lit. It casts no shadows.
    Sky,
}

/// A light besides those of the models.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Light")]
pub(super) struct Written {
    /// Name of its node.
    #[serde(default)]
    name: String,
    /// Directional, point, spot or sky.
    r#type: Kind,
    /// Directional and spot: where the light comes from, in degrees: 0 from the front, positive
    /// from the right.
    #[schemars(range(min = -36000, max = 36000))]
    azimuth_deg: Option<f32>,
    /// Directional and spot: where the light comes from, in degrees: positive from above.
    #[schemars(range(min = -90, max = 90))]
    elevation_deg: Option<f32>,
    /// Directional and spot: where the light goes, instead of the two angles. Sky: where the
    /// ground is; straight down by default.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    direction: Option<[f32; 3]>,
    /// Point and spot: where the light stands, in metres.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    position: Option<[f32; 3]>,
    /// Its colour; white by default.
    #[serde(default = "white")]
    color: Color,
    /// Its strength, in lux (directional) or candela (point and spot).
    #[serde(default = "one")]
    #[schemars(range(min = 0, max = 1e9))]
    intensity: f32,
    /// Point and spot: distance in metres beyond which it gives no light; no limit by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    range: Option<f32>,
    /// Spot: half angle in degrees within which it is at full strength; 0 by default.
    #[schemars(range(min = 0, max = 90))]
    inner_angle_deg: Option<f32>,
    /// Spot: half angle in degrees outside which it gives no light; 45 by default.
    #[schemars(range(min = 0, max = 90))]
    outer_angle_deg: Option<f32>,
    /// What its place and direction turn with; the world by default.
    pinned_to: Option<PinnedTo>,
    /// The node or bone that its place and direction move with, in whose frame they are given.
    node: Option<Located<String>>,
    /// Whether it casts shadows, where the style has them; true by default. A sky never does.
    casts_shadow: Option<bool>,
}

fn white() -> Color {
    Color::WHITE
}

fn one() -> f32 {
    1.0
}

impl TryFrom<Written> for LightEntry {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let w = &written;
        let angles = w.azimuth_deg.is_some() || w.elevation_deg.is_some();
        let keys = [
            ("position", w.position.is_some()),
            ("range", w.range.is_some()),
            ("inner_angle_deg", w.inner_angle_deg.is_some()),
            ("outer_angle_deg", w.outer_angle_deg.is_some()),
            ("direction", w.direction.is_some()),
            ("azimuth_deg", w.azimuth_deg.is_some()),
            ("elevation_deg", w.elevation_deg.is_some()),
        ];
        let (kind, useless) = match w.r#type {
            Kind::Directional => (LightKind::Directional, &keys[..4]),
            Kind::Point => (LightKind::Point { range: w.range }, &keys[2..]),
            Kind::Spot => (w.spot()?, &keys[..0]),
            Kind::Sky => (LightKind::Sky, &keys[..4]),
        };
        let kind_name = match w.r#type {
            Kind::Directional => "directional",
            Kind::Point => "point",
            Kind::Spot => "spot",
            Kind::Sky => "sky",
        };
        if let Some((key, _)) = useless.iter().find(|key| key.1) {
            return Err(format!("must not have '{key}': a {kind_name} light has none"));
        }
        if w.r#type == Kind::Sky && angles {
            return Err("must not have angles: a sky's 'direction' says where the ground is".into());
        }
        if w.r#type == Kind::Sky && w.casts_shadow.is_some() {
            return Err("must not have 'casts_shadow': a sky casts none".to_owned());
        }
        if w.node.is_some() && w.pinned_to.is_some() {
            return Err("must have either a 'node' or 'pinned_to', not both".to_owned());
        }
        if matches!(w.r#type, Kind::Point | Kind::Spot) && w.position.is_none() && w.node.is_none()
        {
            return Err("must have a 'position' or a 'node'".to_owned());
        }
        if angles && w.direction.is_some() {
            return Err("must have either a 'direction' or its two angles, not both".to_owned());
        }
        let back = match w.direction {
            Some(direction) => (-Vec3::from(direction))
                .try_normalize()
                .ok_or("must have a 'direction' that is not zero")?,
            None if w.r#type == Kind::Sky => Vec3::Y,
            None => from_angles(w.azimuth_deg.unwrap_or(0.0), w.elevation_deg.unwrap_or(0.0)),
        };
        let Color { r, g, b, a: _ } = w.color;
        let light = Light {
            name: w.name.clone(),
            kind,
            color: Vec3::new(r, g, b).map(linear_from_srgb),
            intensity: w.intensity,
            pinned_to_camera: w.pinned_to == Some(PinnedTo::Camera),
            casts_shadow: w.casts_shadow.unwrap_or(true),
        };
        // A sky's up is its node's +Y, a light shines along −Z.
        let axis = if w.r#type == Kind::Sky { Vec3::Y } else { Vec3::Z };
        let transform = Transform::Parts {
            translation: w.position.map_or(Vec3::ZERO, Vec3::from),
            rotation: Quat::from_rotation_arc(axis, back),
            scale: Vec3::ONE,
        };
        Ok(Self { light, transform, node: written.node })
    }
}

impl Written {
    fn spot(&self) -> Result<LightKind, String> {
        let inner = self.inner_angle_deg.unwrap_or(0.0);
        let outer = self.outer_angle_deg.unwrap_or(45.0);
        if inner >= outer {
            return Err(format!(
                "must have an 'outer_angle_deg' that is larger than its inner one, not {outer} and {inner}"
            ));
        }
        Ok(LightKind::Spot {
            range: self.range,
            inner_angle: inner.to_radians(),
            outer_angle: outer.to_radians(),
        })
    }
}

/// The unit vector towards where a light comes from.
fn from_angles(azimuth_deg: f32, elevation_deg: f32) -> Vec3 {
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
    Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}
