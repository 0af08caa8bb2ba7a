use glam::{Affine3A, Mat4, Vec2, Vec3, Vec4};

use crate::scene::{Aabb, Pose, Projection, Scene};

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewCamera {
    /// From camera space (looking down −Z, +Y up) to the world; rotation and translation only.
    pub world_from_camera: Affine3A,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// Distance in metres nearer than which nothing is drawn, > 0.
    pub near: f32,
}

/// A camera on a sphere round what it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Degrees to the right of the front (+Z).
    pub azimuth_deg: f32,
    /// Degrees above the horizon.
    pub elevation_deg: f32,
    /// Magnification; 1 shows everything with a small margin. > 0.
    pub zoom: f32,
    /// Vertical angle of view in degrees, in (0, 180); without effect if `orthographic`.
    pub fov_deg: f32,
    /// Parallel projection.
    pub orthographic: bool,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            azimuth_deg: 30.0,
            elevation_deg: 15.0,
            zoom: 1.0,
            fov_deg: 30.0,
            orthographic: false,
        }
    }
}

/// What [`Orbit`] leaves free on each side, as a part of the picture.
const MARGIN: f32 = 0.06;

impl ViewCamera {
    /// A camera that shows all of `bounds` in a picture of the given aspect (width over height).
    ///
    /// Numbers out of range are clamped.
    #[must_use]
    pub fn orbit(bounds: &Aabb, orbit: &Orbit, aspect: f32) -> Self {
        Self::orbit_points(&corners(bounds), orbit, aspect)
    }

    /// A camera that shows all `points` (see [`Scene::extremes`]), as large as they fit and in the
    /// middle of the picture.
    #[must_use]
    pub fn orbit_points(points: &[Vec3], orbit: &Orbit, aspect: f32) -> Self {
        Fit::new(points, orbit, aspect).camera(orbit, &[orbit.azimuth_deg], true)
    }

    /// As [`Self::orbit_points`], but at the same distance and height from every azimuth, so that
    /// a turning object neither jumps nor pulsates.
    #[must_use]
    pub fn turntable(points: &[Vec3], orbit: &Orbit, aspect: f32) -> Self {
        let azimuths: [f32; 72] = std::array::from_fn(|i| 5.0 * i as f32);
        Fit::new(points, orbit, aspect).camera(orbit, &azimuths, false)
    }

    /// Unit vector from a point of the world to the eye.
    #[must_use]
    pub fn to_eye(&self, point: Vec3) -> Vec3 {
        let back = Vec3::from(self.world_from_camera.matrix3.z_axis).normalize_or(Vec3::Z);
        match self.projection {
            Projection::Perspective { .. } => {
                (Vec3::from(self.world_from_camera.translation) - point).normalize_or(back)
            }
            Projection::Orthographic { .. } => back,
        }
    }

    /// The camera of a node of the file; `None` if that node has none.
    #[must_use]
    pub fn from_node(scene: &Scene, pose: &Pose, node: usize) -> Option<Self> {
        let camera = scene.cameras.get(scene.nodes.get(node)?.camera?)?;
        let world_from_node = pose.world_from_node.get(node)?;
        // glTF: a camera ignores the scale of its node.
        let (_, rotation, translation) = world_from_node.to_scale_rotation_translation();
        Some(Self {
            world_from_camera: Affine3A::from_rotation_translation(rotation, translation),
            projection: camera.projection,
            near: camera.near.max(1e-6),
        })
    }
}

/// The eight corners of a box.
fn corners(bounds: &Aabb) -> [Vec3; 8] {
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f32, high: f32| if i & bit == 0 { low } else { high };
        Vec3::new(
            pick(1, bounds.min.x, bounds.max.x),
            pick(2, bounds.min.y, bounds.max.y),
            pick(4, bounds.min.z, bounds.max.z),
        )
    })
}

/// Fits a camera round points.
struct Fit<'a> {
    points: &'a [Vec3],
    center: Vec3,
    radius: f32,
    zoom: f32,
    /// Tangents of half the angles of view, less the margin.
    tangents: Vec2,
    aspect: f32,
}

impl<'a> Fit<'a> {
    fn new(points: &'a [Vec3], orbit: &Orbit, aspect: f32) -> Self {
        let aspect = if aspect.is_finite() { aspect.clamp(1e-3, 1e3) } else { 1.0 };
        let zoom = if orbit.zoom.is_finite() { orbit.zoom.clamp(1e-3, 1e4) } else { 1.0 };
        let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let is_empty = points.is_empty();
        let center = if is_empty { Vec3::ZERO } else { 0.5 * low + 0.5 * high };
        let radius = if is_empty { 1.0 } else { (0.5 * high - 0.5 * low).length().max(1e-6) };
        let tan_y = (0.5 * orbit.fov_deg.clamp(0.1, 170.0)).to_radians().tan();
        let tangents = Vec2::new(tan_y * aspect, tan_y) * (1.0 - 2.0 * MARGIN);
        Self { points, center, radius, zoom, tangents, aspect }
    }

    /// The camera of `orbit` that sees every point from each of the `azimuths`.
    ///
    /// A point (x, y, z) in the camera's axes is seen if `|x − c| ≤ (d − z) tan`, so the two
    /// extremes of `z ± x/tan` give the least distance d and the offset c that centres it.
    fn camera(&self, orbit: &Orbit, azimuths: &[f32], centered: bool) -> ViewCamera {
        let mut extremes = [[f32::NEG_INFINITY; 2]; 2];
        let mut sides = [[f32::NEG_INFINITY; 2]; 2];
        let mut front = f32::NEG_INFINITY;
        for &azimuth in azimuths {
            let axes = axes(azimuth, orbit.elevation_deg);
            for &point in self.points {
                let p = point - self.center;
                let at = [p.dot(axes[0]), p.dot(axes[1])];
                let z = p.dot(axes[2]);
                front = front.max(z);
                for axis in 0..2 {
                    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                        let needed = z + sign * at[axis] / self.tangents[axis];
                        extremes[axis][side] = extremes[axis][side].max(needed);
                        sides[axis][side] = sides[axis][side].max(sign * at[axis]);
                    }
                }
            }
        }
        let [right, up, back] = axes(orbit.azimuth_deg, orbit.elevation_deg);
        let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
        let (mut offset, mut distance, mut height) = (Vec3::ZERO, 0.0_f32, 0.0_f32);
        let fit = 1.0 - 2.0 * MARGIN;
        for (axis, direction) in [right, up].into_iter().enumerate() {
            let measured = if orbit.orthographic { sides[axis] } else { extremes[axis] };
            let [plus, minus] = measured.map(finite);
            // The turntable's axis stays in the middle of the picture.
            let is_free = centered || axis == 1;
            let shift = if is_free { 0.5 * (plus - minus) } else { 0.0 };
            let reach = (plus - shift).max(minus + shift);
            if orbit.orthographic {
                let reach = if axis == 0 { reach / self.aspect } else { reach };
                height = height.max(2.0 * reach / fit);
                offset += shift * direction;
            } else {
                distance = distance.max(reach);
                offset += shift * self.tangents[axis] * direction;
            }
        }
        let front = finite(front);
        let tan_y = self.tangents.y / fit;
        let (projection, distance) = if orbit.orthographic {
            let height = (height / self.zoom).max(1e-6);
            (Projection::Orthographic { height }, front + 2.0 * self.radius)
        } else {
            let distance = distance.max(front + 1e-3 * self.radius);
            (Projection::Perspective { fov_y: 2.0 * (tan_y / self.zoom).atan() }, distance)
        };
        let near = (0.5 * (distance - front)).max(1e-3 * distance).max(1e-9);
        let eye = self.center + offset + distance * back;
        ViewCamera {
            world_from_camera: Affine3A::from_cols(
                right.into(),
                up.into(),
                back.into(),
                eye.into(),
            ),
            projection,
            near,
        }
    }
}

/// Right, up and back of a camera at these angles.
fn axes(azimuth_deg: f32, elevation_deg: f32) -> [Vec3; 3] {
    let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
    let (sin_a, cos_a) = finite(azimuth_deg).to_radians().sin_cos();
    let (sin_e, cos_e) = finite(elevation_deg).clamp(-90.0, 90.0).to_radians().sin_cos();
    let back = Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
    let right = Vec3::new(cos_a, 0.0, -sin_a);
    [right, back.cross(right), back]
}

/// A picture to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where it is taken from.
    pub camera: ViewCamera,
    /// Width and height in pixels, ≥ 1.
    pub size: [u32; 2],
    /// Paint texels per pixel along each axis, 1 to 4. Lines are antialiased anyway.
    pub supersample: u32,
    /// Whether the style's background is drawn; otherwise the picture is transparent there.
    pub background: bool,
    /// Number of the frame in an animation, for lines that are drawn anew every few frames.
    pub frame: u32,
}

impl View {
    /// A view with the style's background and the stills' default of 2 texels per pixel.
    #[must_use]
    pub fn new(camera: ViewCamera, size: [u32; 2]) -> Self {
        Self { camera, size, supersample: 2, background: true, frame: 0 }
    }

    /// The ray through a place of the picture in pixels from its top left (the first pixel's
    /// middle is at 0.5): where it starts and its unit direction, in the world.
    #[must_use]
    pub fn ray(&self, pixel: Vec2) -> [Vec3; 2] {
        let camera = &self.camera.world_from_camera;
        let size = Vec2::new(self.size[0].max(1) as f32, self.size[1].max(1) as f32);
        let at = (pixel / size * 2.0 - 1.0) * Vec2::new(size.x / size.y, -1.0);
        let eye = Vec3::from(camera.translation);
        let forward = -Vec3::from(camera.matrix3.z_axis).normalize_or(Vec3::Z);
        match self.camera.projection {
            Projection::Perspective { fov_y } => {
                let offset = at * (0.5 * fov_y.clamp(1e-4, 3.1)).tan();
                let direction = camera.transform_vector3(offset.extend(-1.0));
                [eye, direction.normalize_or(forward)]
            }
            Projection::Orthographic { height } => {
                let offset = at * 0.5 * height.max(1e-9);
                [eye + camera.transform_vector3(offset.extend(0.0)), forward]
            }
        }
    }
}

/// A view's numbers for the shaders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projected {
    pub(crate) clip_from_world: Mat4,
    /// See `Frame::eye`.
    pub(crate) eye: Vec4,
    /// Near, far (orthographic only).
    pub(crate) depth_range: Vec2,
    /// See `Frame::pixel_footprint`.
    pub(crate) pixel_footprint: f32,
    pub(crate) orthographic: bool,
}

impl Projected {
    /// Metres that a pixel covers at a point.
    pub(crate) fn pixel_at(&self, point: Vec3) -> f32 {
        let away = if self.orthographic { 1.0 } else { self.eye.truncate().distance(point) };
        self.pixel_footprint * away
    }

    /// Reverse-Z, infinitely far in perspective; `bounds` sets the far plane of orthographic
    /// cameras.
    pub(crate) fn new(camera: &ViewCamera, size: [u32; 2], bounds: Option<Aabb>) -> Self {
        let camera_from_world = camera.world_from_camera.inverse();
        let view_from_world = Mat4::from(camera_from_world);
        let (width, height) = (size[0].max(1) as f32, size[1].max(1) as f32);
        let near = camera.near.max(1e-6);
        let back = Vec3::from(camera.world_from_camera.matrix3.z_axis).normalize_or(Vec3::Z);
        match camera.projection {
            Projection::Perspective { fov_y } => {
                let tan_y = (0.5 * fov_y.clamp(1e-4, 3.1)).tan();
                let clip_from_view =
                    Mat4::perspective_infinite_reverse_rh(2.0 * tan_y.atan(), width / height, near);
                let eye = Vec3::from(camera.world_from_camera.translation);
                Self {
                    clip_from_world: clip_from_view * view_from_world,
                    eye: eye.extend(1.0),
                    depth_range: Vec2::new(near, f32::MAX),
                    pixel_footprint: 2.0 * tan_y / height,
                    orthographic: false,
                }
            }
            Projection::Orthographic { height: metres } => {
                let metres = metres.max(1e-9);
                let distance = |p| -camera_from_world.transform_point3(p).z;
                let farthest = bounds.map_or(100.0, |bounds| {
                    corners(&bounds).map(distance).into_iter().fold(f32::MIN, f32::max)
                });
                let far = (farthest * 1.01 + 1e-3 * metres).max(near + 1e-3 * metres);
                let (x, y) = (2.0 * height / (metres * width), 2.0 / metres);
                let z = 1.0 / (far - near);
                // z = 1 at the near plane, 0 at the far one.
                let clip_from_view = Mat4::from_cols(
                    Vec4::new(x, 0.0, 0.0, 0.0),
                    Vec4::new(0.0, y, 0.0, 0.0),
                    Vec4::new(0.0, 0.0, z, 0.0),
                    Vec4::new(0.0, 0.0, far * z, 1.0),
                );
                Self {
                    clip_from_world: clip_from_view * view_from_world,
                    eye: back.extend(0.0),
                    depth_range: Vec2::new(near, far),
                    pixel_footprint: metres / height,
                    orthographic: true,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a lopsided thing.
    fn points() -> Vec<Vec3> {
        (0..200)
            .map(|i| {
                let t = i as f32 * 0.37;
                Vec3::new(3.0 * t.sin() + 5.0, 2.0 * (1.7 * t).cos().abs(), 4.0 * (0.3 * t).cos())
            })
            .collect()
    }

    fn ndc(camera: &ViewCamera, aspect: f32, point: Vec3) -> Vec3 {
        let size = [(1000.0 * aspect) as u32, 1000];
        let bounds = Some(Aabb { min: Vec3::splat(-9.0), max: Vec3::splat(9.0) });
        Projected::new(camera, size, bounds).clip_from_world.project_point3(point)
    }

    #[test]
    fn a_fitted_camera_fills_the_picture_up_to_its_margin_and_centres_it() {
        for orthographic in [false, true] {
            for (azimuth, elevation, aspect) in
                [(0.0, 0.0, 1.0), (35.0, 20.0, 1.6), (200.0, -50.0, 0.5)]
            {
                let orbit = Orbit {
                    azimuth_deg: azimuth,
                    elevation_deg: elevation,
                    orthographic,
                    ..Orbit::default()
                };
                let camera = ViewCamera::orbit_points(&points(), &orbit, aspect);
                let seen: Vec<Vec3> = points().iter().map(|&p| ndc(&camera, aspect, p)).collect();
                let low = seen.iter().copied().fold(Vec3::INFINITY, Vec3::min);
                let high = seen.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
                let most = high.x.max(high.y);
                assert!((most - 0.88).abs() < 0.01, "{orbit:?}: {low} {high}");
                assert!((low.x + high.x).abs() < 0.02 || orthographic || most > high.x + 0.01);
                assert!(low.z > 0.0 && high.z <= 1.0, "{low} {high}");
            }
        }
    }

    #[test]
    fn a_turntable_keeps_its_distance_and_loses_no_point() {
        let mut distances = Vec::new();
        let center = {
            let (low, high) = points()
                .iter()
                .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
            0.5 * (low + high)
        };
        for i in 0..12 {
            let orbit = Orbit { azimuth_deg: 30.0 * i as f32, ..Orbit::default() };
            let camera = ViewCamera::turntable(&points(), &orbit, 1.3);
            distances.push(Vec3::from(camera.world_from_camera.translation).distance(center));
            for p in points() {
                let at = ndc(&camera, 1.3, p);
                assert!(at.x.abs() < 0.9 && at.y.abs() < 0.9, "{i}: {at}");
            }
        }
        let spread = distances.iter().fold(0.0_f32, |m, d| m.max((d - distances[0]).abs()));
        assert!(spread < 1e-4, "{distances:?}");
    }
}
