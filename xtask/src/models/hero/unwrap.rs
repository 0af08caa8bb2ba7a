//! Texture coordinates that follow the limbs: u goes once round each limb, and twice round the
//! trunk, with the seam behind or on the inside; v runs down it, 2 a metre.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Held;
use super::limb::Limb;
use super::limbs::{lower_arm, upper_arm, upper_leg};
use super::skeleton::{
    CAPE, FINGER_TIPS, HEAD, LOWER_ARM_AT, LOWER_LEG_AT, NECK, RIGHT, SHOULDER, THUMB, TOES,
    UPPER_ARM, UPPER_LEG, mirrored,
};
use super::weights::Weights;
use crate::models::sculpt::Unwrap;

/// What a chart goes round.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Chart {
    Trunk,
    Head,
    LeftArm,
    RightArm,
    LeftLeg,
    RightLeg,
}

/// All charts, in their order.
const CHARTS: [Chart; 6] =
    [Chart::Trunk, Chart::Head, Chart::LeftArm, Chart::RightArm, Chart::LeftLeg, Chart::RightLeg];

fn chart_of(bone: usize) -> Chart {
    let right = (SHOULDER + RIGHT..CAPE).contains(&bone);
    match if right { bone - RIGHT } else { bone } {
        NECK | HEAD => Chart::Head,
        UPPER_ARM..=FINGER_TIPS | THUMB if right => Chart::RightArm,
        UPPER_ARM..=FINGER_TIPS | THUMB => Chart::LeftArm,
        UPPER_LEG..=TOES if right => Chart::RightLeg,
        UPPER_LEG..=TOES => Chart::LeftLeg,
        _ => Chart::Trunk,
    }
}

/// The chart in which most of a triangle's weight lies.
fn strongest(weights: [&Weights; 3]) -> Chart {
    let mut sums: BTreeMap<Chart, f64> = BTreeMap::new();
    for (bone, weight) in weights.into_iter().flat_map(|w| w.iter().enumerate()) {
        *sums.entry(chart_of(bone)).or_default() += weight;
    }
    let most = sums.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    most.map_or(Chart::Trunk, |(chart, _)| chart)
}

/// Turns round a limb, 0 at `front`, and metres along it from where it begins.
fn round(limb: &Limb, front: DVec3, p: DVec3) -> (f64, f64) {
    let off = p - limb.from;
    let side = limb.along.cross(front);
    (libm::atan2(off.dot(side), off.dot(front)) / TAU, off.dot(limb.along))
}

fn place(chart: Chart, p: DVec3) -> DVec2 {
    let (q, right) = match chart {
        Chart::RightArm | Chart::RightLeg => (mirrored(p), true),
        _ => (p, false),
    };
    let (turn, down) = match chart {
        Chart::Trunk => (2.0 * libm::atan2(p.x, p.z + 0.01) / TAU, 2.0 - p.y),
        Chart::Head => (libm::atan2(p.x, p.z + 0.01) / TAU, 2.0 - p.y),
        Chart::LeftArm | Chart::RightArm => {
            let (upper, lower) = (upper_arm(), lower_arm());
            let middle = (upper.along + lower.along).normalize();
            if (q - LOWER_ARM_AT).dot(middle) < 0.0 {
                round(&upper, upper.out, q)
            } else {
                let (turn, along) = round(&lower, lower.out, q);
                (turn, along + upper.length)
            }
        }
        Chart::LeftLeg | Chart::RightLeg => {
            // One axis from hip to knee and on down: the shin is nearly in line with the thigh.
            let upper = upper_leg();
            let axis =
                upper.from.lerp(LOWER_LEG_AT, ((upper.from.y - q.y) / 0.455).clamp(0.0, 1.0));
            let off = q - axis;
            (libm::atan2(off.x, off.z) / TAU, upper.from.y - q.y)
        }
    };
    DVec2::new(if right { -turn } else { turn } + 0.5, 2.0 * down)
}

/// Gives texture coordinates to every vertex.
pub(super) fn unwrap(held: &mut Held) {
    let Held { part, weights } = held;
    let unwrap = Unwrap {
        chart: &|corners| strongest(corners.map(|i| &weights[i as usize])) as usize,
        place: &|chart, p| place(CHARTS[chart], p),
        turn: &|chart| if CHARTS[chart] == Chart::Trunk { 2.0 } else { 1.0 },
    };
    let (unwrapped, old) = unwrap.unwrap(part);
    *weights = old.iter().map(|&i| weights[i as usize].clone()).collect();
    *part = unwrapped;
}
