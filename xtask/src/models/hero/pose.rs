//! Poses by what an animator thinks of: the trunk's turns, where hands and feet are, where elbows
//! and knees point.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use super::hand;
use super::skeleton::{
    Bone, CAPE, CAPE_JOINTS, CHEST, FINGER_TIPS, FINGERS, FOOT, HAND, HEAD, HIPS, LOWER_ARM,
    LOWER_LEG, NECK, RIGHT, SHOULDER, SPINE, THUMB, TOES, UPPER_ARM, UPPER_CHEST, UPPER_LEG,
    mirrored,
};

/// Elbows and knees bend no further: such muscles leave no room for more.
const MOST_BENT_DEG: f64 = 103.0;

/// Turns in degrees: bow forwards, turn to the own left, tilt to the own right.
pub(super) type Turn = [f64; 3];

/// An arm, in the world's space.
#[derive(Clone, Copy)]
pub(super) struct Arm {
    /// Collar bone: up, forwards, in degrees.
    pub(super) shoulder: [f64; 2],
    /// Where the wrist is.
    pub(super) wrist: DVec3,
    /// Where the elbow points.
    pub(super) elbow: DVec3,
    /// Where the hand points.
    pub(super) hand: DVec3,
    /// Where the palm faces.
    pub(super) palm: DVec3,
    /// 0: open, 1: a fist.
    pub(super) fist: f64,
}

/// A leg, in the world's space.
#[derive(Clone, Copy)]
pub(super) struct Leg {
    /// Where the ankle is.
    pub(super) ankle: DVec3,
    /// Where the knee points.
    pub(super) knee: DVec3,
    /// The foot's turn: toes down, toes to the own left, in degrees.
    pub(super) foot: [f64; 2],
    /// Toes bent up, in degrees.
    pub(super) toes: f64,
}

/// A pose; arms and legs are left, right.
#[derive(Clone, Copy)]
pub(super) struct Pose {
    pub(super) hips_at: DVec3,
    /// Hips, spine, chest, upper chest, neck, head, each against the one before.
    pub(super) trunk: [Turn; 6],
    pub(super) arms: [Arm; 2],
    pub(super) legs: [Leg; 2],
    /// The cape's joints: lifted backwards, swung to the own left, twisted, in degrees.
    pub(super) cape: [Turn; CAPE_JOINTS],
}

/// Where every bone of a pose is.
pub(super) struct Placed {
    /// Turns against the bind pose, in the world's space.
    pub(super) turns: Vec<DMat3>,
    pub(super) places: Vec<DVec3>,
}

fn about(axis: DVec3, deg: f64) -> DMat3 {
    let (s, c) = (libm::sin(deg.to_radians()), libm::cos(deg.to_radians()));
    let t = 1.0 - c;
    let DVec3 { x, y, z } = axis;
    DMat3::from_cols(
        DVec3::new(t * x * x + c, t * x * y + s * z, t * x * z - s * y),
        DVec3::new(t * x * y - s * z, t * y * y + c, t * y * z + s * x),
        DVec3::new(t * x * z + s * y, t * y * z - s * x, t * z * z + c),
    )
}

fn turned([bow, turn, tilt]: Turn) -> DMat3 {
    about(DVec3::Y, turn) * about(DVec3::X, bow) * about(DVec3::Z, tilt)
}

/// The frame whose first axis is `a` and whose second one is as near to `b` as can be.
fn frame(a: DVec3, b: DVec3) -> DMat3 {
    let a = a.normalize();
    let b = (b - a * b.dot(a)).normalize();
    DMat3::from_cols(a, b, a.cross(b))
}

/// The turn that takes one pair of directions to another.
fn turn_between(from: [DVec3; 2], to: [DVec3; 2]) -> DMat3 {
    frame(to[0], to[1]) * frame(from[0], from[1]).transpose()
}

impl Pose {
    /// Places every bone.
    pub(super) fn place(&self, bones: &[Bone]) -> Placed {
        let n = bones.len();
        let mut placed = Placed { turns: vec![DMat3::IDENTITY; n], places: vec![DVec3::ZERO; n] };
        placed.places[HIPS] = self.hips_at;
        placed.turns[HIPS] = turned(self.trunk[0]);
        for (bone, turn) in
            [SPINE, CHEST, UPPER_CHEST, NECK, HEAD].into_iter().zip(&self.trunk[1..])
        {
            placed.hang(bones, bone, turned(*turn));
        }
        for side in 0..2 {
            let (of, sign) = (side * RIGHT, if side == 0 { 1.0 } else { -1.0 });
            placed.arm(bones, of, sign, &self.arms[side]);
            placed.leg(bones, of, &self.legs[side]);
        }
        for (i, turn) in self.cape.iter().enumerate() {
            let [lift, swing, twist] = *turn;
            let local = about(DVec3::Z, swing) * about(DVec3::X, lift) * about(DVec3::Y, twist);
            placed.hang(bones, CAPE + i, local);
        }
        placed
    }

    /// Between two poses; `t` may be eased.
    pub(super) fn between(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * t;
        let turn = |a: Turn, b: Turn| [0, 1, 2].map(|i| mix(a[i], b[i]));
        let arm = |i: usize| {
            let (a, b) = (&self.arms[i], &other.arms[i]);
            Arm {
                shoulder: [0, 1].map(|k| mix(a.shoulder[k], b.shoulder[k])),
                wrist: a.wrist.lerp(b.wrist, t),
                elbow: a.elbow.lerp(b.elbow, t),
                hand: a.hand.normalize().lerp(b.hand.normalize(), t),
                palm: a.palm.normalize().lerp(b.palm.normalize(), t),
                fist: mix(a.fist, b.fist),
            }
        };
        let leg = |i: usize| {
            let (a, b) = (&self.legs[i], &other.legs[i]);
            Leg {
                ankle: a.ankle.lerp(b.ankle, t),
                knee: a.knee.lerp(b.knee, t),
                foot: [0, 1].map(|k| mix(a.foot[k], b.foot[k])),
                toes: mix(a.toes, b.toes),
            }
        };
        Self {
            hips_at: self.hips_at.lerp(other.hips_at, t),
            trunk: [0, 1, 2, 3, 4, 5].map(|i| turn(self.trunk[i], other.trunk[i])),
            arms: [arm(0), arm(1)],
            legs: [leg(0), leg(1)],
            cape: [0, 1, 2, 3].map(|i| turn(self.cape[i], other.cape[i])),
        }
    }
}

impl Placed {
    /// Places a bone on its parent, with a turn against it.
    fn hang(&mut self, bones: &[Bone], bone: usize, turn: DMat3) {
        let parent = bones[bone].parent.unwrap_or(HIPS);
        let offset = bones[bone].at - bones[parent].at;
        self.places[bone] = self.places[parent] + self.turns[parent] * offset;
        self.turns[bone] = self.turns[parent] * turn;
    }

    /// Two bones that reach for a target (law of cosines); gives the common hinge.
    fn reach(
        &mut self,
        bones: &[Bone],
        [first, second, end]: [usize; 3],
        target: DVec3,
        pole: DVec3,
    ) {
        self.hang(bones, first, DMat3::IDENTITY);
        let from = self.places[first];
        let (d1, d2) = (bones[second].at - bones[first].at, bones[end].at - bones[second].at);
        let (l1, l2) = (d1.length(), d2.length());
        let way = target - from;
        let bent = libm::cos(MOST_BENT_DEG.to_radians());
        let least = (l1 * l1 + l2 * l2 + 2.0 * l1 * l2 * bent).sqrt();
        let distance = way.length().clamp(least, (l1 + l2) * 0.997);
        let way = way.normalize();
        let along = (l1 * l1 - l2 * l2 + distance * distance) / (2.0 * distance);
        let off = (l1 * l1 - along * along).max(0.0).sqrt();
        let side = (pole - way * pole.dot(way)).normalize();
        let middle = from + way * along + side * off;
        let reached = from + way * distance;
        let hinge = (middle - from).cross(reached - middle).normalize();
        let bind_hinge = d1.cross(d2).normalize();
        self.turns[first] = turn_between([d1, bind_hinge], [middle - from, hinge]);
        self.places[second] = middle;
        self.turns[second] = turn_between([d2, bind_hinge], [reached - middle, hinge]);
        self.places[end] = reached;
    }

    fn arm(&mut self, bones: &[Bone], of: usize, sign: f64, arm: &Arm) {
        let [up, forwards] = arm.shoulder;
        let collar = about(DVec3::Z, sign * up) * about(DVec3::Y, -sign * forwards);
        self.hang(bones, SHOULDER + of, collar);
        let chain = [UPPER_ARM, LOWER_ARM, HAND].map(|bone| bone + of);
        self.reach(bones, chain, arm.wrist, arm.elbow);
        let mirror = |v: DVec3| if sign < 0.0 { mirrored(v) } else { v };
        let bind = hand::frame();
        let (along, palm) = (mirror(bind.along), mirror(bind.palm));
        let turn = turn_between([along, palm], [arm.hand, arm.palm]);
        self.turns[HAND + of] = turn;
        // The forearm takes half of the hand's twist, as its two bones do.
        let lower = self.turns[LOWER_ARM + of];
        let axis = (self.places[HAND + of] - self.places[LOWER_ARM + of]).normalize();
        let flat = |v: DVec3| (v - axis * v.dot(axis)).normalize_or_zero();
        let (now, wanted) = (flat(lower * palm), flat(turn * palm));
        let angle = libm::atan2(now.cross(wanted).dot(axis), now.dot(wanted)).to_degrees();
        self.turns[LOWER_ARM + of] = about(axis, angle * 0.75) * lower;
        // Fingers bend about the axis across the palm.
        let across = -mirror(bind.thumb) * sign;
        let bend = |deg: f64| about(across, deg);
        let curl = arm.fist;
        self.hang(bones, FINGERS + of, bend(-24.0 + 72.0 * curl));
        self.hang(bones, FINGER_TIPS + of, bend(-26.0 + 69.0 * curl));
        let thumb_axis = mirror(bind.along) * sign;
        self.hang(bones, THUMB + of, about(thumb_axis, -29.0 * curl) * bend(15.0 * curl));
    }

    fn leg(&mut self, bones: &[Bone], of: usize, leg: &Leg) {
        let chain = [UPPER_LEG, LOWER_LEG, FOOT].map(|bone| bone + of);
        self.reach(bones, chain, leg.ankle, leg.knee);
        let [down, left] = leg.foot;
        self.turns[FOOT + of] = about(DVec3::Y, left) * about(DVec3::X, down);
        self.hang(bones, TOES + of, about(DVec3::X, -leg.toes));
    }

    /// Translation and rotation of each bone against its parent.
    pub(super) fn locals(&self, bones: &[Bone]) -> Vec<(Vec3, Quat)> {
        let local = |(i, bone): (usize, &Bone)| {
            let (turn, offset) = match bone.parent {
                Some(parent) => {
                    (self.turns[parent].transpose() * self.turns[i], bone.at - bones[parent].at)
                }
                None => (self.turns[i], self.places[i]),
            };
            let q = DQuat::from_mat3(&turn).normalize();
            (offset.as_vec3(), q.as_quat())
        };
        bones.iter().enumerate().map(local).collect()
    }

    /// A point of the bind pose, moved by its bones.
    #[cfg(test)]
    pub(super) fn skinned(&self, bones: &[Bone], p: DVec3, weights: &[(usize, f64)]) -> DVec3 {
        let moved = |&(bone, weight): &(usize, f64)| {
            (self.places[bone] + self.turns[bone] * (p - bones[bone].at)) * weight
        };
        weights.iter().map(moved).sum()
    }
}
