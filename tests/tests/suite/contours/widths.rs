//! What a line's width depends on, each against its curve in f64.

use genga::render::{Orbit, View};
use genga::scene::{LightKind, Pose, Primitive, Scene, Transform};
use genga::shapes;
use genga_tests::Eye;
use genga_tests::lines::figures::{Sight, contour_style};
use genga_tests::lines::ink::Ink;
use genga_tests::lines::outline::outline;
use genga_tests::scenes::{Builder, light, moved, orbit_view, ortho_view, parts, perspective_view};
use glam::{DVec3, Quat, Vec2, Vec3};

use super::ink_of;

/// Sum of the coverage in a row between two columns: the width of an upright line there.
fn row_width(ink: &Ink, y: u32, columns: std::ops::Range<u32>) -> f64 {
    columns.map(|x| f64::from(ink.at(i64::from(x), i64::from(y))) / 255.0).sum()
}

/// The same down a column.
fn column_width(ink: &Ink, x: u32, rows: std::ops::Range<u32>) -> f64 {
    rows.map(|y| f64::from(ink.at(i64::from(x), i64::from(y))) / 255.0).sum()
}

/// Walls whose left sides are seen at these places and distances from the eye, in a view from
/// z = 4 m along −Z, 1.2 m high at a distance of 1 m.
fn walls(places: &[(f32, f32)]) -> (Scene, View, Vec<f64>) {
    let view = perspective_view([256, 128], 2.0 * 0.6_f32.atan().to_degrees(), 4.0);
    let eye = Eye::new(&view);
    let mut scene = Builder::new();
    let mut columns = Vec::new();
    for (i, &(across, distance)) in places.iter().enumerate() {
        let x = across * distance;
        let wall = shapes::plane(Vec2::new(0.15 * distance, 20.0));
        let at = moved(x + 0.075 * distance, 0.0, 4.0 - distance);
        scene.object(&format!("wall {i}"), wall, None, at);
        columns.push(eye.project(DVec3::new(f64::from(x), 0.0, f64::from(4.0 - distance))).x);
    }
    (scene.build(), view, columns)
}

#[test]
fn depth_changes_widths_by_its_curve() {
    let distances = [2.0, 3.5, 5.0, 9.0];
    let (scene, view, columns) = walls(&[
        (-0.9, distances[0]),
        (-0.4, distances[1]),
        (0.1, distances[2]),
        (0.6, distances[3]),
    ]);
    // From the camera: 2 at 3 m and nearer, 0.5 at 7 m and farther.
    let by_camera = "width_by.depth = [[3, 2], [7, 0.5]]";
    // From the second wall: 1 there, and 2 half a metre before it.
    let by_object =
        "width_by.depth = [[-0.5, 2], [0, 1], [4, 0.5]]\nwidth_by.depth_from = \"wall 1\"";
    for (rest, factors) in [
        (by_camera, distances.map(|d| (2.0 - 1.5 * (f64::from(d) - 3.0) / 4.0).clamp(0.5, 2.0))),
        (by_object, [2.0, 1.0, 1.0 - 0.5 * 1.5 / 4.0, 0.5]),
    ] {
        let ink = ink_of(&scene, &contour_style(4.0, 128, rest), &view);
        for (column, factor) in columns.iter().zip(factors) {
            let near = (column - 8.0).max(0.0) as u32..(column + 8.0) as u32;
            let found = row_width(&ink, 64, near);
            assert!((found - 4.0 * factor).abs() < 0.1, "{rest}, {column}: {found} px");
        }
    }
}

#[test]
fn widths_in_metres_get_smaller_with_distance() {
    let distances = [2.0, 5.0, 8.0];
    let (scene, view, columns) =
        walls(&[(-0.8, distances[0]), (-0.2, distances[1]), (0.5, distances[2])]);
    let ink = ink_of(&scene, &contour_style(9.0, 128, "width_m = 0.1"), &view);
    let eye = Eye::new(&view);
    for (column, distance) in columns.iter().zip(distances) {
        let expected = 0.1 / eye.footprint(f64::from(distance));
        let near = (column - 8.0).max(0.0) as u32..(column + 8.0) as u32;
        let found = row_width(&ink, 64, near);
        assert!((found - expected).abs() < 0.1, "{distance} m: {found} px, not {expected}");
    }
}

#[test]
fn light_changes_widths_by_the_ramp_coordinate() {
    for degrees in [0.0_f32, 40.0, 90.0, 130.0] {
        let mut scene = Builder::new();
        scene.object("wall", shapes::plane(Vec2::splat(20.0)), None, moved(10.0, 0.0, 0.0));
        let from = Quat::from_rotation_y(degrees.to_radians()) * Vec3::Z;
        scene.light(light(LightKind::Directional, 1.0), from);
        let style = genga_tests::style(
            "[lines]\nreference_height = 128\n[[lines.sets]]\nwidth = 8\n\
             width_by.light = [[0, 1.5], [1, 0.25]]",
        );
        let ink = ink_of(&scene.build(), &style, &ortho_view([128, 128], 2.0));
        let t = 0.5 + 0.5 * f64::from(degrees.to_radians()).cos();
        let expected = 8.0 * (1.5 - 1.25 * t);
        let found = row_width(&ink, 64, 40..100);
        assert!((found - expected).abs() < 0.15, "{degrees}°: {found} px, not {expected}");
    }
}

/// A ball's mean and least width of its outline.
fn ball_width(radius: f32, height: f32, rest: &str) -> f64 {
    let mut scene = Builder::new();
    scene.object("ball", shapes::uv_sphere(96, 48, radius), None, Transform::default());
    let scene = scene.build();
    let view = ortho_view([192, 192], height);
    let ink = ink_of(&scene, &contour_style(4.0, 192, rest), &view);
    let sight = Sight::new(&scene, &Pose::rest(&scene), &view);
    let found = outline(&ink, &sight.lines, &sight.eye, DVec3::ZERO, 0.0);
    assert_eq!((found.open, found.doubled), (0, 0), "{radius} m, {rest}: {found:?}");
    // Largest difference from no width at all.
    found.width_off_px
}

#[test]
fn curvature_of_the_mesh_changes_widths() {
    // A ball's mean curvature is 1/r.
    let rest = "width_by.curvature = [[0, 0.5], [4, 1.5]]";
    for radius in [0.25_f32, 0.5, 1.0] {
        let expected = 4.0 * (0.5 + 0.25 / f64::from(radius)).min(1.5);
        // As large on the picture each time.
        let found = ball_width(radius, 3.0 * radius, rest);
        assert!((found / expected - 1.0).abs() < 0.1, "{radius} m: {found} px, not {expected}");
    }
}

#[test]
fn curvature_on_the_picture_changes_widths() {
    // 100 px over the radius: 2 for a circle of 50 px.
    let rest = "width_by.screen_curvature = [[0, 0.5], [4, 1.5]]";
    for radius_px in [30.0_f32, 45.0, 75.0] {
        let height = 192.0 / radius_px;
        let expected = 4.0 * (0.5 + 0.25 * 100.0 / f64::from(radius_px)).min(1.5);
        let found = ball_width(1.0, height, rest);
        assert!((found / expected - 1.0).abs() < 0.12, "{radius_px} px: {found}, not {expected}");
    }
    // A straight line has none.
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(Vec2::splat(20.0)), None, moved(10.0, 0.0, 0.0));
    let ink = ink_of(&scene.build(), &contour_style(4.0, 128, rest), &ortho_view([128, 128], 2.0));
    let found = row_width(&ink, 64, 40..100);
    assert!((found - 2.0).abs() < 0.1, "straight: {found} px");
}

/// Two faces of a roof whose ridge runs across the picture from `left` to `right` in metres; the
/// view is 2 m high.
pub(super) fn roof(ridges: &[[f32; 2]]) -> Scene {
    let mut scene = Builder::new();
    for (i, [left, right]) in ridges.iter().enumerate() {
        let y = 0.3 * (i as f32 - 0.5 * (ridges.len() as f32 - 1.0));
        let mut roof = Primitive::default();
        for side in [1.0, -1.0] {
            let normal = Vec3::new(0.0, side, 1.0).normalize();
            let first = roof.positions.len() as u32;
            for (x, down) in [(*left, 0.0), (*right, 0.0), (*right, 1.0), (*left, 1.0)] {
                let eave = Vec3::new(0.0, side * 0.12, -0.12) * down;
                roof.positions.push(Vec3::new(x, y, 0.0) + eave);
                roof.normals.push(normal);
            }
            let [b, c] = if side > 0.0 { [1, 2] } else { [2, 1] };
            roof.indices.extend([0, b, c].map(|corner| first + corner));
            let [b, c] = if side > 0.0 { [2, 3] } else { [3, 2] };
            roof.indices.extend([0, b, c].map(|corner| first + corner));
        }
        scene.object(&format!("roof {i}"), roof, None, Transform::default());
    }
    scene.build()
}

#[test]
fn lines_taper_from_the_ends_of_their_strokes() {
    // A ridge of 120 pixels, from 36 to 156.
    let scene = roof(&[[-0.6, 0.6]]);
    let view = ortho_view([192, 200], 2.0);
    let rest = "types = [\"crease\"]\nwidth_by.taper = [[0, 0.2], [40, 1]]";
    let ink = ink_of(&scene, &contour_style(6.0, 200, rest), &view);
    for x in 38..154 {
        let from_end = f64::from(x) + 0.5 - 36.0;
        let nearest = from_end.min(120.0 - from_end);
        let expected = 6.0 * (0.2 + 0.8 * nearest / 40.0).min(1.0);
        let found = column_width(&ink, x, 80..120);
        // Strokes change their width in pieces of up to 16 pixels, which rounds the curve's corner.
        assert!((found - expected).abs() < 0.5, "column {x}: {found} px, not {expected}");
    }
    // A closed line has no ends.
    let mut scene = Builder::new();
    scene.object("ball", shapes::uv_sphere(96, 48, 0.6), None, Transform::default());
    let scene = scene.build();
    let rest = "width_by.taper = [[0, 0], [1000, 1]]";
    let ink = ink_of(&scene, &contour_style(4.0, 200, rest), &view);
    let found = row_width(&ink, 100, 0..96);
    assert!((found - 4.0).abs() < 0.1, "a ball's outline: {found} px");
}

#[test]
fn factors_are_multiplied() {
    let mut wall = shapes::plane(Vec2::splat(20.0));
    wall.line_widths = vec![0.5; wall.positions.len()];
    let mut scene = Builder::new();
    scene.object("wall", wall, None, parts(Vec3::X * 10.0, Quat::IDENTITY, Vec3::ONE));
    let rest = "width_by.depth = [[0, 3]]\nwidth_by.screen_curvature = [[0, 1.5], [1, 9]]\n\
                [[override]]\nlines.width = 0.8";
    let scene = scene.build();
    let ink = ink_of(&scene, &contour_style(4.0, 128, rest), &ortho_view([128, 128], 2.0));
    let found = row_width(&ink, 64, 40..100);
    let expected = 4.0 * 0.5 * 3.0 * 1.5 * 0.8;
    assert!((found - expected).abs() < 0.1, "{found} px, not {expected}");
}

#[test]
fn widths_scale_with_the_pictures_height() {
    let scene = roof(&[[-0.6, 0.6]]);
    let rest = "types = [\"crease\"]\nwidth_by.taper = [[0, 0.2], [20, 1]]";
    let style = contour_style(3.0, 100, rest);
    let [small, large] =
        [1, 2].map(|n| ink_of(&scene, &style, &ortho_view([96 * n, 100 * n], 2.0)));
    for x in 20..76 {
        let [a, b] = [
            column_width(&small, x, 40..60),
            0.25 * (column_width(&large, 2 * x, 80..120)
                + column_width(&large, 2 * x + 1, 80..120)),
        ];
        // Pieces of lines have up to 16 pixels at either size.
        assert!((a - b).abs() < 0.5, "column {x}: {a} px, twice as large {b}");
    }
}

#[test]
fn an_unlit_scene_counts_as_facing_no_light() {
    // Without lights T is one half or as the style says; the width must not be undefined.
    let scene = roof(&[[-0.6, 0.6]]);
    let style = contour_style(4.0, 200, "width_by.light = [[0, 1], [1, 1]]");
    let orbit = Orbit { elevation_deg: 0.0, azimuth_deg: 0.0, ..Orbit::default() };
    let view = orbit_view(&scene, &orbit, [192, 200]);
    let plain = contour_style(4.0, 200, "");
    assert_eq!(ink_of(&scene, &style, &view), ink_of(&scene, &plain, &view));
}
