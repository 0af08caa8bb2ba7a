//! How fast directions turn over a mesh.

use glam::Vec3;

/// Largest cotangent of a corner: that of slivers would be of no meaning.
const MAX_COTANGENT: f32 = 20.0;

/// How fast lines turn at each vertex, in radians a unit of length, a line for each vertex; over triangles
/// of one surface. |∇θ|² is that of piecewise linear functions, ½ Σ cot α Δ² over the area (Pinkall and
/// Polthier 1993), with the sine between lines as Δ, in the mean of the triangles at a vertex.
pub(super) fn turning(
    positions: &[Vec3],
    lines: &[Vec3],
    triangles: impl Iterator<Item = [u32; 3]>,
) -> Vec<f32> {
    let mut sums = vec![[0.0_f32; 2]; positions.len()];
    for corners in triangles {
        let corners = corners.map(|v| v as usize);
        let [mut energy, mut area] = [0.0; 2];
        for i in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
            let sides = [positions[b] - positions[a], positions[c] - positions[a]];
            let twice_area = sides[0].cross(sides[1]).length();
            let cotangent = sides[0].dot(sides[1]) / twice_area.max(1e-30);
            let turn = lines[b].cross(lines[c]).length_squared();
            energy += 0.5 * cotangent.clamp(-MAX_COTANGENT, MAX_COTANGENT) * turn;
            area = 0.5 * twice_area;
        }
        for v in corners {
            sums[v][0] += energy.max(0.0);
            sums[v][1] += area;
        }
    }
    sums.iter().map(|[energy, area]| (energy / area.max(1e-30)).sqrt()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_that_turns_evenly_turns_so_in_long_triangles_too() {
        // A strip of triangles, 20 times as long as wide; lines turn by 0.2 in 0.1.
        let count = 12_u32;
        let of =
            |i: u32| [Vec3::new(0.1 * i as f32, 0.0, 0.0), Vec3::new(0.1 * i as f32, 2.0, 0.0)];
        let positions: Vec<Vec3> = (0..count).flat_map(of).collect();
        let line = |p: &Vec3| Vec3::new((2.0 * p.x).cos(), (2.0 * p.x).sin(), 0.0);
        let mut lines: Vec<Vec3> = positions.iter().map(line).collect();
        // Both ends are the same.
        lines[5] = -lines[5];
        let quads = (0..count - 1).map(|i| 2 * i);
        let triangles = quads.flat_map(|v| [[v, v + 1, v + 2], [v + 1, v + 3, v + 2]]);
        for found in turning(&positions, &lines, triangles) {
            assert!((found - 2.0).abs() < 0.05, "{found}");
        }
    }
}
