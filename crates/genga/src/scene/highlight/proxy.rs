//! Smooth stand-ins for bumpy surfaces.

use std::sync::Arc;

use glam::{Affine3A, Mat3, Quat, Vec3, Vec3A};

use crate::scene::{Mesh, Scene};

/// A shape whose normals stand in for the surface's. It lives in the highlight's node.
#[derive(Clone, Debug, PartialEq)]
pub enum Proxy {
    /// `normalize(p − O)`.
    Sphere {
        /// O.
        center: Vec3,
    },
    /// `normalize(q − O)`, where q is the place at which the line of sight to p meets the ball, or
    /// comes nearest to it: the drawing is seen as on the smooth ball, however far the surface
    /// steps out of it. (The normal at p itself moves drawings on steps that stand off the ball.)
    Ball {
        /// O.
        center: Vec3,
        /// In metres of the node, > 0.
        radius: f32,
    },
    /// `normalize(AᵀA(p − O))` with `A = diag(1/radii) · rotation⁻¹`.
    Ellipsoid {
        /// O.
        center: Vec3,
        /// Half axes, > 0. Only their ratios count.
        radii: Vec3,
        /// Turn of the axes.
        rotation: Quat,
    },
    /// From the nearest point of a line, usually along a bone.
    Capsule {
        /// One end.
        from: Vec3,
        /// The other end.
        to: Vec3,
    },
    /// The same normal everywhere.
    Plane {
        /// Where light and view are seen from.
        center: Vec3,
        /// Its normal.
        normal: Vec3,
    },
    /// The normal where the ray from the centre through the surface's point meets a mesh.
    Mesh {
        /// The centre, inside of the mesh.
        center: Vec3,
        /// The mesh.
        mesh: Arc<ProxyMesh>,
    },
}

/// A simple mesh near a surface, in the highlight's node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProxyMesh {
    /// Corners, in metres.
    pub positions: Vec<Vec3>,
    /// Unit normals at the corners.
    pub normals: Vec<Vec3>,
    /// Triangles.
    pub indices: Vec<[u32; 3]>,
}

/// Texels along a side of the map that holds a mesh's normals by direction.
pub(crate) const NORMAL_MAP_SIZE: usize = 64;

impl Proxy {
    /// Where light and view are seen from, in the node's space.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        match self {
            Self::Sphere { center }
            | Self::Ball { center, .. }
            | Self::Ellipsoid { center, .. }
            | Self::Plane { center, .. }
            | Self::Mesh { center, .. } => *center,
            Self::Capsule { from, to } => 0.5 * (*from + *to),
        }
    }

    /// Unit normal in the world at a point of the world, for a node that stands there; `None` at
    /// the centre of the proxy. A ball takes the point as the place of its surface: see
    /// [`Proxy::seen`].
    #[must_use]
    pub fn normal(&self, world_from_node: &Affine3A, point: Vec3) -> Option<Vec3> {
        let shape = ProxyShape::new(self, world_from_node);
        let q = point - shape.origin;
        let d = q - shape.axis * q.dot(shape.axis).clamp(0.0, shape.axis_length);
        let n = shape.normals * d + shape.offset;
        match self {
            Self::Mesh { center, mesh } => {
                let n = mesh.normal_along(*center, n.try_normalize()?);
                (shape.normals.transpose() * n).try_normalize()
            }
            _ => n.try_normalize(),
        }
    }

    /// The point that stands in for a surface's point, for an eye in the direction `to_eye` (unit
    /// vector), all in the world: on a ball's surface, the point itself for other proxies.
    #[must_use]
    pub fn seen(&self, world_from_node: &Affine3A, point: Vec3, to_eye: Vec3) -> Vec3 {
        if !matches!(self, Self::Ball { .. }) {
            return point;
        }
        let shape = ProxyShape::new(self, world_from_node);
        let q = point - shape.origin;
        let along = q.dot(to_eye);
        let inside = along * along - q.length_squared() + shape.radius * shape.radius;
        point + to_eye * (inside.max(0.0).sqrt() - along)
    }

    pub(in crate::scene) fn validate(&self) -> Result<(), String> {
        let vectors: [Vec3; 2] = match self {
            Self::Sphere { center } => [*center; 2],
            Self::Ball { center, radius } => {
                if !(radius.is_finite() && *radius > 0.0) {
                    return Err("has a proxy with a radius that is not above 0".to_owned());
                }
                [*center; 2]
            }
            Self::Ellipsoid { center, radii, rotation } => {
                if !(radii.is_finite() && radii.cmpgt(Vec3::ZERO).all()) {
                    return Err("has a proxy with a radius that is not above 0".to_owned());
                }
                if !rotation.is_finite() {
                    return Err("has a proxy that is turned by no number".to_owned());
                }
                [*center; 2]
            }
            Self::Capsule { from, to } => [*from, *to],
            Self::Plane { center, normal } => {
                if normal.try_normalize().is_none() {
                    return Err("has a proxy plane whose normal is no direction".to_owned());
                }
                [*center; 2]
            }
            Self::Mesh { center, mesh } => {
                mesh.validate()?;
                [*center; 2]
            }
        };
        if vectors.iter().all(|v| v.is_finite()) {
            Ok(())
        } else {
            Err("has a proxy whose place is not a finite number".to_owned())
        }
    }
}

/// A proxy in world space, as one formula: the normal at p is along
/// `normals · (q − axis · clamp(q·axis, 0, axis_length)) + offset` with `q = p − origin`.
pub(crate) struct ProxyShape {
    pub(crate) origin: Vec3,
    pub(crate) axis: Vec3,
    pub(crate) axis_length: f32,
    pub(crate) normals: Mat3,
    pub(crate) offset: Vec3,
    /// Of a ball, in the world's metres; 0 for the other proxies.
    pub(crate) radius: f32,
}

impl ProxyShape {
    pub(crate) fn new(proxy: &Proxy, world_from_node: &Affine3A) -> Self {
        let point = |p: Vec3| world_from_node.transform_point3(p);
        let linear = Mat3::from(world_from_node.matrix3);
        // Scaled to about 1, since only directions count.
        let size = linear.to_cols_array().into_iter().fold(0.0_f32, |a, x| a.max(x.abs()));
        let linear = if size > 0.0 { linear * (1.0 / size) } else { Mat3::IDENTITY };
        let inverse = linear.inverse();
        let inverse = if inverse.is_finite() { inverse } else { Mat3::IDENTITY };
        let mut shape = Self {
            origin: point(proxy.center()),
            axis: Vec3::ZERO,
            axis_length: 0.0,
            normals: inverse.transpose() * inverse,
            offset: Vec3::ZERO,
            radius: 0.0,
        };
        match proxy {
            Proxy::Sphere { .. } => {}
            Proxy::Ball { radius, .. } => {
                let volume = Mat3::from(world_from_node.matrix3).determinant().abs();
                shape.radius = radius * volume.cbrt();
            }
            Proxy::Ellipsoid { radii, rotation, .. } => {
                let largest = radii.max_element();
                let scale = Mat3::from_diagonal(largest / *radii);
                let a = scale * Mat3::from_quat(rotation.normalize().inverse()) * inverse;
                shape.normals = a.transpose() * a;
            }
            Proxy::Capsule { from, to } => {
                let (from, to) = (point(*from), point(*to));
                shape.origin = from;
                if let Some(axis) = (to - from).try_normalize() {
                    shape.axis = axis;
                    shape.axis_length = (to - from).length();
                }
                shape.normals = Mat3::IDENTITY;
            }
            Proxy::Plane { normal, .. } => {
                shape.normals = Mat3::ZERO;
                shape.offset = (inverse.transpose() * *normal).normalize_or(Vec3::Z);
            }
            Proxy::Mesh { .. } => shape.normals = inverse,
        }
        if !(shape.origin.is_finite() && shape.normals.is_finite()) {
            (shape.origin, shape.normals) = (Vec3::ZERO, Mat3::IDENTITY);
        }
        shape
    }
}

impl ProxyMesh {
    /// The triangles of a node of the scene at its rest pose, in the space of the node `into` (the
    /// world for `None`); `None` if the node has no mesh.
    #[must_use]
    pub fn from_node(scene: &Scene, node: usize, into: Option<usize>) -> Option<Self> {
        let pose = crate::scene::Pose::rest(scene);
        let mesh = scene.meshes.get(scene.nodes.get(node)?.mesh?)?;
        let world_from_node = *pose.world_from_node.get(node)?;
        let world_from_into =
            into.and_then(|into| pose.world_from_node.get(into).copied()).unwrap_or_default();
        let into_from_node = world_from_into.inverse() * world_from_node;
        Some(Self::from_mesh(mesh, &into_from_node))
    }

    /// The triangles of a mesh, brought to the highlight's node.
    #[must_use]
    pub fn from_mesh(mesh: &Mesh, into_from_mesh: &Affine3A) -> Self {
        let turn = Mat3::from(into_from_mesh.matrix3).inverse().transpose();
        let mut result = Self::default();
        for primitive in &mesh.primitives {
            let first = result.positions.len() as u32;
            let placed = primitive.positions.iter().map(|&p| into_from_mesh.transform_point3(p));
            result.positions.extend(placed);
            let turned = primitive.normals.iter().map(|&n| (turn * n).normalize_or_zero());
            result.normals.extend(turned);
            let (triangles, _) = primitive.indices.as_chunks::<3>();
            result.indices.extend(triangles.iter().map(|t| t.map(|index| first + index)));
        }
        result
    }

    fn validate(&self) -> Result<(), String> {
        let count = self.positions.len();
        let in_range = |t: &[u32; 3]| t.iter().all(|&index| (index as usize) < count);
        if self.indices.is_empty()
            || self.normals.len() != count
            || !self.indices.iter().all(in_range)
        {
            return Err("has a proxy mesh without whole triangles".to_owned());
        }
        let finite = |v: &Vec3| v.is_finite();
        if !(self.positions.iter().all(finite) && self.normals.iter().all(finite)) {
            return Err("has a proxy mesh with a coordinate that is not a finite number".to_owned());
        }
        Ok(())
    }

    /// Normal where the ray from `center` leaves the mesh; the direction itself if it misses.
    #[must_use]
    pub fn normal_along(&self, center: Vec3, direction: Vec3) -> Vec3 {
        let mut farthest = (0.0_f32, direction);
        for triangle in &self.indices {
            let corners = triangle.map(|index| self.positions.get(index as usize).copied());
            let [Some(a), Some(b), Some(c)] = corners else { continue };
            let Some((t, weights)) = ray_triangle(center, direction, [a, b, c]) else { continue };
            if t > farthest.0 {
                let normals =
                    triangle.map(|i| self.normals.get(i as usize).copied().unwrap_or(direction));
                let n = (0..3).map(|i| normals[i] * weights[i]).sum::<Vec3>();
                farthest = (t, n.normalize_or(direction));
            }
        }
        farthest.1
    }

    /// Normals by direction from the centre: an octahedral map of `NORMAL_MAP_SIZE`² texels with a
    /// border of one texel, so that it can be filtered. Row 0 is the lowest y of the map.
    pub(crate) fn normal_map(&self, center: Vec3) -> Vec<Vec3> {
        let size = NORMAL_MAP_SIZE as i32;
        let side = size + 2;
        let inner: Vec<Vec3> = (0..size * size)
            .map(|i| {
                let at = |k: i32| (k as f32 + 0.5) / size as f32 * 2.0 - 1.0;
                self.normal_along(center, octahedral_direction(at(i % size), at(i / size)))
            })
            .collect();
        (0..side * side)
            .map(|i| {
                // Over an edge the map goes on in the same side, turned by 180°.
                let (mut x, mut y) = (i % side - 1, i / side - 1);
                if x < 0 || x >= size {
                    (x, y) = (x.clamp(0, size - 1), size - 1 - y);
                }
                if y < 0 || y >= size {
                    (x, y) = (size - 1 - x, y.clamp(0, size - 1));
                }
                inner[(y * size + x) as usize]
            })
            .collect()
    }
}

/// The direction of a place in [−1, 1]² of an octahedral map (Cigolle et al. 2014).
fn octahedral_direction(x: f32, y: f32) -> Vec3 {
    let z = 1.0 - x.abs() - y.abs();
    let fold = |a: f32, b: f32| (1.0 - b.abs()) * if a < 0.0 { -1.0 } else { 1.0 };
    let (x, y) = if z < 0.0 { (fold(x, y), fold(y, x)) } else { (x, y) };
    Vec3::new(x, y, z).normalize_or(Vec3::Z)
}

/// Distance along a ray to a triangle seen from either side, and the weights of its corners there
/// (Möller and Trumbore 1997).
pub(crate) fn ray_triangle(
    origin: Vec3,
    direction: Vec3,
    [a, b, c]: [Vec3; 3],
) -> Option<(f32, [f32; 3])> {
    let (origin, direction) = (Vec3A::from(origin), Vec3A::from(direction));
    let (a, b, c) = (Vec3A::from(a), Vec3A::from(b), Vec3A::from(c));
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = origin - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(ab);
    let v = direction.dot(q) / determinant;
    let t = ac.dot(q) / determinant;
    // Written so that NaN fails. A little beyond the edges counts, so that no ray slips between.
    let slack = 1e-6;
    (u >= -slack && v >= -slack && u + v <= 1.0 + slack && t > 0.0)
        .then_some((t, [1.0 - u - v, u, v]))
}
