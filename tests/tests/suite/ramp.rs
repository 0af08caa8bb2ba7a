//! Where tones end on a surface, compared with N·L in f64.

use std::f64::consts::FRAC_PI_8;
use std::sync::Arc;

use genga::render::{Picture, View};
use genga::scene::{LightKind, Material, Scene, Transform};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{Builder, image, light, moved, nearest, ortho_view, style};
use genga_tests::{Eye, Pixels, draw};
use glam::{DVec2, DVec3, Vec2, Vec3};

/// A ball of radius 0.9 m at the origin that fills most of a view 2 m high.
fn ball() -> Builder {
    let mut scene = Builder::new();
    scene.object("ball", shapes::uv_sphere(96, 48, 0.9), None, Transform::default());
    scene
}

fn ball_view() -> View {
    View { supersample: 1, ..ortho_view([128, 128], 2.0) }
}

/// The ball's normal at a place of the picture.
fn ball_normal(eye: &Eye, p_px: DVec2) -> Option<DVec3> {
    let ray = eye.ray(p_px);
    ray.meets_sphere(DVec3::ZERO, 0.9).map(|t| ray.point(t) / 0.9)
}

/// A style whose ramp has black, grey and white tones that begin at those places.
fn tones(stops: &[(f64, u8)], rest: &str) -> Style {
    let stops: Vec<String> = stops
        .iter()
        .map(|(at, grey)| format!("{{ at = {at}, color = \"#{grey:02x}{grey:02x}{grey:02x}\" }}"))
        .collect();
    style(&format!(
        "[lines]\nmethod = \"none\"\n[light]\nazimuth_deg = -35\nelevation_deg = 40\n\
         pinned_to = \"world\"\n[paint.ramp]\nstops = [{}]\n{rest}",
        stops.join(", ")
    ))
}

/// The vector to the light of [`tones`].
fn style_light() -> DVec3 {
    let (azimuth, elevation) = (-35_f64.to_radians(), 40_f64.to_radians());
    DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos())
}

fn tone_at(stops: &[(f64, u8)], t: f64) -> u8 {
    stops.iter().rev().find(|(at, _)| t >= *at).map_or(stops[0].1, |stop| stop.1)
}

/// Asserts that each pixel has the tone of its T, unless an edge passes within a pixel of it.
/// `ramp_coordinate` is `None` beside the surface. Returns how many pixels had each tone.
fn assert_tones(
    picture: &Picture,
    stops: &[(f64, u8)],
    ramp_coordinate: impl Fn(DVec2) -> Option<f64>,
) -> Vec<usize> {
    let mut counts = vec![0; stops.len()];
    for (x, y) in picture.places() {
        let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let around = (0..16).map(|i| middle + DVec2::from_angle(f64::from(i) * FRAC_PI_8));
        let seen: Option<Vec<u8>> =
            around.chain([middle]).map(|p| ramp_coordinate(p).map(|t| tone_at(stops, t))).collect();
        let Some(seen) = seen else { continue };
        if seen.iter().all(|tone| *tone == seen[0]) {
            let [r, g, b, _] = picture.at(x, y);
            assert_eq!([r, g, b], [seen[0]; 3], "the tone at ({x}, {y})");
            counts[stops.iter().position(|stop| stop.1 == seen[0]).expect("a tone")] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 50), "a tone is missing: {counts:?}");
    counts
}

const THREE: [(f64, u8); 3] = [(0.0, 20), (0.4, 120), (0.75, 255)];

#[test]
fn tones_end_where_the_light_says() {
    let picture = draw(&ball().build(), &tones(&THREE, ""), &ball_view());
    let eye = Eye::new(&ball_view());
    assert_tones(&picture, &THREE, |p| {
        ball_normal(&eye, p).map(|n| 0.5 + 0.5 * n.dot(style_light()))
    });
}

#[test]
fn bias_and_gain_move_the_edges() {
    let eye = Eye::new(&ball_view());
    let biased = draw(&ball().build(), &tones(&THREE, "[paint]\nshade_bias = 0.125"), &ball_view());
    assert_tones(&biased, &THREE, |p| {
        ball_normal(&eye, p).map(|n| 0.5 + 0.5 * n.dot(style_light()) + 0.125)
    });
    let stronger = draw(&ball().build(), &tones(&THREE, "gain = 1.75"), &ball_view());
    assert_tones(&stronger, &THREE, |p| {
        ball_normal(&eye, p).map(|n| 0.5 + 0.5 * (1.75 * n.dot(style_light())).clamp(-1.0, 1.0))
    });
}

#[test]
fn a_camera_light_turns_with_the_camera() {
    let mut view = ball_view();
    let turn = glam::Affine3A::from_rotation_y(1.1);
    view.camera.world_from_camera = turn * view.camera.world_from_camera;
    let mut pinned = tones(&THREE, "");
    pinned.light.pinned_to = genga::style::PinnedTo::Camera;
    let from_front = draw(&ball().build(), &pinned, &ball_view());
    let from_side = draw(&ball().build(), &pinned, &view);
    let eye = Eye::new(&ball_view());
    let t = |p| ball_normal(&eye, p).map(|n| 0.5 + 0.5 * n.dot(style_light()));
    assert_tones(&from_front, &THREE, t);
    assert_tones(&from_side, &THREE, t);
}

#[test]
fn two_lights_share_one_ramp() {
    let directions = [Vec3::new(-1.0, 0.4, 0.6), Vec3::new(0.8, -0.2, 0.7)];
    let intensities = [3.0, 1.0];
    let mut scene = ball();
    for (direction, intensity) in directions.into_iter().zip(intensities) {
        scene.light(light(LightKind::Directional, intensity), 5.0 * direction);
    }
    let picture = draw(&scene.build(), &tones(&THREE, ""), &ball_view());
    let eye = Eye::new(&ball_view());
    assert_tones(&picture, &THREE, |p| {
        let n = ball_normal(&eye, p)?;
        let share = |i: usize| {
            f64::from(intensities[i] / 4.0) * n.dot(directions[i].as_dvec3().normalize())
        };
        Some(0.5 + 0.5 * (share(0) + share(1)))
    });
    // A ramp per light would give further bands: sums of two tones.
    let mut counts = [0_usize; 256];
    for (x, y) in picture.places().filter(|&(x, y)| {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        (p - DVec2::splat(64.0)).length() < 0.88 / 2.0 * 128.0
    }) {
        counts[usize::from(picture.at(x, y)[0])] += 1;
    }
    let bands: Vec<usize> = (0..256).filter(|&grey| counts[grey] > 40).collect();
    assert_eq!(bands, [20, 120, 255]);
}

#[test]
fn model_lights_give_way_if_the_style_says_so() {
    let mut scene = ball();
    scene.light(light(LightKind::Directional, 1.0), Vec3::new(0.0, -3.0, 0.0));
    let mut replaced = tones(&THREE, "");
    replaced.light.replace_model_lights = true;
    let eye = Eye::new(&ball_view());
    assert_tones(&draw(&scene.build(), &replaced, &ball_view()), &THREE, |p| {
        ball_normal(&eye, p).map(|n| 0.5 + 0.5 * n.dot(style_light()))
    });
}

/// A wall in the plane z = 0 with one light.
fn lit_wall(kind: LightKind, from: Vec3) -> Scene {
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(Vec2::splat(6.0)), None, Transform::default());
    scene.light(light(kind, 100.0), from);
    scene.build()
}

#[test]
fn point_lights_shine_from_a_place_and_end_at_their_range() {
    let stops = [(0.0, 20), (0.8, 255)];
    let view = View { supersample: 1, ..ortho_view([128, 128], 4.0) };
    let eye = Eye::new(&view);
    let from = DVec3::new(0.3, 0.2, 1.0);
    for range in [None, Some(2.0)] {
        let scene = lit_wall(LightKind::Point { range }, from.as_vec3());
        let picture = draw(&scene, &tones(&stops, ""), &view);
        assert_tones(&picture, &stops, |p| {
            let to_light = from - eye.ray(p).point(10.0);
            let distance = to_light.length();
            let window = |range: f32| (1.0 - (distance / f64::from(range)).powi(4)).clamp(0.0, 1.0);
            let falloff = range.map_or(1.0, window);
            // Without light a surface is in the darkest tone: −1 for N·L.
            Some(0.5 + 0.5 * (falloff * (to_light.z / distance + 1.0) - 1.0))
        });
    }
}

#[test]
fn spots_shine_in_their_cone() {
    let (inner, outer) = (0.3_f32, 0.55_f32);
    let view = View { supersample: 1, ..ortho_view([128, 128], 4.0) };
    let eye = Eye::new(&view);
    let from = DVec3::new(-0.4, 0.5, 1.6);
    let kind = LightKind::Spot { range: None, inner_angle: inner, outer_angle: outer };
    let stops = [(0.0, 20), (0.25, 120), (0.7, 255)];
    let picture = draw(&lit_wall(kind, from.as_vec3()), &tones(&stops, ""), &view);
    assert_tones(&picture, &stops, |p| {
        let to_light = (from - eye.ray(p).point(10.0)).normalize();
        let (inner, outer) = (f64::from(inner).cos(), f64::from(outer).cos());
        let falloff = ((to_light.dot(from.normalize()) - outer) / (inner - outer)).clamp(0.0, 1.0);
        Some(0.5 + 0.5 * (falloff * (to_light.z + 1.0) - 1.0))
    });
}

#[test]
fn a_ramp_picture_equals_its_stops() {
    let scene = ball().build();
    let eye = Eye::new(&ball_view());
    let t = |p| ball_normal(&eye, p).map(|n| 0.5 + 0.5 * n.dot(style_light()));

    let mut hard = tones(&THREE, "");
    let step = image(1000, 3, |x, y| {
        let grey = if y == 1 { tone_at(&THREE, f64::from(x) / 1000.0) } else { 77 };
        [grey, grey, grey, 255]
    });
    hard.paint.ramp.image = Some(Arc::new(step));
    assert_tones(&draw(&scene, &hard, &ball_view()), &THREE, t);

    let by_stops = tones(&[(0.0, 0), (1.0, 255)], "smooth = true");
    let mut by_image = by_stops.clone();
    let gradient = image(256, 1, |x, _| [x as u8, x as u8, x as u8, 255]);
    by_image.paint.ramp.image = Some(Arc::new(gradient));
    let a = draw(&scene, &by_stops, &ball_view());
    let b = draw(&scene, &by_image, &ball_view());
    for (x, y) in a.places() {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        // Where the whole pixel is the ball: at its outline normals change too fast.
        if (p - DVec2::splat(64.0)).length() > 0.88 / 2.0 * 128.0 {
            continue;
        }
        let expected = 255.0 * t(p).expect("inside of the ball");
        for grey in [a.at(x, y)[0], b.at(x, y)[0]] {
            let error = (f64::from(grey) - expected).abs();
            assert!(error < 2.0, "({x}, {y}): {grey}, not {expected}");
        }
    }
}

#[test]
fn softness_is_the_width_of_an_edge_in_t() {
    let soft = "[lines]\nmethod = \"none\"\n[light]\nazimuth_deg = -35\nelevation_deg = 40\n\
        pinned_to = \"world\"\n[paint.ramp]\nstops = [{ at = 0, color = \"#000\" }, \
        { at = 0.6, color = \"#fff\", softness = 0.3 }]";
    let picture = draw(&ball().build(), &style(soft), &ball_view());
    let eye = Eye::new(&ball_view());
    let mut by_t: Vec<(f64, u8)> = picture
        .places()
        .filter_map(|(x, y)| {
            let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let n = ball_normal(&eye, p).filter(|n| n.z > 0.2)?;
            Some((0.5 + 0.5 * n.dot(style_light()), picture.at(x, y)[0]))
        })
        .collect();
    by_t.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(by_t.len() > 5000);
    let mut highest = 0_u8;
    for (t, grey) in by_t {
        assert!(grey.saturating_add(3) >= highest, "{grey} at T = {t}, but {highest} before");
        highest = highest.max(grey);
        match t {
            t if t < 0.44 => assert_eq!(grey, 0, "T = {t}"),
            t if t > 0.76 => assert_eq!(grey, 255, "T = {t}"),
            t if (t - 0.6).abs() < 0.005 => assert!((115..=140).contains(&grey), "{grey} at {t}"),
            t if (0.5..0.7).contains(&t) => assert!((5..250).contains(&grey), "{grey} at {t}"),
            _ => {}
        }
    }
}

/// A square of one colour under a ramp of one tone.
fn assert_tone(color: &str, blend: &str, expected: [f64; 3]) {
    let mut scene = Builder::new();
    let picture = image(1, 1, |_, _| [200, 150, 100, 255]);
    let base_color_texture = Some(scene.texture(picture, nearest()));
    let material = scene.material(Material { base_color_texture, ..Material::default() });
    scene.object("square", shapes::plane(Vec2::ONE), Some(material), moved(0.0, 0.0, 0.0));
    let style = style(&format!(
        "[lines]\nmethod = \"none\"\n[paint.ramp]\n\
         stops = [{{ at = 0, color = \"{color}\", blend = \"{blend}\" }}]"
    ));
    let at = draw(&scene.build(), &style, &ortho_view([8, 8], 1.0)).at(4, 4);
    for (channel, expected_channel) in at.into_iter().zip(expected) {
        let error: f64 = f64::from(channel) - expected_channel;
        assert!(error.abs() <= 1.0, "{blend} {color}: {at:?}, not {expected:?}");
    }
}

const BASE: [f64; 3] = [200.0, 150.0, 100.0];
const TONE: [f64; 3] = [51.0, 102.0, 255.0];

#[test]
fn tones_multiply_or_replace() {
    assert_tone("#3366ff", "multiply", [0, 1, 2].map(|c| BASE[c] * TONE[c] / 255.0));
    assert_tone("#3366ff", "replace", TONE);
    let half = 128.0 / 255.0;
    let mixed = |to: f64, c: usize| BASE[c] + (to - BASE[c]) * half;
    let multiplied = [0, 1, 2].map(|c| mixed(BASE[c] * TONE[c] / 255.0, c));
    assert_tone("#3366ff80", "multiply", multiplied);
}

#[test]
fn a_tones_alpha_is_how_far_it_replaces() {
    let half = 128.0 / 255.0;
    assert_tone("#3366ff80", "replace", [0, 1, 2].map(|c| BASE[c] + (TONE[c] - BASE[c]) * half));
}
