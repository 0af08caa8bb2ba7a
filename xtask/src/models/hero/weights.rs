//! Which bones hold a point of the bind pose, and how firmly.

use glam::DVec3;

use super::body::Body;
use super::hand;
use super::limbs::{lower_arm, lower_leg, upper_arm, upper_leg};
use super::skeleton::{
    CHEST, FINGER_TIPS, FINGER_TIPS_AT, FINGERS, FINGERS_AT, FOOT, HAND, HAND_AT, HEAD, HIPS,
    LOWER_ARM, LOWER_ARM_AT, LOWER_LEG, LOWER_LEG_AT, NECK, RIGHT, SHOULDER, SPINE, THUMB,
    THUMB_AT, TOES, TOES_AT, UPPER_ARM, UPPER_CHEST, UPPER_LEG, mirrored,
};
use crate::models::sculpt::smooth_step;

/// A weight for every bone; they add up to 1.
pub(super) type Weights = Vec<f64>;

/// Gives `share` of what `from` has to `to`.
fn hand_on(weights: &mut [f64], from: usize, to: usize, share: f64) {
    let moved = weights[from] * share;
    weights[from] -= moved;
    weights[to] += moved;
}

/// Weights of a point on the body, smooth across every joint.
pub(super) fn body_weights(body: &Body, p: DVec3, bones: usize) -> Weights {
    let q = if p.x < 0.0 { mirrored(p) } else { p };
    let of = if p.x < 0.0 { RIGHT } else { 0 };
    let [torso, arm, leg, head] = body.parts(q);
    let mut w = vec![0.0; bones];
    w[HIPS] = 1.0;
    // The trunk from below to above.
    hand_on(&mut w, HIPS, SPINE, smooth_step(1.075, 1.19, q.y));
    hand_on(&mut w, SPINE, CHEST, smooth_step(1.18, 1.32, q.y));
    hand_on(&mut w, CHEST, UPPER_CHEST, smooth_step(1.31, 1.47, q.y));
    let of_neck = smooth_step(0.02, -0.02, head - torso) * smooth_step(1.56, 1.62, q.y);
    hand_on(&mut w, UPPER_CHEST, NECK, of_neck);
    hand_on(&mut w, NECK, HEAD, smooth_step(1.655, 1.725, q.y + 0.5 * q.z));
    // The collar bone's share.
    let collar = smooth_step(0.05, 0.18, q.x) * smooth_step(1.42, 1.53, q.y);
    hand_on(&mut w, UPPER_CHEST, SHOULDER + of, 0.85 * collar * (1.0 - of_neck));
    // The breast folds more softly than the shoulder blade.
    let breast = smooth_step(-0.01, 0.05, q.z);
    let on_arm = smooth_step(-0.030 - 0.02 * breast, 0.035 + 0.02 * breast, torso - arm)
        * smooth_step(
            -0.075 - 0.03 * breast,
            0.045 + 0.05 * breast,
            (q - upper_arm().from).dot(upper_arm().along),
        );
    for bone in [HIPS, SPINE, CHEST, UPPER_CHEST, SHOULDER + of] {
        hand_on(&mut w, bone, UPPER_ARM + of, on_arm);
    }
    let groin = smooth_step(-0.02, 0.06, q.z);
    let on_leg = smooth_step(-0.045, 0.055, torso - leg)
        // The groin folds more softly than the seat, and the belt stays on the hips.
        * smooth_step(
            -0.07 + 0.03 * groin,
            0.06 + 0.10 * groin,
            (q - upper_leg().from).dot(upper_leg().along),
        )
        * smooth_step(1.035, 0.985, q.y);
    for bone in [HIPS, SPINE] {
        hand_on(&mut w, bone, UPPER_LEG + of, on_leg);
    }
    if q.x > 0.35 {
        hand_down_arm(&mut w, of, q);
    } else if q.y < 0.8 {
        let bisector = (upper_leg().along + lower_leg().along).normalize();
        let knee = smooth_step(-0.06, 0.06, (q - LOWER_LEG_AT).dot(bisector));
        hand_on(&mut w, UPPER_LEG + of, LOWER_LEG + of, knee);
        hand_on(&mut w, LOWER_LEG + of, FOOT + of, smooth_step(0.135, 0.065, q.y - 0.25 * q.z));
        let toes = smooth_step(-0.03, 0.03, q.z - TOES_AT.z) * smooth_step(0.12, 0.08, q.y);
        hand_on(&mut w, FOOT + of, TOES + of, toes);
    }
    w
}

fn hand_down_arm(w: &mut [f64], of: usize, q: DVec3) {
    // Where flesh meets in the bend, two turns may only be mixed slowly: past a slope of
    // 1 / (2 r tan(θ / 2)) over the distance, the skin r off a joint bent by θ folds over.
    let (upper, lower) = (upper_arm().along, lower_arm().along);
    let bisector = (upper + lower).normalize();
    let inner = smooth_step(-0.02, 0.03, (q - LOWER_ARM_AT).dot((lower - upper).normalize()));
    let reach = 0.055 + 0.060 * inner;
    let elbow = smooth_step(-reach, reach, (q - LOWER_ARM_AT).dot(bisector));
    hand_on(w, UPPER_ARM + of, LOWER_ARM + of, elbow);
    let hand::Frame { along, palm, .. } = hand::frame();
    let wrist = smooth_step(-0.050, 0.035, (q - HAND_AT).dot(along));
    hand_on(w, LOWER_ARM + of, HAND + of, wrist);
    let (base, tip) = hand::thumb_line();
    let way = tip - base;
    let t = ((q - base).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    let on_thumb = smooth_step(0.030, 0.020, q.distance(base + way * t))
        * smooth_step(0.012, -0.004, (q - FINGERS_AT).dot(along));
    let thumb = smooth_step(-0.016, 0.016, (q - THUMB_AT).dot(way.normalize()));
    hand_on(w, HAND + of, THUMB + of, thumb * on_thumb);
    hand_on(w, HAND + of, FINGERS + of, smooth_step(-0.012, 0.010, (q - FINGERS_AT).dot(along)));
    let across = (along * 0.6 + palm * 0.8).normalize();
    let tips = smooth_step(-0.008, 0.008, (q - FINGER_TIPS_AT).dot(across));
    hand_on(w, FINGERS + of, FINGER_TIPS + of, tips);
}

/// The four largest weights in 1/65535, which they add up to.
pub(super) fn quantised(weights: &[f64]) -> ([u8; 4], [u16; 4]) {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]).then(a.cmp(&b)));
    let four = &order[..4];
    let sum: f64 = four.iter().map(|&b| weights[b]).sum();
    let (mut joints, mut shares) = ([0; 4], [0; 4]);
    let mut left = u16::MAX;
    for slot in (1..4).rev() {
        let share = (weights[four[slot]] / sum * 65535.0).round() as u16;
        if share > 0 {
            (joints[slot], shares[slot]) = (four[slot] as u8, share);
            left -= share;
        }
    }
    (joints[0], shares[0]) = (four[0] as u8, left);
    (joints, shares)
}
