//! What lines are proved on.

use genga::scene::Scene;
use genga::shapes;
use glam::{Quat, Vec3};

use crate::scenes::{Builder, model, moved, parts};

/// Names of the subjects, for [`subject`].
pub const SUBJECTS: [&str; 4] =
    ["cube-before-plane", "teapot-on-box", "capped-cylinder", "two-boxes"];

/// A scene by its name.
///
/// # Panics
/// If there is none of that name.
#[must_use]
pub fn subject(name: &str) -> Scene {
    match name {
        "capped-cylinder" => capped_cylinder(),
        "two-boxes" => two_boxes(),
        _ => model(name),
    }
}

/// A round bar with flat ends, tilted.
#[must_use]
pub fn capped_cylinder() -> Scene {
    let mut scene = Builder::new();
    let tilt = parts(Vec3::ZERO, Quat::from_rotation_z(0.3), Vec3::ONE);
    scene.object("cylinder", shapes::cylinder(48, 0.4, 1.2), None, tilt);
    scene.build()
}

/// Two boxes that run into each other, askew.
#[must_use]
pub fn two_boxes() -> Scene {
    let mut scene = Builder::new();
    scene.object("flat", shapes::cuboid(Vec3::new(1.6, 0.6, 1.0)), None, moved(0.0, 0.0, 0.0));
    let turn = Quat::from_rotation_y(0.5) * Quat::from_rotation_x(0.35);
    let at = parts(Vec3::new(0.25, 0.3, 0.2), turn, Vec3::ONE);
    scene.object("tall", shapes::cuboid(Vec3::new(0.5, 1.4, 0.5)), None, at);
    scene.build()
}

/// One ball of radius 1.
#[must_use]
pub fn ball(segments: u32, rings: u32) -> Scene {
    let mut scene = Builder::new();
    let tilt = parts(Vec3::ZERO, Quat::from_rotation_x(0.4), Vec3::ONE);
    scene.object("ball", shapes::uv_sphere(segments, rings, 1.0), None, tilt);
    scene.build()
}
