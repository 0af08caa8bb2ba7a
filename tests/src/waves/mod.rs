//! Energy waves in f64, by formula and adaptive quadrature, to compare the renderer with.

pub mod cases;
mod curve;
mod quadrature;

use genga::render::View;
use genga::scene::{Projection, Wave, WavePlacement, WaveShape};
use glam::{DMat3, DVec3, Vec3};

use curve::Curve;
use quadrature::integral;

/// A view ray: where it begins, its unit direction, and metres along it per metre along the
/// camera's axis.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where t is 0.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// 1 or more.
    pub slant: f64,
}

/// The ray through the middle of a pixel.
#[must_use]
pub fn ray_of(view: &View, [x, y]: [u32; 2]) -> Ray {
    let m = view.camera.world_from_camera;
    let axis = |v: glam::Vec3A| Vec3::from(v).as_dvec3();
    let (right, up, back) =
        (axis(m.matrix3.x_axis), axis(m.matrix3.y_axis), axis(m.matrix3.z_axis));
    let eye = Vec3::from(m.translation).as_dvec3();
    let [width, height] = view.size.map(f64::from);
    let (x, y) = (f64::from(x) + 0.5 - 0.5 * width, 0.5 * height - f64::from(y) - 0.5);
    let pixel = footprint(view);
    let offset = (right * x + up * y) * pixel;
    match view.camera.projection {
        Projection::Perspective { .. } => {
            let direction = offset - back;
            let slant = direction.length();
            Ray { origin: eye, direction: direction / slant, slant }
        }
        Projection::Orthographic { .. } => {
            Ray { origin: eye + offset, direction: -back, slant: 1.0 }
        }
    }
}

/// Metres per pixel at a distance of 1 m, or anywhere (orthographic).
#[must_use]
pub fn footprint(view: &View) -> f64 {
    match view.camera.projection {
        Projection::Perspective { fov_y } => {
            2.0 * (0.5 * f64::from(fov_y)).tan() / f64::from(view.size[1])
        }
        Projection::Orthographic { height } => f64::from(height) / f64::from(view.size[1]),
    }
}

/// A wave in f64.
pub struct Reference {
    wave: Wave,
    curve: Curve,
    origin: DVec3,
    axes: DMat3,
    /// Metres per pixel (see [`footprint`]), and whether everywhere.
    footprint: (f64, bool),
    near: f64,
    tail: DVec3,
    head: DVec3,
    bound: (DVec3, f64),
}

impl Reference {
    /// A wave that holds on to no nodes, as a view sees it.
    ///
    /// # Panics
    /// If it is stretched between places: that is tested otherwise.
    #[must_use]
    pub fn new(wave: &Wave, view: &View) -> Self {
        let WavePlacement::At { anchor, direction, roll, .. } = &wave.placement else {
            panic!("only waves at a place have a reference")
        };
        let x = direction.as_dvec3().normalize();
        let up = if x.y.abs() < 0.999_999 { DVec3::Y } else { DVec3::NEG_X };
        let y = (up - x * x.dot(up)).normalize();
        let (sin, cos) = f64::from(*roll).sin_cos();
        let z = x.cross(y);
        let axes = DMat3::from_cols(x, y * cos + z * sin, z * cos - y * sin);
        let curve = Curve::new(wave);
        let axes = axes * curve.shape_from_curve;
        let [tail, head] = wave.growth.map(|s| curve.at(f64::from(s)));
        let places: Vec<DVec3> = (0..=2000).map(|i| curve.at(f64::from(i) / 2000.0)).collect();
        let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = 0.5 * (low + high);
        let radius = places.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
        let is_ortho = matches!(view.camera.projection, Projection::Orthographic { .. });
        Self {
            wave: wave.clone(),
            origin: anchor.offset.as_dvec3(),
            axes,
            footprint: (footprint(view), is_ortho),
            near: f64::from(view.camera.near),
            tail,
            head,
            bound: (middle, radius * 1.001),
            curve,
        }
    }

    /// The place of the curve at s, in the world.
    #[must_use]
    pub fn place(&self, s: f64) -> DVec3 {
        self.origin + self.axes * self.curve.at(s)
    }

    /// The energy that a ray collects up to a distance.
    #[must_use]
    pub fn energy(&self, ray: &Ray, end: f64) -> f64 {
        let local = self.axes.transpose();
        let (o, d) = (local * (ray.origin - self.origin), local * ray.direction);
        let wave = &self.wave;
        let reach = f64::from(wave.reach);
        let (mut t0, mut t1) = (0.0, end.min(reach));
        let is_endless = matches!(wave.shape, WaveShape::Cylinder { length: None });
        let nearest = d.dot(self.bound.0 - o);
        let mut marks = vec![nearest];
        if let (Some(radius), false) = (wave.radius, is_endless) {
            let wide = self.bound.1 + f64::from(radius);
            let away = (o + d * nearest).distance(self.bound.0);
            if away >= wide {
                return 0.0;
            }
            let half = (wide * wide - away * away).sqrt();
            t0 = f64::max(t0, nearest - half);
            t1 = f64::min(t1, nearest + half);
        } else if is_endless {
            // The place nearest to the axis.
            let flat = DVec3::new(0.0, d.y, d.z);
            let t = -flat.dot(o) / flat.length_squared().max(1e-300);
            for i in -40..=40 {
                marks.push(t + f64::from(wave.radius.unwrap_or(1.0)) * f64::from(i) / 20.0);
            }
        }
        if t0 >= t1 {
            return 0.0;
        }
        if d.x.abs() > 1e-12 {
            for x in self.curve.marks() {
                marks.push((x - o.x) / d.x);
            }
            marks.push((self.tail.x - o.x) / d.x);
            marks.push((self.head.x - o.x) / d.x);
        }
        for place in [self.tail, self.head] {
            marks.push((place - o).dot(d));
        }
        let half = 3.0 * self.bound.1 + 3.0 * f64::from(wave.radius.unwrap_or(1.0));
        for i in 0..=160 {
            marks.push(t0 + (t1 - t0) * f64::from(i) / 160.0);
            marks.push(nearest + half * (f64::from(i) / 80.0 - 1.0));
        }
        // Rounding must not cut off the ends.
        marks.extend([t0, t1]);
        marks.retain(|t| *t >= t0 && *t <= t1);
        marks.sort_by(f64::total_cmp);
        integral(&|t| self.density(o + d * t, t) * self.fading(t), &marks)
    }

    fn fading(&self, t: f64) -> f64 {
        let rest = (1.0 - t / f64::from(self.wave.reach)).clamp(0.0, 1.0);
        rest.powf(f64::from(self.wave.attenuation))
    }

    /// Density at a place in the curve's frame.
    fn density(&self, p: DVec3, t: f64) -> f64 {
        let wave = &self.wave;
        let (footprint, is_ortho) = self.footprint;
        let pixel = footprint * if is_ortho { 1.0 } else { t.max(self.near) };
        let core = f64::from(wave.core).max(0.5 * pixel);
        let law = |r: f64, alpha: f64| {
            let rim = wave.radius.map_or(0.0, |radius| {
                let radius = f64::from(radius);
                1.0 / (radius * radius + core * core).sqrt()
            });
            alpha * (1.0 / (r * r + core * core).sqrt() - rim).max(0.0)
        };
        let alpha = |s: f64| f64::from(wave.alpha) * self.profile(s);
        let [tail_s, head_s] = wave.growth.map(f64::from);
        let has_ends = !matches!(wave.shape, WaveShape::Cylinder { .. });
        let is_endless = matches!(wave.shape, WaveShape::Cylinder { length: None });
        let mut sum = if is_endless {
            law(p.y.hypot(p.z), alpha(0.0))
        } else if p.x <= self.tail.x {
            if has_ends { law(p.distance(self.tail), alpha(tail_s)) } else { 0.0 }
        } else if p.x >= self.head.x {
            if has_ends { law(p.distance(self.head), alpha(head_s)) } else { 0.0 }
        } else {
            let s = self.curve.s_of_x(p.x);
            law(p.distance(self.curve.at(s)), alpha(s))
        };
        for (place, swell) in [self.tail, self.head].into_iter().zip(wave.swell) {
            if swell > 0.0 {
                sum += law(p.distance(place), f64::from(swell));
            }
        }
        sum
    }

    fn profile(&self, s: f64) -> f64 {
        let points = &self.wave.profile;
        let at = |i: usize| (f64::from(points[i][0]), f64::from(points[i][1]));
        match points.iter().position(|p| f64::from(p[0]) >= s) {
            _ if points.is_empty() => 1.0,
            Some(0) => at(0).1,
            None => at(points.len() - 1).1,
            Some(i) => {
                let ((s0, a), (s1, b)) = (at(i - 1), at(i));
                a + (b - a) * (s - s0) / (s1 - s0)
            }
        }
    }
}
