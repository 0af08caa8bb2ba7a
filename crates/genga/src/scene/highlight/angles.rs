//! Yaw and pitch of directions: rotations about X, then about Y, from +Z.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

/// Yaw and pitch of a direction in radians: `atan2(x, z)` in (−π, π] and `asin(−y)` in
/// [−π/2, π/2]. Positive pitch looks down, as a positive rotation about X does.
#[must_use]
pub fn yaw_pitch(direction: Vec3) -> [f32; 2] {
    yaw_pitch_f64(unit(direction)).map(|angle| angle as f32)
}

/// The unit vector of a yaw and a pitch in radians.
#[must_use]
pub fn direction_of(yaw: f32, pitch: f32) -> Vec3 {
    direction(f64::from(yaw), f64::from(pitch)).as_vec3()
}

pub(super) fn yaw_pitch_f64(d: DVec3) -> [f64; 2] {
    [d.x.atan2(d.z), (-d.y).atan2(d.x.hypot(d.z))]
}

pub(super) fn direction(yaw: f64, pitch: f64) -> DVec3 {
    let (sin_yaw, cos_yaw) = yaw.sin_cos();
    let (sin_pitch, cos_pitch) = pitch.sin_cos();
    DVec3::new(sin_yaw * cos_pitch, -sin_pitch, cos_yaw * cos_pitch)
}

/// The angle in [−π, π) that is the same direction.
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - TAU * ((angle + PI) / TAU).floor()
}

/// The unit vector of a direction; +Z for one that is zero or not finite.
pub(super) fn unit(direction: Vec3) -> DVec3 {
    direction.as_dvec3().try_normalize().unwrap_or(DVec3::Z)
}
