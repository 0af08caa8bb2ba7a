//! The hero's clips, one key for each frame at 24 frames per second.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Quat, Vec3};

use super::pose::{Arm, Leg, Pose};
use super::skeleton::{Bone, HIPS};
use crate::models::glb::{Model, NodeId, Track};
use crate::models::sculpt::smooth_step;

/// Frames per second.
pub(super) const FPS: f64 = 24.0;

/// A clip: its name, its last frame, and its pose at a time in seconds.
pub(super) struct Clip {
    pub(super) name: &'static str,
    pub(super) last_frame: usize,
    pub(super) pose: fn(f64) -> Pose,
}

pub(super) const CLIPS: [Clip; 3] = [
    Clip { name: "walk", last_frame: 26, pose: walk },
    Clip { name: "punch", last_frame: 24, pose: punch },
    Clip { name: "beam", last_frame: 36, pose: beam },
];

/// Adds all clips to a model.
pub(super) fn add(model: &mut Model, bones: &[Bone], joints: &[NodeId]) {
    for clip in &CLIPS {
        let times: Vec<f32> = (0..=clip.last_frame).map(|f| (f as f64 / FPS) as f32).collect();
        let mut rotations: Vec<Vec<Quat>> = vec![Vec::new(); bones.len()];
        let mut hips: Vec<Vec3> = Vec::new();
        for frame in 0..=clip.last_frame {
            let locals = (clip.pose)(frame as f64 / FPS).place(bones).locals(bones);
            hips.push(locals[HIPS].0);
            for (keys, (_, mut q)) in rotations.iter_mut().zip(locals) {
                // The shorter way from key to key, whatever reads the file.
                if keys.last().is_some_and(|last| last.dot(q) < 0.0) {
                    q = -q;
                }
                keys.push(q);
            }
        }
        let mut tracks = vec![Track::Translation(joints[HIPS], hips)];
        for (&joint, keys) in joints.iter().zip(rotations) {
            tracks.push(Track::Rotation(joint, keys));
        }
        model.clip(clip.name, &times, &tracks);
    }
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Passes through poses at times, slowing down at each.
fn through(keys: &[(f64, Pose)], t: f64) -> Pose {
    let next = keys.iter().position(|(time, _)| *time > t).unwrap_or(keys.len());
    if next == 0 {
        return keys[0].1;
    }
    if next == keys.len() {
        return keys[next - 1].1;
    }
    let ((t0, a), (t1, b)) = (&keys[next - 1], &keys[next]);
    a.between(b, smooth_step(*t0, *t1, t))
}

/// Two steps on the spot, seamless: the last frame is the first one.
fn walk(t: f64) -> Pose {
    let phase = t * FPS / 26.0;
    let swing = libm::cos(TAU * phase);
    // Up when a leg passes the other one.
    let hips_at =
        v(0.008 * libm::sin(TAU * phase), 0.957 - 0.017 * libm::cos(2.0 * TAU * phase), 0.0);
    let arm = |sign: f64, forwards: f64| Arm {
        shoulder: [0.0, 3.0 * forwards],
        wrist: v(
            sign * (0.440 - 0.035 * forwards),
            0.985 + 0.045 * forwards * forwards + 0.03 * forwards,
            0.06 + 0.26 * forwards,
        ),
        elbow: v(sign * 0.85, -0.1, -1.0),
        hand: v(sign * 0.10, -1.0, 0.30 + 0.35 * forwards),
        palm: v(-sign, -0.1, 0.15),
        fist: 0.55,
    };
    let bow = 1.5 * libm::cos(2.0 * TAU * phase);
    Pose {
        hips_at,
        trunk: [
            [3.0, -7.0 * swing, 2.0 * libm::sin(TAU * phase)],
            [1.0 + bow * 0.5, 3.0 * swing, -libm::sin(TAU * phase)],
            [0.0, 5.0 * swing, 0.0],
            [0.0, 5.0 * swing, 0.0],
            [-2.0, -3.0 * swing, 0.0],
            [-2.0 - bow * 0.5, -3.0 * swing, 0.0],
        ],
        // Arms against legs.
        arms: [arm(1.0, -swing), arm(-1.0, swing)],
        legs: [step(1.0, phase), step(-1.0, phase + 0.5)],
        cape: [
            [7.0 + 2.0 * bow, 1.5 * libm::sin(TAU * phase), 0.0],
            [5.0, 1.5 * libm::sin(TAU * phase - 0.8), 0.0],
            [4.0 + 2.0 * libm::sin(2.0 * TAU * phase), 1.5 * libm::sin(TAU * phase - 1.6), 0.0],
            [2.0 + 3.0 * libm::sin(2.0 * TAU * phase - 1.0), 0.0, 0.0],
        ],
    }
}

/// A leg of the walk: on the ground for 0.6 of the cycle, from its heel's touching it.
fn step(sign: f64, phase: f64) -> Leg {
    const STANCE: f64 = 0.6;
    let p = phase - phase.floor();
    let (front, back) = (0.30, -0.36);
    let (x, floor) = (sign * 0.115, 0.09);
    let knee = v(sign * 0.12, 0.0, 1.0);
    if p < STANCE {
        let s = p / STANCE;
        let off = smooth_step(0.62, 1.0, s);
        let heel = smooth_step(0.16, 0.0, s);
        Leg {
            // Rolling over the ball of the foot lifts the ankle.
            ankle: v(
                x,
                floor + 0.062 * off + 0.006 * heel,
                front + (back - front) * s + 0.03 * off,
            ),
            knee,
            foot: [38.0 * off - 16.0 * heel, sign * 5.0],
            toes: 34.0 * off,
        }
    } else {
        let s = (p - STANCE) / (1.0 - STANCE);
        let eased = smooth_step(-0.12, 1.05, s);
        let from = smooth_step(-0.12, 1.05, 0.0);
        let to = smooth_step(-0.12, 1.05, 1.0);
        let way = (eased - from) / (to - from);
        Leg {
            ankle: v(
                x,
                floor + 0.062 * (1.0 - s) + 0.006 * s + 0.085 * libm::sin(PI * s),
                (back + 0.03) + (front - back - 0.03) * way,
            ),
            knee,
            foot: [38.0 + (-16.0 - 38.0) * smooth_step(0.0, 0.9, s), sign * 5.0],
            toes: 34.0 * smooth_step(0.35, 0.0, s),
        }
    }
}

/// Ready to fight: knees bent, fists up.
fn guard() -> Pose {
    Pose {
        hips_at: v(0.0, 0.93, 0.0),
        trunk: [
            [4.0, -20.0, 0.0],
            [5.0, 0.0, 0.0],
            [4.0, 2.0, 0.0],
            [2.0, 4.0, 0.0],
            [-4.0, 4.0, 0.0],
            [-4.0, 8.0, 0.0],
        ],
        arms: [
            Arm {
                shoulder: [2.0, 8.0],
                wrist: v(0.29, 1.27, 0.40),
                elbow: v(0.9, -0.7, 0.2),
                hand: v(-0.25, 0.75, 0.55),
                palm: v(-0.85, -0.1, -0.35),
                fist: 1.0,
            },
            Arm {
                shoulder: [2.0, 4.0],
                wrist: v(-0.22, 1.29, 0.24),
                elbow: v(-0.8, -1.0, -0.2),
                hand: v(0.20, 0.80, 0.50),
                palm: v(0.85, -0.1, -0.35),
                fist: 1.0,
            },
        ],
        legs: [
            Leg {
                ankle: v(0.20, 0.09, 0.24),
                knee: v(0.20, 0.0, 1.0),
                foot: [0.0, 4.0],
                toes: 0.0,
            },
            Leg {
                ankle: v(-0.20, 0.11, -0.26),
                knee: v(-0.45, 0.0, 1.0),
                foot: [12.0, -34.0],
                toes: 12.0,
            },
        ],
        cape: [[8.0, 0.0, 8.0], [6.0, 0.0, 4.0], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
    }
}

/// From guard: the right fist is drawn back, strikes, stays, and returns.
fn punch(t: f64) -> Pose {
    let guard = guard();
    let mut drawn = guard;
    drawn.hips_at = v(-0.02, 0.905, -0.05);
    drawn.trunk[0] = [2.0, -32.0, 0.0];
    drawn.trunk[2] = [2.0, -10.0, 0.0];
    drawn.trunk[3] = [0.0, -10.0, 0.0];
    drawn.trunk[4] = [-4.0, 16.0, 0.0];
    drawn.trunk[5] = [-4.0, 20.0, 0.0];
    drawn.arms[1] = Arm {
        shoulder: [6.0, -10.0],
        wrist: v(-0.38, 1.36, -0.04),
        elbow: v(-0.9, -0.3, -0.8),
        hand: v(0.10, 0.45, 0.90),
        palm: v(0.75, -0.65, 0.20),
        fist: 1.0,
    };
    drawn.arms[0].wrist = v(0.28, 1.27, 0.44);
    drawn.arms[0].elbow = v(0.8, -0.5, 0.7);
    let mut struck = guard;
    struck.hips_at = v(0.03, 0.885, 0.10);
    struck.trunk = [
        [8.0, 8.0, 0.0],
        [6.0, 10.0, 0.0],
        [6.0, 14.0, 0.0],
        [4.0, 12.0, 0.0],
        [-8.0, -18.0, 0.0],
        [-8.0, -24.0, 0.0],
    ];
    struck.arms[1] = Arm {
        shoulder: [4.0, 24.0],
        wrist: v(0.03, 1.40, 0.98),
        elbow: v(-1.0, -0.35, 0.0),
        hand: v(0.05, 0.02, 1.0),
        palm: v(0.15, -1.0, 0.0),
        fist: 1.0,
    };
    struck.arms[0] = Arm {
        shoulder: [2.0, -6.0],
        wrist: v(0.42, 1.17, 0.22),
        elbow: v(0.7, -0.6, -0.9),
        hand: v(-0.10, 0.65, 0.75),
        palm: v(-0.90, -0.1, -0.1),
        fist: 1.0,
    };
    struck.legs[1] = Leg {
        ankle: v(-0.20, 0.17, -0.34),
        knee: v(-0.30, 0.0, 1.0),
        foot: [40.0, -20.0],
        toes: 36.0,
    };
    struck.cape = [[22.0, 0.0, -14.0], [14.0, 0.0, -6.0], [8.0, 0.0, 0.0], [-6.0, 0.0, 0.0]];
    let mut held = struck;
    held.hips_at.z += 0.015;
    held.cape = [[14.0, 0.0, -12.0], [8.0, 0.0, -6.0], [8.0, 0.0, 0.0], [8.0, 0.0, 0.0]];
    through(&[(0.0, guard), (0.30, drawn), (0.44, struck), (0.62, held), (1.0, guard)], t)
}

/// Arms are drawn in, then both are thrust forward with open palms, and stay.
fn beam(t: f64) -> Pose {
    let mut stand = guard();
    stand.trunk = [
        [2.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
    ];
    stand.hips_at = v(0.0, 0.95, 0.0);
    stand.legs = [
        Leg { ankle: v(0.24, 0.09, 0.06), knee: v(0.35, 0.0, 1.0), foot: [0.0, 16.0], toes: 0.0 },
        Leg {
            ankle: v(-0.24, 0.09, -0.10),
            knee: v(-0.35, 0.0, 1.0),
            foot: [0.0, -20.0],
            toes: 0.0,
        },
    ];
    let arm = |sign: f64, wrist: DVec3, elbow: DVec3, hand: DVec3, palm: DVec3, fist: f64| {
        let turn = |p: DVec3| v(sign * p.x, p.y, p.z);
        Arm {
            shoulder: [0.0, 0.0],
            wrist: turn(wrist),
            elbow: turn(elbow),
            hand: turn(hand),
            palm: turn(palm),
            fist,
        }
    };
    let both = |wrist: DVec3, elbow: DVec3, hand: DVec3, palm: DVec3, fist: f64| {
        [arm(1.0, wrist, elbow, hand, palm, fist), arm(-1.0, wrist, elbow, hand, palm, fist)]
    };
    stand.arms =
        both(v(0.40, 1.02, 0.10), v(0.6, 0.0, -1.0), v(0.05, -1.0, 0.35), v(-1.0, -0.1, 0.0), 0.5);
    stand.cape = [[7.0, 0.0, 0.0], [5.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let mut drawn = stand;
    drawn.hips_at = v(0.0, 0.90, -0.05);
    drawn.trunk[1] = [-4.0, 0.0, 0.0];
    drawn.trunk[2] = [-5.0, 0.0, 0.0];
    drawn.trunk[3] = [-4.0, 0.0, 0.0];
    drawn.trunk[4] = [6.0, 0.0, 0.0];
    drawn.arms = both(
        v(0.37, 1.22, 0.12),
        v(0.55, -0.35, -1.0),
        v(-0.10, 0.35, 0.95),
        v(-0.85, 0.0, 0.45),
        0.7,
    );
    for arm in &mut drawn.arms {
        arm.shoulder = [4.0, -10.0];
    }
    let mut thrust = drawn;
    thrust.hips_at = v(0.0, 0.875, 0.09);
    thrust.trunk = [
        [8.0, 0.0, 0.0],
        [7.0, 0.0, 0.0],
        [6.0, 0.0, 0.0],
        [5.0, 0.0, 0.0],
        [-10.0, 0.0, 0.0],
        [-10.0, 0.0, 0.0],
    ];
    thrust.arms = both(
        v(0.20, 1.27, 0.86),
        v(0.7, -1.0, 0.0),
        v(0.10, 0.82, 0.55),
        v(-0.45, -0.45, 0.82),
        0.0,
    );
    for arm in &mut thrust.arms {
        arm.shoulder = [0.0, 26.0];
    }
    // The left hand stays clear of the shield that is before it.
    thrust.arms[0].hand = v(-0.10, 0.45, 0.90);
    thrust.arms[0].palm = v(-0.85, -0.30, 0.20);
    thrust.cape = [[24.0, 0.0, 0.0], [16.0, 0.0, 0.0], [10.0, 0.0, 0.0], [-8.0, 0.0, 0.0]];
    let mut held = thrust;
    held.hips_at.z -= 0.02;
    held.cape = [[16.0, 0.0, 0.0], [12.0, 0.0, 0.0], [12.0, 0.0, 0.0], [4.0, 0.0, 0.0]];
    let mut back = held;
    back.cape = [[20.0, 0.0, 0.0], [13.0, 0.0, 0.0], [6.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    through(
        &[(0.0, stand), (0.42, drawn), (0.62, thrust), (0.92, held), (1.25, back), (1.5, back)],
        t,
    )
}
