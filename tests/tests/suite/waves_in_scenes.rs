//! Energy waves with noise, among beams, over bright backgrounds, of very many points.

use std::fmt::Write as _;

use genga::render::{LayerData, LayerKind, View};
use genga::scene::{
    Beam, BeamOrder, BeamShape, BeamTone, Pose, Scene, Wave, WaveAnchor, WaveBlend, WaveNoise,
    WaveOrder, WavePlacement, WaveShape,
};
use genga::scene_file::SceneFile;
use genga_tests::waves::cases::{energies, errors, scene_of, shapes, views};
use genga_tests::{Pixels, draw, ortho_view, style};
use glam::{Affine3A, Vec3, Vec3A, Vec4};

#[test]
fn noise_along_the_curve_is_that_of_f64() {
    let [(_, view), ..] = views([96, 96]);
    let noises = [
        WaveNoise { amplitude: 0.2, frequency: 5.0, octaves: 1, seed: 1, phase: 0.0 },
        WaveNoise { amplitude: 0.15, frequency: 3.0, octaves: 4, seed: 77, phase: -2.3 },
    ];
    let mut pictures = Vec::new();
    for (name, shape) in shapes() {
        if !["capsule", "helix", "bezier", "polyline"].contains(&name) {
            continue;
        }
        for noise in noises {
            let shape = shape.clone();
            let wave = Wave { shape, noise, radius: Some(0.8), core: 0.05, ..Wave::default() };
            let found = energies(&scene_of(std::slice::from_ref(&wave)), &view);
            let errors = errors(&wave, &view, &found, 150, &|_| 1e9);
            assert!(errors.largest <= 0.01, "{name}, seed {}: {errors:?}", noise.seed);
            pictures.push(found);
        }
    }
    assert_ne!(pictures[0], pictures[1], "another seed bends it otherwise");
}

/// A glow that is nearly even about the middle of the picture.
fn wide(order: WaveOrder, blend: WaveBlend, color: Vec4) -> Wave {
    let (core, radius) = (1.0, Some(4.0));
    Wave { order, blend, color, core, radius, occluded: false, ..Wave::default() }
}

#[test]
fn waves_and_beams_lie_over_each_other_by_their_order() {
    let anchor = |x: f32| WaveAnchor { offset: Vec3::X * x, ..WaveAnchor::default() };
    let green = BeamTone { at: 0.0, color: Vec4::new(0.0, 1.0, 0.0, 1.0), softness: 0.0 };
    let view = View { supersample: 1, ..ortho_view([32, 32], 2.0) };
    let black = style("[background]\ncolor = \"#000000\"\n[lines]\nmethod = \"none\"");
    let beams = [BeamOrder::Under, BeamOrder::LinesThrough, BeamOrder::Over];
    let waves = [WaveOrder::Under, WaveOrder::LinesThrough, WaveOrder::Over];
    for (b, order) in beams.into_iter().enumerate() {
        for (w, wave_order) in waves.into_iter().enumerate() {
            let beam = Beam {
                shape: BeamShape::Path {
                    points: vec![Vec3::ZERO, Vec3::X],
                    is_bezier: false,
                    radius: [0.3; 2],
                },
                placement: WavePlacement::Between {
                    from: anchor(-2.0),
                    to: anchor(2.0),
                    roll: 0.0,
                },
                ramp: vec![green],
                order,
                ..Beam::default()
            };
            let red = Vec4::new(0.5, 0.0, 0.0, 1.0);
            let mut scene = scene_of(&[wide(wave_order, WaveBlend::Display, red)]);
            scene.beams = vec![beam];
            let picture = draw(&scene, &black, &view);
            let [r, g, ..] = picture.at(16, 16);
            assert_eq!(g, 255, "the beam is there");
            // Waves of a rank are added to its beams, those of lower ranks are behind them.
            assert_eq!(r > 40, w >= b, "{wave_order:?} and {order:?}: {r}");
            let beside = picture.at(16, 4)[0];
            assert!(beside > 40, "{wave_order:?}: {beside} beside the beam");
        }
    }
}

#[test]
fn a_wave_that_covers_keeps_its_color_before_a_bright_sky() {
    let view = View { supersample: 1, ..ortho_view([16, 16], 0.5) };
    let color = Vec4::new(0.5, 0.25, 0.9, 1.0);
    let middle = |blend, style_text: &str, background| {
        let scene = scene_of(&[wide(WaveOrder::Over, blend, color)]);
        let view = View { background, ..view };
        let energy = energies(&scene, &view)[8 * 16 + 8];
        (energy, draw(&scene, &style(style_text), &view).at(8, 8))
    };
    let none = "[lines]\nmethod = \"none\"\n[background]\ncolor = ";
    for space in ["display", "linear"] {
        let sky = format!("{none}\"#c0e0ff\"\n[paint]\nblend_space = \"{space}\"\n");
        let (energy, found) = middle(WaveBlend::Normal, &sky, true);
        let shown = color.truncate() * energy;
        let alpha = shown.max_element().min(1.0);
        assert!(alpha > 0.3 && alpha < 0.9, "the case shows something: {alpha}");
        let behind = Vec3::new(192.0, 224.0, 255.0);
        for (c, wanted) in
            (behind * (1.0 - alpha) + 255.0 * shown).to_array().into_iter().enumerate()
        {
            let off = (f32::from(found[c]) - wanted).abs();
            assert!(off <= 1.5, "{space}, channel {c}: {found:?}, not {wanted}");
        }
        assert_eq!(found[3], 255);
        // An added one washes out there: its blue was full before.
        let (_, added) = middle(WaveBlend::Display, &sky, true);
        assert!(added[0] > found[0] + 30, "{added:?} and {found:?}");
    }
    // On black nothing differs, and without a background both have the alpha of their brightest.
    let black = format!("{none}\"#000000\"\n");
    for background in [true, false] {
        let (energy, covering) = middle(WaveBlend::Normal, &black, background);
        let (_, added) = middle(WaveBlend::Display, &black, background);
        for (a, b) in covering.into_iter().zip(added) {
            assert!(a.abs_diff(b) <= 1, "{covering:?} and {added:?}");
        }
        let alpha = if background { 255.0 } else { 255.0 * (0.9 * energy).min(1.0) };
        assert!((f32::from(covering[3]) - alpha).abs() <= 1.5, "{covering:?}, not {alpha}");
    }
}

/// A scene file with one wave.
fn file(keys: &str, points: &[Vec3]) -> Result<Scene, String> {
    let mut text = format!("version = 1\n[[wave]]\n{keys}\npoints = [");
    for p in points {
        write!(text, "[{}, {}, {}], ", p.x, p.y, p.z).expect("strings take all");
    }
    text += "]\n";
    let file = SceneFile::from_toml_str(&text).map_err(|e| e.to_string())?;
    let assembled = file.assemble(|name| Err::<Scene, _>(format!("there is no model {name:?}")));
    assembled.map(|a| a.scene).map_err(|e| e.to_string())
}

#[test]
fn ten_thousand_points_are_drawn_or_refused_with_a_sentence() {
    let [(_, view), ..] = views([160, 160]);
    // Twenty periods of a sine, which can be had by formula as well.
    let (length, height, turns) = (4.0, 0.4, 20.0);
    let points: Vec<Vec3> = (0..10_000)
        .map(|i| {
            let s = f64::from(i) / 9_999.0;
            let y = f64::from(height) * (std::f64::consts::TAU * f64::from(turns) * s).sin();
            Vec3::new((f64::from(length) * s) as f32, y as f32, 0.0)
        })
        .collect();
    let shape = WaveShape::Trig { length, turns, y: vec![[height, 0.0]], z: Vec::new() };
    let wanted = Wave { shape, core: 0.05, radius: Some(0.3), ..Wave::default() };
    let wanted = energies(&scene_of(&[wanted]), &view);
    let peak = wanted.iter().copied().fold(0.0, f32::max);
    for shape in ["polyline", "b-spline"] {
        let keys = format!("shape = \"{shape}\"\ncore = 0.05\nradius = 0.3");
        let scene = file(&keys, &points).expect("it rises along its direction");
        let found = energies(&scene, &view);
        for (i, (a, b)) in found.iter().zip(&wanted).enumerate() {
            // Both may be off by a percent.
            let allowed = 0.02 * b.max(peak / 100.0);
            assert!((a - b).abs() <= allowed, "{shape} at {}, {}: {a}, {b}", i % 160, i / 160);
        }
    }
    // A circle folds back.
    let circle: Vec<Vec3> = (0..10_000)
        .map(|i| {
            let (sin, cos) = (i as f32 * 6e-4).sin_cos();
            Vec3::new(cos, sin, 0.0)
        })
        .collect();
    let fault = file("shape = \"b-spline\"", &circle).expect_err("it has no direction");
    assert!(fault.contains("folds back along its direction at s = "), "{fault}");
    let fault = file("shape = \"bezier\"", &points).expect_err("so many have no Bézier curve");
    assert!(fault.contains("10000 control points"), "{fault}");
}

#[test]
fn sums_may_have_hundreds_of_terms() {
    let [(_, view), ..] = views([160, 160]);
    let drawn = |turns: f32, y: Vec<[f32; 2]>| {
        let shape = WaveShape::Trig { length: 4.0, turns, y, z: Vec::new() };
        let wave = Wave { shape, core: 0.05, radius: Some(0.3), ..Wave::default() };
        energies(&scene_of(&[wave]), &view)
    };
    // The twentieth of 300 terms over one turn is the first one over twenty turns.
    let mut terms = vec![[0.0, 0.0]; 300];
    terms[19] = [0.4, 0.0];
    let (found, wanted) = (drawn(1.0, terms), drawn(20.0, vec![[0.4, 0.0]]));
    let peak = wanted.iter().copied().fold(0.0, f32::max);
    assert!(peak > 0.0, "nothing is drawn");
    for (i, (a, b)) in found.iter().zip(&wanted).enumerate() {
        // Both may be off by a percent.
        let allowed = 0.02 * b.max(peak / 100.0);
        assert!((a - b).abs() <= allowed, "at {}, {}: {a}, {b}", i % 160, i / 160);
    }
}

#[test]
fn a_wave_on_a_bone_goes_with_the_clip() {
    let text = r#"
version = 1
[[model]]
file = "hero.glb"
translation = [0.2, 0, -0.1]
rotation_deg = [0, 90, 0]
[[wave]]
shape = "sphere"
from_node = "leftHand"
from = [0.1, 0.2, 0]
radius = 0.2
occluded = false
"#;
    let file = SceneFile::from_toml_str(text).expect("the file is right");
    let hero = |_: &std::path::Path| Ok::<_, String>(genga_tests::scenes::model("hero"));
    let scene = file.assemble(hero).expect("the bone is there").scene;
    let clip = scene.find_clip("beam").expect("the hero has it");
    let bone = scene.nodes.iter().position(|node| node.name == "leftHand").expect("it is there");
    let height = 2.2;
    let mut view = View { supersample: 1, ..ortho_view([120, 90], height) };
    view.camera.world_from_camera = Affine3A::from_translation(Vec3::new(0.5, 1.1, 10.0));

    let (style, shared) = (style(""), genga_tests::shared());
    let _turn = shared.turn();
    let renderer = &shared.renderer;
    let mut prepared = renderer.prepare(&scene, &style).expect("it can be prepared");
    let mut places = Vec::new();
    for time in [0.0, 0.45, 0.9] {
        let pose = Pose::at(&scene, clip, time);
        renderer.set_pose(&mut prepared, &scene, &pose).expect("the pose fits");
        // As it was read, then brighter and larger, which does not move it.
        let mut larger = scene.waves.clone();
        (larger[0].alpha, larger[0].radius) = (0.4, Some(0.3));
        let mut sums = Vec::new();
        for waves in [&scene.waves, &larger] {
            renderer.set_waves(&mut prepared, waves, scene.wave_method, &pose).expect("they fit");
            let layers = [LayerKind::Energy];
            let mut silent = |_, _| {};
            let picture = renderer.picture(&prepared, &view, &layers, &mut silent);
            let picture = pollster::block_on(picture).expect("it can be drawn");
            let LayerData::F32 { values, .. } = &picture.layers[0].data else { panic!() };
            let (mut sum, mut x, mut y) = (0.0, 0.0, 0.0);
            for (i, &energy) in values.iter().enumerate() {
                let energy = f64::from(energy);
                sum += energy;
                x += energy * ((i % 120) as f64 + 0.5);
                y += energy * ((i / 120) as f64 + 0.5);
            }
            let hand = pose.world_from_node[bone].translation + Vec3A::new(0.1, 0.2, 0.0);
            let at = view.camera.world_from_camera.inverse().transform_point3a(hand);
            let pixel = |metres: f32| f64::from(metres) * 90.0 / f64::from(height);
            let wanted = [60.0 + pixel(at.x), 45.0 - pixel(at.y)];
            let off = [x / sum - wanted[0], y / sum - wanted[1]];
            assert!(off[0].hypot(off[1]) < 0.05, "after {time} s: {off:?} from {wanted:?}");
            sums.push(sum);
            places.push(wanted);
        }
        assert!(sums[1] > 2.0 * sums[0], "{sums:?}");
    }
    let way = (places[0][0] - places[4][0]).hypot(places[0][1] - places[4][1]);
    assert!(way > 5.0, "the clip moves the hand, {way} px");
    assert_eq!(shared.gpu.take_fault(), None, "the driver complained");
}
