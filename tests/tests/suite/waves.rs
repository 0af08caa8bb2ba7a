//! Energy waves against adaptive quadrature in f64, and what their pictures must not show.

use genga::render::{LayerKind, View};
use genga::scene::{
    Projection, Scene, Wave, WaveBlend, WaveMethod, WaveOrder, WavePlacement, WaveShape,
};
use genga::shapes;
use genga_tests::waves::cases::{
    Random, energies, errors, look, scaled, scene_of, shapes as wave_shapes, views,
};
use genga_tests::{Builder, draw, ortho_view, perspective_view, style};
use glam::{Affine3A, Vec3, Vec4};

/// With a core over half a pixel everywhere: less is blurred, and exact only to some percent.
fn wave(shape: WaveShape) -> Wave {
    Wave { shape, radius: Some(0.8), core: 0.05, ..Wave::default() }
}

fn no_end(_: &genga_tests::waves::Ray) -> f64 {
    1e9
}

#[test]
fn every_shape_is_within_its_tolerance_from_every_side() {
    for (tolerance, bound) in [(0.01, 0.01), (0.001, 0.001)] {
        for (name, shape) in wave_shapes() {
            let wave = Wave { tolerance, ..wave(shape) };
            for (side, view) in views([96, 96]) {
                let errors = errors(
                    &wave,
                    &view,
                    &energies(&scene_of(std::slice::from_ref(&wave)), &view),
                    200,
                    &no_end,
                );
                assert!(errors.largest <= bound, "{name}, {side}, {tolerance}: {errors:?}");
            }
        }
    }
}

#[test]
fn glows_without_an_end_are_exact_too() {
    for (name, shape) in wave_shapes() {
        let wave = Wave { radius: None, reach: 40.0, ..wave(shape) };
        let [(_, view), ..] = views([64, 64]);
        let errors = errors(
            &wave,
            &view,
            &energies(&scene_of(std::slice::from_ref(&wave)), &view),
            100,
            &no_end,
        );
        assert!(errors.largest <= 0.01, "{name}: {errors:?}");
    }
}

#[test]
fn growth_and_attenuation_keep_to_the_model() {
    let [(_, view), ..] = views([80, 80]);
    for (name, shape) in wave_shapes() {
        for head in [0.0, 0.25, 0.5, 1.0] {
            let wave = Wave { growth: [0.0, head], ..wave(shape.clone()) };
            let errors = errors(
                &wave,
                &view,
                &energies(&scene_of(std::slice::from_ref(&wave)), &view),
                80,
                &no_end,
            );
            assert!(errors.largest <= 0.01, "{name}, k = {head}: {errors:?}");
        }
        for (j, bound) in [(0.5, 0.02), (1.0, 0.01), (2.0, 0.02)] {
            let wave = Wave { attenuation: j, reach: 8.0, ..wave(shape.clone()) };
            let errors = errors(
                &wave,
                &view,
                &energies(&scene_of(std::slice::from_ref(&wave)), &view),
                80,
                &no_end,
            );
            assert!(errors.largest <= bound, "{name}, j = {j}: {errors:?}");
        }
    }
}

#[test]
fn profile_and_swelling_ends_keep_to_the_model() {
    let [(_, view), ..] = views([80, 80]);
    for (name, shape) in wave_shapes() {
        if name == "endless" || name == "sphere" {
            continue;
        }
        let profile = vec![[0.0, 0.2], [0.3, 1.0], [1.0, 0.5]];
        let wave = Wave { profile, swell: [0.1, 0.4], ..wave(shape) };
        let errors = errors(
            &wave,
            &view,
            &energies(&scene_of(std::slice::from_ref(&wave)), &view),
            150,
            &no_end,
        );
        assert!(errors.largest <= 0.01, "{name}: {errors:?}");
    }
}

/// A double-sided wall of 8 m at z = 0, turned towards the camera.
fn wall() -> Scene {
    let mut scene = Builder::new();
    let mut wall = shapes::cuboid(Vec3::new(8.0, 8.0, 0.001));
    for p in &mut wall.positions {
        p.z = 0.0;
    }
    scene.object("wall", wall, None, Default::default());
    scene.build()
}

#[test]
fn a_surface_hides_the_part_behind_it_of_every_shape() {
    for (name, shape) in wave_shapes() {
        let direction = Vec3::new(0.9, 0.1, 0.4).normalize();
        let placement = WavePlacement::At {
            anchor: genga::scene::WaveAnchor { nodes: Vec::new(), offset: -2.0 * direction },
            direction,
            follow: false,
            roll: 0.0,
        };
        let wave = Wave { placement, ..wave(shape) };
        let mut scene = wall();
        scene.waves = vec![wave.clone()];
        let view = View { supersample: 1, ..perspective_view([80, 80], 40.0, 6.0) };
        let to_wall = |ray: &genga_tests::waves::Ray| -ray.origin.z / ray.direction.z;
        let errors = errors(&wave, &view, &energies(&scene, &view), 120, &to_wall);
        assert!(errors.largest <= 0.01, "{name}: {errors:?}");
    }
}

#[test]
fn the_parts_before_and_behind_a_wall_make_up_the_whole() {
    let size = [64, 64];
    let front = View { supersample: 1, ..ortho_view(size, 5.0) };
    let mut back = front;
    back.camera.world_from_camera =
        Affine3A::from_rotation_y(std::f32::consts::PI) * front.camera.world_from_camera;
    for (name, shape) in wave_shapes() {
        if name == "endless" {
            continue;
        }
        let placement = WavePlacement::At {
            anchor: genga::scene::WaveAnchor {
                nodes: Vec::new(),
                offset: Vec3::new(-2.0, 0.0, 0.1),
            },
            direction: Vec3::X,
            follow: false,
            roll: 0.0,
        };
        let wave = Wave { placement, reach: 100.0, ..wave(shape) };
        let mut scene = wall();
        scene.waves = vec![wave.clone()];
        let (before, behind) = (energies(&scene, &front), energies(&scene, &back));
        let whole = energies(&scene_of(&[wave]), &front);
        let peak = whole.iter().copied().fold(0.0, f32::max);
        for y in 0..64 {
            for x in 0..64 {
                let i = y * 64 + x;
                // From behind, the picture is mirrored.
                let sum = before[i] + behind[y * 64 + 63 - x];
                let off = (sum - whole[i]).abs() / whole[i].max(peak / 255.0);
                assert!(off <= 0.01, "{name} at {x}, {y}: {sum} and {}", whole[i]);
            }
        }
    }
}

#[test]
fn no_ray_gives_a_number_that_is_none() {
    let mut random = Random(3);
    for (name, shape) in wave_shapes() {
        for (scale, core, radius) in [
            (1e-3, 0.02, Some(0.8)),
            (1.0, 0.02, None),
            (1.0, 0.0, None),
            (1.0, 0.0, Some(0.8)),
            (1e4, 0.02, None),
            (1e4, 0.0, Some(0.8)),
        ] {
            let scaled = scaled(&shape, scale);
            let wave = Wave {
                core: core * scale,
                radius: radius.map(|radius: f32| radius * scale),
                reach: 1000.0 * scale,
                attenuation: random.below(3) as f32,
                swell: [0.1, 0.2],
                ..wave(scaled)
            };
            // Through the middle, along the axis, across it, anywhere. An odd size has a pixel in
            // the very middle.
            let eyes = [
                Vec3::new(-3.0, 0.0, 0.0),
                Vec3::new(2.0, 0.0, 5.0),
                Vec3::ZERO,
                Vec3::new(random.signed(), random.signed(), random.signed()) * 5.0,
            ];
            for eye in eyes {
                let at = if eye.z == 5.0 { Vec3::new(2.0, 0.0, 0.0) } else { Vec3::X * 2.5 };
                let mut camera = look(eye * scale, at * scale);
                camera.near = 0.1 * scale;
                let view = View { supersample: 1, ..View::new(camera, [45, 45]) };
                let energies = energies(&scene_of(std::slice::from_ref(&wave)), &view);
                let bad = energies.iter().find(|e| !e.is_finite() || **e < -1e-4);
                assert_eq!(bad, None, "{name}, {scale}, {eye}");
            }
        }
    }
}

#[test]
fn a_core_looks_alike_at_every_resolution() {
    let wave = Wave { core: 0.03, ..wave(WaveShape::Capsule { length: 4.0 }) };
    let scene = scene_of(&[wave]);
    let camera = look(Vec3::new(2.0, 0.0, 4.0), Vec3::new(2.0, 0.0, 0.0));
    let view = |side| View { supersample: 1, ..View::new(camera, [16, side]) };
    let (small, large) = (energies(&scene, &view(256)), energies(&scene, &view(1024)));
    for y in 0..256 {
        // The middle of a pixel of the small picture is a corner of four of the large one.
        let fine = [4 * y + 1, 4 * y + 2].map(|y| 0.5 * (large[y * 16 + 7] + large[y * 16 + 8]));
        let coarse = 0.5 * (small[y * 16 + 7] + small[y * 16 + 8]);
        let fine = 0.5 * (fine[0] + fine[1]);
        assert!((coarse - fine).abs() <= 0.02 * fine.max(0.01), "row {y}: {coarse} and {fine}");
    }
}

#[test]
fn a_smooth_glow_shows_no_bands() {
    // On the flank of a wide sphere 8 bits have steps of many pixels.
    let wave = Wave {
        radius: Some(3.0),
        core: 0.5,
        alpha: 0.05,
        color: Vec4::ONE,
        ..wave(WaveShape::Sphere)
    };
    let view =
        View { supersample: 1, background: false, ..perspective_view([256, 256], 40.0, 6.0) };
    let scene = scene_of(&[wave]);
    let energies = energies(&scene, &view);
    let picture = draw(&scene, &style(""), &view);
    let mut worst = 0.0_f32;
    for by in 0..32 {
        for bx in 0..32 {
            let pixels = (0..64).map(|i| ((by * 8 + i / 8) * 256 + bx * 8 + i % 8) as usize);
            let (mut drawn, mut wanted) = (0.0, 0.0);
            for i in pixels {
                let alpha = f32::from(picture.rgba[4 * i + 3]) / 255.0;
                drawn += f32::from(picture.rgba[4 * i]) / 255.0 * alpha;
                wanted += energies[i].min(1.0);
            }
            worst = worst.max((drawn - wanted).abs() / 64.0 * 255.0);
        }
    }
    // Without dithering a mean is off by up to half a step.
    assert!(worst < 0.55, "{worst}");
}

#[test]
fn lists_leave_no_edges_in_the_picture() {
    for (name, shape) in wave_shapes() {
        let wave = Wave { radius: Some(1.5), color: Vec4::ONE, ..wave(shape) };
        let [(_, view), ..] = views([128, 128]);
        let coarse = energies(&scene_of(std::slice::from_ref(&wave)), &view);
        let fine = energies(&scene_of(&[Wave { tolerance: 1e-4, ..wave }]), &view);
        let off: Vec<f32> = coarse.iter().zip(&fine).map(|(a, b)| a - b).collect();
        let peak = fine.iter().copied().fold(0.0, f32::max);
        // How much the error changes from pixel to pixel, at borders of squares and elsewhere.
        let (mut borders, mut others) = ((0.0, 0), (0.0, 0));
        for y in 0..128 {
            for x in 1..128 {
                let change = (off[y * 128 + x] - off[y * 128 + x - 1]).abs();
                assert!(change <= 0.5 / 255.0 * peak, "{name} at {x}, {y}: {change} of {peak}");
                let slot = if x % 8 == 0 { &mut borders } else { &mut others };
                *slot = (slot.0 + f64::from(change / peak), slot.1 + 1);
            }
        }
        let mean = |(sum, count): (f64, i32)| sum / f64::from(count);
        let excess = mean(borders) - mean(others);
        assert!(excess < 0.05 / 255.0, "{name}: {excess}");
    }
}

#[test]
fn crowded_squares_give_the_same_picture() {
    // So many waves that no list holds their nodes.
    let mut random = Random(11);
    let waves: Vec<Wave> = (0..120)
        .map(|_| Wave {
            alpha: 0.01,
            placement: WavePlacement::At {
                anchor: Default::default(),
                direction: Vec3::new(1.0, 0.3 * random.signed(), 0.3 * random.signed()),
                follow: false,
                roll: random.signed(),
            },
            ..wave(WaveShape::Helix { length: 4.0, radius: 0.3, turns: 6.0, phase: 0.0 })
        })
        .collect();
    let [(_, view), ..] = views([64, 64]);
    let together = energies(&scene_of(&waves), &view);
    let mut sum = vec![0.0; together.len()];
    for part in waves.chunks(4) {
        for (sum, e) in sum.iter_mut().zip(energies(&scene_of(part), &view)) {
            *sum += e;
        }
    }
    let peak = sum.iter().copied().fold(0.0, f32::max);
    for (a, b) in together.iter().zip(&sum) {
        assert!((a - b).abs() <= 1e-4 * peak, "{a} and {b}");
    }
}

#[test]
fn a_picture_in_tiles_has_the_same_waves() {
    let scene =
        scene_of(&[wave(WaveShape::Helix { length: 4.0, radius: 0.5, turns: 5.0, phase: 0.0 })]);
    let [(_, view), ..] = views([150, 130]);
    let shared = genga_tests::shared();
    let _turn = shared.turn();
    let prepared = shared.renderer.prepare(&scene, &style("")).expect("the scene is valid");
    let draw = |limit| {
        let layers = &[LayerKind::Energy];
        let renderer = &shared.renderer;
        let mut progress = |_, _| {};
        let tiles = renderer.picture_in_tiles(&prepared, &view, layers, limit, &mut progress);
        pollster::block_on(tiles).expect("the picture can be drawn")
    };
    let (whole, tiled) = (draw(4096), draw(100));
    assert_eq!(whole.layers, tiled.layers);
    assert_eq!(whole.rgba, tiled.rgba);
}

#[test]
fn a_picture_in_tiles_has_the_same_waves_behind_a_wall() {
    let mut scene = wall();
    let placement = WavePlacement::At {
        anchor: genga::scene::WaveAnchor { nodes: Vec::new(), offset: Vec3::new(-1.5, 0.0, -0.6) },
        direction: Vec3::new(0.9, 0.1, 0.4),
        follow: false,
        roll: 0.0,
    };
    let shape = WaveShape::Helix { length: 4.0, radius: 0.5, turns: 5.0, phase: 0.0 };
    scene.waves = vec![Wave { placement, ..wave(shape) }];
    let view = View { supersample: 1, ..perspective_view([150, 130], 40.0, 6.0) };
    let shared = genga_tests::shared();
    let _turn = shared.turn();
    let prepared = shared.renderer.prepare(&scene, &style("")).expect("the scene is valid");
    let draw = |limit| {
        let mut progress = |_, _| {};
        let tiles = shared.renderer.picture_in_tiles(&prepared, &view, &[], limit, &mut progress);
        pollster::block_on(tiles).expect("the picture can be drawn").rgba
    };
    for (i, (a, b)) in draw(4096).iter().zip(draw(100)).enumerate() {
        let (x, y) = (i / 4 % 150, i / 600);
        assert!(a.abs_diff(b) <= 1, "at {x}, {y}: {a} and {b}");
    }
}

#[test]
fn orders_and_blend_spaces_decide_what_is_added_to_what() {
    let mut scene = Builder::new();
    let red = scene.material(genga::scene::Material {
        name: "red".to_owned(),
        base_color: Vec4::new(0.2, 0.0, 0.0, 1.0),
        unlit: true,
        ..Default::default()
    });
    scene.object("ball", shapes::cuboid(Vec3::ONE), Some(red), Default::default());
    let mut scene = scene.build();
    // A glow that is 0.4 everywhere near the middle: its energy is far above what its ramp ends at.
    let glow = |order, blend| Wave {
        order,
        blend,
        occluded: false,
        radius: Some(4.0),
        core: 1.0,
        color: Vec4::new(0.0, 0.4, 0.0, 1.0),
        ..wave(WaveShape::Sphere)
    };
    let view = View { supersample: 1, background: false, ..ortho_view([16, 16], 0.5) };
    let flat = style("[lines]\nmethod = \"none\"");
    let mut middle = |order, blend| {
        scene.waves = vec![glow(order, blend)];
        let energy = energies(&scene, &view)[8 * 16 + 8];
        let picture = draw(&scene, &flat, &view);
        let i = 4 * (8 * 16 + 8);
        (energy, [picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 3]])
    };
    let (_, [red, green, alpha]) = middle(WaveOrder::Under, WaveBlend::Display);
    assert_eq!((green, alpha), (0, 255), "the surface hides what is under it");
    let (energy, [same, green, _]) = middle(WaveOrder::Over, WaveBlend::Display);
    let wanted = (0.4 * energy * 255.0).min(255.0);
    assert!((f32::from(green) - wanted).abs() <= 1.0, "{green} and {wanted}");
    assert!(same.abs_diff(red) <= 1);
    let (energy, [_, green, _]) = middle(WaveOrder::LinesThrough, WaveBlend::Linear);
    let linear = (0.4_f32 + 0.055) / 1.055;
    let light = (linear.powf(2.4) * energy).min(1.0);
    let wanted = 255.0 * (1.055 * light.powf(1.0 / 2.4) - 0.055);
    assert!((f32::from(green) - wanted).abs() <= 1.5, "{green} and {wanted}");
}

#[test]
fn the_reference_method_comes_near_the_same_energy() {
    let [(_, view), ..] = views([48, 48]);
    for (name, shape) in wave_shapes() {
        // Simpson's rule does not see where flat ends begin, and Mesa's software driver ends loops
        // after 65,535 rounds, which solving for s in a polyline takes.
        if ["endless", "cylinder", "polyline"].contains(&name) {
            continue;
        }
        // A wide core, which 1000 points resolve.
        let wave = Wave { core: 0.2, ..wave(shape) };
        let exact = energies(&scene_of(std::slice::from_ref(&wave)), &view);
        let peak = exact.iter().copied().fold(0.0, f32::max);
        for (thinning, de_boor) in [(1, false), (2, false), (1, true)] {
            let mut scene = scene_of(std::slice::from_ref(&wave));
            scene.wave_method = WaveMethod::Simpson { points: 1000, thinning, de_boor };
            for (a, b) in exact.iter().zip(energies(&scene, &view)) {
                assert!((a - b).abs() <= 0.01 * a.max(peak / 20.0), "{name}: {a} and {b}");
            }
        }
    }
}

#[test]
fn an_orthographic_camera_sees_the_same_model() {
    for (name, shape) in wave_shapes() {
        let wave = Wave { reach: 60.0, ..wave(shape) };
        let mut view = View { supersample: 1, ..ortho_view([64, 64], 5.0) };
        view.camera.world_from_camera.translation.x = 2.0;
        assert!(matches!(view.camera.projection, Projection::Orthographic { .. }));
        let errors = errors(
            &wave,
            &view,
            &energies(&scene_of(std::slice::from_ref(&wave)), &view),
            120,
            &no_end,
        );
        assert!(errors.largest <= 0.01, "{name}: {errors:?}");
    }
}
