//! Poses against values worked out by hand, bounds and validation.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{Affine3A, Mat4, Quat, Vec3, Vec3A};

use super::*;

/// Nodes in a chain, each one metre above its parent.
fn chain(length: usize) -> Scene {
    let transform =
        Transform::Parts { translation: Vec3::Y, rotation: Quat::IDENTITY, scale: Vec3::ONE };
    let node = |i: usize| Node {
        name: format!("bone {i}"),
        parent: i.checked_sub(1),
        children: if i + 1 < length { vec![i + 1] } else { Vec::new() },
        transform,
        ..Node::default()
    };
    Scene { nodes: (0..length).map(node).collect(), roots: vec![0], ..Scene::default() }
}

/// One triangle (0, 0, 0), (1, 0, 0), (0, 1, 0).
fn triangle() -> Primitive {
    Primitive {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        indices: vec![0, 1, 2],
        ..Primitive::default()
    }
}

fn shown(primitive: Primitive) -> Scene {
    let mut scene = chain(1);
    scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
    scene.nodes[0].mesh = Some(0);
    scene
}

fn channel(target: ChannelTarget, interpolation: Interpolation, values: &[f32]) -> Channel {
    Channel { node: 0, target, interpolation, times: vec![1.0, 3.0], values: values.to_vec() }
}

/// A one-node scene with one channel, posed at a time.
fn posed(channel: Channel, time: f32) -> Affine3A {
    let mut scene = chain(1);
    scene.nodes[0].transform = Transform::default();
    scene.clips.push(Clip { name: "clip".to_owned(), channels: vec![channel] });
    Pose::at(&scene, 0, time).world_from_node[0]
}

fn moved(interpolation: Interpolation, values: &[f32], time: f32) -> f32 {
    posed(channel(ChannelTarget::Translation, interpolation, values), time).translation.x
}

#[test]
fn keys_hold_outside_and_are_joined_by_lines_inside() {
    let values = [2.0, 0.0, 0.0, 6.0, 0.0, 0.0];
    let at = |time| moved(Interpolation::Linear, &values, time);
    assert_eq!([-9.0, 1.0, 1.5, 3.0, 99.0].map(at), [2.0, 2.0, 3.0, 6.0, 6.0]);
    assert_eq!(at(f32::NAN), 2.0);
    let at = |time| moved(Interpolation::Step, &values, time);
    assert_eq!([0.0, 1.0, 2.9, 3.0, 4.0].map(at), [2.0, 2.0, 2.0, 6.0, 6.0]);
}

#[test]
fn cubic_splines_follow_their_tangents() {
    // p0 = 1, out-tangent 2, p1 = 3, in-tangent −1, over 2 s. At u = 1/4 the Hermite basis is
    // 0.84375, 0.140625, 0.15625, −0.046875, tangents times 2 s:
    // 0.84375 + 0.140625 · 2 · 2 + 0.15625 · 3 − 0.046875 · 2 · −1 = 1.96875.
    let key = |a: f32, p: f32, b: f32| [a, 0.0, 0.0, p, 0.0, 0.0, b, 0.0, 0.0];
    let values = [key(9.0, 1.0, 2.0), key(-1.0, 3.0, 9.0)].concat();
    let at = |time| moved(Interpolation::CubicSpline, &values, time);
    assert!((at(1.5) - 1.96875).abs() < 1e-6, "{}", at(1.5));
    assert_eq!([0.0, 1.0, 3.0, 5.0].map(at), [1.0, 1.0, 3.0, 3.0]);
}

#[test]
fn rotations_take_the_shorter_way() {
    let quarter = Quat::from_rotation_z(FRAC_PI_2);
    // The same rotation by the opposite quaternion would be reached the long way round.
    for end in [quarter, -quarter] {
        let values = [Quat::IDENTITY.to_array(), end.to_array()].concat();
        let world = posed(channel(ChannelTarget::Rotation, Interpolation::Linear, &values), 2.0);
        let expected = Affine3A::from_rotation_z(FRAC_PI_4);
        assert!(world.abs_diff_eq(expected, 1e-3), "{world}");
    }
}

#[test]
fn spline_rotations_are_normalised() {
    let key = |q: Quat| [[0.0; 4], q.to_array(), [0.0; 4]].concat();
    let values = [key(Quat::IDENTITY), key(Quat::from_rotation_z(FRAC_PI_2))].concat();
    let world = posed(channel(ChannelTarget::Rotation, Interpolation::CubicSpline, &values), 2.0);
    assert!(world.abs_diff_eq(Affine3A::from_rotation_z(FRAC_PI_4), 1e-5), "{world}");
}

#[test]
fn channels_without_enough_values_change_nothing() {
    assert_eq!(moved(Interpolation::Linear, &[1.0, 2.0, 3.0], 2.0), 0.0);
    assert_eq!(moved(Interpolation::CubicSpline, &[1.0; 6], 2.0), 0.0);
    let mut none = channel(ChannelTarget::Translation, Interpolation::Linear, &[]);
    none.times.clear();
    assert_eq!(posed(none, 2.0), Affine3A::IDENTITY);
}

#[test]
fn a_node_given_by_a_matrix_is_not_animated() {
    let mut scene = chain(1);
    scene.nodes[0].transform = Transform::Matrix(Mat4::from_translation(Vec3::Z));
    let values = [5.0; 6];
    let channels = vec![channel(ChannelTarget::Translation, Interpolation::Linear, &values)];
    scene.clips.push(Clip { name: String::new(), channels });
    assert_eq!(Pose::at(&scene, 0, 2.0).world_from_node[0].translation, Vec3A::Z);
    // A clip that does not exist is the rest pose.
    assert_eq!(Pose::at(&scene, 7, 2.0), Pose::rest(&scene));
}

#[test]
fn parents_move_their_children_in_any_order_of_nodes() {
    let mut scene = chain(3);
    assert_eq!(Pose::rest(&scene).world_from_node[2].translation, Vec3A::Y * 3.0);
    scene.nodes.reverse();
    for (i, node) in scene.nodes.iter_mut().enumerate() {
        node.parent = (i < 2).then_some(i + 1);
        node.children = if i > 0 { vec![i - 1] } else { Vec::new() };
    }
    scene.roots = vec![2];
    assert_eq!(scene.validate(), Ok(()));
    assert_eq!(Pose::rest(&scene).world_from_node[0].translation, Vec3A::Y * 3.0);
}

#[test]
fn joints_outside_of_the_shown_scene_are_placed_but_not_visible() {
    let mut scene = chain(2);
    scene.nodes.push(Node { name: "shown".to_owned(), ..Node::default() });
    scene.roots = vec![2];
    let pose = Pose::rest(&scene);
    assert_eq!(pose.visible, [false, false, true]);
    assert_eq!(pose.world_from_node[1].translation, Vec3A::Y * 2.0);
}

#[test]
fn cycles_end() {
    let mut scene = chain(2);
    scene.nodes[1].children = vec![0, 1, 99];
    assert!(scene.validate().is_err());
    let pose = Pose::rest(&scene);
    assert_eq!(pose.visible, [true, true]);
}

/// The triangle held by bone 1 at (1, 0, 0) and by bone 0 elsewhere.
fn skinned() -> Scene {
    let mut scene = chain(2);
    let mut primitive = triangle();
    primitive.joints = vec![[0; 4], [1, 0, 0, 0], [0, 1, 0, 0]];
    primitive.weights = vec![[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0]];
    scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
    // Bound where the bones stand, one and two metres up.
    scene.skins.push(Skin {
        name: "skin".to_owned(),
        joints: vec![0, 1],
        joint_from_mesh: [1.0, 2.0].map(|y| Affine3A::from_translation(Vec3::Y * -y)).to_vec(),
    });
    scene.nodes.push(Node {
        name: "body".to_owned(),
        mesh: Some(0),
        skin: Some(0),
        // A skinned mesh ignores where its own node stands.
        transform: Transform::Matrix(Mat4::from_translation(Vec3::splat(100.0))),
        ..Node::default()
    });
    scene.roots.push(2);
    scene
}

#[test]
fn a_skin_at_its_bind_pose_leaves_the_mesh_in_place() {
    let scene = skinned();
    assert_eq!(scene.validate(), Ok(()));
    let pose = Pose::rest(&scene);
    let matrices = pose.world_from_rest(&scene, 2).unwrap();
    assert!(matrices.iter().all(|matrix| matrix.abs_diff_eq(Affine3A::IDENTITY, 1e-6)));
    assert_eq!(pose.world_from_rest(&scene, 0), None);
    assert_eq!(pose.world_from_rest(&scene, 99), None);
    let bounds = scene.bounds(&pose).unwrap();
    assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)));
}

#[test]
fn a_bent_joint_takes_its_vertices_along() {
    let mut scene = skinned();
    scene.nodes[1].transform = Transform::Parts {
        translation: Vec3::new(0.0, 1.0, 4.0),
        rotation: Quat::IDENTITY,
        scale: Vec3::ONE,
    };
    let bounds = scene.bounds(&Pose::rest(&scene)).unwrap();
    // The second vertex moves by 4, the third, which two bones hold, by 2.
    assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 4.0)));
    assert_eq!(bounds.center(), Vec3::new(0.5, 0.5, 2.0));
    assert!((bounds.radius() - 0.5 * 18.0_f32.sqrt()).abs() < 1e-6);
}

#[test]
fn bounds_follow_morph_targets_and_nodes() {
    let mut primitive = triangle();
    let target = MorphTarget { positions: vec![Vec3::Z * 2.0; 3], normals: Vec::new() };
    primitive.morph_targets = vec![target];
    let mut scene = shown(primitive);
    scene.meshes[0].morph_weights = vec![0.5];
    let bounds = scene.bounds(&Pose::rest(&scene)).unwrap();
    assert_eq!(bounds.min, Vec3::new(0.0, 1.0, 1.0));
    assert_eq!(bounds.max, Vec3::new(1.0, 2.0, 1.0));
    // The node's weights replace the mesh's.
    scene.nodes[0].morph_weights = vec![-1.0];
    assert_eq!(scene.bounds(&Pose::rest(&scene)).unwrap().max.z, -2.0);
}

#[test]
fn what_is_not_drawn_has_no_bounds() {
    let mut scene = shown(triangle());
    scene.roots.clear();
    assert_eq!(scene.bounds(&Pose::rest(&scene)), None);
    assert_eq!(Scene::default().bounds(&Pose::rest(&Scene::default())), None);
    // Places that overflow do not count.
    let mut scene = shown(triangle());
    scene.nodes[0].transform = Transform::Matrix(Mat4::from_scale(Vec3::splat(f32::MAX)));
    scene.meshes[0].primitives[0].positions[1] = Vec3::X * 10.0;
    let bounds = scene.bounds(&Pose::rest(&scene)).unwrap();
    assert_eq!(bounds.max, Vec3::Y * f32::MAX);
}

#[test]
fn validation_names_what_is_wrong() {
    let message = |change: &dyn Fn(&mut Scene)| {
        let mut scene = skinned();
        scene.meshes[0].name = "Body".to_owned();
        change(&mut scene);
        scene.validate().unwrap_err().to_string()
    };
    let cases: [(&dyn Fn(&mut Scene), &str); 16] = [
        (&|s| s.nodes[2].mesh = Some(1), "node 2 'body' refers to mesh 1, but there are only 1"),
        (&|s| s.nodes[2].skin = Some(1), "skin 1"),
        (&|s| s.nodes[2].camera = Some(0), "camera 0"),
        (&|s| s.nodes[2].light = Some(0), "light 0"),
        (&|s| s.nodes[1].parent = Some(9), "node 9"),
        (&|s| s.nodes[1].children = vec![3], "node 3"),
        (&|s| s.roots = vec![5], "the scene refers to node 5"),
        (&|s| s.roots = vec![0, 1], "'bone 1' is reached twice"),
        (&|s| s.skins[0].joints[0] = 8, "skin 0 'skin' refers to node 8"),
        (&|s| s.skins[0].joint_from_mesh.truncate(1), "inverse bind matrix 1"),
        (&|s| s.meshes[0].primitives[0].indices[2] = 3, "vertex 3"),
        (&|s| s.meshes[0].primitives[0].normals.clear(), "'Body' has 0 normals for 3 vertices"),
        (&|s| s.meshes[0].primitives[0].weights.clear(), "0 joint weights"),
        (&|s| s.meshes[0].primitives[0].joints[0] = [2; 4], "joint 2"),
        (
            &|s| s.meshes[0].primitives[0].positions[1].x = f32::NAN,
            "not a finite number at vertex 1",
        ),
        (&|s| s.meshes[0].primitives[0].indices.truncate(2), "2 indices"),
    ];
    for (change, expected) in cases {
        assert!(message(change).contains(expected), "{} lacks {expected}", message(change));
    }
}

#[test]
fn validation_knows_materials_textures_and_clips() {
    let mut scene = shown(triangle());
    scene.meshes[0].primitives[0].material = Some(0);
    assert!(scene.validate().is_err());
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::default() };
    scene.materials.push(Material { base_color_texture: Some(texture), ..Material::default() });
    assert!(scene.validate().unwrap_err().to_string().contains("texture 0"));
    let texture = Texture { name: String::new(), image: Some(0), sampler: Sampler::default() };
    scene.textures.push(texture);
    assert!(scene.validate().unwrap_err().to_string().contains("image 0"));
    let rgba = vec![0; 7];
    scene.images.push(Image { name: "atlas".to_owned(), width: 2, height: 1, rgba });
    let message = scene.validate().unwrap_err().to_string();
    assert!(message.contains("image 0 'atlas'") && message.contains("7 bytes"), "{message}");
    scene.images[0].rgba.push(0);
    assert_eq!(scene.validate(), Ok(()));

    let good = channel(ChannelTarget::Translation, Interpolation::Linear, &[0.0; 6]);
    let check = |change: &dyn Fn(&mut Channel)| {
        let mut scene = shown(triangle());
        let mut channel = good.clone();
        change(&mut channel);
        scene.clips.push(Clip { name: "walk".to_owned(), channels: vec![channel] });
        scene.validate()
    };
    assert_eq!(check(&|_| {}), Ok(()));
    assert!(check(&|c| c.node = 1).is_err());
    assert!(check(&|c| c.times = vec![3.0, 1.0]).unwrap_err().to_string().contains("'walk'"));
    assert!(check(&|c| c.times[0] = f32::NAN).is_err());
    assert!(check(&|c| c.values.truncate(5)).is_err());
    assert!(check(&|c| c.interpolation = Interpolation::CubicSpline).is_err());
}
