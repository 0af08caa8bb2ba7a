//! The light of beams: its colour and its shadows.

use genga::render::Picture;
use genga::scene::{Beam, BeamLight, BeamOrder, BeamShape, Scene, WaveAnchor, WavePlacement};
use genga::scene_file::SceneFile;
use genga::shapes;
use genga_tests::scenes::{Builder, moved, ortho_view, style};
use genga_tests::{Pixels, draw};
use glam::{DVec3, Vec2, Vec3};

/// A white wall, dark under the style's light from behind, and a flash one metre before its middle that
/// does not hide it. A small screen stands between them, on the right.
fn scene(light: BeamLight, has_screen: bool) -> Scene {
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(Vec2::splat(4.0)), None, moved(0.0, 0.0, 0.0));
    if has_screen {
        scene.object("screen", shapes::plane(Vec2::splat(0.3)), None, moved(0.3, 0.0, 0.5));
    }
    scene.raw().beams.push(Beam {
        shape: BeamShape::Flash { radius: 0.05, spikes: 3, spread: 3.0, seed: 0 },
        placement: WavePlacement::At {
            anchor: WaveAnchor { offset: Vec3::Z, ..WaveAnchor::default() },
            direction: Vec3::X,
            follow: false,
            roll: 0.0,
        },
        order: BeamOrder::Under,
        light: Some(light),
        ..Beam::default()
    });
    scene.build()
}

fn light(color: Option<Vec3>, casts_shadow: bool) -> BeamLight {
    BeamLight { intensity: 1.0, range: 3.0, color, casts_shadow }
}

const DARK: &str = "[light]\nazimuth_deg = 180\nelevation_deg = 0\n[lines]\nmethod = \"none\"\n\
    [paint.shadow]\nenabled = true\n[paint.ramp]\nsmooth = true\n\
    stops = [{ at = 0, color = \"#000\" }, { at = 1, color = \"#fff\" }]\n";

fn drawn(light: BeamLight, has_screen: bool) -> Picture {
    draw(&scene(light, has_screen), &style(DARK), &ortho_view([128, 128], 4.0))
}

/// Where a pixel of the wall is, in metres.
fn place(x: u32, y: u32) -> DVec3 {
    DVec3::new((f64::from(x) + 0.5) / 32.0 - 2.0, 2.0 - (f64::from(y) + 0.5) / 32.0, 0.0)
}

/// The flash's part of the sum of lights on the wall.
fn share(p: DVec3) -> f64 {
    let to_light = DVec3::Z - p;
    let ratio = to_light.length_squared() / 9.0;
    (1.0 - ratio * ratio).clamp(0.0, 1.0) * to_light.z / to_light.length()
}

#[test]
fn its_colour_is_that_of_f64() {
    let color = Vec3::new(0.25, 0.6, 1.0);
    let picture = drawn(light(Some(color), false), false);
    let (mut stepped, mut outshone) = (0, 0);
    for (x, y) in picture.places() {
        let share = share(place(x, y));
        // T is that of −1 without the flash.
        let tone = 0.5 + 0.5 * (share - 1.0);
        let is_outshone = share > 0.5;
        // The edge between both is a pixel wide.
        if (share - 0.5).abs() < 0.03 {
            continue;
        }
        stepped += usize::from(!is_outshone && tone > 0.1);
        outshone += usize::from(is_outshone);
        let found = picture.at(x, y);
        for c in 0..3 {
            let [part, least] = [color[c], color.min_element()].map(f64::from);
            let mut expected = tone * part;
            if is_outshone {
                expected = 1.0 - (1.0 - 0.5 * tone * (1.0 + part)) * (1.0 - 0.6 * (part - least));
            }
            let error = (255.0 * expected - f64::from(found[c])).abs();
            assert!(error <= 1.5, "({x}, {y}): {found:?}, channel {c} should be {expected}");
        }
    }
    assert!(stepped > 500 && outshone > 500, "{stepped} and {outshone} pixels");
}

#[test]
fn without_a_colour_it_has_the_ramps() {
    // The mean of orange, yellow and white, as bright as it can be.
    let mean = (Vec3::new(1.0, 0.42, 0.1) + Vec3::new(1.0, 0.85, 0.3) + Vec3::ONE) / 3.0;
    let own = drawn(light(None, false), false);
    let given = drawn(light(Some(mean / mean.max_element()), false), false);
    assert_eq!(own.rgba, given.rgba);
    let white = drawn(light(Some(Vec3::ONE), false), false);
    assert!(white.places().all(|(x, y)| {
        let [r, g, b, _] = white.at(x, y);
        r == g && g == b
    }));
}

#[test]
fn its_shadow_is_that_of_a_lamp_in_its_middle() {
    let [without, with] = [false, true].map(|casts| drawn(light(None, casts), true));
    let (mut dark, mut lit) = (0, 0);
    for (x, y) in with.places() {
        let p = place(x, y);
        // The screen hides the wall itself from 0.15 to 0.45, and the light from twice as far out.
        let is_screen = (p.x - 0.3).abs() < 0.2 && p.y.abs() < 0.2;
        let depth = (0.3 - (p.x - 0.6).abs()).min(0.3 - p.y.abs());
        if is_screen || depth.abs() < 1.5 / 32.0 {
            continue;
        }
        if depth > 0.0 {
            dark += 1;
            assert_eq!(with.at(x, y), [0, 0, 0, 255], "in the shadow at ({x}, {y})");
        } else {
            lit += 1;
            assert_eq!(with.at(x, y), without.at(x, y), "beside it at ({x}, {y})");
        }
    }
    assert!(dark > 100 && lit > 10_000, "{dark} and {lit} pixels");
}

#[test]
fn a_scene_file_gives_it_both() {
    let read = |light: &str| {
        let text = format!(
            "version = 1\n[[model]]\nfile = \"a.glb\"\n[[beam]]\nshape = \"line\"\nlength = 1\n\
             light = {{ range = 2, {light} }}\n"
        );
        SceneFile::from_toml_str(&text)
    };
    let file = read("color = \"#3366ff\", casts_shadow = true").expect("it is right");
    let light = file.beams[0].beam.light.expect("it has a light");
    assert!(light.casts_shadow && light.color.is_some_and(|c| (c.z - 1.0).abs() < 1e-6));
    let error = read("colour = \"#3366ff\"").expect_err("no such key").to_string();
    assert!(error.contains("did you mean 'color'?"), "{error}");
}
