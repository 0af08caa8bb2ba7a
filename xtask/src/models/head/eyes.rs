//! The eyes' and the mouth's shapes in the plane of the face, seen from the front, and how they
//! move. x and y in metres, in the half where x ≥ 0.

use glam::{DVec2, DVec3};

use super::form::Form;
use crate::models::sculpt::{Part, plate, smooth_step};

const CENTER: DVec2 = DVec2::new(0.0405, 0.2205);
const HALF_WIDTH: f64 = 0.0255;
const ABOVE: f64 = 0.0225;
const BELOW: f64 = 0.0245;

/// Across the eye: −1 at the inner corner, 1 at the outer one.
fn across(x: f64) -> f64 {
    (x - CENTER.x) / HALF_WIDTH
}

/// The height of the line through both corners.
fn axis(t: f64) -> f64 {
    CENTER.y + 0.0022 * t
}

/// How high a superellipse stands at `t` of its half width.
fn arch(t: f64) -> f64 {
    libm::pow((1.0 - libm::pow(t.abs().min(1.0), 2.5)).max(0.0), 1.0 / 2.2)
}

/// The lids' edges at `t`: upper, lower.
pub(super) fn lids(t: f64) -> (f64, f64) {
    (axis(t) + ABOVE * arch(t), axis(t) - BELOW * arch(t))
}

/// Negative in the open eye.
pub(super) fn opening(p: DVec3) -> f64 {
    if p.z < 0.02 {
        return 1.0;
    }
    let t = across(p.x.abs());
    let y = p.y - axis(t);
    let h = y.abs() / if y > 0.0 { ABOVE } else { BELOW };
    (libm::pow(t.abs(), 2.5) + libm::pow(h, 2.2) - 1.0) * 0.010
}

const IRIS: DVec2 = DVec2::new(CENTER.x - 0.0012, CENTER.y - 0.0020);
const IRIS_RADII: DVec2 = DVec2::new(0.0165, 0.0225);
/// The coloured part of the iris within its dark edge.
const INNER: f64 = 0.95;

const MOUTH_Y: f64 = 0.1660;
const MOUTH_HALF: f64 = 0.0165;

/// Negative in the mouth's line.
pub(super) fn mouth(p: DVec3) -> f64 {
    if p.z < 0.03 {
        return 1.0;
    }
    let t = p.x / MOUTH_HALF;
    (p.y - mouth_line(p.x)).abs() - 0.0013 * (1.0 - t * t * t * t).max(-1.0)
}

fn mouth_line(x: f64) -> f64 {
    let t = x / MOUTH_HALF;
    MOUTH_Y + 0.0016 * (t * t - 0.3)
}

/// What a point of the face does when a morph target is on; both halves.
pub(super) type Warp = fn(DVec2) -> DVec2;

pub(super) fn rest(p: DVec2) -> DVec2 {
    p
}

/// The lids close a little below the middle.
pub(super) fn blink(p: DVec2) -> DVec2 {
    DVec2::new(p.x, p.y + lid_motion(p, 1.0))
}

/// What is left of the white when the lids are closed, behind the lashes, in metres.
const LEFT: f64 = 0.0006;

fn lid_motion(p: DVec2, how: f64) -> f64 {
    let t = across(p.x.abs());
    let fade = smooth_step(1.45, 1.0, t.abs());
    let (upper, lower) = lids(t);
    let bowl = (1.0 - t * t).max(0.0);
    let closed = axis(t) - 0.62 * BELOW * bowl;
    let left = LEFT * bowl;
    let moved = if p.y >= upper {
        // The lashes' wings come down with the lid.
        let above = p.y - upper;
        let wing = 0.0072 * smooth_step(0.72, 0.98, t.abs()) * smooth_step(0.0, 0.0130, above);
        -(upper - closed + wing) * smooth_step(0.034, 0.0065, above)
    } else if p.y <= lower {
        (closed - left - lower) * (1.0 - (lower - p.y) / 0.022).max(0.0)
    } else {
        closed - left * (upper - p.y) / (upper - lower) - p.y
    };
    // In the corners, where the lids' edges run upright, they keep their order.
    moved * fade * how * (1.0 - 0.08 * smooth_step(0.85, 1.0, t.abs()))
}

/// The corners of the mouth rise, the mouth opens, the lower lids lift.
pub(super) fn smile(p: DVec2) -> DVec2 {
    let from_mouth = p - DVec2::new(0.0, MOUTH_Y);
    let near = smooth_step(0.026, 0.006, (from_mouth * DVec2::new(0.75, 1.0)).length());
    let t = (p.x / MOUTH_HALF).clamp(-1.6, 1.6);
    let mut moved = DVec2::new(p.x * 0.28, 0.0048 * t * t - 0.0012) * near;
    if p.y < mouth_line(p.x) {
        moved.y -= 0.0085 * (1.0 - t * t).max(0.0) * near;
    }
    let e = across(p.x.abs());
    let (_, lower) = lids(e);
    let lift = 0.0052 * arch(e);
    let fade = smooth_step(1.45, 1.0, e.abs());
    if p.y <= lower {
        moved.y += lift * (1.0 - (lower - p.y) / 0.020).max(0.0) * fade;
    } else if p.y < axis(e) {
        moved.y += lift * (axis(e) - p.y) / (axis(e) - lower).max(1e-6) * fade;
    }
    p + moved
}

/// A point in the face's plane, and its distance off the face in metres.
type Lifted = (DVec2, f64);

/// How far a patch goes into the face, in metres.
const DEPTH: DVec3 = DVec3::new(0.0, 0.0, -0.0012);

/// A patch on the face for one eye: rows of points in the half where x ≥ 0, rings if it is round.
pub(super) struct Patch {
    rows: Vec<Vec<Lifted>>,
    round: bool,
}

impl Patch {
    /// The patch on the face, a closed plate sunk into it, moved by `warp`, on the left or mirrored to the right.
    pub(super) fn placed(&self, form: &Form, warp: Warp, right: bool) -> Part {
        let place = |&(p, lift): &Lifted| {
            let q = warp(p);
            let (place, normal) = form.on_face(q.x, q.y);
            let p = place + normal * lift;
            if right { DVec3::new(-p.x, p.y, p.z) } else { p }
        };
        let rows: Vec<Vec<DVec3>> = self
            .rows
            .iter()
            .map(|row| {
                let mut row: Vec<DVec3> = row.iter().map(place).collect();
                if right {
                    row.reverse();
                }
                row
            })
            .collect();
        plate(&rows, self.round, DEPTH)
    }
}

/// A round patch: an ellipse, cut off by the lids and by an ellipse round the iris's middle. Rows are rings from the
/// middle outwards.
fn disc(center: DVec2, radii: DVec2, within: DVec2, lift: f64, dome: f64) -> Patch {
    const RINGS: usize = 3;
    const STEPS: usize = 40;
    let reach = |angle: f64| {
        let way = DVec2::new(libm::cos(angle), libm::sin(angle));
        let full = 1.0 / (way / radii).length();
        // Until a little before the lid, and within the iris.
        let inside = |r: f64| {
            let p = center + way * r;
            opening(DVec3::new(p.x, p.y, 0.1)) < -0.0002 && ((p - IRIS) / within).length() < 0.999
        };
        let (mut near, mut far) = (0.0, full);
        if inside(full) {
            return way * full;
        }
        for _ in 0..30 {
            let middle = (near + far) / 2.0;
            if inside(middle) { near = middle } else { far = middle }
        }
        way * near
    };
    let rows = (0..=RINGS)
        .map(|ring| {
            let r = ring as f64 / RINGS as f64;
            (0..=STEPS)
                .map(|i| {
                    let angle = std::f64::consts::TAU * (i % STEPS) as f64 / STEPS as f64;
                    (center + reach(angle) * r, lift + dome * (1.0 - r * r))
                })
                .collect()
        })
        .collect();
    Patch { rows, round: true }
}

/// A stroke along a line: its middle and half its width at each step from 0 to 1; it stands off
/// the face most in the middle.
fn stroke(steps: usize, lift: f64, line: &dyn Fn(f64) -> (DVec2, DVec2)) -> Patch {
    const ACROSS: usize = 2;
    let rows = (0..=ACROSS)
        .map(|k| {
            // From the lower edge to the upper one: along × across must face the viewer.
            let side = k as f64 / ACROSS as f64 * 2.0 - 1.0;
            (0..=steps)
                .map(|i| {
                    let (middle, half) = line(i as f64 / steps as f64);
                    (middle - half * side, 0.0002 + lift * (1.0 - side * side))
                })
                .collect()
        })
        .collect();
    Patch { rows, round: false }
}

/// The patches of one eye, with their materials.
pub(super) fn patches() -> Vec<(&'static str, Patch)> {
    let upper_lash = |s: f64| {
        // From before the inner corner to a wing beyond the outer one.
        let t = -1.0 + 2.0 * s;
        let (y, _) = lids(t * 0.995);
        // The wing leaves the lid outwards instead of following it down.
        let wing = smooth_step(0.80, 1.0, s);
        let y = y + (axis(1.0) + 0.0085 - y) * wing;
        let p = DVec2::new(CENTER.x + HALF_WIDTH * (t + 0.10 * wing), y - 0.0005);
        let thick = 0.0009 + 0.0032 * smooth_step(0.0, 0.45, s) * smooth_step(1.0, 0.84, s);
        (p + DVec2::Y * thick * 0.7, DVec2::new(-0.15 * t, 1.0) * thick)
    };
    let lower_lash = |s: f64| {
        let t = 0.15 + 0.80 * s;
        let (_, y) = lids(t);
        let thick = 0.00015 + 0.0008 * smooth_step(0.0, 0.5, s) * smooth_step(1.0, 0.8, s);
        (DVec2::new(CENTER.x + HALF_WIDTH * t, y), DVec2::new(0.0, thick))
    };
    let fold = |s: f64| {
        let t = -0.62 + 1.35 * s;
        let (y, _) = lids(t * 0.9);
        let thick = 0.00015 + 0.0005 * smooth_step(0.0, 0.3, s) * smooth_step(1.0, 0.7, s);
        (DVec2::new(CENTER.x + HALF_WIDTH * t, y + 0.0072), DVec2::new(0.0, thick))
    };
    let brow = |s: f64| {
        let t = -0.85 + 1.70 * s;
        let y = CENTER.y + 0.0345 + 0.0040 * (1.0 - (t - 0.15) * (t - 0.15)) - 0.0006 * t;
        let thick = 0.00015 + 0.0020 * smooth_step(-0.05, 0.25, s) * smooth_step(1.0, 0.3, s);
        (DVec2::new(CENTER.x + HALF_WIDTH * t, y), DVec2::new(0.0, thick))
    };
    let inner = IRIS_RADII * INNER;
    vec![
        // Dark round its edge.
        ("pupil", disc(IRIS, IRIS_RADII, IRIS_RADII, -0.0007, 0.0003)),
        ("iris", disc(IRIS, inner, inner, -0.0005, 0.0004)),
        (
            "iris_shade",
            disc(
                IRIS + DVec2::Y * 0.0120,
                IRIS_RADII * DVec2::new(1.2, 0.62),
                inner,
                -0.0001,
                0.0003,
            ),
        ),
        ("pupil", disc(IRIS + DVec2::Y * 0.0010, IRIS_RADII * 0.47, inner, 0.0002, 0.0002)),
        (
            "shine",
            disc(
                IRIS + DVec2::new(0.0058, 0.0105),
                DVec2::new(0.0044, 0.0054),
                inner,
                0.0005,
                0.0003,
            ),
        ),
        (
            "shine",
            disc(
                IRIS - DVec2::new(0.0062, 0.0110),
                DVec2::new(0.0026, 0.0030),
                inner,
                0.0005,
                0.0002,
            ),
        ),
        ("lash", stroke(36, 0.0022, &upper_lash)),
        ("lash", stroke(20, 0.0008, &lower_lash)),
        ("lash", stroke(20, 0.0007, &fold)),
        ("brow", stroke(24, 0.0016, &brow)),
    ]
}
