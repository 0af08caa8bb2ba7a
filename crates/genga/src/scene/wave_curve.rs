//! The curve of a wave in f64, in a frame whose x axis is the curve's main direction.

use glam::{DMat3, DQuat, DVec3, Vec3};

use super::{Pose, Wave, WaveAnchor, WaveNoise, WavePlacement, WaveShape};

/// Where a wave's frame is in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WaveFrame {
    pub(crate) origin: DVec3,
    /// Columns: the frame's axes in the world.
    pub(crate) axes: DMat3,
    /// Factor on the curve's x.
    pub(crate) stretch: f64,
}

/// A wave's curve.
#[derive(Clone, Debug)]
pub(crate) struct WaveCurve<'a> {
    pub(crate) wave: &'a Wave,
    /// The shape's points in the curve's frame; only for shapes with points.
    pub(crate) points: Vec<DVec3>,
    /// Knots of a B-spline.
    pub(crate) knots: Vec<f64>,
    /// From the curve's frame to the shape's.
    shape_from_curve: DQuat,
    /// Factor on x, see [`WaveFrame`].
    pub(crate) stretch: f64,
}

impl<'a> WaveCurve<'a> {
    /// The curve without any stretching.
    pub(crate) fn new(wave: &'a Wave) -> Self {
        let mut curve = Self {
            wave,
            points: Vec::new(),
            knots: Vec::new(),
            shape_from_curve: DQuat::IDENTITY,
            stretch: 1.0,
        };
        let points = match &wave.shape {
            WaveShape::Bezier { points }
            | WaveShape::BSpline { points, .. }
            | WaveShape::Polyline { points } => points,
            _ => return curve,
        };
        let mut points: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        if matches!(wave.shape, WaveShape::Polyline { .. }) {
            points.dedup();
        }
        let (first, last) = (points[0], points[points.len() - 1]);
        let direction = (last - first).normalize_or(DVec3::X);
        curve.shape_from_curve = DQuat::from_rotation_arc(DVec3::X, direction);
        let curve_from_shape = curve.shape_from_curve.inverse();
        let is_between = matches!(wave.placement, WavePlacement::Between { .. });
        let start = if is_between { first } else { DVec3::ZERO };
        curve.points = points.iter().map(|&p| curve_from_shape * (p - start)).collect();
        if let WaveShape::BSpline { points, order, knots } = &wave.shape {
            curve.knots = if knots.is_empty() {
                clamped_knots(points.len(), *order)
            } else {
                knots.iter().map(|&k| f64::from(k)).collect()
            };
        }
        curve
    }

    /// Places the curve at a pose; stretches it if its placement asks for that.
    pub(crate) fn place(&mut self, pose: &Pose) -> WaveFrame {
        match &self.wave.placement {
            WavePlacement::At { anchor, direction, follow, roll } => {
                let mut x = direction.as_dvec3().normalize_or(DVec3::X);
                let node = anchor.nodes.first().and_then(|&node| pose.world_from_node.get(node));
                if let (true, Some(node)) = (*follow, node) {
                    x = node.transform_vector3(x.as_vec3()).as_dvec3().normalize_or(x);
                }
                let axes = axes(x, f64::from(*roll)) * DMat3::from_quat(self.shape_from_curve);
                WaveFrame { origin: place_of(anchor, pose), axes, stretch: 1.0 }
            }
            WavePlacement::Between { from, to, roll } => {
                let (from, to) = (place_of(from, pose), place_of(to, pose));
                let (length, own) = ((to - from).length(), self.length());
                if own > 0.0 {
                    self.stretch = (length / own).max(1e-9);
                }
                let x = (to - from).normalize_or(DVec3::X);
                WaveFrame { origin: from, axes: axes(x, f64::from(*roll)), stretch: self.stretch }
            }
        }
    }

    /// From the first end to the last one along x, before stretching.
    fn length(&self) -> f64 {
        match &self.wave.shape {
            WaveShape::Sphere => 0.0,
            WaveShape::Cylinder { length } => length.map_or(0.0, f64::from),
            WaveShape::Capsule { length }
            | WaveShape::Helix { length, .. }
            | WaveShape::Trig { length, .. } => f64::from(*length),
            WaveShape::Bezier { .. } | WaveShape::BSpline { .. } | WaveShape::Polyline { .. } => {
                self.points.last().zip(self.points.first()).map_or(0.0, |(l, f)| l.x - f.x)
            }
        }
    }

    /// The place of s in [0, 1] in the curve's frame, with noise.
    pub(crate) fn at(&self, s: f64) -> DVec3 {
        let mut p = self.smooth_at(s);
        p.x *= self.stretch;
        let [y, z] = noise_at(&self.wave.noise, s);
        p + DVec3::new(0.0, y, z)
    }

    fn smooth_at(&self, s: f64) -> DVec3 {
        let turn = std::f64::consts::TAU * s;
        match &self.wave.shape {
            WaveShape::Sphere => DVec3::ZERO,
            WaveShape::Cylinder { length } => {
                DVec3::new(length.map_or(0.0, f64::from) * s, 0.0, 0.0)
            }
            WaveShape::Capsule { length } => DVec3::new(f64::from(*length) * s, 0.0, 0.0),
            WaveShape::Helix { length, radius, turns, phase } => {
                let (sin, cos) = (f64::from(*phase) + turn * f64::from(*turns)).sin_cos();
                let r = f64::from(*radius);
                DVec3::new(f64::from(*length) * s, r * sin, r * cos)
            }
            WaveShape::Trig { length, turns, y, z } => {
                let angle = turn * f64::from(*turns);
                let sum = |terms: &[[f32; 2]]| {
                    let terms = terms.iter().enumerate();
                    let term = |(n, t): (usize, &[f32; 2])| {
                        let (sin, cos) = ((n + 1) as f64 * angle).sin_cos();
                        f64::from(t[0]) * sin + f64::from(t[1]) * cos
                    };
                    terms.map(term).sum::<f64>()
                };
                DVec3::new(f64::from(*length) * s, sum(y), sum(z))
            }
            WaveShape::Bezier { .. } => bezier(&self.points, s),
            WaveShape::BSpline { order, .. } => b_spline(&self.points, &self.knots, *order, s),
            WaveShape::Polyline { .. } => {
                let last = self.points.len() - 1;
                let at = s.clamp(0.0, 1.0) * last as f64;
                let i = (at as usize).min(last.saturating_sub(1));
                let next = self.points[(i + 1).min(last)];
                self.points[i].lerp(next, at - i as f64)
            }
        }
    }

    /// Values of s, rising from 0 to 1, between which a parabola over x is within `tolerance` metres
    /// of the curve.
    pub(crate) fn values_of_s(&self, tolerance: f64) -> Vec<f64> {
        let mut starts = vec![0.0, 1.0];
        starts.extend(self.wave.profile.iter().map(|p| f64::from(p[0])));
        let (mut pieces, noise) = (1_usize, &self.wave.noise);
        match &self.wave.shape {
            WaveShape::Helix { turns, .. } => pieces = (4.0 * turns.abs()).ceil() as usize,
            WaveShape::Trig { turns, y, z, .. } => {
                let terms = y.len().max(z.len()) as f32;
                pieces = (4.0 * turns.abs() * terms).ceil() as usize;
            }
            WaveShape::Bezier { points } => pieces = points.len(),
            WaveShape::BSpline { order, .. } => {
                let (low, high) = domain(&self.knots, *order);
                starts.extend(self.knots.iter().map(|k| (k - low) / (high - low)));
            }
            WaveShape::Polyline { .. } => pieces = self.points.len() - 1,
            WaveShape::Sphere | WaveShape::Cylinder { .. } | WaveShape::Capsule { .. } => {}
        }
        let mut split = |pieces: usize| {
            starts.extend((1..pieces).map(|i| i as f64 / pieces as f64));
        };
        split(pieces.min(MAX_PIECES));
        if noise.amplitude > 0.0 {
            let highest = noise.frequency * (1 << (noise.octaves.clamp(1, 8) - 1)) as f32;
            split(((2.0 * highest).ceil() as usize).min(MAX_PIECES));
        }
        starts.retain(|s| (0.0..=1.0).contains(s));
        starts.sort_by(f64::total_cmp);
        starts.dedup_by(|a, b| (*a - *b).abs() < 1e-7);
        let mut values = vec![0.0];
        for pair in starts.windows(2) {
            self.refine([pair[0], pair[1]], tolerance, 0, &mut values);
        }
        values
    }

    /// Splits a piece until a parabola over x is within `tolerance` of it.
    fn refine(&self, [s0, s1]: [f64; 2], tolerance: f64, depth: u32, values: &mut Vec<f64>) {
        let at = |part: f64| self.at(s0 + (s1 - s0) * part);
        let [a, m, b] = [at(0.0), at(0.5), at(1.0)];
        let is_straight = self.wave.noise.amplitude == 0.0
            && matches!(
                self.wave.shape,
                WaveShape::Polyline { .. } | WaveShape::Capsule { .. } | WaveShape::Cylinder { .. }
            );
        let fits = is_straight
            || [0.25, 0.75].into_iter().all(|part| {
                let p = at(part);
                let ratio = |x: f64, y: f64| if y.abs() > 1e-300 { x / y } else { 0.0 };
                // Lagrange's parabola through the three, at p's x.
                let la = ratio((p.x - m.x) * (p.x - b.x), (a.x - m.x) * (a.x - b.x));
                let lm = ratio((p.x - a.x) * (p.x - b.x), (m.x - a.x) * (m.x - b.x));
                let lb = ratio((p.x - a.x) * (p.x - m.x), (b.x - a.x) * (b.x - m.x));
                let d = p - (a * la + m * lm + b * lb);
                d.y.hypot(d.z) <= tolerance
            });
        if fits || depth >= 12 || values.len() >= MAX_PIECES {
            values.push(s1);
            return;
        }
        let middle = 0.5 * (s0 + s1);
        self.refine([s0, middle], tolerance, depth + 1, values);
        self.refine([middle, s1], tolerance, depth + 1, values);
    }
}

impl Wave {
    /// Places of the curve in the world: `count` of them, at even steps of s from tail to head.
    ///
    /// The wave must be valid (see [`super::Scene::validate`]).
    #[must_use]
    pub fn places(&self, pose: &Pose, count: usize) -> Vec<Vec3> {
        let mut curve = WaveCurve::new(self);
        let frame = curve.place(pose);
        let [tail, head] = self.growth.map(f64::from);
        let step = (head - tail) / count.saturating_sub(1).max(1) as f64;
        (0..count)
            .map(|i| (frame.origin + frame.axes * curve.at(tail + step * i as f64)).as_vec3())
            .collect()
    }
}

/// Most pieces that a curve is cut into.
pub(crate) const MAX_PIECES: usize = 16_384;

fn place_of(anchor: &WaveAnchor, pose: &Pose) -> DVec3 {
    let places = anchor.nodes.iter().filter_map(|&node| pose.world_from_node.get(node));
    let (sum, count) = places.fold((DVec3::ZERO, 0.0), |(sum, count), node| {
        (sum + Vec3::from(node.translation).as_dvec3(), count + 1.0)
    });
    sum / f64::max(count, 1.0) + anchor.offset.as_dvec3()
}

/// Axes with that x axis, whose y axis is as far up as it can be before the roll.
fn axes(x: DVec3, roll: f64) -> DMat3 {
    let up = if x.y.abs() < 0.999_999 { DVec3::Y } else { DVec3::NEG_X };
    let y = (up - x * x.dot(up)).normalize_or(DVec3::Y);
    let z = x.cross(y);
    DMat3::from_cols(x, y, z) * DMat3::from_rotation_x(roll)
}

/// Knots that make a B-spline begin and end in its first and last point, even in between.
fn clamped_knots(points: usize, order: usize) -> Vec<f64> {
    let spans = points + 1 - order;
    let knot = |i: usize| (i as f64 - (order as f64 - 1.0)).clamp(0.0, spans as f64);
    (0..points + order).map(knot).collect()
}

/// The knots between which a B-spline is defined.
pub(crate) fn domain(knots: &[f64], order: usize) -> (f64, f64) {
    (knots[order - 1], knots[knots.len() - order])
}

/// De Casteljau.
fn bezier(points: &[DVec3], s: f64) -> DVec3 {
    let mut p = points.to_vec();
    for n in (1..p.len()).rev() {
        for i in 0..n {
            p[i] = p[i].lerp(p[i + 1], s);
        }
    }
    p[0]
}

/// De Boor.
fn b_spline(points: &[DVec3], knots: &[f64], order: usize, s: f64) -> DVec3 {
    let (low, high) = domain(knots, order);
    let x = low + (high - low) * s.clamp(0.0, 1.0);
    let degree = order - 1;
    // The last span that begins at or before x and is not empty.
    let mut span = degree;
    while span + 1 < points.len() && knots[span + 1] <= x {
        span += 1;
    }
    while span > degree && knots[span + 1] <= knots[span] {
        span -= 1;
    }
    let mut d: Vec<DVec3> = points[span - degree..=span].to_vec();
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let i = j + span - degree;
            let width = knots[i + order - r] - knots[i];
            let part = if width > 0.0 { (x - knots[i]) / width } else { 0.0 };
            d[j] = d[j - 1].lerp(d[j], part);
        }
    }
    d[degree]
}

/// Displacement along y and z at s: value noise on the integers of `frequency · s + phase`, with
/// quintic interpolation, fading out at the ends. `shaders/shading/energy_curve.wesl` has the same.
pub(crate) fn noise_at(noise: &WaveNoise, s: f64) -> [f64; 2] {
    if noise.amplitude <= 0.0 {
        return [0.0; 2];
    }
    let (mut sum, mut scale) = ([0.0; 2], 1.0);
    for octave in 0..noise.octaves.clamp(1, 8) {
        let at = (f64::from(noise.frequency) * s + f64::from(noise.phase)) / scale;
        let cell = at.floor();
        let t = at - cell;
        let part = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let key = noise.seed.wrapping_mul(0x9e37_79b9).wrapping_add(octave * 2);
        for (axis, sum) in sum.iter_mut().enumerate() {
            let value = |i: i32| lattice((i as u32).wrapping_add(hash(key + axis as u32)));
            let (a, b) = (value(cell as i32), value((cell as i32).wrapping_add(1)));
            *sum += scale * (a + (b - a) * part);
        }
        scale *= 0.5;
    }
    let away = 2.0 * s.clamp(0.0, 1.0) - 1.0;
    let fade = 1.0 - away.powi(4);
    sum.map(|sum| f64::from(noise.amplitude) * fade * sum)
}

/// A value in [−1, 1] for an integer.
fn lattice(n: u32) -> f64 {
    f64::from(hash(n) >> 8) * (2.0 / 16_777_215.0) - 1.0
}

/// PCG's output function (Jarzynski and Olano 2020).
fn hash(n: u32) -> u32 {
    let state = n.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
