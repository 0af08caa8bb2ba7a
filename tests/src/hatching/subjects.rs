//! What is hatched: simple bodies, a body with a skin, and how they move.

use genga::render::{View, ViewCamera};
use genga::scene::{Node, Pose, Primitive, Projection, Scene, Skin};
use genga::shapes;
use glam::{Affine3A, DVec3, Quat, Vec3};

use super::surface::{Frame, Hit};
use crate::scenes::{Builder, perspective_view};

/// The bodies of [`body`].
pub const BODIES: [&str; 3] = ["cylinder", "cone", "sphere"];

/// A round body about the y axis, about 2 m high.
///
/// # Panics
/// If there is none of that name.
#[must_use]
pub fn body(name: &str) -> Primitive {
    match name {
        "cylinder" => tube(|_| 0.7),
        "cone" => tube(|y| 0.5 * (1.0 - y).max(1e-3)),
        "sphere" => shapes::uv_sphere(96, 48, 1.0),
        _ => panic!("there is no body '{name}'"),
    }
}

/// A surface of revolution without caps, from y = −1 to 1.
fn tube(radius: impl Fn(f32) -> f32) -> Primitive {
    const ROUND: u32 = 96;
    const HIGH: u32 = 24;
    let mut tube = Primitive::default();
    for j in 0..=HIGH {
        let y = 2.0 * j as f32 / HIGH as f32 - 1.0;
        let slope = (radius(y + 0.01) - radius(y - 0.01)) / 0.02;
        for i in 0..=ROUND {
            // The first and the last are one place.
            let (sin, cos) = ((i % ROUND) as f32 / ROUND as f32 * std::f32::consts::TAU).sin_cos();
            tube.positions.push(Vec3::new(sin * radius(y), y, cos * radius(y)));
            tube.normals.push(Vec3::new(sin, -slope, cos).normalize());
            if i < ROUND && j < HIGH {
                let [a, b] = [j, j + 1].map(|j| j * (ROUND + 1) + i);
                tube.indices.extend([a, a + 1, b + 1, a, b + 1, b]);
            }
        }
    }
    tube
}

/// A body at the origin.
#[must_use]
pub fn standing(name: &str) -> Scene {
    let mut scene = Builder::new();
    scene.object(name, body(name), None, Default::default());
    scene.build()
}

/// A pose of [`standing`], turned about its axis.
#[must_use]
pub fn turned(scene: &Scene, degrees: f32) -> Pose {
    let mut pose = Pose::rest(scene);
    pose.world_from_node[0] = Affine3A::from_rotation_y(degrees.to_radians());
    pose
}

/// A tube on two joints, the upper one at the origin.
#[must_use]
pub fn skinned() -> Scene {
    let mut scene = Builder::new();
    let mut tube = body("cylinder");
    for p in &tube.positions {
        let upper = (0.5 + p.y).clamp(0.0, 1.0);
        tube.joints.push([0, 1, 0, 0]);
        tube.weights.push([1.0 - upper, upper, 0.0, 0.0]);
    }
    let object = scene.object("tube", tube, None, Default::default());
    let joints = ["lower", "upper"]
        .map(|name| scene.node(Node { name: name.to_owned(), ..Node::default() }));
    let scene = scene.raw();
    scene.skins.push(Skin {
        name: String::new(),
        joints: joints.to_vec(),
        joint_from_mesh: vec![Affine3A::IDENTITY; 2],
    });
    scene.nodes[object].skin = Some(0);
    scene.clone()
}

/// A pose of [`skinned`]: its upper half bends to the side and turns.
#[must_use]
pub fn bent(scene: &Scene, degrees: f32) -> Pose {
    let mut pose = Pose::rest(scene);
    let angle = degrees.to_radians();
    let bend = Quat::from_rotation_z(angle) * Quat::from_rotation_y(0.5 * angle);
    let upper = scene.skins[0].joints[1];
    pose.world_from_node[upper] = Affine3A::from_quat(bend);
    pose
}

/// A view of a body from in front of it.
#[must_use]
pub fn front(size: u32) -> View {
    View { supersample: 1, ..perspective_view([size, size], 30.0, 4.6) }
}

/// The same, nearer to the middle of its right half by a factor.
#[must_use]
pub fn magnified(size: u32, zoom: f32) -> View {
    let camera = ViewCamera {
        world_from_camera: Affine3A::from_translation(Vec3::new(0.15, 0.1, 5.0)),
        projection: Projection::Orthographic { height: 2.4 / zoom },
        near: 0.1,
    };
    View { supersample: 1, ..View::new(camera, [size, size]) }
}

/// Round the y axis: where strokes of these bodies run to.
#[must_use]
pub fn round(frame: &Frame, hit: Hit) -> Option<DVec3> {
    let [a, b, c] = frame.posed().triangles[hit.triangle];
    let normal = (b - a).cross(c - a);
    DVec3::Y.cross(normal).try_normalize()
}
