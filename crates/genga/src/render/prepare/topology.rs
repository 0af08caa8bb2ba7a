//! Which triangles of a mesh are neighbours: unique edges over all its primitives, with what makes
//! each a line; normals averaged over equal places; curvature.

use std::{
    collections::HashMap,
    hash::{BuildHasherDefault, Hasher},
};

use glam::{Vec2, Vec3};

use crate::render::generated as gpu;
use crate::scene::{Mesh, Primitive};

/// A triangle's side: three times the triangle plus the corner that it begins at, counted over all
/// primitives of the mesh.
pub(crate) type Half = u32;

/// An edge that can be a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LineEdge {
    pub(crate) left: Half,
    /// `None` on a border.
    pub(crate) right: Option<Half>,
    pub(crate) is_hard: bool,
    /// Left and right triangle: far from their corners' normals.
    pub(crate) is_flat: [bool; 2],
    pub(crate) is_material: bool,
    pub(crate) is_user: bool,
    pub(crate) is_uv_seam: bool,
}

impl LineEdge {
    /// For the GPU, with other numbers for the sides.
    pub(crate) fn packed(&self, left: Half, right: Option<Half>) -> gpu::Edge {
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        gpu::Edge {
            left: left
                | flag(self.is_flat[0], gpu::EDGE_FLAT)
                | flag(self.is_hard, gpu::EDGE_HARD)
                | flag(self.is_material, gpu::EDGE_MATERIAL),
            right: right.unwrap_or(gpu::EDGE_NONE)
                | flag(self.is_flat[1], gpu::EDGE_FLAT)
                | flag(self.is_user, gpu::EDGE_USER)
                | flag(self.is_uv_seam, gpu::EDGE_UV_SEAM),
        }
    }
}

/// What lines need to know of a mesh. Vertices and triangles are counted over all its primitives.
pub(crate) struct Topology {
    /// First vertex of each primitive, then the number of all.
    pub(crate) first_vertex: Vec<u32>,
    /// First triangle of each primitive, then the number of all.
    pub(crate) first_triangle: Vec<u32>,
    /// Sorted by their left triangle.
    pub(crate) edges: Vec<LineEdge>,
    /// Mean of the normals of all faces at a vertex's place, weighted by their angle there.
    pub(crate) smooth_normals: Vec<Vec3>,
    /// Mean curvature in 1/m by the change of normals along edges (Okuya et al. 2015, section
    /// 4.3); positive on convex places.
    pub(crate) curvatures: Vec<f32>,
    /// User line id of each triangle.
    pub(crate) line_ids: Vec<u32>,
    /// Whether contours run through a triangle, not along its sides.
    pub(crate) is_smooth: Vec<bool>,
}

/// Cosine of the largest angle between a triangle and its corners' normals up to which it is taken
/// for a part of a smooth surface. The contour of a coarser one would lie too far from the outline
/// that its triangles have on the picture.
const SMOOTH_COSINE: f32 = 0.978;

/// Cosine of the angle that one triangle of a coarse part has at least: a surface about the limit
/// above does not change from triangle to triangle between what it is.
const COARSE_COSINE: f32 = 0.906;

/// Cosine under which two normals at one place are different ones.
const SAME_NORMAL: f32 = 0.9995;

/// Sine of the angle up to which two faces lie in one plane, by the rounding of their corners.
const COPLANAR_SINE: f32 = 3e-4;

/// All primitives of a mesh, with vertices counted on.
struct Whole<'a> {
    primitives: &'a [Primitive],
    first_vertex: Vec<u32>,
    first_triangle: Vec<u32>,
}

impl Whole<'_> {
    fn primitive_of_triangle(&self, triangle: u32) -> usize {
        self.first_triangle.partition_point(|&first| first <= triangle) - 1
    }

    /// Vertex at the beginning of a side.
    fn corner(&self, primitive: usize, half: Half) -> u32 {
        let own = half - 3 * self.first_triangle[primitive];
        self.first_vertex[primitive] + self.primitives[primitive].indices[own as usize]
    }

    /// Unit normal of a side's triangle; 0 if it has no area.
    fn face(&self, half: Half) -> Vec3 {
        let primitive = self.primitive_of_triangle(half / 3);
        let of = &self.primitives[primitive];
        let first = (half / 3 * 3 - 3 * self.first_triangle[primitive]) as usize;
        let p = [0, 1, 2].map(|i| of.positions[of.indices[first + i] as usize]);
        (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero()
    }

    fn attribute<T: Copy>(&self, vertex: u32, of: impl Fn(&Primitive) -> &[T]) -> Option<T> {
        let primitive = self.first_vertex.partition_point(|&first| first <= vertex) - 1;
        let own = vertex - self.first_vertex[primitive];
        of(&self.primitives[primitive]).get(own as usize).copied()
    }
}

/// The next side of the same triangle.
pub(crate) fn following(half: Half) -> Half {
    if half % 3 == 2 { half - 2 } else { half + 1 }
}

/// The most common of a triangle's three ids; the smallest of three different ones.
fn face_id(ids: [u32; 3]) -> u32 {
    let [a, b, c] = ids;
    if a == b || a == c {
        a
    } else if b == c {
        b
    } else {
        a.min(b).min(c)
    }
}

impl Topology {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let primitives = &mesh.primitives;
        let counted = |size: fn(&Primitive) -> usize| {
            let mut first = vec![0_u32];
            for primitive in primitives {
                first.push(first[first.len() - 1] + size(primitive) as u32);
            }
            first
        };
        let whole = Whole {
            primitives,
            first_vertex: counted(|p| p.positions.len()),
            first_triangle: counted(|p| p.indices.len() / 3),
        };
        let welded = weld(&whole);
        let mut line_ids = Vec::new();
        for primitive in primitives {
            let id = |v: u32| primitive.line_ids.get(v as usize).copied().unwrap_or(0);
            let (triangles, _) = primitive.indices.as_chunks::<3>();
            line_ids.extend(triangles.iter().map(|t| face_id(t.map(id))));
        }
        let pairs = pair_sides(&whole, &welded);
        let is_smooth = smooth_triangles(&whole, &pairs);
        let smooth_normals = smooth_normals(&whole, &welded);
        let curvatures = curvatures(&whole, &welded, &pairs);
        let deforms =
            primitives.iter().any(|p| !p.joints.is_empty() || !p.morph_targets.is_empty());
        let mut edges: Vec<LineEdge> = pairs
            .into_iter()
            .filter_map(|(left, right)| {
                line_edge(&whole, &line_ids, &is_smooth, deforms, left, right)
            })
            .collect();
        edges.sort_unstable_by_key(|edge| edge.left);
        Self {
            first_vertex: whole.first_vertex,
            first_triangle: whole.first_triangle,
            edges,
            smooth_normals,
            curvatures,
            line_ids,
            is_smooth,
        }
    }

    /// Which primitive a triangle belongs to.
    pub(crate) fn primitive_of(&self, triangle: u32) -> usize {
        self.first_triangle.partition_point(|&first| first <= triangle) - 1
    }
}

/// Triangles whose corners' normals differ, and not too much from their own.
fn smooth_triangles(whole: &Whole<'_>, pairs: &[(Half, Option<Half>)]) -> Vec<bool> {
    /// Least cosine between a triangle and its corners' normals; `None` where these are one, or
    /// where the triangle has no area.
    fn bend(primitive: &Primitive, triangle: [u32; 3]) -> Option<f32> {
        let p = triangle.map(|v| primitive.positions[v as usize]);
        let n = triangle.map(|v| primitive.normals[v as usize]);
        let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        let cosines = n.map(|n| n.dot(face));
        let differs = n[0] != n[1] || n[1] != n[2];
        (differs && face != Vec3::ZERO).then(|| cosines[0].min(cosines[1]).min(cosines[2]))
    }
    let mut bends = Vec::new();
    for primitive in whole.primitives {
        let (triangles, _) = primitive.indices.as_chunks::<3>();
        bends.extend(triangles.iter().map(|&triangle| bend(primitive, triangle)));
    }
    let may_be_coarse =
        |triangle: u32| bends[triangle as usize].is_some_and(|cosine| cosine <= SMOOTH_COSINE);
    // Parts of triangles side by side that may be coarse, as trees of their first ones.
    let mut parents: Vec<u32> = (0..bends.len() as u32).collect();
    fn first_of(parents: &mut [u32], mut triangle: u32) -> u32 {
        while parents[triangle as usize] != triangle {
            let above = parents[triangle as usize];
            parents[triangle as usize] = parents[above as usize];
            triangle = above;
        }
        triangle
    }
    for (left, right) in pairs {
        let Some(right) = right else { continue };
        let [left, right] = [left / 3, right / 3];
        if may_be_coarse(left) && may_be_coarse(right) {
            let firsts = [left, right].map(|triangle| first_of(&mut parents, triangle));
            parents[firsts[0].max(firsts[1]) as usize] = firsts[0].min(firsts[1]);
        }
    }
    let mut is_coarse = vec![false; bends.len()];
    for (triangle, bend) in bends.iter().enumerate() {
        if bend.is_some_and(|cosine| cosine <= COARSE_COSINE) {
            is_coarse[first_of(&mut parents, triangle as u32) as usize] = true;
        }
    }
    (0..bends.len())
        .map(|triangle| {
            let first = first_of(&mut parents, triangle as u32) as usize;
            bends[triangle].is_some() && !is_coarse[first]
        })
        .collect()
}

/// What makes an edge a line; `None` for the smooth ones inside of a surface. If that `deforms`,
/// its planes may turn away where its normals do not, so that any edge can be an outline.
fn line_edge(
    whole: &Whole<'_>,
    line_ids: &[u32],
    is_smooth: &[bool],
    deforms: bool,
    left: Half,
    right: Option<Half>,
) -> Option<LineEdge> {
    let mut edge = LineEdge {
        left,
        right,
        is_hard: true,
        is_flat: [!is_smooth[left as usize / 3], right.is_some_and(|r| !is_smooth[r as usize / 3])],
        is_material: false,
        is_user: false,
        is_uv_seam: false,
    };
    let Some(right) = right else { return Some(edge) };
    let of = [left / 3, right / 3].map(|triangle| whole.primitive_of_triangle(triangle));
    // The right face runs along the edge the other way.
    let ends = [
        [whole.corner(of[0], left), whole.corner(of[1], following(right))],
        [whole.corner(of[0], following(left)), whole.corner(of[1], right)],
    ];
    let differs = |[a, b]: [u32; 2]| {
        let normals = [a, b].map(|v| whole.attribute(v, |p| &p.normals[..]).unwrap_or_default());
        a != b && normals[0].dot(normals[1]) < SAME_NORMAL
    };
    edge.is_hard = ends.into_iter().any(differs);
    edge.is_material = whole.primitives[of[0]].material != whole.primitives[of[1]].material;
    edge.is_user = line_ids[left as usize / 3] != line_ids[right as usize / 3];
    let no_uvs: &[Vec2] = &[];
    let torn = |[a, b]: [u32; 2]| {
        let uvs =
            [a, b].map(|v| whole.attribute(v, |p| p.uvs.first().map_or(no_uvs, |uvs| &uvs[..])));
        match uvs {
            [Some(a), Some(b)] => a.distance_squared(b) > 1e-10,
            _ => false,
        }
    };
    edge.is_uv_seam = ends.into_iter().any(torn);
    // Coplanar faces turn away together.
    let folds = edge.is_flat.contains(&true)
        && whole.face(left).cross(whole.face(right)).length() > COPLANAR_SINE;
    let is_line = edge.is_hard || folds || edge.is_material || edge.is_user || edge.is_uv_seam;
    (is_line || deforms).then_some(edge)
}

/// For each vertex the first one at the same place with the same bones: split normals, UV seams
/// and borders of primitives are one vertex again.
fn weld(whole: &Whole<'_>) -> Vec<u32> {
    let count = whole.first_vertex[whole.first_vertex.len() - 1];
    let mut first_at: HashMap<[u32; 8], u32, BuildHasherDefault<MixHasher>> =
        HashMap::with_capacity_and_hasher(count as usize, BuildHasherDefault::default());
    let mut welded = Vec::with_capacity(count as usize);
    for primitive in whole.primitives {
        for i in 0..primitive.positions.len() {
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
            let next = welded.len() as u32;
            welded.push(*first_at.entry(key).or_insert(next));
        }
    }
    welded
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

/// Every edge once, as the sides of its faces. Two faces share an edge if they run along it in
/// opposite directions; further faces (non-manifold meshes) and faces without a partner give
/// borders.
fn pair_sides(whole: &Whole<'_>, welded: &[u32]) -> Vec<(Half, Option<Half>)> {
    // Sides sorted by their lower welded vertex (a counting sort), then matched within each small
    // bucket: linear in the number of triangles.
    let mut corners = Vec::new();
    for (primitive, &first) in whole.primitives.iter().zip(&whole.first_vertex) {
        corners.extend(primitive.indices.iter().map(|&v| welded[(first + v) as usize]));
    }
    let (triangles, _) = corners.as_chunks::<3>();
    let is_degenerate = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let sides = || {
        triangles.iter().enumerate().filter(|(_, t)| !is_degenerate(**t)).flat_map(
            |(t, corners)| (0..3).map(move |i| (3 * t + i, corners[i], corners[(i + 1) % 3])),
        )
    };
    let mut starts = vec![0_u32; welded.len() + 1];
    for (_, a, b) in sides() {
        starts[a.min(b) as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut sorted = vec![0_u32; starts.last().map_or(0, |&n| n as usize)];
    let mut next = starts.clone();
    for (half, a, b) in sides() {
        let low = a.min(b) as usize;
        sorted[next[low] as usize] = half as u32;
        next[low] += 1;
    }
    let ends = |half: u32| (corners[half as usize], corners[following(half) as usize]);
    let mut pairs = Vec::with_capacity(sorted.len() / 2 + 16);
    let mut used: Vec<bool> = Vec::new();
    for bucket in starts.windows(2) {
        let bucket = &sorted[bucket[0] as usize..bucket[1] as usize];
        used.clear();
        used.resize(bucket.len(), false);
        for (i, &half) in bucket.iter().enumerate() {
            if used[i] {
                continue;
            }
            let (a, b) = ends(half);
            let partner = (i + 1..bucket.len()).find(|&j| !used[j] && ends(bucket[j]) == (b, a));
            let right = partner.map(|j| {
                used[j] = true;
                bucket[j]
            });
            pairs.push((half, right));
        }
    }
    pairs
}

/// A vector per welded place, then brought to every vertex.
fn smooth_normals(whole: &Whole<'_>, welded: &[u32]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; welded.len()];
    for (primitive, &first) in whole.primitives.iter().zip(&whole.first_vertex) {
        for triangle in primitive.indices.chunks_exact(3) {
            let p = [0, 1, 2].map(|i| primitive.positions[triangle[i] as usize]);
            let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            for i in 0..3 {
                let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
                let angle = a.cross(b).length().atan2(a.dot(b));
                if angle.is_finite() {
                    sums[welded[(first + triangle[i]) as usize] as usize] += angle * face;
                }
            }
        }
    }
    let normals = whole.primitives.iter().flat_map(|p| &p.normals);
    let of_place =
        |(&place, &normal): (&u32, &Vec3)| sums[place as usize].try_normalize().unwrap_or(normal);
    welded.iter().zip(normals).map(of_place).collect()
}

/// Mean curvature per vertex: half the mean over its edges of twice the change of the normal along
/// the edge, `(n_b − n_a)·(b − a)/|b − a|²`, weighted by length.
fn curvatures(whole: &Whole<'_>, welded: &[u32], pairs: &[(Half, Option<Half>)]) -> Vec<f32> {
    let normals = smooth_normals(whole, welded);
    let mut sums = vec![(0.0_f32, 0.0_f32); welded.len()];
    let positions: Vec<Vec3> =
        whole.primitives.iter().flat_map(|p| p.positions.iter().copied()).collect();
    for &(half, _) in pairs {
        let primitive = whole.primitive_of_triangle(half / 3);
        let a = welded[whole.corner(primitive, half) as usize] as usize;
        let b = welded[whole.corner(primitive, following(half)) as usize] as usize;
        let along = positions[b] - positions[a];
        let length = along.length();
        if length <= 1e-12 {
            continue;
        }
        let bend = (normals[b] - normals[a]).dot(along) / length;
        for end in [a, b] {
            // length · bend/length
            sums[end].0 += bend;
            sums[end].1 += length;
        }
    }
    welded
        .iter()
        .map(|&place| {
            let (bend, length) = sums[place as usize];
            if length > 0.0 { (bend / length).clamp(-6e4, 6e4) } else { 0.0 }
        })
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

    fn topology(primitive: Primitive) -> Topology {
        Topology::new(&Mesh { primitives: vec![primitive], ..Mesh::default() })
    }

    #[test]
    fn a_cube_with_corners_of_its_own_on_every_face_has_12_edges() {
        // The diagonals of its faces are none: coplanar faces turn away together.
        let edges = topology(split_cube()).edges;
        assert_eq!(edges.len(), 12);
        assert!(edges.iter().all(|e| e.right.is_some() && e.is_flat == [true; 2]));
    }

    #[test]
    fn smooth_normals_of_a_cube_point_along_its_diagonals() {
        let cube = split_cube();
        let positions = cube.positions.clone();
        for (p, n) in positions.iter().zip(topology(cube).smooth_normals) {
            assert!(p.normalize().dot(n) > 0.99999, "{p} {n}");
        }
    }

    #[test]
    fn an_open_triangle_has_three_borders() {
        let p = primitive(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[0, 1, 2]);
        let edges = topology(p).edges;
        assert_eq!(edges.len(), 3);
        assert!(edges.iter().all(|e| e.right.is_none()));
    }

    #[test]
    fn a_third_face_on_an_edge_gives_a_border_and_degenerate_triangles_none() {
        let corners =
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let p = primitive(&corners, &[0, 1, 2, 1, 0, 3, 0, 1, 4, 0, 0, 1]);
        // The smooth pair is no line; the third face's side and the six others are borders.
        let edges = topology(p).edges;
        assert_eq!(edges.iter().filter(|e| e.right.is_none()).count(), 7);
        assert_eq!(edges.len(), 7);
    }

    #[test]
    fn vertices_of_different_bones_stay_apart() {
        let mut p = primitive(&[[0.0; 3], [0.0; 3]], &[]);
        p.joints = vec![[0; 4], [1, 0, 0, 0]];
        p.weights = vec![[1.0, 0.0, 0.0, 0.0]; 2];
        let whole =
            Whole { primitives: &[p], first_vertex: vec![0, 2], first_triangle: vec![0, 0] };
        assert_eq!(weld(&whole), [0, 1]);
    }

    #[test]
    fn a_sphere_is_as_curved_everywhere_as_its_radius_says() {
        let sphere = crate::shapes::uv_sphere(64, 32, 0.5);
        let positions = sphere.positions.clone();
        for (p, curvature) in positions.iter().zip(topology(sphere).curvatures) {
            if p.y.abs() < 0.45 {
                assert!((curvature - 2.0).abs() < 0.02, "{p}: {curvature}");
            }
        }
    }
}
