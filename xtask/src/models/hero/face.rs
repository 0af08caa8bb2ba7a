//! Head, hair and what lies on the face, in the half where x ≥ 0.

use glam::{DMat3, DVec3};

use super::torso::belly;
use crate::models::sculpt::{Part, Solid, lock};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The head without hair.
pub(super) fn head() -> Solid {
    let i = DMat3::IDENTITY;
    let mut s = Solid::new();
    s.ellipsoid(v(0.0, 1.825, -0.006), v(0.0755, 0.085, 0.096), i, 0.0);
    // Cheeks down to a square jaw and chin.
    s.block(v(0.0, 1.768, 0.038), v(0.060, 0.062, 0.056), i, 0.034, 0.03);
    s.cone(v(0.056, 1.752, 0.006), 0.015, v(0.021, 1.706, 0.074), 0.016, 0.022);
    s.block(v(0.0, 1.707, 0.074), v(0.026, 0.017, 0.020), i, 0.013, 0.014);
    belly(
        &mut s,
        v(0.030, 1.776, 0.088),
        v(0.064, 1.786, 0.048),
        v(0.5, 0.0, 1.0),
        (0.013, 0.012),
        0.014,
    );
    // Forehead and brow.
    s.ellipsoid(v(0.0, 1.848, 0.045), v(0.058, 0.040, 0.046), i, 0.03);
    belly(
        &mut s,
        v(0.002, 1.815, 0.094),
        v(0.060, 1.822, 0.062),
        v(0.3, 0.0, 1.0),
        (0.011, 0.013),
        0.010,
    );
    // Sockets and eyes.
    s.carve_ellipsoid(v(0.032, 1.799, 0.104), v(0.022, 0.012, 0.013), i, 0.010);
    // Nose.
    s.cone(v(0.0, 1.808, 0.096), 0.0075, v(0.0, 1.770, 0.115), 0.0092, 0.008);
    s.ellipsoid(v(0.0105, 1.764, 0.104), v(0.0075, 0.0065, 0.009), i, 0.005);
    // Mouth: the swell of the lips, and the hollow below.
    s.ellipsoid(v(0.0, 1.739, 0.082), v(0.030, 0.021, 0.021), i, 0.014);
    s.ellipsoid(v(0.0, 1.7315, 0.097), v(0.015, 0.0052, 0.008), i, 0.006);
    s.carve_ellipsoid(v(0.0, 1.7225, 0.103), v(0.018, 0.004, 0.005), i, 0.008);
    // Ear.
    let ear = DMat3::from_cols(v(0.94, 0.0, -0.34), v(0.0, 1.0, 0.0), v(0.34, 0.0, 0.94));
    s.ellipsoid(v(0.0785, 1.786, -0.012), v(0.010, 0.031, 0.019), ear, 0.010);
    s.carve_ellipsoid(v(0.0885, 1.790, -0.008), v(0.006, 0.019, 0.010), ear, 0.006);
    s
}

/// The hair's cap; locks lie over it.
pub(super) fn hair_cap() -> Solid {
    let mut s = Solid::new();
    s.ellipsoid(v(0.0, 1.838, -0.016), v(0.083, 0.088, 0.102), DMat3::IDENTITY, 0.0);
    // The hairline: over the forehead, down before the ears, across the nape.
    s.cut(v(0.0, 1.872, 0.060), v(0.0, -0.55, 0.83), 0.008);
    s.cut(v(0.0, 1.792, -0.02), v(0.0, -0.93, 0.37), 0.008);
    for side in [-1.0, 1.0] {
        // Sideburns.
        s.cone(v(side * 0.0710, 1.822, 0.030), 0.011, v(side * 0.0725, 1.784, 0.025), 0.006, 0.010);
    }
    s
}

/// Control points of a Bézier curve, half the width, thickness, where it begins to narrow.
type Curve = ([[f64; 3]; 4], f64, f64, f64);

/// Locks on the left, mirrored to the right: swept back along the side.
const SIDES: [Curve; 3] = [
    (
        [
            [0.064, 1.872, 0.050],
            [0.090, 1.890, 0.020],
            [0.092, 1.885, -0.055],
            [0.060, 1.868, -0.118],
        ],
        0.024,
        0.006,
        0.5,
    ),
    (
        [
            [0.073, 1.842, 0.036],
            [0.096, 1.856, 0.008],
            [0.099, 1.842, -0.060],
            [0.062, 1.818, -0.122],
        ],
        0.024,
        0.006,
        0.5,
    ),
    (
        [
            [0.077, 1.812, 0.020],
            [0.094, 1.826, 0.000],
            [0.096, 1.806, -0.055],
            [0.060, 1.772, -0.108],
        ],
        0.023,
        0.006,
        0.5,
    ),
];

/// The crest that rises over the forehead and falls back, what covers the back of the head, and
/// a lock on the forehead.
const SINGLE: [Curve; 10] = [
    (
        [
            [-0.052, 1.868, 0.062],
            [-0.064, 1.920, 0.076],
            [-0.066, 1.938, 0.010],
            [-0.058, 1.900, -0.070],
        ],
        0.025,
        0.010,
        0.5,
    ),
    (
        [
            [-0.032, 1.880, 0.074],
            [-0.042, 1.938, 0.096],
            [-0.044, 1.962, 0.020],
            [-0.038, 1.925, -0.075],
        ],
        0.025,
        0.011,
        0.5,
    ),
    (
        [
            [-0.008, 1.884, 0.080],
            [-0.014, 1.950, 0.106],
            [-0.014, 1.972, 0.025],
            [-0.010, 1.932, -0.078],
        ],
        0.025,
        0.011,
        0.5,
    ),
    (
        [
            [0.016, 1.882, 0.078],
            [0.018, 1.944, 0.100],
            [0.020, 1.966, 0.022],
            [0.020, 1.930, -0.076],
        ],
        0.025,
        0.011,
        0.5,
    ),
    (
        [
            [0.040, 1.874, 0.070],
            [0.050, 1.926, 0.088],
            [0.054, 1.946, 0.014],
            [0.048, 1.912, -0.072],
        ],
        0.025,
        0.010,
        0.5,
    ),
    (
        [
            [-0.040, 1.918, -0.030],
            [-0.050, 1.930, -0.100],
            [-0.052, 1.868, -0.146],
            [-0.036, 1.800, -0.122],
        ],
        0.026,
        0.012,
        0.45,
    ),
    (
        [
            [0.000, 1.924, -0.030],
            [0.000, 1.938, -0.105],
            [0.000, 1.870, -0.154],
            [0.000, 1.782, -0.120],
        ],
        0.028,
        0.013,
        0.45,
    ),
    (
        [
            [0.040, 1.918, -0.030],
            [0.050, 1.930, -0.100],
            [0.052, 1.868, -0.146],
            [0.036, 1.800, -0.122],
        ],
        0.026,
        0.012,
        0.45,
    ),
    (
        [
            [0.004, 1.884, 0.074],
            [0.010, 1.914, 0.108],
            [0.034, 1.880, 0.116],
            [0.014, 1.850, 0.108],
        ],
        0.011,
        0.007,
        0.35,
    ),
    (
        [
            [-0.012, 1.886, 0.074],
            [-0.016, 1.910, 0.108],
            [-0.030, 1.884, 0.114],
            [-0.034, 1.864, 0.104],
        ],
        0.010,
        0.007,
        0.35,
    ),
];

/// The locks, at the sculpted size.
pub(super) fn locks() -> Part {
    let mirrored = |(points, half, thick, point): &Curve| {
        (points.map(|[x, y, z]| [-x, y, z]), *half, *thick, *point)
    };
    let right: Vec<Curve> = SIDES.iter().map(mirrored).collect();
    let mut all = Part::default();
    for (points, half, thick, point) in SIDES.iter().chain(&right).chain(&SINGLE) {
        let [a, b, c, d] = points.map(DVec3::from_array);
        let path = |t: f64| {
            let s = 1.0 - t;
            a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
        };
        let out = |p: DVec3| p - v(0.0, 1.835, -0.010);
        all.append(&lock(&path, &out, *half, *thick, *point));
    }
    all
}
