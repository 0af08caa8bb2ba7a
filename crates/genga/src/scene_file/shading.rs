use schemars::JsonSchema;
use serde::Deserialize;

use super::{Located, ProxyEntry};
use crate::style::Globs;

/// Surfaces that are shaded by the normals of a smooth shape, or by a keyed face shadow.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Shading")]
pub struct ShadingEntry {
    /// Name of the model, where there are several.
    pub model: Option<Located<String>>,
    /// Name of the node or bone in whose frame everything below is; the model itself by default.
    pub node: Option<Located<String>>,
    /// Globs of object names; empty for all.
    #[serde(default)]
    pub objects: Globs,
    /// Globs of material names; empty for all.
    #[serde(default)]
    pub materials: Globs,
    /// The smooth shape whose normals stand in for the surface's.
    pub proxy: Option<Located<ProxyEntry>>,
    /// How much of them: 0 leaves the surface's own, 1 takes the shape's alone.
    #[serde(default = "most")]
    #[schemars(range(min = 0, max = 1))]
    pub amount: f32,
    /// A picture on the first texture coordinates, whose red channel says for every place up to which
    /// angle of the strongest light it is lit: 0 is never, 0.5 as long as the light comes from beside
    /// or before the node's +Z, 1 always. It is drawn for light from the node's +X.
    pub face_shadow: Option<Located<String>>,
    /// Where on u that picture is mirrored for light from the other side; not mirrored by default.
    #[schemars(range(min = 0, max = 1))]
    pub mirror_u: Option<f32>,
}

fn most() -> f32 {
    0.8
}

impl ShadingEntry {
    /// What the schema cannot say.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.proxy.is_none() && self.face_shadow.is_none() {
            return Err("must have a 'proxy' or a 'face_shadow'".to_owned());
        }
        if self.mirror_u.is_some() && self.face_shadow.is_none() {
            return Err("must not have 'mirror_u' without a 'face_shadow'".to_owned());
        }
        match &self.proxy {
            Some(proxy) if proxy.radius.is_some() => {
                Err("must have a 'proxy' without 'radius', which only highlights have".to_owned())
            }
            Some(proxy) => {
                proxy.check().map_err(|problem| format!("must have another 'proxy': {problem}"))
            }
            None => Ok(()),
        }
    }
}
