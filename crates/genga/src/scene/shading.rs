use std::sync::Arc;

use super::{Image, Proxy};
use crate::style::Globs;

/// How some surfaces are shaded other than by their own normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shading {
    /// The node in whose frame proxy and face shadow are; `None` for the world.
    pub node: Option<usize>,
    /// Only objects below this node; `None` for all.
    pub under: Option<usize>,
    /// Globs of object names; empty for all.
    pub objects: Globs,
    /// Globs of material names; empty for all.
    pub materials: Globs,
    /// The smooth shape whose normals take the place of the surface's. Those of a mesh are taken where
    /// the ray from its centre through a place leaves it.
    pub proxy: Option<Proxy>,
    /// How much of them: 0 leaves the surface's own, 1 takes the proxy's alone.
    pub amount: f32,
    /// A keyed face shadow.
    pub face_shadow: Option<FaceShadow>,
}

/// A picture on the first texture coordinates that says by its red channel, for every place of a face,
/// up to which angle of the strongest light it is lit: 0 is never, 0.5 as long as the light comes from
/// beside or before the node's +Z, 1 always. It is drawn for light from the node's right (+X).
#[derive(Clone, Debug, PartialEq)]
pub struct FaceShadow {
    /// The picture.
    pub image: Arc<Image>,
    /// The texture coordinate u that the picture is mirrored at for light from the other side;
    /// `None` where it is not mirrored.
    pub mirror_u: Option<f32>,
}

/// Most [`Shading`]s of a scene.
pub const MAX_SHADINGS: usize = 16;

impl Shading {
    /// What is wrong, as the end of a sentence; node numbers are checked elsewhere.
    pub(crate) fn validate(&self) -> Result<(), String> {
        if !(0.0..=1.0).contains(&self.amount) {
            return Err("has an amount outside of 0 to 1".to_owned());
        }
        if let Some(proxy) = &self.proxy {
            proxy.validate()?;
        }
        let Some(face) = &self.face_shadow else { return Ok(()) };
        let (image, mirror) = (&face.image, face.mirror_u.unwrap_or(0.0));
        if image.rgba.is_empty()
            || image.rgba.len() as u64 != 4 * u64::from(image.width) * u64::from(image.height)
        {
            return Err("has a face shadow without pixels".to_owned());
        }
        if !(0.0..=1.0).contains(&mirror) {
            return Err("mirrors its face shadow outside of 0 to 1".to_owned());
        }
        Ok(())
    }
}
