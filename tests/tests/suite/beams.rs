//! Beams: their ramp against f64, how objects and lines meet them, layer, light, tiles, bad input.

use genga::render::{LayerKind, View};
use genga::scene::{
    Beam, BeamLight, BeamOrder, BeamShape, BeamTone, Material, Scene, Wave, WaveAnchor, WaveOrder,
    WavePlacement,
};
use genga::scene_file::SceneFile;
use genga::shapes;
use genga::style::{Globs, Style};
use genga_tests::scenes::{Builder, moved, ortho_view, parts, perspective_view, style};
use genga_tests::{Pixels, Tolerance, difference, draw, draw_layers, shared};
use glam::{Quat, Vec2, Vec3, Vec4};

const UNLINED: &str = "[lines]\nmethod = \"none\"\n";

fn tone(at: f32, [r, g, b, a]: [f32; 4], softness: f32) -> BeamTone {
    BeamTone { at, color: Vec4::new(r, g, b, a), softness }
}

/// Objects of that name are the beam.
fn marked(name: &str, ramp: Vec<BeamTone>) -> Beam {
    let objects = Globs::new([name]).expect("it is a glob");
    let shape = BeamShape::Surfaces { under: None, objects, materials: Globs::default() };
    Beam { shape, ramp, ..Beam::default() }
}

/// The ramp in f64, premultiplied; the width of a pixel in E·N is not in it.
fn expected_ramp(beam: &Beam, t: f64) -> [f64; 4] {
    let premultiplied = |tone: &BeamTone| {
        let [r, g, b, a] = tone.color.to_array().map(f64::from);
        [r * a, g * a, b * a, a]
    };
    let mut color = premultiplied(&beam.ramp[0]);
    for pair in beam.ramp.windows(2) {
        let (at, softness) = (f64::from(pair[1].at), f64::from(pair[1].softness));
        let weight = if beam.smooth {
            let before = f64::from(pair[0].at);
            ((t - before) / (at - before)).clamp(0.0, 1.0)
        } else if softness > 0.0 {
            let u = ((t - at) / softness + 0.5).clamp(0.0, 1.0);
            u * u * (3.0 - 2.0 * u)
        } else {
            f64::from(u8::from(t >= at))
        };
        let next = premultiplied(&pair[1]);
        (0..4).for_each(|c| color[c] += (next[c] - color[c]) * weight);
    }
    color
}

#[test]
fn the_ramp_over_facing_is_that_of_f64() {
    let core = || {
        vec![
            tone(0.0, [1.0, 0.2, 0.0, 0.5], 0.0),
            tone(0.4, [1.0, 0.8, 0.1, 0.75], 0.3),
            tone(0.9, [1.0, 1.0, 0.9, 1.0], 0.12),
        ]
    };
    let size = [120, 90];
    let view = View { background: false, ..perspective_view(size, 50.0, 2.0) };
    let mut seen = 0;
    for (smooth, turn) in [(true, 0.0), (true, 1.0), (false, 0.5), (false, -1.2), (true, 1.45)] {
        let rotation = Quat::from_rotation_y(turn);
        let mut scene = Builder::new();
        let plane = shapes::plane(Vec2::splat(3.0));
        scene.object("light", plane, None, parts(Vec3::ZERO, rotation, Vec3::ONE));
        let beam = Beam { smooth, ..marked("light", core()) };
        scene.raw().beams.push(beam.clone());
        let picture = draw(&scene.build(), &style(UNLINED), &view);
        let normal = (rotation * Vec3::Z).as_dvec3();
        let eye = glam::DVec3::new(0.0, 0.0, 2.0);
        for (x, y) in picture.places().filter(|_| true) {
            let scale = 2.0 * 25.0_f64.to_radians().tan() / f64::from(size[1]);
            let ray = glam::DVec3::new(
                (f64::from(x) + 0.5 - 60.0) * scale,
                (45.0 - f64::from(y) - 0.5) * scale,
                -1.0,
            );
            let at = eye + ray * (-eye.dot(normal) / ray.dot(normal));
            let local = rotation.inverse().as_dquat() * at;
            if !(local.x.abs() < 1.4 && local.y.abs() < 1.4 && at.z < 1.9) {
                continue;
            }
            let t = (eye - at).normalize().dot(normal).abs();
            let [r, g, b, a] = expected_ramp(&beam, t);
            let drawn = picture.at(x, y).map(f64::from);
            for (channel, wanted) in drawn.into_iter().zip([r / a, g / a, b / a, a]) {
                let error = (channel / 255.0 - wanted).abs();
                assert!(error <= 1.01 / 255.0, "{drawn:?}, not {wanted} at ({x}, {y}), E·N {t}");
            }
            seen += 1;
        }
    }
    assert!(seen > 10_000, "only {seen} pixels were compared");
}

/// A red square at z = −1 and a blue one at z = 1 to its right, a beam across both, 4 m wide.
fn squares(order: BeamOrder, alpha: f32, occluded: bool) -> Scene {
    let mut scene = Builder::new();
    let mut square = |name: &str, rgb: [f32; 3], x: f32, z: f32| {
        let base_color = Vec3::from(rgb).extend(1.0);
        let material = scene.material(Material { base_color, unlit: true, ..Material::default() });
        scene.object(name, shapes::plane(Vec2::ONE), Some(material), moved(x, 0.0, z));
    };
    square("far", [1.0, 0.0, 0.0], -0.8, -1.0);
    square("near", [0.0, 0.0, 1.0], 0.8, 1.0);
    let anchor = |x: f32| WaveAnchor { offset: Vec3::X * x, ..WaveAnchor::default() };
    scene.raw().beams.push(Beam {
        shape: BeamShape::Path {
            points: vec![Vec3::ZERO, Vec3::X],
            is_bezier: false,
            radius: [0.25; 2],
        },
        placement: WavePlacement::Between { from: anchor(-1.8), to: anchor(1.8), roll: 0.0 },
        ramp: vec![tone(0.0, [0.0, 1.0, 0.0, alpha], 0.0)],
        order,
        occluded,
        ..Beam::default()
    });
    scene.build()
}

fn gray_lines() -> Style {
    style(
        "[background]\ncolor = \"#ffffff\"\n[lines]\nreference_height = 128\n\
         [[lines.sets]]\ncolor = \"#808080\"\nwidth = 6",
    )
}

#[test]
fn objects_and_lines_meet_a_beam_in_four_ways() {
    use BeamOrder::{Hide, LinesThrough, Over, Under};
    let view = ortho_view([256, 128], 2.0);
    let place = |x: f32, y: f32| ((128.0 + 64.0 * x) as u32, (64.0 - 64.0 * y) as u32);
    let (red, green, blue) = ([255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]);
    for order in [Under, LinesThrough, Over, Hide] {
        let picture = draw(&squares(order, 1.0, true), &gray_lines(), &view);
        let at = |x: f32, y: f32| {
            let (x, y) = place(x, y);
            picture.at(x, y)
        };
        assert_eq!(at(0.0, 0.1), green, "{order:?}: nothing is there but the beam");
        assert_eq!(at(0.8, 0.1), blue, "{order:?}: the near square hides the beam");
        assert_eq!(at(-0.8, 0.4), red, "{order:?}: the beam is not there");
        assert_eq!(at(-0.8, 0.1), if order == Under { red } else { green }, "{order:?}");
        // The outline of the far square, where the beam is, and of the near one, beside it.
        let ink = match order {
            Under => [128, 128, 128, 255],
            LinesThrough => [0, 128, 0, 255],
            Over | Hide => green,
        };
        assert_eq!(at(-0.31, 0.1), ink, "{order:?}: the far outline");
        let ink = if order == LinesThrough { [0, 128, 0, 255] } else { [128, 128, 128, 255] };
        assert_eq!(at(0.285, 0.1), ink, "{order:?}: the near outline");
    }
    // Half transparent.
    for (order, inside) in [(Over, [127, 128, 0, 255]), (Hide, [127, 255, 127, 255])] {
        let picture = draw(&squares(order, 0.5, true), &gray_lines(), &view);
        let (x, y) = place(-0.8, 0.1);
        let found = picture.at(x, y);
        let is_near = found.iter().zip(inside).all(|(a, b): (&u8, u8)| a.abs_diff(b) <= 1);
        assert!(is_near, "{order:?}: {found:?}, not {inside:?}");
    }
    let picture = draw(&squares(Over, 1.0, false), &gray_lines(), &view);
    let (x, y) = place(0.8, 0.1);
    assert_eq!(picture.at(x, y), green, "no surface hides it");
}

#[test]
fn the_layer_has_what_is_seen_of_beams() {
    let view = View { background: false, ..ortho_view([256, 128], 2.0) };
    for order in [BeamOrder::Under, BeamOrder::LinesThrough, BeamOrder::Over] {
        let scene = squares(order, 0.5, true);
        let picture =
            draw_layers(&scene, &gray_lines(), &view, &[LayerKind::Beam, LayerKind::Color]);
        let layer = picture.bytes(LayerKind::Beam);
        let at = |x: usize, y: usize| [0, 1, 2, 3].map(|c| layer[4 * (256 * y + x) + c]);
        assert_eq!(at(128, 58), [0, 255, 0, 128], "{order:?}");
        assert_eq!(at(128 + 51, 58)[3], 0, "{order:?}: the near square hides it");
        let over_far = if order == BeamOrder::Under { 0 } else { 128 };
        assert_eq!(at(128 - 51, 58)[3], over_far, "{order:?}: before the far square");
        let color = picture.bytes(LayerKind::Color);
        assert_eq!(color[4 * (256 * 58 + 128) + 3], 0, "{order:?}: colour has no beam");
    }
}

#[test]
fn a_beam_lights_only_what_is_near_and_faces_it() {
    let lit = |light: Option<BeamLight>| {
        let mut scene = Builder::new();
        // Dark under the style's light from behind.
        scene.object("wall", shapes::plane(Vec2::splat(4.0)), None, moved(0.0, 0.0, 0.0));
        scene.raw().beams.push(Beam {
            shape: BeamShape::Path {
                points: vec![Vec3::ZERO, Vec3::Y],
                is_bezier: false,
                radius: [0.05; 2],
            },
            placement: WavePlacement::At {
                anchor: WaveAnchor { offset: Vec3::new(-1.0, -0.5, 0.4), ..WaveAnchor::default() },
                direction: Vec3::X,
                follow: false,
                roll: 0.0,
            },
            light,
            ..Beam::default()
        });
        let dark = "[light]\nazimuth_deg = 180\nelevation_deg = 0\n[paint.ramp]\nsmooth = true\n\
             stops = [{ at = 0, color = \"#000\" }, { at = 1, color = \"#fff\" }]\n[lines]\nmethod = \"none\"";
        draw(&scene.build(), &style(dark), &ortho_view([128, 128], 4.0))
    };
    let without = lit(None);
    let light =
        BeamLight { intensity: 1.0, range: 1.0, color: Some(Vec3::ONE), casts_shadow: false };
    let with = lit(Some(light));
    let mut changed = 0;
    for (x, y) in with.places() {
        let (a, b) = (with.at(x, y)[0], without.at(x, y)[0]);
        // The beam goes from (−1, −0.5) up by 1 m; x = 32, y = 48 to 80 here.
        let (dx, dy) = (x as f32 + 0.5 - 32.0, (y as f32 + 0.5).clamp(48.0, 80.0) - y as f32 - 0.5);
        if dx.hypot(dy) / 32.0 > 0.93 {
            assert_eq!(a, b, "out of reach at ({x}, {y})");
        } else {
            assert!(a >= b, "light takes nothing at ({x}, {y})");
            changed += usize::from(a > b);
        }
    }
    assert!(changed > 1000, "only {changed} pixels are lit");
}

#[test]
fn tiles_equal_the_whole_and_order_does_not_matter() {
    let mut scene = squares(BeamOrder::Over, 0.6, true);
    scene.beams.push(Beam {
        shape: BeamShape::Flash {
            radius: 0.8,
            spikes: 14,
            spread: 3.2_f32.min(std::f32::consts::PI),
            seed: 2,
        },
        ..Beam::default()
    });
    scene.beams.push(Beam {
        shape: BeamShape::Burst { radius: 0.5, lobes: 9, seed: 1 },
        order: BeamOrder::Hide,
        ..Beam::default()
    });
    let shared = shared();
    let _turn = shared.turn();
    for supersample in [1, 2] {
        let view = View { supersample, ..ortho_view([300, 220], 2.0) };
        let draw = |scene: &Scene, texels| {
            let prepared = shared.renderer.prepare(scene, &gray_lines()).expect("it can be drawn");
            let mut quiet = |_, _| {};
            let layers = [LayerKind::Beam];
            let picture =
                shared.renderer.picture_in_tiles(&prepared, &view, &layers, texels, &mut quiet);
            pollster::block_on(picture).expect("a picture")
        };
        let whole = draw(&scene, 4096);
        assert_eq!(shared.gpu.take_fault(), None, "the driver complained");
        let tiled = draw(&scene, 200 * supersample);

        let found = difference(&whole, &tiled, Tolerance::same_picture());
        assert!(!found.is_too_much, "{found:?}");
        let layers = [&whole, &tiled].map(|p| p.bytes(LayerKind::Beam));
        assert!(layers[0].iter().zip(layers[1]).all(|(a, b)| a.abs_diff(*b) <= 1));
    }
}

#[test]
fn what_has_no_length_is_not_drawn() {
    let view = ortho_view([64, 64], 2.0);
    let path = |points: Vec<Vec3>| BeamShape::Path { points, is_bezier: false, radius: [0.2; 2] };
    let mut scene = Builder::new();
    scene.object("dot", shapes::plane(Vec2::splat(0.1)), None, moved(0.0, 0.0, 0.0));
    let mut scene = scene.build();
    let plain = draw(&scene, &style(UNLINED), &view);
    for (shape, growth) in
        [(path(vec![Vec3::ONE; 5]), [0.0, 1.0]), (path(vec![Vec3::ZERO, Vec3::X]), [0.5, 0.5])]
    {
        scene.beams = vec![Beam { shape, growth, ..Beam::default() }];
        assert_eq!(draw(&scene, &style(UNLINED), &view).rgba, plain.rgba);
    }
    // Many points, on top of each other and folded back: a sensible picture.
    let many =
        (0..10_000).map(|i| Vec3::new((i as f32 * 0.01).sin(), (i / 5000) as f32 * 0.5, 0.0));
    scene.beams = vec![Beam { shape: path(many.collect()), ..Beam::default() }];
    let picture = draw(&scene, &style(UNLINED), &view);
    assert_ne!(picture.rgba, plain.rgba);
}

#[test]
fn wrong_beams_get_a_sentence() {
    let path = |points: Vec<Vec3>| BeamShape::Path { points, is_bezier: false, radius: [0.2; 2] };
    let holding = WavePlacement::At {
        anchor: WaveAnchor { nodes: vec![7], offset: Vec3::ZERO },
        direction: Vec3::X,
        follow: false,
        roll: 0.0,
    };
    let lamp = BeamLight { intensity: 1.0, range: 1.0, color: None, casts_shadow: false };
    for (beam, part) in [
        (Beam { shape: path(vec![Vec3::NAN, Vec3::X]), ..Beam::default() }, "its numbers must be"),
        (Beam { shape: path(vec![Vec3::X]), ..Beam::default() }, "it must have 2 to 10000"),
        (Beam { ramp: Vec::new(), ..Beam::default() }, "it must have 1 to 8"),
        (Beam { opacity: f32::NAN, ..Beam::default() }, "the opacity NaN"),
        (Beam { placement: holding, ..Beam::default() }, "there are only 0 nodes"),
        (Beam { light: Some(BeamLight { range: 0.0, ..lamp }), ..Beam::default() }, "range 0"),
        (
            Beam {
                light: Some(BeamLight { color: Some(Vec3::new(0.0, 2.0, 0.0)), ..lamp }),
                ..Beam::default()
            },
            "the light's colour 2",
        ),
    ] {
        let scene = Scene { beams: vec![beam], ..Scene::default() };
        let error = scene.validate().expect_err("this beam is wrong").to_string();
        assert!(error.starts_with("beam 0") && error.contains(part), "{error}");
    }
    for (keys, part) in [
        ("shape = \"line\"", "either a 'length' or an end"),
        ("shape = \"flash\"", "must have a 'radius'"),
        ("shape = \"flash\"\nradius = 1\nlobes = 3", "a flash has none"),
        ("shape = \"surface\"\nobjects = []", "must name what it marks"),
        ("shape = \"light-trail\"", "must have a 'from_node'"),
        ("shape = \"line\"\nto = [0, 0, nan]", "number"),
        ("shape = \"line\"\nlength = 1\nglow = 1", "unknown key"),
        (
            "shape = \"line\"\nlength = 1\nramp = [{ at = 0.5, color = \"#fff\" }, { at = 0.5, color = \"#fff\" }]",
            "do not rise",
        ),
    ] {
        let text = format!("version = 1\n[[beam]]\n{keys}\n");
        let error = SceneFile::from_toml_str(&text).expect_err("this beam is wrong").to_string();
        assert!(error.contains(part), "{keys}: {error}");
    }
    let text = "version = 1\n[[beam]]\nshape = \"line\"\nlength = 1\nfrom_node = \"gone\"";
    let file = SceneFile::from_toml_str(text).expect("names are looked up later");
    let error = file.assemble(|_| Err::<Scene, _>(String::new())).expect_err("no such node");
    assert!(error.to_string().contains("no node 'gone'"), "{error}");
}

#[test]
fn marks_that_fit_nothing_are_told() {
    let mut scene = Builder::new();
    scene.object("box", shapes::plane(Vec2::ONE), None, moved(0.0, 0.0, 0.0));
    scene.raw().beams.push(marked("sword*", vec![tone(0.0, [1.0; 4], 0.0)]));
    let shared = shared();
    let _turn = shared.turn();
    let prepared =
        shared.renderer.prepare(&scene.build(), &style(UNLINED)).expect("it can be drawn");
    assert!(
        prepared.warnings().iter().any(|w| w.contains("marks no surface")),
        "{:?}",
        prepared.warnings()
    );
}

#[test]
fn a_beam_between_equal_places_is_told() {
    let at_one_place =
        BeamShape::Path { points: vec![Vec3::X; 2], is_bezier: false, radius: [0.1; 2] };
    for (shape, is_told) in [(at_one_place, true), (Beam::default().shape, false)] {
        let mut scene = Scene::default();
        scene.beams.push(Beam { shape, ..Beam::default() });
        let shared = shared();
        let _turn = shared.turn();
        let prepared = shared.renderer.prepare(&scene, &style(UNLINED)).expect("it can be drawn");
        let told = prepared.warnings().iter().any(|w| w.contains("at one place"));
        assert_eq!(told, is_told, "{:?}", prepared.warnings());
    }
}

#[test]
fn waves_of_a_rank_are_added_to_its_beams() {
    let view = ortho_view([256, 128], 2.0);
    let at = |beam: BeamOrder, wave: Option<WaveOrder>| {
        let mut scene = squares(beam, 1.0, true);
        let order = wave.unwrap_or(WaveOrder::Under);
        let color = Vec4::new(0.0, 0.0, 1.0, 1.0);
        let wave =
            wave.map(|_| Wave { order, color, alpha: 1.0, occluded: false, ..Wave::default() });
        scene.waves.extend(wave);
        draw(&scene, &gray_lines(), &view).at(128, 60)
    };
    for (beam, wave, is_added) in [
        (BeamOrder::Under, WaveOrder::Under, true),
        (BeamOrder::LinesThrough, WaveOrder::Under, false),
        (BeamOrder::LinesThrough, WaveOrder::LinesThrough, true),
        (BeamOrder::Over, WaveOrder::LinesThrough, false),
        (BeamOrder::Over, WaveOrder::Over, true),
        (BeamOrder::LinesThrough, WaveOrder::Over, true),
    ] {
        let (without, with) = (at(beam, None), at(beam, Some(wave)));
        assert_eq!(without, [0, 255, 0, 255]);
        assert_eq!(with[2] > 100, is_added, "{beam:?} and a wave {wave:?}: {with:?}");
    }
}
