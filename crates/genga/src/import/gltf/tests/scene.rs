//! Nodes, skins, lights, cameras and clips.

use std::f32::consts::{FRAC_PI_4, FRAC_PI_6};

use glam::{Affine3A, Mat4, Quat, Vec3};

use super::*;
use crate::scene::{Interpolation, LightKind, Pose, Projection, Transform};

#[test]
fn unnamed_things_get_names() {
    let mut glb = Glb::triangle();
    glb.json["meshes"][0]["name"] = json!("Sphere");
    glb.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "name": "Ball" }, { "name": "" }]);
    glb.json["materials"] = json!([{ "name": "" }, {}]);
    glb.json["animations"] = json!([{ "channels": [], "samplers": [] }]);
    let scene = glb.imported().scene;
    let names: Vec<_> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["Sphere", "Ball", "node-2"]);
    assert_eq!(scene.materials[0].name, "material-0");
    assert_eq!(scene.materials[1].name, "material-1");
    assert_eq!(scene.clips[0].name, "clip-0");
    assert_eq!(scene.name, "test");
}

#[test]
fn transforms_as_parts_and_as_matrices() {
    let mut glb = Glb::triangle();
    let matrix = Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0));
    glb.json["nodes"] = json!([
        { "translation": [1.0, 0.0, 0.0], "rotation": [0.0, 0.0, 2.0, 2.0], "scale": [2.0, 2.0, 2.0],
          "children": [1] },
        { "matrix": matrix.to_cols_array(), "mesh": 0 },
    ]);
    let scene = glb.imported().scene;
    assert_eq!(scene.nodes[1].parent, Some(0));
    assert_eq!(scene.roots, [0]);
    let world = Pose::rest(&scene).world_from_node[1];
    // The inner point (1, 2, 3), doubled, turned by 90° about z and moved by x.
    let point = world.transform_point3(Vec3::ZERO);
    assert!((point - Vec3::new(-3.0, 2.0, 6.0)).length() < 1e-5, "{point}");
}

#[test]
fn the_shown_scene_is_the_default_the_first_or_everything() {
    let mut glb = Glb::triangle();
    glb.json["nodes"] = json!([{ "children": [1] }, {}, {}]);
    assert_eq!(glb.imported().scene.roots, [0, 2]);
    glb.json["scenes"] = json!([{ "nodes": [2] }, { "nodes": [0, 0, 1] }]);
    assert_eq!(glb.imported().scene.roots, [2]);
    // A node that is listed with its parent is drawn once.
    glb.json["scene"] = json!(1);
    assert_eq!(glb.imported().scene.roots, [0]);
}

#[test]
fn lights() {
    let mut glb = Glb::triangle();
    glb.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "color": [1.0, 0.5, 0.0], "intensity": 3.0, "name": "Sun" },
        { "type": "point", "range": 4.0 },
        { "type": "spot", "spot": { "innerConeAngle": FRAC_PI_6 } },
    ] } });
    glb.json["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 2 } });
    let scene = glb.imported().scene;
    assert_eq!(scene.nodes[0].light, Some(2));
    assert_eq!(scene.lights[0].color, Vec3::new(1.0, 0.5, 0.0));
    assert_eq!((scene.lights[0].kind, scene.lights[0].intensity), (LightKind::Directional, 3.0));
    assert_eq!(scene.lights[1].kind, LightKind::Point { range: Some(4.0) });
    let spot = LightKind::Spot { range: None, inner_angle: FRAC_PI_6, outer_angle: FRAC_PI_4 };
    assert_eq!(scene.lights[2].kind, spot);
}

#[test]
fn cameras() {
    let mut glb = Glb::triangle();
    glb.json["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1, "aspectRatio": 2.0 } },
        { "type": "orthographic",
          "orthographic": { "xmag": 3.0, "ymag": 2.0, "znear": 0.0, "zfar": 10.0 } },
    ]);
    glb.json["nodes"][0]["camera"] = json!(1);
    let scene = glb.imported().scene;
    assert_eq!(scene.cameras[0].projection, Projection::Perspective { fov_y: 0.5 });
    assert_eq!((scene.cameras[0].aspect, scene.cameras[0].near), (Some(2.0), 0.1));
    assert_eq!(scene.cameras[1].projection, Projection::Orthographic { height: 4.0 });
    assert_eq!(scene.cameras[1].aspect, Some(1.5));
    assert!(scene.cameras[1].near > 0.0);
}

/// A triangle held by one joint, node 1.
pub(super) fn skinned() -> Glb {
    let mut glb = Glb::triangle();
    let joints = glb.accessor(&[0; 12], U8, "VEC4", 3);
    let weights = glb.floats("VEC4", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let attributes = &mut glb.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    glb.json["nodes"][0]["skin"] = json!(0);
    glb.push("nodes", json!({ "translation": [0.0, 5.0, 0.0] }));
    glb.push("skins", json!({ "joints": [1] }));
    glb
}

#[test]
fn skins_with_and_without_inverse_bind_matrices() {
    let mut glb = skinned();
    let scene = glb.imported().scene;
    assert_eq!(scene.skins[0].joint_from_mesh, [Affine3A::IDENTITY]);
    let matrix = Mat4::from_translation(Vec3::NEG_Y);
    let matrices = glb.floats("MAT4", &matrix.to_cols_array());
    glb.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
    let scene = glb.imported().scene;
    let moved = Pose::rest(&scene).world_from_rest(&scene, 0).unwrap();
    assert_eq!(moved[0].transform_point3(Vec3::ZERO), Vec3::Y * 4.0);
}

#[test]
fn a_skin_without_joints_in_its_mesh_is_ignored() {
    let mut glb = Glb::triangle();
    glb.json["nodes"] = json!([{ "mesh": 0, "skin": 0 }]);
    glb.json["skins"] = json!([{ "joints": [0] }]);
    assert!(glb.warning().contains("skin is ignored"));
    assert_eq!(glb.read().unwrap().scene.nodes[0].skin, None);
}

#[test]
fn clips_of_every_target_and_interpolation() {
    let mut glb = Glb::triangle();
    glb.json["meshes"][0]["primitives"][0]["targets"] = json!([{}, {}]);
    let times = glb.floats("SCALAR", &[0.0, 2.0]);
    let moves = glb.floats("VEC3", &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    // Normalised integers: from none to half a turn about z.
    let turns = glb.shorts("VEC4", 4, &[0, 0, 0, 32_767, 0, 0, 32_767, 0]);
    glb.json["accessors"][turns]["componentType"] = json!(I16);
    glb.json["accessors"][turns]["normalized"] = json!(true);
    let weights = glb.floats("SCALAR", &[0.0, 1.0, 1.0, 0.0]);
    let spline = glb.floats(
        "VEC3",
        &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 0.0, 0.0, 0.0],
    );
    glb.json["animations"] = json!([{ "name": "wave", "channels": [
        { "sampler": 0, "target": { "node": 0, "path": "translation" } },
        { "sampler": 1, "target": { "node": 0, "path": "rotation" } },
        { "sampler": 2, "target": { "node": 0, "path": "weights" } },
        { "sampler": 3, "target": { "node": 0, "path": "scale" } },
    ], "samplers": [
        { "input": times, "output": moves, "interpolation": "STEP" },
        { "input": times, "output": turns },
        { "input": times, "output": weights, "interpolation": "LINEAR" },
        { "input": times, "output": spline, "interpolation": "CUBICSPLINE" },
    ] }]);
    let scene = glb.imported().scene;
    assert_eq!(scene.find_clip("Wave"), Some(0));
    assert_eq!(scene.clips[0].duration(), 2.0);
    assert_eq!(scene.clips[0].channels[3].interpolation, Interpolation::CubicSpline);
    let pose = Pose::at(&scene, 0, 1.0);
    assert_eq!(pose.morph_weights[0], [0.5, 0.5]);
    let expected = Affine3A::from_scale_rotation_translation(
        // Flat tangents: half way at half time.
        Vec3::splat(2.0),
        Quat::from_rotation_z(std::f32::consts::FRAC_PI_2),
        Vec3::ZERO,
    );
    assert!(pose.world_from_node[0].abs_diff_eq(expected, 1e-4));
}

#[test]
fn channels_that_cannot_be_played_are_left_out() {
    let nan = f32::NAN;
    for (times, path, why) in [
        (vec![1.0, 0.0], "translation", "do not rise"),
        (vec![0.0, nan], "translation", "do not rise"),
        (vec![0.0, 1.0, 2.0], "translation", "fewer values"),
        (vec![], "translation", "no keys"),
        (vec![0.0, 1.0], "weights", "does not have"),
        (vec![0.0, 1.0], "pointer", "not supported"),
    ] {
        let mut glb = Glb::triangle();
        let input = glb.floats("SCALAR", &times);
        let output = glb.floats("VEC3", &[0.0; 6]);
        glb.json["animations"] = json!([{ "channels": [
            { "sampler": 0, "target": { "node": 0, "path": path } },
        ], "samplers": [{ "input": input, "output": output }] }]);
        assert!(glb.warning().contains(why), "{why}: {}", glb.warning());
        assert!(glb.read().unwrap().scene.clips[0].channels.is_empty());
    }
}

#[test]
fn a_channel_without_a_node_is_left_out() {
    let mut glb = Glb::triangle();
    let times = glb.floats("SCALAR", &[0.0]);
    glb.json["animations"] = json!([{ "channels": [
        { "sampler": 0, "target": { "path": "pointer" } },
    ], "samplers": [{ "input": times, "output": times }] }]);
    assert!(glb.warning().contains("moves no node"));
}

#[test]
fn a_node_with_a_useless_transform_stands_at_the_origin() {
    let mut glb = Glb::triangle();
    glb.json["nodes"][0]["translation"] = json!([1e30, 0.0, 0.0]);
    assert!(glb.warning().contains("transform of node 0"));
    assert_eq!(glb.read().unwrap().scene.nodes[0].transform, Transform::default());
}
