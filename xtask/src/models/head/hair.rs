//! Hair: a smooth cap, and a few bold locks over it that end in points.

use glam::{DMat3, DVec2, DVec3};

use super::form::SKULL;
use crate::models::sculpt::{Field, Part, Solid, lock};

/// Half axes of the cap in metres.
const CAP: DVec3 = DVec3::new(0.0985, 0.1060, 0.1110);

/// The cap as a solid: round the skull, cut off along the hairline.
pub(super) fn cap() -> impl Field {
    let mut s = Solid::new();
    s.ellipsoid(SKULL, CAP, DMat3::IDENTITY, 0.0);
    s.cut(DVec3::new(0.0, 0.300, 0.060), DVec3::new(0.0, -0.62, 0.78), 0.006);
    s.cut(DVec3::new(0.0, 0.205, -0.03), DVec3::new(0.0, -0.95, 0.30), 0.006);
    move |p: DVec3| s.at(p)
}

/// A lock: it runs down the cap from near the crown and hangs from where the cap turns under.
struct Lock {
    /// Degrees round the head at root and tip: 0 in front, 90 on the left.
    around: [f64; 2],
    /// Degrees down from the crown where it starts.
    from: f64,
    /// Length along the cap and down, in metres.
    length: f64,
    /// Half its width at the widest, and its thickness there, in metres.
    half_width: f64,
    thick: f64,
    /// How far root, middle and tip stand off the cap, in metres.
    lift: [f64; 3],
}

/// A point on the cap's extension: over the cap to its widest place, then straight down.
fn on_cap(around_deg: f64, down: f64, lift: f64) -> DVec3 {
    // The crown lies behind the top.
    const CROWN: f64 = -0.30;
    let radius = 0.105;
    let quarter = std::f64::consts::FRAC_PI_2;
    let angle = (down / radius).min(quarter);
    let below = (down - quarter * radius).max(0.0);
    let a = around_deg.to_radians();
    let level = libm::sin(angle);
    let local = DVec3::new(libm::sin(a) * level, libm::cos(angle), libm::cos(a) * level);
    // Tilted back at the top, upright further down.
    let tilt = CROWN * libm::cos(angle).max(0.0);
    let (s, c) = (libm::sin(tilt), libm::cos(tilt));
    let local = DVec3::new(local.x, local.y * c - local.z * s, local.y * s + local.z * c);
    let n = local.normalize();
    SKULL + n * (CAP + DVec3::splat(lift)) + DVec3::new(0.0, -below, 0.0)
}

impl Lock {
    fn part(&self) -> Part {
        let [l0, l1, l2] = self.lift;
        let start = self.from.to_radians() * 0.105;
        let path = |t: f64| {
            let ease = t * t * (3.0 - 2.0 * t);
            let around =
                self.around[0] + (self.around[1] - self.around[0]) * (0.5 * t + 0.5 * ease);
            // A parabola through the three lifts.
            let lift = l0 * (1.0 - t) * (1.0 - 2.0 * t)
                + l1 * 4.0 * t * (1.0 - t)
                + l2 * t * (2.0 * t - 1.0);
            on_cap(around, start + self.length * t, lift)
        };
        let out = |p: DVec3| (p - SKULL) * DVec3::new(1.0, 0.3, 1.0);
        lock(&path, &out, self.half_width, self.thick, 0.42)
    }
}

/// Around at root and tip, start, length, half the width, thickness, lifts.
type Numbers = ([f64; 2], f64, f64, f64, f64, [f64; 3]);

/// The fringe, from the right to the left; parted over the left eye.
const FRINGE: [Numbers; 6] = [
    ([-56.0, -64.0], 24.0, 0.158, 0.031, 0.012, [-0.008, 0.014, 0.004]),
    ([-32.0, -38.0], 24.0, 0.152, 0.031, 0.012, [-0.008, 0.014, 0.004]),
    ([-10.0, -15.0], 24.0, 0.160, 0.032, 0.012, [-0.008, 0.014, 0.004]),
    ([9.0, 6.0], 24.0, 0.143, 0.027, 0.012, [-0.008, 0.014, 0.004]),
    ([26.0, 35.0], 24.0, 0.152, 0.031, 0.012, [-0.008, 0.014, 0.004]),
    ([50.0, 62.0], 24.0, 0.158, 0.031, 0.012, [-0.008, 0.014, 0.004]),
];

/// Before and behind the ears, then down the back with ends turned out; left, mirrored right.
const SIDES: [Numbers; 4] = [
    ([76.0, 70.0], 26.0, 0.262, 0.028, 0.013, [-0.008, 0.012, -0.006]),
    ([98.0, 94.0], 26.0, 0.222, 0.036, 0.014, [-0.008, 0.012, 0.006]),
    ([124.0, 124.0], 30.0, 0.232, 0.044, 0.016, [-0.009, 0.012, 0.018]),
    ([152.0, 154.0], 34.0, 0.236, 0.044, 0.016, [-0.009, 0.014, 0.014]),
];

/// The middle of the back, and a wisp at the crown.
const SINGLE: [Numbers; 2] = [
    ([180.0, 180.0], 38.0, 0.236, 0.046, 0.018, [-0.009, 0.016, 0.020]),
    ([30.0, 75.0], 2.0, 0.060, 0.008, 0.006, [0.0, 0.035, 0.050]),
];

/// All locks.
pub(super) fn locks() -> Part {
    let mirrored = |n: &Numbers| (n.0.map(|around| -around), n.1, n.2, n.3, n.4, n.5);
    let right: Vec<Numbers> = SIDES.iter().map(mirrored).collect();
    let mut all = Part::default();
    for &(around, from, length, half_width, thick, lift) in
        FRINGE.iter().chain(&SIDES).chain(&right).chain(&SINGLE)
    {
        all.append(&Lock { around, from, length, half_width, thick, lift }.part());
    }
    for (uv, p) in all.uvs.iter_mut().zip(&all.positions) {
        let turn = libm::atan2(p.x, p.z - SKULL.z) / std::f64::consts::TAU;
        *uv = DVec2::new(turn + 0.5, (0.40 - p.y) * 2.5);
    }
    all
}
