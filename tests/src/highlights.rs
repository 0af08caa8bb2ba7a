//! Highlights in f64, by their formulas, and scenes to see them on.

use std::f64::consts::{PI, TAU};

use genga::render::{Gpu, GpuOptions, LayerKind, Picture, Renderer, View, Workload};
use genga::scene::{
    AngleKey, FreeKey, FreePlacement, Highlight, KeyInterpolation, Moment, PanoramaPlacement, Pose,
    Primitive, Scene,
};
use genga::shapes;
use genga::style::Style;
use glam::{DMat3, DQuat, DVec2, DVec3, Vec2, Vec3};

use crate::scenes::{Builder, style};
use crate::{Pixels as _, shared};

/// Random numbers by a linear congruence: the same in every run.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    /// In [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A unit vector, evenly over the sphere.
    pub fn direction(&mut self) -> Vec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.between(0.0, TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z).as_vec3()
    }

    /// Light and view.
    pub fn moment(&mut self) -> Moment {
        Moment { light: self.direction(), view: self.direction() }
    }

    /// One of the three interpolations.
    pub fn interpolation(&mut self) -> KeyInterpolation {
        let all = [KeyInterpolation::Hold, KeyInterpolation::Linear, KeyInterpolation::Smooth];
        all[(self.unit() * 3.0) as usize % 3]
    }

    /// Up to `most` keys on light and view.
    pub fn free_keys(&mut self, most: usize) -> FreePlacement {
        let count = (self.unit() * (most + 1) as f64) as usize;
        let mut placement = FreePlacement::default();
        for _ in 0..count {
            let mut pair = |low, high| {
                Vec2::new(self.between(low, high) as f32, self.between(low, high) as f32)
            };
            let (offset, scale, split) = (pair(-1.0, 1.0), pair(0.5, 2.0), pair(0.0, 0.5));
            let moment = self.moment();
            let key = FreeKey {
                offset,
                rotation: self.between(-3.0, 3.0) as f32,
                scale,
                split,
                square: self.unit() as f32,
                interpolation: self.interpolation(),
                ..FreeKey::at(&moment)
            };
            placement.set_key(key);
        }
        placement
    }

    /// Up to `most` keys on each axis of a panorama.
    pub fn panorama_keys(&mut self, most: usize) -> PanoramaPlacement {
        let mut placement = PanoramaPlacement::default();
        for _ in 0..(self.unit() * (most + 1) as f64) as usize {
            let key = self.angle_key(PI, PI);
            placement.set_yaw_key(key);
        }
        for _ in 0..(self.unit() * (most + 1) as f64) as usize {
            let key = self.angle_key(PI, 0.5 * PI);
            placement.set_pitch_key(key);
        }
        placement
    }

    fn angle_key(&mut self, at: f64, place: f64) -> AngleKey {
        AngleKey {
            at: self.between(-at, at) as f32,
            place: self.between(-place, place) as f32,
            interpolation: self.interpolation(),
        }
    }
}

fn wide(v: Vec3) -> DVec3 {
    v.as_dvec3().normalize()
}

/// Rotations about X, then Y, that take +Z to a direction.
#[must_use]
pub fn angles(d: DVec3) -> [f64; 2] {
    [d.x.atan2(d.z), (-d.y / d.length()).clamp(-1.0, 1.0).asin()]
}

/// The direction that rotations about X by `pitch`, then about Y by `yaw` take +Z to.
#[must_use]
pub fn direction([yaw, pitch]: [f64; 2]) -> DVec3 {
    DMat3::from_rotation_y(yaw) * (DMat3::from_rotation_x(pitch) * DVec3::Z)
}

/// Yaw and pitch of the drawing's middle on a panorama.
#[must_use]
pub fn panorama_place(placement: &PanoramaPlacement, moment: &Moment) -> [f64; 2] {
    let [light, view] = [moment.light, moment.view].map(|d| angles(wide(d)));
    let mut relative_yaw = light[0] - view[0];
    relative_yaw -= TAU * (relative_yaw / TAU + 0.5).floor();
    let yaw = spline(placement.yaw_keys(), relative_yaw, true).unwrap_or(light[0]);
    let pitch = spline(placement.pitch_keys(), light[1] - view[1], false).unwrap_or(light[1]);
    let [low, high] = placement.limits.map(f64::from);
    [yaw, pitch.clamp(low, high)]
}

/// Keys at an angle. Periodic ones are written out five times over, so that there are always
/// neighbours.
fn spline(keys: &[AngleKey], at: f64, periodic: bool) -> Option<f64> {
    let (first, last) = (keys.first()?, keys.last()?);
    let rounds = if periodic && keys.len() > 1 { -2..=2 } else { 0..=0 };
    let turn = TAU * ((f64::from(last.place) - f64::from(first.place)) / TAU).round();
    let all: Vec<(f64, f64, KeyInterpolation)> = rounds
        .flat_map(|round| {
            let round = f64::from(round);
            keys.iter().map(move |key| {
                let at = f64::from(key.at) + round * TAU;
                (at, f64::from(key.place) + round * turn, key.interpolation)
            })
        })
        .collect();
    let tangent = |i: usize| -> f64 {
        if i == 0 || i + 1 == all.len() {
            return 0.0;
        }
        let (h0, h1) = (all[i].0 - all[i - 1].0, all[i + 1].0 - all[i].0);
        let (d0, d1) = ((all[i].1 - all[i - 1].1) / h0, (all[i + 1].1 - all[i].1) / h1);
        if d0 * d1 <= 0.0 {
            return 0.0;
        }
        // Fritsch and Butland's weighted harmonic mean.
        let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
        (w0 + w1) / (w0 / d0 + w1 / d1)
    };
    let next = all.iter().position(|key| key.0 > at).unwrap_or(all.len());
    if next == 0 {
        return Some(all[0].1);
    }
    if next == all.len() {
        return Some(all[next - 1].1);
    }
    let ((t0, p0, kind), (t1, p1, _)) = (all[next - 1], all[next]);
    let (h, u) = (t1 - t0, (at - t0) / (t1 - t0));
    Some(match kind {
        KeyInterpolation::Hold => p0,
        KeyInterpolation::Linear => p0 * (1.0 - u) + p1 * u,
        KeyInterpolation::Smooth => {
            let (m0, m1) = (h * tangent(next - 1), h * tangent(next));
            let (a, b) = (2.0 * (p0 - p1) + m0 + m1, 3.0 * (p1 - p0) - 2.0 * m0 - m1);
            ((a * u + b) * u + m0) * u + p0
        }
    })
}

/// A drawing in its place by keys on light and view.
#[derive(Clone, Copy, Debug)]
pub struct FreePlace {
    /// Right, up and middle.
    pub axes: DMat3,
    /// In radians.
    pub rotation: f64,
    /// Factors.
    pub scale: DVec2,
    /// Halves apart.
    pub split: DVec2,
    /// In [0, 1].
    pub square: f64,
}

/// By `1/(2 − l·lᵢ − v·vᵢ)`, normalised.
#[must_use]
pub fn free_place(placement: &FreePlacement, moment: &Moment) -> FreePlace {
    let (l, v) = (wide(moment.light), wide(moment.view));
    let gap = |key: &FreeKey| 2.0 - l.dot(wide(key.light)) - v.dot(wide(key.view));
    let nearest = placement.keys.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
    let mut sum = 0.0;
    let mut turn = DVec3::ZERO;
    let mut place = FreePlace {
        axes: DMat3::IDENTITY,
        rotation: 0.0,
        scale: DVec2::ZERO,
        split: DVec2::ZERO,
        square: 0.0,
    };
    for key in &placement.keys {
        let weight = match nearest {
            Some(nearest) if nearest.interpolation == KeyInterpolation::Hold => {
                f64::from(u8::from(std::ptr::eq(nearest, key)))
            }
            Some(nearest) => {
                let ratio = gap(nearest).max(1e-15) / gap(key).max(1e-15);
                if key.interpolation == KeyInterpolation::Linear { ratio.sqrt() } else { ratio }
            }
            None => 0.0,
        };
        let axes = upright(wide(key.light));
        let offset = key.offset.as_dvec2();
        // The rotation that takes the light's direction towards the offset, by its length.
        let axis = axes.z_axis.cross(axes.x_axis * offset.x + axes.y_axis * offset.y);
        turn += weight * axis;
        place.rotation += weight * f64::from(key.rotation);
        place.scale += weight * key.scale.as_dvec2();
        place.split += weight * key.split.as_dvec2();
        place.square += weight * f64::from(key.square);
        sum += weight;
    }
    if sum > 0.0 {
        turn /= sum;
        place.rotation /= sum;
        place.scale /= sum;
        place.split /= sum;
        place.square /= sum;
    } else {
        place.scale = DVec2::ONE;
    }
    let angle = turn.length();
    let middle = if angle > 0.0 {
        // Rodrigues.
        let axis = turn / angle;
        let (sin, cos) = angle.sin_cos();
        l * cos + axis.cross(l) * sin + axis * axis.dot(l) * (1.0 - cos)
    } else {
        l
    };
    FreePlace { axes: upright(middle), ..place }
}

/// +X and +Y turned with +Z the shortest way to a direction.
fn upright(d: DVec3) -> DMat3 {
    let axis = DVec3::Z.cross(d);
    let angle = axis.length().atan2(d.z);
    let turn = DQuat::from_axis_angle(axis.try_normalize().unwrap_or(DVec3::Y), angle);
    DMat3::from_cols(turn * DVec3::X, turn * DVec3::Y, d)
}

/// Coordinates on the drawing of a reflected direction, both in the frame.
#[must_use]
pub fn drawing_coordinates(highlight: &Highlight, moment: &Moment, reflected: DVec3) -> DVec2 {
    use genga::scene::Placement;
    let size = highlight.size.as_dvec2();
    let angle = f64::from(highlight.angle);
    match &highlight.placement {
        Placement::Panorama(panorama) => {
            let place = panorama_place(panorama, moment);
            let [yaw, pitch] = angles(reflected);
            let mut right = yaw - place[0];
            right -= TAU * (right / TAU).round();
            DVec2::from_angle(-angle).rotate(DVec2::new(right, place[1] - pitch)) / (0.5 * size)
        }
        Placement::Free(free) => {
            let place = free_place(free, moment);
            let m = place.axes.transpose() * reflected;
            let flat = DVec2::new(m.x, m.y) / (1.0 + m.z);
            let turned = DVec2::from_angle(-angle - place.rotation).rotate(flat);
            let u = turned / ((0.25 * size).map(f64::tan) * place.scale);
            let u = u - place.split * u.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
            // On rays from the middle a circle's points move out to the square round it.
            let angle = u.y.atan2(u.x);
            let inwards = angle.cos().abs().max(angle.sin().abs());
            u * (1.0 - place.square + place.square * inwards)
        }
    }
}

/// A ball of radius 1 round the origin that bulges and dents by `amplitude`, with its own normals.
#[must_use]
pub fn bumpy_ball(amplitude: f32) -> Primitive {
    let mut ball = shapes::uv_sphere(256, 128, 1.0);
    for position in &mut ball.positions {
        let p = *position;
        let bumps = (13.0 * p.x + 1.0).sin() * (11.0 * p.y).sin() * (12.0 * p.z + 2.0).cos();
        *position = p * (1.0 + amplitude * bumps);
    }
    smooth_normals(&mut ball);
    ball
}

/// Normals of the triangles round each place, weighted by area.
pub fn smooth_normals(primitive: &mut Primitive) {
    let key = |p: Vec3| (p * 1e5).round().to_array().map(|v| v as i64);
    let mut sums = std::collections::HashMap::<[i64; 3], Vec3>::new();
    for triangle in primitive.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|i| primitive.positions[i as usize]);
        let n = (b - a).cross(c - a);
        for p in [a, b, c] {
            *sums.entry(key(p)).or_default() += n;
        }
    }
    for (normal, p) in primitive.normals.iter_mut().zip(&primitive.positions) {
        *normal = sums.get(&key(*p)).copied().unwrap_or_default().normalize_or(Vec3::Z);
    }
}

/// A scene of one object of the material `skin`, lit from `from`.
#[must_use]
pub fn lit_scene(primitive: Primitive, from: Vec3, highlights: Vec<Highlight>) -> Scene {
    let mut scene = Builder::new();
    let skin = scene.colored("skin", [0.6, 0.3, 0.2]);
    scene.object("ball", primitive, Some(skin), genga::scene::Transform::default());
    scene.light(crate::scenes::light(genga::scene::LightKind::Directional, 1.0), from);
    let mut scene = scene.build();
    scene.highlights = highlights;
    scene
}

/// No lines, two tones.
#[must_use]
pub fn bare_style() -> Style {
    style("[lines]\nmethod = \"none\"")
}

/// How much two masks overlap: their intersection over their union.
#[must_use]
pub fn overlap(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|(a, b)| **a && **b).count();
    let any = a.iter().zip(b).filter(|(a, b)| **a || **b).count();
    both as f64 / any.max(1) as f64
}

/// Where a picture's highlight layer covers at least half of a pixel.
#[must_use]
pub fn covered(picture: &Picture) -> Vec<bool> {
    let bytes = picture.bytes(LayerKind::Highlight);
    bytes.as_chunks::<4>().0.iter().map(|texel| texel[3] >= 128).collect()
}

/// GPU times of the paint pass in milliseconds, without the highlights and with them, measured by
/// turns: the median without, and that times the median ratio of two frames in a row, since what
/// else a machine does changes slowly.
///
/// # Panics
/// If the renderer reports an error or the device has no clock.
#[must_use]
pub fn paint_times(scene: &Scene, style: &Style, view: &View, runs: usize) -> [f64; 2] {
    // A device of its own: the shared one has no clock.
    let options = GpuOptions { timestamps: true, ..GpuOptions::default() };
    let gpu = pollster::block_on(Gpu::headless(&options)).expect("an adapter");
    let renderer = Renderer::new(&gpu.device, &gpu.queue).expect("a renderer");
    let plain = Scene { highlights: Vec::new(), ..scene.clone() };
    let prepared = [&plain, scene].map(|s| renderer.prepare(s, style).expect("a scene"));
    let mut times = [Vec::new(), Vec::new()];
    for run in 0..runs + 3 {
        for k in 0..2 {
            let which = (run + k) % 2;
            let frame = renderer.time_frame(&prepared[which], view, Workload::Styled);
            let frame = pollster::block_on(frame).expect("a frame");
            let paint = frame.passes.iter().find(|pass| pass.name == "paint").expect("a clock");
            if run >= 3 {
                times[which].push(paint.milliseconds);
            }
        }
    }
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let ratio = median(times[0].iter().zip(&times[1]).map(|(a, b)| b / a).collect());
    let [plain, _] = times;
    let plain = median(plain);
    [plain, plain * ratio]
}

/// What [`put_everywhere`] finds.
#[derive(Clone, Copy, Debug)]
pub struct Puts {
    /// Pixels that a highlight was put at.
    pub tried: usize,
    /// Farthest from the wanted pixel that a drawing's middle landed.
    pub worst_px: f64,
}

/// Puts a scene's first highlight at `count` random pixels of its surface, draws each time, and
/// measures how far from that pixel the drawing's middle lies.
///
/// # Panics
/// If the renderer reports an error, or a pixel cannot be used although it shows the surface.
#[must_use]
pub fn put_everywhere(scene: &Scene, view: &View, count: usize, seed: u64) -> Puts {
    let shared = shared();
    let _turn = shared.turn();
    let renderer = &shared.renderer;
    let view = &View { supersample: 1, ..*view };
    let mut prepared = renderer.prepare(scene, &bare_style()).expect("a scene");
    let pose = Pose::rest(scene);
    let original = prepared.highlights()[0].clone();
    let mut random = Random(seed);
    let mut puts = Puts { tried: 0, worst_px: 0.0 };
    while puts.tried < count {
        let [width, height] = view.size;
        let x = random.between(4.0, f64::from(width) - 4.0) as u32;
        let y = random.between(4.0, f64::from(height) - 4.0) as u32;
        let pixel = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        // The surface must go on round the pixel, so that its neighbours tell the gradient.
        let round = [(0.0, 0.0), (2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)];
        let first = round.map(|(dx, dy)| {
            let [origin, direction] = view.ray(pixel + Vec2::new(dx, dy));
            let hit = scene.pick(&pose, origin, direction)?;
            let mesh = &scene.meshes[scene.nodes[hit.node].mesh?];
            let material = mesh.primitives[hit.primitive].material?;
            let is_its = original.materials.matches(&scene.materials[material].name);
            (is_its && hit.normal.dot(-direction) > 0.2).then_some(hit)
        });
        let [Some(middle), others @ ..] = first else { continue };
        let goes_on = |hit: &genga::scene::Hit| {
            (hit.node, hit.primitive) == (middle.node, middle.primitive)
                && hit.normal.dot(middle.normal) > 0.8
        };
        if !others.iter().all(|hit| hit.as_ref().is_some_and(goes_on)) {
            continue;
        }
        prepared.set_highlight(0, original.clone()).expect("it was valid");
        prepared.put_highlight(0, scene, &pose, view, pixel).expect("there is a surface");
        let layers = [LayerKind::HighlightUv];
        let mut quiet = |_, _| {};
        let picture = renderer.picture(&prepared, view, &layers, &mut quiet);
        let picture = pollster::block_on(picture).expect("a picture");
        let uv = picture.floats(LayerKind::HighlightUv);
        let at = |x: u32, y: u32| {
            let i = 3 * (y * width + x) as usize;
            DVec2::new(f64::from(uv[i]), f64::from(uv[i + 1]))
        };
        // Where the coordinates would be 0, by their gradient here.
        let (dx, dy) = (0.5 * (at(x + 1, y) - at(x - 1, y)), 0.5 * (at(x, y + 1) - at(x, y - 1)));
        let jacobian = glam::DMat2::from_cols(dx, dy);
        let off = (jacobian.inverse() * at(x, y)).length();
        puts.worst_px = puts.worst_px.max(off);
        puts.tried += 1;
    }
    puts
}
