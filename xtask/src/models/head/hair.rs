//! Hair: a smooth cap, and a few bold locks over it that end in points.

use glam::{DMat3, DVec2, DVec3};

use super::form::SKULL;
use crate::models::sculpt::{Field, Part, Solid, smooth_step};

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
        const ALONG: usize = 28;
        const OVER: usize = 8;
        const UNDER: usize = 4;
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
        let (mut over, mut under) = (Vec::new(), Vec::new());
        for i in 0..=ALONG {
            let t = i as f64 / ALONG as f64;
            let p = path(t);
            let way = (path((t + 0.01).min(1.0)) - path((t - 0.01).max(0.0))).normalize();
            let mut out = p - SKULL;
            out.y *= 0.3;
            let out = (out - way * out.dot(way)).normalize();
            let side = way.cross(out);
            // Narrow at the root, wide to the middle, a point at the tip.
            let swell = libm::sqrt(smooth_step(-0.05, 0.40, t));
            let end = 1.0 - libm::pow(((t - 0.42) / 0.58).max(0.0), 1.7);
            let size = swell * end;
            let (half, thick) = (self.half_width * size, self.thick * size);
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
}

/// All locks.
pub(super) fn locks() -> Part {
    let lock = |a0: f64, a1: f64, from: f64, length: f64, half: f64, thick: f64, lift: [f64; 3]| {
        Lock { around: [a0, a1], from, length, half_width: half, thick, lift }
    };
    let mut locks = Vec::new();
    // The fringe, from the right to the left; parted over the left eye.
    for (a0, a1, length, half) in [
        (-56.0, -64.0, 0.158, 0.031),
        (-32.0, -38.0, 0.152, 0.031),
        (-10.0, -15.0, 0.160, 0.032),
        (9.0, 6.0, 0.143, 0.027),
        (26.0, 35.0, 0.152, 0.031),
        (50.0, 62.0, 0.158, 0.031),
    ] {
        locks.push(lock(a0, a1, 24.0, length, half, 0.012, [-0.008, 0.014, 0.004]));
    }
    for side in [-1.0, 1.0] {
        // Long locks before the ears.
        locks.push(lock(
            side * 76.0,
            side * 70.0,
            26.0,
            0.262,
            0.028,
            0.013,
            [-0.008, 0.012, -0.006],
        ));
        locks.push(lock(
            side * 98.0,
            side * 94.0,
            26.0,
            0.222,
            0.036,
            0.014,
            [-0.008, 0.012, 0.006],
        ));
        // Down the back, ends turned out.
        locks.push(lock(
            side * 124.0,
            side * 124.0,
            30.0,
            0.232,
            0.044,
            0.016,
            [-0.009, 0.012, 0.018],
        ));
        locks.push(lock(
            side * 152.0,
            side * 154.0,
            34.0,
            0.236,
            0.044,
            0.016,
            [-0.009, 0.014, 0.014],
        ));
    }
    locks.push(lock(180.0, 180.0, 38.0, 0.236, 0.046, 0.018, [-0.009, 0.016, 0.020]));
    let mut all = Part::default();
    for lock in locks {
        all.append(&lock.part());
    }
    // A wisp at the crown.
    all.append(&lock(30.0, 75.0, 2.0, 0.060, 0.008, 0.006, [0.0, 0.035, 0.050]).part());
    for (uv, p) in all.uvs.iter_mut().zip(&all.positions) {
        *uv = DVec2::new(
            libm::atan2(p.x, p.z - SKULL.z) / std::f64::consts::TAU + 0.5,
            (0.40 - p.y) * 2.5,
        );
    }
    all
}
