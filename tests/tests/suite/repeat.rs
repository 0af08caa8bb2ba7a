//! The same picture, drawn again or in parts.

use genga::render::{LayerData, LayerKind, Orbit, Picture, View};
use genga::scene::{AlphaMode, Material, Scene};
use genga::shapes;
use genga::style::Style;
use genga_tests::compare::byte_difference;
use genga_tests::scenes::{Builder, model, moved, orbit_view, parts, style};
use genga_tests::{Tolerance, difference, shared};
use glam::{Quat, Vec3, Vec4};

/// Balls, boxes and a pane of glass, one before the other.
fn crowd() -> Scene {
    let mut scene = Builder::new();
    let red = scene.colored("red", [0.7, 0.1, 0.05]);
    let glass = scene.material(Material {
        base_color: Vec4::new(0.3, 0.6, 0.9, 0.6),
        alpha: AlphaMode::Blend,
        double_sided: true,
        ..Material::default()
    });
    scene.object("ball", shapes::uv_sphere(40, 20, 0.8), Some(red), moved(-0.4, 0.2, 0.0));
    let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.5, 0.3, 0.1);
    let mirror = parts(Vec3::new(0.6, -0.2, 0.4), turn, Vec3::new(-1.0, 1.2, 0.8));
    scene.object("box", shapes::cuboid(Vec3::ONE), None, mirror);
    let pane = shapes::plane(glam::Vec2::splat(1.0));
    scene.object("pane", pane, Some(glass), moved(-0.2, -0.4, 1.1));
    scene.build()
}

fn picture(scene: &Scene, style: &Style, view: &View, max_texels: u32) -> Picture {
    layered(scene, style, view, max_texels, &LayerKind::ALL)
}

fn layered(
    scene: &Scene,
    style: &Style,
    view: &View,
    max_texels: u32,
    layers: &[LayerKind],
) -> Picture {
    let shared = shared();
    let _turn = shared.turn();
    let renderer = &shared.renderer;
    let prepared = renderer.prepare(scene, style).expect("the scene can be prepared");
    let progress = &mut |_, _| {};
    let drawn = renderer.picture_in_tiles(&prepared, view, layers, max_texels, progress);
    pollster::block_on(drawn).expect("the picture can be drawn")
}

/// Asserts that two pictures and all their layers are the same within 1/255; distances within a
/// hundred-thousandth, normals within a step of half floats, ids exactly.
fn assert_same(whole: &Picture, parts: &Picture, what: &str) {
    let same = Tolerance::same_picture();
    let found = difference(whole, parts, same);
    assert!(!found.is_too_much, "{what}: the picture: {found:?}");
    for (a, b) in whole.layers.iter().zip(&parts.layers) {
        let what = format!("{what}: {}", a.kind.name());
        match (&a.data, &b.data) {
            (LayerData::Rgba8(a), LayerData::Rgba8(b)) => {
                let found = byte_difference(whole.width, a, b, same);
                assert!(!found.is_too_much, "{what}: {found:?}");
            }
            (LayerData::F32 { values: a, channels }, LayerData::F32 { values: b, .. }) => {
                for (i, (a, b)) in a.iter().zip(b).enumerate() {
                    let allowed = match channels {
                        3 => 1.0 / 1024.0,
                        // Coverage, of 8 bits.
                        4 => 1.001 / 255.0,
                        _ => 1e-5 * a,
                    };
                    let near = a == b || (a - b).abs() <= allowed;
                    assert!(near, "{what}: {a} and {b} at pixel {}", i / channels);
                }
            }
            (a, b) => assert!(a == b, "{what}: the ids differ"),
        }
    }
}

fn lined(method: &str) -> Style {
    style(&format!(
        "[background]\nbottom = \"#204060\"\n[paint.ramp]\nstops = [{{ at = 0, color = \"#446\" }}, \
         {{ at = 0.5, color = \"#fff\" }}]\n[lines]\nmethod = \"{method}\"\nreference_height = 180\n\
         [[lines.sets]]\nname = \"inner\"\ntypes = [\"crease\", \"material\"]\ncolor = \"#c02020\"\n\
         width = 1.5\n[[lines.sets]]\nname = \"outer\"\ntypes = [\"silhouette\", \"object\"]\n\
         width = 4"
    ))
}

#[test]
fn tiles_equal_the_whole() {
    let scene = crowd();
    for method in ["contour", "reference", "hull", "rim", "image"] {
        let style = lined(method);
        for (supersample, size, orthographic) in
            [(1, [201, 167], false), (2, [199, 173], true), (3, [151, 183], false)]
        {
            let orbit = Orbit { orthographic, zoom: 1.2, ..Orbit::default() };
            let view = View { supersample, ..orbit_view(&scene, &orbit, size) };
            let whole = picture(&scene, &style, &view, 4096);
            // Tiles of 160 pixels, of which the apron takes two thirds.
            let tiled = picture(&scene, &style, &view, 160 * supersample);
            assert_same(&whole, &tiled, &format!("{method}, {supersample} texels"));
        }
    }
}

#[test]
fn tiles_keep_soft_edges() {
    // Rims and tones are antialiased by derivatives.
    let scene = model("teapot-on-box");
    for method in ["rim", "none"] {
        let orbit = Orbit { azimuth_deg: 218.0, elevation_deg: 33.0, ..Orbit::default() };
        let view = View { supersample: 1, ..orbit_view(&scene, &orbit, [411, 293]) };
        let whole = picture(&scene, &lined(method), &view, 4096);
        // Tiles that begin at odd pixels among others.
        let tiled = picture(&scene, &lined(method), &view, 231);
        let found = difference(&whole, &tiled, Tolerance::same_picture());
        assert!(!found.is_too_much, "{method}: {found:?}");
    }
}

#[test]
fn the_same_picture_has_the_same_bytes() {
    let scene = model("teapot-on-box");
    let view = orbit_view(&scene, &Orbit::default(), [160, 120]);
    let style = lined("contour");
    let first = picture(&scene, &style, &view, 4096);
    for run in 1..10 {
        assert!(picture(&scene, &style, &view, 4096) == first, "run {run} differs");
    }
}

#[test]
fn another_picture_between_changes_nothing() {
    let (scene, style) = (crowd(), lined("contour"));
    let view = orbit_view(&scene, &Orbit::default(), [120, 90]);
    let first = picture(&scene, &style, &view, 4096);
    let other = orbit_view(&scene, &Orbit { azimuth_deg: 200.0, ..Orbit::default() }, [120, 90]);
    let second = picture(&scene, &lined("image"), &other, 4096);
    assert!(first != second);
    assert!(picture(&scene, &style, &view, 4096) == first);
}

#[test]
fn two_threads_may_draw_at_once() {
    let shared = shared();
    let _turn = shared.turn();
    let renderer = &shared.renderer;
    let scene = crowd();
    let prepared = ["contour", "image"]
        .map(|method| renderer.prepare(&scene, &lined(method)).expect("the scene is valid"));
    let views = [20.0, 200.0].map(|azimuth_deg| {
        let orbit = Orbit { azimuth_deg, ..Orbit::default() };
        View { supersample: 1, ..orbit_view(&scene, &orbit, [120, 90]) }
    });
    let draw = |i: usize| {
        let layers = &LayerKind::ALL;
        pollster::block_on(renderer.picture(&prepared[i], &views[i], layers, &mut |_, _| {}))
            .expect("the picture can be drawn")
    };
    let alone = [draw(0), draw(1)];
    std::thread::scope(|threads| {
        for (i, alone) in alone.iter().enumerate() {
            threads.spawn(move || {
                for run in 0..12 {
                    assert!(draw(i) == *alone, "picture {i} differs in run {run}");
                }
            });
        }
    });
}

#[test]
fn a_large_picture_of_a_figure_is_the_same_again() {
    // As many lines as a page has: none may be lost by the order in which they are found.
    let scene = model("hero");
    let style = Style::preset("blueprint").expect("it is a preset");
    let view = View { supersample: 1, ..orbit_view(&scene, &Orbit::default(), [1200, 1200]) };
    let draw = || layered(&scene, &style, &view, 4096, &[]).rgba;
    let first = draw();
    for _ in 0..2 {
        let differ = first.iter().zip(draw()).filter(|(a, b)| **a != *b).count();
        assert_eq!(differ, 0, "values differ");
    }
}
