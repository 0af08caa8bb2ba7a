use std::path::Path;

use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::Located;
use crate::scene::Transform;
use crate::style::Globs;

/// A model of a scene file.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelEntry {
    /// The model's file, relative to this one.
    pub file: Located<String>,
    /// Name of the node that the model hangs under; the file's name by default.
    #[serde(default)]
    pub name: Option<String>,
    /// Where its origin stands, in metres.
    #[serde(default)]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub translation: [f32; 3],
    /// Rotations in degrees about the scene's x, then y, then z axis.
    #[serde(default)]
    #[schemars(inner(range(min = -36000, max = 36000)))]
    pub rotation_deg: [f32; 3],
    /// One factor, or one for each axis of the model.
    #[serde(default)]
    pub scale: Scale,
    /// The animation that poses it: its name, or its number in the file, from 0. Without one the
    /// model stands as its file has it.
    #[serde(default)]
    pub clip: Option<Located<ClipEntry>>,
    /// The moment of the clip in seconds.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub time: f32,
    /// Globs of node names that are not drawn, with all that hangs under them.
    #[serde(default)]
    pub hide: Located<Globs>,
}

/// How much larger a model is than its file says.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Scale {
    /// The same in all directions.
    Uniform(#[schemars(range(min = 1e-6, max = 1e6))] f32),
    /// Along the model's x, y and z axis.
    PerAxis(#[schemars(inner(range(min = 1e-6, max = 1e6)))] [f32; 3]),
}

impl Default for Scale {
    fn default() -> Self {
        Self::Uniform(1.0)
    }
}

impl Scale {
    /// The factors along x, y and z.
    #[must_use]
    pub fn to_vec3(self) -> Vec3 {
        match self {
            Self::Uniform(factor) => Vec3::splat(factor),
            Self::PerAxis(factors) => Vec3::from(factors),
        }
    }
}

/// Which clip of a model is meant.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ClipEntry {
    /// By its place in the file, from 0.
    Index(#[schemars(range(min = 0, max = 65535))] u32),
    /// By its name; case matters only if two names differ in nothing else.
    Name(String),
}

impl ModelEntry {
    /// The node's name.
    #[must_use]
    pub fn node_name(&self) -> String {
        self.name.clone().unwrap_or_else(|| {
            Path::new(self.file.as_str()).file_stem().unwrap_or_default().to_string_lossy().into()
        })
    }

    /// From the model's space to the scene's.
    #[must_use]
    pub fn transform(&self) -> Transform {
        let [x, y, z] = self.rotation_deg.map(f32::to_radians);
        Transform::Parts {
            translation: Vec3::from(self.translation),
            rotation: Quat::from_rotation_z(z)
                * Quat::from_rotation_y(y)
                * Quat::from_rotation_x(x),
            scale: self.scale.to_vec3(),
        }
    }
}
