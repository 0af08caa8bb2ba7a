//! The small scenes that pictures of lines are compared on.

use genga_shapes::{cuboid, plane, uv_sphere};
use glam::{Vec2, Vec3};

use super::glb::Model;
use super::teapot::Teapot;

/// The way the sun shines in every scene: from the upper left, in front.
pub(super) const SUN: Vec3 = Vec3::new(0.4, -0.55, -0.75);

/// The scene of figure 3 in Okuya et al. 2015: a cube, and a plane behind it that is parallel to
/// its front, so that depth alone finds the outline and normals alone the creases.
pub(super) fn cube_before_plane() -> Model {
    let mut model = Model::new("cube-before-plane");
    let red = model.material("red", 0xD9482B, false);
    let wall = model.material("wall", 0xE9E2CF, false);
    model.shape("cube", &cuboid(Vec3::ONE), red, Vec3::new(0.0, 0.5, 0.0));
    model.shape("plane", &plane(Vec2::new(3.2, 2.2)), wall, Vec3::new(-0.5, 0.9, -1.2));
    model.camera(Vec3::new(2.4, 2.1, 5.4), Vec3::new(-0.08, 0.72, -0.4), 26.0);
    model.sun(SUN);
    model
}

/// The scene of figure 10 in Okuya et al. 2015: a teapot on a box, and a plane behind both.
pub(super) fn teapot_on_box() -> Model {
    let mut model = Model::new("teapot-on-box");
    let body = model.material("glaze", 0x2F7FB8, true);
    let lid = model.material("lid", 0xF2B632, true);
    let handle = model.material("handle", 0x8C4A2F, false);
    let spout = model.material("spout", 0x5BAE6A, true);
    let wood = model.material("wood", 0xC98F55, false);
    let wall = model.material("wall", 0xE9E2CF, false);
    let table = Vec3::new(0.8, 0.3, 0.5);
    let on_table = Vec3::Y * table.y;
    let teapot = Teapot::new();
    model.shape("body", &teapot.body, body, on_table);
    model.shape("lid", &teapot.lid, lid, on_table);
    model.shape("handle", &teapot.handle, handle, on_table);
    model.shape("spout", &teapot.spout, spout, on_table);
    model.shape("box", &cuboid(table), wood, Vec3::Y * (table.y / 2.0));
    model.shape("plane", &plane(Vec2::new(1.5, 0.85)), wall, Vec3::new(-0.2, 0.36, -0.5));
    model.camera(Vec3::new(0.75, 0.95, 2.2), Vec3::new(-0.05, 0.33, -0.1), 25.0);
    model.sun(SUN);
    model
}

/// The same ball twice, near and far: line widths against distance.
pub(super) fn spheres_near_far() -> Model {
    let mut model = Model::new("spheres-near-far");
    let paint = model.material("ball", 0xE0663C, false);
    let ball = model.mesh("ball", &uv_sphere(64, 32, 0.5), paint);
    model.object("near", ball, Vec3::new(-0.65, 0.0, 0.0));
    model.object("far", ball, Vec3::new(1.9, 0.7, -9.0));
    model.camera(Vec3::new(0.0, 0.3, 4.0), Vec3::new(0.0, 0.12, 0.0), 27.0);
    model.sun(SUN);
    model
}
