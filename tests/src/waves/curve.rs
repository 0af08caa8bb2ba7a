//! The curves as Abe 2024 prints them (3.25 to 3.34), in f64.

use genga::scene::{Wave, WaveNoise, WaveShape};
use glam::{DMat3, DQuat, DVec3};

/// A curve in a frame whose x axis is its main direction.
pub(super) struct Curve {
    shape: WaveShape,
    noise: WaveNoise,
    points: Vec<DVec3>,
    knots: Vec<f64>,
    pub(super) shape_from_curve: DMat3,
    /// x at even steps of s, to start the search for s from.
    table: Vec<f64>,
}

const STEPS: usize = 4096;

impl Curve {
    pub(super) fn new(wave: &Wave) -> Self {
        let mut curve = Self {
            shape: wave.shape.clone(),
            noise: wave.noise,
            points: Vec::new(),
            knots: Vec::new(),
            shape_from_curve: DMat3::IDENTITY,
            table: Vec::new(),
        };
        if let WaveShape::Bezier { points }
        | WaveShape::BSpline { points, .. }
        | WaveShape::Polyline { points } = &wave.shape
        {
            let direction = (points[points.len() - 1] - points[0]).as_dvec3().normalize();
            let turn = DQuat::from_rotation_arc(DVec3::X, direction);
            curve.shape_from_curve = DMat3::from_quat(turn);
            curve.points = points.iter().map(|p| turn.inverse() * p.as_dvec3()).collect();
        }
        if let WaveShape::BSpline { points, order, knots } = &wave.shape {
            let (n, k) = (points.len(), *order);
            curve.knots = if knots.is_empty() {
                // Open and even: k equal knots at both ends.
                let inner = n - k;
                let mut all = vec![0.0; k];
                all.extend((1..=inner).map(|i| i as f64));
                all.extend(vec![(inner + 1) as f64; k]);
                all
            } else {
                knots.iter().map(|&x| f64::from(x)).collect()
            };
        }
        curve.table = (0..=STEPS).map(|i| curve.at(i as f64 / STEPS as f64).x).collect();
        curve
    }

    /// With noise: values of a lattice, blended by Perlin's polynomial of degree 5, an octave half as
    /// high and twice as fast as the one before, none at the ends.
    pub(super) fn at(&self, s: f64) -> DVec3 {
        let noise = &self.noise;
        let mut p = self.smooth_at(s);
        if noise.amplitude == 0.0 {
            return p;
        }
        let fade = f64::from(noise.amplitude) * (1.0 - (2.0 * s.clamp(0.0, 1.0) - 1.0).powi(4));
        for octave in 0..noise.octaves.max(1) {
            let scale = 0.5_f64.powi(octave as i32);
            let at = (f64::from(noise.frequency) * s + f64::from(noise.phase)) / scale;
            let (i, t) = (at.floor() as i64 as u32, at - at.floor());
            let part = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            let value = |axis: u32| {
                let key =
                    hash(noise.seed.wrapping_mul(0x9e37_79b9).wrapping_add(2 * octave + axis));
                let at = |i: u32| {
                    f64::from(hash(i.wrapping_add(key)) >> 8) * 2.0 / f64::from((1 << 24) - 1) - 1.0
                };
                (1.0 - part) * at(i) + part * at(i.wrapping_add(1))
            };
            p.y += fade * scale * value(0);
            p.z += fade * scale * value(1);
        }
        p
    }

    fn smooth_at(&self, s: f64) -> DVec3 {
        let turn = std::f64::consts::TAU * s;
        match &self.shape {
            WaveShape::Sphere | WaveShape::Cylinder { length: None } => DVec3::ZERO,
            WaveShape::Cylinder { length: Some(l) } | WaveShape::Capsule { length: l } => {
                DVec3::X * f64::from(*l) * s
            }
            WaveShape::Helix { length, radius, turns, phase } => {
                let angle = turn * f64::from(*turns) + f64::from(*phase);
                let r = f64::from(*radius);
                DVec3::new(f64::from(*length) * s, r * angle.sin(), r * angle.cos())
            }
            WaveShape::Trig { length, turns, y, z } => {
                let sum = |terms: &[[f32; 2]]| {
                    let mut sum = 0.0;
                    for (n, [a, b]) in terms.iter().enumerate() {
                        let angle = (n + 1) as f64 * turn * f64::from(*turns);
                        sum += f64::from(*a) * angle.sin() + f64::from(*b) * angle.cos();
                    }
                    sum
                };
                DVec3::new(f64::from(*length) * s, sum(y), sum(z))
            }
            WaveShape::Bezier { .. } => {
                let n = self.points.len() - 1;
                let mut binomial = 1.0;
                let mut sum = DVec3::ZERO;
                for (i, p) in self.points.iter().enumerate() {
                    if i > 0 {
                        binomial *= (n - i + 1) as f64 / i as f64;
                    }
                    sum += *p * binomial * s.powi(i as i32) * (1.0 - s).powi((n - i) as i32);
                }
                sum
            }
            WaveShape::BSpline { order, .. } => {
                let (low, high) = (self.knots[order - 1], self.knots[self.points.len()]);
                let x = (low + (high - low) * s).clamp(low, high);
                let basis = |i| self.basis(i, *order, x, high);
                self.points.iter().enumerate().map(|(i, p)| *p * basis(i)).sum()
            }
            WaveShape::Polyline { .. } => {
                let last = self.points.len() - 1;
                let i = ((s * last as f64) as usize).min(last - 1);
                self.points[i].lerp(self.points[i + 1], s * last as f64 - i as f64)
            }
        }
    }

    /// Nᵢᵏ by Cox and de Boor's recursion, 0/0 = 0, the last knot inclusive.
    fn basis(&self, i: usize, k: usize, x: f64, last: f64) -> f64 {
        let knot = |i: usize| self.knots[i];
        if k == 1 {
            let is_within = knot(i) <= x && x < knot(i + 1);
            let is_end = x == last && knot(i) < last && knot(i + 1) == last;
            return if is_within || is_end { 1.0 } else { 0.0 };
        }
        if x < knot(i) || x > knot(i + k) {
            return 0.0;
        }
        let part = |up: f64, down: f64| if down > 0.0 { up / down } else { 0.0 };
        part(x - knot(i), knot(i + k - 1) - knot(i)) * self.basis(i, k - 1, x, last)
            + part(knot(i + k) - x, knot(i + k) - knot(i + 1)) * self.basis(i + 1, k - 1, x, last)
    }

    /// Values of x where the curve has a corner.
    pub(super) fn marks(&self) -> Vec<f64> {
        match self.shape {
            WaveShape::Polyline { .. } if self.points.len() < 200 => {
                self.points.iter().map(|p| p.x).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The s whose place has that x.
    pub(super) fn s_of_x(&self, x: f64) -> f64 {
        if let WaveShape::Polyline { .. } = self.shape {
            let last = self.points.len() - 1;
            let i = self.points.partition_point(|p| p.x <= x).clamp(1, last) - 1;
            let (a, b) = (self.points[i].x, self.points[i + 1].x);
            return (i as f64 + ((x - a) / (b - a)).clamp(0.0, 1.0)) / last as f64;
        }
        let i = self.table.partition_point(|&at| at <= x).clamp(1, STEPS);
        let (x0, x1) = (self.table[i - 1], self.table[i]);
        let (mut low, mut high) = ((i - 1) as f64 / STEPS as f64, i as f64 / STEPS as f64);
        let mut s = low + (high - low) * ((x - x0) / (x1 - x0)).clamp(0.0, 1.0);
        if matches!(
            self.shape,
            WaveShape::Capsule { .. }
                | WaveShape::Cylinder { .. }
                | WaveShape::Helix { .. }
                | WaveShape::Trig { .. }
        ) {
            return s;
        }
        for _ in 0..40 {
            let off = self.at(s).x - x;
            if off.abs() < 1e-12 * (1.0 + x.abs()) {
                break;
            }
            if off > 0.0 {
                high = s;
            } else {
                low = s;
            }
            // The chord's slope is good; bisection only where it leads out.
            let next = s - off * (1.0 / STEPS as f64) / (x1 - x0);
            s = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        s
    }
}

/// PCG's output function.
fn hash(n: u32) -> u32 {
    let state = n.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
