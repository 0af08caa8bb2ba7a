//! The hero's bones in the bind pose: arms held 40° below the horizontal, all joints unturned.
//!
//! 22 for the body, as VRM names them. Each hand has three more, two for the four fingers together
//! and one for the thumb: with fewer no fist closes. The cape hangs on a chain of four.

use glam::DVec3;

/// A joint.
pub(super) struct Bone {
    /// glTF humanoid name, as VRM has it; the cape's are our own.
    pub(super) name: &'static str,
    pub(super) parent: Option<usize>,
    /// Where it stands in the bind pose, in metres.
    pub(super) at: DVec3,
}

/// Indices of the bones; those of the right side follow the left's by [`RIGHT`].
pub(super) const HIPS: usize = 0;
pub(super) const SPINE: usize = 1;
pub(super) const CHEST: usize = 2;
pub(super) const UPPER_CHEST: usize = 3;
pub(super) const NECK: usize = 4;
pub(super) const HEAD: usize = 5;
pub(super) const SHOULDER: usize = 6;
pub(super) const UPPER_ARM: usize = 7;
pub(super) const LOWER_ARM: usize = 8;
pub(super) const HAND: usize = 9;
pub(super) const FINGERS: usize = 10;
pub(super) const FINGER_TIPS: usize = 11;
pub(super) const THUMB: usize = 12;
pub(super) const UPPER_LEG: usize = 13;
pub(super) const LOWER_LEG: usize = 14;
pub(super) const FOOT: usize = 15;
pub(super) const TOES: usize = 16;
pub(super) const RIGHT: usize = 11;
/// The first of the cape's joints, from the shoulders down.
pub(super) const CAPE: usize = 28;
pub(super) const CAPE_JOINTS: usize = 4;

/// Places of the left side's joints.
pub(super) const SHOULDER_AT: DVec3 = DVec3::new(0.03, 1.555, -0.005);
pub(super) const UPPER_ARM_AT: DVec3 = DVec3::new(0.228, 1.540, -0.02);
pub(super) const LOWER_ARM_AT: DVec3 = DVec3::new(0.4580, 1.3470, -0.0250);
pub(super) const HAND_AT: DVec3 = DVec3::new(0.6490, 1.1780, 0.0400);
pub(super) const FINGERS_AT: DVec3 = DVec3::new(0.7206, 1.1154, 0.0661);
pub(super) const FINGER_TIPS_AT: DVec3 = DVec3::new(0.7404, 1.0751, 0.0782);
pub(super) const THUMB_AT: DVec3 = DVec3::new(0.6610, 1.1480, 0.0680);
pub(super) const UPPER_LEG_AT: DVec3 = DVec3::new(0.098, 0.985, 0.0);
pub(super) const LOWER_LEG_AT: DVec3 = DVec3::new(0.135, 0.53, 0.02);
pub(super) const FOOT_AT: DVec3 = DVec3::new(0.155, 0.09, -0.025);
pub(super) const TOES_AT: DVec3 = DVec3::new(0.17, 0.03, 0.105);

/// All bones, parents first.
pub(super) fn bones() -> Vec<Bone> {
    let mut bones = Vec::new();
    let mut add = |name, parent, at| bones.push(Bone { name, parent, at });
    add("hips", None, DVec3::new(0.0, 1.02, 0.0));
    add("spine", Some(HIPS), DVec3::new(0.0, 1.12, -0.01));
    add("chest", Some(SPINE), DVec3::new(0.0, 1.25, -0.015));
    add("upperChest", Some(CHEST), DVec3::new(0.0, 1.40, -0.02));
    add("neck", Some(UPPER_CHEST), DVec3::new(0.0, 1.60, -0.025));
    add("head", Some(NECK), DVec3::new(0.0, 1.69, -0.005));
    let names = [
        ["leftShoulder", "rightShoulder"],
        ["leftUpperArm", "rightUpperArm"],
        ["leftLowerArm", "rightLowerArm"],
        ["leftHand", "rightHand"],
        ["leftMiddleProximal", "rightMiddleProximal"],
        ["leftMiddleIntermediate", "rightMiddleIntermediate"],
        ["leftThumbProximal", "rightThumbProximal"],
        ["leftUpperLeg", "rightUpperLeg"],
        ["leftLowerLeg", "rightLowerLeg"],
        ["leftFoot", "rightFoot"],
        ["leftToes", "rightToes"],
    ];
    let parents = [
        UPPER_CHEST,
        SHOULDER,
        UPPER_ARM,
        LOWER_ARM,
        HAND,
        FINGERS,
        HAND,
        HIPS,
        UPPER_LEG,
        LOWER_LEG,
        FOOT,
    ];
    let places = [
        SHOULDER_AT,
        UPPER_ARM_AT,
        LOWER_ARM_AT,
        HAND_AT,
        FINGERS_AT,
        FINGER_TIPS_AT,
        THUMB_AT,
        UPPER_LEG_AT,
        LOWER_LEG_AT,
        FOOT_AT,
        TOES_AT,
    ];
    for side in 0..2 {
        for ((name, &parent), &at) in names.iter().zip(&parents).zip(&places) {
            let own = if side == 1 && parent >= SHOULDER { parent + RIGHT } else { parent };
            add(name[side], Some(own), if side == 1 { mirrored(at) } else { at });
        }
    }
    let names = ["cape1", "cape2", "cape3", "cape4"];
    for (i, name) in names.into_iter().enumerate() {
        let parent = if i == 0 { UPPER_CHEST } else { CAPE + i - 1 };
        let at = DVec3::new(0.0, 1.53 - 0.30 * i as f64, -0.17 - 0.02 * i as f64);
        add(name, Some(parent), at);
    }
    bones
}

/// The same place on the other side.
pub(super) fn mirrored(p: DVec3) -> DVec3 {
    DVec3::new(-p.x, p.y, p.z)
}
