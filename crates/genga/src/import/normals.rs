//! Smooth normals for meshes that bring none.
//!
//! glTF asks for flat ones then; on the figures that people draw, one shaded band per face is
//! never what was meant.

use glam::{DVec3, Vec3};

use crate::scene::Primitive;

/// Makes every normal a unit vector; missing and unusable ones are made smooth over all parts of
/// the mesh that need some.
pub(super) fn complete(primitives: &mut [Primitive]) {
    let is_unit = |normal: &Vec3| (normal.length_squared() - 1.0).abs() < 1e-6;
    let mut incomplete = Vec::new();
    for (index, primitive) in primitives.iter_mut().enumerate() {
        if primitive.normals.is_empty() {
            incomplete.push(index);
            continue;
        }
        let mut broken = false;
        for normal in primitive.normals.iter_mut().filter(|normal| !is_unit(normal)) {
            *normal = normal.as_dvec3().normalize_or_zero().as_vec3();
            broken |= *normal == Vec3::ZERO;
        }
        if broken {
            incomplete.push(index);
        }
    }
    if incomplete.is_empty() {
        return;
    }
    let parts: Vec<Part> = incomplete
        .iter()
        .filter_map(|&index| primitives.get(index))
        .map(|p| Part { positions: &p.positions, indices: &p.indices })
        .collect();
    let made = smooth(&parts);
    for (index, made) in incomplete.into_iter().zip(made) {
        let Some(primitive) = primitives.get_mut(index) else { continue };
        if primitive.normals.is_empty() {
            primitive.normals = made;
            continue;
        }
        for (normal, made) in primitive.normals.iter_mut().zip(made) {
            if *normal == Vec3::ZERO {
                *normal = made;
            }
        }
    }
}

/// The triangles of one part of a mesh.
#[derive(Clone, Copy)]
struct Part<'a> {
    positions: &'a [Vec3],
    /// In range, a multiple of three.
    indices: &'a [u32],
}

/// Unit normals for each vertex of each part: the mean of the adjoining faces' normals, weighted
/// by the angle that each face has at the vertex (Thürmer & Wüthrich 1998), over all vertices at
/// exactly equal positions, also those of other parts.
///
/// Where the mean is zero, as in a sheet folded onto itself, a face's own normal is taken.
fn smooth(parts: &[Part]) -> Vec<Vec<Vec3>> {
    let groups = groups_of_equal_positions(parts);
    let group_count = groups.iter().flatten().map(|&group| group as usize + 1).max().unwrap_or(0);
    let mut sums = vec![DVec3::ZERO; group_count];
    let add_faces = |sums: &mut [DVec3], only_where: &dyn Fn(DVec3) -> bool| {
        for (part, groups) in parts.iter().zip(&groups) {
            for triangle in part.indices.chunks_exact(3) {
                let corner = |i: usize| {
                    let vertex = triangle[i] as usize;
                    Some((part.positions.get(vertex)?.as_dvec3(), *groups.get(vertex)? as usize))
                };
                let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else {
                    continue;
                };
                let normal = (b.0 - a.0).cross(c.0 - a.0).normalize_or_zero();
                if normal == DVec3::ZERO {
                    continue;
                }
                for (at, next, previous) in [(a, b, c), (b, c, a), (c, a, b)] {
                    if let Some(sum) = sums.get_mut(at.1)
                        && only_where(*sum)
                    {
                        *sum += normal * angle_between(next.0 - at.0, previous.0 - at.0);
                    }
                }
            }
        }
    };
    add_faces(&mut sums, &|_| true);
    let is_zero = |sum: DVec3| sum.length_squared() < 1e-12;
    if sums.iter().any(|&sum| is_zero(sum)) {
        for sum in &mut sums {
            if is_zero(*sum) {
                *sum = DVec3::ZERO;
            }
        }
        add_faces(&mut sums, &|sum| sum == DVec3::ZERO);
    }
    let unit: Vec<Vec3> =
        sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()).collect();
    groups
        .into_iter()
        .map(|groups| {
            groups
                .into_iter()
                .map(|group| unit.get(group as usize).copied().unwrap_or(Vec3::Y))
                .collect()
        })
        .collect()
}

fn angle_between(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// A number for each vertex that is the same exactly where positions are equal, counted from 0
/// without gaps.
///
/// Sorting by hashes stays fast for any input, where a hash table could be made slow on purpose.
fn groups_of_equal_positions(parts: &[Part]) -> Vec<Vec<u32>> {
    let positions: Vec<[u32; 3]> = parts
        .iter()
        // Adding 0 turns −0 into 0, which is the same place.
        .flat_map(|part| {
            part.positions.iter().map(|p| (*p + Vec3::ZERO).to_array().map(f32::to_bits))
        })
        .collect();
    let mut order: Vec<u64> = positions
        .iter()
        .enumerate()
        .map(|(vertex, &key)| (u64::from(hash(key)) << 32) | vertex as u64)
        .collect();
    order.sort_unstable();

    let mut group_of = vec![0_u32; positions.len()];
    let mut group = 0_u32;
    let vertex_of = |entry: u64| (entry & 0xffff_ffff) as usize;
    for run in order.chunk_by_mut(|a, b| a >> 32 == b >> 32) {
        let first = positions[vertex_of(run[0])];
        if run.iter().any(|&entry| positions[vertex_of(entry)] != first) {
            run.sort_unstable_by_key(|&entry| (positions[vertex_of(entry)], entry));
        }
        for same in run.chunk_by(|&a, &b| positions[vertex_of(a)] == positions[vertex_of(b)]) {
            for &entry in same {
                group_of[vertex_of(entry)] = group;
            }
            group += 1;
        }
    }
    let mut rest = group_of.as_slice();
    parts
        .iter()
        .map(|part| {
            let (these, others) = rest.split_at(part.positions.len());
            rest = others;
            these.to_vec()
        })
        .collect()
}

fn hash([x, y, z]: [u32; 3]) -> u32 {
    let mut h = u64::from(x) | (u64::from(y) << 32);
    h = (h ^ (h >> 29)).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ u64::from(z);
    h = (h ^ (h >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    (h >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(a: Vec3, b: Vec3) {
        assert!((a - b).length() < 1e-6, "{a} is not {b}");
    }

    #[test]
    fn normals_weigh_by_angle_not_by_triangle_count() {
        // The corner of a cube; one of its faces is split in two at the corner. By angle each
        // face counts the same, so the normal is the diagonal.
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, 1.0, 0.0)];
        let indices = [0, 4, 1, 0, 2, 4, 0, 3, 2, 0, 1, 3];
        let normals = smooth(&[Part { positions: &positions, indices: &indices }]);
        assert_near(normals[0][0], -Vec3::ONE.normalize());
    }

    #[test]
    fn equal_positions_are_smoothed_across_vertices_and_parts() {
        let tent = [Vec3::ZERO, Vec3::Z, Vec3::new(-1.0, -1.0, 0.0)];
        let other = [Vec3::Z, Vec3::new(-0.0, 0.0, 0.0), Vec3::new(1.0, -1.0, 0.0)];
        let normals = smooth(&[
            Part { positions: &tent, indices: &[0, 2, 1] },
            Part { positions: &other, indices: &[1, 0, 2] },
        ]);
        assert_near(normals[0][0], normals[1][1]);
        assert_near(normals[0][1], normals[1][0]);
        assert!(normals[0][0].x.abs() < 1e-6);
    }

    #[test]
    fn degenerate_triangles_and_folds_still_give_unit_normals() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::splat(9.0)];
        // A face and its own back, one without area, and a vertex in no face.
        let indices = [0, 1, 2, 0, 2, 1, 0, 0, 1];
        let normals = smooth(&[Part { positions: &positions, indices: &indices }]);
        for normal in &normals[0] {
            assert!((normal.length() - 1.0).abs() < 1e-6);
        }
        assert!(normals[0][0].z.abs() > 0.99);
    }

    #[test]
    fn tiny_and_huge_triangles_have_normals() {
        for size in [1e-30_f32, 1e15] {
            let positions = [Vec3::ZERO, Vec3::X * size, Vec3::Y * size];
            let normals = smooth(&[Part { positions: &positions, indices: &[0, 1, 2] }]);
            assert_near(normals[0][1], Vec3::Z);
        }
    }

    #[test]
    fn equal_hashes_of_different_places_stay_apart() {
        // Enough points that some of 32 bits of hash collide among them now and then; the groups
        // must be right whatever the hash does.
        let positions: Vec<Vec3> = (0..60_000).map(|i| Vec3::splat((i % 50_000) as f32)).collect();
        let groups = groups_of_equal_positions(&[Part { positions: &positions, indices: &[] }]);
        for i in 50_000..60_000 {
            assert_eq!(groups[0][i], groups[0][i - 50_000]);
        }
        let mut unique = groups[0][..50_000].to_vec();
        unique.sort_unstable();
        unique.dedup();
        assert_eq!(unique.len(), 50_000);
    }
}
