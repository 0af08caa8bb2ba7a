//! Posed triangles in f64, and which of them each pixel sees.

use genga::render::View;
use genga::scene::{Pose, Primitive, Scene};
use glam::{Affine3A, DMat3, DVec2, DVec3, Vec3};

use crate::eye::Eye;

/// A triangle in world space.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Its corners.
    pub corners: [DVec3; 3],
    /// Shading normals there, of unit length.
    pub normals: [DVec3; 3],
    /// The normal of its plane on the outer side, not of unit length; mirroring is undone.
    pub outward: DVec3,
    /// Node, material.
    pub owner: (usize, Option<usize>),
    /// Whether it is seen from behind as well.
    pub double_sided: bool,
}

impl Triangle {
    /// Whether its outer side faces the eye.
    #[must_use]
    pub fn faces(&self, eye: &Eye) -> bool {
        self.outward.dot(eye.towards(self.corners[0])) > 0.0
    }
}

fn wide(m: Affine3A) -> (DMat3, DVec3) {
    let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
    let wide = |v| Vec3::from(v).as_dvec3();
    (DMat3::from_cols(wide(x), wide(y), wide(z)), Vec3::from(m.translation).as_dvec3())
}

/// The cofactor matrix turns normals; its sign keeps them outside under reflections.
fn normal_matrix(m: DMat3) -> DMat3 {
    let side = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    side * DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y))
}

/// Position, normal of a vertex in world space, and whether its transform mirrors.
fn vertex(
    primitive: &Primitive,
    v: usize,
    morph_weights: &[f32],
    joints: Option<&[Affine3A]>,
    node: Affine3A,
) -> (DVec3, DVec3, bool) {
    let (mut p, mut n) = (primitive.positions[v].as_dvec3(), primitive.normals[v].as_dvec3());
    for (target, &weight) in primitive.morph_targets.iter().zip(morph_weights) {
        let offset = |offsets: &[Vec3]| offsets.get(v).map_or(DVec3::ZERO, |o| o.as_dvec3());
        p += f64::from(weight) * offset(&target.positions);
        n += f64::from(weight) * offset(&target.normals);
    }
    let (linear, shift) = match joints {
        Some(joints) if !primitive.joints.is_empty() => {
            let weights = primitive.weights[v].map(f64::from);
            let total: f64 = weights.iter().sum();
            let mut sum = (DMat3::ZERO, DVec3::ZERO);
            for (joint, weight) in primitive.joints[v].into_iter().zip(weights) {
                let (linear, shift) = wide(joints[usize::from(joint)]);
                sum = (sum.0 + weight / total * linear, sum.1 + weight / total * shift);
            }
            sum
        }
        _ => wide(node),
    };
    let normal = normal_matrix(linear) * n;
    (linear * p + shift, normal.normalize_or_zero(), linear.determinant() < 0.0)
}

/// All triangles of a posed scene, in the order of nodes, primitives and indices.
#[must_use]
pub fn triangles(scene: &Scene, pose: &Pose) -> Vec<Triangle> {
    let mut result = Vec::new();
    for (n, node) in scene.nodes.iter().enumerate().filter(|(n, _)| pose.visible[*n]) {
        let Some(mesh) = node.mesh else { continue };
        let joints = pose.world_from_rest(scene, n);
        for primitive in &scene.meshes[mesh].primitives {
            let vertices: Vec<_> = (0..primitive.positions.len())
                .map(|v| {
                    let (weights, node) = (&pose.morph_weights[n], pose.world_from_node[n]);
                    vertex(primitive, v, weights, joints.as_deref(), node)
                })
                .collect();
            for corner in primitive.indices.as_chunks::<3>().0 {
                let corners = corner.map(|v| vertices[v as usize].0);
                let [a, b, c] = corners;
                let side = if vertices[corner[0] as usize].2 { -1.0 } else { 1.0 };
                result.push(Triangle {
                    corners,
                    normals: corner.map(|v| vertices[v as usize].1),
                    outward: side * (b - a).cross(c - a),
                    owner: (n, primitive.material),
                    double_sided: primitive
                        .material
                        .is_some_and(|m| scene.materials[m].double_sided),
                });
            }
        }
    }
    result
}

/// What a pixel's line of sight meets first.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Index of the triangle.
    pub triangle: usize,
    /// Distance along the camera's axis in metres.
    pub distance: f64,
    /// Weights of the triangle's corners.
    pub weights: [f64; 3],
    /// Whether the middle of the pixel is so near to a triangle's edge that rounding may decide.
    pub unsure: bool,
}

/// Distance in pixels from a triangle's edge within which rounding may decide: vertices are
/// rounded to 1/256 texel.
const UNSURE_PX: f64 = 0.02;

/// What every pixel sees, row by row; all triangles must be in front of the camera.
///
/// # Panics
/// If a triangle reaches behind the near plane.
#[must_use]
pub fn cast(view: &View, triangles: &[Triangle]) -> Vec<Option<Hit>> {
    let eye = Eye::new(view);
    let [width, height] = view.size;
    let mut hits: Vec<Option<Hit>> = vec![None; (width * height) as usize];
    let mut unsure = vec![false; hits.len()];
    for (index, triangle) in triangles.iter().enumerate() {
        let facing = triangle.faces(&eye);
        if !facing && !triangle.double_sided {
            continue;
        }
        assert!(triangle.corners.iter().all(|&p| eye.distance(p) > eye.near), "behind the camera");
        let corners = triangle.corners.map(|p| eye.project(p));
        let [a, b, c] = corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |low: f64, high: f64, size: u32| {
            (low - 1.0).clamp(0.0, f64::from(size)) as u32
                ..(high + 1.0).clamp(0.0, f64::from(size)) as u32
        };
        for y in range(low.y, high.y, height) {
            for x in range(low.x, high.x, width) {
                let p_px = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let slot = (y * width + x) as usize;
                if distance_to_outline(p_px, corners) < UNSURE_PX {
                    unsure[slot] = true;
                }
                let ray = eye.ray(p_px);
                let Some((distance, [v, w])) = ray.meets(triangle.corners) else { continue };
                if hits[slot].is_none_or(|hit| distance < hit.distance) {
                    let weights = [1.0 - v - w, v, w];
                    hits[slot] = Some(Hit { triangle: index, distance, weights, unsure: false });
                }
            }
        }
    }
    for (hit, unsure) in hits.iter_mut().zip(unsure) {
        if let Some(hit) = hit {
            hit.unsure = unsure;
        }
    }
    hits
}

/// Distance of a point from a segment.
#[must_use]
pub fn distance_to_segment(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0);
    (p - a - t * along).length()
}

fn distance_to_outline(p: DVec2, [a, b, c]: [DVec2; 3]) -> f64 {
    [[a, b], [b, c], [c, a]]
        .map(|edge| distance_to_segment(p, edge))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

impl Hit {
    /// The interpolated shading normal.
    #[must_use]
    pub fn normal(&self, triangles: &[Triangle]) -> DVec3 {
        let normals = triangles[self.triangle].normals;
        let sum = normals[0] * self.weights[0]
            + normals[1] * self.weights[1]
            + normals[2] * self.weights[2];
        sum.normalize_or_zero()
    }
}
