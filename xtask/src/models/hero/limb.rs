//! A frame along a bone, in which muscles are placed.

use glam::{DMat3, DVec3};

/// A straight limb: `out` points sideways off it and `front` forwards, both at right angles to
/// `along`.
#[derive(Clone, Copy)]
pub(super) struct Limb {
    pub(super) from: DVec3,
    pub(super) length: f64,
    pub(super) out: DVec3,
    pub(super) along: DVec3,
    pub(super) front: DVec3,
}

impl Limb {
    /// From one joint to the next, its front as near to `front` as can be.
    pub(super) fn new(from: DVec3, to: DVec3, front: DVec3) -> Self {
        let length = from.distance(to);
        let along = (to - from) / length;
        let front = (front - along * front.dot(along)).normalize();
        Self { from, length, out: front.cross(along), along, front }
    }

    /// A point at a part `t` of the length and off the axis in metres.
    pub(super) fn at(&self, t: f64, out: f64, front: f64) -> DVec3 {
        self.from + self.along * (self.length * t) + self.out * out + self.front * front
    }

    /// Axes out, along and front.
    pub(super) fn axes(&self) -> DMat3 {
        DMat3::from_cols(self.out, self.along, self.front)
    }
}
