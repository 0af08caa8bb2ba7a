use glam::{Affine3A, Mat4, Quat, Vec3};

/// A node of the forest: a place in space with what stands there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Name in the file; may be empty.
    pub name: String,
    /// Index of the parent node, if any.
    pub parent: Option<usize>,
    /// Indices of the child nodes.
    pub children: Vec<usize>,
    /// Rest transform to the parent's space.
    pub transform: Transform,
    /// Index into [`super::Scene::meshes`].
    pub mesh: Option<usize>,
    /// Index into [`super::Scene::skins`].
    pub skin: Option<usize>,
    /// Index into [`super::Scene::cameras`].
    pub camera: Option<usize>,
    /// Index into [`super::Scene::lights`].
    pub light: Option<usize>,
    /// Morph weights of this node, which replace those of its mesh; empty to keep them.
    pub morph_weights: Vec<f32>,
}

/// A node's transform: parts that a clip can animate, or a matrix that it cannot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// Translation · rotation · scale.
    Parts {
        /// In metres.
        translation: Vec3,
        /// Unit quaternion.
        rotation: Quat,
        /// Per axis.
        scale: Vec3,
    },
    /// Any affine matrix.
    Matrix(Mat4),
}

impl Default for Transform {
    fn default() -> Self {
        Self::Parts { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Transform {
    /// The matrix that takes a point of the node's space to the parent's.
    #[must_use]
    pub fn parent_from_node(&self) -> Affine3A {
        match *self {
            Self::Parts { translation, rotation, scale } => {
                Affine3A::from_scale_rotation_translation(scale, rotation, translation)
            }
            Self::Matrix(matrix) => Affine3A::from_mat4(matrix),
        }
    }
}

/// Joints that bend a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Name in the file; may be empty.
    pub name: String,
    /// Node indices of the joints.
    pub joints: Vec<usize>,
    /// For each joint, the matrix from the mesh's rest space to the joint's.
    pub joint_from_mesh: Vec<Affine3A>,
}
