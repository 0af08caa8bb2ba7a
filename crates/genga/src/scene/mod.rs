//! Plain scene data: what an importer makes and the renderer draws. No GPU here.
//!
//! The space is glTF's: right-handed, +Y up, metres, seconds, radians. Everything refers to
//! everything else by index into the vectors of [`Scene`]; [`Scene::validate`] checks that all
//! of them are in range, which the renderer relies on.

mod beam;
mod beam_mesh;
mod bounds;
mod camera;
mod clip;
mod highlight;
mod light;
mod material;
mod mesh;
mod node;
mod pick;
mod pose;
mod shading;
mod surface_point;
#[cfg(test)]
mod tests;
mod validate;
mod wave;
mod wave_check;
pub(crate) mod wave_curve;
#[cfg(test)]
mod wave_tests;

pub use beam::{
    Beam, BeamLight, BeamMotion, BeamOrder, BeamOutline, BeamShape, BeamTone, MAX_BEAM_TONES,
    MAX_BEAMS,
};
pub(crate) use beam_mesh::BeamMesh;
pub use bounds::Aabb;
pub use camera::{Camera, Projection};
pub use clip::{Channel, ChannelTarget, Clip, Interpolation};
pub use highlight::{
    AngleKey, BuiltInDrawing, Drawing, DrawingError, FreeKey, FreePlacement, Highlight,
    HighlightBlend, HighlightError, HighlightFrame, HighlightTone, KeyInterpolation, Moment,
    PanoramaPlacement, PlaceError, Placed, Placement, Proxy, ProxyMesh, direction_of, yaw_pitch,
};
pub use light::{Light, LightKind};
pub use material::{
    AlphaMode, Filter, Image, Material, MipFilter, Sampler, Texture, TextureRef, UvTransform, Wrap,
};
pub use mesh::{Mesh, MorphTarget, Primitive};
pub use node::{Node, Skin, Transform};
pub use pick::Hit;
pub use pose::Pose;
pub use shading::{FaceShadow, MAX_SHADINGS, Shading};
pub(crate) use surface_point::{NodePose, SurfacePoint};
pub use validate::SceneError;
pub(crate) use validate::{validate_beams, validate_waves};
pub use wave::{
    MAX_WAVES, Wave, WaveAnchor, WaveBlend, WaveMethod, WaveMotion, WaveNoise, WaveOrder,
    WavePlacement, WaveShape, WaveTone,
};

pub(crate) use highlight::{FIELD_EXTENT, FIELD_SIZE, NORMAL_MAP_SIZE, ProxyShape, nodes_below};

/// A whole model or set: everything that can be drawn, posed and lit.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// A name for messages and output files, usually the file's stem.
    pub name: String,
    /// The node forest. A node's parent may come before or after it.
    pub nodes: Vec<Node>,
    /// Indices of the nodes without a parent that are drawn.
    pub roots: Vec<usize>,
    /// Meshes, referred to by [`Node::mesh`].
    pub meshes: Vec<Mesh>,
    /// Materials, referred to by [`Primitive::material`].
    pub materials: Vec<Material>,
    /// Textures, referred to by [`TextureRef::texture`].
    pub textures: Vec<Texture>,
    /// Decoded pictures, referred to by [`Texture::image`].
    pub images: Vec<Image>,
    /// Skins, referred to by [`Node::skin`].
    pub skins: Vec<Skin>,
    /// Animation clips.
    pub clips: Vec<Clip>,
    /// Cameras, referred to by [`Node::camera`].
    pub cameras: Vec<Camera>,
    /// Lights, referred to by [`Node::light`].
    pub lights: Vec<Light>,
    /// Anime highlights.
    pub highlights: Vec<Highlight>,
    /// Surfaces that are shaded by other normals, at most [`MAX_SHADINGS`]; where several fit, the
    /// last one counts.
    pub shadings: Vec<Shading>,
    /// Energy waves, at most [`MAX_WAVES`]; they may change from frame to frame.
    pub waves: Vec<Wave>,
    /// How they are integrated.
    pub wave_method: WaveMethod,
    /// Beams, at most [`MAX_BEAMS`]; they may change from frame to frame.
    pub beams: Vec<Beam>,
}

impl Scene {
    /// The number of triangles in all meshes, each counted once per node that shows it.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.drawn_primitives().map(|primitive| primitive.indices.len() / 3).sum()
    }

    /// The number of vertices in all meshes, each counted once per node that shows it.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.drawn_primitives().map(|primitive| primitive.positions.len()).sum()
    }

    /// The clip of that name, or `None`. An exact match wins over one that ignores case.
    #[must_use]
    pub fn find_clip(&self, name: &str) -> Option<usize> {
        self.clips
            .iter()
            .position(|clip| clip.name == name)
            .or_else(|| self.clips.iter().position(|clip| clip.name.eq_ignore_ascii_case(name)))
    }

    fn drawn_primitives(&self) -> impl Iterator<Item = &Primitive> {
        self.nodes
            .iter()
            .filter_map(|node| node.mesh)
            .filter_map(|mesh| self.meshes.get(mesh))
            .flat_map(|mesh| &mesh.primitives)
    }
}
