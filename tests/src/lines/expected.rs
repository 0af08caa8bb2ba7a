//! Which pieces of a mesh are lines in a view.

use std::collections::HashMap;

use glam::DVec3;

use super::cuts::cuts;
use crate::eye::Eye;
use crate::reference::Triangle;

/// What makes a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A hard edge between a face that looks at the eye and one that does not.
    Silhouette,
    /// The zero set of n·(eye − p) inside a triangle, where n is interpolated.
    Contour,
    /// An edge whose faces meet at an angle.
    Crease,
    /// An edge with one face.
    Border,
    /// An edge between two materials.
    Seam,
    /// Where two objects run into each other.
    Cut,
}

/// A straight piece of a line in world space.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Its ends.
    pub ends: [DVec3; 2],
    /// What makes it.
    pub kind: Kind,
    /// Indices of the triangles that it lies on; twice the same if it is one.
    pub faces: [usize; 2],
    /// Metres by which the object's own surface round it may lie before it: the smooth contour of
    /// a coarse mesh can run behind the mesh's own faces.
    pub slack: f64,
    /// Whether it must be drawn where it is seen; otherwise it may be.
    pub must: bool,
}

/// Creases nearer to their threshold than this may be too thin to be seen, in degrees.
const NEAR_THRESHOLD_DEG: f64 = 5.0;
/// Where objects cut each other at a smaller angle, the line's place is ill-defined, in degrees.
const FLAT_CUT_DEG: f64 = 8.0;

/// Faces seen at a smaller angle than this may be thinner than a pixel, as its sine.
const EDGE_ON: f64 = 0.04;

/// Rounding of normals and places, as the sine of an angle.
const FACING_DOUBT: f64 = 2e-4;

/// An edge with its faces: their indices, and their normals at both ends.
struct Edge {
    ends: [DVec3; 2],
    faces: Vec<(usize, [DVec3; 2])>,
}

/// What `contour` draws in a view, whether anything hides it or not.
///
/// `crease_deg` is the smallest angle of a crease between the planes of two faces.
#[must_use]
pub fn expected(triangles: &[Triangle], eye: &Eye, crease_deg: f64) -> Vec<Line> {
    let mut lines = Vec::new();
    for edge in edges(triangles) {
        edge_lines(&edge, triangles, eye, crease_deg, &mut lines);
    }
    for (index, triangle) in triangles.iter().enumerate() {
        let facing: [f64; 3] =
            std::array::from_fn(|i| triangle.normals[i].dot(eye.towards(triangle.corners[i])));
        lines.extend(smooth_contour(triangle, index, facing, eye));
        // Where the facing hardly changes, rounding decides where it is zero.
        for side in [-1.0, 1.0] {
            let doubt = side * FACING_DOUBT * eye.towards(triangle.corners[0]).length();
            let shifted = smooth_contour(triangle, index, facing.map(|f| f + doubt), eye);
            lines.extend(shifted.map(|line| Line { must: false, ..line }));
        }
    }
    for (faces, ends) in cuts(triangles) {
        let [a, b] = faces.map(|f| &triangles[f]);
        if [a, b].iter().any(|t| !t.double_sided && !t.faces(eye)) {
            continue;
        }
        let is_broad = !is_edge_on(a, eye) && !is_edge_on(b, eye);
        let angle = a.outward.angle_between(b.outward).to_degrees();
        let must = is_broad && angle.min(180.0 - angle) > FLAT_CUT_DEG;
        // Beside a smooth contour the plane has turned away, but not yet the normals: the mesh's own
        // edge before it stands for the cut.
        let turned = faces.into_iter().find(|&f| has_turned_first(&triangles[f], eye));
        let line = match turned {
            Some(f) => {
                let other = if f == faces[0] { faces[1] } else { faces[0] };
                let slack = longest_side(&triangles[f]);
                Line { ends, kind: Kind::Cut, faces: [f, other], slack, must: false }
            }
            None => Line { ends, kind: Kind::Cut, faces, slack: 0.0, must },
        };
        lines.push(line);
    }
    lines
}

/// Whether the plane has turned away from the eye, but not all of the normals.
fn has_turned_first(triangle: &Triangle, eye: &Eye) -> bool {
    let faces = |i: usize| triangle.normals[i].dot(eye.towards(triangle.corners[i])) > 0.0;
    !triangle.faces(eye) && (0..3).any(faces)
}

fn longest_side(triangle: &Triangle) -> f64 {
    let [a, b, c] = triangle.corners;
    (b - a).length().max((c - b).length()).max((a - c).length())
}

fn is_edge_on(triangle: &Triangle, eye: &Eye) -> bool {
    let towards = eye.towards(triangle.corners[0]).normalize_or_zero();
    triangle.outward.normalize_or_zero().dot(towards).abs() < EDGE_ON
}

fn bits(p: DVec3) -> [u64; 3] {
    (p + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// The edges of each object; vertices at the same place are one.
fn edges(triangles: &[Triangle]) -> Vec<Edge> {
    let mut edges: HashMap<_, Edge> = HashMap::new();
    for (index, triangle) in triangles.iter().enumerate() {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let (p, q) = (triangle.corners[i], triangle.corners[j]);
            let (n, m) = (triangle.normals[i], triangle.normals[j]);
            let turned = bits(q) < bits(p);
            let (ends, normals) = if turned { ([q, p], [m, n]) } else { ([p, q], [n, m]) };
            let key = (triangle.owner.0, ends.map(bits));
            let edge = edges.entry(key).or_insert(Edge { ends, faces: Vec::new() });
            edge.faces.push((index, normals));
        }
    }
    let mut edges: Vec<_> = edges.into_iter().collect();
    edges.sort_by_key(|(key, _)| *key);
    edges.into_iter().map(|(_, edge)| edge).collect()
}

fn edge_lines(
    edge: &Edge,
    triangles: &[Triangle],
    eye: &Eye,
    crease_deg: f64,
    lines: &mut Vec<Line>,
) {
    let seen = |f: usize| triangles[f].double_sided || triangles[f].faces(eye);
    let broad = |f: usize| seen(f) && !is_edge_on(&triangles[f], eye);
    let whole = |kind, faces, must| Line { ends: edge.ends, kind, faces, slack: 0.0, must };
    let [(f, f_normals), (g, g_normals)] = edge.faces[..] else {
        if let Some((f, _)) = edge.faces.iter().find(|(f, _)| seen(*f)) {
            lines.push(whole(Kind::Border, [*f; 2], broad(*f)));
        }
        return;
    };
    let is_seen = seen(f) || seen(g);
    let faces = [f, g];
    let [a, b] = faces.map(|face| &triangles[face]);
    let angle = a.outward.angle_between(b.outward).to_degrees();
    let is_hard = (0..2).any(|end| f_normals[end].dot(g_normals[end]) < 1.0 - 1e-6);
    let is_broad = broad(f) || broad(g);
    if is_seen && angle > crease_deg - NEAR_THRESHOLD_DEG {
        // Between faces that are shaded as one surface, the picture shows no crease.
        let must = is_hard && is_broad && angle > crease_deg + NEAR_THRESHOLD_DEG;
        lines.push(whole(Kind::Crease, faces, must));
    }
    if is_seen && a.owner != b.owner {
        lines.push(whole(Kind::Seam, faces, is_broad));
    }
    if !is_hard {
        return;
    }
    // n·(eye − p) along the edge is taken as linear between its ends, on either face.
    let facing = [f_normals, g_normals]
        .map(|normals| [0, 1].map(|end| normals[end].dot(eye.towards(edge.ends[end]))));
    let roots = facing.iter().filter(|at| (at[0] > 0.0) != (at[1] > 0.0));
    let mut cuts: Vec<f64> = roots.map(|at| at[0] / (at[0] - at[1])).collect();
    cuts.extend([0.0, 1.0]);
    cuts.sort_by(f64::total_cmp);
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let turned = facing.map(|at| at[0] + (at[1] - at[0]) * middle > 0.0);
        if turned[0] != turned[1] && pair[0] < pair[1] {
            let ends = [pair[0], pair[1]].map(|t| edge.ends[0].lerp(edge.ends[1], t));
            // Between normals that hardly differ it is as thin as a contour that turns away. Where
            // both planes have turned away, but not yet the normals, it joins outline and contour.
            let must = is_seen && is_broad && angle > NEAR_THRESHOLD_DEG;
            let slack = if is_seen { 0.0 } else { (edge.ends[1] - edge.ends[0]).length() };
            lines.push(Line { ends, kind: Kind::Silhouette, faces, slack, must });
        }
    }
}

/// The straight piece inside a triangle along which n·(eye − p), interpolated between `facing` at
/// its corners, is zero (Hertzmann and Zorin 2000).
fn smooth_contour(triangle: &Triangle, index: usize, facing: [f64; 3], eye: &Eye) -> Option<Line> {
    let crossing = |i: usize, j: usize| {
        ((facing[i] > 0.0) != (facing[j] > 0.0)).then(|| {
            let t = facing[i] / (facing[i] - facing[j]);
            triangle.corners[i].lerp(triangle.corners[j], t)
        })
    };
    let mut points = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(i, j)| crossing(i, j));
    let ends = [points.next()?, points.next()?];
    // A contour of a convex place (seen along its line of sight) is where a surface turns towards
    // the eye as it comes nearer; the others lie in hollows, behind the surface itself.
    let nearness = triangle.corners.map(|p| -eye.distance(p));
    let gradients = [&facing, &nearness].map(|values| gradient(triangle, values));
    let must = gradients[0].dot(gradients[1]) > 0.0;
    let slack = longest_side(triangle);
    Some(Line { ends, kind: Kind::Contour, faces: [index; 2], slack, must })
}

/// The gradient in space of values that are linear on a triangle.
fn gradient(triangle: &Triangle, values: &[f64; 3]) -> DVec3 {
    let [a, b, c] = triangle.corners;
    let n = (b - a).cross(c - a);
    let scale = n.length_squared().max(1e-300);
    ((values[1] - values[0]) * (c - a).cross(n) + (values[2] - values[0]) * n.cross(b - a)) / scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::triangles;
    use crate::scenes::{Builder, ortho_view, perspective_view};
    use genga::scene::{Pose, Transform};
    use genga::shapes;
    use glam::Vec3;

    fn lines_of(primitive: genga::scene::Primitive, view: &genga::render::View) -> Vec<Line> {
        let mut scene = Builder::new();
        scene.object("object", primitive, None, Transform::default());
        let scene = scene.build();
        expected(&triangles(&scene, &Pose::rest(&scene)), &Eye::new(view), 40.0)
    }

    fn length(lines: &[Line], kind: Kind) -> f64 {
        let of_kind = lines.iter().filter(|line| line.kind == kind && line.must);
        of_kind.map(|line| (line.ends[1] - line.ends[0]).length()).sum()
    }

    #[test]
    fn a_cube_from_the_front_shows_the_edges_of_its_front() {
        let lines = lines_of(shapes::cuboid(Vec3::ONE), &perspective_view([99, 99], 40.0, 5.0));
        assert!((length(&lines, Kind::Crease) - 4.0).abs() < 1e-9);
        assert!((length(&lines, Kind::Silhouette) - 4.0).abs() < 1e-9);
        assert!(length(&lines, Kind::Contour) + length(&lines, Kind::Border) == 0.0);
    }

    #[test]
    fn a_balls_contour_is_a_circle_round_it() {
        // From the distance d, the contour of a ball is a circle of radius r √(1 − r²/d²).
        let lines =
            lines_of(shapes::uv_sphere(200, 100, 1.0), &perspective_view([99, 99], 40.0, 5.0));
        let radius = (1.0_f64 - 1.0 / 25.0).sqrt();
        let circle = std::f64::consts::TAU * radius;
        assert!((length(&lines, Kind::Contour) / circle - 1.0).abs() < 0.01);
        for line in lines.iter().filter(|line| line.must) {
            assert!(line.kind == Kind::Contour);
            assert!((line.ends[0].truncate().length() - radius).abs() < 1e-3);
        }
        let lines = lines_of(shapes::uv_sphere(24, 16, 1.0), &ortho_view([99, 99], 3.0));
        let must = || lines.iter().filter(|line| line.must);
        assert!(must().count() > 10 && must().all(|line| line.ends[0].z.abs() < 1e-6));
    }

    #[test]
    fn a_gradient_is_that_of_its_values() {
        let corners = [DVec3::ZERO, DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.5, 3.0, -1.0)];
        let [a, b, c] = corners;
        let triangle = Triangle {
            corners,
            normals: [DVec3::Z; 3],
            outward: (b - a).cross(c - a),
            owner: (0, None),
            double_sided: false,
        };
        let g = gradient(&triangle, &[1.0, 4.0, -2.0]);
        assert!((g.dot(b - a) - 3.0).abs() < 1e-9 && (g.dot(c - a) + 3.0).abs() < 1e-9);
        assert!(g.dot(triangle.outward).abs() < 1e-9);
    }
}
