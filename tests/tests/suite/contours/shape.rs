//! Strokes have the width that is asked for, round ends, and no dents at their joints.

use genga::scene::{Primitive, Scene, Transform};
use genga::shapes;
use genga_tests::Eye;
use genga_tests::lines::capsules::union_of_capsules;
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::ink::Ink;
use genga_tests::scenes::{Builder, ortho_view, parts};
use glam::{DVec2, DVec3, Quat, Vec2, Vec3};

use super::ink_of;

/// A wall whose left side runs through the middle of the picture, `degrees` from upright.
fn wall(degrees: f32) -> Scene {
    let mut scene = Builder::new();
    let turn = Quat::from_rotation_z(degrees.to_radians());
    let at = parts(turn * Vec3::new(10.0, 0.0, 0.0), turn, Vec3::ONE);
    scene.object("wall", shapes::plane(Vec2::splat(20.0)), None, at);
    scene.build()
}

#[test]
fn straight_lines_are_1_to_16_pixels_wide() {
    let view = ortho_view([128, 128], 2.0);
    for width in 1..=16 {
        let width = f64::from(width);
        for degrees in [0.0, 7.0, 45.0, 80.0] {
            let ink = ink_of(&wall(degrees), &contour_style(width, 128, ""), &view);
            let turn = f64::from(degrees).to_radians();
            // Across the line, from places on it.
            for along in [-30.0, -11.3, 0.0, 4.7, 25.0] {
                let [out, up] =
                    [DVec2::new(turn.cos(), -turn.sin()), DVec2::new(-turn.sin(), -turn.cos())];
                let middle = DVec2::splat(64.0) + up * along;
                let steps = 8 * 24;
                let values = (-steps..=steps).map(|i| {
                    let p = middle + out * (f64::from(i) / 8.0);
                    ink.between(p.x, p.y)
                });
                let found: f64 = values.sum::<f64>() / 8.0;
                let what = format!("{width} px, {degrees}°, {along} px along");
                assert!((found - width).abs() <= 0.25, "{what}: {found} px");
            }
        }
    }
}

/// A flat band whose sides turn by the same angle to and fro; corners inside have `degrees`.
fn zigzag(degrees: f64) -> (Primitive, Vec<DVec3>) {
    let half = degrees.to_radians() / 2.0;
    // Sides of a corner lie half the angle off the axis of the corner.
    let step = DVec2::new(half.sin(), half.cos()) * 0.55_f64.min(0.42 / half.sin());
    let middle: Vec<DVec2> =
        (0..5).map(|i| DVec2::new(f64::from(i) * step.x, f64::from(i % 2) * step.y)).collect();
    let center = DVec2::new(2.0 * step.x, 0.5 * step.y);
    let across = DVec2::new(0.0, 0.16 / half.sin().max(0.25));
    let mut band = Primitive::default();
    for p in &middle {
        for side in [-1.0, 1.0] {
            let p = *p - center + across * side;
            band.positions.push(Vec3::new(p.x as f32, p.y as f32, 0.0));
            band.normals.push(Vec3::Z);
        }
    }
    for i in 0..4 {
        let first = 2 * i;
        band.indices.extend([0, 2, 3, 0, 3, 1].map(|corner| first + corner));
    }
    let upper = (0..5).map(|i| 2 * i + 1);
    let outline = (0..5).map(|i| 2 * i).chain(upper.rev());
    let outline = outline.map(|i: usize| band.positions[i].as_dvec3()).collect();
    (band, outline)
}

/// A triangle whose lowest corner has `degrees`.
fn wedge(degrees: f64) -> (Primitive, Vec<DVec3>) {
    let half = degrees.to_radians() / 2.0;
    let side = 1.3_f64.min(0.8 / half.sin());
    let top = DVec2::new(half.sin(), half.cos()) * side;
    let corners = [[0.0, -0.5], [top.x, top.y - 0.5], [-top.x, top.y - 0.5]];
    let positions = corners.map(|[x, y]| Vec3::new(x as f32, y as f32, 0.0)).to_vec();
    let outline = positions.iter().map(|p| p.as_dvec3()).collect();
    let normals = vec![Vec3::Z; 3];
    (Primitive { positions, normals, indices: vec![0, 1, 2], ..Primitive::default() }, outline)
}

/// Part of all pixels that differ by more than 2/255.
fn outliers(a: &Ink, b: &Ink) -> f64 {
    let differ = a.values.iter().zip(&b.values).filter(|(a, b)| a.abs_diff(**b) > 2);
    differ.count() as f64 / a.values.len() as f64
}

/// Draws flat shapes whose corners have these angles, and compares with capsules round their
/// outlines.
fn assert_unions(name: &str, shape: fn(f64) -> (Primitive, Vec<DVec3>), angles: &[i32]) {
    let size = [192, 192];
    let view = ortho_view(size, 2.0);
    let eye = Eye::new(&view);
    for degrees in angles {
        let (mesh, outline) = shape(f64::from(*degrees));
        let turn = Quat::from_rotation_z(0.13);
        let mut scene = Builder::new();
        scene.object(name, mesh, None, parts(Vec3::ZERO, turn, Vec3::ONE));
        let scene = scene.build();
        let corners: Vec<DVec2> =
            outline.iter().map(|p| eye.project(turn.as_dquat() * *p)).collect();
        let next = corners.iter().cycle().skip(1);
        let segments: Vec<_> = corners.iter().zip(next).map(|(a, b)| [*a, *b]).collect();
        for width in [2.0, 5.0, 11.0] {
            let drawn = ink_of(&scene, &contour_style(width, size[1], ""), &view);
            let expected = union_of_capsules(&segments, width, size);
            let part = outliers(&drawn, &expected);
            assert!(part <= 0.001, "{name}, {degrees}°, {width} px: {part} of the pixels");
        }
    }
}

const ANGLES: [i32; 17] =
    [10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170];

#[test]
fn polylines_are_unions_of_capsules_at_every_angle() {
    assert_unions("wedge", wedge, &ANGLES);
    assert_unions("zigzag", zigzag, &ANGLES);
}

#[test]
fn an_objects_transform_changes_no_width() {
    let mut scene = Builder::new();
    let squeezed = Transform::Parts {
        translation: Vec3::ZERO,
        rotation: Quat::from_rotation_z(0.4),
        scale: Vec3::new(-0.5, 3.0, 1.0),
    };
    scene.object("plate", shapes::plane(Vec2::new(1.0, 0.4)), None, squeezed);
    let scene = scene.build();
    let view = ortho_view([128, 128], 2.0);
    let eye = Eye::new(&view);
    let corner = |x: f64, y: f64| {
        let p = DVec3::new(-0.5 * 0.5 * x, 3.0 * 0.2 * y, 0.0);
        eye.project(Quat::from_rotation_z(0.4).as_dquat() * p)
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let segments: Vec<_> = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect();
    let drawn = ink_of(&scene, &contour_style(4.0, 128, ""), &view);
    let part = outliers(&drawn, &union_of_capsules(&segments, 4.0, [128, 128]));
    assert!(part <= 0.001, "{part} of the pixels");
}
