//! Texture coordinates that follow the limbs: u goes once round each limb, and twice round the
//! trunk, with the seam behind or on the inside; v runs down it, 2 a metre.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Held;
use super::limb::Limb;
use super::limbs::{lower_arm, upper_arm, upper_leg};
use super::skeleton::{
    CAPE, FINGER_TIPS, HEAD, LOWER_ARM_AT, LOWER_LEG_AT, NECK, RIGHT, SHOULDER, THUMB, UPPER_ARM,
    UPPER_LEG, mirrored,
};
use super::weights::Weights;

/// What a chart goes round.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Chart {
    Trunk,
    Head,
    Arm { right: bool },
    Leg { right: bool },
}

fn chart_of(bone: usize) -> Chart {
    let right = (SHOULDER + RIGHT..CAPE).contains(&bone);
    match if right { bone - RIGHT } else { bone } {
        NECK | HEAD => Chart::Head,
        UPPER_ARM..=FINGER_TIPS | THUMB => Chart::Arm { right },
        left if (UPPER_LEG..SHOULDER + RIGHT).contains(&left) => Chart::Leg { right },
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
        Chart::Arm { right: true } | Chart::Leg { right: true } => (mirrored(p), true),
        _ => (p, false),
    };
    let (turn, down) = match chart {
        Chart::Trunk => (2.0 * libm::atan2(p.x, p.z + 0.01) / TAU, 2.0 - p.y),
        Chart::Head => (libm::atan2(p.x, p.z + 0.01) / TAU, 2.0 - p.y),
        Chart::Arm { .. } => {
            let (upper, lower) = (upper_arm(), lower_arm());
            let middle = (upper.along + lower.along).normalize();
            if (q - LOWER_ARM_AT).dot(middle) < 0.0 {
                round(&upper, upper.out, q)
            } else {
                let (turn, along) = round(&lower, lower.out, q);
                (turn, along + upper.length)
            }
        }
        Chart::Leg { .. } => {
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

/// Gives texture coordinates to every vertex; vertices on a seam become two.
pub(super) fn unwrap(held: &mut Held) {
    let Held { part, weights } = held;
    // Vertices by what they were, their chart and whether they lie past the seam.
    let mut vertices: BTreeMap<(u32, Chart, bool), u32> = BTreeMap::new();
    let (old, old_weights) = (std::mem::take(part), std::mem::take(weights));
    for t in old.indices.chunks_exact(3) {
        let chart = strongest([t[0], t[1], t[2]].map(|i| &old_weights[i as usize]));
        let uv = [t[0], t[1], t[2]].map(|i| place(chart, old.positions[i as usize]));
        let turns = if chart == Chart::Trunk { 2.0 } else { 1.0 };
        let most = uv[0].x.max(uv[1].x).max(uv[2].x);
        for (&i, uv) in t.iter().zip(uv) {
            let past = most - uv.x > turns / 2.0;
            let index = *vertices.entry((i, chart, past)).or_insert_with(|| {
                part.uvs.push(if past { uv + DVec2::X * turns } else { uv });
                weights.push(old_weights[i as usize].clone());
                part.push(old.positions[i as usize], old.normals[i as usize])
            });
            part.indices.push(index);
        }
    }
}
