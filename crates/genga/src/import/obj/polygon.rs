//! Triangles from polygons.

use glam::{DVec2, DVec3, Vec3};

/// Polygons with more corners are fanned even if they are not convex: ear clipping takes a time
/// that grows with the cube of the corners.
const MAX_CLIPPED: usize = 100;

/// Cuts a polygon into triangles, as indices of its corners, wound like the polygon.
///
/// Convex polygons are fanned from their first corner, others cut by ear clipping in the plane
/// of their mean normal.
pub(super) fn triangulate(points: &[Vec3]) -> Vec<[usize; 3]> {
    let n = points.len();
    if n < 3 {
        return Vec::new();
    }
    let fan = || (2..n).map(|i| [0, i - 1, i]).collect();
    if n == 3 || n > MAX_CLIPPED {
        return fan();
    }
    let flat = flatten(points);
    let is_convex = (0..n).all(|i| turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= 0.0);
    if is_convex { fan() } else { clip_ears(&flat) }
}

/// The polygon in its plane, counter-clockwise.
fn flatten(points: &[Vec3]) -> Vec<DVec2> {
    // Newell's normal, which also fits polygons that are not flat.
    let next = points.iter().cycle().skip(1);
    let normal: DVec3 =
        points.iter().zip(next).map(|(a, b)| a.as_dvec3().cross(b.as_dvec3())).sum();
    let (x, y) = normal.normalize_or(DVec3::Z).any_orthonormal_pair();
    points.iter().map(|p| DVec2::new(p.as_dvec3().dot(x), p.as_dvec3().dot(y))).collect()
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn clip_ears(points: &[DVec2]) -> Vec<[usize; 3]> {
    let mut rest: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::with_capacity(points.len());
    while rest.len() > 3 {
        let n = rest.len();
        let is_ear = |&at: &usize| {
            let [a, b, c] = [rest[(at + n - 1) % n], rest[at], rest[(at + 1) % n]];
            let [pa, pb, pc] = [points[a], points[b], points[c]];
            let is_inside = |&p: &DVec2| {
                turn(pa, pb, p) >= 0.0 && turn(pb, pc, p) >= 0.0 && turn(pc, pa, p) >= 0.0
            };
            turn(pa, pb, pc) > 0.0
                && !rest
                    .iter()
                    .map(|&other| &points[other])
                    .filter(|p| **p != pa && **p != pb && **p != pc)
                    .any(is_inside)
        };
        // A polygon that crosses itself may have no ear; what is left is fanned then.
        let Some(ear) = (0..n).find(is_ear) else { break };
        triangles.push([rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]]);
        rest.remove(ear);
    }
    triangles.extend((2..rest.len()).map(|i| [rest[0], rest[i - 1], rest[i]]));
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[Vec3], triangles: &[[usize; 3]]) -> f32 {
        let normal = |t: &[usize; 3]| {
            (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).z / 2.0
        };
        assert!(triangles.iter().all(|t| normal(t) >= 0.0), "a triangle is turned over");
        triangles.iter().map(normal).sum()
    }

    fn flat(points: &[[f32; 2]]) -> Vec<Vec3> {
        points.iter().map(|p| Vec3::new(p[0], p[1], 7.0)).collect()
    }

    #[test]
    fn convex_polygons_are_fanned() {
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(triangulate(&square), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        let arrow = flat(&[[0.0, 0.0], [2.0, -1.0], [0.0, 3.0], [-2.0, -1.0]]);
        let triangles = triangulate(&arrow);
        assert_eq!(triangles.len(), 2);
        assert!((area(&arrow, &triangles) - 6.0).abs() < 1e-5);
        let comb = flat(&[
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 2.0],
            [4.0, 1.0],
            [3.0, 2.0],
            [2.0, 1.0],
            [1.0, 2.0],
            [0.0, 1.0],
        ]);
        let triangles = triangulate(&comb);
        assert_eq!(triangles.len(), 6);
        assert!((area(&comb, &triangles) - 7.5).abs() < 1e-5);
    }

    #[test]
    fn crossing_and_flat_polygons_end() {
        let bow = flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(triangulate(&bow).len(), 2);
        assert_eq!(triangulate(&[Vec3::ONE; 9]).len(), 7);
        assert_eq!(triangulate(&vec![Vec3::ONE; 100_000]).len(), 99_998);
        assert!(triangulate(&[]).is_empty());
    }
}
