//! The round shield on the left forearm.

use glam::{DMat3, DVec3};

use super::limbs::lower_arm;
use super::skeleton::LOWER_ARM_AT;
use crate::models::sculpt::{Part, lathe, sheet};

/// The shield's radius in metres.
const RADIUS: f64 = 0.25;

/// Its metal, its coloured ring, its boss and its strap, relative to the elbow in the bind pose.
pub(super) fn shield() -> [Part; 4] {
    // A dish: part of a sphere.
    let dish = |r: f64| 0.046 - 0.66 * r * r;
    let run = |from: f64, to: f64, lift: f64, steps: usize| -> Vec<(f64, f64)> {
        (0..=steps)
            .map(|i| {
                let r = from + (to - from) * i as f64 / steps as f64;
                (r, dish(r) + lift)
            })
            .collect()
    };
    let rim = 0.220;
    // A round rim from the ring's edge to the back.
    let bead: Vec<(f64, f64)> = (0..=10)
        .map(|i| {
            let angle = std::f64::consts::PI * (1.0 - f64::from(i) / 10.0 * 1.25);
            let middle = (rim + RADIUS) / 2.0;
            let r = middle + (RADIUS - middle) * libm::cos(angle);
            (r, dish(middle) + 0.002 + 0.017 * libm::sin(angle))
        })
        .collect();
    let (end_r, end_z) = bead[10];
    let behind: Vec<(f64, f64)> = (0..=8)
        .map(|i| {
            let r = end_r * (1.0 - f64::from(i) / 8.0);
            (r, end_z + (dish(r) - dish(end_r)) * 0.8)
        })
        .collect();
    let middle = run(0.088, 0.148, 0.0, 5);
    let metal = lathe(&[&middle, &[(rim, dish(rim) + 0.004), bead[0]], &bead, &behind], 48);
    let ring = lathe(&[&[middle[5], (0.148, dish(0.148) + 0.004)], &run(0.148, rim, 0.004, 6)], 48);
    let boss: Vec<(f64, f64)> = (0..=8)
        .map(|i| {
            let angle = f64::from(i) / 8.0 * 1.5;
            let r = 0.082 * libm::sin(angle) / libm::sin(1.5);
            (r, dish(0.088) + 0.012 + 0.030 * libm::cos(angle))
        })
        .collect();
    let boss = lathe(&[&boss, &[*boss.last().unwrap_or(&(0.0, 0.0)), middle[0]]], 48);
    let limb = lower_arm();
    let axes = DMat3::from_cols(limb.along, limb.out.cross(limb.along), limb.out);
    let center = limb.at(0.62, 0.096, 0.0) - LOWER_ARM_AT;
    let [metal, ring, boss] = [metal, ring, boss].map(|mut part| {
        for p in &mut part.positions {
            *p = center + axes * *p;
        }
        for n in &mut part.normals {
            *n = axes * *n;
        }
        part
    });
    [metal, ring, boss, strap()]
}

/// A strap from the shield's back round the forearm, below the glove's cuff and clear of it.
fn strap() -> Part {
    const STEPS: usize = 16;
    const ALONG: f64 = 0.76;
    const WIDTH: f64 = 0.034;
    const RADIUS: f64 = 0.056;
    let limb = lower_arm();
    let side = limb.out.cross(limb.along);
    // Down one side, round below the arm, and up the other side.
    let mut path = vec![(-RADIUS, 0.132)];
    path.extend((0..=STEPS).map(|i| {
        let angle = std::f64::consts::PI * i as f64 / STEPS as f64;
        (-RADIUS * libm::cos(angle), -0.85 * RADIUS * libm::sin(angle))
    }));
    path.push((RADIUS, 0.132));
    let place = |&(across, out): &(f64, f64), along: f64| {
        limb.at(ALONG, out, 0.0) + side * across + limb.along * along - LOWER_ARM_AT
    };
    let row = |at: &(f64, f64)| vec![place(at, -WIDTH / 2.0), place(at, WIDTH / 2.0)];
    let rows: Vec<Vec<DVec3>> = path.iter().map(row).collect();
    sheet(&rows, 0.004)
}
