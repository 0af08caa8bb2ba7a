use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::picture;
use crate::scene::Image;

/// A shade bias that changes over a surface: T is moved by `strength · (2v − 1)`, so that a value v of
/// 0.5 changes nothing, lighter ones keep a place lighter, darker ones darker.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ShadeMap {
    /// Where v comes from.
    pub from: ShadeSource,
    /// The picture whose red channel is v, by the first texture coordinates; only for `picture`.
    #[serde(deserialize_with = "picture::load_some")]
    #[schemars(with = "Option<String>")]
    pub image: Option<Arc<Image>>,
    /// Largest shift of T.
    #[schemars(range(min = -1, max = 1))]
    pub strength: f32,
}

impl Default for ShadeMap {
    fn default() -> Self {
        Self { from: ShadeSource::Picture, image: None, strength: 0.5 }
    }
}

/// What a [`ShadeMap`] reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ShadeSource {
    /// The red channel of a picture.
    #[default]
    Picture,
    /// The red channel of COLOR_0.
    VertexRed,
    /// The green channel of COLOR_0.
    VertexGreen,
    /// The blue channel of COLOR_0.
    VertexBlue,
    /// The alpha channel of COLOR_0.
    VertexAlpha,
}
