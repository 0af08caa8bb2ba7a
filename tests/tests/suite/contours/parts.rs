//! Which parts of lines are drawn: visible or hidden ones, through what, long enough, without
//! gaps, in dashes.

use genga::scene::{Scene, Transform};
use genga::shapes;
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::ink::Ink;
use genga_tests::scenes::{Builder, moved, ortho_view, parts};
use glam::{Quat, Vec2, Vec3};

use super::ink_of;
use super::widths::roof;

fn inked(ink: &Ink, columns: std::ops::Range<u32>, rows: std::ops::Range<u32>) -> usize {
    ink.places(128).filter(|(x, y)| columns.contains(x) && rows.contains(y)).count()
}

/// A long thin board across the picture, and one before its middle; 128 pixels for 2 m.
fn board_behind_board() -> Scene {
    let mut scene = Builder::new();
    let [wood, glass] = [[0.5; 3], [0.9; 3]].map(|rgb| scene.colored("m", rgb));
    scene.raw().materials[wood].name = "wood".to_owned();
    scene.raw().materials[glass].name = "glass".to_owned();
    scene.object("far", shapes::plane(Vec2::new(1.6, 0.4)), Some(wood), Transform::default());
    scene.object("near", shapes::plane(Vec2::new(0.5, 1.2)), Some(glass), moved(0.0, 0.0, 0.5));
    scene.build()
}

#[test]
fn a_set_draws_the_visible_or_the_hidden_parts() {
    let scene = board_behind_board();
    let view = ortho_view([128, 128], 2.0);
    // The far board's upper side runs at row 64 − 12.8, the near one hides columns 48 to 80.
    let upper = 49..54;
    for (part, [beside, behind]) in [("visible", [true, false]), ("hidden", [false, true])] {
        let rest = format!("objects = [\"far\"]\nparts = \"{part}\"");
        let ink = ink_of(&scene, &contour_style(2.0, 128, &rest), &view);
        for (columns, is_drawn) in [(18..44, beside), (52..76, behind), (84..108, beside)] {
            let count = inked(&ink, columns.clone(), upper.clone());
            let width = columns.len();
            let is_right = if is_drawn { count > width } else { count == 0 };
            assert!(is_right, "{part}, columns {columns:?}: {count} pixels");
        }
    }
}

#[test]
fn hidden_parts_can_be_dashed() {
    let scene = board_behind_board();
    let view = ortho_view([128, 128], 2.0);
    let rest = "objects = [\"far\"]\nparts = \"hidden\"\ndash = [5, 3]";
    let ink = ink_of(&scene, &contour_style(2.0, 128, rest), &view);
    let row: Vec<bool> = (49..79).map(|x| (49..54).any(|y| ink.at(x, y) >= 128)).collect();
    let dark = row.iter().filter(|dark| **dark).count() as f64 / row.len() as f64;
    let starts = row.windows(2).filter(|pair| !pair[0] && pair[1]).count();
    assert!((dark - 5.0 / 8.0).abs() < 0.12, "{dark} of the line is dark: {row:?}");
    assert!((3..=4).contains(&starts), "{starts} dashes begin: {row:?}");
}

#[test]
fn lines_can_be_drawn_through_a_material() {
    let scene = board_behind_board();
    let view = ortho_view([128, 128], 2.0);
    for (through, is_drawn) in [("glass", true), ("wood", false), ("*", true)] {
        let rest = format!("objects = [\"far\"]\nthrough = [\"{through}\"]");
        let ink = ink_of(&scene, &contour_style(2.0, 128, &rest), &view);
        let count = inked(&ink, 52..76, 49..54);
        let is_right = if is_drawn { count >= 2 * 24 } else { count == 0 };
        assert!(is_right, "through {through}: {count} pixels behind the near board");
        assert!(inked(&ink, 18..44, 49..54) > 26, "through {through}: beside it");
    }
}

#[test]
fn short_strokes_are_left_out_and_longer_ones_are_thinner() {
    // Ridges of 12, 30 and 90 pixels.
    let scene = roof(&[[-0.06, 0.06], [-0.15, 0.15], [-0.45, 0.45]]);
    let view = ortho_view([192, 200], 2.0);
    let mut style = contour_style(4.0, 200, "types = [\"crease\"]");
    style.lines.strokes.min_length = 20.0;
    style.lines.strokes.gap = 0.0;
    let ink = ink_of(&scene, &style, &view);
    let middle = |row: u32| -> f64 {
        (row - 8..row + 8).map(|y| f64::from(ink.at(96, i64::from(y))) / 255.0).sum()
    };
    // The first roof is the lowest: rows 130, 100 and 70.
    assert!(middle(130) == 0.0, "12 px: {}", middle(130));
    assert!((middle(100) - 2.0).abs() < 0.3, "30 px: {}", middle(100));
    assert!((middle(70) - 4.0).abs() < 0.1, "90 px: {}", middle(70));
}

#[test]
fn a_small_gap_does_not_end_a_stroke() {
    // A ridge of 40 pixels behind a post of 4: two parts of 18.
    let ridge = roof(&[[-0.2, 0.2]]);
    let mut scene = Builder::new();
    *scene.raw() = ridge;
    scene.object("post", shapes::plane(Vec2::new(0.04, 1.8)), None, moved(0.0, 0.0, 0.5));
    let scene = scene.build();
    let view = ortho_view([192, 200], 2.0);
    for (gap, is_drawn) in [(0.0, false), (10.0, true)] {
        let mut style = contour_style(2.0, 200, "types = [\"crease\"]\nobjects = [\"roof*\"]");
        style.lines.strokes.min_length = 19.0;
        style.lines.strokes.gap = gap;
        let ink = ink_of(&scene, &style, &view);
        let beside = inked(&ink, 78..90, 95..105) + inked(&ink, 102..114, 95..105);
        assert_eq!(beside > 24, is_drawn, "gap {gap}: {beside} pixels");
        // What stands before a closed gap still covers it.
        assert_eq!(inked(&ink, 95..97, 95..105), 0, "gap {gap}: ink on the post");
    }
}

#[test]
fn texture_seams_are_lines_where_they_are_asked_for() {
    // A bar's texture has its seam at −Z: seen from behind, down the middle.
    let mut scene = Builder::new();
    let turn = parts(Vec3::ZERO, Quat::from_rotation_y(std::f32::consts::PI), Vec3::ONE);
    scene.object("bar", shapes::cylinder(32, 0.5, 3.0), None, turn);
    let scene = scene.build();
    let view = ortho_view([128, 128], 2.0);
    for uv_seams in [false, true] {
        let mut style = contour_style(3.0, 128, "types = [\"uv-seam\"]");
        style.lines.detect.uv_seams = uv_seams;
        let ink = ink_of(&scene, &style, &view);
        let width: f64 = (50..78).map(|x| f64::from(ink.at(x, 64)) / 255.0).sum();
        let expected = if uv_seams { 3.0 } else { 0.0 };
        assert!((width - expected).abs() < 0.1, "uv_seams = {uv_seams}: {width} px");
        assert_eq!(inked(&ink, 0..50, 0..128) + inked(&ink, 78..128, 0..128), 0, "elsewhere");
    }
}
