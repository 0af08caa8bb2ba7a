//! Head, hair and what lies on the face, in the half where x ≥ 0.

use glam::{DMat3, DVec3};

use super::torso::belly;
use crate::models::sculpt::Solid;

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
    s.carve_ellipsoid(v(0.031, 1.799, 0.104), v(0.021, 0.011, 0.013), i, 0.010);
    // Nose.
    s.cone(v(0.0, 1.808, 0.096), 0.0075, v(0.0, 1.770, 0.115), 0.0092, 0.008);
    s.ellipsoid(v(0.0105, 1.764, 0.104), v(0.0075, 0.0065, 0.009), i, 0.005);
    // Mouth: the swell of the lips, and the hollow below.
    s.ellipsoid(v(0.0, 1.739, 0.082), v(0.030, 0.021, 0.021), i, 0.014);
    s.ellipsoid(v(0.0, 1.7315, 0.097), v(0.015, 0.0052, 0.008), i, 0.006);
    s.carve_ellipsoid(v(0.0, 1.7225, 0.103), v(0.018, 0.004, 0.005), i, 0.008);
    // Ear.
    let ear = DMat3::from_cols(v(0.94, 0.0, -0.34), v(0.0, 1.0, 0.0), v(0.34, 0.0, 0.94));
    s.ellipsoid(v(0.0785, 1.786, -0.012), v(0.009, 0.031, 0.019), ear, 0.006);
    s.carve_ellipsoid(v(0.0885, 1.790, -0.008), v(0.006, 0.019, 0.010), ear, 0.004);
    s
}

/// The hair: a cap with swept-back locks. Asymmetric, so it takes both halves.
pub(super) fn hair() -> Solid {
    let mut s = Solid::new();
    let mut cap = Solid::new();
    cap.ellipsoid(v(0.0, 1.838, -0.016), v(0.083, 0.088, 0.102), DMat3::IDENTITY, 0.0);
    // The hairline: over the forehead, down before the ears, across the nape.
    cap.cut(v(0.0, 1.872, 0.060), v(0.0, -0.55, 0.83), 0.008);
    cap.cut(v(0.0, 1.792, -0.02), v(0.0, -0.93, 0.37), 0.008);
    s.solid(cap, 0.0);
    for side in [-1.0, 1.0] {
        // Sideburns.
        s.cone(v(side * 0.072, 1.822, 0.026), 0.011, v(side * 0.074, 1.778, 0.018), 0.006, 0.010);
        // Sides swept back.
        for (y, z, drop) in [(1.868, 0.040, 0.028), (1.842, 0.022, 0.030), (1.815, -0.002, 0.028)] {
            let (a, b) = (v(side * 0.066, y, z), v(side * 0.066, y - drop, z - 0.085));
            belly(&mut s, a, b, v(side, 0.2, 0.0), (0.019, 0.022), 0.006);
        }
    }
    // The crest rises over the forehead and falls back; it is parted on the left.
    for (x, lift, length) in [
        (-0.052, 0.000, 0.10),
        (-0.030, 0.008, 0.13),
        (-0.006, 0.014, 0.14),
        (0.018, 0.012, 0.135),
        (0.041, 0.004, 0.11),
    ] {
        let root = v(x, 1.884 - x * x * 4.0, 0.068);
        let crest = v(x * 1.15 - 0.004, 1.922 + lift - x * x * 6.0, 0.048);
        let back = v(x * 1.1 - 0.006, 1.912 + lift * 0.5 - x * x * 6.0, 0.048 - length);
        s.cone(root, 0.013, crest, 0.020, 0.008);
        s.cone(crest, 0.020, back, 0.017, 0.008);
    }
    // One lock falls on the forehead.
    s.cone(v(0.012, 1.892, 0.078), 0.012, v(0.020, 1.872, 0.096), 0.009, 0.006);
    s.cone(v(0.020, 1.872, 0.096), 0.009, v(0.012, 1.852, 0.101), 0.0045, 0.003);
    s
}
