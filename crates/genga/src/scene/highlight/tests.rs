//! Keys by hand, distance fields against exact distances, and bad input. The comparison with f64
//! formulas and pictures is in the workspace's `tests`.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3};

use super::*;
use crate::scene::{Mesh, Node, Primitive, Scene};

fn moment(light: Vec3, view: Vec3) -> Moment {
    Moment { light: light.normalize(), view: view.normalize() }
}

fn angle_key(at: f32, place: f32, interpolation: KeyInterpolation) -> AngleKey {
    AngleKey { at, place, interpolation }
}

#[test]
fn angles_are_rotations_about_x_then_y_from_plus_z() {
    for (yaw, pitch) in [(0.0, 0.0), (1.0, 0.5), (-2.5, -1.2), (3.0, 1.5)] {
        let turned = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(pitch) * Vec3::Z;
        assert!(turned.distance(direction_of(yaw, pitch)) < 1e-6);
        let back = yaw_pitch(turned);
        assert!((back[0] - yaw).abs() < 1e-5 && (back[1] - pitch).abs() < 1e-5, "{back:?}");
    }
    assert_eq!(yaw_pitch(Vec3::NEG_Y), [0.0, FRAC_PI_2]);
    assert_eq!(yaw_pitch(Vec3::NAN), [0.0, 0.0]);
}

#[test]
fn without_keys_the_drawing_stands_at_the_mirror_direction() {
    let moment = moment(Vec3::new(1.0, 2.0, -0.5), Vec3::new(-1.0, 0.3, 2.0));
    for placement in [
        Placement::Free(FreePlacement::default()),
        Placement::Panorama(PanoramaPlacement::default()),
    ] {
        let placed = placement.evaluate(&moment);
        assert!(placed.middle().distance(moment.light.as_dvec3()) < 1e-6, "{placement:?}");
        assert_eq!(placed.opacity, 1.0);
    }
}

#[test]
fn the_panorama_goes_round_the_nearest_way_between_its_last_and_first_key() {
    let mut panorama = PanoramaPlacement::default();
    panorama.set_yaw_key(angle_key(-2.5, -2.9, KeyInterpolation::Linear));
    panorama.set_yaw_key(angle_key(2.5, 2.9, KeyInterpolation::Linear));
    // Half way round the back from 2.9 to 2π − 2.9.
    let back = Moment { light: direction_of(PI, 0.0), view: Vec3::Z };
    let [yaw, _] = panorama.evaluate(&back).panorama.expect("a panorama");
    assert!((yaw.abs() - std::f64::consts::PI).abs() < 1e-5, "{yaw}");
    // And through 0 in front.
    let front = Moment { light: Vec3::Z, view: Vec3::Z };
    let [yaw, _] = panorama.evaluate(&front).panorama.expect("a panorama");
    assert!(yaw.abs() < 1e-5, "{yaw}");
}

#[test]
fn keys_of_a_panorama_are_added_moved_and_removed() {
    let mut panorama = PanoramaPlacement::default();
    for at in [1.0, -1.0, 0.0, 1.0 + 2.0 * PI] {
        panorama.set_yaw_key(angle_key(at, at, KeyInterpolation::Hold));
    }
    // The last one is the same angle as the first.
    let ats = |p: &PanoramaPlacement| p.yaw_keys().iter().map(|k| k.at).collect::<Vec<_>>();
    assert_eq!(panorama.yaw_keys().len(), 3);
    assert!((panorama.yaw_keys()[2].place - (1.0 + 2.0 * PI)).abs() < 1e-6);
    assert!(panorama.move_yaw_key(0, 0.5) && !panorama.move_yaw_key(3, 0.0));
    assert!(ats(&panorama).is_sorted() && (ats(&panorama)[1] - 0.5).abs() < 1e-6);
    assert_eq!(panorama.remove_yaw_key(0).map(|key| key.place), Some(0.0));
    assert_eq!(panorama.remove_yaw_key(9), None);
    panorama.set_pitch_key(angle_key(0.2, 0.1, KeyInterpolation::Smooth));
    assert!(panorama.move_pitch_key(0, 0.3) && panorama.pitch_keys()[0].at == 0.3);
    assert!(panorama.remove_pitch_key(0).is_some() && panorama.pitch_keys().is_empty());
}

#[test]
fn smooth_keys_do_not_overshoot_and_have_no_bend() {
    let mut panorama = PanoramaPlacement::default();
    let keys = [(-1.2_f32, -0.4_f32), (-0.5, -0.3), (0.1, 0.5), (0.9, 0.6), (1.4, 0.2)];
    for (at, place) in keys {
        panorama.set_pitch_key(angle_key(at, place, KeyInterpolation::Smooth));
    }
    let at = |pitch: f64| {
        let moment = Moment { light: direction_of(0.0, pitch as f32), view: Vec3::Z };
        panorama.evaluate(&moment).panorama.expect("a panorama")[1]
    };
    for pair in keys.windows(2) {
        let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
        for i in 0..=20 {
            let u = i as f32 / 20.0;
            let y = at(f64::from(pair[0].0 + (pair[1].0 - pair[0].0) * u)) as f32;
            assert!(y >= low - 1e-4 && y <= high + 1e-4, "{y} is not in {low} to {high}");
        }
    }
    let slope = |from: f64, to: f64| (at(to) - at(from)) / (to - from);
    let (before, after) = (slope(0.098, 0.1), slope(0.1, 0.102));
    assert!((before - after).abs() < 0.05, "{before} and {after}");
}

#[test]
fn free_keys_hold_exactly_and_a_range_hides() {
    let mut free = FreePlacement::default();
    let front = moment(Vec3::new(0.3, 0.5, 1.0), Vec3::Z);
    let side = moment(Vec3::X, Vec3::new(1.0, 0.0, 1.0));
    let key = FreeKey {
        offset: Vec2::new(0.2, 0.1),
        rotation: 1.0,
        scale: Vec2::new(2.0, 0.5),
        light_range: Some(0.3),
        ..FreeKey::at(&front)
    };
    free.set_key(key);
    free.set_key(FreeKey { light_range: Some(0.3), ..FreeKey::at(&side) });
    let placed = free.evaluate(&front);
    assert_eq!((placed.rotation, placed.scale, placed.opacity), (1.0, [2.0, 0.5], 1.0));
    let offset = placed.middle().angle_between(front.light.as_dvec3());
    assert!((offset - 0.05_f64.sqrt()).abs() < 1e-6, "{offset}");
    assert!(free.evaluate(&side).middle().distance(side.light.as_dvec3()) < 1e-9);
    assert_eq!(free.evaluate(&moment(Vec3::NEG_Z, Vec3::Z)).opacity, 0.0);
    assert_eq!(free.key_at(&front), Some(0));
    assert!(free.move_key(0, &side) && free.keys.len() == 1 && !free.move_key(1, &side));
    assert_eq!(free.remove_key(0).map(|key| key.rotation), Some(1.0));
    assert_eq!(free.remove_key(0), None);
}

#[test]
fn a_level_drawing_stays_upright_all_round() {
    for yaw in 0..36 {
        let light = direction_of(yaw as f32 * 0.175, -0.6);
        let level = FreePlacement { level: true, ..FreePlacement::default() };
        let placed = level.evaluate(&moment(light, Vec3::Z));
        assert!(placed.axes.x_axis.y.abs() < 1e-9 && placed.axes.y_axis.y > 0.5);
        assert!(placed.axes.x_axis.cross(placed.axes.y_axis).distance(placed.middle()) < 1e-9);
    }
}

#[test]
fn a_held_key_is_alone_in_its_neighbourhood() {
    let mut free = FreePlacement::default();
    let front = moment(Vec3::Z, Vec3::Z);
    let hold = KeyInterpolation::Hold;
    free.set_key(FreeKey { rotation: 1.0, interpolation: hold, ..FreeKey::at(&front) });
    free.set_key(FreeKey { rotation: 3.0, ..FreeKey::at(&moment(Vec3::NEG_Z, Vec3::Z)) });
    assert_eq!(free.evaluate(&moment(Vec3::new(0.9, 0.0, 1.0), Vec3::Z)).rotation, 1.0);
    let beyond = free.evaluate(&moment(Vec3::new(0.9, 0.0, -1.0), Vec3::Z)).rotation;
    assert!(beyond > 2.0 && beyond < 3.0, "{beyond}");
}

#[test]
fn putting_a_drawing_somewhere_keeps_it_there() {
    let at = moment(Vec3::new(0.4, 0.7, 0.6), Vec3::new(0.1, -0.2, 1.0));
    let middle = Vec3::new(-0.5, 0.2, 0.9).normalize();
    let mut free = Placement::Free(FreePlacement::default());
    let mut panorama = Placement::Panorama(PanoramaPlacement::default());
    for placement in [&mut free, &mut panorama] {
        for middle in [middle, -at.light, at.light] {
            assert_eq!(placement.put(&at, middle), Ok(()));
            assert!(placement.evaluate(&at).middle().distance(middle.as_dvec3()) < 1e-5);
        }
    }
    let mut limited = PanoramaPlacement::default();
    limited.limits = [-0.1, 0.1];
    let refused = Placement::Panorama(limited).put(&at, Vec3::Y);
    let text = refused.expect_err("the pole is beyond the limits").to_string();
    assert!(text.contains("-90"), "{text}");
}

#[test]
fn a_ball_is_seen_where_the_line_of_sight_meets_it() {
    let ball = Proxy::Ball { center: Vec3::Y, radius: 0.5 };
    let twice = Affine3A::from_scale(Vec3::splat(2.0));
    let seen = |p: Vec3| ball.seen(&twice, p, Vec3::Z);
    // Before and behind its surface, which is a metre round (0, 2, 0).
    for z in [-3.0, 0.2, 5.0] {
        assert!(seen(Vec3::new(0.6, 2.0, z)).distance(Vec3::new(0.6, 2.0, 0.8)) < 1e-6);
    }
    // A line that misses it comes nearest there.
    assert!(seen(Vec3::new(3.0, 2.0, 0.7)).distance(Vec3::new(3.0, 2.0, 0.0)) < 1e-6);
    let sphere = Proxy::Sphere { center: Vec3::Y };
    assert_eq!(sphere.seen(&twice, Vec3::X, Vec3::Z), Vec3::X);
}

/// A scene of one object, with a highlight on it.
fn scene_of(mesh: Primitive) -> Scene {
    let mesh = Mesh { primitives: vec![mesh], ..Mesh::default() };
    let node = Node { mesh: Some(0), ..Node::default() };
    Scene {
        meshes: vec![mesh],
        nodes: vec![node],
        roots: vec![0],
        highlights: vec![Highlight::default()],
        ..Scene::default()
    }
}

#[test]
fn a_ball_is_fitted_to_the_surfaces_round_it() {
    // The front cap of a ball, as hair or a shield is.
    let at = Vec3::new(0.3, 1.0, -0.2);
    let mut cap = crate::shapes::uv_sphere(96, 48, 0.5);
    cap.positions.iter_mut().for_each(|p| *p += at);
    let front: Vec<u32> = cap
        .indices
        .as_chunks::<3>()
        .0
        .iter()
        .filter(|t| t.iter().all(|&i| cap.positions[i as usize].z > at.z + 0.2))
        .flatten()
        .copied()
        .collect();
    cap.indices = front;
    let scene = scene_of(cap);
    let fitted = |center| scene.fitted_ball(&scene.highlights[0], center);
    let Some(Proxy::Ball { center, radius }) = fitted(None) else { panic!("no ball") };
    assert!(center.distance(at) < 0.02 && (radius - 0.5).abs() < 0.02, "{center}, {radius}");
    let Some(Proxy::Ball { center, radius }) = fitted(Some(at)) else { panic!("no ball") };
    assert!(center == at && (radius - 0.5).abs() < 1e-3, "{radius}");
}

#[test]
fn what_is_far_from_the_centre_hardly_moves_the_fitted_radius() {
    // One eye has the material of the other.
    let at = Vec3::X * 0.06;
    let mut eyes = crate::shapes::uv_sphere(48, 24, 0.02);
    let mut other = eyes.clone();
    other.positions.iter_mut().for_each(|p| *p += at);
    let first = eyes.positions.len() as u32;
    eyes.indices.extend(other.indices.iter().map(|i| first + i));
    eyes.positions.extend(other.positions);
    eyes.normals.extend(other.normals);
    let scene = scene_of(eyes);
    let ball = scene.fitted_ball(&scene.highlights[0], Some(Vec3::ZERO));
    let Some(Proxy::Ball { radius, .. }) = ball else { panic!("no ball") };
    assert!((0.02..0.026).contains(&radius), "{radius}");
}

#[test]
fn balls_are_fitted_to_flat_and_to_broken_surfaces_too() {
    let plate = |corners: [Vec3; 3]| Primitive {
        positions: corners.to_vec(),
        normals: vec![Vec3::Z; 3],
        indices: vec![0, 1, 2],
        ..Primitive::default()
    };
    let scene = scene_of(plate([Vec3::ZERO, Vec3::X, Vec3::Y]));
    let fitted = scene.fitted_ball(&scene.highlights[0], None);
    assert!(fitted.as_ref().is_none_or(|ball| ball.validate().is_ok()), "{fitted:?}");
    let aside = scene.fitted_ball(&scene.highlights[0], Some(Vec3::Z));
    assert!(matches!(aside, Some(Proxy::Ball { radius, .. }) if radius > 1.0 && radius < 1.5));
    for broken in [[Vec3::ZERO; 3], [Vec3::NAN, Vec3::X, Vec3::Y]] {
        let scene = scene_of(plate(broken));
        assert_eq!(scene.fitted_ball(&scene.highlights[0], None), None);
    }
}

#[test]
fn proxies_have_their_normals() {
    let at = |proxy: &Proxy, node: &Affine3A, p: Vec3| proxy.normal(node, p);
    let moved = Affine3A::from_translation(Vec3::X);
    let sphere = Proxy::Sphere { center: Vec3::Y };
    assert_eq!(at(&sphere, &moved, Vec3::new(1.0, 1.0, 3.0)), Some(Vec3::Z));
    assert_eq!(at(&sphere, &moved, Vec3::new(1.0, 1.0, 0.0)), None);
    let radii = Vec3::new(1.0, 2.0, 4.0);
    let ellipsoid = Proxy::Ellipsoid { center: Vec3::ZERO, radii, rotation: Quat::IDENTITY };
    let p = Vec3::new(0.5, 1.0, 2.0);
    let expected = (p / (radii * radii)).normalize();
    let normal = at(&ellipsoid, &Affine3A::IDENTITY, p).expect("a normal");
    assert!(normal.distance(expected) < 1e-6);
    // A ball under a stretched node is that ellipsoid, too.
    let stretched = Affine3A::from_scale(radii);
    let ball = at(&Proxy::Sphere { center: Vec3::ZERO }, &stretched, p).expect("a normal");
    assert!(ball.distance(expected) < 1e-6);
    let capsule = Proxy::Capsule { from: Vec3::ZERO, to: Vec3::Y * 2.0 };
    let side = at(&capsule, &moved, Vec3::new(1.0, 1.3, 0.2)).expect("a normal");
    assert!(side.distance(Vec3::Z) < 1e-5);
    let end = at(&capsule, &moved, Vec3::new(1.0, 3.0, 1.0)).expect("a normal");
    assert!(end.distance(Vec3::new(0.0, 1.0, 1.0).normalize()) < 1e-6);
    let plane = Proxy::Plane { center: Vec3::ZERO, normal: Vec3::new(0.0, 1.0, 1.0) };
    let turned = Affine3A::from_rotation_y(FRAC_PI_2);
    let normal = at(&plane, &turned, Vec3::ONE).expect("a normal");
    assert!(normal.distance(Vec3::new(1.0, 1.0, 0.0).normalize()) < 1e-6);
}

#[test]
fn a_mesh_gives_its_normals_along_rays_from_the_centre() {
    let ball = crate::shapes::uv_sphere(48, 24, 2.0);
    let indices = ball.indices.as_chunks::<3>().0.to_vec();
    let mesh = ProxyMesh { positions: ball.positions, normals: ball.normals, indices };
    let map = mesh.normal_map(Vec3::ZERO);
    assert_eq!(map.len(), (NORMAL_MAP_SIZE + 2).pow(2));
    assert!(map.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
    let d = Vec3::new(0.3, -0.8, 0.4).normalize();
    assert!(mesh.normal_along(Vec3::ZERO, d).distance(d) < 0.01);
    // Across the border of the map normals go on evenly.
    let side = NORMAL_MAP_SIZE + 2;
    for i in 1..side - 1 {
        for (outer, inner) in [(i, side + i), (i * side, i * side + 1)] {
            assert!(map[outer].distance(map[inner]) < 0.1, "texel {i}");
        }
    }
}

#[test]
fn distance_fields_of_circles_are_exact() {
    let field = Drawing::BuiltIn(BuiltInDrawing::Disc).distance_field().expect("a disc");
    let extent = f64::from(distance::FIELD_EXTENT);
    let mut worst = 0.0_f64;
    for (i, &d) in field.iter().enumerate() {
        let at = |k: usize| ((k as f64 + 0.5) / FIELD_SIZE as f64 * 2.0 - 1.0) * extent;
        let (x, y) = (at(i % FIELD_SIZE), -at(i / FIELD_SIZE));
        worst = worst.max((f64::from(d) - (x.hypot(y) - 1.0)).abs());
    }
    // The outline has 256 corners: its chords lie 1 − cos(π/256) inside.
    assert!(worst < 1e-4, "{worst}");
}

#[test]
fn every_built_in_drawing_fills_its_square_and_no_more() {
    for drawing in BuiltInDrawing::ALL {
        let points: Vec<Vec2> = drawing.outlines().concat();
        let high = points.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        let low = points.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        assert!(high.max_element() <= 1.01 && low.min_element() >= -1.01, "{drawing:?}");
        assert!((high - low).max_element() > 1.85, "{drawing:?}: {low} to {high}");
        let field = Drawing::BuiltIn(drawing).distance_field().expect("not empty");
        let inside = field.iter().filter(|d| **d < 0.0).count();
        let share = inside as f32 / field.len() as f32;
        assert!((0.03..0.7).contains(&share), "{drawing:?} covers {share}");
        assert!(field.iter().all(|d| d.is_finite()));
    }
}

fn image(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Drawing {
    let rgba = (0..width * height).flat_map(|i| pixel(i % width, i / width)).collect();
    Drawing::Image(Arc::new(Image { name: String::new(), width, height, rgba }))
}

#[test]
fn pictures_give_the_distance_to_their_contour() {
    // A disc of radius 20 in 64 pixels, antialiased, in alpha; the same bright on black.
    let share = |x: u32, y: u32| {
        let d = (x as f32 - 31.5).hypot(y as f32 - 31.5);
        ((20.5 - d).clamp(0.0, 1.0) * 255.0).round() as u8
    };
    let by_alpha = image(64, 64, |x, y| [9, 9, 9, share(x, y)]);
    let by_luminance = image(64, 64, |x, y| [share(x, y), share(x, y), share(x, y), 255]);
    for drawing in [by_alpha, by_luminance] {
        let field = drawing.distance_field().expect("a disc");
        let mut worst = 0.0_f32;
        for (i, d) in field.iter().enumerate() {
            let at = |k: usize| ((k as f32 + 0.5) / FIELD_SIZE as f32 * 2.0 - 1.0) * 1.25;
            let exact = at(i % FIELD_SIZE).hypot(at(i / FIELD_SIZE)) - 20.0 / 32.0;
            worst = worst.max((d - exact).abs());
        }
        // A tenth of the picture's pixel.
        assert!(worst < 0.1 / 32.0, "{worst}");
    }
}

/// A change, and what the sentence about it must have.
type Case<'a> = (&'a dyn Fn(&mut Highlight), &'a str);

#[test]
fn what_cannot_be_drawn_is_said_in_a_sentence() {
    let wrong = |change: &dyn Fn(&mut Highlight)| {
        let mut highlight = Highlight { name: "ring".to_owned(), ..Highlight::default() };
        change(&mut highlight);
        let scene = Scene { highlights: vec![highlight], ..Scene::default() };
        scene.validate().expect_err("not valid").to_string()
    };
    let free = |key: FreeKey| {
        Placement::Free(FreePlacement { keys: vec![key], ..FreePlacement::default() })
    };
    let at = FreeKey::at(&moment(Vec3::X, Vec3::Z));
    let cases: [Case<'_>; 13] = [
        (&|h| h.node = Some(3), "node 3"),
        (&|h| h.gamma = f32::NAN, "gamma"),
        (&|h| h.size.x = 0.0, "size"),
        (&|h| h.size.y = f32::NAN, "size"),
        (&|h| h.drawing = image(4, 4, |_, _| [255, 255, 255, 100]), "empty drawing"),
        (&|h| h.drawing = image(0, 0, |_, _| [0; 4]), "empty drawing"),
        (&|h| h.proxy = Proxy::Sphere { center: Vec3::NAN }, "finite"),
        (&|h| h.proxy = Proxy::Ball { center: Vec3::ZERO, radius: f32::NAN }, "radius"),
        (&|h| h.proxy = Proxy::Ball { center: Vec3::ZERO, radius: 0.0 }, "radius"),
        (&|h| h.placement = free(FreeKey { rotation: f32::NAN, ..at }), "number 1"),
        (&|h| h.placement = free(FreeKey { light: Vec3::ZERO, ..at }), "direction"),
        (&|h| h.placement = free(FreeKey { scale: Vec2::ZERO, ..at }), "scale"),
        (
            &|h| {
                let mut panorama = PanoramaPlacement::default();
                panorama.set_yaw_key(angle_key(f32::NAN, 0.0, KeyInterpolation::Smooth));
                h.placement = Placement::Panorama(panorama);
            },
            "finite",
        ),
    ];
    for (change, part) in cases {
        let text = wrong(change);
        assert!(text.starts_with("highlight 0 'ring' has") || text.contains("refers to"), "{text}");
        assert!(text.contains(part), "'{text}' does not say '{part}'");
    }
}

#[test]
fn evaluation_is_finite_whatever_the_directions() {
    let odd = [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::Y, Vec3::NEG_Z, Vec3::Z];
    let mut free = FreePlacement::default();
    // Equal keys, put there past the calls that keep them apart.
    let key = FreeKey { rotation: 2.0, ..FreeKey::at(&moment(Vec3::NEG_Z, Vec3::NEG_Z)) };
    free.keys = vec![key, key, FreeKey::at(&moment(Vec3::Y, Vec3::Y))];
    for placement in [Placement::Free(free), Placement::Panorama(PanoramaPlacement::default())] {
        for light in odd {
            for view in odd {
                let placed = placement.evaluate(&Moment { light, view });
                assert!(placed.middle().is_finite() && placed.axes.is_finite());
                assert!(placed.rotation.is_finite() && placed.opacity.is_finite());
            }
        }
    }
}
