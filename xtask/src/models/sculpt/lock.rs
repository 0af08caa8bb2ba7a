//! Locks of hair: leaf shapes swept along a curve, with sharp sides and a point.

use glam::DVec3;

use super::field::smooth_step;
use super::sweep::Part;

/// A lock along `path`, which runs from 0 at the root to 1 at the tip. `out` gives the way off
/// the head at a place. Half the width and the thickness are those of the widest place, in
/// metres; `point` is the part of the length after which it narrows.
pub(in crate::models) fn lock(
    path: &dyn Fn(f64) -> DVec3,
    out: &dyn Fn(DVec3) -> DVec3,
    half_width: f64,
    thick: f64,
    point: f64,
) -> Part {
    const ALONG: usize = 32;
    const OVER: usize = 10;
    const UNDER: usize = 2;
    let (mut over, mut under) = (Vec::new(), Vec::new());
    for i in 0..=ALONG {
        let t = i as f64 / ALONG as f64;
        let p = path(t);
        let way = (path((t + 0.01).min(1.0)) - path((t - 0.01).max(0.0))).normalize();
        let out = out(p);
        let out = (out - way * out.dot(way)).normalize();
        let side = out.cross(way);
        let swell = libm::sqrt(smooth_step(0.0, 0.38, t));
        let narrowed = 1.0 - libm::pow(((t - point) / (1.0 - point)).max(0.0), 1.7);
        let size = swell * narrowed;
        let (half, thick) = (half_width * size, thick * size);
        // The sides bend towards the head.
        let at = |s: f64, bulge: f64| {
            p + side * (half * s) + out * (bulge * (1.0 - s * s) - 0.35 * half * s * s)
        };
        let over_at = |k: usize| at(-1.0 + 2.0 * k as f64 / OVER as f64, thick);
        let under_at = |k: usize| at(1.0 - 2.0 * k as f64 / UNDER as f64, -0.35 * thick);
        over.push((0..=OVER).map(over_at).collect());
        under.push((0..=UNDER).map(under_at).collect());
    }
    let mut part = Part::default();
    part.grid(&over, false);
    part.grid(&under, false);
    part
}
