//! Unique edges of a triangle mesh with both faces, and normals averaged over equal places.

use std::{
    collections::HashMap,
    hash::{BuildHasherDefault, Hasher},
};

use glam::Vec3;

use crate::render::generated::{Edge, NO_VERTEX};
use crate::scene::Primitive;

/// For each vertex the first one at the same place with the same bones: split normals and UV
/// seams are one vertex again.
pub(crate) fn weld(primitive: &Primitive) -> Vec<u32> {
    let mut first_at: HashMap<[u32; 8], u32, BuildHasherDefault<MixHasher>> =
        HashMap::with_capacity_and_hasher(primitive.positions.len(), BuildHasherDefault::default());
    (0..primitive.positions.len())
        .map(|i| {
            // + 0.0 makes −0 the same place as 0.
            let p = primitive.positions[i] + Vec3::ZERO;
            let [a, b, c, d] = primitive.joints.get(i).copied().unwrap_or_default().map(u32::from);
            let w = primitive.weights.get(i).copied().unwrap_or_default();
            let weights = w.map(|w| (w * 65535.0) as u32);
            let key = [
                p.x.to_bits(),
                p.y.to_bits(),
                p.z.to_bits(),
                a | b << 16,
                c | d << 16,
                weights[0] | weights[1] << 16,
                weights[2] | weights[3] << 16,
                0,
            ];
            *first_at.entry(key).or_insert(i as u32)
        })
        .collect()
}

/// Multiply-and-rotate hashing: the keys are coordinates, not an attacker's choice of buckets, and
/// there are millions of them.
#[derive(Default)]
struct MixHasher(u64);

impl Hasher for MixHasher {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            let mixed = self.0.rotate_left(23) ^ u64::from_le_bytes(word);
            self.0 = mixed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            self.0 ^= self.0 >> 31;
        }
    }
}

/// An edge with the triangle to its left, in the primitive's own vertex numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceEdge {
    pub(crate) edge: Edge,
    /// The left triangle.
    pub(crate) triangle: u32,
}

/// Every edge once. Two faces share an edge if they run along it in opposite directions; further
/// faces (non-manifold meshes) and faces without a partner give borders.
pub(crate) fn unique_edges(indices: &[u32], welded: &[u32]) -> Vec<FaceEdge> {
    // Half edges sorted by their lower welded vertex (a counting sort), then matched within each
    // small bucket: linear in the number of triangles.
    let corner = |triangle: usize, i: usize| indices[3 * triangle + i % 3];
    let place = |v: u32| welded[v as usize];
    let triangles = indices.len() / 3;
    let mut starts = vec![0u32; welded.len() + 1];
    let is_degenerate = |t: usize| {
        let [a, b, c] = [0, 1, 2].map(|i| place(corner(t, i)));
        a == b || b == c || c == a
    };
    for t in (0..triangles).filter(|&t| !is_degenerate(t)) {
        for i in 0..3 {
            starts[place(corner(t, i)).min(place(corner(t, i + 1))) as usize + 1] += 1;
        }
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut half_edges = vec![0u32; starts.last().map_or(0, |&n| n as usize)];
    let mut next = starts.clone();
    for t in (0..triangles).filter(|&t| !is_degenerate(t)) {
        for i in 0..3 {
            let low = place(corner(t, i)).min(place(corner(t, i + 1))) as usize;
            half_edges[next[low] as usize] = (3 * t + i) as u32;
            next[low] += 1;
        }
    }
    let ends = |half: u32| {
        let (t, i) = (half as usize / 3, half as usize % 3);
        (corner(t, i), corner(t, i + 1), corner(t, i + 2))
    };
    let mut edges = Vec::with_capacity(half_edges.len() / 2 + 16);
    let mut used: Vec<bool> = Vec::new();
    for bucket in starts.windows(2) {
        let bucket = &half_edges[bucket[0] as usize..bucket[1] as usize];
        used.clear();
        used.resize(bucket.len(), false);
        for (i, &half) in bucket.iter().enumerate() {
            if used[i] {
                continue;
            }
            let (v0, v1, left) = ends(half);
            let partner = (i + 1..bucket.len()).find(|&j| {
                let (w0, w1, _) = ends(bucket[j]);
                !used[j] && place(w0) == place(v1) && place(w1) == place(v0)
            });
            let right = partner.map_or(NO_VERTEX, |j| {
                used[j] = true;
                ends(bucket[j]).2
            });
            edges.push(FaceEdge { edge: Edge { v0, v1, left, right }, triangle: half / 3 });
        }
    }
    edges
}

/// Per vertex the mean of the normals of all faces at its place, weighted by their angle there.
pub(crate) fn smooth_normals(primitive: &Primitive, welded: &[u32]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; welded.len()];
    for triangle in primitive.indices.chunks_exact(3) {
        let p = [0, 1, 2].map(|i| primitive.positions[triangle[i] as usize]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        for i in 0..3 {
            let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            let angle = a.cross(b).length().atan2(a.dot(b));
            if angle.is_finite() {
                sums[welded[triangle[i] as usize] as usize] += angle * face;
            }
        }
    }
    welded
        .iter()
        .zip(&primitive.normals)
        .map(|(&place, &normal)| sums[place as usize].try_normalize().unwrap_or(normal))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn primitive(positions: &[[f32; 3]], indices: &[u32]) -> Primitive {
        Primitive {
            positions: positions.iter().map(|&p| Vec3::from(p)).collect(),
            normals: vec![Vec3::Z; positions.len()],
            indices: indices.to_vec(),
            ..Primitive::default()
        }
    }

    /// A cube with four vertices of its own on every face, as files with flat shading have it.
    fn split_cube() -> Primitive {
        let mut positions = Vec::new();
        let mut indices = Vec::new();
        for axis in 0..3 {
            for side in [-1.0_f32, 1.0] {
                let first = positions.len() as u32;
                for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                    let mut p = [0.0; 3];
                    p[axis] = side;
                    p[(axis + 1) % 3] = u * side;
                    p[(axis + 2) % 3] = v;
                    positions.push(p);
                }
                indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
            }
        }
        primitive(&positions, &indices)
    }

    #[test]
    fn a_cube_with_split_normals_has_18_closed_edges() {
        let cube = split_cube();
        let edges = unique_edges(&cube.indices, &weld(&cube));
        assert_eq!(edges.len(), 18); // 12 of the cube, 6 diagonals
        assert!(edges.iter().all(|e| e.edge.right != NO_VERTEX));
    }

    #[test]
    fn smooth_normals_of_a_cube_point_along_its_diagonals() {
        let cube = split_cube();
        let normals = smooth_normals(&cube, &weld(&cube));
        for (p, n) in cube.positions.iter().zip(normals) {
            assert!(p.normalize().dot(n) > 0.99999, "{p} {n}");
        }
    }

    #[test]
    fn an_open_triangle_has_three_borders() {
        let p = primitive(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[0, 1, 2]);
        let edges = unique_edges(&p.indices, &weld(&p));
        assert_eq!(edges.len(), 3);
        assert!(edges.iter().all(|e| e.edge.right == NO_VERTEX));
    }

    #[test]
    fn a_third_face_on_an_edge_gives_a_border_and_degenerate_triangles_none() {
        let corners =
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let p = primitive(&corners, &[0, 1, 2, 1, 0, 3, 0, 1, 4, 0, 0, 1]);
        let edges = unique_edges(&p.indices, &weld(&p));
        assert_eq!(edges.len(), 8); // the shared one twice: as a pair and as a border
        assert_eq!(edges.iter().filter(|e| e.edge.right == NO_VERTEX).count(), 7);
    }

    #[test]
    fn vertices_of_different_bones_stay_apart() {
        let mut p = primitive(&[[0.0; 3], [0.0; 3]], &[]);
        p.joints = vec![[0; 4], [1, 0, 0, 0]];
        p.weights = vec![[1.0, 0.0, 0.0, 0.0]; 2];
        assert_eq!(weld(&p), [0, 1]);
    }
}
