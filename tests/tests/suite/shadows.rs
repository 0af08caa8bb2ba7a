//! Cast shadows compared with rays in f64: where their edges lie, that nothing shades itself, and
//! that edges stand still when the camera moves.

use genga::render::{LayerKind, Orbit, Picture, View};
use genga::scene::{LightKind, Pose, Scene, Transform};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{
    Builder, light, model, moved, orbit_view, ortho_view, perspective_view, style,
};
use genga_tests::{Eye, Pixels, draw, draw_layers};
use glam::{Affine3A, DVec2, DVec3, Vec2, Vec3};

/// Two tones with their edge at 0.5, and shadows.
fn shadowed(rest: &str) -> Style {
    style(&format!(
        "[lines]\nmethod = \"none\"\n[paint.shadow]\nenabled = true\n{rest}\n[paint.ramp]\n\
         stops = [{{ at = 0.0, color = \"#000000\" }}, {{ at = 0.5, color = \"#ffffff\" }}]\n"
    ))
}

/// A wall at z = 0 with a ball and a box before it.
fn stage() -> Builder {
    let mut scene = Builder::new();
    let wall = shapes::plane(Vec2::splat(8.0));
    scene.object("wall", wall, None, Transform::default());
    scene.object("ball", shapes::uv_sphere(192, 96, 0.4), None, moved(-0.7, 0.1, 0.5));
    scene.object("box", shapes::cuboid(Vec3::splat(0.6)), None, moved(0.7, 0.0, 0.3));
    scene
}

const BALL: (DVec3, f64) = (DVec3::new(-0.7, 0.1, 0.5), 0.4);
const BOX: [DVec3; 2] = [DVec3::new(0.4, -0.3, 0.0), DVec3::new(1.0, 0.3, 0.6)];

/// Whether ball or box meet the stretch from `from` to `to`.
fn is_blocked(from: DVec3, to: DVec3) -> bool {
    let d = to - from;
    let along = (BALL.0 - from).dot(d) / d.length_squared();
    let nearest = from + along.clamp(0.0, 1.0) * d;
    if nearest.distance(BALL.0) < BALL.1 {
        return true;
    }
    let (mut first, mut last) = (1e-9_f64, 1.0_f64);
    for axis in 0..3 {
        let near = (BOX[0][axis] - from[axis]) / d[axis];
        let far = (BOX[1][axis] - from[axis]) / d[axis];
        first = first.max(near.min(far));
        last = last.min(near.max(far));
    }
    first < last
}

/// What the wall shows at a place of the picture: `None` where something stands before it, or where
/// `lamp` says nothing of the place.
fn wall_is_lit(eye: &Eye, p_px: DVec2, lamp: &dyn Fn(DVec3) -> Option<DVec3>) -> Option<bool> {
    let ray = eye.ray(p_px);
    let t = -ray.origin.z / ray.direction.z;
    let p = ray.point(t);
    if is_blocked(ray.origin, p) {
        return None;
    }
    Some(!is_blocked(p, lamp(p)?))
}

/// Compares every pixel of the wall with the shadow's outline in f64: three quarters of a pixel
/// away from it, the pixel is on the right side; from one and a half on, it has the tone itself.
/// Returns how many were in shadow.
fn compare(picture: &Picture, view: &View, lamp: &dyn Fn(DVec3) -> Option<DVec3>) -> u32 {
    let eye = Eye::new(view);
    let mut dark = 0;
    for (x, y) in picture.places() {
        let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let Some(lit) = wall_is_lit(&eye, middle, lamp) else { continue };
        let is_even = |radius: f64| {
            (0..16).all(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 16.0;
                let place = middle + radius * DVec2::from_angle(angle);
                wall_is_lit(&eye, place, lamp) == Some(lit)
            })
        };
        let found = picture.at(x, y)[0];
        if is_even(0.75) {
            assert_eq!(found >= 128, lit, "pixel {x}, {y} is {found}");
        }
        if is_even(1.5) {
            assert_eq!(found, if lit { 255 } else { 0 }, "pixel {x}, {y}");
            dark += u32::from(!lit);
        }
    }
    dark
}

#[test]
fn the_sun_casts_shadows_to_the_pixel() {
    let from = Vec3::new(-2.0, 3.0, 4.0);
    let lamp = |p: DVec3| Some(p + 100.0 * from.as_dvec3());
    for view in [ortho_view([320, 240], 2.6), perspective_view([320, 240], 30.0, 5.0)] {
        for supersample in [1, 2] {
            let view = View { supersample, ..view };
            let mut scene = stage();
            scene.light(light(LightKind::Directional, 1.0), from);
            let picture = draw(&scene.build(), &shadowed(""), &view);
            let dark = compare(&picture, &view, &lamp);
            assert!(dark > 1000, "there are shadows: {dark}");
        }
    }
}

#[test]
fn lamps_cast_shadows_to_the_pixel() {
    let from = Vec3::new(-1.2, 1.6, 2.4);
    let spot = LightKind::Spot { range: None, inner_angle: 0.7, outer_angle: 0.8 };
    let wide = LightKind::Spot { range: None, inner_angle: 1.4, outer_angle: 1.5 };
    for kind in [LightKind::Point { range: None }, spot, wide] {
        let mut scene = stage();
        scene.light(light(kind, 1.0), from);
        let view = View { supersample: 1, ..perspective_view([320, 240], 30.0, 5.0) };
        let picture = draw(&scene.build(), &shadowed(""), &view);
        let at = from.as_dvec3();
        // Well inside of a spot's cone; what is outside has no light at all.
        let cone = match kind {
            LightKind::Spot { inner_angle, .. } => f64::from(inner_angle).cos(),
            _ => -1.0,
        };
        let lamp = |p: DVec3| ((p - at).normalize().dot(-at.normalize()) > cone).then_some(at);
        let dark = compare(&picture, &view, &lamp);
        assert!(dark > 1000, "there are shadows of {kind:?}: {dark}");
    }
}

#[test]
fn an_edge_is_a_pixel_wide() {
    let mut scene = stage();
    scene.light(light(LightKind::Directional, 1.0), Vec3::new(-2.0, 3.0, 4.0));
    let view = View { supersample: 1, ..ortho_view([320, 240], 2.6) };
    let picture = draw(&scene.build(), &shadowed(""), &view);
    let partial = |x: u32, y: u32| !matches!(picture.at(x, y)[0], 0 | 255);
    let eye = Eye::new(&view);
    let sun = |p: DVec3| Some(p + 100.0 * DVec3::new(-2.0, 3.0, 4.0));
    let is_wall = |x: u32, y: u32| {
        let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        (0..16).all(|i| {
            let round = DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 16.0);
            wall_is_lit(&eye, middle + 2.0 * round, &sun).is_some()
        })
    };
    // Grey pixels are there, but no 3 × 3 of them.
    let grey = picture.places().filter(|&(x, y)| partial(x, y)).count();
    assert!(grey > 100, "edges are antialiased: {grey}");
    for (x, y) in picture.places().filter(|&(x, y)| x > 0 && y > 0 && x < 319 && y < 239) {
        let all = (0..9).all(|i| partial(x + i % 3 - 1, y + i / 3 - 1));
        assert!(!all || !is_wall(x, y), "the edge at {x}, {y} is blurred");
    }
}

/// A continuous ramp, so that a shadow shows wherever it is.
const GREYS: &str = "stops = [{ at = 0.0, color = \"#000000\" }, { at = 1.0, color = \"#ffffff\" }]\n\
                     smooth = true\n";

fn with_and_without(scene: &Scene, replaced: bool, view: &View) -> [Picture; 2] {
    [true, false].map(|enabled| {
        let style = style(&format!(
            "[lines]\nmethod = \"none\"\n[background]\ncolor = \"#000\"\n\
             [paint.shadow]\nenabled = {enabled}\ntone = 0.0\n\
             [light]\nreplace_model_lights = {replaced}\npinned_to = \"world\"\n[paint.ramp]\n{GREYS}"
        ));
        draw(scene, &style, view)
    })
}

#[test]
fn what_is_convex_does_not_shade_itself() {
    let lamp = LightKind::Point { range: None };
    for kind in [LightKind::Directional, lamp] {
        for (segments, rings) in [(12, 8), (96, 48)] {
            let mut scene = Builder::new();
            let ball = shapes::uv_sphere(segments, rings, 0.9);
            scene.object("ball", ball, None, Transform::default());
            scene.light(light(kind, 1.0), Vec3::new(-2.0, 2.0, 3.0));
            let view = View { supersample: 1, ..ortho_view([160, 160], 2.0) };
            let [with, without] = with_and_without(&scene.build(), false, &view);
            let darker = with.places().filter(|&(x, y)| {
                let [a, b] = [&with, &without].map(|p| i32::from(p.at(x, y)[0]));
                // Lit clearly: T over 0.55.
                b > 140 && a + 2 < b
            });
            assert_eq!(darker.count(), 0, "{kind:?} on {segments} × {rings}");
        }
    }
}

#[test]
fn a_slanted_plane_has_no_acne() {
    for tilt in [0.05_f32, 0.2, 0.6, 1.2] {
        let mut scene = Builder::new();
        scene.object("wall", shapes::plane(Vec2::splat(8.0)), None, Transform::default());
        // Light from `tilt` above the wall's plane.
        let from = Vec3::new(-tilt.cos(), 0.3, tilt.sin());
        scene.light(light(LightKind::Directional, 1.0), from);
        let view = View { supersample: 1, ..perspective_view([160, 120], 40.0, 4.0) };
        let [with, without] = with_and_without(&scene.build(), false, &view);
        assert_eq!(with.rgba, without.rgba, "light at {tilt}");
    }
}

#[test]
fn every_shadow_on_a_figure_is_explained_by_a_ray() {
    for (name, zoom) in [("hero", 2.0), ("head", 1.0)] {
        let scene = model(name);
        let pose = Pose::rest(&scene);
        let orbit = Orbit { azimuth_deg: 20.0, zoom, ..Orbit::default() };
        let view = View { supersample: 1, ..orbit_view(&scene, &orbit, [240, 240]) };
        let [with, without] = with_and_without(&scene, true, &view);
        let (azimuth, elevation) = (-35_f32.to_radians(), 40_f32.to_radians());
        let to_light = Vec3::new(
            azimuth.sin() * elevation.cos(),
            elevation.sin(),
            azimuth.cos() * elevation.cos(),
        );
        let is_blocked = |x: f32, y: f32| {
            let [origin, direction] = view.ray(Vec2::new(x, y));
            let Some(hit) = scene.pick(&pose, origin, direction) else { return true };
            // A back face hides light as well: look from the light, too.
            let start = hit.point + 1e-4 * hit.normal;
            let far = start + 10.0 * to_light;
            scene.pick(&pose, start, to_light).is_some()
                || scene
                    .pick(&pose, far, -to_light)
                    .is_some_and(|blocker| (blocker.point - start).dot(to_light) > 1e-3)
        };
        let mut shaded = 0;
        for (x, y) in with.places() {
            let [a, b] = [&with, &without].map(|p| i32::from(p.at(x, y)[0]));
            // Where light grazes, a texel of the map is many pixels long.
            if b < 140 || a + 40 > b {
                continue;
            }
            shaded += 1;
            // Every third is looked at: a ray visits every triangle.
            if shaded % 3 != 0 {
                continue;
            }
            let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
            let explained = (0..3_u8).any(|i| {
                (0..3_u8).any(|j| is_blocked(px + f32::from(i) - 1.0, py + f32::from(j) - 1.0))
            });
            assert!(explained, "{name}: nothing stands between pixel {x}, {y} and the light");
        }
        assert!(shaded > 40, "{name} has shadows: {shaded}");
    }
}

#[test]
fn edges_stand_still_when_the_camera_moves() {
    // The box's upright edge throws an upright edge on the wall.
    let from = Vec3::new(-2.0, 0.4, 3.0);
    let mut places = Vec::new();
    let mut scene = stage();
    scene.light(light(LightKind::Directional, 1.0), from);
    let scene = scene.build();
    let metres = 2.6;
    for step in 0..16_u8 {
        let shift = 0.0031 * f32::from(step);
        let mut view = View { supersample: 1, ..ortho_view([320, 240], metres) };
        view.camera.world_from_camera = Affine3A::from_translation(Vec3::new(shift, 0.0, 10.0));
        let picture = draw(&scene, &shadowed(""), &view);
        // Where the shadow right of the box ends, in metres of the world.
        let row = 130;
        let per_px = metres / 240.0;
        let left_px = 257;
        let dark: f32 =
            (left_px..320).map(|x| 1.0 - f32::from(picture.at(x, row)[0]) / 255.0).sum();
        places.push((left_px as f32 + dark - 160.0) * per_px + shift);
    }
    let wanted = 1.0 + 0.6 * 2.0 / 3.0;
    let pixel = metres / 240.0;
    for (step, place) in places.iter().enumerate() {
        let off = (place - wanted) / pixel;
        assert!(off.abs() < 0.5, "step {step}: the edge is {off} px off: {places:?}");
    }
    let low = places.iter().copied().fold(f32::INFINITY, f32::min);
    let high = places.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    assert!((high - low) / pixel < 0.2, "the edge moves by {} px", (high - low) / pixel);
}

#[test]
fn a_surface_may_neither_receive_nor_cast() {
    let mut scene = stage();
    scene.light(light(LightKind::Directional, 1.0), Vec3::new(-2.0, 3.0, 4.0));
    let scene = scene.build();
    let view = View { supersample: 1, ..ortho_view([160, 120], 2.6) };
    let dark = |rest: &str| {
        let style = style(&format!(
            "[lines]\nmethod = \"none\"\n[paint.shadow]\nenabled = true\n[paint.ramp]\n\
             stops = [{{ at = 0.0, color = \"#000000\" }}, {{ at = 0.5, color = \"#ffffff\" }}]\n\
             [[override]]\n{rest}"
        ));
        let layers = draw_layers(&scene, &style, &view, &[LayerKind::Ids]);
        let wall = layers.places().filter(|&(x, y)| layers.ids(x, y)[0] == 1);
        wall.filter(|&(x, y)| layers.at(x, y)[0] < 128).count()
    };
    let all = dark("select = { objects = [\"nothing\"] }");
    assert_eq!(dark("select = { objects = [\"wall\"] }\npaint.shadow = { receive = false }"), 0);
    let ball = dark("select = { objects = [\"box\"] }\npaint.shadow = { cast = false }");
    let cube = dark("select = { objects = [\"ball\"] }\npaint.shadow = { cast = false }");
    assert!(ball > 300 && cube > 300 && ball + cube >= all, "{ball}, {cube}, {all}");
    // A tone that is lit on the ramp shows no shadow.
    assert_eq!(dark("select = { objects = [\"wall\"] }\npaint.shadow = { tone = 0.8 }"), 0);
}

#[test]
fn a_tiled_picture_has_the_same_shadows() {
    let mut scene = stage();
    scene.light(light(LightKind::Directional, 1.0), Vec3::new(-2.0, 3.0, 4.0));
    scene.light(light(LightKind::Point { range: None }, 0.5), Vec3::new(1.0, 1.5, 2.0));
    let (scene, style) = (scene.build(), shadowed(""));
    let view = View { supersample: 1, ..perspective_view([300, 200], 30.0, 5.0) };
    let whole = draw(&scene, &style, &view);
    let shared = genga_tests::shared();
    let _turn = shared.turn();
    let prepared = shared.renderer.prepare(&scene, &style).expect("the scene is valid");
    let mut progress = |_, _| {};
    let tiled = shared.renderer.picture_in_tiles(&prepared, &view, &[], 160, &mut progress);
    let tiled = pollster::block_on(tiled).expect("it can be drawn");
    let differences = whole.rgba.iter().zip(&tiled.rgba).filter(|(a, b)| a.abs_diff(**b) > 1);
    assert_eq!(differences.count(), 0);
}

#[test]
fn layers_split_the_picture() {
    let mut scene = stage();
    let red = scene.colored("red", [0.5, 0.1, 0.05]);
    scene.object("red", shapes::cuboid(Vec3::splat(0.3)), Some(red), moved(0.0, 0.8, 0.2));
    scene.light(light(LightKind::Directional, 1.0), Vec3::new(-2.0, 3.0, 4.0));
    let view = View { supersample: 1, ..ortho_view([160, 120], 2.6) };
    let kinds = [LayerKind::Color, LayerKind::Base, LayerKind::Tone, LayerKind::Shadow];
    let style = style(
        "[lines]\nmethod = \"none\"\n[paint.shadow]\nenabled = true\n[paint.ramp]\n\
         stops = [{ at = 0.0, color = \"#8060a0\" }, { at = 0.5, color = \"#ffffff\" }]\n",
    );
    let picture = draw_layers(&scene.build(), &style, &view, &kinds);
    let [color, base, tone, shadow] = kinds.map(|kind| picture.bytes(kind));
    let mut counts = [0; 2];
    for i in 0..color.len() / 4 {
        for c in 0..3 {
            let [a, b, t] = [color, base, tone].map(|layer| f32::from(layer[4 * i + c]));
            assert!((a - b * t / 255.0).abs() <= 1.0, "pixel {i}: {a} is not {b} × {t}");
        }
        counts[0] += usize::from(shadow[4 * i] == 0);
        counts[1] += usize::from(shadow[4 * i] == 255);
        // A cast shadow is in the dark tone.
        assert!(shadow[4 * i] > 0 || tone[4 * i + 1] == 0x60, "pixel {i}");
    }
    assert!(counts[0] > 300 && counts[1] > 3000, "{counts:?}");
}

#[test]
fn a_sky_lights_what_looks_up() {
    let mut scene = Builder::new();
    scene.object("ball", shapes::uv_sphere(96, 48, 0.9), None, Transform::default());
    scene.raw().lights.push(light(LightKind::Sky, 1.0));
    let sky = genga::scene::Node { light: Some(0), ..Default::default() };
    scene.node(sky);
    // A light of the same strength from the front, so that the style's own does not join.
    scene.light(light(LightKind::Directional, 1.0), Vec3::Z);
    let view = View { supersample: 1, ..ortho_view([128, 128], 2.0) };
    let style = style(&format!("[lines]\nmethod = \"none\"\n[paint.ramp]\n{GREYS}"));
    let picture = draw(&scene.build(), &style, &view);
    let eye = Eye::new(&view);
    let mut seen = 0;
    for (x, y) in picture.places() {
        let ray = eye.ray_at(x, y);
        // Not where a pixel holds background, too.
        if ray.meets_sphere(DVec3::ZERO, 0.88).is_none() {
            continue;
        }
        let Some(t) = ray.meets_sphere(DVec3::ZERO, 0.9) else { continue };
        let n = ray.point(t) / 0.9;
        let wanted = 255.0 * 0.5 * (1.0 + 0.5 * n.y + 0.5 * n.z);
        let found = f64::from(picture.at(x, y)[0]);
        assert!((found - wanted).abs() < 2.0, "pixel {x}, {y}: {found}, not {wanted}");
        seen += 1;
    }
    assert!(seen > 8000, "{seen}");
}

#[test]
fn shadows_are_fine_near_the_eye_on_a_floor_to_the_horizon() {
    let mut scene = Builder::new();
    let mut floor = shapes::plane(Vec2::splat(600.0));
    floor.positions.iter_mut().for_each(|p| *p = Vec3::new(p.x, 0.0, -p.y));
    floor.normals.iter_mut().for_each(|n| *n = Vec3::Y);
    scene.object("floor", floor, None, Transform::default());
    let half = Vec3::new(0.1, 0.6, 0.1);
    let middles = [[-0.8, -3.0], [0.6, -9.0], [1.0, -30.0]].map(|[x, z]| Vec3::new(x, 0.6, z));
    for middle in middles {
        scene.object("post", shapes::cuboid(2.0 * half), None, moved(middle.x, middle.y, middle.z));
    }
    let sun = Vec3::new(-2.0, 1.6, 1.0);
    scene.light(light(LightKind::Directional, 1.0), sun);
    let mut view = View { supersample: 1, ..perspective_view([320, 200], 40.0, 0.0) };
    view.camera.world_from_camera =
        Affine3A::from_translation(Vec3::Y * 1.5) * Affine3A::from_rotation_x(-0.2);
    let picture = draw(&scene.build(), &shadowed(""), &view);
    // Whether a ray meets a post, by its slabs.
    let meets = |from: Vec3, way: Vec3| {
        middles.iter().any(|middle| {
            let [a, b] = [-half, half].map(|side| (*middle + side - from) / way);
            let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
            enter < leave && leave > 0.0
        })
    };
    // Dark, light, or nothing of the floor.
    let expected = |x: u32, y: u32| {
        let [from, way] = view.ray(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
        let place = from - way * (from.y / way.y);
        let is_floor = way.y < 0.0 && place.distance(from) < 60.0 && !meets(from, way);
        is_floor.then(|| meets(place + Vec3::Y * 1e-4, sun))
    };
    let (mut shaded, mut wrong) = (0, 0);
    for y in 1..199 {
        for x in 1..319 {
            let around = (0..9).map(|i| expected(x + i % 3 - 1, y + i / 3 - 1));
            let Some(is_dark) = expected(x, y) else { continue };
            if !around.into_iter().all(|other| other == Some(is_dark)) {
                continue;
            }
            shaded += u32::from(is_dark);
            wrong += u32::from((picture.at(x, y)[0] < 128) != is_dark);
        }
    }
    assert!(shaded > 300, "only {shaded} pixels lie in shadows");
    assert_eq!(wrong, 0, "of {shaded} pixels in shadows");
}
