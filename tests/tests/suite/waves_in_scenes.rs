//! Energy waves with noise, among beams, over bright backgrounds, of very many points.

use std::fmt::Write as _;

use genga::render::View;
use genga::scene::{
    Beam, BeamOrder, BeamShape, BeamTone, Scene, Wave, WaveAnchor, WaveBlend, WaveNoise, WaveOrder,
    WavePlacement, WaveShape,
};
use genga::scene_file::SceneFile;
use genga_tests::waves::cases::{energies, errors, scene_of, shapes, views};
use genga_tests::{Pixels, draw, ortho_view, style};
use glam::{Vec3, Vec4};

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
