use glam::{Affine3A, Vec3};

use super::{Pose, Primitive, Scene};

/// A place on a triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfacePoint {
    pub(crate) node: usize,
    pub(crate) primitive: usize,
    pub(crate) corners: [u32; 3],
    /// Shares of the corners; their sum is 1.
    pub(crate) shares: [f32; 3],
}

/// What moves one node at a pose.
pub(crate) struct NodePose<'a> {
    primitives: &'a [Primitive],
    world_from_node: Affine3A,
    /// Empty without a skin.
    world_from_rest: Vec<Affine3A>,
    weights: &'a [f32],
}

impl<'a> NodePose<'a> {
    /// `None` for nodes without a mesh.
    pub(crate) fn new(scene: &'a Scene, pose: &'a Pose, node: usize) -> Option<Self> {
        let mesh = scene.meshes.get(scene.nodes.get(node)?.mesh?)?;
        Some(Self {
            primitives: &mesh.primitives,
            world_from_node: pose.world_from_node.get(node).copied().unwrap_or_default(),
            world_from_rest: pose.world_from_rest(scene, node).unwrap_or_default(),
            weights: pose.morph_weights.get(node).map_or(&[], Vec::as_slice),
        })
    }

    /// World places of a triangle's corners, as `deform` has them.
    pub(crate) fn corners(&self, point: &SurfacePoint) -> [Vec3; 3] {
        let Some(primitive) = self.primitives.get(point.primitive) else { return [Vec3::NAN; 3] };
        point.corners.map(|corner| self.place(primitive, corner as usize))
    }

    fn place(&self, primitive: &Primitive, vertex: usize) -> Vec3 {
        let Some(mut p) = primitive.positions.get(vertex).copied() else { return Vec3::NAN };
        for (target, &weight) in primitive.morph_targets.iter().zip(self.weights) {
            if weight != 0.0 && weight.is_finite() {
                p += target.positions.get(vertex).copied().unwrap_or(Vec3::ZERO) * weight;
            }
        }
        let (Some(joints), Some(weights)) =
            (primitive.joints.get(vertex), primitive.weights.get(vertex))
        else {
            return self.world_from_node.transform_point3(p);
        };
        if self.world_from_rest.is_empty() {
            return self.world_from_node.transform_point3(p);
        }
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        for (&joint, &weight) in joints.iter().zip(weights) {
            if weight > 0.0
                && let Some(matrix) = self.world_from_rest.get(usize::from(joint))
            {
                sum += matrix.transform_point3(p) * weight;
                total += weight;
            }
        }
        sum / f32::max(total, 1e-6)
    }
}
