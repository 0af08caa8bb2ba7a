//! Deformation and projection against f64 on the processor: what each pixel sees, how far away it
//! is and how it is turned.

use genga::render::{LayerKind, Picture, View};
use genga::scene::{MorphTarget, Node, Pose, Primitive, Scene, Skin, Transform};
use genga::shapes;
use genga_tests::reference::{Hit, Triangle, cast, triangles};
use genga_tests::scenes::{Builder, moved, ortho_view, parts, perspective_view, style};
use genga_tests::{Eye, Pixels, draw_posed};
use glam::{Affine3A, Quat, Vec3};

/// Draws the scene and compares ids, depth and normals with what f64 says, where it is sure.
fn assert_drawn_as_computed(scene: &Scene, pose: &Pose, view: &View) {
    let view = &View { supersample: 1, ..*view };
    let layers = [LayerKind::Depth, LayerKind::Normal, LayerKind::Ids];
    let picture = draw_posed(scene, pose, &style("[lines]\nmethod = \"none\""), view, &layers);
    let triangles = triangles(scene, pose);
    let hits = cast(view, &triangles);
    let eye = Eye::new(view);
    let mut compared = 0;
    for ((x, y), hit) in picture.places().zip(&hits) {
        match hit {
            Some(hit) if !hit.unsure => {
                compared += 1;
                assert_pixel(&picture, (x, y), hit, &triangles, &eye);
            }
            _ => {}
        }
    }
    let seen = hits.iter().flatten().count();
    assert!(seen > 1000, "the scene covers only {seen} pixels");
    assert!(10 * compared > 8 * seen, "only {compared} of {seen} pixels could be compared");
    // The background's side: what is not near anything is empty.
    for ((x, y), _) in picture.places().zip(&hits).filter(|((x, y), _)| {
        let near = |dx: i64, dy: i64| {
            let (x, y) = (i64::from(*x) + dx, i64::from(*y) + dy);
            let [width, height] = view.size.map(i64::from);
            let inside = (0..width).contains(&x) && (0..height).contains(&y);
            inside && hits[(y * width + x) as usize].is_some()
        };
        (-1..=1).all(|dy| (-1..=1).all(|dx| !near(dx, dy)))
    }) {
        assert_eq!(picture.ids(x, y), [0; 3], "the background at ({x}, {y})");
        assert_eq!(picture.normal(x, y), Vec3::ZERO);
    }
}

fn assert_pixel(
    picture: &Picture,
    (x, y): (u32, u32),
    hit: &Hit,
    triangles: &[Triangle],
    eye: &Eye,
) {
    let triangle = &triangles[hit.triangle];
    let (node, material) = triangle.owner;
    let [object, material_id, _] = picture.ids(x, y);
    assert_eq!(object as usize, node + 1, "object at ({x}, {y})");
    assert_eq!(material_id as usize, material.map_or(0, |m| m + 1), "material at ({x}, {y})");

    // Vertices are rounded to 1/256 pixel, which on steep faces is a difference in depth.
    let ray = eye.ray_at(x, y);
    let plane = triangle.outward.normalize();
    let slope = ray.direction.length() / plane.dot(ray.direction).abs();
    let allowed = 2e-5 * hit.distance + eye.footprint(hit.distance) * slope / 128.0;
    let depth = f64::from(picture.depth(x, y));
    let error = (depth - hit.distance).abs();
    assert!(error < allowed, "({x}, {y}): {depth} m, not {} (± {allowed})", hit.distance);

    let facing = if triangle.faces(eye) { 1.0 } else { -1.0 };
    let normal = facing * hit.normal(triangles);
    let drawn = picture.normal(x, y).as_dvec3();
    // Half floats have steps of 1/2048 near 1; rounded places turn interpolated normals a little.
    assert!((drawn - normal).length() < 4e-3, "({x}, {y}): normal {drawn}, not {normal}");
}

fn views() -> [View; 2] {
    [ortho_view([160, 120], 3.0), perspective_view([160, 120], 35.0, 5.0)]
}

#[test]
fn transforms_scale_turn_and_mirror() {
    let mut scene = Builder::new();
    let red = scene.colored("red", [1.0, 0.0, 0.0]);
    let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.4, 0.2);
    let squeeze = Vec3::new(0.5, 1.4, 0.8);
    let ball = || shapes::uv_sphere(24, 12, 0.45);
    let cube = || shapes::cuboid(Vec3::splat(0.7));
    scene.object("scaled", ball(), Some(red), parts(Vec3::new(-1.2, 0.5, 0.0), turn, squeeze));
    let mirror = Vec3::new(-0.9, 1.1, 1.0);
    scene.object("mirrored", cube(), None, parts(Vec3::new(0.0, 0.6, 0.2), turn, mirror));
    let all_ways = Vec3::new(-1.0, -0.7, -1.2);
    scene.object("turned over", ball(), None, parts(Vec3::new(1.2, 0.5, 0.0), turn, all_ways));
    // A mirrored parent, and a parent squeezed across its child's turn: the child is sheared.
    let shear = parts(Vec3::new(0.0, -0.6, 0.0), Quat::IDENTITY, Vec3::new(-1.6, 0.6, 1.0));
    let parent = scene.node(Node { transform: shear, ..Node::default() });
    let mesh = Some(scene.mesh(cube()));
    let child =
        scene.node(Node { mesh, transform: parts(Vec3::ZERO, turn, Vec3::ONE), ..Node::default() });
    let raw = scene.raw();
    raw.roots.retain(|&root| root != child);
    raw.nodes[parent].children.push(child);
    raw.nodes[child].parent = Some(parent);
    let scene = scene.build();
    for view in views() {
        assert_drawn_as_computed(&scene, &Pose::rest(&scene), &view);
    }
}

/// A ball bent by two joints and swollen by two morph targets.
fn bent_ball() -> Scene {
    let ball = shapes::uv_sphere(24, 16, 1.0);
    let upper: Vec<f32> =
        ball.positions.iter().map(|p| (0.5 + 0.5 * p.y).clamp(0.0, 1.0)).collect();
    let bulge = |axis: Vec3| MorphTarget {
        positions: ball.positions.iter().map(|p| 0.3 * p.dot(axis).max(0.0) * axis).collect(),
        normals: ball.positions.iter().map(|p| -0.2 * (*p - p.dot(axis) * axis)).collect(),
    };
    let primitive = Primitive {
        joints: vec![[0, 1, 0, 0]; ball.positions.len()],
        weights: upper.iter().map(|&w| [1.0 - w, w, 0.0, 0.0]).collect(),
        morph_targets: vec![bulge(Vec3::X), bulge(Vec3::new(0.0, 0.6, 0.8))],
        ..ball
    };
    let mut scene = Builder::new();
    let lower_joint = scene.node(Node { transform: moved(0.0, -0.5, 0.0), ..Node::default() });
    let bend = Quat::from_rotation_z(0.6) * Quat::from_rotation_x(-0.3);
    let transform = parts(Vec3::new(0.2, 0.5, 0.0), bend, Vec3::new(1.0, 0.8, 1.1));
    let upper_joint = scene.node(Node { transform, ..Node::default() });
    let mesh = Some(scene.mesh(primitive));
    // A skinned mesh ignores its own node's transform.
    let node = scene.node(Node {
        mesh,
        skin: Some(0),
        transform: moved(5.0, 5.0, 5.0),
        ..Node::default()
    });
    let raw = scene.raw();
    raw.meshes[0].morph_weights = vec![0.7, -0.4];
    raw.nodes[node].morph_weights = vec![1.2, 0.5];
    let joint_from_mesh = [0.5, -0.5].map(|y| Affine3A::from_translation(Vec3::Y * y)).to_vec();
    raw.skins.push(Skin {
        joints: vec![lower_joint, upper_joint],
        joint_from_mesh,
        ..Skin::default()
    });
    scene.build()
}

#[test]
fn skins_and_morph_targets_bend() {
    let scene = bent_ball();
    let mut pose = Pose::rest(&scene);
    for view in views() {
        assert_drawn_as_computed(&scene, &pose, &view);
    }
    // Another pose of the same scene, with a mirrored joint.
    pose.world_from_node[1] =
        Affine3A::from_translation(Vec3::Y * 0.4) * Affine3A::from_rotation_y(0.9);
    pose.morph_weights[2] = vec![-0.3, 0.9];
    assert_drawn_as_computed(&scene, &pose, &views()[1]);
}

#[test]
fn a_mirrored_skin_is_not_inside_out() {
    let scene = bent_ball();
    let mut pose = Pose::rest(&scene);
    let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    for joint in 0..2 {
        pose.world_from_node[joint] = mirror * pose.world_from_node[joint];
    }
    assert_drawn_as_computed(&scene, &pose, &views()[1]);
}

#[test]
fn double_sided_faces_show_both_sides() {
    let mut scene = Builder::new();
    let sheet = scene.material(genga::scene::Material { double_sided: true, ..Default::default() });
    let away = parts(Vec3::new(-0.7, 0.0, 0.0), Quat::from_rotation_y(2.6), Vec3::ONE);
    scene.object("both sides", shapes::plane(glam::Vec2::ONE), Some(sheet), away);
    let away = parts(Vec3::new(0.7, 0.0, 0.0), Quat::from_rotation_y(2.6), Vec3::ONE);
    scene.object("one side", shapes::plane(glam::Vec2::ONE), None, away);
    let mirrored =
        parts(Vec3::new(0.7, 0.9, 0.0), Quat::from_rotation_y(2.6), Vec3::new(1.0, 0.6, -1.0));
    scene.object("mirrored", shapes::plane(glam::Vec2::ONE), None, mirrored);
    let scene = scene.build();
    for view in views() {
        assert_drawn_as_computed(&scene, &Pose::rest(&scene), &view);
    }
}

#[test]
fn depth_is_metres_along_the_axis() {
    // A wall 4 m away is 4 m away in its corners as well.
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(glam::Vec2::splat(8.0)), None, Transform::default());
    let scene = scene.build();
    let view = perspective_view([64, 48], 60.0, 4.0);
    let plain = style("[lines]\nmethod = \"none\"");
    let picture = draw_posed(&scene, &Pose::rest(&scene), &plain, &view, &[LayerKind::Depth]);
    for (x, y) in picture.places() {
        assert!((picture.depth(x, y) - 4.0).abs() < 1e-5, "{} at ({x}, {y})", picture.depth(x, y));
    }
}
