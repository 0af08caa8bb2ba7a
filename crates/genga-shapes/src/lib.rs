//! Meshes made by formula, the same bytes on every machine.
//!
//! This is its own small crate so that tools can make models without building a renderer.
//! Sines and cosines come from [`libm`] rather than the system, whose last digits differ.

mod basic;
mod smooth;

use glam::{DVec3, Vec2, Vec3};

pub use basic::{cuboid, cylinder, plane, uv_sphere};
pub use smooth::{CountError, smooth_object, smooth_object_with_vertices};

/// An indexed triangle mesh, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Positions in metres, +Y up.
    pub positions: Vec<Vec3>,
    /// Unit normals, one per position.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one per position, (0, 0) at the top left; empty without any.
    pub uvs: Vec<Vec2>,
    /// Three per triangle.
    pub indices: Vec<u32>,
}

impl Shape {
    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Volume inside a closed shape in m³, by the divergence theorem; negative when it is inside
    /// out.
    #[must_use]
    pub fn signed_volume(&self) -> f64 {
        let corner = |i: &u32| self.positions[*i as usize].as_dvec3();
        let six_times: f64 = self
            .indices
            .chunks_exact(3)
            .map(|t| corner(&t[0]).dot(corner(&t[1]).cross(corner(&t[2]))))
            .sum();
        six_times / 6.0
    }

    fn push(&mut self, position: DVec3, normal: DVec3) -> u32 {
        self.positions.push(position.as_vec3());
        self.normals.push(normal.normalize_or_zero().as_vec3());
        self.positions.len() as u32 - 1
    }
}

#[cfg(test)]
mod test_support {
    use std::collections::HashMap;

    use super::Shape;

    /// Asserts that every edge, matched by position, is used once in each direction, that no
    /// triangle is without area, that all normals are of unit length and on the outer side.
    pub(crate) fn assert_closed_and_outward(shape: &Shape) {
        let bits = |i: u32| shape.positions[i as usize].to_array().map(|x| (x + 0.0).to_bits());
        let mut edges: HashMap<_, (i32, i32)> = HashMap::new();
        for t in shape.indices.chunks_exact(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| shape.positions[i as usize].as_dvec3());
            let face = (b - a).cross(c - a);
            assert!(face.length() > 0.0, "triangle {t:?} has no area");
            for &i in t {
                let normal = shape.normals[i as usize].as_dvec3();
                assert!((normal.length() - 1.0).abs() < 1e-6, "normal {i} is {normal}");
                assert!(normal.dot(face) > 0.0, "normal {i} points inwards");
            }
            for (from, to) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let (from, to) = (bits(from), bits(to));
                if from < to {
                    edges.entry((from, to)).or_default().0 += 1;
                } else {
                    edges.entry((to, from)).or_default().1 += 1;
                }
            }
        }
        assert!(!edges.is_empty());
        assert!(edges.values().all(|&uses| uses == (1, 1)), "an edge without exactly two faces");
        assert!(shape.signed_volume() > 0.0);
    }
}
