//! Even triangles: the isotropic remeshing of Botsch and Kobbelt 2004, "A remeshing approach to
//! multiresolution modeling", with a length for every place.

use glam::DVec3;

use super::field::{Field, project};
use super::mesh::{Mesh, next, prev};

/// Remeshes the surface of `field` to edges of about `length(p)` metres.
pub(in crate::models) fn remesh(
    mut mesh: Mesh,
    field: &dyn Field,
    length: &dyn Fn(DVec3) -> f64,
    rounds: usize,
) -> Mesh {
    for _ in 0..rounds {
        split_long(&mut mesh, length);
        collapse_short(&mut mesh, length);
        mesh = mesh.compact().0;
        even_valences(&mut mesh);
        mesh.points = mesh.smoothed(0.7, &|_| true);
        for point in &mut mesh.points {
            *point = project(field, *point);
        }
    }
    mesh
}

fn split_long(mesh: &mut Mesh, length: &dyn Fn(DVec3) -> f64) {
    // Half edges that splitting adds are looked at in the next round.
    for h in 0..mesh.half_edges() {
        if h > mesh.twin(h) {
            continue;
        }
        let (a, b) = (mesh.point(mesh.from(h)), mesh.point(mesh.to(h)));
        let middle = (a + b) / 2.0;
        if a.distance(b) > length(middle) * 4.0 / 3.0 {
            mesh.split(h, middle);
        }
    }
}

fn collapse_short(mesh: &mut Mesh, length: &dyn Fn(DVec3) -> f64) {
    for h in 0..mesh.half_edges() {
        if mesh.is_gone(h) || h > mesh.twin(h) {
            continue;
        }
        let (a, b) = (mesh.point(mesh.from(h)), mesh.point(mesh.to(h)));
        let middle = (a + b) / 2.0;
        let wanted = length(middle);
        if a.distance(b) < wanted * 0.8 {
            mesh.collapse(h, middle, wanted * 4.0 / 3.0);
        }
    }
}

/// Flips edges where that brings the corners nearer to six triangles each.
fn even_valences(mesh: &mut Mesh) {
    let mut valence = vec![0i32; mesh.points.len()];
    for h in 0..mesh.half_edges() {
        valence[mesh.from(h) as usize] += 1;
    }
    for h in 0..mesh.half_edges() {
        let g = mesh.twin(h);
        if h > g {
            continue;
        }
        let [a, b] = [mesh.from(h) as usize, mesh.from(g) as usize];
        let [c, d] = [mesh.from(prev(h)) as usize, mesh.from(prev(g)) as usize];
        let off = |v: usize, change: i32| (valence[v] + change - 6).abs();
        let before = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0);
        let after = off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1);
        if after < before && valence[a] > 3 && valence[b] > 3 && stays_flat(mesh, h) && mesh.flip(h)
        {
            for (v, change) in [(a, -1), (b, -1), (c, 1), (d, 1)] {
                valence[v] += change;
            }
        }
    }
}

/// Whether flipping an edge folds nothing over.
pub(super) fn stays_flat(mesh: &Mesh, h: u32) -> bool {
    let g = mesh.twin(h);
    let [a, b] = [mesh.point(mesh.from(h)), mesh.point(mesh.to(h))];
    let [c, d] = [mesh.point(mesh.from(prev(h))), mesh.point(mesh.from(prev(g)))];
    let old = (b - a).cross(c - a).normalize_or_zero() + (a - b).cross(d - b).normalize_or_zero();
    let (new0, new1) = ((a - c).cross(d - c), (b - d).cross(c - d));
    let cos = |n: DVec3| n.normalize_or_zero().dot(old.normalize_or_zero());
    debug_assert!(next(h) != h);
    cos(new0) > 0.6 && cos(new1) > 0.6
}
