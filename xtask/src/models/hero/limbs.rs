//! Arms and legs, in the half where x ≥ 0.

use glam::{DMat3, DVec3};

use super::limb::Limb;
use super::skeleton::{FOOT_AT, HAND_AT, LOWER_ARM_AT, LOWER_LEG_AT, UPPER_ARM_AT, UPPER_LEG_AT};
use super::torso::belly;
use crate::models::sculpt::Solid;

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// `out` is the side of the deltoid, away from the body and up.
pub(super) fn upper_arm() -> Limb {
    Limb::new(UPPER_ARM_AT, LOWER_ARM_AT, DVec3::Z)
}

pub(super) fn lower_arm() -> Limb {
    Limb::new(LOWER_ARM_AT, HAND_AT, DVec3::Z)
}

pub(super) fn upper_leg() -> Limb {
    Limb::new(UPPER_LEG_AT, LOWER_LEG_AT, DVec3::Z)
}

pub(super) fn lower_leg() -> Limb {
    Limb::new(LOWER_LEG_AT, FOOT_AT, DVec3::Z)
}

/// Deltoid, biceps, triceps, forearm.
pub(super) fn arm() -> Solid {
    let mut s = Solid::new();
    let (u, l) = (upper_arm(), lower_arm());
    s.cone(u.at(0.0, 0.0, 0.0), 0.052, u.at(1.0, 0.0, 0.0), 0.038, 0.0);
    // Deltoid: side, front and rear head, meeting in a point at the middle of the arm.
    belly(&mut s, u.at(-0.22, 0.020, 0.0), u.at(0.56, 0.030, 0.0), u.out, (0.068, 0.064), 0.030);
    belly(
        &mut s,
        u.at(-0.24, 0.010, 0.048),
        u.at(0.52, 0.026, 0.026),
        u.front,
        (0.048, 0.042),
        0.019,
    );
    belly(
        &mut s,
        u.at(-0.24, 0.010, -0.046),
        u.at(0.50, 0.026, -0.024),
        -u.front,
        (0.048, 0.042),
        0.019,
    );
    // Biceps and triceps.
    belly(
        &mut s,
        u.at(0.22, -0.008, 0.024),
        u.at(0.99, -0.002, 0.020),
        u.front,
        (0.047, 0.050),
        0.023,
    );
    belly(
        &mut s,
        u.at(0.10, 0.000, -0.030),
        u.at(0.86, 0.012, -0.028),
        -u.front,
        (0.042, 0.044),
        0.023,
    );
    belly(
        &mut s,
        u.at(0.06, -0.026, -0.022),
        u.at(0.90, -0.014, -0.030),
        -u.front,
        (0.040, 0.044),
        0.023,
    );
    belly(&mut s, u.at(0.55, 0.018, 0.002), u.at(1.05, 0.016, 0.008), u.out, (0.024, 0.026), 0.019);
    // Forearm: two bones side by side, the mass of muscles near the elbow.
    s.cone(l.at(0.0, 0.0, 0.0), 0.040, l.at(0.98, 0.010, 0.0), 0.024, 0.02);
    s.cone(l.at(0.1, -0.008, 0.0), 0.036, l.at(0.98, -0.010, 0.0), 0.024, 0.02);
    belly(
        &mut s,
        l.at(-0.28, 0.020, 0.018),
        l.at(0.66, 0.014, 0.022),
        l.front,
        (0.041, 0.039),
        0.027,
    );
    belly(
        &mut s,
        l.at(-0.05, -0.022, 0.006),
        l.at(0.72, -0.014, 0.006),
        -l.out,
        (0.041, 0.037),
        0.027,
    );
    belly(
        &mut s,
        l.at(-0.06, 0.014, -0.020),
        l.at(0.74, 0.008, -0.014),
        -l.front,
        (0.036, 0.030),
        0.027,
    );
    s.cone(u.at(1.0, 0.0, -0.030), 0.020, l.at(0.02, 0.0, -0.030), 0.018, 0.014);
    s
}

/// Thigh, knee, calf.
pub(super) fn leg() -> Solid {
    let mut s = Solid::new();
    let (u, l) = (upper_leg(), lower_leg());
    let inner = v(-1.0, 0.0, 0.6);
    s.cone(u.at(0.0, 0.0, 0.0), 0.084, u.at(1.0, 0.0, -0.004), 0.050, 0.0);
    // Front: rectus, the outer sweep, the teardrop inside above the knee.
    belly(
        &mut s,
        u.at(-0.06, 0.010, 0.052),
        u.at(0.90, 0.004, 0.034),
        u.front,
        (0.043, 0.054),
        0.019,
    );
    belly(
        &mut s,
        u.at(-0.04, 0.066, 0.006),
        u.at(0.90, 0.034, 0.022),
        u.out,
        (0.056, 0.054),
        0.019,
    );
    belly(
        &mut s,
        u.at(0.40, -0.046, 0.030),
        u.at(1.00, -0.032, 0.028),
        inner,
        (0.040, 0.042),
        0.017,
    );
    // Inside and back.
    belly(
        &mut s,
        u.at(-0.10, -0.045, -0.004),
        u.at(0.70, -0.034, 0.004),
        -u.out,
        (0.062, 0.046),
        0.027,
    );
    belly(
        &mut s,
        u.at(0.02, 0.032, -0.044),
        u.at(0.99, 0.030, -0.028),
        -u.front,
        (0.042, 0.052),
        0.017,
    );
    belly(
        &mut s,
        u.at(0.02, -0.026, -0.046),
        u.at(0.99, -0.028, -0.028),
        -u.front,
        (0.042, 0.052),
        0.017,
    );
    // The furrow from the hip's outside to the knee's inside.
    s.carve_cone(u.at(0.06, -0.014, 0.098), 0.005, u.at(0.55, -0.044, 0.066), 0.005, 0.026);
    // Knee.
    s.ellipsoid(u.at(1.0, 0.0, 0.036), v(0.030, 0.036, 0.026), u.axes(), 0.016);
    s.cone(l.at(0.06, 0.0, 0.030), 0.022, l.at(0.16, 0.0, 0.026), 0.018, 0.016);
    // Calf: shin, two heads behind, the muscle outside of the shin.
    s.cone(l.at(0.0, 0.0, 0.0), 0.050, l.at(1.0, 0.0, 0.0), 0.036, 0.02);
    belly(
        &mut s,
        l.at(-0.04, -0.026, -0.028),
        l.at(0.58, -0.018, -0.024),
        v(-0.4, 0.0, -1.0),
        (0.042, 0.055),
        0.027,
    );
    belly(
        &mut s,
        l.at(-0.04, 0.026, -0.026),
        l.at(0.52, 0.020, -0.024),
        v(0.5, 0.0, -1.0),
        (0.040, 0.052),
        0.027,
    );
    belly(
        &mut s,
        l.at(0.02, 0.024, 0.012),
        l.at(0.76, 0.012, 0.014),
        v(1.0, 0.0, 0.6),
        (0.032, 0.028),
        0.027,
    );
    s.cone(l.at(0.55, 0.0, -0.030), 0.022, l.at(1.0, 0.0, -0.036), 0.016, 0.02);
    s
}

/// The foot in its boot, flat on the ground at y = 0.
pub(super) fn foot() -> Solid {
    let i = DMat3::IDENTITY;
    let mut s = Solid::new();
    s.ellipsoid(v(0.155, 0.040, -0.052), v(0.038, 0.052, 0.046), i, 0.0);
    s.cone(v(0.156, 0.080, -0.020), 0.042, v(0.170, 0.040, 0.10), 0.036, 0.03);
    s.ellipsoid(v(0.174, 0.026, 0.120), v(0.047, 0.038, 0.078), i, 0.025);
    s.ellipsoid(v(0.165, 0.018, 0.04), v(0.040, 0.030, 0.10), i, 0.02);
    s.cut(v(0.0, 0.0, 0.0), -DVec3::Y, 0.008);
    s
}
