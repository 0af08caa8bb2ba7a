//! The line round a beam: its width, its colour, and what hides it.

use genga::render::View;
use genga::scene::{Beam, BeamOrder, BeamOutline, BeamShape, BeamTone, Scene};
use genga::scene_file::SceneFile;
use genga::shapes;
use genga::style::{Globs, Style};
use genga_tests::scenes::{Builder, moved, ortho_view, parts, style};
use genga_tests::{Pixels, draw};
use glam::{Quat, Vec2, Vec3, Vec4};

const SIDE: u32 = 128;
const WIDTH: f64 = 6.0;
const RADIUS: f64 = 0.6;

fn view() -> View {
    View { supersample: 1, ..ortho_view([SIDE, SIDE], 2.0) }
}

fn unlined() -> Style {
    style(&format!("[lines]\nmethod = \"none\"\nreference_height = {SIDE}"))
}

/// A green ball as a beam, with a red line round it, and a blue square before its right half.
fn ball(order: BeamOrder, mirror: f32) -> Scene {
    let mut scene = Builder::new();
    let ball = shapes::uv_sphere(96, 48, RADIUS as f32);
    scene.object(
        "ball",
        ball,
        None,
        parts(Vec3::ZERO, Quat::IDENTITY, Vec3::new(mirror, 1.0, 1.0)),
    );
    let blue = scene.colored("blue", [0.0, 0.0, 1.0]);
    scene.object("near", shapes::plane(Vec2::ONE), Some(blue), moved(0.9, 0.0, 2.0));
    let objects = Globs::new(["ball"]).expect("it is a glob");
    scene.raw().beams.push(Beam {
        shape: BeamShape::Surfaces { under: None, objects, materials: Globs::default() },
        ramp: vec![BeamTone { at: 0.0, color: Vec4::new(0.0, 1.0, 0.0, 1.0), softness: 0.0 }],
        outline: Some(BeamOutline { color: Vec4::new(1.0, 0.0, 0.0, 1.0), width: WIDTH as f32 }),
        order,
        ..Beam::default()
    });
    scene.build()
}

#[test]
fn it_is_as_wide_as_asked_and_outside() {
    for (order, mirror) in [(BeamOrder::Over, 1.0), (BeamOrder::LinesThrough, -1.0)] {
        let picture = draw(&ball(order, mirror), &unlined(), &view());
        let (mut inside, mut lined, mut hidden) = (0, 0, 0);
        for (x, y) in picture.places() {
            let half = f64::from(SIDE) / 2.0;
            let (u, v) = (f64::from(x) + 0.5 - half, f64::from(y) + 0.5 - half);
            let from_rim = u.hypot(v) - RADIUS * half;
            let [r, g, b, _] = picture.at(x, y);
            // The square is from 0.4 m to 1.4 m.
            let is_hidden = u > 0.4 * half + 1.0 && v.abs() < 0.5 * half - 1.0;
            if is_hidden {
                assert_eq!([r, g, b], [0, 0, 255], "({x}, {y})");
                hidden += u32::from(from_rim.abs() < WIDTH);
                continue;
            }
            if u > 0.4 * half - 1.0 {
                continue;
            }
            let wanted = if from_rim < -1.0 {
                inside += 1;
                [0, 255, 0]
            } else if from_rim > 1.0 && from_rim < WIDTH - 1.0 {
                lined += 1;
                [255, 0, 0]
            } else if from_rim > WIDTH + 1.0 {
                [255, 255, 255]
            } else {
                continue;
            };
            assert_eq!([r, g, b], wanted, "({x}, {y}), {from_rim:.1} px from the rim");
        }
        assert!(inside > 2000 && lined > 300 && hidden > 20, "{inside}, {lined}, {hidden}");
    }
}

#[test]
fn scene_files_give_it_and_mistakes_are_told() {
    let scene = |outline: &str| {
        let toml = format!(
            "version = 1\n[[beam]]\nshape = \"flash\"\nradius = 0.8\noutline = {outline}\n"
        );
        SceneFile::from_toml_str(&toml)
    };
    let beam = scene("{ width = 4 }").expect("it is right").beams[0].beam.clone();
    assert_eq!(beam.outline, Some(BeamOutline { color: Vec4::W, width: 4.0 }));
    for (wrong, told) in [("{ width = -1 }", "width"), ("{ thick = 3 }", "thick"), ("4", "outline")]
    {
        let error = scene(wrong).expect_err("it is wrong").to_string();
        assert!(error.contains(told), "{error}");
    }
}

/// Spikes that a straight outline would miss: with a line there is more of the picture covered, all
/// round, and nothing of the flash itself is lost.
#[test]
fn a_flash_has_it_all_round() {
    let flash = |outline| {
        let mut scene = Builder::new();
        scene.raw().beams.push(Beam {
            shape: BeamShape::Flash {
                radius: 0.8,
                spikes: 12,
                spread: std::f32::consts::PI,
                seed: 4,
            },
            ramp: vec![BeamTone { at: 0.0, color: Vec4::new(0.0, 1.0, 0.0, 1.0), softness: 0.0 }],
            outline,
            ..Beam::default()
        });
        scene.build()
    };
    let line = Some(BeamOutline { color: Vec4::new(1.0, 0.0, 0.0, 1.0), width: 5.0 });
    let plain = draw(&flash(None), &unlined(), &view());
    let lined = draw(&flash(line), &unlined(), &view());
    let is = |picture: &genga::render::Picture, (x, y): (u32, u32), c: usize| {
        let rgb = picture.at(x, y);
        rgb[c] == 255 && rgb[(c + 1) % 3] == 0
    };
    let (mut flashes, mut kept, mut rims, mut met) = (0_u32, 0_u32, 0_u32, 0_u32);
    for (x, y) in plain.places() {
        let inside = |x: u32, y: u32| plain.at(x, y)[0] == 0;
        if inside(x, y) {
            flashes += 1;
            kept += u32::from(is(&lined, (x, y), 1));
        } else if x > 2 && y > 2 && x < SIDE - 3 && y < SIDE - 3 && plain.at(x, y)[0] == 255 {
            let near = (0..5).any(|i| (0..5).any(|j| inside(x + i - 2, y + j - 2)));
            rims += u32::from(near);
            met += u32::from(near && lined.at(x, y)[1] < 128);
        }
    }
    assert!(flashes > 500, "{flashes}");
    // Spikes before others have their line on them.
    assert!(f64::from(kept) > 0.6 * f64::from(flashes), "{kept} of {flashes} pixels are left");
    assert!(f64::from(met) > 0.95 * f64::from(rims), "{met} of {rims} pixels at the rim are lined");
}
