//! Cameras in f64: where a point falls on the picture, and what lies behind a pixel.

use genga::render::View;
use genga::scene::Projection;
use glam::{DVec2, DVec3, Vec3};

/// A view in f64.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Place of the camera.
    pub origin: DVec3,
    right: DVec3,
    up: DVec3,
    back: DVec3,
    /// Half the visible height at a distance of 1 m, or at all distances if `orthographic`.
    half_height: f64,
    orthographic: bool,
    size: DVec2,
    /// Distance of the near plane.
    pub near: f64,
}

/// A line of sight through a pixel: `origin + t · direction`, `t` the distance along the camera's
/// axis in metres.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where t is 0.
    pub origin: DVec3,
    /// Its part along the camera's axis has length 1.
    pub direction: DVec3,
}

fn wide(v: impl Into<Vec3>) -> DVec3 {
    v.into().as_dvec3()
}

impl Eye {
    /// The camera of a view.
    #[must_use]
    pub fn new(view: &View) -> Self {
        let camera = &view.camera;
        let axes = camera.world_from_camera.matrix3;
        let (half_height, orthographic) = match camera.projection {
            Projection::Perspective { fov_y } => ((0.5 * f64::from(fov_y)).tan(), false),
            Projection::Orthographic { height } => (0.5 * f64::from(height), true),
        };
        Self {
            origin: wide(camera.world_from_camera.translation),
            right: wide(axes.x_axis),
            up: wide(axes.y_axis),
            back: wide(axes.z_axis),
            half_height,
            orthographic,
            size: DVec2::new(f64::from(view.size[0]), f64::from(view.size[1])),
            near: f64::from(camera.near),
        }
    }

    /// Distance of a point along the camera's axis in metres.
    #[must_use]
    pub fn distance(&self, p_in_world: DVec3) -> f64 {
        (self.origin - p_in_world).dot(self.back)
    }

    /// Pixels from the top left of a point in front of the camera.
    #[must_use]
    pub fn project(&self, p_in_world: DVec3) -> DVec2 {
        let offset = p_in_world - self.origin;
        let distance = if self.orthographic { 1.0 } else { self.distance(p_in_world) };
        let across = DVec2::new(offset.dot(self.right), -offset.dot(self.up));
        0.5 * self.size + across / (self.half_height * distance) * (0.5 * self.size.y)
    }

    /// The line of sight through a place of the picture in pixels.
    #[must_use]
    pub fn ray(&self, p_px: DVec2) -> Ray {
        let ndc = (p_px - self.size / 2.0) / (self.size.y / 2.0) * self.half_height;
        let across = self.right * ndc.x - self.up * ndc.y;
        if self.orthographic {
            Ray { origin: self.origin + across, direction: -self.back }
        } else {
            Ray { origin: self.origin, direction: across - self.back }
        }
    }

    /// The line of sight through the middle of a pixel.
    #[must_use]
    pub fn ray_at(&self, x: u32, y: u32) -> Ray {
        self.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))
    }

    /// Metres that a pixel covers at a distance.
    #[must_use]
    pub fn footprint(&self, distance: f64) -> f64 {
        let height = 2.0 * self.half_height / self.size.y;
        if self.orthographic { height } else { height * distance }
    }

    /// Whether lines of sight are parallel.
    #[must_use]
    pub fn is_orthographic(&self) -> bool {
        self.orthographic
    }

    /// Vector from a point towards the eye, not of unit length.
    #[must_use]
    pub fn towards(&self, p_in_world: DVec3) -> DVec3 {
        if self.orthographic { self.back } else { self.origin - p_in_world }
    }
}

impl Ray {
    /// The point at a distance.
    #[must_use]
    pub fn point(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Where it meets a triangle, from either side, and the barycentric weights of the second and
    /// third corner.
    #[must_use]
    pub fn meets(&self, [a, b, c]: [DVec3; 3]) -> Option<(f64, [f64; 2])> {
        let (ab, ac) = (b - a, c - a);
        let p = self.direction.cross(ac);
        let determinant = ab.dot(p);
        if determinant == 0.0 {
            return None;
        }
        let s = self.origin - a;
        let u = s.dot(p) / determinant;
        let q = s.cross(ab);
        let v = self.direction.dot(q) / determinant;
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        inside.then(|| (ac.dot(q) / determinant, [u, v]))
    }

    /// Where it first meets a sphere.
    #[must_use]
    pub fn meets_sphere(&self, center: DVec3, radius: f64) -> Option<f64> {
        let offset = self.origin - center;
        let a = self.direction.length_squared();
        let b = self.direction.dot(offset);
        let root = b * b - a * (offset.length_squared() - radius * radius);
        (root >= 0.0).then(|| (-b - root.sqrt()) / a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{ortho_view, perspective_view};

    #[test]
    fn projecting_a_point_of_a_ray_gives_its_pixel() {
        for view in [ortho_view([90, 60], 2.0), perspective_view([90, 60], 40.0, 5.0)] {
            let eye = Eye::new(&view);
            for p_px in [DVec2::new(0.0, 0.0), DVec2::new(33.0, 51.5), DVec2::new(90.0, 1.0)] {
                let ray = eye.ray(p_px);
                let p = ray.point(3.5);
                assert!((eye.distance(p) - 3.5).abs() < 1e-9);
                assert!((eye.project(p) - p_px).length() < 1e-9);
            }
        }
    }
}
