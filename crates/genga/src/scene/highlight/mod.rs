//! Anime highlights: drawings that stand on a surface where the artist wants them, for each light
//! and view.
//!
//! A highlight is looked up by the view vector, reflected about a normal that is blended with that
//! of a smooth [`Proxy`]. Everything about it is in the *frame* of a node or bone: the proxy, and
//! the directions that keys are set for. [`Placement`] says where the drawing stands.

mod angles;
mod distance;
mod drawing;
mod fit;
mod free;
mod panorama;
mod proxy;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{Affine3A, DMat3, DVec3, Mat3, Vec2, Vec3};

use schemars::JsonSchema;
use serde::Deserialize;

pub use angles::{direction_of, yaw_pitch};
pub use drawing::{BuiltInDrawing, Drawing, DrawingError};
pub use free::{FreeKey, FreePlacement};
pub use panorama::{AngleKey, PanoramaPlacement};
pub use proxy::{Proxy, ProxyMesh};

pub(crate) use distance::{FIELD_EXTENT, FIELD_SIZE};
pub(crate) use fit::nodes_below;
pub(crate) use proxy::{NORMAL_MAP_SIZE, ProxyShape, ray_triangle};

use super::Image;
use crate::style::{Color, Globs};

/// A drawing on surfaces, added on top of their paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Highlight {
    /// Name for messages.
    pub name: String,
    /// What is drawn.
    pub drawing: Drawing,
    /// The node or bone whose frame it lives in; `None` for the world.
    pub node: Option<usize>,
    /// Only surfaces of this node and of what hangs under it; `None` for all.
    pub under: Option<usize>,
    /// Names of the objects that it is drawn on.
    pub objects: Globs,
    /// Names of the materials that it is drawn on.
    pub materials: Globs,
    /// The smooth stand-in for the surface.
    pub proxy: Proxy,
    /// Part of the proxy's normal in the blend with the surface's own, γ in [0, 1].
    pub gamma: f32,
    /// Node of the light that it belongs to; `None` for the strongest light.
    pub light: Option<usize>,
    /// Width and height of the drawing's square, as angles of the reflected direction in radians,
    /// > 0. A distant eye sees half of that angle on a sphere.
    pub size: Vec2,
    /// Turn of the drawing in radians, counter-clockwise.
    pub angle: f32,
    /// Its colour; alpha is its strength.
    pub color: Color,
    /// How it goes over the paint.
    pub blend: HighlightBlend,
    /// The tones that it shows in.
    pub tone: HighlightTone,
    /// A picture in the base colour's texture coordinates: dark or transparent hides.
    pub mask: Option<Arc<Image>>,
    /// Where the drawing stands.
    pub placement: Placement,
}

impl Default for Highlight {
    fn default() -> Self {
        Self {
            name: String::new(),
            drawing: Drawing::BuiltIn(BuiltInDrawing::Disc),
            node: None,
            under: None,
            objects: Globs::default(),
            materials: Globs::default(),
            proxy: Proxy::Sphere { center: Vec3::ZERO },
            gamma: 1.0,
            light: None,
            size: Vec2::splat(40_f32.to_radians()),
            angle: 0.0,
            color: Color::WHITE,
            blend: HighlightBlend::Add,
            tone: HighlightTone::All,
            mask: None,
            placement: Placement::Free(FreePlacement::default()),
        }
    }
}

/// How a highlight goes over the paint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HighlightBlend {
    /// Added; stops at white.
    #[default]
    Add,
    /// Covers the paint.
    Replace,
}

/// The tones of the ramp that a highlight shows in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HighlightTone {
    /// All of them.
    #[default]
    All,
    /// Only the brightest.
    Light,
    /// All but the brightest.
    Shadow,
}

/// Where a drawing stands, by light and view.
#[derive(Clone, Debug, PartialEq)]
pub enum Placement {
    /// On a panorama, its x by the relative yaw and its y by the relative pitch.
    Panorama(PanoramaPlacement),
    /// By keys on the directions of light and view.
    Free(FreePlacement),
}

/// The directions that keys are set for: unit vectors from the proxy's centre, in the highlight's
/// frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Towards the light.
    pub light: Vec3,
    /// Towards the eye.
    pub view: Vec3,
}

/// How a key goes on towards the next ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum KeyInterpolation {
    /// Its value holds until another key takes over.
    Hold,
    /// Evenly.
    Linear,
    /// Without a bend at the key.
    #[default]
    Smooth,
}

/// A drawing in its place, in the highlight's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Right, up and middle of the drawing (columns; a rotation): the middle is the reflected
    /// direction that shows it. On a panorama the axes of the frame instead.
    pub axes: DMat3,
    /// Yaw and pitch of the drawing's middle in radians, in (−π, π] and [−π/2, π/2] where nothing
    /// says otherwise; on a panorama only.
    pub panorama: Option<[f64; 2]>,
    /// Turn in radians, counter-clockwise.
    pub rotation: f64,
    /// Factors on width and height.
    pub scale: [f64; 2],
    /// How far each half is moved apart, in halves of the drawing's side, along both axes.
    pub split: [f64; 2],
    /// How square the drawing is, in [0, 1].
    pub square: f64,
    /// How far it shows, in [0, 1].
    pub opacity: f64,
}

impl Placed {
    /// The reflected direction that shows the drawing's middle.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        match self.panorama {
            Some([yaw, pitch]) => angles::direction(yaw, pitch),
            None => self.axes.z_axis,
        }
    }
}

impl Placement {
    /// Where the drawing stands at a moment. Directions that are not finite count as +Z, so the
    /// result is finite, too.
    #[must_use]
    pub fn evaluate(&self, moment: &Moment) -> Placed {
        match self {
            Self::Panorama(panorama) => panorama.evaluate(moment),
            Self::Free(free) => free.evaluate(moment),
        }
    }

    /// Sets the keys of a moment so that the drawing's middle stands at the reflected direction
    /// `middle`: what a drag does. Keys of the same moment are replaced.
    ///
    /// # Errors
    /// [`PlaceError::Limits`] if a panorama's limits do not let it stand there.
    pub fn put(&mut self, moment: &Moment, middle: Vec3) -> Result<(), PlaceError> {
        match self {
            Self::Panorama(panorama) => panorama.put(moment, middle),
            Self::Free(free) => {
                free.put(moment, middle);
                Ok(())
            }
        }
    }
}

/// Why a highlight cannot be put somewhere.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    /// There is no such highlight.
    #[error("there is no highlight {0}")]
    NoHighlight(usize),
    /// Nothing is drawn at that pixel.
    #[error("there is no surface at this pixel to put the highlight on")]
    NoSurface,
    /// The surface at that pixel is not one of the highlight's.
    #[error("the highlight is not drawn on the surface at this pixel: choose one of its materials")]
    OtherSurface,
    /// The panorama's limits are in the way.
    #[error("the highlight's limits keep its pitch within {0}° and {1}°: it cannot stand at {2}°")]
    Limits(f32, f32, f32),
}

/// The frame of a highlight in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HighlightFrame {
    /// From the node's space to the world.
    pub world_from_node: Affine3A,
    /// The node's axes in the world, made orthonormal: directions turn with them.
    pub world_from_frame: Mat3,
    /// The proxy's centre in the world.
    pub center: Vec3,
}

impl HighlightFrame {
    /// The frame of a highlight under a node that stands there.
    #[must_use]
    pub fn new(highlight: &Highlight, world_from_node: &Affine3A) -> Self {
        let center = world_from_node.transform_point3(highlight.proxy.center());
        Self {
            world_from_node: *world_from_node,
            world_from_frame: orthonormal(Mat3::from(world_from_node.matrix3)),
            center: if center.is_finite() { center } else { Vec3::ZERO },
        }
    }

    /// The directions to light and eye, given in the world.
    #[must_use]
    pub fn moment(&self, to_light: Vec3, to_eye: Vec3) -> Moment {
        let turned = |v: Vec3| {
            let in_frame = self.world_from_frame.transpose() * v.normalize_or(Vec3::Z);
            in_frame.normalize_or(Vec3::Z)
        };
        Moment { light: turned(to_light), view: turned(to_eye) }
    }

    /// The direction, in the frame, in which the eye sees the panorama at a point of the surface:
    /// the reflection of the view about the blended normal. All arguments are in the world,
    /// `normal` and `to_eye` unit vectors.
    #[must_use]
    pub fn reflected(
        &self,
        highlight: &Highlight,
        point: Vec3,
        normal: Vec3,
        to_eye: Vec3,
    ) -> Vec3 {
        let seen = highlight.proxy.seen(&self.world_from_node, point, to_eye);
        let proxy = highlight.proxy.normal(&self.world_from_node, seen).unwrap_or(normal);
        let gamma = highlight.gamma.clamp(0.0, 1.0);
        let n = (gamma * proxy + (1.0 - gamma) * normal).normalize_or(normal);
        let reflected = 2.0 * n.dot(to_eye) * n - to_eye;
        (self.world_from_frame.transpose() * reflected).normalize_or(Vec3::Z)
    }
}

/// Orthonormal axes nearest to those of a matrix, mirrored if it mirrors; the identity if it is
/// flat. Y is kept first: the drawing stays upright.
fn orthonormal(m: Mat3) -> Mat3 {
    let Some(y) = m.y_axis.try_normalize() else { return Mat3::IDENTITY };
    let z = m.z_axis.try_normalize().unwrap_or(Vec3::ZERO);
    let Some(z) = (z - y * z.dot(y)).try_normalize() else { return Mat3::IDENTITY };
    let x = y.cross(z);
    let mirrored = m.determinant() < 0.0;
    Mat3::from_cols(if mirrored { -x } else { x }, y, z)
}

/// A highlight cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("highlight {index} '{name}' {problem}")]
pub struct HighlightError {
    /// Index of the highlight.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// What is wrong with it.
    pub problem: String,
}

impl Highlight {
    /// Checks that all numbers are finite and in range, and that its nodes are among `node_count`.
    ///
    /// # Errors
    /// What is wrong, as the end of a sentence that begins with the highlight's name.
    pub fn validate(&self, node_count: usize) -> Result<(), String> {
        for (what, node) in [("node", self.node), ("node", self.under), ("light", self.light)] {
            if let Some(index) = node.filter(|&index| index >= node_count) {
                return Err(format!(
                    "refers to {what} {index}, but there are only {node_count} nodes"
                ));
            }
        }
        let size_ok = self.size.is_finite() && self.size.cmpgt(Vec2::ZERO).all();
        if !size_ok {
            return Err("has a size that is not above 0".to_owned());
        }
        if !(0.0..=1.0).contains(&self.gamma) {
            return Err("has a gamma outside of 0 to 1".to_owned());
        }
        let color = self.color.to_array();
        if !self.angle.is_finite() || !color.iter().all(|channel| (0.0..=1.0).contains(channel)) {
            return Err("has an angle or colour that is not a usable number".to_owned());
        }
        self.drawing.validate()?;
        if let Some(mask) = &self.mask
            && (mask.rgba.is_empty()
                || mask.rgba.len() as u64 != 4 * u64::from(mask.width) * u64::from(mask.height))
        {
            return Err("has a mask without pixels".to_owned());
        }
        self.proxy.validate()?;
        match &self.placement {
            Placement::Panorama(panorama) => panorama.validate(),
            Placement::Free(free) => free.validate(),
        }
    }
}
