//! The ball that stands in for surfaces.

use glam::{DMat3, DVec3, Vec3};

use super::{Highlight, Proxy};
use crate::scene::{Pose, Scene};

impl Scene {
    /// The ball that stands best for the surfaces which carry a highlight, at rest: round `center`
    /// (in the highlight's node), or round the centre of the sphere of least squares (Coope 1993).
    /// Its radius is the surfaces' mean distance over all directions in which the centre sees them,
    /// so what is far off, or seen from the side, counts little. `None` if no surface carries it.
    ///
    /// It visits every triangle on the CPU.
    #[must_use]
    pub fn fitted_ball(&self, highlight: &Highlight, center: Option<Vec3>) -> Option<Proxy> {
        let triangles = self.triangles_in_frame(highlight);
        let center = center.map_or_else(|| center_of(&triangles), |center| Some(center.as_dvec3()));
        let center = center?;
        let area = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).length();
        let all: f64 = triangles.iter().map(area).sum();
        let (mut sum, mut total) = (0.0, 0.0);
        for corners in &triangles {
            // Areas decide where the centre lies in the plane of all triangles.
            let little = 1e-6 * area(corners) / all;
            let corners = corners.map(|corner| corner - center);
            let angle = solid_angle(corners) + little;
            sum += angle * (corners[0] + corners[1] + corners[2]).length() / 3.0;
            total += angle;
        }
        let radius = (sum / total) as f32;
        let center = center.as_vec3();
        (radius.is_finite() && radius > 0.0 && center.is_finite())
            .then_some(Proxy::Ball { center, radius })
    }

    /// The triangles that carry a highlight, in its node at rest.
    fn triangles_in_frame(&self, highlight: &Highlight) -> Vec<[DVec3; 3]> {
        let rest = Pose::rest(self);
        let at = |index: usize| rest.world_from_node.get(index).copied();
        let under = highlight.under.map(|top| nodes_below(self, top));
        let is_under =
            |node: usize| under.as_ref().is_none_or(|nodes| nodes.get(node) == Some(&true));
        let node_from_world = highlight.node.and_then(at).unwrap_or_default().inverse();
        let mut triangles = Vec::new();
        self.visit_triangles(&rest, &mut |node, material, corners| {
            let object = self.nodes.get(node).map_or("", |node| node.name.as_str());
            let names = highlight.objects.matches(object) && highlight.materials.matches(material);
            if names && is_under(node) {
                let corners = corners.map(|p| node_from_world.transform_point3(p).as_dvec3());
                triangles.push(corners);
            }
        });
        triangles.retain(|corners| corners.iter().all(|corner| corner.is_finite()));
        triangles
    }
}

/// The centre of the sphere nearest to triangles, by least squares of `|p − c|² − r²` over their
/// area. On what is nearly flat it is kept within three times their extent.
fn center_of(triangles: &[[DVec3; 3]]) -> Option<DVec3> {
    let weighted = || {
        triangles.iter().map(|[a, b, c]| {
            let area = (b - a).cross(c - a).length();
            ((a + b + c) / 3.0, area)
        })
    };
    let total: f64 = weighted().map(|(_, area)| area).sum();
    if !(total.is_finite() && total > 0.0) {
        return None;
    }
    let middle = weighted().map(|(p, area)| p * area).sum::<DVec3>() / total;
    let spread =
        weighted().map(|(p, area)| (p - middle).length_squared() * area).sum::<f64>() / total;
    let (mut covariance, mut wanted) = (DMat3::ZERO, DVec3::ZERO);
    for (p, area) in weighted() {
        let q = p - middle;
        covariance += area / total * DMat3::from_cols(q * q.x, q * q.y, q * q.z);
        wanted += area / total * q * (q.length_squared() - spread);
    }
    let extent = spread.sqrt();
    // Less than a hundredth of the extent in any direction is taken for noise.
    let covariance = covariance + DMat3::from_diagonal(DVec3::splat(1e-4 * spread));
    let offset = 0.5 * (covariance.inverse() * wanted);
    let offset =
        if offset.is_finite() { offset.clamp_length_max(3.0 * extent) } else { DVec3::ZERO };
    Some(middle + offset)
}

/// The solid angle that a triangle covers as seen from the origin (van Oosterom and Strackee 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    let angle = 2.0 * a.dot(b.cross(c)).abs().atan2(below);
    if angle.is_finite() { angle } else { 0.0 }
}

/// Which nodes are `top` or hang under it.
pub(crate) fn nodes_below(scene: &Scene, top: usize) -> Vec<bool> {
    let mut result = vec![false; scene.nodes.len()];
    let mut todo = vec![top];
    while let Some(index) = todo.pop() {
        let (Some(flag), Some(node)) = (result.get_mut(index), scene.nodes.get(index)) else {
            continue;
        };
        if !std::mem::replace(flag, true) {
            todo.extend(&node.children);
        }
    }
    result
}
