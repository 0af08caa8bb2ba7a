//! What a ray meets first.

use glam::{Affine3A, Mat3, Vec3};

use super::highlight::ray_triangle;
use super::{Pose, Primitive, Scene};

/// The nearest surface along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub distance: f32,
    /// Index of the node whose mesh it is.
    pub node: usize,
    /// Index of the primitive in that mesh.
    pub primitive: usize,
    /// The place in the world.
    pub point: Vec3,
    /// The unit shading normal, turned towards where the ray comes from.
    pub normal: Vec3,
}

impl Scene {
    /// The nearest surface that a ray of the world meets at a pose, with morph targets and skins
    /// applied; `None` if it meets nothing. Back faces of one-sided materials do not count.
    ///
    /// It visits every triangle on the CPU: for a click, not for a picture.
    #[must_use]
    pub fn pick(&self, pose: &Pose, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        self.visit_posed(pose, &mut |node, number, primitive, posed| {
            let material = primitive.material.and_then(|m| self.materials.get(m));
            let both_sides = material.is_some_and(|material| material.double_sided);
            let (triangles, _) = primitive.indices.as_chunks::<3>();
            for triangle in triangles {
                let Some(corners) = posed.corners(triangle) else { continue };
                let Some((distance, at)) = ray_triangle(origin, direction, corners) else {
                    continue;
                };
                if nearest.is_some_and(|hit| hit.distance <= distance) {
                    continue;
                }
                let [a, b, c] = corners;
                // Mirrored transforms wind the other way.
                let flip = if posed.mirrored { -1.0 } else { 1.0 };
                let away = flip * (b - a).cross(c - a).dot(direction) > 0.0;
                if away && !both_sides {
                    continue;
                }
                let n = posed.normal(triangle, at);
                let normal = if away { -n } else { n };
                let point = origin + direction * distance;
                nearest = Some(Hit { distance, node, primitive: number, point, normal });
            }
        });
        nearest
    }

    /// Calls `visit` with the node, the material's name and the corners in the world of every
    /// triangle that is drawn at a pose.
    pub(super) fn visit_triangles(
        &self,
        pose: &Pose,
        visit: &mut dyn FnMut(usize, &str, [Vec3; 3]),
    ) {
        self.visit_posed(pose, &mut |node, _, primitive, posed| {
            let material = primitive.material.and_then(|m| self.materials.get(m));
            let name = material.map_or("", |material| material.name.as_str());
            let (triangles, _) = primitive.indices.as_chunks::<3>();
            triangles
                .iter()
                .filter_map(|triangle| posed.corners(triangle))
                .for_each(|corners| visit(node, name, corners));
        });
    }

    /// Calls `visit` with the node, the number in its mesh, and the place in the world of every
    /// primitive that is drawn at a pose.
    fn visit_posed(&self, pose: &Pose, visit: &mut dyn FnMut(usize, usize, &Primitive, &Posed)) {
        for (index, node) in self.nodes.iter().enumerate() {
            let Some(mesh) = node.mesh.and_then(|mesh| self.meshes.get(mesh)) else { continue };
            if !pose.visible.get(index).copied().unwrap_or(false) {
                continue;
            }
            let world_from_node = pose.world_from_node.get(index).copied().unwrap_or_default();
            let weights = pose.morph_weights.get(index).map_or(&[][..], Vec::as_slice);
            let joints = pose.world_from_rest(self, index).unwrap_or_default();
            for (number, primitive) in mesh.primitives.iter().enumerate() {
                let posed = Posed::new(primitive, &world_from_node, &joints, weights);
                visit(index, number, primitive, &posed);
            }
        }
    }
}

/// A primitive in its place.
struct Posed {
    points: Vec<Vec3>,
    normals: Vec<Vec3>,
    mirrored: bool,
}

impl Posed {
    fn new(
        primitive: &Primitive,
        world_from_node: &Affine3A,
        joints: &[Affine3A],
        weights: &[f32],
    ) -> Self {
        let is_skinned = !joints.is_empty() && !primitive.joints.is_empty();
        let matrix = |vertex: usize| -> Affine3A {
            if !is_skinned {
                return *world_from_node;
            }
            let mut sum = Affine3A { matrix3: glam::Mat3A::ZERO, translation: glam::Vec3A::ZERO };
            let bound = primitive.joints[vertex].iter().zip(&primitive.weights[vertex]);
            for (&joint, &weight) in bound {
                if let Some(m) = joints.get(usize::from(joint)) {
                    sum.matrix3 += m.matrix3 * weight;
                    sum.translation += m.translation * weight;
                }
            }
            sum
        };
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for vertex in 0..primitive.positions.len() {
            let mut p = primitive.positions[vertex];
            let mut n = primitive.normals.get(vertex).copied().unwrap_or(Vec3::Z);
            for (target, &weight) in primitive.morph_targets.iter().zip(weights) {
                p += weight * target.positions.get(vertex).copied().unwrap_or_default();
                n += weight * target.normals.get(vertex).copied().unwrap_or_default();
            }
            let m = matrix(vertex);
            points.push(m.transform_point3(p));
            // As the deformation does: by the cofactors, which exist where no inverse does.
            let r = Mat3::from(m.matrix3);
            let cofactors = Mat3::from_cols(
                r.y_axis.cross(r.z_axis),
                r.z_axis.cross(r.x_axis),
                r.x_axis.cross(r.y_axis),
            );
            let side = if r.determinant() < 0.0 { -1.0 } else { 1.0 };
            normals.push((side * (cofactors * n)).normalize_or_zero());
        }
        let first = if is_skinned { joints.first() } else { Some(world_from_node) };
        let mirrored = first.is_some_and(|m| m.matrix3.determinant() < 0.0);
        Self { points, normals, mirrored }
    }

    fn corners(&self, triangle: &[u32; 3]) -> Option<[Vec3; 3]> {
        let [a, b, c] = triangle.map(|index| self.points.get(index as usize).copied());
        Some([a?, b?, c?])
    }

    fn normal(&self, triangle: &[u32; 3], weights: [f32; 3]) -> Vec3 {
        let at = |k: usize| self.normals.get(triangle[k] as usize).copied().unwrap_or_default();
        let sum: Vec3 = (0..3).map(|k| at(k) * weights[k]).sum();
        let flat = || {
            let [a, b, c] = self.corners(triangle).unwrap_or_default();
            (b - a).cross(c - a).normalize_or(Vec3::Z)
        };
        sum.try_normalize().unwrap_or_else(flat)
    }
}
