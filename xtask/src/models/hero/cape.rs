//! The cape: a sheet from shoulder to shoulder, in folds, hanging clear of the body.

use glam::{DVec2, DVec3};

use super::body::Body;
use super::skeleton::{CAPE, CAPE_JOINTS, UPPER_CHEST};
use super::weights::Weights;
use crate::models::sculpt::{Part, gradient, sheet, smooth_step};

const ROWS: usize = 44;
const COLUMNS: usize = 48;
/// Distance that it keeps from the body at the least, in metres.
const CLEARANCE: f64 = 0.014;

/// The cape in the bind pose.
pub(super) fn cape(body: &Body) -> Part {
    let rows: Vec<Vec<DVec3>> = (0..=ROWS)
        .map(|r| {
            let v = r as f64 / ROWS as f64;
            // From the hero's left to the right, so that the outside faces backwards.
            (0..=COLUMNS).map(|c| place(body, 1.0 - 2.0 * c as f64 / COLUMNS as f64, v)).collect()
        })
        .collect();
    let mut part = sheet(&rows, 0.007);
    part.uvs = vec![DVec2::ZERO; part.positions.len()];
    for (uv, p) in part.uvs.iter_mut().zip(&part.positions) {
        *uv = DVec2::new(p.x + 0.5, 1.6 - p.y);
    }
    part
}

/// `u` runs from 1 on the left to −1 on the right, `v` from 0 at the top to 1.
fn place(body: &Body, u: f64, v: f64) -> DVec3 {
    // Round the neck, over the shoulders to the collar bones.
    let angle = u * 1.75;
    let top = DVec3::new(
        0.150 * libm::sin(angle),
        1.600 - 0.030 * u * u,
        -0.040 - 0.090 * libm::cos(angle),
    );
    let half = 0.20 + 0.26 * libm::pow(v, 0.8);
    let wave = libm::cos(u * 9.5) * 0.6 + libm::cos(u * 5.0 + 0.8) * 0.4;
    let hanging = DVec3::new(
        u * half,
        1.575 - 1.23 * v + 0.02 * u * u,
        -0.150 - 0.10 * v - (0.012 + 0.050 * v) * wave * smooth_step(0.0, 0.5, v),
    );
    let mut p = top.lerp(hanging, smooth_step(0.0, 0.20, v));
    let field = |p: DVec3| body.body(p);
    for _ in 0..6 {
        let d = body.body(p);
        if d >= CLEARANCE {
            break;
        }
        p += gradient(&field, p).normalize_or_zero() * (CLEARANCE - d + 0.0005);
    }
    p
}

/// Weights of a point on the cape.
pub(super) fn cape_weights(p: DVec3, bones: usize) -> Weights {
    let mut weights = vec![0.0; bones];
    let mut left = 1.0;
    for i in (0..CAPE_JOINTS).rev() {
        let joint = 1.53 - 0.30 * i as f64;
        let share = smooth_step(joint + 0.10, joint - 0.16, p.y) * left;
        weights[CAPE + i] = share;
        left -= share;
    }
    weights[UPPER_CHEST] = left;
    weights
}
