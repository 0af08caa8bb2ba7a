use glam::{Affine3A, Vec3, Vec3A};

use super::{Mesh, Pose, Primitive, Scene};

/// A box along the axes that is not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the least coordinates.
    pub min: Vec3,
    /// The corner with the greatest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box of a single point.
    #[must_use]
    pub fn from_point(point: Vec3) -> Self {
        Self { min: point, max: point }
    }

    /// The least box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The middle.
    #[must_use]
    pub fn center(self) -> Vec3 {
        // Halved first, so that opposite huge corners do not overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Lengths of the edges.
    #[must_use]
    pub fn size(self) -> Vec3 {
        self.max - self.min
    }

    /// Radius of the sphere about the centre through the corners.
    #[must_use]
    pub fn radius(self) -> f32 {
        (self.size().as_dvec3() * 0.5).length() as f32
    }
}

impl Scene {
    /// The box around all triangles' corners in world space at a pose, with morph targets and
    /// skins applied; `None` if nothing is drawn.
    ///
    /// It visits every vertex on the CPU. Places that are not finite do not count.
    #[must_use]
    pub fn bounds(&self, pose: &Pose) -> Option<Aabb> {
        let mut bounds = Bounds::default();
        self.visit_points(pose, &mut |point| bounds.add(point));
        bounds.finish()
    }

    /// Points at a pose that stick out farthest in 64 directions: enough to fit a camera closely,
    /// however large the scene is. In a scene of waves and beams alone, places round these. Empty if nothing
    /// is drawn.
    ///
    /// It visits every vertex on the CPU.
    #[must_use]
    pub fn extremes(&self, pose: &Pose) -> Vec<Vec3> {
        // A Fibonacci lattice covers the sphere evenly.
        let directions: [Vec3A; 64] = std::array::from_fn(|i| {
            let z = 1.0 - (2.0 * i as f32 + 1.0) / 64.0;
            let (sin, cos) = (i as f32 * 2.399_963_2).sin_cos();
            Vec3A::new(cos * (1.0 - z * z).sqrt(), z, sin * (1.0 - z * z).sqrt())
        });
        let mut farthest = [(f32::NEG_INFINITY, Vec3A::ZERO); 64];
        self.visit_points(pose, &mut |point| {
            if point.is_finite() {
                for (slot, direction) in farthest.iter_mut().zip(&directions) {
                    let distance = point.dot(*direction);
                    if distance > slot.0 {
                        *slot = (distance, point);
                    }
                }
            }
        });
        if farthest[0].0 == f32::NEG_INFINITY {
            let beams = self.beams.iter().filter(|beam| beam.check(self.nodes.len()).is_ok());
            let beams = beams.flat_map(|beam| beam.mesh(pose).positions);
            return self.wave_places(pose).into_iter().chain(beams).collect();
        }
        farthest.iter().filter(|(d, _)| *d > f32::NEG_INFINITY).map(|(_, p)| (*p).into()).collect()
    }

    /// Places along the waves, and at half a radius round their ends.
    fn wave_places(&self, pose: &Pose) -> Vec<Vec3> {
        let waves = self.waves.iter().filter(|wave| wave.check(self.nodes.len()).is_ok());
        waves
            .flat_map(|wave| {
                let mut places = wave.places(pose, 65);
                let around = 0.5 * wave.radius.unwrap_or(1.0);
                for end in [places[0], places[64]] {
                    places.extend(Vec3::AXES.map(|axis| end + axis * around));
                    places.extend(Vec3::AXES.map(|axis| end - axis * around));
                }
                places
            })
            .collect()
    }

    /// Calls `visit` with the place of every vertex that is drawn.
    fn visit_points(&self, pose: &Pose, visit: &mut dyn FnMut(Vec3A)) {
        for (index, node) in self.nodes.iter().enumerate() {
            let Some(mesh) = node.mesh.and_then(|mesh| self.meshes.get(mesh)) else { continue };
            if !pose.visible.get(index).copied().unwrap_or(false) {
                continue;
            }
            let world_from_node = pose.world_from_node.get(index).copied().unwrap_or_default();
            let morph_weights = pose.morph_weights.get(index).map_or(&[][..], Vec::as_slice);
            let world_from_rest = pose.world_from_rest(self, index).unwrap_or_default();
            visit_mesh(mesh, &world_from_node, &world_from_rest, morph_weights, visit);
        }
    }
}

/// A box that grows; empty at first.
struct Bounds {
    min: Vec3A,
    max: Vec3A,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY }
    }
}

impl Bounds {
    fn add(&mut self, point: Vec3A) {
        if point.is_finite() {
            self.min = self.min.min(point);
            self.max = self.max.max(point);
        }
    }

    fn finish(&self) -> Option<Aabb> {
        self.min.cmple(self.max).all().then(|| Aabb { min: self.min.into(), max: self.max.into() })
    }
}

fn visit_mesh(
    mesh: &Mesh,
    world_from_node: &Affine3A,
    world_from_rest: &[Affine3A],
    morph_weights: &[f32],
    visit: &mut dyn FnMut(Vec3A),
) {
    for primitive in mesh.primitives.iter().filter(|p| !p.indices.is_empty()) {
        let morphed;
        let positions = if morph_weights.iter().any(|&weight| weight != 0.0) {
            morphed = morphed_positions(primitive, morph_weights);
            &morphed
        } else {
            &primitive.positions
        };
        if world_from_rest.is_empty() || primitive.joints.is_empty() {
            for &position in positions {
                visit(world_from_node.transform_point3a(position.into()));
            }
            continue;
        }
        for (&position, (joints, weights)) in
            positions.iter().zip(primitive.joints.iter().zip(&primitive.weights))
        {
            let position = Vec3A::from(position);
            let mut point = Vec3A::ZERO;
            for (&joint, &weight) in joints.iter().zip(weights) {
                if weight > 0.0
                    && let Some(matrix) = world_from_rest.get(usize::from(joint))
                {
                    point += matrix.transform_point3a(position) * weight;
                }
            }
            visit(point);
        }
    }
}

fn morphed_positions(primitive: &Primitive, morph_weights: &[f32]) -> Vec<Vec3> {
    let mut positions = primitive.positions.clone();
    for (target, &weight) in primitive.morph_targets.iter().zip(morph_weights) {
        if weight != 0.0 {
            for (position, &offset) in positions.iter_mut().zip(&target.positions) {
                *position += offset * weight;
            }
        }
    }
    positions
}
