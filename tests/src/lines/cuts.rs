//! Where the surfaces of different objects cut each other: triangle against triangle.

use glam::DVec3;

use crate::reference::Triangle;

/// Metres within which a corner counts as lying on a plane.
const ON_PLANE: f64 = 1e-7;

/// Pairs of triangles of different objects that cut each other, with the segment that they share.
#[must_use]
pub fn cuts(triangles: &[Triangle]) -> Vec<([usize; 2], [DVec3; 2])> {
    let boxes: Vec<[DVec3; 2]> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.corners;
            [a.min(b).min(c) - ON_PLANE, a.max(b).max(c) + ON_PLANE]
        })
        .collect();
    // Sorted by their least x, so that only neighbours need to be compared.
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0].x.total_cmp(&boxes[b][0].x));
    let mut found = Vec::new();
    for (at, &i) in order.iter().enumerate() {
        for &j in order[at + 1..].iter().take_while(|&&j| boxes[j][0].x <= boxes[i][1].x) {
            let apart =
                boxes[i][0].cmpgt(boxes[j][1]).any() || boxes[j][0].cmpgt(boxes[i][1]).any();
            if !apart && triangles[i].owner.0 != triangles[j].owner.0 {
                let pair = [triangles[i].corners, triangles[j].corners];
                found.extend(cut(pair[0], pair[1]).map(|ends| ([i, j], ends)));
            }
        }
    }
    found
}

/// The segment that two triangles share (Möller 1997); none if they lie in one plane.
#[must_use]
pub fn cut(a: [DVec3; 3], b: [DVec3; 3]) -> Option<[DVec3; 2]> {
    let [on_b, on_a] = [crossing(b, a)?, crossing(a, b)?];
    let along = (on_a[1] - on_a[0]).normalize_or_zero();
    let at = |p: DVec3| (p - on_a[0]).dot(along);
    let [mut low, mut high] = [on_a[0], on_a[1]];
    let [first, last] = if at(on_b[0]) <= at(on_b[1]) { on_b } else { [on_b[1], on_b[0]] };
    if at(first) > at(low) {
        low = first;
    }
    if at(last) < at(high) {
        high = last;
    }
    (at(high) - at(low) > ON_PLANE).then_some([low, high])
}

/// Where the sides of `triangle` meet the plane of `other`.
fn crossing(triangle: [DVec3; 3], other: [DVec3; 3]) -> Option<[DVec3; 2]> {
    let normal = (other[1] - other[0]).cross(other[2] - other[0]).normalize_or_zero();
    let height = triangle.map(|p| {
        let h = (p - other[0]).dot(normal);
        if h.abs() < ON_PLANE { 0.0 } else { h }
    });
    if height.iter().all(|h| *h == 0.0) {
        return None;
    }
    let mut points: Vec<DVec3> = Vec::new();
    for i in 0..3 {
        let j = (i + 1) % 3;
        if height[i] == 0.0 {
            points.push(triangle[i]);
        } else if height[j] != 0.0 && (height[i] > 0.0) != (height[j] > 0.0) {
            points.push(triangle[i].lerp(triangle[j], height[i] / (height[i] - height[j])));
        }
    }
    match points[..] {
        [p, q] => Some([p, q]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [DVec3; 3] =
        [DVec3::new(-9.0, 0.0, -9.0), DVec3::new(9.0, 0.0, -9.0), DVec3::new(0.0, 0.0, 9.0)];

    #[test]
    fn two_triangles_share_the_part_of_their_line_that_lies_in_both() {
        let fin =
            [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
        let mut ends = cut(FLOOR, fin).expect("they cross");
        ends.sort_by(|p, q| p.x.total_cmp(&q.x));
        assert!((ends[0] - DVec3::new(-0.5, 0.0, 0.0)).length() < 1e-12);
        assert!((ends[1] - DVec3::new(0.5, 0.0, 0.0)).length() < 1e-12);
        assert_eq!(cut(FLOOR, fin.map(|p| p + DVec3::Y * 1.5)), None, "above");
        assert_eq!(cut(FLOOR, fin.map(|p| p + DVec3::Z * 20.0)), None, "beside");
        assert_eq!(cut(FLOOR, FLOOR), None, "in one plane");
        // A side that rests on the floor.
        let resting = cut(FLOOR, fin.map(|p| p + DVec3::Y)).expect("they touch");
        assert!(((resting[1] - resting[0]).length() - 2.0).abs() < 1e-12);
    }
}
