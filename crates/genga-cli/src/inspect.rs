//! Checks of a mesh's triangles: what makes lines break or surfaces vanish.

use std::collections::HashMap;

use genga::scene::Mesh;
use glam::{DVec3, Vec3};
use serde::Serialize;

/// A triangle flatter than this (least altitude over longest edge) is a sliver.
const SLIVER: f64 = 0.01;

/// A triangle flatter than this has no area within the precision of its corners.
const FLAT: f64 = 1e-6;

/// What a mesh's triangles look like, seen as one surface: vertices at the same place are one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct Geometry {
    /// All triangles.
    pub(crate) triangles: usize,
    /// Triangles without area.
    pub(crate) degenerate: usize,
    /// Triangles that are very thin.
    pub(crate) slivers: usize,
    /// Edges with a triangle on one side only.
    pub(crate) open_edges: usize,
    /// Edges with more than two triangles.
    pub(crate) non_manifold_edges: usize,
    /// Edges whose two triangles are wound against each other.
    pub(crate) twisted_edges: usize,
    /// Triangles whose vertex normals point to their back.
    pub(crate) normals_reversed: usize,
    /// Vertices that no triangle uses.
    pub(crate) unused_vertices: usize,
    /// Primitives with a texture but without the texture coordinates for it.
    pub(crate) without_uvs: usize,
    /// Whether the surface has an inside: every edge has two triangles.
    pub(crate) closed: bool,
    /// Whether it is closed and its triangles face inwards.
    pub(crate) inside_out: bool,
}

impl Geometry {
    /// What is wrong, as phrases. An open surface is not wrong in itself.
    pub(crate) fn problems(&self) -> Vec<String> {
        use crate::text::count;
        let mut problems = Vec::new();
        let mut add = |number: usize, one: &str, many: &str| {
            if number > 0 {
                problems.push(count(number, one, many));
            }
        };
        add(self.degenerate, "triangle without area", "triangles without area");
        add(self.slivers, "sliver", "slivers");
        add(self.non_manifold_edges, "non-manifold edge", "non-manifold edges");
        add(self.twisted_edges, "edge wound both ways", "edges wound both ways");
        add(
            self.normals_reversed,
            "triangle with reversed normals",
            "triangles with reversed normals",
        );
        add(self.unused_vertices, "unused vertex", "unused vertices");
        add(self.without_uvs, "textured part without UVs", "textured parts without UVs");
        if self.inside_out {
            problems.push("inside out".to_owned());
        }
        problems
    }
}

/// Looks at every triangle of a mesh at rest. `uv_sets` gives the sets that a material's
/// textures use.
pub(crate) fn inspect(mesh: &Mesh, uv_sets: impl Fn(Option<usize>) -> Vec<usize>) -> Geometry {
    let mut geometry = Geometry::default();
    let mut places: HashMap<[u32; 3], u32> = HashMap::new();
    // (smaller place, larger place, direction) packed, so that equal edges sort together.
    let mut edges: Vec<u64> = Vec::new();
    let mut volume = 0.0;
    let origin = mesh.primitives.iter().find_map(|p| p.positions.first());
    let origin = origin.copied().unwrap_or(Vec3::ZERO).as_dvec3();
    for primitive in &mesh.primitives {
        let place_of: Vec<u32> = primitive
            .positions
            .iter()
            .map(|p| {
                let next = u32::try_from(places.len()).unwrap_or(u32::MAX);
                // Adding zero turns −0 into 0.
                *places.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
            })
            .collect();
        let mut used = vec![false; primitive.positions.len()];
        for triangle in primitive.indices.as_chunks::<3>().0 {
            let corners = triangle.map(|i| i as usize);
            let Some([a, b, c]) = points(&primitive.positions, corners) else { continue };
            corners.iter().for_each(|&i| used[i] = true);
            geometry.triangles += 1;
            let normal = (b - a).cross(c - a);
            let longest =
                [a.distance(b), b.distance(c), c.distance(a)].into_iter().fold(0.0, f64::max);
            let flatness = if longest > 0.0 { normal.length() / (longest * longest) } else { 0.0 };
            if flatness < FLAT {
                geometry.degenerate += 1;
            } else if flatness < SLIVER {
                geometry.slivers += 1;
            }
            if let Some(normals) = points(&primitive.normals, corners)
                && flatness >= FLAT
                && normals.iter().all(|n| n.dot(normal) < 0.0)
            {
                geometry.normals_reversed += 1;
            }
            volume += (a - origin).dot((b - origin).cross(c - origin));
            let [a, b, c] = corners.map(|i| place_of[i]);
            if a != b && b != c && c != a {
                edges.extend([(a, b), (b, c), (c, a)].map(|(from, to)| packed(from, to)));
            }
        }
        geometry.unused_vertices += used.iter().filter(|used| !**used).count();
        let has_uvs = |&set: &usize| primitive.uvs.get(set).is_some_and(|uvs| !uvs.is_empty());
        if !uv_sets(primitive.material).iter().all(has_uvs) {
            geometry.without_uvs += 1;
        }
    }
    edges.sort_unstable();
    for same in edges.chunk_by(|a, b| a >> 1 == b >> 1) {
        match same {
            [_] => geometry.open_edges += 1,
            [a, b] if a == b => geometry.twisted_edges += 1,
            [_, _] => {}
            _ => geometry.non_manifold_edges += 1,
        }
    }
    geometry.closed =
        !edges.is_empty() && geometry.open_edges == 0 && geometry.non_manifold_edges == 0;
    geometry.inside_out = geometry.closed && geometry.twisted_edges == 0 && volume < 0.0;
    geometry
}

fn points(all: &[Vec3], corners: [usize; 3]) -> Option<[DVec3; 3]> {
    let [a, b, c] = corners.map(|i| all.get(i));
    Some([a?.as_dvec3(), b?.as_dvec3(), c?.as_dvec3()])
}

/// 31 bits for each place are enough: a model has at most 4 GiB, 12 bytes for each vertex.
fn packed(from: u32, to: u32) -> u64 {
    let (low, high) = (u64::from(from.min(to)), u64::from(from.max(to)));
    (low << 32) | (high << 1) | u64::from(from > to)
}

#[cfg(test)]
mod tests {
    use genga::scene::Primitive;

    use super::*;

    /// A cube with its corners shared by all faces.
    fn cube() -> Primitive {
        let positions = (0..8_u8)
            .map(|i| Vec3::new(f32::from(i & 1), f32::from(i >> 1 & 1), f32::from(i >> 2)))
            .collect::<Vec<_>>();
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let indices = quads.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
        let normals = positions.iter().map(|p| (*p - 0.5).normalize()).collect();
        Primitive { positions, normals, indices, ..Default::default() }
    }

    fn look(primitives: Vec<Primitive>) -> Geometry {
        inspect(&Mesh { primitives, ..Default::default() }, |_| Vec::new())
    }

    #[test]
    fn a_cube_is_closed_and_sound() {
        let geometry = look(vec![cube()]);
        assert_eq!(geometry, Geometry { triangles: 12, closed: true, ..Default::default() });
        assert!(geometry.problems().is_empty());
    }

    #[test]
    fn vertices_at_one_place_are_one() {
        let mut split = cube();
        split.positions = split.indices.iter().map(|&i| split.positions[i as usize]).collect();
        split.normals = split.indices.iter().map(|&i| split.normals[i as usize]).collect();
        split.indices = (0..36).collect();
        assert!(look(vec![split.clone()]).closed);
        // Also across primitives, since a material changes no surface.
        let mut rest = split.clone();
        split.indices.truncate(18);
        rest.indices.drain(..18);
        let geometry = look(vec![split, rest]);
        assert!(geometry.closed);
        assert_eq!(geometry.unused_vertices, 36);
    }

    #[test]
    fn holes_have_open_edges() {
        let mut open = cube();
        open.indices.truncate(33);
        let geometry = look(vec![open]);
        assert_eq!((geometry.open_edges, geometry.closed), (3, false));
    }

    #[test]
    fn windings_are_compared() {
        let mut twisted = cube();
        twisted.indices.swap(0, 1);
        let geometry = look(vec![twisted]);
        assert_eq!((geometry.twisted_edges, geometry.normals_reversed), (3, 1));
        let mut inside_out = cube();
        inside_out.indices.reverse();
        let geometry = look(vec![inside_out]);
        assert!(geometry.inside_out && geometry.closed);
        assert_eq!(geometry.normals_reversed, 12);
    }

    #[test]
    fn thin_triangles_are_counted() {
        let positions =
            vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, 0.005, 0.0), Vec3::new(2.0, 0.0, 0.0)];
        let normals = vec![Vec3::Z; 4];
        let indices = vec![0, 1, 2, 0, 1, 3, 1, 1, 2];
        let geometry = look(vec![Primitive { positions, normals, indices, ..Default::default() }]);
        assert_eq!((geometry.slivers, geometry.degenerate), (1, 2));
    }

    #[test]
    fn a_third_triangle_at_an_edge_is_counted() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NEG_Y, Vec3::Z];
        let indices = vec![0, 1, 2, 1, 0, 3, 0, 1, 4];
        let geometry = look(vec![Primitive { positions, indices, ..Default::default() }]);
        assert_eq!((geometry.non_manifold_edges, geometry.open_edges), (1, 6));
    }

    #[test]
    fn textures_need_their_uvs() {
        let mesh = Mesh { primitives: vec![cube()], ..Default::default() };
        assert_eq!(inspect(&mesh, |_| vec![0]).without_uvs, 1);
    }
}
