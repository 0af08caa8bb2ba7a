//! The trunk's muscles, in the half where x ≥ 0; the other half mirrors it.

use glam::{DMat3, DVec3};

use crate::models::sculpt::Solid;

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Axes whose y runs from `a` to `b` and whose z is as near to `front` as can be; also the
/// middle and half the distance.
pub(super) fn between(a: DVec3, b: DVec3, front: DVec3) -> (DVec3, f64, DMat3) {
    let along = (b - a).normalize();
    let front = (front - along * front.dot(along)).normalize();
    let axes = DMat3::from_cols(along.cross(front), along, front);
    ((a + b) / 2.0, a.distance(b) / 2.0, axes)
}

/// Adds a muscle's belly from `a` to `b`, so wide and so thick (half each).
pub(super) fn belly(
    solid: &mut Solid,
    a: DVec3,
    b: DVec3,
    front: DVec3,
    (wide, thick): (f64, f64),
    blend: f64,
) {
    let (center, half, axes) = between(a, b, front);
    solid.ellipsoid(center, v(wide, half, thick), axes, blend);
}

/// Ribs, waist, pelvis and the muscles on them.
pub(super) fn torso() -> Solid {
    let i = DMat3::IDENTITY;
    let mut s = Solid::new();
    // The masses: ribs, waist, pelvis.
    s.ellipsoid(v(0.0, 1.405, -0.015), v(0.166, 0.185, 0.114), i, 0.0);
    s.cone(v(0.045, 1.27, 0.0), 0.082, v(0.034, 1.12, 0.0), 0.076, 0.05);
    s.ellipsoid(v(0.0, 1.035, -0.008), v(0.146, 0.095, 0.096), i, 0.05);
    s.ellipsoid(v(0.0, 0.955, 0.005), v(0.075, 0.08, 0.075), i, 0.05);
    // Back: lats, shoulder blades, the columns along the spine.
    belly(
        &mut s,
        v(0.200, 1.490, -0.050),
        v(0.080, 1.150, -0.055),
        v(0.7, 0.0, -0.6),
        (0.080, 0.060),
        0.03,
    );
    belly(
        &mut s,
        v(0.185, 1.50, -0.085),
        v(0.055, 1.36, -0.115),
        v(0.2, 0.2, -1.0),
        (0.055, 0.032),
        0.018,
    );
    belly(
        &mut s,
        v(0.15, 1.56, -0.085),
        v(0.05, 1.50, -0.11),
        v(0.0, 0.4, -1.0),
        (0.035, 0.03),
        0.018,
    );
    s.cone(v(0.038, 1.05, -0.07), 0.036, v(0.033, 1.36, -0.095), 0.034, 0.02);
    belly(
        &mut s,
        v(0.012, 1.60, -0.07),
        v(0.018, 1.30, -0.12),
        v(0.3, 0.0, -1.0),
        (0.045, 0.025),
        0.02,
    );
    // Shoulder girdle: trapezius, collar bone.
    belly(
        &mut s,
        v(0.035, 1.670, -0.045),
        v(0.215, 1.550, -0.045),
        v(0.3, 0.8, -0.4),
        (0.050, 0.042),
        0.03,
    );
    s.ellipsoid(v(0.055, 1.565, 0.000), v(0.085, 0.040, 0.052), i, 0.045);
    s.cone(v(0.100, 1.552, 0.012), 0.036, v(0.205, 1.545, 0.010), 0.040, 0.050);
    // Chest: upper and lower part of each pectoral, running out to the arm.
    let front = v(0.35, 0.12, 1.0);
    belly(&mut s, v(0.000, 1.425, 0.070), v(0.230, 1.505, 0.018), front, (0.066, 0.056), 0.032);
    belly(
        &mut s,
        v(0.004, 1.495, 0.052),
        v(0.205, 1.525, 0.012),
        v(0.3, 0.4, 1.0),
        (0.045, 0.040),
        0.036,
    );
    s.ellipsoid(v(0.090, 1.415, 0.066), v(0.080, 0.050, 0.050), i, 0.020);
    // Ribs' edge and the teeth of the serratus.
    for (x, y, z) in [(0.148, 1.350, 0.040), (0.141, 1.310, 0.050), (0.130, 1.270, 0.056)] {
        let lean = v(-0.6, -0.45, 0.5) * 0.038;
        let (a, b) = (v(x, y, z) - lean, v(x, y, z) + lean);
        belly(&mut s, a, b, v(0.9, 0.0, 0.5), (0.021, 0.012), 0.020);
    }
    // Belly: four rows, and the flanks that bulge over the belt.
    for (y, z, height, wide) in
        [(1.325, 0.087, 0.034, 0.040), (1.262, 0.090, 0.034, 0.041), (1.197, 0.088, 0.035, 0.040)]
    {
        s.ellipsoid(v(0.0405, y, z - 0.008), v(wide, height, 0.029), i, 0.015);
    }
    s.ellipsoid(v(0.033, 1.11, 0.062), v(0.042, 0.068, 0.034), i, 0.016);
    belly(
        &mut s,
        v(0.098, 1.235, 0.020),
        v(0.116, 1.075, 0.018),
        v(1.0, 0.0, 0.5),
        (0.060, 0.032),
        0.022,
    );
    // Seat.
    belly(
        &mut s,
        v(0.060, 1.06, -0.060),
        v(0.110, 0.915, -0.060),
        v(0.3, 0.0, -1.0),
        (0.080, 0.068),
        0.02,
    );
    // Furrows: breastbone, middle of the belly, spine.
    s.carve_cone(v(0.0, 1.52, 0.118), 0.006, v(0.0, 1.40, 0.132), 0.006, 0.028);
    s.carve_cone(v(0.0, 1.37, 0.122), 0.006, v(0.0, 1.16, 0.112), 0.005, 0.014);
    s.carve_cone(v(0.0, 1.50, -0.150), 0.008, v(0.0, 1.08, -0.116), 0.010, 0.022);
    s
}

/// The neck, with the muscle that runs from behind the ear to the breastbone.
pub(super) fn neck() -> Solid {
    let mut s = Solid::new();
    s.cone(v(0.0, 1.55, -0.025), 0.072, v(0.0, 1.72, -0.005), 0.060, 0.0);
    s.cone(v(0.060, 1.715, -0.02), 0.017, v(0.014, 1.565, 0.045), 0.012, 0.024);
    s.ellipsoid(v(0.0, 1.655, 0.052), v(0.014, 0.018, 0.012), DMat3::IDENTITY, 0.014);
    s
}
