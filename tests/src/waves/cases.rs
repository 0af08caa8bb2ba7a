//! Waves and views that tests and proofs share, and how far the renderer is from the reference.

use genga::render::{LayerData, LayerKind, View, ViewCamera};
use genga::scene::{Projection, Scene, Wave, WaveShape};
use glam::{Affine3A, Vec3};

use super::{Ray, Reference, footprint, ray_of};
use crate::gpu::draw_layers;
use crate::scenes::style;

/// One wave of each shape, about 4 m long along x.
#[must_use]
pub fn shapes() -> Vec<(&'static str, WaveShape)> {
    let wavy = |i: usize| {
        let t = i as f32;
        Vec3::new(0.4 * t, 0.8 * (1.3 * t).sin(), 0.6 * (0.9 * t).cos())
    };
    let many: Vec<Vec3> = (0..12).map(wavy).collect();
    vec![
        ("sphere", WaveShape::Sphere),
        ("capsule", WaveShape::Capsule { length: 4.0 }),
        ("cylinder", WaveShape::Cylinder { length: Some(4.0) }),
        ("endless", WaveShape::Cylinder { length: None }),
        ("helix", WaveShape::Helix { length: 4.0, radius: 0.5, turns: 5.0, phase: 0.3 }),
        (
            "trig",
            WaveShape::Trig {
                length: 4.0,
                turns: 2.0,
                y: vec![[0.3, 0.1], [0.1, 0.05]],
                z: vec![[0.1, 0.3], [0.0, 0.1], [0.05, 0.0]],
            },
        ),
        ("bezier", WaveShape::Bezier { points: bezier_points().to_vec() }),
        ("b-spline", WaveShape::BSpline { points: many.clone(), order: 4, knots: Vec::new() }),
        ("polyline", WaveShape::Polyline { points: many }),
    ]
}

/// The same curve, larger or smaller.
#[must_use]
pub fn scaled(shape: &WaveShape, factor: f32) -> WaveShape {
    let mut shape = shape.clone();
    match &mut shape {
        WaveShape::Sphere | WaveShape::Cylinder { length: None } => {}
        WaveShape::Cylinder { length: Some(length) } | WaveShape::Capsule { length } => {
            *length *= factor;
        }
        WaveShape::Helix { length, radius, .. } => {
            *length *= factor;
            *radius *= factor;
        }
        WaveShape::Trig { length, y, z, .. } => {
            *length *= factor;
            y.iter_mut().chain(z).flatten().for_each(|t| *t *= factor);
        }
        WaveShape::Bezier { points }
        | WaveShape::BSpline { points, .. }
        | WaveShape::Polyline { points } => points.iter_mut().for_each(|p| *p *= factor),
    }
    shape
}

/// Of a Bézier curve of degree 4.
#[must_use]
pub fn bezier_points() -> [Vec3; 5] {
    [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(1.0, 1.5, 0.2),
        Vec3::new(2.0, -1.5, 0.8),
        Vec3::new(3.0, 1.0, -1.0),
        Vec3::new(4.0, 0.0, 0.0),
    ]
}

/// Views of such a wave: from outside, along its axis, from inside.
#[must_use]
pub fn views(size: [u32; 2]) -> [(&'static str, View); 3] {
    let view = |eye: Vec3, at: Vec3| View { supersample: 1, ..View::new(look(eye, at), size) };
    [
        ("outside", view(Vec3::new(2.5, 1.0, 6.0), Vec3::new(2.0, 0.0, 0.0))),
        ("along", view(Vec3::new(-3.0, 0.0, 0.0), Vec3::new(2.0, 0.0, 0.0))),
        ("inside", view(Vec3::new(1.3, 0.1, 0.05), Vec3::new(3.0, 0.3, 0.4))),
    ]
}

/// A camera at `eye` that looks at a place.
#[must_use]
pub fn look(eye: Vec3, at: Vec3) -> ViewCamera {
    ViewCamera {
        world_from_camera: Affine3A::look_at_rh(eye, at, Vec3::Y).inverse(),
        projection: Projection::Perspective { fov_y: 0.8 },
        near: 0.1,
    }
}

/// A scene of these waves alone.
#[must_use]
pub fn scene_of(waves: &[Wave]) -> Scene {
    Scene { waves: waves.to_vec(), ..Scene::default() }
}

/// The energy of each pixel.
///
/// # Panics
/// If the renderer reports an error.
#[must_use]
pub fn energies(scene: &Scene, view: &View) -> Vec<f32> {
    let picture = draw_layers(scene, &style(""), view, &[LayerKind::Energy]);
    match &picture.layers[0].data {
        LayerData::F32 { values, channels: 1 } => values.clone(),
        other => panic!("the energy is no layer of one float: {other:?}"),
    }
}

/// How far energies are from the reference. Relative errors are relative to the energy itself or to
/// 1/255 of the brightest one, whichever is more.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// The largest relative error.
    pub largest: f64,
    /// What 99 of 100 are at most.
    pub p99: f64,
    /// Their mean.
    pub mean: f64,
    /// The largest error as a part of the brightest energy.
    pub of_peak: f64,
    /// Rays that were compared.
    pub rays: usize,
}

/// Compares `count` rays of a view, a quarter of them within 2 pixels of the curve where that is in
/// view. `end` is where a ray ends.
#[must_use]
pub fn errors(
    wave: &Wave,
    view: &View,
    energies: &[f32],
    count: usize,
    end: &dyn Fn(&Ray) -> f64,
) -> Errors {
    let reference = Reference::new(wave, view);
    let peak = f64::from(energies.iter().copied().fold(0.0, f32::max)).max(1e-12);
    let mut random = Random(7);
    let mut errors = Errors::default();
    let mut all = Vec::with_capacity(count);
    for i in 0..count {
        let mut pixel = view.size.map(|n| random.below(n));
        if i % 4 == 0 {
            let [tail, head] = wave.growth.map(f64::from);
            let s = tail + (head - tail) * i as f64 / count as f64;
            let off = [random.below(5), random.below(5)];
            if let Some(aimed) = near(view, reference.place(s).as_vec3(), off) {
                pixel = aimed;
            }
        }
        let ray = ray_of(view, pixel);
        let wanted = reference.energy(&ray, end(&ray));
        let got = f64::from(energies[(pixel[1] * view.size[0] + pixel[0]) as usize]);
        assert!(got.is_finite(), "{:?} at {pixel:?}: {got}", wave.shape);
        let off = (got - wanted).abs();
        let relative = off / wanted.max(peak / 255.0);
        errors.largest = errors.largest.max(relative);
        errors.of_peak = errors.of_peak.max(off / peak);
        errors.mean += relative;
        all.push(relative);
        errors.rays += 1;
    }
    errors.mean /= errors.rays.max(1) as f64;
    all.sort_by(f64::total_cmp);
    errors.p99 = all.get(all.len() * 99 / 100).copied().unwrap_or_default();
    errors
}

/// The pixel `off` − 2 pixels from a place, if it is in the picture.
fn near(view: &View, place: Vec3, off: [u32; 2]) -> Option<[u32; 2]> {
    let p = view.camera.world_from_camera.inverse().transform_point3(place);
    let depth = match view.camera.projection {
        Projection::Perspective { .. } if p.z > -1e-3 => return None,
        Projection::Perspective { .. } => -p.z,
        Projection::Orthographic { .. } => 1.0,
    };
    let pixel = footprint(view) as f32 * depth;
    let at = [p.x / pixel, -p.y / pixel];
    let mut found = [0; 2];
    for axis in 0..2 {
        let x = at[axis] + 0.5 * view.size[axis] as f32 + off[axis] as f32 - 2.0;
        if !(x >= 0.0 && x < view.size[axis] as f32) {
            return None;
        }
        found[axis] = x as u32;
    }
    Some(found)
}

/// PCG, for the same numbers in every run.
pub struct Random(pub u32);

impl Random {
    /// A whole number from 0 to `n` − 1.
    pub fn below(&mut self, n: u32) -> u32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((self.0 >> ((self.0 >> 28) + 4)) ^ self.0).wrapping_mul(277_803_737);
        ((word >> 22) ^ word) % n.max(1)
    }

    /// A number from −1 to 1.
    pub fn signed(&mut self) -> f32 {
        self.below(2_000_001) as f32 / 1e6 - 1.0
    }
}
