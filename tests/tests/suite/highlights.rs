//! Where highlights stand, against f64: their keys, their pixels, and the way between keys.

use genga::render::{LayerKind, View, ViewCamera};
use genga::scene::{
    BuiltInDrawing, Drawing, FreeKey, Highlight, HighlightFrame, KeyInterpolation, Moment, Placed,
    Placement, Pose, Proxy, Scene, direction_of,
};
use genga::shapes;
use genga_tests::highlight_proofs::placement_errors;
use genga_tests::highlights::{
    Random, bare_style, drawing_coordinates, free_place, lit_scene, put_everywhere,
};
use genga_tests::{Eye, Pixels, draw_layers, ortho_view, perspective_view};
use glam::{Affine3A, DVec2, DVec3, Quat, Vec2, Vec3};

/// Pixels round a panorama 2048 pixels wide.
const PIXEL: f64 = std::f64::consts::TAU / 2048.0;

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

#[test]
fn placement_is_that_of_the_formulas_within_half_a_pixel_of_the_panorama() {
    let worst = placement_errors(10_000, 7);
    assert!(worst.iter().all(|&px| px <= 0.5), "{worst:?} pixels");
    // What blends beside the place.
    let mut random = Random(13);
    for _ in 0..1000 {
        let (moment, free) = (random.moment(), random.free_keys(5));
        let expected = free_place(&free, &moment);
        let placed = Placement::Free(free).evaluate(&moment);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-5, "{placed:?}, {expected:?}");
        close(placed.rotation, expected.rotation);
        close(placed.square, expected.square);
        for k in 0..2 {
            close(placed.scale[k], expected.scale[k]);
            close(placed.split[k], expected.split[k]);
        }
    }
}

#[test]
fn at_its_key_a_drawing_is_where_the_key_says() {
    let mut random = Random(11);
    for _ in 0..500 {
        let mut free = random.free_keys(6);
        let (at, wanted) = (random.moment(), random.direction());
        let mut put = Placement::Free(free.clone());
        put.put(&at, wanted).expect("free placement has no limits");
        let off = angle(put.evaluate(&at).middle(), wanted.as_dvec3()) / PIXEL;
        assert!(off <= 0.5, "{off} pixels");
        for key in free.keys.clone() {
            let at = Moment { light: key.light, view: key.view };
            let placed = Placement::Free(free.clone()).evaluate(&at);
            let away = angle(placed.middle(), key.light.as_dvec3());
            assert!((away - f64::from(key.offset.length())).abs() < 0.5 * PIXEL);
            assert!((placed.rotation - f64::from(key.rotation)).abs() < 1e-6);
        }
        free.keys.clear();
        let mut panorama = Placement::Panorama(random.panorama_keys(4));
        panorama.put(&at, wanted).expect("the panorama has no limits");
        let off = angle(panorama.evaluate(&at).middle(), wanted.as_dvec3()) / PIXEL;
        assert!(off <= 0.5, "{off} pixels on the panorama");
    }
}

/// The largest way of a drawing's middle and of its right end from step to step, as angles.
fn largest_move(placement: &Placement, path: &dyn Fn(f64) -> Moment, steps: usize) -> f64 {
    let at = |i: usize| -> Placed { placement.evaluate(&path(i as f64 / steps as f64)) };
    let middle = |placed: &Placed| placed.middle();
    (0..steps).map(|i| angle(middle(&at(i)), middle(&at(i + 1)))).fold(0.0, f64::max)
}

#[test]
fn half_the_step_of_the_light_is_half_the_largest_move_of_the_drawing() {
    let mut random = Random(5);
    // Over the top of the head, down the back and up again: across both poles.
    let over_the_poles = |u: f64| {
        let a = u * std::f64::consts::TAU;
        let light = DVec3::new(0.0, a.sin(), a.cos()).as_vec3();
        Moment { light, view: Vec3::new(0.2, 0.1, 1.0).normalize() }
    };
    // Round the head: across the sides of the panorama.
    let round = |u: f64| {
        let yaw = (u * std::f64::consts::TAU) as f32;
        Moment { light: direction_of(yaw, -0.4), view: direction_of(0.3, 0.1) }
    };
    let smooth = |mut placement: genga::scene::FreePlacement| {
        for key in &mut placement.keys {
            key.interpolation = KeyInterpolation::Smooth;
        }
        Placement::Free(placement)
    };
    let moving = |mut placement: genga::scene::PanoramaPlacement| {
        for i in 0..placement.yaw_keys().len() {
            let key = placement.yaw_keys()[i];
            let interpolation = KeyInterpolation::Smooth;
            placement.set_yaw_key(genga::scene::AngleKey { interpolation, ..key });
        }
        for i in 0..placement.pitch_keys().len() {
            let key = placement.pitch_keys()[i];
            let interpolation = KeyInterpolation::Linear;
            placement.set_pitch_key(genga::scene::AngleKey { interpolation, ..key });
        }
        Placement::Panorama(placement)
    };
    let halves = |placement: &Placement, path: &dyn Fn(f64) -> Moment, what: &str| {
        // Fine enough for keys that happen to stand close to each other.
        let (coarse, fine) =
            (largest_move(placement, path, 8000), largest_move(placement, path, 16_000));
        assert!(fine < 0.55 * coarse + 1e-7, "{what}: {coarse} and {fine}: {placement:?}");
    };
    for _ in 0..12 {
        let free = smooth(random.free_keys(5));
        halves(&free, &over_the_poles, "free, over the poles");
        halves(&free, &round, "free, round");
        halves(&moving(random.panorama_keys(5)), &round, "panorama, round");
    }
}

/// A drawing of that kind with all that keys can do to it.
fn keyed(placement: Placement) -> Highlight {
    Highlight {
        drawing: Drawing::BuiltIn(BuiltInDrawing::Star),
        size: Vec2::new(1.2, 0.9),
        angle: 0.4,
        placement,
        ..Highlight::default()
    }
}

/// Compares the coordinates of every pixel of a ball with f64.
fn assert_coordinates(scene: &Scene, view: &View, from: Vec3, what: &str) {
    let view = &View { supersample: 1, ..*view };
    let layers = [LayerKind::HighlightUv, LayerKind::Ids];
    let picture = draw_layers(scene, &bare_style(), view, &layers);
    let uv = picture.floats(LayerKind::HighlightUv);
    let highlight = &scene.highlights[0];
    let eye = Eye::new(view);
    let frame = HighlightFrame::new(highlight, &Affine3A::IDENTITY);
    let moment = frame.moment(from, view.camera.to_eye(Vec3::ZERO));
    let expected = |x: f64, y: f64| -> Option<DVec2> {
        let ray = eye.ray(DVec2::new(x, y));
        let p = ray.point(ray.meets_sphere(DVec3::ZERO, 1.0)?);
        let (n, e) = (p.normalize(), eye.towards(p).normalize());
        Some(drawing_coordinates(highlight, &moment, 2.0 * n.dot(e) * n - e))
    };
    let inside = |x: u32, y: u32| {
        let near = (x - 2..=x + 2).flat_map(|x| (y - 2..=y + 2).map(move |y| (x, y)));
        near.into_iter().all(|(x, y)| picture.ids(x, y)[0] == 1)
    };
    let (mut compared, mut worst) = (0, 0.0_f64);
    for y in 2..view.size[1] - 2 {
        for x in 2..view.size[0] - 2 {
            if !inside(x, y) {
                continue;
            }
            let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let at = |dx: f64, dy: f64| expected(px + dx, py + dy).expect("inside of the ball");
            let here = at(0.0, 0.0);
            // What half a pixel to any side changes.
            let sides = [(-0.5, 0.0), (0.5, 0.0), (0.0, -0.5), (0.0, 0.5)];
            let half_pixel =
                sides.iter().map(|&(dx, dy)| at(dx, dy).distance(here)).fold(0.0, f64::max);
            let i = 3 * (y * view.size[0] + x) as usize;
            let found = DVec2::new(f64::from(uv[i]), f64::from(uv[i + 1]));
            // The layer holds half floats: eleven bits.
            let off = (found.distance(here) - here.length() / 2048.0).max(0.0);
            worst = worst.max(off / half_pixel);
            compared += 1;
        }
    }
    assert!(compared > 6000, "{what}: only {compared} pixels were compared");
    assert!(worst <= 1.0, "{what}: {worst} times half a pixel");
}

#[test]
fn every_pixel_of_a_ball_lies_where_f64_says_on_the_drawing() {
    let from = Vec3::new(0.5, 0.6, 1.0);
    let moment =
        |view: &View| Moment { light: from.normalize(), view: view.camera.to_eye(Vec3::ZERO) };
    let mut random = Random(3);
    let views = [perspective_view([128, 112], 30.0, 4.4), ortho_view([128, 112], 2.3)];
    for view in views {
        let mut free = random.free_keys(4);
        free.keys.iter_mut().for_each(|key| key.split = Vec2::new(0.3, 0.2));
        free.set_key(FreeKey {
            offset: Vec2::new(-0.2, 0.3),
            rotation: 0.7,
            scale: Vec2::new(1.5, 0.8),
            square: 0.8,
            ..FreeKey::at(&moment(&view))
        });
        let panorama = random.panorama_keys(4);
        for placement in [
            Placement::Free(genga::scene::FreePlacement::default()),
            Placement::Free(free),
            Placement::Panorama(genga::scene::PanoramaPlacement::default()),
            Placement::Panorama(panorama),
        ] {
            let what = format!("{placement:?}");
            let ball = shapes::uv_sphere(512, 256, 1.0);
            let scene = lit_scene(ball, from, vec![keyed(placement)]);
            assert_coordinates(&scene, &view, from, &what);
        }
    }
}

#[test]
fn a_highlight_put_at_a_pixel_lands_there() {
    let view = perspective_view([96, 96], 30.0, 4.4);
    let from = Vec3::new(-0.6, 0.8, 0.7);
    let ball = shapes::uv_sphere(256, 128, 1.0);
    for placement in [
        Placement::Free(genga::scene::FreePlacement::default()),
        Placement::Panorama(genga::scene::PanoramaPlacement::default()),
    ] {
        let scene = lit_scene(ball.clone(), from, vec![keyed(placement)]);
        let found = put_everywhere(&scene, &view, 25, 17);
        assert!(found.tried == 25 && found.worst_px <= 1.0, "{found:?}");
    }
}

#[test]
fn a_highlight_is_put_only_where_it_can_lie() {
    let shared = genga_tests::shared();
    let view = ortho_view([64, 64], 4.0);
    let skin = genga::style::Globs::new(["hair"]).expect("a glob");
    let highlight = Highlight { materials: skin, ..Highlight::default() };
    let scene = lit_scene(shapes::uv_sphere(32, 16, 1.0), Vec3::Z, vec![highlight]);
    let _turn = shared.turn();
    let mut prepared = shared.renderer.prepare(&scene, &bare_style()).expect("a scene");
    let warnings = prepared.warnings().join("\n");
    assert!(warnings.contains("highlight 0") && warnings.contains("no surface"), "{warnings}");
    let pose = Pose::rest(&scene);
    let mut put = |index: usize, x: f32| {
        let pixel = Vec2::new(x, 32.0);
        let put = prepared.put_highlight(index, &scene, &pose, &view, pixel);
        put.expect_err("it cannot lie there").to_string()
    };
    assert!(put(0, 2.0).contains("no surface"));
    assert!(put(0, 32.0).contains("not drawn on the surface"));
    assert!(put(9, 32.0).contains("no highlight 9"));
}

#[test]
fn several_highlights_with_proxies_of_their_own_do_not_disturb_each_other() {
    let from = Vec3::new(0.4, 0.5, 1.0);
    let kinds = [
        Proxy::Sphere { center: Vec3::new(0.1, 0.0, 0.0) },
        Proxy::Ellipsoid {
            center: Vec3::ZERO,
            radii: Vec3::new(1.0, 2.0, 1.5),
            rotation: Quat::from_rotation_x(0.4),
        },
        Proxy::Capsule { from: Vec3::NEG_Y * 0.4, to: Vec3::Y * 0.5 },
        Proxy::Plane { center: Vec3::ZERO, normal: Vec3::new(0.1, 0.2, 1.0) },
    ];
    let highlights: Vec<Highlight> =
        kinds.into_iter().map(|proxy| Highlight { proxy, ..Highlight::default() }).collect();
    let view = View { supersample: 1, ..perspective_view([64, 64], 30.0, 4.4) };
    let coordinates = |highlights: Vec<Highlight>| {
        let scene = lit_scene(shapes::uv_sphere(64, 32, 1.0), from, highlights);
        let picture = draw_layers(&scene, &bare_style(), &view, &[LayerKind::HighlightUv]);
        picture.floats(LayerKind::HighlightUv).to_vec()
    };
    for i in 0..highlights.len() {
        // The layer shows the first one: alone, and before all others.
        let alone = coordinates(vec![highlights[i].clone()]);
        let mut turned = highlights.clone();
        turned.rotate_left(i);
        let among = coordinates(turned);
        let worst = alone.iter().zip(&among).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-2, "proxy {i}: {worst}");
        assert!(alone.iter().any(|&value| value != 0.0));
    }
}

#[test]
fn a_camera_given_by_hand_looks_through_the_right_pixels() {
    for view in [perspective_view([90, 60], 40.0, 5.0), ortho_view([90, 60], 2.0)] {
        let camera = ViewCamera {
            world_from_camera: Affine3A::from_rotation_y(0.4) * view.camera.world_from_camera,
            ..view.camera
        };
        let view = View { camera, ..view };
        let eye = Eye::new(&view);
        for pixel in [Vec2::new(3.5, 50.0), Vec2::new(45.0, 30.0)] {
            let [origin, direction] = view.ray(pixel);
            let point = origin + direction * 4.0;
            let back = eye.project(point.as_dvec3()).as_vec2();
            assert!(back.distance(pixel) < 1e-3, "{back}");
        }
    }
}
