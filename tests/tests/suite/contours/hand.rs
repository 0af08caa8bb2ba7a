//! The unsteady hand, and that every frame is drawn from itself alone.

use genga::render::View;
use genga::scene::{LightKind, Scene};
use genga::shapes;
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::ink::Ink;
use genga_tests::scenes::{Builder, light, model, moved, ortho_view};
use genga_tests::{Pixels, draw, style};
use glam::{Affine3A, Vec2, Vec3};

use super::ink_of;

/// A wall with its left side down the middle.
fn wall() -> Scene {
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(Vec2::splat(20.0)), None, moved(10.0, 0.0, 0.0));
    scene.build()
}

/// Middle of the line in each row, in pixels from `column`.
fn offsets(ink: &Ink, column: f64) -> Vec<f64> {
    (0..ink.height)
        .map(|y| {
            let at = |x: u32| f64::from(ink.at(i64::from(x), i64::from(y)));
            let total: f64 = (0..ink.width).map(at).sum();
            let weighted: f64 = (0..ink.width).map(|x| at(x) * (f64::from(x) + 0.5)).sum();
            weighted / total.max(1.0) - column
        })
        .collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

#[test]
fn a_hand_wobbles_within_its_amplitude() {
    let view = ortho_view([96, 384], 2.0);
    for amplitude in [1.0, 4.0] {
        let rest = format!("wobble = {{ amplitude = {amplitude}, wavelength = 40, seed = 3 }}");
        let found = offsets(&ink_of(&wall(), &contour_style(3.0, 384, &rest), &view), 48.0);
        assert!(largest(&found) <= amplitude + 0.1, "{amplitude}: {}", largest(&found));
        assert!(largest(&found) >= 0.4 * amplitude, "{amplitude}: {}", largest(&found));
        // Bends are about a wavelength apart: over 384 pixels there are several.
        let crossings = found.windows(2).filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0)).count();
        assert!((5..60).contains(&crossings), "{amplitude}: {crossings} crossings");
        // A hand does not jump from row to row.
        let jump = found.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(jump < 0.5 * amplitude, "{amplitude}: jumps by {jump} px");
    }
}

#[test]
fn another_seed_is_another_hand() {
    let view = ortho_view([96, 192], 2.0);
    let drawn = |seed: u32| {
        let rest = format!("wobble = {{ amplitude = 3, wavelength = 30, seed = {seed} }}");
        ink_of(&wall(), &contour_style(3.0, 192, &rest), &view)
    };
    assert_eq!(drawn(1), drawn(1));
    assert_ne!(drawn(1), drawn(2));
}

#[test]
fn a_wobble_sticks_to_its_surface() {
    let rest = "wobble = { amplitude = 6, wavelength = 40, seed = 5 }";
    let style = contour_style(3.0, 256, rest);
    let view = ortho_view([96, 256], 2.0);
    let before = offsets(&ink_of(&wall(), &style, &view), 48.0);
    // The camera rises by 20 and a half pixels and goes 7 to the right.
    let mut moved = view;
    let metres = 2.0 / 256.0;
    let way = Affine3A::from_translation(Vec3::new(7.0 * metres, 20.5 * metres, 0.0));
    moved.camera.world_from_camera = way * moved.camera.world_from_camera;
    let after = offsets(&ink_of(&wall(), &style, &moved), 41.0);
    // What was in row y is half a pixel below row y + 20 now.
    let differences: Vec<f64> =
        (10..220).map(|y| before[y] - 0.5 * (after[y + 20] + after[y + 21])).collect();
    assert!(largest(&differences) < 0.5, "off by {} px", largest(&differences));
    let unmoved: Vec<f64> = (10..220).map(|y| before[y] - after[y]).collect();
    let still = largest(&unmoved);
    assert!(still > 1.0, "the hand does not move with the surface: {still} px");
}

#[test]
fn a_line_is_redrawn_every_so_many_frames() {
    let rest = "wobble = { amplitude = 3, wavelength = 30, seed = 1, redraw_every = 3 }";
    let style = contour_style(3.0, 96, rest);
    let frames: Vec<Ink> = (0..10)
        .map(|frame| ink_of(&wall(), &style, &View { frame, ..ortho_view([64, 96], 2.0) }))
        .collect();
    for (i, pair) in frames.windows(2).enumerate() {
        let is_redrawn = (i + 1) % 3 == 0;
        assert_eq!(pair[0] != pair[1], is_redrawn, "between frames {i} and {}", i + 1);
    }
    let rest = "wobble = { amplitude = 3, wavelength = 30, seed = 1 }";
    let steady = contour_style(3.0, 96, rest);
    let at = |frame| ink_of(&wall(), &steady, &View { frame, ..ortho_view([64, 96], 2.0) });
    assert_eq!(at(0), at(77));
}

#[test]
fn a_frame_alone_equals_the_same_frame_of_a_sequence() {
    let scene = model("teapot-on-box");
    let style = contour_style(
        2.5,
        120,
        "width_by.taper = [[0, 0.2], [30, 1]]\n\
         wobble = { amplitude = 1.5, wavelength = 20, seed = 1, redraw_every = 2 }",
    );
    let shared = genga_tests::shared();
    let renderer = &shared.renderer;
    let pose = genga::scene::Pose::rest(&scene);
    let extremes = scene.extremes(&pose);
    let view = |frame: u32| {
        let orbit = genga::render::Orbit { azimuth_deg: 7.0 * frame as f32, ..Default::default() };
        let camera = genga::render::ViewCamera::turntable(&extremes, &orbit, 4.0 / 3.0);
        View { frame, ..View::new(camera, [160, 120]) }
    };
    let alone = draw(&scene, &style, &view(4));
    let _turn = shared.turn();
    let prepared = renderer.prepare(&scene, &style).expect("the scene can be prepared");
    let mut last = None;
    for frame in 0..5 {
        let (view, progress) = (view(frame), &mut |_, _| {});
        let picture = renderer.picture(&prepared, &view, &[], progress);
        last = Some(pollster::block_on(picture).expect("the picture can be drawn"));
    }
    assert_eq!(last.map(|picture| picture.rgba), Some(alone.rgba));
}

#[test]
fn lines_take_colours_from_the_surface_and_from_the_light() {
    let view = ortho_view([64, 64], 2.0);
    for degrees in [0.0_f32, 60.0, 180.0] {
        let mut scene = Builder::new();
        let red = scene.colored("red", [0.6, 0.2, 0.1]);
        scene.object("wall", shapes::plane(Vec2::splat(20.0)), Some(red), moved(10.0, 0.0, 0.0));
        let from = glam::Quat::from_rotation_y(degrees.to_radians()) * Vec3::Z;
        scene.light(light(LightKind::Directional, 1.0), from);
        let scene = scene.build();
        let with = |rest: &str| {
            let style = style(&format!(
                "[lines]\nreference_height = 64\n[[lines.sets]]\nwidth = 6\n{rest}"
            ));
            draw(&scene, &style, &view).at(31, 32)
        };
        // The base colour as it is displayed, times one half.
        let base = with("color_by = \"base\"\ndarken = 0.5");
        let srgb = |linear: f64| 255.0 * (1.055 * linear.powf(1.0 / 2.4) - 0.055);
        for (channel, linear) in [0.6, 0.2, 0.1].into_iter().enumerate() {
            let expected = 0.5 * srgb(linear);
            let found = f64::from(base[channel]);
            assert!((found - expected).abs() <= 2.0, "{degrees}°, base: {base:?}, not {expected}");
        }
        // From black in shade to white in light.
        let lit = with("color_by = \"light\"\ncolor = \"#000000\"\nlit_color = \"#ffffff\"");
        let expected = 255.0 * (0.5 + 0.5 * f64::from(degrees.to_radians()).cos());
        assert!((f64::from(lit[0]) - expected).abs() <= 3.0, "{degrees}°: {lit:?}, not {expected}");
    }
}

#[test]
fn lines_on_nothing_are_premultiplied_right() {
    // Straight alpha in the picture: what it gives on white is what white gives.
    let scene = model("cube-before-plane");
    let sets = "[[lines.sets]]\nname = \"a\"\ncolor = \"#c02040\"\nwidth = 7\nopacity = 0.6\n\
                [[lines.sets]]\nname = \"b\"\ntypes = [\"crease\"]\ncolor = \"#2040c0\"\nwidth = 3\n\
                wobble = { amplitude = 2, wavelength = 20 }";
    let style = style(&format!(
        "[background]\ncolor = \"#ffffff\"\n[lines]\nreference_height = 120\n{sets}"
    ));
    let view = genga_tests::orbit_view(&scene, &genga::render::Orbit::default(), [160, 120]);
    let opaque = draw(&scene, &style, &view);
    let clear = draw(&scene, &style, &View { background: false, ..view });
    let mut partial = 0;
    for (x, y) in opaque.places() {
        let [color, on_white] = [clear.at(x, y), opaque.at(x, y)];
        let alpha = f64::from(color[3]) / 255.0;
        partial += usize::from(color[3] > 0 && color[3] < 255);
        for c in 0..3 {
            let expected = f64::from(color[c]) * alpha + 255.0 * (1.0 - alpha);
            let found = f64::from(on_white[c]);
            assert!(
                (found - expected).abs() <= 2.0,
                "({x}, {y}): {color:?} on white is {on_white:?}"
            );
        }
    }
    assert!(partial > 100, "{partial} pixels are partly clear");
}
