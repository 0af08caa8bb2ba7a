//! The head's form, in the half where x ≥ 0: skull, face, neck and shoulders; y = 0 is where the
//! bust is cut off.

use glam::{DMat3, DVec3};

use crate::models::sculpt::{Field, Solid, gradient, smooth_step};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The centre of the skull, round which the hair lies.
pub(super) const SKULL: DVec3 = DVec3::new(0.0, 0.272, -0.012);

/// The sculpted bust.
pub(super) struct Form(Solid);

impl Form {
    pub(super) fn new() -> Self {
        let i = DMat3::IDENTITY;
        let mut s = Solid::new();
        s.ellipsoid(SKULL, v(0.086, 0.094, 0.098), i, 0.0);
        s.ellipsoid(v(0.0, 0.226, 0.018), v(0.077, 0.078, 0.068), i, 0.03);
        // Cheeks that run down to a small chin.
        s.cone(v(0.028, 0.213, 0.022), 0.045, v(0.0, 0.1480, 0.060), 0.0095, 0.022);
        s.ellipsoid(v(0.036, 0.199, 0.046), v(0.024, 0.022, 0.022), i, 0.03);
        // Hollows for the eyes, a small nose, the swell of the mouth.
        s.carve_ellipsoid(v(0.042, 0.222, 0.103), v(0.032, 0.028, 0.016), i, 0.020);
        s.cone(v(0.0, 0.213, 0.084), 0.0030, v(0.0, 0.1905, 0.0945), 0.0040, 0.012);
        s.ellipsoid(v(0.0, 0.167, 0.070), v(0.020, 0.013, 0.011), i, 0.014);
        // Ears.
        let ear = DMat3::from_cols(v(0.92, 0.0, -0.39), v(0.0, 1.0, 0.0), v(0.39, 0.0, 0.92));
        s.ellipsoid(v(0.087, 0.212, -0.014), v(0.009, 0.031, 0.019), ear, 0.006);
        s.carve_ellipsoid(v(0.097, 0.215, -0.008), v(0.006, 0.020, 0.010), ear, 0.004);
        // Neck and shoulders.
        s.cone(v(0.0, 0.175, -0.024), 0.029, v(0.0, 0.05, -0.034), 0.031, 0.014);
        s.cone(v(0.0, 0.046, -0.036), 0.040, v(0.125, 0.004, -0.036), 0.046, 0.045);
        s.ellipsoid(v(0.0, 0.0, -0.012), v(0.115, 0.055, 0.062), i, 0.03);
        s.cut(DVec3::ZERO, -DVec3::Y, 0.030);
        Self(s)
    }

    /// Where the face is at that x and y, seen from the front, and its normal.
    pub(super) fn on_face(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let (mut outside, mut inside) = (0.16, 0.0);
        for _ in 0..44 {
            let middle = (outside + inside) / 2.0;
            if self.at(v(x, y, middle)) > 0.0 { outside = middle } else { inside = middle }
        }
        let p = v(x, y, (outside + inside) / 2.0);
        (p, gradient(self, p).normalize_or_zero())
    }
}

impl Field for Form {
    fn at(&self, p: DVec3) -> f64 {
        self.0.at(v(p.x.abs(), p.y, p.z))
    }
}

/// The length of edges in metres that a place deserves.
pub(super) fn edge_length(p: DVec3) -> f64 {
    let q = v(p.x.abs(), p.y, p.z);
    let near = |center: DVec3, radius: f64| smooth_step(radius * 1.7, radius, q.distance(center));
    let mut length: f64 = 0.0085;
    let mut finer = |to: f64, how: f64| length = length.min(0.0085 + (to - 0.0085) * how);
    finer(0.0042, near(v(0.0, 0.20, 0.07), 0.055));
    finer(0.0028, near(v(0.041, 0.222, 0.075), 0.030));
    finer(0.0012, near(v(0.0, 0.167, 0.082), 0.014));
    finer(0.0045, near(v(0.09, 0.212, -0.012), 0.03));
    length
}

/// Clothes below the neck.
pub(super) fn cloth(p: DVec3) -> f64 {
    (p.y - 0.090 - 0.20 * p.z) * 0.95
}
