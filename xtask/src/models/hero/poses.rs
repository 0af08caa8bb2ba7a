//! The hero's poses and clips.

use glam::DVec3;

use super::pose::{Arm, Leg, Pose};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The pose of the file: a charge behind the shield, the right fist drawn back.
pub(super) fn charge() -> Pose {
    Pose {
        hips_at: v(0.0, 0.825, 0.0),
        trunk: [
            [12.0, -22.0, 0.0],
            [9.0, -8.0, 0.0],
            [6.0, -12.0, 0.0],
            [2.0, -14.0, -4.0],
            [-6.0, 22.0, 2.0],
            [-10.0, 28.0, 3.0],
        ],
        arms: [
            Arm {
                shoulder: [8.0, 16.0],
                wrist: v(-0.14, 1.27, 0.56),
                elbow: v(1.0, -0.40, 0.45),
                hand: v(-0.90, 0.30, 0.25),
                palm: v(-0.10, 0.15, -1.0),
                fist: 1.0,
            },
            Arm {
                shoulder: [10.0, -16.0],
                wrist: v(-0.40, 1.47, -0.08),
                elbow: v(-0.8, -0.35, -0.9),
                hand: v(0.05, 0.75, 0.65),
                palm: v(0.75, -0.45, 0.45),
                fist: 1.0,
            },
        ],
        legs: [
            Leg {
                ankle: v(0.19, 0.09, 0.44),
                knee: v(0.25, 0.1, 1.0),
                foot: [0.0, 8.0],
                toes: 0.0,
            },
            Leg {
                ankle: v(-0.26, 0.17, -0.62),
                knee: v(-0.45, 0.0, 1.0),
                foot: [42.0, -30.0],
                toes: 36.0,
            },
        ],
        cape: [[20.0, -8.0, 24.0], [16.0, -6.0, 8.0], [12.0, -4.0, 0.0], [-14.0, 0.0, 0.0]],
    }
}
