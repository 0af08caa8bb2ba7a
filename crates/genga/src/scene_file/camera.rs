use glam::{Affine3A, Mat3, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::Located;
use crate::scene::Projection;

/// The camera of a scene file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub enum CameraEntry {
    /// On a sphere round the whole scene.
    Orbit(OrbitCamera),
    /// At a place of its own.
    Placed(PlacedCamera),
    /// A camera of one of the models, by its name or its node's.
    Node(Located<String>),
}

/// A camera that looks at the middle of the scene from a direction, at the distance from which
/// all of it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    /// Degrees to the right of the front (+Z).
    pub azimuth_deg: f32,
    /// Degrees above the horizon, in [−90, 90].
    pub elevation_deg: f32,
    /// Magnification, > 0.
    pub zoom: f32,
    /// Vertical angle of view in degrees, in [1, 170].
    pub fov_deg: f32,
    /// Parallel projection.
    pub orthographic: bool,
}

/// A camera at a place of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedCamera {
    /// From camera space (looking down −Z, +Y up) to the scene's; rotation and translation only.
    pub world_from_camera: Affine3A,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// Distance in metres nearer than which nothing is drawn, > 0.
    pub near: f32,
}

/// The camera of an assembled scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneCamera {
    /// On a sphere round the whole scene.
    Orbit(OrbitCamera),
    /// At a place of its own.
    Placed(PlacedCamera),
    /// That of a node of the scene, by the node's index.
    Node(usize),
}

/// How the scene is seen: `node` (a camera of a model); or `position`, `target`, `up` and
/// `fov_deg` or `height`; or otherwise on a sphere round the whole scene by `azimuth_deg`,
/// `elevation_deg`, `zoom`, `fov_deg` and `orthographic`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Camera")]
pub(super) struct Written {
    /// Orbit: degrees to the right of the front (+Z); 30 by default.
    #[schemars(range(min = -36000, max = 36000))]
    azimuth_deg: Option<f32>,
    /// Orbit: degrees above the horizon; 15 by default.
    #[schemars(range(min = -90, max = 90))]
    elevation_deg: Option<f32>,
    /// Orbit: magnification; 1 shows the whole scene.
    #[schemars(range(min = 0.001, max = 10000))]
    zoom: Option<f32>,
    /// Orbit: parallel projection.
    orthographic: Option<bool>,
    /// Vertical angle of view in degrees; 30 by default.
    #[schemars(range(min = 1, max = 170))]
    fov_deg: Option<f32>,
    /// Where the camera stands, in metres.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    position: Option<[f32; 3]>,
    /// With `position`: what it looks at.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    target: Option<[f32; 3]>,
    /// With `position`: what is up in the picture; [0, 1, 0] by default.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    up: Option<[f32; 3]>,
    /// With `position`: parallel projection that shows this height in metres.
    #[schemars(range(min = 1e-6, max = 1e6))]
    height: Option<f32>,
    /// With `position`: nothing nearer than this is drawn, in metres; 0.01 by default.
    #[schemars(range(min = 1e-6, max = 1e6))]
    near: Option<f32>,
    /// The camera of a model, by its name or its node's.
    node: Option<Located<String>>,
}

impl TryFrom<Written> for CameraEntry {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        let w = &written;
        let orbit = [
            ("azimuth_deg", w.azimuth_deg.is_some()),
            ("elevation_deg", w.elevation_deg.is_some()),
            ("zoom", w.zoom.is_some()),
            ("orthographic", w.orthographic.is_some()),
        ];
        let placed = [
            ("target", w.target.is_some()),
            ("up", w.up.is_some()),
            ("height", w.height.is_some()),
            ("near", w.near.is_some()),
        ];
        let others = [("fov_deg", w.fov_deg.is_some()), ("position", w.position.is_some())];
        let none_of = |keys: &[(&str, bool)], with: &str| match keys.iter().find(|key| key.1) {
            Some((key, _)) => Err(format!("must not have '{key}' together with {with}")),
            None => Ok(()),
        };
        if let Some(node) = written.node {
            none_of(&[&orbit[..], &placed, &others].concat(), "'node'")?;
            return Ok(Self::Node(node));
        }
        if let Some(position) = w.position {
            none_of(&orbit, "'position'")?;
            return written.placed(Vec3::from(position)).map(Self::Placed);
        }
        none_of(&placed, "an orbit: it needs a 'position'")?;
        Ok(Self::Orbit(OrbitCamera {
            azimuth_deg: w.azimuth_deg.unwrap_or(30.0),
            elevation_deg: w.elevation_deg.unwrap_or(15.0),
            zoom: w.zoom.unwrap_or(1.0),
            fov_deg: w.fov_deg.unwrap_or(30.0),
            orthographic: w.orthographic.unwrap_or(false),
        }))
    }
}

impl Written {
    fn placed(&self, position: Vec3) -> Result<PlacedCamera, String> {
        let target = self.target.ok_or("must have a 'target' beside its 'position'")?;
        let projection = match (self.fov_deg, self.height) {
            (Some(_), Some(_)) => {
                return Err("must have either 'fov_deg' or 'height', not both".to_owned());
            }
            (_, Some(height)) => Projection::Orthographic { height },
            (fov, None) => Projection::Perspective { fov_y: fov.unwrap_or(30.0).to_radians() },
        };
        let back = (position - Vec3::from(target)).try_normalize();
        let back = back.ok_or("must have its 'target' away from its 'position'")?;
        let up = Vec3::from(self.up.unwrap_or([0.0, 1.0, 0.0]));
        let up = up.try_normalize().ok_or("must have an 'up' that is not zero")?;
        let across = up.cross(back);
        if across.length() < 1e-4 {
            return Err("must not look along its 'up': give another one".to_owned());
        }
        let right = across.normalize();
        let rotation = Mat3::from_cols(right, back.cross(right), back);
        Ok(PlacedCamera {
            world_from_camera: Affine3A::from_mat3_translation(rotation, position),
            projection,
            near: self.near.unwrap_or(0.01),
        })
    }
}
