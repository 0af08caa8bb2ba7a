//! Outlines are closed, whatever draws them; hulls neither tear nor fill.

use std::collections::VecDeque;

use genga::render::{LayerKind, Orbit, Picture, View};
use genga::scene::{Scene, Transform};
use genga::shapes;
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::holes::holes;
use genga_tests::scenes::{Builder, model, orbit_view, parts, style};
use genga_tests::{Pixels, draw, draw_layers};
use glam::{Quat, Vec3};

fn object(primitive: genga::scene::Primitive, transform: Transform) -> Scene {
    let mut scene = Builder::new();
    scene.object("object", primitive, None, transform);
    scene.build()
}

/// White on white with black lines, so that only lines are dark.
fn drawing(scene: &Scene, method: &str, width: f32, orbit: &Orbit) -> Picture {
    let style = style(&format!(
        "[paint]\nbase = \"#ffffff\"\n[lines]\nmethod = \"{method}\"\nreference_height = 128\n\
         [[lines.sets]]\nwidth = {width}"
    ));
    draw(scene, &style, &orbit_view(scene, orbit, [128, 128]))
}

/// Pixels that paint poured in at the picture's border reaches, through sides and corners of
/// pixels, without crossing any that are darker than a line's soft side.
fn poured(picture: &Picture) -> Vec<bool> {
    let (width, height) = (picture.width, picture.height);
    let index = |x: u32, y: u32| (y * width + x) as usize;
    let is_wall = |x: u32, y: u32| picture.at(x, y)[0] < 200;
    let mut reached = vec![false; (width * height) as usize];
    let border =
        picture.places().filter(|&(x, y)| x == 0 || y == 0 || x + 1 == width || y + 1 == height);
    let mut queue: VecDeque<_> = border.filter(|&(x, y)| !is_wall(x, y)).collect();
    queue.iter().for_each(|&(x, y)| reached[index(x, y)] = true);
    while let Some((x, y)) = queue.pop_front() {
        for next_y in y.saturating_sub(1)..=(y + 1).min(height - 1) {
            for next_x in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                if !reached[index(next_x, next_y)] && !is_wall(next_x, next_y) {
                    reached[index(next_x, next_y)] = true;
                    queue.push_back((next_x, next_y));
                }
            }
        }
    }
    reached
}

/// Asserts that no paint comes to the middle, which itself is not dark.
fn assert_closed(picture: &Picture, what: &str) {
    let (x, y) = (picture.width / 2, picture.height / 2);
    assert!(picture.at(x, y)[0] > 200, "{what}: the middle is dark");
    let reached = poured(picture);
    assert!(reached[0], "{what}: even the corner is dark");
    assert!(!reached[(y * picture.width + x) as usize], "{what}: the outline is open");
}

#[test]
fn a_balls_outline_is_closed_in_every_method() {
    for (segments, rings) in [(12, 6), (48, 24)] {
        let scene = object(shapes::uv_sphere(segments, rings, 1.0), Transform::default());
        for method in ["contour", "reference", "hull", "image", "rim"] {
            for orthographic in [false, true] {
                for azimuth_deg in [0.0, 31.0, 77.0] {
                    // A rim needs normals that turn from the eye within each face.
                    if method == "rim" && segments < 48 {
                        continue;
                    }
                    let orbit = Orbit {
                        azimuth_deg,
                        orthographic,
                        elevation_deg: 13.0,
                        ..Orbit::default()
                    };
                    let picture = drawing(&scene, method, 3.0, &orbit);
                    let what = format!("{method}, {segments} segments, {azimuth_deg}°");
                    assert_closed(&picture, &what);
                }
            }
        }
    }
}

#[test]
fn a_hull_does_not_tear_at_split_normals() {
    let squeezed = parts(Vec3::ZERO, Quat::from_rotation_x(0.3), Vec3::new(1.0, 2.0, 0.7));
    let cube = || shapes::cuboid(Vec3::ONE);
    for (name, scene) in
        [("cube", object(cube(), Transform::default())), ("box", object(cube(), squeezed))]
    {
        for azimuth_deg in [20.0, 45.0, 70.0, 160.0, 250.0] {
            for orthographic in [false, true] {
                let orbit =
                    Orbit { azimuth_deg, orthographic, elevation_deg: 27.0, ..Orbit::default() };
                // The front edge passes the middle of some of the pictures: look from outside only.
                let picture = drawing(&scene, "hull", 4.0, &orbit);
                let plain = drawing(&scene, "none", 4.0, &orbit);
                assert!(plain.rgba.iter().all(|&channel| channel == 255));
                assert_closed(&picture, &format!("{name}, {azimuth_deg}°"));
            }
        }
    }
}

#[test]
fn a_hulls_width_is_the_lines_width() {
    // Seen from the front, a ball's outline in an orthographic view is a ring.
    let scene = object(shapes::uv_sphere(64, 32, 1.0), Transform::default());
    let orbit =
        Orbit { azimuth_deg: 0.0, elevation_deg: 0.0, orthographic: true, ..Orbit::default() };
    for width in [2.0, 4.0, 6.5] {
        let picture = drawing(&scene, "hull", width, &orbit);
        let row: f64 = (0..64).map(|x| 1.0 - f64::from(picture.at(x, 64)[0]) / 255.0).sum();
        let expected = f64::from(width);
        assert!((row - expected).abs() < 0.25, "{row} px, not {expected}");
    }
}

#[test]
fn a_hulls_width_can_be_in_metres() {
    let scene = object(shapes::uv_sphere(64, 32, 1.0), Transform::default());
    let orbit =
        Orbit { azimuth_deg: 0.0, elevation_deg: 0.0, orthographic: true, ..Orbit::default() };
    let view = orbit_view(&scene, &orbit, [128, 128]);
    let metres_per_pixel = genga_tests::Eye::new(&view).footprint(1.0);
    for width_m in [0.02, 0.08] {
        let style = style(&format!(
            "[paint]\nbase = \"#ffffff\"\n[lines]\nmethod = \"hull\"\nhull.width_m = {width_m}"
        ));
        let picture = draw(&scene, &style, &view);
        let row: f64 = (0..64).map(|x| 1.0 - f64::from(picture.at(x, 64)[0]) / 255.0).sum();
        let expected = width_m / metres_per_pixel;
        assert!((row - expected).abs() < 0.25, "{row} px, not {expected}");
    }
}

#[test]
fn a_hull_without_width_fills_nothing() {
    let scene = object(shapes::uv_sphere(24, 12, 1.0), Transform::default());
    let orbit = Orbit::default();
    let plain = drawing(&scene, "none", 3.0, &orbit);
    assert_eq!(drawing(&scene, "hull", 0.0, &orbit), plain);
    let style = style(
        "[paint]\nbase = \"#ffffff\"\n[lines]\nmethod = \"hull\"\nreference_height = 128\n\
         [[override]]\nlines.width = 0",
    );
    assert_eq!(draw(&scene, &style, &orbit_view(&scene, &orbit, [128, 128])), plain);
}

/// Bodies whose outline is not where their normals turn away: bent ones, and coarse ones with
/// faces that are nearly in one plane.
#[test]
fn contour_leaves_no_holes_in_outlines() {
    let twisted = {
        let mut bar = shapes::cylinder(7, 0.4, 1.2);
        // Shaded as one surface, as coarse models are, and no longer of plane sides.
        for (p, n) in bar.positions.iter_mut().zip(&mut bar.normals) {
            *p = Quat::from_rotation_y(0.012 * p.y) * *p;
            *n = Vec3::new(p.x, 0.8 * p.y, p.z).normalize();
        }
        object(bar, Transform::default())
    };
    for (name, scene) in [("hero", model("hero")), ("bar", twisted)] {
        for i in 0..8_u8 {
            let orbit = Orbit {
                azimuth_deg: 45.0 * f32::from(i) + 30.0,
                elevation_deg: 7.5 * f32::from(i % 3),
                ..Orbit::default()
            };
            let view = View { supersample: 1, ..orbit_view(&scene, &orbit, [320, 240]) };
            let layers = [LayerKind::Lines, LayerKind::Depth];
            let picture = draw_layers(&scene, &contour_style(2.0, 240, ""), &view, &layers);
            let holes = holes(&picture);
            let worst = holes.iter().max_by_key(|hole| hole.extent());
            assert!(worst.is_none_or(|hole| hole.extent() <= 2), "{name}, camera {i}: {worst:?}");
        }
    }
}
