//! The cape: a sheet from shoulder to shoulder, in folds, hanging clear of the body.

use glam::{DMat3, DVec2, DVec3};

use super::body::Body;
use super::skeleton::{CAPE, CAPE_JOINTS};
use super::weights::{Weights, body_weights};
use crate::models::sculpt::{Part, gradient, lathe, sheet, smooth_step};

const ROWS: usize = 34;
const COLUMNS: usize = 36;
/// Distance that it keeps from the body at the least, in metres.
const CLEARANCE: f64 = 0.016;
/// Angle in radians from behind at which its upper corners lie.
const CORNER: f64 = 1.62;

/// The cape in the bind pose.
pub(super) fn cape(body: &Body) -> Part {
    let mut rows: Vec<Vec<DVec3>> = (0..=ROWS)
        .map(|r| {
            let v = r as f64 / ROWS as f64;
            // From the hero's left to the right, so that the outside faces backwards.
            (0..=COLUMNS).map(|c| place(body, 1.0 - 2.0 * c as f64 / COLUMNS as f64, v)).collect()
        })
        .collect();
    (0..3).for_each(|_| rows = evened(&rows));
    // Contours run through the folds: their triangles must turn by little.
    rows = turned(&refined(&turned(&refined(&rows))));
    let mut part = sheet(&rows, 0.006);
    part.uvs = vec![DVec2::ZERO; part.positions.len()];
    for (uv, p) in part.uvs.iter_mut().zip(&part.positions) {
        *uv = DVec2::new(p.x + 0.5, 1.6 - p.y);
    }
    part
}

/// A point more between any two of a row, on the cubic curve through its four neighbours.
fn refined(rows: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    let between = |row: &[DVec3], i: usize| {
        let before = if i == 0 { 2.0 * row[0] - row[1] } else { row[i - 1] };
        let after = row.get(i + 2).copied().unwrap_or(2.0 * row[i + 1] - row[i]);
        (9.0 * (row[i] + row[i + 1]) - before - after) / 16.0
    };
    let finer = |row: &Vec<DVec3>| {
        let mut points: Vec<DVec3> =
            (0..row.len() - 1).flat_map(|i| [row[i], between(row, i)]).collect();
        points.extend(row.last());
        points
    };
    rows.iter().map(finer).collect()
}

/// Columns as rows.
fn turned(rows: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    (0..rows[0].len()).map(|c| rows.iter().map(|row| row[c]).collect()).collect()
}

/// Each point half way to the mean of its neighbours, on the border to those along the border.
fn evened(rows: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    let place = |r: usize, c: usize| {
        let (top, side) = (r == 0 || r == ROWS, c == 0 || c == COLUMNS);
        let across = || (rows[r][c - 1] + rows[r][c + 1]) / 2.0;
        let along = || (rows[r - 1][c] + rows[r + 1][c]) / 2.0;
        let mean = match (top, side) {
            (true, true) => rows[r][c],
            (true, false) => across(),
            (false, true) => along(),
            (false, false) => (across() + along()) / 2.0,
        };
        rows[r][c].midpoint(mean)
    };
    (0..=ROWS).map(|r| (0..=COLUMNS).map(|c| place(r, c)).collect()).collect()
}

/// `u` runs from 1 on the left to −1 on the right, `v` from 0 at the top to 1.
fn place(body: &Body, u: f64, v: f64) -> DVec3 {
    // Round the neck, over the shoulders to the collar bones.
    let angle = u * CORNER;
    let top = DVec3::new(
        0.148 * libm::sin(angle),
        1.625 + 0.030 * u * u,
        -0.035 - 0.095 * libm::cos(angle),
    );
    let half = 0.150 + 0.31 * libm::pow(v, 0.9);
    let wave = libm::cos(u * 9.5) * 0.6 + libm::cos(u * 5.0 + 0.8) * 0.4;
    let hanging = DVec3::new(
        u * half,
        1.575 - 1.23 * v + 0.02 * u * u,
        -0.150 - 0.10 * v - (0.012 + 0.050 * v) * wave * smooth_step(0.0, 0.5, v),
    );
    let mut p = top.lerp(hanging, smooth_step(0.0, 0.20, v));
    let field = |p: DVec3| body.body(p);
    // It lies on the shoulders, and below keeps off the body.
    let lying = smooth_step(0.10, 0.0, v);
    // Over the edge of the shoulders the way out is backwards.
    let backwards = DVec3::new(0.0, 0.2, -1.0) * smooth_step(0.0, 0.08, v);
    for _ in 0..16 {
        let off = CLEARANCE + 0.014 * smooth_step(0.02, 0.12, v) - body.body(p);
        let out = gradient(&field, p);
        p += if off > 0.0 {
            (out + backwards * 1.5).normalize_or_zero() * (off + 0.0005)
        } else {
            out.normalize_or_zero() * (off * lying)
        };
    }
    p
}

/// The two clasps that hold the upper corners.
pub(super) fn clasps(body: &Body) -> Part {
    let dome: Vec<(f64, f64)> = (0..=6)
        .map(|i| {
            let angle = f64::from(i) / 6.0 * 1.5;
            (0.027 * libm::sin(angle), 0.016 * libm::cos(angle))
        })
        .collect();
    let rim = dome[6];
    let form = lathe(&[&dome, &[rim, (rim.0, -0.014)], &[(rim.0, -0.014), (0.0, -0.014)]], 28);
    let field = |p: DVec3| body.body(p);
    let mut all = Part::default();
    for u in [1.0, -1.0] {
        let corner = place(body, u * 0.93, 0.012);
        let normal = gradient(&field, corner).normalize_or_zero();
        let side = normal.cross(DVec3::Z).normalize_or_zero();
        let axes = DMat3::from_cols(side, normal.cross(side), normal);
        let mut part = form.clone();
        for (p, n) in part.positions.iter_mut().zip(&mut part.normals) {
            (*p, *n) = (corner + axes * *p, axes * *n);
        }
        all.append(&part);
    }
    all
}

/// Weights of a point on the cape: the body's own on the shoulders, the cape's joints below.
pub(super) fn cape_weights(body: &Body, p: DVec3, bones: usize) -> Weights {
    let mut weights = body_weights(body, p, bones);
    let mut left = 1.0;
    for i in (0..CAPE_JOINTS).rev() {
        let joint = 1.53 - 0.30 * i as f64;
        let share = smooth_step(joint + 0.03, joint - 0.22, p.y) * left;
        weights[CAPE + i] = share;
        left -= share;
    }
    let on_body: f64 = weights[..CAPE].iter().sum();
    for weight in &mut weights[..CAPE] {
        *weight *= left / on_body;
    }
    weights
}
