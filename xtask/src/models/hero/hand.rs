//! The left hand, half closed: palm, four fingers, and a thumb well apart.

use glam::{DMat3, DVec3};

use super::skeleton::{FINGERS_AT, HAND_AT, THUMB_AT};
use crate::models::sculpt::Solid;

/// The hand's frame: along the palm to the knuckles, out of the palm, and towards the thumb.
pub(super) struct Frame {
    pub(super) along: DVec3,
    pub(super) palm: DVec3,
    pub(super) thumb: DVec3,
}

pub(super) fn frame() -> Frame {
    let along = (FINGERS_AT - HAND_AT).normalize();
    let palm = DVec3::new(-0.66, -0.75, 0.05);
    let palm = (palm - along * palm.dot(along)).normalize();
    Frame { along, palm, thumb: palm.cross(along) }
}

/// Palm, fingers and thumb.
pub(super) fn hand() -> Solid {
    let Frame { along, palm, thumb } = frame();
    let at = |a: f64, t: f64, p: f64| HAND_AT + along * a + thumb * t + palm * p;
    let axes = DMat3::from_cols(thumb, along, palm);
    let mut s = Solid::new();
    s.block(at(0.056, 0.0, 0.002), DVec3::new(0.046, 0.050, 0.019), axes, 0.016, 0.0);
    s.cone(at(-0.02, 0.010, 0.0), 0.026, at(0.03, 0.012, 0.0), 0.024, 0.02);
    s.cone(at(-0.02, -0.010, 0.0), 0.026, at(0.03, -0.016, 0.0), 0.024, 0.02);
    // Balls of the thumb and of the little finger.
    s.ellipsoid(at(0.040, 0.028, 0.016), DVec3::new(0.022, 0.036, 0.018), axes, 0.012);
    s.ellipsoid(at(0.042, -0.028, 0.014), DVec3::new(0.018, 0.036, 0.014), axes, 0.012);
    // Fingers: index to little; bent by about 30° at each joint.
    // Each is a form of its own, so that no web grows between them.
    let fingers = [
        (0.0415, 0.097, 0.018, 1.00),
        (0.0140, 0.102, 0.006, 1.08),
        (-0.0140, 0.099, -0.006, 1.02),
        (-0.0405, 0.091, -0.020, 0.88),
    ];
    for (side, start, fan, size) in fingers {
        let root = at(start, side, 0.002);
        let spread = thumb * fan * 1.2;
        let bent = |cos: f64, sin: f64| along * cos + palm * sin;
        let middle = root + (bent(0.90, 0.44) * 0.042 + spread * 0.4) * size;
        let last = middle + (bent(0.55, 0.83) * 0.030 + spread * 0.12) * size;
        let tip = last + bent(0.30, 0.95) * 0.022 * size;
        let mut finger = Solid::new();
        finger.cone(root - along * 0.02, 0.0114, middle, 0.0110, 0.0);
        finger.ellipsoid(root - palm * 0.006, DVec3::new(0.0112, 0.014, 0.012), axes, 0.012);
        finger.cone(middle, 0.0110, last, 0.0104, 0.012);
        finger.cone(last, 0.0104, tip, 0.0096, 0.010);
        s.solid(finger, 0.004);
    }
    // The thumb points forwards and across.
    let [base, joint, tip] = thumb_joints();
    s.cone(at(0.018, 0.022, 0.010), 0.018, base, 0.017, 0.010);
    s.cone(base, 0.0165, joint, 0.0135, 0.012);
    s.cone(joint, 0.0135, tip, 0.0112, 0.003);
    s
}

fn thumb_joints() -> [DVec3; 3] {
    let Frame { along, palm, thumb } = frame();
    let joint = THUMB_AT + (along * 0.45 + thumb * 0.80 + palm * 0.25).normalize() * 0.044;
    let tip = joint + (along * 0.80 + thumb * 0.42 + palm * 0.22).normalize() * 0.032;
    [THUMB_AT, joint, tip]
}

/// The thumb's first joint and its tip.
pub(super) fn thumb_line() -> (DVec3, DVec3) {
    let [base, _, tip] = thumb_joints();
    (base, tip)
}
