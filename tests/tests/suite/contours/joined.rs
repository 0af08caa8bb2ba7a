//! Lines hold together: about their thresholds, over gaps, and from one line set to the next.

use genga::scene::{Node, Primitive, Scene, Transform};
use genga::shapes;
use genga_tests::edges::cameras;
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::ink::Ink;
use genga_tests::lines::measure;
use genga_tests::lines::subjects::subject;
use genga_tests::scenes::{Builder, ortho_view, style};
use glam::{Vec2, Vec3};

use super::ink_of;

/// Pixels of the pictures, and of a metre in them.
const SIZE: u32 = 128;
const PIXELS: f32 = 64.0;

/// A sheet before a wall, its upper side so many pixels before it, at even steps from column 16 to
/// 112. The sheet's edge is folded back and down, so that its step is all that is seen of it.
fn ledge(heights_px: &[f32]) -> Scene {
    let mut sheet = Primitive::default();
    for (i, height) in heights_px.iter().enumerate() {
        let x = -0.75 + 1.5 * i as f32 / (heights_px.len() - 1) as f32;
        let z = height / PIXELS;
        let folded = Vec3::new(x, -0.05, 0.5 * z);
        sheet.positions.extend([Vec3::new(x, -0.6, z), Vec3::new(x, 0.0, z)]);
        sheet.positions.extend([Vec3::new(x, 0.0, z), folded]);
        sheet.normals.extend([Vec3::Z, Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Z]);
    }
    for i in 0..heights_px.len() as u32 - 1 {
        let (a, b) = (4 * i, 4 * i + 4);
        sheet.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
        sheet.indices.extend([a + 2, b + 2, b + 3, a + 2, b + 3, a + 3]);
    }
    let mut scene = Builder::new();
    let mut wall = shapes::plane(Vec2::splat(4.0));
    for place in &mut wall.positions {
        place.z -= 0.2 / PIXELS;
    }
    one_object(&mut scene, [wall, sheet]);
    scene.build()
}

fn one_object(scene: &mut Builder, [first, second]: [Primitive; 2]) {
    let mesh = scene.mesh(first);
    scene.raw().meshes[mesh].primitives.push(second);
    scene.node(Node { mesh: Some(mesh), ..Node::default() });
}

/// The coverage of the ledge's line in each column, away from its ends.
fn columns(ink: &Ink) -> Vec<f64> {
    let of = |x: i64| (54..74).map(|y| f64::from(ink.at(x, y)) / 255.0).sum();
    (24..104).map(of).collect()
}

/// Steps by turns, each for six pixels, with a silhouette from 2 pixels on.
fn by_turns(low_px: f32, high_px: f32) -> Vec<f64> {
    let heights: Vec<f32> = (0..17).map(|i| if i % 2 == 0 { low_px } else { high_px }).collect();
    let rest = "types = [\"silhouette\"]";
    let mut style = contour_style(6.0, SIZE, rest);
    style.lines.detect.depth = 8.0;
    style.lines.detect.laplacian = 0.0;
    style.lines.strokes.gap = 0.0;
    style.lines.strokes.min_length = 0.0;
    columns(&ink_of(&ledge(&heights), &style, &ortho_view([SIZE, SIZE], 2.0)))
}

#[test]
fn strokes_go_on_where_a_step_is_now_over_and_now_under_its_threshold() {
    // Whole, dashed before it was asked how surely the line is there.
    let found = by_turns(4.5, 5.5);
    assert!(found.iter().all(|width| (width - 6.0).abs() < 0.3), "{found:.1?}");
    let found = by_turns(1.5, 3.5);
    assert!(found.iter().all(|width| *width > 0.7), "torn: {found:.1?}");
    // Nothing, and not the tops of steps that are mostly too small.
    let found = by_turns(0.0, 2.1);
    assert!(found.iter().all(|width| *width < 0.1), "crumbs: {found:.1?}");
}

#[test]
fn an_outline_hands_over_to_a_thinner_line_little_by_little() {
    // From 8 pixels to 1: silhouette first, then only a crease.
    let heights: Vec<f32> = (0..17).map(|i| (8.0 - (i - 5) as f32 * 3.0).clamp(1.0, 8.0)).collect();
    let mut style = style(&format!(
        "[light]\nreplace_model_lights = true\n[lines]\nmethod = \"contour\"\n\
         reference_height = {SIZE}\n\
         [[lines.sets]]\nname = \"inner\"\nwidth = 2\ntypes = [\"crease\"]\n\
         [[lines.sets]]\nname = \"outline\"\nwidth = 8\ntypes = [\"silhouette\"]\n"
    ));
    style.lines.detect.depth = 8.0;
    style.lines.detect.laplacian = 0.0;
    let widths = columns(&ink_of(&ledge(&heights), &style, &ortho_view([SIZE, SIZE], 2.0)));
    let (first, last) = (widths[4], widths[widths.len() - 4]);
    assert!(
        (first - 8.0).abs() < 0.2 && (last - 2.0).abs() < 0.2,
        "{first} to {last}: {widths:.1?}"
    );
    let jump = widths.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(jump < 1.0, "a jump of {jump} px: {widths:.1?}");
}

/// A ball sunk in a plate, as one object or as two; the ball's lines have no width.
fn ball_in_plate(is_one: bool) -> Scene {
    let mut scene = Builder::new();
    let mut ball = shapes::uv_sphere(48, 32, 0.5);
    ball.line_widths = vec![0.0; ball.positions.len()];
    let plate = shapes::plane(Vec2::splat(4.0));
    let other = Some(scene.colored("ball", [0.8; 3]));
    ball.material = other;
    // Sunk: where they meet is no contour of the ball's.
    let sunk = -0.3;
    for place in &mut ball.positions {
        place.z += sunk;
    }
    if is_one {
        one_object(&mut scene, [plate, ball]);
    } else {
        scene.object("plate", plate, None, Transform::default());
        scene.object("ball", ball, other, Transform::default());
    }
    scene.build()
}

#[test]
fn a_seam_within_an_object_needs_lines_on_both_sides() {
    let view = ortho_view([SIZE, SIZE], 2.0);
    for is_one in [true, false] {
        let ink = ink_of(&ball_in_plate(is_one), &contour_style(3.0, SIZE, ""), &view);
        let count = ink.places(128).count();
        // A ring of 26 pixels' radius.
        assert_eq!(count > 350, !is_one, "one object: {is_one}, {count} pixels");
    }
}

#[test]
fn seams_are_drawn_on_to_contours() {
    // Where the teapot's handle leaves its body at a small angle.
    let scene = subject("teapot-on-box");
    for camera in [12, 16] {
        let figures = measure(&scene, 3.0, &cameras(&scene, 20, [960, 720])[camera]);
        assert!(figures.longest_gap_px <= 2.0, "camera {camera}: {:?}", figures.places);
    }
}
