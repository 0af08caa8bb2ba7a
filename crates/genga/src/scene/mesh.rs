use glam::{Vec2, Vec3, Vec4};

/// One or more primitives that share morph weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name in the file; may be empty.
    pub name: String,
    /// Its parts, one material each.
    pub primitives: Vec<Primitive>,
    /// Default weights of the morph targets.
    pub morph_weights: Vec<f32>,
    /// Names of the morph targets (`extras.targetNames`); may be empty.
    pub morph_names: Vec<String>,
}

/// An indexed triangle list with one material.
///
/// Every non-empty attribute has one element per vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// Rest positions in the node's space, in metres. Finite.
    pub positions: Vec<Vec3>,
    /// Unit normals (shading); never empty after import.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, by set. (0, 0) is the top left of the picture.
    pub uvs: Vec<Vec<Vec2>>,
    /// COLOR_0, linear RGBA in [0, 1]; empty for white.
    pub colors: Vec<Vec4>,
    /// Up to four joints per vertex, as indices into [`super::Skin::joints`].
    pub joints: Vec<[u16; 4]>,
    /// The joints' weights, ≥ 0, sum 1.
    pub weights: Vec<[f32; 4]>,
    /// `_LINE_WIDTH`: factor on the width of lines, ≥ 0; empty for 1.
    pub line_widths: Vec<f32>,
    /// `_LINE_ID`: user line id, 0 to 65535; a triangle has the one that most of its corners have.
    /// Empty for 0.
    pub line_ids: Vec<u32>,
    /// `_HATCH`: direction of hatching strokes in the node's space, of any length; 0 for none. Empty
    /// for none anywhere.
    pub hatch_directions: Vec<Vec3>,
    /// `_SHADE_BIAS`: added to the ramp coordinate T, in [−1, 1]; empty for 0. A file's
    /// `_SHADE_THRESHOLD`, where T has its terminator instead of at 0.5, is in it.
    pub shade_biases: Vec<f32>,
    /// Triangles: three indices each, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
    /// Index into [`super::Scene::materials`]; `None` for the default material.
    pub material: Option<usize>,
    /// Morph targets; all primitives of a mesh have the same number.
    pub morph_targets: Vec<MorphTarget>,
}

/// Offsets that a morph weight of 1 adds to each vertex. Empty vectors mean no change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// Position offsets in metres.
    pub positions: Vec<Vec3>,
    /// Normal offsets.
    pub normals: Vec<Vec3>,
}
