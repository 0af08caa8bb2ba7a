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
        Self { azimuth_deg: 30.0, elevation_deg: 15.0, zoom: 1.0, fov_deg: 30.0, orthographic: false }
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
        let aspect = if aspect.is_finite() { aspect.clamp(1e-3, 1e3) } else { 1.0 };
        let zoom = if orbit.zoom.is_finite() { orbit.zoom.clamp(1e-3, 1e4) } else { 1.0 };
        let (sin_a, cos_a) = orbit.azimuth_deg.to_radians().sin_cos();
        let (sin_e, cos_e) = orbit.elevation_deg.clamp(-90.0, 90.0).to_radians().sin_cos();
        let back = Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        let right = Vec3::new(cos_a, 0.0, -sin_a);
        let up = back.cross(right);
        let center = 0.5 * (bounds.min + bounds.max);
        let half = (0.5 * (bounds.max - bounds.min)).max(Vec3::splat(1e-6));
        let corners = (0..8).map(|i| {
            let sign = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
            let corner = half * Vec3::new(sign(1), sign(2), sign(4));
            Vec3::new(corner.dot(right), corner.dot(up), corner.dot(back))
        });
        let tan_y = (0.5 * orbit.fov_deg.clamp(0.1, 170.0)).to_radians().tan();
        let fit = 1.0 - 2.0 * MARGIN;
        let (mut distance, mut height, mut front) = (0.0_f32, 0.0_f32, 0.0_f32);
        for corner in corners {
            let needed = (corner.x.abs() / aspect).max(corner.y.abs()) / fit;
            distance = distance.max(needed / tan_y + corner.z);
            height = height.max(2.0 * needed);
            front = front.max(corner.z);
        }
        let (projection, distance) = if orbit.orthographic {
            (Projection::Orthographic { height: height / zoom }, 3.0 * half.length())
        } else {
            (Projection::Perspective { fov_y: 2.0 * (tan_y / zoom).atan() }, distance)
        };
        let near = (0.5 * (distance - front)).max(1e-3 * distance);
        let world_from_camera = Affine3A::from_cols(
            right.into(),
            up.into(),
            back.into(),
            (center + distance * back).into(),
        );
        Self { world_from_camera, projection, near }
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
}

impl View {
    /// A view with the style's background and the stills' default of 2 texels per pixel.
    #[must_use]
    pub fn new(camera: ViewCamera, size: [u32; 2]) -> Self {
        Self { camera, size, supersample: 2, background: true }
    }
}

/// A view's numbers for the shaders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projected {
    pub(crate) clip_from_world: Mat4,
    pub(crate) view_from_world: Mat4,
    /// See `Frame::eye`.
    pub(crate) eye: Vec4,
    /// Near, far (orthographic only).
    pub(crate) depth_range: Vec2,
    /// See `Frame::pixel_footprint`.
    pub(crate) pixel_footprint: f32,
    pub(crate) orthographic: bool,
}

impl Projected {
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
                    view_from_world,
                    eye: eye.extend(1.0),
                    depth_range: Vec2::new(near, f32::MAX),
                    pixel_footprint: 2.0 * tan_y / height,
                    orthographic: false,
                }
            }
            Projection::Orthographic { height: metres } => {
                let metres = metres.max(1e-9);
                let farthest = bounds.map_or(100.0, |bounds| {
                    (0..8)
                        .map(|i| {
                            let pick = |bit: i32, low: f32, high: f32| if i & bit == 0 { low } else { high };
                            let corner = Vec3::new(
                                pick(1, bounds.min.x, bounds.max.x),
                                pick(2, bounds.min.y, bounds.max.y),
                                pick(4, bounds.min.z, bounds.max.z),
                            );
                            -camera_from_world.transform_point3(corner).z
                        })
                        .fold(f32::MIN, f32::max)
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
                    view_from_world,
                    eye: back.extend(0.0),
                    depth_range: Vec2::new(near, far),
                    pixel_footprint: metres / height,
                    orthographic: true,
                }
            }
        }
    }
}
