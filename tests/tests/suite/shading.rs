//! Normals, biases and face shadows for shading alone, against formulas in f64.

use std::sync::Arc;

use genga::render::{LayerKind, Picture, View};
use genga::scene::{
    FaceShadow, LightKind, Material, Mesh, Node, Pose, Primitive, Proxy, ProxyMesh, Scene, Shading,
    Transform,
};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{Builder, image, light, ortho_view, style};
use genga_tests::{Eye, Pixels, draw, draw_layers};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3, Vec4};

const FROM: Vec3 = Vec3::new(-0.5, 0.6, 1.0);

/// T as a grey.
fn greys(rest: &str) -> Style {
    style(&format!(
        "{rest}\n[lines]\nmethod = \"none\"\n[paint.ramp]\nsmooth = true\n\
         stops = [{{ at = 0, color = \"#000\" }}, {{ at = 1, color = \"#fff\" }}]"
    ))
}

fn view() -> View {
    View { supersample: 1, ..ortho_view([96; 2], 2.0) }
}

fn assert_grey(picture: &Picture, x: u32, y: u32, wanted: f64, within: f64) {
    let found = f64::from(picture.at(x, y)[0]);
    let wanted = 255.0 * wanted.clamp(0.0, 1.0);
    assert!((found - wanted).abs() <= within, "pixel {x}, {y}: {found}, not {wanted}");
}

#[test]
fn normals_of_a_proxy_blend_with_the_surfaces_own() {
    let normal = Vec3::new(0.3, 0.2, 0.9).normalize();
    for amount in [0.0, 0.5, 1.0] {
        let mut scene = Builder::new();
        scene.object("ball", shapes::uv_sphere(256, 128, 0.9), None, Transform::default());
        scene.light(light(LightKind::Directional, 1.0), FROM);
        let proxy = Some(Proxy::Plane { center: Vec3::ZERO, normal });
        scene.raw().shadings = vec![Shading { proxy, amount, ..Shading::default() }];
        let picture = draw(&scene.build(), &greys(""), &view());
        let eye = Eye::new(&view());
        let l = FROM.as_dvec3().normalize();
        for (x, y) in [(48, 48), (30, 40), (60, 30), (50, 75), (20, 48)] {
            let ray = eye.ray_at(x, y);
            let t = ray.meets_sphere(DVec3::ZERO, 0.9).expect("the ball is there");
            let own = ray.point(t) / 0.9;
            let blended = own.lerp(normal.as_dvec3(), f64::from(amount)).normalize();
            assert_grey(&picture, x, y, 0.5 + 0.5 * blended.dot(l), 1.5);
        }
    }
}

#[test]
fn a_proxy_turns_with_its_node_and_leaves_lines_alone() {
    let mut scene = Builder::new();
    scene.object("ball", shapes::uv_sphere(48, 24, 0.9), None, Transform::default());
    scene.light(light(LightKind::Directional, 1.0), FROM);
    let turn = Transform::Parts {
        translation: Vec3::ZERO,
        rotation: Quat::from_rotation_y(0.7),
        scale: Vec3::ONE,
    };
    let node = scene.node(Node { name: "head".to_owned(), transform: turn, ..Node::default() });
    let mut plain = scene.clone().build();
    plain.shadings.clear();
    let proxy = Some(Proxy::Plane { center: Vec3::ZERO, normal: Vec3::Z });
    scene.raw().shadings =
        vec![Shading { node: Some(node), proxy, amount: 1.0, ..Shading::default() }];
    let scene = scene.build();
    let kinds = [LayerKind::Normal];
    let [with, without] =
        [&scene, &plain].map(|scene| draw_layers(scene, &greys(""), &view(), &kinds));
    let wanted = (Quat::from_rotation_y(0.7) * Vec3::Z).dot(FROM.normalize());
    assert_grey(&with, 48, 48, 0.5 + 0.5 * f64::from(wanted), 1.5);
    assert_eq!(with.floats(LayerKind::Normal), without.floats(LayerKind::Normal));
}

#[test]
fn the_normals_of_a_mesh_stand_in_for_the_surfaces_own() {
    // A box that is shaded as a ball, in a node that is turned, moved and stretched.
    let rotation = Quat::from_rotation_y(0.6) * Quat::from_rotation_x(0.4);
    let transform = Transform::Parts {
        translation: Vec3::new(0.1, -0.05, 0.0),
        rotation,
        scale: Vec3::new(1.0, 1.5, 0.8),
    };
    let mut scene = Builder::new();
    let frame = scene.node(Node { name: "frame".to_owned(), transform, ..Node::default() });
    scene.object("box", shapes::cuboid(Vec3::splat(0.9)), None, transform);
    scene.light(light(LightKind::Directional, 1.0), FROM);
    let ball = shapes::uv_sphere(64, 32, 0.7);
    let ball = Mesh { primitives: vec![ball], ..Mesh::default() };
    let mesh = Arc::new(ProxyMesh::from_mesh(&ball, &Affine3A::IDENTITY));
    let proxies = [
        Proxy::Mesh { center: Vec3::ZERO, mesh },
        Proxy::Ellipsoid { center: Vec3::ZERO, radii: Vec3::ONE, rotation: Quat::IDENTITY },
    ];
    let [by_mesh, by_formula] = proxies.map(|proxy| {
        let mut scene = scene.clone();
        let shading =
            Shading { node: Some(frame), proxy: Some(proxy), amount: 1.0, ..Shading::default() };
        scene.raw().shadings = vec![shading];
        draw(&scene.build(), &greys(""), &view())
    });
    let (mut seen, mut least, mut most) = (0, 255, 0);
    for (x, y) in by_mesh.places() {
        let (a, b) = (by_mesh.at(x, y), by_formula.at(x, y));
        if a[3] == 255 && a != [255; 4] {
            seen += 1;
            (least, most) = (least.min(b[0]), most.max(b[0]));
            assert!(a[0].abs_diff(b[0]) <= 3, "({x}, {y}): {a:?}, not {b:?}");
        }
    }
    assert!(seen > 1000 && most - least > 60, "{seen} pixels, from {least} to {most}");
}

/// A wall from −1 to 1 that faces the light.
fn wall(change: impl FnOnce(&mut Primitive)) -> Scene {
    let mut scene = Builder::new();
    let mut plane = shapes::plane(Vec2::splat(2.0));
    change(&mut plane);
    let material = Material { name: "wall".to_owned(), ..Material::default() };
    let material = scene.material(material);
    scene.object("wall", plane, Some(material), Transform::default());
    // T is 0.75.
    scene.light(light(LightKind::Directional, 1.0), Vec3::new(0.0, 3_f32.sqrt(), 1.0));
    scene.build()
}

/// The part of the way from left to right of a pixel's middle.
fn across(x: u32) -> f64 {
    (f64::from(x) + 0.5) / 96.0
}

#[test]
fn a_bias_at_vertices_moves_t() {
    let scene = wall(|plane| {
        plane.shade_biases = plane.positions.iter().map(|p| 0.2 * p.x).collect();
    });
    let picture = draw(&scene, &greys(""), &view());
    for x in [5, 30, 48, 70, 90] {
        assert_grey(&picture, x, 40, 0.75 + 0.2 * (2.0 * across(x) - 1.0), 1.5);
    }
}

#[test]
fn a_channel_of_the_vertex_colour_can_be_a_bias() {
    let scene = wall(|plane| {
        let alpha = |p: &Vec3| Vec4::new(1.0, 1.0, 1.0, 0.5 + 0.5 * p.x);
        plane.colors = plane.positions.iter().map(alpha).collect();
    });
    let style = greys("[paint]\nshade_map = { from = \"vertex-alpha\", strength = 0.2 }");
    let picture = draw(&scene, &style, &view());
    for x in [5, 30, 48, 70, 90] {
        assert_grey(&picture, x, 40, 0.75 + 0.2 * (2.0 * across(x) - 1.0), 1.5);
    }
}

#[test]
fn a_picture_can_be_a_bias() {
    let mut style = greys("[paint]\nshade_map = { strength = -0.2 }");
    let map = style.paint.shade_map.as_mut().expect("the style has one");
    map.image = Some(Arc::new(image(4, 1, |x, _| [[0, 0, 255, 255][x as usize]; 4])));
    let picture = draw(&wall(|_| ()), &style, &view());
    assert_grey(&picture, 20, 40, 0.95, 1.5);
    assert_grey(&picture, 76, 40, 0.55, 1.5);
}

#[test]
fn a_face_shadow_follows_the_light_and_is_mirrored() {
    // The picture is darker to the left: with light from the right, the left goes dark first.
    let drawn = Arc::new(image(256, 1, |x, _| [x as u8; 4]));
    for (yaw, mirror_u) in
        [(45_f32, Some(0.5)), (-45.0, Some(0.5)), (100.0, Some(0.5)), (-30.0, None)]
    {
        let mut scene = Builder::new();
        let plane = shapes::plane(Vec2::splat(2.0));
        scene.object("face", plane, None, Transform::default());
        let (sin, cos) = yaw.to_radians().sin_cos();
        scene.light(light(LightKind::Directional, 1.0), Vec3::new(sin, 0.4, cos));
        let face_shadow = Some(FaceShadow { image: Arc::clone(&drawn), mirror_u });
        scene.raw().shadings = vec![Shading { face_shadow, ..Shading::default() }];
        let picture = draw(&scene.build(), &greys(""), &view());
        for x in [5, 30, 48, 70, 90] {
            let is_mirrored = yaw < 0.0 && mirror_u.is_some();
            let m = if is_mirrored { 1.0 - across(x) } else { across(x) };
            let term = 2.0 * (m - f64::from(yaw.abs()) / 180.0);
            assert_grey(&picture, x, 40, 0.5 + 0.5 * term.clamp(-1.0, 1.0), 2.0);
        }
    }
}

#[test]
fn a_shading_of_no_use_is_said() {
    let mut scene = wall(|_| ());
    scene.shadings = vec![Shading {
        materials: genga::style::Globs::new(["skin"]).expect("a glob"),
        ..Shading::default()
    }];
    let shared = genga_tests::shared();
    let _turn = shared.turn();
    let prepared = shared.renderer.prepare(&scene, &greys("")).expect("it can be drawn");
    let warned = prepared.warnings().iter().any(|w| w.contains("shading 0 (proxy) lies on no"));
    assert!(warned, "{:?}", prepared.warnings());
    assert_eq!(scene.bounds(&Pose::rest(&scene)), prepared.bounds());
    scene.shadings[0].amount = 2.0;
    let error = scene.validate().expect_err("amounts end at 1").to_string();
    assert_eq!(error, "shading 0 has an amount outside of 0 to 1");
}
